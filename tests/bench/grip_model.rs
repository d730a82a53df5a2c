//! Grasps as pure functions of time: what is true of each finger, and what a hand would read of it, with offsets that drift, friction of
//! free motion, noise, wrist turns, slips fast and slow, bumps, vibration, light grips and losses. It shares nothing with the simulated
//! hand, so that both can be wrong in different ways.

use super::grip_table::{EventKind, GripTable, Seen, Truth};
use handscope::hand::grip::{Grip, GripEstimator, GripState};
use handscope::hand::{
    AngleReading, Dof, Finger, ForceReading, Group, Groups, HandSample, Moment, PerDof, PerFinger,
    Status, TactileBlock, Timed,
};

/// Grasps of one hand; the first is in the air.
const GRASPS: u64 = 16;
/// When fingers close, when something happens, when they open, and the end, ms into a grasp.
const CLOSES_MS: f64 = 700.0;
const EVENT_MS: f64 = 5500.0;
const OPENS_MS: f64 = 9500.0;
const ENDS_MS: u64 = 12_000;
/// The hand acts so late.
const LATE_MS: f64 = 64.0;
/// Newtons of a gram.
const N_PER_G: f64 = 0.009_806_65;

/// One hand: what its sensors add to the truth.
struct Hand {
    chance: fastrand::Rng,
    zero_g: PerDof<f64>,
    noise_g: f64,
    tip_noise_n: f64,
    /// A fingertip's newtons by those of the load: the sensors of one hand differ.
    tip_scale: PerFinger<f64>,
    /// Friction at 240 counts, g.
    friction_g: PerDof<f64>,
    touch_each: u64,
}

/// What happens to the object in the middle of a grasp.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Event {
    Nothing,
    /// Force rises by half for 0.15 s.
    Bump,
    /// The ratio shakes.
    Vibration {
        for_ms: f64,
    },
    /// The tangential force turns, at the same normal force and ratio.
    WristTurn {
        degrees: f64,
        for_ms: f64,
    },
    Loss,
    /// The ratio rises for so long, then the object is gone.
    Slip {
        for_ms: f64,
        to: f64,
        normal: f64,
    },
}

struct Plan {
    speed: f64,
    to: f64,
    contact: PerFinger<Option<f64>>,
    load_g: f64,
    stiffness: f64,
    ratio: f64,
    direction: f64,
    event: Event,
    /// Drift of all offsets from rest to the event, g.
    drift_g: f64,
}

/// One finger at one moment.
#[derive(Debug, Clone, Copy)]
struct Now {
    angle: f64,
    load_g: f64,
    ratio: f64,
    direction: f64,
    status: Status,
    state: Option<GripState>,
}

/// Grasps of hands with these seeds.
pub(crate) fn grasps(hands: std::ops::Range<u64>) -> GripTable {
    let mut table = GripTable::default();
    for seed in hands {
        let mut hand = Hand::of(seed);
        let mut sample = HandSample::default();
        let mut estimator = GripEstimator::default();
        for at in 0..GRASPS {
            let plan = Plan::draw(&mut hand.chance, at == 0);
            let begins = at * ENDS_MS;
            let mut truth = Truth::default();
            let mut seen = Seen::default();
            for ms in 0..ENDS_MS {
                let t = ms as f64;
                let now = PerFinger::from_fn(|finger| plan.now(finger, t));
                truth.set(&now.map(|own| own.state), ms);
                let Some(fresh) = hand.read(&mut sample, &now, &plan, begins, ms) else {
                    continue;
                };
                let grip: Grip = estimator.apply(&sample, fresh, moment(begins + ms));
                seen.take(&grip, &truth, ms, &mut table);
            }
            seen.end_of_fingers(&truth, plan.event.kind(), &mut table);
            for (_, zero) in hand.zero_g.iter_mut() {
                *zero += plan.drift_g;
            }
            table.count += 1;
        }
    }
    table
}

fn moment(ms: u64) -> Moment {
    Moment::from_micros(ms * 1000)
}

impl Event {
    fn draw(chance: &mut fastrand::Rng) -> Self {
        match chance.u8(..12) {
            0 | 1 => Self::Nothing,
            2 => Self::Bump,
            3 => Self::Vibration {
                for_ms: 2500.0 * chance.f64() + 500.0,
            },
            4 | 5 => Self::WristTurn {
                degrees: (60.0 + 120.0 * chance.f64()) * if chance.bool() { 1.0 } else { -1.0 },
                for_ms: 300.0 + 1700.0 * chance.f64(),
            },
            6..9 => Self::Loss,
            _ => Self::Slip {
                for_ms: 150.0 * 20f64.powf(chance.f64()),
                to: 0.4 + 0.3 * chance.f64(),
                normal: 0.5 + 0.5 * chance.f64(),
            },
        }
    }

    fn kind(self) -> EventKind {
        match self {
            Self::Nothing | Self::Bump | Self::Vibration { .. } | Self::Loss => EventKind::Calm,
            Self::WristTurn { .. } => EventKind::WristTurn,
            Self::Slip { .. } => EventKind::Slip,
        }
    }

    fn lost_at(self) -> Option<f64> {
        match self {
            Self::Loss => Some(EVENT_MS),
            Self::Slip { for_ms, .. } => Some(EVENT_MS + for_ms),
            _ => None,
        }
    }
}

impl Plan {
    fn draw(chance: &mut fastrand::Rng, in_the_air: bool) -> Self {
        let angle = 350.0 + 400.0 * chance.f64();
        let misses = in_the_air || chance.u8(..8) == 0;
        Self {
            speed: 1.52 * (80.0 + 900.0 * chance.f64()),
            to: 250.0 * chance.f64(),
            contact: PerFinger::from_fn(|_| {
                let misses = misses || chance.u8(..6) == 0;
                let own = angle + 80.0 * (chance.f64() - 0.5);
                (!misses).then_some(own)
            }),
            load_g: match chance.u8(..10) {
                0 => 2300.0 + 400.0 * chance.f64(),
                1..4 => 40.0 + 40.0 * chance.f64(),
                _ => 80.0 * 15f64.powf(chance.f64()),
            },
            stiffness: 40f64.powf(chance.f64()),
            ratio: 0.1 + 0.15 * chance.f64(),
            direction: 360.0 * chance.f64(),
            event: Event::draw(chance),
            drift_g: if chance.bool() {
                0.0
            } else {
                let sign = if chance.u8(..4) == 0 { -1.0 } else { 1.0 };
                sign * (25.0 + 75.0 * chance.f64())
            },
        }
    }

    fn now(&self, finger: Finger, t: f64) -> Now {
        let contact = self.contact[finger];
        let end = contact.map_or(self.to, |contact| {
            (contact - self.load_g / self.stiffness).max(0.0)
        });
        let began = CLOSES_MS + LATE_MS;
        let way = |since: f64| self.speed * 0.001 * (t - since).max(0.0);
        let closed = (1000.0 - way(began)).max(end);
        let opens = t >= OPENS_MS + LATE_MS;
        let angle = match opens {
            true => (end + way(OPENS_MS + LATE_MS)).min(1000.0),
            false => closed,
        };
        let arrived = began + (1000.0 - end) / self.speed * 1000.0;
        let moves = (began..arrived).contains(&t) || opens && angle < 1000.0;
        let gone = self.event.lost_at().is_some_and(|at| t >= at);
        let pressed = contact.map_or(0.0, |contact| (contact - angle) * self.stiffness);
        let impact = 1.0 + 0.2 * (-(t - arrived).max(0.0) / 150.0).exp();
        let rest_g = contact.map_or(0.0, |contact| (contact - end) * self.stiffness);
        let load_g = if gone {
            0.0
        } else {
            pressed.clamp(0.0, self.load_g) * impact
        };
        let status = match () {
            () if opens && angle < 1000.0 => Status::Releasing,
            () if moves => Status::Grasping,
            () if contact.is_some() && t >= arrived && !opens => Status::ForceReached,
            () => Status::PositionReached,
        };
        let mut now = Now {
            angle,
            load_g,
            ratio: self.ratio,
            direction: self.direction,
            status,
            state: self.state(rest_g, moves, t, arrived, opens),
        };
        self.happen(&mut now, t);
        now
    }

    /// What is true; `None` where more than one answer would be right.
    fn state(
        &self,
        rest_g: f64,
        moves: bool,
        t: f64,
        arrived: f64,
        opens: bool,
    ) -> Option<GripState> {
        let holds = rest_g > 0.0;
        let slides = match self.event {
            Event::Slip { for_ms, .. } => (EVENT_MS..EVENT_MS + for_ms).contains(&t),
            _ => false,
        };
        let gone = self.event.lost_at().is_some_and(|at| t >= at);
        match () {
            () if moves && holds => None,
            () if moves => Some(GripState::Moving),
            () if opens || t < arrived => Some(GripState::Open),
            () if !holds => Some(GripState::Empty),
            () if gone => (rest_g >= 31.0).then_some(GripState::Lost),
            () if slides => Some(GripState::Slipping),
            () => match rest_g {
                ..5.0 => Some(GripState::Empty),
                ..31.0 | 1400.0..2100.0 => None,
                2100.0.. => Some(GripState::TooHard),
                _ => Some(GripState::Holding),
            },
        }
    }

    fn happen(&self, now: &mut Now, t: f64) {
        let since = t - EVENT_MS;
        if since < 0.0 {
            return;
        }
        match self.event {
            // Vibration comes with each reading.
            Event::Nothing | Event::Loss | Event::Vibration { .. } => {}
            Event::Bump => now.load_g *= if since < 150.0 { 1.5 } else { 1.0 },
            Event::WristTurn { degrees, for_ms } => {
                now.direction += degrees * (since / for_ms).min(1.0);
            }
            Event::Slip { for_ms, to, normal } => {
                let share = (since / for_ms).min(1.0);
                now.ratio += (to - self.ratio) * share;
                now.load_g *= 1.0 + (normal - 1.0) * share;
            }
        }
    }

    fn shakes(&self, t: f64) -> bool {
        match self.event {
            Event::Vibration { for_ms } => (EVENT_MS..EVENT_MS + for_ms).contains(&t),
            _ => false,
        }
    }
}

impl Hand {
    fn of(seed: u64) -> Self {
        let mut chance = fastrand::Rng::with_seed(seed ^ 0x6772_6970);
        Self {
            zero_g: PerDof::from_fn(|_| 480.0 * (chance.f64() - 0.5)),
            noise_g: 1.0 + 11.0 * chance.f64() * chance.f64(),
            tip_noise_n: 0.005 + 0.015 * chance.f64(),
            tip_scale: PerFinger::from_fn(|_| 0.7 + 0.7 * chance.f64()),
            friction_g: PerDof::from_fn(|dof| match dof {
                Dof::Little => 100.0 * chance.f64(),
                _ => 60.0 * (chance.f64() - 0.5),
            }),
            touch_each: if chance.u8(..4) == 0 { 50 } else { 33 },
            chance,
        }
    }

    fn gauss(&mut self) -> f64 {
        let radius = (-2.0 * self.chance.f64().max(1e-12).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.chance.f64()).cos()
    }

    /// What is read at this moment, if something is.
    fn read(
        &mut self,
        sample: &mut HandSample,
        now: &PerFinger<Now>,
        plan: &Plan,
        begins: u64,
        ms: u64,
    ) -> Option<Groups> {
        let timed = |ms: u64| (moment((begins + ms).saturating_sub(4)), moment(begins + ms));
        let (asked, received) = timed(ms);
        let t = ms as f64;
        if ms % self.touch_each == 3 {
            for (finger, own) in now.iter() {
                let value = self.tip(finger, own, plan.shakes(t));
                sample.tactile[finger] = Some(Timed {
                    value,
                    asked,
                    received,
                });
            }
            return Some(Finger::ALL.into_iter().map(Group::Tactile).collect());
        }
        if !ms.is_multiple_of(10) {
            return None;
        }
        let rest = CLOSES_MS + 1500.0;
        let drifted = plan.drift_g * ((t - rest) / (EVENT_MS - rest)).clamp(0.0, 1.0);
        let force = PerDof::from_fn(|dof| {
            let own = &now[dof.finger()];
            let (angle, load) = match dof {
                // It does not move.
                Dof::ThumbRotate => (1000.0, 0.0),
                _ => (own.angle, own.load_g),
            };
            let free = self.friction_g[dof] * (1000.0 - angle) / 760.0;
            let noise = self.noise_g * self.gauss();
            let read = self.zero_g[dof] + drifted + free + load + noise;
            ForceReading::new(read.round() as i16)
        });
        let six = |of: fn(&Now) -> i16| {
            PerDof::from_fn(|dof| match dof {
                Dof::ThumbRotate => 1000,
                _ => of(&now[dof.finger()]),
            })
        };
        let angle = six(|own| own.angle.round() as i16).map(AngleReading::new);
        sample.angle = Some(Timed {
            value: angle,
            asked,
            received,
        });
        sample.force = Some(Timed {
            value: force,
            asked,
            received,
        });
        let status = PerDof::from_fn(|dof| match dof {
            Dof::ThumbRotate => Status::PositionReached,
            _ => now[dof.finger()].status,
        });
        sample.status = Some(Timed {
            value: status,
            asked,
            received,
        });
        Some(
            [Group::Angle, Group::Force, Group::Status]
                .into_iter()
                .collect(),
        )
    }

    fn tip(&mut self, finger: Finger, own: &Now, shakes: bool) -> TactileBlock {
        let load_n = own.load_g * N_PER_G * self.tip_scale[finger];
        let normal = (load_n + self.tip_noise_n * self.gauss()).max(0.0);
        let ratio = own.ratio + if shakes { 0.04 * self.gauss() } else { 0.0 };
        let direction = own.direction + self.gauss();
        TactileBlock {
            normal_n: normal as f32,
            tangential_n: (load_n * ratio.max(0.0)) as f32,
            direction_raw: match own.load_g > 20.0 {
                true => direction.rem_euclid(360.0) as u16 % 360,
                false => u16::MAX,
            },
            ..TactileBlock::decode(&[0; 58]).unwrap()
        }
    }
}
