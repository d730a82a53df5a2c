//! Overshoot past the force thresholds as measured in one hand's own closes: it replaces the table measured on another hand of
//! the family. Counts closes by setting and by the object's stiffness; does not extrapolate.

use crate::hand::impact::{self, NOTABLE_G};
use crate::hand::{Dof, Force, Speed};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Closes on rigid objects from which their highest peak stands for this hand: of fewer, the next one exceeds it too often.
pub const CLOSES_LEAST: u32 = 3;
/// Number of stored kinds of closes; beyond it the oldest is dropped.
pub const KINDS_MAX: usize = 2000;
/// Possible overshoot of a close, g; no sensor reads beyond this.
const OVERS_G: RangeInclusive<f64> = -100.0..=10_000.0;
/// A measurement also applies to speeds up to this factor higher.
const SPEED_FACTOR: f64 = 1.1;

/// Stiffness of an object under the pressing finger, in g per unit of ANGLE_ACT.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stiffness {
    /// Less than 5: foam, a soft ball.
    Soft,
    /// 5 to 20: rubber, a full carton.
    Firm,
    /// 20 or more: wood, metal. The published rigid block gave 25.
    Rigid,
    /// Not determined by any grip.
    Unknown,
}

impl Stiffness {
    /// All classes, softest first; `Unknown` last.
    pub const ALL: [Self; 4] = [Self::Soft, Self::Firm, Self::Rigid, Self::Unknown];

    /// Returns the class of a stiffness in g per unit of ANGLE_ACT.
    pub fn of(g_per_angle: Option<f64>) -> Self {
        match g_per_angle {
            Some(g) if g >= 20.0 => Self::Rigid,
            Some(g) if g >= 5.0 => Self::Firm,
            Some(_) => Self::Soft,
            None => Self::Unknown,
        }
    }

    /// Name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Soft => "soft",
            Self::Firm => "firm",
            Self::Rigid => "rigid",
            Self::Unknown => "unknown",
        }
    }
}

/// Stages of an approach.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stages {
    /// At one speed all the way.
    One,
    /// Fast, then at the contact speed before the contact.
    Two,
}

/// Properties by which closes are counted together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct CloseKind {
    /// Joint that closed.
    #[serde(rename = "joint")]
    pub dof: Dof,
    /// Stages of its approach.
    pub stages: Stages,
    /// SPEED_SET at the contact.
    pub speed: Speed,
    /// FORCE_SET, g.
    #[serde(rename = "force_threshold_g")]
    pub threshold: Force,
    /// Stiffness of the object.
    pub stiffness: Stiffness,
}

/// Results of the closes of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredCloses {
    #[serde(flatten)]
    /// Their common properties.
    pub kind: CloseKind,
    /// Number of closes.
    pub closes: u32,
    /// Highest peak above the threshold, g.
    pub most_over_g: f64,
    /// Mean of the peaks above the threshold, g.
    pub mean_over_g: f64,
    /// Date of the first close, such as `2026-11-26`.
    pub first: String,
    /// Date of the last close.
    pub last: String,
}

impl MeasuredCloses {
    /// True if the numbers are possible: the peak is near or above the threshold, and the dates are dates.
    fn is_sound(&self) -> bool {
        let can_be = |over: f64| OVERS_G.contains(&over);
        let is_day =
            |day: &str| day.len() == 10 && day.bytes().all(|at| at.is_ascii_digit() || at == b'-');
        self.closes > 0
            && can_be(self.most_over_g)
            && can_be(self.mean_over_g)
            && is_day(&self.first)
            && is_day(&self.last)
    }
}

/// Hand on which a figure was measured.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasuredOn {
    /// This hand.
    ThisHand {
        /// Number of closes at the speeds and thresholds behind the figure.
        closes: u32,
        /// Date of the last of them, such as `2026-11-26`.
        last: String,
    },
    /// Another hand of the family: this one has no measurement there.
    AnotherHand,
}

/// Expected overshoot at a contact with a rigid object.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// Peak above the threshold, g: the highest measured on this hand, or the median measured on another.
    pub over_g: f64,
    /// Source of the figure.
    pub on: MeasuredOn,
}

/// Overshoot measured in one hand's closes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OvershootMap(Vec<MeasuredCloses>);

impl OvershootMap {
    /// Builds the map from stored results. Duplicate kinds are merged.
    pub fn of(kept: impl IntoIterator<Item = MeasuredCloses>) -> Self {
        let mut map = Self::default();
        kept.into_iter().for_each(|own| map.merge(own));
        map
    }

    /// Results, by kind.
    pub fn kinds(&self) -> &[MeasuredCloses] {
        &self.0
    }

    /// True if nothing was measured.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Total number of closes.
    pub fn closes(&self) -> u32 {
        count(self.0.iter())
    }

    /// Adds one close that overshot its threshold by `over_g` on a date.
    pub fn add(&mut self, kind: CloseKind, over_g: f64, day: &str) {
        self.merge(MeasuredCloses {
            kind,
            closes: 1,
            most_over_g: over_g,
            mean_over_g: over_g,
            first: day.into(),
            last: day.into(),
        });
    }

    fn merge(&mut self, new: MeasuredCloses) {
        if !new.is_sound() {
            return;
        }
        let Some(own) = self.0.iter_mut().find(|own| own.kind == new.kind) else {
            if self.0.len() >= KINDS_MAX {
                let all = self.0.iter().enumerate();
                let oldest = all.min_by(|(_, one), (_, other)| one.last.cmp(&other.last));
                if let Some((at, _)) = oldest {
                    self.0.remove(at);
                }
            }
            return self.0.push(new);
        };
        let closes = own.closes.saturating_add(new.closes);
        let share = f64::from(new.closes) / f64::from(closes);
        own.mean_over_g += (new.mean_over_g - own.mean_over_g) * share;
        own.most_over_g = own.most_over_g.max(new.most_over_g);
        own.closes = closes;
        if new.first < own.first {
            own.first = new.first;
        }
        if new.last > own.last {
            own.last = new.last;
        }
    }

    /// Expected overshoot of a joint that hits a rigid object at a speed, units of SPEED_SET, with a threshold in g. Fewer than
    /// [`CLOSES_LEAST`] closes of this hand, and closes on softer objects, can raise the figure, never lower it.
    pub fn expected(&self, dof: Dof, stages: Stages, speed: f64, threshold_g: f64) -> Expected {
        let published = match stages {
            Stages::One => impact::overshoot_g(speed, threshold_g),
            Stages::Two => impact::two_stage_overshoot_g(speed, threshold_g),
        };
        let near = || self.near(dof, stages, threshold_g);
        let is_rigid = |own: &&MeasuredCloses| own.kind.stiffness == Stiffness::Rigid;
        let rigid = Grown::at(near().filter(is_rigid), speed);
        let own = match rigid {
            Some(rigid) if rigid.is_within && rigid.closes >= CLOSES_LEAST => Some(rigid),
            _ => Grown::at(near(), speed).filter(|any| any.over_g > published),
        };
        match own {
            Some(own) => Expected {
                over_g: own.over_g,
                on: MeasuredOn::ThisHand {
                    closes: own.closes,
                    last: own.last,
                },
            },
            None => Expected {
                over_g: published,
                on: MeasuredOn::AnotherHand,
            },
        }
    }

    /// Lowest speed at which a contact with a rigid object overshoots this threshold by [`NOTABLE_G`]; `None` if none does.
    pub fn rough_from_speed(&self, dof: Dof, threshold: Force) -> Option<Speed> {
        let threshold_g = f64::from(threshold.get());
        if self.near(dof, Stages::One, threshold_g).next().is_none() {
            return impact::rough_from_speed(threshold);
        }
        let is_rough = |speed: i16| {
            let expected = self.expected(dof, Stages::One, speed.into(), threshold_g);
            expected.over_g >= NOTABLE_G
        };
        impact::first(Speed::MAX.get(), is_rough).and_then(|speed| Speed::new(speed).ok())
    }

    /// Smallest threshold that a contact with a rigid object at this speed overshoots by [`NOTABLE_G`]; `None` if there is none.
    pub fn rough_from_threshold(&self, dof: Dof, speed: Speed) -> Option<Force> {
        let published = impact::rough_from_threshold(speed);
        let own = self.0.iter().map(|own| own.kind);
        let own = own.filter(|kind| kind.dof == dof && kind.stages == Stages::One);
        // The expected value changes where the range of another threshold's closes begins or ends.
        let edges = own.flat_map(|kind| {
            let at = i64::from(kind.threshold.get());
            [(at * 2 + 2) / 3, at * 3 / 2 + 1].map(Force::nearest)
        });
        edges
            .chain(published)
            .filter(|threshold| {
                let (speed, threshold_g) = (speed.get().into(), threshold.get().into());
                let expected = self.expected(dof, Stages::One, speed, threshold_g);
                expected.over_g >= NOTABLE_G
            })
            .min()
    }

    /// Results of a joint at thresholds near this one: it is between two thirds of theirs and one and a half times theirs.
    fn near(
        &self,
        dof: Dof,
        stages: Stages,
        threshold_g: f64,
    ) -> impl Iterator<Item = &MeasuredCloses> {
        let is_near = move |own: &&MeasuredCloses| {
            let at = f64::from(own.kind.threshold.get());
            own.kind.dof == dof
                && own.kind.stages == stages
                && threshold_g * 3.0 >= at * 2.0
                && threshold_g * 2.0 <= at * 3.0
        };
        self.0.iter().filter(is_near)
    }
}

fn count<'a>(closes: impl Iterator<Item = &'a MeasuredCloses>) -> u32 {
    closes.fold(0, |all, own| all.saturating_add(own.closes))
}

/// Peaks of a joint as a function of speed: linear between the measured speeds, zero at rest, and never falling with
/// speed.
struct Grown {
    over_g: f64,
    /// True if comparable speeds were measured.
    is_within: bool,
    closes: u32,
    last: String,
}

impl Grown {
    /// Value at a speed; constant above the highest measured speed. `None` without closes.
    fn at<'a>(closes: impl Iterator<Item = &'a MeasuredCloses>, speed: f64) -> Option<Self> {
        let mut closes: Vec<&MeasuredCloses> = closes.collect();
        // Within one speed, the highest peak first.
        closes.sort_by(|a, b| {
            let by_speed = a.kind.speed.cmp(&b.kind.speed);
            by_speed.then(b.most_over_g.total_cmp(&a.most_over_g))
        });
        let fastest = f64::from(closes.last()?.kind.speed.get());
        let (mut low, mut over_g) = ((0.0, 0.0), None);
        for own in &closes {
            let high = (f64::from(own.kind.speed.get()), own.most_over_g.max(low.1));
            if speed <= high.0 && over_g.is_none() {
                let part = (speed - low.0) / (high.0 - low.0).max(f64::EPSILON);
                over_g = Some(low.1 + (high.1 - low.1) * part);
            }
            low = high;
        }
        Some(Self {
            over_g: over_g.unwrap_or(low.1),
            is_within: speed <= fastest * SPEED_FACTOR,
            closes: count(closes.iter().copied()),
            last: closes.iter().map(|own| own.last.as_str()).max()?.into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(speed: i16, threshold: i16, stiffness: Stiffness) -> CloseKind {
        CloseKind {
            dof: Dof::Index,
            stages: Stages::One,
            speed: Speed::new(speed).unwrap(),
            threshold: Force::new(threshold).unwrap(),
            stiffness,
        }
    }

    fn map(closes: &[(i16, i16, Stiffness, f64)]) -> OvershootMap {
        let mut map = OvershootMap::default();
        for (speed, threshold, stiffness, over) in closes {
            for _ in 0..CLOSES_LEAST {
                map.add(kind(*speed, *threshold, *stiffness), *over, "2026-11-20");
            }
        }
        map
    }

    fn expected(map: &OvershootMap, speed: f64, threshold: f64) -> (f64, bool) {
        let expected = map.expected(Dof::Index, Stages::One, speed, threshold);
        (expected.over_g, expected.on != MeasuredOn::AnotherHand)
    }

    #[test]
    fn closes_of_a_kind_are_counted_together_with_their_days() {
        let mut map = OvershootMap::default();
        map.add(kind(100, 500, Stiffness::Rigid), 40.0, "2026-11-20");
        map.add(kind(100, 500, Stiffness::Rigid), 70.0, "2026-11-26");
        map.add(kind(100, 500, Stiffness::Rigid), 10.0, "2026-11-02");
        map.add(kind(100, 500, Stiffness::Soft), f64::NAN, "2026-11-02");
        let [own] = map.kinds() else {
            panic!("{map:?}")
        };
        assert_eq!(
            (own.closes, own.most_over_g, own.mean_over_g),
            (3, 70.0, 40.0)
        );
        assert_eq!(
            (own.first.as_str(), own.last.as_str()),
            ("2026-11-02", "2026-11-26")
        );
        assert_eq!(OvershootMap::of(map.kinds().to_vec()), map);
        let twice = OvershootMap::of([map.kinds(), map.kinds()].concat());
        assert_eq!((twice.kinds().len(), twice.closes()), (1, 6));
    }

    #[test]
    fn this_hand_replaces_the_other_only_where_it_was_tried_on_something_rigid() {
        let published = |speed, threshold| impact::overshoot_g(speed, threshold);
        let none = OvershootMap::default();
        assert_eq!(
            expected(&none, 250.0, 500.0),
            (published(250.0, 500.0), false)
        );
        let own = map(&[
            (25, 500, Stiffness::Rigid, 10.0),
            (200, 500, Stiffness::Rigid, 80.0),
        ]);
        assert_eq!(expected(&own, 200.0, 500.0), (80.0, true));
        assert_eq!(expected(&own, 12.5, 500.0), (5.0, true));
        assert_eq!(expected(&own, 112.5, 700.0), (45.0, true));
        assert_eq!(
            expected(&own, 220.0, 340.0),
            (80.0, true),
            "a little faster"
        );
        assert_eq!(
            expected(&own, 250.0, 500.0),
            (published(250.0, 500.0), false)
        );
        assert_eq!(
            expected(&own, 200.0, 800.0),
            (published(200.0, 800.0), false)
        );
        let two = own.expected(Dof::Index, Stages::Two, 25.0, 500.0);
        assert_eq!(two.on, MeasuredOn::AnotherHand);
        let thumb = own.expected(Dof::ThumbBend, Stages::One, 25.0, 500.0);
        assert_eq!(thumb.on, MeasuredOn::AnotherHand);
    }

    #[test]
    fn too_few_closes_make_a_warning_sharper_and_never_milder() {
        let published = impact::overshoot_g(250.0, 500.0);
        let mut map = OvershootMap::default();
        for _ in 1..CLOSES_LEAST {
            map.add(kind(250, 500, Stiffness::Rigid), 39.0, "2026-11-30");
            assert_eq!(expected(&map, 250.0, 500.0), (published, false));
        }
        map.add(kind(250, 500, Stiffness::Rigid), 39.0, "2026-11-30");
        assert_eq!(expected(&map, 250.0, 500.0), (39.0, true));
        let mut one = OvershootMap::default();
        one.add(kind(250, 500, Stiffness::Rigid), 1500.0, "2026-11-30");
        assert_eq!(expected(&one, 250.0, 500.0), (1500.0, true));
    }

    #[test]
    fn a_softer_object_makes_a_warning_sharper_and_never_milder() {
        let mild = map(&[(250, 500, Stiffness::Soft, 20.0)]);
        assert!(!expected(&mild, 250.0, 500.0).1);
        let wild = map(&[(250, 500, Stiffness::Firm, 1500.0)]);
        assert_eq!(expected(&wild, 250.0, 500.0), (1500.0, true));
        assert!(expected(&wild, 600.0, 500.0).0 >= 1500.0);
    }

    #[test]
    fn the_first_rough_speed_and_threshold_are_where_the_expected_is() {
        let all = [
            map(&[]),
            map(&[(1000, 500, Stiffness::Rigid, 300.0)]),
            map(&[(100, 500, Stiffness::Rigid, 900.0)]),
            map(&[
                (250, 200, Stiffness::Firm, 700.0),
                (40, 1000, Stiffness::Rigid, 90.0),
            ]),
        ];
        for map in &all {
            for threshold in [100, 250, 400, 500, 700, 1200, 3000] {
                let threshold_g = f64::from(threshold);
                let rough = map.rough_from_speed(Dof::Index, Force::new(threshold).unwrap());
                let found = (0..=1000_i16)
                    .find(|speed| expected(map, f64::from(*speed), threshold_g).0 >= NOTABLE_G);
                assert_eq!(rough.map(Speed::get), found, "{map:?} {threshold}");
            }
            for speed in [25, 100, 150, 250, 500, 1000] {
                let rough = map.rough_from_threshold(Dof::Index, Speed::new(speed).unwrap());
                let found = (0..=3000_i16).find(|threshold| {
                    expected(map, f64::from(speed), f64::from(*threshold)).0 >= NOTABLE_G
                });
                assert_eq!(rough.map(Force::get), found, "{map:?} {speed}");
            }
        }
    }

    #[test]
    fn what_no_hand_can_have_measured_counts_for_nothing() {
        let map = map(&[(250, 500, Stiffness::Rigid, 60.0)]);
        let own = &map.kinds()[0];
        let wrong = [
            MeasuredCloses {
                most_over_g: -500.0,
                ..own.clone()
            },
            MeasuredCloses {
                mean_over_g: 1e300,
                ..own.clone()
            },
            MeasuredCloses {
                closes: 0,
                ..own.clone()
            },
            MeasuredCloses {
                last: "\u{1b}[31m".into(),
                ..own.clone()
            },
        ];
        assert!(OvershootMap::of(wrong).is_empty());
        let most = MeasuredCloses {
            closes: u32::MAX,
            ..own.clone()
        };
        let other = MeasuredCloses {
            kind: kind(300, 500, Stiffness::Rigid),
            ..most.clone()
        };
        let many = OvershootMap::of([most.clone(), most, other]);
        assert_eq!(many.closes(), u32::MAX);
        assert_eq!(expected(&many, 250.0, 500.0), (60.0, true));
    }

    #[test]
    fn no_more_kinds_are_kept_than_there_is_room_for() {
        let mut map = OvershootMap::default();
        for nth in 0..2100_i16 {
            let day = format!("2026-{nth:05}");
            map.add(
                kind(nth % 1000, nth / 1000 + 100, Stiffness::Rigid),
                1.0,
                &day,
            );
        }
        assert_eq!(map.kinds().len(), KINDS_MAX);
        assert_eq!(map.kinds()[0].first, "2026-00100");
    }
}
