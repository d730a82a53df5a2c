//! The view of poses: the user's own, sequences of them, and the gestures in the hand. Holds the selection only, no pose.
pub(crate) mod editor;
pub(crate) mod gestures;
mod grip_size;
mod hold;
pub(crate) mod sequence_step;
pub(crate) mod sequence_view;
pub(crate) mod shipped;
pub(crate) mod tiles;

use crate::app::action::Action;
use crate::poses::edit::{LibraryEdit, PoseEdit};
use crate::poses::library::{LibraryPose, PoseId};
use crate::ui::kit::path_field::path_ui;
use crate::ui::kit::{self, Button, Label, Pane, Pick, reorder};
use crate::ui::poses::gestures::GestureView;
use crate::ui::poses::sequence_view::{SequenceView, beside};
use crate::ui::poses::tiles::{capture_ui, for_all_ui, tile_ui};
use crate::ui::text::{Text, notices, poses};
use crate::ui::theme;
use egui::{Align, Layout, ScrollArea, Ui, UiBuilder, vec2};

/// Section of the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum PoseSection {
    #[default]
    Mine,
    Sequences,
    Shipped,
    InHand,
}

impl PoseSection {
    const ALL: [(Self, Text); 4] = [
        (Self::Mine, poses::MY_POSES),
        (Self::Sequences, poses::SEQUENCES),
        (Self::Shipped, poses::SHIPPED),
        (Self::InHand, poses::IN_HAND),
    ];
}

/// View state.
#[derive(Debug, Default)]
pub(crate) struct PoseView {
    section: PoseSection,
    chosen: Option<PoseId>,
    shown: Option<PoseId>,
    sequences: SequenceView,
    gestures: GestureView,
    order: reorder::Reorder,
    /// Only poses with these words are shown.
    find: String,
}

impl PoseView {
    /// Width that the open section needs: a step of a sequence has up to seven numbers side by side.
    pub(crate) const fn least_width(&self) -> f32 {
        match self.section {
            PoseSection::Sequences => 800.0,
            PoseSection::Mine | PoseSection::Shipped | PoseSection::InHand => 600.0,
        }
    }

    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let newest = pane.state.poses.newest;
        if newest != self.shown {
            (self.shown, self.chosen) = (newest, newest);
        }
        kit::full_card_ui(ui, pane.look, |ui| {
            ui.horizontal(|ui| self.head_ui(ui, pane));
            if self.section != PoseSection::InHand {
                for_all_ui(ui, pane);
            }
            refused_ui(ui, pane);
            match self.section {
                PoseSection::Mine => self.mine_ui(ui, pane),
                PoseSection::Sequences => self.sequences.ui(ui, pane),
                PoseSection::Shipped => shipped::shipped_ui(ui, pane),
                PoseSection::InHand => self.gestures.ui(ui, pane),
            }
        });
    }

    /// Draws the choice of sections, and the actions on all poses.
    fn head_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let sections = Pick::new(look, poses::SECTION_TIP);
        sections.ui(ui, &mut self.section, PoseSection::ALL);
        if matches!(self.section, PoseSection::Mine | PoseSection::Sequences) {
            kit::right_ui(ui, |ui| tools_ui(ui, pane));
        }
    }

    fn mine_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let library = &pane.state.poses.library;
        if library.poses.is_empty() {
            return empty_ui(ui, pane);
        }
        ui.horizontal(|ui| {
            capture_ui(ui, pane, Button::text(look, poses::CAPTURE));
            ui.scope(|ui| {
                ui.set_max_width(200.0);
                kit::translated_edit_ui(ui, look, poses::FIND, &mut self.find);
            });
        });
        let chosen = self.chosen.and_then(|chosen| library.pose(chosen));
        let chosen = chosen.or(library.poses.first());
        self.chosen = chosen.map(|pose| pose.id);
        let width = (ui.available_width() * 0.42).clamp(268.0, 380.0);
        beside(width, "pose").show(ui, |ui| {
            if let Some(pose) = chosen {
                editor::editor_ui(ui, pane, pose);
            }
        });
        self.tiles_ui(ui, pane);
    }

    fn tiles_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let words = self.find.trim().to_lowercase();
        let all = pane.state.poses.library.poses.iter().enumerate();
        let shown: Vec<(usize, &LibraryPose)> = all.filter(|(_, pose)| pose.has(&words)).collect();
        if shown.is_empty() {
            Label::muted(pane.look, poses::FIND_NONE).wrap().ui(ui);
        }
        let gap = theme::STEP;
        let room = ui.available_width() - theme::GAP;
        let columns = ((room + gap) / (112.0 + gap)).floor().max(1.0);
        let width = ((room - gap * (columns - 1.0)) / columns).floor();
        let area = ScrollArea::vertical().auto_shrink(false);
        area.id_salt("poses").show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(gap, theme::GAP);
                for (index, (_, pose)) in shown.iter().enumerate() {
                    let (id, place) = ui.allocate_space(vec2(width, 158.0));
                    let moved = self.order.place(ui, pane.look, index, (id, place));
                    let tile = UiBuilder::new().id_salt(pose.id).max_rect(place);
                    let tile = tile.layout(Layout::top_down_justified(Align::Min));
                    let is_chosen = self.chosen == Some(pose.id);
                    if tile_ui(&mut ui.new_child(tile), pane, pose, is_chosen) {
                        self.chosen = Some(pose.id);
                    }
                    let Some((from, to)) = moved else { continue };
                    if let (Some((_, pose)), Some((to, _))) = (shown.get(from), shown.get(to)) {
                        self.chosen = Some(pose.id);
                        let edit = LibraryEdit::Pose(pose.id, PoseEdit::Move(*to));
                        pane.actions.push(Action::Library(edit));
                    }
                }
            });
        });
    }
}

/// Draws the actions from right to left.
fn tools_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let book = &pane.state.poses;
    let nothing = book.library.is_empty().then(|| look.tr(poses::NOTHING));
    let no_undo = (!book.can_undo()).then(|| look.tr(poses::UNDO_NONE));
    let undo = Action::Library(LibraryEdit::Undo);
    for (text, disabled, action) in [
        (poses::EXPORT, nothing, Action::ExportPoses),
        (poses::IMPORT, None, Action::ImportPoses(None)),
        (poses::UNDO, no_undo, undo),
    ] {
        let button = Button::text(look, text).disabled(disabled);
        button.on_click(ui, pane, action);
    }
}

/// Draws the reason why the last file was rejected, and a field for another path.
fn refused_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let Some(refused) = &pane.state.poses.refused else {
        return;
    };
    let words = notices::notice(pane.look, refused);
    kit::small_text_ui(ui, &words, pane.look.palette.warn);
    if let Some(path) = path_ui(ui, pane.look, "poses") {
        pane.actions.push(Action::ImportPoses(Some(path)));
    }
}

fn empty_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    ui.add_space(theme::STEP);
    Label::text(look, poses::EMPTY_TITLE).large().wrap().ui(ui);
    kit::small_text_ui(ui, look.tr(poses::EMPTY_BODY), look.palette.muted);
    let tip = look.tip(poses::CAPTURE);
    let button = Button::new(look.tr(poses::EMPTY_BUTTON), tip);
    capture_ui(ui, pane, button);
}
