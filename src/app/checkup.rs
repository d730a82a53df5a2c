//! Check-ups in the window: the running one, its files, and the last result. Measurements and judgements are defined in
//! [`crate::checkup`]. Draws nothing.

use crate::app::env::motion_task::MotionTask;
use crate::app::env::{Ctx, Env, day_folder};
use crate::app::notices::NoticeKind;
use crate::app::settings::Settings;
use crate::app::trials::work::SeriesHand;
use crate::checkup::free_file;
use crate::checkup::report::{CheckupReport, PAGE_FILE};
use crate::checkup::run::CheckupView;
use crate::checkup::subject::Grade;
use crate::checkup::{Checkup, CheckupPlan};
use crate::hand::{ArmEpoch, Moment};
use crate::motion::checkup::{CheckupFiles, ConcludedCheckup, EndedCheckup};
use crate::motion::drive::{Armed, drive};
use crate::motion::program::Progress;
use crate::record::Abort;
use crate::store::calendar::{day, since_1970, stamp};
use crate::store::{JobKind, Jobs, create_folder, on_thread};
use crate::transport::Endpoint;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// User requests concerning check-ups. By sending one, the user confirms that the hand is empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum CheckupAction {
    /// Start a check-up in the current arming. Needs arming.
    Start(CheckupPlan),
    /// Arm the hand, and start a check-up once it is armed.
    ArmAndStart(CheckupPlan),
}

#[derive(Debug, Default)]
pub struct HandCheckup {
    /// The last check-up: of this run of the program, else the last stored one.
    pub last: Option<ShownCheckup>,
    /// Reason why the stored check-ups cannot be read.
    pub unread: Option<String>,
    jobs: Jobs<ReadLastCheckup>,
    /// True once stored check-ups have been requested.
    is_read: bool,
}

/// Background job of check-ups: reading the last stored one.
#[derive(Debug, PartialEq, Eq)]
struct ReadLastCheckup;

impl JobKind for ReadLastCheckup {
    type State = HandCheckup;
    type Ctx<'a> = ();
}

/// A finished check-up.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownCheckup {
    pub report: CheckupReport,
    /// HTML report; `None` if it was not written.
    pub page: Option<PathBuf>,
}

impl ShownCheckup {
    fn of((report, folder): (CheckupReport, Option<PathBuf>)) -> Self {
        let page = folder.map(|folder| folder.join(PAGE_FILE));
        Self { report, page }
    }
}

/// A running check-up, as the window sees it.
#[derive(Debug)]
pub struct CheckupRun {
    /// Current progress.
    pub view: CheckupView,
    pub epoch: ArmEpoch,
    /// Start of the current step.
    pub since: Moment,
    task: MotionTask<Abort, CheckupView, io::Result<ConcludedCheckup>>,
}

impl CheckupRun {
    /// Starts a check-up.
    pub(crate) fn begin(
        hand: SeriesHand<'_>,
        plan: CheckupPlan,
        files: CheckupFiles,
        ctx: &Ctx<'_>,
    ) -> Self {
        let clock = ctx.env.clock;
        let (epoch, link) = (hand.epoch, hand.link);
        let checkup = Checkup::start(epoch, plan);
        let view = checkup.view();
        let armed = Armed {
            epoch,
            lease: hand.lease,
            seen: hand.seen,
            clock,
        };
        let task = MotionTask::start(ctx.env, |steps, ends| async move {
            let wanted = files.clone();
            let prepared = on_thread(move || prepare(&wanted)).await;
            let recording = prepared.and_then(|()| files.record(link.observe(), clock));
            let recording = match recording {
                Ok(recording) => recording,
                Err(error) => {
                    link.disarm();
                    return Err(error);
                }
            };
            let report = |progress| {
                if let Progress::View(view) = progress {
                    steps.send(view);
                }
                true
            };
            let driven = drive(&link, armed, checkup, ends, report).await;
            let ended = EndedCheckup { driven, recording };
            on_thread(move || Ok(files.conclude(ended))).await
        });
        Self {
            view,
            epoch,
            since: ctx.now,
            task,
        }
    }

    /// Applies the progress of the task, and returns its result once it has ended.
    pub(crate) fn news(&mut self) -> Option<io::Result<ConcludedCheckup>> {
        let (steps, end) = self.task.news();
        for (at, view) in steps {
            (self.view, self.since) = (view, at);
        }
        end
    }

    /// Approximate remaining time if nothing ends the check-up early.
    pub fn left(&self, now: Moment) -> Duration {
        self.view.left.saturating_sub(now.since(self.since))
    }

    /// Ends the check-up early. The caller stops the hand, and the task makes sure of it.
    pub(crate) fn end(&self, why: Abort) {
        self.task.input(why);
    }
}

impl HandCheckup {
    /// True while the stored check-ups are being read.
    pub const fn is_reading(&self) -> bool {
        !self.jobs.is_empty()
    }

    /// Stores the result of a check-up for display, and returns the notices for the user.
    pub(crate) fn over(&mut self, end: io::Result<ConcludedCheckup>) -> Vec<NoticeKind> {
        match end {
            Err(error) => vec![NoticeKind::not_saved(PathBuf::from("checks"), &error)],
            Ok(ConcludedCheckup { report, written }) => {
                let mut notices = vec![NoticeKind::CheckupEnded {
                    act: report.count(Grade::Act),
                    watch: report.count(Grade::Watch),
                    aborted: report.aborted,
                }];
                let folder = match written.transpose() {
                    Ok(folder) => folder,
                    Err(error) => {
                        notices.push(NoticeKind::not_saved(PathBuf::from("report.html"), &error));
                        None
                    }
                };
                self.last = Some(ShownCheckup::of((report, folder)));
                notices
            }
        }
    }

    /// Reads the stored check-ups when their view is shown, once.
    pub(crate) fn read_last(&mut self, files: CheckupFiles, env: &Env) {
        if std::mem::replace(&mut self.is_read, true) {
            return;
        }
        // Nothing is stored for the built-in hand.
        if files.kept.is_none() {
            return;
        }
        let read = async move { on_thread(move || Ok(files.last())).await.flatten() };
        self.jobs.start(
            ReadLastCheckup,
            env.background(),
            read,
            |checkup, (), read| match read {
                Ok(kept) if checkup.last.is_none() => checkup.last = kept.map(ShownCheckup::of),
                Ok(_) => {}
                Err(error) => checkup.unread = Some(error.to_string()),
            },
        );
    }

    /// Applies the result of the read.
    pub(crate) fn tick(&mut self) {
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, &mut ());
        }
    }
}

/// Paths of a hand's check-up files in the window.
pub(crate) fn files(hand: &Endpoint, settings: &Settings, env: &Env) -> CheckupFiles {
    let checks = env.settings_path.as_ref();
    let checks = checks.map(|path| path.with_file_name("checks"));
    let documents = env.documents.as_deref();
    CheckupFiles {
        hand: hand.clone(),
        free_force: env
            .settings_path
            .as_ref()
            .and_then(|settings| free_file::file_of(settings, hand)),
        kept: checks.and_then(|folder| CheckupFiles::kept_in(&folder, hand)),
        report: documents.map(|documents| {
            let now = since_1970();
            let time = stamp(now);
            let time = time.chars().skip_while(|letter| *letter != 'T');
            let time: String = time.filter(char::is_ascii_digit).collect();
            let folder = day_folder::of_day(documents, &day(now));
            day_folder::free_path(&folder, &format!("handscope-check-{}-{time}", day(now)))
        }),
        recordings: settings.recordings_folder(documents),
    }
}

/// Prepares the destination folders. The hand does not move if the check-up could not be stored or its report not
/// written.
fn prepare(files: &CheckupFiles) -> io::Result<()> {
    files.prepare()?;
    files.report.as_deref().map_or(Ok(()), create_folder)
}
