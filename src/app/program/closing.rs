//! Closing the window: a hand that may move is stopped first, and the user is warned of unsaved work.

use crate::app::env::Env;
use crate::app::hands::Hand;
use crate::app::hands::list::HandList;
use crate::app::program::hands;
use crate::app::state::{LeaveQuestion, State};
use crate::hand::Moment;

/// The window is closing.
#[derive(Clone, Copy)]
pub(super) struct Closing {
    pub(super) since: Moment,
    /// A hand was stopped, and its rest is awaited.
    held: bool,
}

impl Closing {
    /// Stops each hand that is armed, or that this program set in motion.
    pub(super) fn begin(state: &mut State, env: &Env, now: Moment) -> Self {
        state.now = now;
        let mut held = false;
        hands::each_hand(state, env, |hand, ctx| {
            if hand.connection.may_move() {
                hand.stop(ctx);
                held = true;
            }
        });
        Self { since: now, held }
    }

    /// True once each stopped hand rests or has disconnected.
    pub(super) fn is_at_rest(&self, hands: &HandList) -> bool {
        !self.held || hands.iter().all(|hand| hand.connection.is_held(self.since))
    }
}

/// Question about unsaved work; `None` if closing would lose nothing.
pub(super) fn question(hands: &HandList) -> Option<LeaveQuestion> {
    let series = hands.iter().any(Hand::runs_series);
    let staged = |hand: &Hand| hand.params.all_staged().iter().count();
    let edits = hands.iter().map(staged).sum();
    (series || edits > 0).then_some(LeaveQuestion { series, edits })
}
