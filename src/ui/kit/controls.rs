//! Basic widgets: placed by rectangle, painted from the theme, named for accessibility.

use crate::app::action::Action;
use crate::ui::kit::pane::{Pane, ViewRequest};
use crate::ui::style::Look;
use crate::ui::text::Text;
use crate::ui::theme::{self, Icon};
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, Align2, Color32, CornerRadius, Event, FontId, Frame, Id, Layout, Margin, Panel,
    PointerButton, Popup, PopupCloseBehavior, Pos2, ProgressBar, Rect, RectAlign, Response,
    RichText, Role, Sense, Stroke, StrokeKind, TouchPhase, Ui, Vec2, WidgetInfo, vec2,
};
use egui_extras::{TableBuilder, TableRow};

/// Seconds for which a disabled control shows its reason after a press.
const REASON_S: f32 = 3.0;
/// Maximum characters of a one-line text field.
const EDIT_MAX: usize = 128;

/// A text at a position. Truncated with dots if it is too long, with the full text in its tooltip.
#[derive(Debug, Clone)]
pub(crate) struct Label<'a> {
    text: &'a str,
    font: FontId,
    color: Color32,
    align: Align2,
    name: Option<&'a str>,
    wraps: bool,
}

impl<'a> Label<'a> {
    /// Body text, left-aligned and vertically centred.
    pub(crate) const fn new(text: &'a str, color: Color32) -> Self {
        Self {
            text,
            font: theme::body(),
            color,
            align: Align2::LEFT_CENTER,
            name: None,
            wraps: false,
        }
    }

    /// A sentence in the window's language.
    pub(crate) const fn text(look: Look, text: Text) -> Self {
        Self::new(look.tr(text), look.palette.text)
    }

    /// A muted sentence.
    pub(crate) const fn muted(look: Look, text: Text) -> Self {
        Self::new(look.tr(text), look.palette.muted)
    }

    /// A small muted sentence.
    pub(crate) fn note(look: Look, text: Text) -> Self {
        Self::muted(look, text).small()
    }

    pub(crate) fn font(mut self, font: FontId) -> Self {
        self.font = font;
        self
    }

    pub(crate) fn small(self) -> Self {
        self.font(theme::small())
    }

    /// Uses the font of what is read first.
    pub(crate) fn large(self) -> Self {
        self.font(theme::large())
    }

    /// Uses digits of equal width.
    pub(crate) fn number(self) -> Self {
        self.font(theme::number())
    }

    /// Right-aligned.
    pub(crate) fn right(mut self) -> Self {
        self.align = Align2::RIGHT_CENTER;
        self
    }

    /// Centred.
    pub(crate) fn center(mut self) -> Self {
        self.align = Align2::CENTER_CENTER;
        self
    }

    /// Accessible name: the quantity that the text is the value of.
    pub(crate) fn named(mut self, name: &'a str) -> Self {
        self.name = Some(name);
        self
    }

    /// Wraps over as many lines as it needs.
    pub(crate) fn wrap(mut self) -> Self {
        self.wraps = true;
        self
    }

    /// Draws it at the cursor of `ui`.
    pub(crate) fn ui(self, ui: &mut Ui) -> Response {
        let rich = RichText::new(self.text)
            .font(self.font.clone())
            .color(self.color);
        let label = egui::Label::new(rich);
        let response = ui.add(if self.wraps {
            label.wrap()
        } else {
            label.truncate()
        });
        if let Some(name) = self.name {
            name_reading(&response, name, self.text);
        }
        response
    }

    /// Draws it in a cell of this width in a row.
    pub(crate) fn cell_ui(self, ui: &mut Ui, width: f32) -> Response {
        cell_ui(ui, vec2(width, theme::CONTROL), |ui| self.ui(ui))
    }

    /// Draws it in the next column of a table row.
    pub(crate) fn column_ui(self, row: &mut TableRow<'_, '_>) {
        row.col(|ui| drop(self.ui(ui)));
    }

    /// Draws it in `rect`, outside the layout.
    pub(crate) fn put(self, ui: &mut Ui, rect: Rect) -> Response {
        // Not allocated: that would move the list's cursor back to the end of this rectangle.
        let id = ui.next_auto_id();
        ui.skip_ahead_auto_ids(1);
        let mut response = ui.interact(rect, id, Sense::hover());
        let elided = self.paint(ui, rect);
        self.name_node(&response);
        if elided {
            response = response.on_hover_text(self.text);
        }
        response
    }

    /// Makes a sensed area this label for screen readers.
    pub(crate) fn name_node(&self, response: &Response) {
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, self.text));
        if let Some(name) = self.name {
            name_reading(response, name, self.text);
        }
    }

    /// Paints the text only: no accessibility node, no tooltip. True if it was truncated.
    pub(crate) fn paint(&self, ui: &Ui, rect: Rect) -> bool {
        let text = self.text.to_owned();
        let mut job = LayoutJob::simple_singleline(text, self.font.clone(), self.color);
        job.wrap = TextWrapping::truncate_at_width(rect.width().max(0.0));
        let galley = ui.painter().layout_job(job);
        let elided = galley.elided;
        let at = self.align.align_size_within_rect(galley.size(), rect).min;
        ui.painter().galley(at, galley, self.color);
        elided
    }
}

/// Gives a screen reader the name of the quantity with its value: it reads the value of a label alone.
fn name_reading(response: &Response, name: &str, text: &str) {
    let value = format!("{name}: {}", text.trim());
    response.ctx.accesskit_node_builder(response.id, |node| {
        node.set_label(name);
        node.set_value(value);
    });
}

/// Sets the accessible name of a widget, in place of its text.
pub(crate) fn set_accessible_name(response: &Response, name: &str) {
    response
        .ctx
        .accesskit_node_builder(response.id, |node| node.set_label(name));
}

/// Senses clicks if enabled, else hover only.
pub(crate) fn click_if(enabled: bool) -> Sense {
    if enabled {
        Sense::click()
    } else {
        Sense::hover()
    }
}

/// Width of a text on one line, in points.
pub(crate) fn text_width(ui: &Ui, text: &str, font: FontId) -> f32 {
    let (text, color) = (text.to_owned(), Color32::PLACEHOLDER);
    let galley = ui.painter().layout_no_wrap(text, font, color);
    galley.size().x
}

/// Visual weight of a button.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    /// An ordinary button.
    Normal,
    /// The selected one of several.
    Chosen,
    /// The main action.
    Strong,
    /// No background until hovered.
    Quiet,
    /// Armed: setpoints pass.
    Armed,
    /// Cannot simply be undone.
    Danger,
    Stop,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Button<'a> {
    /// Visible text.
    pub(crate) text: &'a str,
    /// Accessible name; the text if `None`.
    pub(crate) name: Option<&'a str>,
    /// Tooltip sentence.
    pub(crate) tip: &'a str,
    /// Reason why it is disabled now.
    pub(crate) disabled: Option<&'a str>,
    pub(crate) weight: Weight,
    /// On or off; `None` if it is not a switch.
    pub(crate) selected: Option<bool>,
    /// An icon in place of the text, which stays the accessible name.
    pub(crate) icon: Option<Icon>,
    /// Height in points.
    pub(crate) height: f32,
}

impl<'a> Button<'a> {
    /// An ordinary button.
    pub(crate) const fn new(text: &'a str, tip: &'a str) -> Self {
        Self {
            text,
            name: None,
            tip,
            disabled: None,
            weight: Weight::Normal,
            selected: None,
            icon: None,
            height: theme::CONTROL,
        }
    }

    /// An ordinary button with a translated text and tip.
    pub(crate) const fn text(look: Look, text: Text) -> Self {
        Self::new(look.tr(text), look.tip(text))
    }

    /// Replaces the tooltip.
    pub(crate) const fn tip(mut self, tip: &'a str) -> Self {
        self.tip = tip;
        self
    }

    /// Strong if `is_so`, else normal.
    pub(crate) const fn strong_if(self, is_so: bool) -> Self {
        let strong = Weight::Strong;
        self.weight(if is_so { strong } else { Weight::Normal })
    }

    /// Height of the most important controls.
    pub(crate) const fn large(mut self) -> Self {
        self.height = theme::CONTROL_LARGE;
        self
    }

    pub(crate) const fn weight(mut self, weight: Weight) -> Self {
        self.weight = weight;
        self
    }

    /// Sets a longer accessible name.
    pub(crate) const fn named(mut self, name: &'a str) -> Self {
        self.name = Some(name);
        self
    }

    /// Disabled for this reason.
    pub(crate) const fn disabled(mut self, reason: Option<&'a str>) -> Self {
        self.disabled = reason;
        self
    }

    /// Disabled for this reason if `is_so`.
    pub(crate) const fn disabled_if(self, is_so: bool, reason: &'a str) -> Self {
        self.disabled(if is_so { Some(reason) } else { None })
    }

    /// One of a row, of which one is selected.
    pub(crate) const fn choice(self, selected: bool) -> Self {
        let quiet = Weight::Quiet;
        let weight = if selected { Weight::Chosen } else { quiet };
        self.selected(selected).weight(weight)
    }

    /// A switch that is on or off.
    pub(crate) const fn switch(self, on: bool) -> Self {
        let normal = Weight::Normal;
        let weight = if on { Weight::Chosen } else { normal };
        self.selected(on).weight(weight)
    }

    /// Reports on or off to a screen reader, with unchanged weight.
    pub(crate) const fn selected(mut self, on: bool) -> Self {
        self.selected = Some(on);
        self
    }

    /// Shows an icon in place of its text, which stays the accessible name.
    pub(crate) const fn icon(mut self, icon: Icon) -> Self {
        self.icon = Some(icon);
        self
    }

    /// Draws it at the cursor of `ui`, as wide as its text; a justified layout makes it wider.
    pub(crate) fn ui(self, ui: &mut Ui, look: Look) -> Response {
        let width = match self.icon {
            Some(_) => self.height.max(theme::CONTROL),
            None => text_width(ui, self.text, self.font()) + 2.0 * theme::PAD,
        };
        let height = self.height.max(ui.spacing().interact_size.y);
        let (id, rect) = ui.allocate_space(vec2(width, height));
        self.put(ui, look, rect, id)
    }

    /// Draws it, and pushes `action` on a click.
    pub(crate) fn on_click(mut self, ui: &mut Ui, pane: &mut Pane<'_>, action: Action) {
        let recorded = pane.recorded().filter(|_| !action.passes_in_replay());
        self.disabled = recorded.or(self.disabled);
        if self.ui(ui, pane.look).clicked() {
            pane.actions.push(action);
        }
    }

    /// Draws it, and opens a view on a click.
    pub(crate) fn navigate(self, ui: &mut Ui, pane: &mut Pane<'_>, request: ViewRequest) {
        if self.ui(ui, pane.look).clicked() {
            pane.open(request);
        }
    }

    /// Draws it, and flips `on` on a click.
    pub(crate) fn toggle(self, ui: &mut Ui, look: Look, on: &mut bool) {
        *on ^= self.ui(ui, look).clicked();
    }

    const fn font(&self) -> FontId {
        match self.weight {
            Weight::Stop => theme::large(),
            _ => theme::body(),
        }
    }

    /// Draws it as a knob on a track, on at the right end.
    pub(crate) fn toggle_ui(self, ui: &mut Ui, look: Look) -> Response {
        let (id, place) = ui.allocate_space(vec2(theme::SWITCH, theme::CONTROL));
        let response = self.weight(Weight::Quiet).ground(ui, look, place, id);
        let is_on = self.selected == Some(true);
        let share = ui.ctx().animate_bool_responsive(id, is_on);
        let palette = look.palette;
        let (track, knob) = match (self.disabled, is_on) {
            (Some(_), _) => (palette.sunken, palette.faint),
            (None, true) => (palette.accent, palette.on_accent),
            (None, false) => (palette.sunken, palette.muted),
        };
        let rect = Rect::from_center_size(place.center(), vec2(32.0, 18.0));
        let (half, edge) = (rect.height() / 2.0, Stroke::new(1.0, palette.faint));
        let painter = ui.painter();
        painter.rect(rect, half, track, edge, StrokeKind::Inside);
        let ends = rect.shrink2(vec2(half, 0.0)).x_range();
        let at = egui::pos2(egui::lerp(ends.min..=ends.max, share), rect.center().y);
        painter.circle_filled(at, half - 4.0, knob);
        response
    }

    /// Draws it in `rect`; its response reports the click.
    pub(crate) fn put(self, ui: &mut Ui, look: Look, rect: Rect, id: Id) -> Response {
        let response = self.ground(ui, look, rect, id);
        let color = self.text_color(look);
        if let Some(icon) = self.icon {
            sign(ui, rect, icon, color);
            return response;
        }
        let font = self.font();
        let inner = rect.shrink2(vec2(theme::STEP, 0.0));
        let label = Label::new(self.text, color).font(font).center();
        label.paint(ui, inner);
        response
    }

    /// Draws the button without its text, for callers that paint their own.
    pub(crate) fn ground(self, ui: &mut Ui, look: Look, rect: Rect, id: Id) -> Response {
        let enabled = self.disabled.is_none() && ui.is_enabled();
        let response = ui.interact(rect, id, click_if(enabled));
        let name = self.name.unwrap_or(self.text);
        response.widget_info(|| match self.selected {
            Some(selected) => WidgetInfo::selected(Role::Button, enabled, selected, name),
            None => WidgetInfo::labeled(Role::Button, enabled, name),
        });
        let (fill, edge) = self.colors(look, &response);
        let round = match self.weight {
            Weight::Stop => theme::ROUND,
            _ => theme::ROUND_SMALL,
        };
        let edge = Stroke::new(1.0, edge);
        ui.painter()
            .rect(rect, round, fill, edge, StrokeKind::Inside);
        focus_ring(ui, look, &response, rect);
        let tip = match self.disabled {
            Some(reason) => format!("{}\n{reason}", self.tip).trim().to_owned(),
            None => self.tip.to_owned(),
        };
        let disabled = self.disabled;
        let is_shown = disabled.is_some_and(|reason| press_reason_ui(ui, &response, reason));
        let response = if tip.is_empty() || is_shown {
            response
        } else {
            response.on_hover_text(tip)
        };
        match disabled {
            Some(_) => response,
            None => response.on_hover_cursor(egui::CursorIcon::PointingHand),
        }
    }

    /// Colour of the text.
    pub(crate) fn text_color(self, look: Look) -> Color32 {
        let palette = look.palette;
        match (self.disabled, self.weight) {
            (Some(_), _) => palette.faint,
            (None, Weight::Normal | Weight::Chosen) => palette.text,
            (None, Weight::Quiet) => palette.muted,
            (None, Weight::Strong) => palette.on_accent,
            (None, Weight::Stop) => palette.on_strong,
            (None, Weight::Armed) => palette.on_armed,
            (None, Weight::Danger) => palette.bad,
        }
    }

    fn colors(self, look: Look, response: &Response) -> (Color32, Color32) {
        let palette = look.palette;
        let hot = response.hovered() && self.disabled.is_none();
        if self.disabled.is_some() {
            return match self.weight {
                Weight::Quiet => (Color32::TRANSPARENT, Color32::TRANSPARENT),
                _ => (palette.card, palette.edge),
            };
        }
        match self.weight {
            Weight::Normal if hot => (palette.control_hover, palette.faint),
            Weight::Normal => (palette.control, palette.edge),
            Weight::Quiet if hot => (palette.control, Color32::TRANSPARENT),
            Weight::Quiet => (Color32::TRANSPARENT, Color32::TRANSPARENT),
            Weight::Chosen => (palette.wash(palette.accent), palette.accent),
            Weight::Strong => (palette.accent, palette.accent),
            Weight::Armed => (palette.armed, palette.armed),
            Weight::Danger if hot => (palette.wash(palette.bad), palette.bad),
            Weight::Danger => (palette.control, palette.bad),
            Weight::Stop if hot => (palette.stop_hover, palette.stop_edge),
            Weight::Stop => (palette.stop, palette.stop_edge),
        }
    }
}

/// Shows the reason on a press on a disabled control; true while it is shown.
fn press_reason_ui(ui: &Ui, response: &Response, reason: &str) -> bool {
    let id = Id::unique("told why not");
    let (pressed, now) = ui.input(|input| (input.pointer.primary_pressed(), input.time));
    if pressed && response.contains_pointer() {
        ui.data_mut(|data| data.insert_temp(id, (response.id, now + f64::from(REASON_S))));
        ui.ctx().request_repaint_after_secs(REASON_S);
    }
    let last: Option<(Id, f64)> = ui.data(|data| data.get_temp(id));
    if last.is_none_or(|(shown, until)| shown != response.id || now > until) {
        return false;
    }
    let layer = response.layer_id;
    let tip = egui::Tooltip::always_open(ui.ctx().clone(), layer, response.id.with(id), response);
    tip.show(|ui| ui.label(reason));
    true
}

/// A thin ring around the widget with the keyboard focus.
pub(crate) fn focus_ring(ui: &Ui, look: Look, response: &Response, rect: Rect) {
    if response.has_focus() {
        let round = CornerRadius::same(theme::ROUND_SMALL + 2);
        let stroke = Stroke::new(theme::FOCUS_LINE, look.palette.accent);
        ui.painter()
            .rect_stroke(rect.expand(2.0), round, stroke, StrokeKind::Outside);
    }
}

/// A card as wide as `ui`.
pub(crate) fn card_ui<R>(ui: &mut Ui, look: Look, add: impl FnOnce(&mut Ui) -> R) -> R {
    let frame = Frame::new()
        .fill(look.palette.card)
        .stroke(Stroke::new(1.0, look.palette.edge))
        .corner_radius(theme::ROUND)
        .inner_margin(theme::PAD);
    let shown = frame.show(ui, |ui| {
        ui.set_min_width(ui.available_width());
        add(ui)
    });
    shown.inner
}

/// A card over all the available space.
pub(crate) fn full_card_ui(ui: &mut Ui, look: Look, add: impl FnOnce(&mut Ui)) {
    card_ui(ui, look, |ui| {
        ui.set_min_height(ui.available_height());
        ui.vertical(add);
    });
}

/// Moves the scroll bars of lists that fill a card into its margin, so that they cover nothing. Within a panel they would be cut.
pub(crate) fn put_scroll_bar_in_margin(ui: &mut Ui) {
    let scroll = &mut ui.spacing_mut().scroll;
    scroll.bar_width = theme::GAP;
    scroll.bar_outer_margin = -theme::GAP;
}

/// A table whose cells lay out their content left to right, vertically centred.
pub(crate) fn table<'a>(ui: &'a mut Ui, id: impl egui::AsIdSalt) -> TableBuilder<'a> {
    let row = Layout::left_to_right(Align::Center);
    TableBuilder::new(ui).id_salt(id).cell_layout(row)
}

/// The title row of a card; `right` adds content at its right end, from right to left.
pub(crate) fn head_ui<R>(
    ui: &mut Ui,
    look: Look,
    title: &str,
    right: impl FnOnce(&mut Ui) -> R,
) -> R {
    let row = ui.horizontal(|ui| {
        ui.set_min_height(theme::CONTROL);
        let title = RichText::new(title).font(theme::body());
        ui.add(egui::Label::new(title.color(look.palette.muted)));
        let left = Layout::right_to_left(Align::Center);
        ui.with_layout(left, right).inner
    });
    row.inner
}

/// A one-line text field that is applied as it is typed, with its accessible name and a hint shown while it is empty.
pub(crate) fn edit_ui(ui: &mut Ui, name: &str, hint: &str, text: &mut String) -> Response {
    let edit = egui::TextEdit::singleline(text)
        .hint_text(hint.to_owned())
        .char_limit(EDIT_MAX)
        .margin(theme::FIELD_INSET)
        .align(Align2::LEFT_CENTER)
        .desired_width(ui.available_width());
    let response = ui.add(edit);
    named_field(&response, name, true, text);
    response
}

/// Same as [`edit_ui`], with a translated name and hint.
pub(crate) fn translated_edit_ui(
    ui: &mut Ui,
    look: Look,
    label: Text,
    text: &mut String,
) -> Response {
    edit_ui(ui, look.tr(label), look.tip(label), text)
}

/// A panel of fixed size without a border, with `gap` left free around its content.
pub(crate) fn bare(panel: Panel, size: f32, gap: Margin) -> Panel {
    let panel = panel.exact_size(size).resizable(false);
    panel
        .show_separator_line(false)
        .frame(Frame::new().inner_margin(gap))
}

/// Lays out content from left to right.
pub(crate) fn left_ui<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let row = Layout::left_to_right(Align::Center);
    ui.with_layout(row, add).inner
}

/// Lays out content from right to left.
pub(crate) fn right_ui<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let row = Layout::right_to_left(Align::Center);
    ui.with_layout(row, add).inner
}

/// Stretches content to the available width.
pub(crate) fn wide_ui<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let wide = Layout::top_down_justified(Align::Center);
    ui.with_layout(wide, add).inner
}

/// A cell of fixed size in a row, whatever its content.
pub(crate) fn cell_ui<R>(ui: &mut Ui, size: Vec2, add: impl FnOnce(&mut Ui) -> R) -> R {
    let row = Layout::left_to_right(Align::Center);
    let cell = ui.allocate_ui_with_layout(size, row, |ui| {
        ui.set_min_size(size);
        add(ui)
    });
    cell.inner
}

/// Completed share of a total, 0..=1.
pub(crate) fn share(done: usize, total: usize) -> f32 {
    let count = |number: usize| f32::from(u16::try_from(number).unwrap_or(u16::MAX));
    count(done) / count(total.max(1))
}

/// A progress bar with an accessible name.
pub(crate) fn progress_ui(ui: &mut Ui, look: Look, name: &str, share: f32) {
    let bar = ProgressBar::new(share).desired_height(6.0);
    let bar = ui.add(bar.fill(look.palette.accent));
    bar.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, name));
}

/// Small text that wraps.
pub(crate) fn small_text_ui(ui: &mut Ui, text: &str, color: Color32) -> Response {
    Label::new(text, color).small().wrap().ui(ui)
}

/// Sets the accessible name and value of a text field.
pub(crate) fn named_field(response: &Response, name: &str, enabled: bool, text: &str) {
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::TextInput, enabled, name);
        info.current_text_value = Some(text.to_owned());
        info
    });
}

/// A button for each of several values, one of which is selected.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pick {
    look: Look,
    tip: Text,
}

impl Pick {
    /// `tip` is the tooltip of values whose text has none.
    pub(crate) const fn new(look: Look, tip: Text) -> Self {
        Self { look, tip }
    }

    /// Draws the buttons; true if the selection changed.
    pub(crate) fn ui<T: Copy + PartialEq>(
        self,
        ui: &mut Ui,
        chosen: &mut T,
        all: impl IntoIterator<Item = (T, Text)>,
    ) -> bool {
        let (look, before) = (self.look, *chosen);
        for (value, text) in all {
            let own = look.tip(text);
            let tip = if own.is_empty() {
                look.tr(self.tip)
            } else {
                own
            };
            let button = Button::new(look.tr(text), tip).choice(before == value);
            if button.ui(ui, look).clicked() {
                *chosen = value;
            }
        }
        before != *chosen
    }
}

/// A popup below a button, closed by a click outside it only.
pub(crate) fn lasting_popup(button: &Response) -> Popup<'_> {
    Popup::menu(button).close_behavior(PopupCloseBehavior::CloseOnClickOutside)
}

/// The same above the button: it never lies on the tiles below, which move the hand, and its lower edge stays where it is.
pub(crate) fn popup_above(button: &Response) -> Popup<'_> {
    lasting_popup(button)
        .align(RectAlign::TOP_END)
        .align_alternatives(&[RectAlign::TOP, RectAlign::TOP_START])
}

/// A menu entry; true if it was pressed.
pub(crate) fn entry_ui(ui: &mut Ui, look: Look, text: Text) -> bool {
    let button = ui.button(look.tr(text));
    button.on_hover_text(look.tip(text)).clicked()
}

/// A labelled check box; true if it was changed.
pub(crate) fn tick_ui(ui: &mut Ui, look: Look, text: Text, on: &mut bool) -> bool {
    let tick = ui.checkbox(on, look.tr(text));
    tick.on_hover_text(look.tip(text)).changed()
}

/// A drop-down list; true if the selection changed.
pub(crate) fn choose_ui<T: Clone + PartialEq, S: AsRef<str>>(
    ui: &mut Ui,
    name: &str,
    chosen: &mut T,
    all: &[(T, S)],
) -> bool {
    let text = all.iter().find(|(value, _)| value == chosen);
    let before = chosen.clone();
    let shown = egui::ComboBox::from_id_salt(name)
        .selected_text(text.map_or("-", |(_, text)| text.as_ref()))
        .show_ui(ui, |ui| {
            for (value, text) in all {
                ui.selectable_value(chosen, value.clone(), text.as_ref());
            }
        });
    set_accessible_name(&shown.response, name);
    *chosen != before
}

/// True in the frame in which `response` is pressed, or activated by a key or a screen reader. A stop does not wait for the
/// release, and is not lost when a slow frame sees press and release after the pointer has left.
pub(crate) fn pressed(ui: &Ui, response: &Response) -> bool {
    if !ui.is_enabled() {
        return false;
    }
    let down = |event: &Event| match event {
        Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed: true,
            ..
        } => response.rect.contains(*pos),
        // A second finger on the screen produces no pointer event.
        Event::Touch {
            phase: TouchPhase::Start,
            pos,
            ..
        } => response.rect.contains(*pos),
        _ => false,
    };
    let (went_down, by_pointer) = ui.input(|input| {
        let went_down = input.events.iter().any(down);
        (went_down, input.pointer.primary_released())
    });
    went_down || response.clicked() && !by_pointer
}

/// Allocates the space of a lamp before a text, lit if `color` is given. Returns its centre.
pub(crate) fn lamp_ui(ui: &mut Ui, color: Option<Color32>) -> Pos2 {
    let size = vec2(2.0 * theme::LAMP_AT, theme::TEXT_LINE);
    let center = ui.allocate_space(size).1.center();
    if let Some(color) = color {
        lamp(ui, center, color);
    }
    center
}

/// A round lamp with a halo.
pub(crate) fn lamp(ui: &Ui, center: Pos2, color: Color32) {
    let painter = ui.painter();
    let halo = color.gamma_multiply(0.22);
    painter.circle_filled(center, theme::LAMP + theme::HALO, halo);
    painter.circle_filled(center, theme::LAMP, color);
}

/// An icon in the middle of a rectangle.
pub(crate) fn sign(ui: &Ui, rect: Rect, sign: Icon, color: Color32) {
    let center = Align2::CENTER_CENTER;
    ui.painter()
        .text(rect.center(), center, sign, theme::icon(), color);
}

/// A warning sign before a text.
pub(crate) fn warning_ui(ui: &mut Ui, color: Color32) -> Response {
    let size = Vec2::splat(theme::SIGN_SMALL);
    let (place, response) = ui.allocate_exact_size(size, Sense::hover());
    let (font, center) = (theme::icon_high(size.y), Align2::CENTER_CENTER);
    ui.painter()
        .text(place.center(), center, theme::WARNING, font, color);
    response
}
