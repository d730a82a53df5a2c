//! The six drives as a row of tiles: lamp, what each says, heat and current. A tile is chosen to hear more of it.

use crate::app::hand::Freshness;
use crate::hand::Dof;
use crate::ui::faults::entry as fault_entry;
use crate::ui::joints::drive_lamp::DriveWords;
use crate::ui::joints::newest::newest;
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, Weight, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::list::{INDENT, LAMP_AT, TITLE_LINE};
use crate::ui::kit::look::Pane;
use crate::ui::text::{faults, words};
use crate::ui::theme;
use egui::{CornerRadius, Id, Rect, Ui, pos2, vec2};

/// Height of a tile with its cause, and without.
const TALL: f32 = theme::DRIVE_TILE;
/// Most lines of a cause.
const CAUSE_LINES: u8 = 4;

/// The height that the tiles take of a view of this size.
pub(crate) fn height(view: Rect) -> f32 {
    match (
        view.width() >= theme::DRIVE_TILES_ROW,
        view.height() >= theme::DRIVE_TILES_ROOMY,
    ) {
        (true, true) => TALL,
        (true, false) => theme::DRIVE_TILE_LOW,
        (false, true) => 2.0 * 84.0 + theme::GAP,
        (false, false) => 2.0 * theme::DRIVE_TILE_LOW + theme::GAP,
    }
}

/// Draws them; the joint whose tile was pressed.
pub(crate) fn tiles_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &Pane<'_>,
    chosen: Option<Dof>,
) -> Option<Dof> {
    let (columns, rows) = if rect.width() >= theme::DRIVE_TILES_ROW {
        (6.0, 1.0)
    } else {
        (3.0, 2.0)
    };
    let gap = theme::GAP;
    let size = vec2(
        (rect.width() - gap * (columns - 1.0)) / columns,
        (rect.height() - gap * (rows - 1.0)) / rows,
    );
    let mut pressed = None;
    let mut at = rect.min;
    for dof in Dof::ALL {
        let place = Rect::from_min_size(at, size);
        if tile_ui(ui, place, pane, dof, chosen == Some(dof)) {
            pressed = Some(dof);
        }
        at.x += size.x + gap;
        if at.x + size.x > rect.right() + 1.0 {
            at = pos2(rect.left(), at.y + size.y + gap);
        }
    }
    pressed
}

fn tile_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, dof: Dof, chosen: bool) -> bool {
    let look = pane.look;
    let palette = look.palette;
    let joint = look.say(words::dof(dof));
    let said = DriveWords::of(pane, dof);
    let name = format!("{} {joint}", look.say(faults::DRIVE));
    let mut button = Button::new(joint, look.say(faults::DRIVE_TIP)).named(&name);
    button.selected = Some(chosen);
    button.weight = if chosen {
        Weight::Chosen
    } else {
        Weight::Normal
    };
    let response = button.ground(ui, look, rect, Id::unique(("drive", dof)));
    let bar = Rect::from_min_size(
        rect.min + vec2(0.0, theme::STEP),
        vec2(theme::BAR, rect.height() - theme::GAP),
    );
    ui.painter()
        .rect_filled(bar, CornerRadius::same(2), palette.dof[dof]);
    let mut inner = rect.shrink2(vec2(theme::GAP, theme::STEP));
    let mut head = take_top(&mut inner, TITLE_LINE);
    inner.min.y -= theme::GAP;
    unseen_mark_ui(ui, &mut head, pane, dof);
    figures_ui(ui, &mut head, pane, dof);
    Label::new(joint, palette.dof[dof]).put(ui, head);
    let mut line = take_top(&mut inner, TITLE_LINE);
    inner.min.y -= theme::GAP;
    controls::lamp(ui, pos2(line.left() + LAMP_AT, line.center().y), said.lamp);
    line.min.x += INDENT;
    code_ui(ui, &mut line, pane, dof);
    let ink = if said.freshness == Freshness::Live && said.text == palette.muted {
        palette.text
    } else {
        said.text
    };
    Label::new(&said.title, ink)
        .shorter(&said.short)
        .put(ui, line);
    if inner.height() > theme::CAUSE_LEAST
        && let Some(words) = said.words
    {
        let room = inner.shrink2(vec2(0.0, 2.0));
        let (font, ink) = (theme::small(), look.value(said.freshness, palette.muted));
        let mut job =
            egui::text::LayoutJob::simple(words.cause.to_owned(), font, ink, room.width());
        let line = ui.fonts_mut(|fonts| fonts.row_height(&theme::small()));
        job.wrap.max_rows = (1..=CAUSE_LINES)
            .take_while(|lines| f32::from(*lines) * line <= room.height() + 1.0)
            .last()
            .map_or(1, usize::from);
        let galley = ui.painter().layout_job(job);
        ui.painter()
            .with_clip_rect(room)
            .galley(room.min, galley, ink);
    }
    response.clicked()
}

/// Heat and current, short.
fn figures_ui(ui: &mut Ui, head: &mut Rect, pane: &Pane<'_>, dof: Dof) {
    let look = pane.look;
    let sample = &pane.state.hand().sample;
    let (heat, heat_age) = newest(pane, dof, sample.temperature);
    let (current, current_age) = newest(pane, dof, sample.current);
    let heat = format::whole(heat.map(|heat| heat.raw().into()), 0);
    let joint = look.say(words::dof(dof));
    let name = controls::text_width(ui, joint, theme::body()) + theme::GAP;
    let current = format::whole(current.map(|current| current.raw().into()), 0);
    for (text, age) in [
        (format!("{heat} °C"), heat_age),
        (format!("{current} mA"), current_age),
    ] {
        let width = controls::text_width(ui, &text, theme::number_small()) + 1.0;
        if head.width() - width < name {
            return;
        }
        let place = take_right(head, width);
        Label::new(&text, look.value(age, look.palette.muted))
            .font(theme::number_small())
            .right()
            .put(ui, place);
    }
}

/// The status code as the hand sent it.
fn code_ui(ui: &mut Ui, line: &mut Rect, pane: &Pane<'_>, dof: Dof) {
    let palette = pane.look.palette;
    let (status, _) = newest(pane, dof, pane.state.hand().sample.status);
    if let Some(status) = status {
        let code = status.raw().to_string();
        let width = controls::text_width(ui, &code, theme::number_small()) + 1.0;
        Label::new(&code, palette.faint)
            .font(theme::number_small())
            .right()
            .put(ui, take_right(line, width));
    }
}

/// A ring for faults of this joint that nobody has seen yet, cut from the right.
pub(crate) fn unseen_mark_ui(ui: &mut Ui, line: &mut Rect, pane: &Pane<'_>, dof: Dof) {
    let mut unseen = pane
        .state
        .hand()
        .faults
        .unseen()
        .filter(|entry| entry.dof == dof);
    let Some(first) = unseen.next() else { return };
    let palette = pane.look.palette;
    let color = if first.is_active() {
        palette.bad
    } else {
        palette.warn
    };
    let place = take_right(line, theme::UNSEEN_MARK);
    fault_entry::mark(ui, place.center(), color);
    let joint = pane.look.say(words::dof(dof));
    let name = format!("{joint} {}", pane.look.say(faults::UNSEEN_MARK));
    let id = ui.next_auto_id();
    ui.skip_ahead_auto_ids(1);
    let response = ui.interact(place, id, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &name));
    let tip = fault_entry::title(pane, dof, first.what);
    response.on_hover_text(format!("{tip}\n{}", pane.look.say(faults::OVER_UNSEEN)));
}
