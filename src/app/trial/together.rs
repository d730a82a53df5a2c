//! The forces of several trials over each other, as a part of the page of a session. Measures nothing.

use crate::app::trial::curve::{Curve, JointCurves};
use crate::app::trial::plan::Setting;
use crate::app::trial::series::Trial;
use crate::app::trial::svg::{Line, Plot, escaped};
use crate::hand::Dof;
use std::fmt::Write as _;

/// What is drawn before the command, s.
pub(crate) const BEFORE_S: f64 = 0.5;
/// Lines that are drawn over each other; more are a carpet.
const TOGETHER_MAX: usize = 24;
/// Strokes that a page has.
const STROKES: usize = 6;

/// The force of one joint in one trial.
#[derive(Debug)]
struct Over {
    setting: Setting,
    dof: Dof,
    force: Curve,
}

/// Forces that are drawn over each other.
#[derive(Debug, Default)]
pub(crate) struct Together {
    all: Vec<Over>,
    left_out: usize,
}

impl Together {
    /// Takes in the forces of a trial, as far as there is room.
    pub(crate) fn add(&mut self, trial: &Trial) {
        for joint in &trial.metrics.joints {
            if self.all.len() >= TOGETHER_MAX {
                self.left_out += 1;
                continue;
            }
            let force = JointCurves::of(&trial.recording, joint.dof).force;
            let force = force.between(-BEFORE_S, f64::INFINITY);
            self.all.push(Over {
                setting: trial.setting,
                dof: joint.dof,
                force: force.map(|point| (point.t, point.v)).collect(),
            });
        }
    }

    /// A stroke for each joint, or for each setting where one joint was tried; nothing of fewer than two lines.
    pub(crate) fn text(&self) -> String {
        if self.all.len() < 2 {
            return String::new();
        }
        let mut out = String::from("<h2>Forces over each other</h2>\n<p>");
        let mut keys: Vec<(usize, String)> = self.all.iter().map(|own| self.key(own)).collect();
        keys.sort();
        keys.dedup();
        for (stroke, name) in keys {
            // Writing to a string cannot fail.
            let _done = write!(
                out,
                "<span class=\"key s{stroke}\">{}</span>",
                escaped(&name)
            );
        }
        let ends = self.all.iter().filter_map(|own| own.force.points().last());
        let line = |own: &Over| Line {
            stroke: self.key(own).0,
            curve: own.force.clone(),
        };
        let plot = Plot {
            name: "Force, g".into(),
            from_s: -BEFORE_S,
            to_s: ends.map(|point| point.t).fold(0.0, f64::max),
            lines: self.all.iter().map(line).collect(),
            level: None,
            marks: Vec::new(),
        };
        let svg = plot.svg();
        let _done = write!(out, "Time counts from the closing command.</p>\n{svg}");
        if self.left_out > 0 {
            let _done = writeln!(
                out,
                "<p>{} further curves are not among them.</p>",
                self.left_out
            );
        }
        out
    }

    fn key(&self, own: &Over) -> (usize, String) {
        let several = self.all.iter().any(|other| other.dof != own.dof);
        if several {
            return (own.dof.index(), own.dof.name().to_owned());
        }
        let mut settings: Vec<Setting> = self.all.iter().map(|own| own.setting).collect();
        settings.sort_unstable();
        settings.dedup();
        let at = settings.binary_search(&own.setting).unwrap_or_default();
        let Setting { speed, force } = own.setting;
        let name = format!("speed {}, threshold {} g", speed.get(), force.get());
        (at % STROKES, name)
    }
}
