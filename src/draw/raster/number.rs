//! Number conversions of the rasteriser, each lossy in one known way. No other arithmetic.

/// One pixel in fixed-point units.
pub(crate) const SUBPIXELS: i64 = 256;
/// Half a pixel: offset of a pixel's centre.
pub(crate) const HALF_PIXEL: i64 = SUBPIXELS / 2;
/// Coordinates are clamped to ±2^20 px, so products of two differences stay far inside an `i64`.
const FIXED_LIMIT: f32 = 268_435_456.0;

/// A pixel coordinate rounded to 1/256 px; `None` if it is NaN.
#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to 2^28 and rounded just before"
)]
pub(crate) fn fixed(pixels: f32) -> Option<i64> {
    let scaled = (pixels * 256.0).round();
    (!scaled.is_nan()).then(|| scaled.clamp(-FIXED_LIMIT, FIXED_LIMIT) as i64)
}

/// Floor, saturating; 0 for NaN.
#[expect(
    clippy::cast_possible_truncation,
    reason = "saturation far outside any texture is what is wanted"
)]
pub(crate) fn floor(value: f32) -> i64 {
    value.floor() as i64
}

/// A fixed-point difference or area for plane equations; exact below 2^53.
#[expect(
    clippy::cast_precision_loss,
    reason = "53 bits are finer than the 8 bits of a colour"
)]
pub(crate) fn real(value: i64) -> f64 {
    value as f64
}

/// A plane's value or slope, at `f32` precision.
#[expect(
    clippy::cast_possible_truncation,
    reason = "24 bits are finer than the 8 bits of a colour"
)]
pub(crate) fn narrow(value: f64) -> f32 {
    value as f32
}

/// A colour channel 0..=255, rounded, saturating.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, which clamps the channel"
)]
pub(crate) fn channel(value: f32) -> u8 {
    (value + 0.5) as u8
}

/// A size or index as a signed coordinate.
pub(crate) fn coordinate(value: usize) -> i64 {
    i64::try_from(value).unwrap_or(i64::MAX)
}

/// A coordinate as an index; negative ones become 0.
pub(crate) fn index(value: i64) -> usize {
    usize::try_from(value).unwrap_or(0)
}

/// A texture's size in texels as a factor for `uv`; exact below 2^24.
#[expect(clippy::cast_precision_loss, reason = "textures are far below 2^24")]
pub(crate) fn texels(value: usize) -> f32 {
    value as f32
}
