//! Pictures and label lists as files, made without a display.

use crate::setup::process::run;
use serde_json::Value;
use std::fs;

const VIEWS: [&str; 13] = [
    "live",
    "touch",
    "tune",
    "compare",
    "faults",
    "poses",
    "device",
    "checkup",
    "connection",
    "inputs",
    "traffic",
    "sessions",
    "window",
];

fn names(list: &str) -> String {
    let list: Vec<Value> = serde_json::from_str(list).unwrap();
    list.iter()
        .map(|entry| format!("{}|", entry["name"]))
        .collect()
}

#[test]
fn two_runs_give_equal_bytes_for_every_view() {
    let folder = tempfile::tempdir().unwrap();
    let [one, other] = ["one", "other"].map(|name| {
        let out = folder.path().join(name);
        let args = [
            "snapshot",
            "--scenario",
            "grasp",
            "--at",
            "1",
            "--view",
            "all",
            "--size",
            "1024x640",
            "--out",
        ];
        let ended = run(&[&args[..], &[out.to_str().unwrap()]].concat()).ok();
        assert_eq!(ended.out.lines().count(), 2 * VIEWS.len());
        assert_eq!(
            ended.out.lines().next().unwrap(),
            out.join("live.png").to_str().unwrap()
        );
        out
    });
    for view in VIEWS {
        for kind in ["png", "json"] {
            let file = format!("{view}.{kind}");
            let (one, other) = (
                fs::read(one.join(&file)).unwrap(),
                fs::read(other.join(&file)).unwrap(),
            );
            assert!(one == other, "{file}");
        }
        let labels = names(&fs::read_to_string(one.join(format!("{view}.json"))).unwrap());
        assert!(labels.contains("STOP"), "{view}: {labels}");
        assert!(labels.contains("SIMULATED"), "{view}: {labels}");
    }
}

#[test]
fn size_scale_theme_language_and_seed_are_what_was_asked() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        let args = [
            "snapshot",
            "--at",
            "0.2",
            "--size",
            "800x500",
            "--out",
            out.to_str().unwrap(),
        ];
        run(&[&args[..], more].concat()).ok();
        (
            fs::read(out.join("window.png")).unwrap(),
            fs::read_to_string(out.join("window.json")).unwrap(),
        )
    };
    let (plain, english) = draw("plain", &[]);
    // The header of a PNG file: width and height after sixteen bytes.
    assert_eq!(plain[16..24], [0, 0, 3, 32, 0, 0, 1, 244]);
    let (large, _) = draw("large", &["--scale", "2"]);
    assert_eq!(large[16..24], [0, 0, 6, 64, 0, 0, 3, 232]);
    let (light, _) = draw("light", &["--theme", "light"]);
    assert!(light != plain);
    let (_, chinese) = draw("chinese", &["--lang", "zh"]);
    assert!(chinese != english);
    let (seeded, _) = draw("seeded", &["--seed", "2"]);
    assert!(seeded != plain);
}

#[test]
fn one_command_draws_every_theme_and_language() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let draw = |name: &str, more: &[&str]| {
        let head = [
            "snapshot", "--at", "0.2", "--view", "live", "--size", "1024x640",
        ];
        run(&[&head[..], &["--out", &out(name)], more].concat()).ok()
    };
    let all = draw("all", &["--theme", "all", "--lang", "all"]);
    let files: Vec<_> = all
        .out
        .lines()
        .map(|line| line.rsplit('/').next().unwrap())
        .collect();
    let wanted = [
        "live.png",
        "live.json",
        "live-light.png",
        "live-zh.png",
        "live-zh.json",
        "live-zh-light.png",
    ];
    assert_eq!(files, wanted);
    for (file, theme, lang) in [
        ("live", "dark", "en"),
        ("live-light", "light", "en"),
        ("live-zh", "dark", "zh"),
        ("live-zh-light", "light", "zh"),
    ] {
        draw("one", &["--theme", theme, "--lang", lang]);
        let one = fs::read(folder.path().join("one/live.png")).unwrap();
        let of_all = fs::read(folder.path().join(format!("all/{file}.png"))).unwrap();
        assert!(one == of_all, "{file} is as if it were drawn alone");
    }
    for list in ["live", "live-zh"] {
        let of_all = fs::read(folder.path().join(format!("all/{list}.json"))).unwrap();
        let lang = if list == "live" { "en" } else { "zh" };
        draw("light", &["--theme", "light", "--lang", lang]);
        let light = fs::read(folder.path().join("light/live.json")).unwrap();
        assert!(of_all == light, "{list}: the themes share one list");
    }
}

#[test]
fn a_card_is_drawn_over_the_view_the_same_in_every_run() {
    let folder = tempfile::tempdir().unwrap();
    for (card, words) in [
        ("keep", ["Keep the change?", "Goes back by itself in 13 s"]),
        ("danger", ["Apply defaults that hit hard?", "Apply anyway"]),
        ("exhibit", ["Your turn", "Play time left"]),
        (
            "exhibit-pin",
            ["Choose a PIN: 4 to 8 digits", "Digits typed"],
        ),
    ] {
        let draw = |name: &str| {
            let out = folder.path().join(name).to_str().unwrap().to_owned();
            let args = [
                "snapshot",
                "--scenario",
                "idle",
                "--at",
                "1",
                "--view",
                "device",
                "--size",
                "1024x640",
                "--card",
                card,
                "--out",
                &out,
            ];
            run(&args).ok();
            let read = |kind: &str| fs::read(format!("{out}/card-{card}.{kind}")).unwrap();
            (read("png"), String::from_utf8(read("json")).unwrap())
        };
        let (one, list) = draw("one");
        for words in words {
            assert!(list.contains(words), "{words}");
        }
        assert!(draw("other") == (one, list), "{card}");
    }
}

#[test]
fn a_card_that_would_write_to_a_real_hand_is_not_drawn_over_one() {
    for card in ["keep", "danger", "exhibit"] {
        let hand = "rs485:/nowhere/hand";
        let args = [
            "snapshot", "--hand", hand, "--card", card, "--out", "/nowhere",
        ];
        let ended = run(&args);
        assert_eq!(ended.code, Some(2), "{}", ended.err);
        assert!(ended.err.contains("only with the built-in hand"));
    }
}

#[test]
fn a_hand_that_is_not_there_gives_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let ended = run(&[
        "snapshot",
        "--hand",
        "rs485:/nowhere/hand",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.err.contains("/nowhere/hand is not there"),
        "{}",
        ended.err
    );
    assert_eq!(ended.out, "");
    assert!(!out.exists());
}

#[test]
fn a_folder_that_cannot_be_made_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "mine").unwrap();
    let ended = run(&["snapshot", "--at", "0", "--out", file.to_str().unwrap()]);
    assert_eq!(ended.code, Some(1));
    assert!(
        ended.err.contains("cannot make the folder"),
        "{}",
        ended.err
    );
}

#[cfg(unix)]
#[test]
fn a_real_wire_is_drawn_in_real_time() {
    let folder = tempfile::tempdir().unwrap();
    let (_sim, hand) = crate::setup::process::sim_on_tcp(&[]);
    let out = folder.path().to_str().unwrap();
    let ended = run(&["snapshot", "--hand", &hand, "--at", "1.3", "--out", out]).ok();
    assert!(ended.took.as_secs_f64() >= 1.3);
    assert_eq!(ended.err, "");
    let labels = names(&fs::read_to_string(folder.path().join("window.json")).unwrap());
    assert!(!labels.contains("SIMULATED"), "{labels}");
}
