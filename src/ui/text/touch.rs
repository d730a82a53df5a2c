//! Sentences of the fingertips and the drawn hand.

use crate::app::readings::tare::{Source, TareZero};
use crate::app::settings::Language;
use crate::hand::Moment;
use crate::ui::kit::{Look, format};
use crate::ui::text::phrase::texts;
use std::time::Duration;

texts! {
    UNKNOWN: "Grey: angle not known", "灰色：角度未知";
    RIGHT_HAND: "Right hand", "右手";
    LEFT_HAND: "Left hand", "左手";
    SIDE_TIP: "Which hand is drawn; the hand does not say which one it is. A click draws the other one. Nothing moves.", "图中所画的手；灵巧手不会报告自己是左手还是右手。点击可切换，灵巧手不会动作。";
    ASSUMED: "Pads: assumed places", "分区位置为假定", "Which channel belongs to which pad is not documented: channels 1 to 7 are drawn as pads 1 to 7 of the sensor maker's model. Channel 8 belongs to no pad and stands beside them.", "手册没有说明通道与分区的对应关系：这里假定通道 1 至 7 对应传感器厂家模型的分区 1 至 7。通道 8 不属于任何分区，画在旁边。";
    DETAIL: "Detail", "详情", "The chosen fingertip: slip, forces, channels over time.", "所选指尖：打滑、受力、各通道曲线。";
    NUMBERS: "All numbers", "全部数值", "Every value of all five fingertips as a number.", "五个指尖的全部数值。";
    FORCES: "Force, N", "力 N";
    CHANNELS: "Channels, counts", "通道，计数";
    RAW: "Raw", "原始", "Channels as the hand sends them.", "按原始值显示各通道。";
    TARED: "Tared", "去皮后", "Channels from their rest: the last taring, or the first reading.", "相对静止值显示：最近一次去皮，或首次读数。";
    LAST_10_S: "10 s", "10 秒";
    LAST_MINUTE: "1 min", "1 分钟";
    LAST_10_MIN: "10 min", "10 分钟";
    LAST_TIP: "How much time the channels show.", "通道曲线显示的时间长度。";
    NOISE_HEAD: "change  noise, 1 s", "变化  噪声（1 秒）";
    NOISE: "Change and noise of channel", "通道变化与噪声", "Over the last second: the mean, counted from the rest, and the standard deviation, in counts.", "最近 1 秒内：相对静止值的平均变化，以及标准差，单位为计数。";
    CHECK: "Check word", "校验字", "The two check bytes against the sum of the first 54 bytes. What they cover is not documented for this hand: data is shown either way.", "两个校验字节与前 54 字节之和的比较。手册没有说明其范围，因此数据照常显示。";
    CHECK_OK: "right", "正确";
    CHECK_DIFFERS: "differs", "不符";
    DIRECTION: "Direction", "方向";
    NO_NUMBER: "not a number", "非数值";
    BEYOND: "out of range", "超出范围", "The manual ends at 20 N. The number is shown as the hand sent it.", "手册上限为 20 N。数值按灵巧手发送的原样显示。";
    SLIP: "Slip", "打滑";
    TARED_NAME: "Taring of the chosen fingertip", "所选指尖的去皮状态";
    NOT_TARED: "Zero: first reading", "零点：首次读数";
    KEPT_NAME: "Take the kept taring", "采用已保存的去皮";
    KEPT_TIP: "Counts from what was tared at this hand in an earlier session. Refused while a fingertip is touched.", "采用此前对同一灵巧手保存的去皮零点。指尖受力时拒绝。";
    NO_ZERO: "No zero yet: it is touched", "尚无零点：正在受力";
}

/// Where the zero of a fingertip comes from, and how old it is.
pub(crate) fn zero(look: Look, rest: TareZero, now: Moment) -> String {
    let since = now.since(rest.at);
    let (ago, kept) = match rest.source {
        Source::First => return look.say(NOT_TARED).to_owned(),
        Source::Person => (since, false),
        Source::Kept(age) => (age + since, true),
    };
    let ago = format::age(ago);
    match (look.language, kept) {
        (Language::En, false) => format!("Tared {ago} ago"),
        (Language::En, true) => format!("Tared {ago} ago, kept"),
        (Language::Zh, false) => format!("{ago}前去皮"),
        (Language::Zh, true) => format!("{ago}前去皮（已保存）"),
    }
}

/// A taring that was kept.
pub(crate) fn kept(look: Look, age: Duration) -> String {
    let age = format::age(age);
    match look.language {
        Language::En => format!("Taring of {age} ago"),
        Language::Zh => format!("{age}前的去皮"),
    }
}
