//! Samples and statistics as the JSON lines and the text of `watch`. Pure; a contract with scripts.

use crate::hand::feedback::tactile::NO_DIRECTION;
use crate::hand::grip::{Grip, GripEstimate};
use crate::hand::kinematics::driven_radians;
use crate::hand::newtons::newtons;
use crate::hand::units::decimal;
use crate::hand::{
    Fault, Faults, Finger, Force, Group, HandSample, Moment, PerDof, PositionReading, Quantity,
    RateClass, Speed, Status, TactileBlock,
};
use crate::link::{LineUse, LinkStats};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::time::Duration;

/// One sample and its grip as one JSON object. Values that are unread or outside the manual's ranges are null.
pub(crate) fn sample_json(sample: &HandSample, grip: &Grip, at: Moment) -> Value {
    let status = sample.status.map(|status| status.value);
    let faults = sample.faults.map(|faults| faults.value);
    let position = sample.position.map(|position| position.value);
    let angle = Quantity::Angle.documented(sample).map(|six| six.value);
    let radians =
        angle.map(|angle| PerDof::from_fn(|dof| Some(rounded(driven_radians(dof, angle[dof]?)))));
    let speed = sample.speed_set.map(|speed| speed.value);
    let threshold = sample.force_set.map(|force| force.value);
    let tactile = sample.tactile.iter();
    let tactile = tactile
        .map(|(finger, block)| tactile_json(finger, block.map(|block| block.value).as_ref()));
    let mut object = json!({
        "t_s": at.secs(),
        "angle_rad": radians,
        "position": position.map(|six| six.map(PositionReading::documented)),
        "status": status.map(|six| six.map(|status| status.name())),
        "status_raw": status.map(|six| six.map(Status::raw)),
        "faults": faults.map(|six| six.map(fault_names)),
        "error_raw": faults.map(|six| six.map(Faults::raw)),
        "tactile": tactile.collect::<Vec<_>>(),
        "grip": grip_json(&grip.at(at), at),
        "target_angle": Quantity::TargetAngle.documented(sample).map(|six| six.value),
        "target_speed": speed.map(|six| six.map(|speed| speed.map(Speed::get))),
        "force_threshold_g": threshold.map(|six| six.map(|force| force.map(Force::get))),
        "undocumented": undocumented_json(sample),
    });
    let measured = Quantity::MEASURED.map(|quantity| {
        let six = quantity.documented(sample).map(|six| six.value);
        (quantity.row().json_name.to_owned(), json!(six))
    });
    if let Value::Object(fields) = &mut object {
        fields.extend(measured);
    }
    object
}

/// One sample as `watch` prints it: with forces in newtons, null where they are unknown.
pub(crate) fn watch_json(
    sample: &HandSample,
    grip: &Grip,
    newtons_per_g: &PerDof<Option<f64>>,
    at: Moment,
) -> Value {
    let mut object = sample_json(sample, grip, at);
    let force = sample.force.map(|force| force.value);
    let force_n = force.map(|force| {
        PerDof::from_fn(|dof| {
            let grams = f64::from(force[dof].documented()?);
            Some(newtons(grams, newtons_per_g[dof]?))
        })
    });
    if let Value::Object(fields) = &mut object {
        fields.insert("force_n".into(), json!(force_n));
    }
    object
}

/// Values outside the manual's ranges: their field in the object, their joint or finger, and the number that the hand sent; null if it
/// is not stored, or no number.
fn undocumented_json(sample: &HandSample) -> Value {
    let joints = sample.undocumented(Group::ALL.into_iter().collect());
    let joints = joints.map(
        |value| json!({"field": field(value.group), "joint": value.dof.name(), "raw": value.raw}),
    );
    let tips = sample.tactile.iter();
    let tips = tips.flat_map(|(finger, block)| {
        let block = block.map(|block| block.value);
        let force = |number: f32| json!(number.is_finite().then(|| decimal(number)));
        let fields = block.map(|block| {
            let turn = block.direction_raw;
            let turns = block.direction_deg().is_some() || turn == NO_DIRECTION;
            [
                ("normal_n", block.normal().is_some(), force(block.normal_n)),
                (
                    "tangential_n",
                    block.tangential().is_some(),
                    force(block.tangential_n),
                ),
                ("direction_deg", turns, json!(turn)),
            ]
        });
        let fields = fields.into_iter().flatten().filter(|field| !field.1);
        fields.map(
            move |(field, _, raw)| json!({"field": field, "finger": finger.name(), "raw": raw}),
        )
    });
    joints.chain(tips).collect()
}

/// Field of a group's values in the object.
const fn field(group: Group) -> &'static str {
    match group {
        Group::AngleSet => "target_angle",
        Group::ForceSet => "force_threshold_g",
        Group::SpeedSet => "target_speed",
        Group::Position => "position",
        Group::Angle => Quantity::Angle.row().json_name,
        Group::Force => Quantity::Force.row().json_name,
        Group::Current => Quantity::Current.row().json_name,
        Group::Temperature => Quantity::Temperature.row().json_name,
        Group::Faults => "error_raw",
        Group::Status => "status_raw",
        Group::Tactile(_) => "tactile",
    }
}

/// A grip as JSON: state, start and age of the grasp and of each finger.
pub(crate) fn grip_json(grip: &Grip, now: Moment) -> Value {
    let mut object = estimate_json(&grip.grasp, now);
    let fingers = grip.fingers.iter().map(|(finger, estimate)| {
        let mut object = estimate_json(estimate, now);
        object.insert("finger".into(), finger.name().into());
        Value::Object(object)
    });
    object.insert("fingers".into(), fingers.collect());
    Value::Object(object)
}

fn estimate_json(estimate: &GripEstimate, now: Moment) -> Map<String, Value> {
    let age_s = estimate.age(now).map(|age| age.as_secs_f64());
    let fields = [
        ("state", json!(estimate.state)),
        ("since_s", json!(estimate.since.secs())),
        ("age_s", json!(age_s)),
    ];
    fields
        .map(|(key, value)| (key.to_owned(), value))
        .into_iter()
        .collect()
}

/// The last line: the link's own statistics.
pub(crate) fn stats_json(stats: &LinkStats, elapsed: Duration) -> Value {
    json!({"stats": {
        "elapsed_s": elapsed.as_secs_f64(),
        "state_reads": stats.state_reads,
        "tactile_reads": stats.tactile_reads,
        "state_hz": rounded(stats.state_hz),
        "tactile_hz": rounded(stats.tactile_hz),
        "rtt_ms": {"p50": millis(stats.rtt_p50), "p99": millis(stats.rtt_p99)},
        "timeouts": stats.timeouts,
        "checksum_errors": stats.checksum_errors,
        "resyncs": stats.resyncs,
        "foreign_replies": stats.foreign_replies,
        "late_replies": stats.late_replies,
        "foreign_requests": stats.foreign_requests,
        "refusals": stats.refusals,
        "implausible": stats.implausible,
        "reconnects": stats.reconnects,
        "writes": stats.writes,
        "dropped_samples": stats.dropped_events,
        "stalls": stalls_json(stats),
        "line": line_json(&stats.line),
    }})
}

/// Stalls, in which this program could not serve the wire.
pub(crate) fn stalls_json(stats: &LinkStats) -> Value {
    json!({
        "count": stats.stalls,
        "total_ms": millis(Some(stats.stalled)),
        "longest_ms": millis(Some(stats.longest_stall)),
    })
}

fn line_json(line: &LineUse) -> Value {
    let groups = RateClass::ALL.into_iter().zip(&line.groups);
    let groups: Map<String, Value> = groups
        .map(|(group, used)| {
            let value = json!({
                "hz": rounded(used.hz),
                "share": rounded(used.share),
                "could_hz": rounded(used.could_hz),
            });
            (group_name(group).to_owned(), value)
        })
        .collect();
    json!({
        "utilisation": rounded(line.utilisation),
        "on_wire": line.on_wire.map(rounded),
        "turnaround_ms": millis(line.turnaround),
        "writes_share": rounded(line.writes),
        "split_at_gap": line.split,
        "groups": groups,
    })
}

const fn group_name(group: RateClass) -> &'static str {
    match group {
        RateClass::Motion => "motion",
        RateClass::Drives => "drives",
        RateClass::Temperature => "temperature",
        RateClass::Tactile => "tactile",
        RateClass::Settings => "settings",
    }
}

/// Use of the line, as text.
fn line_text(line: &LineUse) -> String {
    let percent = |share: f64| format!("{:.0} %", share * 100.0);
    let mut text = format!("line {} used", percent(line.utilisation));
    if let Some(on_wire) = line.on_wire {
        let _infallible = write!(text, ", bits on it {}", percent(on_wire));
    }
    if let Some(ms) = millis(line.turnaround) {
        let _infallible = write!(text, ", turnaround {ms:.2} ms");
    }
    for (group, used) in RateClass::ALL.into_iter().zip(&line.groups) {
        let (name, share) = (group_name(group), percent(used.share));
        let _infallible = write!(text, "; {name} {:.1} Hz, {share}", used.hz);
    }
    text
}

/// One sample as one line of text.
pub(crate) fn sample_text(sample: &HandSample, at: Moment) -> String {
    let status = sample.status.map(|six| six.value.map(status_name));
    let mut parts = vec![format!("{:9.3} s", at.secs())];
    for (quantity, width) in Quantity::MEASURED.into_iter().zip([4, 5, 4, 3]) {
        let row = quantity.row();
        let (name, unit) = (row.json_name.split('_').next(), row.unit);
        let space = if unit.is_empty() { "" } else { " " };
        let values = quantity.documented(sample).map(|six| {
            six.value
                .map(|value| value.map_or_else(|| "-".into(), |value| value.to_string()))
        });
        let values = values.map(|six| six.map(|value| format!("{value:>width$}")));
        let name = name.unwrap_or_default();
        parts.push(format!("{name} {}{space}{unit}", joined(values)));
    }
    parts.push(format!("status {}", joined(status)));
    if sample.has_fault() {
        let faults = sample.faults.map(|six| six.value.map(fault_words));
        parts.push(format!("faults {}", joined(faults)));
    }
    let measured = Quantity::MEASURED.map(Quantity::group).into_iter();
    let outside = sample.undocumented(measured.collect());
    let outside: Vec<String> = outside.map(|value| value.to_string()).collect();
    if !outside.is_empty() {
        parts.push(format!("undocumented {}", outside.join(" ")));
    }
    parts.join("  ")
}

fn joined(words: Option<PerDof<String>>) -> String {
    words.map_or_else(|| "-".into(), |words| words.as_array().join(" "))
}

/// The statistics as lines of text.
pub(crate) fn stats_text(stats: &LinkStats, elapsed: Duration) -> String {
    let rtt = |value: Option<Duration>| {
        millis(value).map_or_else(|| "-".into(), |ms| format!("{ms:.2} ms"))
    };
    format!(
        "{:.1} s: {} states ({:.1} a second), {} touch sweeps ({:.1} a second), round trip {} (99 %: {})\n\
         {} timeouts, {} checksum errors, {} resyncs, {} foreign replies, {} late replies, {} refusals, {} implausible, {} reconnects\n\
         {}",
        elapsed.as_secs_f64(),
        stats.state_reads,
        stats.state_hz,
        stats.tactile_reads,
        stats.tactile_hz,
        rtt(stats.rtt_p50),
        rtt(stats.rtt_p99),
        stats.timeouts,
        stats.checksum_errors,
        stats.resyncs,
        stats.foreign_replies,
        stats.late_replies,
        stats.refusals,
        stats.implausible,
        stats.reconnects,
        line_text(&stats.line),
    )
}

/// One fingertip as JSON; all null if it was not read.
pub(crate) fn tactile_json(finger: Finger, block: Option<&TactileBlock>) -> Value {
    json!({
        "finger": finger.name(),
        "raw": block.map(|block| block.raw),
        "normal_n": block.and_then(TactileBlock::normal).map(decimal),
        "normal_delta": block.map(|block| block.normal_delta),
        "tangential_n": block.and_then(TactileBlock::tangential).map(decimal),
        "tangential_delta": block.map(|block| block.tangential_delta),
        "direction_deg": block.and_then(TactileBlock::direction_deg),
        "proximity": block.map(|block| block.proximity),
        "check_ok": block.map(TactileBlock::check_ok),
    })
}

/// A status in one word; an undocumented code includes its number.
pub(crate) fn status_name(status: Status) -> String {
    match status {
        Status::Unknown(raw) => format!("unknown({raw})"),
        known => known.name().into(),
    }
}

/// The faults of one joint, lowest bit first.
pub(crate) fn fault_names(faults: Faults) -> Vec<&'static str> {
    faults.iter().map(Fault::name).collect()
}

fn fault_words(faults: Faults) -> String {
    match fault_names(faults) {
        names if names.is_empty() => "none".into(),
        names => names.join("+"),
    }
}

fn millis(value: Option<Duration>) -> Option<f64> {
    value.map(|value| rounded(value.as_secs_f64() * 1000.0))
}

/// Rounds to three decimals: more is noise.
fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::grip::GripState;
    use crate::hand::{AngleReading, Dof, ForceReading, PerFinger, Reply, Timed, register};

    #[test]
    fn what_was_not_read_is_null() {
        let json = sample_json(
            &HandSample::default(),
            &Grip::default(),
            Moment::from_micros(1_500_000),
        );
        assert_eq!(json["t_s"], 1.5);
        for key in [
            "angle",
            "position",
            "force_g",
            "current_ma",
            "temp_c",
            "status",
            "status_raw",
            "faults",
            "error_raw",
        ] {
            assert!(json[key].is_null(), "{key}");
        }
        assert_eq!(json["tactile"].as_array().unwrap().len(), 5);
        assert_eq!(json["tactile"][0]["finger"], "little");
        assert!(json["tactile"][4]["raw"].is_null());
    }

    #[test]
    fn a_grip_has_state_beginning_and_age_and_is_unknown_when_it_is_old() {
        let asked = Moment::from_micros(1_000_000);
        let held = GripEstimate {
            state: GripState::Holding,
            since: asked,
            asked: Some(asked),
        };
        let grip = Grip {
            fingers: PerFinger::splat(held),
            grasp: GripEstimate::default(),
            fresh_for: Duration::from_millis(500),
        };
        let at = |micros| Moment::from_micros(micros);
        let json = sample_json(&HandSample::default(), &grip, at(1_250_000));
        let grip_then = &json["grip"];
        assert_eq!(grip_then["state"], "unknown");
        assert!(grip_then["age_s"].is_null());
        let thumb = json!({"finger": "thumb", "state": "holding", "since_s": 1.0, "age_s": 0.25});
        assert_eq!(grip_then["fingers"][4], thumb);
        let json = sample_json(&HandSample::default(), &grip, at(1_750_000));
        assert_eq!(json["grip"]["fingers"][0]["state"], "unknown");
    }

    #[test]
    fn six_values_stand_in_register_order_with_names_and_raw_codes() {
        let mut bytes = [0u8; 78];
        bytes[0..2].copy_from_slice(&1000i16.to_le_bytes());
        bytes[10..12].copy_from_slice(&7i16.to_le_bytes());
        bytes[60] = 0x06;
        bytes[66] = 3;
        bytes[67] = 4;
        bytes[77] = 255;
        let mut sample = HandSample::default();
        let at = Moment::ZERO;
        sample.apply(&Reply {
            span: register::STATE,
            bytes: &bytes,
            asked: at,
            received: at,
        });
        let json = sample_json(&sample, &Grip::default(), at);
        assert_eq!(json["angle"], json!([1000, 0, 0, 0, 0, 7]));
        assert_eq!(
            json["faults"][0],
            json!(["over_temperature", "over_current"])
        );
        assert_eq!(json["error_raw"][0], 6);
        assert_eq!(json["status"][0], "force_reached");
        assert_eq!(json["status"][1], "unknown");
        assert_eq!(json["status_raw"][1], 4);
        assert_eq!(json["temp_c"][5], Value::Null);
        let cold = json!([{"field": "temp_c", "joint": "thumb_rotate", "raw": 255}]);
        assert_eq!(json["undocumented"], cold);
        assert!(json["position"].is_null());
        assert!(sample_text(&sample, at).contains("over_temperature+over_current"));
    }

    #[test]
    fn a_value_outside_the_manual_is_no_value_and_its_number_is_told() {
        let at = Moment::ZERO;
        fn timed<T>(value: T) -> Option<Timed<T>> {
            let (asked, received) = (Moment::ZERO, Moment::ZERO);
            Some(Timed {
                value,
                asked,
                received,
            })
        }
        let mut sample = HandSample {
            angle: timed(PerDof::new([1000, 0, -7, 32767, 1013, 5]).map(AngleReading::new)),
            force: timed(PerDof::new([0, 0, 0, -32768, 0, 4000]).map(ForceReading::new)),
            position: timed(PerDof::new([0, 2000, -1, 0, 0, 0]).map(PositionReading::new)),
            speed_set: timed(
                PerDof::new([Some(25), None, Some(0), Some(1000), None, Some(1)])
                    .map(|speed| speed.and_then(|speed| Speed::new(speed).ok())),
            ),
            ..HandSample::default()
        };
        let plain = TactileBlock::decode(&[0; 58]).unwrap();
        let odd = TactileBlock {
            normal_n: f32::NAN,
            tangential_n: 3e38,
            direction_raw: 400,
            ..plain
        };
        let free = TactileBlock {
            direction_raw: 65535,
            normal_n: 20.0,
            ..plain
        };
        sample.tactile[Finger::Ring] = timed(odd);
        sample.tactile[Finger::Thumb] = timed(free);
        let json = sample_json(&sample, &Grip::default(), at);
        assert_eq!(json["angle"], json!([1000, 0, null, null, null, 5]));
        assert_eq!(json["force_g"], json!([0, 0, 0, null, 0, 4000]));
        assert_eq!(json["position"], json!([0, 2000, null, 0, 0, 0]));
        let turned = &json["angle_rad"];
        assert_eq!(turned[0], 0.0, "open");
        assert!(
            turned[1].as_f64().unwrap() > 1.0 && turned[3].is_null(),
            "{turned}"
        );
        assert_eq!(json["target_speed"], json!([25, null, 0, 1000, null, 1]));
        let ring = &json["tactile"][1];
        for field in ["normal_n", "tangential_n", "direction_deg"] {
            assert!(ring[field].is_null(), "{field}");
        }
        assert_eq!(json["tactile"][4]["normal_n"], 20.0);
        let joint = |field: &str, joint: &str, raw: Value| json!({"field": field, "joint": joint, "raw": raw});
        let tip = |field: &str, raw: Value| json!({"field": field, "finger": "ring", "raw": raw});
        let all = json!([
            joint("target_speed", "ring", Value::Null),
            joint("target_speed", "thumb_bend", Value::Null),
            joint("position", "middle", json!(-1)),
            joint("angle", "middle", json!(-7)),
            joint("angle", "index", json!(32767)),
            joint("angle", "thumb_bend", json!(1013)),
            joint("force_g", "index", json!(-32768)),
            tip("normal_n", Value::Null),
            tip("tangential_n", json!(3e38)),
            tip("direction_deg", json!(400)),
        ]);
        assert_eq!(json["undocumented"], all);
        let text = sample_text(&sample, at);
        assert!(
            text.contains("undocumented angle[2]=-7 angle[3]=32767"),
            "{text}"
        );
        assert!(!text.replace("=32767", "").contains("32767"), "{text}");
        let per_g = PerDof::splat(Some(0.01));
        let newtons = watch_json(&sample, &Grip::default(), &per_g, at)["force_n"].clone();
        assert_eq!(newtons, json!([0.0, 0.0, 0.0, null, 0.0, 40.0]));
    }

    #[test]
    fn newtons_stand_beside_the_grams_where_they_are_known() {
        let mut sample = HandSample::default();
        let mut per_g = PerDof::splat(None);
        per_g[Dof::Index] = Some(0.0071);
        let at = Moment::ZERO;
        let json = |sample: &HandSample| watch_json(sample, &Grip::default(), &per_g, at);
        assert!(json(&sample)["force_n"].is_null());
        sample.force = Some(Timed {
            value: PerDof::splat(ForceReading::new(500)),
            asked: at,
            received: at,
        });
        let json = json(&sample);
        assert_eq!(json["force_n"], json!([null, null, null, 3.55, null, null]));
        assert_eq!(json["force_g"][3], 500);
    }

    #[test]
    fn the_statistics_have_the_documented_keys() {
        let json = stats_json(&LinkStats::default(), Duration::from_secs(5));
        for key in [
            "elapsed_s",
            "state_reads",
            "tactile_reads",
            "state_hz",
            "tactile_hz",
            "rtt_ms",
            "timeouts",
            "checksum_errors",
            "resyncs",
            "reconnects",
            "stalls",
            "line",
        ] {
            assert!(!json["stats"][key].is_null(), "{key}");
        }
        assert!(json["stats"]["rtt_ms"]["p50"].is_null());
        let line = &json["stats"]["line"];
        assert_eq!(line["utilisation"], 0.0);
        assert!(line["on_wire"].is_null() && line["turnaround_ms"].is_null());
        for group in ["motion", "drives", "temperature", "tactile", "settings"] {
            for key in ["hz", "share", "could_hz"] {
                assert!(line["groups"][group][key].is_number(), "{group} {key}");
            }
        }
    }
}
