//! Refusal of a request: a kind for the program, and a text for its user.

use crate::link::{LeaseRefusal, Owner};
use crate::record::Disarmed;
use serde::Serialize;

/// Kind of a refusal, by its name in the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RefusalKind {
    /// The line is not a valid request.
    Wrong,
    Refused,
    NotArmed,
    Taken,
    Replaced,
    NotConfirmed,
    Disarmed,
    /// Control of the hand ended for this reason.
    #[serde(untagged)]
    Ended(Disarmed),
}

/// Kind and text of a refusal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct StdioRefusal {
    pub(crate) kind: RefusalKind,
    pub(crate) why: String,
}

impl StdioRefusal {
    pub(crate) fn new(kind: RefusalKind, why: impl Into<String>) -> Self {
        let why = why.into();
        Self { kind, why }
    }

    /// Loss of control by a program that does not read.
    pub(crate) fn unread() -> Self {
        Self::new(
            RefusalKind::Ended(Disarmed::Silent),
            "the hand was stopped, because this program did not read its states for a second; one long call that lets nothing else run does that, such as an import or a computation without a pause",
        )
    }

    /// Refusal of a task that was replaced by another request.
    pub(crate) fn replaced() -> Self {
        Self::new(RefusalKind::Replaced, "another request came first")
    }
}

impl From<LeaseRefusal> for StdioRefusal {
    fn from(end: LeaseRefusal) -> Self {
        let (kind, why) = match end {
            LeaseRefusal::Taken(Owner::Gateway(at)) => {
                (RefusalKind::Taken, format!("{at} has control"))
            }
            LeaseRefusal::Taken(_) => (RefusalKind::Taken, "another controller has control".into()),
            LeaseRefusal::Ended(why) => (RefusalKind::Ended(why), why.to_string()),
        };
        Self::new(
            kind,
            format!("this program may no longer move the hand: {why}"),
        )
    }
}
