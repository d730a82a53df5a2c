//! Sentences of recordings: the list, the timeline, the lamp in the header.

use crate::app::recordings::RecordingItem;
use crate::app::settings::{Language, Settings};
use crate::app::state::State;
use crate::hand::kinematics::Side;
use crate::record::EventKind;
use crate::record::export::ExportFormat;
use crate::store::calendar;
use crate::ui::style::Look;
use crate::ui::style::phrase::texts;
use crate::ui::text::{panels, words};
use std::time::Duration;

texts! {
    TITLE: "Recordings", "录制";
    FIND: "Find recordings", "查找录制", "name, hand, day, note or fault", "名称、灵巧手、日期、备注或故障";
    FIND_NONE: "No recording has these words.", "没有包含这些文字的录制。";
    NONE_TITLE: "No recordings yet", "还没有录制";
    NONE: "What a hand does is recorded here by itself once it is connected; built-in hands only if you ask for it.", "连接真实灵巧手后会自动录制；仿真手只在您要求时录制。";
    NONE_RECORD: "Record this hand", "录制此灵巧手", "Records this hand until you end it in the header.", "录制此灵巧手，直到在标题栏中停止。";
    NONE_BUTTON: "Connect a hand", "连接灵巧手", "Opens the Connection view.", "打开连接灵巧手的页面。";
    NOWHERE: "There is no folder to record into: this computer has no documents folder.", "没有可供录制的文件夹：此计算机未提供您的文档目录。";
    FOLDER: "Folder", "文件夹", "Where recordings are stored. A running one stays in its file; the next goes into a newly chosen folder.", "录制的保存位置。正在进行的录制保留在原文件中；下一次录制使用新文件夹。";
    FOLDER_CHANGE: "Change ...", "更改……", "Chooses the folder for recordings.", "选择录制文件夹。";
    FOLDER_DEFAULT: "Default", "默认", "Records into your documents again.", "恢复录制到您的文档目录。";
    FOLDER_IS_DEFAULT: "This is the default folder.", "已是默认文件夹。";
    FOLDER_PATH: "Path of the folder", "文件夹路径", "type the path of the folder here", "在此输入文件夹路径";
    FOLDER_TAKE: "Record here", "录制到此处", "Records into the typed folder. Enter does the same.", "录制到所输入的文件夹。按回车作用相同。";
    LOOKS: "Looking for recordings ...", "正在查找录制……";
    OPEN_OTHER: "Another file", "其他文件", "Opens a recording by its path; it can also be dropped onto the window.", "按路径打开录制文件；也可将文件拖入窗口。";

    TODAY: "today", "今天";
    YESTERDAY: "yesterday", "昨天";
    TRIALS_COUNT: "{} trials", "{} 次试验";
    TRIAL_ONE: "1 trial", "1 次试验";
    SIMULATED_HAND: "Simulated hand", "仿真手";
    AT_MOMENT: "{}   {} g", "{}   {} g";
    STRIP: "Force over time", "受力时间条", "Greatest force of any joint over the recording, with faults, stops and notes. Drag to mark a stretch and export it.", "整个录制中各自由度的最大受力，并标出故障、停止与备注。拖动可选择一段并导出。";
    EXPORT_PART: "Export the marked {}", "导出选中的 {}";
    EXPORTING: "Exporting {}: {} %", "正在导出 {}：{} %";
    NOT_EXPORTED: "Not exported: {}: {}", "未能导出：{}：{}";
    NAME: "Recording", "录制";
    LENGTH: "Length", "时长";
    FORCE: "Force", "受力", "Greatest force of any joint over the recording.", "整个录制中各自由度的最大受力。";
    FAULTS: "Faults", "故障";
    TRIALS: "Trials", "试验";
    NOTES: "Notes", "备注";
    SIZE: "Size", "大小";
    STAR: "Keep", "收藏", "A recording with a star, a name or notes is never deleted to make room.", "带星标、名称或备注的录制不会为腾出空间而被删除。";
    UNSTAR: "Kept: press to remove the star.", "已收藏：按下取消星标。";
    REPLAY: "Replay", "回放", "Shows this recording in the whole window. The hand stays connected behind it.", "在整个窗口中回放此录制。灵巧手在后台保持连接。";
    REPLAY_STRETCH: "Replay", "回放", "Replays the recording from two seconds before, this stretch again and again.", "从此前两秒开始循环回放录制的这一段。";
    REPLAY_NONE: "No recording of this session holds it.", "本次运行录制中没有这一段。";
    MORE: "More", "更多", "Rename, show in the folder, export, delete.", "重命名、打开所在文件夹、导出、删除。";
    RENAME: "Name of the recording", "录制名称", "a name of your own", "自定义名称";
    REVEAL: "Show in folder", "在文件夹中显示", "Shows the file in the system's file manager.", "在系统文件管理器中显示此文件。";
    EXPORT: "Export the whole recording", "导出整个录制";
    NOT_DELETED: "Could not be deleted:", "无法删除：";
    NOT_REVEALED: "The file manager did not start: {}. The file is {}", "无法启动文件管理器：{}。文件位于 {}";
    COPY_PATH: "Copy path", "复制路径", "Copies the file's path.", "复制文件所在位置。";
    DELETE: "Delete ...", "删除……", "Asks before anything is deleted.", "删除前会先询问。";
    DELETE_TITLE: "Delete this recording?", "删除此录制？";
    DELETE_WHAT: "The recording of {} is lost for good.", "{} 的录制将永久丢失。";
    DELETE_NOT: "Keep it", "保留";
    DELETE_SURE: "Delete the recording", "删除录制";
    UNCLOSED: "not closed", "未关闭", "The program that recorded it was cut off, or still records. All but the last quarter of a second is there.", "录制程序被中断，或仍在录制。除最后四分之一秒外均已保存。";
    RECORDS_NOW: "is being recorded", "正在录制";
    SIMULATED: "simulated", "仿真";
    UNREAD: "{} files here cannot be read.", "此处有 {} 个文件无法读取。";
    TOTAL: "Recordings: {}. Room: {} of {} GB.", "录制：{} 个。空间：已用 {}，共 {} GB。";
    PLANNED: "Recordings exceed their room. The {} oldest without star, name or notes ({}, recorded {} to {}) are deleted when a recording begins after {}. The Recordings tab shows them and can keep them.", "录制占用空间超出限额。最早的 {} 个没有星标、名称或备注的录制（{}，录制于 {} 至 {}）将在 {} 之后开始录制时删除。可在“录制”中查看并保留。";
    BEYOND: "More than fits: the {} oldest ({}) go when a recording begins after {}.", "超出限额：最早的 {} 个录制（{}）将在 {} 之后开始录制时删除。";
    GOES: "Goes to make room, not before {}. A star, a name or a note keeps it.", "为腾出空间将被删除，不早于 {}。星标、名称或备注可将其保留。";
    ROOM_NOW: "Delete now", "立即删除", "Deletes the oldest recordings without star, name or notes until the rest fits.", "删除最早的没有星标、名称或备注的录制，直到不超限额。";
    ROOM_KEEP: "Keep them", "全部保留", "Gives each of them a star, so that none is deleted by itself.", "为这些录制全部加星标，使其不会被自动删除。";

    RECORDING: "Recording", "录制中", "Readings and commands go to disk as they happen. Press to stop recording.", "灵巧手的反馈与指令正在实时写入磁盘。按下停止录制。";
    NOT_RECORDING: "Not recording", "未录制", "Press to record readings and commands.", "按下开始录制灵巧手的反馈与指令。";
    STALLED: "Recording stalled, new data is not on disk: {}. Retrying.", "录制受阻，当前数据没有写入磁盘：{}。程序会重试。";
    TROUBLE: "Recording stalled", "录制受阻", "The disk does not accept the recording. Retrying; what does not fit in memory is counted and noted in the file.", "磁盘无法写入录制数据。程序会重试；内存中放不下的数据会被计数并在文件中注明。";
    FILE: "File: {}", "文件：{}";
    RATE: "{} MB so far, {} MB an hour", "已录 {} MB，每小时 {} MB";
    MISSING: "{} entries are missing", "缺失 {} 条记录";

    RECORDED: "RECORDED", "回放", "This is a recording. Nothing is sent; STOP stops the live hand.", "这是录制内容，不会发送任何指令；“停止”作用于实际连接的灵巧手。";
    BACK: "Back to live", "返回实时", "Shows the live hand again.", "重新显示实时灵巧手。";
    BACK_EYES: "Back to live: it moves!", "返回实时：手在动！";
    LINE: "Time line", "时间轴", "Drag to go to a moment; with Shift, to choose the stretch that is played again and again.", "拖动到某一时刻；按住 Shift 拖动可选择循环播放的区段。";
    RUN: "Play", "播放", "Resumes replay.", "开始播放。";
    PAUSE: "Pause", "暂停", "Pauses the replay.", "暂停播放。";
    STEP_ON: "Next reading", "下一次读数", "Goes to the next reading of the angles.", "跳到下一次角度读数。";
    STEP_BACK: "Reading before", "上一次读数", "Goes to the reading of the angles before this.", "跳到上一次角度读数。";
    PACE: "Pace", "速度", "The replay speed.", "播放速度。";
    LOOP_OFF: "Loop off", "取消循环", "Plays all of it again.", "恢复完整播放。";
    EVENTS: "Marks", "标记", "Faults, stops, notes and trials of this recording: press one to go there.", "此录制的故障、停止、备注和试验：点击跳转。";
    NO_TRIALS: "This recording has no trials.", "此录制没有试验。";
    NO_EVENTS: "Nothing is marked in this recording.", "此录制没有标记。";
    BESIDE: "Compare with", "对比录制", "Draws another recording over this one, dashed, in all plots.", "在所有曲线图中以虚线叠加另一录制。";
    BESIDE_OFF: "Stop comparing", "取消对比";
    BESIDE_NONE: "There is no other recording.", "没有其他录制。";
    ALIGN: "Align", "对齐", "Lays a mark of each recording over the other.", "将两个录制各自的一个标记对齐。";
    ALIGN_OWN: "This recording, at", "本录制，位于";
    ALIGN_OTHER: "The other, at", "另一录制，位于";
    BEGINNING: "its beginning", "开头";
    THIS_MOMENT: "the moment shown", "当前时刻";
    NOTE_HERE: "Note here", "在此添加备注", "what is visible here", "此处值得注意的内容";
    DAMAGED: "A part of this file cannot be read and is left out.", "此文件有一部分无法读取，已略过。";
    REFUSED: "{} cannot be replayed: {}.", "无法回放 {}：{}。";
    NOT_MCAP: "it is not an MCAP file", "它不是 MCAP 文件";
    NOT_A_FILE: "it is not a regular file", "它不是文件，而是文件夹或设备";
    FOREIGN: "it is an MCAP file of another program", "它是其他程序的 MCAP 文件";
    FILE_MOVED: "{} was renamed during recording. It continues as {}; nothing is lost.", "正在录制的文件 {} 被改名，将继续写入 {}，没有丢失内容。";
    FILE_RENAMED: "{} was renamed during recording. It continues under its new name; nothing is lost.", "正在录制的文件 {} 被改名，将以新名称继续写入，没有丢失内容。";
    FILE_REMOVED: "{} was removed during recording: {} entries are lost. The recording continues in a new file.", "正在录制的文件 {} 被删除：其中 {} 条记录已丢失。录制将在新文件中继续。";
    CLOCK_SET: "The computer's clock was set, or it slept: recording continues in {}.", "计算机时钟被调整或曾休眠：录制将在 {} 中继续。";
    SEVERAL_HANDS: "it holds recordings of several hands, whose values cannot be told apart: {}", "其中混有多只灵巧手的录制，数值无法区分：{}";
    TOO_MUCH: "it unpacks to more than the limit", "解压后的数据量超过任何录制";
    EMPTY: "nothing in it can be read", "其中没有可读取的内容";
    IS_RECORDING: "This is a recording: nothing was sent. Go back to the live hand first.", "这是录制内容：没有发送任何指令。请先返回实时灵巧手。";
    NOT_NOW: "Not replayed now: a series of trials or a question about the hand must be ended first.", "现在不能回放：请先结束抓取试验或完成关于灵巧手的询问。";
    DELETED: "Recordings deleted:", "已删除录制：";
    SIM_TOO: "Record built-in hands, too", "也录制仿真手", "Simulated hands are recorded, too, and their recordings are marked.", "仿真手也会被录制，其录制会有标记。";

    UNCOMMANDED: "Data set without commands (LeRobot)", "无指令的数据集（LeRobot）", "Also if no joint was commanded: the action in it never changes, and says nothing about what moved the hand.", "即使没有向任何自由度发过指令也会导出：其中的动作始终不变，不能说明是什么使灵巧手运动。";

    /// Export formats of a recording.
    fn export_format(ExportFormat) {
        ExportFormat::Csv => "Table (CSV)", "表格（CSV）";
        ExportFormat::Parquet => "Table (Parquet)", "表格（Parquet）";
        ExportFormat::Rosbag => "Folder for ROS 2 (rosbag2)", "ROS 2 文件夹（rosbag2）";
        ExportFormat::LeRobot => "Data set (LeRobot)", "数据集（LeRobot）";
        ExportFormat::Mcap => "Recording file (MCAP)", "录制文件（MCAP）";
    }
}

/// Title of a recording: its own name, else the joints tried in it or its hand.
pub(crate) fn what(look: Look, settings: &Settings, item: &RecordingItem) -> String {
    if !item.about.name.is_empty() {
        return item.about.name.clone();
    }
    let joints = item.tried().into_iter();
    let joints = joints.map(|dof| look.tr(words::dof(dof)).to_owned());
    let trials = match item.count(EventKind::Trial) {
        0 => None,
        1 => Some(look.tr(TRIAL_ONE).to_owned()),
        count => Some(look.fill(TRIALS_COUNT, &[&count])),
    };
    let all: Vec<String> = joints.chain(trials).collect();
    if !all.is_empty() {
        return listed(look, &all);
    }
    let endpoint = item.opening.hand.parse().ok();
    let name = endpoint.as_ref().and_then(|hand| settings.hand_name(hand));
    let hand = match item.opening.side {
        _ if item.opening.simulated => SIMULATED_HAND,
        Side::Right => panels::RIGHT_HAND,
        Side::Left => panels::LEFT_HAND,
    };
    name.unwrap_or(look.tr(hand)).to_owned()
}

/// Local start time of a recording, `today 20:21`; `None` if it is unknown.
pub(crate) fn when(look: Look, item: &RecordingItem, now_since_1970: Duration) -> Option<String> {
    if item.opening.is_imported() {
        return None;
    }
    let (day, time) = calendar::local(item.opening.began_since_1970());
    let is_day = |ago: u32| {
        let then = now_since_1970.saturating_sub(ago * Duration::from_secs(24 * 3600));
        calendar::local(then).0 == day
    };
    Some(match (is_day(0), is_day(1)) {
        (true, _) => format!("{} {time}", look.tr(TODAY)),
        (_, true) => format!("{} {time}", look.tr(YESTERDAY)),
        _ => format!("{day} {time}"),
    })
}

/// Title and start time in one line.
pub(crate) fn title(look: Look, state: &State, item: &RecordingItem) -> String {
    let what = what(look, &state.settings, item);
    let when = when(look, item, state.recordings.scanned_at);
    let all: Vec<String> = std::iter::once(what).chain(when).collect();
    listed(look, &all)
}

fn listed(look: Look, all: &[String]) -> String {
    all.join(match look.language {
        Language::En => ", ",
        Language::Zh => "，",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::recordings::RecordingAbout;
    use crate::hand::Moment;
    use crate::record::file::{Counts, FileMark, Opening};

    fn item(began_s: u64, trials: &[&str]) -> RecordingItem {
        let mark = |words: &&str| FileMark {
            at: Moment::ZERO,
            kind: EventKind::Trial,
            words: (*words).to_owned(),
        };
        RecordingItem {
            path: "file.mcap".into(),
            files: Vec::new(),
            bytes: 0,
            opening: Opening {
                base_nanos: began_s * 1_000_000_000,
                version: "test".into(),
                hand: "rs485:COM1".into(),
                ..Opening::unknown(0)
            },
            first: Moment::ZERO,
            length: Duration::ZERO,
            counts: Counts::default(),
            marks: trials.iter().map(mark).collect(),
            strip: Vec::new(),
            poses: std::sync::Arc::default(),
            closed: true,
            about: RecordingAbout::default(),
        }
    }

    #[test]
    fn a_recording_is_named_by_what_was_done_and_when_on_the_clock_here() {
        const DAY_S: u64 = 24 * 3600;
        let mut state = State::default();
        state.recordings.scanned_at = Duration::from_secs(20_000 * DAY_S);
        let look = Look::of(&state);
        let time = |began_s| calendar::local(Duration::from_secs(began_s)).1;
        let now = 20_000 * DAY_S;
        let all = item(now, &["1 of 2, index, middle", "2 of 2, index, middle"]);
        let text = title(look, &state, &all);
        assert_eq!(
            text,
            format!("Middle, Index, 2 trials, today {}", time(now))
        );
        let one = item(now - DAY_S, &["1 of 1"]);
        let text = title(look, &state, &one);
        assert_eq!(text, format!("1 trial, yesterday {}", time(now)));
        let (day, hour) = calendar::local(Duration::from_secs(now - 9 * DAY_S));
        let mut none = item(now - 9 * DAY_S, &[]);
        assert_eq!(
            title(look, &state, &none),
            format!("Right hand, {day} {hour}")
        );
        none.about.name = "sponge".into();
        assert_eq!(title(look, &state, &none), format!("sponge, {day} {hour}"));
        assert_eq!(
            title(look, &state, &item(2 * DAY_S, &[]))
                .matches("1970")
                .count(),
            1
        );
    }
}
