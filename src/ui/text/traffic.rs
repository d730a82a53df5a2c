//! Sentences of the traffic view: kinds of frames, their errors, names of their bytes. Decides nothing.

use crate::app::settings::Language;
use crate::link::traffic::fields::FieldName;
use crate::link::traffic::frame::{Kind, Wrong};
use crate::ui::style::Look;
use crate::ui::style::phrase::texts;

texts! {
    SHOWN_OF: "of", "/";
    FRAMES: "frames", "条报文";
    PAUSE: "Pause", "暂停", "Freezes the list. Recording continues.", "列表停止更新，记录继续进行。";
    PAUSED: "Paused", "已暂停", "Freezes the list. Recording continues.", "列表停止更新，记录继续进行。";
    PAUSE_NAME: "Pause the list", "暂停列表";
    CAME_SINCE: "came since", "条新报文";
    FOLLOW: "Follow", "跟随", "Keeps the newest frame in sight.", "始终显示最新的报文。";
    FOLLOW_NAME: "Follow the newest", "跟随最新报文";
    CLEAR: "Clear", "清除", "Clears the list. New frames appear as they pass.", "清空列表，之后的报文会继续显示。";
    CLEAR_NAME: "Clear the list", "清除列表";
    COPY: "Copy hex", "复制十六进制", "Puts the bytes of the chosen frames on the clipboard, one frame a line. Ctrl+C does the same.", "将所选报文的字节复制到剪贴板，每条一行。Ctrl+C 作用相同。";
    COPY_AS: "Copy as", "复制为";
    COPY_NONE: "No frame is chosen.", "没有选择报文。";
    EXPORT_CSV: "Export CSV", "导出 CSV", "Writes the frames that the list shows to a file.", "将列表中显示的报文写入文件。";
    EXPORT_JSON: "Export JSON", "导出 JSON", "Writes the frames that the list shows to a file.", "将列表中显示的报文写入文件。";
    EXPORT_NONE: "The list is empty.", "列表为空。";
    FILTER: "Filter", "筛选", "name or hex bytes", "名称或十六进制字节";
    WAY_ALL: "Both ways", "双向";
    WAY_OUT: "To hand", "发往手";
    WAY_IN: "From hand", "来自手";
    WAY_TIP: "Which way frames went.", "报文的方向。";
    WRONG_ONLY: "Only wrong", "仅异常", "Shows only frames with something wrong about them.", "只显示有异常的报文。";
    HIDE_POLLING: "Hide polling", "隐藏轮询", "Hides the regular reads and their good replies.", "隐藏定时读取及其正常应答。";
    EMPTY: "Nothing has passed over the wire yet.", "线路上还没有报文。";
    EMPTY_LINK: "Nothing is connected. Frames appear here as soon as a wire is open.", "当前没有连接。线路打开后，报文会显示在这里。";
    EMPTY_FILTER: "No frame passes the filter.", "没有符合筛选条件的报文。";
    HEAD_TIME: "Time, s", "时间 s";
    HEAD_KIND: "Kind", "类型";
    HEAD_MEANING: "Meaning", "含义";
    HEAD_BYTES: "Bytes", "字节";
    DETAIL: "Frame", "报文";
    DETAIL_HINT: "Choose a frame to see the meaning of its bytes.", "选择一条报文，查看每个字节的含义。";
    DETAIL_MANY: "frames chosen", "条报文已选";
    TOOK: "answered within", "应答用时";
    ALL_WELL: "Nothing wrong", "正常";

    /// Kind of a frame, in a word.
    fn kind(Kind) {
        Kind::Opened => "Wire opened", "线路打开";
        Kind::Closed => "Wire closed", "线路关闭";
        Kind::Broken => "Wire broke", "线路断开";
        Kind::Gap => "Not kept", "未保留";
        Kind::Read => "Read", "读取";
        Kind::ReadReply => "Values", "数值";
        Kind::Write => "Write", "写入";
        Kind::WriteReply => "Taken", "确认";
        Kind::Refusal => "Refused", "拒绝";
        Kind::SaveResult => "Save result", "保存结果";
        Kind::Adapter => "To adapter", "适配器命令";
        Kind::AdapterReply => "Adapter", "适配器";
        Kind::Noise => "No frame", "非报文";
    }

    /// Name of a frame's field, in a word.
    fn field(FieldName) {
        FieldName::Header => "Header", "帧头";
        FieldName::Id => "Hand id", "灵巧手 ID";
        FieldName::Unit => "Unit id", "单元标识符";
        FieldName::Length => "Length", "长度";
        FieldName::Command => "Command", "命令";
        FieldName::Function => "Function", "功能码";
        FieldName::Address => "Address", "地址";
        FieldName::Wanted => "Bytes wanted", "读取字节数";
        FieldName::Words => "Words", "字数";
        FieldName::Data => "Data", "数据";
        FieldName::Acknowledge => "Acknowledgement", "确认";
        FieldName::Code => "Code", "异常码";
        FieldName::Checksum => "Checksum", "校验和";
        FieldName::Crc => "CRC", "CRC";
        FieldName::Transaction => "Transaction", "事务编号";
        FieldName::Protocol => "Protocol", "协议";
        FieldName::CanId => "Identifier", "标识符";
        FieldName::Filler => "Filler", "填充";
        FieldName::FrameKind => "Kind of frame", "帧类型";
        FieldName::Tail => "Tail", "帧尾";
        FieldName::Text => "Text", "文本";
        FieldName::Unknown => "Unknown", "未知";
    }
}

/// Error of a frame, in a short sentence.
pub(crate) fn wrong(look: Look, wrong: Wrong) -> String {
    if look.language == Language::En {
        let text = wrong.to_string();
        let mut signs = text.chars();
        let first = signs.next().map(|sign| sign.to_ascii_uppercase());
        return first.into_iter().chain(signs).collect();
    }
    match wrong {
        Wrong::Checksum { got, want } => format!("校验和为 {got:02X}，应为 {want:02X}"),
        Wrong::Crc { got, want } => format!("CRC 为 {got:04X}，应为 {want:04X}"),
        Wrong::CutOff { got, want: None } => format!("不完整：{got} 字节"),
        Wrong::CutOff {
            got,
            want: Some(want),
        } => format!("不完整：{got} 字节，应为 {want} 字节"),
        Wrong::BadHead { len, .. } => format!("帧头之后的长度 {len} 或命令无效"),
        Wrong::NoFrame { len } => format!("{len} 字节不是报文"),
        Wrong::Protocol { got } => format!("协议标识 {got}，应为 0：对方不是 Modbus TCP"),
        Wrong::LengthField { got } => format!("长度字段 {got}，应为 2 至 254"),
        Wrong::Function { function } => format!("未知功能码 {function} 或长度不符"),
        Wrong::ForeignId { got, want } => format!("ID 为 {got}，当前灵巧手为 {want}"),
        Wrong::ForeignCanId { id } => format!("标识符 {id:08X} 不属于灵巧手"),
        Wrong::Echo => "收到请求：回显，或总线上有其他程序".into(),
        Wrong::Backwards => "发出了应答".into(),
        Wrong::NotAsked => "没有对应的请求".into(),
        Wrong::Late { after_ms } => format!("迟到：请求在 {after_ms} ms 前发出，已放弃"),
        Wrong::Amount { got, want } => format!("应答 {got} 字节，请求 {want} 字节"),
        Wrong::Address { got, want } => format!("地址 {got}，请求的是 {want}"),
        Wrong::Transaction { got, want } => format!("事务编号 {got}，等待的是 {want}"),
        Wrong::Refused { code } => format!("拒绝，异常码 {code}"),
        Wrong::NotTaken { value } => format!("未确认：{value}，应为 1"),
        Wrong::NotSaved { value } => format!("保存失败：{value:02X}"),
        Wrong::NoReply => "没有应答".into(),
        Wrong::Line => "不是串口 CAN 适配器的文本".into(),
        Wrong::AdapterFailed => "适配器无法执行".into(),
        Wrong::BusOff => "总线关闭：控制器已离开总线".into(),
        Wrong::ErrorPassive => "错误被动：控制器遇到大量错误".into(),
        Wrong::Forgotten { pieces } => format!("之前的 {pieces} 段数据已不再保留"),
    }
}
