//! Lists that scroll inside their place, line by line, with texts of as many lines as they need. Knows no list's meaning.

use crate::ui::theme;
use egui::text::LayoutJob;
use egui::{Color32, Id, Rect, Response, Ui, UiBuilder, pos2, vec2};

/// A list at a place. `lines` adds them from top to bottom with [`piece`], in the width that it is given.
pub(crate) fn scroll_ui(ui: &mut Ui, rect: Rect, salt: &str, lines: impl FnOnce(&mut Ui, f32)) {
    ui.scope_builder(UiBuilder::new().max_rect(rect).id_salt(salt), |ui| {
        ui.shrink_clip_rect(rect);
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| lines(ui, rect.width() - theme::GAP));
    });
}

/// A piece of the list of the given height.
pub(crate) fn piece(ui: &mut Ui, width: f32, height: f32) -> Rect {
    ui.allocate_space(vec2(width, height)).1
}

/// Text over as many lines as it needs; where it stands.
pub(crate) fn wrapped_ui(
    ui: &mut Ui,
    width: f32,
    indent: f32,
    text: &str,
    color: Color32,
) -> Response {
    let job = LayoutJob::simple(text.to_owned(), theme::small(), color, width - indent);
    job_ui(ui, width, indent, job)
}

fn job_ui(ui: &mut Ui, width: f32, indent: f32, job: LayoutJob) -> Response {
    let text = job.text.clone();
    let galley = ui.painter().layout_job(job);
    let place = piece(ui, width, galley.size().y + 2.0);
    let id: Id = ui.next_auto_id().with(&text);
    ui.skip_ahead_auto_ids(1);
    let response = ui.interact(place, id, egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
    let at = pos2(place.left() + indent, place.top());
    ui.painter().galley(at, galley, Color32::PLACEHOLDER);
    response
}
