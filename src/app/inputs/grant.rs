//! The source that is granted control, and the task that follows it.

use crate::app::env::Env;
use crate::app::env::running::Running;
use crate::app::inputs::{FollowOutcome, FollowRun, HandInputs};
use crate::hand::Moment;
use crate::link::{LinkHandle, Owner};
use crate::motion::follow::{FollowStart, FollowTerms, follow};
use crate::motion::program::Ended;
use crate::motion::source::{Source, SourceKind};
use crate::record::{Abort, Disarmed};
use tokio::sync::watch;

impl HandInputs {
    /// A source that may be granted control now, as this owner: it is present, its data is fresh, and no other hand follows its sender.
    pub(crate) fn offered(&self, kind: SourceKind, now: Moment) -> Option<(&Source, Owner)> {
        let source = self.source(kind)?;
        let owner = source.owner(now)?;
        source.other_follower().is_none().then_some((source, owner))
    }
}

impl FollowRun {
    /// Follows a source under the lease of `start`. The run passes on changed terms.
    pub(crate) fn begin(
        (source, owner): (&Source, Owner),
        link: LinkHandle,
        start: impl FnOnce(watch::Receiver<FollowTerms>) -> FollowStart,
        (terms, env): (FollowTerms, &Env),
    ) -> Self {
        let (terms, watched) = watch::channel(terms);
        let start = start(watched);
        let (offers, leader) = (source.follow(), source.leader());
        let task = Running::start(env, |views| async move {
            let end = follow(&link, start, offers, |view| views.send(view)).await;
            let leader = leader.filter(|_| stops_leader(end));
            FollowOutcome {
                end,
                leader_stopped: leader.is_some_and(|leader| leader.stop_if_moved()),
            }
        });
        Self {
            owner,
            view: None,
            terms,
            task,
        }
    }
}

/// True if a led hand was lost or stopped, so that the leading hand must not continue alone. It may continue if the user took the led
/// hand back, or granted control to another party.
const fn stops_leader(end: Ended<()>) -> bool {
    match end {
        Ok(()) | Err(Abort::TakenOver) => false,
        Err(why) => !matches!(
            why,
            Abort::Disarmed {
                why: Some(Disarmed::Person)
            }
        ),
    }
}
