//! Grasp trials: plan, running series, results.

pub(crate) mod compare;
pub(crate) mod compare_best;
pub(crate) mod compare_choice;
pub(crate) mod compare_columns;
pub(crate) mod compare_curves;
pub(crate) mod compare_list;
pub(crate) mod compare_table;
#[cfg(test)]
pub(crate) mod compare_tests;
pub(crate) mod overshoot;
pub(crate) mod promotion;
pub(crate) mod recorded;
pub(crate) mod search_form;
pub(crate) mod tune;
pub(crate) mod tune_form;
pub(crate) mod tune_live;
