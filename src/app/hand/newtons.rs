//! Newtons of the joints of a slot's hand, as calibrations with a scale found them: read when the hand is opened, and stored when a point
//! is accepted, off the window's thread.

use crate::app::env::Ctx;
use crate::app::notices::NoticeKind;
use crate::checkup::newtons_file;
use crate::hand::newtons::{JointPoints, NewtonsMap};
use crate::hand::{Dof, PerDof};
use crate::store::{JobKind, Jobs, on_thread};
use crate::transport::Endpoint;
use std::path::PathBuf;

/// Newtons of one hand.
#[derive(Debug, Default)]
pub struct HandNewtons {
    of: Option<Endpoint>,
    known: NewtonsMap,
    jobs: Jobs<NewtonsJob>,
}

/// Reading or changing the file.
#[derive(Debug, PartialEq, Eq)]
enum NewtonsJob {
    Read,
    Keep,
}

impl JobKind for NewtonsJob {
    type State = HandNewtons;
    type Ctx<'a> = Ctx<'a>;
}

impl HandNewtons {
    /// Newtons of a gram of a joint; `None` if they were not measured.
    pub fn per_g(&self, dof: Dof) -> Option<f64> {
        self.all_per_g()[dof]
    }

    /// Newtons of a gram of all joints.
    pub fn all_per_g(&self) -> PerDof<Option<f64>> {
        self.known.per_g()
    }

    /// Points of a joint; `None` if it has none.
    pub fn points(&self, dof: Dof) -> Option<&JointPoints> {
        self.known.points(dof)
    }

    /// Switches to this hand if it changed.
    pub(crate) fn tick(&mut self, endpoint: Option<&Endpoint>, ctx: &mut Ctx<'_>) {
        if self.of.as_ref() != endpoint {
            *self = Self {
                of: endpoint.cloned(),
                ..Self::default()
            };
            self.read(ctx);
        }
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, ctx);
        }
    }

    /// Replaces the points of a joint; without points, forgets it.
    pub(crate) fn put(&mut self, dof: Dof, joint: JointPoints, ctx: &Ctx<'_>) {
        match joint.points.is_empty() {
            true => self.known.forget(dof),
            false => self.known.put(dof, joint.clone()),
        }
        let Some(file) = self.file(ctx) else {
            return;
        };
        let place = file.clone();
        let work = on_thread(move || newtons_file::put(&place, dof, joint));
        self.jobs.start(
            NewtonsJob::Keep,
            ctx.env.background(),
            work,
            move |_, ctx, kept| {
                if let Err(error) = kept {
                    ctx.notify(NoticeKind::not_saved(file, &error));
                }
            },
        );
    }

    /// Its file; `None` for the built-in hand.
    fn file(&self, ctx: &Ctx<'_>) -> Option<PathBuf> {
        let settings = ctx.env.settings_path.as_ref();
        let (settings, hand) = settings.zip(self.of.as_ref())?;
        newtons_file::file_of(settings, hand)
    }

    fn read(&mut self, ctx: &Ctx<'_>) {
        let Some(file) = self.file(ctx) else {
            return;
        };
        let place = file.clone();
        let work = on_thread(move || newtons_file::read(&place));
        self.jobs.start(
            NewtonsJob::Read,
            ctx.env.background(),
            work,
            move |newtons, ctx, known| match known {
                Ok(known) => newtons.known = known,
                Err(error) => ctx.notify(NoticeKind::not_saved(file, &error)),
            },
        );
    }
}
