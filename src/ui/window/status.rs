//! The status line below the header: the worst warning, the mover of the hand with a button to end it, the newest message,
//! and the note being written. The line is always visible, so nothing shifts when its content changes.

use crate::app::action::Action;
use crate::app::hand::hold::HoldAction;
use crate::app::hand::mover::{Mover, rests};
use crate::app::hand::scale::ScaleAction;
use crate::app::inputs::InputAction;
use crate::app::notices::{Level, Notice, NoticeKind};
use crate::app::readings::Freshness;
use crate::hand::{Dof, Moment};
use crate::history::NOTE_MAX;
use crate::link::Dialling;
use crate::poses::Play;
use crate::poses::library::EntryId;
use crate::record::{Hold, LinkState};
use crate::ui::inputs::owner_words;
use crate::ui::kit::{self, Button, Label, Pane, ViewRequest, Weight, format};
use crate::ui::plots::times::clock;
use crate::ui::recordings::marks::play_words;
use crate::ui::text::{
    Text, checkup, errors, hold, main, notices, panels, poses, tune, window, words,
};
use crate::ui::theme;
use crate::ui::view::View;
use egui::{Color32, Frame, Key, TextEdit, Ui, vec2};
use std::fmt::Display;
use std::time::Duration;

/// Height of the line, in points.
pub(crate) const HEIGHT: f32 = 28.0;
/// Delay before a connection attempt is announced: a hand that answers sooner is connected before the text could be read.
const ANNOUNCE_DELAY: Duration = Duration::from_millis(500);
/// Display time of the newest message.
const NEWS_DURATION: Duration = Duration::from_secs(10);

/// Remedy for a warning.
enum Help {
    /// A view, and the text of the button that opens it.
    View(View, Text),
    /// Dismisses the notice with this id.
    Dismiss(u64),
}

/// A condition that the user must know about now.
struct Warning {
    title: Text,
    body: String,
    aside: String,
    color: Color32,
    help: Option<Help>,
}

impl Warning {
    /// A warning with the tip of `title` as its body.
    fn new(pane: &Pane<'_>, title: Text, color: Color32) -> Self {
        Self {
            title,
            body: pane.look.tip(title).to_owned(),
            aside: String::new(),
            color,
            help: None,
        }
    }

    /// Appends to the body.
    fn more(mut self, more: impl Display) -> Self {
        self.body = format!("{} {more}", self.body).trim_start().to_owned();
        self
    }

    /// Puts the name of the hand first, if given.
    fn of(mut self, pane: &Pane<'_>, hand: Option<&str>) -> Self {
        if let Some(hand) = hand {
            self.body = pane.look.pair(hand, &self.body);
        }
        self
    }

    /// Adds the state of reconnecting.
    fn retried(mut self, pane: &Pane<'_>) -> Self {
        self.aside = match pane.hand().connection.status.dialling {
            Dialling::Idle => String::new(),
            Dialling::Trying { attempt } => pane.look.tr_with(main::LOST_TRYING, attempt),
            Dialling::Waiting { until, .. } => {
                let left = until.since(pane.state.now).as_secs_f64();
                format!("{} {left:.1} s", pane.look.tr(main::LOST_RETRY_IN))
            }
        };
        self
    }

    fn help(mut self, help: Help) -> Self {
        self.help = Some(help);
        self
    }
}

/// Current warnings, worst first.
fn warnings(pane: &Pane<'_>) -> Vec<Warning> {
    let all = [
        unsent(pane),
        alarm(pane),
        lost(pane),
        lost_elsewhere(pane),
        faults(pane),
        other_controller(pane),
        not_taken(pane),
        stale(pane),
        connecting(pane),
        empty(pane),
        idle(pane),
    ];
    all.into_iter().flatten().collect()
}

/// A stop that could not be sent, until it is dismissed or the hand answers again.
fn unsent(pane: &Pane<'_>) -> Option<Warning> {
    let mut all = pane.state.notices.iter();
    let notice = all.find(|notice| notice.what == NoticeKind::StopNotSent)?;
    let unsent = Warning::new(pane, window::STOP_NOT_SENT, pane.look.palette.bad);
    let hand = notice.hand.as_ref().map(|hand| &*hand.name);
    let help = Help::Dismiss(notice.id);
    Some(unsent.of(pane, hand).help(help))
}

/// The shown hand, or else another one, that does not stop.
fn alarm(pane: &Pane<'_>) -> Option<Warning> {
    let shown = pane.hand();
    let mut hands = std::iter::once(shown).chain(pane.state.hands.iter());
    let hand = hands.find(|hand| matches!(hand.connection.status.hold, Hold::Alarm { .. }))?;
    let title = if hand.connection.status.feedback_in_doubt {
        main::DOUBT_TITLE
    } else {
        main::ALARM_TITLE
    };
    let alarm = Warning::new(pane, title, pane.look.palette.bad);
    let is_several = pane.state.hands.is_several();
    Some(alarm.of(pane, is_several.then_some(&hand.label.name)))
}

/// A hand other than the shown one, lost while it may have been moving.
fn lost_elsewhere(pane: &Pane<'_>) -> Option<Warning> {
    let shown = pane.hand().label.slot;
    let mut others = pane.state.hands.iter();
    let lost = others.find(|hand| {
        let is_lost =
            hand.connection.status.trouble.is_some() && hand.readings.sample.angle.is_some();
        hand.label.slot != shown && hand.connection.status.state == LinkState::Offline && is_lost
    })?;
    let warning = Warning::new(pane, main::LOST_TITLE, pane.look.palette.bad);
    Some(warning.of(pane, Some(&lost.label.name)))
}

fn lost(pane: &Pane<'_>) -> Option<Warning> {
    let link = &pane.hand().connection.status;
    if link.state != LinkState::Offline && link.state != LinkState::Identifying {
        return None;
    }
    let cause = errors::trouble(pane.look, link.trouble.as_ref()?);
    // A hand that has answered may be moving; one that never did is merely unreachable.
    let (title, color) = match pane.hand().readings.sample.angle {
        Some(_) => (main::LOST_TITLE, pane.look.palette.bad),
        None => (main::UNREACHABLE_TITLE, pane.look.palette.warn),
    };
    Some(Warning::new(pane, title, color).more(cause).retried(pane))
}

fn faults(pane: &Pane<'_>) -> Option<Warning> {
    let (look, sample) = (pane.look, &pane.hand().readings.sample);
    let faults = sample.faults.filter(|_| sample.has_fault())?;
    let mut list = Vec::new();
    for dof in Dof::ALL {
        let name = look.tr(words::dof(dof));
        let titles = faults.value[dof].iter();
        let titles = titles.map(|fault| words::fault(fault, look.language).title);
        list.extend(titles.map(|title| look.pair(name, title)));
    }
    let (list, end) = (list.join(" · "), look.tr(main::LIST_END));
    let color = look.value(pane.freshness(Some(faults.asked)), look.palette.bad);
    let warning = Warning::new(pane, main::FAULT_TITLE, color);
    Some(Warning {
        body: format!("{list}{end}{}", warning.body),
        help: Some(Help::View(View::Faults, main::FAULT_SHOW)),
        ..warning
    })
}

fn other_controller(pane: &Pane<'_>) -> Option<Warning> {
    let link = &pane.hand().connection.status;
    let other = || Warning::new(pane, main::OTHER_CONTROLLER_TITLE, pane.look.palette.warn);
    let warning = (link.state.is_live() && link.other_controller).then(other)?;
    Some(match &link.foreign_setpoint {
        Some(foreign) => {
            let foreign = words::setpoint(pane.look, foreign);
            // The effect comes first, so that a short line still shows it.
            let wrote = pane.look.fill(main::OTHER_WROTE, &[&foreign]);
            let body = format!("{wrote} {}", warning.body);
            Warning { body, ..warning }
        }
        None => warning,
    })
}

/// A setpoint that the armed hand ignores or limits.
fn not_taken(pane: &Pane<'_>) -> Option<Warning> {
    let link = &pane.hand().connection.status;
    let conflict = link.setpoint_not_taken.filter(|_| link.armed.is_some())?;
    let warning = Warning::new(pane, main::NOT_TAKEN_TITLE, pane.look.palette.warn);
    Some(warning.more(words::setpoint(pane.look, &conflict)))
}

fn stale(pane: &Pane<'_>) -> Option<Warning> {
    let asked = pane.hand().readings.sample.angle?.asked;
    let link = &pane.hand().connection.status;
    // While the hand saves, it is not polled: the view that requested the save shows this.
    let expected = link.state.is_live() && !link.line_left;
    let is_stale = expected && pane.freshness(Some(asked)) == Freshness::Stale;
    let age = format::age(pane.state.now.since(asked));
    let stale = || Warning::new(pane, main::STALE_TITLE, pane.look.palette.warn);
    is_stale.then(|| stale().more(age))
}

/// A first connection attempt that has not failed yet.
fn connecting(pane: &Pane<'_>) -> Option<Warning> {
    let link = &pane.hand().connection.status;
    let hand = pane.hand().connection.endpoint.as_ref()?;
    let asks = matches!(link.state, LinkState::Offline | LinkState::Identifying);
    // A hand that answers at once is not announced.
    let waited = pane.state.now.since(link.since) >= ANNOUNCE_DELAY;
    let warning = || Warning::new(pane, main::CONNECTING_TITLE, pane.look.palette.accent);
    let help = Help::View(View::Connection, main::EMPTY_OPEN);
    (asks && waited && link.trouble.is_none())
        .then(|| warning().more(hand).retried(pane).help(help))
}

fn empty(pane: &Pane<'_>) -> Option<Warning> {
    let warning = || Warning::new(pane, main::EMPTY_TITLE, pane.look.palette.accent);
    let help = Help::View(View::Connection, main::EMPTY_OPEN);
    let is_none = pane.hand().connection.endpoint.is_none();
    is_none.then(|| warning().help(help))
}

/// An armed hand that no longer receives commands.
fn idle(pane: &Pane<'_>) -> Option<Warning> {
    let idle = pane.hand().connection.idle(pane.state.now)?;
    let warning = Warning::new(pane, main::IDLE_TITLE, pane.look.palette.warn);
    Some(warning.more(format::duration(idle)))
}

/// Description of the mover of the hand, and the action that ends it; `None` if nothing moves the hand.
fn mover(pane: &Pane<'_>) -> Option<(String, Option<Action>)> {
    let look = pane.look;
    let tr = |text: Text| look.tr(text).to_owned();
    Some(match Mover::of(pane.hand(), pane.state.now)? {
        Mover::Stop => (tr(window::MOVES_STOP), None),
        Mover::Calibration => (tr(window::MOVES_CALIBRATION), None),
        Mover::Scale => {
            let finish = Action::Scale(ScaleAction::Finish);
            (tr(checkup::NEWTONS), Some(finish))
        }
        Mover::Hold => (tr(hold::MOVES), Some(Action::Hold(HoldAction::End))),
        Mover::Series(number, total) => {
            let words = format!("{} {number} / {total}", look.tr(tune::COLUMN_TRIAL));
            (words, Some(Action::Stop))
        }
        Mover::Checkup(step, total) => {
            let words = format!("{} {step} / {total}", look.tr(checkup::TITLE));
            (words, Some(Action::Stop))
        }
        Mover::Playing(entry, step) => {
            let name = look.entry_name(&pane.state.poses, entry);
            let title = look.tr(match entry {
                EntryId::Pose(_) => poses::POSE,
                EntryId::Sequence(_) => poses::SEQUENCE,
                EntryId::Reaction(_) => poses::REACTION,
            });
            let mut words = format!("{title} {name}");
            if let EntryId::Sequence(id) = entry {
                let sequence = pane.state.poses.sequence(id);
                let steps = sequence.map_or(0, |own| own.steps.len());
                let (of, step) = (look.tr(window::MOVES_STEP), step + 1);
                words = look.pair(&words, &format!("{of} {step} / {steps}"));
            }
            (words, Some(Action::Play(Play::End)))
        }
        Mover::Gesture(gesture) => {
            let name = pane.state.settings.gesture_name(gesture);
            let (title, name) = (look.tr(panels::GESTURE), name.unwrap_or_default());
            let words = format!("{title} {} {name}", gesture.get());
            (words.trim().to_owned(), None)
        }
        Mover::Outside(owner) => {
            let words = owner_words(pane, owner);
            (words, Some(Action::Input(InputAction::TakeBack)))
        }
        Mover::Setpoints => (tr(window::MOVES_SETPOINTS), None),
        Mover::Recorded => (play_words(look, pane.hand().recorded_play()?), None),
        Mover::Task => (tr(window::MOVES_TASK), None),
        Mover::Exhibition => (tr(window::MOVES_EXHIBIT), None),
        Mover::Unrecorded => (tr(window::MOVES_UNRECORDED), None),
        Mover::Unknown => (tr(window::MOVES_UNKNOWN), None),
    })
}

/// The status line, with the note being written in it.
#[derive(Debug, Default)]
pub(crate) struct StatusLine {
    /// Time at which the note was begun; `None` while none is being written.
    note_at: Option<Moment>,
    note: String,
    is_new: bool,
}

impl StatusLine {
    /// Begins a note for this moment, unless one is being written.
    pub(crate) fn open_note(&mut self, at: Moment) {
        if self.note_at.is_none() {
            *self = Self {
                note_at: Some(at),
                note: String::new(),
                is_new: true,
            };
        }
    }

    /// True while a note is being written.
    pub(crate) const fn writes_note(&self) -> bool {
        self.note_at.is_some()
    }

    /// Discards the note being written.
    pub(crate) fn drop_note(&mut self) {
        *self = Self::default();
    }

    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let warnings = warnings(pane);
        // A missing hand is less important than a message about it.
        let is_told = news(pane).is_some_and(|notice| notice.level > Level::Info);
        let hides = |worst: &&Warning| worst.color == pane.look.palette.accent && is_told;
        let worst = warnings.first().filter(|worst| !hides(worst));
        let palette = pane.look.palette;
        let fill = worst.map_or(palette.card, |worst| palette.wash(worst.color));
        let frame = Frame::new().fill(fill).inner_margin(vec2(theme::PAD, 2.0));
        frame.show(ui, |ui| {
            kit::right_ui(ui, |ui| {
                ui.set_min_size(ui.available_size());
                self.note_ui(ui, pane);
                let news = news(pane).filter(|_| worst.is_none());
                mover_ui(ui, pane, worst.is_some() || news.is_some());
                kit::left_ui(ui, |ui| match worst {
                    Some(worst) => warning_ui(ui, pane, worst, &warnings),
                    None => news_ui(ui, pane, news),
                });
            });
        });
    }

    fn note_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let Some(at) = self.note_at else { return };
        let look = pane.look;
        let cancel = Button::text(look, panels::NOTE_CANCEL);
        let cancelled = cancel.ui(ui, look).clicked();
        let keep = Button::text(look, panels::NOTE_KEEP);
        let kept = keep.weight(Weight::Strong).ui(ui, look).clicked();
        let title = look.tr_with(panels::NOTE_AT, clock(at.secs(), 0.01));
        let words = kit::text_width(ui, &title, theme::body()) + theme::GAP;
        let hint = if rests(pane.hand(), pane.state.now) {
            panels::NOTE_HINT
        } else {
            panels::NOTE_HINT_MOVING
        };
        let edit = TextEdit::singleline(&mut self.note)
            .char_limit(NOTE_MAX)
            .hint_text(look.tr(hint))
            .margin(theme::FIELD_INSET)
            .desired_width((440.0 - words).max(theme::FIELD));
        let response = ui.add(edit);
        kit::named_field(&response, look.tr(panels::NOTE_FIELD), true, &self.note);
        Label::new(&title, look.palette.text).ui(ui);
        if std::mem::take(&mut self.is_new) {
            response.request_focus();
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if kept || entered {
            pane.actions
                .push(Action::Note(at, std::mem::take(&mut self.note)));
        }
        if kept || entered || cancelled {
            *self = Self::default();
        }
    }
}

/// Draws the mover's end button at the right, with its description if `is_aside`.
fn mover_ui(ui: &mut Ui, pane: &mut Pane<'_>, is_aside: bool) {
    let look = pane.look;
    let Some((words, end)) = mover(pane) else {
        return;
    };
    if let Some(end) = end {
        let button = Button::text(look, window::END);
        let name = format!("{}: {words}", look.tr(window::END));
        button.named(&name).on_click(ui, pane, end);
    }
    if is_aside {
        Label::new(&words, look.palette.text).ui(ui);
    }
}

/// Newest unread message that still applies, while it is recent. Faults have a warning and a list of their own.
fn news<'a>(pane: &Pane<'a>) -> Option<&'a Notice> {
    let now = pane.state.now;
    let recent = || {
        let all = pane.state.notices.iter();
        all.take_while(|notice| now.since(notice.at) < NEWS_DURATION)
    };
    let is_rest = |notice: &Notice| matches!(notice.what, NoticeKind::HoldConfirmed { .. });
    // After a stop of several hands, the shown one counts, whichever came to rest last.
    let slot = pane.hand().label.slot;
    let is_own = |notice: &&Notice| notice.hand.as_ref().is_none_or(|hand| hand.slot == slot);
    let own = recent().take_while(|notice| is_rest(notice)).find(is_own);
    let mut new = recent();
    let newest = new.next()?;
    let newest = own.unwrap_or(newest);
    // A confirmed hold is less important than the cause of the stop.
    let is_rest = is_rest(newest);
    let why = new.next().filter(|why| is_rest && why.level > newest.level);
    let shown = why.unwrap_or(newest);
    let moves = Mover::of(pane.hand(), pane.state.now).is_some();
    (shown.level > Level::Info || !moves).then_some(shown)
}

/// Without a warning: draws the newest message, else the mover of the hand, else that the hand is at rest.
fn news_ui(ui: &mut Ui, pane: &Pane<'_>, news: Option<&Notice>) {
    let look = pane.look;
    let palette = look.palette;
    let (words, color) = match (news, mover(pane)) {
        (Some(newest), _) => {
            let text = notices::notice_of(look, newest);
            (text, look.level(newest.level))
        }
        (None, Some((words, _))) => (words, palette.armed),
        (None, None) => {
            let words = if pane.hand().connection.status.state.is_live() {
                window::AT_REST
            } else {
                window::NO_HAND
            };
            Label::muted(look, words).ui(ui);
            return;
        }
    };
    kit::lamp_ui(ui, Some(color));
    Label::new(&words, palette.text).ui(ui);
}

/// Draws the worst warning, with the number of further ones.
fn warning_ui(ui: &mut Ui, pane: &mut Pane<'_>, worst: &Warning, all: &[Warning]) {
    let look = pane.look;
    let palette = look.palette;
    if worst.color == palette.accent {
        kit::lamp_ui(ui, Some(worst.color));
    } else {
        drop(kit::warning_ui(ui, worst.color))
    }
    kit::right_ui(ui, |ui| {
        if let Some(help) = &worst.help {
            help_ui(ui, pane, help);
        }
        for other in all.iter().skip(1).rev() {
            let label = Label::new(look.tr(other.title), other.color).ui(ui);
            label.on_hover_text(&other.body);
        }
        if !worst.aside.is_empty() {
            Label::new(&worst.aside, palette.muted).number().ui(ui);
        }
        kit::left_ui(ui, |ui| words_ui(ui, pane, worst));
    });
}

/// Draws title and sentence as far as they fit, with the whole text in the tooltip.
fn words_ui(ui: &mut Ui, pane: &Pane<'_>, warning: &Warning) {
    let look = pane.look;
    let title = Label::new(look.tr(warning.title), warning.color);
    title.large().ui(ui);
    let width = kit::text_width(ui, &warning.body, theme::body());
    let words = Label::new(&warning.body, look.palette.text);
    let is_long = width > ui.available_width();
    let words = if is_long { words.small() } else { words };
    words.ui(ui).on_hover_text(&warning.body);
}

fn help_ui(ui: &mut Ui, pane: &mut Pane<'_>, help: &Help) {
    match help {
        Help::View(view, text) => {
            let button = Button::text(pane.look, *text);
            button.navigate(ui, pane, ViewRequest::View(*view));
        }
        Help::Dismiss(id) => {
            let button = Button::text(pane.look, window::UNDERSTOOD);
            button.on_click(ui, pane, Action::Dismiss(*id));
        }
    }
}
