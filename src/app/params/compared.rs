//! A file of parameters beside a hand: which of its rows are ticked to be staged. Reads no file.

use crate::params::file::ParamsFile;
use crate::params::rows::ParamId;
use crate::params::values::Params;
use std::collections::BTreeSet;

/// A file that is compared with the hand.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    pub name: String,
    /// What it holds.
    pub file: ParamsFile,
    ticked: BTreeSet<ParamId>,
}

impl Compared {
    /// Ticks the rows in which the hand differs. A row that says where a hand is found belongs to one hand, so only the user ticks it.
    pub fn new(name: String, file: ParamsFile, live: &Params) -> Self {
        let differ = live.differences(&file.params).into_iter();
        let ticked = differ.map(|row| row.id).filter(|id| !id.is_place());
        Self {
            ticked: ticked.collect(),
            name,
            file,
        }
    }

    /// Whether a row is ticked.
    pub fn is_ticked(&self, id: ParamId) -> bool {
        self.ticked.contains(&id)
    }

    /// Ticks a row that the file holds, or takes the tick away.
    pub fn tick(&mut self, id: ParamId) {
        if self.file.params.get(id).is_some() && !self.ticked.remove(&id) {
            self.ticked.insert(id);
        }
    }

    /// The rows that are ticked.
    pub fn chosen(&self) -> Params {
        self.file.params.only(|id| self.is_ticked(id))
    }
}
