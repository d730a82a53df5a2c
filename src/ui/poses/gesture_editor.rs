//! A gesture of the user's in the hand's own memory: six angles, tried, written and read back. Every step is an action.

use crate::app::action::Action;
use crate::app::hand::gestures::StoreVerdict;
use crate::hand::{Angle, GestureStore, PerDof, UserGesture};
use crate::ui::hand::panel;
use crate::ui::kit::{Button, Label, NumberField, Pane, Weight};
use crate::ui::poses::editor::{caption_ui, six_ui};
use crate::ui::text::{main, poses};
use egui::{Ui, vec2};

/// What the editor needs between frames.
#[derive(Debug)]
pub(crate) struct GestureEditor {
    gesture: UserGesture,
    angles: PerDof<Option<Angle>>,
    /// A read was asked for, and what comes is taken.
    reading: bool,
}

impl Default for GestureEditor {
    fn default() -> Self {
        Self {
            gesture: UserGesture::MIN,
            angles: PerDof::splat(None),
            reading: false,
        }
    }
}

impl GestureEditor {
    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        self.take_read(pane);
        let look = pane.look;
        ui.horizontal(|ui| self.number_ui(ui, pane));
        ui.horizontal(|ui| self.store_ui(ui, pane));
        ui.horizontal(|ui| {
            ui.vertical(|ui| {
                ui.set_width(160.0);
                six_ui(ui, pane, "gesture", &mut self.angles);
            });
            let shares = |angle: Option<Angle>| Some(f32::from(angle?.get()) / 1000.0);
            let (_, picture) = ui.allocate_space(vec2(180.0, 164.0));
            panel::pose_ui(ui, look, picture, &self.angles.map(shares));
        });
        ui.horizontal(|ui| self.buttons_ui(ui, pane));
        self.verdict_ui(ui, pane);
        let known = match pane.state.settings.gesture_store {
            GestureStore::Register1066 => &[poses::STORE_KNOWN, poses::STORE_UNKNOWN][..],
            GestureStore::Off => &[poses::STORE_OFF.tip()],
        };
        for text in known {
            Label::note(look, *text).wrap().ui(ui);
        }
    }

    fn take_read(&mut self, pane: &Pane<'_>) {
        let stored = pane.state.hand().gestures.stored;
        let own = stored.filter(|stored| self.reading && stored.gesture == self.gesture);
        if let Some(stored) = own {
            self.angles = stored.angles.map(|raw| Angle::new(raw).ok());
            self.reading = false;
        }
    }

    fn number_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let text = look.say(poses::USER_GESTURE);
        caption_ui(ui, text, look.palette.text);
        let field = NumberField::new(text, look.tip(poses::USER_GESTURE), 14.0..=40.0);
        let typed = field.whole_ui(ui, pane, Some(self.gesture.get()));
        if let Some(gesture) = typed.and_then(|typed| UserGesture::new(typed).ok()) {
            self.gesture = gesture;
            self.reading = false;
        }
        let name = pane.state.settings.gesture_name(self.gesture.gesture());
        if let Some(name) = name {
            Label::new(name, look.palette.muted).ui(ui);
        }
    }

    /// Where the angles of this gesture lie, and whether such addresses are used at all.
    fn store_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let now = pane.state.settings.gesture_store;
        caption_ui(ui, look.say(poses::STORE_CAPTION), look.palette.text);
        for (text, store) in [
            (poses::STORE_1066, GestureStore::Register1066),
            (poses::STORE_OFF, GestureStore::Off),
        ] {
            let text = look.say(text);
            let name = format!("{}: {text}", look.say(poses::STORE_NAME));
            let button = Button::new(text, look.say(poses::STORE_TIP)).named(&name);
            button
                .choice(now == store)
                .sends(ui, pane, Action::GestureStore(store));
        }
    }

    fn buttons_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let unreachable = match pane.state.settings.gesture_store {
            GestureStore::Off => Some(look.tip(poses::STORE_OFF)),
            GestureStore::Register1066 => {
                let live = pane.state.hand().link.state.is_live();
                (!live).then(|| look.say(main::REFUSED_OFFLINE))
            }
        };
        let now = pane.state.hand().pose_now();
        let unknown = now.is_none().then(|| look.say(poses::CAPTURE_UNKNOWN));
        let angles = self.angles.all();
        let missing = angles.is_none().then(|| look.say(poses::FIRST_ANGLES));
        let mut pressed = |text, disabled, weight| {
            let button = Button::said(look, text).weight(weight);
            button.disabled(disabled).ui(ui, look).clicked()
        };
        let (normal, strong) = (Weight::Normal, Weight::Strong);
        if pressed(poses::RECAPTURE, unknown, normal)
            && let Some(now) = now
        {
            self.angles = now.map(Some);
        }
        if pressed(poses::READ_HAND, unreachable, normal) {
            self.reading = true;
            pane.actions.push(Action::ReadGesture(self.gesture));
        }
        let untested = missing.or(pane.unready());
        if pressed(poses::TEST, untested, normal)
            && let Some(angles) = angles
        {
            pane.actions.push(Action::TryAngles(angles));
        }
        let unsent = unreachable.or(missing);
        if pressed(poses::UPLOAD, unsent, strong)
            && let Some(angles) = angles
        {
            let store = Action::StoreGesture(self.gesture, angles);
            pane.actions.push(store);
        }
    }

    fn verdict_ui(&self, ui: &mut Ui, pane: &Pane<'_>) {
        let (look, palette) = (pane.look, pane.look.palette);
        let gestures = &pane.state.hand().gestures;
        let own = |gesture: UserGesture| gesture == self.gesture;
        let upload = gestures.upload.filter(|last| own(last.gesture));
        let stored = gestures.stored.filter(|last| own(last.gesture));
        let empty = stored.is_some_and(|last| last.angles.iter().all(|(_, raw)| *raw < 0));
        let (text, color) = match upload.map(|upload| upload.verdict) {
            Some(StoreVerdict::Same) => (poses::VERDICT_SAME, palette.ok),
            Some(StoreVerdict::Differs) => (poses::VERDICT_DIFFERS, palette.bad),
            Some(StoreVerdict::Failed) => (poses::VERDICT_FAILED, palette.bad),
            Some(StoreVerdict::Writing) => (poses::VERDICT_WRITING, palette.muted),
            None if empty => (poses::STORED_NONE, palette.muted),
            None => return,
        };
        Label::new(look.say(text), color).ui(ui);
    }
}
