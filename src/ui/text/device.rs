//! Sentences of the hand's parameters: rows, verdicts, SAVE, files.

use crate::app::params::state::{Doing, ParamRefusal};
use crate::params::changes::{RowOutcome, RowVerdict};
use crate::params::rows::ParamId;
use crate::record::{Doubt, NotSent, SaveDoubt, Saved};
use crate::tasks::TaskError;
use crate::tasks::save::SaveReport;
use crate::ui::style::Look;
use crate::ui::style::phrase::{Text, texts};
use crate::ui::text::{errors, main, words};

texts! {

    FIND: "Find parameters", "查找参数", "Filter", "筛选";
    FIND_NONE: "No row has these words.", "没有符合的行。";
    NO_DIFFERENCE: "No row differs.", "没有不同的行。";
    ONLY: "Only differences", "只看不同", "Shows only rows in which live, staged, saved and factory are not all the same.", "只显示实际值、暂存值、已存值与出厂值不完全相同的行。";
    READ: "Read again", "重新读取", "Reads all rows from the hand. Writes nothing.", "从灵巧手读取全部行，不写入任何内容。";
    APPLY: "Apply", "应用", "Writes the staged rows and reads them back. They hold until the hand is switched off, unless they are saved to flash.", "写入暂存的行并读回。若不保存到闪存，断电后即失效。";
    UNDO: "Undo apply", "撤销应用", "Writes back what the last apply changed, and reads it back.", "写回上次应用所改动的值，并读回核对。";
    UNSTAGE_ALL: "Discard staged", "清除暂存", "Forgets everything that is staged. Writes nothing.", "清除全部暂存值，不写入任何内容。";
    UNSTAGE: "Drop", "清除", "Forgets what is staged here. Writes nothing.", "清除此行暂存值，不写入任何内容。";
    COPY: "Copy the hand's speed and force", "取手当前的速度与力阈值", "Stages SPEED_SET and FORCE_SET, as they are read from the hand now, as defaults after power-up, for all joints. Writes nothing.", "把当前从灵巧手读到的 SPEED_SET 与 FORCE_SET 暂存为全部自由度的上电默认值，不写入任何内容。";
    COPY_UNKNOWN: "SPEED_SET and FORCE_SET are not known now.", "SPEED_SET 与 FORCE_SET 目前未知。";
    CHANGE: "Change...", "更改...", "Changes where the hand is found, step by step and with a way back.", "分步更改灵巧手的通讯地址，并保留退路。";
    CHANGE_NONE: "Type another value first.", "请先输入另一个值。";

    CHANGE_SIM: "The simulated hand is always found here.", "仿真手总在此处。";

    LIVE: "Live", "实际值";
    STAGED: "Staged", "暂存值", "The new value of this row. Enter stages it; nothing is written by typing.", "应用后此行的值。按回车暂存，输入时不写入任何内容。";
    SAVED: "Last saved", "上次保存";
    FACTORY: "Factory", "出厂值";
    RANGE: "Range", "范围";
    MANUAL: "manual", "手册";
    ADDRESS_HINT: "address", "地址";
    FOUR_SPEEDS: "4 speeds", "4 种速率";

    VERDICT: "verdict", "结果";

    GROUP_PLACE: "Where the hand is found", "通讯地址";
    GROUP_SPEED: "Speed after power-up", "上电速度";
    GROUP_FORCE: "Force threshold after power-up", "上电力阈值";
    ABOUT_PLACE: "Belongs to one hand. A wrong value hides the hand from this computer.", "每只灵巧手各不相同。值有误时，本机将找不到灵巧手。";
    ABOUT_SPEED: "DEFAULT_SPEED_SET: the speed after power-up.", "DEFAULT_SPEED_SET：灵巧手上电时的速度。";
    ABOUT_FORCE: "DEFAULT_FORCE_SET: where a drive stops after power-up. It does not regulate.", "DEFAULT_FORCE_SET：上电后电机停止的力值，并非力控。";
    HAND_ID: "Hand id", "设备 ID";
    REDU_RATIO: "Serial speed", "串口速率";
    IP_ADDRESS: "IP address", "IP 地址";
    ABOUT_HAND_ID: "The id on the bus.", "总线上的编号。";
    ABOUT_REDU_RATIO: "In baud.", "单位：波特。";
    ABOUT_IP: "Acts from the next power-up.", "下次上电时生效。";

    NO_HAND: "No hand answers. What was read before is old; what was never read is \"-\".", "没有灵巧手应答。先前读到的值已旧，从未读到的显示 \"-\"。";
    NOT_READ: "Not read yet.", "尚未读取。";
    READING: "Reading...", "正在读取...";
    APPLYING: "Writing, then reading back...", "正在写入并读回...";
    BACKING_UP: "Making a backup...", "正在备份...";
    SAVING: "The hand writes its flash. Leave it switched on.", "灵巧手正在写闪存，请勿断电。";
    READ_AT: "Read", "读取于";
    AGO: "ago", "前";
    TROUBLE: "Not all rows could be read, so nothing was written:", "部分行无法读取，因此未写入任何内容：";


    APPLIED: "applied, read back", "已应用并读回";
    NOT_TAKEN: "refused", "被拒绝";
    DROPPED: "silently refused: the hand keeps its old value", "未采用：灵巧手保持原值";
    PUT_BACK: "restored, as other rows were refused; requested", "其他行未被采用，已写回原值；想要";
    ALTERED: "the hand took another value than", "灵巧手采用了别的值，而非";
    UNVERIFIED: "unverified", "未核实";
    NOT_WRITTEN: "not written", "未写入";
    WANTED: "wanted", "期望";
    DOUBT_NOT_READ: "it could not be read back", "无法读回";
    DOUBT_AMBIGUOUS: "a late answer could be mistaken for it", "可能与迟到的应答混淆";
    TOO_SOON: "The last SAVE was just now: wait", "刚刚保存过：请等待";

    DANGER_APPLY: "Apply defaults that hit hard?", "应用会造成冲击的默认值？";
    DANGER_SAVE: "Save defaults that hit hard?", "保存会造成冲击的默认值？";
    DANGER_LATE: "A drive stops late: closing at this speed, the finger presses far beyond its force threshold before it stops. Once in flash, the hand starts like this every time.", "电机停止有滞后：以此速度合拢时，手指会远超力阈值才停下。写入闪存后，灵巧手每次上电都将如此。";
    DANGER_RATED: "Above the rated grip of 2000 g:", "高于额定抓握力 2000 g：";
    DANGER_FORCE: "Threshold, g", "阈值 g";
    DANGER_OVER: "Overshoot, g", "超出 g";
    DANGER_MEASURED: "Measured on another hand of the family: index finger on a rigid block, median of the peaks. Soft objects are pressed less.", "在同系列一只手上实测：食指接触刚性物体，取峰值的中位数。柔软物体受力较小。";
    DANGER_BEYOND: "Thresholds above 1000 g were not measured: the figure for 1000 g is used.", "1000 g 以上的阈值没有实测，按 1000 g 的数据给出。";
    DANGER_SLOWLY: "With speed 25 the same thresholds were passed by at most", "速度为 25 时，同样的阈值最多超出";
    FORCE: "force", "力";
    AGREE_APPLY: "Apply anyway", "仍然应用", "Proceeds with this list.", "按所列内容继续。";
    AGREE_SAVE: "Save anyway", "仍然保存", "Proceeds with this list.", "按所列内容继续。";
    DECLINE: "Back", "返回", "Writes nothing. What was staged before stays staged.", "不写入任何内容，之前的暂存值保留。";

    FLASH: "Flash", "闪存";
    FLASH_BODY: "Flash itself cannot be read. \"Last saved\" is what this program saved.", "闪存本身无法读取。“上次保存”是本程序所保存的内容。";
    SAVE: "Save to flash", "保存到闪存", "Shows what would change, makes a backup, then lets the hand write all its parameters to flash. Takes up to 3 seconds.", "先显示将要改变的内容并备份，然后让灵巧手把全部参数写入闪存，最多 3 秒。";
    SAVE_TITLE: "Save these changes to flash?", "把这些更改保存到闪存？";
    SAVE_NOTHING: "Nothing to save, as far as this program knows", "据本程序所知，没有可保存的更改";
    SAVE_NOTHING_BODY: "No row differs from what was read first. This program never saved on this hand, so what its flash holds is not known. SAVE writes all parameters as they are now.", "没有与最初读取不同的行。本程序从未在此灵巧手上保存过，闪存内容未知。保存会把当前全部参数写入闪存。";
    SAVE_CHANGES: "SAVE writes all parameters of the hand. After the next power-up these are not as before:", "保存会写入灵巧手的全部参数。下次上电后，以下各项与以前不同：";
    SAVE_FROM: "Until now", "以前";
    SAVE_TO: "Will be saved", "将保存";
    SAVE_STAGED: "Rows are staged and not applied. Save to flash applies them first.", "有暂存值尚未应用。保存到闪存时会先应用。";
    SAVE_NOT_APPLIED: "Not saved: not all that was staged is in force. Each row says why.", "未保存：暂存值未全部生效，原因见各行。";
    UNSAVED: "Not in flash yet:", "尚未写入闪存：";
    AGREE: "Save", "保存", "Proceeds with this list.", "按所列内容继续。";
    AGREE_APPLY_SAVE: "Apply and save", "应用并保存", "Proceeds with this list.", "按所列内容继续。";
    NEVER_SAVED: "This program saved nothing on this hand yet.", "本程序尚未在此灵巧手上保存过。";
    BY_FRAME: "confirmed by the hand", "灵巧手已确认";
    BY_READING: "read back the same", "读回一致";
    DOUBTFUL: "The result of a later SAVE is unknown:", "之后有一次保存结果未知：";
    UNREADABLE: "The record cannot be read:", "记录无法读取：";
    SAVE_CONFIRMED: "Saved: the hand reports its parameters in flash.", "已保存：灵巧手确认参数已写入闪存。";
    SAVE_READ_BACK: "Saved as far as this wire tells: acknowledged, and read back the same. Only the next power-up shows what is in flash.", "就此连接所知已保存：已应答且读回一致。只有下次上电才能看到闪存内容。";
    SAVE_FAILED: "Not saved: the hand reports that its flash failed.", "未保存：灵巧手报告写闪存失败。";
    SAVE_UNKNOWN: "Unknown whether it was saved:", "是否已保存未知：";
    SAVE_UNKNOWN_ADVICE: "Switch the hand off and on, then read again.", "请将灵巧手断电重启，然后重新读取。";
    SAVE_REFUSED: "Not saved, the hand refused:", "未保存，灵巧手拒绝：";
    SAVE_NOT_SENT: "Not saved, nothing was sent:", "未保存，未发送任何内容：";
    SAVE_NO_BACKUP: "Not saved, nothing was sent: the backup could not be written:", "未保存，未发送任何内容：备份无法写入：";
    SAVE_NOT_NOTED: "Could not be recorded:", "此结果无法记录：";
    SAVE_NO_RESULT: "the hand gave no result within 3 s.", "灵巧手 3 秒内没有给出结果。";
    SAVE_UNANSWERED: "the hand did not answer.", "灵巧手没有应答。";
    SAVE_NOT_READ: "its parameters could not be read back as they were.", "参数无法照原样读回。";
    SAVE_LINK: "the link was lost.", "连接断开。";

    DUMP: "Export to file", "导出到文件", "Writes what was read to a file of parameters.", "把读到的值写入参数文件。";
    OPEN: "Open file", "打开文件", "Shows a file of parameters beside the hand. Writes nothing.", "把参数文件与灵巧手对照显示，不写入任何内容。";
    BACKUPS: "Backups", "备份";
    BACKUP_OF: "Hand of the backup", "备份所属灵巧手";
    BACKUPS_NONE: "None yet. One is made before each save.", "还没有备份。每次保存前会自动备份。";
    BACKUP_TIP: "Shows this backup beside the hand. Writes nothing.", "把此备份与灵巧手对照显示，不写入任何内容。";
    COMPARED: "Beside the hand", "与灵巧手对照";
    IN_FILE: "In the file", "文件中";
    TAKE: "Take", "采用";
    TICK_TIP: "Stages this row with the others that are ticked.", "与其他勾选的行一起暂存。";
    TICK_PLACE_TIP: "Says where another hand may be found: tick it only if it is meant.", "可能是另一只灵巧手的通讯地址：确有需要才勾选。";
    STAGE_TICKED: "Stage ticked rows", "暂存勾选的行", "Puts the ticked rows beside what the hand holds. Writes nothing.", "把勾选的行放入暂存值，不写入任何内容。";
    STAGE_NONE: "No row is ticked.", "没有勾选任何行。";
    CLOSE_FILE: "Close", "关闭", "Goes back to the table.", "返回参数表。";
    SAME: "same", "相同";
    UNKNOWN_KEYS: "Keys that are not known:", "无法识别的字段：";
    WHY_DUMP: "dump", "导出";
    WHY_BEFORE_SAVE: "before save", "保存前";
    WHY_BEFORE_APPLY: "before apply", "应用前";
    WHY_BEFORE_RESET: "before reset", "复位前";

    /// Reason why it is not possible now.
    fn refusal(ParamRefusal) {
        ParamRefusal::NoHand => "No hand answers.", "没有灵巧手应答。";
        ParamRefusal::Armed => "The hand is armed: disarm it first.", "灵巧手已使能：请先取消使能。";
        ParamRefusal::Holding => "A stop is being confirmed.", "正在确认停止。";
        ParamRefusal::Moving => "The hand moves: wait until it rests.", "灵巧手在运动：请等它静止。";
        ParamRefusal::RestUnknown => "It is not known whether the hand rests: wait for its status.", "尚不清楚灵巧手是否静止：请等待状态更新。";
        ParamRefusal::Busy => "Something is under way.", "正在进行其他操作。";
        ParamRefusal::NothingToSave => "Nothing to save: the hand holds what was saved last.", "没有可保存的更改：灵巧手的值与上次保存的一致。";
        ParamRefusal::NothingStaged => "Nothing is staged that can be applied.", "没有可应用的暂存值。";
        ParamRefusal::NothingToUndo => "No apply of this session changed anything.", "本次没有可撤销的应用。";
        ParamRefusal::NoFolder => "There is no place for the backup.", "没有存放备份的位置。";
        ParamRefusal::NothingRead => "No row was read yet.", "尚未读取任何行。";
    }
}

/// Operation in progress; `None` if there is none.
pub(crate) const fn doing(doing: Doing) -> Option<Text> {
    match doing {
        Doing::Nothing | Doing::Asking => None,
        Doing::Reading => Some(READING),
        Doing::Applying => Some(APPLYING),
        Doing::BackingUp => Some(BACKING_UP),
        Doing::Saving => Some(SAVING),
    }
}

/// Name of a row within its group.
pub(crate) const fn name(id: ParamId) -> Text {
    match id {
        ParamId::HandId => HAND_ID,
        ParamId::ReduRatio => REDU_RATIO,
        ParamId::IpAddress => IP_ADDRESS,
        ParamId::DefaultSpeed(dof) | ParamId::DefaultForce(dof) => words::dof(dof),
    }
}

/// Name of a row without its group: `Index speed`.
pub(crate) fn whole_name(look: Look, id: ParamId) -> String {
    let own = look.tr(name(id));
    match id {
        ParamId::DefaultSpeed(_) => format!("{own} {}", look.tr(main::NAME_SPEED)),
        ParamId::DefaultForce(_) => format!("{own} {}", look.tr(FORCE)),
        _ => own.to_owned(),
    }
}

/// Description of a row's effect.
pub(crate) const fn about(id: ParamId) -> Text {
    match id {
        ParamId::HandId => ABOUT_HAND_ID,
        ParamId::ReduRatio => ABOUT_REDU_RATIO,
        ParamId::IpAddress => ABOUT_IP,
        ParamId::DefaultSpeed(_) => ABOUT_SPEED,
        ParamId::DefaultForce(_) => ABOUT_FORCE,
    }
}

/// Outcome for a row.
pub(crate) fn row_end(look: Look, end: &RowOutcome) -> String {
    let tr = |text| look.tr(text);
    match &end.verdict {
        RowVerdict::Applied => tr(APPLIED).into(),
        RowVerdict::Refused { reason } => format!(
            "{}: {} ({} {})",
            tr(NOT_TAKEN),
            errors::reason(look, *reason),
            tr(WANTED),
            end.wanted
        ),
        RowVerdict::Dropped => format!("{} ({} {})", tr(DROPPED), tr(WANTED), end.wanted),
        RowVerdict::Altered => format!("{} {}", tr(ALTERED), end.wanted),
        RowVerdict::PutBack => format!("{} {}", tr(PUT_BACK), end.wanted),
        RowVerdict::Unverified(doubt) => {
            let why = match doubt {
                Doubt::NotReadBack => DOUBT_NOT_READ,
                Doubt::Ambiguous => DOUBT_AMBIGUOUS,
                Doubt::LinkLost => SAVE_LINK,
            };
            format!("{}: {}", tr(UNVERIFIED), tr(why))
        }
        RowVerdict::NotSent(why) => {
            format!("{}: {}", tr(NOT_WRITTEN), not_sent(look, *why))
        }
    }
}

fn not_sent(look: Look, why: NotSent) -> String {
    let text = match why {
        NotSent::Armed => refusal(ParamRefusal::Armed),
        NotSent::Holding => refusal(ParamRefusal::Holding),
        NotSent::Moving => refusal(ParamRefusal::Moving),
        NotSent::RestUnknown => refusal(ParamRefusal::RestUnknown),
        NotSent::TooSoon { wait } => {
            let wait = wait.as_secs_f64().ceil();
            return format!("{} {wait} s", look.tr(TOO_SOON));
        }
    };
    look.tr(text).into()
}

/// Outcome of a SAVE.
pub(crate) fn save_end(look: Look, end: &Result<SaveReport, TaskError>) -> String {
    let report = match end {
        Ok(report) => report,
        Err(TaskError::NoBackup(why)) => {
            return look.tr_with(SAVE_NO_BACKUP, errors::backup(look, why));
        }
        Err(TaskError::NotAsked(error)) => {
            return look.tr_with(SAVE_NOT_SENT, errors::request(look, error));
        }
        Err(TaskError::NotApplied) => return look.tr(SAVE_NOT_APPLIED).into(),
        Err(error) => return errors::task(look, error),
    };
    let result = saved(look, &report.saved);
    match &report.not_noted {
        None => result,
        Some(error) => format!(
            "{result} {} {}",
            look.tr(SAVE_NOT_NOTED),
            errors::system_error(look, error)
        ),
    }
}

/// True if the parameters are saved, as far as the wire shows, and that was recorded.
pub(crate) const fn is_saved(end: &Result<SaveReport, TaskError>) -> bool {
    match end {
        Ok(report) => {
            report.not_noted.is_none() && matches!(report.saved, Saved::Confirmed | Saved::ReadBack)
        }
        Err(_) => false,
    }
}

pub(crate) fn saved(look: Look, saved: &Saved) -> String {
    let tr = |text| look.tr(text);
    match saved {
        Saved::Confirmed => tr(SAVE_CONFIRMED).into(),
        Saved::ReadBack => tr(SAVE_READ_BACK).into(),
        Saved::Failed { code } => format!("{} ({code})", tr(SAVE_FAILED)),
        Saved::Unknown { why } => {
            let why = match why {
                SaveDoubt::NoResult => SAVE_NO_RESULT,
                SaveDoubt::Unanswered => SAVE_UNANSWERED,
                SaveDoubt::NotReadBack => SAVE_NOT_READ,
                SaveDoubt::LinkLost => SAVE_LINK,
            };
            format!(
                "{} {} {}",
                tr(SAVE_UNKNOWN),
                tr(why),
                tr(SAVE_UNKNOWN_ADVICE)
            )
        }
        Saved::Refused { reason } => {
            format!("{} {}", tr(SAVE_REFUSED), errors::reason(look, *reason))
        }
        Saved::NotSent(why) => {
            format!("{} {}", tr(SAVE_NOT_SENT), not_sent(look, *why))
        }
    }
}

/// Reason why a file was written; unknown text is returned unchanged.
pub(crate) fn why(look: Look, why: &str) -> String {
    let known = [
        WHY_DUMP,
        WHY_BEFORE_SAVE,
        WHY_BEFORE_APPLY,
        WHY_BEFORE_RESET,
    ];
    let known = known.into_iter().find(|text| text.en == why);
    known.map_or_else(|| why.to_owned(), |text| look.tr(text).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::settings::{Language, Theme};
    use crate::params::values::Params;
    use crate::ui::theme::Palette;
    use std::path::PathBuf;
    use std::time::Duration;

    #[test]
    fn only_what_the_wire_can_tell_is_said_of_a_save() {
        let look = Look {
            palette: Palette::of(Theme::Dark),
            language: Language::En,
            side: crate::hand::kinematics::Side::Right,
        };
        let why = SaveDoubt::NoResult;
        let wait = Duration::from_millis(2100);
        for (saved, words, is_ok) in [
            (
                Saved::Confirmed,
                "the hand reports its parameters in flash",
                true,
            ),
            (Saved::ReadBack, "Only the next power-up shows", true),
            (Saved::Failed { code: 255 }, "Not saved", false),
            (
                Saved::Unknown { why },
                "no result within 3 s. Switch the hand off",
                false,
            ),
            (Saved::NotSent(NotSent::TooSoon { wait }), "wait 3 s", false),
        ] {
            let end = Ok(SaveReport {
                params: Params::default(),
                backup: PathBuf::new(),
                saved,
                not_noted: None,
            });
            let text = save_end(look, &end);
            assert!(text.contains(words), "{text}");
            assert_eq!(is_saved(&end), is_ok, "{text}");
        }
    }
}
