//! Sentences of the faults, the recordings around them and the message log.

use crate::ui::style::phrase::texts;

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
    CAME: "came {} times", "共 {} 次";
    SEEN: "Seen", "已看", "You have seen this fault. It stays in the list until it is forgotten, and is unseen again if it comes again.", "表示已查看该故障。它仍留在列表中；再次出现时会重新标为未查看。";
    SEEN_ALL: "All seen", "全部已看", "You have seen all faults of the list.", "表示已查看列表中的全部故障。";
    SEEN_NONE: "Every fault was seen.", "没有未查看的故障。";
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
    WORD_INFO: "info", "信息";
    WORD_WARN: "warning", "警告";
    WORD_ALARM: "alarm", "报警";
    COPY: "Copy", "复制", "Copies the messages that are listed, with seconds since the start of the program.", "复制列出的消息，附程序启动以来的秒数。";
    COPIED: "Copied", "已复制";


    RECORDINGS: "Recordings", "故障记录";
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
}
