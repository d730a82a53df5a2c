//! What a program asks of a hand on standard input, one JSON object a line. Pure; a contract with scripts
//! (`handscope help share`).

use crate::cli::parse::{moving, rated};
use crate::hand::kinematics::Side;
use crate::hand::{Angle, Dof, Force, PerDof, Speed};
use crate::inputs::line::StreamLine;
use crate::link::{ArmRequest, PollRates};
use crate::poses::way::Targets;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::path::PathBuf;

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Asked {
    /// What its answer is marked with; `null` unless it has one.
    pub(crate) id: Value,
    pub(crate) what: Result<Ask, String>,
}

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Ask {
    /// To move the hand from now on, beginning with these speeds and force thresholds.
    Arm(ArmRequest),
    Move(MoveAsk),
    /// A target to be followed, as lines of `follow` have it.
    Follow(StreamLine),
    /// The hand stops, whoever moves it, and is not armed any more.
    Stop,
    /// The same, unless another moves it now.
    Release,
    /// The hand is not armed any more, and keeps its targets: a program on the gateway may move it.
    Disarm,
    /// A fault is cleared; that moves nothing.
    Clear,
    /// How often the hand is read.
    Rate(PollRates),
    /// A recording begins here, or with `None` ends.
    Record(Option<PathBuf>),
}

/// A motion to targets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MoveAsk {
    pub(crate) targets: Targets,
    pub(crate) speed: Speed,
    pub(crate) force: Force,
    pub(crate) settles: bool,
}

#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
enum Raw {
    Arm {
        speed: Option<i64>,
        force_g: Option<i64>,
    },
    Move {
        angle: Vec<Option<i64>>,
        speed: Option<i64>,
        force_g: Option<i64>,
        #[serde(default)]
        settle: bool,
    },
    Stop {},
    Release {},
    Disarm {},
    Clear {},
    Rate {
        state_hz: f64,
    },
    Record {
        path: Option<PathBuf>,
    },
}

impl Asked {
    /// Reads one line for the hand of this side.
    pub(crate) fn parse(line: &str, side: Side) -> Self {
        let mut fields: Map<String, Value> = match serde_json::from_str(line) {
            Ok(fields) => fields,
            Err(error) => {
                return Self {
                    id: Value::Null,
                    what: Err(format!("not a JSON object: {error}")),
                };
            }
        };
        let id = fields.remove("id").unwrap_or_default();
        let what = if fields.contains_key("do") {
            serde_json::from_value(Value::Object(fields))
                .map_err(|error| format!("{error}; 'handscope help share' tells what can be asked"))
                .and_then(ask)
        } else {
            let line = StreamLine::parse(line.as_bytes(), side);
            line.map(Ask::Follow).map_err(|fault| fault.to_string())
        };
        Self { id, what }
    }
}

fn ask(raw: Raw) -> Result<Ask, String> {
    Ok(match raw {
        Raw::Arm { speed, force_g } => Ask::Arm(ArmRequest {
            speed: PerDof::splat(moving_speed(speed)?),
            force: PerDof::splat(rated_force(force_g)?),
        }),
        Raw::Move {
            angle,
            speed,
            force_g,
            settle,
        } => Ask::Move(MoveAsk {
            targets: targets(&angle)?,
            speed: moving_speed(speed)?,
            force: rated_force(force_g)?,
            settles: settle,
        }),
        Raw::Stop {} => Ask::Stop,
        Raw::Release {} => Ask::Release,
        Raw::Disarm {} => Ask::Disarm,
        Raw::Clear {} => Ask::Clear,
        Raw::Rate { state_hz } if (1.0..=1000.0).contains(&state_hz) => Ask::Rate(PollRates {
            state_hz,
            tactile_hz: PollRates::default().tactile_hz.max(state_hz / 8.0),
            ..PollRates::default()
        }),
        Raw::Rate { state_hz } => {
            return Err(format!(
                "{state_hz} is not a rate of 1 to 1000 states a second"
            ));
        }
        Raw::Record { path } => Ask::Record(path),
    })
}

fn targets(angles: &[Option<i64>]) -> Result<Targets, String> {
    if angles.len() != Dof::ALL.len() {
        return Err("a hand has six joints: give each an angle, or null to leave it alone".into());
    }
    let mut targets = PerDof::splat(None);
    for (dof, angle) in Dof::ALL.into_iter().zip(angles) {
        let told = |error| format!("{}: {error}", dof.name());
        targets[dof] = angle.map(Angle::new).transpose().map_err(told)?;
    }
    if targets == PerDof::splat(None) {
        return Err("no joint is to be moved".into());
    }
    Ok(targets)
}

/// Gentle, where none is asked for.
fn moving_speed(speed: Option<i64>) -> Result<Speed, String> {
    let speed = speed.map_or(Ok(Speed::GENTLE), Speed::new);
    speed.map_err(|error| error.to_string()).and_then(moving)
}

/// Gentle, where none is asked for.
fn rated_force(grams: Option<i64>) -> Result<Force, String> {
    let force = grams.map_or(Ok(Force::GENTLE), Force::new);
    force.map_err(|error| error.to_string()).and_then(rated)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Ask, String> {
        Asked::parse(line, Side::Right).what
    }

    #[test]
    fn what_is_not_said_is_gentle_and_null_leaves_a_joint_alone() {
        let asked = Asked::parse(
            r#"{"id":7,"do":"move","angle":[0,null,null,400,null,1000]}"#,
            Side::Right,
        );
        assert_eq!(asked.id, 7);
        let Ok(Ask::Move(ask)) = asked.what else {
            panic!("{asked:?}")
        };
        let counts = ask.targets.map(|to| to.map(Angle::get));
        let want = [Some(0), None, None, Some(400), None, Some(1000)];
        assert_eq!(Dof::ALL.map(|dof| counts[dof]), want);
        assert_eq!(
            (ask.speed, ask.force, ask.settles),
            (Speed::GENTLE, Force::GENTLE, false)
        );
        let armed = parse(r#"{"do":"arm","speed":50}"#);
        let Ok(Ask::Arm(limits)) = armed else {
            panic!("{armed:?}")
        };
        assert_eq!(limits.speed, PerDof::splat(Speed::nearest(50)));
        assert!(matches!(
            parse(r#"{"right":[1,1,1,1,1,1],"seq":1}"#),
            Ok(Ask::Follow(_))
        ));
        assert_eq!(
            parse(r#"{"do":"record","path":null}"#),
            Ok(Ask::Record(None))
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
            (r#"{"id":1,"do":"fly"}"#, "help share"),
            (r#"{"id":1,"do":"stop","now":true}"#, "now"),
            (r#"{"id":1,"right":[2,1,1,1,1,1]}"#, "0 (bent) to 1 (open)"),
        ] {
            let asked = Asked::parse(line, Side::Right);
            assert_eq!(asked.id, 1, "{line}");
            let told = asked.what.unwrap_err();
            assert!(told.contains(why), "{line}: {told}");
        }
        assert!(parse("[1]").unwrap_err().contains("not a JSON object"));
    }
}
