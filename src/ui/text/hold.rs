//! Sentences of a hold between two forces.

use crate::hand::Force;
use crate::hand::grip::{TightenCause, Tightened};
use crate::hand::newtons::ForceUnit;
use crate::hand::overshoot::Stiffness;
use crate::motion::grasp::doubt::GraspDoubt;
use crate::motion::grasp::run::{ConfirmStep, Confirming};
use crate::motion::grasp::seen::NoGrasp;
use crate::motion::held_object::{Bounded, HeldObject};
use crate::motion::hold::{HoldEnd, HoldPhase, HoldView};
use crate::motion::program::Ended;
use crate::record::Abort;
use crate::ui::kit::Look;
use crate::ui::style::phrase::texts;
use crate::ui::text::{Text, tune, words};

texts! {
    HOLD: "Hold", "保持", "Holds an object with the least force that holds it, between two limits.", "在两个限值之间，用能保持住物体的最小力保持物体。";
    AT_LEAST: "At least, g", "最小力 g", "Each finger presses with this force or more.", "每根手指的力不小于此值。";
    AT_LEAST_N: "At least, N", "最小力 N", "Each finger presses with this force or more.", "每根手指的力不小于此值。";
    AT_MOST_N: "At most, N", "最大力 N", "No finger presses harder. The hand itself keeps to it by its force threshold.", "每根手指的力不大于此值，由手自身的力阈值保证。";
    UNIT_G: "g", "g", "The forces as this hand reads them.", "按此手读数的力。";
    UNIT_N: "N", "N", "The forces in newtons, as measured with a scale. Both units have forces of their own: nothing is converted.", "以牛顿计的力（已用秤标定）。两种单位各有设定，互不换算。";
    UNIT_UNKNOWN: "Measure the newtons of all fingers first: Hand > Check-up.", "请先测量所有手指的牛顿值：手 > 体检。";
    AT_MOST: "At most, g", "最大力 g", "No finger presses harder. The hand itself keeps to it by its force threshold.", "每根手指的力不大于此值，由手自身的力阈值保证。";
    IN_NEWTONS: "At least {}, at most {}, as measured for: {}", "按已标定手指：最小 {}，最大 {}（{}）";
    FROM_TO_N: "{} to {} N", "{} 至 {} N";
    TAKE: "Hold what is held", "保持已抓物体", "Takes over what the hand holds, without opening it.", "不张开手，直接接管已抓住的物体。";
    POWER: "Close all fingers", "五指抓握", "Closes slowly as Power grasp until the object stops the fingers, then holds.", "按强力抓握姿态缓慢闭合，遇物体停止后保持。";
    PINCH: "Close as pinch", "两指捏取", "Closes thumb and index slowly until the object stops them, then holds.", "大拇指与食指缓慢闭合，遇物体停止后保持。";
    END: "End the hold", "结束保持", "Stops and disarms. The hand does not open.", "停止并取消使能，手不会张开。";
    MOVES: "Hold", "保持";
    MEASURING: "Measuring zero", "正在测量力零点";
    CLOSING: "Closing", "正在闭合";
    HOLDING: "Holding with {} g, margin {}", "保持力 {} g，裕量 {}";
    HELD: "Holding", "正在保持";
    TOO_WEAK: "Cannot hold", "无法保持";
    CANNOT_HOLD: "Cannot hold within {}, margin {}", "{} 以内无法保持，裕量 {}";
    CANNOT_HOLD_NOTICE: "The hold needs more force than allowed: raise At most, or support the object.", "所需的力超过最大力：请提高最大力或托住物体。";
    TIGHTENED: "tightened {} times, last: {}", "加力 {} 次，最近：{}";
    WARM: "a drive is warm", "驱动器温度偏高";
    OBJECT: "In the hand: {}", "手中物体：{}";
    OBJECT_SIZE: "size {} ±{} mm", "尺寸 {} ±{} mm";
    OBJECT_NO_SIZE: "size: cannot tell", "尺寸未知";
    OBJECT_STIFFNESS: "stiffness: cannot tell", "刚度未知";
    OBJECT_YIELDS: "yields", "会变形";
    OBJECT_KEEPS: "does not yield", "不变形";
    OBJECT_NO_YIELD: "yields: cannot tell", "是否变形未知";
    OBJECT_WEIGHT: "weight {} ±{} g", "重量 {} ±{} g";
    OBJECT_NO_WEIGHT: "weight: cannot tell", "重量未知";
    TOO_LITTLE: "too little force", "力过小";
    MARGIN: "little margin", "裕量不足";
    LOAD: "rising load", "负载上升";
    SLIP: "slip", "打滑";
    ENDED: "Hold ended: {}", "保持已结束：{}";
    END_HELD: "the hand keeps what it holds", "手保持所抓物体";
    END_PERSON: "the hand keeps its position", "手保持当前位置";
    END_NOTHING: "the hand holds nothing", "手中没有物体";
    END_LOST: "the object left the hand", "物体已脱离";
    END_LATE: "the hand did not get there in time", "未能按时到位";
    SAVE: "Save this grasp", "保存此抓取", "Saves forces, stiffness, friction and result in the pose library, to hold like this again.", "将力、刚度、摩擦和结果存入姿态库，以便再次这样抓取。";
    GRASPS: "Saved grasps", "已保存的抓取";
    GRASP_OWN: "Made on this hand: {} to {} g.", "在此手上保存：{} 至 {} g。";
    GRASP_TRUSTED: "Made on {}, and confirmed by this hand: {} to {} g there.", "在 {} 上保存，已由此手确认：原手 {} 至 {} g。";
    GRASP_NEW: "Made on {}: this hand confirms it first, with five closes ({} to {} g there).", "在 {} 上保存：此手先闭合五次加以确认（原手 {} 至 {} g）。";
    CONFIRMING: "Confirming {} of {}: {}", "确认第 {} 次，共 {} 次：{}";
    CONFIRM_CLOSE: "closing", "正在闭合";
    CONFIRM_LIFT: "lift the object and use it, without turning the hand", "请提起物体并使用，不要转动手";
    CONFIRM_DOWN: "use it, then put it down", "使用后请放下物体";
    CONFIRM_RELEASE: "the load is gone; press Put down once the object stands by itself", "负载已消失；物体放稳后请按“已放下”";
    PUT_DOWN: "Put down", "已放下", "The object stands by itself. The hand opens for the next close.", "物体已放稳。手将张开，准备下一次闭合。";
    PUT_DOWN_LOADED: "The object still loads the fingertips: put it down first.", "指尖仍有负载：请先放下物体。";
    CONFIRM_OPEN: "opening; put the object back in its place", "正在张开；请把物体放回原处";
    NOT_SAVED_FAILED: "The hold did not end well.", "保持未正常结束。";
    NOT_SAVED_SHORT: "It held too briefly: hold for 2 s or more.", "保持时间过短：请保持 2 s 以上。";
    NOT_SAVED_FORCE: "At most did not suffice at times: raise it, and hold again.", "最大力有时不足：请提高后重试。";
    NOT_SAVED_TAKEN: "The hand held the object already, so how it closes is not known: open it first.", "手已抓住物体，闭合方式未知：请先张开手。";
    NOT_SAVED_READ: "No finger that holds was read.", "未读到保持的手指。";
    DOUBTED: "The grasp is not trusted on this hand: {}", "此手不能信任该抓取：{}";
    DOUBT_THERE: "it has no newtons of the {}; measure the hand that made it with 'handscope scale', and save it anew", "抓取文件中没有{}的牛顿值；请用 handscope scale 测量原手并重新保存";
    DOUBT_HERE: "the newtons of the {} of this hand are not known; measure them with 'handscope scale'", "此手{}的牛顿值未知；请用 handscope scale 测量";
    DOUBT_ROOM: "its forces are not possible as the {} of this hand reads them ({} to {} g)", "按此手{}的读数，这些力不可行（{} 至 {} g）";
    DOUBT_NO_LOAD: "no load came and went in close {}: lift the object, and put it down again", "第 {} 次闭合中负载没有出现并消失：请提起并放下物体";
    DOUBT_NOT_RELEASED: "nobody said in close {} that the object stands", "第 {} 次闭合中未确认物体已放稳";
    DOUBT_NOT_CLOSED: "in close {} the open hand touched the object", "第 {} 次闭合前张开的手已碰到物体";
    DOUBT_LOST: "the object left the hand in close {}", "第 {} 次闭合中物体脱离";
    DOUBT_FORCE: "at most did not suffice in close {}", "第 {} 次闭合中最大力不足";
    DOUBT_NOT_HELD: "the {} does not hold as on the first hand: place the object as it lay there", "{}没有像原手那样保持：请按原样放置物体";
    DOUBT_PEAK: "the {} may press with {} g, above at most ({} g on this hand)", "{}可能达到 {} g，超过最大力（此手为 {} g）";
    DOUBT_STIFF: "the object is {} times as stiff as on the first hand", "物体刚度是原手所测的 {} 倍";
    DOUBT_NO_STIFF: "the stiffness of the object is known on one of both hands only", "只有一只手测得物体刚度";
    DOUBT_SLID: "the object slid at a load of {} of the force, and held at {} on the first hand", "负载为力的 {} 时物体打滑，而原手在 {} 时仍能保持";
    DOUBT_FRICTION: "the closes show a friction of {}, and {} is needed: load the object as it was there", "闭合显示的摩擦为 {}，需要 {}：请按原来的负载使用物体";
    DOUBT_HEAVIER: "the load was {} N, and {} N on the first hand", "负载为 {} N，原手上为 {} N";
    DOUBT_UNKNOWN: "it has no load: hold there again, and save it anew", "抓取文件中没有负载：请在原手上重新保持并保存";
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

/// Phase of a running hold in one or two words.
pub(crate) const fn phase(phase: HoldPhase) -> Text {
    match phase {
        HoldPhase::Measuring => MEASURING,
        HoldPhase::Closing => CLOSING,
        HoldPhase::Holding => HELD,
        HoldPhase::CannotHold => TOO_WEAK,
    }
}

/// A running hold in one line; its two forces are in this unit.
pub(crate) fn state(look: Look, view: &HoldView, unit: ForceUnit) -> String {
    let margin = view.margin_percent;
    let margin = margin.map_or("-".into(), |percent| format!("{percent} %"));
    let main = match view.phase {
        HoldPhase::Measuring => look.tr(MEASURING).to_owned(),
        HoldPhase::Closing => look.tr(CLOSING).to_owned(),
        HoldPhase::Holding => {
            let force = view.mean_g().map_or("-".into(), |g| g.to_string());
            look.fill(HOLDING, &[&force, &margin])
        }
        HoldPhase::CannotHold => look.fill(
            CANNOT_HOLD,
            &[&force_in(unit, view.forces.at_most()), &margin],
        ),
    };
    let last = view
        .last
        .map(|last| look.fill(TIGHTENED, &[&view.tightened, &tightened(look, last)]));
    let warm = view.is_warm.then(|| look.tr(WARM).to_owned());
    let all: Vec<String> = std::iter::once(main).chain(last).chain(warm).collect();
    look.list(&all)
}

/// One of the two forces of a hold with its unit.
fn force_in(unit: ForceUnit, force: Force) -> String {
    let value = f64::from(force.get()) * unit.per_g();
    match unit {
        ForceUnit::Grams => format!("{value:.0} g"),
        ForceUnit::Newtons => format!("{value:.1} N"),
    }
}

/// What is in the hand, in one line.
pub(crate) fn object(look: Look, own: &HeldObject) -> String {
    let bounded = |value: Option<Bounded>, known: Text, unknown: Text| match value {
        Some(own) => look.fill(
            known,
            &[&format!("{:.0}", own.value), &format!("{:.0}", own.bound)],
        ),
        None => look.tr(unknown).to_owned(),
    };
    let stiffness = match own.stiffness {
        Stiffness::Unknown => OBJECT_STIFFNESS,
        known => tune::stiffness(known),
    };
    let yields = match own.yields {
        Some(true) => OBJECT_YIELDS,
        Some(false) => OBJECT_KEEPS,
        None => OBJECT_NO_YIELD,
    };
    let all = look.list(&[
        &bounded(own.size_mm, OBJECT_SIZE, OBJECT_NO_SIZE),
        look.tr(stiffness),
        look.tr(yields),
        &bounded(own.weight_g, OBJECT_WEIGHT, OBJECT_NO_WEIGHT),
    ]);
    look.fill(OBJECT, &[&all])
}

/// Progress of a confirmation.
pub(crate) fn confirming(look: Look, own: Confirming) -> String {
    let step = look.tr(match own.step {
        ConfirmStep::Close => CONFIRM_CLOSE,
        ConfirmStep::Lift => CONFIRM_LIFT,
        ConfirmStep::PutDown => CONFIRM_DOWN,
        ConfirmStep::Release => CONFIRM_RELEASE,
        ConfirmStep::Open => CONFIRM_OPEN,
    });
    look.fill(CONFIRMING, &[&own.close, &own.of, &step])
}

/// Reason why a hold is not saved.
pub(crate) const fn not_saved(why: NoGrasp) -> Text {
    match why {
        NoGrasp::Failed => NOT_SAVED_FAILED,
        NoGrasp::Short { .. } => NOT_SAVED_SHORT,
        NoGrasp::CouldNotHold => NOT_SAVED_FORCE,
        NoGrasp::TookOver => NOT_SAVED_TAKEN,
        NoGrasp::NotRead => NOT_SAVED_READ,
    }
}

/// Reason why a grasp is not trusted.
pub(crate) fn doubt(look: Look, doubt: GraspDoubt) -> String {
    let finger = |finger| look.tr(words::finger(finger));
    let whole = |value: f64| format!("{value:.0}");
    let ratio = |value: f64| format!("{value:.2}");
    let tenths = |value: f64| format!("{value:.1}");
    match doubt {
        GraspDoubt::NoNewtonsThere { finger: own } => look.fill(DOUBT_THERE, &[&finger(own)]),
        GraspDoubt::NoNewtonsHere { finger: own } => look.fill(DOUBT_HERE, &[&finger(own)]),
        GraspDoubt::NoRoom { finger: own, why } => {
            look.fill(DOUBT_ROOM, &[&finger(own), &why.at_least, &why.at_most])
        }
        GraspDoubt::NoLoad { close } => look.fill(DOUBT_NO_LOAD, &[&close]),
        GraspDoubt::NotReleased { close } => look.fill(DOUBT_NOT_RELEASED, &[&close]),
        GraspDoubt::NotClosed { close } => look.fill(DOUBT_NOT_CLOSED, &[&close]),
        GraspDoubt::Lost { close } => look.fill(DOUBT_LOST, &[&close]),
        GraspDoubt::CouldNotHold { close } => look.fill(DOUBT_FORCE, &[&close]),
        GraspDoubt::NotHeld { finger: own } => look.fill(DOUBT_NOT_HELD, &[&finger(own)]),
        GraspDoubt::Peak {
            finger: own,
            bound_g,
            at_most_g,
        } => look.fill(
            DOUBT_PEAK,
            &[&finger(own), &whole(bound_g), &whole(at_most_g)],
        ),
        GraspDoubt::Stiffness { ratio } => look.fill(DOUBT_STIFF, &[&tenths(ratio)]),
        GraspDoubt::NoStiffness => look.tr(DOUBT_NO_STIFF).to_owned(),
        GraspDoubt::Slid { slid, held } => look.fill(DOUBT_SLID, &[&ratio(slid), &ratio(held)]),
        GraspDoubt::NoFriction { shown, needed } => {
            look.fill(DOUBT_FRICTION, &[&ratio(shown), &ratio(needed)])
        }
        GraspDoubt::Heavier { here_n, there_n } => {
            look.fill(DOUBT_HEAVIER, &[&tenths(here_n), &tenths(there_n)])
        }
        GraspDoubt::LoadUnknown => look.tr(DOUBT_UNKNOWN).to_owned(),
    }
}

/// A grasp that is not trusted, as a sentence.
pub(crate) fn doubted(look: Look, why: GraspDoubt) -> String {
    look.fill(DOUBTED, &[&doubt(look, why)])
}

/// The end of a hold.
pub(crate) fn end(look: Look, end: Ended<HoldEnd>) -> String {
    let why = match end {
        Ok(HoldEnd::Held) => look.tr(END_HELD).to_owned(),
        Err(Abort::Person) => look.tr(END_PERSON).to_owned(),
        Ok(HoldEnd::Nothing) => look.tr(END_NOTHING).to_owned(),
        Ok(HoldEnd::Lost) => look.tr(END_LOST).to_owned(),
        Ok(HoldEnd::Late) => look.tr(END_LATE).to_owned(),
        Err(why) => tune::abort(look, why),
    };
    look.fill(ENDED, &[&why])
}
