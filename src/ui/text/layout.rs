//! Sentences of the borders between the rooms, and of the window's menu.

use crate::ui::text::phrase::texts;

texts! {
    MENU: "Window menu", "窗口菜单", "Rooms of the window: shut, open, put back.", "窗口各区域：收起、展开、恢复。";
    RESET: "Reset layout", "恢复默认布局", "All rooms open, all borders where they were at first. Nothing moves on the hand.", "展开所有区域，边界恢复到初始位置。灵巧手不会动作。";
    AT_REST: "Nothing moves the hand.", "灵巧手静止，无动作指令。";
    NO_HAND: "No hand is connected.", "未连接灵巧手。";
    MOVES_STOP: "Stopping: waiting for feedback that the hand rests", "正在停止：等待反馈确认静止";
    MOVES_CALIBRATION: "Force calibration moves the hand", "力传感器校准正在驱动灵巧手";
    MOVES_SERIES: "Trial", "试验";
    MOVES_SEQUENCE: "Sequence", "序列";
    MOVES_STEP: "step", "第";
    MOVES_GESTURE: "Gesture", "手势";
    MOVES_SETPOINTS: "The hand moves to your setpoints", "灵巧手正在移向设定值";
    MOVES_UNKNOWN: "The hand moves, and not because of this window", "灵巧手正在运动，但并非由本窗口发起";
    END: "End", "结束", "Ends it and holds the hand where it is.", "结束并保持灵巧手当前位置。";
    STOP_NOT_SENT: "STOP COULD NOT BE SENT", "停止命令未能发出", "No hand answers. If it moves, switch off its 24 V supply.", "没有灵巧手应答。若仍在运动，请关闭 24 V 电源。";
    UNDERSTOOD: "Understood", "知道了";
    OPEN: "Expand", "展开", "Shows this room again.", "重新显示此区域。";
    SIDE: "Fingertips and faults", "指尖与故障";
    ARM_FIRST: "Press Arm to move", "先点击“使能”再操作";
    TITLE: "Keys", "快捷键";
    BUTTON: "Keys", "快捷键", "Shows what each key does.", "显示各个按键的作用。";
    CLOSE: "Close the list of keys", "关闭快捷键列表";
    SHUT: "Close", "关闭";
    STOP: "STOP, from everywhere", "停止（任何时候）";
    ARM: "Arm or disarm", "使能或取消使能";
    LINK: "Link the fingers", "四指联动";
    UNIT: "Unit of angles", "角度单位";
    UNDO_TARE: "Take taring back", "撤销去皮";
    NOTE: "Write a note", "写备注";
    PAUSE: "Pause the plots", "暂停曲线";
    LANGUAGE: "English or Chinese", "中文或英文";
    THEME: "Dark or light", "深色或浅色";
    LIST: "This list", "本列表";
    MOTION: "Motion", "运动";
    JOINTS: "Joint that the arrows move", "方向键控制的关节";
    MEASURING: "Measuring", "测量";
    WINDOW: "Window", "窗口";
    ZOOM_IN: "Everything larger", "放大";
    ZOOM_OUT: "Everything smaller", "缩小";
    ZOOM_RESET: "Original size", "原始大小";
    ON_TRACKS: "On a track: arrows 10, with Shift 100; wheel; Tab to the next.", "在滑轨上：方向键每次 10，按住 Shift 每次 100；滚轮；Tab 到下一个。";
    IN_FIELDS: "In a field: a click selects all, Enter takes the number, Esc gives the old one back.", "在输入框里：点击全选，回车确认数值，Esc 恢复原值。";
    ESCAPE: "While the hand rests, Esc first closes what is open: a menu, a field, a note, this list. Else it stops the hand at once.", "灵巧手静止时，Esc 先关闭打开的菜单、输入框、标记或本列表；否则立即停止灵巧手。";
}
