//! The file for support: what is in it, and whom it does not name.

use crate::setup::busy::unless_busy;
use crate::setup::process::{Ended, handscope, listen, sim_on_link, start};
use crate::setup::recorded::three;
use handscope::record::export::{Destination, ExportSource, cut};
use handscope::record::file::RecordingFile;
use handscope::record::file::reader::TimeRange;
use handscope::transport::Endpoint;
use mcap::MessageStream;
use nix::sys::signal::Signal;
use serde_json::Value;
use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;
use zip::ZipArchive;

const CHECKUP: &str =
    r#"{"at":"2026-11-01T10:00:00Z","hand":"x","figures":[],"report":"@/checked"}"#;

/// A user with a home of their own.
struct User {
    home: PathBuf,
    _folder: tempfile::TempDir,
}

impl User {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let home = folder.path().join("liddell-home");
        fs::create_dir_all(home.join(".config/handscope/checks")).unwrap();
        Self {
            home,
            _folder: folder,
        }
    }

    fn run(&self, args: &[&str]) -> Ended {
        let mut command: Command = handscope();
        command.env("HOME", &self.home).env("USER", "liddell");
        command.env("HANDSCOPE_DOCUMENTS", self.home.join("docs"));
        command.args(args);
        listen(command).end()
    }

    fn store(&self, name: &str, text: &str) {
        let home = self.home.to_str().unwrap();
        let path = self.home.join(".config/handscope").join(name);
        fs::write(path, text.replace('@', home)).unwrap();
    }
}

/// The files of a report by name, in their order.
fn unzipped(path: &Path) -> Vec<(String, Vec<u8>)> {
    let mut zip = ZipArchive::new(File::open(path).unwrap()).unwrap();
    let count = zip.len();
    let read = |nth| {
        let mut file = zip.by_index(nth).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        (file.name().unwrap().into_owned(), bytes)
    };
    (0..count).map(read).collect()
}

/// All bytes of a file; of a recording also those that it compresses.
fn plain(name: &str, bytes: &[u8]) -> Vec<u8> {
    let mut plain = bytes.to_vec();
    if name.ends_with(".mcap") {
        for message in MessageStream::new(bytes).unwrap() {
            plain.extend_from_slice(&message.unwrap().data);
        }
    }
    plain
}

fn holds(bytes: &[u8], word: &str) -> bool {
    let lower = bytes.to_ascii_lowercase();
    let word = word.to_ascii_lowercase();
    lower.windows(word.len()).any(|at| at == word.as_bytes())
}

#[test]
fn a_report_holds_what_it_lists_and_names_neither_home_nor_user() {
    unless_busy(report_of_a_user);
}

fn report_of_a_user() {
    let user = User::new();
    let home = user.home.to_str().unwrap();
    let (_sim, hand) = sim_on_link(&user.home.join("hand"), &["--scenario", "faults"]);
    user.run(&["record", "--hand", &hand, "--for", "2"]).ok();
    user.store(
        "settings.toml",
        "theme = \"light\"\n[recordings]\nfolder = \"@/docs/Handscope\"\n",
    );
    let stem = hand.parse::<Endpoint>().unwrap().file_stem();
    user.store(&format!("checks/{stem}.jsonl"), &[CHECKUP; 6].join("\n"));
    let out = user.home.join("for-support.zip");
    let args = [
        "report",
        "--hand",
        &hand,
        "--for",
        "1",
        "--json",
        "--out",
        out.to_str().unwrap(),
    ];
    let ended = user.run(&args).ok();
    let lines = ended.lines();
    let (listed, written) = (&lines[0]["report"], &lines[1]["written"]);
    assert_eq!(lines.len(), 2);
    assert_eq!(written["bytes"], fs::metadata(&out).unwrap().len());
    assert_eq!(listed["missing"], Value::Array(Vec::new()));
    let files = unzipped(&out);
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let expected = [
        "doctor.txt",
        "doctor.json",
        "faults.json",
        "quirks.toml",
        "now.mcap",
        "recording.mcap",
        "settings.toml",
        "checkups.jsonl",
        "versions.json",
    ];
    assert_eq!(names, expected);
    for (told, (name, bytes)) in listed["files"].as_array().unwrap().iter().zip(&files) {
        assert_eq!(
            (&told["name"], &told["bytes"]),
            (&name.as_str().into(), &bytes.len().into())
        );
        let plain = plain(name, bytes);
        for word in [home, "liddell"] {
            assert!(!holds(&plain, word), "{name} names {word}");
        }
    }
    let text = |wanted: &str| {
        let file = files.iter().find(|(name, _)| name == wanted).unwrap();
        String::from_utf8(file.1.clone()).unwrap()
    };
    let json = |name: &str| -> Value { serde_json::from_str(&text(name)).unwrap() };
    assert_eq!(
        json("doctor.json")["hand"]
            .as_str()
            .unwrap()
            .split('?')
            .next(),
        Some("rs485:~/hand")
    );
    assert_eq!(json("faults.json")["now"].as_array().unwrap().len(), 6);
    let fault = &json("faults.json")["recorded"][0];
    assert!(
        fault["fault"].is_string() && fault["at"].is_string(),
        "{fault}"
    );
    assert!(text("settings.toml").contains("folder = \"~/docs/Handscope\""));
    assert_eq!(text("checkups.jsonl").lines().count(), 4);
    assert_eq!(
        json("versions.json")["handscope"],
        env!("CARGO_PKG_VERSION")
    );
    for name in ["now.mcap", "recording.mcap"] {
        let path = user.home.join(name);
        let (_, bytes) = files.iter().find(|(file, _)| file == name).unwrap();
        fs::write(&path, bytes).unwrap();
        let info = user.run(&["info", "--json", path.to_str().unwrap()]).ok();
        let info = &info.lines()[0];
        assert!(info["states"].as_u64().unwrap() > 20, "{info}");
        assert_eq!(info["writes"], 0, "the hand is only read");
    }
    let again = user.run(&args);
    assert_eq!((again.code, again.out.as_str()), (Some(1), ""));
    assert!(again.err.contains("is not overwritten"), "{}", again.err);
}

#[test]
fn the_last_minute_of_the_newest_recording_is_included_and_its_texts_can_be_rewritten() {
    let user = User::new();
    let [_, _, newest] = three(&user.home.join("others"));
    let folder = user.home.join("docs/Handscope/2026-11-21");
    fs::create_dir_all(&folder).unwrap();
    let file = RecordingFile::open(&newest).unwrap();
    let source = ExportSource::new(&file, TimeRange::WHOLE);
    let to = Destination::Path(folder.join("080000-rs485.mcap"));
    let absent = |text: &str| text.replace("/dev/ttyUSB0", "/no/such/liddell");
    cut::rewrite(source, &to, &absent).unwrap();
    let out = user.home.join("silent.zip");
    let args = [
        "report",
        "--hand",
        "rs485:/no/such/liddell",
        "--out",
        out.to_str().unwrap(),
    ];
    let ended = user.run(&args).ok();
    assert!(
        ended.out.contains("080000-rs485.mcap, at most 60 s"),
        "{}",
        ended.out
    );
    let files = unzipped(&out);
    let (_, bytes) = files
        .iter()
        .find(|(name, _)| name == "recording.mcap")
        .unwrap();
    let path = user.home.join("minute.mcap");
    fs::write(&path, bytes).unwrap();
    let minute = RecordingFile::open(&path).unwrap();
    let hand = &minute.opening().hand;
    assert!(hand.starts_with("rs485:/no/such/USER?"), "{hand}");
    let length = minute.last().since(minute.first()).as_secs_f64();
    assert!((59.8..=60.0).contains(&length), "{length}");
    assert_eq!(minute.last(), file.last());
}

#[test]
fn without_a_file_nothing_is_written_and_a_silent_hand_is_reported_too() {
    let user = User::new();
    let listed = user.run(&["report", "--hand", "sim:", "--for", "0.3"]).ok();
    for words in [
        "now.mcap",
        "recording.mcap",
        "missing:",
        "~, USER and COMPUTER",
    ] {
        assert!(listed.out.contains(words), "{}", listed.out);
    }
    let left: Vec<_> = fs::read_dir(&user.home).unwrap().collect();
    assert_eq!(left.len(), 1, "only the settings folder: {left:?}");
    let out = user.home.join("silent.zip");
    let silent = [
        "report",
        "--hand",
        "rs485:/no/such/port",
        "--json",
        "--out",
        out.to_str().unwrap(),
    ];
    let ended = user.run(&silent).ok();
    let report = &ended.lines()[0]["report"];
    let missing = report["missing"].as_array().unwrap();
    let now = missing
        .iter()
        .find(|one| one["name"] == "now.mcap")
        .unwrap();
    assert_eq!(now["why"], "the hand does not answer");
    let names: Vec<String> = unzipped(&out).into_iter().map(|(name, _)| name).collect();
    assert_eq!(
        names,
        ["doctor.txt", "doctor.json", "faults.json", "versions.json"]
    );
    let nowhere = user.home.join("no/such.zip");
    let ended = user.run(&[
        "report",
        "--hand",
        "sim:",
        "--out",
        nowhere.to_str().unwrap(),
    ]);
    assert_eq!((ended.code, ended.err.lines().count()), (Some(1), 1));
    assert!(ended.err.contains("there is no folder"), "{}", ended.err);
}

#[test]
fn ctrl_c_ends_a_report_at_any_time_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    // The connection is examined for five seconds, then the hand is recorded.
    for after_ms in [800, 7500] {
        let out = folder.path().join("never.zip");
        let args = [
            "report", "--hand", "sim:", "--for", "600", "--json", "--out",
        ];
        let report = start(&[&args[..], &[out.to_str().unwrap()]].concat());
        sleep(Duration::from_millis(after_ms));
        report.signal(Signal::SIGINT);
        let ended = report.end();
        assert_eq!((ended.code, ended.out.as_str()), (Some(1), ""));
        assert!(
            ended.err.contains("\"kind\":\"interrupted\""),
            "{}",
            ended.err
        );
        assert!(!out.exists());
    }
}
