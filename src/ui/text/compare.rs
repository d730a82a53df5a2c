//! Sentences of comparing sessions of trials. What was measured is named in [`crate::ui::text::tune`].

use crate::app::trials::SessionDifference;
use crate::ui::text::phrase::texts;

texts! {
    SHOW: "Show {}", "显示{}", "Shows this session together with the others. At most four.", "与其他轮次叠加显示，最多四轮。";
    SHOWN_ALL: "At most four sessions. Hide one first.", "最多显示四轮：请先取消一轮。";
    SHOWN_LAST: "The only session shown.", "只显示了这一轮。";
    RUNS: "runs", "正在运行";
    NOT_SAVED: "not saved", "未保存";
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
    COLUMN_SESSION: "Session", "轮次";
    RISING: "rising", "升序";
    FALLING: "falling", "降序";
    OF_ALL: "curves of", "条曲线，共";
    ALONE: "{} alone: the sessions differ in {}", "仅统计{}，各轮差异：{}", "Figures of such sessions cannot be compared, so map and best setting are of the selected session.", "存在差异的试验不能合并统计，超出量图与最佳设置只针对所选的轮次。";
    TOGETHER: "Over all sessions shown", "统计所有显示的轮次";
    STATE: "{}: saved", "{}的保存状态";

    /// What keeps sessions from being compared.
    fn difference(SessionDifference) {
        SessionDifference::Hand => "hand", "灵巧手";
        SessionDifference::Joints => "joints", "自由度";
        SessionDifference::Way => "start or target", "起点或终点";
        SessionDifference::Approach => "approach", "接近方式";
        SessionDifference::Dwell => "time held", "保持时间";
    }
}
