//! Reasons why a grasp of another hand is not trusted here.

use crate::hand::Finger;
use crate::hand::hold_forces::NoRoom;

/// Reason why a grasp that another hand made is not trusted on this one.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GraspDoubt {
    /// The file does not know its forces in newtons.
    #[error(
        "the grasp has no newtons of the {}: measure the hand that made it with 'handscope scale --joint {}', hold there again, and save it anew",
        finger.name(), finger.bend().name()
    )]
    NoNewtonsThere {
        /// Finger without newtons.
        finger: Finger,
    },
    /// The newtons of this hand are not known.
    #[error(
        "the newtons of the {} of this hand are not known, so its forces cannot be compared: measure them with 'handscope scale --joint {}'",
        finger.name(), finger.bend().name()
    )]
    NoNewtonsHere {
        /// Finger without newtons.
        finger: Finger,
    },
    /// The forces are impossible on this hand.
    #[error("as the {} of this hand reads the forces, {why}", finger.name())]
    NoRoom {
        /// Finger that reads them.
        finger: Finger,
        /// Its reason.
        why: NoRoom,
    },
    /// No load was put on the object, or it was not taken off again.
    #[error(
        "no load came and went in close {close}: lift the object, use it, and put it down again"
    )]
    NoLoad {
        /// Number of the close, from 1.
        close: usize,
    },
    /// The user did not say that the object stands.
    #[error("nobody said in close {close} that the object stands: confirm it once it is put down")]
    NotReleased {
        /// Number of the close, from 1.
        close: usize,
    },
    /// The hand held the object before it closed.
    #[error(
        "in close {close} the hand held the object before it closed: hold it so that the open hand does not touch it"
    )]
    NotClosed {
        /// Number of the close, from 1.
        close: usize,
    },
    /// The object left the hand.
    #[error("the object left the hand in close {close}")]
    Lost {
        /// Number of the close, from 1.
        close: usize,
    },
    /// At most did not suffice.
    #[error("at most did not suffice in close {close}")]
    CouldNotHold {
        /// Number of the close, from 1.
        close: usize,
    },
    /// A finger that held on the first hand does not hold here.
    #[error("the {} held on the first hand, and not in each close here: place the object as it lay there", finger.name())]
    NotHeld {
        /// The finger.
        finger: Finger,
    },
    /// A finger presses too hard.
    #[error(
        "the {} may press with {bound_g:.0} g, and at most is {at_most_g:.0} g on this hand: close more gently, or raise it",
        finger.name()
    )]
    Peak {
        /// The finger.
        finger: Finger,
        /// Bound of its force, g of this hand.
        bound_g: f64,
        /// At most, g of this hand.
        at_most_g: f64,
    },
    /// The stiffness differs, or only one hand shows it.
    #[error(
        "the object is {ratio:.1} times as stiff as on the first hand: it is another one, or held elsewhere"
    )]
    Stiffness {
        /// Stiffness here over that of the first hand.
        ratio: f64,
    },
    /// Only one of both hands shows a stiffness.
    #[error(
        "the stiffness of the object is known on one of both hands only: it cannot be compared"
    )]
    NoStiffness,
    /// The object slid where it held on the first hand.
    #[error(
        "the object slid at a load of {slid:.2} of the force, and held at {held:.2} on the first hand: clean the fingertips and the object"
    )]
    Slid {
        /// Ratio at which it slid here.
        slid: f64,
        /// Ratio at which it held there.
        held: f64,
    },
    /// The closes do not show enough friction.
    #[error(
        "the closes show a friction of {shown:.2}, and the loads of the first hand need {needed:.2}: load the object as it was there"
    )]
    NoFriction {
        /// Friction that they show.
        shown: f64,
        /// Friction that is needed.
        needed: f64,
    },
    /// The loads are larger than those of the first hand.
    #[error(
        "the load was {here_n:.1} N, and {there_n:.1} N on the first hand: the object is heavier, or pulled harder"
    )]
    Heavier {
        /// Largest load here, N.
        here_n: f64,
        /// Largest load there, N.
        there_n: f64,
    },
    /// The load of the first hand is not known.
    #[error(
        "the grasp has no load, as a fingertip was not read: hold there again, and save it anew"
    )]
    LoadUnknown,
}
