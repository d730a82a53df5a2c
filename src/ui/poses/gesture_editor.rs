//! A gesture of the user's in the hand's own memory: six angles, tried, written and read back. Every step is an action.

use crate::app::action::Action;
use crate::app::hand::gestures::StoreVerdict;
use crate::hand::command::stored_gesture;
use crate::hand::{Angle, GestureStore, PerDof, UserGesture};
use crate::ui::hand::panel;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::kit::number::NumberField;
use crate::ui::poses::editor::{six_ui, whole};
use crate::ui::text::{Text, main, poses};
use crate::ui::theme;
use egui::{Id, Rect, Ui};

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

const fn verdict_text(verdict: StoreVerdict) -> Text {
    match verdict {
        StoreVerdict::Writing => poses::VERDICT_WRITING,
        StoreVerdict::Same => poses::VERDICT_SAME,
        StoreVerdict::Differs => poses::VERDICT_DIFFERS,
        StoreVerdict::Failed => poses::VERDICT_FAILED,
    }
}

impl GestureEditor {
    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        self.take_read(pane);
        let mut left = rect;
        self.number_ui(ui, take_top(&mut left, theme::CONTROL), pane);
        self.store_ui(ui, take_top(&mut left, theme::CONTROL), pane);
        let six = take_top(&mut left, 6.0 * (theme::CONTROL + theme::STEP));
        let picture = six.with_min_x(
            six.left() + theme::GESTURE_CAPTION + theme::POSE_NUMBER + 2.0 * theme::GAP,
        );
        let shares = self
            .angles
            .map(|angle| Some(f32::from(angle?.get()) / 1000.0));
        panel::pose_ui(ui, pane.look, picture, &shares);
        if let Some(angles) = six_ui(ui, six, pane, "gesture", &self.angles) {
            self.angles = angles;
        }
        self.fill_ui(ui, take_top(&mut left, theme::CONTROL), pane);
        self.send_ui(ui, take_top(&mut left, theme::CONTROL_LARGE), pane);
        self.verdict_ui(ui, take_top(&mut left, theme::CONTROL), pane);
        let text = match pane.state.settings.gesture_store {
            GestureStore::Register1066 => {
                let known = pane.look.say(poses::STORE_KNOWN);
                format!("{known}\n{}", pane.look.say(poses::STORE_UNKNOWN))
            }
            GestureStore::Off => pane.look.say(poses::STORE_OFF_TIP).to_owned(),
        };
        wrapped(ui, left, pane, &text);
    }

    /// Where the angles of this gesture lie, and whether such addresses are used at all.
    fn store_ui(&self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let now = pane.state.settings.gesture_store;
        let text = look.say(poses::STORE_CAPTION);
        let place = take_left(&mut row, theme::GESTURE_CAPTION);
        Label::new(text, look.palette.text).put(ui, place);
        for (text, store) in [
            (poses::STORE_1066, GestureStore::Register1066),
            (poses::STORE_OFF, GestureStore::Off),
        ] {
            let text = look.say(text);
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
            let place = take_left(&mut row, width);
            row.min.x -= theme::STEP;
            let name = format!("{}: {text}", look.say(poses::STORE_NAME));
            let button = Button::new(text, look.say(poses::STORE_TIP)).named(&name);
            let button = button.choice(now == store);
            if button
                .put(ui, look, place, Id::unique(("gesture store", store)))
                .clicked()
            {
                pane.actions.push(Action::GestureStore(store));
            }
        }
        if now == GestureStore::Register1066 {
            let span = stored_gesture(self.gesture);
            let last = span.end().saturating_sub(1);
            let text = format!("{} {}..{last}", look.say(poses::STORE_AT), span.address);
            row.min.x += theme::STEP;
            if controls::text_width(ui, &text, theme::small()) > row.width() {
                let (_, short) = text.split_once(' ').unwrap_or_default();
                Label::new(short, look.palette.faint).small().put(ui, row);
            } else {
                Label::new(&text, look.palette.faint).small().put(ui, row);
            }
        }
    }

    /// Why the hand's memory of gestures cannot be reached now.
    fn unreachable(pane: &Pane<'_>) -> Option<&'static str> {
        let look = pane.look;
        if pane.state.settings.gesture_store == GestureStore::Off {
            return Some(look.say(poses::STORE_OFF_TIP));
        }
        (!pane.state.hand().link.state.is_live()).then(|| look.say(main::REFUSED_OFFLINE))
    }

    fn take_read(&mut self, pane: &Pane<'_>) {
        let Some(stored) = pane.state.hand().gestures.stored.filter(|_| self.reading) else {
            return;
        };
        if stored.gesture == self.gesture {
            self.angles = stored.angles.map(|raw| Angle::new(raw).ok());
            self.reading = false;
        }
    }

    fn number_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let text = look.say(poses::USER_GESTURE);
        Label::new(text, look.palette.text).put(ui, take_left(&mut row, theme::GESTURE_CAPTION));
        let field = NumberField {
            name: text,
            tip: look.say(poses::USER_GESTURE_TIP),
            disabled: None,
            value: Some(f64::from(self.gesture.get())),
            range: 14.0..=40.0,
            decimals: 0,
        };
        let place = take_left(&mut row, theme::POSE_NUMBER);
        let typed = field.put(ui, look, pane.typing, place, Id::unique("user gesture"));
        if let Some(gesture) = typed.and_then(|typed| UserGesture::new(whole(typed)).ok()) {
            self.gesture = gesture;
            self.reading = false;
        }
        let name = pane.state.settings.gesture_name(self.gesture.gesture());
        Label::new(name.unwrap_or_default(), look.palette.muted).put(ui, row);
    }

    fn fill_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let half = (row.width() - theme::GAP) / 2.0;
        let now = pane.state.hand().pose_now();
        let unknown = now.is_none().then(|| look.say(poses::CAPTURE_UNKNOWN));
        let take = Button::new(look.say(poses::RECAPTURE), look.say(poses::RECAPTURE_TIP));
        let place = take_left(&mut row, half);
        if take
            .disabled(unknown)
            .put(ui, look, place, Id::unique("gesture take"))
            .clicked()
            && let Some(now) = now
        {
            self.angles = now.map(Some);
        }
        let read = Button::new(look.say(poses::READ_HAND), look.say(poses::READ_HAND_TIP));
        if read
            .disabled(Self::unreachable(pane))
            .put(ui, look, row, Id::unique("gesture read"))
            .clicked()
        {
            self.reading = true;
            pane.actions.push(Action::ReadGesture(self.gesture));
        }
    }

    fn send_ui(&self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let half = (row.width() - theme::GAP) / 2.0;
        let angles = self.angles.all();
        let missing = angles.is_none().then(|| look.say(poses::FIRST_ANGLES));
        let unarmed = pane.unready();
        let test = Button::new(look.say(poses::TEST), look.say(poses::TEST_TIP));
        let place = take_left(&mut row, half);
        let test = test.disabled(missing.or(unarmed));
        if test
            .put(ui, look, place, Id::unique("gesture test"))
            .clicked()
            && let Some(angles) = angles
        {
            pane.actions.push(Action::TryAngles(angles));
        }
        let upload = Button::new(look.say(poses::UPLOAD), look.say(poses::UPLOAD_TIP));
        let upload = upload
            .disabled(Self::unreachable(pane).or(missing))
            .weight(Weight::Strong);
        if upload
            .put(ui, look, row, Id::unique("gesture upload"))
            .clicked()
            && let Some(angles) = angles
        {
            pane.actions
                .push(Action::StoreGesture(self.gesture, angles));
        }
    }

    fn verdict_ui(&self, ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let upload = pane
            .state
            .hand()
            .gestures
            .upload
            .filter(|last| last.gesture == self.gesture);
        let stored = pane
            .state
            .hand()
            .gestures
            .stored
            .filter(|last| last.gesture == self.gesture);
        let empty = stored.is_some_and(|last| last.angles.iter().all(|(_, raw)| *raw < 0));
        let (text, color) = match upload.map(|upload| upload.verdict) {
            Some(StoreVerdict::Same) => (verdict_text(StoreVerdict::Same), look.palette.ok),
            Some(bad @ (StoreVerdict::Differs | StoreVerdict::Failed)) => {
                (verdict_text(bad), look.palette.bad)
            }
            Some(under_way) => (verdict_text(under_way), look.palette.muted),
            None if empty => (poses::STORED_NONE, look.palette.muted),
            None => return,
        };
        let place = rect.with_max_y(rect.top() + theme::CONTROL);
        Label::new(look.say(text), color).put(ui, place);
    }
}

/// Running text on several lines.
pub(crate) fn wrapped(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, text: &str) {
    let job = egui::text::LayoutJob::simple(
        text.to_owned(),
        theme::small(),
        pane.look.palette.faint,
        rect.width(),
    );
    let galley = ui.painter().layout_job(job);
    let clip = ui.painter().with_clip_rect(rect);
    clip.galley(rect.min, galley, pane.look.palette.faint);
    let id = ui.next_auto_id();
    ui.skip_ahead_auto_ids(1);
    let response = ui.interact(rect, id, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, text));
    controls::focus_ring(ui, pane.look, &response, rect);
}
