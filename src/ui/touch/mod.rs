//! The five fingertips: small below the drawn hand in the overview, large beside it with one of them in detail.
pub(crate) mod heat;
pub(crate) mod table;
pub(crate) mod tip_channels;
pub(crate) mod tip_detail;

use crate::app::action::Action;
use crate::app::readings::friction::FrictionState;
use crate::hand::Finger;
use crate::ui::hand::fingertip::{self, Sense};
use crate::ui::hand::panel::{self, HandPanel};
use crate::ui::kit::{self, Button, Label, Pane, Pick, ViewRequest, format};
use crate::ui::text::{main, panels, words};
use crate::ui::theme;
use crate::ui::touch::tip_detail::TipDetail;
use crate::ui::view::View;
use egui::{
    Align, CursorIcon, Id, Layout, Margin, Panel, Rect, Role, ScrollArea, Sense as Senses, Ui,
    WidgetInfo, vec2,
};

/// Height of a fingertip's name and force in the overview; height of its picture, as a share of the card and at
/// least.
const FIGURES: f32 = 2.0 * theme::LIST_LINE;
const TIP_PART: f32 = 0.13;
const TIP_LEAST: f32 = 44.0;
/// Minimum height of the hand, even if nothing else fits.
const HAND_LEAST: f32 = 272.0;

/// View state of the fingertips.
#[derive(Debug, Default)]
pub(crate) struct TouchView {
    hand: HandPanel,
    detail: TipDetail,
    /// All numbers instead of one fingertip.
    numbers: bool,
}

impl TouchView {
    /// Draws the card of the overview: the hand, and below it the fingertips, as far as the hand keeps its minimum height, unless
    /// they are drawn large beside it.
    pub(crate) fn small_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, has_large: bool) {
        let look = pane.look;
        kit::full_card_ui(ui, look, |ui| {
            kit::head_ui(ui, look, look.tr(panels::HAND), |ui| {
                panel::side_ui(ui, pane);
                heat::no_zero_ui(ui, pane);
            });
            let (width, height) = (ui.available_width(), ui.available_height());
            let widest = (width / 5.0 - theme::GAP) * fingertip::HEIGHT_TO_WIDTH;
            let picture = (height * TIP_PART).max(TIP_LEAST).min(widest).round();
            let room = height - HAND_LEAST - theme::GAP;
            let below = [picture + FIGURES, FIGURES, 0.0];
            let fits = below.into_iter().find(|below| *below <= room);
            let below = fits.filter(|_| !has_large).unwrap_or(0.0);
            let height = height - below - theme::GAP;
            let size = vec2(width, height.max(1.0));
            ui.allocate_ui(size, |ui| self.hand_ui(ui, pane, has_large));
            if below > 0.0 {
                ui.spacing_mut().item_spacing.x = 0.0;
                ui.columns(Finger::ALL.len(), |columns| {
                    for (ui, finger) in columns.iter_mut().zip(Finger::ALL) {
                        let picture = (below > FIGURES).then_some(picture);
                        self.column_ui(ui, pane, finger, picture);
                    }
                });
            }
        });
    }

    /// Draws one fingertip of the overview: its name, its picture if it has a height, and its normal force.
    fn column_ui(
        &mut self,
        ui: &mut Ui,
        pane: &mut Pane<'_>,
        finger: Finger,
        picture: Option<f32>,
    ) {
        let look = pane.look;
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.vertical_centered(|ui| {
            let color = look.palette.dof[finger.bend()];
            let name = look.tr(words::finger(finger));
            Label::new(name, color).small().ui(ui);
            if let Some(height) = picture {
                let size = vec2(ui.available_width(), height);
                let (place, response) = ui.allocate_exact_size(size, Senses::click());
                let fingertip = heat::tip(pane, finger).unwrap_or_default();
                fingertip::paint(ui.painter(), look, place, &fingertip);
                let name = look.pair(look.tr(panels::TIP), name);
                response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
                let tip = format!("{}\n{}", panel::felt(pane, finger), look.tip(panels::TOUCH));
                let response = response.on_hover_cursor(CursorIcon::PointingHand);
                if response.on_hover_text(tip).clicked() {
                    self.open(pane, finger);
                }
            }
            table::normal_ui(ui, pane, finger);
        });
    }

    /// Draws the hand alone, from the front or in the default view.
    pub(crate) fn hand_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>, is_frontal: bool) {
        let clicked = self.hand.ui(ui, pane, &heat::tips(pane), is_frontal);
        if let Some(finger) = clicked {
            self.open(pane, finger);
        }
    }

    /// Draws the view in place of the plots: five large fingertips above the chosen one in detail, or all numbers.
    pub(crate) fn large_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        self.detail.follow(pane);
        let height = (ui.available_height() * 0.48).round();
        let upper = Panel::top("touch, upper");
        kit::bare(upper, height, Margin::ZERO).show(ui, |ui| {
            kit::card_ui(ui, look, |ui| {
                kit::head_ui(ui, look, look.tr(panels::TOUCH), |ui| {
                    heat::scale_ui(ui, pane);
                });
                self.tare_ui(ui, pane);
                let height = ui.available_height();
                ui.columns(Finger::ALL.len(), |columns| {
                    for (ui, finger) in columns.iter_mut().zip(Finger::ALL) {
                        let (_, place) = ui.allocate_space(vec2(ui.available_width(), height));
                        self.tip_ui(ui, pane, place, finger);
                    }
                });
            });
        });
        ui.add_space(theme::GAP);
        kit::full_card_ui(ui, look, |ui| self.lower_ui(ui, pane));
    }

    /// Opens a fingertip in detail.
    const fn open(&mut self, pane: &mut Pane<'_>, finger: Finger) {
        self.detail.finger = finger;
        pane.open(ViewRequest::View(View::Touch));
    }

    fn lower_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>) {
        let look = pane.look;
        let finger = self.detail.finger;
        let name = look.tr(words::finger(finger));
        let title = look.pair(look.tr(panels::TIP), name);
        kit::head_ui(ui, look, &title, |ui| {
            let all = [(true, panels::NUMBERS), (false, panels::DETAIL)];
            Pick::new(look, panels::NUMBERS.tip()).ui(ui, &mut self.numbers, all);
            let assumed = Label::note(look, panels::ASSUMED).ui(ui);
            assumed.on_hover_text(look.tip(panels::ASSUMED));
            let zero = pane.hand().readings.tare.zero(finger);
            let tared = match zero {
                None => look.tr(panels::NO_ZERO).to_owned(),
                Some(zero) => panels::zero(look, zero, pane.state.now),
            };
            let tared = Label::new(&tared, look.palette.muted).small();
            tared.named(look.tr(panels::TARED_NAME)).ui(ui);
        });
        if self.numbers {
            let area = ScrollArea::vertical().auto_shrink(false);
            area.show(ui, |ui| table::all_ui(ui, pane));
        } else {
            self.detail.ui(ui, pane);
        }
    }

    /// Draws a large fingertip: a button that selects it, with its forces.
    fn tip_ui(&mut self, ui: &mut Ui, pane: &Pane<'_>, place: Rect, finger: Finger) {
        let look = pane.look;
        let tip = heat::tip(pane, finger).unwrap_or_default();
        let name = look.tr(words::finger(finger));
        let label = look.pair(look.tr(panels::TIP), name);
        let button = Button::new(name, look.tip(panels::TOUCH))
            .named(&label)
            .choice(self.detail.finger == finger);
        let id = Id::unique(("tip", finger));
        if button.ground(ui, look, place, id).clicked() {
            self.detail.finger = finger;
        }
        let block = pane.hand().readings.sample.tactile[finger];
        let block = block.map(|block| block.value);
        let (below, color) = match (tip.sense, self.detail.hold(finger)) {
            (Sense::NoNumber, _) => (look.tr(panels::NO_NUMBER).to_owned(), look.palette.warn),
            (Sense::Beyond, _) => (look.tr(panels::BEYOND).to_owned(), look.palette.warn),
            (Sense::Fine, FrictionState::Slips) => {
                (look.tr(panels::SLIP).to_owned(), look.palette.bad)
            }
            (Sense::Fine, _) => {
                let shear = format::newtons(block.map(|block| block.tangential_n));
                // The arrow also shows the direction.
                (format!("{shear} N"), look.palette.muted)
            }
        };
        let normal = format!("{} N", format::newtons(block.map(|block| block.normal_n)));
        let strong = match tip.sense {
            Sense::Fine => look.palette.text,
            _ => look.palette.warn,
        };
        let meaning = look.tr(match tip.sense {
            Sense::Beyond => panels::BEYOND.tip(),
            _ => panels::TOUCH.tip(),
        });
        let freshness = pane.tip_freshness(finger);
        let builder = egui::UiBuilder::new()
            .max_rect(place.shrink(theme::STEP))
            .layout(Layout::bottom_up(Align::Center));
        ui.scope_builder(builder, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let figures = [
                (below, panels::TOUCH_SHEAR_NAME, theme::small(), color),
                (normal, panels::TOUCH_NORMAL_NAME, theme::body(), strong),
            ];
            for (words, what, font, color) in figures {
                let name = format!("{name} {}", look.tr(what));
                let label = Label::new(&words, look.value(freshness, color)).font(font);
                label.named(&name).ui(ui).on_hover_text(meaning);
            }
            let top = (ui.available_height() - theme::TITLE_LINE).max(0.0);
            let (_, place) = ui.allocate_space(vec2(ui.available_width(), top));
            fingertip::paint(ui.painter(), look, place, &tip);
            Label::new(name, look.palette.dof[finger.bend()]).ui(ui);
        });
    }

    /// Draws the buttons that tare all fingertips or one, and that undo it.
    fn tare_ui(&self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let hand = pane.hand();
        let offline =
            (!hand.connection.status.state.is_live()).then(|| look.tr(main::REFUSED_OFFLINE));
        let finger = self.detail.finger;
        let name = look.tr(words::finger(finger));
        let one = look.tr_with(panels::TARE_ONE, name);
        let all = look.tr(panels::TARE_ALL);
        let nothing = (!hand.readings.tare.can_undo()).then(|| look.tr(panels::TARE_NOTHING));
        let undo = look.tr(panels::TARE_UNDO);
        let offered = hand.readings.tare.offered(pane.state.now);
        ui.horizontal(|ui| {
            for (words, tip, disabled, action) in [
                (all, panels::TARE_ALL.tip(), offline, Action::Tare(None)),
                (
                    &one,
                    panels::TARE_ONE.tip(),
                    offline,
                    Action::Tare(Some(finger)),
                ),
                (undo, panels::TARE_UNDO.tip(), nothing, Action::UndoTare),
            ] {
                let button = Button::new(words, look.tr(tip)).disabled(disabled);
                button.on_click(ui, pane, action);
            }
            if let Some(age) = offered {
                let words = panels::stored_tare(look, age);
                let kept = Button::new(&words, look.tip(panels::KEPT_TARE));
                let kept = kept.named(look.tr(panels::KEPT_TARE)).disabled(offline);
                kept.on_click(ui, pane, Action::TakeKeptTare);
            }
        });
    }
}
