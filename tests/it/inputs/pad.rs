//! A gamepad in a person's hands: an object is picked, held and put down in the simulated world, and a pad that is pulled ends in a
//! hold.

use crate::inputs::follow::Stage;
use crate::pad::setup::{PAD, Played};
use crate::setup::hand;
use crate::setup::time::in_virtual_time;
use handscope::hand::{Dof, Force, PerDof};
use handscope::inputs::Offer;
use handscope::inputs::pad::PadNews;
use handscope::link::Owner;
use handscope::record::{Disarmed, Record, WriteCause};
use handscope::sim::{Object, SimConfig, SimHand};
use tokio::sync::mpsc;

/// What an object may be pressed with beyond the force that a person set, g.
const OVERSHOOT_MAX: i16 = 100;
/// The joints that press: the thumb's rotation misses the object.
const PRESS: [Dof; 5] = [
    Dof::Little,
    Dof::Ring,
    Dof::Middle,
    Dof::Index,
    Dof::ThumbBend,
];

struct Teleoperator {
    stage: Stage,
    pad: Played,
    offers: mpsc::Sender<Offer>,
}

impl Teleoperator {
    /// For this time, as the pad says each 10 ms where it wants the hand.
    async fn play(&mut self, ms: u64) {
        for _ in 0..ms / 10 {
            self.pad.now = self.stage.clock().now();
            self.pad.news(PadNews::Alive(PAD));
            let _taken = self.offers.try_send(self.pad.offer());
            self.stage.pass(10).await;
        }
    }

    /// Both triggers go from here to there, in this time.
    async fn squeeze(&mut self, from: i32, to: i32, ms: i32) {
        for at in 0..=ms / 10 {
            let raw = from + (to - from) * at * 10 / ms;
            self.pad.says("ABS_Z", raw);
            self.pad.says("ABS_RZ", raw);
            self.play(10).await;
        }
    }

    fn forces(&self) -> PerDof<i16> {
        let force = self.stage.sample().force.unwrap().value;
        force.map(|force| force.raw())
    }

    /// The highest force of each joint so far.
    fn peaks(&self) -> PerDof<i16> {
        let mut peaks = PerDof::splat(0);
        for record in self.stage.records() {
            if let Record::Reading { sample, .. } = record
                && let Some(force) = sample.force
            {
                peaks = PerDof::from_fn(|dof| force.value[dof].raw().max(peaks[dof]));
            }
        }
        peaks
    }
}

#[test]
fn an_object_is_picked_held_and_put_down_and_a_pulled_pad_ends_in_a_hold() {
    in_virtual_time(async {
        let mut hand = SimHand::new(SimConfig::default());
        hand.set_object(&Object::soft_ball());
        let stage = Stage::at(hand::begin(hand)).await;
        let lease = stage.link().grant(Owner::Gamepad);
        let (offers, _task) = stage.start(lease);
        let mut person = Teleoperator {
            stage,
            pad: Played::xbox(),
            offers,
        };
        person.pad.now = person.stage.clock().now();
        person.pad.says("BTN_TL", 1);
        person.play(300).await;
        person.squeeze(0, 255, 3000).await;
        person.play(2000).await;
        let held = person.forces();
        for dof in PRESS {
            assert!(held[dof] > 200, "{dof:?} does not hold: {held:?}");
        }
        let (peaks, limit) = (person.peaks(), Force::GENTLE.get());
        for dof in PRESS {
            let over = peaks[dof] - limit;
            assert!(over < OVERSHOOT_MAX, "{dof:?}: {over} g beyond {limit}");
        }
        // Put down.
        person.squeeze(255, 0, 2000).await;
        person.play(1500).await;
        let free = person.forces();
        for dof in PRESS {
            assert!(free[dof].abs() < 60, "{dof:?} still presses: {free:?}");
        }
        // Picked again, and the pad is pulled.
        person.squeeze(0, 128, 1000).await;
        person.pad.now = person.stage.clock().now();
        person.pad.news(PadNews::Gone(PAD));
        for _ in 0..150 {
            let _taken = person.offers.try_send(person.pad.offer());
            person.stage.pass(10).await;
        }
        let status = person.stage.link().status();
        assert_eq!(
            (status.armed, status.disarmed),
            (None, Some(Disarmed::Released))
        );
        assert_eq!(person.stage.index().last().unwrap().cause, WriteCause::Hold);
    });
}
