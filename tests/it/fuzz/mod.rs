//! Millions of damaged and random inputs through every decoder: nothing panics, nothing grows, and what is accepted is
//! what it says. `HANDSCOPE_SEED` takes others.

#[expect(
    unreachable_pub,
    reason = "the fuzz package has this file as its library"
)]
mod targets;

use crate::fuzz::targets::{OTHERS, State, Target, WIRES, seeds};
use crate::setup::soak;
use fastrand::Rng;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Inputs of each decoder of a wire, of which an ordinary run takes a share.
const WIRE_INPUTS: u64 = 10_000_000;
/// Inputs of all others, which make text of what they read or take much longer ones.
const OTHER_INPUTS: u64 = 50_000;
/// Longest random input; mutated frames are as long as they are.
const RANDOM_MAX: usize = 24;
/// One decoder state is used for so many inputs, then another: accepted frames do not depend on old noise alone.
const FRESH_EACH: u64 = 1_000_000;

fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok().map(|text| text.parse().unwrap())
}

/// A good input, a damaged one, or noise.
fn fill(input: &mut Vec<u8>, rng: &mut Rng, seeds: &[Vec<u8>]) {
    input.clear();
    let choice = rng.u32(..);
    if choice.is_multiple_of(4) {
        let len = (choice >> 8) as usize % (RANDOM_MAX + 1);
        input.resize(len, 0);
        for piece in input.chunks_mut(8) {
            piece.copy_from_slice(&rng.u64(..).to_le_bytes()[..piece.len()]);
        }
        return;
    }
    input.extend_from_slice(&seeds[(choice >> 8) as usize % seeds.len()]);
    if choice.is_multiple_of(2) || input.is_empty() {
        return;
    }
    let at = rng.usize(..input.len());
    match (choice >> 4) % 4 {
        0 => input[at] ^= 1 << rng.u32(..8),
        1 => input[at] = rng.u8(..),
        2 => input.truncate(at),
        _ => input.insert(at, rng.u8(..)),
    }
}

fn run(name: &str, target: Target, inputs: u64) {
    let seed = setting("HANDSCOPE_SEED").unwrap_or(1);
    let mut rng = Rng::with_seed(seed);
    let seeds = seeds(name);
    let (mut state, mut accepted, mut input) = (State::default(), 0, Vec::new());
    let begun = std::time::Instant::now();
    for n in 0..inputs {
        if n.is_multiple_of(FRESH_EACH) {
            accepted += state.accepted;
            state = State::default();
        }
        fill(&mut input, &mut rng, &seeds);
        target(&mut state, &input);
    }
    accepted += state.accepted;
    println!(
        "{name}: {inputs} inputs, {accepted} accepted, {:.1?}",
        begun.elapsed()
    );
    assert!(
        accepted > inputs / 1000,
        "{name}: {accepted} of {inputs} accepted"
    );
}

/// Two threads, each of which takes the next target as soon as it is done with one.
fn run_all(targets: &[(&str, Target)], inputs: u64) {
    let inputs = soak::times(inputs);
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some((name, target)) = targets.get(next.fetch_add(1, Ordering::Relaxed)) {
            run(name, *target, inputs);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
}

#[test]
fn every_wire_decoder_stands_millions_of_inputs() {
    run_all(&WIRES, WIRE_INPUTS);
}

#[test]
fn everything_else_that_reads_foreign_bytes_stands_them_too() {
    run_all(&OTHERS, OTHER_INPUTS);
}
