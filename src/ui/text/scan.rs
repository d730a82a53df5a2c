//! Sentences of scanning for hands. Decides nothing.

use crate::app::scan::{IdRange, ScanStage, ScanState, ScanTarget};
use crate::hand::register::BytePacking;
use crate::link::scan::ScanEvent;
use crate::link::{Owner, TouchDoubt, TouchVariant};
use crate::record::quirk_sheet::Fact;
use crate::transport::Endpoint;
use crate::ui::style::phrase::{Text, texts};
use crate::ui::style::{Look, format};
use crate::ui::text::{errors, panels, words};

texts! {
    HANDS: "Hands", "灵巧手";
    WAYS: "Ways to connect", "连接方式";
    ADDRESS: "Address, port or name", "地址、端口或名称";
    EXAMPLES: "For example 192.168.11.210, /dev/ttyUSB0, COM3, can0 or sim:", "例如 192.168.11.210、/dev/ttyUSB0、COM3、can0 或 sim:";
    CHANGE: "Change", "更改", "Shows speed, id, unit and the like.", "显示波特率、ID、单元等设置。";
    CHANGE_NONE: "Type an address first.", "请先输入地址。";
    INSTEAD: "{} instead", "改用 {}", "A port does not tell which protocol is spoken on it.", "端口不会说明使用哪种协议。";
    RANGE: "A range of addresses can be scanned, not connected to.", "网段只能扫描，不能连接。";
    WITH_BAUD: "{}, {} baud, id {}", "{}，波特率 {}，ID {}";
    WITH_BITRATE: "{}, {} bit/s, id {}", "{}，{} bit/s，ID {}";
    WITH_UNIT: "{}, port {}, unit {}", "{}，端口 {}，单元 {}";
    WITH_ID: "{}, id {}", "{}，ID {}";
    PLUGGED_IN: "now plugged in", "已插入";
    ANSWERED: "answered the scan", "扫描时有应答";
    LAST_USED: "last used {}", "上次使用：{}";
    FIND: "Find hands", "查找灵巧手", "Queries all serial ports and CAN interfaces, at all speeds, in all protocols, and listens for hands that other Handscopes share at the network interface beside it. It only reads, and tries no address in the network that you do not name.\nOpening a port resets some other devices, such as boards with an Arduino bootloader.", "在所有串口与 CAN 接口上，以各种波特率与协议查询。只读取，不写入，也不会尝试未指定的网络地址；同时在旁边的网络接口上查找其他 Handscope 共享的灵巧手。\n打开串口可能使某些其他设备复位，例如带 Arduino 引导程序的开发板。";
    CANCEL: "Cancel", "取消", "Ends the scan. What was found stays.", "结束扫描，保留已找到的结果。";
    RUNNING: "A scan is under way.", "正在扫描。";
    IDS: "Ids", "ID", "Ids queried on every bus. All of them take about two minutes a port.", "在每条总线上查询的 ID。全部 ID 每个端口约需两分钟。";
    IDS_FEW: "1 to 10", "1 至 10";
    IDS_ALL: "1 to 254", "1 至 254";
    PRESETS: "Hands on the network often have", "网络灵巧手常用地址：";
    PRESET_MAKER: "As delivered", "出厂地址";
    PRESET_FIELD: "Seen on some hands", "部分灵巧手使用";
    PRESET_TIP: "Puts this address into the field. Nothing is sent before you press a button.", "将此地址填入输入框。点击按钮之前不会发送任何内容。";
    NEVER: "Nothing was scanned yet.", "尚未扫描。";
    PROGRESS: "Scan progress", "扫描进度";
    ASKED: "questions", "次查询";
    TIME_LEFT: "time left about", "约剩";
    LISTING: "Looking for ports", "正在查找端口";
    FOUND: "Hands that answered: {}", "有应答的灵巧手：{} 只";
    NO_PLACES: "There is nothing to scan: this computer has no serial port and no CAN interface. Plug the adapter in, or scan an address.", "没有可扫描的端口：本机没有串口，也没有 CAN 接口。请插入适配器，或扫描地址。";
    NOTHING: "No hand answered. Check power and cable; a hand may have an id above 10.", "没有灵巧手应答。请检查电源与线缆；ID 也可能大于 10。";
    NOTHING_THERE: "No hand answered. Check power, cable and address; this computer needs an address in the same network.", "没有灵巧手应答。请检查电源、线缆与地址；本机需要同一网段的地址。";
    NOTHING_AT_ALL: "No hand answered to any id. Check power, cable and wiring.", "所有 ID 均无应答。请检查电源、线缆与接线。";
    NOWHERE: "Nothing could be scanned:", "无法扫描：";
    CANCELLED: "Cancelled.", "已取消。";
    CONNECTED: "Connected", "已连接", "The current hand.", "当前连接的灵巧手。";
    HELD: "skipped, the current connection uses it. Disconnect first to scan it.", "已跳过，当前连接正在使用。请先断开再扫描。";
    MORE: "more", "更多";
    AS_FOUND: "as the hand shows", "自动识别";
    PACKING_UNKNOWN: "unknown: not written", "未知：不写入";
    SHARED: "Shared at", "共享接口", "Hands that other Handscopes share: there, under Share, with DDS joined and the gateway open. To watch one costs its link nothing; to move it, ask for control there.", "其他 Handscope 共享的灵巧手：需在对方的“共享”中加入 DDS 并打开网关。观看不占用对方链路；控制需由对方的人允许。";
    SHARED_STOP: "Stop looking", "停止查找", "Leaves DDS; the list is cleared.", "退出 DDS，并清空列表。";
    SHARED_NONE: "No hand is shared at this interface.", "此接口上没有共享的灵巧手。";
    SHARED_UNREACHABLE: "Its gateway is closed, or not open to this network.", "对方的网关未打开，或未对此网络开放。";
    SHARED_OWN: "This window shares it itself.", "由本窗口共享。";
    NOBODY_MOVES: "nobody moves it", "无人控制";
    FIRST_MOVES: "whoever writes first may move it", "先写入者可控制";
    OTHER_HAND: "This hand answered differently last time; it may be another hand.", "本手与上次应答不同，可能是另一只手。";

    /// Fact on which two sheets disagree.
    fn fact(Fact) {
        Fact::HandId => "HAND_ID", "HAND_ID";
        Fact::BaudCode => "REDU_RATIO", "REDU_RATIO";
        Fact::Packing => "Modbus bytes", "Modbus 字节", "How this hand puts single bytes (SAVE, faults) into Modbus words. Choose only if it cannot be found out and its papers say so: a wrong choice writes to the wrong address.", "本手将单字节（SAVE、故障）放入 Modbus 字的方式。仅当无法识别且资料有说明时才手动选择：选错会写到错误的地址。";
        Fact::Gap => "Gap 1558..1581", "地址 1558..1581";
        Fact::Touch => "Fingertips", "指尖";
    }


    /// Name of a touch variant.
    fn touch(TouchVariant) {
        TouchVariant::Capacitive => "capacitive", "电容式";
        TouchVariant::Resistive => "resistive: not decoded", "电阻式：本程序不支持";
        TouchVariant::Unknown(TouchDoubt::Empty) => "unknown: all zero", "未知：全为零";
        TouchVariant::Unknown(TouchDoubt::Force) => "unknown: impossible force", "未知：力值无效";
        TouchVariant::Unknown(TouchDoubt::Direction) => "unknown: impossible direction", "未知：方向无效";
        TouchVariant::Unknown(TouchDoubt::Check) => "unknown: check sum differs", "未知：校验不一致";
        TouchVariant::Unknown(TouchDoubt::Refused) => "unknown: not readable", "未知：无法读取";
    }

    /// Name of a byte packing.
    fn packing(BytePacking) {
        BytePacking::LowFirst => "low first", "低字节在前";
        BytePacking::HighFirst => "high first", "高字节在前";
        BytePacking::OnePerWord => "one a word", "每字一字节";
    }
}

/// Controller of a hand that another Handscope shares.
pub(crate) fn mover(look: Look, owner: Owner) -> String {
    const THERE: Text = Text::new("moved by a user there", "由对方的人控制");
    const MOVED: Text = Text::new("moved by: {}", "控制者：{}");
    match owner {
        Owner::Person | Owner::Task => look.tr(THERE).into(),
        owner => look.fill(MOVED, &[&words::owner(look, owner)]),
    }
}

/// Remark of a scan, as a sentence; empty for its results.
pub(crate) fn remark(look: Look, remark: &ScanEvent) -> String {
    match remark {
        ScanEvent::Held { place } => look.pair(place, look.tr(HELD)),
        ScanEvent::Trouble { error, .. } => errors::transport(look, error),
        ScanEvent::Hint(hint) => errors::hint(look, hint),
        ScanEvent::Begun { .. } | ScanEvent::Found(_) | ScanEvent::Done(_) => String::new(),
    }
}

pub(crate) fn progress(look: Look, book: &ScanState) -> String {
    let progress = book.progress;
    if progress.total == 0 {
        return look.tr(LISTING).into();
    }
    // Never less than a second: almost finished is not worth a flicker.
    let left = progress.left.as_secs() + 1;
    format!(
        "{} / {} {}, {} {left} s",
        progress.tried,
        progress.total,
        look.tr(ASKED),
        look.tr(TIME_LEFT)
    )
}

/// Result of a scan, or the reason why there is none.
pub(crate) fn ended(look: Look, book: &ScanState) -> Result<String, Text> {
    let summary = match book.stage {
        ScanStage::Never | ScanStage::Running => return Err(NEVER),
        ScanStage::Cancelled if book.found.is_empty() => return Err(CANCELLED),
        ScanStage::Cancelled => {
            let found = look.fill(FOUND, &[&book.found.len()]);
            return Ok(look.tr_with(CANCELLED, found));
        }
        ScanStage::Done(summary) => summary,
    };
    if !book.found.is_empty() {
        let found = look.fill(FOUND, &[&book.found.len()]);
        return Ok(format!("{found}, {}", format::age(summary.took)));
    }
    Err(match &book.wish {
        _ if summary.places == 0 && !book.remarks.is_empty() => NOWHERE,
        _ if summary.places == 0 => NO_PLACES,
        Some(ScanTarget::Hosts(_)) => NOTHING_THERE,
        Some(ScanTarget::Ports(ids) | ScanTarget::Port(_, ids) | ScanTarget::Interface(_, ids))
            if *ids == IdRange::All =>
        {
            NOTHING_AT_ALL
        }
        Some(_) | None => NOTHING,
    })
}

/// Kind of a recognised address, with its settings and those that remain as delivered.
pub(crate) fn recognised(look: Look, endpoint: &Endpoint) -> String {
    let kind = look.tr(panels::kind(endpoint.kind()));
    match endpoint {
        Endpoint::Sim {
            scenario,
            body,
            object,
            ..
        } => {
            // An object takes the place of the one that the scenario is named after.
            let scenario = scenario.parse().ok().filter(|_| object.is_none());
            let scenario = scenario.map(|own| look.tr(panels::scenario(own)));
            let given = scenario.into_iter().chain(object.as_deref());
            let given = given.chain(body.as_deref());
            let words: Vec<&str> = std::iter::once(kind).chain(given).collect();
            look.list(&words)
        }
        Endpoint::Tcp { port, unit, .. } => look.fill(WITH_UNIT, &[&kind, port, unit]),
        Endpoint::Slcan { bitrate, id, .. } => look.fill(WITH_BITRATE, &[&kind, bitrate, id]),
        other => {
            let id = other.id_or_unit();
            match other.baud() {
                Some(baud) => look.fill(WITH_BAUD, &[&kind, &baud, &id]),
                None => look.fill(WITH_ID, &[&kind, &id]),
            }
        }
    }
}

/// Protocol, speed, and the id if known.
pub(crate) fn title(look: Look, endpoint: &Endpoint, id: Option<u16>) -> String {
    let kind = look.tr(panels::kind(endpoint.kind()));
    let speed = match endpoint {
        Endpoint::Sim { scenario, .. } => return look.list(&[kind, scenario.as_str()]),
        Endpoint::Slcan { bitrate, .. } => Some(*bitrate),
        other => other.baud(),
    };
    let speed = speed.map(|speed| format!(", {speed}")).unwrap_or_default();
    let id = id.map(|id| format!("ID {id}, ")).unwrap_or_default();
    format!("{id}{kind}{speed}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use crate::app::state::State;

    #[test]
    fn an_object_takes_the_place_of_the_one_of_the_scenario() {
        let look = Look::of(&State::default());
        for (spelled, words) in [
            ("sim:", "Simulated, Soft ball"),
            ("sim:?object=cup", "Simulated, cup"),
            ("sim:?scenario=free&object=block", "Simulated, block"),
        ] {
            let endpoint = spelled.parse().unwrap();
            assert_eq!(recognised(look, &endpoint), words);
        }
    }
}
