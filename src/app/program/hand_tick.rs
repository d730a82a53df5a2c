//! The work at each hand in each frame: applying news and continuing operations.

use crate::app::checkup::{CheckupRun, files};
use crate::app::env::Ctx;
use crate::app::hand::Hand;
use crate::app::hand::hold::{HoldMotion, HoldNews};
use crate::app::hand::running::SequenceRun;
use crate::app::hand::running::{AskedSeries, MotionRun};
use crate::app::notices::NoticeKind;
use crate::app::params::ParamsHand;
use crate::app::poses::PoseState;
use crate::app::procedures::Procedure;
use crate::app::program::inputs;
use crate::app::program::scale;
use crate::app::program::taring;
use crate::app::recordings::recording::{HandRecording, RecordingTarget};
use crate::app::settings::Settings;
use crate::app::trials::work::SeriesHand;
use crate::app::trials::{SeriesPlan, SeriesRun, TrialsState};
use crate::checkup::CheckupPlan;
use crate::hand::{Moment, Status};
use crate::history::MarkKind;
use crate::poses::player::{PlayEnd, PlayPhase};
use crate::record::{Abort, EventKind};
use std::time::Duration;

/// A hand that is not armed within this time, even on the slowest wire, will not be armed.
const ARM_TIMEOUT: Duration = Duration::from_secs(2);

/// State that all hands share.
pub(super) struct Shared<'a> {
    pub(super) settings: &'a mut Settings,
    pub(super) trials: &'a mut TrialsState,
    pub(super) poses: &'a PoseState,
    /// False if nothing is recorded in this run, regardless of the settings.
    pub(super) records: bool,
}

/// Advances one hand.
pub(super) fn tick(hand: &mut Hand, shared: &mut Shared<'_>, ctx: &mut Ctx<'_>) {
    hand.apply_news(&mut ctx.notices, ctx.now);
    let ran = hand.running.sequence().is_some_and(SequenceRun::is_running);
    if let Some(news) = hand.running.sequence_mut().map(SequenceRun::news) {
        apply_hold_news(hand, &news, ctx);
    }
    let thresholds = hand.running.sequence().map(SequenceRun::thresholds);
    hand.readings.grip.judge_by(thresholds.unwrap_or_default());
    let phase = hand.running.sequence().map(|run| run.view.phase);
    if let Some(PlayPhase::Ended(Ok(PlayEnd::NotHolding(grip)))) = phase.filter(|_| ran) {
        ctx.notify(NoticeKind::NotHolding { grip });
    }
    tick_hold(hand, ctx);
    scale::tick(hand, ctx);
    if !hand.running.plays() {
        restore_rested(hand);
    }
    inputs::tick(hand, shared.settings, shared.poses, ctx);
    hand.need_key(shared.settings.hold_to_run);
    hand.tick_requests(ctx);
    let holds = hand.running.holds()
        || hand.running.calibrates()
        || hand.running.sequence().is_some_and(SequenceRun::holds);
    let is_idle = !holds && hand.connection.idle(ctx.now).is_some();
    if shared.settings.disarm_idle && is_idle {
        hand.disarm(ctx.now);
        ctx.notify(NoticeKind::IdleDisarmed);
    }
    let of = ParamsHand {
        connection: &hand.connection,
        overshoot: &hand.overshoot.map,
        env: ctx.env,
    };
    hand.params.tick(of, ctx);
    start_asked(hand, shared, ctx);
    tick_series(hand, shared.trials, ctx);
    let endpoint = hand.connection.endpoint.as_ref();
    hand.overshoot.tick(endpoint, ctx);
    hand.newtons.tick(endpoint, ctx);
    hand.grasps.tick(endpoint, ctx);
    hand.free_force.tick(endpoint, &mut hand.readings.grip, ctx);
    tick_checkup(hand, ctx);
    tick_procedure(hand, shared.settings, ctx);
    if let Some(link) = hand.connection.link() {
        link.read_first(shared.settings.read_first);
    }
    taring::offer(hand, shared.settings, ctx.now);
    let name = hand.connection.name();
    let measured = &mut hand.measured;
    measured.recorder.tick(&measured.history, &name, ctx.now);
    if shared.records {
        tick_recording(hand, shared.settings, ctx);
    }
    hand.continue_leaving(ctx);
}

/// Restores the user's speed and force for joints that are at the targets of a sequence. A joint that presses or still moves keeps the
/// values it was sent with until its next command: a rising threshold would press harder.
fn restore_rested(hand: &mut Hand) {
    if let Some(status) = hand.readings.sample.status {
        hand.restore_limits(|dof| status.value[dof] == Status::PositionReached);
    }
}

/// Starts a series under the current arming; does nothing if there is none.
pub(super) fn start_series(
    hand: &mut Hand,
    plan: SeriesPlan,
    trials: &mut TrialsState,
    ctx: &Ctx<'_>,
) {
    let is_refused = hand.series_refusal(Some(&plan.trials())).is_some() || !plan.is_sound();
    // One series at a time: any key stops it, and it uses the view exclusively.
    if is_refused || trials.running.is_some() {
        return;
    }
    if let Some(at) = lend(hand) {
        let run = SeriesRun::begin(at, plan, trials, ctx);
        hand.running.0 = run.map(|run| MotionRun::Trials(Box::new(run)));
    }
}

/// Starts a check-up under the current arming; does nothing if there is none.
pub(super) fn start_checkup(
    hand: &mut Hand,
    plan: CheckupPlan,
    settings: &Settings,
    ctx: &Ctx<'_>,
) {
    let endpoint = hand.connection.endpoint.clone();
    let Some(endpoint) = endpoint.filter(|_| hand.series_refusal(None).is_none()) else {
        return;
    };
    let files = files(&endpoint, settings, ctx.env);
    if let Some(at) = lend(hand) {
        let run = CheckupRun::begin(at, plan, files, ctx);
        hand.running.0 = Some(MotionRun::Checkup(run));
    }
}

/// Hands an armed hand over to a series.
fn lend(hand: &mut Hand) -> Option<SeriesHand<'_>> {
    hand.take_over();
    let connection = &mut hand.connection;
    let (epoch, open) = (connection.status.armed?, connection.open.as_mut()?);
    let (link, lease) = (open.link.clone(), open.lend_lease());
    hand.controls.release();
    connection.commanded = true;
    Some(SeriesHand {
        link,
        lease,
        epoch,
        seen: hand.readings.sample,
        connection,
    })
}

/// Starts the requested series once the hand is armed for it. A series does not start if arming was late, or the plan has changed
/// meanwhile.
fn start_asked(hand: &mut Hand, shared: &mut Shared<'_>, ctx: &mut Ctx<'_>) {
    let trials = &mut *shared.trials;
    let is_armed = hand.connection.is_armed();
    let Some(MotionRun::Arming(asked, at)) = &hand.running.0 else {
        return;
    };
    // A window that hung meanwhile must not move the hand late.
    let is_late = ctx.now.since(*at) > ARM_TIMEOUT;
    let is_other = match asked {
        AskedSeries::Trials(plan) => **plan != trials.planned(plan.kind()),
        AskedSeries::Checkup(_) => false,
    };
    if !(is_armed || is_late || is_other) {
        return;
    }
    let asked = asked.clone();
    hand.running.0 = None;
    if is_armed && !is_late && !is_other {
        match asked {
            AskedSeries::Trials(plan) => start_series(hand, *plan, trials, ctx),
            AskedSeries::Checkup(plan) => start_checkup(hand, plan, shared.settings, ctx),
        }
    }
    if !hand.runs_series() {
        ctx.notify(NoticeKind::SeriesNotBegun);
    }
}

/// Applies the progress of the series.
fn tick_series(hand: &mut Hand, trials: &mut TrialsState, ctx: &mut Ctx<'_>) {
    let Some(MotionRun::Trials(run)) = &mut hand.running.0 else {
        return;
    };
    let news = run.news(trials);
    let epoch = run.epoch;
    hand.overshoot.add(news.measured);
    for (at, words) in news.begun {
        record_event(hand, at, EventKind::Trial, words);
    }
    if let Some(told) = news.end {
        ctx.notify(told);
        hand.running.0 = None;
        // The task disarmed the hand, or stopped it.
        if hand.connection.status.armed == Some(epoch) {
            hand.disarm(ctx.now);
        }
    }
}

/// Applies the progress of a hold, also of one in a sequence: each finger that pressed harder is a mark.
fn apply_hold_news(hand: &mut Hand, news: &HoldNews, ctx: &mut Ctx<'_>) {
    news.sent.iter().for_each(|setpoints| hand.sent(setpoints));
    for (at, tightened) in &news.tightened {
        let mark = MarkKind::Tightened(*tightened);
        record_event(hand, *at, EventKind::Hold, mark.words());
        hand.measured.history.mark(*at, mark);
    }
    if news.cannot_hold {
        record_event(hand, ctx.now, EventKind::Hold, "cannot hold".into());
        ctx.notify(NoticeKind::CannotHold);
    }
}

/// Applies the progress of the hold.
fn tick_hold(hand: &mut Hand, ctx: &mut Ctx<'_>) {
    let Some(news) = hand.running.hold_mut().map(HoldMotion::news) else {
        return;
    };
    apply_hold_news(hand, &news, ctx);
    let Some(end) = news.end else {
        return;
    };
    if let Some((grasp, agreement)) = hand.running.hold().and_then(HoldMotion::confirmed) {
        hand.grasps.confirm(grasp, agreement, ctx);
    }
    match end {
        Err(Abort::Person) => {}
        Ok(Err(doubt)) => ctx.notify(NoticeKind::GraspDoubted(doubt)),
        Ok(Ok(end)) => ctx.notify(NoticeKind::HoldEnded(Ok(end))),
        Err(why) => ctx.notify(NoticeKind::HoldEnded(Err(why))),
    }
}

/// Applies the progress of the check-up, and stored check-ups that were read.
fn tick_checkup(hand: &mut Hand, ctx: &mut Ctx<'_>) {
    hand.checkup.tick();
    let Some(MotionRun::Checkup(run)) = &mut hand.running.0 else {
        return;
    };
    let epoch = run.epoch;
    let Some(end) = run.news() else {
        return;
    };
    hand.running.0 = None;
    let notices = hand.checkup.over(end).into_iter();
    notices.for_each(|notice| ctx.notify(notice));
    hand.free_force.read_again();
    if hand.connection.status.armed == Some(epoch) {
        hand.disarm(ctx.now);
    }
}

/// Applies the progress of the open procedure, and opens the link it requests.
fn tick_procedure(hand: &mut Hand, settings: &mut Settings, ctx: &mut Ctx<'_>) {
    hand.procedures.watch(&hand.readings.sample);
    let map = &hand.overshoot.map;
    let is_over = hand.procedures.apply_news(&mut hand.params, map, settings);
    if let Some(request) = hand.procedures.take_link_request() {
        if hand.connection.endpoint.as_ref() != Some(&request.place) {
            hand.go(Some(request.place), ctx);
        }
        if let Some(link) = hand.connection.link() {
            let _told = request.opened.send(link.clone());
        }
    }
    if is_over {
        if !matches!(hand.procedures.card, Some(Procedure::Calibrate(_))) {
            hand.params.link_lost(ctx.now);
        }
        hand.params.files = None;
        let home = hand.procedures.home();
        if home.is_some() && hand.connection.endpoint != home {
            hand.go(home, ctx);
        }
    }
}

/// Starts or ends the recording of a hand according to the settings.
fn tick_recording(hand: &mut Hand, settings: &Settings, ctx: &mut Ctx<'_>) {
    let Hand {
        connection,
        params,
        recording,
        running,
        ..
    } = hand;
    let wanted = settings.records(connection.is_simulated());
    let sequence = running.sequence();
    let is_playing = sequence.is_some_and(SequenceRun::is_running) || running.holds();
    match (recording, connection.link()) {
        (Some(recording), Some(link)) if wanted => {
            recording.tick(&mut ctx.notices, ctx.now);
            recording.follow_play(is_playing, ctx.now);
            recording.settings(settings, ctx.now);
            // A partial reading is no news.
            if !params.is_busy() {
                recording.params(&params.live_params(), ctx.now);
            }
            // A recording contains the persistent parameters: they are read once, as soon as the hand rests and no other activity
            // prevents it, unless the user read them before.
            let may_read = params.write_refusal(&connection.status).is_none();
            let link = link.clone();
            if may_read
                && hand.activity().lets_read_beside()
                && let Some(recording) = &mut hand.recording
            {
                recording.request_params(&link, ctx.env);
            }
        }
        (Some(_), _) => hand.recording = None,
        // A hand that never answers creates no file; earlier traffic is still in the tap.
        (None, Some(link)) if wanted && connection.is_live() => {
            let folder = settings.recordings_folder(ctx.env.documents.as_deref());
            let target = folder.zip(connection.endpoint.as_ref());
            hand.recording = target.and_then(|(folder, endpoint)| {
                let target = RecordingTarget {
                    folder,
                    endpoint,
                    side: hand.side,
                    newtons_per_g: hand.newtons.all_per_g(),
                };
                HandRecording::begin(&target, link.observe(), ctx.env)
            });
        }
        (None, _) => {}
    }
}

/// Records a user action in the recording of a hand.
pub(super) fn record_event(hand: &Hand, at: Moment, kind: EventKind, words: String) {
    if let Some(recording) = &hand.recording {
        recording.event(at, kind, words);
    }
}
