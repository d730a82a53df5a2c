//! Sentences of inputs that may move the hand besides the window: streams, the gateway, a gamepad with its controls and actions.

use crate::inputs::dds::ctrl::CtrlFault;
use crate::inputs::line::StreamLineFault;
use crate::inputs::pad::{PadAction, PadControl};
use crate::motion::follow::step::FollowPhase;
use crate::ui::style::phrase::texts;

texts! {
    TITLE: "Share", "共享";
    OWNER: "Who moves the hand", "由谁控制";
    NOBODY_OUTSIDE: "Only this window.", "仅本窗口。";
    TAKE_BACK: "Take back", "收回控制", "Stops the hand and revokes control.", "停下灵巧手，并收回对方的控制权。";
    GRANT: "Let it move the hand", "允许控制", "One at a time may move the hand. It begins where the hand is; a click here, STOP, silence, a fault or a lost link end it.", "同一时间只允许一个来源控制。从当前位置开始；在此点击、停止、无数据、故障或断开连接都会结束控制。";
    TAKEN: "Another has control: take it back first.", "其他来源正在控制：请先收回。";
    NO_HAND: "No hand answers.", "没有灵巧手应答。";
    ADDRESS_WRONG: "Write an address in numbers and a port, for example 127.0.0.1:6010.", "请输入数字地址和端口，例如 127.0.0.1:6010。";
    INTERFACE_WRONG: "Write the name of a network interface, or its address.", "请输入网络接口的名称或地址。";
    NOT_OPENED: "This cannot be opened: {}. Choose another address or port.", "无法打开：{}。请选择其他地址或端口。";
    OPEN_TO_ALL: "Anyone in the network can reach this; 127.0.0.1 keeps it to this computer.", "网络中的任何人都能访问；使用 127.0.0.1 则仅限本机。";
    STREAM: "Another program", "其他程序", "Lines of JSON over UDP or TCP: hand tracking, a glove, a script ('handscope help stream').", "通过 UDP 或 TCP 发送的 JSON 数据：手部追踪、手套或脚本（'handscope help stream'）。";
    STREAM_AT: "Address for lines", "数据地址";
    UDP: "UDP", "UDP";
    TCP: "TCP", "TCP";
    ON: "On", "已开启", "It is open. Press to end it: whoever moves the hand through it is stopped.", "已开启。按下即结束；正在由此驱动的灵巧手会停止。";
    OFF: "Off", "已关闭";
    LISTEN: "Listen", "接收", "Takes lines at this address; nothing moves by that.", "在此地址接收数据；不会移动灵巧手。";
    ALL_REFUSED: "Lines arrive, and each is refused.", "有数据到达，但均被拒绝。";
    NOBODY_SENDS: "No sender now.", "目前没有数据。";
    HZ_FROM: "{} Hz from {}", "{} Hz，来自 {}";
    TAKEN_LINES: "Lines taken", "已接收";
    ODD_STOPS: "Stops in an odd spelling", "写法异常的停止";
    NOT_GRANTED: "Not followed", "未跟随";
    MIRROR: "Another hand", "另一只手", "Another hand of this window leads this one, which follows its joints; left and right may lead each other. That one is only read. Once either is stopped or lost, this window moves neither.", "由本窗口中的另一只手带动此手：此手跟随其自由度位置，左右手均可。对那只手只读取。任一只手停下或断开后，本窗口不再移动这两只手。";
    LEADER: "Leading hand", "主导手";
    WATCH: "Watch the leading hand", "跟踪主导手", "Reads the hand that leads; nothing moves by that.", "读取主导手；不会移动灵巧手。";
    NO_OTHER_HAND: "No other hand is connected.", "没有连接其他灵巧手。";
    MIRROR_SCALE: "Share, %", "比例（%）", "How much of each bend of the leading hand is followed, percent:", "按此百分比跟随主导手的弯曲：";
    CHOOSE_LEADER: "Choose the hand that leads first.", "请先选择主导手。";
    LEADER_SILENT: "The leading hand does not answer.", "主导手没有应答。";
    CIRCLE: "This hand leads that one already, directly or over others: hands cannot lead one another in a circle.", "此手已直接或经由其他手带动那只手：不能循环带动。";
    ANSWERS: "The leading hand answers, {} Hz", "主导手有应答，{} Hz";
    GATEWAY: "Gateway", "网关", "Several Modbus TCP programs at this hand ('handscope help share'). They read; grant control of the hand here.", "多个 Modbus TCP 程序共用此灵巧手（'handscope help share'）。它们可以读取；由谁控制在此决定。";
    FIRST_CLIENT: "The first client that writes may move the hand: the settings file says so (first_client_moves).", "先写入的程序可直接控制：设置文件如此规定（first_client_moves）。";
    GATEWAY_AT: "Address of the gateway", "网关地址";
    OPEN_GATEWAY: "Open the gateway", "打开网关", "Serves Modbus TCP at this address.", "在此地址提供 Modbus TCP 服务。";
    NO_CLIENTS: "Nobody is connected.", "没有连接。";
    MOVES: "moves the hand", "正在控制";
    CLIENTS: "Programs connected: {}", "已连接程序：{}";
    CLIENT: "{} requests/s, {} reads, {} writes, {} refused", "每秒 {} 次请求，读取 {}，写入 {}，拒绝 {}";
    DDS: "DDS", "DDS", "Like Unitree's driver and ROS 2 ('handscope help dds'): publishes this hand's state, and listens for commands. Both at this interface, a name or an address.", "与宇树驱动和 ROS 2 一致（'handscope help dds'）：发布状态，并接收指令。在此网络接口（名称或地址）上进行。";
    DDS_AT: "Interface of DDS", "DDS 网络接口";
    JOIN: "Join", "加入", "Publishes at this interface, and listens; nothing moves by that.", "在此接口上发布并接收；不会移动灵巧手。";
    STATES: "States published", "已发布状态";
    COMMANDS: "Commands taken", "已接收指令";
    REFUSED: "Refused", "已拒绝";
    VIEWERS: "Live viewers", "实时查看", "Foxglove, PlotJuggler and their like ('handscope help share'): the topics of a recording as they happen. Read only.", "Foxglove、PlotJuggler 等（'handscope help share'）：实时显示记录的话题。它们只能查看。";
    VIEWERS_AT: "Address for viewers", "查看地址";
    SHOW: "Show", "显示", "Serves viewers at this address.", "在此地址提供实时查看。";
    VIEWERS_NOW: "Viewers now: {}", "查看者：{}";
    PAD: "Gamepad", "手柄", "A gamepad moves the hand while its button is held. Try it here first: nothing moves until you let it.", "按住手柄上的运行键时由手柄控制。可先在此试用：未经允许不会移动灵巧手。";
    DRY_RUN: "Its target for the hand, while held to run:", "按住运行键时，手柄所指的姿态：";
    DISARM_IDLE: "Disarm after five minutes without a command", "五分钟无指令时自动解除使能", "An armed hand is disarmed after five minutes without a command. It keeps its pose.", "已使能的灵巧手五分钟内未收到指令时自动解除使能，姿态保持不变。";
    IDLE_DISARMED: "Disarmed: no command for five minutes.", "已解除使能：五分钟内没有指令。";
    HOLD_TO_RUN: "Hold to run (H key)", "按住运行（H 键）", "Whoever moves the hand: it moves only while H is held here. Let go, or in another window, it stops at once.", "无论由谁控制：只有在此按住 H 键时灵巧手才会运动。松开或切换窗口即停。";
    SHARED: "Shared", "共享中", "Others can reach this hand: press to see who, and to end it.", "其他程序可以访问此灵巧手：点击查看或结束。";
    LISTENING: "Listening", "接收中";
    READ_PAD: "Read gamepad", "读取手柄", "Looks for a gamepad on this computer.", "在本机上查找手柄。";
    PLUG_IN: "No gamepad: plug one in, or pair it with this computer.", "没有手柄：请插入或与本机配对。";
    PAD_OFF: "Plug a gamepad in or pair it, then switch this on.", "请插入或配对手柄，然后打开。";
    PAD_CHANGE: "Click a control to change what it does.", "点击控件可更改其动作。";
    FOLLOW_NOW: "{} counts ahead of the joints, {} ms from input to wire (99 %)", "领先实际角度 {}，输入到线路 {} ms（99 %）";
    LIMITS: "Limits for external control:", "外部控制的限制：";
    LEAD: "Lead at most", "最大领先量", "Counts of 1000 that a target may be ahead of its joint:", "目标最多领先实际角度的量（满程 1000）：";
    FOLLOW_RATE: "Speed at most", "最大速度", "How fast a target may go, counts of 1000 a second:", "目标每秒最多变化的量（满程 1000）：";
    OTHER_FOLLOWS: "At {}, {} follows this sender already: one sender must not move two hands.", "{} 上的 {} 已在跟随此来源：一个来源不可同时控制两只手。";
    NONE: "No gamepad", "没有手柄";
    POSE: "Pose {}", "姿态：{}";
    NO_POSE: "Pose {} (not in the library)", "姿态：{}（库中没有）";
    SINGLE: "One control must do this. Choose it at another control: the two change places.", "必须有一个控件执行此动作。请在另一个控件上选择它，两者会互换。";
    CHANGE: "Click to change what it does.", "点击可更改其动作。";

    /// State of following an input.
    fn phase(FollowPhase) {
        FollowPhase::Waiting => "arming", "使能中";
        FollowPhase::Following => "follows", "跟随中";
        FollowPhase::Frozen => "tracking frozen?", "追踪已停止？";
        FollowPhase::Holding => "holds", "保持中";
        FollowPhase::Silent => "silent: held", "无数据：已保持";
        FollowPhase::Released => "not held to run", "未按住运行键";
    }

    /// Reason why a line was refused.
    fn fault(StreamLineFault) {
        StreamLineFault::TooLong => "Refused: too long", "拒绝：过长";
        StreamLineFault::NotFinite => "Refused: NaN or infinite", "拒绝：NaN 或无穷大";
        StreamLineFault::Malformed => "Refused: not such a line", "拒绝：格式错误";
        StreamLineFault::Type => "Refused: a field of another type", "拒绝：字段类型错误";
        StreamLineFault::Twice => "Refused: a field twice", "拒绝：字段重复";
        StreamLineFault::Version => "Refused: another version", "拒绝：版本不同";
        StreamLineFault::OtherSide => "Refused: other side", "拒绝：另一侧的手";
        StreamLineFault::Length => "Refused: not six values", "拒绝：不是六个数值";
        StreamLineFault::Range => "Refused: not 0 to 1", "拒绝：超出 0 至 1";
        StreamLineFault::Gap => "Refused: gap not 3 to 120 mm", "拒绝：间距超出 3 至 120 mm";
        StreamLineFault::Both => "Refused: gap and values", "拒绝：同时给出间距与数值";
        StreamLineFault::Forces => "Refused: no room between the forces of a hold", "拒绝：保持的两个力没有余地";
        StreamLineFault::AboveLimit => "Refused: more force than is set here", "拒绝：力高于此处设置";
        StreamLineFault::Late => "Refused: late", "拒绝：迟到";
        StreamLineFault::OtherSender => "Refused: another sender", "拒绝：其他来源";
    }

    /// Reason why a command over DDS was refused.
    fn ctrl_fault(CtrlFault) {
        CtrlFault::Malformed => "Refused: not a message of its topic's type.", "拒绝：消息不符合话题的类型。";
        CtrlFault::Mode => "Refused: mode bits that do not exist.", "拒绝：模式位不存在。";
        CtrlFault::Position => "Refused: it sets positions of drives (mode 2).", "拒绝：设置了驱动位置（模式 2）。";
        CtrlFault::Length => "Refused: not six values.", "拒绝：不是六个数值。";
        CtrlFault::Range => "Refused: a value outside the range of the register or the joint.", "拒绝：数值超出寄存器或关节的范围。";
        CtrlFault::Motors => "Refused: not the twelve motors of two hands.", "拒绝：不是双手的十二个电机。";
        CtrlFault::Unpaired => "Refused: not one position for each named joint.", "拒绝：关节名称与位置的数量不一致。";
        CtrlFault::UnknownJoint => "Refused: it names other joints, one twice, or no driven one.", "拒绝：关节名称未知、重复，或没有主动关节。";
        CtrlFault::Points => "Refused: several points. Send each when it is due.", "拒绝：轨迹有多个点，请逐点按时发送。";
        CtrlFault::Timing => "Refused: its point is not due within 200 ms.", "拒绝：轨迹点不在 200 ms 之内。";
        CtrlFault::AboveLimit => "Refused: faster or firmer than is set here.", "拒绝：速度或力高于此处设置。";
        CtrlFault::OtherSender => "Refused: another sender is followed.", "拒绝：正在跟随其他来源。";
    }

    /// Name of a control.
    fn control(PadControl) {
        PadControl::South => "A (bottom)", "A（下）";
        PadControl::East => "B (right)", "B（右）";
        PadControl::West => "X (left)", "X（左）";
        PadControl::North => "Y (top)", "Y（上）";
        PadControl::LeftBumper => "Left bumper", "左肩键";
        PadControl::RightBumper => "Right bumper", "右肩键";
        PadControl::LeftTrigger => "Left trigger", "左扳机";
        PadControl::RightTrigger => "Right trigger", "右扳机";
        PadControl::LeftStick => "Left stick", "左摇杆";
        PadControl::RightStick => "Right stick", "右摇杆";
        PadControl::LeftStickPress => "Left stick, pressed", "按下左摇杆";
        PadControl::RightStickPress => "Right stick, pressed", "按下右摇杆";
        PadControl::DpadUp => "Cross up", "十字键上";
        PadControl::DpadDown => "Cross down", "十字键下";
        PadControl::DpadLeft => "Cross left", "十字键左";
        PadControl::DpadRight => "Cross right", "十字键右";
        PadControl::Select => "Back", "返回键";
        PadControl::Start => "Start", "开始键";
        PadControl::Home => "Home", "主页键";
    }

    /// Action of a control. A pose includes its name.
    fn action(&PadAction) {
        PadAction::Nothing => "Nothing", "无";
        PadAction::DeadMan => "Hold to run", "按住运行", "The dead-man: the hand follows while it is held, and stops when released.", "按住时灵巧手跟随手柄；松开即停。";
        PadAction::Stop => "STOP", "停止", "Stops the hand, with or without the button that is held to run. It is not an emergency stop.", "立即停下灵巧手，无论是否按住运行键。这不是急停。";
        PadAction::Pose(_) => "Pose {}", "姿态：{}", "The hand goes to this pose while the button is held.", "按住时灵巧手摆出该姿态。";
        PadAction::CloseFingers => "Close fingers", "弯曲手指", "By amount: let go is open, pressed is bent.", "按行程控制：松开为张开，按到底为弯曲。";
        PadAction::BendThumb => "Bend thumb", "弯曲大拇指", "By amount: let go is open, pressed is bent.", "按行程控制：松开为张开，按到底为弯曲。";
        PadAction::CloseGap => "Close to a gap", "按间距捏合", "By amount: let go is 120 mm between the pads of thumb and index, pressed is 3 mm. Other triggers and sticks are ignored then.", "按行程控制：松开为大拇指与食指指腹相距 120 mm，按到底为 3 mm。此时其他扳机与摇杆不起作用。";
        PadAction::RotateThumb => "Rotate thumb", "旋转大拇指", "Left and right push the thumb while it is held; let go, the thumb stays.", "左右推动时旋转大拇指；松开后大拇指保持不动。";
        PadAction::ChooseFingers => "Choose fingers", "选择手指", "At rest all four. Left, up, right and down choose index, middle, ring and little finger.", "居中时为四指；向左、上、右、下分别选择食指、中指、无名指、小拇指。";
    }
}
