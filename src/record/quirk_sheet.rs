//! Findings about one hand, as text for a file.

use serde::{Deserialize, Serialize};

/// Findings about one hand. Keys of a later version are preserved in [`Self::others`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct QuirkSheet {
    /// The endpoint without the id.
    pub place: String,
    /// The requested id or unit.
    pub id: u16,
    /// Date of the first answer, `2026-11-21`; empty in a sheet that was never saved.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub first_seen: String,
    /// Date of the last answer.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub last_seen: String,
    /// HAND_ID as the hand reports it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand_id: Option<u8>,
    /// REDU_RATIO as the hand reports it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baud_code: Option<u8>,
    /// `low-first`, `high-first` or `one-per-word`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub packing: Option<String>,
    /// `through` or `split`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<String>,
    /// `capacitive`, `resistive`, or `unknown: ` and the reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub touch: Option<String>,
    /// Keys of a later version, unchanged.
    #[serde(flatten)]
    pub others: toml::Table,
}

impl QuirkSheet {
    /// Differences from a later sheet. A fact that is unknown in either is not a difference.
    pub fn differences(&self, now: &Self) -> Vec<FactDifference> {
        let number = |value: Option<u8>| value.map(|value| value.to_string());
        let touch = |sheet: &Self| {
            let known = |touch: &String| !touch.starts_with("unknown");
            sheet.touch.clone().filter(known)
        };
        [
            (Fact::HandId, number(self.hand_id), number(now.hand_id)),
            (
                Fact::BaudCode,
                number(self.baud_code),
                number(now.baud_code),
            ),
            (Fact::Packing, self.packing.clone(), now.packing.clone()),
            (Fact::Gap, self.gap.clone(), now.gap.clone()),
            (Fact::Touch, touch(self), touch(now)),
        ]
        .into_iter()
        .filter_map(|(fact, before, now)| {
            let (before, now) = (before?, now?);
            (before != now).then_some(FactDifference { fact, before, now })
        })
        .collect()
    }

    /// Updates with a later visit to the same hand: facts not learnt this time are unchanged.
    pub fn update(&mut self, now: Self) {
        self.last_seen = now.last_seen;
        self.hand_id = now.hand_id.or(self.hand_id);
        self.baud_code = now.baud_code.or(self.baud_code);
        self.packing = now.packing.or_else(|| self.packing.take());
        self.gap = now.gap.or_else(|| self.gap.take());
        self.touch = now.touch.or_else(|| self.touch.take());
    }
}

/// Facts in which two sheets may differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fact {
    HandId,
    /// REDU_RATIO.
    BaudCode,
    /// Byte order in words.
    Packing,
    /// Reads across unused addresses.
    Gap,
    /// Type of the fingertip sensors.
    Touch,
}

/// A fact for which the hand's answer has changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FactDifference {
    pub fact: Fact,
    /// Earlier value.
    pub before: String,
    pub now: String,
}
