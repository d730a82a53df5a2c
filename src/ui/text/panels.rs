//! Sentences of the plots, the fingertips, the fault list, the gestures and the connection.

use crate::app::readings::friction::FrictionState;
use crate::app::readings::tare::{TareSource, TareZero};
use crate::app::settings::Language;
use crate::hand::grip::GripState;
use crate::hand::{Moment, RateClass};
use crate::sim::Scenario;
use crate::ui::style::phrase::texts;
use crate::ui::style::{Look, format};
use std::time::Duration;

texts! {
    HISTORY: "History", "曲线";
    WINDOW_NAME: "Plot window", "时间窗口";
    PAUSE: "Pause", "暂停", "Freezes the plots. Nothing is lost meanwhile.", "曲线停止滚动，期间数据不会丢失。";
    PAUSED: "Paused", "已暂停", "Freezes the plots. Nothing is lost meanwhile.", "曲线停止滚动，期间数据不会丢失。";
    PAUSE_NAME: "Pause the plots", "暂停曲线";
    SHOW_CURVE: "Show or hide this joint's curves.", "显示或隐藏该自由度的曲线。";
    HIDE_CURVE: "Press to hide this joint's curves. More shows them again.", "点击隐藏该自由度的曲线，可在“更多”中重新显示。";
    CURVES: "Curves", "曲线";
    GROW: "Grow", "放大", "Press to draw this plot tall.", "点击放大此曲线图。";
    DRIVES: "Status", "状态", "Status reported by each drive. Blue: it moves. Green: in position. Amber: at force. Red: a fault, or stopped to protect itself. Empty: not known.", "各驱动器的状态。蓝：运动中。绿：位置到位。黄：力控到位。红：故障或保护停止。空白：未知。";
    DRIVE_SINCE: "since {}, for {}", "自 {} 起，持续 {}";
    SHORT_FORCE: "Force\ng", "受力\ng";
    SHORT_NORMAL: "Normal\nN", "法向\nN";
    SHORT_TANGENTIAL: "Shear\nN", "切向\nN";
    SHORT_CURRENT: "Current\nmA", "电流\nmA";
    SHORT_TEMPERATURE: "Temp.\n°C", "温度\n°C";
    SHORT_ANGLE: "Angle", "角度";
    THRESHOLDS: "Thresholds", "阈值", "Shows the force thresholds as dashed lines.", "以虚线显示力阈值。";
    PLOT_FORCE: "Force, g", "受力 g";
    PLOT_CURRENT: "Current, mA", "电流 mA";
    PLOT_TEMPERATURE: "Temperature, °C", "温度 °C";
    PLOT_ANGLE: "Angle, 0 bent to 1000 open", "角度 0 弯曲 1000 张开";
    PLOT_EMPTY: "Nothing measured in this time", "此时间段内没有数据";
    NOW: "now", "现在";
    MARK_STOP: "Stop", "停止";
    MARK_STOP_NOT_SENT: "Stop not sent", "停止未发出";
    MARK_FAULT: "Fault", "故障";
    MARK_RECONNECT: "Reconnected", "重新连接";
    MARK_LOST: "Link lost", "断开";
    MARK_ARMED: "Armed", "使能";
    MARK_DISARMED: "Disarmed", "取消使能";
    MARK_HELD: "At rest", "静止";

    TOUCH: "Fingertips", "指尖触觉", "Pads show capacitance above the zero: the first untouched reading, or the last taring. All fingers have one scale. The circle is the normal force, the arrow the tangential force (up = towards the tip), the halo the proximity.\nWhich channel belongs to which pad is not documented.", "各区显示相对零点的电容增量（零点为首次未受力读数或最近一次清零），所有手指同一标尺。圆的大小为法向力，箭头为切向力（向上为指尖方向），光晕为接近值。\n通道与区域的对应关系手册没有说明。";
    TOUCH_SCALE: "0 to {}k counts", "0 至 {}k 计数";
    TOUCH_NO_ZERO: "No zero", "无零点", "No zero yet: let go of the fingertips.", "尚无零点：请松开指尖。";
    TOUCH_NORMAL: "Normal", "法向";
    TOUCH_SHEAR: "Tangential", "切向";
    TOUCH_DIRECTION: "Direction", "方向";
    TOUCH_PROXIMITY: "Near", "接近";
    TOUCH_CHECK: "Check", "校验";
    TOUCH_NORMAL_NAME: "normal force", "法向力";
    TOUCH_SHEAR_NAME: "tangential force", "切向力";
    TOUCH_DIRECTION_NAME: "direction", "切向力方向";
    TOUCH_PROXIMITY_NAME: "proximity", "接近值";
    TOUCH_CHECK_NAME: "check", "校验";
    TOUCH_OK: "ok", "正常";
    TOUCH_DIFFERS: "diff", "不符";
    TOUCH_NO_CONTACT: "none", "无";
    TOUCH_CHANNEL: "Channel", "通道";
    TOUCH_DELTA_N: "Normal delta", "法向变化";
    TOUCH_DELTA_T: "Shear delta", "切向变化";

    HAND: "Hand", "灵巧手";
    HAND_PICTURE: "Picture of the hand", "手部姿态图", "Drag a finger to move it, elsewhere to turn the picture; double-click turns it back. Click a finger for its details.", "拖动手指可移动它，在其他位置拖动可旋转视图，双击复位；点击手指查看详情。";

    DRAG_FINGER: "drag to move it", "拖动即可移动";
    FINGER_FORCE: "force at the drawn finger", "图旁受力";
    FINGER_GRIP: "grip at the drawn finger", "图旁抓握";
    GRIP: "Grip", "抓握", "State of the grip, inferred from angles, forces, fingertips, current and status. Slipping: the force along a fingertip rises or turns. Lost: the contact is gone, and the finger did not open. Unknown: a reading is missing or old.", "根据角度、受力、指尖、电流和状态判断手对物体的抓握情况。打滑：指尖切向力上升或转向。丢失：手指未张开而接触消失。未知：读数缺失或过期。";
    GRIP_NOTES: "Grip details", "抓握详情";
    FINGER_TROUBLE: "trouble at the drawn finger", "图旁状况";
    TOUCH_SCALE_END: "end of the heat scale", "热度标尺上限";
    TARE_ALL: "Tare all", "全部清零", "Zeroes all channels here. Readings and recordings stay as the hand sends them.", "所有通道从当前读数起算。原始读数与记录不变。";
    TARE_ONE: "Tare", "清零", "Zeroes the channels of the chosen fingertip.", "所选指尖的通道从当前读数起算。";
    TARE_UNDO: "Undo", "撤销", "Undoes the last taring.", "撤销最近一次清零。";
    TARE_NOTHING: "Nothing was tared.", "还没有清零。";
    TIP: "Fingertip", "指尖";
    TIP_UP: "tip", "指尖";
    TIP_NORMAL: "Normal", "法向力";
    TIP_SHEAR: "Tangential", "切向力";
    TIP_RATIO: "Tangential / normal", "切向 / 法向";
    TIP_MARGIN: "Slip margin", "防滑余量";
    TIP_FRICTION: "Friction", "摩擦系数", "Friction between fingertip and object, from 0.01 to 1.5. The program cannot know it: choose it for your object. The ring shows it.", "指尖与物体间的摩擦系数，0.01 到 1.5。程序无法得知，请按物体选择；圆环表示该值。";
    TIP_FRICTION_NAME: "Friction, percent", "摩擦系数，百分比";

    FAULTS_NONE: "No faults", "没有故障";
    FAULTS_NONE_HINT: "Faults appear here with their cause and what to do.", "出现故障时，这里会列出原因与处理建议。";
    FAULTS_NONE_OLD: "No faults when last read", "上次读取时没有故障";
    FAULTS_UNKNOWN: "Faults not read yet", "尚未读取故障";
    CLEAR: "Clear errors", "清除错误", "Holds the pose, then clears stall, over-current, motor and communication faults. Over-temperature cannot be cleared: it ends by itself when cool.", "先保持姿态，再清除堵转、过流、电机异常和通讯故障。过温故障不可清除，温度回落后自动清除。";
    NOTICE_LOST: "Link lost.", "连接断开。";
    NOTICE_NO_LINK: "No hand reached.", "未连接到灵巧手。";
    TIMER_TOLD: "The USB adapter delays replies, which halves the rate. Its latency timer is", "USB 适配器延迟应答，速率减半。其延迟定时器为";
    TIMER_SEEN: "Replies come every 16 ms, as from a USB adapter that delays them (latency timer).", "应答每 16 ms 才到，像是 USB 适配器的延迟定时器所致。";
    TIMER_CURE: "In a terminal:", "在终端运行：";
    TIMER_CURE_WINDOWS: "Device Manager, port, Port Settings, Advanced: latency timer 1 ms.", "设备管理器 → 端口 → 端口设置 → 高级：延迟定时器 1 ms。";
    NOTICE_STOP_NOT_SENT: "STOP could not be sent: no hand answers. If it moves, switch off its 24 V supply.", "停止命令未能发出：没有灵巧手应答。若仍在运动，请关闭 24 V 电源。";
    NOTICE_RECONNECTED: "The hand answers again. It is not armed.", "灵巧手重新应答，尚未使能。";
    NOTICE_HELD: "Feedback shows rest. From stop to rest:", "反馈显示已静止。从停止到静止：";
    NOTICE_ARM: "Not armed.", "未能使能。";
    NOTICE_ACKNOWLEDGED: "acknowledged by the hand.", "灵巧手已确认。";
    NOTICE_LOCKED: "Nothing was sent: a gesture moves all joints, and this one is locked:", "未发送：手势会移动所有自由度，而以下自由度已锁定：";
    NOTICE_ENDPOINT: "The stored hand is invalid:", "无法识别上次的连接地址：";
    NOTICE_WITHOUT_OPENGL: "OpenGL does not start on this computer, so the window is drawn without it.", "这台电脑无法启动 OpenGL，窗口改用软件绘制。";
    NOTICE_UNGUARDED: "If this program is killed, only the 24 V switch stops the hand: the process for it could not start:", "无法启动备用进程：若本程序被强行终止，只有切断 24 V 电源才能让灵巧手停下：";
    DISARMED_BY_OTHER: "No longer armed: another controller wrote {}. Arm again if you want both.", "已取消使能：另有控制器写入 {}。再次使能以确认继续。";
    STEPS_LOST: "This window did not keep up: {} events are not shown.", "此窗口未能跟上：有 {} 个步骤未显示。";
    LEADER_STOPPED: "The hand that led this one was stopped, too.", "带动此手的那只手也已停下。";
    SOURCE_SILENT: "{} fell silent: the hand was stopped.", "{} 已无数据：灵巧手已停下。";

    GESTURE: "Gesture", "手势";
    GESTURES_FIXED: "1 to 13 fixed", "1 至 13 固定";
    GESTURES_USER: "14 to 40 user", "14 至 40 用户自定";
    GESTURES_TIP: "The manual describes gestures but lists no address for them. The route says which address is written.", "手册说明了手势功能，但寄存器表中没有其地址。“方式”决定写入哪个地址。";
    GESTURE_RUN_TIP: "Starts this gesture at once.", "立即执行该手势。";
    GESTURE_SHOW_TIP: "Shows what is known of it. Nothing moves.", "显示该手势的已知信息，不会产生动作。";
    GESTURE_CHOOSE: "Choose a gesture to see what is known of it.", "选择一个手势以查看已知信息。";
    GESTURE_START: "Start gesture", "执行手势";
    GESTURE_NAME_HINT: "name", "名称";
    GESTURE_OF_MAKER: "Fixed by the maker (1 to 13). The hand moves at its own speed, and does not tell the angles.", "由厂家固定（1 至 13）。灵巧手按自身速度运动，不提供角度。";
    GESTURE_OF_USER: "Stored by a user of this hand (14 to 40), or empty. The hand does not tell which.", "由用户存入（14 至 40），或为空；灵巧手不提供此信息。";
    GESTURE_ROUTE: "Gesture route", "手势方式";
    ROUTE_1008: "Write 1008", "写 1008";
    ROUTE_LIBRARY: "Action library 2320", "动作库 2320";
    ROUTE_OFF: "Off", "关闭";
    KNOWN_1008: "1008: not in the manual's table. Known: four drivers of this family write it. Not known: whether this firmware obeys.", "1008：手册寄存器表中没有。已知：同系列的四个驱动程序写此地址。未知：本固件是否执行。";
    KNOWN_LIBRARY: "2320, then 2322 = 1: not in the manual's table. Known: the maker's newer demos write it. Not known: whether this firmware moves.", "先写 2320，再写 2322 = 1：手册寄存器表中没有。已知：厂家较新的示例使用此方式。未知：本固件是否动作。";
    KNOWN_OFF: "Off: no address outside the manual's table is written, and no gesture can be started.", "关闭：不写手册寄存器表以外的地址，也无法启动手势。";
    GESTURES_OFF: "The gesture route is off.", "手势方式已关闭。";
    GESTURE_NAME_EDIT: "Name gestures", "命名手势", "Type names for the numbers. The hand does not describe its gestures.", "为编号输入名称。灵巧手不会给出手势名称。";
    GESTURE_NAME: "Name of gesture", "手势名称";

    CONNECTION_KIND: "Kind of link", "连接方式";
    PORTS_NONE: "None found. Type a name, or plug the adapter in and refresh.", "没有找到串口。请输入名称，或插入适配器后刷新。";
    PORTS_REFRESH: "Refresh", "刷新", "Looks for serial ports again.", "重新查找串口。";
    PORT_PICK_TIP: "Uses this port.", "选用此串口。";
    EXPERT: "For experts", "专家选项";
    SCAN_HERE: "Scan", "扫描", "Looks for hands here and nowhere else, at all speeds and in all protocols. It only reads.", "仅在此处以各种波特率与协议查找灵巧手。只读取，不写入。";
    CONNECT: "Connect", "连接", "Connects to this hand. Connecting writes nothing.", "开始与该灵巧手通讯。连接时不会写入任何内容。";
    DISCONNECT: "Disconnect", "断开", "Disconnects. The hand keeps its targets.", "停止通讯。灵巧手保持上一次的设置。";
    ADDRESS_WRONG: "Not an IP address: four numbers 0 to 255, as 192.168.11.210", "不是 IP 地址：应为四个 0 至 255 的数字，例如 192.168.11.210";
    LINK_NOW: "Link now", "当前连接";
    ENDPOINT: "Endpoint", "通讯地址";
    SINCE: ", for", "，已持续";
    ECHOES: "The adapter echoes: what is sent comes back, and is left out.", "适配器有回显：发送的内容会返回，已自动忽略。";
    SLOW: "Replies take up to {} ms: feedback and a stop lag as much.", "应答最长需要 {} ms：反馈与停止也会相应推迟。";
    MOVED_TO: "The adapter is now at", "适配器现位于";
    BUDGET: "What the line is used for", "线路的使用";
    DETAILS: "Details", "详细";
    FIRST: "While it moves, first", "运动时优先读取";
    FIRST_FORCE: "Force", "力";
    FIRST_TOUCH: "Fingertips", "指尖";
    FIRST_TIP: "What is read more often while something moves, where the line is too slow for all. A stop is as quick either way.", "线路速度不足时，运动期间优先读取的内容。停止的速度不受影响。";
    BUDGET_SHARE: "of its time", "时间占比";
    BUDGET_COULD: "at most", "最多", "How often it could be read if nothing else were read.", "若不读取其他内容，最多可达到的频率。";
    BUDGET_WRITES: "Writes", "写入";
    LINE_USED: "All together", "合计";
    ROUND_TRIP: "round trip {} ms", "往返 {} ms";
    STATE_RATE: "Motion state", "运动状态";
    RTT_P50: "Round trip, median", "往返时间，中位数";
    RTT_P99: "Round trip, 99 %", "往返时间，99 %";
    READS: "Reads", "读取次数";
    WRITES: "Writes", "写入次数";
    TIMEOUTS: "Timeouts", "超时";
    CHECKSUMS: "Checksum errors", "校验错误";
    RESYNCS: "Noise skipped", "跳过噪声";
    FOREIGN_REQUESTS: "Requests of others", "其他主站请求";
    FOREIGN: "Foreign replies", "无关应答";
    LATE: "Late replies", "迟到的应答";
    REFUSALS: "Refusals", "拒绝";
    IMPLAUSIBLE: "Implausible readings", "不合理的读数";
    RECONNECTS: "Reconnects", "重新连接";
    DROPPED: "Samples dropped", "丢弃样本";
    UNKNOWN: "Grey: angle not known", "灰色：角度未知";
    RIGHT_HAND: "Right hand", "右手";
    LEFT_HAND: "Left hand", "左手";
    SIDE_TIP: "Which hand is drawn; the hand does not say which one it is. A click draws the other one. Nothing moves.", "图中所画的手；灵巧手不会报告自己是左手还是右手。点击可切换，灵巧手不会动作。";
    ASSUMED: "Pads: assumed places", "分区位置为假定", "Which channel belongs to which pad is not documented: channels 1 to 7 are drawn as pads 1 to 7 of the sensor maker's model. Channel 8 belongs to no pad and stands beside them.", "手册没有说明通道与分区的对应关系：这里假定通道 1 至 7 对应传感器厂家模型的分区 1 至 7。通道 8 不属于任何分区，画在旁边。";
    DETAIL: "Detail", "详情", "The chosen fingertip: slip, forces, channels over time.", "所选指尖：打滑、受力、各通道曲线。";
    NUMBERS: "All numbers", "全部数值", "Every value of all five fingertips as a number.", "五个指尖的全部数值。";
    FORCES: "Force, N", "力 N";
    CHANNELS: "Channels, counts", "通道，计数";
    RAW: "Raw", "原始", "Channels as the hand sends them.", "按原始值显示各通道。";
    TARED: "Tared", "清零后", "Channels from their rest: the last taring, or the first reading.", "相对静止值显示：最近一次清零，或首次读数。";
    LAST_10_S: "10 s", "10 秒";
    LAST_MINUTE: "1 min", "1 分钟";
    LAST_10_MIN: "10 min", "10 分钟";
    LAST_TIP: "How much time the channels show.", "通道曲线显示的时间长度。";
    NO_NUMBER: "not a number", "非数值";
    BEYOND: "out of range", "超出范围", "The manual ends at 20 N. The number is shown as the hand sent it.", "手册上限为 20 N。数值按灵巧手发送的原样显示。";
    SLIP: "Slip", "打滑";
    TARED_NAME: "Taring of the chosen fingertip", "所选指尖的清零状态";
    NOT_TARED: "Zero: first reading", "零点：首次读数";
    KEPT_TARE: "Take the kept taring", "采用已保存的清零", "Counts from what was tared at this hand in an earlier session. Refused while a fingertip is touched.", "采用此前对同一灵巧手保存的清零零点。指尖受力时拒绝。";
    NO_ZERO: "No zero yet: it is touched", "尚无零点：正在受力";
    AREA_TIP: "Wheel: zoom in time. Drag: move. Shift and drag: zoom to what is marked. Double-click: follow the newest again.", "滚轮：时间缩放。拖动：平移。按住 Shift 拖动：放大所选范围。双击：重新跟随最新数据。";
    NORMAL: "Normal force at the tips, N", "指尖法向力 N";
    TANGENTIAL: "Tangential force at the tips, N", "指尖切向力 N";
    RANGE: "Value scale", "数值范围", "Drag: move. Wheel: zoom. Double-click: automatic again.", "拖动：平移。滚轮：缩放。双击：恢复自动。";
    RANGE_FIXED: "fixed scale", "固定范围";
    UNDER_POINTER: "under the pointer", "指针处数值";
    MORE: "More", "更多", "Which plots are shown, copying and saving.", "选择显示的曲线、复制和保存。";
    MORE_NAME: "More for the plots", "曲线更多选项";
    SHOWN: "Plots shown", "显示的曲线";
    ENLARGE: "Fill the view", "放大显示";
    SAVE_CSV: "Save these {} as CSV", "将这 {} 保存为 CSV", "All measurements of the shown time, plots and joints, as they were received, into a file. The window stays usable.", "把当前时间范围内所示曲线的全部原始数据保存到文件。保存期间窗口照常工作。";
    SAVE_PNG: "Save as PNG", "保存为 PNG", "A picture of these plots, at twice the resolution of the screen.", "将当前曲线保存为图片，分辨率为屏幕的两倍。";
    CURSORS: "A|B", "A|B", "Two cursors with values, difference, slope, and smallest, largest and mean value between them.", "两个游标：数值、差值、斜率，以及区间最小、最大和平均值。";
    CURSORS_NAME: "Cursors", "游标";
    CURSOR_A: "Cursor A", "游标 A";
    CURSOR_B: "Cursor B", "游标 B";
    AT_A: "A", "A";
    AT_B: "B", "B";
    DIFFERENCE: "B - A", "B - A";
    SLOPE: "per s", "每秒";
    SMALLEST: "min", "最小";
    LARGEST: "max", "最大";
    MEAN: "mean", "平均";
    APART: "Time between the cursors", "游标间隔";
    FIGURES: "Figures of the next plot", "下一曲线的数值", "The figures below are of this plot. Press for the next one, or click into a plot.", "下方为该曲线的数值。按下切换到下一条，或点击曲线区。";
    NOTE: "Note", "备注", "Puts a line with your words into the plots, at this moment. Key: N", "在当前时刻添加一条带文字的备注线。快捷键：N";
    NOTE_NAME: "Make a note", "添加备注", "Puts a line with your words into the plots, at this moment. Key: N", "在当前时刻添加一条带文字的备注线。快捷键：N";
    NOTE_AT: "Note at", "备注时刻";
    NOTE_FIELD: "Words of the note", "备注内容";
    NOTE_HINT: "Enter keeps it. Esc drops it.", "按 Enter 保存。Esc 取消。";
    NOTE_HINT_MOVING: "Enter keeps it. Esc stops the hand.", "按 Enter 保存。Esc 停止灵巧手。";
    NOTE_KEEP: "Keep", "保存", "Puts the note where its key was pressed.", "把备注放在按键时刻。";
    NOTE_CANCEL: "Cancel", "取消", "Makes no note.", "不添加备注。";
    NOTES: "Notes", "备注列表";
    NOTE_SHOW: "Show the note", "显示备注", "Shows this moment in the plots.", "在曲线中显示该时刻。";
    NOTE_DELETE: "Delete the note", "删除备注", "Removes the note from the plots.", "从曲线中删除该备注。";

    /// Behaviour of the built-in hand, with its name in endpoints.
    fn scenario(Scenario) {
        Scenario::Idle => "Soft ball", "软球";
        Scenario::Free => "Nothing to hold", "无物体";
        Scenario::Rigid => "Hard block", "硬块";
        Scenario::Fragile => "Fragile cup", "易碎杯";
        Scenario::Grasp => "Grasps by itself", "自动抓握";
        Scenario::Touched => "Fingertips are touched", "指尖被触摸";
        Scenario::Faults => "All faults in turn", "依次出现各种故障";
        Scenario::Extremes => "Impossible values", "异常数值";
        Scenario::Frozen => "Readings freeze in motion", "运动中读数冻结";
    }

    /// Grip state of a finger, or of the grasp.
    fn grip(GripState) {
        GripState::Unknown => "Unknown", "未知";
        GripState::Open => "Open", "张开";
        GripState::Moving => "Moving", "运动中";
        GripState::Empty => "Empty", "空握";
        GripState::Holding => "Holding", "握住";
        GripState::Slipping => "Slipping", "打滑";
        GripState::Lost => "Lost", "丢失";
        GripState::TooHard => "Too hard", "过紧";
        GripState::Touching => "Touching", "接触";
    }

    /// Firmness of a fingertip's hold.
    fn hold(FrictionState) {
        FrictionState::Unknown => "Not known", "未知";
        FrictionState::Loose => "No contact", "没有接触";
        FrictionState::Firm => "Holds", "稳定";
        FrictionState::Near => "Near to slipping", "接近打滑";
        FrictionState::Slips => "Slips at this friction", "按此摩擦会打滑";
    }

    /// Values that are read together.
    fn group(RateClass) {
        RateClass::Motion => "Angles, forces", "角度、受力";
        RateClass::Drives => "Currents, faults", "电流、故障";
        RateClass::Temperature => "Temperatures", "温度";
        RateClass::Tactile => "Fingertips", "指尖";
        RateClass::Settings => "Setpoints", "设定值";
    }

    /// Kind of endpoint, by its part before the colon, with a hint.
    fn kind(&str) {
        "rs485" => "RS485", "RS485", "As delivered: 115200 baud, id 1. If the port is refused on Linux, add yourself to the group dialout and log in again.", "出厂设置：波特率 115200，ID 1。Linux 下若无权限，请将用户加入 dialout 组后重新登录。";
        "tcp" => "Modbus TCP", "Modbus TCP", "As delivered: 192.168.11.210 port 6000, unit 255. This computer needs an address in the same network, for example 192.168.11.100. Anyone in that network can move the hand.", "出厂设置：192.168.11.210，端口 6000，单元标识符 255。本机需要同一网段的地址，例如 192.168.11.100。同一网络中的任何人都能控制灵巧手。";
        "rtu" => "Modbus RTU", "Modbus RTU", "As delivered: 115200 baud, id 1. If the port is refused on Linux, add yourself to the group dialout and log in again.", "出厂设置：波特率 115200，ID 1。Linux 下若无权限，请将用户加入 dialout 组后重新登录。";
        "can" => "CAN", "CAN", "Linux only. As delivered: 1000000 bit/s, id 1. The interface must be up: sudo ip link set can0 up type can bitrate 1000000.", "仅限 Linux。出厂设置：1000000 bit/s，ID 1。接口须已启用：sudo ip link set can0 up type can bitrate 1000000。";
        "slcan" => "CAN adapter", "CAN 适配器", "A serial CAN adapter that speaks slcan (Lawicel). As delivered, the hand has 1000000 bit/s and id 1.", "使用 slcan（Lawicel）协议的串口 CAN 适配器。灵巧手出厂设置：1000000 bit/s，ID 1。";
        "rtu+tcp" => "RTU over TCP", "RTU over TCP", "Modbus RTU through a serial device server: its address and TCP port, such as 192.168.11.7:4001. The server's serial side must have the hand's speed.", "通过串口服务器的 Modbus RTU：填写其地址与 TCP 端口，例如 192.168.11.7:4001。串口服务器的波特率须与灵巧手一致。";
        "usbcan" => "Maker's CAN", "因时 USB-CAN", "The maker's own USB-CAN adapter, 115200 bit/s on its serial side. Its bit rate on CAN is not set from here: it must be that of the hand, as delivered 1000000 bit/s.", "因时自带的 USB-CAN 适配器，串口侧 115200 bit/s。此处不设置其 CAN 波特率：须与灵巧手一致，出厂为 1000000 bit/s。";
        _ => "Simulated", "仿真", "The built-in hand answers on a simulated RS485 wire. Nothing real moves.", "内置仿真手通过模拟的 RS485 线路应答，不会有真实动作。";
    }

    /// Name of an endpoint's part, by its key.
    fn setting(&str) {
        "port" => "Serial port", "串口";
        "host" => "Address", "网络地址";
        "interface" => "Interface", "接口";
        "seed" => "Seed", "种子";
        "scenario" => "Scenario", "场景";
        "baud" => "Baud", "波特率";
        "bitrate" => "Bit rate", "CAN 波特率";
        "unit" => "Unit id", "单元标识符";
        "packing" => "Modbus bytes", "Modbus 字节";
        _ => "Hand id", "灵巧手 ID";
    }
}

/// Source and age of a fingertip's zero.
pub(crate) fn zero(look: Look, rest: TareZero, now: Moment) -> String {
    let since = now.since(rest.at);
    let (ago, kept) = match rest.source {
        TareSource::First => return look.tr(NOT_TARED).to_owned(),
        TareSource::User => (since, false),
        TareSource::Stored(age) => (age + since, true),
    };
    let ago = format::age(ago);
    match (look.language, kept) {
        (Language::En, false) => format!("Tared {ago} ago"),
        (Language::En, true) => format!("Tared {ago} ago, kept"),
        (Language::Zh, false) => format!("{ago}前清零"),
        (Language::Zh, true) => format!("{ago}前清零（已保存）"),
    }
}

/// A stored taring.
pub(crate) fn stored_tare(look: Look, age: Duration) -> String {
    let age = format::age(age);
    match look.language {
        Language::En => format!("Taring of {age} ago"),
        Language::Zh => format!("{age}前的清零"),
    }
}
