//! A task that runs beside the window: its steps with their times, and its end.

use crate::app::env::Env;
use crate::hand::Moment;
use crate::store::BackgroundJob;
use tokio::sync::mpsc;
use tokio_util::task::AbortOnDrop;

/// A task under way. Dropping it breaks it off.
#[derive(Debug)]
pub(crate) struct Running<S, E> {
    // As many as a task tells: some ten for each thing it does.
    steps: mpsc::UnboundedReceiver<(Moment, S)>,
    end: Option<BackgroundJob<E>>,
    _task: AbortOnDrop,
}

/// Where a task tells its steps.
pub(crate) struct Steps<S> {
    told: mpsc::UnboundedSender<(Moment, S)>,
    env: Env,
}

impl<S> Steps<S> {
    pub(crate) fn tell(&self, step: S) {
        // A receiver that is gone means that nobody wants to know.
        let _told = self.told.send((self.env.clock.now(), step));
        (self.env.wake)();
    }
}

impl<S: Send + 'static, E: Send + 'static> Running<S, E> {
    /// Begins a task.
    pub(crate) fn start<F>(env: &Env, task: impl FnOnce(Steps<S>) -> F) -> Self
    where
        F: Future<Output = E> + Send + 'static,
    {
        let (told, steps) = mpsc::unbounded_channel();
        let env = env.clone();
        let work = task(Steps {
            told,
            env: env.clone(),
        });
        let task = env.runtime.spawn(work);
        let abort = AbortOnDrop::new(task.abort_handle());
        let end =
            BackgroundJob::start_fallible(&env.runtime, &env.wake, async move { task.await.ok() });
        Self {
            steps,
            end: Some(end),
            _task: abort,
        }
    }

    /// What was told since the last call, and the end once it is there. All steps come before the end.
    pub(crate) fn news(&mut self) -> (Vec<(Moment, S)>, Option<E>) {
        let end = BackgroundJob::take_from(&mut self.end);
        let steps = std::iter::from_fn(|| self.steps.try_recv().ok()).collect();
        (steps, end)
    }
}
