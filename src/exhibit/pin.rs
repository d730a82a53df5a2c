//! The PIN of staff: five tries, then a minute of waiting, then five more and twice the wait, also after a restart.

use crate::hand::Moment;
use std::time::Duration;

/// Wrong PINs before nothing is taken for a while.
pub const TRIES: u8 = 5;
/// How long that is the first time; each time twice as long.
pub const LOCK_DURATION: Duration = Duration::from_secs(60);
/// It grows no longer than this: staff who mistyped get in on the same day.
pub const LOCKED_MAX: Duration = Duration::from_secs(3600);
/// Digits of a PIN.
pub const DIGITS: std::ops::RangeInclusive<usize> = 4..=8;

/// Four to eight digits.
#[derive(Clone, PartialEq, Eq)]
pub struct Pin(String);

/// A text that is no PIN. It does not repeat what was given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a PIN has {} to {} digits, and nothing else", DIGITS.start(), DIGITS.end())]
pub struct BadPin;

impl TryFrom<String> for Pin {
    type Error = BadPin;
    fn try_from(text: String) -> Result<Self, BadPin> {
        let is_pin = DIGITS.contains(&text.len()) && text.bytes().all(|c| c.is_ascii_digit());
        is_pin.then_some(Self(text)).ok_or(BadPin)
    }
}

/// Never shows its digits.
impl std::fmt::Debug for Pin {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str("Pin(…)")
    }
}

/// What became of a PIN that was typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PinAnswer {
    Right,
    /// It was wrong; so many tries are left.
    Wrong {
        /// At least one.
        left: u8,
    },
    /// Nothing is taken before this moment, right or wrong.
    Locked {
        /// When the next try counts.
        until: Moment,
    },
}

/// Wrong PINs since the last right one: what of a gate outlasts the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WrongPins {
    /// How many.
    pub count: u32,
    /// The wait after the last of them is over, if there was one.
    pub waited: bool,
}

impl WrongPins {
    /// How long nothing is taken after these: nothing but after each [`TRIES`], then a minute and twice as long each time.
    pub fn wait(self) -> Option<Duration> {
        let rounds = self.count / u32::from(TRIES);
        let is_due = rounds > 0 && self.count.is_multiple_of(u32::from(TRIES));
        let doubled = 2_u32.saturating_pow(rounds.saturating_sub(1));
        is_due.then(|| LOCK_DURATION.saturating_mul(doubled).min(LOCKED_MAX))
    }
}

/// Takes PINs and counts wrong ones.
#[derive(Debug, Clone)]
pub struct PinGate {
    pin: Pin,
    wrong: u32,
    locked: Option<Moment>,
}

impl PinGate {
    /// Opens to this PIN only.
    pub const fn new(pin: Pin) -> Self {
        Self {
            pin,
            wrong: 0,
            locked: None,
        }
    }

    /// The same after wrong PINs in an earlier run of the program. A wait that was not over then begins anew: no clock tells how
    /// much of it passed that the user could not have set.
    pub fn resumed(pin: Pin, earlier: WrongPins, now: Moment) -> Self {
        let wait = earlier.wait().filter(|_| !earlier.waited);
        Self {
            pin,
            wrong: earlier.count,
            locked: wait.map(|wait| now.plus(wait)),
        }
    }

    /// What an exhibition that begins later has to know.
    pub fn wrong_pins(&self, now: Moment) -> WrongPins {
        let count = self.wrong;
        WrongPins {
            count,
            waited: count > 0 && self.locked_until(now).is_none(),
        }
    }

    /// When the next try counts, if that is not now.
    pub fn locked_until(&self, now: Moment) -> Option<Moment> {
        self.locked.filter(|until| now < *until)
    }

    /// Takes what was typed.
    pub fn enter(&mut self, typed: &str, now: Moment) -> PinAnswer {
        if let Some(until) = self.locked_until(now) {
            return PinAnswer::Locked { until };
        }
        self.locked = None;
        if typed == self.pin.0 {
            self.wrong = 0;
            return PinAnswer::Right;
        }
        self.wrong = self.wrong.saturating_add(1);
        let Some(wait) = self.wrong_pins(now).wait() else {
            let in_round = u8::try_from(self.wrong % u32::from(TRIES)).unwrap_or_default();
            return PinAnswer::Wrong {
                left: TRIES - in_round,
            };
        };
        let until = now.plus(wait);
        self.locked = Some(until);
        PinAnswer::Locked { until }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;

    fn pin(text: &str) -> Result<Pin, BadPin> {
        Pin::try_from(text.to_owned())
    }

    #[test]
    fn a_pin_has_four_to_eight_digits_and_is_never_shown() {
        for (text, is_one) in [
            ("123", false),
            ("1234", true),
            ("00000000", true),
            ("123456789", false),
            ("12a4", false),
            ("１２３４", false),
            ("", false),
        ] {
            assert_eq!(pin(text).is_ok(), is_one, "{text}");
        }
        assert!(!format!("{:?}", pin("4711").unwrap()).contains('7'));
    }

    #[test]
    fn five_wrong_pins_lock_for_a_minute_even_the_right_one() {
        let mut gate = PinGate::new(pin("4711").unwrap());
        let at = |s: u64| Moment::from_micros(s * 1_000_000);
        for (second, left) in [(1, 4), (2, 3), (3, 2), (4, 1)] {
            assert_eq!(gate.enter("0000", at(second)), PinAnswer::Wrong { left });
        }
        let locked = PinAnswer::Locked { until: at(65) };
        assert_eq!(gate.enter("471", at(5)), locked);
        assert_eq!(gate.enter("4711", at(64)), locked, "right, and too early");
        assert_eq!(gate.enter("4711", at(65)), PinAnswer::Right);
        assert_eq!(gate.enter("0000", at(66)), PinAnswer::Wrong { left: 4 });
    }
    #[test]
    fn the_wait_doubles_up_to_an_hour_and_begins_anew_after_a_restart_and_a_right_pin_ends_it() {
        let mut now = Moment::ZERO;
        let mut gate = PinGate::new(pin("4711").unwrap());
        for minutes in [1, 2, 4, 8, 16, 32, 60, 60] {
            for _ in 0..4 {
                assert!(matches!(gate.enter("0000", now), PinAnswer::Wrong { .. }));
                // A restart between two tries gives no more of them.
                gate = PinGate::resumed(pin("4711").unwrap(), gate.wrong_pins(now), now);
            }
            let wait = Duration::from_secs(60 * minutes);
            let until = now.plus(wait);
            assert_eq!(gate.enter("0000", now), PinAnswer::Locked { until });
            // Half of it passes, and the program begins again: it is waited for in full.
            now = now.plus(wait / 2);
            gate = PinGate::resumed(pin("4711").unwrap(), gate.wrong_pins(now), now);
            let until = now.plus(wait);
            assert_eq!(gate.locked_until(now), Some(until));
            assert_eq!(gate.enter("4711", now), PinAnswer::Locked { until });
            now = until;
            gate = PinGate::resumed(pin("4711").unwrap(), gate.wrong_pins(now), now);
            assert_eq!(gate.locked_until(now), None, "it was over before");
        }
        assert_eq!(gate.enter("4711", now), PinAnswer::Right);
        assert_eq!(gate.wrong_pins(now), WrongPins::default());
        let mut last = PinGate::resumed(
            pin("4711").unwrap(),
            WrongPins {
                count: u32::MAX,
                waited: false,
            },
            now,
        );
        assert!(
            last.locked_until(now)
                .is_none_or(|until| until <= now.plus(LOCKED_MAX))
        );
        last.enter("0000", now.plus(LOCKED_MAX));
    }
}
