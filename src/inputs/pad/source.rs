//! A gamepad as a source for a hand to follow: reports in, offers out, STOP at once.

use crate::hand::{Angle, AngleReading, PerDof};
use crate::inputs::offer::{Offer, OfferOutlet, SourceSite};
use crate::inputs::pad::device::PadReader;
use crate::inputs::pad::input::{FingerChoice, PadEvent, PadInput, PadPoses};
use crate::inputs::pad::report::{PadNews, PadTrouble};
use crate::inputs::pad::state::PadState;
use crate::link::{Owner, Records};
use crate::record::Record;
use std::time::Duration;
use tokio::sync::{mpsc, watch};
use tokio::time::{MissedTickBehavior, interval};
use tokio_util::task::AbortOnDropHandle;

/// Interval of offers, whether a control was moved or not.
const OFFER_INTERVAL: Duration = Duration::from_millis(10);

/// Configuration of a gamepad source.
pub struct PadSourceConfig {
    /// The gamepads of this computer.
    pub reader: PadReader,
    /// Assignment of its controls, with the poses of its buttons.
    pub input: PadInput,
    /// Readings of the hand, for the actual angles.
    pub records: Records,
    /// The program.
    pub site: SourceSite,
}

/// Current state of the gamepad.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PadView {
    /// Name that the device reports; `None` without a gamepad.
    pub name: Option<String>,
    /// Reason why there is none, if known.
    pub trouble: Option<PadTrouble>,
    /// True while its dead-man is held.
    pub is_held: bool,
    /// Targets of the joints while its dead-man is held.
    pub aims: PerDof<Option<Angle>>,
    /// State of its controls.
    pub state: PadState,
    /// Fingers that a trigger closes.
    pub fingers: FingerChoice,
}

impl PadView {
    /// Owner as which it would control the hand; `None` without a gamepad.
    pub fn owner(&self) -> Option<Owner> {
        self.name.as_ref().map(|_| Owner::Gamepad)
    }
}

/// Reads a gamepad until dropped.
#[derive(Debug)]
pub struct PadSource {
    view: watch::Receiver<PadView>,
    /// Changed poses of its buttons.
    poses: watch::Sender<PadPoses>,
    outlet: OfferOutlet,
    _task: AbortOnDropHandle<()>,
}

impl PadSource {
    /// Reads from now on. Must be called within a tokio runtime.
    pub fn open(config: PadSourceConfig) -> Self {
        let (views, view) = watch::channel(PadView::default());
        let outlet = OfferOutlet::default();
        let (poses, changed) = watch::channel(PadPoses::new());
        let task = tokio::spawn(run(config, views, (outlet.clone(), changed)));
        Self {
            view,
            poses,
            outlet,
            _task: AbortOnDropHandle::new(task),
        }
    }

    /// Current state.
    pub fn view(&self) -> PadView {
        self.view.borrow().clone()
    }

    /// Sets the poses of its buttons.
    pub fn set_poses(&self, poses: PadPoses) {
        self.poses.send_if_modified(|current| {
            let is_news = *current != poses;
            *current = poses;
            is_news
        });
    }

    /// Receives its targets from now on; replaces the previous follower.
    pub fn follow(&self) -> mpsc::Receiver<Offer> {
        self.outlet.follow()
    }
}

async fn run(
    mut config: PadSourceConfig,
    views: watch::Sender<PadView>,
    (outlet, mut poses): (OfferOutlet, watch::Receiver<PadPoses>),
) {
    let mut tick = interval(OFFER_INTERVAL);
    tick.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut view = PadView::default();
    loop {
        tokio::select! {
            biased;
            report = config.reader.report() => {
                let Some(report) = report else { return };
                match &report.news {
                    PadNews::Found { facts, .. } if view.name.is_none() => {
                        view.name = Some(facts.name.clone());
                        view.trouble = None;
                    }
                    PadNews::Trouble(trouble) => view.trouble = Some(trouble.clone()),
                    _ => {}
                }
                match config.input.receive(&report) {
                    Some(PadEvent::Stop) => (config.site.stop)(),
                    Some(PadEvent::Gone) => view.name = None,
                    _ => {}
                }
            }
            Some(record) = config.records.next() => {
                if let Record::Reading { sample, .. } = record {
                    let angle = sample.angle;
                    let actual: PerDof<Option<Angle>> = PerDof::from_fn(|dof| {
                        angle.and_then(|angle| AngleReading::hold(angle.value[dof]))
                    });
                    config.input.set_actual(actual);
                }
                continue;
            }
            _ = tick.tick() => {}
        }
        if let Ok(true) = poses.has_changed() {
            config.input.set_poses(poses.borrow_and_update().clone());
        }
        let now = config.site.clock.now();
        view.is_held = config.input.is_held(now);
        view.state.clone_from(config.input.state());
        view.fingers = config.input.fingers();
        let offer = config.input.offer(now);
        view.aims = offer.map(|offer| offer.aims).unwrap_or_default();
        if views.send_if_modified(|shown| {
            let is_news = *shown != view;
            if is_news {
                shown.clone_from(&view);
            }
            is_news
        }) {
            (config.site.wake)();
        }
        if let Some(offer) = offer {
            outlet.offer(offer);
        }
    }
}
