//! A calibration of the force of one joint with a kitchen scale, with a hand of the window.

use crate::app::env::Env;
use crate::app::env::motion_task::MotionTask;
use crate::hand::newtons::{Contradiction, ScalePoint};
use crate::hand::{Dof, Force};
use crate::link::LinkHandle;
use crate::motion::drive::Armed;
use crate::motion::program::{Ended, Progress};
use crate::motion::scale::{ScaleEnd, ScaleEvent, ScaleInput, ScaleStart, calibrate};
use crate::record::Abort;

/// A user action on a calibration with a scale.
#[derive(Debug, Clone, Copy, PartialEq, strum::VariantNames, strum::IntoStaticStr)]
pub enum ScaleAction {
    /// Press the scale with this joint, at loads up to this limit. Needs arming.
    Start(Dof, Force),
    /// The scale shows this, g.
    Reading(f64),
    /// Press this load again.
    Again,
    /// Leave this load out.
    Skip,
    /// Let go, and end. The accepted loads remain.
    Finish,
    /// Forget what was measured of this joint.
    Forget(Dof),
}

/// The current or last calibration.
#[derive(Debug)]
pub struct ScaleMotion {
    /// The joint that presses.
    pub dof: Dof,
    /// Limit of its loads.
    pub limit: Force,
    /// Accepted points.
    pub points: Vec<ScalePoint>,
    /// Number of the load that the user reads now, from 0, and the force over the zero, g; `None` while the finger moves.
    pub asked: Option<(usize, f64)>,
    /// The last contradiction; `None` once a reading was accepted.
    pub doubt: Option<Contradiction>,
    /// Its end; `None` while it runs.
    pub end: Option<Ended<ScaleEnd>>,
    task: MotionTask<ScaleInput, ScaleEvent, Ended<ScaleEnd>>,
}

impl ScaleMotion {
    /// Starts a calibration.
    pub(crate) fn begin(link: LinkHandle, armed: Armed, start: ScaleStart, env: &Env) -> Self {
        let (dof, limit, points) = (start.dof, start.limit, start.points.clone());
        let task = MotionTask::start(env, |steps, inputs| async move {
            let report = |progress| {
                if let Progress::Event(event) = progress {
                    steps.send(event);
                }
                true
            };
            calibrate(&link, armed, start, inputs, report).await.end
        });
        Self {
            dof,
            limit,
            points,
            asked: None,
            doubt: None,
            end: None,
            task,
        }
    }

    /// True while it may move the hand.
    pub const fn is_running(&self) -> bool {
        self.end.is_none()
    }

    /// Passes an answer of the user on.
    pub(crate) fn answer(&mut self, answer: ScaleInput) {
        self.asked = None;
        self.task.input(answer);
    }

    /// Marks that it has lost control of the hand.
    pub(crate) fn leave(&mut self) {
        if self.is_running() {
            self.task.leave();
            self.asked = None;
            self.end = Some(Err(Abort::TakenOver));
        }
    }

    /// Applies the progress of its task; none after it lost control of the hand. Returns the points if they changed.
    pub(crate) fn news(&mut self) -> Option<&[ScalePoint]> {
        let (steps, end) = self.task.news();
        let mut is_changed = false;
        for (_, event) in steps {
            match event {
                ScaleEvent::Asked { load, hand_g } => self.asked = Some((load, hand_g)),
                ScaleEvent::NotAsked => {}
                ScaleEvent::Doubted(why) => self.doubt = Some(why),
                ScaleEvent::Points(points) => {
                    self.doubt = self.doubt.filter(|_| points.len() < self.points.len());
                    self.points = points;
                    is_changed = true;
                }
            }
        }
        if let Some(end) = end {
            self.asked = None;
            self.end.get_or_insert(end);
        }
        is_changed.then_some(self.points.as_slice())
    }
}
