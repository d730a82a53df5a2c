//! Work off the window's thread, and the application of its results.

use std::fmt;
use std::io;
use std::sync::Arc;
use tokio::runtime::Handle;
use tokio::sync::oneshot;
use tokio::sync::oneshot::error::TryRecvError;

/// Runs file work on a thread that may block.
///
/// # Errors
/// The error of the work, or that the program is ending.
pub async fn on_thread<T: Send + 'static>(
    work: impl FnOnce() -> io::Result<T> + Send + 'static,
) -> io::Result<T> {
    match tokio::task::spawn_blocking(work).await {
        Ok(done) => done,
        Err(_ending) => Err(io::Error::other("the program is ending")),
    }
}

/// The runtime of jobs, and the function called when one has ended.
#[derive(Clone, Copy)]
pub struct Background<'a> {
    pub runtime: &'a Handle,
    pub wake: &'a Arc<dyn Fn() + Send + Sync>,
}

/// Kinds of jobs of one component, such as reading and writing its file. Of two jobs of equal kind, the newer supersedes the older.
pub trait JobKind: PartialEq + 'static {
    /// State that the results of the jobs change.
    type State;
    /// What the results need besides the state, such as a sink for notices.
    type Ctx<'a>;
}

/// Result of an ended job, to be applied to the state.
pub type Effect<K> =
    Box<dyn FnOnce(&mut <K as JobKind>::State, &mut <K as JobKind>::Ctx<'_>) + Send>;

/// Running jobs of a state. Dropping them discards their results; the work itself runs to its end.
pub struct Jobs<K: JobKind>(Vec<Job<K>>);

struct Job<K: JobKind> {
    kind: K,
    effect: oneshot::Receiver<Effect<K>>,
}

impl<K: JobKind> Jobs<K> {
    /// Starts a job; `apply` gets its result on the thread that calls [`Jobs::next_ended`]. An older job of the same kind is
    /// superseded: its result is discarded.
    pub fn start<T: Send + 'static>(
        &mut self,
        kind: K,
        background: Background<'_>,
        work: impl Future<Output = T> + Send + 'static,
        apply: impl FnOnce(&mut K::State, &mut K::Ctx<'_>, T) + Send + 'static,
    ) {
        let (sender, effect) = oneshot::channel::<Effect<K>>();
        let wake = Arc::clone(background.wake);
        background.runtime.spawn(async move {
            let result = work.await;
            // A dropped receiver means that the result is not needed.
            let _sent = sender.send(Box::new(move |state, ctx| apply(state, ctx, result)));
            wake();
        });
        self.cancel(&kind);
        self.0.push(Job { kind, effect });
    }

    /// Discards the result of the running job of this kind, if any.
    pub fn cancel(&mut self, kind: &K) {
        self.0.retain(|job| job.kind != *kind);
    }

    /// True while a job of this kind is running, or its result is yet to be applied.
    pub fn is_running(&self, kind: &K) -> bool {
        self.0.iter().any(|job| job.kind == *kind)
    }

    /// True while no job is running and all results are applied.
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Effect of an ended job, in order of start; `None` if no further job has ended. Jobs that ended without a result are
    /// removed. Call it in each tick until `None`.
    pub fn next_ended(&mut self) -> Option<Effect<K>> {
        let mut ended = None;
        self.0.retain_mut(|job| {
            if ended.is_some() {
                return true;
            }
            match job.effect.try_recv() {
                Err(TryRecvError::Empty) => true,
                Err(TryRecvError::Closed) => false,
                Ok(effect) => {
                    ended = Some(effect);
                    false
                }
            }
        });
        ended
    }
}

impl<K: JobKind> Default for Jobs<K> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<K: JobKind + fmt::Debug> fmt::Debug for Jobs<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list()
            .entries(self.0.iter().map(|job| &job.kind))
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[derive(Debug, PartialEq)]
    enum Kind {
        Read,
        Write,
    }

    impl JobKind for Kind {
        type State = Component;
        type Ctx<'a> = Vec<&'a str>;
    }

    #[derive(Debug, Default)]
    struct Component {
        jobs: Jobs<Kind>,
        results: Vec<u32>,
    }

    impl Component {
        fn start(&mut self, kind: Kind, work: impl Future<Output = u32> + Send + 'static) {
            let (runtime, wake) = (Handle::current(), no_wake());
            let background = Background {
                runtime: &runtime,
                wake: &wake,
            };
            self.jobs
                .start(kind, background, work, |component, notices, result| {
                    component.results.push(result);
                    notices.push("ended");
                });
        }

        /// Returns the notices of one tick.
        fn tick(&mut self) -> Vec<&'static str> {
            let mut notices = Vec::new();
            while let Some(effect) = self.jobs.next_ended() {
                effect(self, &mut notices);
            }
            notices
        }
    }

    fn no_wake() -> Arc<dyn Fn() + Send + Sync> {
        Arc::new(|| ())
    }

    /// Lets all tasks run that can; the runtime of these tests has one thread.
    async fn run_tasks() {
        for _ in 0..10 {
            tokio::task::yield_now().await;
        }
    }

    #[tokio::test]
    async fn a_result_is_applied_in_the_tick_after_the_job_ended() {
        let mut component = Component::default();
        let (result, work) = oneshot::channel();
        component.start(Kind::Read, async { work.await.unwrap() });
        run_tasks().await;
        assert!(component.tick().is_empty() && component.results.is_empty());
        assert!(component.jobs.is_running(&Kind::Read));
        assert!(!component.jobs.is_running(&Kind::Write));
        result.send(7).unwrap();
        run_tasks().await;
        assert!(component.jobs.is_running(&Kind::Read), "not applied yet");
        assert_eq!(component.tick(), ["ended"]);
        assert_eq!(component.results, [7]);
        assert!(component.jobs.is_empty() && component.tick().is_empty());
    }

    #[tokio::test]
    async fn ended_jobs_are_applied_in_order_of_start_past_one_that_still_runs() {
        let mut component = Component::default();
        let (first, work) = oneshot::channel();
        component.start(Kind::Write, async { work.await.unwrap() });
        component.start(Kind::Read, async { 2 });
        run_tasks().await;
        assert_eq!(component.tick(), ["ended"]);
        assert_eq!(component.results, [2]);
        component.start(Kind::Read, async { 3 });
        run_tasks().await;
        first.send(1).unwrap();
        run_tasks().await;
        assert_eq!(component.tick(), ["ended", "ended"]);
        assert_eq!(component.results, [2, 1, 3]);
    }

    #[tokio::test]
    async fn a_newer_job_supersedes_an_older_one_of_its_kind_even_if_that_has_ended() {
        let mut component = Component::default();
        component.start(Kind::Read, async { 1 });
        component.start(Kind::Write, async { 2 });
        run_tasks().await;
        component.start(Kind::Read, async { 3 });
        run_tasks().await;
        component.tick();
        assert_eq!(component.results, [2, 3]);
    }

    #[tokio::test]
    async fn an_effect_can_cancel_another_ended_job() {
        let mut component = Component::default();
        let (runtime, wake) = (Handle::current(), no_wake());
        let background = Background {
            runtime: &runtime,
            wake: &wake,
        };
        let work = std::future::ready(());
        component
            .jobs
            .start(Kind::Write, background, work, |component, _, ()| {
                component.jobs.cancel(&Kind::Read);
            });
        component.start(Kind::Read, async { 1 });
        run_tasks().await;
        assert!(component.tick().is_empty());
        assert!(component.results.is_empty() && component.jobs.is_empty());
    }

    #[tokio::test]
    async fn a_job_that_ends_without_a_result_is_removed_and_hides_no_other() {
        let mut component = Component::default();
        let (lost, work) = oneshot::channel::<u32>();
        drop(lost);
        component.start(Kind::Read, async { work.await.unwrap() });
        component.start(Kind::Write, async { 2 });
        run_tasks().await;
        assert_eq!(component.tick(), ["ended"]);
        assert_eq!(component.results, [2]);
        assert!(!component.jobs.is_running(&Kind::Read));
    }

    #[tokio::test]
    async fn the_results_of_dropped_jobs_are_discarded_and_the_work_is_done_all_the_same() {
        let (done, woken) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let count = |counter: &Arc<AtomicUsize>| {
            let counter = Arc::clone(counter);
            move || {
                counter.fetch_add(1, Ordering::Relaxed);
            }
        };
        let (work, runtime) = (count(&done), Handle::current());
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(count(&woken));
        let background = Background {
            runtime: &runtime,
            wake: &wake,
        };
        let mut component = Component::default();
        let apply = |component: &mut Component, _: &mut Vec<&str>, ()| component.results.push(1);
        component
            .jobs
            .start(Kind::Write, background, async move { work() }, apply);
        component = Component::default();
        run_tasks().await;
        assert!(component.tick().is_empty() && component.results.is_empty());
        let counts = [&done, &woken].map(|counter| counter.load(Ordering::Relaxed));
        assert_eq!(counts, [1, 1]);
    }
}
