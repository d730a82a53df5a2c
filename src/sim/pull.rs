//! An object that is pulled out of the grip at a given time. Only computes; the hand applies the result.

use crate::sim::number;
use crate::sim::scenario::Slip;

/// Parameters of a pull. All fingers feel it alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pull {
    /// Start, ms of the hand's own time.
    pub at_ms: u64,
    /// Time for which the object sticks while the pull grows, ms.
    pub sticks_ms: u64,
    /// Time for which it slides afterwards, ms.
    pub slides_ms: u64,
    /// Increase of the ratio of tangential to normal force at the end of sticking.
    pub friction: f64,
    /// Turn of the tangential force, degrees.
    pub turn_deg: f64,
    /// Share of the contact force left at the end of sliding.
    pub grip: f64,
    /// Outcome.
    pub end: PullEnd,
}

/// Outcome of a pull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PullEnd {
    /// The object is out of the hand.
    Lost,
    /// It rests in another place, at full force.
    Held,
    /// The pull ends before anything slides; there is no sliding.
    LetGo,
}

/// Phase of a pull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PullPhase {
    /// Not started.
    Before,
    /// The object still sticks; share of the time, 0 to 1.
    Sticks(f64),
    /// The object slides; share of the travel, 0 to 1.
    Slides(f64),
    /// Finished.
    Over,
}

impl Pull {
    /// Phase in this millisecond.
    pub fn phase(&self, now_ms: u64) -> PullPhase {
        let Some(since) = now_ms.checked_sub(self.at_ms) else {
            return PullPhase::Before;
        };
        let share = |ms: u64, of: u64| number::seconds(ms) / number::seconds(of.max(1));
        if since < self.sticks_ms {
            return PullPhase::Sticks(share(since, self.sticks_ms));
        }
        let slid = since - self.sticks_ms;
        if self.end != PullEnd::LetGo && slid < self.slides_ms {
            return PullPhase::Slides(share(slid, self.slides_ms));
        }
        PullPhase::Over
    }

    /// Effect of the pull on the fingertips.
    pub fn slip(&self, now_ms: u64) -> Slip {
        /// Sliding friction as a share of sticking friction.
        const SLIDING: f64 = 0.85;
        /// Travel of the contact on the fingertip, mm.
        const WAY_MM: f64 = 6.0;
        match self.phase(now_ms) {
            PullPhase::Before => Slip::default(),
            PullPhase::Sticks(share) => Slip {
                friction: self.friction * share,
                turn_deg: self.turn_deg * share / 2.0,
                ..Slip::default()
            },
            PullPhase::Slides(share) => Slip {
                grip: 1.0 - (1.0 - self.grip) * share,
                friction: self.friction * SLIDING,
                turn_deg: self.turn_deg * (1.0 + share) / 2.0,
                slide_mm: WAY_MM * share,
            },
            PullPhase::Over if self.end == PullEnd::Held => Slip {
                turn_deg: self.turn_deg,
                slide_mm: WAY_MM,
                ..Slip::default()
            },
            PullPhase::Over => Slip::default(),
        }
    }

    /// True if the object is out of the hand.
    pub fn is_lost(&self, now_ms: u64) -> bool {
        self.end == PullEnd::Lost && self.phase(now_ms) == PullPhase::Over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PULL: Pull = Pull {
        at_ms: 1000,
        sticks_ms: 200,
        slides_ms: 400,
        friction: 0.3,
        turn_deg: 60.0,
        grip: 0.6,
        end: PullEnd::Lost,
    };

    #[test]
    fn an_object_sticks_slides_and_is_lost_and_one_that_is_let_go_does_not_slide() {
        assert_eq!(PULL.slip(999), Slip::default());
        assert_eq!(PULL.phase(1100), PullPhase::Sticks(0.5));
        assert!((PULL.slip(1100).friction - 0.15).abs() < 1e-9);
        assert_eq!(PULL.phase(1400), PullPhase::Slides(0.5));
        assert!((PULL.slip(1400).grip - 0.8).abs() < 1e-9);
        assert!(!PULL.is_lost(1599) && PULL.is_lost(1600));
        let tug = Pull {
            end: PullEnd::LetGo,
            ..PULL
        };
        assert_eq!(tug.phase(1200), PullPhase::Over);
        assert_eq!(tug.slip(1200), Slip::default());
        let held = Pull {
            end: PullEnd::Held,
            ..PULL
        };
        assert!(!held.is_lost(9000));
        assert_eq!(held.slip(9000).grip, 1.0);
    }
}
