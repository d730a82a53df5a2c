//! The forty gestures that a hand stores by number: the last one that was started, and what was read and written of them.

use crate::hand::{Angle, Gesture, Moment, PerDof, UserGesture};

/// How far the last gesture came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GestureProgress {
    /// Asked; no answer yet.
    Asked,
    /// The hand acknowledged. It does not say that the pose is reached.
    Acknowledged,
    /// It did not work; a notice says why.
    Failed,
}

/// The gesture that was started last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LastGesture {
    /// Its number.
    pub gesture: Gesture,
    /// When it was asked.
    pub at: Moment,
    /// How far it came.
    pub progress: GestureProgress,
}

/// What the hand has stored under a number, as it was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stored {
    /// The number.
    pub gesture: UserGesture,
    /// Its six shorts, as they are.
    pub angles: PerDof<i16>,
}

/// How far storing a pose in the hand came. Written, acknowledged and read back are three things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StoreVerdict {
    /// On its way.
    Writing,
    /// Read back as it was written.
    Same,
    /// Read back as something else: the hand does not keep it there.
    Differs,
    /// It did not work; a notice says why.
    Failed,
}

/// The pose that was stored last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Upload {
    /// Its number.
    pub gesture: UserGesture,
    /// What was written.
    pub wanted: PerDof<Angle>,
    /// How far it came.
    pub verdict: StoreVerdict,
}

/// What is known of a hand's own gestures.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GestureState {
    /// The one that was started last.
    pub last: Option<LastGesture>,
    /// The pose that was stored last.
    pub upload: Option<Upload>,
    /// What was read last.
    pub stored: Option<Stored>,
}

impl GestureState {
    /// Notes how far storing came.
    pub(crate) fn judge(&mut self, gesture: UserGesture, verdict: StoreVerdict) {
        if let Some(upload) = &mut self.upload
            && upload.gesture == gesture
            && matches!(upload.verdict, StoreVerdict::Writing)
        {
            upload.verdict = verdict;
        }
    }

    /// Takes what was read, and compares it with what was written.
    pub(crate) fn read_back(&mut self, stored: Stored) {
        self.stored = Some(stored);
        let wanted = self.upload.map(|upload| upload.wanted.map(Angle::get));
        let verdict = if wanted == Some(stored.angles) {
            StoreVerdict::Same
        } else {
            StoreVerdict::Differs
        };
        self.judge(stored.gesture, verdict);
    }

    /// Notes how the last gesture went on.
    pub(crate) const fn progress(&mut self, progress: GestureProgress) {
        if let Some(last) = &mut self.last {
            last.progress = progress;
        }
    }
}
