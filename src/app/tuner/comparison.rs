//! Trials of several sessions side by side: rows, lines, what the settings come to, and whether they may be taken
//! together. Reckoned when something changed, not each frame. Draws nothing.

use crate::app::trial::best::{Score, Tally, tallies};
use crate::app::trial::session::PlanRow;
use crate::app::trial::{JointMetrics, Setting};
use crate::app::tuner::book::{Session, SessionId, Tried, TunerBook};
use crate::app::tuner::lines::{JointLines, Shown, thinned_to};
use crate::hand::Dof;

/// Sessions that are shown at once: as many as there are kinds of strokes that an eye tells apart.
pub const SHOWN_MAX: usize = 4;
/// Lines that are drawn at once; more are a carpet.
pub const LINES_MAX: usize = 200;
/// Points of all lines that are drawn at once: some milliseconds a frame without a graphics card.
pub const POINTS_MAX: usize = 20_000;

/// One joint of one trial of a session that is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Place {
    /// Which of the sessions shown, 0 the oldest.
    pub session: usize,
    /// Which of its trials, from 0.
    pub trial: usize,
    /// Which of the joints that took part, from 0.
    pub joint: usize,
}

/// What a place holds.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// The session.
    pub session: &'a Session,
    /// The trial.
    pub tried: &'a Tried,
    /// What was measured.
    pub joint: &'a JointMetrics,
}

/// What lines have a colour for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// The joint, where several took part.
    Joint(Dof),
    /// The setting, in the order of settings.
    Setting(usize),
    /// The session, where all tried the same setting.
    Session(usize),
}

/// Why sessions are not taken together: their numbers do not tell the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Difference {
    /// Another hand, or the same at another place.
    Hand,
    /// Other joints.
    Joints,
    /// Another start or target.
    Way,
    /// Another approach.
    Approach,
    /// Held for another time.
    Dwell,
}

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Whose.
    pub place: Place,
    /// When it met the object, s.
    pub contact_s: Option<f64>,
    /// Seconds from the command, and values.
    pub points: Vec<[f64; 2]>,
}

/// The lines that are drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Picture {
    /// The lines, the oldest first.
    pub lines: Vec<Drawn>,
    /// Lines there are.
    pub all: usize,
}

/// Sessions side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    of: Vec<(SessionId, usize)>,
    focus: SessionId,
    rows: Vec<Place>,
    settings: Vec<Setting>,
    several_joints: bool,
    joints: Vec<Dof>,
    scores: Vec<Score>,
    differences: Vec<Difference>,
}

/// Its state by which a change is seen: trials are added to a session and never change.
fn stand(book: &TunerBook, shown: &[SessionId]) -> Vec<(SessionId, usize)> {
    let mut of: Vec<_> = shown
        .iter()
        .filter_map(|id| Some((*id, book.session(*id)?.trials.len())))
        .collect();
    of.sort_unstable();
    of.dedup();
    of.truncate(SHOWN_MAX);
    of
}

impl Comparison {
    /// Puts these sessions side by side. Where they may not be taken together, what settings come to is of `focus` alone.
    #[must_use]
    pub fn of(book: &TunerBook, shown: &[SessionId], focus: SessionId) -> Self {
        let of = stand(book, shown);
        let sessions: Vec<&Session> = of.iter().filter_map(|(id, _)| book.session(*id)).collect();
        let own = book.session(focus);
        let differences = differences(&sessions);
        let pooled: Vec<&Session> = match differences.is_empty() {
            true => sessions.clone(),
            false => own.into_iter().collect(),
        };
        let tried = || sessions.iter().flat_map(|session| &session.trials);
        let mut settings: Vec<Setting> = tried().map(|own| own.setting).collect();
        settings.sort_unstable();
        settings.dedup();
        Self {
            rows: rows(&sessions),
            several_joints: tried().any(|own| own.metrics.joints.len() > 1)
                || differences.contains(&Difference::Joints),
            settings,
            joints: joints(&pooled),
            scores: scores(&pooled),
            differences,
            focus,
            of,
        }
    }

    /// True while it would come out the same.
    #[must_use]
    pub fn stands(&self, book: &TunerBook, shown: &[SessionId], focus: SessionId) -> bool {
        self.focus == focus && self.of == stand(book, shown)
    }

    /// The sessions, the oldest first.
    pub fn sessions(&self) -> impl ExactSizeIterator<Item = SessionId> + DoubleEndedIterator {
        self.of.iter().map(|(id, _)| *id)
    }

    /// A row for each joint of each trial, in their order.
    #[must_use]
    pub fn rows(&self) -> &[Place] {
        &self.rows
    }

    /// The settings tried, in their order.
    #[must_use]
    pub fn settings(&self) -> &[Setting] {
        &self.settings
    }

    /// What settings come to, over all sessions or over one: see [`Self::differences`].
    #[must_use]
    pub fn scores(&self) -> &[Score] {
        &self.scores
    }

    /// The joints that those tried.
    #[must_use]
    pub fn joints(&self) -> &[Dof] {
        &self.joints
    }

    /// Why settings are not judged over all sessions; empty if they are.
    #[must_use]
    pub fn differences(&self) -> &[Difference] {
        &self.differences
    }

    /// What stands at a place.
    #[must_use]
    pub fn seen<'a>(&self, book: &'a TunerBook, place: Place) -> Option<Seen<'a>> {
        let (id, _) = self.of.get(place.session)?;
        let session = book.session(*id)?;
        let tried = session.trials.get(place.trial)?;
        let joint = tried.metrics.joints.get(place.joint)?;
        Some(Seen {
            session,
            tried,
            joint,
        })
    }

    /// What a place has a colour for.
    #[must_use]
    pub fn group(&self, place: Place, seen: Seen<'_>) -> Group {
        if self.several_joints {
            return Group::Joint(seen.joint.dof);
        }
        if self.of.len() > 1 && self.settings.len() == 1 {
            return Group::Session(place.session);
        }
        let at = self.settings.binary_search(&seen.tried.setting);
        Group::Setting(at.unwrap_or_default())
    }

    /// The lines of a quantity: spread evenly over all there are, and none with more points than the eye sees.
    #[must_use]
    pub fn picture(&self, book: &TunerBook, shown: Shown) -> Picture {
        let lines: Vec<(Place, &JointLines)> = self
            .rows
            .iter()
            .filter_map(|place| Some((*place, self.line(book, *place)?)))
            .filter(|(_, line)| !line.points(shown).is_empty())
            .collect();
        let all = lines.len();
        let count = all.min(LINES_MAX);
        let most = POINTS_MAX / count.max(1);
        let chosen = (0..count).filter_map(|at| lines.get(at * all / count));
        let drawn = |(place, line): &(Place, &JointLines)| Drawn {
            place: *place,
            contact_s: line.contact_s,
            points: thinned_to(line.points(shown), most),
        };
        Picture {
            lines: chosen.map(drawn).collect(),
            all,
        }
    }

    /// The lines of a place, if samples of it are there.
    #[must_use]
    pub fn line<'a>(&self, book: &'a TunerBook, place: Place) -> Option<&'a JointLines> {
        let (id, _) = self.of.get(place.session)?;
        let tried = book.session(*id)?.trials.get(place.trial)?;
        tried.lines.0.get(place.joint)
    }
}

fn rows(sessions: &[&Session]) -> Vec<Place> {
    let mut rows = Vec::new();
    for (session, own) in sessions.iter().enumerate() {
        for (trial, tried) in own.trials.iter().enumerate() {
            let joints = 0..tried.metrics.joints.len();
            rows.extend(joints.map(|joint| Place {
                session,
                trial,
                joint,
            }));
        }
    }
    rows
}

fn joints(sessions: &[&Session]) -> Vec<Dof> {
    let tried = |dof: &Dof| {
        let trials = sessions.iter().flat_map(|session| &session.trials);
        let mut all = trials.flat_map(|own| &own.metrics.joints);
        all.any(|joint| joint.dof == *dof)
    };
    Dof::ALL.into_iter().filter(tried).collect()
}

/// What settings come to; looking for the contact does not count.
fn scores(sessions: &[&Session]) -> Vec<Score> {
    let tried = sessions.iter().flat_map(|session| &session.trials);
    let tried = tried.filter(|tried| tried.repeat.is_some());
    tallies(tried.map(|tried| Tally {
        setting: tried.setting,
        aborted: tried.ended.is_some(),
        joints: &tried.metrics.joints,
    }))
}

fn differences(sessions: &[&Session]) -> Vec<Difference> {
    let Some((first, others)) = sessions.split_first() else {
        return Vec::new();
    };
    let plan = first.plan();
    let others: Vec<(&str, PlanRow)> = others
        .iter()
        .map(|own| (own.head.hand.as_str(), own.plan()))
        .collect();
    let any = |differs: &dyn Fn(&str, &PlanRow) -> bool| {
        others.iter().any(|(hand, other)| differs(hand, other))
    };
    let closing = |plan: &PlanRow| plan.close.keys().cloned().collect::<Vec<_>>();
    let approach = |plan: &PlanRow| (plan.fast_speed, plan.until.clone(), plan.until_value);
    let found = [
        (
            Difference::Hand,
            any(&|hand, _| hand != first.head.hand.as_str()),
        ),
        (
            Difference::Joints,
            any(&|_, other| closing(other) != closing(&plan)),
        ),
        (
            Difference::Way,
            any(&|_, other| {
                closing(other) == closing(&plan)
                    && (&other.start, &other.close) != (&plan.start, &plan.close)
            }),
        ),
        (
            Difference::Approach,
            any(&|_, other| approach(other) != approach(&plan)),
        ),
        (
            Difference::Dwell,
            any(&|_, other| (other.dwell_s - plan.dwell_s).abs() > f64::EPSILON),
        ),
    ];
    let found = found.into_iter().filter(|(_, is)| *is);
    found.map(|(difference, _)| difference).collect()
}
