//! Errors for scripts: one JSON object on standard error, with a kind, and the same sentence as for people.

use crate::setup::process::{Ended, run};
use serde_json::{Value, json};

/// The kind and the message of a run that failed.
fn failure(ended: &Ended) -> (String, String) {
    assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    let object: Value = serde_json::from_str(&ended.err).unwrap();
    let error = object["error"].as_object().unwrap();
    assert_eq!((object.as_object().unwrap().len(), error.len()), (1, 2));
    let text = |key: &str| error[key].as_str().unwrap().to_owned();
    (text("kind"), text("message"))
}

#[test]
fn a_failed_command_tells_its_kind_with_json_and_the_same_sentence_without() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (taken, missing) = (path("taken.toml"), path("missing.mcap"));
    std::fs::write(&taken, "mine").unwrap();
    std::fs::write(path("no.mcap"), "no recording").unwrap();
    let nobody = format!("rs485:{}", path("no-port"));
    for (args, code, kind) in [
        (&["read", "HAND_ID", "--hand", &nobody][..], 1, "no_hand"),
        (&["watch", "--hand", &nobody, "--for", "0"], 1, "no_hand"),
        (&["params", "dump", "--hand", &nobody], 1, "no_hand"),
        (&["quirks", "--hand", "sim:", "--out", &taken], 1, "file"),
        (&["info", &missing], 1, "file"),
        (&["info", &path("no.mcap")], 1, "file"),
        (&["params", "diff", &missing, "--hand", "sim:"], 1, "file"),
        (&["import", &missing], 1, "file"),
        (&["report", "--hand", "sim:", "--out", &taken], 1, "file"),
        (
            &["trial", "--hand", "sim:", "--joint", "index"],
            1,
            "not_armed",
        ),
        (&["check", "--hand", "sim:"], 1, "not_armed"),
        (&["grip", "--hand", "sim:", "--gap", "30"], 1, "not_armed"),
        (
            &[
                "hold",
                "--hand",
                "sim:",
                "--at-least",
                "150",
                "--at-most",
                "400",
            ],
            1,
            "not_armed",
        ),
        (
            &["scale", "--hand", "tcp:127.0.0.1:9", "--joint", "index"],
            1,
            "not_armed",
        ),
        (
            &["export", &missing, "--csv", "--fps", "3", "--out", "-"],
            2,
            "wrong_usage",
        ),
    ] {
        let text = run(args);
        let ended = run(&[args, &["--json"]].concat());
        assert_eq!(
            (text.code, ended.code),
            (Some(code), Some(code)),
            "{args:?}"
        );
        let (told, message) = failure(&ended);
        assert_eq!(told, kind, "{args:?}: {message}");
        let sentence = text.err.lines().last().unwrap();
        assert_eq!(sentence, format!("handscope: {message}"), "{args:?}");
        assert!(!ended.out.contains("error\":{\"kind"), "{}", ended.out);
    }
    assert_eq!(std::fs::read_to_string(&taken).unwrap(), "mine");
}

#[test]
fn a_wrong_command_line_is_an_object_too_and_help_is_not() {
    for args in [
        &["watch", "--json"][..],
        &["fly", "--json"],
        &["watch", "--hand", "nonsense", "--json"],
        &["doctor", "--json", "--hand", "sim:", "--for", "soon"],
    ] {
        let ended = run(args);
        assert_eq!((ended.code, ended.out.as_str()), (Some(2), ""), "{args:?}");
        let (kind, message) = failure(&ended);
        assert_eq!(kind, "wrong_usage", "{args:?}");
        assert!(!message.starts_with("error"), "{message}");
    }
    let help = run(&["watch", "--json", "--help"]).ok();
    assert!(help.out.contains("Usage"), "{}", help.out);
    let not_an_option = run(&["info", "--", "--json"]);
    assert!(
        not_an_option.err.starts_with("handscope: "),
        "{}",
        not_an_option.err
    );
}

#[test]
fn a_bad_result_is_no_error_of_another_kind() {
    let ended = run(&[
        "doctor",
        "--json",
        "--hand",
        "rs485:/no/such/port",
        "--for",
        "0.1",
    ]);
    let (kind, message) = failure(&ended);
    assert_eq!(
        (ended.code, kind.as_str()),
        (Some(1), "failed"),
        "{message}"
    );
    assert_eq!(ended.lines()[0]["well"], json!(false));
}
