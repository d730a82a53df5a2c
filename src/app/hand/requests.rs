//! Single requests of a person to the hand, and how they ended.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::hand::open::Pending;
use crate::app::notices::{NoticeKind, Notices, RequestKind};
use crate::hand::{Gesture, GestureRoute, HandCommand};
use crate::link::RequestError;
use crate::store::BackgroundJob;

/// Requests whose end is still awaited; the link itself lets fewer wait.
const ASKED_MAX: usize = 32;

impl HandState {
    /// Writes a command; false if no hand is there to take it.
    fn ask(
        &mut self,
        what: RequestKind,
        command: HandCommand,
        env: &Env,
        notices: &mut Notices,
    ) -> bool {
        let live = self.link.state.is_live();
        let Some(open) = self.open.as_ref().filter(|_| live) else {
            self.failed(what, RequestError::NotConnected, notices);
            return false;
        };
        let (link, lease) = (open.link.clone(), open.lease);
        let write = async move {
            match lease.filter(|_| command.is_motion()) {
                Some(lease) => link.write_as(lease, command).await,
                None => link.write(command).await,
            }
        };
        let end = BackgroundJob::start(&env.runtime, &env.wake, write);
        if self.asked.len() >= ASKED_MAX {
            self.asked.remove(0);
        }
        let end = Some(end);
        self.asked.push(Pending { what, end });
        true
    }

    /// Starts a gesture of the hand's own. It moves every joint, so none may be locked.
    pub(crate) fn gesture(
        &mut self,
        gesture: Gesture,
        route: GestureRoute,
        env: &Env,
        notices: &mut Notices,
    ) {
        let what = RequestKind::Gesture(gesture);
        let now = self.now;
        if !self.is_armed() {
            self.failed(what, RequestError::NotArmed, notices);
            return;
        }
        if route == GestureRoute::Off {
            notices.push(now, NoticeKind::GesturesOff);
            return;
        }
        if let Some((dof, _)) = self.joints.iter().find(|(_, joint)| joint.locked) {
            notices.push(now, NoticeKind::GestureWouldMoveLocked { dof });
            return;
        }
        self.take_over();
        self.gesture = Some(gesture);
        if self.ask(what, HandCommand::Gesture(gesture, route), env, notices) {
            self.gesture_started(gesture.get());
        }
    }

    /// Clears what can be cleared. The link holds the pose first.
    pub(crate) fn clear_errors(&mut self, env: &Env, notices: &mut Notices) {
        let what = RequestKind::ClearErrors;
        self.ask(what, HandCommand::ClearErrors, env, notices);
    }

    /// Takes in how requests ended.
    pub(crate) fn tick_requests(&mut self, notices: &mut Notices) {
        let mut ended = Vec::new();
        self.asked.retain_mut(|asked| {
            let end = BackgroundJob::take_from(&mut asked.end);
            ended.extend(end.map(|end| (asked.what, end)));
            asked.end.is_some()
        });
        for (what, end) in ended {
            match end {
                Ok(()) => notices.push(self.now, NoticeKind::Acknowledged { what }),
                Err(error) => self.failed(what, error, notices),
            }
        }
    }

    /// Says that something did not work.
    fn failed(&mut self, what: RequestKind, error: RequestError, notices: &mut Notices) {
        if matches!(what, RequestKind::Gesture(_)) {
            self.gesture = None;
        }
        notices.push(self.now, NoticeKind::RequestFailed { what, error });
    }
}
