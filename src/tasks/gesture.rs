//! A pose into the hand's own memory of gestures, and out of it again. At addresses that the manual does not list.

use crate::hand::command::stored_gesture;
use crate::hand::{Angle, HandCommand, PerDof, UserGesture};
use crate::link::RequestError;
use crate::tasks::hand::Hand;

/// Reads six angles as they are stored; `None` if the answer was no six angles.
///
/// # Errors
/// As the link says.
pub async fn read<H: Hand>(
    hand: &H,
    gesture: UserGesture,
) -> Result<Option<PerDof<i16>>, RequestError> {
    let bytes = hand.read(stored_gesture(gesture)).await?;
    let (pairs, _) = bytes.as_chunks::<2>();
    let mut pairs = pairs.iter().map(|pair| i16::from_le_bytes(*pair));
    Ok(PerDof::from_fn(|_| pairs.next()).all())
}

/// Writes six angles and reads them back.
///
/// # Errors
/// As the link says.
pub async fn store<H: Hand>(
    hand: &H,
    gesture: UserGesture,
    angles: PerDof<Angle>,
) -> Result<Option<PerDof<i16>>, RequestError> {
    hand.write(HandCommand::StoreGesture(gesture, angles))
        .await?;
    read(hand, gesture).await
}
