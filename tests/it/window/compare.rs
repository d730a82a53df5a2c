//! Claims about comparing trials: what was measured on the simulated hand is shown, sorted, saved, read back, promoted.

use crate::setup::window::{Bench, Role};
use crate::window::tune::{arm, enter, finish, on_block, short};
use handscope::app::trials::SessionOrigin;
use handscope::ui::View;
use std::path::PathBuf;

/// Two speeds, tried on the block, on the view that compares them.
fn tried() -> Bench {
    let mut bench = on_block();
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "25, 250");
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    bench.show(View::Compare);
    bench
}

fn over(bench: &Bench, number: usize) -> f64 {
    bench.reading(&format!("{number} Over, g")).parse().unwrap()
}

/// The folder that the session was saved to.
fn save(bench: &mut Bench) -> PathBuf {
    bench.click("Save session");
    bench.until(5000, |bench| {
        let session = &bench.state().trials.sessions[0];
        matches!(&session.origin, SessionOrigin::Saved(_))
    });
    match &bench.state().trials.sessions[0].origin {
        SessionOrigin::Saved(folder) => folder.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn before_anything_was_tried_it_says_what_to_do() {
    let mut bench = on_block();
    bench.show(View::Compare);
    assert!(bench.shows("Nothing tried yet"));
    assert!(bench.buttons_with("Save session").is_empty());
    assert!(!bench.is_disabled(Role::Button, "Open an earlier session"));
}

#[test]
fn what_was_measured_stands_in_the_table_and_sorts() {
    let mut bench = tried();
    assert!(over(&bench, 1) < 150.0 && over(&bench, 2) > 350.0);
    assert!(bench.reading("1 Peak, g").parse::<f64>().unwrap() > 450.0);
    let rows = |bench: &Bench| -> Vec<String> {
        bench
            .all(Role::Row)
            .into_iter()
            .map(|(name, _)| name)
            .collect()
    };
    assert!(rows(&bench)[0].starts_with("1  25 / 500 g"));
    bench.click("Over, g");
    bench.click("Over, g");
    bench.run(60);
    assert!(rows(&bench)[0].starts_with("2  250 / 500 g"));
    bench.click_row("1  25 / 500 g");
    for quantity in ["Angle", "Current, mA", "Touch, N", "Force, g"] {
        bench.click_button(quantity);
        bench.run(60);
        assert!(!bench.shows("No samples to draw"), "{quantity}");
    }
    bench.click("From command");
    bench.run(60);
    assert!(!bench.shows("No samples to draw"));
}

#[test]
fn the_gentle_setting_is_best_until_it_must_hold_more() {
    let mut bench = tried();
    assert_eq!(bench.reading("Best"), "25 / 500 g");
    enter(&mut bench, "Holds at least, g", "4000");
    assert_eq!(bench.reading("Best"), "No setting will do.");
    assert!(bench.is_disabled(Role::Button, "Make it the default"));
}

#[test]
fn heads_explain_themselves() {
    let mut bench = tried();
    let head = bench.rect(Role::Button, "Over, g");
    bench.point(head.center());
    bench.run(1000);
    let told = bench.texts_with("Overshoot: highest force above the threshold.");
    assert_eq!(told.len(), 1);
}

#[test]
fn a_saved_session_is_read_back_with_its_curves() {
    let mut bench = tried();
    enter(&mut bench, "Note", "a block");
    let folder = save(&mut bench);
    for file in [
        "session.toml",
        "trial-001.csv",
        "trial-002.csv",
        "report.html",
    ] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    let own: Vec<f64> = vec![over(&bench, 1), over(&bench, 2)];
    for file in std::fs::read_dir(&folder).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), bench.folder().join(file.file_name())).unwrap();
    }
    bench.click("Open");
    bench.until(5000, |bench| bench.state().trials.sessions.len() == 2);
    bench.run(60);
    let read = &bench.state().trials.sessions[1];
    assert_eq!(read.head.note, "a block");
    assert_eq!(
        read.trials[0].lines,
        bench.state().trials.sessions[0].trials[0].lines
    );
    assert_eq!(vec![over(&bench, 1), over(&bench, 2)], own);
    assert!(
        bench.is_disabled(Role::Button, "Save session"),
        "it has its files"
    );
    bench.click_button("Session 1");
    bench.run(60);
    assert!(!bench.is_disabled(Role::Button, "Save session"));
}

/// The session that was run, and the same read from files in which something was changed.
fn with_another(from: &str, to: &str) -> Bench {
    let mut bench = tried();
    let folder = save(&mut bench);
    for file in ["session.toml", "trial-001.csv", "trial-002.csv"] {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let text = text.replacen(from, to, 1);
        std::fs::write(bench.folder().join(file), text).unwrap();
    }
    bench.click("Open");
    bench.until(5000, |bench| bench.state().trials.sessions.len() == 2);
    bench.run(60);
    bench
}

fn rows(bench: &Bench) -> Vec<String> {
    let rows = bench.all(Role::Row).into_iter();
    rows.map(|(name, _)| name).collect()
}

#[test]
fn sessions_lie_over_each_other_and_their_trials_are_told_apart() {
    let mut bench = with_another("", "");
    assert_eq!(rows(&bench).len(), 2, "what was opened is shown alone");
    assert!(bench.is_disabled(Role::CheckBox, "Show Session 2"));
    bench.click("Show Session 1");
    bench.run(60);
    let both = [
        "1: 1  25 / 500 g  Index",
        "2: 1  25 / 500 g  Index",
        "1: 2  250 / 500 g  Index",
        "2: 2  250 / 500 g  Index",
    ];
    assert_eq!(rows(&bench), both);
    assert_eq!(bench.reading("1: 2 Over, g"), bench.reading("2: 2 Over, g"));
    for key in ["25 / 500 g", "250 / 500 g"] {
        assert!(bench.shows(key), "the legend names {key}");
    }
    bench.click_row("2: 2  250");
    assert!(bench.shows("Session 2  Trial 2  250 / 500 g  Index"));
    bench.click("Over, g");
    bench.click("Over, g");
    bench.run(60);
    assert!(rows(&bench)[1].contains("2  250") && rows(&bench)[3].contains("1  25"));
    assert!(bench.shows("Over all sessions shown"));
    bench.click("Show Session 2");
    bench.run(60);
    assert_eq!(rows(&bench).len(), 2);
    assert!(over(&bench, 1) < 150.0);
}

#[test]
fn sessions_that_were_not_alike_say_so_and_are_judged_apart() {
    let mut bench = with_another("dwell_s = 0.5", "dwell_s = 2.5");
    bench.click("Show Session 1");
    bench.run(60);
    assert!(bench.shows("Session 2 alone: the sessions differ in time held"));
    assert_eq!(rows(&bench).len(), 4, "they are drawn all the same");
    bench.click_button("Session 1");
    bench.run(60);
    assert!(bench.shows("Session 1 alone: the sessions differ in time held"));
    assert_eq!(rows(&bench).len(), 4);
}

#[test]
fn every_column_sorts_and_shows_which_way() {
    let mut bench = with_another("Force reached", "Force reached");
    bench.click("Show Session 1");
    bench.run(60);
    let way = |bench: &Bench, column: &str| bench.value(Role::Button, column);
    assert_eq!(way(&bench, "Trial"), "rising");
    for column in ["Over, g", "Heat, \u{b0}C", "End", "Trial"] {
        bench.click_button(column);
        bench.run(60);
        let before = way(&bench, column);
        bench.click_button(column);
        bench.run(60);
        let ways = [before, way(&bench, column)];
        assert_eq!(ways, ["rising", "falling"], "{column}");
    }
}

#[test]
fn the_end_of_trials_sorts_by_its_words() {
    let mut bench = on_block();
    short(&mut bench);
    enter(&mut bench, "Speeds to try", "25, 250");
    enter(&mut bench, "Force limit, g", "700");
    arm(&mut bench);
    bench.click("Start trials");
    finish(&mut bench, 60_000);
    bench.show(View::Compare);
    let first = |bench: &Bench| rows(bench)[0].chars().next().unwrap();
    bench.click_button("End");
    bench.run(60);
    assert_eq!(first(&bench), '1', "Force reached");
    bench.click_button("End");
    bench.run(60);
    assert_eq!(first(&bench), '2', "Index presses harder than the ceiling");
}

#[test]
fn forgetting_what_is_in_no_file_asks_first() {
    let mut bench = tried();
    bench.click("Forget");
    bench.run(60);
    assert!(bench.shows("Forget this session?") && bench.texts_with("Trials: 2").len() == 1);
    bench.click("Leave it");
    bench.run(60);
    assert_eq!(bench.state().trials.sessions.len(), 1);
    assert!(!bench.shows("Forget this session?"));
    bench.click("Forget");
    bench.run(60);
    bench.click("Forget it");
    bench.run(60);
    assert!(bench.state().trials.sessions.is_empty());
    assert!(bench.shows("Nothing tried yet"));
    assert!(bench.buttons_with("Forget").is_empty());
}

#[test]
fn forgetting_what_is_in_files_leaves_the_files() {
    let mut bench = tried();
    let folder = save(&mut bench);
    bench.click("Forget");
    bench.run(60);
    assert!(bench.state().trials.sessions.is_empty());
    assert!(folder.join("session.toml").is_file());
}

#[test]
fn the_folder_of_a_session_can_be_typed() {
    let mut bench = tried();
    let folder = save(&mut bench);
    bench.click("Open");
    bench.run(400);
    assert_eq!(bench.texts_with("was not used:").len(), 2);
    bench.type_into("Path of the file", &folder.display().to_string());
    bench.key(egui::Key::Enter);
    bench.until(5000, |bench| bench.state().trials.sessions.len() == 2);
    bench.run(60);
    assert!(!bench.shows("Path of the file"));
}

#[test]
fn a_bad_session_is_refused_whole_with_one_sentence() {
    let mut bench = tried();
    let folder = save(&mut bench);
    for file in ["session.toml", "trial-001.csv"] {
        std::fs::copy(folder.join(file), bench.folder().join(file)).unwrap();
    }
    let table = bench.folder().join("trial-001.csv");
    let text = std::fs::read_to_string(&table).unwrap();
    std::fs::write(&table, text.replacen(",close", ",shut", 1)).unwrap();
    let toml = bench.folder().join("session.toml");
    for (spoilt, words) in [
        (false, "'shut' is not a valid event"),
        (true, "session.toml"),
    ] {
        if spoilt {
            std::fs::write(&toml, "format = 7").unwrap();
        }
        bench.click("Open");
        bench.run(400);
        let told: Vec<String> = bench
            .state()
            .notices
            .iter()
            .map(|one| format!("{:?}", one.what))
            .collect();
        let refused = told.iter().rev().find(|told| told.contains("Refused"));
        assert!(refused.is_some_and(|told| told.contains(words)), "{told:?}");
        assert_eq!(
            bench.state().trials.sessions.len(),
            1,
            "nothing of it is taken"
        );
        let said = bench.texts_with("was not used:");
        assert_eq!(said.len(), 2, "the view says it, and the line of messages");
    }
}
