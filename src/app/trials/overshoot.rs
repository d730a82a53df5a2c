//! Overshoot of the hand in a slot, measured by trials: loaded when the hand is opened, extended after each trial, in the
//! background.

use crate::app::env::Ctx;
use crate::app::notices::NoticeKind;
use crate::hand::overshoot::OvershootMap;
use crate::store::calendar::{day, since_1970};
use crate::store::{JobKind, Jobs, on_thread};
use crate::transport::Endpoint;
use crate::trials::overshoot_file::{self, MeasuredClose};
use std::path::PathBuf;
use std::sync::Arc;

/// Measured overshoot of one hand.
#[derive(Debug, Default)]
pub struct HandOvershoot {
    /// Current overshoot map. For the built-in hand it covers this run only.
    pub map: Arc<OvershootMap>,
    of: Option<Endpoint>,
    /// Closes that are not in the file yet.
    waiting: Vec<MeasuredClose>,
    jobs: Jobs<SyncOvershoot>,
    /// True if the file must be cleared.
    forgets: bool,
}

/// Background job of the overshoot: synchronizing its file with the measurements.
#[derive(Debug, PartialEq, Eq)]
struct SyncOvershoot;

impl JobKind for SyncOvershoot {
    type State = HandOvershoot;
    type Ctx<'a> = Ctx<'a>;
}

impl HandOvershoot {
    /// Adds the measurements of a trial.
    pub(crate) fn add(&mut self, closes: Vec<MeasuredClose>) {
        self.count(&closes);
        self.waiting.extend(closes);
    }

    fn count(&mut self, closes: &[MeasuredClose]) {
        let today = day(since_1970());
        for (kind, over_g) in closes {
            Arc::make_mut(&mut self.map).add(*kind, *over_g, &today);
        }
    }

    /// Clears all measurements, in memory and in the file.
    pub(crate) fn forget(&mut self) {
        self.map = Arc::default();
        self.waiting.clear();
        self.forgets = true;
    }

    /// Switches to this hand if it changed, and synchronizes its file with the measurements.
    pub(crate) fn tick(&mut self, endpoint: Option<&Endpoint>, ctx: &mut Ctx<'_>) {
        if self.of.as_ref() != endpoint {
            if self.forgets || !self.waiting.is_empty() {
                self.write(ctx);
            }
            *self = Self {
                of: endpoint.cloned(),
                ..Self::default()
            };
            self.write(ctx);
        }
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, ctx);
        }
        if self.jobs.is_empty() && (self.forgets || !self.waiting.is_empty()) {
            self.write(ctx);
        }
    }

    /// Clears the file if requested, appends the pending measurements, and reads it back.
    fn write(&mut self, ctx: &Ctx<'_>) {
        let closes = std::mem::take(&mut self.waiting);
        let forgets = std::mem::take(&mut self.forgets);
        let Some(file) = self.file(ctx) else { return };
        let place = file.clone();
        let work = on_thread(move || {
            if forgets {
                overshoot_file::forget(&place)?;
            }
            overshoot_file::add(&place, &closes, &day(since_1970()))
        });
        self.jobs.start(
            SyncOvershoot,
            ctx.env.background(),
            work,
            move |overshoot, ctx, map| match map {
                Ok(_) if overshoot.forgets => {}
                Ok(map) => {
                    overshoot.map = Arc::new(map);
                    let waiting = std::mem::take(&mut overshoot.waiting);
                    overshoot.count(&waiting);
                    overshoot.waiting = waiting;
                }
                Err(error) => ctx.notify(NoticeKind::not_saved(file, &error)),
            },
        );
    }

    fn file(&self, ctx: &Ctx<'_>) -> Option<PathBuf> {
        let settings = ctx.env.settings_path.as_ref()?;
        overshoot_file::file_of(settings, self.of.as_ref()?)
    }
}
