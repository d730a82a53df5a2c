//! The README and the manual: short, without dead links, and shown by `handscope help`.

use crate::setup::process::take_pipe;
use crate::setup::skipped::skipped;
use handscope::exhibit::file::ExhibitFile;
use handscope::manual::TOPICS;
use std::fs;
use std::io::Read as _;
use std::path::Path;
use std::process::Command;

const README: &str = include_str!("../../README.md");
/// A README is read in one sitting, with all ways to install on its first screen; the rest is in the manual.
const README_MAX_BYTES: usize = 8704;
/// Columns of the narrowest common terminal, which shows the pages line by line.
const COLUMNS: usize = 80;

/// Exit status, standard output, standard error.
fn handscope(args: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_handscope"))
        .args(args)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

#[test]
fn the_readme_is_short_and_its_links_lead_somewhere() {
    assert!(
        README.len() <= README_MAX_BYTES,
        "README.md has {} bytes",
        README.len()
    );
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let targets = README
        .split("](")
        .skip(1)
        .map(|rest| rest.split(')').next().unwrap());
    let mut files = 0;
    for target in targets.filter(|target| !target.starts_with("http")) {
        if let Some(section) = target.strip_prefix('#') {
            let headings = README.lines().filter_map(|line| line.strip_prefix("## "));
            let mut anchors = headings.map(|title| title.to_lowercase().replace(' ', "-"));
            assert!(anchors.any(|anchor| anchor == section), "#{section}");
            continue;
        }
        assert!(root.join(target).exists(), "{target}");
        files += 1;
    }
    assert!(files > TOPICS.len(), "only {files} links");
    for topic in TOPICS {
        assert!(
            README.contains(&format!("(assets/manual/{}.md)", topic.name)),
            "{}",
            topic.name
        );
    }
}

#[test]
fn every_page_is_a_topic_and_fits_a_terminal() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/manual");
    let mut pages: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut topics: Vec<String> = TOPICS
        .iter()
        .map(|topic| format!("{}.md", topic.name))
        .collect();
    pages.sort();
    topics.sort();
    assert_eq!(pages, topics);
    for topic in TOPICS {
        for line in topic.text.lines() {
            assert!(
                line.chars().count() <= COLUMNS,
                "{}.md: too long: {line}",
                topic.name
            );
        }
    }
}

#[test]
fn help_that_is_not_read_to_its_end_is_no_failure() {
    for topic in ["sim", "window"] {
        let (mut child, out) = take_pipe(&["help", topic]);
        drop(out);
        assert_eq!(child.wait().unwrap().code(), Some(0));
        let mut said = String::new();
        let mut messages = child.stderr.take().unwrap();
        messages.read_to_string(&mut said).unwrap();
        assert_eq!(said, "", "{topic}");
    }
}

#[test]
fn help_lists_commands_and_topics_and_shows_every_topic() {
    let (code, all, _) = handscope(&["help"]);
    assert_eq!(code, Some(0));
    assert_eq!(all, handscope(&["--help"]).1);
    for word in ["snapshot", "watch", "params", "Exit status"] {
        assert!(all.contains(word), "{word}");
    }
    for topic in TOPICS {
        assert!(
            all.contains(&format!("  {:9}  {}", topic.name, topic.about)),
            "{}",
            topic.name
        );
        let (code, page, err) = handscope(&["help", topic.name]);
        assert_eq!((code, err.as_str()), (Some(0), ""), "{}", topic.name);
        let title = topic
            .text
            .lines()
            .next()
            .unwrap()
            .strip_prefix("# ")
            .unwrap();
        assert!(page.starts_with(&format!("{title}\n===")), "{page}");
        assert_eq!(handscope(&["help", &topic.name.to_uppercase()]).1, page);
    }
}

#[test]
fn help_of_a_command_is_what_the_command_says_itself() {
    for command in [&["watch"][..], &["params"], &["params", "apply"], &["help"]] {
        let (code, help, err) = handscope(&[&["help"], command].concat());
        assert_eq!((code, err.as_str()), (Some(0), ""), "{command:?}");
        assert_eq!(
            help,
            handscope(&[command, &["--help"]].concat()).1,
            "{command:?}"
        );
        assert!(help.contains("Usage: handscope"), "{help}");
    }
}

#[test]
fn the_help_of_snapshot_names_every_view() {
    let help = handscope(&["snapshot", "--help"]).1;
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    let views = handscope::ui::View::ALL.map(handscope::ui::View::name);
    assert!(help.contains(&format!("({})", views.join(", "))), "{help}");
}

#[test]
fn an_unknown_word_is_wrong_usage_with_one_sentence_and_the_nearest_names() {
    for (words, said) in [
        (&["wirring"][..], "nearest are wiring"),
        (&["whatch"], "nearest are watch"),
        (&["doktor"], "nearest are doctor"),
        (
            &["wiring", "can"],
            "'wiring' is a topic: 'handscope help wiring'",
        ),
    ] {
        let (code, out, err) = handscope(&[&["help"], words].concat());
        assert_eq!((code, out.as_str()), (Some(2), ""), "{words:?}");
        assert_eq!(err.lines().count(), 1, "{err}");
        assert!(
            err.starts_with("handscope: ") && err.contains(said),
            "{err}"
        );
    }
    for words in [&["params", "sav"], &["watch", "tv"]] {
        let (code, out, err) = handscope(&[&["help"][..], words].concat());
        assert_eq!((code, out.as_str()), (Some(2), ""), "{words:?}");
        assert!(err.contains(words[1]), "{err}");
    }
}

#[test]
fn the_poses_of_the_manual_are_a_file_that_is_taken_whole() {
    let page = handscope::manual::topic("files").unwrap().text;
    let section = page.split("## Poses\n").nth(1).unwrap();
    let example = section
        .split("```")
        .nth(1)
        .unwrap()
        .strip_prefix("toml")
        .unwrap();
    let library = handscope::poses::file::read(example).unwrap();
    assert_eq!((library.poses.len(), library.sequences.len()), (2, 1));
}

#[test]
fn the_exhibition_of_the_manual_is_a_file_that_is_taken_whole() {
    let page = handscope::manual::topic("exhibit").unwrap().text;
    let example = page.split("```toml\n").nth(1).unwrap();
    let example = example.split("```").next().unwrap();
    let own = handscope::poses::library::PoseLibrary::default();
    fn read(text: &str) -> ExhibitFile<'_> {
        ExhibitFile::parse(text, Path::new("")).unwrap()
    }
    let plan = read(example).plan(&own).unwrap();
    assert_eq!(plan.tiles.len(), 6);
    assert!(plan.pin.is_some() && plan.attract.is_some());
    assert!(read(example).logo().unwrap().is_some());
    let bare = "format = \"handscope-exhibit\"\nversion = 1\n";
    let line = |key| example.lines().find(|line: &&str| line.starts_with(key));
    let bare = format!(
        "{bare}{}\n[attract]\n{}",
        line("tiles").unwrap(),
        line("pieces").unwrap()
    );
    let usual = read(&bare).plan(&own).unwrap();
    let limits = |plan: &handscope::exhibit::plan::ExhibitPlan| {
        let attract = plan.attract.clone().unwrap();
        let times = [plan.visit, attract.after, attract.play, attract.rest];
        (plan.limits, plan.visitor_restart, times)
    };
    assert_eq!(
        limits(&plan),
        limits(&usual),
        "the example shows what is usual"
    );
}

/// The unit that starts an exhibition with the desktop.
const UNIT: &str = include_str!("../../assets/handscope-exhibit.service");

/// The values of a key in a section of the unit.
fn of_unit(section: &str, key: &str) -> Vec<&'static str> {
    let section = format!("[{section}]");
    let lines = UNIT
        .lines()
        .skip_while(move |line| *line != section)
        .skip(1);
    let lines = lines.take_while(|line| !line.starts_with('['));
    let pairs = lines.filter_map(|line| line.split_once('='));
    pairs
        .filter(|(own, _)| *own == key)
        .map(|(_, value)| value)
        .collect()
}

#[test]
fn the_unit_of_a_booth_starts_it_again_after_a_crash_and_not_after_leaving() {
    for (section, key, value) in [
        ("Unit", "PartOf", "graphical-session.target"),
        ("Unit", "After", "graphical-session.target"),
        ("Unit", "StartLimitIntervalSec", "0"),
        ("Service", "Restart", "on-failure"),
        ("Service", "RestartSec", "2"),
        ("Install", "WantedBy", "graphical-session.target"),
    ] {
        assert_eq!(of_unit(section, key), [value], "{key}");
    }
    assert!(
        of_unit("Service", "Type").is_empty(),
        "it runs until it is left"
    );
    let page = handscope::manual::topic("exhibit").unwrap().text;
    let lines = UNIT.lines().filter(|line| !line.starts_with('#'));
    let unit = lines.collect::<Vec<_>>().join("\n");
    assert!(
        page.contains(&format!("```ini\n{unit}\n```")),
        "the manual shows the same"
    );
}

#[test]
fn the_unit_of_a_booth_starts_what_the_command_line_takes() {
    let [command] = of_unit("Service", "ExecStart")[..] else {
        panic!("{UNIT}")
    };
    let words: Vec<&str> = command.split(' ').collect();
    assert_eq!(
        words,
        ["/usr/local/bin/handscope", "exhibit", "%h/exhibit.toml"]
    );
    let (code, help, _) = handscope(&[words[1], "--help"]);
    assert_eq!(code, Some(0));
    assert!(help.contains("Usage: handscope exhibit"), "{help}");
    // Taken as the name of a file, which is not there.
    let folder = tempfile::tempdir().unwrap();
    let path = words[2].replace("%h", folder.path().to_str().unwrap());
    let (code, _, err) = handscope(&[words[1], &path]);
    assert_eq!(code, Some(1), "{err}");
    assert!(err.contains("exhibit.toml"), "{err}");
}

#[test]
fn systemd_takes_the_unit_of_a_booth() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("handscope-exhibit.service");
    // The program need not be installed where the test runs.
    let unit = UNIT.replace("/usr/local/bin/handscope", env!("CARGO_BIN_EXE_handscope"));
    fs::write(&path, unit).unwrap();
    let verify = Command::new("systemd-analyze")
        .args(["verify", "--user", "--man=no"])
        .arg(&path)
        .env("XDG_RUNTIME_DIR", folder.path())
        .output();
    let Ok(verify) = verify else {
        return skipped("the unit of a booth", "there is no systemd-analyze");
    };
    let told = String::from_utf8_lossy(&verify.stderr);
    let ours: Vec<&str> = told
        .lines()
        .filter(|line| line.contains("handscope-exhibit"))
        .collect();
    assert!(verify.status.success() && ours.is_empty(), "{told}");
    // 9.6 before it was hardened. What needs rights that a user's manager lacks would keep it from starting.
    let security = Command::new("systemd-analyze")
        .args(["security", "--user", "--offline=true", "--threshold=70"])
        .arg(&path)
        .env("XDG_RUNTIME_DIR", folder.path())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&security.stdout);
    assert!(security.status.success(), "{told}");
}
