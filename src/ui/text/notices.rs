//! Messages, troubles of the link and failed requests as sentences in the window's language. Decides nothing.

use crate::app::notices::{Asked, NoticeKind};
use crate::app::readings::faults::FaultKind;
use crate::app::settings::Language;
use crate::hand::Words;
use crate::link::{LinkTrouble, RequestError};
use crate::record::Disarmed;
use crate::record::quirk_sheet::Difference;
use crate::ui::kit::format;
use crate::ui::kit::look::Look;
use crate::ui::text::phrase::Text;
use crate::ui::text::{device, main, panels, poses, quirks, traffic, trials, tune, words};

/// Title, cause and advice of what is wrong with a drive.
pub(crate) const fn fault_kind(what: FaultKind, language: Language) -> Words {
    match what {
        FaultKind::Fault(fault) => words::fault(fault, language),
        FaultKind::Status(status) => words::status(status, language),
    }
}

/// Why there is no live hand.
pub(crate) fn trouble(look: Look, trouble: &LinkTrouble) -> String {
    if look.language == Language::En {
        return format::sentence(&trouble.to_string());
    }
    match trouble {
        LinkTrouble::Transport(error) => format!("线路问题：{error}。"),
        LinkTrouble::Garbled { place, id } => {
            format!("{place} 上有应答，但不符合 ID {id}、此速度或此协议：请用扫描查找。")
        }
        LinkTrouble::Mute { place, unit } => {
            format!(
                "{place} 接受了连接，但单元 {unit} 没有应答：请检查地址、端口与单元，并确认没有其他程序占用。"
            )
        }
        LinkTrouble::NoAnswer { id } => {
            format!("ID {id} 没有应答：请检查灵巧手的电源、ID、波特率与协议。")
        }
        LinkTrouble::Silent { silent } => {
            format!("灵巧手停止应答：连续 {silent} 次请求没有应答。")
        }
        LinkTrouble::Ambiguous => "线路上有迟到的应答：已重新打开，以免把旧数据当作新数据。".into(),
        LinkTrouble::Suspended { slept_s } => {
            format!("本机休眠了 {slept_s} 秒：之前显示的数据已过时。")
        }
    }
}

/// How a request failed.
pub(crate) fn request_error(look: Look, error: &RequestError) -> String {
    if look.language == Language::En {
        return format::sentence(&error.to_string());
    }
    match error {
        RequestError::NotConnected => "没有连接：未发送任何内容。".into(),
        RequestError::NotArmed => "未使能：未发送任何内容。".into(),
        RequestError::Full { limit } => format!("已有 {limit} 个请求在等待：未发送。"),
        RequestError::TooLong { address, len } => {
            format!("此线路无法一次读写地址 {address} 起的 {len} 字节。")
        }
        RequestError::Timeout { address, after_ms } => {
            format!("地址 {address} 在 {after_ms} ms 内没有应答：不确定灵巧手是否已执行。")
        }
        RequestError::Refused { address, reason } => {
            format!("灵巧手拒绝了地址 {address}：{reason}。")
        }
        RequestError::WrongLength { address, got, want } => {
            format!("地址 {address} 应答了 {got} 字节，应为 {want} 字节。")
        }
        RequestError::Ambiguous { address, wait_s } => {
            format!("地址 {address} 可能还有迟到的应答：请在 {wait_s} 秒后重试。")
        }
        RequestError::LinkLost => "连接断开：不确定灵巧手是否已执行。".into(),
        RequestError::OutOfRange(error) => format!("超出手册范围：{error}。"),
    }
}

fn asked(look: Look, what: Asked) -> String {
    match what {
        Asked::Gesture(gesture) => format!("{} {}", look.say(panels::GESTURE), gesture.get()),
        Asked::StoreGesture(gesture) => {
            format!("{} {}", look.say(poses::STORE_ASKED), gesture.get())
        }
        Asked::ReadGesture(gesture) => {
            format!("{} {}", look.say(poses::READ_ASKED), gesture.get())
        }
        Asked::ClearErrors => look.say(panels::CLEAR).into(),
    }
}

fn disarmed(look: Look, why: Disarmed) -> &'static str {
    look.say(match why {
        Disarmed::Stop => panels::DISARMED_STOP,
        Disarmed::Person => panels::DISARMED_PERSON,
        Disarmed::Fault => panels::DISARMED_FAULT,
        Disarmed::LinkLost => panels::DISARMED_LOST,
        Disarmed::Stale => panels::DISARMED_STALE,
        Disarmed::OtherController => panels::DISARMED_RIVAL,
        Disarmed::Resume => panels::DISARMED_RESUME,
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

fn place(path: Option<&std::path::Path>) -> String {
    path.map(|path| path.display().to_string())
        .unwrap_or_default()
}

/// A message as one or two sentences.
pub(crate) fn notice(look: Look, what: &NoticeKind) -> String {
    let said = |text| look.say(text).to_owned();
    match what {
        NoticeKind::LinkLost(why) => {
            format!("{} {}", said(panels::NOTICE_LOST), trouble(look, why))
        }
        NoticeKind::NoLink(why) => {
            format!("{} {}", said(panels::NOTICE_NO_LINK), trouble(look, why))
        }
        NoticeKind::LatencyTimer { port, ms } => latency_timer(look, port, *ms),
        NoticeKind::Reconnected => said(panels::NOTICE_RECONNECTED),
        NoticeKind::HoldConfirmed { after } => {
            format!("{} {}", said(panels::NOTICE_HELD), format::age(*after))
        }
        NoticeKind::HoldAlarm => said(main::ALARM_BODY),
        NoticeKind::StopNotSent => said(panels::NOTICE_STOP_NOT_SENT),
        NoticeKind::Disarmed(why) => disarmed(look, *why).into(),
        NoticeKind::ArmRefused(why) => {
            format!(
                "{} {}",
                said(panels::NOTICE_ARM),
                words::refusal(look, *why)
            )
        }
        NoticeKind::Fault { dof, what } => {
            let title = fault_kind(*what, look.language).title;
            format!("{}: {title}", look.say(words::dof(*dof)))
        }
        NoticeKind::RequestFailed { what, error } => {
            format!("{}: {}", asked(look, *what), request_error(look, error))
        }
        NoticeKind::Acknowledged { what } => {
            format!(
                "{}: {}",
                asked(look, *what),
                said(panels::NOTICE_ACKNOWLEDGED)
            )
        }
        NoticeKind::GestureWouldMoveLocked { dof } => {
            format!(
                "{} {}",
                said(panels::NOTICE_LOCKED),
                look.say(words::dof(*dof))
            )
        }
        NoticeKind::PoseUnknown => said(poses::CAPTURE_UNKNOWN),
        NoticeKind::PosesImported { .. }
        | NoticeKind::PosesRefused { .. }
        | NoticeKind::ParamsRefused { .. }
        | NoticeKind::PosesIgnored { .. }
        | NoticeKind::PosesNotSaved { .. } => of_files(look, what),
        NoticeKind::SeriesEnded { .. }
        | NoticeKind::SeriesRuns
        | NoticeKind::SessionOpened { .. }
        | NoticeKind::SessionRefused { .. } => trials::notice(look, what),
        NoticeKind::GesturesOff => said(panels::GESTURES_OFF),
        NoticeKind::GestureStoreOff => said(poses::STORE_OFF_TIP),
        NoticeKind::DrawnWithoutOpenGl { reason } => {
            format!("{} ({reason})", said(panels::NOTICE_WITHOUT_OPENGL))
        }
        NoticeKind::SettingsNotSaved { message } => {
            format!("{} {message}", said(panels::NOTICE_NOT_SAVED))
        }
        NoticeKind::SettingsIgnored { message, kept_as } => {
            let kept = place(kept_as.as_deref());
            format!("{} {message} {kept}", said(panels::NOTICE_SETTINGS))
        }
        NoticeKind::Saved { path, entries } => {
            format!("{} {} ({entries})", said(traffic::SAVED), path.display())
        }
        NoticeKind::NotSaved { path, message } => {
            format!("{} {}: {message}", said(traffic::NOT_SAVED), path.display())
        }
        NoticeKind::NoFileChosen => said(traffic::NO_FILE),
        NoticeKind::HandDiffers {
            differences,
            last_seen,
        } => differing(look, differences, last_seen),
        NoticeKind::SheetNotKept { message } => {
            format!("{} {message}", said(quirks::NOT_KEPT))
        }
        NoticeKind::PlanIgnored { message } => {
            format!("{} {message}", said(tune::PLAN_IGNORED))
        }
        NoticeKind::EndpointIgnored { text } => {
            format!("{} {text}", said(panels::NOTICE_ENDPOINT))
        }
    }
}

/// What became of files of poses and parameters; empty for everything else.
fn of_files(look: Look, what: &NoticeKind) -> String {
    let said = |text: Text| look.say(text).to_owned();
    match what {
        NoticeKind::PosesImported {
            poses: count,
            sequences,
        } => format!(
            "{} {count} {}, {sequences} {}",
            said(poses::IMPORTED),
            said(poses::COUNT_POSES),
            said(poses::COUNT_SEQUENCES)
        ),
        NoticeKind::PosesRefused { path, error } => {
            format!("{} {}: {error}", said(poses::REFUSED), path.display())
        }
        NoticeKind::ParamsRefused { path, error } => {
            format!("{} {}: {error}", said(device::REFUSED), path.display())
        }
        NoticeKind::PosesIgnored { error, kept_as } => {
            let kept = place(kept_as.as_deref());
            format!("{} {error} {kept}", said(poses::IGNORED))
        }
        NoticeKind::PosesNotSaved { message } => {
            format!("{} {message}", said(poses::NOT_SAVED))
        }
        _ => String::new(),
    }
}

fn differing(look: Look, differences: &[Difference], last_seen: &str) -> String {
    let facts = differences.iter().map(|difference| {
        let Difference { fact, before, now } = difference;
        format!("{}: {before} -> {now}", look.say(quirks::fact(*fact)))
    });
    let facts: Vec<String> = facts.collect();
    let intro = look.say(quirks::OTHER_HAND);
    format!("{intro} ({last_seen}) {}", facts.join("; "))
}
