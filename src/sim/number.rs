//! The few conversions from the body's numbers to register values, and the normal distribution. No casts elsewhere.

/// Rounds to a signed 16-bit value; saturates.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn short(value: f64) -> i16 {
    value.round() as i16
}

/// Rounds to a byte; saturates.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn byte(value: f64) -> u8 {
    value.round() as u8
}

/// Rounds to 32-bit counts; saturates.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn counts(value: f64) -> i32 {
    value.round() as i32
}

/// Rounds to an unsigned 16-bit value; saturates.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn word(value: f64) -> u16 {
    value.round() as u16
}

/// Converts to the nearest single-precision number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a sensor sends single precision"
)]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}

/// Converts milliseconds to seconds; exact for any realistic run time.
#[expect(clippy::cast_precision_loss, reason = "exact below 2^53 milliseconds")]
pub(crate) fn seconds(ms: u64) -> f64 {
    ms as f64 / 1000.0
}

/// Rounds to whole milliseconds; negative values become 0.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, which is what is wanted"
)]
pub(crate) fn whole_ms(ms: f64) -> u64 {
    ms.round() as u64
}

/// A random number of the standard normal distribution.
pub(crate) fn normal(rng: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.f64()).cos()
}
