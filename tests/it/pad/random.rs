//! Whatever comes from a gamepad, in whatever order: what must never be asked of a hand is never asked of it.

use crate::pad::setup::{BLUETOOTH, PAD, STEAM, SWITCH, XBOX, facts};
use handscope::hand::{Angle, Moment, PerDof};
use handscope::inputs::pad::input::{HEARD_TIMEOUT, PadAim};
use handscope::inputs::pad::{
    KernelEvent, PadAction, PadControl, PadEvent, PadId, PadInput, PadMap, PadNews, PadReport,
};
use std::collections::BTreeMap;
use std::time::Duration;

/// What a fair witness knows of the dead-man and STOP, from the same reports.
#[derive(Default)]
struct Witness {
    followed: Option<PadId>,
    is_down: bool,
    /// It went down while it was followed, after everything that lets go.
    is_fresh: bool,
    is_stop_down: bool,
    heard: Moment,
}

const DEAD_MAN: u16 = 0x136;
const STOP: u16 = 0x131;

impl Witness {
    fn take(&mut self, report: &PadReport) {
        let followed = self.followed;
        match &report.news {
            PadNews::Found { pad, now, .. } if followed.is_none() => {
                self.followed = Some(*pad);
                self.anew(now);
            }
            PadNews::Lost { pad, now } if followed == Some(*pad) => self.anew(now),
            PadNews::Moved { pad, event } if followed == Some(*pad) => match *event {
                KernelEvent::Key {
                    code: DEAD_MAN,
                    is_down,
                } => {
                    self.is_fresh = is_down && (self.is_fresh || !self.is_down);
                    self.is_down = is_down;
                }
                KernelEvent::Key {
                    code: STOP,
                    is_down,
                } => {
                    self.is_fresh &= !is_down || self.is_stop_down;
                    self.is_stop_down = is_down;
                }
                _ => {}
            },
            PadNews::Alive(pad) if followed == Some(*pad) => {}
            PadNews::Gone(pad) if followed == Some(*pad) => {
                *self = Self::default();
                return;
            }
            _ => return,
        }
        self.heard = report.at;
    }

    fn anew(&mut self, now: &[KernelEvent]) {
        (self.is_down, self.is_stop_down, self.is_fresh) = (false, false, false);
        for event in now {
            match *event {
                KernelEvent::Key {
                    code: DEAD_MAN,
                    is_down,
                } => self.is_down = is_down,
                KernelEvent::Key {
                    code: STOP,
                    is_down,
                } => self.is_stop_down = is_down,
                _ => {}
            }
        }
    }
}

fn random_event(random: &mut fastrand::Rng) -> KernelEvent {
    let keys = [
        DEAD_MAN, DEAD_MAN, STOP, 0x130, 0x133, 0x134, 0x137, 0x138, 0x139, 0x13b, 0x2c0, 0,
    ];
    let axes = [0, 1, 2, 3, 4, 5, 9, 10, 16, 17, 20, 21, 40, u16::MAX];
    let values = [
        i32::MIN,
        -32768,
        -1,
        0,
        1,
        90,
        255,
        1023,
        32767,
        65535,
        i32::MAX,
    ];
    match random.bool() {
        true => KernelEvent::Key {
            code: keys[random.usize(..keys.len())],
            is_down: random.bool(),
        },
        false => KernelEvent::Axis {
            code: axes[random.usize(..axes.len())],
            value: match random.bool() {
                true => values[random.usize(..values.len())],
                false => random.i32(..),
            },
        },
    }
}

fn random_news(random: &mut fastrand::Rng) -> PadNews {
    let pad = match random.u8(..8) {
        0 => PadId(8),
        _ => PAD,
    };
    let mut several = |count: usize| (0..count).map(|_| random_event(random)).collect();
    let now: Vec<KernelEvent> = several(4);
    let event = now[0];
    let axes = [XBOX, BLUETOOTH, SWITCH, STEAM, &[]];
    match random.u8(..24) {
        0..=2 => PadNews::Found {
            pad,
            facts: facts(axes[random.usize(..axes.len())]),
            now,
        },
        3 => PadNews::Lost { pad, now },
        4 => PadNews::Gone(pad),
        5..=8 => PadNews::Alive(pad),
        _ => PadNews::Moved { pad, event },
    }
}

fn input(random: &mut fastrand::Rng) -> PadInput {
    let mut input = PadInput::new(PadMap::usual());
    let joint = |random: &mut fastrand::Rng| {
        let angle = Angle::new(random.i64(0..=1000)).ok();
        angle.filter(|_| random.bool())
    };
    let mut pose = || PerDof::from_fn(|_| joint(random));
    let poses = ["Open", "Pinch"].map(|name| (name.to_owned(), PadAim::joints(pose())));
    input.set_poses(BTreeMap::from(poses));
    input.set_actual(pose());
    input
}

#[test]
fn no_schedule_of_events_moves_a_hand_without_the_dead_man_or_loses_a_stop() {
    let mut held_times = 0;
    for seed in 0..300 {
        let mut random = fastrand::Rng::with_seed(seed);
        let (mut input, mut witness) = (input(&mut random), Witness::default());
        let mut at = Moment::ZERO;
        for step in 0..400 {
            at = at.plus(Duration::from_millis(random.u64(..120)));
            let news = random_news(&mut random);
            let report = PadReport { at, news };
            let was_down = input.state().is_held(PadControl::East);
            let followed = input.pad();
            let event = input.receive(&report);
            witness.take(&report);
            // Of whichever pad: it lets go.
            witness.is_fresh &= event != Some(PadEvent::Stop);
            let pressed = matches!(&report.news, PadNews::Moved { pad, event: KernelEvent::Key { code: STOP, is_down: true } } if followed == Some(*pad));
            if pressed && !was_down {
                assert_eq!(event, Some(PadEvent::Stop), "seed {seed} step {step}");
            }
            let now = at.plus(Duration::from_millis(random.u64(..260)));
            let Some(offer) = input.offer(now) else {
                assert_eq!(witness.followed, None);
                continue;
            };
            let may =
                witness.is_down && witness.is_fresh && now.since(witness.heard) <= HEARD_TIMEOUT;
            assert_eq!(offer.held, Some(may), "seed {seed} step {step}");
            let aims = offer.aims.as_array().iter().flatten();
            let mut aims = aims.inspect(|aim| assert!((0..=1000).contains(&aim.get())));
            assert!(may || aims.next().is_none(), "seed {seed} step {step}");
            aims.for_each(drop);
            held_times += u32::from(may);
            at = now;
        }
    }
    assert!(held_times > 1000, "only {held_times} times held");
    let stop = PadMap::usual();
    assert_eq!(stop.doing(&PadAction::Stop).next(), Some(PadControl::East));
}
