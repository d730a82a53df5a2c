//! Lines of JSON that ask a hand to go somewhere: `{"seq":1,"right":[six of 0..1 or null]}`, 0 bent, 1 open, or `{"seq":1,"grip_mm":30}`
//! (`handscope help stream`).
//! What is wrong is refused whole and counted, never bent into range.

use crate::hand::gap::Gap;
use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, PerDof};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// Version of the lines that are read here.
pub const LINE_VERSION: u64 = 1;
/// Longest line, bytes.
pub const LINE_MAX: usize = 2048;

/// What one line asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreamLine {
    /// Its number, if the sender counts.
    pub seq: Option<u64>,
    /// Where the joints should go.
    pub aims: PerDof<Option<Angle>>,
    /// The gap that these are the angles of, where one is asked for in place of them.
    pub gap: Option<Gap>,
    /// Whether the sender's dead-man is held, if it has one.
    pub held: Option<bool>,
    /// The hand is to be stopped.
    pub stop: bool,
    /// The same for targets that are the same to the last bit.
    pub mark: u64,
}

/// Why a line was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum LineFault {
    #[error("longer than {LINE_MAX} bytes")]
    TooLong,
    /// A number is NaN or infinite.
    #[error("a number is NaN or infinite: send null to leave a joint alone")]
    NotFinite,
    /// It is no object of this kind.
    #[error("not a line of JSON as 'handscope help stream' has it")]
    Malformed,
    /// It has another version.
    #[error("its version is not {LINE_VERSION}")]
    Version,
    /// It says nothing of this hand.
    #[error("nothing in it is for this hand's side")]
    OtherSide,
    /// Not six values.
    #[error("a hand has six joints")]
    Length,
    /// A value that is not from 0 to 1.
    #[error("a value is not from 0 (bent) to 1 (open)")]
    Range,
    /// A gap that the path of thumb and index does not have.
    #[error("grip_mm is not from {} to {} mm", Gap::MIN.mm(), Gap::MAX.mm())]
    Gap,
    /// A gap and values.
    #[error("grip_mm stands beside six values: send one of them")]
    Both,
    /// Its number is not above the one before.
    #[error("late or doubled: its seq is not above the one before")]
    Late,
    /// Another sender is followed.
    #[error("another sender is followed until it is silent")]
    OtherSender,
}

impl LineFault {
    /// True for what is no message at all: who sends that speaks another language, as a web page does that sends a form.
    pub const fn is_no_message(self) -> bool {
        matches!(self, Self::TooLong | Self::Malformed)
    }

    /// The word for it in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::TooLong => "too_long",
            Self::NotFinite => "not_finite",
            Self::Malformed => "malformed",
            Self::Version => "version",
            Self::OtherSide => "other_side",
            Self::Length => "length",
            Self::Range => "range",
            Self::Gap => "gap",
            Self::Both => "both",
            Self::Late => "late",
            Self::OtherSender => "other_sender",
        }
    }
}

#[derive(serde::Deserialize)]
struct Raw {
    v: Option<u64>,
    seq: Option<u64>,
    left: Option<Vec<Option<f64>>>,
    right: Option<Vec<Option<f64>>>,
    grip_mm: Option<f64>,
    held: Option<bool>,
    #[serde(default)]
    stop: bool,
}

impl StreamLine {
    /// A stop, whatever version or targets stand beside it.
    fn stop(raw: &Raw) -> Self {
        Self {
            seq: raw.seq,
            aims: PerDof::splat(None),
            gap: None,
            held: raw.held,
            stop: true,
            mark: 0,
        }
    }

    /// Reads one line for the hand of this side.
    ///
    /// # Errors
    /// [`LineFault`]: why it is refused whole.
    pub fn parse(line: &[u8], side: Side) -> Result<Self, LineFault> {
        if line.len() > LINE_MAX {
            return Err(LineFault::TooLong);
        }
        let raw: Raw = serde_json::from_slice(line).map_err(|_unread| malformed(line))?;
        if raw.stop {
            return Ok(Self::stop(&raw));
        }
        if raw.v.is_some_and(|version| version != LINE_VERSION) {
            return Err(LineFault::Version);
        }
        if raw.grip_mm.is_some() && (raw.left.is_some() || raw.right.is_some()) {
            return Err(LineFault::Both);
        }
        let gap = raw.grip_mm.map(gap).transpose()?;
        let values = match side {
            Side::Left => raw.left,
            Side::Right => raw.right,
        };
        let values = match values {
            None if gap.is_some() => vec![None; Dof::ALL.len()],
            values => values.ok_or(LineFault::OtherSide)?,
        };
        let mut aims = PerDof::splat(None);
        let mut hasher = DefaultHasher::new();
        raw.grip_mm.map(f64::to_bits).hash(&mut hasher);
        if values.len() != Dof::ALL.len() {
            return Err(LineFault::Length);
        }
        for (dof, value) in Dof::ALL.into_iter().zip(values) {
            value.map(f64::to_bits).hash(&mut hasher);
            aims[dof] = value.map(angle).transpose()?;
        }
        Ok(Self {
            seq: raw.seq,
            aims: gap.map_or(aims, |gap| gap.angles().map(Some)),
            gap,
            held: raw.held,
            stop: false,
            mark: hasher.finish(),
        })
    }
}

/// Whether a line may be a message, by its first byte.
pub(crate) fn begins_message(line: &[u8]) -> bool {
    line.trim_ascii_start()
        .first()
        .is_none_or(|byte| *byte == b'{')
}

fn gap(mm: f64) -> Result<Gap, LineFault> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the range is checked after it"
    )]
    Gap::new(mm as f32).map_err(|_out| LineFault::Gap)
}

fn angle(share: f64) -> Result<Angle, LineFault> {
    if !(0.0..=1.0).contains(&share) {
        return Err(LineFault::Range);
    }
    #[expect(clippy::cast_possible_truncation, reason = "from 0 to 1000")]
    let counts = (share * f64::from(Angle::MAX.get())).round() as i64;
    Angle::new(counts).map_err(|_out| LineFault::Range)
}

/// JSON has no word for what is no finite number; many senders write one anyway, or a number that is too large to be one.
fn malformed(line: &[u8]) -> LineFault {
    let is_in_number = |byte: &u8| byte.is_ascii_alphanumeric() || b"+-.".contains(byte);
    let mut words = line.split(|byte| !is_in_number(byte)).map(str::from_utf8);
    let is_not_finite = |word: &str| word.parse().is_ok_and(|number: f64| !number.is_finite());
    if begins_message(line) && words.any(|word| word.is_ok_and(is_not_finite)) {
        LineFault::NotFinite
    } else {
        LineFault::Malformed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<StreamLine, LineFault> {
        StreamLine::parse(line.as_bytes(), Side::Right)
    }

    #[test]
    fn a_line_says_where_each_joint_goes_and_null_leaves_one_alone() {
        let line = parse(r#"{"t":1.5,"seq":7,"right":[0,1,0.5,null,0.25,1e-9],"more":3}"#).unwrap();
        let counts = line.aims.map(|aim| aim.map(Angle::get));
        let want = [Some(0), Some(1000), Some(500), None, Some(250), Some(0)];
        assert_eq!(Dof::ALL.map(|dof| counts[dof]), want);
        assert_eq!((line.seq, line.held, line.stop), (Some(7), None, false));
        let stop = parse(r#"{"stop":true}"#).unwrap();
        assert!(stop.stop && stop.aims == PerDof::splat(None));
        // It stops the hand, whatever else stands there.
        for beside in [
            r#""v":2"#,
            r#""grip_mm":0"#,
            r#""grip_mm":30,"right":[1,1,1,1,1,1]"#,
            r#""right":[1]"#,
            r#""right":[7,1,1,1,1,1]"#,
            r#""left":[1,1,1,1,1,1]"#,
        ] {
            let stop = parse(&format!("{{\"stop\":true,{beside}}}")).unwrap();
            assert!(stop.stop && stop.gap.is_none(), "{beside}");
        }
    }

    #[test]
    fn what_is_wrong_is_refused_whole() {
        for (line, fault) in [
            (r#"{"right":[0,0,0,0,0,NaN]}"#, LineFault::NotFinite),
            (r#"{"right":[0,0,0,0,0,-Infinity]}"#, LineFault::NotFinite),
            (r#"{"right":[0,0,0,0,0,1e999]}"#, LineFault::NotFinite),
            (r#"{"right":[0,0,0,0,0,1.001]}"#, LineFault::Range),
            (r#"{"right":[0,0,0,0,0,-0.001]}"#, LineFault::Range),
            (r#"{"right":[0,0,0,0,0]}"#, LineFault::Length),
            (r#"{"right":[0,0,0,0,0,0,0]}"#, LineFault::Length),
            (r#"{"left":[0,0,0,0,0,0]}"#, LineFault::OtherSide),
            (r#"{"v":2,"right":[0,0,0,0,0,0]}"#, LineFault::Version),
            (r#"{"right":"fist"}"#, LineFault::Malformed),
            (r#"{"grip_mm":2.9}"#, LineFault::Gap),
            (r#"{"grip_mm":120.1}"#, LineFault::Gap),
            (r#"{"grip_mm":-30}"#, LineFault::Gap),
            (r#"{"grip_mm":NaN}"#, LineFault::NotFinite),
            (r#"{"grip_mm":"30"}"#, LineFault::Malformed),
            (r#"{"grip_mm":30,"right":[0,0,0,0,0,0]}"#, LineFault::Both),
            (r#"{"grip_mm":30,"left":[0,0,0,0,0,0]}"#, LineFault::Both),
            (r#"{"grip_mm":null}"#, LineFault::OtherSide),
            ("[0,0,0,0,0,0]", LineFault::Malformed),
            ("POST /NaN HTTP/1.1", LineFault::Malformed),
            ("", LineFault::Malformed),
        ] {
            assert_eq!(parse(line), Err(fault), "{line}");
        }
        let long = format!(
            r#"{{"right":[0,0,0,0,0,0],"x":"{}"}}"#,
            "y".repeat(LINE_MAX)
        );
        assert_eq!(parse(&long), Err(LineFault::TooLong));
    }

    #[test]
    fn a_gap_stands_in_place_of_values_for_either_side() {
        for side in [Side::Left, Side::Right] {
            let line = StreamLine::parse(br#"{"v":1,"seq":3,"grip_mm":30.5}"#, side).unwrap();
            let gap = Gap::new(30.5).unwrap();
            assert_eq!(line.gap, Some(gap));
            assert_eq!(line.aims, gap.angles().map(Some));
        }
        let mark = |line: &str| parse(line).unwrap().mark;
        assert_ne!(mark(r#"{"grip_mm":30}"#), mark(r#"{"grip_mm":30.01}"#));
        assert_eq!(mark(r#"{"grip_mm":30}"#), mark(r#"{"grip_mm":30.0}"#));
        assert_eq!(parse(r#"{"right":[1,1,1,1,1,1]}"#).unwrap().gap, None);
    }

    #[test]
    fn a_mark_is_the_same_for_the_same_bits_only() {
        let mark = |value: &str| {
            parse(&format!(r#"{{"right":[{value},0,0,0,0,0]}}"#))
                .unwrap()
                .mark
        };
        assert_eq!(mark("0.5"), mark("0.50"));
        assert_ne!(mark("0.5"), mark("0.50000001"));
        assert_ne!(mark("0"), mark("null"));
    }
}
