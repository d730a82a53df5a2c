//! Sentences of the top bar, the banners, the tabs and the joints.

use crate::ui::text::phrase::texts;

texts! {
    SIMULATED: "SIMULATED", "仿真";
    SIMULATED_TIP: "This is the built-in hand. No real hand is connected.", "这是内置的仿真手，没有连接真实的灵巧手。";
    REAL_HAND: "HAND", "真机";
    NO_HAND: "NO HAND", "无连接";
    ENDPOINT_TIP: "Where the hand is. Press the lamp beside it to change it.", "灵巧手的连接地址。点击旁边的状态灯可更改。";

    STATE_OFFLINE: "Offline", "离线";
    STATE_CONNECTING: "Connecting", "连接中";
    STATE_IDENTIFYING: "Identifying", "识别中";
    STATE_MONITORING: "Monitoring", "监视";
    STATE_ARMED: "Armed", "已使能";
    STATE_HOLDING: "Holding", "保持中";
    STATE_FAULT: "Fault", "故障";
    STATE_LOST: "Link lost", "连接断开";
    LINK_BUTTON: "Link state", "连接状态";
    LINK_TIP: "Shows where the link stands. Press to open the connection.", "显示连接状态。点击打开连接设置。";

    RATE_STATE: "State", "状态";
    RATE_TACTILE: "Touch", "触觉";
    ROUND_TRIP: "Round trip", "往返";
    ERRORS: "Errors", "错误";
    RATES_TIP: "Reads of the motion state and of all fingertips a second, over the last second.", "最近一秒内每秒读取运动状态和全部指尖的次数。";
    ROUND_TRIP_TIP: "Median and 99th percentile of the time from request to reply, in milliseconds.", "请求到应答所用时间的中位数与第 99 百分位，单位毫秒。";
    ERRORS_TIP: "Timeouts, wrong checksums, skipped noise, foreign replies and refusals since connecting.", "连接以来的超时、校验错误、跳过的噪声、无关应答与拒绝次数。";

    ARM: "Arm", "使能";
    DISARM: "Armed", "已使能";
    ARM_NAME: "Arm the hand", "使能灵巧手";
    DISARM_NAME: "Disarm the hand", "取消使能";
    ARM_TIP: "Lets your angles, forces and speeds pass to the hand. Nothing moves by arming.", "允许角度、力控阈值和速度发送到灵巧手。使能本身不会产生动作。";
    DISARM_TIP: "Setpoints pass. Press to let none pass any more; the hand keeps what it was told.", "设置值正在生效。点击后不再发送，灵巧手保持上一次的设置。";
    STOP: "STOP", "停止";
    STOP_KEYS: "Space or Esc", "空格键或 Esc";
    STOP_TIP: "Holds the pose: every joint is told to stay where it is. Space or Esc does the same.\nIt is not an emergency stop: in danger cut the 24 V supply.", "保持当前姿态：令所有自由度停在原位。空格键或 Esc 键作用相同。\n这不是急停：遇到危险请切断 24 V 电源。";

    REFUSED_OFFLINE: "There is no live hand.", "没有在线的灵巧手。";
    REFUSED_HOLDING: "A stop is still being confirmed.", "正在确认停止。";
    REFUSED_FAULT: "A drive reports a fault: clear it first.", "驱动器报告故障，请先清除。";
    REFUSED_NO_ANSWER: "The hand did not acknowledge its speed and force limits.", "灵巧手没有确认速度与力控设置。";
    REFUSED_POSE: "The angle of a joint is unknown or old:", "有自由度的角度未知或已过时：";
    NOT_ARMED: "Not armed: press Arm first.", "未使能：请先点击“使能”。";
    LOCKED: "This joint is locked.", "该自由度已锁定。";

    EMPTY_TITLE: "NOT CONNECTED", "未连接";
    EMPTY_BODY: "Choose the hand to talk to, or the built-in simulated one.", "请选择要连接的灵巧手，或内置的仿真手。";
    EMPTY_OPEN: "Connection", "连接设置";
    EMPTY_OPEN_TIP: "Opens the connection.", "打开连接设置。";
    LOST_TITLE: "LINK LOST", "连接断开";
    LOST_BODY: "The hand may still be moving or gripping. Cut the 24 V supply if needed.", "灵巧手可能仍在运动或抓握。必要时请切断 24 V 电源。";
    LOST_RETRY_IN: "Next try in", "重试倒计时";
    LOST_TRYING: "Trying, attempt", "正在重试，第";
    UNREACHABLE_TITLE: "NO CONNECTION", "无法连接";
    ALARM_TITLE: "STOP NOT CONFIRMED", "停止未确认";
    ALARM_BODY: "Feedback does not show rest: the hand may still move. Hold is being repeated. Cut the 24 V supply.", "反馈未显示静止：灵巧手可能仍在运动。正在重复发送保持指令。请切断 24 V 电源。";
    RIVAL_TITLE: "ANOTHER CONTROLLER", "另有控制器";
    RIVAL_BODY: "Another program or master talks to this hand, and the two disturb each other. Close it. Arming while it is there is your confirmation.", "另有程序或主站正在与此灵巧手通信，两者会互相干扰。请关闭它；此时使能即表示确认。";
    FAULT_TITLE: "FAULT", "故障";
    FAULT_BODY: "A drive reports a fault. Setpoints do not pass until it is cleared.", "驱动器报告故障。清除之前不会发送设置值。";
    FAULT_SHOW: "Show faults", "查看故障";
    FAULT_SHOW_TIP: "Opens the list of faults with causes and advice.", "打开故障列表，查看原因与建议。";
    LIST_END: ". ", "。";
    STALE_TITLE: "OLD VALUES", "数据过时";
    STALE_BODY: "No fresh feedback for", "没有新反馈已有";

    TAB_LIVE: "Live", "总览";
    TAB_TOUCH: "Touch", "触觉";
    TAB_FAULTS: "Faults", "故障";
    TAB_GESTURES: "Gestures", "手势";
    TAB_CONNECTION: "Connection", "连接";
    TAB_TIP: "Shows this part of the window. Nothing moves.", "切换到此视图，不会产生动作。";
    THEME_DARK: "Dark", "深色";
    THEME_LIGHT: "Light", "浅色";
    THEME_NAME: "Theme", "主题";
    THEME_TIP: "Switches between light on dark and dark on light.", "切换深色与浅色主题。";
    LANGUAGE_NAME: "Language", "语言";
    LANGUAGE_TIP: "Switches the window to Chinese.", "切换为英文界面。";
    DISMISS: "Close", "关闭";
    DISMISS_TIP: "Takes this message away.", "移除这条消息。";

    JOINTS: "Joints", "自由度";
    LITTLE: "Little", "小拇指";
    RING: "Ring", "无名指";
    MIDDLE: "Middle", "中指";
    INDEX: "Index", "食指";
    THUMB: "Thumb", "大拇指";
    THUMB_BEND: "Thumb bend", "大拇指弯曲";
    THUMB_ROTATE: "Thumb rotate", "大拇指旋转";
    ANGLE: "Angle", "角度";
    FORCE: "Force", "力控";
    SPEED: "Speed", "速度";
    STATUS: "status", "状态";
    NAME_ANGLE_TARGET: "angle target", "角度目标";
    NAME_ANGLE_NUMBER: "angle number", "角度数值";
    NAME_ANGLE_ACTUAL: "actual angle", "实际角度";
    NAME_FORCE_THRESHOLD: "force threshold", "力控阈值";
    NAME_FORCE_NUMBER: "force number", "力控阈值数值";
    NAME_FORCE_ACTUAL: "live force", "实际受力";
    NAME_SPEED: "speed", "速度";
    NAME_SPEED_NUMBER: "speed number", "速度数值";
    NAME_LOCK: "lock", "锁定";
    NAME_DRIVE: "current and temperature", "电流与温度";
    NAME_IMPACT: "impact warning", "冲击警告";
    ANGLE_TIP: "0 = bent (fist), 1000 = open. The handle is the target, the bar the actual angle.\nArrows: 10 steps, with Shift 100.", "0 = 弯曲（握拳），1000 = 张开。圆点为目标，竖条为实际角度。\n方向键每次 10，按住 Shift 每次 100。";
    FORCE_TIP: "The joint stops closing when its force reaches this threshold (grams). The bar is the force now.\nIt stops the drive; it does not regulate force.", "受力到达此阈值（克）时该自由度停止弯曲。色条为当前受力。\n它只让驱动器停止，并不调节力的大小。";
    SPEED_TIP: "1000 runs the whole stroke in 600 ms without load.", "1000 表示空载时 600 ms 走完全程。";
    STAGED: "Not armed: applies on arming.", "未使能：使能后生效。";
    NUMBER_TIP: "Type a number and press Enter. Nothing is sent before.", "输入数字后按回车。回车之前不会发送。";
    LOCK_TIP: "Locked: this joint is left alone by Open and by its slider.", "锁定后，“张开”与滑块都不会移动该自由度。";
    IMPACT_TIP: "Impact zone. The threshold is not a limit at this speed: on a rigid object the peak force was measured\nabove the threshold by 336 g (speed 250, 250 g), 637 g (250, 500 g), 1640 g (250, 1000 g) and about 3000 g at speed 1000.\nSlow down to 25 before contact to stay within 100 g.", "冲击区。此速度下阈值并非上限：抓取刚性物体时实测峰值超出阈值\n336 g（速度 250，阈值 250 g）、637 g（250，500 g）、1640 g（250，1000 g），速度 1000 时约 3000 g。\n接触前降到速度 25，可控制在 100 g 以内。";
    OPEN: "Open all", "全部张开";
    OPEN_TIP: "Tells every joint that is not locked to open, at its speed.", "令所有未锁定的自由度以各自速度张开。";
    HOLD: "Hold", "保持";
    HOLD_TIP: "The same as STOP: every joint stays where it is.", "与“停止”相同：所有自由度停在原位。";
    AGE: "Age", "距今";
    AGE_TIP: "These values are old. The age counts from the request that brought them.", "这些数值已过时。时间从读取它们的请求算起。";
    NEVER_READ: "Not read yet", "尚未读取";
}
