//! What the manual leaves open, as switches of the simulated hand: each does what it says, and the link keeps its rules
//! with every pair of positions, on every wire, in virtual time. `HANDSCOPE_ROW=n` runs one row of the pairs.

mod pairs;
mod run;
mod switches;
mod wire;

use crate::sim::personalities::run::Verdict;
use crate::sim::personalities::wire::Protocol;
use handscope::sim::SWITCHES;

#[test]
fn every_pair_of_positions_keeps_the_links_rules_on_every_wire() {
    let sizes: Vec<usize> = SWITCHES.iter().map(|switch| switch.values.len()).collect();
    let rows = pairs::covering(&sizes);
    assert_eq!(pairs::uncovered(&sizes, &rows), 0);
    let one = std::env::var("HANDSCOPE_ROW").ok();
    let one: Option<usize> = one.map(|row| row.parse().unwrap());
    let mut seen = Verdict::default();
    let mut broken = Vec::new();
    for (number, row) in rows.iter().enumerate() {
        if one.is_some_and(|one| one != number) {
            continue;
        }
        for protocol in Protocol::ALL {
            let verdict = std::panic::catch_unwind(|| run::judge(row, protocol));
            match verdict {
                Ok(verdict) => seen.add(&verdict),
                Err(_) => broken.push(format!(
                    "HANDSCOPE_ROW={number} {protocol:?}: {}",
                    run::spelled(row)
                )),
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    println!("{} rows, {seen:#?}", rows.len());
    if one.is_none() {
        // Oracles that never had anything to judge prove nothing.
        let runs = rows.len() * Protocol::ALL.len();
        assert_eq!(seen.connected, runs);
        assert!(seen.armed > runs / 2, "{seen:?} of {runs}");
        assert!(seen.stopped > runs / 2, "{seen:?} of {runs}");
        assert!(
            seen.written > runs && seen.confirmed > runs / 3,
            "{seen:?} of {runs}"
        );
    }
}
