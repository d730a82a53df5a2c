//! A background task of the window: its timestamped steps, its questions, and its result.

use crate::app::env::{Env, LostSteps};
use crate::hand::Moment;
use crate::tasks::{Question, User};
use std::fmt;
use tokio::sync::broadcast::error::TryRecvError;
use tokio::sync::{broadcast, mpsc, oneshot};
use tokio_util::task::AbortOnDrop;

/// Capacity of the step queue: five seconds of a following hand. A window that does not read for longer gets the newest steps.
const STEPS_MAX: usize = 1024;

/// A running task. Dropping it aborts the task.
pub(crate) struct Running<S, E> {
    steps: broadcast::Receiver<(Moment, S)>,
    lost: LostSteps,
    questions: mpsc::Receiver<AskedQuestion>,
    question: Option<AskedQuestion>,
    end: oneshot::Receiver<E>,
    _task: AbortOnDrop,
}

/// A question that waits for its answer.
#[derive(Debug)]
struct AskedQuestion {
    question: Question,
    since: Moment,
    answer: oneshot::Sender<bool>,
}

/// Applies the result of a task to the state that started it.
pub(crate) type TaskEffect<T> = Box<dyn FnOnce(&mut T, Moment) + Send>;

/// Sender of a task's steps and questions.
pub(crate) struct Steps<S> {
    sender: broadcast::Sender<(Moment, S)>,
    questions: mpsc::Sender<AskedQuestion>,
    env: Env,
}

impl<S> Steps<S> {
    pub(crate) fn send(&self, step: S) {
        // A dropped receiver means that the window no longer needs the steps.
        let _sent = self.sender.send((self.env.clock.now(), step)).is_ok();
        (self.env.wake)();
    }
}

impl<S: Send> User for &Steps<S> {
    async fn ask(&mut self, question: Question) -> bool {
        let (answer, answered) = oneshot::channel();
        let open = AskedQuestion {
            question,
            since: self.env.clock.now(),
            answer,
        };
        if self.questions.send(open).await.is_err() {
            return false;
        }
        (self.env.wake)();
        answered.await.unwrap_or(false)
    }
}

impl<S: Clone + Send + 'static, E: Send + 'static> Running<S, E> {
    /// Starts a task.
    pub(crate) fn start<F>(env: &Env, task: impl FnOnce(Steps<S>) -> F) -> Self
    where
        F: Future<Output = E> + Send + 'static,
    {
        let (sender, steps) = broadcast::channel(STEPS_MAX);
        // A task waits for each answer before it asks again.
        let (asked, questions) = mpsc::channel(1);
        let env = env.clone();
        let work = task(Steps {
            sender,
            questions: asked,
            env: env.clone(),
        });
        let task = env.runtime.spawn(work);
        let abort = AbortOnDrop::new(task.abort_handle());
        let (ended, end) = oneshot::channel();
        let wake = env.wake;
        env.runtime.spawn(async move {
            if let Ok(result) = task.await {
                // A dropped receiver means that the window no longer needs the result.
                let _sent = ended.send(result);
            }
            wake();
        });
        Self {
            steps,
            lost: env.lost_steps,
            questions,
            question: None,
            end,
            _task: abort,
        }
    }

    /// Returns the steps since the last call, and the result once the task has ended. All steps come before the result.
    pub(crate) fn news(&mut self) -> (Vec<(Moment, S)>, Option<E>) {
        let end = self.end.try_recv().ok();
        // A task that stopped waiting for the answer has withdrawn its question.
        self.question.take_if(|open| open.answer.is_closed());
        if self.question.is_none() {
            self.question = self.questions.try_recv().ok();
        }
        (waiting(&mut self.steps, &self.lost), end)
    }
}

impl<S, E> fmt::Debug for Running<S, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Running").finish_non_exhaustive()
    }
}

impl<S, E> Running<S, E> {
    /// The open question, and the time since which it is open.
    pub(crate) fn question(&self) -> Option<(&Question, Moment)> {
        let open = self.question.as_ref()?;
        Some((&open.question, open.since))
    }

    /// Answers the question if it is the open one; true if it was.
    pub(crate) fn answer(&mut self, question: &Question, yes: bool) -> bool {
        let is_it = |open: &mut AskedQuestion| open.question == *question;
        let open = self.question.take_if(is_it);
        open.is_some_and(|open| open.answer.send(yes).is_ok())
    }
}

/// Returns all queued steps and counts those that were overwritten before they were read.
fn waiting<T: Clone>(steps: &mut broadcast::Receiver<T>, lost: &LostSteps) -> Vec<T> {
    let mut all = Vec::new();
    loop {
        match steps.try_recv() {
            Ok(step) => all.push(step),
            Err(TryRecvError::Lagged(count)) => lost.add(count),
            Err(TryRecvError::Empty | TryRecvError::Closed) => return all,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_that_does_not_look_gets_the_newest_steps_and_how_many_went() {
        let (sender, mut steps) = broadcast::channel(STEPS_MAX);
        let lost = LostSteps::default();
        for step in 0..3000 {
            sender.send(step).unwrap();
        }
        drop(sender);
        let all = waiting(&mut steps, &lost);
        assert_eq!((all.len(), all.last()), (STEPS_MAX, Some(&2999)));
        assert_eq!(lost.take(), 3000 - STEPS_MAX as u64);
        assert_eq!(lost.take(), 0, "told once");
    }
}
