//! What trials measured of the hand in a slot: read when it is opened and added to after each trial, off the window's thread.

use crate::app::ctx::Ctx;
use crate::app::notices::NoticeKind;
use crate::hand::overshoot::OvershootMap;
use crate::store::calendar::{day, since_1970};
use crate::store::{BackgroundJob, on_thread};
use crate::transport::Endpoint;
use crate::trials::hand_map::{self, MeasuredClose};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

/// What trials measured of one hand.
#[derive(Debug, Default)]
pub struct HandMap {
    /// What is known of it now. Of the built-in hand only what was measured in this run.
    pub map: Arc<OvershootMap>,
    of: Option<Endpoint>,
    /// Closes that are not in the file yet.
    waiting: Vec<MeasuredClose>,
    under_way: Option<BackgroundJob<io::Result<OvershootMap>>>,
    /// The file is to go once nothing is written to it.
    forgets: bool,
}

impl HandMap {
    /// Takes what a trial measured.
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

    /// Forgets all of it, here and in the file.
    pub(crate) fn forget(&mut self) {
        self.map = Arc::default();
        self.waiting.clear();
        self.forgets = true;
    }

    /// Lets it be of this hand, and its file hold what was measured.
    pub(crate) fn tick(&mut self, endpoint: Option<&Endpoint>, ctx: &mut Ctx<'_>) {
        if self.of.as_ref() != endpoint {
            self.write(ctx);
            *self = Self {
                of: endpoint.cloned(),
                ..Self::default()
            };
            self.write(ctx);
        }
        let end = BackgroundJob::take_from(&mut self.under_way);
        let failed = match end {
            None => None,
            Some(Ok(map)) if !self.forgets => {
                self.map = Arc::new(map);
                let waiting = std::mem::take(&mut self.waiting);
                self.count(&waiting);
                self.waiting = waiting;
                None
            }
            Some(end) => end.err(),
        };
        let forgotten = if self.under_way.is_some() {
            None
        } else if std::mem::take(&mut self.forgets) {
            self.file(ctx)
                .and_then(|file| hand_map::forget(&file).err())
        } else {
            if !self.waiting.is_empty() {
                self.write(ctx);
            }
            None
        };
        for error in failed.into_iter().chain(forgotten) {
            let file = self.file(ctx).unwrap_or_default();
            ctx.tell(NoticeKind::not_saved(file, &error));
        }
    }

    /// Adds what waits to the file, and reads it.
    fn write(&mut self, ctx: &Ctx<'_>) {
        let closes = std::mem::take(&mut self.waiting);
        let Some(file) = self.file(ctx) else { return };
        let work = on_thread(move || hand_map::add(&file, &closes, &day(since_1970())));
        self.under_way = Some(BackgroundJob::start(&ctx.env.runtime, &ctx.env.wake, work));
    }

    fn file(&self, ctx: &Ctx<'_>) -> Option<PathBuf> {
        let settings = ctx.env.settings_path.as_ref()?;
        hand_map::file_of(settings, self.of.as_ref()?)
    }
}
