//! Sentences of the window's frame: status line, menu, rooms, and what became of files.

use crate::ui::text::phrase::texts;

texts! {
    MENU: "Window menu", "窗口菜单", "Rooms of the window: shut, open, put back.", "窗口各区域：收起、展开、恢复。";
    RESET: "Reset layout", "恢复默认布局", "All rooms open, all borders where they were at first. Nothing moves on the hand.", "展开所有区域，边界恢复到初始位置。灵巧手不会动作。";
    AT_REST: "Nothing moves the hand.", "灵巧手静止，无动作指令。";
    NO_HAND: "No hand is connected.", "未连接灵巧手。";
    MOVES_STOP: "Stopping: waiting for feedback that the hand rests", "正在停止：等待反馈确认静止";
    MOVES_CALIBRATION: "Force calibration moves the hand", "力传感器校准正在驱动灵巧手";
    MOVES_STEP: "step", "第";
    MOVES_SETPOINTS: "The hand moves to your setpoints", "灵巧手正在移向设定值";
    MOVES_UNKNOWN: "The hand moves, and not because of this window", "灵巧手正在运动，但并非由本窗口发起";
    END: "End", "结束", "Ends it and holds the hand where it is.", "结束并保持灵巧手当前位置。";
    STOP_NOT_SENT: "STOP COULD NOT BE SENT", "停止命令未能发出", "No hand answers. If it moves, switch off its 24 V supply.", "没有灵巧手应答。若仍在运动，请关闭 24 V 电源。";
    LEAVE_TITLE: "Close Handscope?", "关闭 Handscope？";
    LEAVE_SERIES: "A series of trials runs. It would end here, and the hand would be held; what was measured is kept.", "正在运行抓取试验。关闭后试验将结束并保持灵巧手；已测得的数据会保留。";
    LEAVE_EDITS: "{} staged values were not applied. They would be forgotten.", "有 {} 个暂存值尚未写入，将会丢失。";
    STAY: "Keep it open", "保持打开";
    LEAVE: "Close the window", "关闭窗口";
    UNDERSTOOD: "Understood", "知道了";
    OPEN: "Expand", "展开", "Shows this room again.", "重新显示此区域。";
    SIDE: "Fingertips and faults", "指尖与故障";
    ARM_FIRST: "Press Arm to move", "先点击“使能”再操作";
    SAVED: "Saved:", "已保存：";
    IGNORED: "{} could not be read: {} It was put aside, and the last good one or none is in use. {}", "{} 无法读取：{}该文件已另存，现使用上一份完好的文件或默认值。{}";
    REFUSED: "Nothing was taken of {}: {}", "未采用 {}：{}";
    NOT_SAVED: "Could not be written:", "无法写入：";
    NO_FILE: "No file was chosen. Where no dialog came up, this desktop has none.", "没有选择文件。如果没有出现对话框，说明此桌面不提供。";
    PATH: "Path of the file", "文件路径";
    PATH_HINT: "or type the path of the file here", "或在此输入文件路径";
    PATH_NONE: "No path was typed.", "尚未输入路径。";
    PATH_OPEN: "Open path", "打开路径", "Opens the file that was typed. Enter does the same.", "打开所输入的文件。按回车作用相同。";
}
