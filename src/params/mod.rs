//! What a hand keeps: its parameters as rows, compared, in files, put into order to be written, and what this program saved.
//! Writes to no hand by itself.
//!
//! [`rows`] says which parameters there are, [`values`] holds one set of them, [`file`](mod@file) is the form on disk, [`changes`]
//! turns wanted values into writes and their results into verdicts, [`danger`] says what could hurt, [`place`] follows a hand that is
//! found elsewhere, [`backups`] keeps what was saved and the backups.

pub mod backups;
pub mod changes;
pub mod danger;
pub mod file;
pub mod place;
pub mod rows;
pub mod values;
