//! Sentences of recorded sessions: the list, the time line, the lamp in the header.

use crate::app::sessions::SessionForm;
use crate::ui::style::phrase::texts;

texts! {
    TITLE: "Sessions", "会话";
    FIND: "Find sessions", "查找会话", "name, hand, day, note or fault", "名称、灵巧手、日期、备注或故障";
    FIND_NONE: "No session has these words.", "没有包含这些文字的会话。";
    NONE: "No session has been recorded yet. What a hand does is recorded here by itself; built-in hands only if you ask for it.", "还没有录制的会话。连接真实灵巧手后会自动录制；仿真手只在您要求时录制。";
    NOWHERE: "There is no folder to record into: this computer names no documents of yours.", "没有可供录制的文件夹：此计算机未提供您的文档目录。";
    FOLDER: "Folder", "文件夹", "Where sessions are recorded. A recording that runs stays in its file; the next goes into a newly chosen folder.", "会话的录制位置。正在进行的录制保留在原文件中；下一次录制使用新文件夹。";
    FOLDER_CHANGE: "Change ...", "更改……", "Chooses the folder for sessions.", "选择会话文件夹。";
    FOLDER_DEFAULT: "Default", "默认", "Records into your documents again.", "恢复录制到您的文档目录。";
    FOLDER_IS_DEFAULT: "This is the default folder.", "已是默认文件夹。";
    FOLDER_PATH: "Path of the folder", "文件夹路径", "type the path of the folder here", "在此输入文件夹路径";
    FOLDER_TAKE: "Record here", "录制到此处", "Records into the folder that was typed. Enter does the same.", "录制到所输入的文件夹。按回车作用相同。";
    LOOKS: "Looking for sessions ...", "正在查找会话……";
    OPEN_OTHER: "Another file", "其他文件", "Opens a recording by its path; it can also be dropped onto the window.", "按路径打开录制文件；也可将文件拖入窗口。";

    BEGAN: "Began (UTC)", "开始时间 (UTC)";
    NAME: "Session", "会话";
    LENGTH: "Length", "时长";
    FORCE: "Force", "受力", "Greatest force of any joint over the session.", "整个会话中各自由度的最大受力。";
    FAULTS: "Faults", "故障";
    TRIALS: "Trials", "试验";
    NOTES: "Notes", "备注";
    SIZE: "Size", "大小";
    STAR: "Keep", "收藏", "A session with a star, a name or notes is never deleted to make room.", "带星标、名称或备注的会话不会为腾出空间而被删除。";
    UNSTAR: "Kept: press to take the star away.", "已收藏：按下取消星标。";
    REPLAY: "Replay", "回放", "Shows this session in the whole window. The hand stays connected behind it.", "在整个窗口中回放此会话。灵巧手在后台保持连接。";
    REPLAY_STRETCH: "Replay", "回放", "Replays the recorded session from two seconds before, this stretch again and again.", "从此前两秒开始循环回放录制会话的这一段。";
    REPLAY_NONE: "No session of this run of the program holds it.", "本次运行录制的会话中没有这一段。";
    MORE: "More", "更多", "Rename, show in the folder, export, delete.", "重命名、打开所在文件夹、导出、删除。";
    RENAME: "Name of the session", "会话名称", "a name of your own", "自定义名称";
    REVEAL: "Show in folder", "在文件夹中显示", "Shows the file in the system's file manager.", "在系统文件管理器中显示此文件。";
    EXPORT: "Export the whole session", "导出整个会话";
    NOT_DELETED: "Could not be deleted:", "无法删除：";
    NOT_REVEALED: "The file manager did not start: {}. The file is {}", "无法启动文件管理器：{}。文件位于 {}";
    COPY_PATH: "Copy path", "复制路径", "Copies where the file lies.", "复制文件所在位置。";
    DELETE: "Delete ...", "删除……", "Asks before anything is deleted.", "删除前会先询问。";
    DELETE_TITLE: "Delete this session?", "删除此会话？";
    DELETE_WHAT: "The recording of {} is lost for good.", "{} 的录制将永久丢失。";
    DELETE_NOT: "Keep it", "保留";
    DELETE_SURE: "Delete the recording", "删除录制";
    UNCLOSED: "not closed", "未关闭", "The program that recorded it was cut off, or still records. All but the last quarter of a second is there.", "录制程序被中断，或仍在录制。除最后四分之一秒外均已保存。";
    RECORDS_NOW: "is being recorded", "正在录制";
    SIMULATED: "simulated", "仿真";
    UNREAD: "{} files here cannot be read.", "此处有 {} 个文件无法读取。";
    TOTAL: "Sessions: {}. Room: {} of {} GB.", "会话：{} 个。空间：已用 {}，共 {} GB。";
    PLANNED: "Recorded sessions need more room than they may. The {} oldest without star, name or notes ({}, recorded {} to {}) are deleted when a recording begins after {} UTC. The view Sessions shows them and keeps them if you like.", "录制的会话占用空间超出限额。最早的 {} 个没有星标、名称或备注的会话（{}，录制于 {} 至 {}）将在 {} UTC 之后开始录制时删除。可在“会话”视图中查看并保留。";
    BEYOND: "More than fits: the {} oldest ({}) go when a recording begins after {} UTC.", "超出限额：最早的 {} 个会话（{}）将在 {} UTC 之后开始录制时删除。";
    GOES: "Goes to make room, not before {} UTC. A star, a name or a note keeps it.", "为腾出空间将被删除，不早于 {} UTC。星标、名称或备注可将其保留。";
    ROOM_NOW: "Delete now", "立即删除", "Deletes the oldest sessions without star, name or notes until the rest fits.", "删除最早的没有星标、名称或备注的会话，直到不超限额。";
    ROOM_KEEP: "Keep them", "全部保留", "Gives each of them a star, so that none is deleted by itself.", "为这些会话全部加星标，使其不会被自动删除。";

    RECORDING: "Recording", "录制中", "What the hand says and what it is told goes to disk as it happens. Press to record no longer.", "灵巧手的反馈与指令正在实时写入磁盘。按下停止录制。";
    NOT_RECORDING: "Not recording", "未录制", "Press to record what the hand says and what it is told.", "按下开始录制灵巧手的反馈与指令。";
    TROUBLE: "Recording stalled", "录制受阻", "The disk does not take what is recorded. It is tried again; what finds no room in memory is counted and said in the file.", "磁盘无法写入录制数据。程序会重试；内存中放不下的数据会被计数并在文件中注明。";
    FILE: "File: {}", "文件：{}";
    RATE: "{} MB so far, {} MB an hour", "已录 {} MB，每小时 {} MB";
    MISSING: "{} entries are missing", "缺失 {} 条记录";

    RECORDED: "RECORDED", "回放", "This is a recording. Nothing is sent; STOP stops the live hand.", "这是录制内容，不会发送任何指令；“停止”作用于实际连接的灵巧手。";
    BACK: "Back to live", "返回实时", "Shows the live hand again.", "重新显示实时灵巧手。";
    BACK_EYES: "Back to live: it moves!", "返回实时：手在动！";
    LINE: "Time line", "时间轴", "Drag to go to a moment; with Shift, to choose the stretch that is played again and again.", "拖动到某一时刻；按住 Shift 拖动可选择循环播放的区段。";
    RUN: "Play", "播放", "Lets time go on.", "开始播放。";
    PAUSE: "Pause", "暂停", "Time stands still.", "暂停播放。";
    STEP_ON: "Next reading", "下一次读数", "Goes to the next reading of the angles.", "跳到下一次角度读数。";
    STEP_BACK: "Reading before", "上一次读数", "Goes to the reading of the angles before this.", "跳到上一次角度读数。";
    PACE: "Pace", "速度", "How fast time goes.", "播放速度。";
    LOOP_OFF: "Loop off", "取消循环", "Plays all of it once again.", "恢复完整播放。";
    EVENTS: "Marks", "标记", "Faults, stops, notes and trials of this session: press one to go there.", "此会话的故障、停止、备注和试验：点击跳转。";
    NO_EVENTS: "Nothing is marked in this session.", "此会话没有标记。";
    BESIDE: "Compare with", "对比会话", "Draws another session over this one, dashed, in all plots.", "在所有曲线图中以虚线叠加另一会话。";
    BESIDE_OFF: "Compare no longer", "取消对比";
    BESIDE_NONE: "There is no other session.", "没有其他会话。";
    ALIGN: "Align", "对齐", "Lays a mark of each session over the other.", "将两个会话各自的一个标记对齐。";
    ALIGN_OWN: "This session, at", "本会话，位于";
    ALIGN_OTHER: "The other, at", "另一会话，位于";
    BEGINNING: "its beginning", "开头";
    THIS_MOMENT: "the moment shown", "当前时刻";
    NOTE_HERE: "Note here", "在此添加备注", "what is to be seen here", "此处值得注意的内容";
    DAMAGED: "A part of this file cannot be read and is left out.", "此文件有一部分无法读取，已略过。";
    REFUSED: "{} cannot be replayed: {}.", "无法回放 {}：{}。";
    NOT_MCAP: "it is not an MCAP file", "它不是 MCAP 文件";
    NOT_A_FILE: "it is no file, but a folder or a device", "它不是文件，而是文件夹或设备";
    FOREIGN: "it is an MCAP file of another program", "它是其他程序的 MCAP 文件";
    FILE_MOVED: "{} was renamed while it is recorded. It is written on as {}; nothing is lost.", "正在录制的文件 {} 被改名，将继续写入 {}，没有丢失内容。";
    FILE_RENAMED: "{} was renamed while it is recorded. It is written on under its new name; nothing is lost.", "正在录制的文件 {} 被改名，将以新名称继续写入，没有丢失内容。";
    FILE_REMOVED: "{} was removed while it was recorded: {} entries are gone with it. The recording goes on in a new file.", "正在录制的文件 {} 被删除：其中 {} 条记录已丢失。录制将在新文件中继续。";
    CLOCK_SET: "The computer's clock was set, or it slept: the recording goes on in {}.", "计算机时钟被调整或曾休眠：录制将在 {} 中继续。";
    SEVERAL_HANDS: "it holds recordings of several hands, whose values cannot be told apart: {}", "其中混有多只灵巧手的录制，数值无法区分：{}";
    EMPTY: "nothing in it can be read", "其中没有可读取的内容";
    IS_RECORDING: "This is a recording: nothing was sent. Go back to the live hand first.", "这是录制内容：没有发送任何指令。请先返回实时灵巧手。";
    NOT_NOW: "Not replayed now: a series of trials or a question about the hand must be ended first.", "现在不能回放：请先结束抓取试验或完成关于灵巧手的询问。";
    DELETED: "Sessions deleted:", "已删除会话：";
    SIM_TOO: "Record built-in hands, too", "也录制仿真手", "Simulated hands are recorded, too, and their sessions are marked.", "仿真手也会被录制，其会话会有标记。";

    /// The formats that a session can be exported in.
    fn form(SessionForm) {
        SessionForm::Csv => "Table (CSV)", "表格（CSV）";
        SessionForm::Parquet => "Table (Parquet)", "表格（Parquet）";
        SessionForm::Rosbag => "Folder for ROS 2 (rosbag2)", "ROS 2 文件夹（rosbag2）";
        SessionForm::LeRobot => "Data set (LeRobot)", "数据集（LeRobot）";
        SessionForm::Mcap => "Session file (MCAP)", "会话文件（MCAP）";
    }
}
