//! Effects of a write on the simulated hand: targets, triggers, codes, SAVE. Receives no bytes and knows no wire.

use crate::hand::register::{
    ACTION_SEQ_INDEX, ACTION_SEQ_RUN, ANGLE_SET, Access, CLEAR_ERROR, DEFAULT_FORCE_SET,
    DEFAULT_SPEED_SET, GESTURE_FORCE_CLB, GESTURE_NO_SET, HAND_ID, POS_SET, REDU_RATIO, RESET_PARA,
    SAVE, SPEED_SET, USER_DEF_ANGLE, by_address,
};
use crate::hand::{Dof, Moment, PerDof, UserGesture};
use crate::sim::drive::{DriveGoal, position_of};
use crate::sim::gesture;
use crate::sim::hand::{SaveFrame, SimHand, WriteEffect};
use crate::sim::live::element;
use crate::sim::memory::{AccessError, MemoryChange};
use crate::sim::personality::{
    BaudEffect, Calibration, ClearError, DefaultsWrite, Effect, FlashWrite, MinusOne,
    ReadOnlyWrite, SaveAnswer, SpeedZero,
};
use std::time::Duration;

/// Time from SAVE to its result (manual 2.2.2: about one second).
const SAVE_TAKES: Duration = Duration::from_secs(1);
/// Time from SAVE to its result on a hand that is slow with it.
const SAVE_TAKES_LATE: Duration = Duration::from_secs(5);
/// Time from the result of a SAVE to its duplicate.
const SAVE_AGAIN: Duration = Duration::from_millis(100);
/// Time from SAVE to the last byte in flash, on a hand that needs time for it.
const FLASH_TAKES_MS: u64 = 1000;
/// Largest default value that a clamping hand accepts.
const CLAMPS_TO: i16 = 500;
/// Capacity for pending SAVE results: no wire that we have carries more in one second.
const SAVES_MAX: usize = 64;

impl SimHand {
    /// Like [`Self::write`], over a wire that has no late frames: the result of a SAVE or a calibration is not reported.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn write_quietly(
        &mut self,
        address: u16,
        bytes: &[u8],
        now: Moment,
    ) -> Result<WriteEffect, AccessError> {
        self.sends_late_frames = false;
        let effect = self.write(address, bytes, now);
        self.sends_late_frames = true;
        effect
    }

    pub(crate) fn refuse_read_only(&self, address: u16) -> Result<(), AccessError> {
        let readable = by_address(address).is_some_and(|row| row.access == Access::Read);
        match self.config.personality.read_only {
            ReadOnlyWrite::Nak if readable => Err(AccessError::ReadOnly { address }),
            ReadOnlyWrite::Nothing if readable => Err(AccessError::Silent),
            _ => Ok(()),
        }
    }

    /// Applies the effect of one changed element. `speeds` are those before the write.
    pub(crate) fn apply(&mut self, change: &MemoryChange, speeds: &PerDof<i16>, now: Moment) {
        let on = change.value == 1;
        if (ANGLE_SET.address..=SPEED_SET.address).contains(&change.register.address) {
            self.order = None;
        }
        match change.register.address {
            a if a == ANGLE_SET.address || a == POS_SET.address => self.apply_target(change),
            a if a == SPEED_SET.address && change.value == 0 => self.apply_no_speed(change, speeds),
            a if a == HAND_ID.address || a == REDU_RATIO.address => self.apply_codes(
                self.config.personality.id_effect == Effect::Now,
                self.config.personality.baud_effect == BaudEffect::Now,
            ),
            a if a == CLEAR_ERROR.address && on => self.clear_errors(),
            a if a == SAVE.address && on => self.save(now),
            a if a == RESET_PARA.address && on => {
                self.memory.reset_parameters();
                self.apply_codes(
                    self.config.personality.id_effect != Effect::AfterPower,
                    self.config.personality.baud_effect != BaudEffect::AfterPower,
                );
            }
            a if a == GESTURE_FORCE_CLB.address && on => self.calibrate(now),
            a if a == GESTURE_NO_SET.address => self.apply_pose(change.value),
            a if a == ACTION_SEQ_RUN.address && on => {
                self.apply_pose(i32::from(self.memory.byte(ACTION_SEQ_INDEX.address)));
            }
            _ => {}
        }
    }

    /// Begins a calibration. Its end is reported only over a wire that has a frame for it.
    fn calibrate(&mut self, now: Moment) {
        // Manual: 2.6.6 names no time. Reports of hands in use say 2 to 6 s, the sister hand's older manual about 6.
        let takes_ms = match self.config.personality.calibration {
            Calibration::SixSeconds => 6000,
            Calibration::TwoSeconds => 2000,
        };
        self.calibration_due_ms = Some(self.now_ms + takes_ms);
        if self.sends_late_frames || self.calibration_end.is_some() {
            self.calibration_end = Some(now.plus(Duration::from_millis(takes_ms)));
        }
    }

    /// Applies the id and serial speed stored in the memory.
    fn apply_codes(&mut self, id: bool, baud: bool) {
        if id {
            self.id = self.memory.byte(HAND_ID.address);
        }
        if baud {
            self.baud_code = self.memory.byte(REDU_RATIO.address);
        }
    }

    fn apply_no_speed(&mut self, change: &MemoryChange, speeds: &PerDof<i16>) {
        let dof = Dof::ALL.get(usize::from(change.element)).copied();
        if let (Some(dof), SpeedZero::Ignored) = (dof, self.config.personality.speed_zero) {
            let former = speeds[dof];
            self.memory.put_short(&SPEED_SET, change.element, former);
        }
    }

    fn clear_errors(&mut self) {
        for dof in Dof::ALL {
            let drive = self.body.drive_mut(dof);
            let was_stopped = !drive.faults().is_empty();
            drive.clear_errors();
            if was_stopped && self.config.personality.clear_error == ClearError::Resume {
                let target = self.memory.short(&ANGLE_SET, element(dof));
                self.go_to_angle(dof, target);
            }
        }
    }

    fn apply_target(&mut self, change: &MemoryChange) {
        let Some(dof) = Dof::ALL.get(usize::from(change.element)).copied() else {
            return;
        };
        let goal = match (change.value, self.config.personality.minus_one_mid_move) {
            (-1, MinusOne::Ignore) => return,
            (-1, MinusOne::Freeze) => DriveGoal::Freeze,
            (-1, MinusOne::Clamp) => {
                let most = change.register.range.map_or(0, |(_, max)| max);
                let most = i16::try_from(most).unwrap_or_default();
                self.memory.put_short(change.register, change.element, most);
                self.apply_target(&MemoryChange {
                    value: i32::from(most),
                    ..*change
                });
                return;
            }
            (value, _) if change.register.address == ANGLE_SET.address => {
                DriveGoal::Position(position_of(f64::from(value)))
            }
            (value, _) => DriveGoal::Position(f64::from(value)),
        };
        self.body.drive_mut(dof).command(goal, self.now_ms);
    }

    fn apply_pose(&mut self, number: i32) {
        let number = u8::try_from(number).unwrap_or_default();
        let taught = UserGesture::new(number).map(|number| {
            let first = 6 * u16::from(number.get() - UserGesture::MIN.get());
            PerDof::from_fn(|dof| self.memory.short(&USER_DEF_ANGLE, first + element(dof)))
        });
        let pose = gesture::pose(number).or(taught.ok());
        for (dof, angle) in pose.iter().flat_map(PerDof::iter) {
            if *angle >= 0 {
                self.memory.put_angle_set(element(dof), *angle);
                self.go_to_angle(dof, *angle);
            }
        }
    }

    /// Copies the saved parameters to flash and applies codes that take effect then.
    pub(crate) fn write_flash(&mut self) {
        self.memory.save();
        self.apply_codes(
            self.config.personality.id_effect == Effect::AfterSave,
            self.config.personality.baud_effect == BaudEffect::AfterSave,
        );
    }

    /// Returns the bytes of a write as this hand accepts them, out of range throughout if it drops them.
    pub(crate) fn as_taken(&self, address: u16, bytes: &[u8]) -> Result<Vec<u8>, AccessError> {
        let is_default = (DEFAULT_SPEED_SET.address
            ..DEFAULT_FORCE_SET.address + DEFAULT_FORCE_SET.len)
            .contains(&address);
        let (pairs, rest) = bytes.as_chunks::<2>();
        match self.config.personality.defaults {
            DefaultsWrite::Exception if is_default => Err(AccessError::OutOfRange { address }),
            // -1 is outside every range there, and values out of range are dropped.
            DefaultsWrite::Drop if is_default => Ok(vec![u8::MAX; bytes.len()]),
            DefaultsWrite::Clamp if is_default => {
                let clamped = pairs.iter().flat_map(|pair| {
                    let value = i16::from_le_bytes(*pair).min(CLAMPS_TO);
                    value.to_le_bytes()
                });
                Ok(clamped.chain(rest.iter().copied()).collect())
            }
            _ => Ok(bytes.to_vec()),
        }
    }

    fn save(&mut self, now: Moment) {
        let answer = self.config.personality.save_frame;
        let (command, ok) = match answer {
            SaveAnswer::Command11 => (0x11, true),
            SaveAnswer::Failed => (0x12, false),
            _ => (0x12, true),
        };
        match self.config.personality.flash {
            _ if !ok => {}
            FlashWrite::AtOnce => self.write_flash(),
            FlashWrite::Slowly => self.flash_due_ms = Some(self.now_ms + FLASH_TAKES_MS),
        }
        let takes = match answer {
            _ if !self.sends_late_frames => &[][..],
            SaveAnswer::Never => &[],
            SaveAnswer::Late => &[SAVE_TAKES_LATE],
            SaveAnswer::Twice => &[SAVE_TAKES, SAVE_TAKES.saturating_add(SAVE_AGAIN)],
            _ => &[SAVE_TAKES],
        };
        let room = SAVES_MAX.saturating_sub(self.saves.len());
        let frames = takes.iter().take(room);
        let frames = frames.map(|takes| (now.plus(*takes), SaveFrame { command, ok }));
        self.saves.extend(frames);
    }
}
