//! Files that passed through other programs: recordings whose times were moved, folders of rosbag2, tables of spreadsheets.

use crate::setup::busy::unless_busy;
use crate::setup::process::run;
use crate::setup::skipped::skipped;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn case(name: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let own = root.join("tests/cases").join(name);
    if own.exists() {
        own
    } else {
        root.join("../shared/cases").join(name)
    }
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn info(path: &Path) -> Value {
    run(&["info", text(path), "--json"]).ok().lines().remove(0)
}

/// The times of an exported table.
fn times(path: &Path) -> Vec<f64> {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("a.csv");
    run(&["export", text(path), "--csv", "--out", text(&to)]).ok();
    let table = std::fs::read_to_string(to).unwrap();
    let time = |line: &str| line.split(',').next().unwrap().parse().unwrap();
    table.lines().skip(1).map(time).collect()
}

#[test]
fn recordings_whose_times_were_moved_are_exported_whole() {
    unless_busy(|| {
        for (name, remark, least_s) in [
            (
                "times_an_hour_early.mcap",
                "its log are 3600.000 s before those in its messages",
                1.0,
            ),
            (
                "times_from_zero.mcap",
                "so another program changed them: those of the log are used",
                1.0,
            ),
            ("clock_in_2040.mcap", "", 1.9),
        ] {
            if !case(name).exists() {
                skipped(name, "it is not among the cases beside this checkout");
                continue;
            }
            let about = info(&case(name));
            let remarks = about["remarks"].to_string();
            assert!(remarks.contains(remark), "{name}: {remarks}");
            let states = about["states"].as_u64().unwrap();
            assert!(states > 100, "{name}: {about}");
            assert_eq!(about["missing_s"], 0.0, "{name}: {about}");
            let length = about["length_s"].as_f64().unwrap();
            assert!((least_s..10.0).contains(&length), "{name}: {about}");
            let times = times(&case(name));
            assert!(
                times.len() as u64 >= states,
                "{name}: {} lines of {states}",
                times.len()
            );
            assert!(times.is_sorted() && times[0] < 0.5, "{name}: {times:?}");
            let last = times.last().unwrap();
            assert!((length - last).abs() < 0.5, "{name}: {last} of {length}");
        }
    });
}

#[test]
fn an_export_of_nothing_is_no_success() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        for (form, name) in [("--csv", "a.csv"), ("--parquet", "a.parquet")] {
            let to = folder.path().join(name);
            let file = case("clock_in_2040.mcap");
            let stretch = ["--from", "0.0000001", "--to", "0.0000002"];
            let ended = run(&[
                &["export", text(&file), form, "--out", text(&to)],
                &stretch[..],
            ]
            .concat());
            assert_eq!(ended.code, Some(1), "{}{}", ended.out, ended.err);
            assert!(
                ended.err.contains("there is nothing to export"),
                "{}",
                ended.err
            );
            assert!(!to.exists(), "{name} is left behind");
            let all = folder.path().join("all");
            let two = [
                "export",
                text(&file),
                text(&file),
                form,
                "--out",
                text(&all),
            ];
            let ended = run(&[&two[..], &stretch[..]].concat());
            assert_eq!(ended.code, Some(1), "{}{}", ended.out, ended.err);
            assert!(!all.exists(), "{}", ended.err);
        }
    });
}

#[test]
fn a_folder_of_rosbag2_is_a_recording() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (bag, again) = (folder.path().join("bag"), folder.path().join("again.mcap"));
        let file = case("clock_in_2040.mcap");
        run(&["export", text(&file), "--rosbag", "--out", text(&bag)]).ok();
        let about = info(&bag);
        assert_eq!(about["states"], info(&file)["states"]);
        assert_eq!(times(&bag), times(&file));
        run(&["recover", text(&bag), "--out", text(&again)]).ok();
        assert_eq!(info(&again)["states"], about["states"]);
        std::fs::remove_file(bag.join("metadata.yaml")).unwrap();
        let ended = run(&["info", text(&bag)]);
        assert_eq!(ended.code, Some(1));
        assert!(ended.err.contains("folder"), "{}", ended.err);
    });
}

/// A table made a recording, and what `import` said.
fn import(table: &[u8]) -> (Option<Value>, String) {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("a.csv"), folder.path().join("a.mcap"));
    std::fs::write(&from, table).unwrap();
    let ended = run(&["import", text(&from), "--json"]);
    let made = (ended.code == Some(0)).then(|| info(&to));
    (made, ended.out + &ended.err)
}

#[test]
fn tables_are_read_with_the_separators_and_commas_of_spreadsheets() {
    unless_busy(|| {
        let german = std::fs::read_to_string(case("spreadsheet_de.csv")).unwrap();
        let points = german.replace(',', ".");
        let wanted = import(points.replace(';', ",").as_bytes()).0.unwrap();
        assert_eq!(wanted["states"], 1, "{wanted}");
        let bare = german.trim_start_matches('\u{feff}');
        for (what, table) in [
            ("decimal commas", german.clone()),
            ("points", points.clone()),
            ("tabs", german.replace(';', "\t")),
            ("a named separator", format!("\u{feff}sep=;\r\n{bare}")),
            ("a rare one", format!("sep=|\n{}", bare.replace(';', "|"))),
        ] {
            let (made, words) = import(table.as_bytes());
            let made = made.unwrap_or_else(|| panic!("{what}: {words}"));
            for field in ["states", "touch_sweeps", "length_s"] {
                assert_eq!(made[field], wanted[field], "{what}: {field}");
            }
        }
        let (made, words) = import(bare.replace(';', "|").as_bytes());
        assert!(
            made.is_none() && words.contains("commas, semicolons or tabs"),
            "{words}"
        );
    });
}

#[test]
fn two_takes_in_one_table_are_refused_with_the_line() {
    unless_busy(|| {
        let (made, words) = import(&std::fs::read(case("time_goes_back.csv")).unwrap());
        assert!(made.is_none(), "{words}");
        assert!(
            words.contains("line 61: the time goes back from 0.364 s to 0.000 s"),
            "{words}"
        );
    });
}

#[test]
fn times_since_1970_begin_with_the_first_line() {
    unless_busy(|| {
        let table = "time_s,angle_index\n1790000000.5,1000\n1790000001.75,500\n";
        let (made, words) = import(table.as_bytes());
        assert_eq!(made.unwrap()["length_s"], 1.25, "{words}");
        assert!(words.contains("\"counts_from_1970\":true"), "{words}");
    });
}
