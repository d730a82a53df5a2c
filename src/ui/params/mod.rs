//! The view of what the hand keeps: its tools, what waits for a yes, and where table, file and flash stand. Keeps only what is
//! filtered; every change is an action.
pub(crate) mod calibration;
pub(crate) mod card;
pub(crate) mod choices;
pub(crate) mod file;
pub(crate) mod flash;
pub(crate) mod place_buttons;
pub(crate) mod procedures;
pub(crate) mod table;

use crate::app::action::Action;
use crate::app::params::action::ParamAction;
use crate::app::state::State;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_left, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::look::Pane;
use crate::ui::params::file as device_file;
use crate::ui::params::flash as device_flash;
use crate::ui::params::table as device_table;
use crate::ui::params::table::Shown;
use crate::ui::text::{Text, device, verdicts};
use crate::ui::theme;
use egui::{Color32, Id, Rect, TextEdit, Ui, vec2};

/// Characters of the filter.
const FILTER_MAX: usize = 40;

/// What the view needs between frames.
#[derive(Debug, Default)]
pub(crate) struct DeviceView {
    shown: Shown,
    typed: Option<(Id, String)>,
}

impl DeviceView {
    /// Draws the view.
    pub(crate) fn ui(&mut self, ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>) {
        let mut table = rect;
        let flash = match rect.width() >= theme::DEVICE_WIDE {
            true => take_right(&mut table, theme::DEVICE_SIDE),
            false => {
                let (upper, lower) = rect.split_top_bottom_at_y(rect.bottom() - theme::DEVICE_FOOT);
                table = upper.with_max_y(upper.bottom() - theme::GAP);
                lower
            }
        };
        device_flash::flash_ui(ui, flash, pane);
        let mut body = controls::card(ui, pane.look, table);
        let state = pane.state;
        if let Some(compared) = &state.hand().params.compared {
            return device_file::file_ui(ui, body, pane, compared);
        }
        self.find_ui(ui, take_top(&mut body, theme::CONTROL), pane);
        tools_ui(ui, take_top(&mut body, theme::CONTROL), pane);
        status_ui(ui, take_top(&mut body, theme::TEXT_LINE), pane);
        device_table::table_ui(ui, body, pane, &self.shown, &mut self.typed);
    }

    /// What is shown of the table, and when it was read.
    fn find_ui(&mut self, ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
        let look = pane.look;
        let refusal = pane.state.hand().read_refusal();
        let refusal = refusal.map(|why| look.say(verdicts::refusal(why)));
        let text = look.say(device::READ);
        let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
        let button = Button::new(text, look.say(device::READ_TIP)).disabled(refusal);
        let place = take_right(&mut row, width);
        if button
            .put(ui, look, place, Id::unique("read rows"))
            .clicked()
        {
            pane.actions.push(Action::Param(ParamAction::Read));
        }
        let text = look.say(device::ONLY);
        let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
        let only = take_right(&mut row, width);
        let button = Button::new(text, look.say(device::ONLY_TIP)).choice(self.shown.only);
        if button
            .put(ui, look, only, Id::unique("only differences"))
            .clicked()
        {
            self.shown.only = !self.shown.only;
        }
        let place = row.with_max_x(row.right().min(row.left() + theme::DEVICE_FIND));
        let edit = TextEdit::singleline(&mut self.shown.words)
            .id(Id::unique("find parameters"))
            .font(theme::body())
            .hint_text(look.say(device::FIND_HINT))
            .char_limit(FILTER_MAX)
            .clip_text(true)
            .align(egui::Align2::LEFT_CENTER)
            .margin(vec2(theme::GAP, 0.0))
            .min_size(place.size())
            .desired_width(place.width() - theme::FIELD_MARGIN);
        let response = ui.put(place, edit);
        let value = self.shown.words.clone();
        response.widget_info(|| {
            let name = look.say(device::FIND);
            let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, name);
            info.current_text_value = Some(value.clone());
            info
        });
    }
}

/// What is done with what is staged.
fn tools_ui(ui: &mut Ui, mut row: Rect, pane: &mut Pane<'_>) {
    let look = pane.look;
    let state = pane.state;
    let why = |why: Option<_>| why.map(|why| look.say(verdicts::refusal(why)));
    let count = state.hand().params.to_apply().iter().count();
    let apply = match count {
        0 => look.say(device::APPLY).to_owned(),
        count => format!("{} ({count})", look.say(device::APPLY)),
    };
    let nothing = state.hand().params.all_staged().is_empty();
    let nothing = nothing.then(|| look.say(device::WHY_NOTHING_STAGED));
    let is_known = state.hand().sample.speed_set.is_some() && state.hand().link.state.is_live();
    let unknown = (!is_known).then(|| look.say(device::COPY_UNKNOWN));
    let strong = match state.hand().apply_refusal() {
        None => Weight::Strong,
        Some(_) => Weight::Normal,
    };
    let tools = [
        (
            Button::new(&apply, look.say(device::APPLY_TIP))
                .named(look.say(device::APPLY))
                .disabled(why(state.hand().apply_refusal()))
                .weight(strong),
            ParamAction::Apply,
        ),
        (
            Button::new(look.say(device::UNDO), look.say(device::UNDO_TIP))
                .disabled(why(state.hand().undo_refusal())),
            ParamAction::Undo,
        ),
        (
            Button::new(
                look.say(device::UNSTAGE_ALL),
                look.say(device::UNSTAGE_ALL_TIP),
            )
            .disabled(nothing),
            ParamAction::UnstageAll,
        ),
        (
            Button::new(look.say(device::COPY), look.say(device::COPY_TIP)).disabled(unknown),
            ParamAction::CopyLive(None),
        ),
    ];
    for (button, wish) in tools {
        let width = controls::text_width(ui, button.text, theme::body()) + 2.0 * theme::PAD;
        let place = take_left(&mut row, width);
        let id = Id::unique(("device", format!("{wish:?}")));
        if button.put(ui, look, place, id).clicked() {
            pane.actions.push(Action::Param(wish));
        }
    }
}

/// One line: what is going on, or how old it all is.
fn status_ui(ui: &mut Ui, row: Rect, pane: &Pane<'_>) {
    let (words, color) = status(pane);
    Label::new(&words, color).small().put(ui, row);
}

fn status(pane: &Pane<'_>) -> (String, Color32) {
    let (look, state): (_, &State) = (pane.look, pane.state);
    let book = &state.hand().params;
    let say = |text: Text| look.say(text).to_owned();
    if let Some(doing) = verdicts::doing(book.doing) {
        return (say(doing), look.palette.accent);
    }
    if !state.hand().link.state.is_live() {
        return (say(device::NO_HAND), look.palette.warn);
    }
    if let Some(error) = &book.trouble {
        let error = crate::ui::text::errors::request(look, error);
        let words = format!("{} {error}", look.say(device::TROUBLE));
        return (words, look.palette.warn);
    }
    match book.read_at {
        None => (say(device::NOT_READ), look.palette.muted),
        Some(at) => {
            let age = format::age(state.now.since(at));
            let words = format!(
                "{} {age} {}",
                look.say(device::READ_AT),
                look.say(device::AGO)
            );
            (words, look.palette.muted)
        }
    }
}
