//! The simulated hand: memory, body, fingertips and script put together. It is given the time; it owns no clock and no wire.

use crate::hand::register::{ANGLE_ACT, FORCE_SET, HAND_ID, REDU_RATIO, Register, SPEED_SET, Span};
use crate::hand::{Dof, Fault, Finger, Group, Moment, PerDof, PerFinger};
use crate::sim::body::Body;
use crate::sim::body_params::BodyParams;
use crate::sim::drive::{DriveGoal, DriveSettings, position_of};
use crate::sim::extremes;
use crate::sim::live::{self, element};
use crate::sim::memory::{AccessError, GAP, Memory};
use crate::sim::number;
use crate::sim::object::Object;
use crate::sim::personality::{
    Beyond, ChangeAck, Doubles, ForceCompared, GapAnswer, Personality, SpeedZero, TactileCheck,
    Turnaround,
};
use crate::sim::pull::{Pull, PullPhase};
use crate::sim::scenario::{self, Ailment, Order, Scenario, Slip};
use crate::sim::supply::Supply;
use crate::sim::touch::{SENSOR_MS, TouchSensors};
use std::collections::VecDeque;
use std::time::Duration;

/// What a sensor's own header adds to its sum: 55 AA, 56 bytes, a command, a number, 8 channels.
// Manual: silent; the sensor maker's own frame has this header before the same 54 bytes.
const SENSOR_HEADER_SUM: u16 = 0x55 + 0xAA + 56 + 3 + 1 + 8;
/// Where the check stands in a fingertip's block (manual 2.6.21).
const CHECK_AT: u16 = 54;
/// One answer in so many comes twice, or late, on hands that do so.
const DOUBLE_ONE_IN: u32 = 16;
const RARE_ONE_IN: u32 = 256;
const RARE_TURNAROUND: Duration = Duration::from_millis(500);
/// Speed that a creeping hand takes SPEED_SET 0 for.
const CREEP: f64 = 5.0;
/// Writes that the journal keeps; twice as many are held before the older half goes.
pub const JOURNAL_KEEPS: usize = 8192;
/// Way of a joint, counts of its stroke, after which feedback freezes in that scenario.
const FREEZE_TRAVEL: f64 = 100.0;
/// Where the time of a read stands when the personality stamps it.
const STAMP: Span = Span::new(GAP.address, 8);

/// What a simulated hand is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimConfig {
    /// Seed of everything random in it.
    pub seed: u64,
    /// Id on the bus, 1..=254.
    pub id: u8,
    /// What it does by itself.
    pub scenario: Scenario,
    /// How it reads the manual's gaps.
    pub personality: Personality,
    /// How it differs from other hands.
    pub body: BodyParams,
}

impl Default for SimConfig {
    fn default() -> Self {
        Self {
            seed: 1,
            id: 1,
            scenario: Scenario::Idle,
            personality: Personality::default(),
            body: BodyParams::default(),
        }
    }
}

/// What a write did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteEffect {
    /// The id in the acknowledgement: the new one, if the write changed it.
    pub ack_id: u8,
    /// Whether there is an acknowledgement at all.
    pub is_acked: bool,
    /// Elements that the hand took; the others were dropped without a word.
    pub taken: usize,
}

/// How an answer is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReplyTiming {
    /// From the end of the request.
    pub after: Duration,
    /// How often it comes, 1 or 2.
    pub copies: usize,
}

/// The second frame after a SAVE on a serial line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SaveFrame {
    /// Command byte, 0x11 or 0x12.
    pub command: u8,
    /// Whether the parameters are in flash.
    pub ok: bool,
}

/// One write that reached the hand, taken or not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JournalEntry {
    pub at: Moment,
    /// First byte's address.
    pub address: u16,
    /// The bytes.
    pub bytes: Vec<u8>,
}

/// A hand that answers bytes.
#[derive(Debug, Clone)]
pub struct SimHand {
    pub(crate) config: SimConfig,
    pub(crate) memory: Memory,
    pub(crate) body: Body,
    supply: Supply,
    touch: TouchSensors,
    rng: fastrand::Rng,
    pub(crate) now_ms: u64,
    published_ms: Option<u64>,
    /// Fingertips that were published then, too.
    published_tips: PerFinger<bool>,
    pub(crate) calibration_due_ms: Option<u64>,
    /// When the SAVE under way is in flash, on a hand that takes its time.
    pub(crate) flash_due_ms: Option<u64>,
    pub(crate) saves: VecDeque<(Moment, SaveFrame)>,
    /// When a serial line with the maker's framing hears that a calibration is finished.
    pub(crate) calibration_end: Option<Moment>,
    /// False while a write comes over a wire that has no frames later than the reply.
    pub(crate) sends_late_frames: bool,
    pub(crate) id: u8,
    pub(crate) baud_code: u8,
    /// Chance of what is not the body's: how answers are sent.
    chance: fastrand::Rng,
    journal: Vec<JournalEntry>,
    /// What somebody presses each fingertip with, g.
    pressed_g: PerFinger<f64>,
    /// What the hand's own script ordered last; a setpoint from outside ends it.
    pub(crate) order: Option<Order>,
    /// What it tells stands still; the joints go on.
    frozen: bool,
    /// ANGLE_ACT of the joints whose angle alone is unchanged, whatever they do.
    frozen_angles: PerDof<Option<i16>>,
    /// Where the joints were when it was switched on.
    began_at: PerDof<f64>,
    /// It says what was recorded: no body, no script, and writes change nothing.
    follows_recording: bool,
    /// How its object is pulled, or is about to be.
    pull: Option<Pull>,
}

impl SimHand {
    /// A hand that was switched on at [`Moment::ZERO`], open.
    pub fn new(config: SimConfig) -> Self {
        let mut rng = fastrand::Rng::with_seed(config.seed);
        let body = Body::new(&Object::of(config.scenario), &config.body, &mut rng);
        let mut touch = TouchSensors::new(&config.body, &mut rng);
        touch.measure(&mut rng);
        let mut hand = Self {
            supply: Supply::new(config.personality.power),
            config,
            memory: Memory::new(config.id),
            body,
            touch,
            rng,
            now_ms: 0,
            published_ms: None,
            published_tips: PerFinger::splat(false),
            calibration_due_ms: None,
            flash_due_ms: None,
            saves: VecDeque::new(),
            calibration_end: None,
            sends_late_frames: true,
            id: config.id,
            baud_code: 0,
            chance: fastrand::Rng::with_seed(config.seed ^ 0x5EED),
            journal: Vec::new(),
            pressed_g: PerFinger::splat(0.0),
            order: None,
            frozen: false,
            frozen_angles: PerDof::splat(None),
            began_at: PerDof::splat(0.0),
            follows_recording: false,
            pull: None,
        };
        hand.target_actual();
        hand
    }

    /// Lives on until `now`, in steps of one millisecond, so that the result does not depend on who asks how often.
    pub fn advance_to(&mut self, now: Moment) {
        let end = now.micros() / 1000;
        if self.follows_recording {
            self.now_ms = self.now_ms.max(end);
        }
        while self.now_ms < end {
            self.now_ms += 1;
            self.tick();
        }
    }

    /// The bytes of a run as they are at `now`.
    ///
    /// # Errors
    /// [`AccessError`] for runs that leave the memory, or cross the gap on a hand that does not answer there.
    pub fn read(&mut self, span: Span, now: Moment) -> Result<Vec<u8>, AccessError> {
        self.advance_to(now);
        if self.supply.is_off(self.now_ms) {
            return Err(AccessError::Silent);
        }
        if self.config.personality.gap == GapAnswer::Refused && overlaps(span, GAP) {
            return Err(AccessError::Gap);
        }
        self.publish(|block| overlaps(span, block));
        if self.config.personality.stamp_gap {
            self.memory.put(STAMP.address, &now.micros().to_le_bytes());
        }
        match self.config.personality.beyond {
            Beyond::Refused => self.memory.read(span).map(<[u8]>::to_vec),
            Beyond::Zeros => self.memory.read_on(span),
        }
    }

    /// A write from outside, over a serial line with the maker's framing, where late frames follow.
    ///
    /// # Errors
    /// [`AccessError`] for runs that leave the memory. A value that the hand does not take is no error: it is dropped.
    pub fn write(
        &mut self,
        address: u16,
        bytes: &[u8],
        now: Moment,
    ) -> Result<WriteEffect, AccessError> {
        self.advance_to(now);
        if self.supply.is_off(self.now_ms) {
            return Err(AccessError::Silent);
        }
        self.record(now, address, bytes);
        if self.follows_recording {
            return Ok(WriteEffect {
                ack_id: self.id,
                is_acked: true,
                taken: 0,
            });
        }
        self.refuse_read_only(address)?;
        let id = self.id;
        let speeds = PerDof::from_fn(|dof| self.memory.short(&SPEED_SET, element(dof)));
        let bytes = self.as_taken(address, bytes)?;
        let changes = self
            .memory
            .write(address, &bytes, self.config.personality.out_of_range)?;
        for change in &changes {
            self.apply(change, &speeds, now);
        }
        self.memory.rearm_triggers();
        self.published_ms = None;
        let names = |row: &Register| changes.iter().any(|change| change.register == row);
        let is_change = names(&HAND_ID) || names(&REDU_RATIO);
        let ack = self.config.personality.change_ack;
        Ok(WriteEffect {
            ack_id: match ack {
                ChangeAck::New if names(&HAND_ID) => self.memory.byte(HAND_ID.address),
                _ => id,
            },
            is_acked: !(is_change && ack == ChangeAck::None),
            taken: changes.len(),
        })
    }

    /// How the next answer is sent.
    pub fn manner(&mut self) -> ReplyTiming {
        let personality = self.config.personality;
        let usual = Duration::from_micros(self.chance.u64(3_000..=15_000));
        let rare = self.chance.u32(..RARE_ONE_IN) == 0;
        let double = self.chance.u32(..DOUBLE_ONE_IN) == 0;
        let thinks = match personality.thinking {
            Turnaround::Given => Duration::ZERO,
            Turnaround::Rarely if rare => RARE_TURNAROUND,
            Turnaround::Usual | Turnaround::Rarely => usual,
        };
        ReplyTiming {
            after: personality.turnaround + thinks,
            copies: 1 + usize::from(double && personality.doubles == Doubles::Some),
        }
    }

    /// The result of a SAVE, if one is due. Each is given once.
    pub fn late_save_result(&mut self, now: Moment) -> Option<SaveFrame> {
        if self.next_save_result()? > now {
            return None;
        }
        self.saves.pop_front().map(|(_, frame)| frame)
    }

    /// When the next result of a SAVE is due.
    pub fn next_save_result(&self) -> Option<Moment> {
        self.saves.front().map(|(due, _)| *due)
    }

    /// When the end of a calibration is to be told.
    pub const fn next_calibration_end(&self) -> Option<Moment> {
        self.calibration_end
    }

    /// True if the end of a calibration is to be told now; once.
    pub fn late_calibration_end(&mut self, now: Moment) -> bool {
        self.calibration_end.take_if(|due| *due <= now).is_some()
    }

    /// Switches the hand off. The joints stay where they are, and nothing is answered.
    pub fn switch_off(&mut self, now: Moment) {
        self.advance_to(now);
        self.supply.switch_off();
    }

    /// Switches the hand off and on, or on if it is off. The joints stay where they are.
    pub fn power_cycle(&mut self, now: Moment) {
        self.advance_to(now);
        self.supply.switch_on();
        self.restart();
    }

    fn restart(&mut self) {
        self.memory.power_cycle();
        self.saves.clear();
        self.calibration_due_ms = None;
        self.calibration_end = None;
        self.flash_due_ms = None;
        self.id = self.memory.byte(HAND_ID.address);
        self.baud_code = self.memory.byte(REDU_RATIO.address);
        for dof in Dof::ALL {
            self.body.drive_mut(dof).power_cycle();
        }
        self.frozen = false;
        self.frozen_angles = PerDof::splat(None);
        self.began_at = PerDof::from_fn(|dof| self.body.drives()[dof].position());
        self.target_actual();
    }

    /// The id that the hand answers to.
    pub const fn id(&self) -> u8 {
        self.id
    }

    /// The serial speed's code in effect, by default that of the last power-up.
    pub const fn baud_code(&self) -> u8 {
        self.baud_code
    }

    /// How this hand reads the manual's gaps.
    pub const fn personality(&self) -> &Personality {
        &self.config.personality
    }

    /// How it differs from other hands.
    pub const fn body(&self) -> &BodyParams {
        &self.config.body
    }

    /// The newest writes, oldest first; never more than twice [`JOURNAL_KEEPS`].
    pub fn journal(&self) -> &[JournalEntry] {
        &self.journal
    }

    /// Puts another object between the fingers.
    pub fn set_object(&mut self, object: &Object) {
        self.body.set_object(object);
        self.published_ms = None;
    }

    /// Lets somebody pull at its object, or leave it alone.
    pub fn set_pull(&mut self, pull: Option<Pull>) {
        self.pull = pull;
        self.published_ms = None;
    }

    /// Force of the object on each fingertip, g, whatever the hand tells.
    pub fn true_loads(&self) -> PerFinger<f64> {
        PerFinger::from_fn(|finger| self.body.fingertip_g(finger))
    }

    /// Whether its object slides now, whatever the hand tells.
    pub fn object_slides(&self) -> bool {
        let phase = self.pull.map(|pull| pull.phase(self.now_ms));
        matches!(phase, Some(PullPhase::Slides(_)))
    }

    /// Presses a fingertip with so many grams, or lets it go with 0.
    pub fn press_tip(&mut self, finger: Finger, grams: f64) {
        self.pressed_g[finger] = grams;
        self.published_ms = None;
    }

    /// Switches a fault on.
    pub fn inject_fault(&mut self, dof: Dof, fault: Fault) {
        self.body.drive_mut(dof).inject(fault);
        self.published_ms = None;
    }

    /// Makes a drive this warm, °C.
    pub fn warm(&mut self, dof: Dof, celsius: f64) {
        self.body.drive_mut(dof).warm(celsius);
        self.published_ms = None;
    }

    /// A temperature sensor reads this from now on, °C, whatever the drive has.
    pub fn break_temperature_sensor(&mut self, dof: Dof, celsius: u8) {
        self.body.drive_mut(dof).break_sensor(celsius);
        self.published_ms = None;
    }

    /// Lets everything that the hand tells of its joints and fingertips stand still from now on, or live again. The joints go on,
    /// setpoints are taken and read back, and every frame is valid. A power cycle ends it.
    pub fn freeze_feedback(&mut self, frozen: bool, now: Moment) {
        self.advance_to(now);
        self.publish(|_| true);
        self.frozen = frozen;
        self.published_ms = None;
    }

    /// Lets the angles of these joints alone stand still from now on, and those of the others live: current, force, touch and status of
    /// all joints live on. A power cycle ends it.
    pub fn freeze_angles(&mut self, frozen: PerDof<bool>, now: Moment) {
        self.advance_to(now);
        self.publish(|_| false);
        self.frozen_angles = PerDof::from_fn(|dof| {
            let shown = self.memory.short(&ANGLE_ACT, element(dof));
            frozen[dof].then_some(shown)
        });
        self.published_ms = None;
    }

    /// True while what the hand tells stands still.
    pub const fn is_frozen(&self) -> bool {
        self.frozen
    }

    /// Where the joints are, counts of ANGLE_ACT, whatever the hand tells.
    pub fn true_angles(&self) -> PerDof<f64> {
        PerDof::from_fn(|dof| self.body.drives()[dof].angle())
    }

    /// Blocks a joint's linkage at an angle, or frees it.
    pub fn set_jam(&mut self, dof: Dof, angle: Option<f64>) {
        self.body.drive_mut(dof).set_jam(angle);
    }

    /// Lets a drive obey nothing any more: its joint stays, and its status with it.
    pub fn set_dead(&mut self, dof: Dof, dead: bool) {
        self.body.drive_mut(dof).set_dead(dead);
    }

    /// From now on it says what it is given, as it was recorded of another hand. Writes are acknowledged and change nothing.
    pub const fn follow_recording(&mut self) {
        self.follows_recording = true;
    }

    /// What a recorded hand held from here on.
    pub fn put_recorded(&mut self, address: u16, bytes: &[u8]) {
        self.memory.put(address, bytes);
    }

    /// Whether a recorded hand answers.
    pub const fn put_silent(&mut self, silent: bool) {
        if silent {
            self.supply.switch_off()
        } else {
            self.supply.switch_on()
        }
    }

    fn record(&mut self, at: Moment, address: u16, bytes: &[u8]) {
        if self.journal.len() >= 2 * JOURNAL_KEEPS {
            self.journal.drain(..JOURNAL_KEEPS);
        }
        self.journal.push(JournalEntry {
            at,
            address,
            bytes: bytes.to_vec(),
        });
    }

    fn tick(&mut self) {
        match self.config.scenario {
            Scenario::Grasp => self.script_grasp(),
            Scenario::Faults => self.script_faults(),
            _ => {}
        }
        self.pull_object();
        if self.supply.is_off(self.now_ms) {
            if self.supply.fails(self.now_ms) {
                self.restart();
            }
            return;
        }
        let settings = PerDof::from_fn(|dof| self.setting(dof));
        self.body.step(self.now_ms, &settings, &mut self.rng);
        if self.config.scenario == Scenario::Frozen && !self.frozen {
            self.freeze_in_motion();
        }
        if self.now_ms.is_multiple_of(SENSOR_MS) {
            self.touch.measure(&mut self.rng);
        }
        if self.flash_due_ms == Some(self.now_ms) {
            self.flash_due_ms = None;
            self.write_flash();
        }
        if self.calibration_due_ms == Some(self.now_ms) {
            self.calibration_due_ms = None;
            self.body.calibrate_force();
        }
    }

    fn freeze_in_motion(&mut self) {
        let has_moved = |dof: &Dof| {
            let way = self.body.drives()[*dof].position() - self.began_at[*dof];
            way.abs() >= FREEZE_TRAVEL
        };
        if Dof::ALL.iter().any(has_moved) {
            self.publish(|_| true);
            self.frozen = true;
        }
    }

    fn setting(&self, dof: Dof) -> DriveSettings {
        if let Some(order) = &self.order {
            return DriveSettings {
                speed: f64::from(order.speeds[dof]),
                threshold_g: f64::from(order.forces[dof]),
            };
        }
        let speed = f64::from(self.memory.short(&SPEED_SET, element(dof)));
        DriveSettings {
            speed: match self.config.personality.speed_zero {
                SpeedZero::Slowest => speed.max(CREEP),
                SpeedZero::Freeze | SpeedZero::Ignored => speed,
            },
            threshold_g: self.stops_at_g(dof, self.memory.short(&FORCE_SET, element(dof))),
        }
    }

    /// The load at which this FORCE_SET stops a drive, g.
    fn stops_at_g(&self, dof: Dof, threshold: i16) -> f64 {
        let offset_g = match self.config.personality.force_compared {
            ForceCompared::AsRead => self.body.offset_g(dof),
            ForceCompared::Load => 0.0,
        };
        f64::from(threshold) - offset_g
    }

    fn script_grasp(&mut self) {
        if let Some(order) = scenario::grasp_order(self.now_ms) {
            self.obey(&order);
        }
        let slip = scenario::slip(Scenario::Grasp, self.now_ms);
        for dof in Dof::ALL {
            self.body.drive_mut(dof).set_grip(slip.grip);
        }
    }

    fn pull_object(&mut self) {
        let Some(pull) = self.pull else {
            return;
        };
        let grip = pull.slip(self.now_ms).grip;
        for dof in Dof::ALL {
            self.body.drive_mut(dof).set_grip(grip);
        }
        if pull.is_lost(self.now_ms) {
            self.body.set_object(&Object::none());
            self.pull = None;
        }
    }

    /// How the object slid on the fingertips when they measured.
    fn slip(&self, measured_ms: u64) -> Slip {
        match self.pull {
            Some(pull) => pull.slip(measured_ms),
            None => scenario::slip(self.config.scenario, measured_ms),
        }
    }

    fn script_faults(&mut self) {
        let Some(picture) = scenario::fault_phase(self.now_ms) else {
            return;
        };
        for dof in Dof::ALL {
            let drive = self.body.drive_mut(dof);
            drive.warm(35.0);
            drive.power_cycle();
        }
        for (dof, ailment) in picture {
            let drive = self.body.drive_mut(*dof);
            match ailment {
                Ailment::Says(status) => drive.pretend(*status),
                Ailment::Has(fault) => drive.inject(*fault),
            }
            if *ailment == Ailment::Has(Fault::OverTemperature) {
                drive.warm(92.0);
            }
        }
    }

    /// Moves as an action stored in the hand would. The setpoint registers stay what a controller wrote: a change there
    /// would be another controller's.
    fn obey(&mut self, order: &Order) {
        for dof in Dof::ALL {
            self.go_to_angle(dof, order.angles[dof]);
        }
        self.order = Some(*order);
    }

    pub(crate) fn go_to_angle(&mut self, dof: Dof, angle: i16) {
        let goal = DriveGoal::Position(position_of(f64::from(angle)));
        self.body.drive_mut(dof).command(goal, self.now_ms);
    }

    /// ANGLE_SET says where the joints are; nothing is to be moved.
    fn target_actual(&mut self) {
        for (dof, drive) in self.body.drives().iter() {
            self.memory
                .put_angle_set(element(dof), number::short(drive.angle()));
        }
        self.published_ms = None;
    }

    /// The check of the fingertip's block at `at`, as this hand reckons it.
    fn put_check(&mut self, at: u16) {
        let check = at + CHECK_AT;
        let sum = u16::from_le_bytes([self.memory.byte(check), self.memory.byte(check + 1)]);
        let sum = match self.config.personality.tactile_check {
            TactileCheck::Block => sum,
            TactileCheck::Sensor => sum.wrapping_add(SENSOR_HEADER_SUM),
            TactileCheck::Zero => 0,
        };
        self.memory.put(check, &sum.to_le_bytes());
    }

    /// Puts the live values of this millisecond into the memory; of the fingertips, those whose blocks are wanted.
    fn publish(&mut self, wants: impl Fn(Span) -> bool) {
        if self.follows_recording || self.frozen {
            return;
        }
        if self.published_ms != Some(self.now_ms) {
            self.published_ms = Some(self.now_ms);
            self.published_tips = PerFinger::splat(false);
            live::publish_drives(&mut self.memory, &self.body);
            for (dof, angle) in self.frozen_angles.iter() {
                if let Some(angle) = angle {
                    self.memory.put_short(&ANGLE_ACT, element(dof), *angle);
                }
            }
            if self.config.scenario == Scenario::Extremes {
                extremes::overlay(&mut self.memory, self.now_ms);
                self.published_tips = PerFinger::splat(true);
            }
        }
        for finger in Finger::ALL {
            if !self.published_tips[finger] && wants(Group::Tactile(finger).span()) {
                self.published_tips[finger] = true;
                self.publish_tip(finger);
            }
        }
    }

    fn publish_tip(&mut self, finger: Finger) {
        let measured_ms = self.now_ms - self.now_ms % SENSOR_MS;
        let slip = self.slip(measured_ms);
        let mut press = live::press(&self.body, finger);
        press.force_g += scenario::touched_g(self.config.scenario, finger, measured_ms);
        press.force_g += self.pressed_g[finger];
        let block = self
            .touch
            .block(finger, press, slip, number::seconds(measured_ms));
        let at = Group::Tactile(finger).span().address;
        self.memory.put(at, &block.encode());
        self.put_check(at);
    }
}

const fn overlaps(a: Span, b: Span) -> bool {
    (a.address as u32) < b.end() && (b.address as u32) < a.end()
}
