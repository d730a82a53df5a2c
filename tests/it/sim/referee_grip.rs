//! The told grip of a hand by another author, in real time: friction in the air, an offset that drifts, a wrist that turns, a slow slip
//! and two losses. Only the order of the states is judged, so that a busy machine changes nothing.

use crate::setup::busy::unless_busy;
use crate::setup::process::start;
use crate::setup::referee::RefereeHand;
use serde_json::Value;
use std::thread::sleep;
use std::time::Duration;

const STEP: Duration = Duration::from_millis(50);

/// The states of a finger, each once until it changes, without what is unknown.
fn told(lines: &[Value], finger: &str) -> Vec<String> {
    let of = |line: &Value| {
        let fingers = line["grip"]["fingers"].as_array()?;
        let own = fingers.iter().find(|own| own["finger"] == finger)?;
        own["state"].as_str().map(str::to_owned)
    };
    let mut states: Vec<String> = lines.iter().filter_map(of).collect();
    states.retain(|state| state != "unknown");
    states.dedup();
    states
}

/// In equal steps from one value to another.
fn ramp(hand: &mut RefereeHand, key: &str, (from, to): (f64, f64), steps: u32) {
    for step in 1..=steps {
        let now = from + (to - from) * f64::from(step) / f64::from(steps);
        hand.send(&format!("set {key} {now:.3}"));
        sleep(STEP);
    }
}

#[test]
fn the_grip_of_the_referee_hand_is_what_happens_to_its_objects() {
    unless_busy(|| {
        let keys = ["only=index,middle", "contact=500", "k=6", "zero=40"];
        let Some(mut hand) = RefereeHand::start(11, &keys) else {
            return;
        };
        let endpoint = hand.endpoint();
        let mut watch = start(&["watch", "--hand", &endpoint, "--for", "16", "--json"]);
        watch.until(|line| line.contains("\"grip\""));
        sleep(Duration::from_millis(500));
        hand.send("speed 300");
        hand.send("force 400");
        hand.send("angle 300 300 300 300 1000 1000");
        // Friction of the little finger grows as it bends.
        ramp(&mut hand, "little dz", (0.0, 87.0), 30);
        sleep(Duration::from_secs(1));
        ramp(&mut hand, "index dz", (0.0, 75.0), 20);
        ramp(&mut hand, "all dir", (90.0, 200.0), 20);
        sleep(Duration::from_secs(1));
        ramp(&mut hand, "middle shear", (0.2, 0.55), 40);
        hand.send("set middle gone 1");
        hand.send("set index gone 1");
        let lines = watch.end().ok().lines();
        let [little, ring, middle, index] =
            ["little", "ring", "middle", "index"].map(|finger| told(&lines, finger));
        let all = format!("{little:?} {ring:?} {middle:?} {index:?}");
        assert!(!little.contains(&"holding".to_owned()), "{all}");
        assert_eq!(ring, ["open", "moving", "empty"], "{all}");
        assert_eq!(index, ["open", "moving", "holding", "lost"], "{all}");
        // It may hold again for a moment between two steps of the slip.
        let slipped = middle.iter().position(|state| state == "slipping");
        let lost = middle.iter().position(|state| state == "lost");
        assert!(
            slipped.zip(lost).is_some_and(|(slip, lost)| slip < lost),
            "{all}"
        );
        assert_eq!(middle.last().map(String::as_str), Some("lost"), "{all}");
    });
}
