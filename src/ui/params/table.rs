//! The table of what the hand keeps: a row for each parameter, each column with where its value comes from and how old it is.
//! Every change is an action that stages; nothing here writes.

use crate::app::action::Action;
use crate::app::hand::Freshness;
use crate::app::params::action::ParamAction;
use crate::hand::Dof;
use crate::params::changes::RowVerdict;
use crate::params::rows::{ParamId, Value};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left, take_right, take_top};
use crate::ui::kit::format;
use crate::ui::kit::format::UNKNOWN;
use crate::ui::kit::list;
use crate::ui::kit::look::Pane;
use crate::ui::kit::number::NumberField;
use crate::ui::kit::text_field::TextField;
use crate::ui::poses::editor::whole;
use crate::ui::text::{Text, device, verdicts};
use crate::ui::theme;
use egui::{Color32, Id, Rect, Ui};

/// Characters of an address.
const ADDRESS_MAX: usize = 15;

/// Which rows are shown.
#[derive(Debug, Default)]
pub(crate) struct Shown {
    /// Only those in which something differs.
    pub(crate) only: bool,
    /// Only those with these words.
    pub(crate) words: String,
}

impl Shown {
    fn passes(&self, pane: &Pane<'_>, id: ParamId) -> bool {
        if self.only && !pane.state.hand().params.differs(id) {
            return false;
        }
        let name = verdicts::whole_name(pane.look, id).to_lowercase();
        let register = id.register().name.to_lowercase();
        let all = format!("{name} {} {register}", id.name());
        let mut words = self.words.split_whitespace();
        words.all(|word| all.contains(&word.to_lowercase()))
    }
}

/// The columns of one row.
pub(crate) struct Columns {
    pub(crate) name: Rect,
    pub(crate) live: Rect,
    pub(crate) staged: Rect,
    pub(crate) saved: Rect,
    pub(crate) factory: Rect,
    pub(crate) range: Rect,
}

impl Columns {
    fn of(row: Rect) -> Self {
        let width = row.width();
        let mut rest = row;
        let [live, staged, saved, factory, range] = theme::DEVICE_COLUMNS.map(|part| width * part);
        let range = take_right(&mut rest, range);
        let factory = take_right(&mut rest, factory);
        let saved = take_right(&mut rest, saved);
        let staged = take_right(&mut rest, staged);
        let live = take_right(&mut rest, live);
        Self {
            name: rest,
            live,
            staged,
            saved,
            factory,
            range,
        }
    }
}

/// Rows that belong together.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Place,
    Speed,
    Force,
}

impl Part {
    const ALL: [Self; 3] = [Self::Speed, Self::Force, Self::Place];

    const fn has(self, id: ParamId) -> bool {
        match id {
            ParamId::DefaultSpeed(_) => matches!(self, Self::Speed),
            ParamId::DefaultForce(_) => matches!(self, Self::Force),
            _ => matches!(self, Self::Place),
        }
    }

    const fn words(self) -> (Text, Text) {
        match self {
            Self::Place => (device::GROUP_PLACE, device::ABOUT_PLACE),
            Self::Speed => (device::GROUP_SPEED, device::ABOUT_SPEED),
            Self::Force => (device::GROUP_FORCE, device::ABOUT_FORCE),
        }
    }
}

/// Draws the table.
pub(crate) fn table_ui(
    ui: &mut Ui,
    mut body: Rect,
    pane: &mut Pane<'_>,
    shown: &Shown,
    typed: &mut Option<(Id, String)>,
) {
    let look = pane.look;
    let head = take_top(&mut body, theme::LIST_LINE);
    body.min.y -= theme::STEP;
    head_ui(ui, head.with_max_x(head.right() - theme::GAP), pane);
    let rows: Vec<ParamId> = ParamId::all()
        .into_iter()
        .filter(|id| shown.passes(pane, *id))
        .collect();
    if rows.is_empty() {
        let text = match shown.words.trim().is_empty() {
            true => device::NO_DIFFERENCE,
            false => device::FIND_NONE,
        };
        let place = body.with_max_y((body.top() + theme::CONTROL_LARGE).min(body.bottom()));
        Label::new(look.say(text), look.palette.muted).put(ui, place);
        return;
    }
    list::scroll_ui(ui, body, "parameters", |ui, width| {
        // All places first: a field inside a row would take the list's cursor back to its own end.
        let mut places = Vec::new();
        for part in Part::ALL {
            let own = rows.iter().copied().filter(|id| part.has(*id));
            let own: Vec<ParamId> = own.collect();
            if own.is_empty() {
                continue;
            }
            places.push((
                list::piece(ui, width, theme::CONTROL_LARGE),
                Line::Part(part),
            ));
            for id in own {
                let place = list::piece(ui, width, height(pane, id));
                places.push((place, Line::Row(id)));
            }
        }
        for (place, line) in places {
            match line {
                Line::Part(part) => part_ui(ui, place, pane, part),
                Line::Row(id) => row_ui(ui, place, pane, id, typed),
            }
        }
    });
}

/// One line of the table.
enum Line {
    Part(Part),
    Row(ParamId),
}

/// What went wrong with a row has a line of its own below it.
fn height(pane: &Pane<'_>, id: ParamId) -> f32 {
    let row = match id.is_place() {
        true => theme::DEVICE_ROW_HIGH,
        false => theme::DEVICE_ROW,
    };
    match trouble(pane, id) {
        true => row + theme::LIST_LINE,
        false => row,
    }
}

/// True if the last write of a row did not end as it should.
fn trouble(pane: &Pane<'_>, id: ParamId) -> bool {
    let end = pane.state.hand().params.outcome(id);
    end.is_some_and(|end| end.verdict != RowVerdict::Applied)
}

fn head_ui(ui: &mut Ui, row: Rect, pane: &Pane<'_>) {
    let look = pane.look;
    let columns = Columns::of(row.shrink2(egui::vec2(theme::STEP, 0.0)));
    for (place, text) in [
        (columns.name, device::NAME),
        (columns.live, device::LIVE),
        (columns.staged, device::STAGED),
        (columns.saved, device::SAVED),
        (columns.factory, device::FACTORY),
        (columns.range, device::RANGE),
    ] {
        let label = Label::new(look.say(text), look.palette.muted).small();
        label.put(ui, place);
    }
}

fn part_ui(ui: &mut Ui, mut place: Rect, pane: &Pane<'_>, part: Part) {
    let look = pane.look;
    let (title, about) = part.words();
    let line = place.with_min_y(place.bottom() - 1.0);
    ui.painter().rect_filled(line, 0.0, look.palette.grid);
    let title = look.say(title);
    let title_width = controls::text_width(ui, title, theme::title()) + 1.0;
    Label::new(title, look.palette.text)
        .font(theme::title())
        .put(ui, take_left(&mut place, title_width));
    Label::new(look.say(about), look.palette.muted)
        .small()
        .put(ui, place);
}

fn row_ui(
    ui: &mut Ui,
    row: Rect,
    pane: &mut Pane<'_>,
    id: ParamId,
    typed: &mut Option<(Id, String)>,
) {
    let palette = pane.look.palette;
    if pane.state.hand().params.staged(id).is_some() {
        ui.painter()
            .rect_filled(row, theme::ROUND_SMALL, palette.wash(palette.accent));
    }
    let mut row = row.shrink2(egui::vec2(theme::STEP, 0.0));
    if trouble(pane, id) {
        let (upper, lower) = row.split_top_bottom_at_y(row.bottom() - theme::LIST_LINE);
        row = upper;
        verdict_ui(ui, lower, pane, id);
    }
    if id.is_place() {
        let (upper, lower) = row.split_top_bottom_at_y(row.bottom() - theme::LIST_LINE);
        row = upper;
        let about = pane.look.say(verdicts::about(id));
        Label::new(about, palette.muted).small().put(ui, lower);
    }
    let columns = Columns::of(row);
    name_ui(ui, columns.name, pane, id);
    live_ui(ui, columns.live, pane, id);
    staged_ui(ui, columns.staged, pane, id, typed);
    saved_ui(ui, columns.saved, pane, id);
    let factory = value_text(id.factory());
    let name = cell_name(pane, id, device::FACTORY);
    cell_ui(ui, columns.factory, (&name, &factory, palette.muted), "");
    let range = match id.range() {
        Some((min, max)) => format!("{min}..{max}"),
        None => pane.look.say(device::ADDRESS_HINT).to_owned(),
    };
    let unit = match id.unit() {
        "" => String::new(),
        unit => format!(" {unit}"),
    };
    let section = format!(
        "{} {}",
        pane.look.say(device::MANUAL),
        id.register().section
    );
    let name = cell_name(pane, id, device::RANGE);
    let range = format!("{range}{unit}");
    cell_ui(ui, columns.range, (&name, &range, palette.muted), &section);
}

/// What a screen reader says before a value: `Index speed live`.
pub(crate) fn cell_name(pane: &Pane<'_>, id: ParamId, column: Text) -> String {
    let name = verdicts::whole_name(pane.look, id);
    format!("{name} {}", pane.look.say(column).to_lowercase())
}

pub(crate) fn value_text(value: Option<Value>) -> String {
    value.map_or_else(|| UNKNOWN.into(), |value| value.to_string())
}

/// A value over what is to be known of it.
pub(crate) fn cell_ui(
    ui: &mut Ui,
    rect: Rect,
    (name, value, color): (&str, &str, Color32),
    below: &str,
) {
    let muted = ui.visuals().weak_text_color();
    let (upper, lower) = halves(rect, below);
    let fits = controls::text_width(ui, value, theme::number()) <= rect.width();
    let label = Label::new(value, color).named(name);
    let label = if fits { label.number() } else { label.small() };
    label.put(ui, upper);
    if !below.is_empty() {
        Label::new(below, muted).small().put(ui, lower);
    }
}

fn halves(rect: Rect, below: &str) -> (Rect, Rect) {
    let rect = controls::middle(rect, theme::DEVICE_ROW - theme::STEP);
    match below.is_empty() {
        true => (rect, rect),
        false => rect.split_top_bottom_at_y(rect.center().y),
    }
}

fn name_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, id: ParamId) {
    let look = pane.look;
    let palette = look.palette;
    let color = match id {
        ParamId::DefaultSpeed(dof) | ParamId::DefaultForce(dof) => palette.dof[dof],
        _ => palette.text,
    };
    let is_applied = pane.state.hand().params.outcome(id).is_some() && !trouble(pane, id);
    let below = match is_applied {
        true => look.say(device::APPLIED),
        false => "",
    };
    let (upper, lower) = halves(rect, below);
    let response = Label::new(look.say(verdicts::name(id)), color).put(ui, upper);
    response.on_hover_text(look.say(verdicts::about(id)));
    if is_applied {
        let verdict = cell_name(pane, id, device::VERDICT);
        let label = Label::new(below, palette.ok).small();
        label.named(&verdict).put(ui, lower);
    }
}

/// What went wrong with a row, and what the hand said.
fn verdict_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, id: ParamId) {
    let Some(end) = pane.state.hand().params.outcome(id) else {
        return;
    };
    let palette = pane.look.palette;
    let color = match &end.verdict {
        RowVerdict::Unverified(_) | RowVerdict::NotSent(_) => palette.warn,
        _ => palette.bad,
    };
    let words = verdicts::row_end(pane.look, end);
    let name = cell_name(pane, id, device::VERDICT);
    Label::new(&words, color).small().named(&name).put(ui, rect);
}

fn live_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, id: ParamId) {
    let live = pane.state.hand().params.live(id);
    let fresh = pane.state.hand().param_freshness(id);
    let color = pane.look.value(fresh, pane.look.palette.text);
    let value = value_text(live.map(|(value, _)| value));
    let below = match (live, fresh) {
        (None, _) => String::new(),
        (Some((_, at)), Freshness::Live) => format::age(pane.state.now.since(at)),
        (Some((_, at)), _) => {
            let age = format::age(pane.state.now.since(at));
            format!("{age} {}", pane.look.say(device::AGO))
        }
    };
    let name = cell_name(pane, id, device::LIVE);
    cell_ui(ui, rect, (&name, &value, color), &below);
}

fn saved_ui(ui: &mut Ui, rect: Rect, pane: &Pane<'_>, id: ParamId) {
    let book = &pane.state.hand().params;
    let saved = book.saved(id);
    let live = book.live(id).map(|(value, _)| value);
    let palette = pane.look.palette;
    let color = match saved == live || saved.is_none() || live.is_none() {
        true => palette.muted,
        false => palette.warn,
    };
    let file = book.known.saved.as_ref().filter(|_| saved.is_some());
    let day = file.and_then(|file| file.at.get(..10)).unwrap_or_default();
    let name = cell_name(pane, id, device::SAVED);
    cell_ui(ui, rect, (&name, &value_text(saved), color), day);
}

fn staged_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    id: ParamId,
    typed: &mut Option<(Id, String)>,
) {
    let staged = pane.state.hand().params.staged(id);
    let live = pane.state.hand().params.live(id).map(|(value, _)| value);
    let mut row = controls::middle(rect, theme::CONTROL);
    let button = if id.is_place() {
        let mut lines = controls::middle(rect, 2.0 * theme::CONTROL + theme::STEP);
        row = take_top(&mut lines, theme::CONTROL);
        let mut line = lines.with_min_y(lines.bottom() - theme::CONTROL);
        let button = take_right(&mut line, theme::CONTROL);
        change_ui(ui, line, pane, id);
        button
    } else {
        take_right(&mut row, theme::CONTROL)
    };
    let look = pane.look;
    let name = verdicts::whole_name(look, id);
    if staged.is_some() {
        let label = format!("{} {name}", look.say(device::UNSTAGE));
        let drop = Button::new(&label, look.say(device::UNSTAGE_TIP)).icon(theme::CLOSE);
        if drop
            .put(ui, look, button, Id::unique((id, "unstage")))
            .clicked()
        {
            pane.actions.push(Action::Stage(id, None));
        }
    } else if let ParamId::DefaultSpeed(dof) = id {
        copy_ui(ui, button, pane, dof);
    }
    let name = format!("{name} {}", look.say(device::STAGED).to_lowercase());
    let new = match id {
        ParamId::IpAddress => address_ui(ui, row, (&name, staged.or(live)), typed),
        _ => number_ui(ui, row, pane, (&name, id), staged.or(live)),
    };
    if let Some(new) = new {
        // The hand holds it already: nothing is left to be staged.
        let new = Some(new).filter(|new| Some(*new) != live || staged.is_some());
        let new = new.filter(|new| Some(*new) != live);
        pane.actions.push(Action::Stage(id, new));
    }
}

fn number_ui(
    ui: &mut Ui,
    rect: Rect,
    pane: &mut Pane<'_>,
    (name, id): (&str, ParamId),
    value: Option<Value>,
) -> Option<Value> {
    let (min, max) = id.range()?;
    let value = match value {
        Some(Value::Number(number)) => Some(f64::from(number)),
        _ => None,
    };
    let field = NumberField {
        name,
        tip: pane.look.say(device::STAGED_TIP),
        disabled: None,
        value,
        range: f64::from(min)..=f64::from(max),
        decimals: 0,
    };
    let place = Id::unique((id, "staged"));
    let typed = field.put(ui, pane.look, pane.typing, rect, place)?;
    Some(Value::Number(i32::try_from(whole(typed)).ok()?))
}

fn address_ui(
    ui: &mut Ui,
    rect: Rect,
    (name, value): (&str, Option<Value>),
    typed: &mut Option<(Id, String)>,
) -> Option<Value> {
    let text = value.map_or_else(String::new, |value| value.to_string());
    let field = TextField {
        name,
        hint: UNKNOWN,
        value: &text,
        max: ADDRESS_MAX,
    };
    let new = field.put(ui, typed, rect, Id::unique("address staged"))?;
    new.parse().ok().map(Value::Address)
}

/// Takes the speed and force of one joint as they are now.
fn copy_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, dof: Dof) {
    let look = pane.look;
    let label = format!(
        "{} {}",
        look.say(device::COPY_ONE),
        look.say(crate::ui::text::words::dof(dof))
    );
    let is_known =
        pane.state.hand().sample.speed_set.is_some() && pane.state.hand().link.state.is_live();
    let unknown = (!is_known).then(|| look.say(device::COPY_UNKNOWN));
    let button = Button::new(&label, look.say(device::COPY_ONE_TIP))
        .icon(theme::TO_LEFT)
        .disabled(unknown);
    let id = Id::unique((dof, "copy live"));
    if button.put(ui, look, rect, id).clicked() {
        let wish = ParamAction::CopyLive(Some(dof));
        pane.actions.push(Action::Param(wish));
    }
}

/// A row that says where the hand is found is not written from the table: it is changed under a card, with a way back.
fn change_ui(ui: &mut Ui, rect: Rect, pane: &mut Pane<'_>, id: ParamId) {
    let look = pane.look;
    let label = format!(
        "{} {}",
        look.say(device::CHANGE),
        verdicts::whole_name(look, id)
    );
    let live = pane.state.hand().params.live(id).map(|(value, _)| value);
    let wanted = pane.state.hand().params.staged(id);
    let wanted = wanted.filter(|wanted| Some(*wanted) != live);
    let reason = match wanted {
        None => Some(device::CHANGE_NONE),
        Some(_) if pane.state.hand().is_simulated() => Some(device::CHANGE_SIM),
        Some(_) => pane.state.hand().write_refusal().map(verdicts::refusal),
    };
    let button = Button::new(look.say(device::CHANGE), look.say(device::CHANGE_TIP))
        .named(&label)
        .disabled(reason.map(|reason| look.say(reason)));
    let pressed = button.put(ui, look, rect, Id::unique((id, "change")));
    if let Some(wanted) = wanted.filter(|_| pressed.clicked()) {
        pane.actions.push(Action::ChangePlace(id, wanted));
    }
}
