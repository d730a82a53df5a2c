//! How often a test that only counts tries what it tries: a fiftieth of what a release wants, all of it with
//! `HANDSCOPE_SOAK=1`, or ten times that with `HANDSCOPE_SOAK=10`. Library tests have this file, too.

const VARIABLE: &str = "HANDSCOPE_SOAK";
/// Our code is compiled for being ready soon, and an edit shall be tried soon.
const USUAL_PART: u64 = 50;

/// How many times all, if not a part.
fn whole() -> Option<u64> {
    let times = std::env::var(VARIABLE).ok()?;
    match times.parse() {
        Ok(times) if times > 0 => Some(times),
        _ => panic!("{VARIABLE} says how many times the full counts, such as 1, and not {times:?}"),
    }
}

/// Of `full` tries, those of this run; one at least.
pub(crate) fn times(full: u64) -> u64 {
    times_at_least(1, full)
}

/// The same where fewer than `least` prove nothing.
pub(crate) fn times_at_least(least: u64, full: u64) -> u64 {
    let times = whole().map_or(full / USUAL_PART, |whole| full * whole);
    times.max(least)
}

/// Whether this run sees even what is rare.
pub(crate) fn is_full() -> bool {
    whole().is_some()
}
