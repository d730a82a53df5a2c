//! The stored gestures as tiles, how they are started, and the names a person gives them. Starts nothing by itself.

use crate::app::action::Action;
use crate::hand::{Gesture, GestureRoute};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Weight, take_right, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::poses::gesture_editor::wrapped;
use crate::ui::poses::tiles::gesture_tile_ui;
use crate::ui::text::{Text, panels};
use crate::ui::theme;
use egui::{Id, Rect, TextEdit, Ui, UiBuilder, pos2, vec2};

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

const fn route_text(route: GestureRoute) -> Text {
    match route {
        GestureRoute::Register1008 => panels::ROUTE_1008,
        GestureRoute::ActionLibrary => panels::ROUTE_LIBRARY,
        GestureRoute::Off => panels::ROUTE_OFF,
    }
}

impl GestureView {
    /// The view of its own: large tiles.
    pub(crate) fn large_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let mut body = rect;
        let mut head = take_top(&mut body, theme::CONTROL);
        self.naming_ui(ui, &mut head, pane);
        route_ui(ui, head, pane);
        hint_ui(
            ui,
            take_top(&mut body, 2.0 * theme::CONTROL - theme::GAP),
            pane,
        );
        let columns: u8 = if body.width() < theme::GESTURES_FIVE {
            4
        } else {
            5
        };
        let rows = f32::from(Gesture::MAX.get().div_ceil(columns));
        let gap = theme::GAP;
        let size = vec2(
            (body.width() - gap * (f32::from(columns) - 1.0)) / f32::from(columns),
            ((body.height() - gap * (rows - 1.0)) / rows)
                .clamp(theme::GESTURE_HEIGHTS.0, theme::GESTURE_HEIGHTS.1),
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
        gesture_tile_ui(ui, rect, pane, gesture);
    }

    fn name_ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, gesture: Gesture) {
        let look = pane.look;
        let known = pane
            .state
            .settings
            .gesture_name(gesture)
            .unwrap_or_default();
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
            .margin(theme::NAME_INSET)
            .min_size(rect.size())
            .desired_width(rect.width() - theme::GAP);
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

/// Which numbers are whose, and what is known of the way they are started.
fn hint_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let known = match pane.state.settings.gesture_route {
        GestureRoute::Register1008 => panels::KNOWN_1008,
        GestureRoute::ActionLibrary => panels::KNOWN_LIBRARY,
        GestureRoute::Off => panels::KNOWN_OFF,
    };
    let hint = format!(
        "{} · {}. {}",
        look.say(panels::GESTURES_FIXED),
        look.say(panels::GESTURES_USER),
        look.say(known)
    );
    wrapped(ui, rect, pane, &hint);
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
                .on_hover_text(format!(
                    "{}\n{}",
                    look.say(panels::GESTURE_ROUTE_TIP),
                    look.say(panels::GESTURES_TIP)
                ))
                .accessible_name(name);
        },
    );
    if chosen != now {
        pane.actions.push(Action::GestureRoute(chosen));
    }
}
