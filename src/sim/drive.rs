//! One drive: motion, contact, current, heat, faults, in steps of one millisecond. Knows no registers.

use crate::hand::impact::RIGID_G_PER_COUNT;
use crate::hand::{Fault, Faults, Status};
use crate::sim::body_params::run_on::{MetThreshold, run_on_g};
use crate::sim::body_params::{COUNTS_PER_SPEED, JointBody, LATENCY_MS, STROKE};
use crate::sim::number;
use crate::sim::object::Obstacle;
use arrayvec::ArrayVec;

/// Length of a step, s.
pub const STEP_S: f64 = 0.001;
/// Acceleration of a drive, counts/s²: a short ramp of 10 ms to full speed.
const RAMP: f64 = 330_000.0;
/// Commands pending within the dead time: one per millisecond is more than any wire can carry.
const PENDING_MAX: usize = 64;
/// Current per gram of load, mA.
const MA_PER_G: f64 = 0.75;
/// Current of a drive that pushes and cannot move, mA.
const STALL_MA: f64 = 950.0;
/// Current at which a drive protects itself, and the largest that its register shows, mA.
const LIMIT_MA: f64 = 2000.0;
/// Time at the current limit before the drive stops, ms; an impact is shorter.
const OVER_CURRENT_MS: u32 = 50;
/// Time of pushing before a drive reports a stall, ms.
const STALL_MS: u32 = 800;
/// Temperature that stops a drive, °C.
const HOT: f64 = 85.0;
/// Temperature at which the fault ends by itself, °C.
const COOL: f64 = 70.0;
/// Time for which a drive stays at the peak of an impact, ms: the peaks of the table were read about 100 times a second.
const PEAK_MS: u32 = 30;
/// Time constant of the grip's relaxation after that, s.
const RELAX_S: f64 = 0.15;
/// A finger that was faster than at the contact by this factor had slowed down for it.
const FAST_APPROACH: f64 = 2.0;
/// Rest after which a finger starts a new approach, ms: a halt between two stages is shorter.
const BEGINS_ANEW_MS: u32 = 400;
/// Half a unit of ANGLE_ACT, in position counts.
const SAME_ANGLE: f64 = 1.0;
/// Share of the threshold left after relaxation, and the share from which the object counts as still held.
const RELAXED_PART: f64 = 0.92;
const HELD_PART: f64 = 0.9;
/// Distance from the open end within which a joint makes room for a new object, counts.
const OPEN_TOLERANCE: f64 = 20.0;

/// Lowest share of the contact force that forces are divided by.
const LEAST_GRIP: f64 = 0.01;

/// Goal of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DriveGoal {
    /// Move to this position, counts.
    Position(f64),
    /// Stop at the present position.
    Freeze,
}

/// Settings with immediate effect.
#[derive(Debug, Clone, Copy)]
pub struct DriveSettings {
    /// Units of SPEED_SET.
    pub speed: f64,
    /// Load that stops the drive, g: FORCE_SET, less the sensor's reading without load where the drive includes that. A drive with a
    /// negative value does not close at all.
    pub threshold_g: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum DrivePhase {
    Rest,
    Moving { to: f64 },
    Coasting { to: f64, relax_to: f64 },
    Peak { left_ms: u32, relax_to: f64 },
    Relaxing { to: f64 },
}

/// One drive and the obstacle in its way.
#[derive(Debug, Clone)]
pub struct Drive {
    position: f64,
    velocity: f64,
    phase: DrivePhase,
    pending: ArrayVec<(u64, DriveGoal), PENDING_MAX>,
    status: Status,
    faults: Faults,
    current_ma: f64,
    temperature: f64,
    /// Fixed reading of a broken temperature sensor, °C.
    sensor_reads: Option<u8>,
    ambient: f64,
    pushing_ms: u32,
    over_current_ms: u32,
    contact: Option<Obstacle>,
    broken: bool,
    /// The object is out of the hand.
    gone: bool,
    /// Depth of the dent in the object, counts.
    dent: f64,
    /// Highest speed since it started closing, counts/s.
    fastest: f64,
    rested_ms: u32,
    jam: Option<f64>,
    dead: bool,
    grip: f64,
    heating_factor: f64,
    body: JointBody,
    rng: fastrand::Rng,
    /// Deviation of this close's contact from the mean, in standard deviations.
    contact_draw: f64,
    /// True if the drive opened since the contact was drawn.
    opened: bool,
    /// Counts by which the drive is ahead of the joint, at most half of its backlash.
    lead: f64,
}

/// Position counts at an angle: the two registers run in opposite directions (manual 2.6.10, 2.6.11).
pub fn position_of(angle: f64) -> f64 {
    (1000.0 - angle) * 2.0
}

impl Drive {
    /// Creates an open drive of the default body at `ambient` °C.
    pub fn new(ambient: f64) -> Self {
        Self::of(JointBody::default(), ambient, 0)
    }

    /// Creates an open drive of this body at `ambient` °C; `seed` determines its scatter.
    pub fn of(body: JointBody, ambient: f64, seed: u64) -> Self {
        let ambient = ambient + body.warmer_by_c;
        let mut rng = fastrand::Rng::with_seed(seed);
        Self {
            position: 0.0,
            velocity: 0.0,
            phase: DrivePhase::Rest,
            pending: ArrayVec::new(),
            status: Status::PositionReached,
            faults: Faults::default(),
            current_ma: 0.0,
            temperature: ambient,
            sensor_reads: None,
            ambient,
            pushing_ms: 0,
            over_current_ms: 0,
            contact: None,
            broken: false,
            gone: false,
            dent: 0.0,
            fastest: 0.0,
            rested_ms: 0,
            jam: None,
            dead: false,
            grip: 1.0,
            heating_factor: 1.0,
            body,
            contact_draw: number::normal(&mut rng),
            rng,
            opened: false,
            lead: -body.backlash / 2.0,
        }
    }

    /// Position in counts, 0 open to 2000 bent.
    pub const fn position(&self) -> f64 {
        self.position
    }

    /// Reading of the drive's own counter, counts: it turns slightly further before the joint follows.
    pub fn motor_position(&self) -> f64 {
        (self.position + self.lead).clamp(0.0, STROKE)
    }

    /// Angle, 1000 open to 0 bent.
    pub fn angle(&self) -> f64 {
        1000.0 - self.position / 2.0
    }

    /// True force on the fingertip, g, without sensor errors.
    pub fn load_g(&self) -> f64 {
        self.load_at(self.position)
    }

    /// The obstacle in its way, unless it is broken or gone.
    fn whole_contact(&self) -> Option<Obstacle> {
        let contact = self.contact.filter(|_| !self.broken && !self.gone)?;
        let later = self.body.contact_offset + self.body.contact_scatter * self.contact_draw;
        Some(contact.shifted(later + self.dent, self.body.stiffness_factor))
    }

    fn load_at(&self, position: f64) -> f64 {
        self.whole_contact().map_or(0.0, |contact| {
            contact.load_g(position - position_of(contact.angle)) * self.grip
        })
    }

    /// Counts between fingertip and object; `None` if nothing is in the way.
    pub fn gap(&self) -> Option<f64> {
        self.whole_contact()
            .map(|contact| (position_of(contact.angle) - self.position).max(0.0))
    }

    /// Motor current, mA.
    pub const fn current_ma(&self) -> f64 {
        self.current_ma.min(LIMIT_MA)
    }

    /// True temperature, °C.
    pub const fn temperature(&self) -> f64 {
        self.temperature
    }

    /// Reading of the temperature sensor, °C.
    pub fn read_temperature(&self) -> u8 {
        let read = || number::byte(self.temperature);
        self.sensor_reads.unwrap_or_else(read)
    }

    /// Makes the sensor read this from now on, regardless of the temperature.
    pub const fn break_sensor(&mut self, celsius: u8) {
        self.sensor_reads = Some(celsius);
    }

    /// Status that the drive reports.
    pub const fn status(&self) -> Status {
        self.status
    }

    /// Its faults.
    pub const fn faults(&self) -> Faults {
        self.faults
    }

    /// Puts an obstacle in its way, or removes it.
    pub const fn set_contact(&mut self, contact: Option<Obstacle>) {
        self.contact = contact;
        self.broken = false;
        self.gone = false;
        self.dent = 0.0;
    }

    /// Takes the object out of its way.
    pub const fn remove_object(&mut self) {
        self.gone = true;
    }

    /// Puts the object back. It touches a joint that closed further meanwhile, without force.
    pub fn return_object(&mut self) {
        self.gone = false;
        self.dent = 0.0;
        if let Some(contact) = self.whole_contact() {
            self.dent = (self.position - position_of(contact.angle)).max(0.0);
        }
    }

    /// True if its side of the object is broken.
    pub const fn is_broken(&self) -> bool {
        self.broken
    }

    /// True if nothing is in its way, or it is so far open that a new object finds room.
    pub fn has_room(&self) -> bool {
        self.contact.is_none() || self.position < OPEN_TOLERANCE
    }

    /// Blocks the linkage at an angle; the fingertip's sensor does not feel it.
    pub const fn set_jam(&mut self, angle: Option<f64>) {
        self.jam = angle;
    }

    /// Makes the drive ignore all commands and keep reporting its state.
    pub const fn set_dead(&mut self, dead: bool) {
        self.dead = dead;
    }

    /// Sets the share of the contact force that is present, 1 = all; a tapered object that slides reduces it.
    pub const fn set_grip(&mut self, grip: f64) {
        self.grip = grip;
    }

    /// Multiplies the heating by its current by this factor.
    pub fn heat_more(&mut self, times: f64) {
        self.heating_factor = times;
    }

    /// Sets its temperature, °C.
    pub const fn warm(&mut self, celsius: f64) {
        self.temperature = celsius;
    }

    /// Reports a status until the next motion; for scripts.
    pub const fn pretend(&mut self, status: Status) {
        self.status = status;
    }

    /// Raises a fault.
    pub fn inject(&mut self, fault: Fault) {
        if fault == Fault::OverTemperature {
            // Without the heat the fault would end at once.
            self.temperature = self.temperature.max(HOT);
        }
        self.raise(fault);
        let status = match fault {
            Fault::Stall => Status::Stalled,
            Fault::OverCurrent => Status::CurrentProtection,
            _ => Status::DriveFault,
        };
        self.stop(status);
    }

    /// Clears the clearable faults (manual 2.6.3). The drive stays where it is.
    pub fn clear_errors(&mut self) {
        if self.faults.is_empty() {
            return;
        }
        self.faults = Faults::from_raw(self.faults.raw() & (1 << Fault::OverTemperature.bit()));
        let status = if self.faults.is_empty() {
            Status::PositionReached
        } else {
            Status::DriveFault
        };
        self.stop(status);
    }

    /// Drops its commands and faults, as at a power loss. Position and temperature remain.
    pub fn power_cycle(&mut self) {
        self.faults = Faults::default();
        self.stop(Status::PositionReached);
    }

    /// Queues a command that takes effect after the dead time.
    pub fn command(&mut self, goal: DriveGoal, now_ms: u64) {
        // Commands do not overtake one another.
        let last = self.pending.last().map_or(0, |(due, _)| *due);
        let due = (now_ms + number::whole_ms(self.draw_latency_ms())).max(last);
        if self.pending.is_full() {
            self.pending.pop();
        }
        self.pending.push((due, goal));
    }

    fn draw_latency_ms(&mut self) -> f64 {
        let scatter = self.body.latency_scatter_ms * number::normal(&mut self.rng);
        (self.body.latency_ms + scatter).max(0.0)
    }

    /// True while its motor turns.
    pub fn is_moving(&self) -> bool {
        matches!(self.phase, DrivePhase::Moving { .. })
    }

    /// Advances by one millisecond.
    pub fn step(&mut self, now_ms: u64, setting: DriveSettings) {
        while let Some((due, goal)) = self.pending.first().copied() {
            if due > now_ms {
                break;
            }
            self.pending.remove(0);
            self.begin(goal, setting);
        }
        self.current_ma = 0.0;
        self.watch_rest();
        match self.phase {
            DrivePhase::Rest => {}
            DrivePhase::Moving { to } => self.move_on(to, setting),
            DrivePhase::Coasting { to, relax_to } => self.coast(to, relax_to),
            DrivePhase::Peak { left_ms, relax_to } => {
                self.phase = match left_ms {
                    0 => DrivePhase::Relaxing { to: relax_to },
                    _ => DrivePhase::Peak {
                        left_ms: left_ms - 1,
                        relax_to,
                    },
                };
            }
            DrivePhase::Relaxing { to } => {
                self.position += (to - self.position) * STEP_S / RELAX_S;
                if (self.position - to).abs() < 0.02 {
                    self.phase = DrivePhase::Rest;
                }
            }
        }
        self.watch_object();
        self.heat();
    }

    fn watch_rest(&mut self) {
        self.rested_ms = match self.phase {
            DrivePhase::Rest => self.rested_ms.saturating_add(1),
            _ => 0,
        };
        if self.rested_ms >= BEGINS_ANEW_MS {
            self.fastest = 0.0;
        }
    }

    /// An object pressed too hard stays broken or dented until the joint is open again.
    fn watch_object(&mut self) {
        if self.position < OPEN_TOLERANCE {
            self.broken = false;
            self.dent = 0.0;
        }
        let Some(contact) = self.whole_contact() else {
            return;
        };
        let load = self.load_g();
        self.broken |= contact.breaks_at_g.is_some_and(|most| load > most);
        if let Some(most) = contact.yields_at_g.filter(|most| load > *most) {
            let grip = self.grip.max(LEAST_GRIP);
            self.dent += contact.compression(load / grip) - contact.compression(most / grip);
        }
    }

    fn begin(&mut self, goal: DriveGoal, setting: DriveSettings) {
        match goal {
            _ if self.dead => {}
            DriveGoal::Freeze => {
                if matches!(self.phase, DrivePhase::Moving { .. }) {
                    self.stop_moving(Status::PositionReached);
                }
            }
            DriveGoal::Position(to) => {
                let to = to.clamp(0.0, STROKE);
                if self.is_there(to) {
                    self.stop_moving(Status::PositionReached);
                } else if self.may_move(to) && !self.holds(to, setting) {
                    self.pushing_ms = 0;
                    self.over_current_ms = 0;
                    if to < self.position {
                        self.fastest = 0.0;
                        self.opened = true;
                    } else if self.opened && self.load_g() <= 0.0 {
                        self.opened = false;
                        self.contact_draw = number::normal(&mut self.rng);
                    }
                    self.phase = DrivePhase::Moving { to };
                }
            }
        }
    }

    /// True if the drive rests at its target, within the resolution of ANGLE_ACT.
    fn is_there(&self, to: f64) -> bool {
        let is_near = (to - self.position).abs() < SAME_ANGLE;
        is_near && self.phase == DrivePhase::Rest && self.faults.is_empty()
    }

    /// True if its threshold stopped it and the grip still holds: a new close command does not make it push (manual 2.6.12).
    fn holds(&self, to: f64, setting: DriveSettings) -> bool {
        let closes = self.status == Status::ForceReached && to > self.position;
        closes && self.load_g() >= HELD_PART * setting.threshold_g.max(1.0)
    }

    /// A drive that stalled or drew too much current may still open; any other fault keeps it from moving.
    // Manual: silent. Its advice to free the finger requires a way to open it.
    fn may_move(&self, to: f64) -> bool {
        let only_opens =
            self.faults.contains(Fault::Stall) || self.faults.contains(Fault::OverCurrent);
        let dead = self.faults.contains(Fault::OverTemperature)
            || self.faults.contains(Fault::Motor)
            || self.faults.contains(Fault::Communication);
        !dead && (!only_opens || to < self.position)
    }

    fn move_on(&mut self, to: f64, setting: DriveSettings) {
        let way = to - self.position;
        let top = setting.speed * self.body.counts_per_speed;
        // The last counts are travelled slowly enough to end on the target.
        let wanted = way.signum() * top.min((2.0 * RAMP * way.abs()).sqrt());
        let change = (wanted - self.velocity).clamp(-RAMP * STEP_S, RAMP * STEP_S);
        self.velocity += change;
        self.fastest = self.fastest.max(self.velocity);
        self.status = if way > 0.0 {
            Status::Grasping
        } else {
            Status::Releasing
        };
        let load = self.load_g();
        self.current_ma = self.free_ma(way) + MA_PER_G * load;
        let step = self.take_up(self.velocity * STEP_S);
        // A fast drive passes its threshold within one step, so the step is checked before it is made.
        let met = self.load_at(self.position + step);
        let may_stop = met > 0.0 || setting.threshold_g < 0.0;
        if way > 0.0 && may_stop && met >= setting.threshold_g {
            self.force_stop(setting.threshold_g);
            return;
        }
        if way.abs() < 0.5 || (step.abs() >= way.abs() && step * way > 0.0) {
            self.position = to;
            self.stop_moving(Status::PositionReached);
            return;
        }
        match self.jam.map(position_of) {
            Some(end) if way > 0.0 && self.position + step >= end && self.position <= end => {
                self.push(end)
            }
            _ => {
                self.position = (self.position + step).clamp(0.0, STROKE);
                self.pushing_ms = 0;
            }
        }
        self.watch_current();
    }

    fn free_ma(&self, way: f64) -> f64 {
        let body = &self.body;
        let constant = if way > 0.0 {
            body.friction_ma
        } else {
            body.opening_friction_ma
        };
        let speed = self.velocity.abs() / body.counts_per_speed;
        constant + body.friction_ma_per_speed * speed
    }

    /// Returns the part of a motor step that reaches the joint once the backlash is taken up.
    fn take_up(&mut self, step: f64) -> f64 {
        let half = self.body.backlash / 2.0;
        let lead = (self.lead + step).clamp(-half, half);
        let taken = lead - self.lead;
        self.lead = lead;
        step - taken
    }

    fn push(&mut self, end: f64) {
        self.position = end;
        self.velocity = 0.0;
        self.pushing_ms += 1;
        self.current_ma = STALL_MA;
        if self.pushing_ms > STALL_MS {
            self.raise(Fault::Stall);
            self.stop_moving(Status::Stalled);
        }
    }

    fn watch_current(&mut self) {
        if self.current_ma < LIMIT_MA {
            self.over_current_ms = 0;
            return;
        }
        self.over_current_ms += 1;
        if self.over_current_ms > OVER_CURRENT_MS {
            self.raise(Fault::OverCurrent);
            self.stop_moving(Status::CurrentProtection);
        }
    }

    /// Stops at the force threshold. The drive runs on by the distance that the table gives.
    fn force_stop(&mut self, threshold_g: f64) {
        let contact = self.whole_contact().filter(|_| threshold_g >= 0.0);
        let Some(contact) = contact else {
            return self.stop_moving(Status::ForceReached);
        };
        let grip = self.grip.max(LEAST_GRIP);
        let stiffness = (contact.stiffness_at(threshold_g / grip) * grip).max(0.01);
        let met = MetThreshold {
            speed: self.velocity / COUNTS_PER_SPEED,
            threshold_g,
            came_fast: self.fastest >= FAST_APPROACH * self.velocity,
        };
        let longer = self.draw_latency_ms() / LATENCY_MS;
        let over = run_on_g(met, self.body.run_on) * longer;
        let met = position_of(contact.angle) + contact.compression(threshold_g / grip);
        let kept = self.body.kept_overshoot * over * stiffness / RIGID_G_PER_COUNT;
        let rest_g = RELAXED_PART * threshold_g + kept;
        self.status = Status::ForceReached;
        self.phase = DrivePhase::Coasting {
            to: (met + over / RIGID_G_PER_COUNT).min(STROKE),
            relax_to: (position_of(contact.angle) + contact.compression(rest_g / grip)).min(STROKE),
        };
    }

    fn coast(&mut self, to: f64, relax_to: f64) {
        self.current_ma = MA_PER_G * self.load_g();
        let left = to - self.position;
        let step = (self.velocity * STEP_S).min(left * 0.5);
        if left <= 0.05 || step <= 0.001 {
            if left > 0.0 && self.velocity > 0.0 {
                self.position = to;
            }
            self.velocity = 0.0;
            self.phase = DrivePhase::Peak {
                left_ms: PEAK_MS,
                relax_to,
            };
            return;
        }
        self.position += step;
    }

    fn heat(&mut self) {
        let amps = self.current_ma / 1000.0;
        let cooling = (self.temperature - self.ambient) / self.body.cooling_s;
        let heating = self.body.heating * self.heating_factor;
        self.temperature += (heating * amps * amps - cooling) * STEP_S;
        if self.temperature >= HOT && !self.faults.contains(Fault::OverTemperature) {
            self.inject(Fault::OverTemperature);
        }
        if self.temperature < COOL && self.faults.contains(Fault::OverTemperature) {
            self.faults =
                Faults::from_raw(self.faults.raw() & !(1 << Fault::OverTemperature.bit()));
            if self.faults.is_empty() {
                self.stop(Status::PositionReached);
            }
        }
    }

    fn raise(&mut self, fault: Fault) {
        self.faults = Faults::from_raw(self.faults.raw() | 1 << (fault.bit() & 7));
    }

    fn stop_moving(&mut self, status: Status) {
        self.velocity = 0.0;
        self.phase = DrivePhase::Rest;
        self.status = status;
    }

    /// Stops and drops the pending commands.
    fn stop(&mut self, status: Status) {
        self.pending.clear();
        self.stop_moving(status);
    }
}
