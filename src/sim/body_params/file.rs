//! Bodies as TOML files: read entirely or not at all, and printed with units and ranges. Values missing from a file are those of the
//! default body.

use crate::hand::{Dof, Finger};
use crate::sim::body_params::{
    BodyKey, BodyParams, CHANNELS, DRIFT_MAX, FingertipBody, JointBody, SupplyBody,
};
use crate::store::toml_file::load;
use crate::store::{FileCause, FileError, FileText};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use toml::{Spanned, Value};

/// Size limit of a body file, bytes; the default body takes some ten thousand.
const BYTES_MAX: u64 = 1 << 20;

/// Error for a file that is not a valid body.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "the body {} cannot be used: {why}; 'handscope sim --print-body' shows every key with its range",
    path.display()
)]
pub struct BodyFileError {
    pub path: PathBuf,
    /// Error with its position.
    pub why: FileError,
}

type NumberTable = BTreeMap<Spanned<String>, Spanned<Value>>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyRow {
    #[serde(default)]
    supply: NumberTable,
    #[serde(default)]
    joint: BTreeMap<Dof, NumberTable>,
    #[serde(default)]
    fingertip: BTreeMap<Finger, FingertipRow>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct FingertipRow {
    dead_channels: Option<Spanned<Vec<i64>>>,
    drift_per_s: Option<Spanned<Vec<f64>>>,
}

/// Reads a body.
///
/// # Errors
/// [`BodyFileError`]: the file is missing, or has an unknown key or a value out of range.
pub fn read(path: &Path) -> Result<BodyParams, BodyFileError> {
    load(path, BYTES_MAX, parse).map_err(|why| BodyFileError {
        path: path.to_owned(),
        why,
    })
}

/// Parses a body.
///
/// # Errors
/// [`FileError`] with line and field.
pub fn parse(text: &str) -> Result<BodyParams, FileError> {
    let source = FileText::plain(text);
    let row: BodyRow = source.parse()?;
    let mut body = BodyParams::default();
    store_numbers(source, &row.supply, SupplyBody::KEYS, &mut body.supply)?;
    for (dof, numbers) in &row.joint {
        store_numbers(source, numbers, JointBody::KEYS, &mut body.joints[*dof])?;
    }
    for (finger, tip) in &row.fingertip {
        body.fingertips[*finger] = fingertip(source, tip)?;
    }
    Ok(body)
}

/// Stores the numbers in their fields.
fn store_numbers<T>(
    source: FileText<'_>,
    numbers: &NumberTable,
    keys: &[BodyKey<T>],
    into: &mut T,
) -> Result<(), FileError> {
    for (name, value) in numbers {
        let Some(key) = keys.iter().find(|key| key.name == name.get_ref()) else {
            let known: Vec<&str> = keys.iter().map(|key| key.name).collect();
            let cause = FileCause::Malformed(format!(
                "unknown key; the keys here are {}",
                known.join(", ")
            ));
            return Err(source.blame(name.span(), name.get_ref(), cause));
        };
        let number = match value.get_ref() {
            Value::Float(number) => Some(*number),
            Value::Integer(number) => i32::try_from(*number).ok().map(f64::from),
            _ => None,
        };
        let fits = number.filter(|number| (key.least..=key.most).contains(number));
        let Some(fits) = fits else {
            let cause = FileCause::Value {
                got: value.get_ref().to_string().chars().take(40).collect(),
                allowed: format!("a number from {} to {}", key.least, key.most),
            };
            return Err(source.blame(value.span(), key.name, cause));
        };
        *(key.place)(into) = fits;
    }
    Ok(())
}

fn fingertip(source: FileText<'_>, row: &FingertipRow) -> Result<FingertipBody, FileError> {
    let mut tip = FingertipBody::default();
    if let Some(dead) = &row.dead_channels {
        for number in dead.get_ref() {
            let at = usize::try_from(*number).ok().and_then(|n| n.checked_sub(1));
            let Some(channel) = at.and_then(|at| tip.dead.get_mut(at)) else {
                let cause = FileCause::Value {
                    got: number.to_string(),
                    allowed: format!("a channel from 1 to {CHANNELS}"),
                };
                return Err(source.blame(dead.span(), "dead_channels", cause));
            };
            *channel = true;
        }
    }
    if let Some(drift) = &row.drift_per_s {
        let are_fit = drift.get_ref().iter().all(|each| each.abs() <= DRIFT_MAX);
        let all = <[f64; CHANNELS]>::try_from(drift.get_ref().as_slice());
        let (true, Ok(all)) = (are_fit, all) else {
            let cause = FileCause::Value {
                got: format!("{:?}", drift.get_ref()).chars().take(60).collect(),
                allowed: format!("{CHANNELS} numbers from -{DRIFT_MAX} to {DRIFT_MAX}"),
            };
            return Err(source.blame(drift.span(), "drift_per_s", cause));
        };
        tip.drift = all;
    }
    Ok(tip)
}

/// Formats the whole body as a file, each number with its unit and its range.
pub fn print(body: &BodyParams) -> String {
    let mut text = String::from(
        "# The body of a simulated hand: 'handscope sim --body FILE', or 'sim:?body=FILE'.\n\
         # Omitted keys have their default. Stiffness belongs to the object: the body only scales it.\n\n[supply]\n",
    );
    put(&mut text, SupplyBody::KEYS, &body.supply);
    for (dof, joint) in body.joints.iter() {
        // Writing to a string cannot fail.
        let _written = writeln!(text, "\n[joint.{}]", dof.name());
        put(&mut text, JointBody::KEYS, joint);
    }
    for (finger, tip) in body.fingertips.iter() {
        let dead = (1..=CHANNELS).zip(tip.dead);
        let dead: Vec<usize> = dead.filter_map(|(n, dead)| dead.then_some(n)).collect();
        let _written = writeln!(
            text,
            "\n[fingertip.{}]\ndead_channels = {dead:?} # of 1 to {CHANNELS}, those that always read 0\n\
             drift_per_s = {:?} # counts a second of each channel, -{DRIFT_MAX} to {DRIFT_MAX}",
            finger.name(),
            tip.drift,
        );
    }
    text
}

fn put<T>(text: &mut String, keys: &[BodyKey<T>], of: &T) {
    for key in keys {
        let (name, about, value) = (key.name, key.about, (key.get)(of));
        let _written = writeln!(
            text,
            "{name} = {value:?} # {about}; {} to {}",
            key.least, key.most
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::body_params::random::random;

    #[test]
    fn what_is_printed_reads_back_and_the_default_is_the_default() {
        assert_eq!(parse(""), Ok(BodyParams::default()));
        let mut worn = random(5);
        worn.supply.sag = 0.25;
        worn.fingertips[Finger::Index].dead[3] = true;
        worn.fingertips[Finger::Thumb].drift[7] = -12.5;
        for body in [BodyParams::default(), worn] {
            let text = print(&body);
            assert_eq!(parse(&text), Ok(body), "{text}");
            assert!(text.contains("ms from a command to the motion"));
        }
    }

    #[test]
    fn one_number_changes_and_the_rest_stays() {
        let body = parse("[joint.index]\nlatency_ms = 70\n[supply]\nsag = 0.1\n").unwrap();
        let mut wanted = BodyParams::default();
        wanted.joints[Dof::Index].latency_ms = 70.0;
        wanted.supply.sag = 0.1;
        assert_eq!(body, wanted);
    }

    #[test]
    fn a_wrong_file_is_refused_with_line_and_reason() {
        for (text, words) in [
            (
                "[joint.index]\nlatency = 3\n",
                "line 2, `latency`: unknown key",
            ),
            (
                "[joint.index]\nlatency_ms = nan\n",
                "line 2, `latency_ms`: nan is not a number from 0 to 500",
            ),
            (
                "[joint.index]\nlatency_ms = -1\n",
                "-1 is not a number from 0 to 500",
            ),
            ("[joint.index]\nlatency_ms = inf\n", "inf is not"),
            ("[joint.index]\nlatency_ms = \"64\"\n", "\"64\" is not"),
            (
                "[joint.index]\nlatency_ms = 9223372036854775807\n",
                "is not a number",
            ),
            ("[joint.wrist]\nlatency_ms = 3\n", "wrist"),
            ("[wobble]\n", "wobble"),
            ("[supply]\nsag = 1.0\n", "0 to 0.9"),
            (
                "[fingertip.thumb]\ndead_channels = [9]\n",
                "9 is not a channel from 1 to 8",
            ),
            ("[fingertip.thumb]\ndrift_per_s = [1]\n", "8 numbers"),
            (
                "[fingertip.thumb]\ndrift_per_s = [nan, 0, 0, 0, 0, 0, 0, 0]\n",
                "8 numbers",
            ),
            ("[fingertip.thumb]\nwobble = 1\n", "wobble"),
            ("not toml", "line 1"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains(words), "{text}: {error}");
            assert!(!error.contains('\n'), "{error}");
        }
        let error = read(Path::new("/nowhere/body.toml"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("/nowhere/body.toml") && error.contains("--print-body"));
    }
}
