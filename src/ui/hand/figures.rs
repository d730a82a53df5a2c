//! Labels beside the drawn hand: each finger's name, force and fault in a fixed position, with a line to the finger.

use crate::app::hand::grip;
use crate::app::readings::Freshness;
use crate::hand::gap::HeldSize;
use crate::hand::grip::{Grip, GripState};
use crate::hand::heat::WARM;
use crate::hand::kinematics::Side;
use crate::hand::{Dof, Finger, PerFinger, Quantity};
use crate::motion::hold::HoldPhase;
use crate::ui::hand::view::{HandPoints, HandView};
use crate::ui::kit::DriveWords;
use crate::ui::kit::{Label, Pane, format, text_width};
use crate::ui::text::{hold, main, panels, poses, words};
use crate::ui::theme;
use egui::{Color32, FontId, Pos2, Rect, Stroke, Ui, Vec2, pos2, vec2};

/// Height of the word for the grasp, and of the picture from which on a small line below it has space.
const WORD: f32 = 26.0;
const NOTES_FROM: f32 = 320.0;

/// Minimum height of a picture with labels, in points.
const LEAST: f32 = 200.0;
/// Size of a label: its column's width, and its three lines.
const WIDTH: f32 = 70.0;
const HEIGHT: f32 = 3.0 * theme::TEXT_LINE;
/// Vertical distance between the labels of the outer fingers, and how far above the hand they begin, so that a line reaches its
/// finger from above the others.
const APART: f32 = HEIGHT + theme::GAP;
const ABOVE: f32 = theme::CONTROL;
/// Position of the thumb's label, as a share of the hand's height: below the thumb, as the index has its own above it.
const THUMB: f32 = 0.7;
/// Share of the labels of index and thumb that is beside the hand: above and below the thumb there is space for the rest.
const BESIDE: f32 = 0.55;
/// Gap between the hand and its labels.
const CLEAR: f32 = 2.0 * theme::GAP;
/// Opacity of a line, radius of the ring at its end, and opacity of a label's background.
const LINE_PART: f32 = 0.7;
const RING: f32 = 2.5;
const GROUND_PART: f32 = 0.6;

/// Area for the hand itself, beside the labels of the outer fingers. The labels of index and thumb are above and below the
/// thumb, where no pose reaches.
pub(crate) fn picture_place(place: Rect, side: Side) -> Rect {
    if place.height() < LEAST {
        return place;
    }
    let below = place
        .with_min_y(place.top() + ABOVE)
        .with_max_y(place.bottom() - below(place));
    let (outer, thumb) = (WIDTH + CLEAR, WIDTH * BESIDE);
    let (left, right) = match side {
        Side::Right => (outer, thumb),
        Side::Left => (thumb, outer),
    };
    below
        .with_min_x(place.left() + left)
        .with_max_x(place.right() - right)
}

/// Draws the labels beside the hand that `view` drew last within `place`.
pub(crate) fn figures_ui(ui: &mut Ui, pane: &Pane<'_>, view: &HandView, place: Rect) {
    let Some(points) = view.points().filter(|_| place.height() >= LEAST) else {
        return;
    };
    let figures = Figure::all(place, &points);
    for finger in Finger::ALL {
        figure_ui(ui, pane, finger, &figures[finger]);
    }
}

/// Position of a finger's label, and its line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Figure {
    lines: [Rect; 3],
    on_left: bool,
    /// Where the finger is seen; `None` if others hide it.
    pub(super) end: Option<Pos2>,
    /// The line leaves the label horizontally or vertically, and ends at the finger; `None` if it would cross another.
    pub(super) path: Option<[Pos2; 3]>,
}

impl Figure {
    /// The labels of all fingers. Each line ends at its tip, or as near to it as its own finger is seen and no lines cross. Those
    /// that would cross in any way are left out: the rings at the fingers have the colours of the labels.
    pub(super) fn all(place: Rect, points: &HandPoints) -> PerFinger<Self> {
        let from = |start: usize| {
            PerFinger::from_fn(|finger| {
                // Index and thumb have labels of their own side.
                let is_outer = !matches!(finger, Finger::Index | Finger::Thumb);
                let along = points.along[finger]
                    .iter()
                    .skip(if is_outer { start } else { 0 });
                Self::new(place, points, finger, along.flatten().next().copied())
            })
        };
        let ends = |figures: &PerFinger<Self>| {
            let ends = Finger::ALL.into_iter().map(|own| figures[own].end);
            ends.flatten().count()
        };
        let at_tips = from(0);
        let starts = 0..points.along[Finger::Middle].len();
        let mut clear = starts.map(from).filter(|figures| {
            let free = Finger::ALL.into_iter().all(|own| is_free(figures, own));
            free && ends(figures) == ends(&at_tips)
        });
        let figures = clear.next().unwrap_or(at_tips);
        PerFinger::from_fn(|finger| Self {
            path: figures[finger].path.filter(|_| is_free(&figures, finger)),
            ..figures[finger]
        })
    }

    fn new(place: Rect, points: &HandPoints, finger: Finger, end: Option<Pos2>) -> Self {
        let (slot, on_left) = slot(place, points, finger);
        let lines = [0.0, 1.0, 2.0].map(|line| {
            let top = slot.top() + line * theme::TEXT_LINE;
            Rect::from_min_size(pos2(slot.left(), top), vec2(WIDTH, theme::TEXT_LINE))
        });
        let [first, second, _] = lines;
        let (from, way) = match (finger, on_left) {
            (Finger::Thumb, _) => (first.center_top(), vec2(0.0, -theme::STEP)),
            (_, true) => (second.right_center(), vec2(theme::STEP, 0.0)),
            (_, false) => (second.left_center(), vec2(-theme::STEP, 0.0)),
        };
        let knee = from + 3.0 * way;
        Self {
            lines,
            on_left,
            end,
            path: end.map(|end| [from + way, knee, end]),
        }
    }

    /// Draws a lock beside the finger's name.
    fn lock_ui(&self, ui: &mut Ui, pane: &Pane<'_>, name: &str) {
        let [line, ..] = self.lines;
        let width = text_width(ui, name, theme::small()) + theme::SIGN_SMALL;
        let x = if self.on_left {
            line.right() - width
        } else {
            line.left() + width
        };
        let place = Rect::from_center_size(pos2(x, line.center().y), Vec2::splat(theme::TEXT_LINE));
        let lock = Label::new(theme::LOCKED, pane.look.palette.muted);
        let lock = lock.font(theme::icon_high(theme::SIGN_SMALL)).center();
        let named = pane.look.pair(name, pane.look.tr(main::LOCKED));
        lock.named(&named).put(ui, place);
    }
}

/// True if the line to a finger crosses no other.
fn is_free(figures: &PerFinger<Figure>, finger: Finger) -> bool {
    let mut others = Finger::ALL.into_iter().filter(|other| *other != finger);
    let crosses = |other: Finger| {
        let both = figures[finger].path.zip(figures[other].path);
        both.is_some_and(|(own, other)| cross(own, other))
    };
    !others.any(crosses)
}

/// True if two lines cross.
pub(super) fn cross(one: [Pos2; 3], other: [Pos2; 3]) -> bool {
    let turned = |a: Pos2, b: Pos2, c: Pos2| (b - a).rot90().dot(c - a) > 0.0;
    let parts = |[from, knee, end]: [Pos2; 3]| [[from, knee], [knee, end]];
    let pairs = parts(one)
        .into_iter()
        .flat_map(|one| parts(other).map(|other| (one, other)));
    let mut crossed = pairs.map(|([a, b], [c, d])| {
        turned(a, b, c) != turned(a, b, d) && turned(c, d, a) != turned(c, d, b)
    });
    crossed.any(|is_crossed| is_crossed)
}

/// Rectangle of a finger's label, and true if it is on the left. It does not change while the hand moves.
fn slot(place: Rect, points: &HandPoints, finger: Finger) -> (Rect, bool) {
    let hand = points.bounds;
    let (is_outer, down) = match finger {
        Finger::Middle => (true, 0.0),
        Finger::Ring => (true, APART),
        Finger::Little => (true, 2.0 * APART),
        Finger::Index => (false, 0.0),
        Finger::Thumb => (false, ABOVE + hand.height() * THUMB),
    };
    let on_left = is_outer == points.is_forward;
    let out = if is_outer {
        CLEAR + WIDTH
    } else {
        WIDTH * BESIDE
    };
    let x = if on_left {
        hand.left() - out
    } else {
        hand.right() + out - WIDTH
    };
    let size = vec2(WIDTH, HEIGHT);
    let room = Rect::from_min_max(place.min, place.max - size);
    let corner = room.clamp(pos2(x, hand.top() - ABOVE + down));
    (Rect::from_min_size(corner, size), on_left)
}

fn figure_ui(ui: &mut Ui, pane: &Pane<'_>, finger: Finger, figure: &Figure) {
    let look = pane.look;
    let name = look.tr(words::finger(finger));
    let color = look.palette.dof[finger.bend()];
    let &Figure {
        lines: [first, second, third],
        on_left,
        ..
    } = figure;
    let ground = look.palette.card.gamma_multiply(GROUND_PART);
    ui.painter()
        .rect_filled(first.union(second), theme::ROUND_SMALL, ground);
    line_ui(ui, figure, color.gamma_multiply(LINE_PART));
    let aligned = |label: Label<'_>, ui: &mut Ui, rect: Rect| {
        let label = if on_left { label.right() } else { label };
        label.put(ui, rect)
    };
    // The third line often has no text, and its ground would hide the hand for nothing.
    let third_ui = |label: Label<'_>, ui: &mut Ui| {
        ui.painter().rect_filled(third, theme::ROUND_SMALL, ground);
        aligned(label, ui, third);
    };
    aligned(Label::new(name, color).small(), ui, first);
    let mut joints = Dof::ALL.into_iter().filter(|dof| dof.finger() == finger);
    let is_locked = |dof| pane.hand().controls.joints[dof].locked;
    if joints.clone().any(is_locked) {
        figure.lock_ui(ui, pane, name);
    }
    let (force, over, freshness) = force(pane, finger);
    let live = if over {
        look.palette.warn
    } else {
        look.palette.text
    };
    let label = Label::new(&force, look.value(freshness, live)).number();
    let label = label.font(FontId::monospace(if over { 15.0 } else { 14.0 }));
    let named = format!("{name} {}", look.tr(panels::FINGER_FORCE));
    aligned(label.named(&named), ui, second);
    if let Some((words, color)) = joints.find_map(|dof| trouble(pane, dof)) {
        let named = format!("{name} {}", look.tr(panels::FINGER_TROUBLE));
        third_ui(Label::new(&words, color).small().named(&named), ui);
        return;
    }
    let state = grip(pane).fingers[finger].state;
    // The picture already shows an open grip.
    if !matches!(state, GripState::Unknown | GripState::Open) {
        let named = format!("{name} {}", look.tr(panels::FINGER_GRIP));
        let words = Label::new(look.tr(panels::grip(state)), grip_color(pane, state));
        third_ui(words.small().named(&named), ui);
    }
}

pub(crate) fn grip(pane: &Pane<'_>) -> Grip {
    grip::grip_now(pane.hand(), pane.state.now)
}

/// Size of the object between thumb and index, as text; `None` unless those two alone hold one.
pub(crate) fn held_size(pane: &Pane<'_>) -> Option<String> {
    let size = size_now(pane)?;
    let text = match size {
        HeldSize::Block(_) => poses::HELD_MEASURED,
        HeldSize::Ball(_) => poses::HELD_BALL,
        HeldSize::Pads(_) => poses::HELD_PADS,
    };
    Some(pane.look.fill(text, &[&format!("{:.0}", size.mm())]))
}

fn size_now(pane: &Pane<'_>) -> Option<HeldSize> {
    let hand = pane.hand();
    let gap = grip::held_gap(hand, pane.state.now)?;
    let endpoint = hand.connection.endpoint.as_ref();
    Some(pane.state.settings.size_blocks(endpoint).size(gap))
}

/// Draws the state of the grasp as one large word under the picture, with what a running hold does in small lines below it.
pub(crate) fn grip_ui(ui: &mut Ui, pane: &Pane<'_>, place: Rect) {
    let (word, color) = grip_word(pane);
    let notes = notes(pane);
    let below = below(place);
    let line = place.with_min_y(place.bottom() - below);
    let large = line.with_max_y(line.top() + WORD);
    let label = Label::new(&word, color).large().center();
    let label = label.named(pane.look.tr(panels::GRIP)).put(ui, large);
    let tip = pane.look.tip(panels::GRIP);
    label.on_hover_text(format!("{}\n{tip}", notes.join("\n")).trim());
    let tops = (0u8..).map(|line| large.bottom() + f32::from(line) * theme::TEXT_LINE);
    for (note, top) in notes.iter().zip(tops) {
        let line = line.with_min_y(top).with_max_y(top + theme::TEXT_LINE);
        if !note.is_empty() && line.bottom() <= place.bottom() + 1.0 {
            let label = Label::new(note, pane.look.palette.muted).small();
            let label = label.named(pane.look.tr(panels::GRIP_NOTES));
            label.center().put(ui, line);
        }
    }
}

/// What a running hold does and has, else how the size of what is held is known; at most two lines.
fn notes(pane: &Pane<'_>) -> [String; 2] {
    let look = pane.look;
    match pane.hand().running.hold().filter(|run| run.is_running()) {
        Some(run) => {
            let object = run.view.object.as_ref();
            let object = object.map(|object| hold::object(look, object));
            // Before it holds, the word says it all.
            let state = match run.view.phase {
                HoldPhase::Measuring | HoldPhase::Closing => String::new(),
                HoldPhase::Holding | HoldPhase::CannotHold => {
                    hold::state(look, &run.view, run.unit)
                }
            };
            [state, object.unwrap_or_default()]
        }
        None => {
            let holds = grip(pane).grasp.state == GripState::Holding;
            let size = held_size(pane).filter(|_| holds);
            [size.unwrap_or_default(), String::new()]
        }
    }
}

/// Word for the state of the grasp, with the size of what two fingers hold, or the phase of a running hold.
fn grip_word(pane: &Pane<'_>) -> (String, Color32) {
    let look = pane.look;
    let state = grip(pane).grasp.state;
    let color = grip_color(pane, state);
    if let Some(run) = pane.hand().running.hold().filter(|run| run.is_running()) {
        let color = match run.view.phase {
            HoldPhase::CannotHold => look.palette.warn,
            HoldPhase::Measuring | HoldPhase::Closing | HoldPhase::Holding => color,
        };
        return (look.tr(hold::phase(run.view.phase)).to_owned(), color);
    }
    let word = look.tr(panels::grip(state));
    let words = match state {
        GripState::Unknown => look.pair(look.tr(panels::GRIP), word),
        GripState::Holding => match size_now(pane) {
            Some(size) => look.list(&[word, &format!("{:.0} mm", size.mm())]),
            None => word.to_owned(),
        },
        _ => word.to_owned(),
    };
    (words, color)
}

/// Height below the picture: the word, and as many of the two small lines as there is space for.
fn below(place: Rect) -> f32 {
    let height = place.height();
    let lines = [NOTES_FROM, 1.5 * NOTES_FROM].map(|least| u8::from(height >= least));
    WORD + lines.iter().map(|line| f32::from(*line)).sum::<f32>() * theme::TEXT_LINE
}

/// Conspicuous for the states that need the user's attention.
fn grip_color(pane: &Pane<'_>, state: GripState) -> Color32 {
    let palette = pane.look.palette;
    match state {
        GripState::Unknown
        | GripState::Open
        | GripState::Moving
        | GripState::Empty
        | GripState::Touching => palette.muted,
        GripState::Holding => palette.ok,
        GripState::Slipping | GripState::TooHard => palette.warn,
        GripState::Lost => palette.bad,
    }
}

/// Force of the drive that bends a finger, true if it is at its threshold, and its freshness.
fn force(pane: &Pane<'_>, finger: Finger) -> (String, bool, Freshness) {
    let (dof, hand) = (finger.bend(), pane.hand());
    let (force, freshness) = pane.newest(dof, hand.readings.sample.force);
    let raw = force.map(|force| i64::from(force.raw()));
    let known = force.and_then(|force| force.documented());
    let over = known.zip(hand.controls.stops_at(dof, hand.held_otherwise(dof)));
    let over = over.is_some_and(|(now, stops_at)| now >= stops_at.get());
    let force = format::with_unit(raw, 0, Quantity::Force.row().unit);
    (force, over, freshness)
}

/// Fault of a drive, or its temperature if it is warm; `None` for old values.
fn trouble(pane: &Pane<'_>, dof: Dof) -> Option<(String, Color32)> {
    let palette = pane.look.palette;
    let drive = DriveWords::of(pane, dof);
    // The lamp of an old reading is faint, so it never equals `palette.bad`.
    if drive.lamp == palette.bad {
        return Some((drive.short, palette.bad));
    }
    let (heat, freshness) = pane.newest(dof, pane.hand().readings.sample.temperature);
    let degrees = heat.and_then(|heat| heat.documented());
    let warm = degrees.filter(|degrees| *degrees >= WARM && freshness == Freshness::Live)?;
    Some((format!("{warm} °C"), palette.warn))
}

/// Draws a thin line from a label to its finger, with a ring at the finger.
fn line_ui(ui: &Ui, figure: &Figure, color: Color32) {
    let painter = ui.painter();
    if let Some([from, knee, end]) = figure.path {
        let stop = end + (knee - end).normalized() * RING;
        painter.line(vec![from, knee, stop], Stroke::new(1.0, color));
    }
    if let Some(end) = figure.end {
        painter.circle_stroke(end, RING, Stroke::new(theme::FOCUS_LINE, color));
    }
}
