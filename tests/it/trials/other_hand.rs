//! A hand with physics of its own, in memory: a drive that stops some time after its threshold, wherever that takes it. It shares
//! nothing with the built-in simulator; its force sensor has an offset, which its drive counts or not.

use handscope::hand::{Dof, Moment, PerDof, Span};

const ANGLE_SET: usize = 1486;
const FORCE_SET: usize = 1498;
const SPEED_SET: usize = 1522;
const POSITION: usize = 1534;
const ANGLE: usize = 1546;
const FORCE: usize = 1582;
const CURRENT: usize = 1594;
const FAULTS: usize = 1606;
const STATUS: usize = 1612;
const TEMPERATURE: usize = 1618;
const TACTILE: usize = 3000;
const TIP_BYTES: usize = 58;
const N_PER_G: f64 = 0.009_806_65;
/// Units of ANGLE_ACT a second that a joint gains in a millisecond.
const RAMP: f64 = 165.0;

/// What a hand of this kind is made of. Times are ms, forces g, lengths units of ANGLE_ACT.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OtherBody {
    /// From a command to the motion, and what it scatters.
    pub(crate) latency: (f64, f64),
    /// From the threshold to the stop, and what it scatters.
    pub(crate) stop: (f64, f64),
    /// How often a stop comes later than that, and by how much then, on average.
    pub(crate) late: (f64, f64),
    /// Units a second for each unit of SPEED_SET.
    pub(crate) rate: f64,
    pub(crate) noise: f64,
    /// What the force sensor reads at rest.
    pub(crate) offset: f64,
    /// Whether the drive compares its threshold with what the sensor reads, offset included.
    pub(crate) counts_offset: bool,
    /// Whether a threshold below the reading at rest keeps it from closing at all.
    pub(crate) stops_in_air: bool,
    /// Where the object is, and what that scatters.
    pub(crate) contact: (f64, f64),
    /// g for each unit, and the power of the depth that the force grows with.
    pub(crate) stiffness: (f64, f64),
    /// Beyond this force the object is broken, g.
    pub(crate) breaks_at_g: f64,
    /// Share of the force that it loses by itself.
    pub(crate) relaxes: f64,
}

impl Default for OtherBody {
    fn default() -> Self {
        Self {
            latency: (64.0, 2.0),
            stop: (60.0, 2.0),
            late: (0.0, 0.0),
            rate: 1.52,
            noise: 3.0,
            offset: 0.0,
            counts_offset: true,
            stops_in_air: false,
            contact: (500.0, 3.75),
            stiffness: (25.0, 1.0),
            breaks_at_g: f64::INFINITY,
            relaxes: 0.08,
        }
    }
}

/// A hand and an object that nothing was tuned on: offsets from -60 to 230 g, counted or not, stiffness 6 to 60 g for each unit, and
/// half of the objects break between 1.08 and 1.4 times the limit.
pub(crate) fn drawn(seed: u64, limit: f64) -> OtherBody {
    let mut rng = fastrand::Rng::with_seed(seed ^ 0x07E2);
    let mut between = |least: f64, most: f64| least + (most - least) * rng.f64();
    let stiffness = between(6.0_f64.ln(), 60.0_f64.ln()).exp();
    OtherBody {
        latency: (between(0.0, 75.0), 2.0),
        stop: (between(40.0, 70.0), between(1.0, 4.0)),
        rate: between(1.4, 1.7),
        noise: between(2.0, 6.0),
        offset: between(-60.0, 230.0),
        counts_offset: !seed.is_multiple_of(4),
        stops_in_air: seed.is_multiple_of(3),
        contact: (between(300.0, 700.0), between(1.0, 5.0)),
        stiffness: match seed % 7 {
            3 => (stiffness / 4.0, 1.4),
            _ => (stiffness, 1.0),
        },
        breaks_at_g: match seed % 2 {
            0 => limit * between(1.08, 1.4),
            _ => f64::INFINITY,
        },
        relaxes: between(0.02, 0.15),
        ..OtherBody::default()
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Doing {
    Opens,
    Closes,
    InPlace,
    Held,
}

/// One joint.
#[derive(Debug, Clone)]
struct Joint {
    body: OtherBody,
    at: f64,
    velocity: f64,
    target: f64,
    queue: Vec<(f64, f64)>,
    doing: Doing,
    stops_at: Option<f64>,
    draw: f64,
    lost_g: f64,
    force_g: f64,
    noise_g: f64,
    broken: bool,
    ever_broken: bool,
    /// Of the present close.
    peak_g: f64,
    rng: fastrand::Rng,
}

impl Joint {
    fn new(body: OtherBody, rng: fastrand::Rng) -> Self {
        Self {
            body,
            at: 1000.0,
            velocity: 0.0,
            target: 1000.0,
            queue: Vec::new(),
            doing: Doing::InPlace,
            stops_at: None,
            draw: 0.0,
            lost_g: 0.0,
            force_g: 0.0,
            noise_g: 0.0,
            broken: false,
            ever_broken: false,
            peak_g: 0.0,
            rng,
        }
    }

    fn normal(&mut self, (mean, sigma): (f64, f64)) -> f64 {
        let radius = (-2.0 * (1.0 - self.rng.f64()).ln()).sqrt();
        mean + sigma * radius * (std::f64::consts::TAU * self.rng.f64()).cos()
    }

    fn command(&mut self, target: f64, now: f64) {
        let last = self.queue.last().map_or(0.0, |(due, _)| *due);
        let due = (now + self.normal(self.body.latency).max(0.0)).max(last);
        self.queue.push((due, target));
    }

    fn begin(&mut self, target: f64) {
        let closes = target < self.at;
        if closes && self.at > 950.0 {
            self.draw = self.normal((0.0, self.body.contact.1));
            (self.broken, self.peak_g) = (false, 0.0);
        }
        if closes && self.doing == Doing::Held && self.force_g > 0.0 {
            return;
        }
        self.target = target;
        self.stops_at = None;
        self.doing = if closes { Doing::Closes } else { Doing::Opens };
    }

    fn reads_g(&self) -> f64 {
        self.force_g + self.body.offset + self.noise_g
    }

    fn step(&mut self, now: f64, (speed, threshold): (f64, f64)) {
        while self.queue.first().is_some_and(|(due, _)| *due <= now) {
            let (_, target) = self.queue.remove(0);
            self.begin(target);
        }
        if now as i64 % 5 == 0 {
            self.noise_g = self.normal((0.0, self.body.noise));
        }
        let mut wanted = 0.0;
        if matches!(self.doing, Doing::Opens | Doing::Closes) {
            let gap = self.target - self.at;
            if gap.abs() < 0.3 {
                (self.at, self.velocity, self.doing) = (self.target, 0.0, Doing::InPlace);
            } else {
                let top = (speed * self.body.rate).min((2.0 * RAMP * 1000.0 * gap.abs()).sqrt());
                wanted = top.copysign(gap);
            }
        }
        if self.doing == Doing::Closes {
            let offset = if self.body.counts_offset {
                0.0
            } else {
                self.body.offset
            };
            let touches = self.body.stops_in_air || self.force_g > 2.0;
            if self.stops_at.is_none() && touches && self.reads_g() - offset >= threshold.max(1.0) {
                let mut late = self.normal(self.body.stop).max(0.0);
                if self.rng.f64() < self.body.late.0 {
                    late -= self.body.late.1 * (1.0 - self.rng.f64()).ln();
                }
                self.stops_at = Some(now + late);
            }
            if self.stops_at.is_some_and(|at| now >= at) {
                (self.velocity, wanted, self.doing) = (0.0, 0.0, Doing::Held);
            }
        }
        self.velocity += (wanted - self.velocity).clamp(-RAMP, RAMP);
        self.at = (self.at + self.velocity * 0.001).clamp(0.0, 1000.0);
        self.press();
    }

    fn press(&mut self) {
        let body = self.body;
        let depth = (body.contact.0 + self.draw - self.at).max(0.0);
        let whole = if self.broken { 0.02 } else { 1.0 };
        let elastic = body.stiffness.0 * depth.powf(body.stiffness.1) * whole;
        self.lost_g += (body.relaxes * elastic - self.lost_g) * (0.001 / 0.15);
        if elastic <= 0.0 {
            self.lost_g = 0.0;
        }
        self.force_g = (elastic - self.lost_g).max(0.0);
        self.peak_g = self.peak_g.max(self.force_g);
        self.broken |= self.force_g > body.breaks_at_g;
        self.ever_broken |= self.broken;
    }
}

/// A hand of six such joints that answers for its registers.
#[derive(Debug, Clone)]
pub(crate) struct OtherHand {
    joints: PerDof<Joint>,
    memory: Vec<u8>,
    now_ms: u64,
    /// When the joints, and the fingertips, were last put into the memory.
    published_ms: [u64; 2],
    /// The highest true force of each close that is over, g, of all joints.
    pub(crate) peaks_g: Vec<f64>,
}

impl OtherHand {
    /// Only the index finger meets the object.
    pub(crate) fn new(body: OtherBody, seed: u64) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let joint = |dof| {
            let mut own = body;
            own.offset += 12.0 * rng.f64() - 8.0;
            if dof != Dof::Index {
                own.contact.0 = -1000.0;
            }
            Joint::new(own, rng.fork())
        };
        let mut hand = Self {
            joints: PerDof::from_fn(joint),
            memory: vec![0; 4096],
            now_ms: 0,
            published_ms: [u64::MAX; 2],
            peaks_g: Vec::new(),
        };
        for n in 0..6 {
            hand.put(ANGLE_SET + 2 * n, 1000.0);
            hand.put(FORCE_SET + 2 * n, 500.0);
            hand.put(SPEED_SET + 2 * n, 1000.0);
        }
        hand
    }

    /// Whether the object ever broke.
    pub(crate) fn broke(&self) -> bool {
        self.joints.iter().any(|(_, joint)| joint.ever_broken)
    }

    /// The highest true force of all closes, g.
    pub(crate) fn highest_g(&self) -> f64 {
        let present = self.joints.iter().map(|(_, joint)| joint.peak_g);
        self.peaks_g
            .iter()
            .copied()
            .chain(present)
            .fold(0.0, f64::max)
    }

    fn put(&mut self, address: usize, value: f64) {
        let bytes = (value.round() as i16).to_le_bytes();
        self.memory[address..address + 2].copy_from_slice(&bytes);
    }

    fn short(&self, address: usize) -> i16 {
        i16::from_le_bytes([self.memory[address], self.memory[address + 1]])
    }

    fn advance_to(&mut self, now: Moment) {
        let until = now.since(Moment::ZERO).as_millis() as u64;
        while self.now_ms < until {
            self.now_ms += 1;
            for (n, dof) in Dof::ALL.into_iter().enumerate() {
                let speed = self.short(SPEED_SET + 2 * n);
                let threshold = self.short(FORCE_SET + 2 * n);
                let setting = (f64::from(speed), f64::from(threshold));
                self.joints[dof].step(self.now_ms as f64, setting);
            }
        }
    }

    fn publish_joints(&mut self) {
        for (n, dof) in Dof::ALL.into_iter().enumerate() {
            let joint = &self.joints[dof];
            let (at, velocity, doing) = (joint.at, joint.velocity, joint.doing);
            let reads_g = joint.reads_g();
            self.put(ANGLE + 2 * n, at);
            self.put(POSITION + 2 * n, (1000.0 - at) * 2.0);
            self.put(FORCE + 2 * n, reads_g);
            self.put(CURRENT + 2 * n, 10.0 + velocity.abs().min(100.0));
            self.memory[FAULTS + n] = 0;
            self.memory[STATUS + n] = match doing {
                Doing::Opens => 0,
                Doing::Closes => 1,
                Doing::InPlace => 2,
                Doing::Held => 3,
            };
            self.memory[TEMPERATURE + n] = 30;
        }
    }

    fn publish_tips(&mut self) {
        for (n, dof) in Dof::ALL.into_iter().enumerate().take(5) {
            let normal = (self.joints[dof].force_g * N_PER_G) as f32;
            let at = TACTILE + TIP_BYTES * n;
            self.memory[at + 32..at + 36].copy_from_slice(&normal.to_le_bytes());
            let tangential = normal * 0.2;
            self.memory[at + 40..at + 44].copy_from_slice(&tangential.to_le_bytes());
            let sum: u16 = self.memory[at..at + 54].iter().map(|b| u16::from(*b)).sum();
            self.memory[at + 54..at + 56].copy_from_slice(&sum.to_le_bytes());
        }
    }

    pub(crate) fn read(&mut self, span: Span, now: Moment) -> Vec<u8> {
        self.advance_to(now);
        let from = usize::from(span.address);
        if self.published_ms[0] != self.now_ms {
            self.published_ms[0] = self.now_ms;
            self.publish_joints();
        }
        if from + usize::from(span.len) > TACTILE && self.published_ms[1] != self.now_ms {
            self.published_ms[1] = self.now_ms;
            self.publish_tips();
        }
        self.memory[from..from + usize::from(span.len)].to_vec()
    }

    pub(crate) fn write(&mut self, address: u16, bytes: &[u8], now: Moment) {
        self.advance_to(now);
        for (pair, value) in bytes.chunks_exact(2).enumerate() {
            let at = usize::from(address) + 2 * pair;
            let value = i16::from_le_bytes([value[0], value[1]]);
            if value < 0 {
                continue;
            }
            self.put(at, value.into());
            if (ANGLE_SET..FORCE_SET).contains(&at) {
                let dof = Dof::ALL[(at - ANGLE_SET) / 2];
                let joint = &mut self.joints[dof];
                if value > 900 && joint.peak_g > 0.0 {
                    self.peaks_g.push(joint.peak_g);
                    joint.peak_g = 0.0;
                }
                let now = self.now_ms as f64;
                joint.command(value.into(), now);
            }
        }
    }
}

/// Moves a joint until it rests; the time then, ms.
fn go(joint: &mut Joint, target: f64, setting: (f64, f64), mut now: f64) -> f64 {
    joint.command(target, now);
    for _ in 0..60_000 {
        now += 1.0;
        joint.step(now, setting);
        if joint.queue.is_empty() && matches!(joint.doing, Doing::InPlace | Doing::Held) {
            break;
        }
    }
    now
}

/// Close time in s, peak, and what is held of one close without registers: with `halt`, it comes fast to that angle.
pub(crate) fn one_close(
    body: OtherBody,
    setting: (f64, f64),
    halt: Option<f64>,
    seed: u64,
) -> (f64, f64, f64) {
    let mut joint = Joint::new(body, fastrand::Rng::with_seed(seed));
    let mut now = 0.0;
    if let Some(halt) = halt {
        // The order to go on slowly comes with the next readings.
        now = go(&mut joint, halt, (1000.0, setting.1), now) + 12.0;
    }
    now = go(&mut joint, 0.0, setting, now);
    for n in 1..700 {
        joint.step(now + f64::from(n), setting);
    }
    (now / 1000.0, joint.peak_g, joint.force_g)
}

/// Closes of each cell of the grid.
const CLOSES: u32 = 6;

/// The quickest close of a grid of speeds and thresholds with a fast approach, whose bound (10 closes, 95 of 100, 95 % sure) stays
/// under the limit and that holds.
pub(crate) fn best_close_s(body: OtherBody, limit: f64, hold: f64) -> f64 {
    let counted = if body.counts_offset {
        body.offset - 2.0
    } else {
        0.0
    };
    // As far before the contact as the search begins its slow stage.
    let halt = body.contact.0 + 3.3 * body.contact.1 + 2.0;
    let mut best = f64::INFINITY;
    for force in [30.0, 50.0, 80.0, 120.0, 170.0, 220.0, 280.0] {
        let mut speed = 10.0;
        while speed < 1000.0 {
            let setting = (speed, (force + counted).max(1.0));
            let closes = (0..CLOSES).map(|seed| one_close(body, setting, Some(halt), seed.into()));
            let closes: Vec<(f64, f64, f64)> = closes.collect();
            let n = f64::from(CLOSES);
            let mean = closes.iter().map(|(_, peak, _)| peak).sum::<f64>() / n;
            let squares = closes.iter().map(|(_, peak, _)| (peak - mean).powi(2));
            let sigma = (squares.sum::<f64>() / (n - 1.0)).sqrt().hypot(body.noise);
            if mean + 2.911 * sigma > limit {
                break;
            }
            if closes.iter().all(|(_, _, held)| *held >= hold) {
                let took = closes.iter().map(|(took, _, _)| took).sum::<f64>() / n;
                best = best.min(took);
            }
            speed *= 1.08;
        }
    }
    best
}
