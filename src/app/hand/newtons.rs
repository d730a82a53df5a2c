//! Newtons of the joints of a slot's hand, as a calibration with a scale stored them: read when the hand is opened, off the window's
//! thread.

use crate::app::env::Ctx;
use crate::app::notices::NoticeKind;
use crate::checkup::newtons_file;
use crate::hand::{Dof, PerDof};
use crate::store::{JobKind, Jobs, on_thread};
use crate::transport::Endpoint;

/// Newtons of one hand.
#[derive(Debug, Default)]
pub struct HandNewtons {
    of: Option<Endpoint>,
    per_g: PerDof<Option<f64>>,
    jobs: Jobs<NewtonsJob>,
}

/// Reading the file.
#[derive(Debug, PartialEq, Eq)]
struct NewtonsJob;

impl JobKind for NewtonsJob {
    type State = HandNewtons;
    type Ctx<'a> = Ctx<'a>;
}

impl HandNewtons {
    /// Newtons of a gram of a joint; `None` if they were not measured.
    pub fn per_g(&self, dof: Dof) -> Option<f64> {
        self.per_g[dof]
    }

    /// Newtons of a gram of all joints.
    pub const fn all_per_g(&self) -> PerDof<Option<f64>> {
        self.per_g
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

    fn read(&mut self, ctx: &Ctx<'_>) {
        let settings = ctx.env.settings_path.as_ref();
        let file = settings.zip(self.of.as_ref());
        let Some(file) = file.and_then(|(settings, hand)| newtons_file::file_of(settings, hand))
        else {
            return;
        };
        let place = file.clone();
        let work = on_thread(move || newtons_file::read(&place));
        self.jobs.start(
            NewtonsJob,
            ctx.env.background(),
            work,
            move |newtons, ctx, known| match known {
                Ok(known) => newtons.per_g = known.per_g(),
                Err(error) => ctx.notify(NoticeKind::not_saved(file, &error)),
            },
        );
    }
}
