//! What a person may ask about grasp trials. Says nothing about how it is done.

use crate::app::trial::Criterion;
use crate::app::tuner::book::SessionId;
use crate::app::tuner::draft::Draft;

/// What a person asks for about trials.
#[derive(Debug, Clone, PartialEq)]
pub enum TrialWish {
    /// This is the plan now. Sends nothing.
    Draft(Box<Draft>),
    /// Run the plan, in the arming that is in force. Needs arming.
    Start,
    /// Keep these words with a session.
    Note(SessionId, String),
    /// Keep these tags with a session, separated by commas.
    Tags(SessionId, String),
    /// Take a session out of the list; its files stay. What lies in no file is asked about first.
    Forget(SessionId),
    /// Yes, without files too.
    Agree,
    /// No, it stays.
    Decline,
    /// Ask for a session that was kept, and read it.
    Open,
    /// Ask for a folder and keep a session in a new one inside it; the report names the best by this.
    Save(SessionId, Option<Criterion>),
}
