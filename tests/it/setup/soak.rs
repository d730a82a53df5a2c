//! How often a test that only counts tries what it tries: a share of what a release wants, or all with `HANDSCOPE_SOAK=1`,
//! or ten times as often with `HANDSCOPE_SOAK=10`. Library tests have this file, too.

const VARIABLE: &str = "HANDSCOPE_SOAK";
/// Enough for an edit to be tried soon, in code that is compiled for being ready soon.
const SHARE: f64 = 0.02;

fn share() -> f64 {
    std::env::var(VARIABLE).map_or(SHARE, |share| match share.parse() {
        Ok(share) if share > 0.0 => share,
        _ => panic!("{VARIABLE} is a factor, 1 for the full counts, not {share:?}"),
    })
}

/// Of `full` tries, this run's share; one at least.
pub(crate) fn times(full: u64) -> u64 {
    times_at_least(1, full)
}

/// The same where fewer than `least` prove nothing.
pub(crate) fn times_at_least(least: u64, full: u64) -> u64 {
    ((full as f64 * share()) as u64).max(least)
}
