//! Stand-in.
use crate::hand::{Dof, Gesture};
/// Quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// g
    Force,
    /// mA
    Current,
    /// C
    Temperature,
    /// raw
    Angle,
}
/// Series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Series {
    /// What.
    pub quantity: Quantity,
    /// Whose.
    pub dof: Dof,
}
/// Trace.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Pieces.
    pub segments: Vec<Vec<[f64; 2]>>,
    /// Thinned.
    pub decimated: bool,
}
/// Kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkKind {
    /// Stop.
    Stop,
    /// Fault.
    Fault,
    /// Reconnect.
    Reconnect,
    /// Gesture.
    Gesture(Gesture),
}
/// Mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// When.
    pub at_s: f64,
    /// What.
    pub kind: MarkKind,
}
/// History.
#[derive(Debug, Clone, Default)]
pub struct History {
    /// Marks.
    pub marks: Vec<Mark>,
    /// Traces.
    pub paused: bool,
    /// Filled.
    pub filled: bool,
}
impl History {
    /// Marks.
    #[must_use]
    pub fn marks(&self, _from: f64, _to: f64) -> &[Mark] {
        &self.marks
    }
    /// Paused.
    #[must_use]
    pub fn is_paused(&self) -> bool {
        self.paused
    }
    /// Trace.
    pub fn trace(&self, series: Series, from_s: f64, to_s: f64, columns: usize, out: &mut Trace) {
        out.segments.clear();
        if !self.filled {
            return;
        }
        let n = columns.min(400);
        let i = f64::from(series.dof.index() as u32);
        let mut piece = Vec::new();
        for k in 0..n {
            let t = from_s + (to_s - from_s) * k as f64 / n as f64;
            if (k * 100 / n) > 40 && (k * 100 / n) < 44 {
                if !piece.is_empty() {
                    out.segments.push(std::mem::take(&mut piece));
                }
                continue;
            }
            let s = ((t * 0.8 + i * 0.4).sin() + 1.0) / 2.0;
            let y = match series.quantity {
                Quantity::Force => s * s * s * 600.0 - 12.0 + 6.0 * (t * 40.0 + i).sin(),
                Quantity::Current => s * 350.0 * (t * 13.0 + i).sin().abs(),
                Quantity::Temperature => 31.0 + i + t * 0.02,
                Quantity::Angle => 1000.0 - 700.0 * s,
            };
            piece.push([t, y]);
        }
        out.segments.push(piece);
    }
}
