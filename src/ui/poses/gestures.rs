//! The gestures stored in the hand: the menu of the live view, and the shelf with their names and the start route. Starts nothing
//! by itself.

use crate::app::action::Action;
use crate::hand::{Gesture, GestureRoute};
use crate::ui::kit::{self, Button, Label, Pane, TextField, Weight};
use crate::ui::text::{Text, cards, panels, poses};
use crate::ui::theme;
use egui::{CollapsingHeader, Grid, Response, ScrollArea, Ui};

/// The last gesture that the maker fixed. Manual 2.6.7.
const FIXED_MAX: u8 = 13;
/// Maximum characters of a name.
const NAME_MAX: usize = 24;
/// Names per row.
const NAMES: usize = 4;

/// Width of the menu of the live view.
const MENU: f32 = 460.0;
/// Height of what the menu tells of a gesture.
const CHOSEN: f32 = 112.0;

/// View state of the gestures.
#[derive(Debug, Default)]
pub(crate) struct GestureView {
    /// True while names are edited instead of gestures started.
    naming: bool,
}

impl GestureView {
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let hint = [panels::GESTURES_FIXED, panels::GESTURES_USER].map(|text| look.tr(text));
            let hint = hint.join(" · ");
            ui.horizontal(|ui| {
                self.naming_ui(ui, pane);
                let hint = Label::new(&hint, look.palette.muted);
                hint.small().ui(ui);
            });
            if self.naming {
                self.names_ui(ui, pane)
            } else {
                ui.horizontal_wrapped(|ui| {
                    for gesture in named_first(pane) {
                        let button = GestureButton::new(pane, gesture);
                        if button
                            .ui(ui, pane, refusal(pane), panels::GESTURE_RUN_TIP)
                            .clicked()
                        {
                            pane.actions.push(Action::Gesture(gesture));
                        }
                    }
                });
            }
            ui.separator();
            CollapsingHeader::new(look.tr(poses::EXPERT))
                .id_salt("expert gestures")
                .show(ui, |ui| route_ui(ui, pane));
        });
    }

    fn naming_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let (text, weight) = if self.naming {
            (cards::CLOSE, Weight::Strong)
        } else {
            (panels::GESTURE_NAME_EDIT, Weight::Normal)
        };
        let tip = look.tip(panels::GESTURE_NAME_EDIT);
        let button = Button::new(look.tr(text), tip).weight(weight);
        let button = button.selected(self.naming);
        button.toggle(ui, look, &mut self.naming);
    }

    fn names_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        Grid::new("gesture names").show(ui, |ui| {
            for (index, gesture) in Gesture::all().enumerate() {
                let number = gesture.get().to_string();
                let name = look.tr_with(panels::GESTURE_NAME, &number);
                let known = pane.state.settings.gesture_name(gesture);
                let field = TextField::new(&name, NAME_MAX).hint(&number);
                ui.scope(|ui| {
                    ui.set_width(120.0);
                    if let Some(name) = field.ui(ui, pane, known.unwrap_or_default()) {
                        pane.actions.push(Action::NameGesture(gesture, name));
                    }
                });
                if index % NAMES == NAMES - 1 {
                    ui.end_row();
                }
            }
        });
    }
}

/// Draws the route by which gestures are started, with notes about it.
fn route_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let routes = [
        (GestureRoute::Register1008, look.tr(panels::ROUTE_1008)),
        (GestureRoute::ActionLibrary, look.tr(panels::ROUTE_LIBRARY)),
        (GestureRoute::Off, look.tr(panels::ROUTE_OFF)),
    ];
    let mut route = pane.state.settings.gesture_route;
    let known = known(route);
    let name = look.tr(panels::GESTURE_ROUTE);
    ui.horizontal(|ui| {
        Label::new(name, look.palette.text).ui(ui);
        if kit::choose_ui(ui, name, &mut route, &routes) {
            pane.actions.push(Action::GestureRoute(route));
        }
    });
    for text in [panels::GESTURES_TIP, known] {
        Label::note(look, text).wrap().ui(ui);
    }
}

/// All gestures, those with a name first.
fn named_first(pane: &Pane<'_>) -> Vec<Gesture> {
    let is_named = |one: &Gesture| pane.state.settings.gesture_name(*one).is_some();
    let (mut all, others): (Vec<_>, Vec<_>) = Gesture::all().partition(is_named);
    all.extend(others);
    all
}

/// What is known about a route.
const fn known(route: GestureRoute) -> Text {
    match route {
        GestureRoute::Register1008 => panels::KNOWN_1008,
        GestureRoute::ActionLibrary => panels::KNOWN_LIBRARY,
        GestureRoute::Off => panels::KNOWN_OFF,
    }
}

/// Reason why no gesture can be started now; `None` if one can.
fn refusal(pane: &Pane<'_>) -> Option<&'static str> {
    if pane.state.settings.gesture_route == GestureRoute::Off {
        return Some(pane.look.tr(panels::GESTURES_OFF));
    }
    pane.unready()
}

/// A gesture's button: its name and number, or its number alone.
struct GestureButton {
    label: String,
    text: String,
    weight: Weight,
}

impl GestureButton {
    fn new(pane: &Pane<'_>, gesture: Gesture) -> Self {
        let known = pane.state.settings.gesture_name(gesture);
        let number = gesture.get().to_string();
        let name = known.unwrap_or_default();
        let label = format!("{} {number} {name}", pane.look.tr(panels::GESTURE));
        Self {
            label: label.trim().to_owned(),
            text: known.map_or_else(|| number.clone(), |name| format!("{name}  {number}")),
            weight: match known {
                Some(_) => Weight::Normal,
                None => Weight::Quiet,
            },
        }
    }

    fn ui(&self, ui: &mut Ui, pane: &Pane<'_>, refused: Option<&str>, tip: Text) -> Response {
        let tip = format!("{}\n{}", self.label, pane.look.tr(tip));
        Button::new(&self.text, &tip)
            .named(&self.label)
            .weight(self.weight)
            .disabled(refused)
            .large()
            .ui(ui, pane.look)
    }
}

/// Draws the live view's button for the gestures. Its popup lists them all; a click on one tells what is known of it, beside the
/// button that starts it.
pub(super) fn menu_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let button = Button::text(pane.look, poses::STRIP_GESTURES).ui(ui, pane.look);
    let id = button.id.with("chosen gesture");
    kit::popup_above(&button).width(MENU).show(|ui| {
        let mut chosen: Option<Gesture> = ui.data(|data| data.get_temp(id));
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = egui::vec2(theme::STEP, theme::STEP);
            for gesture in named_first(pane) {
                let mut button = GestureButton::new(pane, gesture);
                if chosen == Some(gesture) {
                    button.weight = Weight::Chosen;
                }
                if button
                    .ui(ui, pane, None, panels::GESTURE_SHOW_TIP)
                    .clicked()
                {
                    chosen = Some(gesture);
                    ui.data_mut(|data| data.insert_temp(id, gesture));
                }
            }
        });
        ui.separator();
        ui.vertical(|ui| {
            // Space for the longest text: the buttons above stay where they are.
            ui.set_min_height(CHOSEN);
            match chosen {
                Some(gesture) => chosen_ui(ui, pane, gesture),
                None => {
                    Label::note(pane.look, panels::GESTURE_CHOOSE).ui(ui);
                }
            }
        });
    });
}

/// Draws what is known of a gesture, its name, and the button that starts it.
fn chosen_ui(ui: &mut Ui, pane: &mut Pane<'_>, gesture: Gesture) {
    let look = pane.look;
    let number = gesture.get();
    ui.horizontal(|ui| {
        Label::new(&GestureButton::new(pane, gesture).label, look.palette.text).ui(ui);
        let name = look.tr_with(panels::GESTURE_NAME, number);
        let known = pane
            .state
            .settings
            .gesture_name(gesture)
            .unwrap_or_default();
        let field = TextField::new(&name, NAME_MAX).hint(look.tr(panels::GESTURE_NAME_HINT));
        ui.scope(|ui| {
            ui.set_width(160.0);
            if let Some(name) = field.ui(ui, pane, known) {
                pane.actions.push(Action::NameGesture(gesture, name));
            }
        });
        let name = look.tr_with(panels::GESTURE_START, number);
        let start = Button::text(look, poses::START)
            .named(&name)
            .weight(Weight::Strong);
        start
            .disabled(refusal(pane))
            .on_click(ui, pane, Action::Gesture(gesture));
    });
    let kind = if number <= FIXED_MAX {
        panels::GESTURE_OF_MAKER
    } else {
        panels::GESTURE_OF_USER
    };
    for text in [kind, known(pane.state.settings.gesture_route)] {
        Label::note(look, text).wrap().ui(ui);
    }
}
