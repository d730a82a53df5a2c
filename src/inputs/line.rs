//! JSON lines with targets for a hand: `{"seq":1,"right":[six of 0..1 or null]}`, 0 bent, 1 open, or `{"seq":1,"grip_mm":30}`; with
//! `"hold":{"at_least_g":150,"at_most_g":400}` they close on an object and hold it (`handscope help stream`).
//! A line with any error is refused as a whole and counted, never clamped into range. A stop is the exception: it is obeyed
//! whatever else its line contains ([`crate::inputs::stop`]).

use crate::hand::gap::Gap;
use crate::hand::hold_forces::HoldForces;
use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, Force, PerDof};
use crate::inputs::fields::{self, FieldFault, Fields};
use crate::inputs::scan;
use crate::inputs::stop::{self, Completeness};
use crate::link::ArmRequest;
use serde::Deserialize as _;
use serde_json::Value;
use std::fmt;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// Supported version of the lines.
pub const LINE_VERSION: i64 = 1;
/// Longest line, bytes.
pub const LINE_MAX: usize = 2048;

/// Contents of one line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StreamLine {
    /// Sequence number, if the sender counts.
    pub seq: Option<f64>,
    /// Targets of the joints.
    pub aims: PerDof<Option<Angle>>,
    /// Target gap, if the line gives one instead of angles; the aims are then its angles.
    pub gap: Option<Gap>,
    /// Forces of a hold, if the line requests one.
    pub hold: Option<HoldForces>,
    /// True while the sender's dead-man is held; `None` if it has none.
    pub held: Option<bool>,
    /// The line requests a stop.
    pub stop: bool,
    /// Equal for bitwise equal targets.
    pub mark: u64,
    /// Reason for which the line would have been refused, had it not requested a stop or released the dead-man.
    pub odd: Option<LineRefusal>,
}

/// A field of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineField {
    Version,
    Seq,
    /// Six values of a side; with a joint, one of them.
    Values(Side, Option<Dof>),
    Gap,
    /// The forces of a hold, or `false`; with a name, one of the forces.
    Hold(Option<&'static str>),
    Held,
    Stop,
}

impl LineField {
    const ALL: [Self; 8] = [
        Self::Version,
        Self::Seq,
        Self::Values(Side::Left, None),
        Self::Values(Side::Right, None),
        Self::Gap,
        Self::Hold(None),
        Self::Held,
        Self::Stop,
    ];

    /// Name in a line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Version => "v",
            Self::Seq => "seq",
            Self::Values(Side::Left, _) => "left",
            Self::Values(Side::Right, _) => "right",
            Self::Gap => "grip_mm",
            Self::Hold(_) => "hold",
            Self::Held => "held",
            Self::Stop => "stop",
        }
    }

    fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|field| field.name() == name)
    }
}

/// Reason for refusing a line, with its field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub struct LineRefusal {
    pub fault: StreamLineFault,
    /// `None` if it concerns no particular field.
    pub field: Option<LineField>,
}

impl fmt::Display for LineRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(field) = self.field {
            f.write_str(field.name())?;
            if let LineField::Values(_, Some(dof)) = field {
                write!(f, ", {}", dof.name())?;
            }
            if let LineField::Hold(Some(force)) = field {
                write!(f, ", {force}")?;
            }
            f.write_str(": ")?;
        }
        write!(f, "{}", self.fault)
    }
}

impl From<StreamLineFault> for LineRefusal {
    fn from(fault: StreamLineFault) -> Self {
        Self { fault, field: None }
    }
}

/// Reason for refusing a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum StreamLineFault {
    #[error("longer than {LINE_MAX} bytes")]
    TooLong,
    /// A number is NaN or infinite.
    #[error("a number is NaN or infinite: send null to leave a joint unchanged")]
    NotFinite,
    /// Not an object of this kind.
    #[error("not a line of JSON as 'handscope help stream' describes it")]
    Malformed,
    /// A field has the wrong type.
    #[error("not of the type that 'handscope help stream' gives")]
    Type,
    /// A field occurs twice.
    #[error("there twice")]
    Twice,
    /// Unsupported version.
    #[error("its version is not {LINE_VERSION}")]
    Version,
    /// The line has nothing for this hand's side.
    #[error("nothing in it is for this hand's side")]
    OtherSide,
    /// Not six values.
    #[error("a hand has six joints")]
    Length,
    /// A value is outside 0 to 1.
    #[error("a value is not from 0 (bent) to 1 (open)")]
    Range,
    /// A gap outside the range of the path of thumb and index.
    #[error("not from {} to {} mm", Gap::MIN.mm(), Gap::MAX.mm())]
    Gap,
    /// Both a gap and values are given.
    #[error("grip_mm together with six values: send one of them")]
    Both,
    /// Forces that leave no room for a hold.
    #[error(
        "at_least_g and at_most_g leave no room for a hold: 'handscope help stream' has their ranges"
    )]
    Forces,
    /// A hold that may press harder than the user allowed.
    #[error("at_most_g is above the force threshold that is set here")]
    AboveLimit,
    /// The sequence number is not above the previous one.
    #[error("late or duplicate: not above the previous one")]
    Late,
    /// Another sender is being followed.
    #[error("another sender is followed until it is silent")]
    OtherSender,
}

impl StreamLineFault {
    /// True if the text is no message at all: its sender uses another protocol, such as a web page that sends a form.
    pub const fn is_no_message(self) -> bool {
        matches!(self, Self::TooLong | Self::Malformed)
    }

    /// Name in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::TooLong => "too_long",
            Self::NotFinite => "not_finite",
            Self::Malformed => "malformed",
            Self::Type => "type",
            Self::Twice => "twice",
            Self::Version => "version",
            Self::OtherSide => "other_side",
            Self::Length => "length",
            Self::Range => "range",
            Self::Gap => "gap",
            Self::Both => "both",
            Self::Forces => "forces",
            Self::AboveLimit => "above_limit",
            Self::Late => "late",
            Self::OtherSender => "other_sender",
        }
    }

    /// Adds the field.
    pub(crate) const fn of(self, field: LineField) -> LineRefusal {
        LineRefusal {
            fault: self,
            field: Some(field),
        }
    }
}

impl StreamLine {
    /// Parses one line for the hand of this side. A line that requests a stop or releases the dead-man is never refused.
    ///
    /// # Errors
    /// [`LineRefusal`]; the line is refused as a whole.
    pub fn parse(line: &[u8], side: Side) -> Result<Self, LineRefusal> {
        let stops = stop::is_stop(line, Completeness::Whole);
        let read = Self::read(line, side);
        if !stops && !stop::lets_go(line) {
            return read;
        }
        Ok(Self {
            seq: read.ok().and_then(|read| read.seq),
            aims: PerDof::splat(None),
            gap: None,
            hold: None,
            held: (!stops).then_some(false),
            stop: stops,
            mark: 0,
            // Neither needs values.
            odd: read
                .err()
                .filter(|odd| odd.fault != StreamLineFault::OtherSide),
        })
    }

    /// Refuses a hold that may press harder than the user allowed any joint.
    ///
    /// # Errors
    /// [`LineRefusal`]; the line is refused as a whole.
    pub fn within(self, allowed: &ArmRequest) -> Result<Self, LineRefusal> {
        let mut most = allowed.force.iter().map(|(_, most)| *most);
        let is_above = |hold: HoldForces| most.any(|most| hold.at_most() > most);
        if self.hold.is_some_and(is_above) {
            return Err(StreamLineFault::AboveLimit.of(LineField::Hold(None)));
        }
        Ok(self)
    }

    fn read(line: &[u8], side: Side) -> Result<Self, LineRefusal> {
        if line.len() > LINE_MAX {
            return Err(StreamLineFault::TooLong.into());
        }
        let fields = Fields::parse(scan::unmarked(line));
        let mut fields = fields.map_err(|_unread| unreadable(line))?;
        if let Some(version) = whole(&mut fields, LineField::Version)?
            && version != LINE_VERSION
        {
            return Err(StreamLineFault::Version.of(LineField::Version));
        }
        flag(&mut fields, LineField::Stop)?;
        let held = flag(&mut fields, LineField::Held)?;
        let seq = take(&mut fields, LineField::Seq, fields::number)?;
        let mm = take(&mut fields, LineField::Gap, fields::number)?;
        let hold = take(&mut fields, LineField::Hold(None), hold_value)?;
        let left = values(&mut fields, Side::Left)?;
        let right = values(&mut fields, Side::Right)?;
        if mm.is_some() && (left.is_some() || right.is_some()) {
            return Err(StreamLineFault::Both.of(LineField::Gap));
        }
        let mut hasher = DefaultHasher::new();
        mm.map(f64::to_bits).hash(&mut hasher);
        let gap = mm.map(gap).transpose()?;
        let needs_no_target = hold.is_some() && left.is_none() && right.is_none();
        let hold = hold
            .flatten()
            .map(|mut both| forces(&mut both))
            .transpose()?;
        hold.map(|hold| [hold.at_least(), hold.at_most()])
            .hash(&mut hasher);
        let values = match side {
            Side::Left => left,
            Side::Right => right,
        };
        let aims = match (gap, values) {
            (Some(gap), _) => gap.angles().map(Some),
            (None, None) if needs_no_target => PerDof::splat(None),
            (None, None) => return Err(StreamLineFault::OtherSide.into()),
            (None, Some(values)) => {
                for (_, value) in values.iter() {
                    value.map(f64::to_bits).hash(&mut hasher);
                }
                aims(&values, side)?
            }
        };
        Ok(Self {
            seq,
            aims,
            gap,
            hold,
            held,
            stop: false,
            mark: hasher.finish(),
            odd: None,
        })
    }
}

/// True if a line may be a message, by its first byte.
pub(crate) fn begins_message(line: &[u8]) -> bool {
    let first = scan::unmarked(line).first();
    first.is_none_or(|byte| *byte == b'{')
}

/// Takes a field from a line and converts it.
fn take<T>(
    fields: &mut Fields,
    field: LineField,
    read: impl Fn(&Value) -> Result<T, FieldFault>,
) -> Result<Option<T>, LineRefusal> {
    let wrong = |fault: FieldFault| match fault {
        FieldFault::Twice => StreamLineFault::Twice.of(field),
        FieldFault::Type => StreamLineFault::Type.of(field),
    };
    let value = fields.take(field.name()).map_err(wrong)?;
    value.as_ref().map(read).transpose().map_err(wrong)
}

fn whole(fields: &mut Fields, field: LineField) -> Result<Option<i64>, LineRefusal> {
    take(fields, field, fields::whole)
}

fn flag(fields: &mut Fields, field: LineField) -> Result<Option<bool>, LineRefusal> {
    take(fields, field, |value| {
        value.as_bool().ok_or(FieldFault::Type)
    })
}

/// Six values of a side; `None` if absent.
fn values(fields: &mut Fields, side: Side) -> Result<Option<PerDof<Option<f64>>>, LineRefusal> {
    let whole = LineField::Values(side, None);
    let list = take(fields, whole, |value| {
        value.as_array().cloned().ok_or(FieldFault::Type)
    })?;
    let Some(list) = list else {
        return Ok(None);
    };
    if list.len() != Dof::ALL.len() {
        return Err(StreamLineFault::Length.of(whole));
    }
    let mut values = PerDof::splat(None);
    for (dof, value) in Dof::ALL.into_iter().zip(&list) {
        if !value.is_null() {
            let wrong = |_type| StreamLineFault::Type.of(LineField::Values(side, Some(dof)));
            values[dof] = Some(fields::number(value).map_err(wrong)?);
        }
    }
    Ok(Some(values))
}

/// The forces of a hold, not read yet; `None` for `false`, which ends one.
fn hold_value(value: &Value) -> Result<Option<Fields>, FieldFault> {
    match value {
        Value::Bool(false) => Ok(None),
        Value::Object(_) => {
            let fields = Fields::deserialize(value).map_err(|_unread| FieldFault::Type)?;
            Ok(Some(fields))
        }
        _ => Err(FieldFault::Type),
    }
}

/// Both forces of a hold.
fn forces(both: &mut Fields) -> Result<HoldForces, LineRefusal> {
    let mut grams = |name: &'static str| {
        let field = LineField::Hold(Some(name));
        let value = both.take(name).ok().flatten();
        let whole = value.and_then(|value| fields::whole(&value).ok());
        let whole = whole.ok_or_else(|| StreamLineFault::Type.of(field))?;
        Force::new(whole).map_err(|_out| StreamLineFault::Forces.of(LineField::Hold(None)))
    };
    let (least, most) = (grams("at_least_g")?, grams("at_most_g")?);
    HoldForces::new(least, most)
        .map_err(|_no_room| StreamLineFault::Forces.of(LineField::Hold(None)))
}

fn aims(values: &PerDof<Option<f64>>, side: Side) -> Result<PerDof<Option<Angle>>, LineRefusal> {
    let mut aims = PerDof::splat(None);
    for (dof, value) in values.iter() {
        let field = LineField::Values(side, Some(dof));
        aims[dof] = value.map(|share| angle(share, field)).transpose()?;
    }
    Ok(aims)
}

fn gap(mm: f64) -> Result<Gap, LineRefusal> {
    let wrong = || StreamLineFault::Gap.of(LineField::Gap);
    let (least, most) = (f64::from(Gap::MIN.mm()), f64::from(Gap::MAX.mm()));
    let mm = fields::within(mm, (least, most)).ok_or_else(wrong)?;
    #[expect(clippy::cast_possible_truncation, reason = "a number of some digits")]
    Gap::new(mm as f32).map_err(|_out| wrong())
}

/// Angle for a share of the travel from bent (0) to open (1); `None` outside 0..=1.
pub(crate) fn angle_of(share: f64) -> Option<Angle> {
    let share = fields::within(share, (0.0, 1.0))?;
    #[expect(clippy::cast_possible_truncation, reason = "from 0 to 1000")]
    let counts = (share * f64::from(Angle::MAX.get())).round() as i64;
    Angle::new(counts).ok()
}

fn angle(share: f64, field: LineField) -> Result<Angle, LineRefusal> {
    angle_of(share).ok_or_else(|| StreamLineFault::Range.of(field))
}

/// JSON has no notation for numbers that are not finite; many senders write one anyway, or a number too large for a float.
fn unreadable(line: &[u8]) -> LineRefusal {
    match scan::not_finite_at(line).filter(|_| begins_message(line)) {
        Some(name) => LineRefusal {
            fault: StreamLineFault::NotFinite,
            field: name.and_then(|name| LineField::named(&name)),
        },
        None => StreamLineFault::Malformed.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<StreamLine, LineRefusal> {
        StreamLine::parse(line.as_bytes(), Side::Right)
    }

    fn fault(line: &str) -> Option<StreamLineFault> {
        parse(line).err().map(|refusal| refusal.fault)
    }

    #[test]
    fn a_line_says_where_each_joint_goes_and_null_leaves_one_alone() {
        let line = parse(r#"{"t":1.5,"seq":7,"right":[0,1,0.5,null,0.25,1e-9],"more":3}"#).unwrap();
        let counts = line.aims.map(|aim| aim.map(Angle::get));
        let want = [Some(0), Some(1000), Some(500), None, Some(250), Some(0)];
        assert_eq!(Dof::ALL.map(|dof| counts[dof]), want);
        assert_eq!((line.seq, line.held, line.stop), (Some(7.0), None, false));
        let stop = parse(r#"{"stop":true}"#).unwrap();
        assert!(stop.stop && stop.aims == PerDof::splat(None));
    }

    #[test]
    fn a_hold_has_two_forces_and_closes_to_what_else_the_line_says() {
        let both = r#""hold":{"at_least_g":150,"at_most_g":400.0,"more":1}"#;
        let forces = HoldForces::nearest(Force::nearest(150), Force::nearest(400));
        let alone = parse(&format!("{{{both}}}")).unwrap();
        assert_eq!(
            (alone.hold, alone.aims),
            (Some(forces), PerDof::splat(None))
        );
        let to = parse(&format!(r#"{{{both},"right":[0,0,0,0,0,null]}}"#)).unwrap();
        assert_eq!(
            (to.hold, to.aims[Dof::Index]),
            (Some(forces), Some(Angle::MIN))
        );
        let pinch = parse(&format!(r#"{{{both},"grip_mm":20}}"#)).unwrap();
        assert_eq!(
            (pinch.hold, pinch.gap),
            (Some(forces), Some(Gap::nearest(20.0)))
        );
        let firmer = parse(r#"{"hold":{"at_least_g":150,"at_most_g":500}}"#).unwrap();
        assert_ne!(firmer.mark, alone.mark);
        let ends = parse(r#"{"hold":false}"#).unwrap();
        assert_eq!((ends.hold, ends.aims), (None, PerDof::splat(None)));
        for (line, told) in [
            (r#"{"hold":null}"#, "nothing in it is for this hand's side"),
            (
                r#"{"hold":{},"left":[1,1,1,1,1,1]}"#,
                "hold, at_least_g: not of the type",
            ),
            (r#"{"hold":true}"#, "hold: not of the type"),
            (
                r#"{"hold":{"at_least_g":150}}"#,
                "hold, at_most_g: not of the type",
            ),
            (
                r#"{"hold":{"at_least_g":"150","at_most_g":400}}"#,
                "hold, at_least_g: not of",
            ),
            (
                r#"{"hold":{"at_least_g":150,"at_most_g":200}}"#,
                "hold: at_least_g and at_most_g leave",
            ),
            (
                r#"{"hold":{"at_least_g":150,"at_most_g":9000}}"#,
                "hold: at_least_g and at_most_g leave",
            ),
            (r#"{"hold":false,"hold":false}"#, "hold: there twice"),
        ] {
            let why = parse(line).unwrap_err().to_string();
            assert!(why.starts_with(told), "{line}: {why}");
        }
        let other_side = format!(r#"{{{both},"left":[1,1,1,1,1,1]}}"#);
        assert_eq!(fault(&other_side), Some(StreamLineFault::OtherSide));
    }

    #[test]
    fn a_hold_with_more_force_than_any_joint_may_have_is_refused() {
        let line = parse(r#"{"hold":{"at_least_g":150,"at_most_g":400}}"#).unwrap();
        let mut allowed = ArmRequest::GENTLE;
        assert_eq!(line.within(&allowed), Ok(line));
        allowed.force[Dof::Ring] = Force::nearest(399);
        let why = line.within(&allowed).unwrap_err();
        assert_eq!(why.fault, StreamLineFault::AboveLimit);
        let follows = parse(r#"{"right":[1,1,1,1,1,1]}"#).unwrap();
        assert_eq!(follows.within(&allowed), Ok(follows));
    }

    #[test]
    fn a_stop_is_obeyed_whatever_is_odd_and_what_is_odd_is_told() {
        for text in stop::tests::odd_stops() {
            let stop = StreamLine::parse(&text, Side::Right).unwrap();
            let shown = String::from_utf8_lossy(&text);
            assert!(stop.stop && stop.aims == PerDof::splat(None), "{shown}");
        }
        for (line, odd) in [
            (r#"{"stop":true}"#, None),
            (r#"{"stop":true,"why":"operator","v":1.0,"seq":17.0}"#, None),
            (r#"{"stop":true,"right":[1,1,1,1,1,1]}"#, None),
            (r#"{"stop":1}"#, Some("stop: not of the type")),
            (r#"{"stop":true,"stop":true}"#, Some("stop: there twice")),
            (r#"{"stop":true,"v":2}"#, Some("v: its version is not 1")),
            (
                r#"{"stop":true,"right":[NaN]}"#,
                Some("right: a number is NaN"),
            ),
            (
                r#"{"stop":true,"right":"lost"}"#,
                Some("right: not of the type"),
            ),
            (
                r#"{"stop":true,"right":[1,1,1,7,1,1]}"#,
                Some("right, index: a value"),
            ),
            (r#"{"stop":true"#, Some("not a line of JSON")),
        ] {
            let told = parse(line).unwrap().odd.map(|odd| odd.to_string());
            let is_told = match (&told, odd) {
                (Some(told), Some(odd)) => told.starts_with(odd),
                (told, odd) => told.is_none() && odd.is_none(),
            };
            assert!(is_told, "{line}: {told:?}");
        }
    }

    #[test]
    fn a_dead_man_is_let_go_with_no_values_and_with_wrong_ones() {
        for (line, is_odd) in [
            (r#"{"held":false}"#, false),
            (r#"{"held":false,"right":[1,1,1,1,1,1]}"#, false),
            (r#"{"held":false,"right":[NaN,1,1,1,1,1]}"#, true),
            (r#"{"held":0}"#, true),
            (r#"{"v":2,"held":false}"#, true),
        ] {
            let read = parse(line).unwrap();
            assert_eq!((read.held, read.stop), (Some(false), false), "{line}");
            assert_eq!(read.aims, PerDof::splat(None), "{line}");
            assert_eq!(read.odd.is_some(), is_odd, "{line}");
        }
        assert_eq!(fault(r#"{"held":true}"#), Some(StreamLineFault::OtherSide));
        assert_eq!(fault(r#"{"held":"yes"}"#), Some(StreamLineFault::Type));
    }

    #[test]
    fn numbers_of_other_languages_are_numbers() {
        let six = |value: &str| format!(r#""right":[{value},0.9,0.9,0.9,0.9,0.9]"#);
        for (line, seq, little) in [
            (
                format!(r#"{{"v":1.0,"seq":17.0,{}}}"#, six("1.0")),
                17.0,
                1000,
            ),
            (
                format!(r#"{{"v":1e0,"seq":17e0,{}}}"#, six("1")),
                17.0,
                1000,
            ),
            (
                format!(r#"{{"seq":-1,{}}}"#, six("1.0000000002")),
                -1.0,
                1000,
            ),
            (format!(r#"{{"seq":1.5,{}}}"#, six("-1e-9")), 1.5, 0),
            (format!("\u{feff}{{\"seq\":2,{}}}", six("-0.0")), 2.0, 0),
            (format!("{{\"seq\":3,{}}}\0", six("0.5")), 3.0, 500),
            (format!("{{\"seq\":3,{}}}\r\n\0", six("0.5")), 3.0, 500),
        ] {
            let read = parse(&line).unwrap();
            assert_eq!(read.seq, Some(seq), "{line}");
            let at = read.aims[Dof::Little].map(Angle::get);
            assert_eq!((at, read.odd), (Some(little), None), "{line}");
        }
        assert_eq!(
            parse(r#"{"grip_mm":120.0000001}"#).unwrap().gap,
            Some(Gap::MAX)
        );
    }

    #[test]
    fn a_refusal_names_the_field() {
        for (line, said) in [
            (
                r#"{"seq":"17","right":[1,1,1,1,1,1]}"#,
                "seq: not of the type",
            ),
            (
                r#"{"right":["1",1,1,1,1,1]}"#,
                "right, little: not of the type",
            ),
            (
                r#"{"right":[1,1,1,1,1,1.1]}"#,
                "right, thumb_rotate: a value is not",
            ),
            (r#"{"right":[1,1]}"#, "right: a hand has six joints"),
            (r#"{"v":1.5,"right":[1]}"#, "v: not of the type"),
            (r#"{"v":2,"right":[1]}"#, "v: its version is not 1"),
            (r#"{"grip_mm":2}"#, "grip_mm: not from 3 to 120 mm"),
            (r#"{"grip_mm":Infinity}"#, "grip_mm: a number is NaN"),
            (
                r#"{"seq":1,"seq":2,"right":[1,1,1,1,1,1]}"#,
                "seq: there twice",
            ),
        ] {
            let told = parse(line).unwrap_err().to_string();
            assert!(told.starts_with(said), "{line}: {told}");
        }
    }

    #[test]
    fn what_is_wrong_is_refused_whole() {
        for (line, wanted) in [
            (r#"{"right":[0,0,0,0,0,NaN]}"#, StreamLineFault::NotFinite),
            (
                r#"{"right":[0,0,0,0,0,-Infinity]}"#,
                StreamLineFault::NotFinite,
            ),
            (r#"{"right":[0,0,0,0,0,1e999]}"#, StreamLineFault::NotFinite),
            (r#"{"right":[0,0,0,0,0,1.001]}"#, StreamLineFault::Range),
            (r#"{"right":[0,0,0,0,0,-0.001]}"#, StreamLineFault::Range),
            (r#"{"right":[0,0,0,0,0]}"#, StreamLineFault::Length),
            (r#"{"right":[0,0,0,0,0,0,0]}"#, StreamLineFault::Length),
            (r#"{"left":[0,0,0,0,0,0]}"#, StreamLineFault::OtherSide),
            (r#"{"v":2,"right":[0,0,0,0,0,0]}"#, StreamLineFault::Version),
            (r#"{"right":"fist"}"#, StreamLineFault::Type),
            (r#"{"grip_mm":2.9}"#, StreamLineFault::Gap),
            (r#"{"grip_mm":120.1}"#, StreamLineFault::Gap),
            (r#"{"grip_mm":-30}"#, StreamLineFault::Gap),
            (r#"{"grip_mm":NaN}"#, StreamLineFault::NotFinite),
            (r#"{"grip_mm":"30"}"#, StreamLineFault::Type),
            (
                r#"{"grip_mm":30,"right":[0,0,0,0,0,0]}"#,
                StreamLineFault::Both,
            ),
            (
                r#"{"grip_mm":30,"left":[0,0,0,0,0,0]}"#,
                StreamLineFault::Both,
            ),
            (r#"{"grip_mm":null}"#, StreamLineFault::OtherSide),
            ("[0,0,0,0,0,0]", StreamLineFault::Malformed),
            ("POST /NaN HTTP/1.1", StreamLineFault::Malformed),
            ("", StreamLineFault::Malformed),
        ] {
            assert_eq!(fault(line), Some(wanted), "{line}");
        }
        let long = format!(
            r#"{{"right":[0,0,0,0,0,0],"x":"{}"}}"#,
            "y".repeat(LINE_MAX)
        );
        assert_eq!(fault(&long), Some(StreamLineFault::TooLong));
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
