//! Sources that may be granted control now, and the task that follows one.

use crate::app::env::Env;
use crate::app::env::running::Running;
use crate::app::inputs::{FollowOutcome, FollowRun, HandInputs, InputSource};
use crate::hand::Moment;
use crate::inputs::Offer;
use crate::link::{LinkHandle, LinkStopper, Owner};
use crate::motion::follow::{FollowEnd, FollowStart, FollowTerms, follow};
use crate::motion::program::Ended;
use crate::record::{Abort, Disarmed};
use tokio::sync::{mpsc, watch};

/// A source that is present and fresh.
pub(crate) struct Offered {
    pub(crate) owner: Owner,
    offers: mpsc::Receiver<Offer>,
    /// The leading hand, if one leads.
    leader: Option<LinkStopper>,
}

impl HandInputs {
    /// Offers of a source; `None` while there is none, or its data is old.
    pub(crate) fn offered(&self, source: InputSource, now: Moment) -> Option<Offered> {
        let (owner, offers) = match source {
            InputSource::Stream => {
                let source = self.stream.as_ref()?;
                (source.view().owner(now)?, source.follow())
            }
            InputSource::Dds => {
                let joined = self.dds.as_ref()?;
                // Two hands must not follow one sender.
                let joined = Some(joined).filter(|joined| joined.others.now().is_none())?;
                let source = &joined.source;
                (source.view().owner(now)?, source.follow())
            }
            InputSource::Pad => {
                let source = self.pad.as_ref()?;
                (source.view().owner()?, source.follow())
            }
            InputSource::Mirror => {
                let source = &self.mirror.as_ref()?.source;
                (source.view().owner(now)?, source.follow())
            }
        };
        let leader = self.mirror.as_ref().filter(|_| owner == Owner::Mirror);
        Some(Offered {
            owner,
            offers,
            leader: leader.map(|mirror| mirror.stopper.clone()),
        })
    }
}

impl FollowRun {
    /// Follows a source under the lease of `start`. The run passes on changed terms.
    pub(crate) fn begin(
        offered: Offered,
        link: LinkHandle,
        start: impl FnOnce(watch::Receiver<FollowTerms>) -> FollowStart,
        (terms, env): (FollowTerms, &Env),
    ) -> Self {
        let (terms, watched) = watch::channel(terms);
        let start = start(watched);
        let Offered {
            owner,
            offers,
            leader,
        } = offered;
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
const fn stops_leader(end: Ended<FollowEnd>) -> bool {
    match end {
        Ok(FollowEnd::Silent | FollowEnd::Gone) | Err(Abort::TakenOver) => false,
        Err(why) => !matches!(
            why,
            Abort::Disarmed {
                why: Some(Disarmed::Person)
            }
        ),
    }
}
