//! What a hand keeps: its parameters as rows, compared, in files, put into order to be written, and what this program saved.
//! Writes to no hand by itself.
//!
//! [`table`] says which rows there are, [`values`] holds one set of them, [`file`](mod@file) is the form on disk, [`plan`] turns wishes into
//! writes and their ends into verdicts, [`danger`] says what could hurt, [`guard`] follows a hand that is found elsewhere, [`record`] keeps what was saved and the backups.

pub mod danger;
pub mod file;
pub mod guard;
pub mod plan;
pub mod record;
pub mod table;
pub mod values;
