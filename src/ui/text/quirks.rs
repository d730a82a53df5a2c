//! Sentences about what a hand was found to do in its own way.

use crate::hand::register::BytePacking;
use crate::link::{GapRead, TouchDoubt, TouchVariant};
use crate::record::quirk_sheet::Fact;
use crate::ui::text::phrase::{Text, texts};

texts! {
    SHEET: "About this hand", "此手的特性";
    HAND_ID: "HAND_ID", "HAND_ID";
    BAUD_CODE: "REDU_RATIO", "REDU_RATIO";
    PACKING: "Modbus bytes", "Modbus 字节";
    GAP: "Gap 1558..1581", "地址 1558..1581";
    TOUCH: "Fingertips", "指尖";
    SEEN: "Seen", "连接日期";
    PACKING_TIP: "How this hand puts single bytes (SAVE, faults) into Modbus words. Choose only if it cannot be found out and its papers say so: a wrong choice writes to the wrong address.", "本手将单字节（SAVE、故障）放入 Modbus 字的方式。仅当无法识别且资料有说明时才手动选择：选错会写到错误的地址。";
    AS_FOUND: "as the hand shows", "自动识别";
    PACKING_UNKNOWN: "unknown: not written", "未知：不写入";
    LOW: "low first", "低字节在前";
    HIGH: "high first", "高字节在前";
    ONE: "one a word", "每字一字节";
    CHOSEN: "as you chose", "手动";
    THROUGH: "read through", "可读";
    SPLIT: "refused", "拒绝";
    CAPACITIVE: "capacitive", "电容式";
    RESISTIVE: "resistive: not decoded", "电阻式：本程序不支持";
    EMPTY: "unknown: all zero", "未知：全为零";
    FORCE: "unknown: impossible force", "未知：力值无效";
    DIRECTION: "unknown: impossible direction", "未知：方向无效";
    CHECK: "unknown: check sum differs", "未知：校验不一致";
    REFUSED: "unknown: not readable", "未知：无法读取";
    BAUD_NONE: "unknown", "未知";
    COPY: "Copy", "复制";
    COPY_TIP: "Copies this sheet as text, for a report or another computer.", "复制为文本。";
    COPY_OFF: "No hand has answered yet.", "灵巧手尚未应答。";
    OTHER_HAND: "This hand answered differently last time; it may be another hand.", "本手与上次应答不同，可能是另一只手。";
    NOT_KEPT: "What was found out about this hand could not be kept:", "本手识别结果无法写入：";
}

/// What two sheets disagree about.
pub(crate) const fn fact(fact: Fact) -> Text {
    match fact {
        Fact::HandId => HAND_ID,
        Fact::BaudCode => BAUD_CODE,
        Fact::Packing => PACKING,
        Fact::Gap => GAP,
        Fact::Touch => TOUCH,
    }
}

pub(crate) const fn packing(packing: BytePacking) -> Text {
    match packing {
        BytePacking::LowFirst => LOW,
        BytePacking::HighFirst => HIGH,
        BytePacking::OnePerWord => ONE,
    }
}

pub(crate) const fn gap(gap: GapRead) -> Text {
    match gap {
        GapRead::Through => THROUGH,
        GapRead::Split => SPLIT,
    }
}

pub(crate) const fn touch(touch: TouchVariant) -> Text {
    match touch {
        TouchVariant::Capacitive => CAPACITIVE,
        TouchVariant::Resistive => RESISTIVE,
        TouchVariant::Unknown(TouchDoubt::Empty) => EMPTY,
        TouchVariant::Unknown(TouchDoubt::Force) => FORCE,
        TouchVariant::Unknown(TouchDoubt::Direction) => DIRECTION,
        TouchVariant::Unknown(TouchDoubt::Check) => CHECK,
        TouchVariant::Unknown(TouchDoubt::Refused) => REFUSED,
    }
}
