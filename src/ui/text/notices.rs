//! Messages, troubles of the link and failed requests as sentences in the window's language. Decides nothing.

use crate::app::notices::{Notice, NoticeKind, RequestKind};
use crate::app::readings::faults::FaultKind;
use crate::app::settings::Language;
use crate::hand::Words;
use crate::record::Disarmed;
use crate::record::file::{OpenError, RecorderNotice};
use crate::record::quirk_sheet::FactDifference;
use crate::ui::style::phrase::Text;
use crate::ui::style::{Look, format};
use crate::ui::text::{errors, main, panels, poses, scan, sessions, tune, window, words};
use std::path::Path;

/// Title, cause and advice of what is wrong with a drive.
pub(crate) const fn fault_kind(what: FaultKind, language: Language) -> Words {
    match what {
        FaultKind::Fault(fault) => words::fault(fault, language),
        FaultKind::Status(status) => words::status(status, language),
    }
}

fn asked(look: Look, what: RequestKind) -> String {
    match what {
        RequestKind::Gesture(gesture) => look.told(panels::GESTURE, gesture.get()),
        RequestKind::ClearErrors => look.say(panels::CLEAR).into(),
    }
}

fn disarmed(look: Look, why: Disarmed) -> &'static str {
    look.say(match why {
        Disarmed::Stop => panels::DISARMED_STOP,
        Disarmed::Person => panels::DISARMED_PERSON,
        Disarmed::Fault => panels::DISARMED_FAULT,
        Disarmed::LinkLost => panels::DISARMED_LOST,
        Disarmed::Stale => panels::DISARMED_STALE,
        Disarmed::OtherController => panels::DISARMED_OTHER_CONTROLLER,
        Disarmed::FrozenFeedback => panels::DISARMED_FROZEN,
        Disarmed::Resume => panels::DISARMED_RESUME,
        Disarmed::Released => panels::DISARMED_RELEASED,
        Disarmed::Silent => panels::DISARMED_SILENT,
        Disarmed::Hot => panels::DISARMED_HOT,
    })
}

/// What a latency timer does, and the one line that cures it.
fn latency_timer(look: Look, port: &str, ms: Option<u16>) -> String {
    let said = match ms {
        Some(ms) => format!("{} {ms} ms.", look.say(panels::TIMER_TOLD)),
        None => look.say(panels::TIMER_SEEN).to_owned(),
    };
    let name = port.rsplit('/').next().unwrap_or(port);
    let cure = if cfg!(windows) {
        look.say(panels::TIMER_CURE_WINDOWS).to_owned()
    } else {
        let file = format!("/sys/bus/usb-serial/devices/{name}/latency_timer");
        format!("{} echo 1 | sudo tee {file}", look.say(panels::TIMER_CURE))
    };
    format!("{said} {cure}")
}

fn place(path: Option<&Path>) -> String {
    path.map(|path| path.display().to_string())
        .unwrap_or_default()
}

/// A message, and of several hands the one that it is about.
pub(crate) fn notice_of(look: Look, notice: &Notice) -> String {
    let said = self::notice(look, &notice.what);
    match &notice.hand {
        Some(hand) if !hand.name.is_empty() => look.pair(&hand.name, &said),
        _ => said,
    }
}

/// A message as one or two sentences.
#[expect(clippy::too_many_lines, reason = "one arm for each message")]
pub(crate) fn notice(look: Look, what: &NoticeKind) -> String {
    let said = |text| look.say(text).to_owned();
    let told = |text: Text, more: &str| look.told(text, more);
    let system = |text: Text, message: &str| told(text, &errors::system(look, message));
    let of = |text: Text, path: &Path, why: &str| {
        look.pair(&told(text, &path.display().to_string()), why)
    };
    match what {
        NoticeKind::LinkLost(why) => told(panels::NOTICE_LOST, &errors::trouble(look, why)),
        NoticeKind::NoLink(why) => told(panels::NOTICE_NO_LINK, &errors::trouble(look, why)),
        NoticeKind::LatencyTimer { port, ms } => latency_timer(look, port, *ms),
        NoticeKind::Reconnected => said(panels::NOTICE_RECONNECTED),
        NoticeKind::HoldConfirmed { after } => told(panels::NOTICE_HELD, &format::age(*after)),
        NoticeKind::HoldAlarm => said(main::ALARM_TITLE.tip()),
        NoticeKind::StopNotSent => said(panels::NOTICE_STOP_NOT_SENT),
        NoticeKind::TareUnderLoad { finger, newtons } => {
            let finger = look.say(words::finger(*finger));
            match look.language {
                Language::En => format!(
                    "Not tared: {finger} is touched ({newtons:.1} N). Let go of everything, then tare."
                ),
                Language::Zh => {
                    format!("未去皮：{finger}正在受力（{newtons:.1} N）。请先松开物体再去皮。")
                }
            }
        }
        NoticeKind::Disarmed(why) => disarmed(look, *why).into(),
        NoticeKind::DisarmedByOther(conflict) => {
            let what = words::setpoint(look, conflict);
            look.fill(panels::DISARMED_BY_OTHER, &[&what])
        }
        NoticeKind::LeaderStopped => said(panels::LEADER_STOPPED),
        NoticeKind::SourceSilent(owner) => {
            look.fill(panels::SOURCE_SILENT, &[&words::owner(look, *owner)])
        }
        NoticeKind::ArmRefused(why) => told(panels::NOTICE_ARM, &words::refusal(look, *why)),
        NoticeKind::Fault { dof, what } => {
            let title = fault_kind(*what, look.language).title;
            look.pair(look.say(words::dof(*dof)), title)
        }
        NoticeKind::RequestFailed { what, error } => {
            look.pair(&asked(look, *what), &errors::request(look, error))
        }
        NoticeKind::Acknowledged { what } => {
            look.pair(&asked(look, *what), look.say(panels::NOTICE_ACKNOWLEDGED))
        }
        NoticeKind::GestureWouldMoveLocked { dof } => {
            told(panels::NOTICE_LOCKED, look.say(words::dof(*dof)))
        }
        NoticeKind::PoseUnknown => said(poses::CAPTURE_UNKNOWN),
        NoticeKind::SeriesRuns => said(main::SERIES_RUNS),
        NoticeKind::ExhibitWantsOneHand => said(window::EXHIBIT_ONE_HAND),
        NoticeKind::OpenElsewhere { endpoint, hand } => {
            look.fill(window::OPEN_ELSEWHERE, &[endpoint, hand])
        }
        NoticeKind::ExhibitNotBegun => said(main::EXHIBIT_NOT_BEGUN),
        NoticeKind::SeriesEnded { trials, aborted } => match aborted {
            None => look.fill(tune::ENDED, &[trials]),
            Some(why) => look.fill(tune::ENDED_EARLY, &[trials, &tune::abort(look, *why)]),
        },
        NoticeKind::GesturesOff => said(panels::GESTURES_OFF),
        // The words of the graphics driver help whoever mends it.
        NoticeKind::Unguarded { why } => told(panels::NOTICE_UNGUARDED, why),
        NoticeKind::DrawnWithoutOpenGl { reason } => match look.language {
            Language::En => told(panels::NOTICE_WITHOUT_OPENGL, &format!("({reason})")),
            Language::Zh => said(panels::NOTICE_WITHOUT_OPENGL),
        },
        NoticeKind::NoFileChosen => said(window::NO_FILE),
        NoticeKind::HandDiffers {
            differences,
            last_seen,
        } => differing(look, differences, last_seen),
        NoticeKind::EndpointIgnored { text } => told(panels::NOTICE_ENDPOINT, text),
        NoticeKind::PosesImported {
            poses: count,
            sequences,
        } => format!(
            "{} {count} {}, {sequences} {}",
            look.say(poses::IMPORTED),
            look.say(poses::COUNT_POSES),
            look.say(poses::COUNT_SEQUENCES)
        ),
        NoticeKind::SessionOpened { path, trials } => {
            look.fill(tune::OPENED, &[&path.display(), trials])
        }
        NoticeKind::FileRefused { path, error } => look.fill(
            window::REFUSED,
            &[&path.display(), &errors::file(look, error)],
        ),
        NoticeKind::FileIgnored {
            path,
            error,
            kept_as,
        } => {
            let why = errors::file(look, error);
            let aside = place(kept_as.as_deref());
            look.fill(window::IGNORED, &[&path.display(), &why, &aside])
        }
        NoticeKind::Saved { path, entries } => {
            let path = path.display().to_string();
            format!("{} ({entries})", told(window::SAVED, &path))
        }
        NoticeKind::NotSaved { path, message } => {
            of(window::NOT_SAVED, path, &errors::system(look, message))
        }
        NoticeKind::NotDeleted { path, error } => of(
            sessions::NOT_DELETED,
            path,
            &errors::system_error(look, error),
        ),
        NoticeKind::NotRevealed { path, error } => {
            let why = errors::system_error(look, error);
            look.fill(sessions::NOT_REVEALED, &[&why, &path.display()])
        }
        NoticeKind::SessionRefused { path, why } => look.fill(
            sessions::REFUSED,
            &[&path.display(), &not_opened(look, why)],
        ),
        NoticeKind::Recording(notice) => recording(look, notice),
        NoticeKind::NotReplayedNow => look.say(sessions::NOT_NOW).to_owned(),
        NoticeKind::Recorded => look.say(sessions::IS_RECORDING).to_owned(),
        NoticeKind::SessionsPlanned {
            sessions: count,
            bytes,
            days: (first, last),
            due,
        } => {
            let size = format::size(*bytes);
            look.fill(sessions::PLANNED, &[count, &size, first, last, due])
        }
        NoticeKind::SessionsDeleted { sessions: count } => look.told(sessions::DELETED, count),
        NoticeKind::PlanIgnored { message } => system(tune::PLAN_IGNORED, message),
    }
}

/// What happened to the file of a recording under way.
fn recording(look: Look, notice: &RecorderNotice) -> String {
    match notice {
        RecorderNotice::Moved { from, to: Some(to) } => {
            look.fill(sessions::FILE_MOVED, &[&from.display(), &to.display()])
        }
        RecorderNotice::Moved { from, to: None } => {
            look.fill(sessions::FILE_RENAMED, &[&from.display()])
        }
        RecorderNotice::Removed { path, entries } => {
            look.fill(sessions::FILE_REMOVED, &[&path.display(), entries])
        }
        RecorderNotice::ClockSet { next } => look.fill(sessions::CLOCK_SET, &[next]),
    }
}

/// Why a recorded session was not opened.
fn not_opened(look: Look, why: &OpenError) -> String {
    let words = match why {
        OpenError::Unreadable { error } => return errors::system_error(look, error),
        OpenError::NotAFile => sessions::NOT_A_FILE,
        OpenError::NotMcap => sessions::NOT_MCAP,
        OpenError::Foreign => sessions::FOREIGN,
        OpenError::SeveralHands { hands } => return look.told(sessions::SEVERAL_HANDS, hands),
        OpenError::Empty => sessions::EMPTY,
    };
    look.say(words).to_owned()
}

fn differing(look: Look, differences: &[FactDifference], last_seen: &str) -> String {
    let facts = differences.iter().map(|difference| {
        let FactDifference { fact, before, now } = difference;
        format!("{}: {before} -> {now}", look.say(scan::fact(*fact)))
    });
    let facts: Vec<String> = facts.collect();
    let intro = look.say(scan::OTHER_HAND);
    format!("{intro} ({last_seen}) {}", facts.join("; "))
}
