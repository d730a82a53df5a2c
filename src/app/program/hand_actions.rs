//! What a person does with the hand that is shown.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::notices::Notices;
use crate::app::settings::Settings;
use crate::app::state::State;
use crate::hand::kinematics::Side;
use crate::hand::{Dof, Finger, Gesture, Moment};
use crate::history::{Mark, MarkKind};
use crate::record::EventKind;
use crate::transport::Endpoint;

impl State {
    /// Leaves the shown hand for another, or for none.
    pub(super) fn connect(&mut self, to: Option<Endpoint>, env: &Env) {
        let slot = self.hand().label.slot;
        if let Some(endpoint) = &to {
            if self.is_open_elsewhere(endpoint, Some(slot)) {
                return;
            }
            // A scan may still ask further ids on the port that is wanted.
            self.scan.cancel();
            self.settings.remember(endpoint);
        }
        let Self {
            hands,
            notices,
            settings,
            ..
        } = self;
        notices.about(hands.is_several().then(|| &hands.shown().label));
        let hand = hands.shown_mut();
        hand.is_removed = false;
        hand.close_procedure();
        hand.leave(to, env, notices);
        hand.apply_settings(settings);
    }

    /// The hand that is shown, with what is told of it.
    pub(super) fn shown(&mut self) -> (&mut HandState, &mut Notices, &mut Settings) {
        let Self {
            hands,
            notices,
            settings,
            ..
        } = self;
        notices.about(hands.is_several().then(|| &hands.shown().label));
        (hands.shown_mut(), notices, settings)
    }

    pub(super) fn set_hold_to_run(&mut self, on: bool) {
        self.settings.hold_to_run = on;
        self.hands.iter_mut().for_each(|hand| hand.tick_hold(on));
    }

    pub(super) fn gesture(&mut self, gesture: Gesture, env: &Env) {
        let (hand, notices, settings) = self.shown();
        hand.gesture(gesture, settings.gesture_route, env, notices);
    }

    pub(super) fn tare(&mut self, finger: Option<Finger>) {
        let (hand, notices, settings) = self.shown();
        hand.tare(finger, notices);
        hand.keep_tare(settings);
    }

    pub(super) fn undo_tare(&mut self) {
        let (hand, _, settings) = self.shown();
        hand.tare.undo();
        hand.keep_tare(settings);
    }

    /// Puts a note into the history; no words are no note.
    pub(super) fn note(&mut self, at: Moment, words: &str) {
        if let Some(note) = MarkKind::note(words) {
            let hand = self.hand_mut();
            hand.record_event(at, EventKind::Note, words.trim().to_owned());
            hand.history.mark(at, note);
        }
    }

    pub(super) fn remove_mark(&mut self, mark: &Mark) {
        let hand = self.hand_mut();
        if let MarkKind::Note(words) = &mark.kind {
            hand.record_event(mark.at, EventKind::NoteRemoved, words.to_string());
        }
        hand.history.remove_mark(mark);
    }

    /// Which side the hand that is shown is of.
    pub(super) fn set_side(&mut self, side: Side) {
        let Self {
            hands, settings, ..
        } = self;
        if let Some(endpoint) = &hands.shown().endpoint {
            settings.set_side_of(endpoint, side);
        }
        // Others of which nobody said a side have the one that was said last.
        if !hands.is_several() {
            settings.side = side;
        }
        hands.shown_mut().apply_settings(settings);
    }
}

/// One joint, or all.
pub(super) fn each(dof: Option<Dof>) -> impl Iterator<Item = Dof> {
    Dof::ALL
        .into_iter()
        .filter(move |own| dof.is_none_or(|dof| dof == *own))
}
