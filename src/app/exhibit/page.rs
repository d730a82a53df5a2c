//! User actions on the exhibition page, and the events of its task.

use crate::app::env::Env;
use crate::app::env::running::Running;
use crate::app::exhibit::{
    ExhibitAction, ExhibitState, Exhibition, StaffPanel, StoredReport, wrong_pins_file,
};
use crate::app::hand::Hand;
use crate::app::settings::Settings;
use crate::exhibit::pin::{Pin, PinAnswer, PinGate};
use crate::exhibit::stage::{ExhibitStage, ExhibitView, ExhibitWish};
use crate::hand::Moment;
use crate::hand::overshoot::OvershootMap;
use crate::motion::exhibit;
use crate::motion::program::Progress;
use crate::store::{Saver, calendar};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::mpsc;

/// Capacity of the queue of visitors' requests: users cannot press faster than the task reads them.
const WISHES_MAX: usize = 64;
/// The staff panel closes by itself after this time, so that it is not left open for visitors.
const STAFF_DURATION: Duration = Duration::from_secs(30);

impl ExhibitState {
    /// Starts an exhibition on a hand that is connected, or will be. Nothing moves before staff arm.
    pub(crate) fn begin(
        start: Exhibition,
        hand: &Hand,
        settings: &Settings,
        env: &Env,
    ) -> Option<Self> {
        let link = hand.connection.link()?.clone();
        let task_start = exhibit::ExhibitStart {
            plan: start.plan.clone(),
            locked: hand.controls.locked(),
            seen: hand.readings.sample,
            grip: hand.readings.grip.clone(),
            overshoot: OvershootMap::clone(&hand.overshoot.map),
            blocks: settings.size_blocks(hand.connection.endpoint.as_ref()),
            clock: env.clock,
            drawn: Arc::default(),
        };
        let drawn = Arc::clone(&task_start.drawn);
        let (wishes, wanted) = mpsc::channel(WISHES_MAX);
        let task = Running::start(env, |steps| async move {
            exhibit::exhibit(&link, task_start, wanted, |step| steps.send(step)).await;
        });
        let wrong_path = env.settings_path.as_deref().map(wrong_pins_file::beside);
        // Reads one line synchronously: it must be known before a PIN can be typed.
        let earlier = wrong_path.as_deref().map(wrong_pins_file::load);
        let earlier = earlier.unwrap_or_default();
        let resumed = |pin| PinGate::resumed(pin, earlier, env.clock.now());
        let gate = start.plan.pin.clone().map(resumed);
        Some(Self {
            staff: match gate {
                Some(_) => StaffPanel::Closed,
                None => StaffPanel::Choose {
                    first: None,
                    refused: false,
                },
            },
            plan: start.plan,
            logo: start.logo,
            view: ExhibitView::default(),
            report: StoredReport::new(env.documents.clone(), env.runtime.clone()),
            gate,
            wrong_pins: Saver::new(
                wrong_path,
                env.runtime.clone(),
                earlier,
                wrong_pins_file::text,
            ),
            ends_program: start.ends_program,
            language: settings.language,
            wishes,
            task,
            drawn,
        })
    }

    /// Applies the task's steps, and closes a staff panel left open. Returns true when a visitor has left and the page must be
    /// reset for the next one.
    pub(crate) fn tick(&mut self, hand: &mut Hand, now: Moment) -> bool {
        self.report.tick(hand, calendar::since_1970(), now);
        self.keep_wrong_pins(now);
        let before = self.view.stage;
        let (steps, _end) = self.task.news();
        for (_, step) in steps {
            match step {
                Progress::View(view) => self.view = view,
                Progress::Sent(setpoints) => {
                    hand.sent(&setpoints);
                }
                Progress::Event(event) => self.report.count(&event),
            }
        }
        let until = match &self.staff {
            StaffPanel::Ask { until, .. } | StaffPanel::Open { until } => Some(*until),
            StaffPanel::Closed | StaffPanel::Choose { .. } => None,
        };
        if until.is_some_and(|until| now >= until) {
            self.staff = StaffPanel::Closed;
        }
        let after = self.view.stage;
        let plays = |stage| matches!(stage, ExhibitStage::Visit { .. });
        // A visitor who only looked and changed the language has left as well.
        let is_alone = before != after && after == ExhibitStage::Attract;
        plays(before) && !plays(after) || is_alone
    }

    /// Saves wrong PINs so that they outlast a restart.
    fn keep_wrong_pins(&mut self, now: Moment) {
        let Some(gate) = &self.gate else { return };
        let since_start = now.since(Moment::ZERO);
        // A failed write is repeated at the next wrong PIN; the gate itself keeps counting.
        let _kept = self.wrong_pins.tick(&gate.wrong_pins(now), since_start);
    }

    /// Handles a user action. Returns true if the exhibition must end.
    pub(crate) fn act(&mut self, action: ExhibitAction, now: Moment) -> bool {
        let is_staff = matches!(self.staff, StaffPanel::Open { .. });
        match action {
            ExhibitAction::Wish(ExhibitWish::Arm | ExhibitWish::Disarm) | ExhibitAction::Leave
                if !is_staff => {}
            ExhibitAction::Wish(wish) => {
                if matches!(wish, ExhibitWish::Arm | ExhibitWish::Disarm) {
                    self.staff = StaffPanel::Closed;
                }
                self.wish(wish);
            }
            ExhibitAction::AskPin => self.ask(now),
            ExhibitAction::Pin(typed) => self.pin(typed, now),
            ExhibitAction::CloseStaff if self.gate.is_some() => self.staff = StaffPanel::Closed,
            ExhibitAction::Leave => return true,
            // Without a PIN there is nothing to protect from visitors.
            ExhibitAction::CloseStaff => return true,
            ExhibitAction::Enter | ExhibitAction::EnterFile => {}
        }
        false
    }

    /// Forwards a visitor's request to the task.
    pub(crate) fn wish(&mut self, wish: ExhibitWish) {
        // A full queue drops one of very many touches; a stop also reaches the hand by another path.
        let _queued = self.wishes.try_send(wish);
    }

    /// Asks for the PIN, or keeps asking.
    pub(crate) fn ask(&mut self, now: Moment) {
        if matches!(self.staff, StaffPanel::Closed) {
            let locked = self.gate.as_ref().and_then(|gate| gate.locked_until(now));
            self.staff = StaffPanel::Ask {
                answer: locked.map(|until| PinAnswer::Locked { until }),
                until: now.plus(STAFF_DURATION),
            };
        }
    }

    fn pin(&mut self, typed: String, now: Moment) {
        let until = now.plus(STAFF_DURATION);
        match (&self.staff, &mut self.gate) {
            (StaffPanel::Choose { first, .. }, None) => {
                let pin = Pin::try_from(typed).ok();
                match (first, pin) {
                    (None, Some(pin)) => {
                        self.staff = StaffPanel::Choose {
                            first: Some(pin),
                            refused: false,
                        };
                    }
                    (Some(first), Some(pin)) if *first == pin => {
                        self.gate = Some(PinGate::new(pin));
                        self.staff = StaffPanel::Open { until };
                    }
                    _ => {
                        self.staff = StaffPanel::Choose {
                            first: None,
                            refused: true,
                        };
                    }
                }
            }
            (StaffPanel::Ask { .. }, Some(gate)) => {
                self.staff = match gate.enter(&typed, now) {
                    PinAnswer::Right => StaffPanel::Open { until },
                    answer => StaffPanel::Ask {
                        answer: Some(answer),
                        until,
                    },
                };
                self.keep_wrong_pins(now);
            }
            _ => {}
        }
    }
}
