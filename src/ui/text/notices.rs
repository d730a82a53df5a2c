//! Sentences of the faults, the recordings around them and the message log.

use crate::app::notices::{Level, Notice, NoticeKind, RequestKind};
use crate::app::readings::faults::FaultKind;
use crate::app::settings::Language;
use crate::hand::gap::BlockError;
use crate::hand::{Dof, Words};
use crate::record::Disarmed;
use crate::record::file::{OpenError, RecorderNotice};
use crate::record::quirk_sheet::FactDifference;
use crate::ui::style::phrase::{Text, texts};
use crate::ui::style::{Look, format};
use crate::ui::text::{
    checkup, errors, hold, inputs, main, panels, poses, recordings, scan, tune, window, words,
};
use std::path::Path;

texts! {
    EXPLAIN: "status, explained", "状态说明", "Click: what this means and what to do.", "点击：查看含义与处理建议。";
    SAYS_NOW: "says now", "当前状态";
    SAID_LAST: "said last", "上次状态";
    CHOSEN_CLOSE: "Show all drives", "显示全部驱动器";
    TODO: "What to do:", "处理：";

    NOW: "now", "当前";
    OVER_UNSEEN: "over, not seen yet", "已结束，未查看";
    OVER: "over", "已结束";
    WHEN_READ: "when last read", "上次读取时";
    BEGAN: "Began {} ago", "{}前开始";
    LASTED: "lasted", "持续";
    CAME: "{} times", "共 {} 次";
    SEEN: "Seen", "已看", "You have seen this fault. It stays in the list until it is forgotten, and is unseen again if it comes again.", "表示已查看该故障。它仍留在列表中；再次出现时会重新标为未查看。";
    SEEN_ALL: "All seen", "全部已看", "You have seen all faults of the list.", "表示已查看列表中的全部故障。";
    SEEN_NONE: "Every fault was seen.", "没有未查看的故障。";
    SHUT_FAULTS: "Close faults", "关闭故障";
    UNSEEN_BEFORE: "Faults:", "故障";
    UNSEEN: "unseen", "项未查看", "Faults that nobody has marked as seen, lasting or over. Opens them.", "尚未标为已看的故障，包括已结束的。点击查看。";
    UNSEEN_MARK: "unseen fault", "未查看的故障";

    CLEAR_NO_FAULT: "Nothing is wrong that could be cleared.", "没有可清除的故障。";
    CLEAR_ONLY_HEAT: "Only over-temperature is left: it cannot be cleared and ends when the drive is cool.", "仅剩过温故障：不可清除，温度回落后自动结束。";
    CLEAR_UNREAD: "Faults were not read yet.", "尚未读取故障。";

    MEANINGS: "What the words mean", "术语说明";
    MEANINGS_STATUS: "What a drive says it does", "驱动器状态";
    MEANINGS_FAULT: "What can be wrong with a drive", "驱动器故障";

    LOG: "Messages", "消息";
    LOG_NONE: "Nothing has happened yet.", "还没有消息。";
    LOG_NONE_PASS: "No message passes the filter.", "没有符合条件的消息。";
    LOG_LOST: "older messages were dropped:", "已丢弃的较早消息：";
    LOG_MORE: "Older messages are found by their words, and copied with the rest.", "较早的消息可按关键词查找，复制时一并包含。";
    LOG_FILTER: "Filter messages", "筛选消息", "words, or info, warning, alarm", "关键词，或：信息、警告、报警";
    COPY: "Copy", "复制", "Copies the messages that are listed, with seconds since the start of the program.", "复制列出的消息，附程序启动以来的秒数。";
    COPIED: "Copied", "已复制";


    RECORDINGS: "Fault recordings", "故障记录";
    SECTION_TIP: "Shows this list.", "显示此列表。";
    RECORDINGS_NONE: "No recordings yet. Around each fault, 45 s before and 15 s after are kept here: everything that was measured, and what was done.", "还没有记录。每次故障前 45 s 与后 15 s 的全部测量与操作会保存在这里。";
    RECORDINGS_KEPT: "Kept in memory until the program ends, 12 at most: the oldest goes first.", "记录保存在内存中，程序退出即清除，最多 12 份；先移除最早的记录。";
    RECORDINGS_LOST: "Older recordings that went:", "已移除的较早记录：";
    RECORDING_RUNS: "Recording a fault, ends in", "正在记录故障，剩余";
    RECORDING_OPEN: "Open", "打开", "Shows what was measured and done around this fault. Nothing is sent to the hand.", "查看该故障前后的测量与操作，不会向灵巧手发送任何内容。";
    RECORDING: "Recording", "记录";
    RECORDING_MORE: "more", "项其他故障";
    RECORDING_BACK: "Back", "返回", "Back to the faults and the lists.", "返回故障与列表。";
    RECORDING_SAVE: "Save CSV", "保存 CSV", "Saves everything of this recording as comma-separated values.", "把该记录的全部内容保存为 CSV。";
    RECORDING_NEAR: "5 s around", "前后 5 s", "Shows the five seconds before and after the fault.", "显示故障前后各 5 秒。";
    RECORDING_WHOLE: "Whole", "全部", "Shows the whole recording.", "显示整段记录。";
    RECORDING_PANEL_TIP: "Shows or hides this plot. Strong lines: the joints with the fault.", "显示或隐藏该曲线。粗线为发生故障的自由度。";
    RECORDING_EVENTS: "What happened", "事件";
    RECORDING_EVENTS_LOST: "Events that were not kept:", "未保留的事件：";
    RECORDING_FAULT: "fault", "故障";

    ACT_DISARM: "Disarmed", "取消使能";
    ACT_TARGET: "target", "目标";
    ACT_FORCE: "threshold, g", "力阈值 g";
    ACT_LOCK: "locked", "已锁定";
    ACT_UNLOCK: "unlocked", "已解锁";
    NO_FAULT_BITS: "no fault", "无故障";

    /// Severity of a message.
    fn level(Level) {
        Level::Info => "info", "信息";
        Level::Warn => "warning", "警告";
        Level::Alarm => "alarm", "报警";
    }
}

/// Title, cause and advice of a drive's fault.
pub(crate) const fn fault_kind(what: FaultKind, language: Language) -> Words {
    match what {
        FaultKind::Fault(fault) => words::fault(fault, language),
        FaultKind::Status(status) => words::status(status, language),
    }
}

/// Translated text of a fault's mark, `index: stall, over_current`.
pub(crate) fn fault_mark(look: Look, mark: &str) -> String {
    let Some((joint, names)) = mark.split_once(": ") else {
        return look.tr(panels::MARK_FAULT).to_owned();
    };
    let dof = Dof::ALL.into_iter().find(|dof| dof.name() == joint);
    let titles = names.split(", ").map(|name| match FaultKind::named(name) {
        Some(kind) => fault_kind(kind, look.language).title,
        None => name,
    });
    let titles: Vec<&str> = titles.collect();
    let joint = dof.map_or(joint, |dof| look.tr(words::dof(dof)));
    look.pair(joint, &titles.join(" + "))
}

fn request_text(look: Look, what: RequestKind) -> String {
    match what {
        RequestKind::Gesture(gesture) => look.tr_with(panels::GESTURE, gesture.get()),
        RequestKind::ClearErrors => look.tr(panels::CLEAR).into(),
    }
}

fn disarmed(look: Look, why: Disarmed) -> String {
    match (look.language, why) {
        (Language::Zh, why) => words::disarmed_zh(why).into(),
        (Language::En, Disarmed::Person) => "No longer armed.".into(),
        (Language::En, Disarmed::OtherController) => {
            format!("No longer armed: {why}. Arm again if you want both.")
        }
        (Language::En, why) => format!("No longer armed: {why}."),
    }
}

/// Effect of a latency timer, and the command line that fixes it.
fn latency_timer(look: Look, port: &str, ms: Option<u16>) -> String {
    let cause = match ms {
        Some(ms) => format!("{} {ms} ms.", look.tr(panels::TIMER_TOLD)),
        None => look.tr(panels::TIMER_SEEN).to_owned(),
    };
    let name = port.rsplit('/').next().unwrap_or(port);
    let cure = if cfg!(windows) {
        look.tr(panels::TIMER_CURE_WINDOWS).to_owned()
    } else {
        let file = format!("/sys/bus/usb-serial/devices/{name}/latency_timer");
        format!("{} echo 1 | sudo tee {file}", look.tr(panels::TIMER_CURE))
    };
    format!("{cause} {cure}")
}

fn place(path: Option<&Path>) -> String {
    path.map(|path| path.display().to_string())
        .unwrap_or_default()
}

/// A message, preceded by its hand's name if there are several.
pub(crate) fn notice_of(look: Look, notice: &Notice) -> String {
    let text = self::notice(look, &notice.what);
    match &notice.hand {
        Some(hand) if !hand.name.is_empty() => look.pair(&hand.name, &text),
        _ => text,
    }
}

/// A message as one or two sentences.
#[expect(clippy::too_many_lines, reason = "one arm for each message")]
pub(crate) fn notice(look: Look, what: &NoticeKind) -> String {
    let tr = |text| look.tr(text).to_owned();
    let tr_with = |text: Text, more: &str| look.tr_with(text, more);
    let of = |text: Text, path: &Path, why: &str| {
        look.pair(&tr_with(text, &path.display().to_string()), why)
    };
    match what {
        NoticeKind::LinkLost(why) => tr_with(panels::NOTICE_LOST, &errors::trouble(look, why)),
        NoticeKind::NoLink(why) => tr_with(panels::NOTICE_NO_LINK, &errors::trouble(look, why)),
        NoticeKind::LatencyTimer { port, ms } => latency_timer(look, port, *ms),
        NoticeKind::Reconnected => tr(panels::NOTICE_RECONNECTED),
        NoticeKind::HoldConfirmed { after } => tr_with(panels::NOTICE_HELD, &format::age(*after)),
        NoticeKind::HoldAlarm => tr(main::ALARM_TITLE.tip()),
        NoticeKind::StopNotSent => tr(panels::NOTICE_STOP_NOT_SENT),
        NoticeKind::TareUnderLoad { finger, newtons } => {
            let finger = look.tr(words::finger(*finger));
            match look.language {
                Language::En => format!(
                    "Not tared: {finger} is touched ({newtons:.1} N). Let go of everything, then tare."
                ),
                Language::Zh => {
                    format!("未清零：{finger}正在受力（{newtons:.1} N）。请先松开物体再清零。")
                }
            }
        }
        NoticeKind::Disarmed(why) => disarmed(look, *why),
        NoticeKind::DisarmedByOther(conflict) => {
            let what = words::setpoint(look, conflict);
            look.fill(panels::DISARMED_BY_OTHER, &[&what])
        }
        NoticeKind::IdleDisarmed => tr(inputs::IDLE_DISARMED),
        NoticeKind::StepsLost(count) => look.fill(panels::STEPS_LOST, &[count]),
        NoticeKind::LeaderStopped => tr(panels::LEADER_STOPPED),
        NoticeKind::SourceSilent(owner) => {
            look.fill(panels::SOURCE_SILENT, &[&words::owner(look, *owner)])
        }
        NoticeKind::ArmRefused(why) => tr_with(panels::NOTICE_ARM, &words::refusal(look, *why)),
        NoticeKind::Fault { dof, what } => {
            let title = fault_kind(*what, look.language).title;
            look.pair(look.tr(words::dof(*dof)), title)
        }
        NoticeKind::RequestFailed { what, error } => {
            look.pair(&request_text(look, *what), &errors::request(look, error))
        }
        NoticeKind::Acknowledged { what } => look.pair(
            &request_text(look, *what),
            look.tr(panels::NOTICE_ACKNOWLEDGED),
        ),
        NoticeKind::GestureWouldMoveLocked { dof } => {
            tr_with(panels::NOTICE_LOCKED, look.tr(words::dof(*dof)))
        }
        NoticeKind::PoseUnknown => tr(poses::CAPTURE_UNKNOWN),
        NoticeKind::BlockNotTaken(BlockError::Size { .. }) => tr(poses::BLOCK_SIZE),
        NoticeKind::BlockNotTaken(BlockError::Unlikely { .. }) => tr(poses::BLOCK_UNLIKELY),
        NoticeKind::SeriesRuns => tr(main::SERIES_RUNS),
        NoticeKind::SeriesNotBegun => tr(tune::NOT_BEGUN),
        NoticeKind::ExhibitWantsOneHand => tr(window::EXHIBIT_ONE_HAND),
        NoticeKind::OpenElsewhere { endpoint, hand } => {
            look.fill(window::OPEN_ELSEWHERE, &[endpoint, hand])
        }
        NoticeKind::ExhibitNotBegun => tr(main::EXHIBIT_NOT_BEGUN),
        NoticeKind::NotHolding { grip } => {
            look.fill(poses::END_NOT_HOLDING, &[&look.tr(panels::grip(*grip))])
        }
        NoticeKind::CannotHold => tr(hold::CANNOT_HOLD_NOTICE),
        NoticeKind::HoldEnded(end) => hold::end(look, *end),
        NoticeKind::GraspDoubted(why) => hold::doubted(look, *why),
        NoticeKind::SeriesEnded { trials, aborted } => match aborted {
            None => look.fill(tune::ENDED, &[trials]),
            Some(why) => look.fill(tune::ENDED_EARLY, &[trials, &tune::abort(look, *why)]),
        },
        NoticeKind::CheckupEnded {
            act,
            watch,
            aborted,
        } => match aborted {
            None => look.fill(checkup::ENDED, &[act, watch]),
            Some(why) => look.fill(checkup::ENDED_EARLY, &[&tune::abort(look, *why)]),
        },
        NoticeKind::GesturesOff => tr(panels::GESTURES_OFF),
        // The graphics driver's text helps with the repair.
        NoticeKind::Unguarded { why } => tr_with(panels::NOTICE_UNGUARDED, why),
        NoticeKind::DrawnWithoutOpenGl { reason } => match look.language {
            Language::En => tr_with(panels::NOTICE_WITHOUT_OPENGL, &format!("({reason})")),
            Language::Zh => tr(panels::NOTICE_WITHOUT_OPENGL),
        },
        NoticeKind::NoFileChosen => tr(window::NO_FILE),
        NoticeKind::HandDiffers {
            differences,
            last_seen,
        } => differing(look, differences, last_seen),
        NoticeKind::EndpointIgnored { text } => tr_with(panels::NOTICE_ENDPOINT, text),
        NoticeKind::PosesImported {
            poses: count,
            sequences,
        } => format!(
            "{} {count} {}, {sequences} {}",
            look.tr(poses::IMPORTED),
            look.tr(poses::COUNT_POSES),
            look.tr(poses::COUNT_SEQUENCES)
        ),
        NoticeKind::RecordingOpened { path, trials } => {
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
            look.fill(window::SAVED, &[&path, entries])
        }
        NoticeKind::NotSaved { path, error } => {
            of(window::NOT_SAVED, path, &errors::system_error(look, error))
        }
        NoticeKind::NotDeleted { path, error } => of(
            recordings::NOT_DELETED,
            path,
            &errors::system_error(look, error),
        ),
        NoticeKind::NotExported { path, error } => {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let why = errors::export(look, error);
            look.fill(recordings::NOT_EXPORTED, &[&name, &why])
        }
        NoticeKind::NotRevealed { path, error } => {
            let why = errors::system_error(look, error);
            look.fill(recordings::NOT_REVEALED, &[&why, &path.display()])
        }
        NoticeKind::RecordingRefused { path, why } => look.fill(
            recordings::REFUSED,
            &[&path.display(), &not_opened(look, why)],
        ),
        NoticeKind::Recording(notice) => recording(look, notice),
        NoticeKind::RecordingStalled { why } => look.fill(recordings::STALLED, &[why]),
        NoticeKind::NotReplayedNow => look.tr(recordings::NOT_NOW).to_owned(),
        NoticeKind::Recorded => look.tr(recordings::IS_RECORDING).to_owned(),
        NoticeKind::RecordingsPlanned {
            recordings: count,
            bytes,
            days: (first, last),
            due,
        } => {
            let size = format::size(*bytes);
            look.fill(recordings::PLANNED, &[count, &size, first, last, due])
        }
        NoticeKind::RecordingsDeleted { recordings: count } => {
            look.tr_with(recordings::DELETED, count)
        }
        NoticeKind::PlanIgnored { error } => {
            tr_with(tune::PLAN_IGNORED, &errors::plan(look, error))
        }
    }
}

/// Change to the file of a recording in progress.
fn recording(look: Look, notice: &RecorderNotice) -> String {
    match notice {
        RecorderNotice::Moved { from, to: Some(to) } => {
            look.fill(recordings::FILE_MOVED, &[&from.display(), &to.display()])
        }
        RecorderNotice::Moved { from, to: None } => {
            look.fill(recordings::FILE_RENAMED, &[&from.display()])
        }
        RecorderNotice::Removed { path, entries } => {
            look.fill(recordings::FILE_REMOVED, &[&path.display(), entries])
        }
        RecorderNotice::ClockSet { next } => look.fill(recordings::CLOCK_SET, &[next]),
    }
}

/// Reason why a recording was not opened.
fn not_opened(look: Look, why: &OpenError) -> String {
    let words = match why {
        OpenError::Unreadable { error } => return errors::system_error(look, error),
        OpenError::NotAFile => recordings::NOT_A_FILE,
        OpenError::NotMcap => recordings::NOT_MCAP,
        OpenError::Foreign => recordings::FOREIGN,
        OpenError::SeveralHands { hands } => return look.tr_with(recordings::SEVERAL_HANDS, hands),
        OpenError::TooMuch { .. } => recordings::TOO_MUCH,
        OpenError::Empty => recordings::EMPTY,
    };
    look.tr(words).to_owned()
}

fn differing(look: Look, differences: &[FactDifference], last_seen: &str) -> String {
    let facts = differences.iter().map(|difference| {
        let FactDifference { fact, before, now } = difference;
        format!("{}: {before} -> {now}", look.tr(scan::fact(*fact)))
    });
    let facts: Vec<String> = facts.collect();
    let intro = look.tr(scan::OTHER_HAND);
    format!("{intro} ({last_seen}) {}", facts.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::State;

    #[test]
    fn the_mark_of_a_fault_says_joint_and_fault_in_both_languages() {
        let mut state = State::default();
        let mut mark_text = |language, mark: &str| {
            state.settings.language = language;
            fault_mark(Look::of(&state), mark)
        };
        let mark = "index: stall, over_current";
        assert_eq!(mark_text(Language::En, mark), "Index: Stall + Over-current");
        assert_eq!(mark_text(Language::Zh, mark), "食指：堵转故障 + 过流故障");
        assert_eq!(
            mark_text(Language::En, "thumb_bend: stalled"),
            "Thumb bend: Stalled"
        );
        assert_eq!(mark_text(Language::En, "index: other"), "Index: other");
        assert_eq!(mark_text(Language::En, ""), "Fault");
    }
}
