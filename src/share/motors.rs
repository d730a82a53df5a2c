//! Unitree's state of both hands of a robot as twelve motors, `unitree_go::msg::dds_::MotorStates_`, as its DFX service publishes it:
//! motors 0 to 5 are the right hand's joints, 6 to 11 the left hand's. An unknown hand is published as NaN, and the state of it that
//! another Handscope publishes is forwarded, so that each message contains both hands.

use crate::hand::kinematics::Side;
use crate::hand::{Dof, Moment};
use crate::record::file::format::cdr;
use crate::transport::dds::DdsTopic;
use serde::{Deserialize, Serialize};
use std::time::Duration;

const JOINTS: usize = Dof::ALL.len();
/// Age from which the other hand's state is unknown: some twenty states.
const OTHER_MAX_AGE: Duration = Duration::from_millis(250);
/// Time after a message from another program that publishes both hands during which this one does not.
const DRIVER_MAX_AGE: Duration = Duration::from_secs(2);
/// Marker in a motor's spare words: measured by the sender, not forwarded.
const MEASURED: u32 = 0x4853_0001;

/// Topic for the state of both hands.
pub(crate) fn topic() -> DdsTopic {
    DdsTopic {
        name: "rt/inspire/state".into(),
        type_name: "unitree_go::msg::dds_::MotorStates_".into(),
    }
}

/// The type, field by field. Unitree's service fills only `q`; the others stay 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Motor {
    mode: u8,
    q: f32,
    others: [f32; 6],
    temperature: u8,
    lost: u32,
    reserve: [u32; 2],
}

#[derive(Serialize, Deserialize)]
struct Motors {
    states: Vec<Motor>,
}

impl Motor {
    /// Unknown: NaN, and lost.
    const UNKNOWN: Self = Self {
        mode: 0,
        q: f32::NAN,
        others: [0.0; 6],
        temperature: 0,
        lost: 1,
        reserve: [0; 2],
    };

    fn measured(angle: i16, celsius: u8) -> Self {
        Self {
            q: f32::from(angle) / 1000.0,
            temperature: celsius,
            lost: 0,
            reserve: [MEASURED, 0],
            ..Self::UNKNOWN
        }
    }
}

/// Known states of both hands.
#[derive(Debug)]
pub(crate) struct MotorPair {
    side: Side,
    other: Option<([Motor; JOINTS], Moment)>,
    /// Time of the last message from another program that publishes both hands.
    driver: Option<Moment>,
}

impl MotorPair {
    /// Creates a pair of which this program has the hand of this side.
    pub(crate) const fn new(side: Side) -> Self {
        Self {
            side,
            other: None,
            driver: None,
        }
    }

    /// Handles a message from another participant.
    pub(crate) fn receive(&mut self, bytes: &[u8], now: Moment) {
        let Some(Motors { states }) = cdr::decode(bytes) else {
            return;
        };
        if states.len() != Side::MOTORS {
            return;
        }
        let is_measured = |motor: &Motor| motor.reserve == [MEASURED, 0];
        if !states.iter().any(is_measured) {
            self.driver = Some(now);
        }
        let other = match self.side {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        };
        let half = states.get(other.first_motor()..).unwrap_or_default();
        if let Some(half) = half.first_chunk()
            && half.iter().all(is_measured)
        {
            self.other = Some((*half, now));
        }
    }

    /// Encodes the message in CDR with its header; `None` while another program publishes both hands.
    pub(crate) fn message(
        &self,
        angles: &[i16; JOINTS],
        celsius: &[u8; JOINTS],
        now: Moment,
    ) -> Option<Vec<u8>> {
        let is_current = |at: Moment| now.since(at) < DRIVER_MAX_AGE;
        if self.driver.is_some_and(is_current) {
            return None;
        }
        let mut all = angles.iter().zip(celsius);
        let own = all
            .by_ref()
            .map(|(angle, celsius)| Motor::measured(*angle, *celsius));
        let own: Vec<Motor> = own.collect();
        let passed_on = |motor: &Motor| Motor {
            reserve: [0; 2],
            ..*motor
        };
        let other = self.other.as_ref();
        let other = other.filter(|(_, at)| now.since(*at) < OTHER_MAX_AGE);
        let other = other.map_or([Motor::UNKNOWN; JOINTS], |(half, _)| {
            half.each_ref().map(passed_on)
        });
        let states = match self.side {
            Side::Right => [own.as_slice(), &other].concat(),
            Side::Left => [&other, own.as_slice()].concat(),
        };
        Some(cdr::encode(&Motors { states }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANGLES: [i16; 6] = [0, 1000, 500, 250, 1003, -2];
    const CELSIUS: [u8; 6] = [31, 32, 33, 34, 35, 36];

    fn ms(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    fn q(message: &[u8]) -> Vec<f32> {
        let Motors { states } = cdr::decode(message).unwrap();
        states.iter().map(|motor| motor.q).collect()
    }

    /// CycloneDDS 11 wrote this of two motors at 0 and 0.25, both at 31 °C, with our mark.
    const CYCLONE: &str = "000100000200000000000000000000000000000000000000000000000000000000000000000000001f000000000000000100534800000000000000000000803e0000000000000000000000000000000000000000000000001f000000000000000100534800000000";

    #[test]
    fn motors_are_what_cyclonedds_writes() {
        let states = [0, 250].map(|angle| Motor::measured(angle, 31)).to_vec();
        let message = cdr::encode(&Motors { states });
        let hex = message.iter().map(|byte| format!("{byte:02x}"));
        assert_eq!(hex.collect::<String>(), CYCLONE);
    }

    #[test]
    fn a_message_has_twelve_motors_of_the_types_own_layout() {
        let pair = MotorPair::new(Side::Right);
        let message = pair.message(&ANGLES, &CELSIUS, ms(0)).unwrap();
        // Head, count, and for each motor: mode, padding, seven numbers, temperature, padding, three words.
        assert_eq!(message.len(), 4 + 4 + Side::MOTORS * 48);
        let ring = &message[8 + 48..][..48];
        assert_eq!(ring[4..8], 1.0_f32.to_le_bytes());
        assert_eq!((ring[0], ring[32]), (0, 32));
        let own = q(&message);
        assert_eq!(own[..6], [0.0, 1.0, 0.5, 0.25, 1.003, -0.002]);
        assert!(
            own[6..].iter().all(|q| q.is_nan()),
            "the left one is not known"
        );
        let left = MotorPair::new(Side::Left);
        let published = q(&left.message(&ANGLES, &CELSIUS, ms(0)).unwrap());
        assert!(published[..6].iter().all(|q| q.is_nan()) && published[9] == 0.25);
    }

    #[test]
    fn two_handscopes_tell_both_hands_and_what_is_passed_on_is_not_passed_on_again() {
        let (mut right, mut left) = (MotorPair::new(Side::Right), MotorPair::new(Side::Left));
        let of_left = left.message(&[700; 6], &CELSIUS, ms(0)).unwrap();
        right.receive(&of_left, ms(1));
        let of_right = right.message(&[300; 6], &CELSIUS, ms(2)).unwrap();
        assert_eq!(q(&of_right), [[0.3; 6], [0.7; 6]].concat());
        // A second right hand hears of the left one only from the left one.
        let mut second = MotorPair::new(Side::Right);
        second.receive(&of_right, ms(3));
        let published = q(&second.message(&[300; 6], &CELSIUS, ms(3)).unwrap());
        assert!(published[6..].iter().all(|q| q.is_nan()), "{published:?}");
        left.receive(&of_right, ms(3));
        let published = q(&left.message(&[700; 6], &CELSIUS, ms(4)).unwrap());
        assert_eq!(published, [[0.3; 6], [0.7; 6]].concat());
        // What is old is not known any more.
        let late = q(&right.message(&[300; 6], &CELSIUS, ms(251)).unwrap());
        assert!(late[6..].iter().all(|q| q.is_nan()), "{late:?}");
    }

    #[test]
    fn nothing_is_told_beside_a_driver_of_both_hands() {
        let mut pair = MotorPair::new(Side::Right);
        let states = vec![
            Motor {
                q: 0.5,
                lost: 0,
                ..Motor::UNKNOWN
            };
            Side::MOTORS
        ];
        pair.receive(&cdr::encode(&Motors { states }), ms(100));
        assert_eq!(pair.message(&ANGLES, &CELSIUS, ms(2099)), None);
        assert!(pair.message(&ANGLES, &CELSIUS, ms(2100)).is_some());
        for odd in [&[][..], &[0, 1, 0, 0], &[0, 1, 0, 0, 255, 255, 255, 255]] {
            pair.receive(odd, ms(3000));
        }
        assert!(pair.message(&ANGLES, &CELSIUS, ms(3000)).is_some());
    }
}
