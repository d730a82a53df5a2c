//! The stored gestures as tiles, their names set by the user, and a collapsible section with the start route. Starts nothing by
//! itself.

use crate::app::action::Action;
use crate::hand::{Gesture, GestureRoute};
use crate::ui::kit::{self, Button, Label, Pane, TextField, Weight};
use crate::ui::poses::tiles::gesture_ui;
use crate::ui::text::{cards, panels, poses};
use egui::{CollapsingHeader, Grid, ScrollArea, Ui};

/// Maximum characters of a name.
const NAME_MAX: usize = 24;
/// Names per row.
const NAMES: usize = 4;

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
                    let is_named = |one: &Gesture| pane.state.settings.gesture_name(*one).is_some();
                    let (named, others): (Vec<_>, Vec<_>) = Gesture::all().partition(is_named);
                    for gesture in named.into_iter().chain(others) {
                        gesture_ui(ui, pane, gesture);
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
    let known = match route {
        GestureRoute::Register1008 => panels::KNOWN_1008,
        GestureRoute::ActionLibrary => panels::KNOWN_LIBRARY,
        GestureRoute::Off => panels::KNOWN_OFF,
    };
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
