//! Sentences about what a hand was found to do in its own way.

use crate::hand::register::BytePacking;
use crate::link::{GapRead, TouchDoubt, TouchVariant};
use crate::record::quirk_sheet::Fact;
use crate::ui::text::phrase::texts;

texts! {
    SHEET: "About this hand", "此手的特性";
    SEEN: "Seen", "连接日期";
    AS_FOUND: "as the hand shows", "自动识别";
    PACKING_UNKNOWN: "unknown: not written", "未知：不写入";
    CHOSEN: "as you chose", "手动";
    BAUD_NONE: "unknown", "未知";
    COPY: "Copy", "复制", "Copies this sheet as text, for a report or another computer.", "复制为文本。";
    COPY_OFF: "No hand has answered yet.", "灵巧手尚未应答。";
    OTHER_HAND: "This hand answered differently last time; it may be another hand.", "本手与上次应答不同，可能是另一只手。";
    NOT_KEPT: "What was found out about this hand could not be kept:", "本手识别结果无法写入：";

    /// What two sheets disagree about.
    fn fact(Fact) {
        Fact::HandId => "HAND_ID", "HAND_ID";
        Fact::BaudCode => "REDU_RATIO", "REDU_RATIO";
        Fact::Packing => "Modbus bytes", "Modbus 字节", "How this hand puts single bytes (SAVE, faults) into Modbus words. Choose only if it cannot be found out and its papers say so: a wrong choice writes to the wrong address.", "本手将单字节（SAVE、故障）放入 Modbus 字的方式。仅当无法识别且资料有说明时才手动选择：选错会写到错误的地址。";
        Fact::Gap => "Gap 1558..1581", "地址 1558..1581";
        Fact::Touch => "Fingertips", "指尖";
    }

    /// Its words.
    fn gap(GapRead) {
        GapRead::Through => "read through", "可读";
        GapRead::Split => "refused", "拒绝";
    }

    /// Its words.
    fn touch(TouchVariant) {
        TouchVariant::Capacitive => "capacitive", "电容式";
        TouchVariant::Resistive => "resistive: not decoded", "电阻式：本程序不支持";
        TouchVariant::Unknown(TouchDoubt::Empty) => "unknown: all zero", "未知：全为零";
        TouchVariant::Unknown(TouchDoubt::Force) => "unknown: impossible force", "未知：力值无效";
        TouchVariant::Unknown(TouchDoubt::Direction) => "unknown: impossible direction", "未知：方向无效";
        TouchVariant::Unknown(TouchDoubt::Check) => "unknown: check sum differs", "未知：校验不一致";
        TouchVariant::Unknown(TouchDoubt::Refused) => "unknown: not readable", "未知：无法读取";
    }

    /// Its words.
    fn packing(BytePacking) {
        BytePacking::LowFirst => "low first", "低字节在前";
        BytePacking::HighFirst => "high first", "高字节在前";
        BytePacking::OnePerWord => "one a word", "每字一字节";
    }
}
