//! The search for the fastest close under a limit, on bodies that it does not know.

use crate::trials::virtual_hand::{STIFFNESSES, case};
use handscope::hand::Dof;
use handscope::trials::find::TuneWish;

/// All of the bench, by hand: `cargo test --test it -- --ignored find::study --nocapture`.
#[test]
#[ignore = "minutes; the bench has it"]
fn study() {
    let number = |name: &str, or: u64| std::env::var(name).map_or(or, |text| text.parse().unwrap());
    let (from, bodies, checks) = (
        number("FROM", 0),
        number("BODIES", 4),
        number("CHECKS", 0) as usize,
    );
    let wish = TuneWish::new(&[Dof::Index], number("LIMIT", 500) as i16);
    for seed in from..from + bodies {
        for stiffness in STIFFNESSES {
            let case = case(seed, stiffness, (&wish, checks));
            println!(
                "{seed} {stiffness:4} {:5.2} of {:5.2} ({:4.2}) highest {:4.0} trials {:3} {:4.0} s above {}/{}: {}",
                case.close_s,
                case.best_s,
                case.close_s / case.best_s,
                case.highest_g,
                case.trials,
                case.took_s,
                case.above,
                case.checked,
                case.words
            );
        }
    }
}
