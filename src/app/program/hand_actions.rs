//! What a person does with the hand that is shown, and how the window is set.

use crate::app::action::Action;
use crate::app::env::Env;
use crate::app::state::State;
use crate::hand::{Dof, Moment};
use crate::history::MarkKind;
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
        hand.know(settings);
    }

    /// What is done with the hand that is shown.
    pub(super) fn hand_action(&mut self, action: Action, env: &Env, now: Moment) {
        let Self {
            hands,
            notices,
            settings,
            ..
        } = self;
        notices.about(hands.is_several().then(|| &hands.shown().label));
        let hand = hands.shown_mut();
        match action {
            Action::Arm => hand.arm(notices),
            Action::HoldToRun(on) => {
                settings.hold_to_run = on;
                hands.iter_mut().for_each(|hand| hand.tick_hold(on));
            }
            Action::Disarm => hand.disarm(),
            Action::Target(dof, angle) => hand.target(dof, angle),
            Action::Force(dof, force) => each(dof).for_each(|dof| hand.force(dof, force)),
            Action::Speed(dof, speed) => each(dof).for_each(|dof| hand.speed(dof, speed)),
            Action::Lock(dof, locked) => hand.lock(dof, locked),
            Action::Preset(preset) => hand.preset(preset),
            Action::Gesture(gesture) => {
                hand.gesture(gesture, settings.gesture_route, env, notices);
            }
            Action::ClearErrors if hand.procedure.is_none() => hand.clear_errors(env, notices),
            Action::ChangePlace(id, wanted) => hand.open_place_change(id, wanted),
            Action::FactoryReset => hand.open_reset(),
            Action::CalibrateForce => hand.open_calibration(),
            Action::Procedure(action) => hand.procedure_action(action, env),
            Action::Input(action) => self.input_action(action, env),
            Action::Tare(finger) => {
                hand.tare(finger, notices);
                hand.keep_tare(settings);
            }
            Action::UndoTare => {
                hand.tare.undo();
                hand.keep_tare(settings);
            }
            Action::TakeKeptTare => hand.take_kept_tare(notices),
            Action::SeenFault(dof, what) => hand.faults.see_one(dof, what),
            Action::SeenFaults => hand.faults.see_all(),
            Action::Note(at, words) => {
                if let Some(note) = MarkKind::note(&words) {
                    hand.record_event(at, EventKind::Note, words.trim().to_owned());
                    hand.history.mark(at, note);
                }
            }
            Action::RemoveMark(mark) => {
                if let MarkKind::Note(words) = &mark.kind {
                    hand.record_event(mark.at, EventKind::NoteRemoved, words.to_string());
                }
                hand.history.remove_mark(&mark);
            }
            Action::Stage(id, value) => hand.params.stage(id, value),
            action => self.pose_action(action, env, now),
        }
    }

    /// What is kept from one start to the next.
    pub(super) fn setting_action(&mut self, action: Action) {
        let Self {
            hands, settings, ..
        } = self;
        match action {
            Action::Side(side) => {
                if let Some(endpoint) = &hands.shown().endpoint {
                    settings.set_side_of(endpoint, side);
                }
                // Others of which nobody said a side have the one that was said last.
                if !hands.is_several() {
                    settings.side = side;
                }
                hands.shown_mut().know(settings);
            }
            Action::NameGesture(gesture, name) => settings.name_gesture(gesture, &name),
            Action::GestureRoute(route) => settings.gesture_route = route,
            Action::Theme(theme) => settings.theme = theme,
            Action::Layout(layout) => settings.layout = layout,
            Action::ReadFirst(first) => settings.read_first = first,
            Action::Zoom(zoom) => settings.zoom = zoom,
            Action::Language(language) => settings.language = language,
            Action::AngleUnit(unit) => settings.angle_unit = unit,
            Action::PlotWindow(window) => settings.plot_window = window,
            Action::ShowPlot(kind, on) => settings.plots.set(kind, on),
            // Standing plots are the view's own matter, and all others were carried out before.
            _ => {}
        }
    }
}

/// One joint, or all.
fn each(dof: Option<Dof>) -> impl Iterator<Item = Dof> {
    Dof::ALL
        .into_iter()
        .filter(move |own| dof.is_none_or(|dof| dof == *own))
}
