//! Why a program's wish was not done: a kind for the program, words for who reads them.

use crate::link::{LeaseRefusal, Owner};
use crate::record::Disarmed;
use serde::Serialize;

/// Of what kind a refusal is, as the lines name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RefusalKind {
    /// The line is none that can be obeyed.
    Wrong,
    Refused,
    NotArmed,
    Taken,
    Replaced,
    NotConfirmed,
    Disarmed,
    /// The right to move the hand ended for this.
    #[serde(untagged)]
    Ended(Disarmed),
}

/// Why something was not done, and by what kind of refusal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Refused {
    pub(crate) kind: RefusalKind,
    pub(crate) why: String,
}

impl Refused {
    pub(crate) fn new(kind: RefusalKind, why: impl Into<String>) -> Self {
        let why = why.into();
        Self { kind, why }
    }

    /// Of what went on when something else was asked for.
    pub(crate) fn replaced() -> Self {
        Self::new(RefusalKind::Replaced, "something else was asked for")
    }
}

impl From<LeaseRefusal> for Refused {
    fn from(end: LeaseRefusal) -> Self {
        let (kind, why) = match end {
            LeaseRefusal::Taken(Owner::Gateway(at)) => {
                (RefusalKind::Taken, format!("{at} may now"))
            }
            LeaseRefusal::Taken(_) => (RefusalKind::Taken, "another may now".into()),
            LeaseRefusal::Ended(why) => (RefusalKind::Ended(why), why.to_string()),
        };
        Self::new(
            kind,
            format!("this program may no longer move the hand: {why}"),
        )
    }
}
