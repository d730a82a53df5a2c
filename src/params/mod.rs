//! Parameters that a hand stores: rows, comparison, files, the order of writes, and a record of what this program saved.
//! Writes to no hand by itself.
//!
//! [`rows`] lists the parameters, [`values`] holds one set of them, [`file`](mod@file) is the form on disk, [`changes`]
//! turns new values into writes and their results into verdicts, [`danger`] reports defaults that could hurt, [`place`] follows a
//! hand whose address changes, [`backups`] stores the last save and the backups.

pub mod backups;
pub mod changes;
pub mod danger;
pub mod file;
pub mod place;
pub mod rows;
pub mod values;
