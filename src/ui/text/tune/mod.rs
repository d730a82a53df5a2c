//! Sentences of grasp trials: plan, progress, and measurements.

pub(crate) mod search;

use crate::app::settings::Language;
use crate::app::trials::SessionDifference;
use crate::app::trials::TrialQuantity;
use crate::app::trials::form::ListError;
use crate::hand::overshoot::{MeasuredOn, Stiffness};
use crate::hand::{Dof, Fault};
use crate::record::Abort;
use crate::trials::Stage;
use crate::trials::plan::PlanField;
use crate::trials::{Approach, EarlyEnd, PlanError, Until};
use crate::ui::style::phrase::texts;
use crate::ui::style::{Look, format};
use crate::ui::text::{Text, words};
use std::time::Duration;

texts! {
    ENDED: "Trials done: {}.", "已完成试验：{} 次。";
    ENDED_EARLY: "Trials ended early: {}. {}", "试验提前结束，共 {} 次。{}";
    OPENED: "Opened: {} ({} trials)", "已打开：{}（{} 次试验）";
    BY_PERSON: "Ended by the user.", "由操作者结束。";
    DISARMED: "No longer armed: {}.", "{}";
    NOT_ARMED: "The hand is no longer armed.", "灵巧手的使能已取消。";
    ARMED_ANEW: "The hand was rearmed.", "灵巧手已重新使能。";
    TAKEN_OVER: "Another controller has control of the hand.", "控制权已转给其他控制方。";
    DRIVE_FAULT: "A drive reports a fault.", "有驱动器报告故障。";
    OTHER_CONTROLLER: "Another controller talks to the hand.", "另有控制器正在与此灵巧手通讯。";
    OTHER_WROTE: "Another controller wrote {}.", "另有控制器写入 {}。";
    LINK_LOST: "The link was lost.", "连接断开。";
    FAULT: "{} reports a fault: {}.", "{}报告故障：{}。";
    HEAT: "{} is too warm: {} °C, limit {} °C.", "{}温度过高：{} °C，上限 {} °C。";
    CEILING: "{} presses harder than the limit: {} g, limit {} g.", "{}的力超过上限：{} g，上限 {} g。";
    UNREACHED: "{} did not reach {} in time.", "{}未按时到达 {}。";
    LIMITS_REFUSED: "{} does not show the speed and force threshold that were set.", "{}没有显示已设置的速度与力阈值。";
    NOT_READ: "Cannot monitor the hand: its {} was not read yet.", "无法监视灵巧手：{}读数尚未获取。";
    GREW_OLD: "Cannot monitor the hand: its last {} is {} s old, and it sends no newer one in time.", "无法监视灵巧手：最近的{}读数已是 {} 秒前，未能及时收到新读数。";
    STALLED: "Could not monitor the hand: this computer was busy, and the program did not run for {} s; the last {} is {} s old.", "无法监视灵巧手：本机繁忙，程序停滞 {} 秒；最近的{}读数已是 {} 秒前。";
    BLIND: "{} cannot be used: its {} is implausible.", "无法监视{}：{}读数不合理。";
    COOLING: "{} stayed too warm to begin: {} °C, limit {} °C.", "{}一直过热，无法开始：{} °C，上限 {} °C。";
    NOT_EMPTY: "The hand is not empty, or something is in its way: {} pressed with {} g at {}.", "手中有物体或有障碍：{}压力达 {} g，角度 {}。";
    NOT_KEPT: "Samples could not be stored.", "读到的数据无法保存。";
    NO_CONTACT: "{} found no contact to approach.", "{}没有感到接触，无法确定接触位置。";

    PLAN_IGNORED: "The plan of trials of last time is of another version; the first plan is shown:", "上次的试验计划版本不同，已改用初始计划：";
    PLAN: "Plan", "试验计划";
    HIDE_PLAN: "Hide the plan", "收起计划", "Gives the results the whole width.", "让结果占满宽度。";
    SHOW_PLAN: "Show the plan", "显示计划", "Puts the plan beside the results.", "在结果旁显示计划。";
    WAY: "{} from {} to {}", "{}从 {} 到 {}";
    STAYS: "{} stays at {} {}", "{}停在 {} {}";
    GRID: "At speeds {} with thresholds {} g; trials of each: {}", "速度 {}，力阈值 {} g，每组 {} 次。";
    MARGIN: "At speed {} first; slow down {} before the contact.", "先以速度 {} 接近；接触前 {} 处减速。";
    ANGLE: "At speed {} first; slow down at angle {}", "先以速度 {} 接近；到角度 {} 处减速。";
    PROXIMITY: "At speed {} first; slow down at proximity +{}", "先以速度 {} 接近；接近值增加 {} 时减速。";
    TOUCH: "At speed {} first; slow down at a touch of {} g.", "先以速度 {} 接近；触碰力 {} g 时减速。";
    TIMES: "Hold {} s, rest {} s. Force limit {} g; begin below {} °C, stop at {} °C.", "保持 {} s，间隔 {} s。力上限 {} g；低于 {} °C 开始，达到 {} °C 即停。";
    RESULTS: "Results", "结果";
    JOINTS: "Close", "闭合";
    JOINT_TIP: "The joint closes in each trial, or stays where it is. Nothing moves now.", "让该自由度在每次试验中闭合，或保持不动。现在不会运动。";
    START: "from", "起点", "Angle of the joint before each trial; 1000 is open.", "每次试验前的角度，1000 为张开。";
    CLOSE: "to", "终点", "Angle to which the joint closes; the force threshold stops it before.", "闭合的目标角度；到达力阈值时会提前停下。";
    TAKE_START: "Start from a pose", "起点取自姿态";
    TAKE_CLOSE: "Close to a pose", "终点取自姿态";
    TAKE_TIP: "Takes the angles of a pose. Nothing moves.", "采用某个姿态的角度，不会运动。";
    TAKE_NOW: "The pose the hand has now", "灵巧手当前的姿态";
    SPEEDS: "Speeds to try", "试验速度", "25, 50, 100", "25, 50, 100";
    FORCES: "Force thresholds to try", "试验力阈值", "300, 500", "300, 500";
    REPEATS: "times each", "每组次数", "Trials of each speed with each threshold.", "每个速度与力阈值组合的试验次数。";
    APPROACH: "Approach", "接近方式";
    FAST: "Fast speed", "快速段速度", "Speed until the fast part ends.", "快速段的速度。";
    UNTIL_MARGIN: "Contact margin", "接触前减速提前量", "Units of the angle before the contact that a first, slow trial measures.", "距首次慢速试验测得的接触处的提前量，角度单位。";
    UNTIL_ANGLE: "Slow at angle", "减速的角度", "The joints stop at this angle by themselves, then go on slowly.", "自由度先停在该角度，再慢速继续。";
    UNTIL_PROXIMITY: "Slow at proximity", "减速的接近增量", "Counts that the fingertip's proximity rises by.", "指尖接近值的增量，计数。";
    UNTIL_TOUCH: "Slow at touch, g", "减速的触碰力 g", "Grams that the fingertip or the force sensor feels.", "指尖或力传感器感到的克数。";
    DWELL: "Hold, s", "保持时间 s", "Time held after the stop; the steady force is measured at its end.", "停下后的保持时间，稳态力在其末尾测量。";
    REST: "Rest, s", "间隔时间 s", "Time between two trials.", "两次试验之间的时间。";
    CEILING_CAPTION: "Force limit, g", "力上限 g", "Force above the reading at rest that ends the series with a stop.", "超过静止读数达到此力时，立即停止并结束。";
    STOP_C: "Stop at, °C", "停止温度 °C", "Drive temperature that ends the series with a stop.", "驱动器达到此温度时，立即停止并结束。";
    START_C: "Begin below, °C", "开始温度 °C", "A trial begins only when all drives are below this temperature; until then it waits.", "所有驱动器低于此温度才开始试验，否则等待。";
    NOTE: "Note", "备注", "what is held, where it lies", "抓握的物体与摆放";
    TAGS: "Tags", "标签", "separated by commas", "用逗号分隔";

    LIST_RANGE: "Write whole numbers with commas, none above {}.", "请输入用逗号分隔的整数，最大为 {}。";
    LIST_LONG: "At most 20 numbers.", "最多 20 个数。";
    LIST_EMPTY: "Write at least one number.", "请至少输入一个数。";
    NO_JOINT: "Choose at least one joint.", "请至少选择一个自由度。";
    NO_WAY: "{} needs a start at least 30 above its target.", "{}的起点须比终点大至少 30。";
    NO_START: "{} takes part and has no start.", "{}参与试验但没有起点。";
    BAD_STAGE: "The speed would change outside the way of {} ({} to {}).", "速度切换处不在{}的行程之内（{} 到 {}）。";
    SLOW_APPROACH: "The fast speed is below a speed to try: {}.", "快速段速度低于试验速度 {}。";
    TOO_MANY: "Too many trials: {}, at most 1000.", "试验次数过多：{} 次，最多 1000 次。";
    BAD_NUMBER: "{}: choose between {} and {}.", "{}：请选择 {} 到 {} 之间的数。";
    UNTIL: "Where it slows down", "减速位置";
    NOTHING_TO_TRY: "There is nothing to try.", "没有可试验的设置。";
    BAD_HEAT: "Begin must be below stop, and stop at most 75 °C.", "开始温度须低于停止温度，停止温度最高 75 °C。";

    START_BUTTON: "Start trials", "开始试验", "Runs the plan while armed now. Any key, STOP, a fault, heat, the force limit or a lost link end it.", "在当前使能下运行计划。按任意键、停止、故障、过热、超过力上限或断线都会结束。";
    ARM_AND_START: "Arm and start", "使能并开始", "Held for 1 s, arms the hand and runs the plan. Any key, STOP, a fault, heat, the force limit or a lost link end it.", "按住 1 秒即使能并运行计划。按任意键、停止、故障、过热、超过力上限或断线都会结束。";
    HOLD_TO_START: "Hold for 1 s, by mouse or Enter: then the hand moves.", "用鼠标或回车按住 1 秒，随后灵巧手开始运动。";
    HOLD_LONGER: "Let go too early: hold for 1 s. Nothing was started.", "松开过早：请按住 1 秒。尚未开始。";
    ARMING: "The hand is being armed.", "正在使能灵巧手。";
    NOT_BEGUN: "The series did not begin: the hand was not armed for this plan in time.", "试验未开始：灵巧手未能及时为该计划使能。";
    NEED_FREE: "{} is locked and would have to move.", "{}已锁定，但试验需要它运动。";
    PLAN_WRONG: "Correct the plan first.", "请先修正计划。";
    WILL: "Trials: {}, at most about {}.", "试验 {} 次，最长约 {}。";
    WILL_PROBE: "The first, slow one measures the contact.", "第一次慢速试验用于测量接触位置。";
    EXPECT: "On a rigid object up to {} g over the threshold (speed {}, threshold {} g).", "抓握刚性物体时，峰值可能超过力阈值 {} g（速度 {}，力阈值 {} g）。", "The threshold stops the drive, it does not regulate force. Slower at the contact is gentler.", "力阈值只会让驱动器停下，并不调节力。接触时越慢越轻柔。";
    ANY_KEY: "Any key ends it with a stop.", "按任意键即停止并结束。";
    STOP_SERIES: "End with a stop", "停止并结束", "Holds the hand and ends the series.", "保持灵巧手当前位置并结束试验。";
    TRIAL: "Trial {} of {}: {}", "第 {} 次，共 {} 次：{}";
    LEFT: "at most about {} left", "最多还剩约 {}";
    PROGRESS: "Progress", "进度";
    LIVE_FORCE: "Force now, g", "当前的力 g";
    LIVE_EMPTY: "Waits for the trial", "等待试验开始";
    PROBE: "looks for the contact", "寻找接触位置";
    LAST: "Last series: {}", "上一轮：{}";
    ALL_DONE: "all trials done.", "全部试验已完成。";
    ENDS_AT: "force limit {} g", "力上限 {} g";
    IDLE_TITLE: "Nothing tried yet", "还没有试验";
    IDLE_BODY: "Put an object between the fingers, write how they close onto it, and start.", "把物体放在手指之间，写好闭合方式，然后开始。";
    OPEN_EARLIER: "Open an earlier session", "打开以前的试验", "Opens the session.toml of an earlier session, and what lies beside it.", "打开以前试验的 session.toml 及同一文件夹的数据。";
    THRESHOLD: "threshold {} g", "力阈值 {} g";
    OPEN: "Open", "打开", "Opens the session.toml of an earlier session, and what lies beside it.", "打开以前试验的 session.toml 及同一文件夹的数据。";
    SAVE: "Save session", "保存试验", "Writes the session into a new folder that is chosen: settings, samples and a report.", "把试验写入所选位置的新文件夹：设置、数据与报告。";
    SAVE_READ: "This session was read from files.", "该试验是从文件读取的。";
    SAVE_RUNS: "This series still runs.", "该轮试验仍在进行。";
    SESSION: "Session {}", "第 {} 轮", "Selects this session for note, tags and files. Shows it alone unless it is shown already.", "选择该轮次的备注、标签与文件；若未显示，则只显示它。";
    SHOWN_TIP: "Shows this quantity.", "显示该量。";
    ON_COMMAND: "From command", "从指令起";
    ON_CONTACT: "From contact", "从接触起";
    ALIGN_TIP: "Where the time of each curve begins. Without a contact a curve is left out.", "各曲线的时间起点。没有接触的曲线不显示。";
    CURVES_EMPTY: "No samples to draw", "没有可画的数据";
    COLUMN_TIP: "Sorts by this; again to reverse it.", "按此排序，再次点击反向。";
    COLUMN_TRIAL: "Trial", "试验", "Its number, speed / threshold, and joint.", "编号、速度 / 力阈值与自由度。";
    COLUMN_DEAD: "Dead, ms", "延迟 ms", "From the command to the first motion.", "从指令到开始运动的时间。";
    COLUMN_CONTACT: "Contact, s", "接触 s", "From the command to the contact, by force.", "从指令到力显示接触的时间。";
    COLUMN_PEAK: "Peak, g", "峰值 g", "Highest force above the reading at rest.", "相对静止读数的最大力。";
    COLUMN_PEAK_N: "Peak, N", "峰值 N", "The same in newtons, of the joints that were measured on a scale.", "同一力以牛顿计，仅限用秤测量过的自由度。";
    COLUMN_OVER: "Over, g", "超出 g", "Overshoot: highest force above the threshold.", "超调：最大力超出力阈值的部分。";
    COLUMN_SETTLE: "Settle, s", "稳定 s", "From the contact until the force stays steady.", "从接触到力稳定的时间。";
    COLUMN_STEADY: "Steady, g", "稳态 g", "Force at the end of the hold.", "保持末尾的力。";
    COLUMN_STEADY_N: "Steady, N", "稳态 N", "The same in newtons, of the joints that were measured on a scale.", "同一力以牛顿计，仅限用秤测量过的自由度。";
    COLUMN_RELAX: "Relax, g", "松弛 g", "Force lost between peak and end of the hold.", "从峰值到保持末尾损失的力。";
    COLUMN_SLIPS: "Slips", "滑动", "Sudden losses of force while it held.", "保持期间力突然下降的次数。";
    COLUMN_CURRENT: "Peak, mA", "峰值 mA", "Highest current of the drive.", "驱动器的最大电流。";
    COLUMN_HEAT: "Heat, °C", "温升 °C", "Rise of the drive's temperature in the trial.", "试验期间驱动器的温升。";
    END_DEAD_DRIVE: "dead drive: it never moved", "驱动无动作：该自由度从未运动";
    COLUMN_END: "End", "结束", "The last status of the drive, or why it ended early.", "驱动器最后的状态，或提前结束的原因。";
    MAP: "Overshoot, g, by speed and threshold", "各速度与力阈值的超出量 g";
    BEST: "Best", "最佳", "What the best setting is chosen by, judged by the worst of its trials.", "最佳设置的选择标准，以最差的一次为准。";
    BEST_NONE: "No setting will do.", "没有满足要求的设置。";
    LEAST_OVER: "Least overshoot", "超出最少";
    FASTEST: "Fastest within 100 g", "超出 100 g 内最快";
    HOLD_AT_LEAST: "Holds at least, g", "最小稳态力 g";
    HOLD_TIP: "Steady force that the best setting must keep.", "最佳设置至少要有的稳态力。";
    PROMOTE: "Make it the default", "设为默认", "Stages speed and threshold of the best as those after power-up, for the joints tried, and shows the card that saves them. Nothing is written unconfirmed.", "把最佳的速度与力阈值暂存为所试自由度的上电默认值，并显示保存卡片；确认前不写入。";
    BEST_SIGN: "Best setting", "最佳设置";
    BEST_OVER: "At most {} g over the threshold", "最多超出力阈值 {} g";
    MEASURED_HERE: "Measured on this hand in {} closes, the last on {}.", "由此手的 {} 次闭合测得，最近一次 {}。";
    MEASURED_ELSEWHERE: "Measured on another hand of the family.", "在同系列另一只手上测得。";
    MAP_SHOW: "This hand", "此手", "What trials and searches measured of this hand: how far its closes went past their thresholds. The warnings use it.", "试验与搜索对此手的实测：闭合时超出力阈值多少。警告据此给出。";
    MAP_TRIALS: "Trials", "试验", "The trials of now and of files.", "本次与文件中的试验。";
    MAP_WHICH: "What is shown", "显示内容";
    MAP_EMPTY: "Nothing measured of this hand yet", "尚无此手的实测数据";
    MAP_EMPTY_BODY: "Until then warnings of hard contacts use what was measured on another hand of the family. Each trial and each search on this hand adds to it, and it is kept.", "在此之前，冲击警告采用同系列另一只手的数据。此手的每次试验与搜索都会加入并保留。";
    MAP_NAME: "Overshoot of this hand over speed", "此手超出量与速度的关系";
    MAP_AXES: "Across: speed. Up: most above the threshold, g.", "横轴：速度。纵轴：超出阈值的最大值 g。";
    MAP_OTHER: "another hand, threshold {} g, rigid", "另一只手，阈值 {} g，刚性物体";
    MAP_POINT: "{} closes: at most {} g over the threshold, {} on average; the last on {}.", "{} 次闭合：最多超出阈值 {} g，平均 {}；最近 {}。";
    MAP_ALL: "All joints", "全部自由度";
    MAP_PICK: "Shows this joint alone.", "只显示该自由度。";
    MAP_EXPORT: "Export", "导出", "Saves it as a table for spreadsheets.", "保存为表格文件。";
    MAP_FORGET: "Forget", "清除", "Asks whether to forget all that was measured of this hand.", "询问是否清除此手的全部实测数据。";
    MAP_FORGET_SURE: "Forget all of it", "确定清除", "Warnings use another hand's figures then.", "之后警告采用另一只手的数据。";
    MAP_FORGET_NOT: "Keep it", "保留";
    MAP_TWO: "fast first", "先快后慢";
    MAP_JOINT: "Joint", "自由度";
    MAP_SPEED: "Speed", "速度", "At the contact.", "接触时的速度。";
    MAP_THRESHOLD: "Threshold", "阈值";
    MAP_OBJECT: "Object", "物体", "By what it gave: soft below 5 g for each unit of the angle, rigid from 20.", "按其变形：每角度单位低于 5 g 为软，20 g 起为硬。";
    MAP_CLOSES: "Closes", "次数";
    MAP_MOST: "Most over", "最多超出";
    MAP_MEAN: "Mean over", "平均超出";
    MAP_LAST: "Last", "最近";
    TRIED_ON: "Tried on another hand: {}", "在另一只手上试验：{}";
    NO_CONTACT_DRAWN: "{} without contact, not drawn", "{} 条无接触，未显示";
    JOINT_NAME: "{} takes part", "{}参与试验";
    START_NAME: "{} from", "{}起点";
    LEAVE: "{}: leave it alone", "{}：不参与", "Takes the joint out of the plan: it stays where it is.", "把该自由度移出计划，保持不动。";
    CLOSE_NAME: "{} to", "{}终点";
    SETTING: "speed {}, threshold {} g", "速度 {}，力阈值 {} g";
    SAVED_IN: "Saved in {}", "已保存到 {}";
    READ_FROM: "Read from {}", "读取自 {}";
    SHOW: "Show {}", "显示{}", "Shows this session together with the others. At most four.", "与其他轮次叠加显示，最多四轮。";
    SHOWN_ALL: "At most four sessions. Hide one first.", "最多显示四轮：请先取消一轮。";
    SHOWN_LAST: "The only session shown.", "只显示了这一轮。";
    SESSION_RUNS: "runs", "正在运行";
    SESSION_NOT_SAVED: "not saved", "未保存";
    SAVED: "saved", "已保存";
    READ: "from files", "来自文件";
    TRIALS: "{} trials", "{} 次";
    LOST: "{} without samples", "{} 次无数据";
    LOST_WHY: "Memory is full: the samples of the oldest trials that were not saved are gone. Figures and curves stay. Save each session when it is done.", "内存已满：最早的未保存试验的原始数据已丢弃，指标与曲线仍在。请在每轮完成后及时保存。";
    FORGET: "Forget", "移除", "Takes this session out of the list. Its files, if any, stay.", "把该轮次从列表移除，已有文件不受影响。";
    FORGET_TITLE: "Forget this session?", "移除该轮次？";
    FORGET_LOSES: "It is in no file: what was measured and recorded is gone then. Trials: {}", "尚未保存到文件：移除后测量结果与数据将丢失。试验次数：{}";
    FORGET_NOT: "Leave it", "保留", "Closes this card. The session stays.", "关闭此卡片，保留该轮次。";
    FORGET_SURE: "Forget it", "确定移除", "Takes this session out of the list. Its files, if any, stay.", "把该轮次从列表移除，已有文件不受影响。";
    RISING: "rising", "升序";
    FALLING: "falling", "降序";
    OF_ALL: "curves of", "条曲线，共";
    ALONE: "{} alone: the sessions differ in {}", "仅统计{}，各轮差异：{}", "Figures of such sessions cannot be compared, so map and best setting are of the selected session.", "存在差异的试验不能合并统计，超出量图与最佳设置只针对所选的轮次。";
    TOGETHER: "Over all sessions shown", "统计所有显示的轮次";
    STATE: "{}: saved", "{}的保存状态";

    /// Stiffness of an object.
    fn stiffness(Stiffness) {
        Stiffness::Soft => "soft", "软";
        Stiffness::Firm => "firm", "中等";
        Stiffness::Rigid => "rigid", "硬";
        Stiffness::Unknown => "unknown", "未知";
    }

    /// Stage of a series.
    fn stage(Stage) {
        Stage::Resting => "resting", "间隔";
        Stage::Preparing => "going to the start", "正在回到起点";
        Stage::Quiet => "still, limits being confirmed", "静止，正在确认设置";
        Stage::Closing => "closing", "正在闭合";
        Stage::Dwelling => "holding", "保持中";
        Stage::Releasing => "opening", "正在张开";
        Stage::Over => "over", "已结束";
    }

    /// Approach to the object.
    fn approach(Approach) {
        Approach::OneStage => "One speed all the way", "全程同一速度";
        Approach::TwoStage { until: Until::Measured { .. }, .. } => "Fast to the measured contact", "快速到实测接触处";
        Approach::TwoStage { until: Until::Angle(_), .. } => "Fast to an angle", "快速到指定角度";
        Approach::TwoStage { until: Until::Proximity(_), .. } => "Fast until the fingertip is near", "快速到指尖接近物体";
        Approach::TwoStage { until: Until::Touch(_), .. } => "Fast until first touch", "快速到首次触碰";
    }

    /// Value that cannot be monitored.
    fn group(&str) {
        "angle" => "angle", "角度";
        "force" => "force", "力";
        "temperature" => "temperature", "温度";
        _ => "fault", "故障";
    }

    /// A quantity of trials.
    fn quantity(TrialQuantity) {
        TrialQuantity::Force => "Force, g", "力 g";
        TrialQuantity::Angle => "Angle", "角度";
        TrialQuantity::Current => "Current, mA", "电流 mA";
        TrialQuantity::Touch => "Touch, N", "触觉 N";
    }

    /// Difference that prevents comparing sessions.
    fn difference(SessionDifference) {
        SessionDifference::Hand => "hand", "灵巧手";
        SessionDifference::Joints => "joints", "自由度";
        SessionDifference::Way => "start or target", "起点或终点";
        SessionDifference::Approach => "approach", "接近方式";
        SessionDifference::Dwell => "time held", "保持时间";
    }
}

/// Reason why a series or trial ended early. A file holds it as text.
pub(crate) fn ended(look: Look, why: &EarlyEnd) -> String {
    match why {
        EarlyEnd::Here(why) => abort(look, *why),
        EarlyEnd::FromFile(words) => format::sentence(words),
    }
}

/// Reason why a trial ended early.
pub(crate) fn abort(look: Look, why: Abort) -> String {
    let joint = |dof: Dof| look.tr(words::dof(dof));
    match why {
        Abort::Person => look.tr(BY_PERSON).into(),
        Abort::ArmedAnew => look.tr(ARMED_ANEW).into(),
        Abort::Disarmed { why: None } => look.tr(NOT_ARMED).into(),
        Abort::Disarmed { why: Some(why) } => match look.language {
            Language::En => look.fill(DISARMED, &[&why]),
            Language::Zh => words::disarmed_zh(why).into(),
        },
        Abort::OtherController { wrote: None } => look.tr(OTHER_CONTROLLER).into(),
        Abort::OtherController { wrote: Some(wrote) } => {
            look.fill(OTHER_WROTE, &[&words::setpoint(look, &wrote)])
        }
        Abort::LinkLost => look.tr(LINK_LOST).into(),
        Abort::NotKept => look.tr(NOT_KEPT).into(),
        Abort::TakenOver => look.tr(TAKEN_OVER).into(),
        Abort::Fault { joint: None } => look.tr(DRIVE_FAULT).into(),
        Abort::Fault {
            joint: Some((dof, faults)),
        } => {
            let name = |fault: Fault| words::fault(fault, look.language).title;
            let names: Vec<&str> = faults.iter().map(name).collect();
            look.fill(FAULT, &[&joint(dof), &look.list(&names)])
        }
        Abort::Heat {
            dof,
            celsius,
            limit,
        } => look.fill(HEAT, &[&joint(dof), &celsius, &limit]),
        Abort::Ceiling {
            dof,
            grams,
            ceiling,
        } => look.fill(CEILING, &[&joint(dof), &grams, &ceiling]),
        Abort::Unreached { dof, target } => look.fill(UNREACHED, &[&joint(dof), &target]),
        Abort::LimitsRefused { dof } => look.fill(LIMITS_REFUSED, &[&joint(dof)]),
        Abort::NotRead { what, age, stall } => not_read(look, what, (age, stall)),
        Abort::Blind { what, dof } => look.fill(BLIND, &[&joint(dof), &look.tr(group(what))]),
        Abort::TooWarm {
            dof,
            celsius,
            limit,
        } => look.fill(COOLING, &[&joint(dof), &celsius, &limit]),
        Abort::NotEmpty { dof, angle, grams } => {
            look.fill(NOT_EMPTY, &[&joint(dof), &grams, &angle])
        }
        Abort::NoContact { dof } => look.fill(NO_CONTACT, &[&joint(dof)]),
    }
}

/// Reason why readings are missing or old, from the age of the last one and the time for which the program was stalled.
fn not_read(
    look: Look,
    what: &'static str,
    (age, stall): (Option<Duration>, Option<Duration>),
) -> String {
    let seconds = |time: Duration| format!("{:.1}", time.as_secs_f64());
    let what = look.tr(group(what));
    match (age.map(seconds), stall.map(seconds)) {
        (None, _) => look.fill(NOT_READ, &[&what]),
        (Some(age), None) => look.fill(GREW_OLD, &[&what, &age]),
        (Some(age), Some(stall)) => look.fill(STALLED, &[&stall, &what, &age]),
    }
}

/// Reason why a plan cannot be run.
pub(crate) fn plan_error(look: Look, error: &PlanError) -> String {
    let joint = |dof: Dof| look.tr(words::dof(dof));
    match *error {
        PlanError::NoJoint => look.tr(NO_JOINT).into(),
        PlanError::NoWay { dof, .. } => look.fill(NO_WAY, &[&joint(dof)]),
        PlanError::NoStart { dof } => look.fill(NO_START, &[&joint(dof)]),
        PlanError::Stage {
            dof, start, close, ..
        } => look.fill(BAD_STAGE, &[&joint(dof), &start, &close]),
        PlanError::SlowApproach { speed, .. } => look.fill(SLOW_APPROACH, &[&speed]),
        PlanError::Empty => look.tr(NOTHING_TO_TRY).into(),
        PlanError::Range {
            field: PlanField::Repeats,
            got,
            ..
        } => look.fill(TOO_MANY, &[&got]),
        PlanError::Range {
            field, least, most, ..
        } => look.fill(BAD_NUMBER, &[&look.tr(plan_field(field)), &least, &most]),
        PlanError::Temperature { .. } => look.tr(BAD_HEAT).into(),
    }
}

/// Name of a field of the plan.
const fn plan_field(field: PlanField) -> Text {
    match field {
        PlanField::Joints | PlanField::Way(_) => JOINTS,
        PlanField::Speeds => SPEEDS,
        PlanField::Forces => FORCES,
        PlanField::Repeats => REPEATS,
        PlanField::Dwell => DWELL,
        PlanField::Rest => REST,
        PlanField::Fast => FAST,
        PlanField::Until => UNTIL,
        PlanField::Ceiling => CEILING_CAPTION,
        PlanField::Heat => STOP_C,
    }
}

/// Reason why a list of numbers is rejected.
pub(crate) fn list_error(look: Look, error: ListError) -> String {
    match error {
        ListError::NotInRange { most } => look.fill(LIST_RANGE, &[&most]),
        ListError::TooLong => look.tr(LIST_LONG).into(),
        ListError::Empty => look.tr(LIST_EMPTY).into(),
    }
}

/// Hand on which a value was measured.
pub(crate) fn measured_on(look: Look, on: &MeasuredOn) -> String {
    match on {
        MeasuredOn::AnotherHand => look.tr(MEASURED_ELSEWHERE).to_owned(),
        MeasuredOn::ThisHand { closes, last } => look.fill(MEASURED_HERE, &[closes, last]),
    }
}
