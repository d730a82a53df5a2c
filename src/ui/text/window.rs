//! Sentences of the window's frame: status line, menu, rooms, the list of keys, and what became of files.

use crate::ui::style::phrase::texts;

texts! {
    MENU: "Window menu", "窗口菜单", "Rooms of the window: shut, open, put back.", "窗口各区域：收起、展开、恢复。";
    RESET: "Reset layout", "恢复默认布局", "All rooms open, all borders where they were at first. Nothing moves on the hand.", "展开所有区域，边界恢复到初始位置。灵巧手不会动作。";
    AT_REST: "Nothing moves the hand.", "灵巧手静止，无动作指令。";
    NO_HAND: "No hand is connected.", "未连接灵巧手。";
    MOVES_STOP: "Stopping: waiting for feedback that the hand rests", "正在停止：等待反馈确认静止";
    MOVES_CALIBRATION: "Force calibration moves the hand", "力传感器校准正在驱动灵巧手";
    MOVES_STEP: "step", "第";
    MOVES_SETPOINTS: "The hand moves to your setpoints", "灵巧手正在移向设定值";
    MOVES_TASK: "A pose, a sequence or another task of the program moves the hand", "姿态、序列或程序的其他任务正在驱动灵巧手";
    MOVES_EXHIBIT: "An exhibition moves the hand", "展示模式正在驱动灵巧手";
    MOVES_UNRECORDED: "The hand moves; who moves it is not in the recording", "灵巧手正在运动；记录中没有是谁在驱动它";
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

    HAND_OF: "Hand {}: {}", "灵巧手 {}：{}", "Shows this hand in all views. Alt and its number do the same.", "在所有页面显示此灵巧手。Alt 加编号作用相同。";
    STOP_ONE: "STOP hand {}", "停止灵巧手 {}", "Holds this hand and no other. STOP at the right, Space and Esc hold all hands.", "仅停止此灵巧手。右侧的“停止”、空格与 Esc 停止所有灵巧手。";
    ALL_HANDS: "All hands", "所有灵巧手", "Shows all hands side by side, in place of the plots of one.", "并排显示所有灵巧手，代替单只的曲线。";
    POSES_FOR_ALL: "To all armed hands", "用于所有已使能的灵巧手", "A pose or demo goes to every hand that is armed, not only to the one that is shown.", "姿态或演示会用于每只已使能的灵巧手，而不仅是当前显示的一只。";
    ADD_HAND: "Add a hand", "添加灵巧手", "Another hand in this window, beside those that are open: at most eight. Connects to nothing by itself.", "在本窗口再打开一只灵巧手，最多八只。不会自动连接。";
    ADD_HAND_FULL: "Eight hands are open, which is all that fit.", "已打开八只灵巧手，不能再添加。";
    REMOVE_HAND: "Remove this hand", "移除此灵巧手", "Stops this hand if it may be moving, disconnects it, and takes it out of the window.", "若此灵巧手可能在运动则先停止，然后断开并从窗口移除。";
    HAND_NAME: "Name of this hand", "灵巧手名称";
    HAND_NAME_SHORT: "Name", "名称";
    SIDE_RIGHT: "R", "右";
    SIDE_LEFT: "L", "左";
    MOVES: "moves", "运动中";
    OPEN_ELSEWHERE: "{} is open already, as {}. Nothing was connected.", "{} 已打开（{}），未连接。";
    EXHIBIT_ONE_HAND: "An exhibition is for one hand: disconnect the others first.", "展示模式仅用于一只灵巧手：请先断开其他灵巧手。";
    KEY_HAND: "Hand 1; so each hand by its number", "灵巧手 1；其他按其编号";
    KEY_HANDS: "Hands", "灵巧手";

    KEYS: "Keys", "快捷键", "Shows what each key does.", "显示各个按键的作用。";
    KEYS_CLOSE: "Close the list of keys", "关闭快捷键列表";
    KEY_ENTRY: "Fist; so each tile by its letter or digit", "握拳；其他图块按其字母或数字";
    KEY_STOP: "STOP, from everywhere", "停止（任何时候）";
    KEY_HOLD: "Held: the hand moves, with hold to run on", "按住：灵巧手运动（已开启“按住运行”时）";
    KEY_ARM: "Arm or disarm", "使能或取消使能";
    KEY_LINK: "Link the fingers", "四指联动";
    KEY_UNIT: "Unit of angles", "角度单位";
    KEY_UNDO_TARE: "Take taring back", "撤销去皮";
    KEY_NOTE: "Write a note", "写备注";
    KEY_LANGUAGE: "English or Chinese", "中文或英文";
    KEY_THEME: "Dark or light", "深色或浅色";
    KEY_LIST: "This list", "本列表";
    KEY_MOTION: "Motion", "运动";
    KEY_JOINTS: "Joint that the arrows move", "方向键控制的关节";
    KEY_MEASURING: "Measuring", "测量";
    KEY_WINDOW: "Window", "窗口";
    KEY_ZOOM_IN: "Everything larger", "放大";
    KEY_ZOOM_OUT: "Everything smaller", "缩小";
    KEY_ZOOM_RESET: "Original size", "原始大小";
    KEY_ON_TRACKS: "On a track: arrows 10, with Shift 100; wheel; Tab to the next.", "在滑轨上：方向键每次 10，按住 Shift 每次 100；滚轮；Tab 到下一个。";
    KEY_IN_FIELDS: "In a field: a click selects all, Enter takes the number, Esc gives the old one back.", "在输入框里：点击全选，回车确认数值，Esc 恢复原值。";
    KEY_ESCAPE: "While the hand rests, Esc first closes what is open: a menu, a field, a note, this list. Else it stops the hand at once.", "灵巧手静止时，Esc 先关闭打开的菜单、输入框、标记或本列表；否则立即停止灵巧手。";
}
