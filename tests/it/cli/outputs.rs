//! What the program gives out: nobody has to read it, nothing in it controls a terminal, and files of measurements are for the user
//! alone and overwrite nothing.

use crate::setup::process::{Ended, handscope, listen, run, start};
use handscope::record::file::format::topic::Topic;
use mcap::records::MessageHeader;
use nix::sys::signal::Signal;
use std::collections::BTreeMap;
use std::io::{Read as _, Write as _};
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longer than a program takes to notice a signal and give up a reader, on a machine with other work.
const ENDS_WITHIN: Duration = Duration::from_secs(20);

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Fills a pipe of a program until nothing more fits.
fn fill(child: &Child, number: u8) {
    let pipe = format!("/proc/{}/fd/{number}", child.id());
    let mut options = std::fs::OpenOptions::new();
    options.write(true);
    options.custom_flags(nix::fcntl::OFlag::O_NONBLOCK.bits());
    let mut pipe = options.open(pipe).unwrap();
    for size in [4096, 1] {
        while pipe.write_all(&b"\n".repeat(size)).is_ok() {}
    }
}

fn ends_within(child: &mut Child, limit: Duration) -> i32 {
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code().unwrap();
        }
        assert!(begun.elapsed() < limit, "it does not end");
        sleep(Duration::from_millis(20));
    }
}

fn signal(child: &Child, signal: Signal) {
    let id = i32::try_from(child.id()).unwrap();
    nix::sys::signal::kill(nix::unistd::Pid::from_raw(id), signal).unwrap();
}

#[test]
fn a_command_whose_output_is_not_read_ends_at_a_signal() {
    for (args, wanted) in [
        (
            &["watch", "--hand", "sim:", "--json", "--full-rate"][..],
            Signal::SIGINT,
        ),
        (&["watch", "--hand", "sim:", "--wire"], Signal::SIGTERM),
        (&["share", "--hand", "sim:", "--stdio"], Signal::SIGTERM),
    ] {
        let mut child = handscope()
            .args(args)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        sleep(Duration::from_millis(300));
        fill(&child, 1);
        fill(&child, 2);
        sleep(Duration::from_millis(700));
        signal(&child, wanted);
        ends_within(&mut child, ENDS_WITHIN);
    }
}

#[test]
fn results_wait_for_a_reader_that_is_slow() {
    let mut child = handscope()
        .arg("registers")
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut pipe = child.stdout.take().unwrap();
    fill(&child, 1);
    // Nobody wished its end: it waits as long as the reader does.
    sleep(Duration::from_millis(2500));
    assert!(child.try_wait().unwrap().is_none());
    let mut out = Vec::new();
    let mut piece = [0; 512];
    while let Ok(len @ 1..) = pipe.read(&mut piece) {
        out.extend_from_slice(&piece[..len]);
    }
    assert_eq!(ends_within(&mut child, ENDS_WITHIN), 0);
    let whole = run(&["registers"]).ok().out;
    assert_eq!(String::from_utf8(out).unwrap().trim_start(), whole);
}

#[test]
fn results_in_a_file_are_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("registers");
    let file = std::fs::File::create(&path).unwrap();
    let status = handscope().arg("registers").stdout(file).status().unwrap();
    assert!(status.success());
    let whole = run(&["registers"]).ok().out;
    assert_eq!(std::fs::read_to_string(path).unwrap(), whole);
}

#[test]
fn output_that_cannot_be_written_is_a_failure() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full");
    let status = handscope().arg("registers").stdout(full.unwrap()).status();
    assert_eq!(status.unwrap().code(), Some(1));
}

/// A recording of another program whose names try to control the terminal.
fn hostile_recording(path: &Path) {
    let hostile = "\u{1b}]0;owned\u{7}\u{1b}[2J\u{202e}\u{9b}1m\nhandscope: all is well";
    let mut writer = mcap::Writer::new(std::fs::File::create(path).unwrap()).unwrap();
    let none = BTreeMap::new();
    let odd = writer.add_schema(hostile, "ros2msg", b"").unwrap();
    for (nth, topic) in Topic::all().enumerate() {
        let schema = topic.schema();
        let own = writer.add_schema(schema.name, "ros2msg", schema.text.as_bytes());
        // One of them is not what it is called.
        let schema = if nth == 1 { odd } else { own.unwrap() };
        let added = writer.add_channel(schema, topic.name(), "cdr", &none);
        added.unwrap();
    }
    let topic = format!("/{hostile}");
    let channel = writer.add_channel(odd, &topic, "cdr", &none).unwrap();
    let header = MessageHeader {
        channel_id: channel,
        sequence: 1,
        log_time: 1_000_000_000,
        publish_time: 1_000_000_000,
    };
    writer
        .write_to_known_channel(&header, b"\0\x01\0\0")
        .unwrap();
    writer.finish().unwrap();
}

fn is_harmless(ended: &Ended) {
    for text in [&ended.out, &ended.err] {
        let odd = text.chars().find(|letter| {
            letter.is_control() && *letter != '\n' || matches!(letter, '\u{202a}'..='\u{202e}')
        });
        assert_eq!(odd, None, "{text:?}");
        let forged = text.lines().any(|line| line == "handscope: all is well");
        assert!(!forged, "{text}");
    }
}

#[test]
fn names_in_files_of_others_do_not_reach_the_terminal_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hostile.mcap");
    hostile_recording(&path);
    let info = run(&["info", text(&path)]);
    let told = format!("{}{}", info.out, info.err);
    assert!(told.contains("\\u{1b}]0;owned"), "{told}");
    is_harmless(&info);
    let json = run(&["info", "--json", text(&path)]);
    is_harmless(&json);
    is_harmless(&run(&["export", text(&path)]));
    let fixed = folder.path().join("fixed.mcap");
    is_harmless(&run(&["recover", text(&path), "--out", text(&fixed)]));
    let plan = folder.path().join("exhibit.toml");
    let key = "format = \"handscope-exhibit\"\nversion = 1\n\"\\u001b[2J\\u202ex\" = 1\n";
    std::fs::write(&plan, key).unwrap();
    is_harmless(&run(&["exhibit", "--check", text(&plan)]));
}

#[test]
fn a_dump_overwrites_no_file_and_no_link() {
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path().join("records");
    let dump = |path: &Path| {
        let args = ["params", "dump", "--hand", "sim:", "--out", text(path)];
        run(&[&args[..], &["--folder", text(&home)]].concat())
    };
    let path = folder.path().join("dump.toml");
    dump(&path).ok();
    let first = std::fs::read(&path).unwrap();
    let mode = std::fs::metadata(&path).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    let target = folder.path().join("not there");
    let link = folder.path().join("link.toml");
    std::os::unix::fs::symlink(&target, &link).unwrap();
    for taken in [&path, &link] {
        let refused = dump(taken);
        assert_eq!(refused.code, Some(1));
        assert!(
            refused.err.contains("is not overwritten"),
            "{}",
            refused.err
        );
    }
    assert_eq!(std::fs::read(&path).unwrap(), first);
    assert!(!target.exists());
}

#[test]
fn what_is_exported_of_a_private_recording_is_private() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("a.mcap");
    run(&[
        "record",
        "--hand",
        "sim:",
        "--for",
        "1",
        "--out",
        text(&recording),
    ])
    .ok();
    for (kind, name) in [
        ("--csv", "a.csv"),
        ("--parquet", "a.parquet"),
        ("--mcap", "b.mcap"),
    ] {
        let out = folder.path().join(name);
        run(&["export", text(&recording), kind, "--out", text(&out)]).ok();
        let mode = std::fs::metadata(&out).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600, "{name}");
    }
}

#[test]
fn a_recording_beside_a_command_that_fails_is_a_failure() {
    let folder = tempfile::tempdir().unwrap();
    for (args, ready) in [
        (&["share", "--tcp", "127.0.0.1:0"][..], "ready tcp"),
        (&["follow", "--udp", "127.0.0.1:0"], "ready udp"),
    ] {
        let path = folder.path().join(format!("{}.mcap", args[0]));
        let mut command = std::process::Command::new("/bin/sh");
        let limited = "trap '' XFSZ; ulimit -f 16; exec \"$0\" \"$@\"";
        command.args(["-c", limited, env!("CARGO_BIN_EXE_handscope")]);
        command
            .args(args)
            .args(["--hand", "sim:", "--record", text(&path)]);
        command.env("HOME", folder.path()).stdin(Stdio::null());
        let mut running = listen(command);
        running.until(|line| line.starts_with(ready));
        let begun = Instant::now();
        while !running.complaint().contains("cannot be written") {
            assert!(begun.elapsed() < ENDS_WITHIN, "the disk is not full");
        }
        running.signal(Signal::SIGINT);
        let ended = running.end();
        assert_eq!(ended.code, Some(1), "{}", ended.err);
    }
    // One that is whole is none.
    let path = folder.path().join("whole.mcap");
    let mut whole = start(&[
        "share",
        "--hand",
        "sim:",
        "--tcp",
        "127.0.0.1:0",
        "--record",
        text(&path),
    ]);
    whole.until(|line| line.starts_with("ready tcp"));
    whole.signal(Signal::SIGINT);
    whole.end().ok();
}
