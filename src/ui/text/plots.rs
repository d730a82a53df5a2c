//! Sentences of the plots: what can be looked at, measured, noted and kept.

use crate::ui::text::phrase::texts;

texts! {
    AREA_TIP: "Wheel: zoom in time. Drag: move. Shift and drag: zoom to what is marked. Double-click: follow the newest again.", "滚轮：时间缩放。拖动：平移。按住 Shift 拖动：放大所选范围。双击：重新跟随最新数据。";
    NORMAL: "Normal force at the tips, N", "指尖法向力 N";
    TANGENTIAL: "Tangential force at the tips, N", "指尖切向力 N";
    DECIMATED: "min and max", "最小最大值", "Decimated: there are more measurements than pixels, so each column of pixels shows the smallest and the largest of several. No extreme is lost. The figures of the cursors come from all measurements.", "已抽取：数据点多于像素，每列像素显示其中的最小值和最大值，不会丢失极值。游标数值由全部数据计算。";
    RANGE: "Value scale", "数值范围", "Drag: move. Wheel: zoom. Click: type the ends. Double-click: automatic again.", "拖动：平移。滚轮：缩放。单击：输入上下限。双击：恢复自动。";
    RANGE_FIXED: "fixed scale", "固定范围";
    RANGE_HIGH: "Upper end", "上限";
    RANGE_LOW: "Lower end", "下限";
    RANGE_END_TIP: "Enter takes it. From and to:", "按 Enter 生效。可输入范围：";
    RANGE_AUTO: "Automatic", "自动", "The scale fits the values again.", "重新根据数据自动调整范围。";
    UNDER_POINTER: "under the pointer", "指针处数值";
    MORE: "More", "更多", "Which plots are shown, copying and saving.", "选择显示的曲线、复制和保存。";
    MORE_NAME: "More for the plots", "曲线更多选项";
    SHOWN: "Plots shown", "显示的曲线";
    ENLARGE: "Fill the view", "放大显示";
    COPY: "Copy as CSV", "复制为 CSV", "All measurements of the shown time, plots and joints, as they were received.", "复制当前时间范围内所示曲线的全部原始数据。";
    COPY_LONG: "Too much for the clipboard: zoom in, or save it as a file.", "数据过多：请缩小范围，或保存为文件。";
    SAVE_CSV: "Save as CSV", "保存为 CSV", "The same into a file, however long the time is. The window goes on meanwhile.", "保存到文件，时间长度不限。保存期间窗口照常工作。";
    SAVE_PNG: "Save as PNG", "保存为 PNG", "A picture of these plots as they stand, twice as fine as on the screen.", "将当前曲线保存为图片，分辨率为屏幕的两倍。";
    COPIED: "Copied, rows:", "已复制行数：";
    CURSORS: "A|B", "A|B", "Two cursors with values, difference, slope, and smallest, largest and mean value between them.", "两个游标：数值、差值、斜率，以及区间最小、最大和平均值。";
    CURSORS_NAME: "Cursors", "游标";
    CURSOR_A: "Cursor A", "游标 A";
    CURSOR_B: "Cursor B", "游标 B";
    AT_A: "A", "A";
    AT_B: "B", "B";
    DIFFERENCE: "B - A", "B - A";
    SLOPE: "per s", "每秒";
    SMALLEST: "min", "最小";
    LARGEST: "max", "最大";
    MEAN: "mean", "平均";
    APART: "Time between the cursors", "游标间隔";
    FIGURES: "Figures of the next plot", "下一曲线的数值", "The figures below are of this plot. Press for the next one, or click into a plot.", "下方为该曲线的数值。按下切换到下一条，或点击曲线区。";
    NOTE: "Note", "标记", "Puts a line with your words into the plots, at this moment. Key: N", "在当前时刻添加一条带文字的标记线。快捷键：N";
    NOTE_NAME: "Make a note", "添加标记", "Puts a line with your words into the plots, at this moment. Key: N", "在当前时刻添加一条带文字的标记线。快捷键：N";
    NOTE_AT: "Note at", "标记时刻";
    NOTE_FIELD: "Words of the note", "标记内容";
    NOTE_HINT: "Enter keeps it. Esc drops it.", "按 Enter 保存。Esc 取消。";
    NOTE_HINT_MOVING: "Enter keeps it. Esc stops the hand.", "按 Enter 保存。Esc 停止灵巧手。";
    NOTE_KEEP: "Keep", "保存", "Puts the note where its key was pressed.", "把标记放在按键时刻。";
    NOTE_CANCEL: "Cancel", "取消", "Makes no note.", "不添加标记。";
    NOTES: "Notes", "标记列表";
    NOTE_SHOW: "Show the note", "显示标记", "Shows this moment in the plots.", "在曲线中显示该时刻。";
    NOTE_DELETE: "Delete the note", "删除标记", "Takes the note out of the plots.", "从曲线中删除该标记。";
}
