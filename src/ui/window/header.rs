//! The bar that is always there: which hand, how the link is, arm, and STOP. Also the row of tabs.

use crate::app::action::Action;
use crate::app::sessions::SessionAction;
use crate::app::settings::{Language, Theme};
use crate::record::ArmRefusal;
use crate::record::file::RecorderStatus;
use crate::ui::connection::link_words::link_words;
use crate::ui::faults::entry as fault_entry;
use crate::ui::kit::{self, Button, Label, Look, Pane, ViewRequest, Weight, format};
use crate::ui::text::{Text, inputs, main, notices, sessions, window, words};
use crate::ui::theme;
use crate::ui::view::View;
use crate::ui::window::rooms;
use egui::{Align, Color32, CornerRadius, Layout, Rect, Response, Ui, pos2, vec2};

/// Draws the bar. STOP can be pressed whatever card is open, the rest only if `is_free`. True if the connection was asked for.
pub(crate) fn header_ui(ui: &mut Ui, pane: &mut Pane<'_>, is_free: bool) {
    kit::right_ui(ui, |ui| {
        stop_ui(ui, pane);
        if !is_free {
            ui.disable();
        }
        ui.add_space(theme::STEP);
        match &pane.state.timeline {
            Some(line) => back_ui(ui, pane, line.live_needs_eyes),
            None => arm_ui(ui, pane),
        }
        unseen_ui(ui, pane);
        kit::left_ui(ui, |ui| {
            badge_ui(ui, pane);
            link_ui(ui, pane);
            sharing_ui(ui, pane);
            recording_ui(ui, pane);
            figures_ui(ui, pane);
        });
    });
}

fn stop_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let button = Button::said(look, main::STOP).weight(Weight::Stop);
    let (id, rect) = ui.allocate_space(vec2(148.0, ui.available_height()));
    let response = button.ground(ui, look, rect, id);
    let strong = look.palette.on_strong;
    let (upper, lower) = rect.shrink(theme::BAR).split_top_bottom_at_fraction(0.6);
    let word = Label::new(look.say(main::STOP), strong).center();
    word.font(theme::large()).paint(ui, upper);
    let keys = Label::new(look.say(main::STOP_KEYS), strong).center();
    keys.small().paint(ui, lower);
    if kit::pressed(ui, &response) {
        pane.actions.push(Action::Stop);
    }
}

fn arm_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let armed = pane.state.hand().connection.is_armed();
    let refusal = pane.state.hand().arm_refusal(pane.state.now);
    let (text, name, weight) = if armed {
        (main::DISARM, main::DISARM_NAME, Weight::Armed)
    } else {
        (main::ARM, main::ARM_NAME, Weight::Strong)
    };
    let (text, name, refusal) = match refusal {
        // Only the key arms: a press here would be refused.
        Some(ArmRefusal::LetGo) => {
            let why = look.tip(main::HOLD_KEY).to_owned();
            (main::HOLD_KEY, main::HOLD_KEY, Some(why))
        }
        refusal => {
            let why = refusal.map(|reason| words::refusal(look, reason));
            (text, name, why)
        }
    };
    let button = Button::said(look, text)
        .named(look.say(name))
        .disabled(refusal.as_deref())
        .selected(armed)
        .weight(weight);
    let (id, rect) = ui.allocate_space(vec2(96.0, theme::CONTROL_LARGE));
    if button.put(ui, look, rect, id).clicked() {
        let action = if armed { Action::Disarm } else { Action::Arm };
        pane.actions.push(action);
    }
}

/// The way back from a recording, where arming is otherwise.
fn back_ui(ui: &mut Ui, pane: &mut Pane<'_>, needs_eyes: bool) {
    let look = pane.look;
    let text = if needs_eyes {
        sessions::BACK_EYES
    } else {
        sessions::BACK
    };
    let button = Button::new(look.say(text), look.tip(sessions::BACK));
    let button = button.weight(Weight::Strong).large();
    button.on_click(ui, pane, Action::Session(SessionAction::Close));
}

/// Whether this hand is recorded, and the switch for it.
fn recording_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    if pane.state.timeline.is_some() || pane.state.hand().connection.endpoint.is_none() {
        return;
    }
    let look = pane.look;
    let palette = look.palette;
    let simulated = pane.state.hand().connection.is_simulated();
    let (text, color, tip) = match &pane.state.hand().recording {
        None => (sessions::NOT_RECORDING, palette.faint, String::new()),
        Some(recording) => {
            let status = &recording.status;
            let (text, color) = match status.trouble {
                Some(_) => (sessions::TROUBLE, palette.warn),
                None => (sessions::RECORDING, palette.bad),
            };
            (text, color, recording_words(look, status))
        }
    };
    if ui.available_width() < RECORDING_LEAST {
        return;
    }
    let tip = format!("{}{tip}", look.tip(text));
    let button = Button::new(look.say(text), &tip).weight(Weight::Quiet);
    if lamp_button_ui(ui, look, button, color).clicked() {
        let on = pane.state.hand().recording.is_none();
        let action = if simulated {
            SessionAction::RecordSimulated(on)
        } else {
            SessionAction::Record(on)
        };
        pane.actions.push(Action::Session(action));
    }
}

/// How a recording goes, a line each.
fn recording_words(look: Look, status: &RecorderStatus) -> String {
    let mega = |bytes: u64| format!("{:.1}", format::giga(bytes) * 1000.0);
    let path = status.path.as_ref().map(|path| path.display().to_string());
    let rate = status.megabytes_an_hour();
    let rate = rate.map_or_else(|| "-".to_owned(), |rate| format!("{rate:.0}"));
    let mut lines = vec![
        look.fill(sessions::FILE, &[&path.unwrap_or_default()]),
        look.fill(sessions::RATE, &[&mega(status.bytes), &rate]),
    ];
    lines.extend(status.trouble.clone());
    if status.missing > 0 {
        lines.push(look.fill(sessions::MISSING, &[&status.missing]));
    }
    lines.iter().map(|line| format!("\n{line}")).collect()
}

/// Room that the lamp of the recording needs.
const RECORDING_LEAST: f32 = 170.0;

/// A button with a lamp before its words.
fn lamp_button_ui(ui: &mut Ui, look: Look, button: Button<'_>, lamp: Color32) -> Response {
    let words = kit::text_width(ui, button.text, theme::body());
    let size = vec2(words + 40.0, theme::CONTROL_LARGE);
    let (id, rect) = ui.allocate_space(size);
    let response = button.ground(ui, look, rect, id);
    let center = pos2(rect.left() + 16.0, rect.center().y);
    kit::lamp(ui, center, lamp);
    let words = rect.with_min_x(rect.left() + 29.0);
    Label::new(button.text, look.palette.text).paint(ui, words);
    response
}

/// How many faults nobody has seen yet, from every view; a click opens them.
fn unseen_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let Some(color) = fault_entry::unseen_color(pane) else {
        return;
    };
    let look = pane.look;
    let count = pane.state.hand().readings.faults.unseen().count();
    let (before, after) = (look.say(notices::UNSEEN_BEFORE), look.say(notices::UNSEEN));
    let text = format!("{before} {count} {after}");
    let button = Button::new(text.trim(), look.tip(notices::UNSEEN));
    if lamp_button_ui(ui, look, button, color).clicked() {
        pane.open(ViewRequest::Faults);
    }
}

/// The badge of the built-in hand, or where the real one is.
fn badge_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let palette = look.palette;
    let simulated = pane.state.hand().connection.is_simulated();
    let recorded = pane.state.timeline.is_some();
    let (text, fill, color) = match (&pane.state.hand().connection.endpoint, simulated) {
        _ if recorded => (sessions::RECORDED, palette.warn, palette.on_accent),
        (_, true) => (main::SIMULATED, palette.simulated, palette.on_accent),
        (Some(_), _) => (main::REAL_HAND, palette.control, palette.text),
        (None, _) => (main::NO_HAND, palette.control, palette.muted),
    };
    let text = look.say(text);
    let width = kit::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let (_, place) = ui.allocate_space(vec2(width, theme::CONTROL));
    ui.painter().rect_filled(place, 12.0, fill);
    let badge = Label::new(text, color).center().put(ui, place);
    if recorded {
        badge.on_hover_text(look.tip(sessions::RECORDED));
    } else if simulated {
        badge.on_hover_text(look.tip(main::SIMULATED));
    }
    if let (Some(endpoint), false) = (&pane.state.hand().connection.endpoint, simulated) {
        let text = endpoint.to_string();
        let most = ui.available_width() * 0.5;
        let width = kit::text_width(ui, &text, theme::number()) + 1.0;
        ui.scope(|ui| {
            ui.set_max_width(width.min(most));
            let label = Label::new(&text, palette.muted).number();
            label.ui(ui)
        })
        .inner
        .on_hover_text(format!("{text}\n{}", look.say(main::ENDPOINT_TIP)));
    }
}

fn link_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let (word, color) = link_words(pane);
    let word = look.say(word);
    let name = format!("{}: {word}", look.say(main::LINK_BUTTON));
    let button = Button::new(word, look.say(main::LINK_TIP))
        .named(&name)
        .weight(Weight::Quiet);
    if lamp_button_ui(ui, look, button, color).clicked() {
        pane.open(ViewRequest::View(View::Connection));
    }
}

/// What listens to others or serves them, as long as it does.
fn sharing_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let open = &pane.state.hand().inputs;
    let parts = [
        (
            open.gateway_at.is_some() || open.foxglove_at.is_some(),
            inputs::SHARED,
        ),
        (open.dds_view.is_some(), inputs::DDS),
        (open.stream_at.is_some(), inputs::LISTENING),
        (open.pad_view.is_some(), inputs::PAD),
    ];
    let words = parts.iter().filter(|(is_open, _)| *is_open);
    let words: Vec<&str> = words.map(|(_, text)| look.say(*text)).collect();
    if words.is_empty() {
        return;
    }
    let words = words.join(" · ");
    let button = Button::new(&words, look.tip(inputs::SHARED)).weight(Weight::Quiet);
    if lamp_button_ui(ui, look, button, look.palette.accent).clicked() {
        pane.open(ViewRequest::View(View::Inputs));
    }
}

/// How often is read, and what went wrong: each a small caption over a number, as many as there is room for.
fn figures_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let palette = look.palette;
    let stats = &pane.state.hand().connection.stats;
    let live = pane.state.hand().connection.status.state.is_live();
    let color = if live { palette.text } else { palette.faint };
    let errors = stats.timeouts
        + stats.checksum_errors
        + stats.resyncs
        + stats.foreign_replies
        + stats.refusals;
    let rate = |hz: f64| format::hertz(if live { hz } else { 0.0 });
    let error_color = if errors > 0 { palette.warn } else { color };
    let (state, touch) = (rate(stats.state_hz), rate(stats.tactile_hz));
    let figures: [(Text, String, Text, Color32); 3] = [
        (main::RATE_STATE, state, main::RATES_TIP, color),
        (main::TAB_TOUCH, touch, main::RATES_TIP, color),
        (
            main::ERRORS,
            errors.to_string(),
            main::ERRORS.tip(),
            error_color,
        ),
    ];
    for (caption, value, tip, color) in figures {
        if ui.available_width() < FIGURE {
            return;
        }
        let (size, down) = (vec2(FIGURE, 34.0), Layout::top_down(Align::Min));
        ui.allocate_ui_with_layout(size, down, |ui| {
            ui.set_width(FIGURE);
            ui.spacing_mut().item_spacing.y = 0.0;
            let caption = look.say(caption);
            Label::new(caption, palette.muted).small().ui(ui);
            let number = Label::new(&value, color).number().named(caption);
            number.ui(ui).on_hover_text(look.say(tip));
        });
    }
}

/// Room for a figure.
const FIGURE: f32 = 64.0;

/// Draws the row of tabs, and the switches for theme and language. True if the list of keys was asked for.
pub(crate) fn tabs_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: View) {
    let look = pane.look;
    kit::right_ui(ui, |ui| {
        rooms::menu_ui(ui, pane);
        let (theme, language) = (pane.state.settings.theme, pane.state.settings.language);
        let text = match language {
            Language::En => "中文",
            Language::Zh => "English",
        };
        let button = Button::new(text, look.say(main::LANGUAGE_TIP))
            .named(look.say(main::LANGUAGE_NAME))
            .weight(Weight::Quiet);
        button.on_click(ui, pane, Action::Language(language.other()));
        let icon = match theme {
            Theme::Dark => theme::DARK,
            Theme::Light => theme::LIGHT,
        };
        let button = Button::new(look.say(main::THEME_NAME), look.say(main::THEME_TIP))
            .icon(icon)
            .weight(Weight::Quiet);
        button.on_click(ui, pane, Action::Theme(theme.other()));
        let list = Button::new("?", look.tip(window::KEYS))
            .named(look.say(window::KEYS))
            .weight(Weight::Quiet);
        if list.ui(ui, look).clicked() {
            pane.open(ViewRequest::Keys);
        }
        kit::left_ui(ui, |ui| {
            ui.spacing_mut().item_spacing.x = theme::STEP;
            for tab in View::ALL {
                tab_ui(ui, pane, tab, tab == view);
            }
        });
    });
}

fn tab_ui(ui: &mut Ui, pane: &mut Pane<'_>, tab: View, is_open: bool) {
    let look = pane.look;
    let button = Button::said(look, tab.title()).weight(Weight::Quiet);
    let button = button.selected(is_open);
    let response = button.ui(ui, look);
    let place = response.rect;
    if is_open {
        let under = Rect::from_min_max(
            place.left_bottom() + vec2(theme::PAD, 0.0),
            place.right_bottom() + vec2(-theme::PAD, 2.0),
        );
        let round = CornerRadius::same(1);
        ui.painter().rect_filled(under, round, look.palette.accent);
    }
    if tab == View::Faults {
        fault_entry::badge_ui(ui, place.right_top() + vec2(2.0, -2.0), pane);
    }
    if response.clicked() {
        pane.open(ViewRequest::View(tab));
    }
}
