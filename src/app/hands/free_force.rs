//! Forces that the joints of a slot's hand read while they touch nothing: read when the hand is opened, and stored when a close
//! improved them, off the window's thread.

use crate::app::ctx::Ctx;
use crate::app::notices::NoticeKind;
use crate::checkup::free_file;
use crate::hand::grip::{FreeForce, GripEstimator};
use crate::store::{BackgroundJob, on_thread};
use crate::transport::Endpoint;
use std::io;
use std::path::PathBuf;

/// Free forces of one hand.
#[derive(Debug, Default)]
pub(crate) struct HandFreeForce {
    of: Option<Endpoint>,
    /// `None` until its file was read.
    known: Option<FreeForce>,
    /// Value of `learned` of the estimator at the last store.
    kept: u64,
    under_way: Option<BackgroundJob<io::Result<FreeForce>>>,
}

impl HandFreeForce {
    /// Reads the file again, because a check-up measured free forces.
    pub(crate) fn read_again(&mut self) {
        self.of = None;
    }

    /// Follows the hand of the slot, passes its free forces to the estimator, and stores improved ones.
    pub(crate) fn tick(
        &mut self,
        hand: Option<&Endpoint>,
        grip: &mut GripEstimator,
        ctx: &mut Ctx<'_>,
    ) {
        if self.of.as_ref() != hand {
            *self = Self {
                of: hand.cloned(),
                ..Self::default()
            };
            match self.file(ctx) {
                Some(file) => self.start(ctx, move || free_file::read(&file)),
                None => self.known = Some(FreeForce::default()),
            }
        }
        match BackgroundJob::take_from(&mut self.under_way) {
            None => {}
            Some(Ok(known)) => {
                self.kept = grip.learned();
                self.known = Some(known);
                grip.set_free_force(known);
            }
            Some(Err(error)) => {
                self.known.get_or_insert_default();
                let file = self.file(ctx).unwrap_or_default();
                ctx.notify(NoticeKind::not_saved(file, &error));
            }
        }
        let Some(known) = self.known.filter(|_| self.under_way.is_none()) else {
            return;
        };
        if grip.learned() == 0 && *grip.free_force() != known {
            // A new connection with the same hand.
            self.kept = 0;
            grip.set_free_force(known);
        } else if grip.learned() > self.kept {
            let learnt = *grip.free_force();
            (self.known, self.kept) = (Some(learnt), grip.learned());
            if let Some(file) = self.file(ctx) {
                self.start(ctx, move || {
                    free_file::keep(&file, &learnt).map(|()| learnt)
                });
            }
        }
    }

    fn start(
        &mut self,
        ctx: &Ctx<'_>,
        work: impl FnOnce() -> io::Result<FreeForce> + Send + 'static,
    ) {
        let work = on_thread(work);
        self.under_way = Some(BackgroundJob::start(&ctx.env.runtime, &ctx.env.wake, work));
    }

    fn file(&self, ctx: &Ctx<'_>) -> Option<PathBuf> {
        let settings = ctx.env.settings_path.as_ref()?;
        free_file::file_of(settings, self.of.as_ref()?)
    }
}
