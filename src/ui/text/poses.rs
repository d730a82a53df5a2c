//! Sentences of the poses, the sequences and the hand's own gestures.

use crate::hand::gap::{GripKind, NotOffered};
use crate::ui::style::phrase::texts;

texts! {
    MY_POSES: "My poses", "我的姿态";
    SEQUENCES: "Sequences", "动作序列";
    SHIPPED: "Built in", "内置";
    SHIPPED_ABOUT: "These come with the program and cannot be changed or lost. Copy one to change it: your own by the same name takes its place.", "这些随程序提供，不会被更改或丢失。复制后即可修改：同名的自有姿态会取而代之。";
    COPY: "Copy", "复制", "Puts a copy among your own, to be changed.", "复制一份到自己的姿态中，以便修改。";
    COPY_REACTION: "Reactions are written in a file, see the page Files of the manual.", "触摸反应写在文件中，见手册“文件”一页。";
    HIDE: "Hide", "隐藏", "Hides it in the Live view.", "不在实时中显示。";
    SHOW: "Show", "显示", "Shows it in the Live view.", "重新在实时中显示。";
    OVERRIDDEN: "One of your own by the same name is shown in its place.", "已由同名的自有姿态代替。";
    IN_HAND: "In the hand", "手内手势";
    SECTION_TIP: "Shows this part.", "显示这一部分。";
    POSE: "Pose", "姿态";
    SEQUENCE: "Sequence", "序列";
    REACTION: "Demo", "演示";
    STRIP: "Poses and demos", "姿态与演示";
    EVERY: "All poses", "全部姿态", "Opens all poses, sequences and gestures.", "打开全部姿态、序列与手势。";

    STRIP_GESTURES: "Gestures", "手内手势", "Shows the gestures that are stored in the hand.", "显示手内存储的手势。";
    GRIP_SIZE: "Grip by size", "按尺寸抓握", "Closes thumb and index to a gap in mm, and measures the object held.", "让大拇指与食指合到指定的间距（mm），并显示所夹物体的尺寸。";
    GAP: "Gap, mm", "间距 mm", "Between the pads of thumb and index, by the model of the hand.", "大拇指与食指指腹之间的距离，按手的模型计算。";
    GAP_WISH: "Not armed: the drawn hand shows where it would go.", "未使能：仅在图上显示将到达的位置。";
    GAP_OPEN: "Open for the grip", "先张开", "Opens thumb and index to 120 mm. From there they go to any gap without meeting.", "把大拇指与食指张开到 120 mm，之后可到任意间距而不相碰。";
    GAP_KEEP: "Keep as pose", "存为姿态", "Adds a pose by size with this gap. Nothing is sent.", "以此间距添加一个按尺寸的姿态，不发送任何内容。";
    GAP_POSE: "Pinch {} mm", "捏 {} mm";
    GAP_CLOSED: "Open for the grip first: from here thumb and index could meet.", "请先张开：从当前位置出发，大拇指与食指可能相碰。";
    HELD_SIZE: "Held", "夹持尺寸", "The ball that touches both pads where thumb and index are, while they alone hold something; where their edges meet, the distance of the pads. Two blocks of known size calibrate it.", "仅大拇指与食指夹住物体时，与两个指腹同时相切的球的直径；指腹边缘相接时为指腹间距。用两个已知尺寸的块校准后，为同类物体的尺寸。";
    HELD_NONE: "nothing between thumb and index", "大拇指与食指之间没有物体";
    HELD_BALL: "a ball of about {} mm, by the model", "约 {} mm 的球（按模型）";
    HELD_PADS: "pads about {} mm apart, by the model", "指腹相距约 {} mm（按模型）";
    HELD_MEASURED: "about {} mm, measured", "约 {} mm（已校准）";
    BLOCK: "Size of a block that is held, mm", "所夹块的真实尺寸 mm", "Stores its size and the readings. Two blocks that differ by 10 mm or more calibrate the sizes.", "记下其尺寸与手的读数。两个相差 10 mm 以上的块即可校准。";
    BLOCK_NOT_HELD: "Let thumb and index alone hold the block.", "请仅用大拇指与食指夹住该块。";
    BLOCKS: "Blocks measured: {}", "已测块：{}";
    BLOCKS_NONE: "none, 2 are needed", "无，需要 2 个";
    BLOCKS_FORGET: "Forget", "清除", "Sizes of this hand are by the model again.", "此手的尺寸恢复为按模型计算。";
    BLOCK_SIZE: "A block has 1 to 120 mm.", "块的尺寸应为 1 到 120 mm。";
    BLOCK_UNLIKELY: "The two blocks do not fit the readings. Measure both again, between thumb and index only.", "两个块与手的读数不符。请仅用大拇指与食指夹住，重新测量两个块。";
    CAPTURE: "Save pose", "记录姿态", "Keeps the pose that the hand has now. Nothing is sent.", "保存灵巧手当前的姿态，不发送任何内容。";
    CAPTURE_UNKNOWN: "The pose is not known: an angle is missing or old.", "姿态未知：有角度缺失或已过时。";
    EMPTY_TITLE: "No poses of your own yet", "还没有自己的姿态";
    EMPTY_BODY: "Arm the hand, bring it into a pose with the sliders, then save the pose; or copy one that is built in. It stays on this computer.", "先使能，用滑块把灵巧手调到一个姿态，然后记录；也可以复制一个内置姿态。姿态保存在本机。";
    EMPTY_BUTTON: "Save the pose the hand has now", "记录灵巧手当前的姿态";
    IMPORT: "Import", "导入", "Adds the poses and sequences of a file. A file with a mistake changes nothing.", "添加文件中的姿态与序列。文件有误时不做任何更改。";
    EXPORT: "Export", "导出", "Writes all poses and sequences to a file.", "把全部姿态与序列写入文件。";
    NOTHING: "There is nothing yet.", "还没有内容。";
    UNDO: "Undo", "撤销", "Undoes the last deletion or import.", "撤销最近一次删除或导入。";
    UNDO_NONE: "Nothing was deleted or imported.", "没有可撤销的删除或导入。";
    IMPORTED: "Imported:", "已导入：";
    COUNT_POSES: "poses", "个姿态";
    COUNT_SEQUENCES: "sequences", "个序列";

    SELECT_TIP: "Shows this pose for editing. Nothing moves. Drag it to change the order.", "显示该姿态以便编辑，不会运动。拖动可调整顺序。";
    DRAG_TIP: "Drag this step to change the order.", "拖动该步骤可调整顺序。";
    STEP_NAME: "Step", "步骤";
    RECALL: "Go", "执行", "Moves to this pose at its speed and force. Locked and left joints stay.", "按该姿态的速度与力执行。已锁定或不参与的自由度不动。";
    RECALL_NAME: "Go to", "执行姿态";
    NAME: "Name", "名称";
    ANGLE: "angle", "角度", "0 bent to 1000 open.", "0 弯曲，1000 张开。";
    BY_SIZE: "By size", "按尺寸", "A pose by size: thumb and index go to a gap, along the path on which their pads meet.", "按尺寸的姿态：大拇指与食指沿指腹相对的路径到达指定间距。";
    ANGLE_OF_GAP: "This angle follows from the gap.", "此角度由间距决定。";
    LEAVE_PINCHES: "A grip by size needs this joint.", "按尺寸抓握需要此自由度。";
    TOLD_BY: "Grip told by: {}", "抓握判断：{}", "Thresholds that a file sets for this pose. They apply while this pose is the target.", "文件为该姿态设定的判断阈值；仅在执行该姿态时生效。";
    LEAVE: "leave alone", "不参与", "This joint stays where it is when the pose is taken.", "执行该姿态时，此自由度保持不动。";
    SPEED: "Speed", "速度", "Speed of the joints on the way, 0 to 1000.", "运动速度，0 到 1000。";
    FORCE: "Force, g", "力阈值 g", "Force threshold on the way, 0 to 3000 g.", "力阈值，0 到 3000 g。";
    RECAPTURE: "From the hand", "取当前姿态", "Replaces this pose with the current pose of the hand.", "用灵巧手当前的姿态替换。";
    DUPLICATE: "Duplicate", "复制", "Makes a copy behind it.", "在后面添加一份副本。";
    EARLIER: "Move earlier", "前移";
    LATER: "Move later", "后移";
    SHIFT_TIP: "Changes the order.", "调整顺序。";
    DELETE: "Delete", "删除", "Removes it. It can be undone.", "删除，可以撤销。";

    NEW_SEQUENCE: "New sequence", "新建序列", "Adds a sequence without steps.", "添加一个空序列。";
    SEQUENCE_EMPTY: "No sequence yet", "还没有序列";
    SEQUENCE_EMPTY_BODY: "A sequence runs poses one after another. It can be tried on the drawn hand first.", "序列依次执行多个姿态，可先在图上试运行。";
    NEEDS_POSES: "Save a pose first.", "请先记录姿态。";
    STEPS_EMPTY: "No steps yet: add a pose below.", "还没有步骤：请在下方添加姿态。";
    ADD: "Add", "添加", "Adds this pose as the last step.", "把该姿态添加为最后一步。";
    ADD_GRIP: "Add grip by size", "添加按尺寸抓握", "Adds a step that closes thumb and index to a gap, along the path on which their pads meet.", "添加一步：让大拇指与食指沿指腹相对的路径合到指定间距。";
    DWELL: "dwell, ms", "停留 ms", "Time at the pose before the next step, milliseconds.", "到达后停留的时间，毫秒。";
    LIMIT: "limit, ms", "限时 ms", "A pose that is not reached within this time counts as reached, milliseconds.", "超过此时间仍未到达时，视为到达，毫秒。";
    ADD_HOLD: "Add hold", "添加保持", "Adds a step that holds what the hand has, between two forces, for its time.", "添加一步：在两个力之间保持手中的物体，持续设定时间。";
    ENDS_HOLD: "Ends in a hold", "以保持结束", "Closes slowly to the pose until an object stops the fingers, then holds it between two forces.", "缓慢闭合到该姿态，遇物体停止后在两个力之间保持。";
    UNTIL: "Until holding", "直到握住", "Waits at the pose until the grip shows that something is held; an unknown grip does not count.", "在该姿态等待，直到抓握状态为“握住”；状态未知不算。";
    WITHIN: "within, ms", "时限 ms", "If nothing is held within this time of the pose, the sequence ends and says so, milliseconds.", "到达姿态后超过此时间仍未握住时，序列结束并说明，毫秒。";
    RETRIES: "retries", "重试", "If the hand closes on nothing, it opens and retries, at most this often, 0 to 20.", "空握时张开并重新握，最多这么多次，0 到 20。";
    REMOVE: "Remove", "移除", "Removes this step.", "移除该步骤。";
    LOOP: "Loop", "循环", "Begins again after the last step.", "最后一步之后从头开始。";
    DRY: "Dry run", "试运行", "Plays it on the drawn hand. Nothing is sent.", "仅在图上播放，不发送任何内容。";
    DRY_END: "End dry run", "结束试运行", "Plays it on the drawn hand. Nothing is sent.", "仅在图上播放，不发送任何内容。";
    START: "Start", "开始", "Runs from the first step. Stop, a fault or a lost link ends it, and nothing starts it again by itself.", "从第一步开始运行。停止、故障或断线都会结束，不会自行恢复。";
    STEP: "Step", "单步", "Takes one step, then waits.", "执行一步，然后等待。";
    PAUSE: "Pause", "暂停", "Holds the hand until resumed.", "在当前位置保持，直到继续。";
    RESUME: "Resume", "继续", "Resumes where it was paused.", "从暂停处继续。";
    END: "End", "结束", "Ends the sequence and holds where the hand is.", "结束序列，并在当前位置保持。";
    NOT_RUNNING: "No sequence runs.", "没有序列在运行。";
    SAY_IDLE: "Ready", "就绪";
    SAY_MOVING: "On the way to step", "正在前往第几步：";
    SAY_WAITING: "Waits until holding at step", "等待握住，第几步：";
    SAY_OPENING: "Closed on nothing, opens to try again: step", "空握，张开后重试，第几步：";
    SAY_HOLDING: "Holds at step", "保持，第几步：";
    SAY_DWELLING: "At step", "停留在第几步：";
    SAY_PAUSED: "Paused at step", "暂停于第几步：";
    SAY_DRY: "Dry run, step", "试运行，第几步：";
    SAY_LATE: "not reached in time:", "未按时到达：";
    END_FINISHED: "Finished", "已完成";
    END_PERSON: "Ended", "已结束";
    END_LOST: "Ended: the link was lost", "已结束：连接断开";
    END_TAKEN: "Ended: moved in another way", "已结束：改为其他操作";
    END_LOCKED: "Ended: a grip by size needs index and thumb, and one of them is locked", "已结束：按尺寸抓握需要食指与大拇指，其中有自由度已锁定";
    END_NOT_HOLDING: "Ended: the hand is not known to hold anything. Grip: {}.", "已结束：未确认握住物体。抓握：{}。";
    PICTURE: "Picture of the pose", "姿态图";

    EXPERT: "For experts: the register that starts a gesture", "高级：手势的启动方式";
    FIND: "Find poses", "查找姿态", "name or tag", "名称或标签";
    FIND_NONE: "No pose has these words in its name or tags.", "没有名称或标签含这些字的姿态。";

    /// Name of a kind of grip.
    fn kind(GripKind) {
        GripKind::Pinch => "Pinch", "捏", "Between the pads of thumb and index.", "在大拇指与食指的指腹之间。";
        GripKind::ThreeFingers => "Three fingers", "三指";
        GripKind::AllFingers => "All fingers", "全指";
        GripKind::Around => "Around", "环握";
    }

    /// Reason why a kind of grip has no gap.
    fn no_gap(NotOffered) {
        NotOffered::BesideMiddle => "There is no gap: the thumb faces the index only, and stays 25 mm beside the middle finger's pad.", "没有间距可言：大拇指只正对食指，与中指指腹始终错开 25 mm。";
        NotOffered::BesideOthers => "There is no gap: the thumb faces the index only, and stays 46 mm beside the ring finger's pad and 66 mm beside the little finger's.", "没有间距可言：大拇指只正对食指，与无名指指腹始终错开 46 mm，与小指指腹错开 66 mm。";
        NotOffered::OnPalm => "There is no gap: the fingers close on the palm, and how far they get depends on where the object lies.", "没有间距可言：手指向手掌合拢，能合多少取决于物体所在的位置。";
    }
}
