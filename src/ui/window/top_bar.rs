//! The bar that is always there: which hand, how the link is, arm, and STOP. Also the row of tabs below it.

use crate::app::action::Action;
use crate::app::settings::{Language, Theme};
use crate::ui::connection::link_words::link_words;
use crate::ui::faults::entry as fault_entry;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right};
use crate::ui::kit::format;
use crate::ui::kit::look::{Explain, Look, Pane};
use crate::ui::text::{Text, faults, keys, main, words};
use crate::ui::theme;
use crate::ui::view::View;
use crate::ui::window::menu as window_menu;
use egui::{Align2, Color32, CornerRadius, Id, Rect, Stroke, Ui, pos2, vec2};

/// Width of STOP.
const STOP_WIDTH: f32 = theme::STOP_WIDTH;
/// Width of Arm.
const ARM_WIDTH: f32 = theme::ARM_WIDTH;

/// Draws the ground of the bar and STOP; the place of everything else. STOP can be pressed whatever card is open.
pub(crate) fn stop_first_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) -> Rect {
    let palette = pane.look.palette;
    ui.painter()
        .rect_filled(rect, CornerRadius::ZERO, palette.card);
    let edge = Stroke::new(1.0, palette.edge);
    ui.painter()
        .hline(rect.x_range(), rect.bottom() - 0.5, edge);
    let mut rest = rect.shrink2(vec2(theme::PAD, theme::GAP));
    stop_ui(ui, take_right(&mut rest, STOP_WIDTH), pane);
    rest.max.x -= theme::STEP;
    rest
}

/// Draws the rest of the bar. True if the connection was asked for.
pub(crate) fn top_bar_ui(ui: &mut Ui, mut rest: Rect, pane: &mut Pane<'_>) -> bool {
    arm_ui(ui, take_right(&mut rest, ARM_WIDTH), pane);
    rest.max.x -= theme::STEP;
    unseen_ui(ui, &mut rest, pane);
    badge_ui(ui, &mut rest, pane);
    let asked = link_ui(ui, &mut rest, pane);
    figures_ui(ui, rest, pane);
    asked
}

fn stop_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let button =
        Button::new(pane.look.say(main::STOP), pane.look.say(main::STOP_TIP)).weight(Weight::Stop);
    let response = button.ground(ui, pane.look, rect, Id::unique("stop"));
    let (center, strong) = (Align2::CENTER_CENTER, pane.look.palette.on_strong);
    let (upper, lower) = rect.shrink(theme::BAR).split_top_bottom_at_fraction(0.62);
    let word = pane.look.say(main::STOP);
    controls::paint_text(ui, upper, center, word, theme::large(), strong);
    let keys = pane.look.say(main::STOP_KEYS);
    let weak = strong.gamma_multiply(0.82);
    controls::paint_text(ui, lower, center, keys, theme::tiny(), weak);
    if controls::pressed(ui, &response) {
        pane.actions.push(Action::Stop);
    }
}

fn arm_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let armed = pane.state.hand().is_armed();
    let refusal = pane
        .state
        .hand()
        .arm_refusal()
        .map(|reason| words::refusal(look, reason));
    let (text, name, tip) = if armed {
        (main::DISARM, main::DISARM_NAME, main::DISARM_TIP)
    } else {
        (main::ARM, main::ARM_NAME, main::ARM_TIP)
    };
    let mut button = Button::new(look.say(text), look.say(tip))
        .named(look.say(name))
        .disabled(refusal.as_deref())
        .weight(if armed { Weight::Armed } else { Weight::Strong });
    button.selected = Some(armed);
    let place = controls::middle(rect, theme::CONTROL_LARGE);
    if button.put(ui, look, place, Id::unique("arm")).clicked() {
        pane.actions
            .push(if armed { Action::Disarm } else { Action::Arm });
    }
}

/// How many faults nobody has seen yet, from every view; a click opens them.
fn unseen_ui(ui: &mut Ui, rest: &mut Rect, pane: &mut Pane<'_>) {
    let Some(color) = fault_entry::unseen_color(pane) else {
        return;
    };
    let look = pane.look;
    let count = pane.state.hand().faults.unseen().count();
    let (before, after) = (look.say(faults::UNSEEN_BEFORE), look.say(faults::UNSEEN));
    let text = format!("{before} {count} {after}");
    let width = controls::text_width(ui, &text, theme::body()) + theme::LAMP_BUTTON;
    let place = controls::middle(take_right(rest, width), theme::CONTROL_LARGE);
    let button = Button::new(&text, look.say(faults::UNSEEN_TIP));
    let response = button.ground(ui, look, place, Id::unique("unseen faults"));
    fault_entry::mark(
        ui,
        pos2(place.left() + theme::LAMP_IN_BUTTON, place.center().y),
        color,
    );
    let words = place.with_min_x(place.left() + theme::WORDS_IN_BUTTON);
    let (font, align) = (theme::body(), Align2::LEFT_CENTER);
    controls::paint_text(ui, words, align, &text, font, look.palette.text);
    if response.clicked() {
        *pane.explain = Some(Explain::Faults);
    }
}

/// The badge of the built-in hand, or where the real one is.
fn badge_ui(ui: &mut Ui, rest: &mut Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let palette = look.palette;
    let simulated = pane.state.hand().is_simulated();
    let (text, fill, color) = match (&pane.state.hand().endpoint, simulated) {
        (_, true) => (main::SIMULATED, palette.simulated, palette.on_simulated),
        (Some(_), _) => (main::REAL_HAND, palette.control, palette.text),
        (None, _) => (main::NO_HAND, palette.control, palette.muted),
    };
    let text = look.say(text);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let place = controls::middle(take_left(rest, width), theme::CONTROL);
    ui.painter()
        .rect_filled(place, CornerRadius::same(theme::ROUND_PILL), fill);
    let label = Label::new(text, color).center().put(ui, place);
    if simulated {
        label.on_hover_text(look.say(main::SIMULATED_TIP));
    }
    rest.min.x += theme::STEP;
    if let (Some(endpoint), false) = (&pane.state.hand().endpoint, simulated) {
        let text = endpoint.to_string();
        let wanted = controls::text_width(ui, &text, theme::number()) + 1.0;
        let place = take_left(rest, wanted.min(rest.width() * 0.4));
        Label::new(&text, palette.muted)
            .number()
            .put(ui, place)
            .on_hover_text(format!("{text}\n{}", look.say(main::ENDPOINT_TIP)));
        rest.min.x += theme::STEP;
    }
}

fn link_ui(ui: &mut Ui, rest: &mut Rect, pane: &Pane<'_>) -> bool {
    let look = pane.look;
    let (word, color) = link_words(pane);
    let word = look.say(word);
    let width = controls::text_width(ui, word, theme::body()) + theme::LAMP_BUTTON;
    let place = controls::middle(
        take_left(rest, width.max(theme::LINK_LEAST)),
        theme::CONTROL_LARGE,
    );
    let name = format!("{}: {word}", look.say(main::LINK_BUTTON));
    let button = Button::new(word, look.say(main::LINK_TIP))
        .named(&name)
        .weight(Weight::Quiet);
    let response = button.ground(ui, look, place, Id::unique("link"));
    controls::lamp(
        ui,
        pos2(place.left() + theme::LAMP_IN_BUTTON, place.center().y),
        color,
    );
    let text = place.with_min_x(place.left() + theme::WORDS_IN_BUTTON);
    let (text_color, align) = (look.palette.text, Align2::LEFT_CENTER);
    controls::paint_text(ui, text, align, word, theme::body(), text_color);
    response.clicked()
}

/// One figure: a small caption over a number.
struct Figure<'a> {
    caption: Text,
    value: String,
    tip: Text,
    color: Color32,
    widest: &'a str,
}

fn figures_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
    let palette = pane.look.palette;
    let stats = &pane.state.hand().stats;
    let live = pane.state.hand().link.state.is_live();
    let color = if live { palette.text } else { palette.faint };
    let errors = stats.timeouts
        + stats.checksum_errors
        + stats.resyncs
        + stats.foreign_replies
        + stats.refusals;
    let (p50, p99) = (
        format::millis(stats.rtt_p50.filter(|_| live)),
        format::millis(stats.rtt_p99.filter(|_| live)),
    );
    let rate = |hz: f64| format::hertz(if live { hz } else { 0.0 });
    let figures = [
        Figure {
            caption: main::RATE_STATE,
            value: rate(stats.state_hz),
            tip: main::RATES_TIP,
            color,
            widest: "0000 Hz",
        },
        Figure {
            caption: main::RATE_TACTILE,
            value: rate(stats.tactile_hz),
            tip: main::RATES_TIP,
            color,
            widest: "0000 Hz",
        },
        Figure {
            caption: main::ROUND_TRIP,
            value: format!("{p50} / {p99} ms"),
            tip: main::ROUND_TRIP_TIP,
            color,
            widest: "00.0 / 000.0 ms",
        },
        Figure {
            caption: main::ERRORS,
            value: errors.to_string(),
            tip: main::ERRORS_TIP,
            color: if errors > 0 { palette.warn } else { color },
            widest: "00000",
        },
    ];
    let mut rest = rect.with_min_x(rect.left() + theme::STEP);
    for figure in figures {
        let width = controls::text_width(ui, figure.widest, theme::number()) + theme::STEP;
        if rest.width() < width {
            break;
        }
        figure_ui(ui, take_left(&mut rest, width), pane.look, &figure);
        rest.min.x += theme::STEP;
    }
}

fn figure_ui(ui: &mut Ui, place: Rect, look: Look, figure: &Figure<'_>) {
    let place = controls::middle(place, theme::FIGURE);
    let (top, bottom) = place.split_top_bottom_at_fraction(0.47);
    let caption = look.say(figure.caption);
    Label::new(caption, look.palette.muted).small().put(ui, top);
    Label::new(&figure.value, figure.color)
        .number()
        .named(caption)
        .put(ui, bottom)
        .on_hover_text(look.say(figure.tip));
}

/// Draws the row of tabs, and the switches for theme and language. True if the list of keys was asked for.
pub(crate) fn tabs_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, view: &mut View) -> bool {
    let look = pane.look;
    let mut rest = rect.shrink2(vec2(theme::PAD, 0.0));
    let menu = take_right(&mut rest, theme::ICON_BUTTON);
    window_menu::menu_button_ui(ui, controls::middle(menu, theme::CONTROL), pane);
    language_ui(ui, take_right(&mut rest, theme::LANGUAGE), pane);
    theme_ui(ui, take_right(&mut rest, theme::ICON_BUTTON), pane);
    let place = controls::middle(take_right(&mut rest, theme::ICON_BUTTON), theme::CONTROL);
    let list = Button::new("?", look.say(keys::BUTTON_TIP))
        .named(look.say(keys::BUTTON))
        .weight(Weight::Quiet);
    let list = list.put(ui, look, place, Id::unique("keys")).clicked();
    for tab in View::ALL {
        let text = look.say(tab.title());
        let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
        let place = controls::middle(take_left(&mut rest, width), theme::CONTROL);
        rest.min.x -= theme::STEP;
        let mut button = Button::new(text, look.say(main::TAB_TIP)).weight(Weight::Quiet);
        button.selected = Some(tab == *view);
        let response = button.ground(ui, look, place, Id::unique(("tab", tab.name())));
        let color = if tab == *view {
            look.palette.text
        } else {
            look.palette.muted
        };
        controls::paint_text(ui, place, Align2::CENTER_CENTER, text, theme::body(), color);
        if tab == *view {
            let under = Rect::from_min_max(
                pos2(place.left() + theme::PAD, rect.bottom() - theme::STEP),
                pos2(place.right() - theme::PAD, rect.bottom() - 2.0),
            );
            ui.painter()
                .rect_filled(under, CornerRadius::same(1), look.palette.accent);
        }
        if tab == View::Faults {
            fault_entry::badge_ui(ui, place.right_top() + vec2(2.0, -2.0), pane);
        }
        if response.clicked() {
            *view = tab;
        }
    }
    list
}

fn theme_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let now = pane.state.settings.theme;
    let icon = match now {
        Theme::Dark => theme::DARK,
        Theme::Light => theme::LIGHT,
    };
    let button = Button::new(
        pane.look.say(main::THEME_NAME),
        pane.look.say(main::THEME_TIP),
    )
    .icon(icon)
    .named(pane.look.say(main::THEME_NAME))
    .weight(Weight::Quiet);
    let place = controls::middle(rect, theme::CONTROL);
    if button
        .put(ui, pane.look, place, Id::unique("theme"))
        .clicked()
    {
        pane.actions.push(Action::Theme(now.other()));
    }
}

fn language_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let now = pane.state.settings.language;
    let text = match now {
        Language::En => "中文",
        Language::Zh => "English",
    };
    let button = Button::new(text, pane.look.say(main::LANGUAGE_TIP))
        .named(pane.look.say(main::LANGUAGE_NAME))
        .weight(Weight::Quiet);
    let place = controls::middle(rect, theme::CONTROL);
    if button
        .put(ui, pane.look, place, Id::unique("language"))
        .clicked()
    {
        pane.actions.push(Action::Language(now.other()));
    }
}
