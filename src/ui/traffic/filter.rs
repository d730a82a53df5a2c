//! Filter of the traffic view. Draws nothing.

use crate::hand::{REGISTERS, Span};
use crate::link::traffic::frame::Frame;
use crate::record::Direction;
use std::collections::VecDeque;
use std::sync::Arc;

/// Criteria that a frame must meet.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Filter {
    /// Part of a register's name, or bytes in hex; empty for all.
    pub(crate) text: String,
    /// Only this direction; `None` for both.
    pub(crate) direction: Option<Direction>,
    /// Only frames with an error.
    pub(crate) wrong_only: bool,
    /// Without the regular reads.
    pub(crate) hide_polling: bool,
    /// Only frames with a larger number: the list was cleared at this one.
    pub(crate) cleared: u64,
}

impl Filter {
    /// Frames that pass, in their order.
    pub(crate) fn passing(&self, frames: &VecDeque<Arc<Frame>>) -> VecDeque<Arc<Frame>> {
        let text = self.text.trim().to_ascii_uppercase();
        let named = REGISTERS.iter().filter(|row| row.name.contains(&text));
        let spans: Vec<Span> = named.map(|row| row.span()).collect();
        let bytes = bytes_of(&text);
        let has_text = |frame: &Frame| {
            let named = spans.iter().any(|row| touches(frame, row));
            let len = bytes.len();
            named || len > 0 && frame.bytes.windows(len).any(|own| own == bytes)
        };
        let passes = |frame: &&Arc<Frame>| {
            frame.number > self.cleared
                && self.direction.is_none_or(|way| way == frame.direction)
                && !(self.wrong_only && frame.wrong.is_none())
                && !(self.hide_polling && frame.is_polling())
                && (text.is_empty() || has_text(frame))
        };
        frames.iter().filter(passes).cloned().collect()
    }
}

fn touches(frame: &Frame, row: &Span) -> bool {
    let within =
        |span: Span| u32::from(row.address) < span.end() && u32::from(span.address) < row.end();
    frame.span.is_some_and(within)
}

/// Bytes given by pairs of hex digits; empty if the text contains anything else. A final unpaired digit is ignored.
fn bytes_of(text: &str) -> Vec<u8> {
    let digits = text.bytes().filter(|sign| *sign != b' ');
    let digits: Option<Vec<u8>> = digits
        .map(|sign| u8::try_from(char::from(sign).to_digit(16)?).ok())
        .collect();
    let digits = digits.unwrap_or_default();
    let pairs = digits.chunks_exact(2);
    pairs
        .map(|pair| pair.iter().fold(0, |byte, half| byte << 4 | half))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Moment;
    use crate::link::tap::WireTap;
    use crate::link::traffic::Traffic;
    use crate::record::PieceKind;

    const ASK: [u8; 9] = [0xEB, 0x90, 1, 4, 0x11, 0x0A, 0x06, 12, 0x32];
    const SAVE: [u8; 9] = [0xEB, 0x90, 1, 4, 0x12, 0xED, 3, 1, 0x08];

    fn traffic() -> (WireTap, Traffic) {
        let tap = WireTap::default();
        let traffic = Traffic::of(tap.clone(), &"rs485:x".parse().unwrap());
        (tap, traffic)
    }

    fn record(tap: &WireTap, n: u64) {
        let (kind, bytes): (_, &[u8]) = match n % 4 {
            0 => (PieceKind::Bytes(Direction::ToHand), &ASK),
            1 => (PieceKind::Bytes(Direction::FromHand), &[1, 2, 3]),
            2 => (PieceKind::Bytes(Direction::ToHand), &SAVE),
            _ => (PieceKind::Opened, &[]),
        };
        tap.record(Moment::from_micros(n * 9_000), kind, bytes);
    }

    #[test]
    fn each_filter_lets_pass_what_it_says() {
        let (tap, mut traffic) = traffic();
        (0..3).for_each(|n| record(&tap, n));
        traffic.read_on(Moment::from_micros(900_000));
        let with = |change: fn(&mut Filter)| {
            let mut filter = Filter::default();
            change(&mut filter);
            let frames = filter.passing(traffic.frames());
            frames.iter().map(|frame| frame.hex()).collect::<Vec<_>>()
        };
        let [ask, noise, save] =
            [&ASK[..], &[1, 2, 3], &SAVE].map(crate::link::traffic::frame::hex);
        assert_eq!(with(|_| {}).len(), 3);
        assert_eq!(
            with(|filter| filter.text = "angle".into()),
            vec![ask.clone()]
        );
        assert_eq!(
            with(|filter| filter.text = "01 02".into()),
            vec![noise.clone()]
        );
        assert_eq!(with(|filter| filter.text = "eb90".into()).len(), 2);
        assert_eq!(with(|filter| filter.text = "b901".into()).len(), 0);
        assert_eq!(with(|filter| filter.text = "eb 90 0".into()).len(), 2);
        let out = |filter: &mut Filter| filter.direction = Some(Direction::ToHand);
        assert_eq!(with(out), [ask.clone(), save.clone()]);
        assert_eq!(with(|filter| filter.cleared = 1).len(), 2);
        // The unanswered read does not count as polling.
        assert_eq!(with(|filter| filter.hide_polling = true).len(), 3);
        assert!(with(|filter| filter.wrong_only = true).contains(&noise));
    }
}
