//! The bar at the top of the window: hand, link, the five tabs, faults, arming, and STOP. Always visible.

use crate::app::action::Action;
use crate::app::recordings::RecordingAction;
use crate::hand::kinematics::Side;
use crate::record::ArmRefusal;
use crate::record::file::RecorderStatus;
use crate::ui::connection::link_words::{self, link_words};
use crate::ui::faults::entry as fault_entry;
use crate::ui::kit::{self, Button, Label, Look, Pane, ViewRequest, Weight, format};
use crate::ui::recordings::toggle_recording;
use crate::ui::text::{inputs, main, notices, panels, recordings, window, words};
use crate::ui::theme;
use crate::ui::view::{Tab, View};
use crate::ui::window::rooms;
use egui::{Color32, Rect, Response, Ui, pos2, vec2};

/// Width of STOP, in points.
const STOP: f32 = 132.0;
/// Maximum width of the hand's name, and the minimum in a narrow window.
const NAME_MAX: f32 = 150.0;
const NAME_LEAST: f32 = 64.0;
/// Minimum width at which the lamp of the recording has a label.
const WORDS: f32 = 1000.0;
/// Width of a lamp without a label.
const LAMP_BUTTON: f32 = 24.0;

/// Draws the bar. STOP is enabled whatever card is open, the rest only if `is_free`.
pub(crate) fn header_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: View, is_free: bool) {
    let is_wide = ui.available_width() - STOP > WORDS;
    kit::right_ui(ui, |ui| {
        stop_ui(ui, pane);
        if !is_free {
            ui.disable();
        }
        match &pane.state.timeline {
            Some(line) => back_ui(ui, pane, line.live_needs_eyes),
            None => arm_ui(ui, pane, view.tab()),
        }
        rooms::menu_ui(ui, pane);
        faults_ui(ui, pane);
        recording_ui(ui, pane, is_wide);
        kit::left_ui(ui, |ui| {
            // Drawn first, so that they do not move when the hand's state changes.
            let gap = std::mem::take(&mut ui.spacing_mut().item_spacing.x);
            for tab in Tab::ALL {
                tab_ui(ui, pane, tab, view.tab() == tab);
            }
            ui.spacing_mut().item_spacing.x = gap;
            ui.add_space(theme::PAD);
            hand_ui(ui, pane);
            sharing_ui(ui, pane);
        });
    });
}

fn stop_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let button = Button::text(look, main::STOP).weight(Weight::Stop);
    let (id, rect) = ui.allocate_space(vec2(STOP, ui.available_height()));
    let response = button.ground(ui, look, rect, id);
    let strong = look.palette.on_strong;
    let (upper, lower) = rect.shrink(theme::BAR).split_top_bottom_at_fraction(0.6);
    let word = Label::new(look.tr(main::STOP), strong).center();
    word.large().paint(ui, upper);
    let keys = Label::new(look.tr(main::STOP_KEYS), strong).center();
    keys.small().paint(ui, lower);
    if kit::pressed(ui, &response) {
        pane.actions.push(Action::Stop);
    }
}

/// Draws the button that arms. It is the main action of the live tab only: other tabs have their own.
fn arm_ui(ui: &mut Ui, pane: &mut Pane<'_>, tab: Tab) {
    let look = pane.look;
    let armed = pane.hand().connection.is_armed();
    let refusal = pane.hand().arm_refusal(pane.state.now);
    let (text, name, weight) = if armed {
        (main::DISARM, main::DISARM_NAME, Weight::Armed)
    } else {
        let is_main = tab == Tab::Live;
        let weight = if is_main {
            Weight::Strong
        } else {
            Weight::Normal
        };
        (main::ARM, main::ARM_NAME, weight)
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
    let button = Button::text(look, text)
        .named(look.tr(name))
        .disabled(refusal.as_deref())
        .selected(armed)
        .weight(weight);
    let (id, rect) = ui.allocate_space(vec2(88.0, theme::CONTROL_LARGE));
    if button.put(ui, look, rect, id).clicked() {
        let action = if armed { Action::Disarm } else { Action::Arm };
        pane.actions.push(action);
    }
}

/// Draws the button that returns from a recording to the live hand, in place of the arm button.
fn back_ui(ui: &mut Ui, pane: &mut Pane<'_>, needs_eyes: bool) {
    let look = pane.look;
    let text = if needs_eyes {
        recordings::BACK_EYES
    } else {
        recordings::BACK
    };
    let button = Button::new(look.tr(text), look.tip(recordings::BACK));
    let button = button.weight(Weight::Strong).large();
    button.on_click(ui, pane, Action::Recording(RecordingAction::Close));
}

/// Recording state of this hand, and the switch for it.
fn recording_ui(ui: &mut Ui, pane: &mut Pane<'_>, is_wide: bool) {
    if pane.state.timeline.is_some() || pane.hand().connection.endpoint.is_none() {
        return;
    }
    let look = pane.look;
    let palette = look.palette;
    let hand = pane.hand();
    let (text, color, tip) = match &hand.recording {
        None => (recordings::NOT_RECORDING, palette.faint, String::new()),
        Some(recording) => {
            let status = &recording.status;
            let (text, color) = match status.trouble {
                Some(_) => (recordings::TROUBLE, palette.warn),
                None => (recordings::RECORDING, palette.bad),
            };
            (text, color, recording_words(look, status))
        }
    };
    let name = look.tr(text);
    let tip = format!("{}{tip}", look.tip(text));
    let all = [
        recordings::NOT_RECORDING,
        recordings::RECORDING,
        recordings::TROUBLE,
    ]
    .map(|text| look.tr(text));
    let (words, all) = if is_wide {
        (name, &all[..])
    } else {
        ("", &[][..])
    };
    let button = Button::new(words, &tip).named(name).weight(Weight::Quiet);
    if lamp_button_ui(ui, look, button, Some(color), all).clicked() {
        pane.actions.push(toggle_recording(hand));
    }
}

/// Status of a recording, one line per value.
fn recording_words(look: Look, status: &RecorderStatus) -> String {
    let mega = |bytes: u64| format!("{:.1}", format::giga(bytes) * 1000.0);
    let path = status.path.as_ref().map(|path| path.display().to_string());
    let rate = status.megabytes_an_hour();
    let rate = rate.map_or_else(|| "-".to_owned(), |rate| format!("{rate:.0}"));
    let mut lines = vec![
        look.fill(recordings::FILE, &[&path.unwrap_or_default()]),
        look.fill(recordings::RATE, &[&mega(status.bytes), &rate]),
    ];
    lines.extend(status.trouble.clone());
    if status.missing > 0 {
        lines.push(look.fill(recordings::MISSING, &[&status.missing]));
    }
    lines.iter().map(|line| format!("\n{line}")).collect()
}

/// A button with a lamp before its text. It is as wide as the widest of `all` texts that may stand there, so that its neighbours
/// stay where they are.
fn lamp_button_ui(
    ui: &mut Ui,
    look: Look,
    button: Button<'_>,
    lamp: Option<Color32>,
    all: &[&str],
) -> Response {
    let width = |text: &&str| kit::text_width(ui, text, theme::body());
    let widest = all.iter().map(width).fold(0.0, f32::max);
    let words = if widest > 0.0 {
        widest + theme::GAP
    } else {
        0.0
    };
    let size = vec2(words + LAMP_BUTTON, theme::CONTROL_LARGE);
    let (id, rect) = ui.allocate_space(size);
    let response = button.ground(ui, look, rect, id);
    if let Some(lamp) = lamp {
        let center = pos2(rect.left() + 12.0, rect.center().y);
        kit::lamp(ui, center, lamp);
    }
    let words = rect.with_min_x(rect.left() + 22.0);
    Label::new(button.text, look.palette.text).paint(ui, words);
    response
}

/// Button for the faults, with the number of unseen ones.
fn faults_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let title = look.tr(main::TAB_FAULTS);
    let widest = format!("{title} 99");
    let all = [widest.as_str()];
    let pressed = match fault_entry::unseen_color(pane) {
        None => {
            let button = Button::text(look, main::TAB_FAULTS).weight(Weight::Quiet);
            lamp_button_ui(ui, look, button, None, &all)
        }
        Some(color) => {
            let count = pane.hand().readings.faults.unseen().count();
            let (before, after) = (look.tr(notices::UNSEEN_BEFORE), look.tr(notices::UNSEEN));
            let name = format!("{before} {count} {after}");
            let words = format!("{title} {count}");
            let button = Button::new(&words, look.tip(notices::UNSEEN));
            lamp_button_ui(ui, look, button.named(name.trim()), Some(color), &all)
        }
    };
    if pressed.clicked() {
        pane.open(ViewRequest::Faults);
    }
}

/// Name of the hand, with state and quality of its link.
fn hand_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let all = link_words::all().map(|text| look.tr(text));
    // With several hands the strips below name each real one.
    let is_real = pane.state.timeline.is_none() && !pane.hand().connection.is_simulated();
    if !is_real || !pane.state.hands.is_several() {
        let width = |text: &&str| kit::text_width(ui, text, theme::body());
        let link = all.iter().map(width).fold(0.0, f32::max) + LAMP_BUTTON;
        let spare = ui.available_width() - link - LAMP_BUTTON - 4.0 * theme::GAP;
        badge_ui(ui, pane, spare - 2.0 * theme::GAP);
    }
    let (word, color) = link_words(pane);
    let word = look.tr(word);
    let name = format!("{}: {word}", look.tr(main::LINK_BUTTON));
    let tip = link_tip(pane);
    let button = Button::new(word, &tip).named(&name).weight(Weight::Quiet);
    if lamp_button_ui(ui, look, button, Some(color), &all).clicked() {
        pane.open(ViewRequest::View(View::Connection));
    }
    let most = format!("{} 9999", look.tr(main::ERRORS));
    let errors_width = kit::text_width(ui, &most, theme::small());
    let spare = ui.available_width() - LAMP_BUTTON - 2.0 * theme::GAP - errors_width;
    let errors = errors(pane);
    if errors > 0 && spare >= 0.0 && pane.state.timeline.is_none() {
        let words = format!("{} {errors}", look.tr(main::ERRORS));
        let label = Label::new(&words, look.palette.warn).small();
        label.ui(ui).on_hover_text(look.tip(main::ERRORS));
    }
}

/// Number of wire errors since connecting.
fn errors(pane: &Pane<'_>) -> u64 {
    let stats = &pane.hand().connection.stats;
    stats.timeouts + stats.checksum_errors + stats.resyncs + stats.foreign_replies + stats.refusals
}

/// Polling rates and error counts, one line each.
fn link_tip(pane: &Pane<'_>) -> String {
    let look = pane.look;
    let connection = &pane.hand().connection;
    let live = connection.status.state.is_live();
    let rate = |hz: f64| format::hertz(if live { hz } else { 0.0 });
    let stats = &connection.stats;
    format!(
        "{}\n{} {}, {} {}, {} {}",
        look.tr(main::LINK_TIP),
        look.tr(main::RATE_STATE),
        rate(stats.state_hz),
        look.tr(main::TAB_TOUCH),
        rate(stats.tactile_hz),
        look.tr(main::ERRORS),
        errors(pane),
    )
}

/// Badge of the built-in hand, of a recording, or with the name and side of a real hand, at most this wide; its address is in the
/// tooltip.
fn badge_ui(ui: &mut Ui, pane: &Pane<'_>, most: f32) {
    let look = pane.look;
    let palette = look.palette;
    let hand = pane.hand();
    let connection = &hand.connection;
    let simulated = connection.is_simulated();
    let recorded = pane.state.timeline.is_some();
    let (letter, side) = match hand.side {
        Side::Right => (window::SIDE_RIGHT, panels::RIGHT_HAND),
        Side::Left => (window::SIDE_LEFT, panels::LEFT_HAND),
    };
    let name = format!("{} · {}", hand.label.name, look.tr(letter));
    let (text, fill, color) = match (&connection.endpoint, simulated) {
        _ if recorded => (
            look.tr(recordings::RECORDED),
            palette.warn,
            palette.on_accent,
        ),
        (_, true) => (
            look.tr(main::SIMULATED),
            palette.simulated,
            palette.on_accent,
        ),
        (Some(_), _) => (name.as_str(), palette.control, palette.text),
        (None, _) => (look.tr(main::NO_HAND), palette.control, palette.muted),
    };
    let most = most.clamp(NAME_LEAST, NAME_MAX);
    // In a narrow window the name alone, then a small one.
    let own = hand.label.name.as_ref();
    let is_own = text == name;
    let fits = |text: &str, font| kit::text_width(ui, text, font) <= most;
    let (text, font) = if !is_own || fits(text, theme::body()) {
        (text, theme::body())
    } else if fits(own, theme::body()) {
        (own, theme::body())
    } else {
        (own, theme::small())
    };
    let width = kit::text_width(ui, text, font.clone()).min(most);
    let (_, place) = ui.allocate_space(vec2(width + 2.0 * theme::GAP, theme::CONTROL));
    ui.painter().rect_filled(place, 12.0, fill);
    let inner = place.shrink2(vec2(theme::GAP, 0.0));
    let badge = Label::new(text, color).font(font).center().put(ui, inner);
    if recorded {
        badge.on_hover_text(look.tip(recordings::RECORDED));
    } else if simulated {
        badge.on_hover_text(look.tip(main::SIMULATED));
    } else if let Some(endpoint) = &connection.endpoint {
        let tip = look.tr(main::ENDPOINT_TIP);
        badge.on_hover_text(format!("{endpoint}\n{}\n{tip}", look.tr(side)));
    }
}

/// A tab button, marked while its tab is open.
fn tab_ui(ui: &mut Ui, pane: &mut Pane<'_>, tab: Tab, is_open: bool) {
    let look = pane.look;
    let button = Button::text(look, tab.title()).weight(Weight::Quiet);
    let response = button.selected(is_open).large().ui(ui, look);
    let rect = response.rect;
    if is_open {
        let xs = rect.x_range().shrink(theme::PAD);
        let ys = rect.bottom()..=rect.bottom() + 2.0;
        let under = Rect::from_x_y_ranges(xs, ys);
        ui.painter().rect_filled(under, 1.0, look.palette.accent);
    }
    if response.clicked() {
        pane.open(ViewRequest::Tab(tab));
    }
}

/// Indicator of active inputs and servers of this hand; nothing if there are none.
fn sharing_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let open = &pane.hand().inputs;
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
    let words: Vec<&str> = words.map(|(_, text)| look.tr(*text)).collect();
    if words.is_empty() {
        return;
    }
    let name = words.join(" · ");
    let tip = format!("{name}\n{}", look.tip(inputs::SHARED));
    let width = kit::text_width(ui, &name, theme::body()) + 32.0;
    let words = if width < ui.available_width() {
        &name
    } else {
        ""
    };
    let button = Button::new(words, &tip).named(&name).weight(Weight::Quiet);
    let lamp = Some(look.palette.accent);
    if lamp_button_ui(ui, look, button, lamp, &[words]).clicked() {
        pane.open(ViewRequest::View(View::Inputs));
    }
}
