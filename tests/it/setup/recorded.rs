//! Recording files with fixed dates and hand-made readings, for pictures and lists.

use handscope::app::recordings::{RecordingAbout, RecordingNote};
use handscope::hand::kinematics::Side;
use handscope::hand::*;
use handscope::link::LinkStatus;
use handscope::record::file::{Opening, PART_LENGTH, Recorder, RecordingPlan, SystemDisk};
use handscope::record::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

const HAND: &str = "rs485:/dev/ttyUSB0?baud=115200&id=1";
/// Sunday, 1 November 2026, 08:00 UTC.
const FIRST_DAY_S: u64 = 1_793_520_000;
const DAY_S: u64 = 24 * 3600;
const TICK_MS: u64 = 50;

/// One recording of a day.
struct Script {
    day: u64,
    seconds: u64,
    /// The second in which the index finger has a fault.
    fault_at: Option<u64>,
    about: RecordingAbout,
}

fn timed<T>(value: T, at: Moment) -> Option<Timed<T>> {
    Some(Timed {
        value,
        asked: at,
        received: at,
    })
}

/// A slow grasp, again and again.
fn reading(at: Moment, is_faulty: bool) -> Entry {
    let t = at.secs();
    let wave = |dof: Dof| (((t * 0.8 + dof.index() as f64 * 0.4).sin() + 1.0) / 2.0).powi(2);
    let whole = |value: f64| value as i16;
    let fault = |dof: Dof| u8::from(is_faulty && dof == Dof::Index);
    let sample = HandSample {
        angle: timed(
            PerDof::from_fn(|dof| AngleReading::new(whole(1000.0 - 700.0 * wave(dof)))),
            at,
        ),
        force: timed(
            PerDof::from_fn(|dof| ForceReading::new(whole(wave(dof).powi(2) * 600.0))),
            at,
        ),
        current: timed(
            PerDof::from_fn(|dof| CurrentReading::new(whole(wave(dof) * 280.0))),
            at,
        ),
        temperature: timed(PerDof::splat(TemperatureReading::new(31)), at),
        status: timed(PerDof::splat(Status::from_raw(1)), at),
        faults: timed(PerDof::from_fn(|dof| Faults::from_raw(fault(dof))), at),
        ..HandSample::default()
    };
    let fresh = Groups::from_iter([
        Group::Angle,
        Group::Force,
        Group::Current,
        Group::Temperature,
        Group::Status,
        Group::Faults,
    ]);
    Entry::Heard(Record::Reading {
        sample: Arc::new(sample),
        fresh,
    })
}

fn write(folder: &Path, script: &Script) -> PathBuf {
    let day_s = FIRST_DAY_S + script.day * DAY_S;
    let day = format!("2026-11-{:02}", script.day + 1);
    let path = folder.join(day).join("080000-rs485-ttyUSB0.mcap");
    let recorder = Recorder::start(RecordingPlan {
        path: path.clone(),
        opening: Opening {
            base_nanos: day_s * 1_000_000_000,
            began: Moment::ZERO,
            hand: HAND.into(),
            simulated: false,
            side: Side::Right,
            newtons_per_g: PerDof::splat(None),
            version: "test".into(),
            part: None,
        },
        disk: Arc::new(SystemDisk),
        part_length: PART_LENGTH,
    })
    .unwrap();
    let input = recorder.input();
    let begun = Moment::from_micros(1000);
    let status = LinkStatus {
        state: LinkState::Monitoring,
        since: begun,
        rest: Rest::Resting,
        ..LinkStatus::default()
    };
    input.push(Entry::Link(LinkReport {
        at: begun,
        state: status.state,
        trouble: String::new(),
        status: serde_json::to_string(&status).unwrap(),
        figures: String::new(),
    }));
    for tick in 1..=script.seconds * 1000 / TICK_MS {
        let at = Moment::from_duration(Duration::from_millis(tick * TICK_MS));
        let second = tick * TICK_MS / 1000;
        let is_faulty = script.fault_at.is_some_and(|fault| fault == second);
        input.push(reading(at, is_faulty));
    }
    let _ended = recorder.end();
    script.about.save(&path).unwrap();
    path
}

/// Three recordings: one with a star, one with a name and a fault, one with notes. The paths, the oldest first.
pub(crate) fn three(folder: &Path) -> [PathBuf; 3] {
    let note = |second: u64, words: &str| RecordingNote {
        at_micros: second * 1_000_000,
        words: words.into(),
    };
    let scripts = [
        Script {
            day: 0,
            seconds: 45,
            fault_at: None,
            about: RecordingAbout {
                star: true,
                ..RecordingAbout::default()
            },
        },
        Script {
            day: 2,
            seconds: 30,
            fault_at: Some(12),
            about: RecordingAbout {
                name: "Old finger, hard sponge".into(),
                ..RecordingAbout::default()
            },
        },
        Script {
            day: 20,
            seconds: 125,
            fault_at: None,
            about: RecordingAbout {
                notes: Some(vec![note(20, "first contact"), note(70, "slipped")]),
                ..RecordingAbout::default()
            },
        },
    ];
    scripts.map(|script| write(folder, &script))
}
