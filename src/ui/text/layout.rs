//! Sentences of the borders between the rooms, and of the window's menu.

use crate::ui::text::phrase::texts;

texts! {
    MENU: "Window menu", "窗口菜单";
    MENU_TIP: "Rooms of the window: shut, open, put back.", "窗口各区域：收起、展开、恢复。";
    RESET: "Reset layout", "恢复默认布局";
    RESET_TIP: "All rooms open, all borders where they were at first. Nothing moves on the hand.", "展开所有区域，边界恢复到初始位置。灵巧手不会动作。";
    BORDER: "Border", "边界";
    BORDER_TIP: "Drag to resize, double click for the first size.", "拖动可调整大小，双击恢复初始大小。";
    SHUT: "Collapse", "收起";
    SHUT_TIP: "Leaves only a slim rest of this room.", "将此区域收起为窄条。";
    OPEN: "Expand", "展开";
    OPEN_TIP: "Shows this room again.", "重新显示此区域。";
    SIDE: "Fingertips and faults", "指尖与故障";
    ARM_FIRST: "Press Arm to move", "先点击“使能”再操作";
}
