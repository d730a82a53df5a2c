//! The task of a program that moves a hand of the window, and the channel for the user's input to it.

use crate::app::env::Env;
use crate::app::env::running::{Running, Steps};
use crate::hand::Moment;
use futures::stream::{BoxStream, StreamExt as _, poll_fn};
use tokio::sync::mpsc;

/// Maximum number of inputs that wait for the program: the user cannot press faster than it receives them.
const INPUTS_MAX: usize = 16;

/// A program that a task drives. Dropping it aborts the task.
#[derive(Debug)]
pub(crate) struct MotionTask<I, S, E> {
    /// `None` once the user moves the hand in another way, which ends the program.
    inputs: Option<mpsc::Sender<I>>,
    running: Running<S, E>,
}

impl<I: Send + 'static, S: Clone + Send + 'static, E: Send + 'static> MotionTask<I, S, E> {
    /// Starts a task, which passes these inputs to its program.
    pub(crate) fn start<F>(
        env: &Env,
        task: impl FnOnce(Steps<S>, BoxStream<'static, I>) -> F,
    ) -> Self
    where
        F: Future<Output = E> + Send + 'static,
    {
        let (inputs, mut received) = mpsc::channel(INPUTS_MAX);
        let received = poll_fn(move |context| received.poll_recv(context)).boxed();
        Self {
            inputs: Some(inputs),
            running: Running::start(env, |steps| task(steps, received)),
        }
    }

    /// Passes an input to the program; one that has ended ignores it.
    pub(crate) fn input(&self, input: I) {
        if let Some(inputs) = &self.inputs {
            // A closed channel means that it has ended.
            let _sent = inputs.try_send(input);
        }
    }

    /// Ends the program, because the user moves the hand in another way. Its later steps are not reported.
    pub(crate) fn leave(&mut self) {
        self.inputs = None;
    }

    /// Returns the steps since the last call, and the result once the task has ended.
    pub(crate) fn news(&mut self) -> (Vec<(Moment, S)>, Option<E>) {
        let (mut steps, end) = self.running.news();
        if self.inputs.is_none() {
            steps.clear();
        }
        (steps, end)
    }
}
