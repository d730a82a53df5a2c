//! Sentences of the list of keys.

use crate::ui::text::phrase::texts;

texts! {
    BUTTON: "Keys", "快捷键", "Shows what each key does.", "显示各个按键的作用。";
    CLOSE: "Close the list of keys", "关闭快捷键列表";
    ENTRY: "Fist; so each tile by its letter or digit", "握拳；其他图块按其字母或数字";
    STOP: "STOP, from everywhere", "停止（任何时候）";
    ARM: "Arm or disarm", "使能或取消使能";
    LINK: "Link the fingers", "四指联动";
    UNIT: "Unit of angles", "角度单位";
    UNDO_TARE: "Take taring back", "撤销去皮";
    NOTE: "Write a note", "写备注";
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
