//! The report of a day as TOML, version 1 (assets/manual/exhibit.md). It is accepted as a whole or rejected.

use crate::exhibit::report::DayReport;
use crate::hand::{Dof, PerDof, TemperatureReading};
use crate::store::toml_file::VERSION;
use crate::store::{FileCause, FileError, FileText};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use toml::Spanned;

/// The `format` value of such a file.
pub const FORMAT: &str = "handscope-exhibit-day";

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DayRow {
    format: String,
    version: i64,
    day: Spanned<String>,
    hands: BTreeSet<String>,
    visits: u32,
    rests: u32,
    stops: u32,
    link_losses: u32,
    #[serde(default)]
    pieces: BTreeMap<String, u32>,
    #[serde(default)]
    faults: BTreeMap<String, u32>,
    #[serde(default, rename = "hour", skip_serializing_if = "Vec::is_empty")]
    hours: Vec<HourRow>,
}

/// Highest temperatures in an hour, °C; `None` without a reading.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HourRow {
    hour: Spanned<u8>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    little: Option<Spanned<u8>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    ring: Option<Spanned<u8>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    middle: Option<Spanned<u8>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    index: Option<Spanned<u8>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    thumb_bend: Option<Spanned<u8>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    thumb_rotate: Option<Spanned<u8>>,
}

/// The report as text.
///
/// # Errors
/// An error of the TOML writer; a report counted by this program never causes one.
pub fn write(report: &DayReport) -> Result<String, toml::ser::Error> {
    toml::to_string(&DayRow {
        format: FORMAT.into(),
        version: VERSION,
        day: Spanned::new(0..0, report.day.clone()),
        hands: report.hands.clone(),
        visits: report.visits,
        rests: report.rests,
        stops: report.stops,
        link_losses: report.link_losses,
        pieces: report.pieces.clone(),
        faults: report.faults.clone(),
        hours: report.hottest.iter().map(hour_row).collect(),
    })
}

fn hour_row((hour, drives): (&u8, &PerDof<Option<u8>>)) -> HourRow {
    let celsius = |dof| drives[dof].map(|celsius| Spanned::new(0..0, celsius));
    HourRow {
        hour: Spanned::new(0..0, *hour),
        little: celsius(Dof::Little),
        ring: celsius(Dof::Ring),
        middle: celsius(Dof::Middle),
        index: celsius(Dof::Index),
        thumb_bend: celsius(Dof::ThumbBend),
        thumb_rotate: celsius(Dof::ThumbRotate),
    }
}

/// Parses a report and checks that it is of this day, `2026-11-21`.
///
/// # Errors
/// [`FileError`] with line and field; a bad text is rejected as a whole.
pub fn read(text: &str, day: &str) -> Result<DayReport, FileError> {
    let source = FileText::of(text, FORMAT)?;
    let row: DayRow = source.parse()?;
    if row.day.get_ref() != day {
        let got: String = row.day.get_ref().chars().take(40).collect();
        let cause = FileCause::Value {
            got: format!("\"{got}\""),
            allowed: format!("the day of this file, \"{day}\""),
        };
        return Err(source.blame(row.day.span(), "day", cause));
    }
    let mut hottest = BTreeMap::new();
    for hour in &row.hours {
        let drives = temperatures(source, hour)?;
        if hottest.insert(*hour.hour.get_ref(), drives).is_some() {
            let cause = FileCause::Value {
                got: format!("{}", hour.hour.get_ref()),
                allowed: "allowed twice".into(),
            };
            return Err(source.blame(hour.hour.span(), "hour", cause));
        }
    }
    Ok(DayReport {
        day: row.day.into_inner(),
        hands: row.hands,
        visits: row.visits,
        pieces: row.pieces,
        faults: row.faults,
        rests: row.rests,
        stops: row.stops,
        link_losses: row.link_losses,
        hottest,
    })
}

fn temperatures(source: FileText<'_>, row: &HourRow) -> Result<PerDof<Option<u8>>, FileError> {
    if *row.hour.get_ref() > 23 {
        let cause = FileCause::Value {
            got: format!("{}", row.hour.get_ref()),
            allowed: "an hour from 0 to 23".into(),
        };
        return Err(source.blame(row.hour.span(), "hour", cause));
    }
    let drives = PerDof::new([
        &row.little,
        &row.ring,
        &row.middle,
        &row.index,
        &row.thumb_bend,
        &row.thumb_rotate,
    ]);
    for (dof, celsius) in drives.iter() {
        if let Some(celsius) = celsius
            && !TemperatureReading::RANGE.contains(celsius.get_ref())
        {
            let cause = FileCause::Value {
                got: format!("{}", celsius.get_ref()),
                allowed: "a temperature from 0 to 100 °C".into(),
            };
            return Err(source.blame(celsius.span(), dof.name(), cause));
        }
    }
    Ok(drives.map(|celsius| celsius.as_ref().map(|celsius| *celsius.get_ref())))
}
