//! The text protocol of serial CAN adapters (Lawicel: `O`, `C`, `S0`..`S8`, `T`, CR and BEL), both sides. No port, no clock.

use crate::codec::NoiseCounts;
use crate::codec::can::{CanData, CanFrame};
use arrayvec::ArrayVec;

/// Maximum length of a line without its CR: `T`, 8 digits, length, 16 digits, 4 of time stamp.
pub const LINE_MAX: usize = 30;
/// Bit rates that have a code, `S0` first.
pub const BITRATES: [u32; 9] = [
    10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, 1_000_000,
];

/// End of a line; alone from an adapter it acknowledges a command.
const CR: u8 = b'\r';
/// Error response of an adapter.
const BEL: u8 = 0x07;

/// A line to send, including its CR.
pub type SlcanLine = ArrayVec<u8, { LINE_MAX + 1 }>;

/// Command to an adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SlcanCommand {
    /// `O`: join the bus.
    Open,
    /// `C`: leave the bus.
    Close,
    /// `S0` to `S8`: set the bit rate, an index into [`BITRATES`].
    Bitrate(u8),
    /// `T`: send a data frame with a 29-bit identifier.
    Send(CanFrame),
    /// `t`, `r` or `R`: send a frame that the hand does not support, with an 11-bit identifier or without data.
    SendOther(u8),
    /// `L`: open the bus in listen-only mode.
    Listen,
    /// `s`: set the bit rate by the controller's two timing registers.
    Timing(u16),
    /// Any other well-formed command: versions, flags, filters.
    Other(u8),
}

/// Response of an slcan adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SlcanAnswer {
    /// CR alone: the command succeeded.
    Done,
    /// BEL: the command was rejected.
    Failed,
    /// `z` or `Z`: the frame was accepted for sending.
    Sent,
    /// `T`: a data frame with a 29-bit identifier was received from the bus.
    Frame(CanFrame),
    /// Any other well-formed line: versions, status flags, 11-bit and remote frames.
    Other(u8),
}

/// Returns the code of a bit rate; `None` if it has none.
pub fn bitrate_code(bitrate: u32) -> Option<u8> {
    let at = BITRATES.iter().position(|known| *known == bitrate)?;
    u8::try_from(at).ok()
}

/// Encodes a command; `None` for codes past 8, and for [`SlcanCommand::SendOther`] and [`SlcanCommand::Other`].
pub fn encode_command(command: &SlcanCommand) -> Option<SlcanLine> {
    let mut line = SlcanLine::new();
    match command {
        SlcanCommand::Open => line.push(b'O'),
        SlcanCommand::Close => line.push(b'C'),
        SlcanCommand::Bitrate(code @ 0..=8) => line.extend([b'S', b'0' + code]),
        SlcanCommand::Send(frame) => line = frame_line(frame),
        SlcanCommand::Listen => line.push(b'L'),
        SlcanCommand::Timing(registers) => {
            line.push(b's');
            line.extend(registers.to_be_bytes().into_iter().flat_map(digits));
        }
        SlcanCommand::Bitrate(_) | SlcanCommand::SendOther(_) | SlcanCommand::Other(_) => {
            return None;
        }
    }
    line.push(CR);
    Some(line)
}

/// Encodes an adapter's response; `None` for [`SlcanAnswer::Other`].
pub fn encode_answer(answer: &SlcanAnswer) -> Option<SlcanLine> {
    let mut line = SlcanLine::new();
    match answer {
        SlcanAnswer::Done => {}
        SlcanAnswer::Failed => {
            line.push(BEL);
            return Some(line);
        }
        SlcanAnswer::Sent => line.push(b'Z'),
        SlcanAnswer::Frame(frame) => line = frame_line(frame),
        SlcanAnswer::Other(_) => return None,
    }
    line.push(CR);
    Some(line)
}

fn frame_line(frame: &CanFrame) -> SlcanLine {
    let mut line = SlcanLine::from_iter([b'T']);
    let id = frame.id.to_be_bytes();
    line.extend(id.into_iter().flat_map(digits));
    let len = u8::try_from(frame.data.len()).unwrap_or_default();
    line.push(b'0' + len);
    line.extend(frame.data.iter().copied().flat_map(digits));
    line
}

fn digits(byte: u8) -> [u8; 2] {
    [byte >> 4, byte & 15].map(|half| match half {
        0..=9 => b'0' + half,
        _ => b'A' + half - 10,
    })
}

/// An incomplete line.
#[derive(Debug, Clone, Default)]
struct Collector {
    line: ArrayVec<u8, LINE_MAX>,
    too_long: bool,
    counts: NoiseCounts,
}

impl Collector {
    /// Adds a byte. An over-long line retains its newest bytes, since a valid frame may come last.
    fn keep(&mut self, byte: u8) {
        if self.line.is_full() {
            self.line.remove(0);
            self.too_long = true;
            self.counts.skipped_bytes += 1;
        }
        self.line.push(byte);
    }

    /// Parses the line and starts the next one.
    fn end<T>(&mut self, parse: impl Fn(&[u8]) -> Option<T>) -> Option<T> {
        let line = std::mem::take(&mut self.line);
        let too_long = std::mem::take(&mut self.too_long);
        let whole = if too_long { None } else { parse(&line) };
        if whole.is_some() {
            return whole;
        }
        self.counts.resyncs += 1;
        // Noise before a frame: `T` is not a hex digit, so the last one starts the frame.
        let from = line.iter().rposition(|byte| *byte == b'T');
        let found = from.and_then(|from| Some((from, parse(line.get(from..)?)?)));
        let skipped = found.as_ref().map_or(line.len(), |(from, _)| *from);
        self.counts.skipped_bytes += u64::try_from(skipped).unwrap_or_default();
        found.map(|(_, parsed)| parsed)
    }
}

/// Decodes an adapter's output.
#[derive(Debug, Clone, Default)]
pub struct AnswerDecoder(Collector);

impl AnswerDecoder {
    /// Accepts the next byte; returns the response that it completes.
    pub fn push(&mut self, byte: u8) -> Option<SlcanAnswer> {
        match byte {
            CR => self.0.end(parse_answer),
            BEL => {
                if !self.0.line.is_empty() {
                    self.0.end(|_| None::<SlcanAnswer>);
                }
                Some(SlcanAnswer::Failed)
            }
            _ => {
                self.0.keep(byte);
                None
            }
        }
    }

    /// Errors met so far.
    pub const fn counts(&self) -> NoiseCounts {
        self.0.counts
    }
}

/// Decodes the commands sent to an adapter.
#[derive(Debug, Clone, Default)]
pub struct CommandDecoder(Collector);

impl CommandDecoder {
    /// Accepts the next byte; returns the command that it completes. An adapter answers an unreadable line with BEL.
    pub fn push(&mut self, byte: u8) -> Option<Result<SlcanCommand, Unreadable>> {
        match byte {
            // Clients clear the line with empty commands, and some end lines with both characters.
            CR if self.0.line.is_empty() => None,
            b'\n' => None,
            CR => Some(self.0.end(parse_command).ok_or(Unreadable)),
            _ => {
                self.0.keep(byte);
                None
            }
        }
    }

    /// Errors met so far.
    pub const fn counts(&self) -> NoiseCounts {
        self.0.counts
    }
}

/// Error for a line that is not a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the line is no command of a serial CAN adapter")]
pub struct Unreadable;

fn parse_answer(line: &[u8]) -> Option<SlcanAnswer> {
    match line {
        [] => Some(SlcanAnswer::Done),
        b"z" | b"Z" => Some(SlcanAnswer::Sent),
        [b'T', rest @ ..] => parse_frame(rest, SlcanFormat::LONG).map(SlcanAnswer::Frame),
        [
            letter @ (b't' | b'r' | b'R' | b'V' | b'v' | b'N' | b'F'),
            rest @ ..,
        ] if rest.iter().all(u8::is_ascii_alphanumeric) => Some(SlcanAnswer::Other(*letter)),
        _ => None,
    }
}

fn parse_command(line: &[u8]) -> Option<SlcanCommand> {
    match line {
        b"O" => Some(SlcanCommand::Open),
        b"C" => Some(SlcanCommand::Close),
        [b'S', code @ b'0'..=b'8'] => Some(SlcanCommand::Bitrate(code - b'0')),
        [b'T', rest @ ..] => parse_frame(rest, SlcanFormat::LONG).map(SlcanCommand::Send),
        [b't', rest @ ..] => other_frame(b't', rest, SlcanFormat::SHORT),
        [b'r', rest @ ..] => other_frame(b'r', rest, SlcanFormat::SHORT.remote()),
        [b'R', rest @ ..] => other_frame(b'R', rest, SlcanFormat::LONG.remote()),
        b"L" => Some(SlcanCommand::Listen),
        [b's', digits @ ..] if digits.len() == 4 => number(digits)
            .and_then(|registers| u16::try_from(registers).ok())
            .map(SlcanCommand::Timing),
        [letter, rest @ ..]
            if b"VvNFZMmXWQPA".contains(letter) && rest.iter().all(u8::is_ascii_alphanumeric) =>
        {
            Some(SlcanCommand::Other(*letter))
        }
        _ => None,
    }
}

/// Format of a frame's text.
#[derive(Debug, Clone, Copy)]
struct SlcanFormat {
    /// Number of hex digits of the identifier.
    digits: usize,
    id_max: u32,
    /// True for a remote frame, which has a length and no data.
    is_remote: bool,
}

impl SlcanFormat {
    const LONG: Self = Self {
        digits: 8,
        id_max: 0x1FFF_FFFF,
        is_remote: false,
    };
    const SHORT: Self = Self {
        digits: 3,
        id_max: 0x7FF,
        is_remote: false,
    };

    const fn remote(mut self) -> Self {
        self.is_remote = true;
        self
    }
}

fn other_frame(letter: u8, text: &[u8], shape: SlcanFormat) -> Option<SlcanCommand> {
    parse_frame(text, shape).map(|_| SlcanCommand::SendOther(letter))
}

/// Parses identifier, length, data and an optional time stamp.
fn parse_frame(text: &[u8], shape: SlcanFormat) -> Option<CanFrame> {
    let (digits, rest) = text.split_at_checked(shape.digits)?;
    let id = number(digits)?;
    let (len, rest) = match rest.split_first()? {
        (digit @ b'0'..=b'8', rest) => (usize::from(digit - b'0'), rest),
        _ => return None,
    };
    let (data, stamp) = rest.split_at_checked(if shape.is_remote { 0 } else { 2 * len })?;
    let stamped = stamp.is_empty() || (stamp.len() == 4 && stamp.iter().all(u8::is_ascii_hexdigit));
    if id > shape.id_max || !stamped {
        return None;
    }
    let (pairs, _) = data.as_chunks::<2>();
    let data: Option<CanData> = pairs
        .iter()
        .map(|[high, low]| Some((nibble(*high)? << 4) | nibble(*low)?))
        .collect();
    Some(CanFrame { id, data: data? })
}

fn number(digits: &[u8]) -> Option<u32> {
    digits.iter().try_fold(0, |number: u32, digit| {
        Some((number << 4) | u32::from(nibble(*digit)?))
    })
}

fn nibble(digit: u8) -> Option<u8> {
    match digit {
        b'0'..=b'9' => Some(digit - b'0'),
        b'a'..=b'f' => Some(digit - b'a' + 10),
        b'A'..=b'F' => Some(digit - b'A' + 10),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::can;
    use crate::hand::Span;
    use proptest::prelude::*;

    fn answers(text: &[u8]) -> (Vec<SlcanAnswer>, NoiseCounts) {
        let mut decoder = AnswerDecoder::default();
        let found = text.iter().filter_map(|byte| decoder.push(*byte)).collect();
        (found, decoder.counts())
    }

    fn commands(text: &[u8]) -> Vec<Result<SlcanCommand, Unreadable>> {
        let mut decoder = CommandDecoder::default();
        text.iter().filter_map(|byte| decoder.push(*byte)).collect()
    }

    fn frame(id: u32, data: &[u8]) -> CanFrame {
        CanFrame {
            id,
            data: CanData::try_from(data).unwrap(),
        }
    }

    #[test]
    fn the_manuals_frames_have_these_lines() {
        let ask = can::read_request(1, Span::new(1552, 2)).unwrap();
        let line = encode_command(&SlcanCommand::Send(ask.clone())).unwrap();
        assert_eq!(&line[..], b"T01840001102\r");
        assert_eq!(commands(b"T01840001102\r"), [Ok(SlcanCommand::Send(ask))]);
        let write = frame(0x0575_0001, &[0x58, 0x02]);
        let line = encode_command(&SlcanCommand::Send(write)).unwrap();
        assert_eq!(&line[..], b"T0575000125802\r");
        let (found, _) = answers(b"T018400012F401\r");
        assert_eq!(found, [SlcanAnswer::Frame(frame(0x0184_0001, &[0xF4, 1]))]);
    }

    #[test]
    fn every_rate_has_its_code_and_others_have_none() {
        assert_eq!(bitrate_code(1_000_000), Some(8));
        assert_eq!(bitrate_code(500_000), Some(6));
        assert_eq!(bitrate_code(10_000), Some(0));
        assert_eq!(bitrate_code(83_333), None);
        let line = encode_command(&SlcanCommand::Bitrate(8)).unwrap();
        assert_eq!(&line[..], b"S8\r");
        assert_eq!(encode_command(&SlcanCommand::Bitrate(9)), None);
    }

    #[test]
    fn acknowledgements_stamps_and_other_frames_are_understood() {
        let got = SlcanAnswer::Frame(frame(0x0184_0001, &[0xF4, 1]));
        for (text, wanted) in [
            (&b"\r"[..], vec![SlcanAnswer::Done]),
            (b"\x07", vec![SlcanAnswer::Failed]),
            (b"z\rZ\r", vec![SlcanAnswer::Sent, SlcanAnswer::Sent]),
            (b"T018400012F401ABCD\r", vec![got.clone()]),
            (b"T018400012f401\r", vec![got.clone()]),
            (b"t1232F401\r", vec![SlcanAnswer::Other(b't')]),
            (
                b"V1013\rNA123\r",
                vec![SlcanAnswer::Other(b'V'), SlcanAnswer::Other(b'N')],
            ),
            (b"Z\rT018400012F401\r", vec![SlcanAnswer::Sent, got.clone()]),
        ] {
            let (found, noise) = answers(text);
            assert_eq!(found, wanted, "{text:?}");
            assert_eq!(noise, NoiseCounts::default(), "{text:?}");
        }
    }

    #[test]
    fn noise_is_skipped_and_counted_and_the_next_line_is_whole() {
        let good = SlcanAnswer::Frame(frame(0x0184_0001, &[0xF4, 1]));
        for noise in [
            &b"\xFF\x00"[..],
            b"T0184",
            b"T018400019\r",
            b"T0184000120\r",
            b"T218400012F401\r",
            b"T018400012F401A\r",
            &[b'0'; 500],
        ] {
            let (found, counts) = answers(&[noise, b"T018400012F401\r"].concat());
            assert_eq!(found, std::slice::from_ref(&good), "{noise:?}");
            assert_eq!(counts.resyncs, 1, "{noise:?}");
            let want = noise.len() - usize::from(noise.ends_with(b"\r"));
            assert_eq!(counts.skipped_bytes, want as u64, "{noise:?}");
        }
    }

    #[test]
    fn an_adapter_says_no_to_what_it_cannot_read() {
        for text in [&b"S9\r"[..], b"S\r", b"OO\r", b"T12\r", b"\xFF\r"] {
            assert_eq!(commands(text), [Err(Unreadable)], "{text:?}");
        }
        assert_eq!(commands(b"\r\r"), []);
        assert_eq!(
            commands(b"C\rS8\rO\r"),
            [
                Ok(SlcanCommand::Close),
                Ok(SlcanCommand::Bitrate(8)),
                Ok(SlcanCommand::Open)
            ]
        );
        assert_eq!(commands(b"V\r"), [Ok(SlcanCommand::Other(b'V'))]);
    }

    proptest! {
        #[test]
        fn frames_read_back_on_both_sides(id in 0_u32..=0x1FFF_FFFF, data in prop::collection::vec(any::<u8>(), 0..9)) {
            let frame = frame(id, &data);
            let line = encode_answer(&SlcanAnswer::Frame(frame.clone())).unwrap();
            prop_assert_eq!(answers(&line).0, [SlcanAnswer::Frame(frame.clone())]);
            let line = encode_command(&SlcanCommand::Send(frame.clone())).unwrap();
            prop_assert_eq!(commands(&line), [Ok(SlcanCommand::Send(frame))]);
        }

        #[test]
        fn no_bytes_make_either_side_panic_or_grow(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
            let (found, noise) = answers(&bytes);
            prop_assert!(found.len() as u64 + noise.skipped_bytes <= bytes.len() as u64);
            commands(&bytes);
        }

        #[test]
        fn lines_of_likely_bytes_read_back_when_accepted(
            text in prop::collection::vec(prop::sample::select(&b"TtZzVS018F\r\x07"[..]), 0..200),
        ) {
            for answer in answers(&text).0 {
                if let Some(line) = encode_answer(&answer) {
                    prop_assert_eq!(answers(&line).0, [answer]);
                }
            }
            for command in commands(&text).into_iter().flatten() {
                if let Some(line) = encode_command(&command) {
                    prop_assert_eq!(commands(&line), [Ok(command)]);
                }
            }
        }
    }
}
