//! What a hand does in its own way, found out by another process over each wire.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, Wires, run, sim_on_all};
use serde_json::{Value, json};

/// A simulated hand with these quirks, on four wires.
fn sim(folder: &tempfile::TempDir, quirks: &[&str]) -> (Running, Wires) {
    let quirks = quirks.iter().flat_map(|quirk| ["--quirk", quirk]);
    sim_on_all(folder.path(), &quirks.collect::<Vec<_>>())
}

#[test]
fn the_same_is_found_over_every_wire() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        for (quirks, packing, gap, touch) in [
            (&[][..], "low-first", "through", "capacitive"),
            (
                &[
                    "byte-words=one-per-word",
                    "gap=refused",
                    "tactile-check=zero",
                ],
                "one-per-word",
                "split",
                "unknown: check sum differs",
            ),
            (
                &["byte-words=high-first"],
                "high-first",
                "through",
                "capacitive",
            ),
        ] {
            let (_sim, wires) = sim(&folder, quirks);
            for hand in wires.all() {
                let ended = run(&["quirks", "--json", "--hand", hand]).ok();
                let mut found: Value = ended.lines().remove(0);
                found.as_object_mut().unwrap().remove("hand");
                let has_words = hand.starts_with("tcp:") || hand.starts_with("rtu:");
                let packing = if has_words {
                    json!(packing)
                } else {
                    Value::Null
                };
                // On CAN each piece is a request of its own, and nobody asks for the gap.
                let gap = if hand.starts_with("slcan:") {
                    Value::Null
                } else {
                    json!(gap)
                };
                // Nor does a sum over pieces of several measurements say anything.
                let touch = match touch {
                    "unknown: check sum differs" if hand.starts_with("slcan:") => "capacitive",
                    touch => touch,
                };
                let expected = json!({
                    "hand_id": 1, "baud_code": 0, "packing": packing, "gap": gap, "touch": touch,
                });
                assert_eq!(found, expected, "{hand} {quirks:?}");
            }
        }
    });
}

#[test]
fn a_sheet_is_printed_with_whose_reading_it_is_and_exported() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let sheet = folder.path().join("hand.toml");
        let (_sim, Wires { tcp, .. }) = sim(&folder, &[]);
        let text = run(&["quirks", "--hand", &tcp, "--out", sheet.to_str().unwrap()])
            .ok()
            .out;
        assert!(
            text.contains("115200 by the manual PRJ-02-TS-U-001 V1.0.0"),
            "{text}"
        );
        let again = run(&["quirks", "--hand", &tcp, "--out", sheet.to_str().unwrap()]);
        assert_eq!(again.code, Some(1));
        assert!(again.err.contains("is not overwritten"), "{}", again.err);
        let sheet: toml::Table = std::fs::read_to_string(&sheet).unwrap().parse().unwrap();
        assert_eq!(sheet["version"].as_integer(), Some(1));
        assert_eq!(sheet["hand"][0]["packing"].as_str(), Some("low-first"));
        assert_eq!(sheet["hand"][0]["place"].as_str(), tcp.split('?').next());
    });
}
