//! The PIN of staff: five tries, then a minute of waiting.

use crate::hand::Moment;
use std::time::Duration;

/// Wrong PINs before nothing is taken for a while.
pub const TRIES: u8 = 5;
/// How long that is.
pub const LOCKED_FOR: Duration = Duration::from_secs(60);
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
    /// It was right.
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

/// Takes PINs and counts wrong ones.
#[derive(Debug, Clone)]
pub struct PinGate {
    pin: Pin,
    wrong: u8,
    locked: Option<Moment>,
}

impl PinGate {
    /// Opens to this PIN only.
    #[must_use]
    pub const fn new(pin: Pin) -> Self {
        Self {
            pin,
            wrong: 0,
            locked: None,
        }
    }

    /// When the next try counts, if that is not now.
    #[must_use]
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
        self.wrong += 1;
        if self.wrong < TRIES {
            return PinAnswer::Wrong {
                left: TRIES - self.wrong,
            };
        }
        self.wrong = 0;
        let until = now.plus(LOCKED_FOR);
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
}
