//! Sentences of a hold between two forces.

use crate::hand::grip::{TightenCause, Tightened};
use crate::motion::hold::{HoldEnd, HoldPhase, HoldView};
use crate::motion::program::Ended;
use crate::record::Abort;
use crate::ui::kit::Look;
use crate::ui::style::phrase::texts;
use crate::ui::text::{Text, tune, words};

texts! {
    HOLD: "Hold", "保持", "Holds an object with the least force that holds it, between two limits.", "在两个限值之间，用能保持住物体的最小力保持物体。";
    AT_LEAST: "At least, g", "最小力 g", "Each finger presses with this force or more.", "每根手指的力不小于此值。";
    AT_MOST: "At most, g", "最大力 g", "No finger presses harder. The hand itself keeps to it by its force threshold.", "每根手指的力不大于此值，由手自身的力阈值保证。";
    TAKE: "Hold what is held", "保持已抓物体", "Takes over what the hand holds, without opening it.", "不张开手，直接接管已抓住的物体。";
    POWER: "Close all fingers", "五指抓握", "Closes slowly as Power grasp until the object stops the fingers, then holds.", "按强力抓握姿态缓慢闭合，遇物体停止后保持。";
    PINCH: "Close as pinch", "两指捏取", "Closes thumb and index slowly until the object stops them, then holds.", "拇指与食指缓慢闭合，遇物体停止后保持。";
    END: "End the hold", "结束保持", "The hand keeps its position, and so what it holds.", "手保持当前位置，物体仍被抓住。";
    MOVES: "Hold", "保持";
    MEASURING: "Measuring the zero of the forces", "正在测量力零点";
    CLOSING: "Closing", "正在闭合";
    HOLDING: "Holding with {} g, margin {}", "保持力 {} g，裕量 {}";
    CANNOT_HOLD: "Cannot hold within {} g, margin {}", "{} g 以内无法保持，裕量 {}";
    CANNOT_HOLD_NOTICE: "The hold needs more force than allowed: raise At most, or support the object.", "所需的力超过最大力：请提高最大力或托住物体。";
    TIGHTENED: "tightened {} times, last: {}", "加力 {} 次，最近：{}";
    WARM: "a drive is warm", "驱动器温度偏高";
    TOO_LITTLE: "too little force", "力过小";
    MARGIN: "little margin", "裕量不足";
    LOAD: "rising load", "负载上升";
    SLIP: "slip", "打滑";
    ENDED: "Hold ended: {}", "保持已结束：{}";
    END_HELD: "the hand keeps what it holds", "手保持所抓物体";
    END_NOTHING: "the hand holds nothing", "手中没有物体";
    END_LOST: "the object left the hand", "物体已脱离";
    END_LATE: "the hand did not get there in time", "未能按时到位";
}

/// Cause for which a finger pressed harder.
const fn cause(cause: TightenCause) -> Text {
    match cause {
        TightenCause::TooLittle => TOO_LITTLE,
        TightenCause::Margin => MARGIN,
        TightenCause::Load => LOAD,
        TightenCause::Slip => SLIP,
    }
}

/// A finger that pressed harder, and why.
pub(crate) fn tightened(look: Look, own: Tightened) -> String {
    look.pair(
        look.tr(words::finger(own.finger)),
        look.tr(cause(own.cause)),
    )
}

/// A running hold in one line.
pub(crate) fn state(look: Look, view: &HoldView) -> String {
    let margin = view.margin_percent;
    let margin = margin.map_or("-".into(), |percent| format!("{percent} %"));
    let main = match view.phase {
        HoldPhase::Measuring => look.tr(MEASURING).to_owned(),
        HoldPhase::Closing => look.tr(CLOSING).to_owned(),
        HoldPhase::Holding => {
            let force = view.mean_g().map_or("-".into(), |g| g.to_string());
            look.fill(HOLDING, &[&force, &margin])
        }
        HoldPhase::CannotHold => look.fill(CANNOT_HOLD, &[&view.forces.at_most().get(), &margin]),
    };
    let last = view
        .last
        .map(|last| look.fill(TIGHTENED, &[&view.tightened, &tightened(look, last)]));
    let warm = view.is_warm.then(|| look.tr(WARM).to_owned());
    let all: Vec<String> = std::iter::once(main).chain(last).chain(warm).collect();
    look.list(&all)
}

/// The end of a hold.
pub(crate) fn end(look: Look, end: Ended<HoldEnd>) -> String {
    let why = match end {
        Ok(HoldEnd::Held) | Err(Abort::Person) => look.tr(END_HELD).to_owned(),
        Ok(HoldEnd::Nothing) => look.tr(END_NOTHING).to_owned(),
        Ok(HoldEnd::Lost) => look.tr(END_LOST).to_owned(),
        Ok(HoldEnd::Late) => look.tr(END_LATE).to_owned(),
        Err(why) => tune::abort(look, why),
    };
    look.fill(ENDED, &[&why])
}
