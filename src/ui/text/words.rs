//! Names of joints, fingers, states, faults and reasons in the window's language. Decides nothing.

use crate::app::settings::Language;
use crate::hand::{Dof, Fault, Finger, Status, Words};
use crate::link::Owner;
use crate::record::{ArmRefusal, Disarmed, SetpointConflict};
use crate::ui::style::Look;
use crate::ui::style::phrase::Text;
use crate::ui::text::{inputs, main};

/// The name of a joint.
pub(crate) const fn dof(dof: Dof) -> Text {
    match dof {
        Dof::Little => main::LITTLE,
        Dof::Ring => main::RING,
        Dof::Middle => main::MIDDLE,
        Dof::Index => main::INDEX,
        Dof::ThumbBend => main::THUMB_BEND,
        Dof::ThumbRotate => main::THUMB_ROTATE,
    }
}

/// The name of a finger.
pub(crate) const fn finger(finger: Finger) -> Text {
    match finger {
        Finger::Thumb => main::THUMB,
        finger => dof(finger.bend()),
    }
}

/// Reason why the hand is no longer armed, as a Chinese sentence.
pub(crate) const fn disarmed_zh(why: Disarmed) -> &'static str {
    match why {
        Disarmed::Stop => "已取消使能：按下了停止。",
        Disarmed::Person => "已取消使能。",
        Disarmed::Fault => "已取消使能：驱动器报告故障。",
        Disarmed::LinkLost => "已取消使能：连接断开。",
        Disarmed::Stale => "已取消使能：反馈过时。",
        Disarmed::OtherController => {
            "已取消使能：另有控制器正在与此灵巧手通讯。再次使能以确认继续。"
        }
        Disarmed::FrozenFeedback => "已取消使能：已发出运动指令，但灵巧手的反馈毫无变化。",
        Disarmed::Resume => "已取消使能：本机曾休眠。",
        Disarmed::Released => "未使能：没有按住需要按住的键。",
        Disarmed::Silent => "已取消使能：控制来源已无数据。",
        Disarmed::Hot => "已取消使能：有驱动器达到 70 °C。",
        Disarmed::HeatUnknown => "已取消使能：驱动器温度不合理或未知。",
    }
}

/// Reason why arming is refused, as a sentence.
pub(crate) fn refusal(look: Look, reason: ArmRefusal) -> String {
    match reason {
        ArmRefusal::Offline => look.tr(main::REFUSED_OFFLINE).into(),
        ArmRefusal::Holding => look.tr(main::REFUSED_HOLDING).into(),
        ArmRefusal::Fault => look.tr(main::REFUSED_FAULT).into(),
        ArmRefusal::HandBusy => look.tr(main::REFUSED_BUSY).into(),
        ArmRefusal::LetGo => look.tr(main::REFUSED_LET_GO).into(),
        ArmRefusal::Refused | ArmRefusal::Taken => look.tr(main::REFUSED_AFAR).into(),
        ArmRefusal::NoAnswer => look.tr(main::REFUSED_NO_ANSWER).into(),
        ArmRefusal::Replaced => look.tr(main::REFUSED_REPLACED).into(),
        ArmRefusal::NotRead => look.tr(main::REFUSED_NOT_READ).into(),
        ArmRefusal::UnknownPose { dof: joint } => {
            look.tr_with(main::REFUSED_POSE, look.tr(dof(joint)))
        }
    }
}

/// Conflict between the hand's setpoint and the one written here.
pub(crate) fn setpoint(look: Look, conflict: &SetpointConflict) -> String {
    let (register, joint) = (conflict.register.name(), look.tr(dof(conflict.dof)));
    let outside = || look.tr(main::SETPOINT_OUTSIDE).to_owned();
    let holds = conflict
        .holds
        .map_or_else(outside, |holds| holds.to_string());
    match conflict.wrote {
        Some(wrote) => look.fill(main::SETPOINT_WROTE, &[&register, &joint, &holds, &wrote]),
        None => look.fill(main::SETPOINT, &[&register, &joint, &holds]),
    }
}

/// Title, cause and advice of a status code.
pub(crate) const fn status(status: Status, language: Language) -> Words {
    match language {
        Language::En => status.words(),
        Language::Zh => status_zh(status),
    }
}

/// Title, cause and advice of a fault.
pub(crate) const fn fault(fault: Fault, language: Language) -> Words {
    match language {
        Language::En => fault.words(),
        Language::Zh => fault_zh(fault),
    }
}

/// Short title of a fault.
pub(crate) const fn fault_short(fault: Fault, language: Language) -> &'static str {
    match (language, fault) {
        (Language::En, Fault::OverTemperature) => "Too hot",
        (Language::En, Fault::Communication) => "No contact",
        (Language::En, Fault::Unknown(_)) => "Unknown",
        (Language::Zh, Fault::Unknown(_)) => "未知故障",
        _ => self::fault(fault, language).title,
    }
}

/// Writes a table of titles, causes and advice as a function that returns them in Chinese.
macro_rules! chinese {
    ($(fn $name:ident($of:ty) { $($case:pat => $title:literal, $cause:literal, $advice:literal;)* })*) => {$(
        const fn $name(of: $of) -> Words {
            match of {
                $($case => Words::new($title, $cause, $advice),)*
            }
        }
    )*};
}

chinese! {
    fn status_zh(Status) {
        Status::Releasing => "正在松开", "该自由度正向张开方向运动。", "无需处理。";
        Status::Grasping => "正在抓取", "该自由度正向弯曲方向运动。", "无需处理。";
        Status::PositionReached => "位置到位", "该自由度已到达目标角度。", "无需处理。";
        Status::ForceReached => "力控到位", "受力到达阈值，驱动器已停止。", "无需处理。若抓握太弱，可提高阈值。";
        Status::CurrentProtection => "电流保护", "驱动器电流过大，已停止。", "移除负载或张开该自由度，再以较慢速度重新控制。";
        Status::Stalled => "堵转停止", "驱动器用力但没有移动。", "张开该自由度或移除阻挡物，然后清除错误。";
        Status::DriveFault => "故障停止", "驱动器因故障停止。", "请查看故障列表中的原因。";
        Status::Unknown(255) => "未报告", "代码 255，手册没有说明。常见于上电后尚未控制过的自由度。", "让该自由度运动一次。若仍然如此，请记录代码并联系厂家。";
        Status::Unknown(_) => "未知代码", "手册没有列出此代码。", "请当作该自由度未就绪，并记录代码联系厂家。";
    }

    fn fault_zh(Fault) {
        Fault::Stall => "堵转故障", "驱动器用力但无法移动。", "松开手指或移除阻挡物，然后清除错误。";
        Fault::OverTemperature => "过温故障", "驱动器温度过高。", "请等待冷却：此故障不可清除，温度回落后自动清除。";
        Fault::OverCurrent => "过流故障", "驱动器电流过大。", "减小负载、速度或力阈值，然后清除错误。";
        Fault::Motor => "电机异常", "驱动器报告电机异常。", "清除错误。若再次出现，请断电重启，仍无效则联系厂家。";
        Fault::Communication => "通讯故障", "主控板与驱动器失去通讯。", "清除错误。若再次出现，请检查电源与线缆，仍无效则联系厂家。";
        Fault::Unknown(5) => "未知故障，第 5 位", "手册没有列出此故障位。", "请停止使用，并记录代码联系厂家。";
        Fault::Unknown(6) => "未知故障，第 6 位", "手册没有列出此故障位。", "请停止使用，并记录代码联系厂家。";
        Fault::Unknown(_) => "未知故障，第 7 位", "手册没有列出此故障位。", "请停止使用，并记录代码联系厂家。";
    }
}

/// Name of the owner that may move the hand.
pub(crate) fn owner(look: Look, owner: Owner) -> String {
    const PERSON: Text = Text::new("This window", "本窗口");
    const TASK: Text = Text::new("A task of this window", "本窗口的任务");
    const EXHIBITION: Text = Text::new("Exhibition", "展示");
    const STREAM: Text = Text::new("Program", "程序");
    const GATEWAY: Text = Text::new("Gateway client", "网关程序");
    const MIRROR: Text = Text::new("Another hand", "另一只手");
    match owner {
        Owner::Person => look.tr(PERSON).into(),
        Owner::Task => look.tr(TASK).into(),
        Owner::Exhibition => look.tr(EXHIBITION).into(),
        Owner::Gamepad => look.tr(inputs::PAD).into(),
        Owner::Stream(sender) => look.tr_with(STREAM, sender),
        Owner::Dds => "DDS".into(),
        Owner::Mirror => look.tr(MIRROR).into(),
        Owner::Gateway(client) => look.tr_with(GATEWAY, client),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chinese_words_stand_for_every_code_and_are_in_the_font() {
        let known = include_str!("../../../assets/fonts/characters.txt");
        let statuses = (0..=255).map(|raw| status(Status::from_raw(raw), Language::Zh));
        let faults = (0..8).map(|bit| fault(Fault::from_bit(bit), Language::Zh));
        for words in statuses.chain(faults) {
            for text in [words.title, words.cause, words.advice] {
                assert!(!text.is_empty());
                let missing = text
                    .chars()
                    .find(|sign| !sign.is_ascii() && !known.contains(*sign));
                assert_eq!(missing, None, "{text}");
            }
        }
    }
}
