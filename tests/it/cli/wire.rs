//! `watch --wire`: frames of the wire as lines, with what is wrong about them.

use crate::setup::process::{run, sim_on_link};

#[test]
fn frames_are_printed_as_json_lines_with_their_meaning() {
    let lines = run(&[
        "watch", "--hand", "sim:", "--wire", "--json", "--for", "0.5",
    ])
    .ok()
    .lines();
    assert!(lines.len() > 20, "{}", lines.len());
    assert_eq!(lines[0]["kind"], "opened");
    for (number, line) in (1_u64..).zip(&lines) {
        assert_eq!(line["number"], number, "{line}");
        assert!(
            line["time_s"].is_number() && line["hex"].is_string(),
            "{line}"
        );
    }
    let values = lines.iter().filter(|line| line["kind"] == "read_reply");
    let mut values = values.filter(|line| line["meaning"].as_str().unwrap().contains("ANGLE_ACT "));
    let reply = values.next().unwrap();
    assert_eq!(
        (&reply["direction"], &reply["id"]),
        (&"from_hand".into(), &1.into())
    );
    assert!(reply["hex"].as_str().unwrap().starts_with("90 EB 01"));
    assert!(reply["took_ms"].is_number() && reply["wrong"].is_null());
}

#[test]
fn requests_without_reply_are_shown_as_such_before_the_command_fails() {
    let folder = tempfile::tempdir().unwrap();
    let (_sim, _url) = sim_on_link(&folder.path().join("hand"), &[]);
    let url = format!("rs485:{}?id=9", folder.path().join("hand").display());
    let ended = run(&["watch", "--hand", &url, "--wire", "--for", "1.5"]);
    assert_eq!(ended.code, Some(1), "{}", ended.out);
    assert!(ended.err.contains("no hand at"), "{}", ended.err);
    assert!(
        ended.out.contains("read          id 9   HAND_ID"),
        "{}",
        ended.out
    );
    assert!(ended.out.contains("!! no reply"), "{}", ended.out);
}
