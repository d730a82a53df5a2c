//! The staff PIN: five tries, then a lockout of one minute, then five more and twice the lockout, also across restarts.

use crate::hand::Moment;
use std::time::Duration;

/// Wrong PINs before a lockout.
pub const TRIES: u8 = 5;
/// Duration of the first lockout; each further one is twice as long.
pub const LOCK_DURATION: Duration = Duration::from_secs(60);
/// Longest lockout: staff who mistype get in on the same day.
pub const LOCKED_MAX: Duration = Duration::from_secs(3600);
/// Number of digits in a PIN.
pub const DIGITS: std::ops::RangeInclusive<usize> = 4..=8;

/// Four to eight digits.
#[derive(Clone, PartialEq, Eq)]
pub struct Pin(String);

/// A text that is not a PIN. The error does not repeat it.
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

/// Result of entering a PIN.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PinAnswer {
    Right,
    /// Wrong, with tries left.
    Wrong {
        /// At least one.
        left: u8,
    },
    /// Locked out: any PIN is rejected until then.
    Locked {
        /// When the next try counts.
        until: Moment,
    },
}

/// Wrong PINs since the last right one; stored across restarts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WrongPins {
    pub count: u32,
    /// True if there are wrong PINs and no lockout is pending.
    pub waited: bool,
}

impl WrongPins {
    /// Duration of the lockout after this count: `None` except at multiples of [`TRIES`]; a minute, doubled each time.
    pub fn wait(self) -> Option<Duration> {
        let rounds = self.count / u32::from(TRIES);
        let is_due = rounds > 0 && self.count.is_multiple_of(u32::from(TRIES));
        let doubled = 2_u32.saturating_pow(rounds.saturating_sub(1));
        is_due.then(|| LOCK_DURATION.saturating_mul(doubled).min(LOCKED_MAX))
    }
}

/// Checks PINs and counts wrong ones.
#[derive(Debug, Clone)]
pub struct PinGate {
    pin: Pin,
    wrong: u32,
    locked: Option<Moment>,
}

impl PinGate {
    /// A gate that accepts this PIN only.
    pub const fn new(pin: Pin) -> Self {
        Self {
            pin,
            wrong: 0,
            locked: None,
        }
    }

    /// A gate with the wrong PINs of an earlier run of the program. An unfinished lockout starts again: the elapsed part is unknown,
    /// since the user could have set the clock.
    pub fn resumed(pin: Pin, earlier: WrongPins, now: Moment) -> Self {
        let wait = earlier.wait().filter(|_| !earlier.waited);
        Self {
            pin,
            wrong: earlier.count,
            locked: wait.map(|wait| now.plus(wait)),
        }
    }

    /// The wrong PINs, to be stored for a later run.
    pub fn wrong_pins(&self, now: Moment) -> WrongPins {
        let count = self.wrong;
        WrongPins {
            count,
            waited: count > 0 && self.locked_until(now).is_none(),
        }
    }

    /// End of the current lockout; `None` if the next try counts now.
    pub fn locked_until(&self, now: Moment) -> Option<Moment> {
        self.locked.filter(|until| now < *until)
    }

    /// Checks a typed PIN.
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
                // A restart between two tries grants no extra ones.
                gate = PinGate::resumed(pin("4711").unwrap(), gate.wrong_pins(now), now);
            }
            let wait = Duration::from_secs(60 * minutes);
            let until = now.plus(wait);
            assert_eq!(gate.enter("0000", now), PinAnswer::Locked { until });
            // The program restarts halfway through a lockout, which then starts again in full.
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
