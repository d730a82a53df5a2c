//! Sentences of the search for settings: goal, progress, and result.

use crate::hand::Dof;
use crate::trials::search::{
    Claim, ComparedThreshold, GoalError, NoClaim, OpenQuestion, SearchStage, ThresholdReference,
};
use crate::ui::style::Look;
use crate::ui::style::phrase::texts;
use crate::ui::text::{tune, words};

texts! {
    WAY: "What is tried", "试验方式";
    FIND: "Find the settings", "寻找设置", "Searches for the fastest close whose peak stays under a limit.", "寻找峰值不超过上限的最快闭合。";
    GRID: "Try a grid", "遍历试验", "Tries each speed with each threshold.", "逐一试验各速度与各力阈值。";
    OBJECT: "Put the object where the fingers close on it. It closes slowly at first, and faster as long as it stays under the limit.", "请把物体放在手指闭合处。先慢速闭合，只要不超过上限就逐步加快。";
    GOAL: "Peak at most {} g, hold at least {} g, confirm with {} closes.", "峰值不超过 {} g，至少保持 {} g，确认 {} 次。";
    LIMIT: "peak at most, g", "峰值上限 g", "No close may press harder than this.", "任何一次闭合都不应超过此力。";
    HOLD: "hold at least, g", "至少保持 g", "Force of the grip once it has settled.", "抓握稳定后至少保留的力。";
    CLOSES: "confirm with", "确认次数", "59 closes hold however the peaks vary; fewer assume normal variation.", "59 次闭合不依赖峰值的分布；更少则假设峰值服从正态分布。";
    FREE: "Assume no distribution", "不假设分布", "The bound is then the largest of all closes; that needs 22 or 59 of them.", "此时上界取所有闭合的最大值，需要 22 或 59 次。";
    PROBING: "Slow closes look for the contact.", "慢速闭合，寻找接触位置。";
    RISING: "Faster, as long as it stays under the limit.", "在不超过上限的前提下逐步加快。";
    CONFIRMING: "Confirms: {} of {}.", "确认中：第 {} 次，共 {} 次。";
    OVER: "Search over.", "寻找结束。";
    LEFT: "{} closes so far, about {} more.", "已闭合 {} 次，约还需 {} 次。";
    NONE: "The search was ended: there is no result.", "寻找被中止，没有结果。";
    CLAIM_N: "In newtons of this hand: at most {} N.", "按此手的牛顿标定：不超过 {} N。";
    CLAIM: "{} on this object: {} s to close, peak at most {} g in {} of 100 closes ({} % sure {}, {} closes).", "{}（此物体）：闭合用时 {} 秒，峰值不超过 {} g，100 次闭合中至少 {} 次成立（置信度 {} %，{}，试验 {} 次）。";
    IF_NORMAL: "if the peaks vary normally", "假设峰值服从正态分布";
    HOWEVER: "however the peaks vary", "不假设峰值的分布";
    SETTING: "Speed {}, threshold {} g", "速度 {}，力阈值 {} g";
    TWO: "Speed {} up to {} before the contact, then {}; threshold {} g", "速度 {} 直到接触前 {}，然后 {}；力阈值 {} g";
    UNTOLD: "Not determined: {}", "无法判断：{}";
    AS_DEFAULT: "Use as default", "设为默认", "Makes speed and threshold the values after power-up of these joints. A card shows all that changes before anything is written.", "把速度与力阈值设为这些自由度上电后的值。写入前会显示全部改动。";
    AS_POSE: "Save as pose", "存为姿态", "A pose that closes with the result, speed and threshold included.", "新建姿态，包含找到的速度与力阈值。";
    AS_SEQUENCE: "Save as sequence", "存为动作", "Fast to just before the object, then slow: two poses and a sequence of them.", "先快速接近物体，再慢速闭合：两个姿态组成一个动作。";
    FULL: "The library of poses is full.", "姿态库已满。";
    POSE: "Grasp under {} g", "不超过 {} g 的抓握";
    NEAR: "Near, for a grasp under {} g", "接近（不超过 {} g 的抓握）";

    BAD_LIMIT: "A number from 30 to 2000.", "请填 30 到 2000。";
    BAD_HOLD: "At most {} g under this limit.", "在此上限下最多 {} g。";
    BAD_CLOSES: "A number from 5 to 100.", "请填 5 到 100。";
    FEW_CLOSES: "Without a distribution at least 22.", "不假设分布时至少 22 次。";

    DEAD: "Commanded to close, {} never moved: check its status and faults, and what may block it.", "已令{}闭合，但它没有动：请检查其状态与故障，以及是否被挡住。";
    TOUCHING: "{} felt something before it moved: place the object so that no finger touches it while the hand is open.", "{}在运动前就有接触：请摆放物体，使手张开时手指不碰到它。";
    NOTHING_MET: "{} met nothing on its way: put the object where it closes, or let it close further.", "{}一路没有碰到物体：请把物体放在闭合处，或允许闭合更多。";
    LOST: "{} met nothing where it had met the object: put it back, and make sure it cannot move.", "{}在原接触处没有碰到物体：请放回物体并确保它不会移动。";
    GIVES: "The object yields under {}: {} g for each count before and {} g now. Check it for damage, and set a lower limit.", "物体在{}下变软：此前每单位 {} g，现在 {} g。请检查是否受损，并降低上限。";
    EARLIER: "The object creeps: {} meets it {} counts earlier with each close. Fix it, or put it where it cannot move.", "物体在移动：{}每次闭合都早 {} 个单位碰到它。请固定物体，或放在不会移动的位置。";
    LATER: "The object creeps: {} meets it {} counts later with each close. Fix it, or put it where it cannot move.", "物体在移动：{}每次闭合都晚 {} 个单位碰到它。请固定物体，或放在不会移动的位置。";
    SLIPS: "The object slips under {} even at a slow close: hold it with more, or place it better.", "即使慢速闭合，物体也在{}下滑动：请增大保持力或重新摆放。";
    NOISE: "A limit of {} g drowns in the noise of {}, {} g: set at least {} g.", "上限 {} g 与{}的噪声（{} g）无法区分：请至少设为 {} g。";
    TOO_STRONG: "Even at speed {} {} may peak at {} g with the threshold that holds: raise the limit, or hold with less.", "即使速度为 {}，以能保持的力阈值，{}的峰值仍可能达 {} g：请提高上限或降低保持力。";
    HOLDS_LITTLE: "{} holds with {} g only under this limit, not with {}: raise the limit, or hold with less.", "在此上限下{}只能保持 {} g，达不到 {} g：请提高上限或降低保持力。";
    UNMEASURED: "The peak of {} could not be measured: its force readings are missing or too few.", "无法测量{}的峰值：力读数缺失或过少。";
    NO_STOP: "The stop of {} could not be seen: its angle, status or force readings after it are missing or too few.", "无法看到{}的停止：其后的角度、状态或力读数缺失或过少。";
    OFFSET: "{} stops before it meets anything: its force sensor reads {} g at rest, which its drive counts. Calibrate the force sensors.", "{}在碰到物体前就停下：其力传感器静止时读数为 {} g，驱动器将其计入。请校准力传感器。";
    UNCONFIRMED: "No setting could be confirmed in {} closes: the peaks scatter too much for this limit. The object may lie differently each time.", "{} 次闭合仍无法确认任何设置：峰值分散过大，物体每次的位置可能不同。";

    UNTOLD_SLIPS: "whether the object slipped under {}", "物体是否在{}下滑动";
    UNTOLD_STIFFNESS: "how stiff the object is under {}", "物体在{}下的刚度";
    UNTOLD_GAPS: "peaks between two readings of {}, up to {} ms apart", "{}两次读数之间的峰值（间隔最长 {} ms）";
    UNTOLD_OFFSET: "whether the drive of {} counts the {} g that its sensor reads at rest", "{}的驱动器是否计入传感器静止时的 {} g";
    AS_READ: "{} compares its threshold with FORCE_ACT as read: the {} g at rest count.", "{}以 FORCE_ACT 的读数与力阈值比较：静止时的 {} g 计入。";
    ABOVE_REST: "{} compares its threshold with the force above rest: the {} g at rest do not count.", "{}以高于静止读数的力与力阈值比较：静止时的 {} g 不计入。";
    UNTOLD_SPEEDS: "whether stops are as late at this speed as at the others, at which {} of the closes were made", "在此速度下停止的延迟是否与其他速度（{} 次闭合）相同";
    UNTOLD_DISTRIBUTION: "whether the peaks are normally distributed, on which the bound rests", "峰值是否服从上界所依据的正态分布";
}

/// Error in a goal.
pub(crate) fn goal_error(look: Look, error: GoalError) -> String {
    match error {
        GoalError::Limit { .. } => look.tr(BAD_LIMIT).into(),
        GoalError::Hold { most, .. } => look.fill(BAD_HOLD, &[&most]),
        GoalError::Closes { .. } => look.tr(BAD_CLOSES).into(),
        GoalError::TooFew { .. } => look.tr(FEW_CLOSES).into(),
        GoalError::Plan(error) => tune::plan_error(look, &error),
    }
}

/// Stage of a search.
pub(crate) fn stage(look: Look, stage: SearchStage) -> String {
    match stage {
        SearchStage::Probing => look.tr(PROBING).into(),
        SearchStage::Rising => look.tr(RISING).into(),
        SearchStage::Confirming { done, of } => look.fill(CONFIRMING, &[&done, &of]),
        SearchStage::Over => look.tr(OVER).into(),
    }
}

/// Result of a search, in a sentence.
pub(crate) fn claim(look: Look, claim: &Claim) -> String {
    let names: Vec<&str> = claim
        .joints
        .iter()
        .map(|own| look.tr(words::dof(own.dof)))
        .collect();
    let percent = |share: f64| format!("{:.0}", share * 100.0);
    let assumed = if claim.distribution_free {
        HOWEVER
    } else {
        IF_NORMAL
    };
    let parts: [&dyn std::fmt::Display; 7] = [
        &look.list(&names),
        &format!("{:.2}", claim.close_s),
        &format!("{:.0}", claim.peak_bound_g().ceil()),
        &percent(claim.assurance.coverage),
        &percent(claim.assurance.confidence),
        &look.tr(assumed),
        &claim.closes,
    ];
    look.fill(CLAIM, &parts)
}

/// Reason why nothing was found.
pub(crate) fn no_claim(look: Look, why: NoClaim) -> String {
    let joint = |dof: Dof| look.tr(words::dof(dof));
    let grams = |grams: f64| format!("{grams:.0}");
    match why {
        NoClaim::Dead { dof } => look.fill(DEAD, &[&joint(dof)]),
        NoClaim::Touching { dof } => look.fill(TOUCHING, &[&joint(dof)]),
        NoClaim::NoContact { dof } => look.fill(NOTHING_MET, &[&joint(dof)]),
        NoClaim::Lost { dof } => look.fill(LOST, &[&joint(dof)]),
        NoClaim::Gives {
            dof,
            before_g,
            now_g,
        } => look.fill(GIVES, &[&joint(dof), &grams(before_g), &grams(now_g)]),
        NoClaim::Creeps { dof, counts } => {
            let sentence = if counts > 0.0 { EARLIER } else { LATER };
            look.fill(sentence, &[&joint(dof), &format!("{:.1}", counts.abs())])
        }
        NoClaim::Slips { dof } => look.fill(SLIPS, &[&joint(dof)]),
        NoClaim::Noise {
            dof,
            limit_g,
            noise_g,
            least_g,
        } => look.fill(
            NOISE,
            &[&limit_g, &joint(dof), &grams(noise_g), &grams(least_g)],
        ),
        NoClaim::TooStrong { dof, speed, peak_g } => {
            look.fill(TOO_STRONG, &[&speed, &joint(dof), &grams(peak_g)])
        }
        NoClaim::HoldsTooLittle {
            dof,
            holds_g,
            wanted_g,
        } => look.fill(HOLDS_LITTLE, &[&joint(dof), &grams(holds_g), &wanted_g]),
        NoClaim::NotMeasured { dof } => look.fill(UNMEASURED, &[&joint(dof)]),
        NoClaim::NoStop { dof } => look.fill(NO_STOP, &[&joint(dof)]),
        NoClaim::Offset { dof, offset_g } => look.fill(OFFSET, &[&joint(dof), &grams(offset_g)]),
        NoClaim::NotConfirmed { trials } => look.fill(UNCONFIRMED, &[&trials]),
    }
}

/// Question that the measurements left open.
pub(crate) fn untold(look: Look, what: OpenQuestion) -> String {
    let joint = |dof: Dof| look.tr(words::dof(dof));
    match what {
        OpenQuestion::Slips { dof } => look.fill(UNTOLD_SLIPS, &[&joint(dof)]),
        OpenQuestion::Stiffness { dof } => look.fill(UNTOLD_STIFFNESS, &[&joint(dof)]),
        OpenQuestion::Gaps { dof, gap_s } => {
            let gap_ms = format!("{:.0}", gap_s * 1000.0);
            look.fill(UNTOLD_GAPS, &[&joint(dof), &gap_ms])
        }
        OpenQuestion::Offset { dof, offset_g } => {
            let grams = format!("{offset_g:.0}");
            look.fill(UNTOLD_OFFSET, &[&joint(dof), &grams])
        }
        OpenQuestion::Distribution => look.tr(UNTOLD_DISTRIBUTION).into(),
        OpenQuestion::OtherSpeeds { closes } => look.fill(UNTOLD_SPEEDS, &[&closes]),
    }
}

/// Value that a drive compares its threshold with; `None` if that makes no difference or is not known.
pub(crate) fn compared(look: Look, own: &ComparedThreshold) -> Option<String> {
    let sentence = match own.compared.filter(|_| own.is_notable())? {
        ThresholdReference::AsRead => AS_READ,
        ThresholdReference::AboveRest => ABOVE_REST,
        ThresholdReference::Unknown => return None,
    };
    let grams = format!("{:.0}", own.offset_g);
    Some(look.fill(sentence, &[&look.tr(words::dof(own.dof)), &grams]))
}
