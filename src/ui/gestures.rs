//! The stored gestures as tiles, how they are started, and the names a person gives them. Starts nothing by itself.

use crate::app::action::Action;
use crate::hand::{Gesture, GestureRoute};
use crate::ui::controls::{self, Button, Label, Weight, take_right};
use crate::ui::look::{Look, Pane};
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::{Id, Rect, TextEdit, Ui, UiBuilder, pos2, vec2};

/// The last of the gestures that cannot be changed (manual 2.6.7).
const LAST_FIXED: u8 = 13;
/// Height of the overview from which its tiles are large enough for names.
const ROOMY: f32 = 640.0;
/// Width of a tile from which a name can be read and typed in it.
const NAMED: f32 = 48.0;
/// Characters that a name may have.
const NAME_MAX: usize = 24;

/// What the gestures need between frames.
#[derive(Debug, Default)]
pub(crate) struct GestureView {
    /// True while names are typed instead of gestures started.
    naming: bool,
    /// The name being typed, and of which gesture.
    typed: Option<(Gesture, String)>,
}

/// All gesture numbers.
fn all() -> impl Iterator<Item = Gesture> {
    (Gesture::MIN.get()..=Gesture::MAX.get()).map(Gesture::nearest)
}

/// Why no gesture can be started now.
fn refusal(pane: &Pane<'_>) -> Option<&'static str> {
    if pane.state.settings.gesture_route == GestureRoute::Off {
        return Some(pane.look.say(panels::GESTURES_OFF));
    }
    (!pane.state.is_armed()).then(|| pane.look.say(crate::ui::text::main::NOT_ARMED))
}

const fn route_text(route: GestureRoute) -> Text {
    match route {
        GestureRoute::Register1008 => panels::ROUTE_1008,
        GestureRoute::ActionLibrary => panels::ROUTE_LIBRARY,
        GestureRoute::Off => panels::ROUTE_OFF,
    }
}

impl GestureView {
    /// Height of the strip in an overview of this height.
    pub(crate) fn strip_height(height: f32) -> f32 {
        if height < ROOMY { 96.0 } else { 160.0 }
    }

    /// The strip of the overview: two rows of numbers, or four rows with names.
    pub(crate) fn strip_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let (mut head, body) = controls::titled_card(ui, look, rect, look.say(panels::GESTURES));
        let gap = theme::STEP;
        let count: u8 = if rect.height() < 120.0 { 20 } else { 10 };
        let (columns, rows) = (
            f32::from(count),
            f32::from(Gesture::MAX.get().div_ceil(count)),
        );
        let size = vec2(
            (body.width() - gap * (columns - 1.0)) / columns,
            (body.height() - gap * (rows - 1.0)) / rows,
        );
        route_ui(ui, take_right(&mut head, 148.0), pane);
        // Where names do not fit they are typed in the view of its own.
        let fits = size.x >= NAMED;
        if fits {
            self.naming_ui(ui, &mut head, pane);
        }
        hint_ui(ui, head, pane);
        for (gesture, place) in grid(body, size, gap, count) {
            self.tile_ui(ui, place, pane, gesture, self.naming && fits);
        }
    }

    /// The view of its own: large tiles.
    pub(crate) fn large_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let (mut head, body) = controls::titled_card(ui, look, rect, look.say(panels::GESTURES));
        route_ui(ui, take_right(&mut head, 148.0), pane);
        self.naming_ui(ui, &mut head, pane);
        hint_ui(ui, head, pane);
        let columns: u8 = if body.width() < 800.0 { 5 } else { 8 };
        let rows = f32::from(Gesture::MAX.get().div_ceil(columns));
        let gap = theme::GAP;
        let size = vec2(
            (body.width() - gap * (f32::from(columns) - 1.0)) / f32::from(columns),
            ((body.height() - gap * (rows - 1.0)) / rows).clamp(28.0, 72.0),
        );
        for (gesture, place) in grid(body, size, gap, columns) {
            self.tile_ui(ui, place, pane, gesture, self.naming);
        }
    }

    fn naming_ui(&mut self, ui: &mut Ui, head: &mut Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let text = if self.naming {
            panels::GESTURE_NAME_DONE
        } else {
            panels::GESTURE_NAME_EDIT
        };
        let text = look.say(text);
        let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
        let mut button =
            Button::new(text, look.say(panels::GESTURE_NAME_EDIT_TIP)).weight(if self.naming {
                Weight::Strong
            } else {
                Weight::Quiet
            });
        button.selected = Some(self.naming);
        if button
            .put(
                ui,
                look,
                take_right(head, width),
                Id::unique("name gestures"),
            )
            .clicked()
        {
            self.naming = !self.naming;
            self.typed = None;
        }
    }

    fn tile_ui(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        pane: &mut Pane<'_>,
        gesture: Gesture,
        naming: bool,
    ) {
        if naming {
            return self.name_ui(ui, rect, pane, gesture);
        }
        let look = pane.look;
        let name = pane
            .state
            .gestures
            .name(gesture)
            .unwrap_or_default()
            .to_owned();
        let number = gesture.get().to_string();
        let label = format!("{} {number} {name}", look.say(panels::GESTURE));
        let tip = format!("{}\n{}", label.trim(), look.say(panels::GESTURE_RUN_TIP));
        let reason = refusal(pane);
        let button = Button::new(&number, &tip)
            .named(label.trim())
            .disabled(reason);
        let response = button.ground(ui, look, rect, Id::unique(("gesture", gesture)));
        let color = button.text_color(look);
        tile_text(ui, look, rect, &number, &name, color, gesture);
        if response.clicked() {
            pane.actions.push(Action::Gesture(gesture));
        }
    }

    fn name_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, gesture: Gesture) {
        let look = pane.look;
        let known = pane.state.gestures.name(gesture).unwrap_or_default();
        let mut text = match &self.typed {
            Some((typed, text)) if *typed == gesture => text.clone(),
            _ => known.to_owned(),
        };
        let edit = TextEdit::singleline(&mut text)
            .id(Id::unique(("gesture name", gesture)))
            .font(theme::small())
            .hint_text(gesture.get().to_string())
            .char_limit(NAME_MAX)
            .clip_text(true)
            .align(egui::Align2::LEFT_CENTER)
            .margin(egui::Margin::symmetric(4, 0))
            .min_size(rect.size())
            .desired_width(rect.width() - 8.0);
        let response = ui.put(rect, edit);
        let name = format!("{} {}", look.say(panels::GESTURE_NAME), gesture.get());
        response.widget_info(|| {
            let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, &name);
            info.current_text_value = Some(text.clone());
            info
        });
        if response.changed() {
            self.typed = Some((gesture, text.clone()));
        }
        if response.lost_focus() {
            let escaped = ui.input(|input| input.key_pressed(egui::Key::Escape));
            let text = text.trim();
            if !escaped && text != known {
                pane.actions.push(Action::NameGesture(gesture, text.into()));
            }
            self.typed = None;
        }
    }
}

fn hint_ui(ui: &mut Ui, head: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let hint = format!(
        "{} · {} · {}",
        look.say(panels::GESTURES_FIXED),
        look.say(panels::GESTURES_USER),
        look.say(panels::GESTURES_NOT_LISTED)
    );
    Label::new(&hint, look.palette.faint)
        .small()
        .put(ui, head)
        .on_hover_text(look.say(panels::GESTURES_TIP));
}

fn tile_text(
    ui: &Ui,
    look: Look,
    rect: Rect,
    number: &str,
    name: &str,
    color: egui::Color32,
    gesture: Gesture,
) {
    let inner = rect.shrink2(vec2(theme::STEP + 1.0, 0.0));
    let number_color = if gesture.get() <= LAST_FIXED {
        color
    } else {
        color.gamma_multiply(0.8)
    };
    if name.is_empty() || rect.width() < NAMED {
        let center = egui::Align2::CENTER_CENTER;
        controls::paint_text(ui, inner, center, number, theme::number(), number_color);
        return;
    }
    let left = egui::Align2::LEFT_CENTER;
    if rect.height() >= 40.0 {
        let (upper, lower) = inner
            .shrink2(vec2(4.0, 6.0))
            .split_top_bottom_at_fraction(0.45);
        controls::paint_text(ui, upper, left, number, theme::number(), look.palette.muted);
        controls::paint_text(ui, lower, left, name, theme::body(), color);
        return;
    }
    let (narrow, rest) = inner.split_left_right_at_x(inner.left() + 17.0);
    controls::paint_text(
        ui,
        narrow,
        left,
        number,
        theme::number_small(),
        look.palette.muted,
    );
    controls::paint_text(ui, rest, left, name, theme::small(), color);
}

fn grid(
    body: Rect,
    size: egui::Vec2,
    gap: f32,
    columns: u8,
) -> impl Iterator<Item = (Gesture, Rect)> {
    all().map(move |gesture| {
        let n = gesture.get() - 1;
        let (row, column) = (f32::from(n / columns), f32::from(n % columns));
        let at = pos2(
            body.left() + column * (size.x + gap),
            body.top() + row * (size.y + gap),
        );
        (gesture, Rect::from_min_size(at, size))
    })
}

fn route_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let now = pane.state.settings.gesture_route;
    let mut chosen = now;
    ui.scope_builder(
        UiBuilder::new().max_rect(controls::middle(rect, theme::CONTROL)),
        |ui| {
            let name = look.say(panels::GESTURE_ROUTE);
            let shown = egui::ComboBox::from_id_salt("gesture route")
                .width(rect.width())
                .selected_text(look.say(route_text(now)))
                .truncate()
                .show_ui(ui, |ui| {
                    for route in [
                        GestureRoute::Register1008,
                        GestureRoute::ActionLibrary,
                        GestureRoute::Off,
                    ] {
                        ui.selectable_value(&mut chosen, route, look.say(route_text(route)));
                    }
                });
            shown
                .response
                .on_hover_text(look.say(panels::GESTURE_ROUTE_TIP))
                .accessible_name(name);
        },
    );
    if chosen != now {
        pane.actions.push(Action::GestureRoute(chosen));
    }
}
