//! Grasp trials: plan, running series, comparison.

pub(crate) mod compare;
pub(crate) mod compare_best;
pub(crate) mod compare_choice;
pub(crate) mod compare_columns;
pub(crate) mod compare_curves;
pub(crate) mod compare_list;
pub(crate) mod compare_table;
#[cfg(test)]
pub(crate) mod compare_tests;
pub(crate) mod plot;
pub(crate) mod tune;
pub(crate) mod tune_form;
pub(crate) mod tune_live;
pub(crate) mod tune_result;

use crate::ui::kit::Label;
use egui::{Color32, Ui};

/// Least height of curves.
pub(crate) const PLOT_LEAST: f32 = 96.0;

/// Small text over as many lines as it needs.
pub(crate) fn line_ui(ui: &mut Ui, text: &str, color: Color32) {
    Label::new(text, color).small().wrap().ui(ui);
}
