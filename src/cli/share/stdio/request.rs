//! Requests of a program on standard input, one JSON object per line. Pure; a contract with scripts (`handscope help
//! share`).

use crate::cli::parse::{moving, rated};
use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, Force, Gesture, PerDof, Speed};
use crate::inputs::fields::{self, FieldFault, Fields};
use crate::inputs::line::{LINE_VERSION, StreamLine};
use crate::inputs::lines::LONGEST;
use crate::inputs::scan::{unmarked, value_at};
use crate::inputs::stop::{Completeness, EndWord, end_word, lets_go};
use crate::link::{ArmRequest, PollRates};
use crate::poses::way::Targets;
use serde_json::Value;
use std::path::PathBuf;

/// One parsed line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StdioLine {
    /// ID for the reply; `null` if the line has none.
    pub(crate) id: Value,
    pub(crate) what: Result<StdioRequest, String>,
    /// Error in a line that ends a motion and is obeyed nevertheless.
    pub(crate) odd: Option<String>,
}

/// A request.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum StdioRequest {
    /// Arm the hand within these limits.
    Arm(LimitsRequest),
    Move(MoveRequest),
    /// A target to follow, in the line format of `follow`.
    Follow(StreamLine),
    /// Stop and disarm the hand, whichever controller moves it.
    Stop,
    /// The same, unless another controller moves it now.
    Release,
    /// Disarm the hand, so that a program on the gateway may get control. A moving hand is stopped first.
    Disarm,
    /// Clear a fault; this moves nothing.
    Clear,
    /// Set the polling rates of the hand.
    Rate(PollRates),
    /// Report the angles of a pose of the library; this moves nothing.
    Pose(String),
    /// Start a recording here, or with `None` end it.
    Record(Option<PathBuf>),
}

/// A motion to targets, or one that the hand itself stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MoveRequest {
    /// Target of each joint; none for a gesture.
    pub(crate) targets: Targets,
    /// Gesture that the hand starts by itself.
    pub(crate) gesture: Option<Gesture>,
    pub(crate) limits: LimitsRequest,
    pub(crate) settles: bool,
}

/// Speed and force threshold for all joints; `None` = not specified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LimitsRequest {
    pub(crate) speed: Option<Speed>,
    pub(crate) force: Option<Force>,
}

impl LimitsRequest {
    fn read(fields: &mut Fields) -> Result<Self, String> {
        Ok(Self {
            speed: moving_speed(fields)?,
            force: rated_force(fields)?,
        })
    }

    /// Applies these limits over the current ones.
    pub(crate) fn over(self, now: ArmRequest) -> ArmRequest {
        ArmRequest {
            speed: self.speed.map_or(now.speed, PerDof::splat),
            force: self.force.map_or(now.force, PerDof::splat),
        }
    }
}

impl StdioLine {
    /// Handles a line without an end word; a released dead-man switch counts despite errors in the line.
    fn of(id: Value, read: Result<StdioRequest, String>, line: &[u8], side: Side) -> Self {
        let let_go = StreamLine::parse(line, side).ok().filter(|_| lets_go(line));
        match (read, let_go) {
            (Err(odd), Some(let_go)) => Self {
                id,
                what: Ok(StdioRequest::Follow(let_go)),
                odd: Some(odd),
            },
            (what, _) => Self {
                id,
                what,
                odd: None,
            },
        }
    }

    /// Parses one line for the hand of this side. A line that ends a motion is obeyed, whatever else it contains.
    pub(crate) fn parse(line: &[u8], side: Side) -> Self {
        let (id, read) = read(line, side);
        let request = match end_word(line, Completeness::Whole) {
            None => return Self::of(id, read, line, side),
            Some(EndWord::Stop) => StdioRequest::Stop,
            Some(EndWord::Release) => StdioRequest::Release,
            Some(EndWord::Disarm) => StdioRequest::Disarm,
        };
        let odd = match read {
            Err(why) => Some(why),
            Ok(StdioRequest::Follow(line)) => line.odd.map(|odd| odd.to_string()),
            Ok(read) if read == request => None,
            Ok(_other) => Some("it also asks for something else".into()),
        };
        Self {
            id,
            what: Ok(request),
            odd,
        }
    }
}

fn read(line: &[u8], side: Side) -> (Value, Result<StdioRequest, String>) {
    if line.len() > LONGEST {
        let why = format!("a line has at most {LONGEST} bytes");
        return (value_at(line, "id"), Err(why));
    }
    let mut fields = match Fields::parse(unmarked(line)) {
        Ok(fields) => fields,
        Err(error) => {
            let why = format!("not a JSON object: {error}");
            return (value_at(line, "id"), Err(why));
        }
    };
    let id = fields.take("id").ok().flatten().unwrap_or_default();
    let request = if fields.has("do") {
        request(&mut fields)
            .map_err(|why| format!("{why}; 'handscope help share' lists the requests"))
    } else {
        let line = StreamLine::parse(line, side);
        line.map(StdioRequest::Follow)
            .map_err(|refusal| refusal.to_string())
    };
    (id, request)
}

fn request(fields: &mut Fields) -> Result<StdioRequest, String> {
    let version = field(fields, "v", fields::whole)?;
    if version.is_some_and(|version| version != LINE_VERSION) {
        return Err(format!("v: its version is not {LINE_VERSION}"));
    }
    let what = field(fields, "do", text)?.unwrap_or_default();
    let request = match what.as_str() {
        "arm" => StdioRequest::Arm(LimitsRequest::read(fields)?),
        "move" => StdioRequest::Move(MoveRequest {
            targets: targets(fields)?,
            gesture: None,
            limits: LimitsRequest::read(fields)?,
            settles: field(fields, "settle", flag)?.unwrap_or(false),
        }),
        "gesture" => StdioRequest::Move(MoveRequest {
            targets: PerDof::splat(None),
            gesture: Some(gesture(fields)?),
            limits: LimitsRequest::read(fields)?,
            // The program does not know where a gesture ends.
            settles: true,
        }),
        "pose" => StdioRequest::Pose(field(fields, "name", text)?.ok_or("name: no pose is named")?),
        "stop" => StdioRequest::Stop,
        "release" => StdioRequest::Release,
        "disarm" => StdioRequest::Disarm,
        "clear" => StdioRequest::Clear,
        "rate" => StdioRequest::Rate(rates(fields)?),
        "record" => StdioRequest::Record(field(fields, "path", text)?.map(PathBuf::from)),
        other => return Err(format!("do: unknown request {other:?}")),
    };
    match fields.other() {
        Some(other) => Err(format!("{other}: not a field of {what}")),
        None => Ok(request),
    }
}

/// Removes and reads a field; the error names it.
fn field<T>(
    fields: &mut Fields,
    name: &str,
    read: fn(&Value) -> Result<T, FieldFault>,
) -> Result<Option<T>, String> {
    let wrong = |fault: FieldFault| format!("{name}: {fault}");
    let value = fields.take(name).map_err(wrong)?;
    value.as_ref().map(read).transpose().map_err(wrong)
}

fn text(value: &Value) -> Result<String, FieldFault> {
    value.as_str().map(str::to_owned).ok_or(FieldFault::Type)
}

fn flag(value: &Value) -> Result<bool, FieldFault> {
    value.as_bool().ok_or(FieldFault::Type)
}

fn list(value: &Value) -> Result<Vec<Value>, FieldFault> {
    value.as_array().cloned().ok_or(FieldFault::Type)
}

fn rates(fields: &mut Fields) -> Result<PollRates, String> {
    let state_hz = field(fields, "state_hz", fields::number)?;
    let state_hz = state_hz.filter(|hz| (1.0..=1000.0).contains(hz));
    let state_hz = state_hz.ok_or("state_hz: not a rate of 1 to 1000 states a second")?;
    let default = PollRates::default();
    let target_hz = field(fields, "target_hz", fields::number)?.unwrap_or(default.settings_hz);
    if !(1.0..=100.0).contains(&target_hz) {
        return Err("target_hz: not a rate of 1 to 100 a second".into());
    }
    Ok(PollRates {
        state_hz,
        tactile_hz: default.tactile_hz.max(state_hz / 8.0),
        settings_hz: target_hz,
    })
}

fn targets(fields: &mut Fields) -> Result<Targets, String> {
    let angles = field(fields, "angle", list)?.unwrap_or_default();
    if angles.len() != Dof::ALL.len() {
        return Err(
            "angle: a hand has six joints: give each an angle, or null to leave it unchanged"
                .into(),
        );
    }
    let mut targets = PerDof::splat(None);
    for (dof, angle) in Dof::ALL.into_iter().zip(&angles) {
        if angle.is_null() {
            continue;
        }
        let name = dof.name();
        let angle = fields::whole(angle).map_err(|fault| format!("angle, {name}: {fault}"))?;
        let angle = Angle::new(angle).map_err(|error| format!("angle, {name}: {error}"))?;
        targets[dof] = Some(angle);
    }
    if targets == PerDof::splat(None) {
        return Err("angle: no joint is to be moved".into());
    }
    Ok(targets)
}

fn gesture(fields: &mut Fields) -> Result<Gesture, String> {
    let number = field(fields, "number", fields::whole)?.ok_or("number: no gesture is named")?;
    Gesture::new(number).map_err(|error| format!("number: {error}"))
}

fn moving_speed(fields: &mut Fields) -> Result<Option<Speed>, String> {
    let speed = field(fields, "speed", fields::whole)?.map(Speed::new);
    let speed = speed.transpose().map_err(|error| error.to_string());
    let speed = speed.and_then(|speed| speed.map(moving).transpose());
    speed.map_err(|why| format!("speed: {why}"))
}

fn rated_force(fields: &mut Fields) -> Result<Option<Force>, String> {
    let force = field(fields, "force_g", fields::whole)?.map(Force::new);
    let force = force.transpose().map_err(|error| error.to_string());
    let force = force.and_then(|force| force.map(rated).transpose());
    force.map_err(|why| format!("force_g: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    include!("../../../../tests/odd_stops.rs");

    fn parse(line: &str) -> Result<StdioRequest, String> {
        StdioLine::parse(line.as_bytes(), Side::Right).what
    }

    #[test]
    fn what_is_not_said_is_as_armed_and_null_leaves_a_joint_alone() {
        let parsed = StdioLine::parse(
            br#"{"id":7,"do":"move","angle":[0,null,null,400.0,null,1e3]}"#,
            Side::Right,
        );
        assert_eq!(parsed.id, 7);
        let Ok(StdioRequest::Move(request)) = parsed.what else {
            panic!("{parsed:?}")
        };
        let counts = request.targets.map(|to| to.map(Angle::get));
        let want = [Some(0), None, None, Some(400), None, Some(1000)];
        assert_eq!(Dof::ALL.map(|dof| counts[dof]), want);
        assert_eq!(
            (request.limits.speed, request.limits.force, request.settles),
            (None, None, false)
        );
        let armed = parse(r#"{"do":"arm","speed":50}"#);
        let Ok(StdioRequest::Arm(limits)) = armed else {
            panic!("{armed:?}")
        };
        let before = ArmRequest {
            speed: PerDof::splat(Speed::nearest(700)),
            force: PerDof::splat(Force::nearest(120)),
        };
        let limits = limits.over(before);
        assert_eq!(limits.speed, PerDof::splat(Speed::nearest(50)));
        assert_eq!(limits.force, before.force, "not named");
        assert!(matches!(
            parse(r#"{"right":[1,1,1,1,1,1],"seq":1}"#),
            Ok(StdioRequest::Follow(_))
        ));
        assert_eq!(
            parse(r#"{"do":"record","path":null}"#),
            Ok(StdioRequest::Record(None))
        );
    }

    #[test]
    fn what_is_wrong_is_refused_in_a_sentence_and_its_id_is_kept() {
        for (line, why) in [
            (r#"{"id":1,"do":"move","angle":[0,0,0,0,0]}"#, "six joints"),
            (
                r#"{"id":1,"do":"move","angle":[0,0,0,1001,0,0]}"#,
                "index: ",
            ),
            (
                r#"{"id":1,"do":"move","angle":[null,null,null,null,null,null]}"#,
                "no joint",
            ),
            (
                r#"{"id":1,"do":"move","angle":[0,0,0,0,0,0],"speed":0}"#,
                "speed of 0",
            ),
            (
                r#"{"id":1,"do":"move","angle":[0,0,0,0,0,0],"force_g":2001}"#,
                "rated for 2000 g",
            ),
            (r#"{"id":1,"do":"arm","speed":1001}"#, "1001"),
            (r#"{"id":1,"do":"rate","state_hz":0}"#, "1 to 1000"),
            (
                r#"{"id":1,"do":"rate","state_hz":100,"target_hz":0}"#,
                "target_hz: not a rate",
            ),
            (r#"{"id":1,"do":"pose"}"#, "no pose is named"),
            (r#"{"id":1,"do":"gesture"}"#, "no gesture is named"),
            (r#"{"id":1,"do":"gesture","number":41}"#, "number: "),
            (
                r#"{"id":1,"do":"gesture","number":3,"angle":[0,0,0,0,0,0]}"#,
                "angle: not a field of gesture",
            ),
            (r#"{"id":1,"do":"fly"}"#, "help share"),
            (
                r#"{"id":1,"do":"arm","now":true}"#,
                "now: not a field of arm",
            ),
            (r#"{"id":1,"do":"arm","v":2}"#, "v: its version"),
            (
                r#"{"id":1,"do":"arm","speed":50.5}"#,
                "speed: has another type",
            ),
            (
                r#"{"id":1,"do":"arm","speed":5,"speed":6}"#,
                "speed: is duplicated",
            ),
            (
                r#"{"id":1,"do":"move","angle":"fist"}"#,
                "angle: has another type",
            ),
            (
                r#"{"id":1,"do":"move","angle":[0,0,0,"0",0,0]}"#,
                "angle, index: has another type",
            ),
            (
                r#"{"id":1,"do":"move","angle":[NaN,0,0,0,0,0]}"#,
                "not a JSON object",
            ),
            (r#"{"id":1,"right":[2,1,1,1,1,1]}"#, "0 (bent) to 1 (open)"),
        ] {
            let parsed = StdioLine::parse(line.as_bytes(), Side::Right);
            assert_eq!(parsed.id, 1, "{line}");
            let why_not = parsed.what.unwrap_err();
            assert!(why_not.contains(why), "{line}: {why_not}");
        }
        assert!(parse("[1]").unwrap_err().contains("not a JSON object"));
    }

    #[test]
    fn a_dead_man_that_is_let_go_counts_whatever_is_wrong_beside_it() {
        for line in [
            r#"{"id":1,"held":false}"#,
            r#"{"id":1,"held":false,"right":[NaN]}"#,
            r#"{"id":1,"held":false,"x":}"#,
            r#"{"id":1,"do":"move","held":false}"#,
        ] {
            let parsed = StdioLine::parse(line.as_bytes(), Side::Right);
            let Ok(StdioRequest::Follow(follow)) = parsed.what else {
                panic!("{line}: {parsed:?}");
            };
            assert_eq!(
                (follow.held, parsed.id),
                (Some(false), Value::from(1)),
                "{line}"
            );
        }
    }

    #[test]
    fn what_ends_a_motion_is_obeyed_whatever_else_is_in_its_line() {
        for text in odd_stops() {
            let parsed = StdioLine::parse(&text, Side::Right);
            let shown = String::from_utf8_lossy(&text);
            assert_eq!(parsed.what, Ok(StdioRequest::Stop), "{shown}");
        }
        for (line, request, odd) in [
            (r#"{"id":1,"do":"stop"}"#, StdioRequest::Stop, None),
            (r#"{"id":1,"stop":true}"#, StdioRequest::Stop, None),
            (r#"{"id":1,"do":"stop","v":1}"#, StdioRequest::Stop, None),
            (
                r#"{"id":1,"do":"stop","why":"operator"}"#,
                StdioRequest::Stop,
                Some("why"),
            ),
            (
                r#"{"id":1,"do":"stop","v":2}"#,
                StdioRequest::Stop,
                Some("v: "),
            ),
            (
                r#"{"id":1,"do":"stop","t":NaN}"#,
                StdioRequest::Stop,
                Some("not a JSON"),
            ),
            (r#"{"id":1,"do":"STOP"}"#, StdioRequest::Stop, Some("STOP")),
            (
                r#"{"id":1,"do":"move","do":"stop"}"#,
                StdioRequest::Stop,
                Some("do: is duplicated"),
            ),
            (
                r#"{"id":1,"do":"arm","stop":true}"#,
                StdioRequest::Stop,
                Some("stop"),
            ),
            (
                r#"{"id":1,"stop":true,"right":[NaN]}"#,
                StdioRequest::Stop,
                Some("not a JSON"),
            ),
            (
                r#"{"id":1,"do":"release","t":NaN}"#,
                StdioRequest::Release,
                Some("not a JSON"),
            ),
            (
                r#"{"id":1,"do":"disarm","by":"me"}"#,
                StdioRequest::Disarm,
                Some("by"),
            ),
        ] {
            let parsed = StdioLine::parse(line.as_bytes(), Side::Right);
            assert_eq!(
                (&parsed.what, &parsed.id),
                (&Ok(request), &1.into()),
                "{line}"
            );
            let is_same = match (&parsed.odd, odd) {
                (Some(own), Some(odd)) => own.contains(odd),
                (own, odd) => own.is_none() && odd.is_none(),
            };
            assert!(is_same, "{line}: {:?}", parsed.odd);
        }
    }
}
