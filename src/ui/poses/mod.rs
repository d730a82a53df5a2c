//! The view of poses: the person's own, sequences of them, and the gestures in the hand. Holds what is chosen, no pose.
pub(crate) mod editor;
pub(crate) mod gesture_editor;
pub(crate) mod gestures;
pub(crate) mod sequence_step;
pub(crate) mod sequence_view;
pub(crate) mod tiles;

use crate::app::action::Action;
use crate::poses::edit::{LibraryEdit, PoseEdit};
use crate::poses::library::{NAME_CHARS_MAX, Pose, PoseId};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::look::Pane;
use crate::ui::kit::reorder::{Along, Reorder};
use crate::ui::poses::editor as pose_editor;
use crate::ui::poses::gesture_editor::GestureEditor;
use crate::ui::poses::gestures::GestureView;
use crate::ui::poses::sequence_view::{SequenceView, scrolled};
use crate::ui::poses::tiles::{capture_button, tile_ui};
use crate::ui::text::{Text, poses};
use crate::ui::theme;
use egui::{Id, Rect, TextEdit, Ui, vec2};

/// What the view shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Section {
    #[default]
    Mine,
    Sequences,
    InHand,
}

impl Section {
    const ALL: [Self; 3] = [Self::Mine, Self::Sequences, Self::InHand];

    const fn title(self) -> Text {
        match self {
            Self::Mine => poses::MY_POSES,
            Self::Sequences => poses::SEQUENCES,
            Self::InHand => poses::IN_HAND,
        }
    }
}

/// What the view needs between frames.
#[derive(Debug, Default)]
pub(crate) struct PoseView {
    section: Section,
    chosen: Option<PoseId>,
    shown: Option<PoseId>,
    sequences: SequenceView,
    gestures: GestureView,
    editor: GestureEditor,
    order: Reorder,
    /// Only poses with these words are shown.
    find: String,
    typed: Option<(Id, String)>,
}

impl PoseView {
    /// Draws the view.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let newest = pane.state.poses.newest;
        if newest != self.shown {
            (self.shown, self.chosen) = (newest, newest);
        }
        let mut body = controls::card(ui, pane.look, rect);
        self.sections_ui(ui, take_top(&mut body, theme::CONTROL_LARGE), pane);
        match self.section {
            Section::InHand => self.in_hand_ui(ui, body, pane),
            Section::Mine | Section::Sequences => {
                let mut row = take_top(&mut body, theme::CONTROL);
                tools_ui(ui, &mut row, pane);
                let searched = !pane.state.poses.library.poses.is_empty();
                if searched && self.section == Section::Mine {
                    self.find_ui(ui, row, pane);
                }
                if self.section == Section::Sequences {
                    self.sequences.ui(ui, body, pane, &mut self.typed);
                } else {
                    self.mine_ui(ui, body, pane);
                }
            }
        }
    }

    fn sections_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        for section in Section::ALL {
            let text = look.say(section.title());
            let width = controls::text_width(ui, text, theme::body()) + 3.0 * theme::PAD;
            let button = Button::new(text, look.say(poses::SECTION_TIP));
            let place = take_left(&mut row, width);
            let button = button.choice(self.section == section);
            if button
                .put(ui, look, place, Id::unique(("section", text)))
                .clicked()
            {
                self.section = section;
            }
        }
    }

    fn in_hand_ui(&mut self, ui: &mut Ui, mut body: Rect, pane: &mut Pane<'_>) {
        let width = (body.width() * 0.42).clamp(theme::POSE_SIDE.0, theme::POSE_SIDE.1);
        let editor = take_right(&mut body, width);
        self.gestures.large_ui(ui, body, pane);
        self.editor.ui(ui, editor, pane);
    }

    /// The field that finds poses by name and tag, as far as there is room for it.
    fn find_ui(&mut self, ui: &mut Ui, row: Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let place = row.with_max_x(row.right().min(row.left() + theme::POSE_FIND));
        let edit = TextEdit::singleline(&mut self.find)
            .id(Id::unique("find poses"))
            .font(theme::body())
            .hint_text(look.say(poses::FIND_HINT))
            .char_limit(NAME_CHARS_MAX)
            .clip_text(true)
            .align(egui::Align2::LEFT_CENTER)
            .margin(theme::FIELD_INSET_LOW)
            .min_size(place.size())
            .desired_width(place.width() - theme::FIELD_MARGIN);
        let response = ui.put(place, edit);
        let value = self.find.clone();
        response.widget_info(|| {
            let name = look.say(poses::FIND);
            let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, name);
            info.current_text_value = Some(value.clone());
            info
        });
    }

    fn mine_ui(&mut self, ui: &mut Ui, mut body: Rect, pane: &mut Pane<'_>) {
        let state = pane.state;
        let library = &state.poses.library;
        if library.poses.is_empty() {
            return empty_ui(ui, body, pane);
        }
        let width = (body.width() * 0.42).clamp(theme::GESTURE_SIDE.0, theme::GESTURE_SIDE.1);
        let editor = take_right(&mut body, width);
        let columns = ((body.width() + theme::GAP) / (theme::POSE_TILE.x + theme::GAP))
            .floor()
            .max(1.0);
        let words = self.find.trim().to_lowercase();
        let poses = library.poses.iter().enumerate();
        let shown: Vec<(usize, &Pose)> = poses.filter(|(_, pose)| pose.has(&words)).collect();
        if shown.is_empty() {
            let text = pane.look.say(poses::FIND_NONE);
            let place = body.with_max_y(body.top() + theme::CONTROL_LARGE);
            Label::new(text, pane.look.palette.muted).put(ui, place);
        }
        scrolled(ui, body, "poses", |ui, room| {
            let width = (room - theme::STEP * (columns - 1.0)) / columns;
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(theme::STEP, theme::GAP);
                self.order.begin();
                for (_, pose) in &shown {
                    let size = vec2(width.floor(), theme::POSE_TILE.y);
                    let (place, _) = ui.allocate_exact_size(size, egui::Sense::hover());
                    self.order.place(ui, place, Id::unique(("pose", pose.id)));
                    if tile_ui(ui, place, pane, pose, self.chosen == Some(pose.id)) {
                        self.chosen = Some(pose.id);
                    }
                }
                let moved = self.order.end(ui, pane.look, Along::Row);
                if let Some((from, to)) = moved
                    && let (Some((_, pose)), Some((to, _))) = (shown.get(from), shown.get(to))
                {
                    self.chosen = Some(pose.id);
                    let edit = LibraryEdit::Pose(pose.id, PoseEdit::Move(*to));
                    pane.actions.push(Action::Library(edit));
                }
            });
        });
        let chosen = self.chosen.and_then(|chosen| library.pose(chosen));
        self.chosen = chosen.or(library.poses.first()).map(|pose| pose.id);
        match chosen {
            Some(pose) => pose_editor::editor_ui(ui, editor, pane, &mut self.typed, pose),
            None => {
                let text = pane.look.say(poses::CHOOSE);
                Label::new(text, pane.look.palette.muted)
                    .center()
                    .put(ui, editor);
            }
        }
    }
}

fn tools_ui(ui: &mut Ui, row: &mut Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let book = &pane.state.poses;
    let nothing = book.library.is_empty().then(|| look.say(poses::NOTHING));
    let no_undo = (!book.can_undo()).then(|| look.say(poses::UNDO_NONE));
    if !book.library.poses.is_empty() {
        let capture = Button::new(look.say(poses::CAPTURE), look.say(poses::CAPTURE_TIP));
        capture_button(ui, row, pane, capture.weight(Weight::Strong));
    }
    for (text, tip, disabled, action) in [
        (
            poses::EXPORT,
            poses::EXPORT_TIP,
            nothing,
            Action::ExportPoses,
        ),
        (poses::IMPORT, poses::IMPORT_TIP, None, Action::ImportPoses),
        (
            poses::UNDO,
            poses::UNDO_TIP,
            no_undo,
            Action::Library(LibraryEdit::Undo),
        ),
    ] {
        let words = look.say(text);
        let width = controls::text_width(ui, words, theme::body()) + 2.0 * theme::PAD;
        let button = Button::new(words, look.say(tip)).disabled(disabled);
        let place = take_right(row, width);
        if button
            .put(ui, look, place, Id::unique(("poses", text.en)))
            .clicked()
        {
            pane.actions.push(action);
        }
    }
}

fn empty_ui(ui: &mut Ui, body: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let mut rows = Rect::from_center_size(
        body.center(),
        vec2(body.width().min(theme::POSE_EMPTY.x), theme::POSE_EMPTY.y),
    );
    let picture = take_top(&mut rows, theme::POSE_EMPTY_PICTURE);
    let open = crate::hand::PerDof::splat(Some(1.0));
    crate::ui::hand::panel::pose_ui(ui, look, picture, &open);
    Label::new(look.say(poses::EMPTY_TITLE), look.palette.text)
        .font(theme::title())
        .center()
        .put(ui, take_top(&mut rows, theme::CONTROL));
    let place = take_top(&mut rows, theme::CONTROL_LARGE);
    crate::ui::poses::gesture_editor::wrapped(ui, place, pane, look.say(poses::EMPTY_BODY));
    let text = look.say(poses::EMPTY_BUTTON);
    let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
    let row = take_top(&mut rows, theme::CONTROL_LARGE);
    let mut place = row.with_max_x(row.center().x + width / 2.0);
    let button = Button::new(text, look.say(poses::CAPTURE_TIP)).weight(Weight::Strong);
    capture_button(ui, &mut place, pane, button);
}
