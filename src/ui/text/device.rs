//! Sentences of what the hand keeps: rows, verdicts, SAVE, files.

use crate::ui::text::phrase::texts;

texts! {
    REFUSED: "Nothing of the file was taken.", "文件未被采用。";
}
