//! Why a program's wish was not done: a kind for the program, words for who reads them.

use crate::link::{LeaseRefusal, Owner};
use crate::record::Disarmed;

/// Why something was not done, and by what kind of refusal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Refused {
    pub(crate) kind: &'static str,
    pub(crate) why: String,
}

impl Refused {
    pub(crate) fn new(kind: &'static str, why: impl Into<String>) -> Self {
        let why = why.into();
        Self { kind, why }
    }
}

impl From<LeaseRefusal> for Refused {
    fn from(end: LeaseRefusal) -> Self {
        let (kind, why) = match end {
            LeaseRefusal::Taken(Owner::Gateway(at)) => ("taken", format!("{at} may now")),
            LeaseRefusal::Taken(_) => ("taken", "another may now".into()),
            LeaseRefusal::Ended(why) => (disarmed_kind(why), why.to_string()),
        };
        Self::new(
            kind,
            format!("this program may no longer move the hand: {why}"),
        )
    }
}

const fn disarmed_kind(why: Disarmed) -> &'static str {
    match why {
        Disarmed::Stop => "stop",
        Disarmed::Person => "person",
        Disarmed::Fault => "fault",
        Disarmed::LinkLost => "link_lost",
        Disarmed::Stale => "stale",
        Disarmed::FrozenFeedback => "frozen_feedback",
        Disarmed::Resume => "resume",
        Disarmed::OtherController => "other_controller",
        Disarmed::Released => "released",
        Disarmed::Silent => "silent",
        Disarmed::Hot => "hot",
    }
}
