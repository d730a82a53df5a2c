//! Another hand as a source for a hand to follow: each reading of its joint angles gives the targets, scaled.
//! That hand is read and never written. Left and right have the same six joints in the same order, so one can follow the other directly.

use crate::hand::{Angle, AngleReading, Group, HandSample, Moment, PerDof};
use crate::inputs::offer::{Offer, OfferLimits, OfferOutlet, is_fresh};
use crate::link::stats::EventRate;
use crate::link::{Owner, Records};
use crate::record::Record;
use tokio::sync::{mpsc, watch};
use tokio_util::task::AbortOnDropHandle;

/// Share of each bend of the other hand that is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MirrorScale(f32);

impl MirrorScale {
    /// Smallest and largest share.
    pub const RANGE: (f32, f32) = (0.2, 1.0);
    /// Smallest and largest share, percent.
    pub const PERCENT: [u8; 2] = [20, 100];
    /// The full bend of the other hand.
    pub const WHOLE: Self = Self(1.0);

    /// Creates a share within [`Self::RANGE`]; `None` outside.
    pub fn new(share: f32) -> Option<Self> {
        let (least, most) = Self::RANGE;
        (least..=most).contains(&share).then_some(Self(share))
    }

    /// Creates a share from percent within [`Self::PERCENT`]; `None` outside.
    pub fn of_percent(percent: u8) -> Option<Self> {
        Self::new(f32::from(percent) / 100.0)
    }

    /// Share in percent.
    pub fn percent(self) -> f32 {
        (self.0 * 100.0).round()
    }

    /// Target of a joint for this angle of the other hand's joint: its travel from open, times the share.
    pub fn aim(self, leader: Angle) -> Angle {
        let bent = f32::from(Angle::MAX.get()) - f32::from(leader.get());
        let aim = f32::from(Angle::MAX.get()) - self.0 * bent;
        #[expect(clippy::cast_possible_truncation, reason = "rounded, and in range")]
        Angle::nearest(aim.round() as i64)
    }
}

/// State of the other hand.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MirrorView {
    /// Time of the last reading of its joint angles.
    pub heard: Option<Moment>,
    /// Readings in the last second.
    pub rate_hz: f64,
}

impl MirrorView {
    /// Owner as which it would control the hand at `now`; `None` without a fresh reading.
    pub fn owner(&self, now: Moment) -> Option<Owner> {
        is_fresh(self.heard?, now).then_some(Owner::Mirror)
    }
}

/// Observes another hand until dropped; does not keep its link open.
#[derive(Debug)]
pub struct MirrorSource {
    view: watch::Receiver<MirrorView>,
    outlet: OfferOutlet,
    task: AbortOnDropHandle<()>,
}

impl MirrorSource {
    /// Observes from now on. The links of both hands must use the same clock. Must be called within a tokio runtime.
    pub fn open(leader: Records, scale: MirrorScale) -> Self {
        let (views, view) = watch::channel(MirrorView::default());
        let outlet = OfferOutlet::default();
        let watching = watch(leader, scale, views, outlet.clone());
        Self {
            view,
            outlet,
            task: AbortOnDropHandle::new(tokio::spawn(watching)),
        }
    }

    /// Current state.
    pub fn view(&self) -> MirrorView {
        *self.view.borrow()
    }

    /// True once its link was closed and no further readings come.
    pub fn is_over(&self) -> bool {
        self.task.is_finished()
    }

    /// Receives its angles as targets from now on; replaces the previous follower.
    pub fn follow(&self) -> mpsc::Receiver<Offer> {
        self.outlet.follow()
    }
}

async fn watch(
    mut records: Records,
    scale: MirrorScale,
    views: watch::Sender<MirrorView>,
    outlet: OfferOutlet,
) {
    let mut rate = EventRate::default();
    while let Some(record) = records.next().await {
        let Record::Reading { sample, fresh } = record else {
            continue;
        };
        let is_news = fresh.contains(Group::Angle);
        if let Some(offer) = is_news.then(|| offer(&sample, scale)).flatten() {
            rate.hit(offer.at);
            views.send_replace(MirrorView {
                heard: Some(offer.at),
                rate_hz: rate.hz(offer.at),
            });
            outlet.offer(offer);
        }
    }
}

/// Targets of a reading; `None` if no joint is known. An unknown joint is left alone.
fn offer(sample: &HandSample, scale: MirrorScale) -> Option<Offer> {
    let angle = sample.angle?;
    let aims = PerDof::from_fn(|dof| AngleReading::hold(angle.value[dof]).map(|at| scale.aim(at)));
    aims.iter().any(|(_, aim)| aim.is_some()).then_some(Offer {
        at: angle.received,
        aims,
        gap: None,
        hold: None,
        limits: OfferLimits::NONE,
        held: None,
        // A hand at rest legitimately repeats its angles: its answers prove that it is alive.
        mark: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{Dof, Timed};

    #[test]
    fn the_way_from_open_is_scaled_and_shares_outside_the_range_are_none() {
        for (share, leader, aim) in [
            (1.0, 0, 0),
            (1.0, 345, 345),
            (1.0, 1000, 1000),
            (0.5, 0, 500),
            (0.5, 301, 651),
            (0.2, 0, 800),
            (0.2, 1000, 1000),
        ] {
            let scale = MirrorScale::new(share).unwrap();
            let leader = Angle::new(leader).unwrap();
            assert_eq!(scale.aim(leader).get(), aim, "{share} of {leader:?}");
        }
        for percent in 0..=u8::MAX {
            let scale = MirrorScale::of_percent(percent);
            assert_eq!(scale.is_some(), (20..=100).contains(&percent), "{percent}");
            assert!(scale.is_none_or(|scale| scale.percent() == f32::from(percent)));
        }
        for share in [0.19, 1.01, -0.5, f32::NAN, f32::INFINITY] {
            assert_eq!(MirrorScale::new(share), None, "{share}");
        }
    }

    #[test]
    fn an_angle_that_makes_no_sense_is_no_target_and_six_of_them_are_no_offer() {
        let sample = |raw: [i16; 6]| HandSample {
            angle: Some(Timed {
                value: PerDof::new(raw).map(AngleReading::new),
                asked: Moment::from_micros(1),
                received: Moment::from_micros(2),
            }),
            ..HandSample::default()
        };
        let some = sample([500, -1, 1004, 32_767, -300, 2000]);
        let offer = |sample| offer(&sample, MirrorScale::WHOLE);
        let offered = offer(some).unwrap();
        let aims = offered.aims.map(|aim| aim.map(Angle::get));
        assert_eq!(aims[Dof::Little], Some(500));
        assert_eq!(
            (aims[Dof::Ring], aims[Dof::Middle]),
            (Some(0), Some(1000)),
            "a little past an end stop is the end stop"
        );
        for dof in [Dof::Index, Dof::ThumbBend, Dof::ThumbRotate] {
            assert_eq!(aims[dof], None, "{dof:?}");
        }
        assert_eq!((offered.at, offered.mark), (Moment::from_micros(2), None));
        assert_eq!(offer(sample([-300; 6])), None);
        assert_eq!(offer(HandSample::default()), None);
    }
}
