//! Every error shown to the user, as a sentence in the window's language. English uses the error's own text, except where that
//! refers to the command line.

use crate::app::inputs::InputError;
use crate::app::settings::Language;
use crate::hand::{ModbusException, OutOfRange, Refusal};
use crate::inputs::pad::PadTrouble;
use crate::link::scan::{HOSTS_MAX, HostsError, ScanHint};
use crate::link::{LeaseRefusal, LinkTrouble, RequestError};
use crate::record::NotSent;
use crate::record::export::ExportError;
use crate::share::gateway::WriteRefusal;
use crate::store::{FileCause, FileError, ValueKind};
use crate::system::SystemError;
use crate::tasks::{BackupError, TaskError};
use crate::transport::dds::DdsError;
use crate::transport::endpoint::error::{EndpointError, Want};
use crate::transport::endpoint::typed::TypedError;
use crate::transport::{Remedy, TransportError, WireFailure};
use crate::trials::plan_settings::PlanReadError;
use crate::ui::style::{Look, format};
use crate::ui::text::{inputs, poses};
use std::fmt::Display;
use std::io::ErrorKind;

/// The error's own text in English; else the result of `zh`.
fn in_language<E: Display>(look: Look, error: &E, zh: impl FnOnce(&E) -> String) -> String {
    match look.language {
        Language::En => format::sentence(&error.to_string()),
        Language::Zh => zh(error),
    }
}

/// Writes a table of errors as a function that returns the Chinese text, and one of another name for the window's language.
macro_rules! chinese {
    ($($(#[$doc:meta])* fn $name:ident($error:ty) $(as $text:ident)? { $($case:pat $(if $guard:expr)? => $words:literal $(, $part:expr)*;)* })*) => {$(
        $(#[$doc])*
        fn $name(error: $error) -> String {
            match error {
                $($case $(if $guard)? => format!($words $(, $part)*),)*
            }
        }
        $(
            pub(crate) fn $text(look: Look, error: $error) -> String {
                in_language(look, error, $name)
            }
        )?
    )*};
}

chinese! {
    /// Reason why a wire could not be opened, or broke.
    fn transport_zh(&TransportError) as transport {
        TransportError::Missing { place } => "{place} 不存在：请插入适配器，或选择其他端口。";
        TransportError::NotAPort { place } => "{place} 不是串口：请选择适配器的设备，例如 /dev/ttyUSB0。";
        TransportError::Permission { place, remedy } => "没有打开 {place} 的权限：{}。", remedy_zh(remedy);
        TransportError::Away { place, alike } if alike.is_empty() => "{place} 的 USB 适配器已拔出：请重新插入。";
        TransportError::Away { place, alike } => "{place} 的 USB 适配器已拔出：请重新插入；如果要用的是 {}，请连接它。", alike.join("、");
        TransportError::Busy { place, holder } => "{place} 正被 {} 使用：请关闭该程序后再连接。", holder.as_deref().unwrap_or("其他程序");
        TransportError::Refused { place } => "{place} 拒绝连接：主机存在，但该端口没有服务；灵巧手自身的端口为 6000。";
        TransportError::Silent { place, after_ms } => "{place} 在 {after_ms} ms 内没有应答：请检查电源、线缆与地址，并确认本机有同一网段的地址。";
        TransportError::Name { place } => "无法解析名称 {place}：请检查拼写，或使用数字地址。";
        TransportError::HungUp { place } => "{place} 已断开：适配器被拔出，或对方关闭了连接。";
        TransportError::Unsupported { kind } => "{kind}: 不经过本机的线路：请指定端口、地址或接口。";
        TransportError::LinuxOnly => "can: 连接需要 Linux：请在此使用 slcan: 适配器。";
        TransportError::BitrateRefused { place, bitrate } => "{place} 上的 CAN 适配器不支持 {bitrate} bit/s：请选择其他波特率。";
        TransportError::Io { place, failure } => "{place} 出错：{}。", failure_zh(failure);
        TransportError::NoInterface { place } => "没有 CAN 接口 {place}：请插入适配器；可用 'ip link show type can' 查看现有接口。";
        TransportError::NotCan { place } => "{place} 不是 CAN 接口：请从 'ip link show type can' 列出的接口中选择，例如 can0。";
        TransportError::InterfaceDown { place } => "CAN 接口 {place} 未启用：请运行 'sudo ip link set {place} up type can bitrate 1000000'。";
        TransportError::NoCan { place } => "无法打开 {place}：本系统的内核不支持 CAN；请改用 slcan: 适配器。";
        TransportError::QueueFull { place } => "{place} 无法发送，数据仍在队列中：CAN 总线上没有设备应答；请检查线缆、终端电阻、波特率与灵巧手电源。";
        TransportError::BusOff { place } => "{place} 因错误过多已离开 CAN 总线：请检查波特率、线缆与终端电阻，然后运行 'sudo ip link set {place} down' 并重新启用。";
        TransportError::ErrorPassive { place } => "{place} 错误较多且没有应答：波特率可能不对，或 CAN 总线上没有其他设备；请检查波特率、线缆、终端电阻与灵巧手电源。";
    }

    fn failure_zh(&WireFailure) {
        WireFailure::System(error) => "{}", system_error_zh(error);
        WireFailure::Protocol(words) => "应答不符合此协议：“{words}”";
        WireFailure::NoScenario(_) => "没有此场景";
        WireFailure::NoBody(_) => "此文件无法使用（格式见 'handscope sim --print-body'）";
        WireFailure::NoObject(_) => "此物体无法使用（格式见 'handscope sim --print-object cup'）";
        WireFailure::OffBus => "适配器无法接入总线";
        WireFailure::Recorded(words) => "系统信息为“{words}”";
    }

    fn remedy_zh(&Remedy) {
        Remedy::JoinGroup(group) => "请运行 'sudo usermod -aG {group} $USER'，然后注销并重新登录";
        Remedy::LogInAgain(group) => "您已在 {group} 组中，但登录之后才加入：请注销并重新登录";
        Remedy::GiveRight(port) => "请运行 'sudo chmod a+rw {port}'（拔出后失效），或为它添加 udev 规则";
        Remedy::Unknown => "请以有权限的用户启动本程序";
    }

    fn trouble_zh(&LinkTrouble) {
        LinkTrouble::Transport(error) => "{}", transport_zh(error);
        LinkTrouble::Garbled { place, id } => "{place} 上有应答，但不符合 ID {id}、此速度或此协议：请用“连接”中的“扫描”查找。";
        LinkTrouble::Mute { place, unit } => "{place} 接受了连接，但单元 {unit} 没有应答：请检查地址、端口与单元，并确认没有其他程序占用。";
        LinkTrouble::NoAnswer { id } => "ID {id} 没有应答：请检查灵巧手的电源、ID、波特率与协议，或用“连接”中的“扫描”逐一尝试。";
        LinkTrouble::Gateway { place, exception } => "{place} 有应答，但其后的灵巧手没有应答：{}（Modbus 异常码 {:02X}）。请检查灵巧手的电源及其与网关之间的线缆。", reason_zh(&Refusal::Exception(*exception)), exception.code();
        LinkTrouble::OtherSeries { place } => "{place} 像灵巧手一样应答，但不属于本系列：其寄存器含义不同，因此不显示也不写入任何内容。";
        LinkTrouble::OnlyEcho { place } => "{place} 只送回所发送的内容：适配器有回显，其后没有灵巧手应答；请检查灵巧手的电源与线缆。";
        LinkTrouble::Silent { silent } => "灵巧手停止应答：连续 {silent} 次请求没有应答。";
        LinkTrouble::Stalled { silent, stalled_ms } => "灵巧手停止应答：连续 {silent} 次请求没有应答，其间本机过于繁忙，停顿了 {stalled_ms} 毫秒。";
        LinkTrouble::Ambiguous => "线路上有迟到的应答：已重新打开，以免把旧数据当作新数据。";
        LinkTrouble::Suspended { slept_s } => "本机休眠了 {slept_s} 秒：之前显示的数据已过时。";
    }

    fn not_sent_zh(&NotSent) {
        NotSent::Armed => "灵巧手已使能，请先取消使能";
        NotSent::Holding => "停止尚待确认";
        NotSent::Moving => "灵巧手正在运动，请等待其静止";
        NotSent::RestUnknown => "不确定灵巧手是否静止：状态或角度缺失或过时";
        NotSent::TooSoon { wait } => "刚刚保存过，请等待 {} 秒", wait.as_secs_f64().ceil();
    }

    /// Reason why a request to the hand was not executed.
    fn request_zh(&RequestError) as request {
        RequestError::NotConnected => "没有连接：未发送任何内容。";
        RequestError::NotArmed => "未使能：未发送任何内容。";
        RequestError::NotOwner(LeaseRefusal::Taken(_)) => "灵巧手现由其他来源控制：未发送任何内容。";
        RequestError::NotOwner(LeaseRefusal::Ended(_)) => "目前没有人获准控制灵巧手，需由人授权：未发送任何内容。";
        RequestError::NotNow(why) => "{}：未发送任何内容。", not_sent_zh(why);
        RequestError::Full { limit } => "已有 {limit} 个请求在等待：未发送。";
        RequestError::TooLong { address, len } => "此线路无法一次读写地址 {address} 起的 {len} 字节。";
        RequestError::Timeout { address, after_ms } => "地址 {address} 在 {after_ms} ms 内没有应答：不确定灵巧手是否已执行。";
        RequestError::Refused { address, reason } => "灵巧手拒绝了地址 {address}：{}。", reason_zh(reason);
        RequestError::WrongLength { address, got, want } => "地址 {address} 应答了 {got} 字节，应为 {want} 字节。";
        RequestError::Ambiguous { address, wait_s } => "地址 {address} 可能还有迟到的应答：请在 {wait_s} 秒后重试。";
        RequestError::LinkLost => "连接断开：不确定灵巧手是否已执行。";
        RequestError::OutOfRange(OutOfRange { what, got, min, max }) => "{what} 的值 {got} 超出手册范围：{min} 至 {max}。";
    }

    fn reason_zh(&Refusal) {
        Refusal::Exception(ModbusException::IllegalFunction) => "不支持此功能码";
        Refusal::Exception(ModbusException::IllegalAddress) => "没有此地址";
        Refusal::Exception(ModbusException::IllegalValue) => "不接受此值";
        Refusal::Exception(ModbusException::Failure) => "设备故障";
        Refusal::Exception(ModbusException::Acknowledge) => "已接受，仍在处理";
        Refusal::Exception(ModbusException::Busy) => "设备忙";
        Refusal::Exception(ModbusException::MemoryParity) => "存储器校验错误";
        Refusal::Exception(ModbusException::NoPath) => "网关没有通路";
        Refusal::Exception(ModbusException::NoAnswer) => "网关的目标设备没有应答";
        Refusal::Exception(ModbusException::Other(code)) => "异常码 {code}";
        Refusal::PackingUnknown => "不清楚本手如何将单字节放入字；在连接的专家选项中选择 Modbus 字节的放法后才能写入";
        Refusal::NotIdentified => "尚不清楚这是否本系列的灵巧手，在此之前不写入任何内容";
        Refusal::PackingUnsafe => "本手的单字节不是低字节在前，写入是否安全尚不清楚";
    }

    fn endpoint_zh(&EndpointError) {
        EndpointError::Place { example, .. } => "缺少端口或地址：例如 {}。", bare(example);
        EndpointError::Kind { text } => "{text} 没有说明连接方式。";
        EndpointError::Key { key, kind, .. } => "{kind}: 没有 {key} 这一项。";
        EndpointError::Twice { key } => "{key} 出现了两次，请只写一次。";
        EndpointError::Value { key, value, want } => "{key}={value} 无效：应为{}。", want_zh(want);
    }

    /// Reason why an export was not written.
    fn export_zh(&ExportError) as export {
        ExportError::Exists { path } => "{} 已存在，不会覆盖。", path.display();
        ExportError::Unwritable { path, error } => "无法写入 {}：{}。", path.display(), system_error_zh(error);
        ExportError::Unreadable { error } => "无法读完此录制：{}。", system_error_zh(error);
        ExportError::Empty => "这一段中没有可导出的内容。";
        ExportError::NoNotes => "这一段中没有可作为片段起点的备注。";
        ExportError::BothSides => "左手与右手的自由度名称不同，不能放入同一数据集。";
        ExportError::NeverCommanded => "这一段中没有向任何自由度发过指令，动作将始终是灵巧手先前保持的目标。";
        ExportError::Interrupted => "已中断。";
        ExportError::ReaderGone => "输出的读取方已离开。";
    }

    fn typed_zh(&TypedError) {
        TypedError::Ip { text } => "{text} 不是 IP 地址：应为四个 0 至 255 的数字，例如 192.168.11.210。";
        TypedError::Unknown { text } => "{text} 不是地址：请输入例如 192.168.11.210、/dev/ttyUSB0、COM3 或 can0。";
        TypedError::Endpoint(error) => "{}", endpoint_zh(error);
    }

    fn want_zh(&Want) {
        Want::Whole => "整数";
        Want::Between(from, to) => " {from} 至 {to} 的整数";
        Want::Speed(from, to) => " {from} 至 {to} 的波特率";
        Want::OneOf(all) => " {}", all.replace(", ", "、").replace(" or ", " 或 ");
    }

    /// Error in addresses to scan.
    fn hosts_zh(&HostsError) as hosts {
        HostsError::Host { text } => "{text} 不是主机：请输入地址，例如 192.168.11.210；端口不是 6000 时在后面加上冒号与端口。";
        HostsError::Port { port } => "{port} 不是端口：请输入 1 至 65535 的数字。";
        HostsError::Range { text } => "{text} 不是网段：请输入例如 192.168.11.0/24。";
        HostsError::TooWide { prefix } => "/{prefix} 网段超过 {HOSTS_MAX} 个地址：请输入 /22 至 /32 的网段。";
        HostsError::Impossible { address } => "灵巧手不可能使用地址 {address}：请输入灵巧手的地址。";
    }

    /// Sign of something other than a hand, or of an unidentified one, during a scan.
    fn hint_zh(&ScanHint) as hint {
        ScanHint::OtherId { endpoint, hand_id } => "{endpoint} 有应答，但 HAND_ID 为 {hand_id}：可能不是灵巧手。";
        ScanHint::OtherSeries { endpoint, hand_id } => "{endpoint} 像灵巧手一样应答（HAND_ID 为 {hand_id}），但不属于本系列：其寄存器含义不同。";
        ScanHint::Refuses { endpoint, reason } => "{endpoint} 有应答，但不给出 HAND_ID（{}）：可能不是灵巧手。", reason_zh(reason);
        ScanHint::OtherTalk { endpoint } => "{} 上收到给其他主机的应答：另一程序正在使用此线路。请先结束它，或扫描全部 ID。", endpoint.place();
        ScanHint::Garbled { place, bauds, bytes } => "{place} 上有数据，但波特率 {} 下无法识别（{bytes} 字节）：可能波特率不同、是其他设备，或接线接反。", numbers(bauds);
    }

    /// Reason why a task could not continue.
    fn task_zh(&TaskError) as task {
        TaskError::NotRead { id, why } => "无法读取 {}：{}", id.name(), request_zh(why);
        TaskError::NotReached => "灵巧手没有应答。";
        TaskError::Declined(_) => "没有确认要这样做。";
        TaskError::NotApplied => "并非所有行都已应用，因此未保存。";
        TaskError::NoBackup(why) => "无法备份，未向灵巧手写入任何内容：{}。", backup_zh(why);
        TaskError::NotAsked(error) => "{}", request_zh(error);
    }

    fn backup_zh(&BackupError) {
        BackupError::NoFolder => "没有备份文件夹";
        BackupError::System(error) => "{}", system_error_zh(error);
    }

    /// Reason why the write of a gateway's client was not executed.
    fn write_refusal_zh(&WriteRefusal) as write_refusal {
        WriteRefusal::NotGranted => "没有程序获准控制：需由人允许。";
        WriteRefusal::Taken => "其他来源正在控制。";
        WriteRefusal::Over => "此连接的控制权已结束：需重新连接。";
        WriteRefusal::NotArmed(_) => "未能使能。";
        WriteRefusal::Limits => "灵巧手现有的速度与力阈值不合理。";
        WriteRefusal::Address { address, words } => "程序不允许写入地址 {address} 起的 {words} 个字。";
        WriteRefusal::Count { count } => "请求中没有所声明的 {count} 个字。";
        WriteRefusal::Value { address } => "地址 {address} 的值超出手册范围。";
        WriteRefusal::Request(error) => "{}", request_zh(error);
    }

    /// Reason why there is no gamepad.
    fn pad_zh(&PadTrouble) as pad {
        PadTrouble::LinuxOnly => "仅在 Linux 上读取手柄：在此可由其他程序读取，并按 'handscope help stream' 所述发送。";
        PadTrouble::NoFolder { folder, why } => "无法查找手柄：{}：{}。", folder.display(), system_error_zh(why);
        PadTrouble::MayNotOpen { path, remedy, .. } => "没有打开 {} 的权限：{}。", path.display(), remedy_zh(remedy);
        PadTrouble::NoThread(why) => "无法读取手柄：{}。", system_error_zh(why);
    }

    /// Reason why DDS is unavailable.
    fn dds_zh(&DdsError) as dds {
        DdsError::NoInterface { name } => "本机没有带 IPv4 地址的网络接口 {name}：可用 'ip address' 查看。";
        DdsError::System { name, error } => "无法使用网络接口 {name}：{}。", system_error_zh(&error.into());
    }

    fn file_cause_zh(&FileCause) {
        FileCause::Malformed(_) => "格式不对";
        FileCause::Syntax(_) => "不是有效的 TOML：每行应写成“键 = 值”";
        FileCause::KeyTwice => "这个键出现了两次，请删除一个";
        FileCause::Both { other } => "不能与 {other} 同时出现，请删除其一";
        FileCause::Missing => "缺少此项，请补上";
        FileCause::Unknown { known } => "此处没有这个键，只有 {known}，请更正或删除";
        FileCause::Range { got, range } => "{got} 超出范围 {}", range.replace(" to ", " 至 ");
        FileCause::Kind { got, wanted } => "{got} 不是{}", value_kind_zh(*wanted);
        FileCause::Choice { got, known } => "“{got}”不可用，只能是 {known}";
        FileCause::NotOffered(why) => "{}", poses::no_gap(*why).zh.trim_end_matches('。');
        FileCause::Pinches { dof } => "按尺寸抓握需要{}，请从此处删除", crate::ui::text::words::dof(*dof).zh;
        FileCause::NotSamples => "不是采样表";
        FileCause::Picture(_) => "图片格式不对";
        FileCause::Format { got, wanted } => "文件类型不对，其格式为 {got}，应为 {wanted}";
        FileCause::Version { got } => "无法读取版本 {got}";
        FileCause::Value { got, .. } => "值 {got} 不允许";
        FileCause::Twice { name } => "名称“{name}”使用了两次";
        FileCause::Absent { name } => "文件中没有“{name}”";
        FileCause::TooMany { got, limit } => "{got} 个过多：最多 {limit} 个";
        FileCause::NotPrivate { path } => "其他用户可以读取此文件，请运行 chmod 600 {path}";
        FileCause::Outside { got } => "{got} 不在此文件所在的文件夹内";
        FileCause::Empty => "文件中没有内容";
        FileCause::Unreadable(error) if error.kind == ErrorKind::InvalidData => "不是文本文件";
        FileCause::Unreadable(error) if error.kind == ErrorKind::InvalidInput => "不是文件";
        FileCause::Unreadable(error) => "{}", system_error_zh(error);
        FileCause::Named { path, error } => "{path}：{}", file_zh(error);
    }

    fn plan_zh(&PlanReadError) {
        PlanReadError::Form(_) => "格式不对";
        PlanReadError::Range(key) => "{key} 超出范围";
    }
}

/// Example of an endpoint without its kind.
fn bare(example: &str) -> &str {
    example.split_once(':').map_or(example, |(_, rest)| rest)
}

fn numbers(all: &[u32]) -> String {
    let all: Vec<String> = all.iter().map(u32::to_string).collect();
    all.join("、")
}

/// Description of a link problem.
pub(crate) fn trouble(look: Look, trouble: &LinkTrouble) -> String {
    match (look.language, trouble) {
        (_, LinkTrouble::Transport(error)) => transport(look, error),
        (Language::En, LinkTrouble::Garbled { place, id }) => format!(
            "Something answers on {place}, but not as id {id} at this speed and in this protocol: 'Scan' in Connection finds out what it is."
        ),
        (Language::En, LinkTrouble::NoAnswer { id }) => format!(
            "No answer from id {id}: check power, id, baud and protocol of the hand, or let 'Scan' in Connection try them all."
        ),
        (_, trouble) => in_language(look, trouble, trouble_zh),
    }
}

/// Error in an endpoint entered in the form.
pub(crate) fn endpoint(look: Look, error: &EndpointError) -> String {
    match (look.language, error) {
        (Language::En, EndpointError::Place { example, .. }) => {
            let example = bare(example);
            format!("The port or address is missing: type for example {example}.")
        }
        (_, error) => in_language(look, error, endpoint_zh),
    }
}

/// Reason why a typed address leads to no hand.
pub(crate) fn typed(look: Look, error: &TypedError) -> String {
    match error {
        TypedError::Endpoint(error) => endpoint(look, error),
        error => in_language(look, error, typed_zh),
    }
}

/// Reason why a file was rejected.
pub(crate) fn file(look: Look, error: &FileError) -> String {
    in_language(look, error, |error| file_zh(error) + "。")
}

const fn value_kind_zh(kind: ValueKind) -> &'static str {
    match kind {
        ValueKind::Whole => "此处允许的整数",
        ValueKind::Number => "数字",
        ValueKind::Truth => " true 或 false",
        ValueKind::Text => "带引号的文字",
        ValueKind::List => "方括号列表",
        ValueKind::Table => "键值表",
    }
}

fn file_zh(error: &FileError) -> String {
    let line = error.line.map(|line| format!("第 {line} 行，"));
    let field = error.field.as_ref().map(|field| format!("{field}："));
    let (line, field) = (line.unwrap_or_default(), field.unwrap_or_default());
    format!("{line}{field}{}", file_cause_zh(&error.cause))
}

/// Reason why the plan in the settings was rejected.
pub(crate) fn plan(look: Look, error: &PlanReadError) -> String {
    match look.language {
        Language::En => error.to_string(),
        Language::Zh => plan_zh(error),
    }
}

/// Reason why there is no backup.
pub(crate) fn backup(look: Look, error: &BackupError) -> String {
    match look.language {
        Language::En => error.to_string(),
        Language::Zh => backup_zh(error),
    }
}

pub(crate) fn system_error(look: Look, error: &SystemError) -> String {
    match look.language {
        Language::En => error.to_string(),
        Language::Zh => system_error_zh(error),
    }
}

fn system_error_zh(error: &SystemError) -> String {
    let by_code = error.code.and_then(system_code_zh);
    match (by_code.or_else(|| system_kind_zh(error.kind)), error.code) {
        (Some(zh), _) => zh.to_owned(),
        (None, Some(code)) => format!("系统错误 {code}"),
        (None, None) => format!("系统信息为“{}”", error.words),
    }
}

/// Errors without a kind of their own in the standard library, or with a shared one, by Unix error number.
const fn system_code_zh(code: i32) -> Option<&'static str> {
    if !cfg!(unix) {
        return None;
    }
    Some(match code {
        1 => "不允许此操作",
        5 => "读写出错",
        6 | 19 => "设备不存在",
        23 | 24 => "打开的文件过多",
        _ => return None,
    })
}

const fn system_kind_zh(kind: ErrorKind) -> Option<&'static str> {
    Some(match kind {
        ErrorKind::AddrInUse => "地址已被占用",
        ErrorKind::AddrNotAvailable => "本机没有此地址",
        ErrorKind::PermissionDenied => "权限不足",
        ErrorKind::NotFound => "文件或文件夹不存在",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "磁盘空间不足",
        ErrorKind::ReadOnlyFilesystem => "文件系统只读",
        ErrorKind::IsADirectory => "这是文件夹，不是文件",
        ErrorKind::NotADirectory => "路径中有一项不是文件夹",
        ErrorKind::AlreadyExists => "文件已存在",
        ErrorKind::InvalidFilename => "文件名过长",
        ErrorKind::ResourceBusy => "设备被占用",
        ErrorKind::NetworkUnreachable => "网络不可达",
        ErrorKind::HostUnreachable => "无法到达主机",
        ErrorKind::ConnectionReset => "连接被对方重置",
        ErrorKind::FileTooLarge => "文件过大",
        ErrorKind::InvalidData => "格式不对",
        // The library's enum is non-exhaustive.
        _ => return None,
    })
}

/// Reason why an input was not opened at the given place.
pub(crate) fn not_opened(look: Look, refusal: &InputError) -> String {
    match refusal {
        InputError::System(error) => look.fill(inputs::NOT_OPENED, &[&system_error(look, error)]),
        InputError::Pad(trouble) => pad(look, trouble),
        InputError::Dds(error) => dds(look, error),
    }
}

/// Reason why the hand, or the rule against unsafe writes, refused.
pub(crate) fn reason(look: Look, reason: Refusal) -> String {
    match look.language {
        Language::En => reason.to_string(),
        Language::Zh => reason_zh(&reason),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::settings::Theme;
    use crate::hand::gap::NotOffered;
    use crate::hand::kinematics::Side;
    use crate::link::Owner;
    use crate::params::rows::ParamId;
    use crate::record::ArmRefusal;
    use crate::store::toml_file;
    use crate::tasks::Risks;
    use crate::ui::theme::Palette;
    use std::collections::HashSet;
    use std::mem::discriminant;

    const PLACE: &str = "/dev/ttyUSB0";

    fn chinese() -> Look {
        Look {
            palette: Palette::of(Theme::Dark),
            language: Language::Zh,
            side: Side::Right,
        }
    }

    /// True if English words occur in a row, outside of commands, paths and register names.
    fn is_english(text: &str) -> bool {
        let outside: String = text.split('\'').step_by(2).collect();
        outside.split(|sign: char| !sign.is_ascii()).any(|part| {
            let words: Vec<&str> = part.split_whitespace().collect();
            let is_word =
                |word: &str| word.len() > 1 && word.chars().all(|sign| sign.is_ascii_lowercase());
            words
                .windows(2)
                .any(|two| two.iter().all(|word| is_word(word)))
        })
    }

    /// Checks sentences, and that there is one for each variant of the enum in `source`.
    fn check<E>(all: &[E], (source, name): (&str, &str), zh: impl Fn(&E) -> String) {
        let (_, body) = source.split_once(&format!("pub enum {name} {{")).unwrap();
        let (body, _) = body.split_once("\n}\n").unwrap();
        let is_variant = |line: &&str| {
            line.strip_prefix("    ")
                .is_some_and(|rest| rest.starts_with(|sign: char| sign.is_ascii_uppercase()))
        };
        let variants = body.lines().filter(is_variant).count();
        let covered: HashSet<_> = all.iter().map(discriminant).collect();
        assert_eq!(covered.len(), variants, "{name}");
        let known = include_str!("../../../assets/fonts/characters.txt");
        for error in all {
            let text = zh(error);
            assert!(text.ends_with('。') && !text.contains("系统信息"), "{text}");
            assert!(!is_english(&text), "{text}");
            let strange = text
                .chars()
                .find(|sign| !sign.is_ascii() && !known.contains(*sign));
            assert_eq!(strange, None, "{text}");
        }
    }

    fn system(code: i32) -> SystemError {
        std::io::Error::from_raw_os_error(code).into()
    }

    fn transports() -> Vec<TransportError> {
        let place = || PLACE.to_owned();
        let io = |failure| TransportError::Io {
            place: place(),
            failure,
        };
        let mut all = vec![
            TransportError::Missing { place: place() },
            TransportError::NotAPort { place: place() },
            TransportError::Away {
                place: place(),
                alike: Vec::new(),
            },
            TransportError::Away {
                place: place(),
                alike: vec!["COM3".into(), "COM4".into()],
            },
            TransportError::Busy {
                place: place(),
                holder: None,
            },
            TransportError::Busy {
                place: place(),
                holder: Some("minicom (42)".into()),
            },
            TransportError::Refused { place: place() },
            TransportError::Silent {
                place: place(),
                after_ms: 3000,
            },
            TransportError::Name { place: place() },
            TransportError::HungUp { place: place() },
            TransportError::Unsupported { kind: "sim".into() },
            TransportError::NoInterface { place: place() },
            TransportError::NotCan { place: place() },
            TransportError::InterfaceDown { place: place() },
            TransportError::NoCan { place: place() },
            TransportError::LinuxOnly,
            TransportError::QueueFull { place: place() },
            TransportError::BusOff { place: place() },
            TransportError::ErrorPassive { place: place() },
            TransportError::BitrateRefused {
                place: place(),
                bitrate: 500_000,
            },
            io(WireFailure::OffBus),
            io(WireFailure::NoScenario(
                "'party' is not a scenario: choose idle".into(),
            )),
            io(WireFailure::NoObject("line 2, `mass`: unknown key".into())),
            io(WireFailure::NoBody("line 2, `latency`: unknown key".into())),
        ];
        all.extend(
            [2, 5, 13, 17, 20, 21, 24, 28, 30, 101, 113, 150].map(|code| io(system(code).into())),
        );
        all.extend(
            [
                Remedy::JoinGroup("dialout".into()),
                Remedy::LogInAgain("dialout".into()),
                Remedy::GiveRight(PLACE.into()),
                Remedy::Unknown,
            ]
            .map(|remedy| TransportError::Permission {
                place: place(),
                remedy,
            }),
        );
        all
    }

    fn requests() -> Vec<RequestError> {
        let address = 1000;
        let refused = |reason| RequestError::Refused { address, reason };
        let range = crate::hand::Angle::new(2000).unwrap_err();
        let mut all = vec![
            RequestError::NotConnected,
            RequestError::NotArmed,
            RequestError::NotOwner(LeaseRefusal::Taken(Owner::Gamepad)),
            RequestError::NotNow(NotSent::Armed),
            RequestError::NotNow(NotSent::Holding),
            RequestError::NotNow(NotSent::Moving),
            RequestError::NotNow(NotSent::RestUnknown),
            RequestError::NotNow(NotSent::TooSoon {
                wait: std::time::Duration::from_secs(3),
            }),
            RequestError::Full { limit: 8 },
            RequestError::TooLong {
                address: 1000,
                len: 300,
            },
            RequestError::Timeout {
                address: 1000,
                after_ms: 60,
            },
            refused(Refusal::PackingUnknown),
            refused(Refusal::PackingUnsafe),
            refused(Refusal::NotIdentified),
            RequestError::WrongLength {
                address: 1000,
                got: 1,
                want: 2,
            },
            RequestError::Ambiguous {
                address: 1000,
                wait_s: 2,
            },
            RequestError::LinkLost,
            RequestError::OutOfRange(range),
        ];
        all.extend((0..=11).map(|code| refused(ModbusException::of(code).into())));
        all
    }

    #[test]
    fn every_error_of_a_wire_and_of_the_link_is_whole_in_chinese() {
        let wire = include_str!("../../transport/wire.rs");
        check(&transports(), (wire, "TransportError"), transport_zh);
        let place = || PLACE.to_owned();
        let troubles = [
            LinkTrouble::Transport(TransportError::LinuxOnly),
            LinkTrouble::NoAnswer { id: 7 },
            LinkTrouble::Garbled {
                place: place(),
                id: 7,
            },
            LinkTrouble::Mute {
                place: place(),
                unit: 255,
            },
            LinkTrouble::Gateway {
                place: place(),
                exception: ModbusException::NoAnswer,
            },
            LinkTrouble::OtherSeries { place: place() },
            LinkTrouble::OnlyEcho { place: place() },
            LinkTrouble::Silent { silent: 5 },
            LinkTrouble::Stalled {
                silent: 5,
                stalled_ms: 300,
            },
            LinkTrouble::Ambiguous,
            LinkTrouble::Suspended { slept_s: 9 },
        ];
        let status = include_str!("../../link/status.rs");
        check(&troubles, (status, "LinkTrouble"), |error| {
            trouble(chinese(), error)
        });
        let request_source = include_str!("../../link/request.rs");
        check(&requests(), (request_source, "RequestError"), |error| {
            request(chinese(), error)
        });
        let task_errors = [
            TaskError::NotRead {
                id: ParamId::HandId,
                why: RequestError::LinkLost,
            },
            TaskError::NotReached,
            TaskError::Declined(Risks::default()),
            TaskError::NotApplied,
            TaskError::NoBackup(BackupError::NoFolder),
            TaskError::NoBackup(BackupError::System(system(28))),
            TaskError::NotAsked(RequestError::NotArmed),
        ];
        let tasks = include_str!("../../tasks/mod.rs");
        check(&task_errors, (tasks, "TaskError"), |error| {
            task(chinese(), error)
        });
    }

    #[test]
    fn every_error_of_what_is_typed_or_read_is_whole_in_chinese() {
        let spelled = [
            "can:can0?id=1&id=2",
            "x",
            "rs485:",
            "rs485:COM3?speed=1",
            "tcp:h:0",
            "sim:?seed=x",
            "rtu:COM3?baud=1",
            "rtu:COM3?packing=x",
            "slcan:COM3?bitrate=1",
        ];
        let endpoints = spelled.map(|text| text.parse::<crate::transport::Endpoint>().unwrap_err());
        let source = include_str!("../../transport/endpoint/error.rs");
        check(&endpoints, (source, "EndpointError"), |error| {
            endpoint(chinese(), error)
        });
        let wrong = ["a b", "10.0.0.1:0", "10.0.0.0/x", "10.0.0.0/8", "0.0.0.0"];
        let wrong = wrong.map(|text| text.parse::<crate::link::scan::Hosts>().unwrap_err());
        let source = include_str!("../../link/scan/hosts.rs");
        check(&wrong, (source, "HostsError"), |error| {
            hosts(chinese(), error)
        });
        let at = |cause| FileError {
            line: Some(3),
            field: Some("name".into()),
            cause,
        };
        let name = || "fist".to_owned();
        let all = [
            FileCause::Malformed("57 cells instead of 58".into()),
            FileCause::Syntax("key with no value".into()),
            FileCause::KeyTwice,
            FileCause::Both { other: "angles" },
            FileCause::Missing,
            FileCause::Unknown { known: name() },
            FileCause::Range {
                got: "1001".into(),
                range: "0 to 1000".into(),
            },
            FileCause::Kind {
                got: "1".into(),
                wanted: ValueKind::Truth,
            },
            FileCause::Choice {
                got: "open".into(),
                known: name(),
            },
            FileCause::NotOffered(NotOffered::OnPalm),
            FileCause::Pinches {
                dof: crate::hand::Dof::Index,
            },
            FileCause::NotSamples,
            FileCause::Picture("bad signature".into()),
            FileCause::Format {
                got: name(),
                wanted: "handscope-poses",
            },
            FileCause::Version { got: 9 },
            FileCause::Value {
                got: "0".into(),
                allowed: "1 to 254".into(),
            },
            FileCause::Twice { name: name() },
            FileCause::Absent { name: name() },
            FileCause::TooMany { got: 9, limit: 1 },
            FileCause::NotPrivate { path: name() },
            FileCause::Outside { got: name() },
            FileCause::Empty,
            FileCause::Unreadable(system(13)),
            FileCause::Named {
                path: "logo.png".into(),
                error: Box::new(FileCause::Empty.into()),
            },
        ];
        let source = include_str!("../../store/file_error.rs");
        check(&all, (source, "FileCause"), |cause| {
            file(chinese(), &at(cause.clone()))
        });
    }

    #[test]
    fn chinese_does_not_depend_on_the_words_of_an_error() {
        let error_of = |kind, words: &str| SystemError::from(std::io::Error::new(kind, words));
        for (kind, zh) in [
            (ErrorKind::PermissionDenied, "权限不足。"),
            (ErrorKind::NotFound, "文件或文件夹不存在。"),
            (ErrorKind::StorageFull, "磁盘空间不足。"),
            (ErrorKind::InvalidData, "不是文本文件。"),
            (ErrorKind::InvalidInput, "不是文件。"),
        ] {
            let error = FileCause::Unreadable(error_of(kind, "mot inconnu")).into();
            assert_eq!(file(chinese(), &error), zh);
        }
        let path = std::path::Path::new;
        let folder = toml_file::load(path("."), 1, |_| Ok(())).unwrap_err();
        assert_eq!(file(chinese(), &folder), "这是文件夹，不是文件。");
        let none = toml_file::load(path("no/such"), 1, |_| Ok(())).unwrap_err();
        assert_eq!(file(chinese(), &none), "文件或文件夹不存在。");
        let cells = FileError {
            line: Some(4),
            ..FileCause::Malformed("57 cells instead of 58".into()).into()
        };
        let named = cells.of_named("'trial-1.csv'".into());
        assert_eq!(
            named.to_string(),
            "'trial-1.csv': line 4, 57 cells instead of 58"
        );
        assert_eq!(
            file(chinese(), &named),
            "'trial-1.csv'：第 4 行，格式不对。"
        );
        // A file error survives conversion to the system's error type.
        let wrapped: std::io::Error = named.into();
        assert_eq!(system_error(chinese(), &wrapped.into()), "格式不对");
        let range = PlanReadError::Range("speeds");
        assert_eq!(plan(chinese(), &range), "speeds 超出范围");
    }

    #[test]
    fn what_keeps_others_out_is_whole_in_chinese() {
        let all = [
            WriteRefusal::NotGranted,
            WriteRefusal::Taken,
            WriteRefusal::Over,
            WriteRefusal::NotArmed(ArmRefusal::Fault),
            WriteRefusal::Limits,
            WriteRefusal::Address {
                address: 1000,
                words: 1,
            },
            WriteRefusal::Count { count: 7 },
            WriteRefusal::Value { address: 1486 },
            WriteRefusal::Request(RequestError::NotArmed),
        ];
        let source = include_str!("../../share/gateway/refusal.rs");
        check(&all, (source, "WriteRefusal"), |refusal| {
            write_refusal(chinese(), refusal)
        });
        let all = [
            PadTrouble::LinuxOnly,
            PadTrouble::NoFolder {
                folder: "/dev/input".into(),
                why: system(2),
            },
            PadTrouble::MayNotOpen {
                path: "/dev/input/event3".into(),
                count: 1,
                remedy: Remedy::JoinGroup("input".into()),
            },
            PadTrouble::NoThread(system(11)),
        ];
        let source = include_str!("../../inputs/pad/report.rs");
        check(&all, (source, "PadTrouble"), |trouble| {
            pad(chinese(), trouble)
        });
        let name = || "eth9".to_owned();
        let all = [
            InputError::System(system(98)),
            InputError::Pad(PadTrouble::LinuxOnly),
            InputError::Dds(DdsError::NoInterface { name: name() }),
            InputError::Dds(DdsError::System {
                name: name(),
                error: std::io::Error::from_raw_os_error(1),
            }),
        ];
        let source = include_str!("../../app/inputs/mod.rs");
        check(&all, (source, "InputError"), |refusal| {
            not_opened(chinese(), refusal)
        });
    }

    #[test]
    fn every_hint_of_a_scan_is_whole_in_chinese() {
        let endpoint = || "rs485:/dev/x".parse().unwrap();
        let all = [
            ScanHint::OtherId {
                endpoint: endpoint(),
                hand_id: 7,
            },
            ScanHint::OtherSeries {
                endpoint: endpoint(),
                hand_id: 1,
            },
            ScanHint::Refuses {
                endpoint: endpoint(),
                reason: ModbusException::IllegalAddress.into(),
            },
            ScanHint::OtherTalk {
                endpoint: endpoint(),
            },
            ScanHint::Garbled {
                place: "x".into(),
                bauds: vec![1, 2],
                bytes: 3,
            },
        ];
        let source = include_str!("../../link/scan/event.rs");
        check(&all, (source, "ScanHint"), |error| hint(chinese(), error));
    }

    #[test]
    fn the_window_sends_nobody_to_the_command_line() {
        let look = Look {
            language: Language::En,
            ..chinese()
        };
        for error in [
            LinkTrouble::NoAnswer { id: 1 },
            LinkTrouble::Garbled {
                place: PLACE.into(),
                id: 1,
            },
        ] {
            let text = trouble(look, &error);
            assert!(
                !text.contains("handscope") && text.contains("'Scan' in Connection"),
                "{text}"
            );
        }
    }
}
