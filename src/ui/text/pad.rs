//! Sentences of a gamepad: its controls and what they do.

use crate::inputs::pad::{PadAction, PadControl};
use crate::ui::text::phrase::texts;

texts! {
    NONE: "No gamepad", "没有手柄";
    POSE: "Pose {}", "姿态：{}";
    SINGLE: "One control must do this. Choose it at another control: the two change places.", "必须有一个控件执行此动作。请在另一个控件上选择它，两者会互换。";
    CHANGE: "Click to change what it does.", "点击可更改其动作。";

    /// What a control is called.
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

    /// What a control does. A pose has its name in it.
    fn action(&PadAction) {
        PadAction::Nothing => "Nothing", "无";
        PadAction::DeadMan => "Hold to run", "按住运行", "The dead-man: the hand follows while it is held, and stops when it is let go.", "按住时灵巧手跟随手柄；松开即停。";
        PadAction::Stop => "STOP", "停止", "Stops the hand, with or without the button that is held to run. It is not an emergency stop.", "立即停下灵巧手，无论是否按住运行键。这不是急停。";
        PadAction::Pose(_) => "Pose {}", "姿态：{}", "The hand goes to this pose while the button is held.", "按住时灵巧手摆出该姿态。";
        PadAction::CloseFingers => "Close fingers", "弯曲手指", "By amount: let go is open, pressed is bent.", "按行程控制：松开为张开，按到底为弯曲。";
        PadAction::BendThumb => "Bend thumb", "弯曲拇指", "By amount: let go is open, pressed is bent.", "按行程控制：松开为张开，按到底为弯曲。";
        PadAction::RotateThumb => "Rotate thumb", "旋转拇指", "Left and right push the thumb as long as it is held; let go, the thumb stays.", "左右推动时旋转拇指；松开后拇指保持不动。";
        PadAction::ChooseFingers => "Choose fingers", "选择手指", "At rest all four. Left, up, right and down choose index, middle, ring and little finger.", "居中时为四指；向左、上、右、下分别选择食指、中指、无名指、小拇指。";
    }
}
