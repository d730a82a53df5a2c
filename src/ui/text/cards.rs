//! Sentences of the cards over the window. No layout, no numbers.

use crate::tasks::calibrate::CalibrationCondition;
use crate::ui::style::phrase::texts;

texts! {
    CANCEL: "Cancel", "取消", "Closes this card. Nothing is written.", "关闭此卡片，不写入任何内容。";
    CLOSE: "Done", "完成", "Closes this card.", "关闭此卡片。";
    TYPE: "To go on, type", "要继续，请输入";
    BACKUP: "Backup:", "备份：";
    NO_BACKUP: "No backup could be made, and nothing was written.", "无法备份，未写入任何内容。";

    CHANGE_ASKED: "Change where the hand is found?", "更改灵巧手的通讯地址？";
    CHANGING: "Change of where the hand is found", "灵巧手通讯地址的更改";
    NOW_AT: "Now at", "当前通讯地址";
    THEN_AT: "Then at", "更改后通讯地址";
    FOLLOWED: "A backup is kept first. Nothing is written if another hand answers at the new place. After the write the hand is looked for there, and unless you keep it within 15 s it goes back.", "先备份。若新位置已有其他灵巧手应答，则不写入。写入后到新位置寻找灵巧手；15 秒内不确认保留，就自动恢复。";
    POWERED: "A backup is kept first. The new value acts only after SAVE and power off and on; until then the hand answers where it is. Unless you keep it within 15 s it goes back.", "先备份。新值在保存并重新上电后才生效，在此之前灵巧手仍在原位置应答；15 秒内不确认保留，就自动恢复。";
    SAME_NETWORK: "At the new address this computer reaches it only from an address in the same network.", "更改后，本机须有同一网段的地址才能连接。";
    CHANGE: "Change", "更改", "Keeps a backup, then writes the new value.", "先备份，再写入新值。";
    LOOKING: "Looking for a hand at", "正在寻找灵巧手：";
    WRITING: "Writing at", "正在写入：";
    KEEP_TITLE: "Keep the change?", "保留更改？";
    KEEP_THERE: "The hand answers at its new place.", "灵巧手已在新位置应答。";
    KEEP_WAITS: "The hand took the new value and still answers where it was: it acts after SAVE, or after power off and on.", "灵巧手已接受新值，仍在原位置应答：保存后或重新上电后生效。";
    GOES_BACK_IN: "Goes back by itself in", "将自动恢复，剩余";
    KEEP: "Keep", "保留", "Leaves the hand at its new place. Next you are asked about flash.", "灵巧手留在新位置，接着询问是否写入闪存。";
    GO_BACK: "Go back", "恢复", "Writes the former value again.", "重新写入原来的值。";
    OFFER_TITLE: "Save it in the hand?", "保存到灵巧手？";
    OFFER: "Without SAVE the hand forgets the change when it is switched off, and is found here again:", "不保存的话，断电后灵巧手会忘记更改，并回到：";
    OFFER_ALL: "SAVE writes everything that the hand holds, these defaults too:", "保存会写入灵巧手的全部参数，包括以下默认值：";
    UNSAVED: "Until power off", "断电前有效", "Writes nothing into flash.", "不写入闪存。";
    SAVE: "Save", "保存", "Writes all parameters of the hand into its flash.", "把灵巧手的全部参数写入闪存。";
    GOING_BACK: "Going back", "正在恢复";
    OVER_OCCUPIED: "Another hand answers there. Nothing was written.", "另一只灵巧手已在该位置应答，未写入任何内容。";
    OVER_NOT_WRITTEN: "The hand was not reached. Nothing was written.", "未能联系灵巧手，未写入任何内容。";
    OVER_NOT_TAKEN: "The hand did not take the new value. It is where it was.", "灵巧手没有接受新值，仍在原位置。";
    OVER_BACK: "The hand holds the former value and answers where it was.", "灵巧手已恢复原值，并在原位置应答。";
    OVER_NOT_BACK: "The former value could not be written. The hand holds another one and answers here:", "无法写回原值。灵巧手现为其他值，并在此应答：";
    OVER_NOT_BACK_POWER: "Nothing is in flash: switched off and on it is found at the former place again.", "未写入闪存：断电再上电后会回到原位置。";
    OVER_KEPT: "The hand answers here:", "灵巧手在此应答：";
    OVER_UNSAVED: "It is not in flash: switched off and on the hand is found at the former place.", "未写入闪存：断电再上电后会回到原位置。";
    OVER_NOWHERE: "No hand answers at either place. Nothing is in flash: switch the hand off and on, and it is found at the former place again. If not, look for it in the Connection view.", "两个位置都没有应答。未写入闪存：请断电再上电，灵巧手会回到原位置。若仍找不到，请在连接视图中扫描。";
    OVER_UNSEEN: "SAVE was sent, and no hand answers at either place. Switch it off and on: then it is at one of these places:", "已发送保存，两个位置都没有应答。请断电再上电，灵巧手在以下位置之一：";
    OVER_WAITS: "Switch the hand off and on; then it is found here:", "请断电再上电，之后灵巧手在：";
    SAVED_UNKNOWN: "It is not known whether it is in flash. Switched off and on the hand is at one of these places:", "不确定是否已写入闪存。断电再上电后，灵巧手在以下位置之一：";
    TO_OLD: "Connect: former place", "连接原位置", "Connects there. Nothing is written.", "连接到该位置，不写入任何内容。";
    TO_NEW: "Connect: new place", "连接新位置", "Connects there. Nothing is written.", "连接到该位置，不写入任何内容。";

    RESET_TITLE: "Return to the factory's parameters?", "恢复出厂参数？";
    RESETTING_TITLE: "Return to the factory's parameters", "恢复出厂参数";
    RESET_WORDS: "Speeds and forces after power-up, id, serial speed and IP address return to what the factory set. A backup is kept first; afterwards the hand is looked for at the factory's place.", "上电速度与力、ID、波特率和 IP 地址都恢复为出厂值。先备份，之后到出厂位置寻找灵巧手。";
    RESET: "Reset", "恢复出厂", "Keeps a backup, then sends RESET_PARA.", "先备份，再发送 RESET_PARA。";
    RESET_SENDING: "The hand returns to the factory's parameters", "灵巧手正在恢复出厂参数";
    RESET_FOUND: "The hand holds the factory's parameters and answers here:", "灵巧手已恢复出厂参数，并在此应答：";
    RESET_LEFT: "The hand was reset and these are not as at delivery; some act after power off and on:", "已恢复出厂，以下参数与出厂值不同，部分要重新上电后生效：";
    RESET_IGNORED: "The hand ignored the reset, as a whole or in part. These are still not as at delivery:", "灵巧手没有执行或没有完全执行恢复出厂，以下参数仍与出厂值不同：";
    RESET_UNCHANGED: "The hand holds what it held before: either that is what the factory set, or it ignored the reset. The manual prints no factory speeds and forces.", "灵巧手的参数与之前相同：要么原本就是出厂值，要么没有执行恢复出厂。手册未给出出厂的速度与力。";
    RESET_NOT_READ: "The reset was sent. What the hand holds now is not known, because it could not be read:", "已发送恢复出厂。由于读取失败，灵巧手现在的参数未知：";
    RESET_REFUSED: "The hand refused it. Nothing was changed.", "灵巧手拒绝，未作任何更改。";
    RESET_NOT_SENT: "It was not sent. Nothing was changed.", "未发送，未作任何更改。";
    RESET_NOWHERE: "It was sent, and no hand answers at the factory's place or at the former one. Switch the hand off and on, then connect or look for it in the Connection view: id 1, 115200 baud, address 192.168.11.210.", "已发送，但出厂位置和原位置都没有应答。请断电再上电，然后连接，或在连接视图中扫描：ID 1，波特率 115200，地址 192.168.11.210。";
    RESET_ENTRY: "Factory reset", "恢复出厂", "Asks first. Returns the hand to the parameters of its delivery.", "先询问，再把灵巧手恢复为出厂参数。";

    CALIBRATE_TITLE: "Calibrate the force sensors", "校准力传感器";
    CALIBRATE_WORDS: "The hand sets its current forces as zero in 2 to 6 s, and nothing else moves it meanwhile. Open it, and let it touch nothing.", "灵巧手把当前的力作为零点，需 2 到 6 秒，期间不会运动。请张开手，不要接触任何物体。";
    CALIBRATE: "Calibrate", "校准", "Sends GESTURE_FORCE_CLB.", "发送 GESTURE_FORCE_CLB。";
    CALIBRATE_NOT_YET: "Not all of it is met.", "条件尚未全部满足。";
    CALIBRATE_ENTRY: "Calibrate force", "力校准", "Opens a card that checks the conditions first.", "打开卡片，先检查所需条件。";
    CALIBRATING: "The hand calibrates its force sensors", "灵巧手正在校准";
    MEASURING: "Measuring the new zero", "正在测量新的零点";
    CALIBRATED: "The hand reports that it is done.", "灵巧手报告校准完成。";
    CALIBRATED_QUIET: "The hand accepted it and had 8 s; no frame reports that it is done. Judge by the forces.", "灵巧手已接受，等待了 8 秒；没有完成报文，请以力的数值判断。";
    CALIBRATED_REFUSED: "The hand refused it.", "灵巧手拒绝校准。";
    CALIBRATED_UNKNOWN: "It is not known whether the sensors were calibrated: check the forces of the open hand.", "不确定是否已校准：请查看手张开时的力。";
    CALIBRATED_NOT_SENT: "It was not sent.", "未发送。";
    JOINT: "Joint", "自由度";
    OFFSET_NOW: "Force, g", "力 g";
    OFFSET_BEFORE: "Before, g", "校准前 g";
    OFFSET_AFTER: "After, g", "校准后 g";

    /// Precondition of a calibration.
    fn check(CalibrationCondition) {
        CalibrationCondition::Open => "Fingers and thumb are open", "手指和大拇指已张开";
        CalibrationCondition::Still => "No joint moves", "各自由度静止";
        CalibrationCondition::Untouched => "Nothing is touched", "没有接触物体";
        CalibrationCondition::Steady => "The force is steady for 2 s", "力稳定 2 秒";
        CalibrationCondition::NoFault => "No drive has a fault", "驱动器没有故障";
        CalibrationCondition::Disarmed => "The hand is not armed", "灵巧手未使能";
    }
}
