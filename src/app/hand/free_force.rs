//! Forces that the joints of a slot's hand read while they touch nothing: read when the hand is opened, and stored when a close
//! improved them, off the window's thread.

use crate::app::env::Ctx;
use crate::app::notices::NoticeKind;
use crate::checkup::free_file;
use crate::hand::grip::{FreeForce, GripEstimator};
use crate::store::{JobKind, Jobs, on_thread};
use crate::transport::Endpoint;
use std::io;
use std::path::{Path, PathBuf};

/// Free forces of one hand.
#[derive(Debug, Default)]
pub(crate) struct HandFreeForce {
    of: Option<Endpoint>,
    /// `None` until its file was read.
    known: Option<FreeForce>,
    /// Value of `learned` of the estimator at the last store.
    kept: u64,
    jobs: Jobs<FreeForceJob>,
}

/// Reading or keeping the file; one of both at a time.
#[derive(Debug, PartialEq, Eq)]
struct FreeForceJob;

/// What is changed besides when the file was read or kept.
struct FreeForceCtx<'a> {
    grip: &'a mut GripEstimator,
    notices: Vec<NoticeKind>,
}

impl JobKind for FreeForceJob {
    type State = HandFreeForce;
    type Ctx<'a> = FreeForceCtx<'a>;
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
                Some(file) => self.start(ctx, file, free_file::read),
                None => self.known = Some(FreeForce::default()),
            }
        }
        let mut changes = FreeForceCtx {
            grip: &mut *grip,
            notices: Vec::new(),
        };
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, &mut changes);
        }
        let notices = changes.notices.into_iter();
        notices.for_each(|notice| ctx.notify(notice));
        let Some(known) = self.known.filter(|_| self.jobs.is_empty()) else {
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
                self.start(ctx, file, move |file| {
                    free_file::keep(file, &learnt).map(|()| learnt)
                });
            }
        }
    }

    fn start(
        &mut self,
        ctx: &Ctx<'_>,
        file: PathBuf,
        work: impl FnOnce(&Path) -> io::Result<FreeForce> + Send + 'static,
    ) {
        let place = file.clone();
        let work = on_thread(move || work(&place));
        self.jobs.start(
            FreeForceJob,
            ctx.env.background(),
            work,
            move |own, changes, known| match known {
                Ok(known) => {
                    own.kept = changes.grip.learned();
                    own.known = Some(known);
                    changes.grip.set_free_force(known);
                }
                Err(error) => {
                    own.known.get_or_insert_default();
                    changes.notices.push(NoticeKind::not_saved(file, &error));
                }
            },
        );
    }

    fn file(&self, ctx: &Ctx<'_>) -> Option<PathBuf> {
        let settings = ctx.env.settings_path.as_ref()?;
        free_file::file_of(settings, self.of.as_ref()?)
    }
}
