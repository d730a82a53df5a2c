//! Claims about the traffic view: what passes over the wire is shown, can be held, searched, copied and saved.

use crate::setup::faulty::{FaultOdds, FaultPlan};
use crate::setup::window::{Bench, Role};
use handscope::app::notices::NoticeKind;
use handscope::ui::View;

fn rows(bench: &Bench) -> Vec<String> {
    let rows = bench.all(Role::Row).into_iter();
    rows.map(|(name, _)| name).collect()
}

fn rows_with(bench: &Bench, part: &str) -> usize {
    let rows = rows(bench);
    rows.iter().filter(|name| name.contains(part)).count()
}

fn looking() -> Bench {
    let mut bench = Bench::live();
    bench.show(View::Traffic);
    bench.run(200);
    bench
}

#[test]
fn nothing_is_decoded_until_somebody_looks_and_then_all_that_was_kept() {
    let mut bench = Bench::live();
    assert!(bench.state().hand().connection.traffic.frames().is_empty());
    bench.show(View::Traffic);
    bench.run(100);
    let first = &bench.state().hand().connection.traffic.frames()[0];
    assert_eq!(first.kind.name(), "opened");
    let before = bench.state().hand().connection.traffic.newest();
    bench.run(500);
    assert!(bench.state().hand().connection.traffic.newest() > before + 100);
    assert!(
        rows_with(&bench, "<- Values ANGLE_ACT ") > 0,
        "{:?}",
        rows(&bench)
    );
    assert!(rows_with(&bench, "-> Read ") > 0);
    // Only what is in sight is drawn.
    assert!(rows(&bench).len() < 40);
}

#[test]
fn a_paused_list_stands_still_says_how_many_came_and_goes_on() {
    let mut bench = looking();
    bench.click("Pause the list");
    bench.run(100);
    let held = rows(&bench);
    let newest = bench.state().hand().connection.traffic.newest();
    bench.run(500);
    assert_eq!(rows(&bench), held);
    assert!(bench.state().hand().connection.traffic.newest() > newest + 100);
    assert_eq!(bench.texts_with("came since").len(), 1);
    bench.click("Pause the list");
    bench.run(100);
    assert_ne!(rows(&bench), held);
    assert!(bench.texts_with("came since").is_empty());
}

#[test]
fn the_filter_leaves_only_what_it_names() {
    let mut bench = looking();
    bench.type_into("Filter", "finger");
    bench.run(300);
    let shown = rows(&bench);
    assert!(shown.len() > 5);
    assert!(
        shown.iter().all(|name| name.contains("FINGER")),
        "{shown:?}"
    );
    bench.type_into("Filter", "no such thing");
    bench.run(100);
    assert!(rows(&bench).is_empty());
    assert!(bench.shows("No frame passes the filter."));
    bench.type_into("Filter", "");
    bench.key(egui::Key::Backspace);
    bench.click("To hand");
    bench.run(100);
    assert!(rows(&bench).iter().all(|name| name.contains("->")));
    bench.click("Both ways");
    bench.click("Hide polling");
    bench.run(300);
    assert_eq!(rows_with(&bench, "Values"), 0, "{:?}", rows(&bench));
    assert_eq!(rows_with(&bench, "Wire opened"), 1);
}

#[test]
fn a_wrong_frame_is_shown_with_what_is_wrong_about_it() {
    let mut bench = Bench::live();
    bench.show(View::Traffic);
    bench.click("Only wrong");
    bench.unplug();
    bench.faults(FaultPlan {
        back: FaultOdds {
            corrupt: 0.02,
            ..FaultOdds::default()
        },
        ..FaultPlan::quiet(3)
    });
    bench.plug();
    bench.wait(8000);
    bench.run(200);
    assert!(rows_with(&bench, "Checksum ") > 0, "{:?}", rows(&bench));
    bench.click("Pause the list");
    bench.run(60);
    let row = bench.click_row("Checksum ");
    let words = &row[row.find("Checksum ").unwrap()..];
    let reason = words.split("  (").next().unwrap();
    let said = bench.texts_with(reason);
    assert!(said.iter().any(|text| text == reason), "{reason}: {said:?}");
    let named = bench.texts();
    assert!(
        named.iter().any(|text| text == "Checksum"),
        "the field has a name"
    );
}

#[test]
fn a_chosen_frame_is_explained_byte_by_byte_and_copied_as_hex() {
    let mut bench = looking();
    bench.click("Pause the list");
    bench.run(60);
    assert!(bench.is_disabled(Role::Button, "Copy hex"));
    bench.click_row("Values ANGLE_ACT ");
    for name in [
        "Header", "Hand id", "Length", "Command", "Address", "Checksum",
    ] {
        let named = bench.texts();
        assert!(named.iter().any(|text| text == name), "{name}: {named:?}");
    }
    assert!(!bench.texts_with("Nothing wrong").is_empty());
    // Nothing moves: the simulated hand stands open.
    let values = bench.texts_with("1000 1000 1000 1000 1000 1000");
    assert_eq!(values.len(), 1, "{values:?}");
    let text = bench.click_to_copy("Copy hex").unwrap();
    assert!(text.starts_with("90 EB 01 "), "{text}");
}

#[test]
fn a_frame_is_chosen_wherever_its_row_is_pressed() {
    let mut bench = looking();
    bench.click("Pause the list");
    bench.run(60);
    let rows = bench.all(Role::Row);
    let (name, place) = rows.into_iter().nth(3).unwrap();
    assert!(place.width() > 500.0, "{name} at {place}");
    bench.press_at(place.center());
    bench.release_at(place.center());
    bench.run(60);
    assert!(!bench.is_disabled(Role::Button, "Copy hex"), "{name}");
}

#[test]
fn what_the_list_shows_is_written_to_the_chosen_file() {
    let mut bench = looking();
    bench.type_into("Filter", "finger");
    bench.click("Pause the list");
    bench.run(60);
    let saved = |bench: &Bench| {
        let notices = bench.state().notices.iter();
        let files = notices.filter_map(|notice| match &notice.what {
            NoticeKind::Saved { path, entries } => Some((path.clone(), *entries)),
            _ => None,
        });
        files.collect::<Vec<_>>()
    };
    for (number, name) in [(1, "Export CSV"), (2, "Export JSON")] {
        bench.click(name);
        // The disk keeps real time.
        for _ in 0..500 {
            bench.run(20);
            if saved(&bench).len() == number {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        let (path, entries) = saved(&bench).remove(0);
        assert_eq!(path.parent(), Some(bench.folder()));
        let text = std::fs::read_to_string(&path).unwrap();
        let head = usize::from(number == 1);
        assert_eq!(text.lines().count(), entries + head, "{name}");
        assert!(entries > 5);
        assert!(text.lines().skip(head).all(|line| line.contains("FINGER")));
    }
}

#[test]
fn a_cleared_list_shows_only_what_passes_afterwards() {
    let mut bench = looking();
    let newest = bench.state().hand().connection.traffic.newest();
    bench.click("Clear the list");
    bench.run(60);
    let path_rows = rows(&bench).len();
    assert!(path_rows > 0 && path_rows < 30);
    assert!(bench.state().hand().connection.traffic.newest() > newest);
    assert_eq!(rows_with(&bench, "Wire opened"), 0);
}

#[test]
fn without_a_link_the_view_says_why_it_is_empty() {
    let mut bench = Bench::live();
    bench.show(View::Connection);
    bench.run(60);
    bench.click_button("Disconnect");
    bench.run(900);
    bench.show(View::Traffic);
    bench.run(60);
    assert!(bench.shows("Nothing is connected. Frames appear here as soon as a wire is open."));
    assert!(!bench.is_disabled(Role::Button, "STOP"));
}

#[test]
fn one_frame_is_copied_from_its_menu_also_as_lines_of_a_program() {
    let mut bench = looking();
    bench.click("Pause the list");
    bench.run(60);
    bench.click_row_secondary("Values ANGLE_ACT ");
    let hex = bench.click_to_copy("Hex").unwrap();
    assert!(hex.starts_with("90 EB 01 "), "{hex}");
    bench.click_row_secondary("Values ANGLE_ACT ");
    let python = bench.click_to_copy("Python").unwrap();
    assert!(
        python.contains("import serial") && python.contains("90 EB 01"),
        "{python}"
    );
}
