//! The few roundings from the body's numbers to registers. Nothing else casts.

/// Rounds to a short; runs past the ends stay at the ends.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn short(value: f64) -> i16 {
    value.round() as i16
}

/// Rounds to a byte; runs past the ends stay at the ends.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn byte(value: f64) -> u8 {
    value.round() as u8
}

/// Rounds to 32-bit counts; runs past the ends stay at the ends.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn counts(value: f64) -> i32 {
    value.round() as i32
}

/// Rounds to an unsigned word; runs past the ends stay at the ends.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn word(value: f64) -> u16 {
    value.round() as u16
}

/// The nearest single-precision number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a sensor sends single precision"
)]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}

/// Milliseconds as seconds; exact for any time that a program runs.
#[expect(clippy::cast_precision_loss, reason = "exact below 2^53 milliseconds")]
pub(crate) fn seconds(ms: u64) -> f64 {
    ms as f64 / 1000.0
}

/// Rounds to whole milliseconds; what is negative is none.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn whole_ms(ms: f64) -> u64 {
    ms.round() as u64
}
