//! Single requests of a person to the hand, and how they ended.

use crate::app::env::Env;
use crate::app::hand::HandState;
use crate::app::hand::gestures::{GestureProgress, LastGesture, StoreVerdict, Stored, Upload};
use crate::app::hand::open::{Pending, RequestEnd};
use crate::app::notices::{NoticeKind, Notices, RequestKind};
use crate::hand::{Angle, Gesture, GestureRoute, GestureStore, HandCommand, PerDof, UserGesture};
use crate::link::{LinkHandle, RequestError};
use crate::store::BackgroundJob;
use crate::tasks::gesture;

/// Requests whose end is still awaited; the link itself lets fewer wait.
const ASKED_MAX: usize = 32;

impl HandState {
    fn ask<F: Future<Output = RequestEnd> + Send + 'static>(
        &mut self,
        what: RequestKind,
        env: &Env,
        notices: &mut Notices,
        ask: impl FnOnce(LinkHandle) -> F,
    ) -> bool {
        let live = self.link.state.is_live();
        let Some(open) = self.open.as_ref().filter(|_| live) else {
            self.failed(what, RequestError::NotConnected, notices);
            return false;
        };
        let end = BackgroundJob::start(&env.runtime, &env.wake, ask(open.link.clone()));
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
        self.gestures.last = Some(LastGesture {
            gesture,
            at: now,
            progress: GestureProgress::Asked,
        });
        let command = HandCommand::Gesture(gesture, route);
        let write = |link: LinkHandle| async move { link.write(command).await.map(|()| None) };
        if self.ask(what, env, notices, write) {
            self.gesture_started(gesture.get());
        }
    }

    /// Clears what can be cleared. The link holds the pose first.
    pub(crate) fn clear_errors(&mut self, env: &Env, notices: &mut Notices) {
        let command = HandCommand::ClearErrors;
        let write = |link: LinkHandle| async move { link.write(command).await.map(|()| None) };
        self.ask(RequestKind::ClearErrors, env, notices, write);
    }

    /// Stores six angles under a number of the user's, then reads them back.
    pub(crate) fn store_gesture(
        &mut self,
        (to, angles): (UserGesture, PerDof<Angle>),
        store: GestureStore,
        env: &Env,
        notices: &mut Notices,
    ) {
        if self.store_is_off(store, notices) {
            return;
        }
        self.gestures.upload = Some(Upload {
            gesture: to,
            wanted: angles,
            verdict: StoreVerdict::Writing,
        });
        self.ask(
            RequestKind::StoreGesture(to),
            env,
            notices,
            |link| async move { gesture::store(&link, to, angles).await },
        );
    }

    /// Reads what is stored under a number of the user's.
    pub(crate) fn read_gesture(
        &mut self,
        wanted: UserGesture,
        store: GestureStore,
        env: &Env,
        notices: &mut Notices,
    ) {
        if self.store_is_off(store, notices) {
            return;
        }
        self.ask(
            RequestKind::ReadGesture(wanted),
            env,
            notices,
            |link| async move { gesture::read(&link, wanted).await },
        );
    }

    /// Says so if the person wants no address touched that the manual does not list.
    fn store_is_off(&self, store: GestureStore, notices: &mut Notices) -> bool {
        let off = store == GestureStore::Off;
        if off {
            notices.push(self.now, NoticeKind::GestureStoreOff);
        }
        off
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
                Ok(stored) => self.acknowledged(what, stored, notices),
                Err(error) => self.failed(what, error, notices),
            }
        }
    }

    fn acknowledged(
        &mut self,
        what: RequestKind,
        stored: Option<PerDof<i16>>,
        notices: &mut Notices,
    ) {
        match what {
            RequestKind::Gesture(_) => self.gestures.progress(GestureProgress::Acknowledged),
            // The result is shown beside the pose.
            RequestKind::StoreGesture(gesture) | RequestKind::ReadGesture(gesture) => {
                if let Some(angles) = stored {
                    self.gestures.read_back(Stored { gesture, angles });
                }
                return;
            }
            RequestKind::ClearErrors => {}
        }
        notices.push(self.now, NoticeKind::Acknowledged { what });
    }

    /// Says that something did not work.
    fn failed(&mut self, what: RequestKind, error: RequestError, notices: &mut Notices) {
        match what {
            RequestKind::Gesture(_) => self.gestures.progress(GestureProgress::Failed),
            RequestKind::StoreGesture(gesture) | RequestKind::ReadGesture(gesture) => {
                self.gestures.judge(gesture, StoreVerdict::Failed);
            }
            RequestKind::ClearErrors => {}
        }
        notices.push(self.now, NoticeKind::RequestFailed { what, error });
    }
}
