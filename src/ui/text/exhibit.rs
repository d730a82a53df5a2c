//! Sentences of an exhibition: for visitors, readable from two metres, and for staff.

use crate::exhibit::stage::HaltReason;
use crate::ui::style::phrase::texts;

texts! {
    ENTER: "Exhibition", "展示模式", "Shows the page for visitors over the whole screen. Nothing moves before you arm on it; leaving needs a PIN.", "全屏显示观众页面。在该页面上使能之前不会有任何动作；退出需要 PIN 码。";
    START: "Start the exhibition", "开始展示";
    ENTER_FILE: "Exhibition from a file...", "从文件打开展示...", "The same with the tiles, limits and times of a file.", "使用文件中的图块、限制和时间。";

    TITLE: "Touch a tile: the hand does it", "点一下，灵巧手就动";
    STOP_NOTE: "The hand stops at once", "灵巧手立即停下";
    FEELS: "What the fingertips feel", "指尖的感觉";
    SLOW: "Warm: moving slowly", "温度偏高：慢速动作";
    PLAY_TIME: "Play time left", "剩余时间";

    MOMENT: "One moment, please", "请稍候";
    HOLD: "Hold a tile for 2 seconds to start again", "按住一个图块 2 秒即可重新开始";
    IDLE: "Touch a tile", "请点一个图块";
    IDLE_NOTE: "The hand does what is drawn on it.", "灵巧手会做出图中的动作。";
    ATTRACT: "Touch anywhere to play", "点击任意位置开始";
    ATTRACT_NOTE: "The hand shows what it can do.", "灵巧手正在演示。";
    VISIT: "Your turn", "请尽情体验";
    VISIT_NOTE: "Touch another tile at any time.", "随时可以点其他图块。";
    GIVE: "Put something into the hand", "请把物体放进手中";
    GIVE_NOTE: "It closes slowly and holds it. Then pull!", "它会缓慢合拢并握住物体，然后请试着拔出来！";
    HELD: "It holds with {} g: pull!", "正以 {} g 的力握着：拔拔看！";
    HELD_NOTE: "The fingertips feel the pull and press harder.", "指尖感觉到拉力时会加力。";
    HELD_TIGHTENED: "Pressed harder {} times, last: {}", "加力 {} 次，最近：{}";
    HELD_SHORT: "It may not press harder", "已达到允许的最大力";
    NEXT: "Thank you! Next, please", "谢谢！请下一位";
    NEXT_NOTE: "The hand opens and rests for a moment.", "灵巧手张开，稍作休息。";
    COOLING: "The hand is cooling: about {} min", "灵巧手正在降温：约 {} 分钟";
    COOLING_NOTE: "It rests open, and goes on by itself.", "它张开休息，之后会自动继续。";
    HEAT_UNKNOWN: "One moment: the temperature is not known", "请稍候：温度未知";
    HEAT_UNKNOWN_NOTE: "Staff: if it persists, check the connection.", "工作人员：若持续如此，请检查连接。";
    CLEARING: "One moment: the hand frees itself", "请稍候：灵巧手正在恢复";
    CLEARING_NOTE: "It opens, and goes on by itself.", "它会张开，然后自动继续。";

    STAFF: "Staff", "工作人员";
    STAFF_BUTTON: "Staff: unlock", "工作人员：解锁";
    PIN_ASK: "Staff PIN", "工作人员 PIN 码";
    PIN_CHOOSE: "Choose a PIN: 4 to 8 digits", "设置 PIN 码：4 到 8 位数字";
    PIN_CHOOSE_NOTE: "It is asked for to arm and to leave.", "使能和退出时需要输入。";
    PIN_AGAIN: "Type the PIN once more", "请再次输入 PIN 码";
    PIN_REFUSED: "Not the same, or not 4 to 8 digits. Begin again.", "两次不一致，或不是 4 到 8 位数字。请重新设置。";
    PIN_WRONG: "Wrong PIN. Tries left: {}", "PIN 码错误，还可尝试 {} 次";
    PIN_LOCKED: "Too many wrong PINs. Wait {} s.", "错误次数过多，请等待 {} 秒。";
    PIN_TYPED: "Digits typed", "已输入位数";
    PIN_DELETE: "Delete", "删除";
    PIN_ENTER: "Enter", "确认";
    CANCEL: "Cancel", "取消";
    CLOSE: "Close", "关闭";

    ARM: "Arm", "使能";
    ARM_NOTE: "The hand will open", "灵巧手将张开";
    ARM_NO_HAND: "No hand answers.", "没有灵巧手应答。";
    DISARM: "Disarm", "取消使能";
    DISARM_NOTHING: "It is not armed.", "尚未使能。";
    LEAVE: "Leave the exhibition", "退出展示模式";
    TODAY: "Today", "今日";
    VISITS: "Visitors", "观众";
    PIECES: "Pieces played", "播放次数";
    RESTS: "Rests for heat", "降温休息";
    FAULTS: "Faults", "故障";
    STOPS: "STOP pressed", "按下停止";

    /// Instructions to staff before the hand moves again.
    fn halted(HaltReason) {
        HaltReason::NotArmed => "Staff: check that nobody is near the hand, then unlock and arm.", "工作人员：确认无人靠近灵巧手后，解锁并使能。";
        HaltReason::NoHand => "Staff: the hand does not answer. Check its power and its cable.", "工作人员：灵巧手没有应答。请检查电源和线缆。";
        HaltReason::LinkLost => "Staff: the hand was away and is back. Check it, then unlock and arm.", "工作人员：灵巧手曾断开，现已恢复。检查后解锁并使能。";
        HaltReason::NoFeedback => "Staff: feedback of the hand is stale or frozen. Check its power and its cable, then unlock and arm.", "工作人员：灵巧手的反馈过时或毫无变化。检查电源和线缆后，解锁并使能。";
        HaltReason::Stopped => "Staff: STOP was pressed. See that all is well, then unlock and arm.", "工作人员：有人按下了停止。确认一切正常后，解锁并使能。";
        HaltReason::Fault => "Staff: a drive reports a fault. Check the hand, then unlock and arm.", "工作人员：驱动器报告故障。检查灵巧手后，解锁并使能。";
        HaltReason::OtherController => "Staff: another program talks to the hand. Close it, then unlock and arm.", "工作人员：另有程序正在控制灵巧手。关闭后解锁并使能。";
        HaltReason::Slept => "Staff: this computer slept. Check the hand, then unlock and arm.", "工作人员：电脑曾进入睡眠。检查灵巧手后，解锁并使能。";
        HaltReason::NotShown => "Staff: this page was not shown for a while. Check the hand, then unlock and arm.", "工作人员：此页面曾一段时间未能显示。检查灵巧手后，解锁并使能。";
    }
}
