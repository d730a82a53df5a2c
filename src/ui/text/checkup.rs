//! Sentences of the check-up: preconditions, progress, and results.

use crate::checkup::check::Check;
use crate::checkup::report::{CheckupReport, Keeping};
use crate::checkup::subject::{Grade, HandPart, Subject};
use crate::motion::program::Ended;
use crate::motion::scale::ScaleEnd;
use crate::store::calendar::day;
use crate::ui::style::Look;
use crate::ui::style::phrase::{Text, texts};
use crate::ui::text::{tune, words};
use std::fmt::Display;
use std::time::Duration;

texts! {
    TITLE: "Check-up", "体检";
    ABOUT: "Moves each joint. About {}.", "各自由度依次动作，约需 {}。", "Each joint bends and opens alone at two speeds, then all together; the readings are compared with good hands, and with this hand's first check-up.", "各自由度先以两种速度单独弯曲与张开，再一起动作；传感器读数将与正常的手以及这只手的首次体检比较。";
    EMPTY: "The hand is empty, and nothing is in its way", "手中没有物体，周围没有障碍", "Confirm before each check-up. A joint that meets something ends it.", "每次体检前都须确认。任何自由度碰到物体都会立即结束。";
    PRESS: "Then press each fingertip", "最后逐个按压指尖", "Once the hand is at rest and not armed, it asks for a press of each fingertip, and judges which channels respond.", "全部动作结束并取消使能后，请逐个按压指尖，以判断各通道是否有反应。";
    SAY_EMPTY: "Confirm that the hand is empty.", "请先确认手中没有物体。";
    START: "Start check-up", "开始体检", "Checks the hand in its current arming. Any key, STOP, a fault, heat, an object or a lost link end it.", "在当前使能下进行体检。按任意键、停止、故障、过热、碰到物体或断线都会结束。";
    ARM_AND_START: "Arm and check up", "使能并体检", "Held for 1 s, arms the hand and checks it up. Any key, STOP, a fault, heat, an object or a lost link end it.", "按住 1 秒即使能并进行体检。按任意键、停止、故障、过热、碰到物体或断线都会结束。";
    END: "End the check-up", "结束体检", "Holds the hand and ends the check-up; its report is partial then.", "保持灵巧手当前位置并结束体检，报告将不完整。";
    STEP: "Step {} of {}: {}", "第 {} 步，共 {} 步：{}";
    ALL_JOINTS: "all joints", "全部自由度";
    PRESS_NOW: "Press and release the fingertip of {}. Nothing moves now.", "请按压{}的指尖后松开。灵巧手不会再动。";
    PROGRESS: "Check-up progress", "体检进度";
    NEVER: "No check-up of this hand yet", "这只手还没有体检记录", "The first one is the reference for later ones: confirm at the left that the hand is empty, and begin.", "首次体检将作为以后比较的依据：请在左侧确认手中没有物体，然后开始。";
    READING: "Reading earlier check-ups.", "正在读取以前的体检记录。";
    UNREAD: "The earlier check-ups cannot be read: {}", "无法读取以前的体检记录：{}";
    OF: "Check-up of {}", "{} 的体检";
    EARLIER: "Check-ups kept before: {}", "此前保留的体检：{} 次";
    PARTIAL: "Partial, it ended early: {}", "不完整，提前结束：{}";
    LIGHTS: "{} fine, {} to watch, {} to act on, {} not measured", "正常 {}，关注 {}，处理 {}，未测量 {}";
    REPORT: "Show report", "显示报告", "Shows the page of the report in the system's file manager; any browser opens it.", "在系统文件管理器中显示报告页面。";
    NO_REPORT: "The report of this check-up is in no file: save it.", "此次体检的报告没有写入文件：请保存。";
    SAVE: "Save page", "保存页面", "Saves the report as one page that any browser opens.", "把报告保存为单个网页文件。";
    ONLY: "Only what is not fine", "只看异常", "Shows only figures that are to be watched or acted on, that drift, or that were not measured.", "只显示需要关注或处理、有漂移或未测量的项目。";
    ALL_FINE: "Everything is as it should be.", "全部正常。";
    LEFT_ALONE: "{} was skipped: its sensor reads {} g at rest, so it could not be stopped gently. Calibrate the force sensors, and check again.", "{}没有动作：空载时传感器读数为 {} g，无法轻柔停下。请校准力传感器后重新体检。";
    NOT_AS_FIRST: "It is not kept as this hand's first: {} did not go through its stroke. Take out what is in its way, and check again.", "未作为首次体检保留：{}没有走完行程。请清除障碍后重新体检。";
    NOT_KEPT: "It is not kept: {}", "没有保留：{}";
    BUILT_IN: "Check-ups of the built-in hand are not kept.", "内置仿真手的体检不保留。";
    PARTIAL_NOT_KEPT: "What is partial is not kept for the next ones.", "不完整的体检不会保留。";
    USED: "Recorded since {}: {} h, {} h of them moving. {} closed most often ({}). Stalls: {}.", "自 {} 起的录制：{} 小时，其中运动 {} 小时。闭合最多的是{}：{} 次。堵转：{} 次。";
    NOT_RECORDED: "Hours in use, closes and stalls are not known: there are no recordings of this hand.", "使用时间、闭合与堵转次数未知：没有这只手的录制。";
    DRIFTS: "Drifts from {} to {} over {} check-ups since {}.", "由 {} 漂移到 {}（{} 次体检，自 {} 起）。";
    CHANNELS: "channels {}", "通道 {}";
    ENDED: "Check-up done: {} to act on, {} to watch.", "体检完成：需处理 {} 项，需关注 {} 项。";
    ENDED_EARLY: "The check-up ended early, its report is partial. {}", "体检提前结束，报告不完整。{}";

    NEWTONS: "Force in newtons", "以牛顿表示的力";
    NEWTONS_ABOUT: "Put a kitchen scale under a finger: it presses gently at five loads, and lets go after each.", "把厨房秤放在手指下方：手指以五种力轻压，每次压后松开。";
    SCALE_NONE: "not measured", "未测量";
    SCALE_PART: "{} of {} loads", "已测 {} / {}";
    SCALE_KNOWN: "100 g = {} N ±{} %, {}", "100 g = {} N ±{} %，{}";
    SCALE_LIMIT: "At most, g", "最大力 g", "The largest of the five loads.", "五种力中最大的一种。";
    SCALE_START: "Start pressing", "开始压秤", "The chosen finger presses the scale in the current arming. Loads measured before at the same limit are not pressed again.", "在当前使能下，所选手指压秤。此前以同一最大力测过的不再重复。";
    SCALE_FORGET: "Forget", "删除", "Removes what was measured of this finger. Its forces are in grams of this hand again.", "删除这根手指的测量结果，力重新以此手的克表示。";
    SCALE_ASK: "Load {} of {}: {} presses with {} g of this hand. Type what the scale shows.", "第 {} 次，共 {} 次：{}以此手的 {} g 施压。请输入秤的读数。";
    SCALE_PRESSING: "{} presses the scale", "{}正在压秤";
    SCALE_WAITS: "The finger is moving: wait for the next load.", "手指正在动作，请等待下一次施压。";
    SCALE_DOUBT: "That reading does not fit the others: the load is pressed again.", "该读数与其他读数不符，将重新施压。";
    SCALE_SHOWS: "The scale shows, g", "秤的读数 g", "Applied with Enter.", "按回车键确认。";
    SCALE_AGAIN: "Press again", "重压", "Presses the same load again.", "以同样的力再压一次。";
    SCALE_SKIP: "Skip", "跳过", "Leaves this load out.", "不测此力。";
    SCALE_FINISH: "End", "结束", "Lets go of the scale and ends. Accepted loads remain.", "松开秤并结束，已接受的读数保留。";
    SCALE_DONE: "measured", "已测完";
    SCALE_INCOMPLETE: "ended before all five loads were measured", "五种力尚未测完";
    SCALE_CONTRADICTED: "the readings contradict each other, and none was kept", "读数互相矛盾，均未保留";
    SCALE_NO_CONTACT: "the finger met no scale", "手指没有碰到秤";
    SCALE_ZERO: "the force reads too much without a load: calibrate the force sensors first", "空载时力读数过大：请先校准力传感器";
    SCALE_NOT_OPENED: "something is in the way, so the finger did not open", "有障碍，手指没有张开";
    SCALE_UNSTEADY: "the force did not become steady", "力没有稳定下来";
    SCALE_LATE: "the finger did not get there in time", "手指未能按时到位";
    SCALE_NO_ANSWER: "no reading was typed for two minutes", "两分钟内没有输入读数";

    COLUMN_OF: "Part", "部位";
    COLUMN_WHAT: "What", "项目";
    COLUMN_MEASURED: "Measured", "测量";
    COLUMN_GOOD: "Good", "正常";
    COLUMN_FIRST: "First", "首次";
    COLUMN_LAST: "Last", "上次";
    COLUMN_TREND: "Trend", "趋势";
    COLUMN_ADVICE: "What to do", "处理";
    HAND: "Hand", "整手";

    /// Name of a grade.
    fn grade(Grade) {
        Grade::Fine => "fine", "正常";
        Grade::Unknown => "unknown", "未知";
        Grade::Watch => "watch", "关注";
        Grade::Act => "act", "处理";
    }
}

/// Name of a measured quantity.
pub(crate) const fn subject(what: Subject) -> Text {
    let zh = match what {
        Subject::OpenEnd => "张开端角度",
        Subject::BentEnd => "弯曲端角度",
        Subject::Backlash => "回程间隙",
        Subject::ClosingCurrent => "弯曲所需电流",
        Subject::OpeningCurrent => "张开所需电流",
        Subject::CurrentPerSpeed => "每单位速度增加的电流",
        Subject::ClosingSpeed => "每单位 SPEED_SET 的弯曲速度",
        Subject::OpeningSpeed => "每单位 SPEED_SET 的张开速度",
        Subject::DeadTime => "从命令到运动的时间",
        Subject::DeadTimeScatter => "该时间的离散",
        Subject::OthersMoved => "其他自由度同时移动的距离",
        Subject::ForceZero => "静止时的力",
        Subject::ForceNoise => "力的噪声",
        Subject::ForceDrift => "静止时力的漂移",
        Subject::WarmerThanOthers => "比其他驱动器高的温度",
        Subject::WarmedBy => "体检期间的升温",
        Subject::DeadChannels => "从不变化的通道",
        Subject::NoisyChannels => "静止时离散大的通道",
        Subject::ChannelDrift => "通道的漂移",
        Subject::SilentChannels => "按压时没有反应的通道",
        Subject::SlowerTogether => "六个一起动作时变慢",
    };
    Text::new(what.row().name, zh)
}

/// Advice about a measured quantity.
pub(crate) const fn advice(what: Subject) -> Text {
    let zh = match what {
        Subject::OpenEnd
        | Subject::BentEnd
        | Subject::ClosingCurrent
        | Subject::OpeningCurrent
        | Subject::CurrentPerSpeed
        | Subject::WarmedBy => "检查自由度处是否有异物并清洁，然后重新体检；仍然如此则检修驱动器",
        Subject::Backlash | Subject::OthersMoved => {
            "检查手指连杆：销轴磨损或螺钉松动会造成这种情况"
        }
        Subject::ClosingSpeed | Subject::OpeningSpeed | Subject::SlowerTogether => {
            "检查 24 V 电源及其电缆与插头：灵巧手最大电流为 2 A"
        }
        Subject::DeadTime | Subject::DeadTimeScatter => "检修驱动器",
        Subject::ForceZero => "空手校准力传感器",
        Subject::ForceNoise => "检查接地与屏蔽，以及附近是否有电机",
        Subject::ForceDrift => "等待灵巧手升温，校准力传感器，然后重新体检",
        Subject::WarmerThanOthers => "等待冷却后重新体检；仍然如此则检修驱动器",
        Subject::DeadChannels
        | Subject::NoisyChannels
        | Subject::ChannelDrift
        | Subject::SilentChannels => "清洁指尖并检查其电缆；仍然如此则更换",
    };
    Text::new(what.row().advice, zh)
}

/// Part of the hand that a value belongs to.
pub(crate) const fn part(of: HandPart) -> Text {
    match of {
        HandPart::Joint(dof) => words::dof(dof),
        HandPart::Fingertip(finger) => words::finger(finger),
        HandPart::Hand => HAND,
    }
}

/// How a calibration with a scale ended.
pub(crate) fn scale_end(look: Look, end: Ended<ScaleEnd>) -> String {
    let text = match end {
        Ok(ScaleEnd::Done) => SCALE_DONE,
        Ok(ScaleEnd::Incomplete) => SCALE_INCOMPLETE,
        Ok(ScaleEnd::Contradicted) => SCALE_CONTRADICTED,
        Ok(ScaleEnd::NoContact) => SCALE_NO_CONTACT,
        Ok(ScaleEnd::ZeroOff) => SCALE_ZERO,
        Ok(ScaleEnd::NotOpened) => SCALE_NOT_OPENED,
        Ok(ScaleEnd::Unsteady) => SCALE_UNSTEADY,
        Ok(ScaleEnd::Late) => SCALE_LATE,
        Ok(ScaleEnd::NoAnswer) => SCALE_NO_ANSWER,
        Err(why) => return tune::abort(look, why),
    };
    look.tr(text).to_owned()
}

/// Advice about a value, and its drift.
pub(crate) fn to_do(look: Look, check: &Check) -> String {
    let what = check.measured.what;
    let advice = (check.grade >= Grade::Watch).then(|| look.tr(advice(what)).to_owned());
    let drift = check.drift().map(|drift| {
        let row = what.row();
        let [from, to] = [drift.from, drift.to].map(|value| row.text(value));
        look.fill(DRIFTS, &[&from, &to, &drift.checks, &drift.since])
    });
    let all: Vec<String> = advice.into_iter().chain(drift).collect();
    all.join(" ")
}

/// Remarks on a check-up, in addition to its values.
pub(crate) fn remarks(look: Look, report: &CheckupReport) -> Vec<String> {
    let joint = |dof| look.tr(words::dof(dof));
    let left_alone = report.left_alone.iter().map(|(dof, zero_g)| {
        let zero_g = format!("{zero_g:.0}");
        look.fill(LEFT_ALONE, &[&joint(*dof), &zero_g])
    });
    let keeping = match &report.keeping {
        Keeping::Kept { .. } => None,
        Keeping::BuiltIn => Some(look.tr(BUILT_IN).to_owned()),
        Keeping::Partial => Some(look.tr(PARTIAL_NOT_KEPT).to_owned()),
        Keeping::NotAsFirst { dof } => Some(look.fill(NOT_AS_FIRST, &[&joint(*dof)])),
        Keeping::Failed { error } => Some(look.fill(NOT_KEPT, &[error])),
    };
    left_alone.chain(keeping).collect()
}

/// Recorded usage of the hand.
pub(crate) fn usage(look: Look, report: &CheckupReport) -> String {
    let Some(usage) = &report.usage else {
        return look.tr(NOT_RECORDED).into();
    };
    let [read, moved] = usage.hours();
    let (dof, closes) = usage.most_closed();
    let since = day(Duration::from_secs(usage.since_1970_s));
    let joint = look.tr(words::dof(dof));
    let parts: [&dyn Display; 6] = [&since, &read, &moved, &joint, &closes, &usage.stalls];
    look.fill(USED, &parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::IntoEnumIterator as _;

    #[test]
    fn every_figure_and_its_advice_are_in_both_languages() {
        let known = include_str!("../../../assets/fonts/characters.txt");
        for text in Subject::iter().flat_map(|what| [subject(what), advice(what)]) {
            assert!(!text.en.is_empty() && !text.zh.is_empty(), "{text:?}");
            let mut signs = text.zh.chars().filter(|sign| !sign.is_ascii());
            assert!(signs.all(|sign| known.contains(sign)), "{text:?}");
        }
    }
}
