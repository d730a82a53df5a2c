//! The curves of the sessions that are shown, over each other: colours for settings or joints, strokes for sessions, and
//! which trial the pointer is at. Measures nothing.

use crate::app::trials::{
    ComparedLine, ComparedLines, ComparedRow, Comparison, LineGroup, RowKey, TrialQuantity,
};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Label, take_left, take_top};
use crate::ui::kit::dash;
use crate::ui::kit::dash::Dash;
use crate::ui::kit::look::Pane;
use crate::ui::text::{Text, compare, tune, words};
use crate::ui::theme;
use crate::ui::trials::compare_choice::{TrialKey, choice_ui, choice_width};
use crate::ui::trials::compare_columns::setting_words;
use crate::ui::trials::compare_list;
use crate::ui::trials::plot::{TrialLine, TrialPlot};
use egui::{Color32, Rect, Stroke, Ui};

/// Where the time of the curves begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Align {
    #[default]
    Command,
    Contact,
}

/// What the curves need between frames.
#[derive(Debug, Default)]
pub(crate) struct CurvesView {
    shown: TrialQuantity,
    align: Align,
    /// Thinned once, not each frame.
    picture: Option<(TrialQuantity, ComparedLines)>,
    /// The line at the pointer.
    pointed: Option<RowKey>,
}

/// A line of the legend.
struct Key {
    words: String,
    color: Color32,
    dash: Dash,
}

impl CurvesView {
    /// The comparison is another one.
    pub(crate) fn forget(&mut self) {
        (self.picture, self.pointed) = (None, None);
    }

    /// Draws what is chosen. A pressed line stands out.
    pub(crate) fn ui(
        &mut self,
        ui: &mut Ui,
        mut rect: Rect,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: &mut Option<TrialKey>,
    ) {
        let look = pane.look;
        self.choices_ui(ui, &mut rect, pane);
        let trials = &pane.state.trials;
        let shown = self.shown;
        let picture = self.picture.take().filter(|(own, _)| *own == shown);
        let picture = picture.map_or_else(|| comparison.lines(trials, shown), |(_, own)| own);
        let row = take_top(&mut rect, theme::LIST_LINE);
        rect.min.y -= theme::STEP;
        self.legend_ui(ui, row, pane, (comparison, &picture), *strong);
        let extra = self.whole(pane, comparison, *strong);
        let (places, lines) = self.lines(pane, comparison, &picture, (&extra, *strong));
        let plot = TrialPlot {
            look,
            name: look.say(title(shown)),
            empty: look.say(tune::CURVES_EMPTY),
            lines,
            levels: self.levels(pane, comparison),
            least: (0.0, 1.0),
        };
        let pointed = plot.ui(ui, rect);
        self.pointed = pointed.line.and_then(|at| places.get(at)).copied();
        if pointed.clicked {
            let seen = self.pointed.and_then(|place| comparison.row(trials, place));
            let chosen = seen.map(|seen| (seen.session.id, seen.trial.number));
            *strong = chosen.filter(|_| chosen != *strong);
        }
        self.picture = Some((shown, picture));
    }

    fn choices_ui(&mut self, ui: &mut Ui, rect: &mut Rect, pane: &Pane<'_>) {
        let look = pane.look;
        let aligns = [
            (Align::Command, tune::ON_COMMAND),
            (Align::Contact, tune::ON_CONTACT),
        ];
        let all = TrialQuantity::ALL.map(title).into_iter();
        let all = all.chain(aligns.map(|(_, text)| text));
        let room: f32 = all
            .map(|text| choice_width(ui, look.say(text)) + theme::STEP)
            .sum();
        let mut row = take_top(rect, theme::CONTROL);
        for shown in TrialQuantity::ALL {
            let text = look.say(title(shown));
            let tip = look.say(tune::SHOWN_TIP);
            if choice_ui(ui, &mut row, pane, (text, tip), self.shown == shown) {
                self.shown = shown;
            }
        }
        if room + theme::PAD > rect.width() {
            row = take_top(rect, theme::CONTROL);
        } else {
            row.min.x += theme::PAD;
        }
        for (align, text) in aligns {
            let texts = (look.say(text), look.say(tune::ALIGN_TIP));
            if choice_ui(ui, &mut row, pane, texts, self.align == align) {
                self.align = align;
            }
        }
    }

    /// The trial that stands out, with all its points: it may not be among the lines, or thinned.
    fn whole(
        &self,
        pane: &Pane<'_>,
        comparison: &Comparison,
        strong: Option<TrialKey>,
    ) -> Vec<ComparedLine> {
        let trials = &pane.state.trials;
        let own = |place: &&RowKey| {
            let seen = comparison.row(trials, **place);
            seen.is_some_and(|seen| strong == Some((seen.session.id, seen.trial.number)))
        };
        let drawn = |place: &RowKey| {
            let line = comparison.line(trials, *place)?;
            Some(ComparedLine {
                key: *place,
                contact_s: line.contact_s,
                points: line.points(self.shown).to_vec(),
            })
        };
        let places = comparison.rows.iter();
        let places = places.filter(|_| strong.is_some()).filter(own);
        places.filter_map(drawn).collect()
    }

    fn lines<'a>(
        &self,
        pane: &Pane<'_>,
        comparison: &Comparison,
        picture: &'a ComparedLines,
        (extra, strong): (&'a [ComparedLine], Option<TrialKey>),
    ) -> (Vec<RowKey>, Vec<TrialLine<'a>>) {
        let mut places = Vec::new();
        let mut lines = Vec::new();
        let is_strong = |place: RowKey| extra.iter().any(|own| own.key == place);
        let rest = picture.lines.iter().filter(|own| !is_strong(own.key));
        for own in rest.chain(extra) {
            let zero_s = match self.align {
                Align::Command => Some(0.0),
                Align::Contact => own.contact_s,
            };
            let seen = comparison.row(&pane.state.trials, own.key);
            let (Some(zero_s), Some(seen)) = (zero_s, seen) else {
                continue;
            };
            let stands_out = is_strong(own.key);
            let color = color(pane, comparison, own.key, seen);
            let is_back = strong.is_some() && !stands_out && !extra.is_empty();
            places.push(own.key);
            lines.push(TrialLine {
                points: &own.points,
                zero_s,
                color: if is_back { dash::behind(color) } else { color },
                width: match stands_out {
                    true => theme::STRONG,
                    false => theme::LINE,
                },
                dash: compare_list::dash(comparison.sessions(), seen.session.id),
            });
        }
        (places, lines)
    }

    fn levels(&self, pane: &Pane<'_>, comparison: &Comparison) -> Vec<(f64, Color32)> {
        if self.shown != TrialQuantity::Force {
            return Vec::new();
        }
        let forces = comparison.settings.iter();
        let mut levels: Vec<f64> = forces.map(|own| f64::from(own.force.get())).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let color = pane.look.palette.muted;
        levels.into_iter().map(|level| (level, color)).collect()
    }

    /// What is drawn, then the trial that is meant, or every line, or what colours and strokes stand for.
    fn legend_ui(
        &self,
        ui: &mut Ui,
        mut row: Rect,
        pane: &Pane<'_>,
        (comparison, picture): (&Comparison, &ComparedLines),
        strong: Option<TrialKey>,
    ) {
        let look = pane.look;
        let title = look.say(title(self.shown));
        let width = controls::text_width(ui, title, theme::small()) + 1.0;
        let place = take_left(&mut row, width);
        Label::new(title, look.palette.muted).small().put(ui, place);
        if picture.lines.len() < picture.all {
            let (drawn, of) = (picture.lines.len(), look.say(compare::OF_ALL));
            let text = format!("{drawn} {of} {}", picture.all);
            let place = take_left(
                &mut row,
                controls::text_width(ui, &text, theme::small()) + 1.0,
            );
            Label::new(&text, look.palette.warn).small().put(ui, place);
        }
        let meant = self.meant(pane, comparison, picture, strong);
        let keys = match meant {
            Some(key) => vec![key],
            None => {
                let all = every(pane, comparison, picture);
                let room: f32 = all.iter().map(|key| key_width(ui, key)).sum();
                match room <= row.width() && !all.is_empty() {
                    true => all,
                    false => groups(pane, comparison, picture),
                }
            }
        };
        let count = keys.len();
        for (at, key) in keys.into_iter().enumerate() {
            let width = key_width(ui, &key);
            let is_first = at == 0;
            if width > row.width() && !is_first {
                let more = format!("+{}", count - at);
                Label::new(&more, look.palette.muted).small().put(ui, row);
                break;
            }
            let width = width.min(row.width());
            let mut place = take_left(&mut row, width - theme::GAP);
            let sign = take_left(&mut place, theme::KEY_SIGN);
            let stroke = Stroke::new(theme::STRONG, key.color);
            key.dash.sample(ui.painter(), sign, stroke);
            Label::new(&key.words, look.palette.text)
                .small()
                .put(ui, place);
        }
    }

    /// The line at the pointer, or the trial that stands out.
    fn meant(
        &self,
        pane: &Pane<'_>,
        comparison: &Comparison,
        picture: &ComparedLines,
        strong: Option<TrialKey>,
    ) -> Option<Key> {
        let trials = &pane.state.trials;
        let own = |place: &RowKey| {
            let seen = comparison.row(trials, *place);
            seen.is_some_and(|seen| strong == Some((seen.session.id, seen.trial.number)))
        };
        let drawn = picture.lines.iter().map(|line| line.key);
        let place = self.pointed.or_else(|| drawn.into_iter().find(own))?;
        let seen = comparison.row(trials, place)?;
        let look = pane.look;
        let (session, tried) = (seen.session, seen.trial);
        let name = compare_list::name(look, session.id);
        let joint = look.say(words::dof(seen.joint.dof));
        let setting = setting_words(tried.setting);
        let trial = format!("{} {}", look.say(tune::COLUMN_TRIAL), tried.number);
        Some(Key {
            words: format!("{name}  {trial}  {setting}  {joint}"),
            color: color(pane, comparison, place, seen),
            dash: compare_list::dash(comparison.sessions(), session.id),
        })
    }
}

fn key_width(ui: &Ui, key: &Key) -> f32 {
    let words = controls::text_width(ui, &key.words, theme::small());
    words + 1.0 + theme::KEY_SIGN + 2.0 * theme::GAP
}

/// A key for each line: session and trial.
fn every(pane: &Pane<'_>, comparison: &Comparison, picture: &ComparedLines) -> Vec<Key> {
    /// More never fit in one row.
    const LINES_NAMED: usize = 12;
    if picture.all > LINES_NAMED {
        return Vec::new();
    }
    let several = comparison.sessions().len() > 1;
    let key = |line: &ComparedLine| {
        let seen = comparison.row(&pane.state.trials, line.key)?;
        let setting = setting_words(seen.trial.setting);
        let (session, trial) = (seen.session.id.0, seen.trial.number);
        let words = match several {
            true => format!("{session}: {trial}  {setting}"),
            false => format!("{trial}  {setting}"),
        };
        Some(Key {
            words,
            color: color(pane, comparison, line.key, seen),
            dash: compare_list::dash(comparison.sessions(), seen.session.id),
        })
    };
    picture.lines.iter().filter_map(key).collect()
}

/// A key for each stroke, then for each colour.
fn groups(pane: &Pane<'_>, comparison: &Comparison, picture: &ComparedLines) -> Vec<Key> {
    let look = pane.look;
    let mut keys = Vec::new();
    if comparison.sessions().len() > 1 {
        keys.extend(comparison.sessions().rev().map(|id| Key {
            words: compare_list::name(look, id),
            color: look.palette.text,
            dash: compare_list::dash(comparison.sessions(), id),
        }));
    }
    let mut groups: Vec<LineGroup> = Vec::new();
    for line in &picture.lines {
        let seen = comparison.row(&pane.state.trials, line.key);
        let group = seen.map(|seen| comparison.group(line.key, seen));
        groups.extend(group.filter(|group| !groups.contains(group)));
    }
    for group in groups {
        let words = match group {
            LineGroup::Joint(dof) => look.say(words::dof(dof)).to_owned(),
            LineGroup::Setting(at) => {
                let setting = comparison.settings.get(at);
                setting.map_or_else(String::new, |own| setting_words(*own))
            }
            LineGroup::Session(_) => continue,
        };
        keys.push(Key {
            words,
            color: group_color(pane, group),
            dash: Dash::Solid,
        });
    }
    keys
}

fn group_color(pane: &Pane<'_>, group: LineGroup) -> Color32 {
    let palette = pane.look.palette;
    let at = match group {
        LineGroup::Joint(dof) => return palette.dof[dof],
        LineGroup::Setting(at) | LineGroup::Session(at) => at,
    };
    let mut colors = palette.dof.iter().map(|(_, color)| *color);
    colors.nth(at % 6).unwrap_or(palette.text)
}

/// The colour of a line: of its setting, its joint or its session.
pub(crate) fn color(
    pane: &Pane<'_>,
    comparison: &Comparison,
    place: RowKey,
    seen: ComparedRow<'_>,
) -> Color32 {
    group_color(pane, comparison.group(place, seen))
}

const fn title(shown: TrialQuantity) -> Text {
    match shown {
        TrialQuantity::Force => tune::SHOW_FORCE,
        TrialQuantity::Angle => tune::SHOW_ANGLE,
        TrialQuantity::Current => tune::SHOW_CURRENT,
        TrialQuantity::Touch => tune::SHOW_TOUCH,
    }
}
