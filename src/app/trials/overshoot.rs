//! What trials measured of the hand in a slot: read when it is opened and added to after each trial, off the window's thread.

use crate::app::ctx::Ctx;
use crate::app::notices::NoticeKind;
use crate::hand::overshoot::OvershootMap;
use crate::store::calendar::{day, since_1970};
use crate::store::{BackgroundJob, on_thread};
use crate::transport::Endpoint;
use crate::trials::overshoot_file::{self, MeasuredClose};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

/// What trials measured of one hand.
#[derive(Debug, Default)]
pub struct HandOvershoot {
    /// What is known of it now. Of the built-in hand only what was measured in this run.
    pub map: Arc<OvershootMap>,
    of: Option<Endpoint>,
    /// Closes that are not in the file yet.
    waiting: Vec<MeasuredClose>,
    under_way: Option<BackgroundJob<io::Result<OvershootMap>>>,
    /// What is in the file is to go.
    forgets: bool,
}

impl HandOvershoot {
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
            if self.forgets || !self.waiting.is_empty() {
                self.write(ctx);
            }
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
        if let Some(error) = failed {
            let file = self.file(ctx).unwrap_or_default();
            ctx.tell(NoticeKind::not_saved(file, &error));
        }
        if self.under_way.is_none() && (self.forgets || !self.waiting.is_empty()) {
            self.write(ctx);
        }
    }

    /// Forgets the file if that is wanted, adds what waits to it, and reads it.
    fn write(&mut self, ctx: &Ctx<'_>) {
        let closes = std::mem::take(&mut self.waiting);
        let forgets = std::mem::take(&mut self.forgets);
        let Some(file) = self.file(ctx) else { return };
        let work = on_thread(move || {
            if forgets {
                overshoot_file::forget(&file)?;
            }
            overshoot_file::add(&file, &closes, &day(since_1970()))
        });
        self.under_way = Some(BackgroundJob::start(&ctx.env.runtime, &ctx.env.wake, work));
    }

    fn file(&self, ctx: &Ctx<'_>) -> Option<PathBuf> {
        let settings = ctx.env.settings_path.as_ref()?;
        overshoot_file::file_of(settings, self.of.as_ref()?)
    }
}
