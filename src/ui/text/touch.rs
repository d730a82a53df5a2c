//! Sentences of the fingertips and the drawn hand.

use crate::ui::text::phrase::texts;

texts! {
    DRAWN: "Drawn finger", "图中手指";
    DRAWN_TIP: "Shows this fingertip in detail.", "查看该指尖的详情。";
    GHOST: "Dashed: angle not known", "虚线轮廓：角度未知";
}
