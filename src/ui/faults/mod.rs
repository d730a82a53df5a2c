//! The view that explains the hand: six drives, what is and was wrong, what to do, and the log. Clears nothing by itself.
pub(crate) mod entry;
pub(crate) mod recording_events;
pub(crate) mod recording_plot;
pub(crate) mod recordings;

use crate::app::action::Action;
use crate::app::hand::Freshness;
use crate::app::notices::{Level, Notice};
use crate::app::readings::faults::{FaultEntry, NothingToClear};
use crate::app::settings::Language;
use crate::hand::{Dof, Fault, Status, Words};
use crate::ui::faults::entry::{Depth, entry_ui, seen_all_ui};
use crate::ui::faults::recordings::RecordingsView;
use crate::ui::joints::drive_lamp::DriveWords;
use crate::ui::joints::drive_tiles;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::list::{
    INDENT, LAMP_AT, LINE, TITLE_LINE, line_ui, piece, scroll_ui, titled_text_ui, wrapped_ui,
};
use crate::ui::kit::look::Pane;
use crate::ui::text::{faults, main, notices, panels, words};
use crate::ui::theme;
use crate::ui::window::message_log::MessageLog;
use egui::{Id, Rect, Ui, pos2};

/// What the view remembers.
#[derive(Debug, Default)]
pub(crate) struct FaultsView {
    /// The joint that is asked about.
    chosen: Option<Dof>,
    section: Section,
    log: MessageLog,
    recordings: RecordingsView,
}

/// The list beside the faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Section {
    #[default]
    Log,
    Recordings,
}

/// The card of the overview: what asks for attention, and nothing else.
pub(crate) fn faults_card_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let (mut head, body) = controls::titled_card(ui, look, rect, look.say(panels::FAULTS));
    clear_ui(ui, &mut head, pane);
    scroll_ui(ui, body, "faults card", |ui, width| {
        let entries: Vec<FaultEntry> = pane.state.hand().faults.iter().copied().collect();
        let mut open = entries
            .iter()
            .filter(|entry| entry.is_active() || !entry.seen)
            .peekable();
        if open.peek().is_none() {
            none_ui(ui, width, pane);
        }
        for entry in open {
            entry_ui(ui, width, pane, entry, Depth::Short);
        }
        let rule = piece(ui, width, theme::GAP);
        let edge = egui::Stroke::new(1.0, look.palette.grid);
        ui.painter().hline(rule.x_range(), rule.top(), edge);
        if pane.state.notices.is_empty() {
            line_ui(
                ui,
                width,
                look.say(panels::MESSAGES_NONE),
                look.palette.faint,
            );
        }
        for notice in pane.state.notices.iter() {
            notice_ui(ui, width, pane, notice);
        }
    });
}

impl FaultsView {
    /// Shows what this joint says, and its faults first; of no joint, all of them alike.
    pub(crate) const fn choose(&mut self, dof: Option<Dof>) {
        self.chosen = dof;
        self.recordings.close();
    }

    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let mut rest = rect;
        let tiles = take_top(&mut rest, drive_tiles::height(rect));
        if let Some(pressed) = drive_tiles::tiles_ui(ui, tiles, pane, self.chosen) {
            self.chosen = (self.chosen != Some(pressed)).then_some(pressed);
            self.recordings.close();
        }
        if let Some(recording) = self.recordings.opened(pane) {
            self.recordings.recording_ui(ui, rest, pane, &recording);
            return;
        }
        let (left, right) = rest.split_left_right_at_fraction(0.54);
        let left = left.with_max_x(left.right() - theme::GAP / 2.0);
        let right = right.with_min_x(right.left() + theme::GAP / 2.0);
        let (mut head, body) = controls::titled_card(ui, look, left, look.say(panels::FAULTS));
        clear_ui(ui, &mut head, pane);
        seen_all_ui(ui, &mut head, pane);
        forget_ui(ui, &mut head, pane);
        scroll_ui(ui, body, "faults", |ui, width| {
            self.list_ui(ui, width, pane)
        });
        let mut body = controls::card(ui, look, right);
        self.sections_ui(ui, take_top(&mut body, theme::CONTROL), pane);
        match self.section {
            Section::Log => self.log.ui(ui, body, pane),
            Section::Recordings => self.recordings.list_ui(ui, body, pane),
        }
    }

    fn sections_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let count = pane.state.hand().recorder.iter().count();
        let recordings = match count {
            0 => look.say(faults::RECORDINGS).to_owned(),
            count => format!("{} ({count})", look.say(faults::RECORDINGS)),
        };
        for (text, section) in [
            (look.say(faults::LOG), Section::Log),
            (&recordings, Section::Recordings),
        ] {
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
            let place = take_left(&mut row, width);
            row.min.x -= theme::STEP;
            let button = Button::new(text, look.say(faults::SECTION_TIP));
            let button = button.choice(self.section == section);
            let id = Id::unique(("faults section", section == Section::Log));
            if button.put(ui, look, place, id).clicked() {
                self.section = section;
            }
        }
    }

    fn list_ui(&mut self, ui: &mut Ui, width: f32, pane: &mut Pane<'_>) {
        if let Some(dof) = self.chosen {
            if drive_ui(ui, width, pane, dof) {
                self.chosen = None;
            }
            piece(ui, width, theme::GAP);
        }
        let mut entries: Vec<FaultEntry> = pane.state.hand().faults.iter().copied().collect();
        entries.sort_by_key(|entry| self.chosen.is_some_and(|dof| entry.dof != dof));
        if entries.is_empty() {
            none_ui(ui, width, pane);
        }
        for entry in &entries {
            let depth = if self.chosen == Some(entry.dof) {
                Depth::Chosen
            } else {
                Depth::Whole
            };
            if let Some(id) = entry_ui(ui, width, pane, entry, depth) {
                self.recordings.open(id, pane);
            }
        }
        meanings_ui(ui, width, pane);
    }
}

fn clear_ui(ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let text = look.say(panels::CLEAR);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let place = take_right(head, width);
    let state = pane.state;
    let reason = match state.hand().faults.nothing_to_clear() {
        _ if !state.hand().link.state.is_live() => Some(panels::NOT_LIVE),
        _ if state.hand().sample.faults.is_none() => Some(faults::CLEAR_UNREAD),
        Some(NothingToClear::NoFault) => Some(faults::CLEAR_NO_FAULT),
        Some(NothingToClear::OnlyHeat) => Some(faults::CLEAR_ONLY_HEAT),
        None => None,
    };
    let button = Button::new(text, look.say(panels::CLEAR_TIP))
        .disabled(reason.map(|reason| look.say(reason)));
    if button
        .put(ui, look, place, Id::unique("clear errors"))
        .clicked()
    {
        pane.actions.push(Action::ClearErrors);
    }
}

fn forget_ui(ui: &mut Ui, head: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let text = look.say(faults::FORGET);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    if width > head.width() {
        return;
    }
    let place = take_right(head, width);
    let any = pane
        .state
        .hand()
        .faults
        .iter()
        .any(|entry| !entry.is_active() && entry.seen);
    let button = Button::new(text, look.say(faults::FORGET_TIP))
        .weight(Weight::Quiet)
        .disabled((!any).then(|| look.say(faults::FORGET_NONE)));
    if button
        .put(ui, look, place, Id::unique("forget faults"))
        .clicked()
    {
        pane.actions.push(Action::ForgetFaults);
    }
}

/// That nothing is wrong, or that nobody knows.
fn none_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>) {
    let look = pane.look;
    let asked = pane.state.hand().sample.faults.map(|faults| faults.asked);
    let (text, color) = match pane.freshness(asked) {
        Freshness::Live => (panels::FAULTS_NONE, look.palette.ok),
        Freshness::Stale => (panels::FAULTS_NONE_OLD, look.palette.faint),
        Freshness::Unknown => (panels::FAULTS_UNKNOWN, look.palette.faint),
    };
    let place = piece(ui, width, TITLE_LINE);
    controls::lamp(ui, pos2(place.left() + LAMP_AT, place.center().y), color);
    let place = place.with_min_x(place.left() + INDENT);
    Label::new(look.say(text), look.palette.muted).put(ui, place);
    let hint = look.say(panels::FAULTS_NONE_HINT);
    wrapped_ui(ui, width, INDENT, hint, look.palette.faint);
    piece(ui, width, theme::GAP);
}

/// What the chosen drive says, explained. True if it was enough of it.
fn drive_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, dof: Dof) -> bool {
    let look = pane.look;
    let palette = look.palette;
    let said = DriveWords::of(pane, dof);
    let mut row = piece(ui, width, theme::CONTROL);
    let text = look.say(faults::CHOSEN_CLOSE);
    let button_width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::GAP;
    let place = take_right(&mut row, button_width);
    let button = Button::new(text, look.say(faults::DRIVE_TIP)).weight(Weight::Quiet);
    let closed = button
        .put(ui, look, place, Id::unique("all drives"))
        .clicked();
    controls::lamp(ui, pos2(row.left() + LAMP_AT, row.center().y), said.lamp);
    let row = row.with_min_x(row.left() + INDENT);
    let verb = if said.freshness == Freshness::Live {
        faults::SAYS_NOW
    } else {
        faults::SAID_LAST
    };
    let joint = look.say(words::dof(dof));
    let title = format!("{joint} · {}: {}", look.say(verb), said.title);
    Label::new(&title, palette.text).put(ui, row);
    let status = pane
        .state
        .hand()
        .sample
        .status
        .map(|group| group.value[dof]);
    // A fault is explained by its entry below; what the status adds to it is said here.
    let faulty = pane
        .state
        .hand()
        .sample
        .faults
        .is_some_and(|group| !group.value[dof].is_empty());
    if let Some(status) = status.filter(|status| !(faulty && status.is_protective())) {
        let words = words::status(status, look.language);
        wrapped_ui(ui, width, INDENT, words.cause, palette.muted);
        let advice = format!("{} {}", look.say(faults::TODO), words.advice);
        wrapped_ui(ui, width, INDENT, &advice, palette.text);
    }
    closed
}

/// Every code and bit of the manual in words, for those who meet them for the first time.
fn meanings_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>) {
    let look = pane.look;
    let rule = piece(ui, width, theme::GAP);
    let edge = egui::Stroke::new(1.0, look.palette.grid);
    ui.painter().hline(rule.x_range(), rule.top(), edge);
    let place = piece(ui, width, theme::CONTROL);
    Label::new(look.say(faults::MEANINGS), look.palette.text)
        .font(theme::title())
        .put(ui, place);
    line_ui(
        ui,
        width,
        look.say(faults::MEANINGS_FAULT),
        look.palette.faint,
    );
    for bit in 0..5 {
        let words = words::fault(Fault::from_bit(bit), look.language);
        meaning_ui(ui, width, pane, words);
    }
    line_ui(
        ui,
        width,
        look.say(faults::MEANINGS_STATUS),
        look.palette.faint,
    );
    for code in [0, 1, 2, 3, 5, 6, 7] {
        let words = words::status(Status::from_raw(code), look.language);
        meaning_ui(ui, width, pane, words);
    }
}

fn meaning_ui(ui: &mut Ui, width: f32, pane: &Pane<'_>, words: Words) {
    let palette = pane.look.palette;
    let sep = match pane.look.language {
        Language::En => ": ",
        Language::Zh => "：",
    };
    let space = match pane.look.language {
        Language::En => " ",
        Language::Zh => "",
    };
    let body = format!("{}{space}{}", words.cause, words.advice);
    let title = format!("{}{sep}", words.title);
    titled_text_ui(ui, width, (&title, palette.text), (&body, palette.muted));
    piece(ui, width, theme::STEP);
}

fn notice_ui(ui: &mut Ui, width: f32, pane: &mut Pane<'_>, notice: &Notice) {
    let look = pane.look;
    let palette = look.palette;
    let color = match notice.level {
        Level::Info => palette.accent,
        Level::Warn => palette.warn,
        Level::Alarm => palette.bad,
    };
    let mut text = notices::notice(look, &notice.what);
    if notice.count > 1 {
        text = format!("{text} ({} ×)", notice.count);
    }
    // Lamp, age and cross stand beside the text, whatever lines it needs.
    let aside = theme::SMALL_BUTTON + theme::MESSAGE_AGE_SHORT + 2.0 * theme::GAP;
    let galley = ui.painter().layout(
        text.clone(),
        theme::small(),
        palette.text,
        (width - INDENT - aside).max(theme::MESSAGE_LEAST),
    );
    let place = piece(
        ui,
        width,
        (galley.size().y + theme::MESSAGE_MARGIN).max(LINE + theme::MESSAGE_LEAD),
    );
    let mut row = place.with_max_y(place.top() + LINE + theme::MESSAGE_LEAD);
    controls::lamp(ui, pos2(row.left() + LAMP_AT, row.center().y), color);
    let response = ui.interact(
        place,
        Id::unique(("notice", notice.id)),
        egui::Sense::hover(),
    );
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
    ui.painter().galley(
        pos2(row.left() + INDENT, row.top() + theme::MESSAGE_TEXT_TOP),
        galley,
        palette.text,
    );
    let close = controls::middle(
        take_right(&mut row, theme::SMALL_BUTTON),
        theme::SMALL_BUTTON,
    );
    let name = format!("{}: {text}", look.say(main::DISMISS));
    let button = Button::new(look.say(main::DISMISS), look.say(main::DISMISS_TIP))
        .icon(theme::CLOSE)
        .named(&name)
        .weight(Weight::Quiet);
    let id = Id::unique(("dismiss", notice.id));
    if button.put(ui, look, close, id).clicked() {
        pane.actions.push(Action::Dismiss(notice.id));
    }
    let age = format::age(pane.state.now.since(notice.at));
    let place = take_right(&mut row, theme::MESSAGE_AGE_SHORT);
    Label::new(&age, palette.faint)
        .small()
        .right()
        .put(ui, place);
}
