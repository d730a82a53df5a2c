//! The plots of the running program: what is saved, and what a note leaves behind.

use crate::setup::window::{Bench, LARGE, Role};
use handscope::app::notices::NoticeKind;
use handscope::history::MarkKind;
use handscope::sim::SimConfig;
use std::path::PathBuf;

/// Presses an entry of the menu and waits for the file.
fn saved(bench: &mut Bench, entry: &str) -> (PathBuf, usize) {
    bench.click("More for the plots");
    bench.run(60);
    bench.click(entry);
    for _ in 0..200 {
        bench.run(20);
        // Files are written on a thread of their own, in real time.
        std::thread::yield_now();
        let found = bench
            .state()
            .notices
            .iter()
            .find_map(|notice| match &notice.what {
                NoticeKind::Saved { path, entries } => Some((path.clone(), *entries)),
                _ => None,
            });
        if let Some(found) = found {
            return found;
        }
    }
    panic!("nothing was saved");
}

#[test]
fn what_the_plots_show_is_saved_as_csv_and_as_png_while_the_window_goes_on() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.wait(2000);
    let before = bench.now();
    let (path, rows) = saved(&mut bench, "Save these 10 s as CSV");
    assert!(bench.now() > before && rows > 150, "{rows}");
    let csv = std::fs::read_to_string(path).unwrap();
    assert!(csv.starts_with("time_s,") && csv.contains("force_index_g"));
    assert_eq!(csv.lines().count(), 1 + rows);

    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.wait(2000);
    let (path, _) = saved(&mut bench, "Save as PNG");
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    let (width, height) = (reader.info().width, reader.info().height);
    assert!(width > 800 && height > 600, "{width} x {height}");
    assert_eq!(bench.writes().len(), 0);
}

#[test]
fn a_note_is_kept_in_the_history() {
    let mut bench = Bench::live();
    bench.key(egui::Key::N);
    bench.run(60);
    bench.type_into("Words of the note", "before the squeeze");
    bench.click("Keep");
    bench.run(60);
    let now = bench.now().secs();
    let note = MarkKind::note("before the squeeze").unwrap();
    let marks = bench.state().hand().measured.history.marks(now - 2.0, now);
    assert_eq!(marks.filter(|mark| mark.kind == note).count(), 1);
}

#[test]
fn notes_are_listed_shown_by_a_click_and_deleted() {
    let mut bench = Bench::live();
    bench.key(egui::Key::N);
    bench.run(60);
    bench.type_into("Words of the note", "before the squeeze");
    bench.click("Keep");
    bench.wait(20_000);
    let listed = |bench: &Bench| {
        let mut all = bench.all(Role::Button).into_iter().map(|(name, _)| name);
        all.rfind(|name| name.ends_with("  before the squeeze"))
    };
    assert_eq!(listed(&bench), None, "only in the menu");
    bench.click("More for the plots");
    bench.run(60);
    let name = listed(&bench).unwrap();
    bench.click_button(&name);
    bench.run(200);
    assert!(bench.is_on("Pause the plots"), "the plots stand there");
    bench.click("More for the plots");
    bench.run(60);
    bench.click_button("Delete the note: before the squeeze");
    bench.run(200);
    assert_eq!(listed(&bench), None);
    let history = &bench.state().hand().measured.history;
    let mut marks = history.marks(0.0, bench.now().secs());
    assert!(!marks.any(|mark| matches!(mark.kind, MarkKind::Note(_))));
    assert_eq!(bench.writes(), []);
}

#[test]
fn a_hand_that_is_disarmed_is_marked_in_the_plots() {
    let mut bench = Bench::armed();
    let marks = |bench: &Bench| -> Vec<String> {
        let history = &bench.state().hand().measured.history;
        history
            .marks(0.0, 1e9)
            .map(|mark| mark.kind.words())
            .collect()
    };
    bench.click("Disarm the hand");
    bench.run(200);
    assert_eq!(marks(&bench), ["armed", "disarmed"]);
    bench.click("Arm the hand");
    bench.run(200);
    bench.click_button("STOP");
    bench.run(1000);
    let all = marks(&bench);
    assert_eq!(
        all[2..4],
        ["armed", "stop"],
        "a stop says it itself: {all:?}"
    );
}
