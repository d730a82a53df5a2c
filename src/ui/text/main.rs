//! Sentences of the top bar, the banners, the tabs and the joints.

use crate::app::settings::AngleUnit;
use crate::record::LinkState;
use crate::ui::style::phrase::texts;

texts! {
    TAB_COMPARE: "Compare", "对比";
    TAB_TUNE: "Tune", "调参";
    EXHIBIT_NOT_BEGUN: "Cannot start the exhibition: connect a hand and finish the open task first.", "无法进入展示：请先连接灵巧手，并结束正在进行的操作。";
    SERIES_RUNS: "A trial series is running. Stop it first.", "正在运行抓取试验：请先停止。";
    SIMULATED: "SIMULATED", "仿真", "This is the built-in hand. No real hand is connected.", "这是内置的仿真手，没有连接真实的灵巧手。";
    ONLY_FROM_TO: "Only a number within", "只接受此范围内的数字：";
    NO_HAND: "NO HAND", "无连接";
    ENDPOINT_TIP: "Where the hand is. Press the lamp beside it to change it.", "灵巧手的连接地址。点击旁边的状态灯可更改。";

    STATE_CONNECTING: "Connecting", "连接中";
    STATE_LOST: "Link lost", "连接断开";
    LINK_BUTTON: "Link state", "连接状态";
    LINK_TIP: "Shows the state of the link. Press to open the connection.", "显示连接状态。点击打开连接设置。";

    RATE_STATE: "State", "状态";
    ERRORS: "Errors", "错误", "Timeouts, wrong checksums, skipped noise, foreign replies and refusals since connecting.", "连接以来的超时、校验错误、跳过的噪声、无关应答与拒绝次数。";

    ARM: "Arm", "使能", "Lets angles, forces and speeds reach the hand. Arming moves nothing.", "允许角度、力阈值和速度发送到灵巧手。使能本身不会产生动作。";
    DISARM: "Armed", "已使能", "Armed: commands reach the hand. Press to disarm; the hand keeps its targets.", "设置值正在生效。点击后不再发送，灵巧手保持上一次的设置。";
    ARM_NAME: "Arm the hand", "使能灵巧手";
    HOLD_KEY: "Hold H", "按住 H", "Hold to run is on: holding the H key arms this hand, and letting go stops every hand.", "已开启“按住运行”：按住 H 键即使能此手，松开则所有手停下。";
    DISARM_NAME: "Disarm the hand", "取消使能";
    STOP: "STOP", "停止", "Holds the pose: every joint stays where it is. Space or Esc does the same; while the hand rests Esc first closes what is open.\nIt is not an emergency stop: in danger cut the 24 V supply.", "保持当前姿态：令所有自由度停在原位。空格键或 Esc 键作用相同；灵巧手静止时，Esc 先关闭已打开的内容。\n这不是急停：遇到危险请切断 24 V 电源。";
    STOP_KEYS: "Space or Esc", "空格键或 Esc";

    REFUSED_OFFLINE: "There is no live hand.", "没有在线的灵巧手。";
    REFUSED_HOLDING: "A stop is still being confirmed.", "正在确认停止。";
    REFUSED_FAULT: "A drive reports a fault: clear it first.", "驱动器报告故障，请先清除。";
    REFUSED_BUSY: "The hand is writing its flash or calibrating: wait until done.", "灵巧手正在写闪存或校准：请等待完成。";
    REFUSED_LET_GO: "Hold the H key: hold to run is on.", "请按住 H 键：已开启“按住运行”。";
    REFUSED_AFAR: "The hand refused its speed and force limits. If another Handscope shares it, ask for control there.", "灵巧手拒绝了速度与力阈值设置。若由其他 Handscope 共享，需由对方的人允许。";
    REFUSED_NO_ANSWER: "The hand did not acknowledge its speed and force limits.", "灵巧手没有确认速度与力阈值设置。";
    REFUSED_REPLACED: "Another request came before the hand was armed.", "使能前又提出了其他请求。";
    REFUSED_NOT_READ: "Angles and faults are unknown or stale.", "角度与故障尚未读取或已过时。";
    REFUSED_POSE: "Implausible joint angle:", "有自由度的角度不合理：";
    NOT_ARMED: "Not armed: press Arm first.", "未使能：请先点击“使能”。";
    LOCKED: "This joint is locked.", "该自由度已锁定。";

    CONNECTING_TITLE: "CONNECTING", "正在连接", "Asking the hand to answer; nothing is written to it:", "正在等待灵巧手应答，不写入任何数据：";
    EMPTY_TITLE: "NOT CONNECTED", "未连接", "Choose the hand to talk to, or the built-in simulated one.", "请选择要连接的灵巧手，或内置的仿真手。";
    EMPTY_OPEN: "Connection", "连接设置", "Opens the connection.", "打开连接设置。";
    LOST_TITLE: "LINK LOST", "连接断开", "The hand may still be moving or gripping. Cut the 24 V supply if needed.", "灵巧手可能仍在运动或抓握。必要时请切断 24 V 电源。";
    LOST_RETRY_IN: "Next try in", "重试倒计时";
    LOST_TRYING: "Trying, attempt", "正在重试，第";
    UNREACHABLE_TITLE: "NO CONNECTION", "无法连接";
    ALARM_TITLE: "STOP NOT CONFIRMED", "停止未确认", "Feedback does not show rest: the hand may still move. Hold is being repeated. Cut the 24 V supply.", "反馈未显示静止：灵巧手可能仍在运动。正在重复发送保持指令。请切断 24 V 电源。";
    DOUBT_TITLE: "FEEDBACK IN DOUBT", "反馈可疑", "Look at the hand, and cut the 24 V supply if it moves: feedback is frozen while motion is commanded, and no stop can be confirmed. Each joint is held at its estimated position.", "请查看灵巧手，若仍在运动请切断 24 V 电源：已发出运动指令，但反馈毫无变化，无法确认停止。各自由度按速度与时间推算的位置保持。";
    OTHER_CONTROLLER_TITLE: "ANOTHER CONTROLLER", "另有控制器", "Another program or master talks to this hand, and the two disturb each other. Close it, or arm again if you want both. If there is none, the hand restarted by itself.", "另有程序或主站正在与此灵巧手通讯，两者会互相干扰。请关闭它，或再次使能以确认继续。如果没有，则是灵巧手自行重启过。";
    OTHER_WROTE: "It wrote {}.", "它写入了 {}。";
    NOT_TAKEN_TITLE: "SETPOINT NOT TAKEN", "设置值未生效", "The hand holds another setpoint than was sent, and no other writer was seen: it ignores or limits it.", "灵巧手保持的设置值与发送的不同，且未发现其他写入：它忽略或限制了该值。";
    SETPOINT_WROTE: "{} {}: {}, we wrote {}", "{} {}：{}，我方写入 {}";
    SETPOINT: "{} {}: {}", "{} {}：{}";
    SETPOINT_OUTSIDE: "out of range", "超出范围";
    FAULT_TITLE: "FAULT", "故障", "A drive reports a fault. Setpoints are blocked until it is gone.", "驱动器报告故障。故障消失之前不会发送设置值。";
    FAULT_SHOW: "Show faults", "查看故障", "Opens the list of faults with causes and advice.", "打开故障列表，查看原因与建议。";
    LIST_END: ". ", "。";
    IDLE_TITLE: "ARMED", "已使能", "No command for", "未收到指令已有";
    STALE_TITLE: "OLD VALUES", "数据过时", "No fresh feedback for", "没有新反馈已有";

    TAB_LIVE: "Live", "实时";
    TAB_TOUCH: "Touch", "触觉";
    TAB_FAULTS: "Faults", "故障";
    TAB_POSES: "Poses", "姿态";
    TAB_TRAFFIC: "Traffic", "报文";
    TAB_DEVICE: "Device", "参数";
    TAB_CONNECTION: "Connection", "连接";
    THEME: "Dark or light", "深色或浅色", "Switches between light on dark and dark on light.", "切换深色与浅色主题。";
    DISMISS: "Close", "关闭", "Removes this message.", "移除这条消息。";

    JOINTS: "Joints", "自由度";
    LITTLE: "Little", "小拇指";
    RING: "Ring", "无名指";
    MIDDLE: "Middle", "中指";
    INDEX: "Index", "食指";
    THUMB: "Thumb", "大拇指";
    THUMB_BEND: "Thumb bend", "大拇指弯曲";
    THUMB_ROTATE: "Thumb rotate", "大拇指旋转";
    ANGLE: "Angle", "角度", "0 = bent (fist), 1000 = open. The handle is the target, the bar the actual angle.\nArrows: 10 steps, with Shift 100.", "0 = 弯曲（握拳），1000 = 张开。圆点为目标，竖条为实际角度。\n方向键每次 10，按住 Shift 每次 100。";
    FORCE: "Force", "力阈值", "The joint stops closing when its force reaches this threshold (grams). The bar is the force now.\nIt stops the drive; it does not regulate force.", "受力到达此阈值（克）时该自由度停止弯曲。色条为当前受力。\n它只让驱动器停止，并不调节力的大小。";
    FORCE_NEWTONS: "{} g are {} N at this joint.", "此自由度的 {} g 约为 {} N。";
    SPEED: "Speed", "速度", "1000 runs the whole stroke in 600 ms without load.", "1000 表示空载时 600 ms 走完全程。";
    STATUS: "status", "状态";
    NAME_ANGLE_TARGET: "angle target", "角度目标";
    NAME_ANGLE_NUMBER: "angle number", "角度数值";
    NAME_ANGLE_ACTUAL: "actual angle", "实际角度";
    NAME_FORCE_THRESHOLD: "force threshold", "力阈值";
    NAME_FORCE_NUMBER: "force number", "力阈值数值";
    NAME_FORCE_ACTUAL: "live force", "实际受力";
    NAME_SPEED: "speed", "速度";
    NAME_SPEED_NUMBER: "speed number", "速度数值";
    NAME_LOCK: "lock", "锁定";
    NAME_DRIVE: "current and temperature", "电流与温度";
    NAME_IMPACT: "impact warning", "冲击警告";
    RECORDED: "A recording is shown: nothing is sent.", "正在显示记录：不会发送任何内容。";
    HAND_HOLDS: "hand", "手", "The hand holds this instead: read back from it. What you set is sent by arming, or the next time you set it.", "灵巧手当前持有的是此值（回读所得）。你的设定会在使能时或下次设定时发送。";
    HELD: "Hand:", "灵巧手：";
    HELD_SPEED: "speed {}", "速度 {}";
    HELD_FORCE: "force {}", "力 {}";
    ARM_SENDS: "; Arm sends {}", "；使能时发送 {}";
    TAKE_HELD: "Use the hand's values", "采用手中的值", "Sets speed and force here to what the hand holds. Nothing is sent.", "将此处的速度与力设为灵巧手当前持有的值，不发送任何内容。";
    STAGED: "Not armed: applies on arming.", "未使能：使能后生效。";
    NUMBER_TIP: "Type a number and press Enter. Nothing is sent before.", "输入数字后按回车。回车之前不会发送。";
    LOCK_TIP: "Locks the joint: Open and its slider do not move it.", "锁定：“张开”与滑块都不再移动该自由度。";
    UNLOCK_TIP: "Locked: Open and its slider do not move it. Press to unlock.", "已锁定：“张开”与滑块都不会移动该自由度。按下可解锁。";
    IMPACT: "At speed {} a threshold of {} g was exceeded by about {} g on a rigid object.", "速度 {}、阈值 {} g 时，抓取刚性物体的实测峰值超出阈值约 {} g。";
    IMPACT_TIP: "Impact zone: the threshold stops the drive, it does not limit the force of a fast finger.\nSlow down to 25 before contact to stay within 100 g. The slanted part of each track is this zone.", "冲击区：阈值只让驱动器停止，不能限制快速手指的冲击力。\n接触前降到速度 25，可控制在 100 g 以内。滑轨上的斜线段即为此区。";
    EVERY: "All", "全部";
    EACH: "Force and speed of each joint", "各自由度的力阈值与速度", "Shows or hides the force threshold and the speed of each joint.", "显示或隐藏各自由度的力阈值与速度。";
    LINK_FINGERS: "Link", "联动", "The four fingers move together: each goes as far as the one you move. The thumb stays apart.", "四指联动：拖动一指，其余三指移动相同的量。大拇指不受影响。";
    UNIT_NAME: "Angle unit", "角度单位";
    UNIT_TIP: "Angles as 0 to 1000, in degrees, or in percent of the way to open. A decimal comma is understood.", "角度以 0 到 1000、度或张开百分比表示。";
    OPEN: "Open all", "全部张开", "Opens every joint that is not locked, at its set speed.", "令所有未锁定的自由度张开，按设定的速度。";
    HALF: "Half", "半握", "Bends fingers and thumb half, at their set speeds. The thumb's rotation and locked joints stay.", "四指与大拇指弯曲到一半，按设定的速度。大拇指旋转与锁定的自由度不动。";
    CLOSE: "Close", "握拢", "Bends fingers and thumb until their force thresholds stop them, at their set speeds. The thumb's rotation and locked joints stay.", "四指与大拇指弯曲，直到力阈值使其停止，按设定的速度。大拇指旋转与锁定的自由度不动。";
    AGE: "Age", "距今", "These values are old. The age counts from the request that brought them.", "这些数值已过时。时间从读取它们的请求算起。";
    NEVER_READ: "Not read yet", "尚未读取";

    /// A unit of angles.
    fn angle_unit(AngleUnit) {
        AngleUnit::Raw => "0..1000", "0..1000";
        AngleUnit::Degrees => "Degrees", "角度制";
        AngleUnit::Percent => "Percent", "百分比";
    }

    /// Name of a link state.
    fn link_state(LinkState) {
        LinkState::Offline => "Offline", "离线";
        LinkState::Identifying => "Identifying", "识别中";
        LinkState::Monitoring => "Monitoring", "监视";
        LinkState::Armed => "Armed", "已使能";
        LinkState::Holding => "Holding", "保持中";
        LinkState::Fault => "Fault", "故障";
    }
}
