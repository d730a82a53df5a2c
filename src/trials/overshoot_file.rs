//! Overshoots measured in trials of one hand, in a file per hand: lines of JSON, each with closes of one kind.

use crate::hand::Status;
use crate::hand::overshoot::{CloseKind, MeasuredCloses, OvershootMap, Stages, Stiffness};
use crate::store::{append_private, read_text, replace};
use crate::transport::Endpoint;
use crate::trials::measure::metrics::JointMetrics;
use crate::trials::recording::TrialEvent;
use crate::trials::search::close::CloseFacts;
use crate::trials::summary::Trial;
use std::io;
use std::path::{Path, PathBuf};

/// Maximum size of the file, bytes.
const FILE_MAX: u64 = 16 << 20;
/// Above this size, bytes, the file is compacted to one line per kind.
const LONG: u64 = 1 << 20;

/// One joint's close in a trial: its kind, and its overshoot past the threshold, g.
pub type MeasuredClose = (CloseKind, f64);

/// The closes of the joints that met their thresholds. Empty for a trial that ended early, possibly before its peak.
pub fn closes_of(trial: &Trial) -> Vec<MeasuredClose> {
    if trial.summary.aborted.is_some() {
        return Vec::new();
    }
    let facts = CloseFacts::of(trial);
    let joints = trial.summary.joints.iter().zip(&facts);
    joints
        .filter_map(|(joint, facts)| Some((kind_of(trial, facts), over(joint)?)))
        .collect()
}

/// The overshoot of a joint; `None` if the threshold did not stop it.
fn over(joint: &JointMetrics) -> Option<f64> {
    let is_held = joint.end_status.as_deref() == Some(Status::ForceReached.name());
    joint.overshoot_g.filter(|over| is_held || *over > 0.0)
}

fn kind_of(trial: &Trial, facts: &CloseFacts) -> CloseKind {
    let setting = trial.summary.setting;
    let slowed = trial.recording.when(TrialEvent::Slow(facts.dof));
    CloseKind {
        dof: facts.dof,
        stages: slowed.map_or(Stages::One, |_| Stages::Two),
        speed: setting.speed,
        threshold: setting.force,
        stiffness: Stiffness::of(facts.stiffness.or(facts.stiffness_at_least)),
    }
}

/// The file of the hand at an endpoint, beside the settings; `None` for the built-in hand, which differs on each start.
pub fn file_of(settings: &Path, hand: &Endpoint) -> Option<PathBuf> {
    let folder = settings.with_file_name("overshoot");
    (!hand.is_sim()).then(|| folder.join(format!("{}.jsonl", hand.file_stem())))
}

/// Reads the stored closes; empty if there is no file. Lines that do not parse, such as one cut off by a crash, are skipped.
///
/// # Errors
/// The I/O error.
pub fn read(file: &Path) -> io::Result<OvershootMap> {
    let text = read_text(file, FILE_MAX)?.unwrap_or_default();
    let lines = text.lines().map(serde_json::from_str::<MeasuredCloses>);
    Ok(OvershootMap::of(lines.filter_map(Result::ok)))
}

/// Appends the closes of a day, safely alongside other programs, and returns all stored closes.
///
/// # Errors
/// The I/O error.
pub fn add(file: &Path, closes: &[MeasuredClose], day: &str) -> io::Result<OvershootMap> {
    if !closes.is_empty() {
        let mut new = OvershootMap::default();
        for (kind, over_g) in closes {
            new.add(*kind, *over_g, day);
        }
        append_private(file, &lines(&new)?)?;
    }
    let map = read(file)?;
    if file.metadata().is_ok_and(|about| about.len() > LONG) {
        replace(file, lines(&map)?.as_bytes())?;
    }
    Ok(map)
}

/// One line per kind. The leading line break ends a line that was cut off.
fn lines(map: &OvershootMap) -> io::Result<String> {
    let lines: Result<Vec<String>, _> = map.kinds().iter().map(serde_json::to_string).collect();
    Ok(format!("\n{}\n", lines?.join("\n")))
}

/// Deletes the file; a missing one is no error.
///
/// # Errors
/// The I/O error.
pub fn forget(file: &Path) -> io::Result<()> {
    match std::fs::remove_file(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        ended => ended,
    }
}

/// All kinds as a CSV table.
pub fn csv(map: &OvershootMap) -> String {
    let mut kinds: Vec<&MeasuredCloses> = map.kinds().iter().collect();
    kinds.sort_by_key(|own| {
        (
            own.kind.dof,
            own.kind.stages,
            own.kind.threshold,
            own.kind.speed,
        )
    });
    let head = "joint,stages,speed,force_threshold_g,stiffness,closes,most_over_g,mean_over_g,first,last\n";
    let line = |own: &MeasuredCloses| {
        let CloseKind {
            dof,
            stages,
            speed,
            threshold,
            stiffness,
        } = own.kind;
        let stages = match stages {
            Stages::One => 1,
            Stages::Two => 2,
        };
        format!(
            "{},{stages},{},{},{},{},{:.1},{:.1},{},{}\n",
            dof.name(),
            speed.get(),
            threshold.get(),
            stiffness.name(),
            own.closes,
            own.most_over_g,
            own.mean_over_g,
            own.first,
            own.last
        )
    };
    kinds
        .into_iter()
        .fold(head.to_owned(), |text, own| text + &line(own))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::hand::{Dof, Force, Speed};

    fn kind(speed: i16) -> CloseKind {
        CloseKind {
            dof: Dof::Index,
            stages: Stages::Two,
            speed: Speed::nearest(speed),
            threshold: Force::GENTLE,
            stiffness: Stiffness::Firm,
        }
    }

    #[test]
    fn what_is_added_stays_also_beside_others_and_behind_a_line_that_was_cut_off() {
        let folder = tempfile::tempdir().unwrap();
        let hand: Endpoint = "tcp:127.0.0.1:6000".parse().unwrap();
        let file = file_of(&folder.path().join("new/settings.toml"), &hand).unwrap();
        assert!(read(&file).unwrap().is_empty());
        add(&file, &[(kind(25), 7.0), (kind(30), 9.0)], "2026-11-25").unwrap();
        let cut = std::fs::read_to_string(&file).unwrap();
        std::fs::write(&file, format!("{cut}{}", &cut[..cut.len() / 3])).unwrap();
        let map = add(&file, &[(kind(25), 9.0)], "2026-11-26").unwrap();
        assert_eq!(map, read(&file).unwrap());
        assert_eq!((map.kinds().len(), map.closes()), (2, 3));
        assert_eq!(map.kinds()[0].last, "2026-11-26");
        assert_eq!(
            csv(&map),
            "joint,stages,speed,force_threshold_g,stiffness,closes,most_over_g,mean_over_g,first,last\n\
             index,2,25,500,firm,2,9.0,8.0,2026-11-25,2026-11-26\n\
             index,2,30,500,firm,1,9.0,9.0,2026-11-25,2026-11-25\n"
        );
        let other: Endpoint = "tcp:127.0.0.1:6001".parse().unwrap();
        assert_ne!(
            file_of(folder.path(), &hand),
            file_of(folder.path(), &other)
        );
        assert_eq!(file_of(folder.path(), &"sim:".parse().unwrap()), None);
        forget(&file).unwrap();
        forget(&file).unwrap();
        assert!(read(&file).unwrap().is_empty());
    }

    #[test]
    fn a_long_file_is_made_short_and_tells_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("map.jsonl");
        let closes: Vec<MeasuredClose> = (0..5000_i16).map(|nth| (kind(nth % 50), 1.0)).collect();
        let before = add(&file, &closes, "2026-11-25").unwrap();
        let line = std::fs::read_to_string(&file).unwrap();
        let times = usize::try_from(LONG).unwrap() / line.len() + 1;
        std::fs::write(&file, line.repeat(times)).unwrap();
        let map = add(&file, &closes, "2026-11-25").unwrap();
        assert_eq!(
            u32::try_from(times + 1).unwrap() * before.closes(),
            map.closes()
        );
        assert_eq!(read(&file).unwrap(), map);
        assert!(std::fs::metadata(&file).unwrap().len() < 20_000);
    }
}
