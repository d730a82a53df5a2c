//! Stand-in.
use crate::hand::{Dof, Fault, Moment};
/// Entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultEntry {
    /// Joint.
    pub dof: Dof,
    /// What.
    pub what: Fault,
    /// Since.
    pub since: Moment,
    /// Until.
    pub until: Option<Moment>,
}
/// Book.
#[derive(Debug, Clone, Default)]
pub struct FaultBook(pub Vec<FaultEntry>);
impl FaultBook {
    /// All.
    pub fn iter(&self) -> impl Iterator<Item = &FaultEntry> {
        self.0.iter()
    }
}
