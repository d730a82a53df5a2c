//! Questions of a task to the user while it runs: one dialog in the window, one rule on the command line.

use crate::params::danger::Danger;
use crate::params::place::WhichPlace;
use crate::params::values::Params;

/// A question that the user answers with yes or no. The task waits for the answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Question {
    /// Write rows despite these risks?
    Apply(Risks),
    /// Save the parameters to flash, with these risks, which may be none?
    Save(Risks),
    /// The hand is at this address, or holds the new value there until it is power-cycled: keep the change? Without an answer within
    /// [`CONFIRM_TIMEOUT`](crate::tasks::place::CONFIRM_TIMEOUT) it is reverted.
    KeepPlace(WhichPlace),
    /// The change was kept, and the hand is at this address: save it to flash?
    SavePlace(WhichPlace),
}

/// The user of a task.
pub trait User: Send {
    /// Asks, and waits for the answer; false as well if the user cannot answer.
    fn ask(&mut self, question: Question) -> impl Future<Output = bool> + Send;
}

/// A user who answers at once.
impl<F: FnMut(&Question) -> bool + Send> User for F {
    async fn ask(&mut self, question: Question) -> bool {
        self(&question)
    }
}

/// Risks that the user should confirm before a task continues.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Risks {
    /// Joints that will hit harder than before.
    pub dangers: Vec<Danger>,
    /// Rows that change the address of the hand, with their new values.
    pub places: Params,
}

impl Risks {
    /// True if these contain all of the others.
    pub fn contain(&self, others: &Self) -> bool {
        let mut dangers = others.dangers.iter();
        let mut places = others.places.iter();
        dangers.all(|danger| self.dangers.contains(danger))
            && places.all(|(id, value)| self.places.get(id) == Some(value))
    }
}
