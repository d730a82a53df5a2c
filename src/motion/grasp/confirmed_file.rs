//! The grasps that one hand confirmed, in a file per hand: each is confirmed once. A grasp that was changed since is another one.

use crate::checkup::hand_file;
use crate::motion::grasp::confirm::Agreement;
use crate::motion::grasp::file::write;
use crate::motion::grasp::saved::Grasp;
use crate::transport::Endpoint;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Number of stored confirmations; beyond it the oldest is dropped.
const CONFIRMED_MAX: usize = 50;

/// A grasp that a hand confirmed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Confirmed {
    /// The grasp, as its file reads.
    grasp: String,
    /// Date of the confirmation.
    pub day: String,
    /// How the closes agreed.
    #[serde(flatten)]
    pub agreement: Agreement,
}

/// The file of the hand at an endpoint, beside the settings; `None` for the built-in hand, which differs on each start.
pub fn file_of(settings: &Path, hand: &Endpoint) -> Option<PathBuf> {
    hand_file::file_of(settings, "confirmed", hand)
}

/// Reads all confirmations; none if there is no file.
///
/// # Errors
/// An I/O error, or the file does not parse.
pub fn read(file: &Path) -> io::Result<Vec<Confirmed>> {
    hand_file::read(file)
}

/// The confirmation of this grasp.
pub fn of<'a>(all: &'a [Confirmed], grasp: &Grasp) -> Option<&'a Confirmed> {
    let text = write(grasp).ok()?;
    all.iter().find(|own| own.grasp == text)
}

/// Adds a confirmation, and returns all.
///
/// # Errors
/// As [`read`], or the I/O error.
pub fn add(
    file: &Path,
    grasp: &Grasp,
    agreement: Agreement,
    day: &str,
) -> io::Result<Vec<Confirmed>> {
    let grasp = write(grasp).map_err(io::Error::other)?;
    let mut all = read(file)?;
    all.retain(|own| own.grasp != grasp);
    let room = all.len().saturating_sub(CONFIRMED_MAX - 1);
    all.drain(..room);
    all.push(Confirmed {
        grasp,
        day: day.to_owned(),
        agreement,
    });
    hand_file::keep(file, &all)?;
    Ok(all)
}
