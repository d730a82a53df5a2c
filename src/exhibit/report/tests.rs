#![allow(clippy::unwrap_used, reason = "a test may")]
use crate::exhibit::report::{DayReport, file, page};
use crate::exhibit::stage::ExhibitEvent;
use crate::hand::{Dof, Fault, HandSample, Moment, PerDof, TemperatureReading, Timed};

fn at(second: u64) -> Moment {
    Moment::from_micros(second * 1_000_000)
}

/// The little finger's drive is so warm, read then; the others are at 30 °C.
fn sample(little: u8, second: u64) -> HandSample {
    let mut value = PerDof::splat(TemperatureReading::new(30));
    value[Dof::Little] = TemperatureReading::new(little);
    HandSample {
        temperature: Some(Timed {
            value,
            asked: at(second),
            received: at(second),
        }),
        ..HandSample::default()
    }
}

fn busy_day() -> DayReport {
    let mut report = DayReport::of("2026-11-23");
    report.hands.insert("tcp:10.0.0.9".into());
    for event in [
        ExhibitEvent::Visit,
        ExhibitEvent::Piece("Fist".into()),
        ExhibitEvent::Piece("<b>\"Rock\" & roll".into()),
        ExhibitEvent::Piece("Fist".into()),
        ExhibitEvent::Fault(Fault::Stall),
        ExhibitEvent::Rest,
        ExhibitEvent::Stop,
        ExhibitEvent::Stop,
        ExhibitEvent::LinkLost,
    ] {
        report.count(&event);
    }
    report.warm(&sample(41, 1), 9, at(1));
    report.warm(&sample(61, 2), 10, at(2));
    report
}

#[test]
fn the_highest_temperature_of_each_hour_stays_and_old_or_unknown_ones_do_not_count() {
    let mut report = DayReport::of("2026-11-23");
    for (celsius, read, hour, now) in [
        (41, 1, 9, 1),
        (44, 2, 9, 2),
        (43, 3, 9, 3),
        // Not known to the hand.
        (255, 4, 9, 4),
        (99, 5, 9, 11),
        (42, 20, 10, 25),
        (99, 26, 11, 32),
    ] {
        report.warm(&sample(celsius, read), hour, at(now));
    }
    report.warm(&HandSample::default(), 12, at(33));
    let little = report.hottest.iter();
    let little: Vec<_> = little
        .map(|(hour, all)| (*hour, all[Dof::Little]))
        .collect();
    assert_eq!(little, [(9, Some(44)), (10, Some(42))]);
    report.warm(&sample(255, 40), 13, at(40));
    assert_eq!(report.hottest[&13][Dof::Little], None);
    assert_eq!(report.hottest[&13][Dof::Ring], Some(30));
}

#[test]
fn what_was_counted_before_is_added() {
    let mut report = DayReport::of("2026-11-23");
    report.count(&ExhibitEvent::Visit);
    report.count(&ExhibitEvent::Piece("Fist".into()));
    report.warm(&sample(50, 1), 9, at(1));
    report.warm(&sample(50, 2), 10, at(2));
    report.stops = u32::MAX;
    report.add(&busy_day());
    assert_eq!((report.visits, report.stops), (2, u32::MAX));
    assert_eq!((report.pieces["Fist"], report.faults["stall"]), (3, 1));
    assert_eq!(report.hottest[&9][Dof::Little], Some(50));
    assert_eq!(report.hottest[&10][Dof::Little], Some(61));
    assert!(report.hands.contains("tcp:10.0.0.9"));
    let mut empty = DayReport::of("2026-11-23");
    empty.add(&busy_day());
    assert_eq!(empty, busy_day());
}

#[test]
fn a_report_comes_back_as_it_was_written() {
    for report in [DayReport::of("2026-11-23"), busy_day()] {
        let text = file::write(&report).unwrap();
        assert_eq!(file::read(&text, "2026-11-23").unwrap(), report, "{text}");
    }
    let text = file::write(&busy_day()).unwrap();
    for line in ["visits = 1", "Fist = 2", "hour = 9", "little = 41"] {
        assert!(text.lines().any(|own| own == line), "{line}: {text}");
    }
}

#[test]
fn a_bad_file_is_refused_with_line_and_field() {
    let good = "format = \"handscope-exhibit-day\"\nversion = 1\nday = \"2026-11-23\"\nhands = []\nvisits = 1\nrests = 0\n\
        stops = 0\nlink_losses = 0\n[pieces]\nFist = 1\n[[hour]]\nhour = 9\nlittle = 41\n";
    file::read(good, "2026-11-23").unwrap();
    for (from, to, line, field) in [
        ("-day\"", "\"", 1, "format"),
        ("version = 1", "version = 2", 2, "version"),
        ("2026-11-23", "2026-11-24", 3, "day"),
        ("visits = 1", "visits = -1", 5, "visits"),
        ("visits = 1", "visits = 4294967296", 5, "visits"),
        ("visits = 1", "vists = 1", 5, "vists"),
        ("Fist = 1", "Fist = \"often\"", 10, "Fist"),
        ("hour = 9", "hour = 24", 12, "hour"),
        ("little = 41", "little = 101", 13, "little"),
        ("little = 41", "toe = 41", 13, "toe"),
        ("41\n", "41\n[[hour]]\nhour = 9\n", 15, "hour"),
    ] {
        let bad = good.replacen(from, to, 1);
        let error = file::read(&bad, "2026-11-23").unwrap_err();
        let place = (error.line, error.field.as_deref());
        assert_eq!(place, (Some(line), Some(field)), "{to}: {error}");
    }
    assert!(file::read(&good[..good.len() / 2], "2026-11-23").is_err());
}

#[test]
fn the_page_has_all_figures_escapes_names_and_needs_nothing_from_elsewhere() {
    let page = page::html(&busy_day()).unwrap();
    for part in [
        "<h1>Exhibition, 2026-11-23</h1>",
        "Hand: tcp:10.0.0.9.",
        "<td>Visits</td><td>1</td>",
        "<td>Rests for heat</td><td>1</td>",
        "<td>STOP pressed</td><td>2</td>",
        "<td>Link lost</td><td>1</td>",
        "<td>Fist</td><td>2</td>",
        "<td>stall</td><td>1</td>",
        "<td>9</td><td>41</td><td>30</td>",
        "<td>10</td><td class=\"hot\">61</td><td>30</td>",
        "<th>thumb_rotate</th>",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
    for none in ["<b>", "\"Rock\"", "<script", "http", "src=", "SIMULATED"] {
        assert!(!page.contains(none), "{none}: {page}");
    }
    let mut simulated = DayReport::of("2026-11-23");
    simulated.hands.insert("sim:".into());
    simulated.hottest.insert(3, PerDof::splat(None));
    let page = page::html(&simulated).unwrap();
    for part in ["SIMULATED HAND", "None was played", "<td>3</td><td>-</td>"] {
        assert!(page.contains(part), "{part}: {page}");
    }
}
