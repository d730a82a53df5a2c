//! One quantity of one joint over time: known values only, in order of time. Detects nothing.

use crate::hand::Dof;
use crate::history::decimated;
use crate::trials::recording::{SampleRow, TipSample, TrialRecording, seconds};

/// A value and its time of arrival.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Seconds from the closing command.
    pub t: f64,
    /// In the unit of the curve.
    pub v: f64,
}

/// Values in order of time, without gaps for missing readings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TimeSeries(Vec<CurvePoint>);

impl FromIterator<(f64, f64)> for TimeSeries {
    fn from_iter<I: IntoIterator<Item = (f64, f64)>>(points: I) -> Self {
        let known = |(t, v): &(f64, f64)| t.is_finite() && v.is_finite();
        let points = points.into_iter().filter(known);
        Self(points.map(|(t, v)| CurvePoint { t, v }).collect())
    }
}

impl TimeSeries {
    /// All points.
    pub fn points(&self) -> &[CurvePoint] {
        &self.0
    }

    /// The points in a closed interval.
    pub fn between(
        &self,
        from: f64,
        to: f64,
    ) -> impl DoubleEndedIterator<Item = CurvePoint> + Clone {
        let inside = move |point: &CurvePoint| (from..=to).contains(&point.t);
        self.0.iter().copied().filter(inside)
    }

    /// The values in a closed interval.
    pub fn values(&self, from: f64, to: f64) -> Vec<f64> {
        self.between(from, to).map(|point| point.v).collect()
    }

    /// The part from a time on.
    pub fn from(&self, from: f64) -> Self {
        let start = self.0.partition_point(|point| point.t < from);
        Self(self.0.get(start..).unwrap_or_default().to_vec())
    }

    /// Times and values, decimated to at most `most` points; extremes are preserved.
    pub fn decimated(&self, most: usize) -> Vec<[f64; 2]> {
        let points: Vec<[f64; 2]> = self.0.iter().map(|point| [point.t, point.v]).collect();
        decimated(&points, most)
    }

    /// The value at a time, interpolated; `None` outside the curve.
    pub fn at(&self, t: f64) -> Option<f64> {
        let next = self.0.iter().position(|point| point.t >= t)?;
        let after = self.0.get(next)?;
        let before = next.checked_sub(1).and_then(|at| self.0.get(at));
        match before {
            None => (after.t <= t).then_some(after.v),
            Some(before) => {
                let share = (t - before.t) / (after.t - before.t).max(f64::EPSILON);
                Some(before.v + (after.v - before.v) * share.clamp(0.0, 1.0))
            }
        }
    }

    /// The curve with `zero` subtracted.
    pub fn less(&self, zero: f64) -> Self {
        self.0
            .iter()
            .map(|point| (point.t, point.v - zero))
            .collect()
    }
}

/// All curves of one joint.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct JointCurves {
    /// ANGLE_ACT; documented values only.
    pub angle: TimeSeries,
    /// FORCE_ACT, g; the offset is included.
    pub force: TimeSeries,
    /// CURRENT, mA.
    pub current: TimeSeries,
    /// STATUS, the raw codes.
    pub status: TimeSeries,
    /// TEMP, °C.
    pub temperature: TimeSeries,
    /// Normal force of the fingertip, N.
    pub normal: TimeSeries,
    /// Tangential force, N.
    pub tangential: TimeSeries,
    /// Direction of the tangential force, degrees; only during contact.
    pub direction: TimeSeries,
    /// Proximity, counts.
    pub proximity: TimeSeries,
}

impl JointCurves {
    /// The curves of one joint in a recording. The thumb's rotation moves no fingertip of its own and has no tip curves.
    pub fn of(recording: &TrialRecording, dof: Dof) -> Self {
        let finger = Some(dof.finger()).filter(|finger| finger.bend() == dof);
        let zero = recording.zero();
        let curve = |value: &dyn Fn(&SampleRow) -> Option<f64>| -> TimeSeries {
            let rows = recording.rows().iter();
            rows.filter_map(|row| Some((seconds(zero, row.at), value(row)?)))
                .collect()
        };
        let tip = |value: fn(&TipSample) -> Option<f64>| -> TimeSeries {
            curve(&|row: &SampleRow| value(row.tips[finger?].as_ref()?))
        };
        let within = |value: Option<i16>, low: i16, high: i16| {
            value
                .filter(|value| (low..=high).contains(value))
                .map(f64::from)
        };
        Self {
            angle: curve(&|row| within(row.angle.map(|six| six[dof]), 0, 1000)),
            force: curve(&|row| within(row.force.map(|six| six[dof]), -4000, 4000)),
            current: curve(&|row| within(row.current.map(|six| six[dof]), 0, 2000)),
            status: curve(&|row| row.status.map(|six| six[dof].into())),
            temperature: curve(&|row| {
                let celsius = row.temperature.map(|six| six[dof]);
                celsius.filter(|celsius| *celsius <= 100).map(f64::from)
            }),
            normal: tip(|tip| tip.normal_n.map(f64::from)),
            tangential: tip(|tip| tip.tangential_n.map(f64::from)),
            direction: tip(|tip| tip.direction_deg.map(f64::from)),
            proximity: tip(|tip| Some(tip.proximity.into())),
        }
    }
}
