//! The simulated hand: combines memory, body, fingertips and script. Time is passed in; it owns no clock and no wire.

use crate::hand::register::{ANGLE_ACT, FORCE_SET, HAND_ID, REDU_RATIO, Register, SPEED_SET, Span};
use crate::hand::{Dof, Fault, Finger, Group, Moment, PerDof, PerFinger};
use crate::sim::body::Body;
use crate::sim::body_params::BodyParams;
use crate::sim::drive::{Drive, DriveGoal, DriveSettings, position_of};
use crate::sim::extremes;
use crate::sim::held::{HeldObject, HeldState};
use crate::sim::live::{self, element};
use crate::sim::memory::{AccessError, GAP, Memory};
use crate::sim::number;
use crate::sim::object::Object;
use crate::sim::personality::{
    Beyond, ChangeAck, Doubles, ForceCompared, GapAnswer, Personality, SpeedZero, TactileCheck,
    Turnaround,
};
use crate::sim::scenario::{self, ActionSetpoints, Ailment, Scenario};
use crate::sim::supply::Supply;
use crate::sim::touch::{SENSOR_MS, TouchSensors};
use std::collections::VecDeque;
use std::time::Duration;

/// Contribution of a sensor's own header to its check sum: 55 AA, 56 bytes, a command, a number, 8 channels.
// Manual: silent; the sensor maker's own frame has this header before the same 54 bytes.
const SENSOR_HEADER_SUM: u16 = 0x55 + 0xAA + 56 + 3 + 1 + 8;
/// Offset of the check word in a fingertip's block (manual 2.6.21).
const CHECK_AT: u16 = 54;
/// On hands that do so, one reply in this many comes twice, or late.
const DOUBLE_ONE_IN: u32 = 16;
const RARE_ONE_IN: u32 = 256;
const RARE_TURNAROUND: Duration = Duration::from_millis(500);
/// Speed at which a creeping hand moves with SPEED_SET 0.
const CREEP: f64 = 5.0;
/// Writes that remain in the journal; the older half is dropped when twice as many have accumulated.
pub const JOURNAL_KEEPS: usize = 8192;
/// Travel of a joint, in counts of its stroke, after which feedback freezes in that scenario.
const FREEZE_TRAVEL: f64 = 100.0;
/// Makes the random numbers of the object independent of the body's.
const HELD_SEED: u64 = 0x0B1EC7;
/// Location of the read's time stamp, if the personality writes one.
const STAMP: Span = Span::new(GAP.address, 8);

/// Configuration of a simulated hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimConfig {
    /// Seed of all its random numbers.
    pub seed: u64,
    /// Id on the bus, 1..=254.
    pub id: u8,
    /// Behaviour without commands.
    pub scenario: Scenario,
    /// Choices where the manual leaves gaps.
    pub personality: Personality,
    /// Mechanical differences from other hands.
    pub body: BodyParams,
    /// Object between the fingers; `None` = that of the scenario.
    pub object: Option<Object>,
}

impl Default for SimConfig {
    fn default() -> Self {
        Self {
            seed: 1,
            id: 1,
            scenario: Scenario::Idle,
            personality: Personality::default(),
            body: BodyParams::default(),
            object: None,
        }
    }
}

/// Result of a write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WriteEffect {
    /// Id in the acknowledgement: the new one, if the write changed it.
    pub ack_id: u8,
    /// True if the write is acknowledged.
    pub is_acked: bool,
    /// Number of elements that the hand accepted; the others were dropped silently.
    pub taken: usize,
}

/// Timing of a reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReplyTiming {
    /// Delay from the end of the request.
    pub after: Duration,
    /// Number of times that it is sent, 1 or 2.
    pub copies: usize,
}

/// The second frame after a SAVE on a serial line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SaveFrame {
    /// Command byte, 0x11 or 0x12.
    pub command: u8,
    /// True if the parameters were written to flash.
    pub ok: bool,
}

/// One write that reached the hand, accepted or not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JournalEntry {
    pub at: Moment,
    /// Address of the first byte.
    pub address: u16,
    pub bytes: Vec<u8>,
}

/// A simulated hand at byte level.
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
    /// Fingertips that were also published then.
    published_tips: PerFinger<bool>,
    pub(crate) calibration_due_ms: Option<u64>,
    /// Time at which the pending SAVE is in flash, on a hand that needs time for it.
    pub(crate) flash_due_ms: Option<u64>,
    pub(crate) saves: VecDeque<(Moment, SaveFrame)>,
    /// Time at which a serial line with the maker's framing reports the end of a calibration.
    pub(crate) calibration_end: Option<Moment>,
    /// False while handling a write from a wire that has no frames after the reply.
    pub(crate) sends_late_frames: bool,
    pub(crate) id: u8,
    pub(crate) baud_code: u8,
    /// Random numbers independent of the body: timing of replies.
    chance: fastrand::Rng,
    journal: Vec<JournalEntry>,
    /// External force on each fingertip, g.
    pressed_g: PerFinger<f64>,
    /// Last order of the hand's own script; a setpoint from outside ends it.
    pub(crate) order: Option<ActionSetpoints>,
    /// The feedback is frozen; the joints continue.
    frozen: bool,
    /// ANGLE_ACT of the joints whose angle alone is frozen.
    frozen_angles: PerDof<Option<i16>>,
    /// Positions of the joints at power-up.
    began_at: PerDof<f64>,
    /// It replays a recording: no body, no script, and writes change nothing.
    follows_recording: bool,
    /// The object between the fingers.
    held: HeldObject,
}

impl SimHand {
    /// Creates a hand that was switched on at [`Moment::ZERO`], open.
    pub fn new(config: SimConfig) -> Self {
        let mut rng = fastrand::Rng::with_seed(config.seed);
        let own = || Object::of(config.scenario);
        let object = config.object.unwrap_or_else(own);
        let body = Body::new(&object, &config.body, &mut rng);
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
            held: HeldObject::new(&object, config.seed ^ HELD_SEED),
        };
        hand.target_actual();
        hand
    }

    /// Simulates up to `now` in steps of one millisecond, so that the result does not depend on the calling pattern.
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

    /// Reads a range of bytes at `now`.
    ///
    /// # Errors
    /// [`AccessError`] for ranges that leave the memory, or cross the gap on a hand that does not answer there.
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

    /// Applies a write from outside over a serial line with the maker's framing, where late frames may follow.
    ///
    /// # Errors
    /// [`AccessError`] for ranges that leave the memory. A value that the hand does not accept is no error: it is dropped.
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

    /// Timing of the next reply.
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

    /// Returns the result of a SAVE, if one is due, once each.
    pub fn late_save_result(&mut self, now: Moment) -> Option<SaveFrame> {
        if self.next_save_result()? > now {
            return None;
        }
        self.saves.pop_front().map(|(_, frame)| frame)
    }

    /// Time at which the next result of a SAVE is due.
    pub fn next_save_result(&self) -> Option<Moment> {
        self.saves.front().map(|(due, _)| *due)
    }

    /// Time at which the end of a calibration is due to be reported.
    pub const fn next_calibration_end(&self) -> Option<Moment> {
        self.calibration_end
    }

    /// True, once, if the end of a calibration is due to be reported.
    pub fn late_calibration_end(&mut self, now: Moment) -> bool {
        self.calibration_end.take_if(|due| *due <= now).is_some()
    }

    /// Switches the hand off. The joints stay where they are, and the hand does not answer.
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

    /// Current id on the bus.
    pub const fn id(&self) -> u8 {
        self.id
    }

    /// Code of the serial speed in effect, by default that of the last power-up.
    pub const fn baud_code(&self) -> u8 {
        self.baud_code
    }

    /// Choices where the manual leaves gaps.
    pub const fn personality(&self) -> &Personality {
        &self.config.personality
    }

    /// Mechanical differences from other hands.
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
        self.body.set_grip(1.0);
        self.held.set_object(object);
        self.published_ms = None;
    }

    /// True force of the object on each fingertip, g, independent of the feedback.
    pub fn true_loads(&self) -> PerFinger<f64> {
        PerFinger::from_fn(|finger| self.body.fingertip_g(finger))
    }

    /// True if its object slides now on every fingertip that touches it, independent of the feedback.
    pub const fn object_slides(&self) -> bool {
        self.held.slides()
    }

    /// True state of its object, independent of the feedback.
    pub fn held(&self) -> HeldState {
        self.held.state(self.body.is_broken())
    }

    /// Presses a fingertip with this force, g; 0 releases it.
    pub fn press_tip(&mut self, finger: Finger, grams: f64) {
        self.pressed_g[finger] = grams;
        self.published_ms = None;
    }

    /// Raises a fault.
    pub fn inject_fault(&mut self, dof: Dof, fault: Fault) {
        self.body.drive_mut(dof).inject(fault);
        self.published_ms = None;
    }

    /// Sets a drive's temperature, °C.
    pub fn warm(&mut self, dof: Dof, celsius: f64) {
        self.body.drive_mut(dof).warm(celsius);
        self.published_ms = None;
    }

    /// Fixes the reading of a temperature sensor, °C, regardless of the drive's temperature.
    pub fn break_temperature_sensor(&mut self, dof: Dof, celsius: u8) {
        self.body.drive_mut(dof).break_sensor(celsius);
        self.published_ms = None;
    }

    /// Freezes or unfreezes all feedback of joints and fingertips. The joints continue, setpoints are accepted and read back,
    /// and every frame is valid. A power cycle ends it.
    pub fn freeze_feedback(&mut self, frozen: bool, now: Moment) {
        self.advance_to(now);
        self.publish(|_| true);
        self.frozen = frozen;
        self.published_ms = None;
    }

    /// Freezes only the angles of these joints; the other angles, and the current, force, touch and status of all joints stay live.
    /// A power cycle ends it.
    pub fn freeze_angles(&mut self, frozen: PerDof<bool>, now: Moment) {
        self.advance_to(now);
        self.publish(|_| false);
        self.frozen_angles = PerDof::from_fn(|dof| {
            let shown = self.memory.short(&ANGLE_ACT, element(dof));
            frozen[dof].then_some(shown)
        });
        self.published_ms = None;
    }

    /// True while all feedback is frozen.
    pub const fn is_frozen(&self) -> bool {
        self.frozen
    }

    /// True angles of the joints, counts of ANGLE_ACT, independent of the feedback.
    pub fn true_angles(&self) -> PerDof<f64> {
        PerDof::from_fn(|dof| self.body.drives()[dof].angle())
    }

    /// Blocks a joint's linkage at an angle, or frees it.
    pub fn set_jam(&mut self, dof: Dof, angle: Option<f64>) {
        self.body.drive_mut(dof).set_jam(angle);
    }

    /// Makes a drive ignore all commands: its joint stays, and its status with it.
    pub fn set_dead(&mut self, dof: Dof, dead: bool) {
        self.body.drive_mut(dof).set_dead(dead);
    }

    /// Makes it replay recorded data of another hand. Writes are acknowledged and change nothing.
    pub const fn follow_recording(&mut self) {
        self.follows_recording = true;
    }

    /// Sets recorded memory contents, valid from now on.
    pub fn put_recorded(&mut self, address: u16, bytes: &[u8]) {
        self.memory.put(address, bytes);
    }

    /// Sets whether a recorded hand answers.
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
        self.step_object();
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

    /// Load at which this FORCE_SET stops a drive, g.
    fn stops_at_g(&self, dof: Dof, threshold: i16) -> f64 {
        let offset_g = match self.config.personality.force_compared {
            ForceCompared::AsRead => self.body.offset_g(dof),
            ForceCompared::Load => 0.0,
        };
        f64::from(threshold) - offset_g
    }

    fn script_grasp(&mut self) {
        if let Some(order) = scenario::grasp_order(self.now_ms) {
            self.execute(&order);
        }
    }

    /// Moves the object under the present forces of the drives, which hold it without power as well.
    fn step_object(&mut self) {
        let was_present = self.held.is_present();
        let has_room = self.body.has_room();
        let drives = self.body.drives().as_array();
        let is_closing = drives.iter().any(Drive::is_moving);
        self.held.step(&self.true_loads(), has_room, is_closing);
        if self.held.is_present() != was_present {
            self.body.set_present(!was_present);
        }
        self.body.set_grip(self.held.grip());
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

    /// Moves as an action stored in the hand would. The setpoint registers keep a controller's last values: a change there
    /// would look like another controller.
    fn execute(&mut self, order: &ActionSetpoints) {
        for dof in Dof::ALL {
            self.go_to_angle(dof, order.angles[dof]);
        }
        self.order = Some(*order);
    }

    pub(crate) fn go_to_angle(&mut self, dof: Dof, angle: i16) {
        let goal = DriveGoal::Position(position_of(f64::from(angle)));
        self.body.drive_mut(dof).command(goal, self.now_ms);
    }

    /// Sets ANGLE_SET to the actual positions; nothing moves.
    fn target_actual(&mut self) {
        for (dof, drive) in self.body.drives().iter() {
            self.memory
                .put_angle_set(element(dof), number::short(drive.angle()));
        }
        self.published_ms = None;
    }

    /// Writes the check word of the fingertip's block at `at`, computed as this hand does.
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

    /// Writes the live values of this millisecond to the memory; for fingertips, only the blocks that `wants` selects.
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
        let mut press = live::press(&self.body, &self.held, finger);
        press.force_g += scenario::touched_g(self.config.scenario, finger, measured_ms);
        press.force_g += self.pressed_g[finger];
        let block = self
            .touch
            .block(finger, press, number::seconds(measured_ms));
        let at = Group::Tactile(finger).span().address;
        self.memory.put(at, &block.encode());
        self.put_check(at);
    }
}

const fn overlaps(a: Span, b: Span) -> bool {
    (a.address as u32) < b.end() && (b.address as u32) < a.end()
}
