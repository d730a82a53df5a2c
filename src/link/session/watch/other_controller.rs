//! Detects another controller on the same hand: requests that are not ours, and setpoints that change though this
//! program did not write them. Judges only; the session acts on it.

use crate::hand::feedback::sample::SET_OUT_OF_RANGE;
use crate::hand::{AngleReading, Force, RegisterWrite, Speed, Target};
use crate::hand::{Group, Groups, HandSample, Moment, PerDof, register};
use crate::link::session::watch::setpoint::{SetpointCheck, SetpointWatch, Wrote};
use crate::record::{SetpointConflict, SetpointRegister};
use arrayvec::ArrayVec;
use std::time::Duration;

/// This many foreign requests …
const REQUESTS: usize = 3;
/// … within this time indicate another controller; fewer may be noise that happens to look like one.
const WITHIN: Duration = Duration::from_secs(2);
/// The other controller counts as gone when it was not detected for this long: setpoints are read back twice per second.
const GONE_TIMEOUT: Duration = Duration::from_secs(5);

/// Evidence of another controller.
#[derive(Debug)]
pub(crate) struct OtherController {
    counted: u64,
    requests: ArrayVec<Moment, REQUESTS>,
    noticed: Option<Moment>,
    angles: SetpointWatch,
    forces: SetpointWatch,
    speeds: SetpointWatch,
    /// The last reading of angles, forces, speeds was inconclusive.
    doubted: [bool; 3],
    /// Number of setpoint changes that this program did not write.
    pub(crate) changes: u64,
    /// The last changed setpoint.
    pub(crate) foreign: Option<SetpointConflict>,
    /// A setpoint that the hand did not accept, without any sign of another writer.
    pub(crate) not_taken: Option<SetpointConflict>,
}

impl Default for OtherController {
    fn default() -> Self {
        Self {
            counted: 0,
            requests: ArrayVec::new(),
            noticed: None,
            angles: SetpointWatch::new(SetpointRegister::AngleSet),
            forces: SetpointWatch::new(SetpointRegister::ForceSet),
            speeds: SetpointWatch::new(SetpointRegister::SpeedSet),
            doubted: [false; 3],
            changes: 0,
            foreign: None,
            not_taken: None,
        }
    }
}

impl OtherController {
    /// Starts a fresh session with the hand: the setpoints it held before are forgotten. The evidence is kept, and our
    /// writes through the previous wire may still take effect.
    pub(crate) fn begin(&mut self) {
        self.angles.begin();
        self.forces.begin();
        self.speeds.begin();
        self.doubted = [false; 3];
        self.not_taken = None;
    }

    /// Applies the total count of foreign requests on the wire.
    pub(crate) fn overheard(&mut self, total: u64, now: Moment) {
        for _ in self.counted..total.min(self.counted.saturating_add(REQUESTS as u64)) {
            if self.requests.is_full() {
                self.requests.remove(0);
            }
            self.requests.push(now);
        }
        let is_new = total > self.counted;
        self.counted = total;
        let oldest = self.requests.first().copied();
        let many = self.requests.is_full() && oldest.is_some_and(|at| now.since(at) <= WITHIN);
        if is_new && many {
            self.noticed = Some(now);
        }
    }

    /// Records a write that was sent, or may have been.
    pub(crate) fn wrote(&mut self, write: &RegisterWrite, now: Moment) {
        let within = |row: &register::Register| row.span().covers(write.span());
        if within(&register::ANGLE_SET) {
            self.angles.wrote(values(write, &register::ANGLE_SET), now);
        } else if within(&register::FORCE_SET) {
            self.forces.wrote(values(write, &register::FORCE_SET), now);
        } else if within(&register::SPEED_SET) {
            self.speeds.wrote(values(write, &register::SPEED_SET), now);
        } else {
            // A gesture or a cleared fault: the hand may set its own setpoints.
            self.angles.hand_decides(now);
            self.forces.hand_decides(now);
            self.speeds.hand_decides(now);
        }
    }

    /// Applies setpoints read from the hand. True if they should be read again soon, because one reading proves nothing.
    pub(crate) fn read(&mut self, sample: &HandSample, fresh: Groups) -> bool {
        let fresh = |group| fresh.contains(group);
        let angles = sample.angle.map(|angle| angle.value.map(AngleReading::raw));
        let angle_set = sample.angle_set.filter(|_| fresh(Group::AngleSet));
        let force_set = sample.force_set.filter(|_| fresh(Group::ForceSet));
        let speed_set = sample.speed_set.filter(|_| fresh(Group::SpeedSet));
        let seen = [
            angle_set.map(|set| {
                let values = set
                    .value
                    .map(|set| set.map_or(SET_OUT_OF_RANGE, Target::raw));
                (self.angles.read(&values, angles, set.asked), set.received)
            }),
            force_set.map(|set| {
                let values = set
                    .value
                    .map(|set| set.map_or(SET_OUT_OF_RANGE, Force::get));
                (self.forces.read(&values, None, set.asked), set.received)
            }),
            speed_set.map(|set| {
                let values = set
                    .value
                    .map(|set| set.map_or(SET_OUT_OF_RANGE, Speed::get));
                (self.speeds.read(&values, None, set.asked), set.received)
            }),
        ];
        let mut again = false;
        let read = self.doubted.iter_mut().zip(seen);
        for (doubted, (seen, at)) in read.filter_map(|(doubted, seen)| Some((doubted, seen?))) {
            *doubted = seen == SetpointCheck::Doubtful;
            again |= *doubted;
            match seen {
                SetpointCheck::Usual | SetpointCheck::Doubtful => {}
                SetpointCheck::NotTaken(conflict) => self.not_taken = Some(conflict),
                SetpointCheck::Foreign(conflict) => {
                    self.changes += 1;
                    self.noticed = Some(at);
                    self.foreign = Some(conflict);
                }
            }
        }
        again
    }

    /// True if the last reading of a group showed a value that this program did not write, which one reading does not prove.
    pub(crate) fn is_doubted(&self) -> bool {
        self.doubted.contains(&true)
    }

    /// True while another controller is active.
    pub(crate) fn is_active(&self, now: Moment) -> bool {
        self.noticed.is_some_and(|at| now.since(at) < GONE_TIMEOUT)
    }
}

/// The values that a write within a group has for each joint.
fn values(write: &RegisterWrite, row: &register::Register) -> PerDof<Wrote> {
    let is_angle = row.address == register::ANGLE_SET.address;
    write.shorts(row).map(|value| match value {
        None => Wrote::Nothing,
        Some(-1) if is_angle => Wrote::Leave,
        Some(value) => Wrote::Value(value),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{HandCommand, Reply};

    fn at(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    /// Reads the speeds of all joints as the hand would return them.
    fn read(other: &mut OtherController, speed: u8, ms: u64) {
        let mut sample = HandSample::default();
        let bytes = [speed, 0].repeat(6);
        let fresh = sample.apply(&Reply {
            span: register::SPEED_SET.span(),
            bytes: &bytes,
            asked: at(ms),
            received: at(ms),
        });
        other.read(&sample, fresh);
    }

    #[test]
    fn setpoints_that_change_under_us_are_noticed_at_the_second_reading() {
        let mut other = OtherController::default();
        for (ms, speed, active) in [
            (0, 100, false),
            (500, 100, false),
            (1000, 50, false),
            (1500, 50, true),
            (6000, 50, true),
            (6600, 50, false),
        ] {
            read(&mut other, speed, ms);
            assert_eq!(other.is_active(at(ms)), active, "{ms}");
        }
        assert_eq!(other.changes, 1);
    }

    #[test]
    fn one_wrong_reading_and_our_own_writes_are_no_other_controller() {
        let mut other = OtherController::default();
        read(&mut other, 100, 0);
        read(&mut other, 7, 500);
        read(&mut other, 100, 1000);
        let speeds = HandCommand::Speeds(PerDof::splat(Some(Speed::nearest(250))));
        other.wrote(&speeds.writes()[0], at(1200));
        // It takes effect late, after a reading that still shows the old values.
        for (ms, speed) in [
            (1500, 100),
            (2000, 100),
            (3000, 250),
            (3500, 250),
            (4000, 250),
        ] {
            read(&mut other, speed, ms);
        }
        assert_eq!(other.changes, 0);
        // On a busy line the next reading may come much later.
        other.wrote(&speeds.writes()[0], at(4200));
        for (ms, speed) in [(8000, 99), (8500, 99)] {
            read(&mut other, speed, ms);
        }
        assert_eq!(other.changes, 0);
        other.begin();
        read(&mut other, 1, 9000);
        read(&mut other, 1, 9500);
        assert_eq!(other.changes, 0, "after a reconnect nothing is known");
    }

    #[test]
    fn our_write_may_act_at_the_end_of_its_horizon_and_through_a_wire_that_is_gone() {
        let speeds = HandCommand::Speeds(PerDof::splat(Some(Speed::nearest(250))));
        for reconnected in [false, true] {
            let mut other = OtherController::default();
            read(&mut other, 100, 0);
            other.wrote(&speeds.writes()[0], at(100));
            if reconnected {
                other.begin();
            }
            for (ms, speed) in [
                (1000, 100),
                (2000, 100),
                (2500, 250),
                (3000, 250),
                (3500, 250),
            ] {
                read(&mut other, speed, ms);
            }
            assert_eq!(other.changes, 0);
        }
    }

    #[test]
    fn a_few_foreign_requests_in_a_row_are_another_controller_and_scattered_ones_are_not() {
        let mut other = OtherController::default();
        for n in 1..20 {
            other.overheard(n, at(n * 1500));
            assert!(!other.is_active(at(n * 1500)));
        }
        for n in 20..23 {
            other.overheard(n, at(40_000 + n * 10));
        }
        assert!(other.is_active(at(40_300)));
        assert!(!other.is_active(at(46_000)));
    }
}
