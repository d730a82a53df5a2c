//! Decides whether a device is a hand of this series, by several groups of its memory; only that verdict permits writing. Pure.
//!
//! The maker's other series use the same frames and have HAND_ID at the same address, but other registers everywhere
//! else: the register that clears errors here saves there. So no single register decides.

use crate::hand::register::{DEFAULT_SPEED_SET, ERROR, POS_ACT};
use crate::hand::{AngleReading, Dof, Group, RegisterWrite, Span};
use crate::link::quirks::TouchVariant;
use crate::record::WriteCause;

/// IP_PART1 to 4 (manual 2.6).
const IP_ADDRESS: u16 = 1700;

/// Kind of device at an endpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum DeviceSeries {
    /// Not enough was read.
    #[default]
    Unknown,
    /// A hand of the series that the manual describes.
    Ours,
    /// Another device, whatever its HAND_ID.
    Other,
}

/// A permitted write; created by [`DeviceSeries::permit`] alone, and buses send no other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PermittedWrite<'a>(&'a RegisterWrite);

impl std::ops::Deref for PermittedWrite<'_> {
    type Target = RegisterWrite;

    fn deref(&self) -> &RegisterWrite {
        self.0
    }
}

impl DeviceSeries {
    /// Permits a write to this device. While the series is unknown only a stop passes.
    pub(crate) fn permit(
        self,
        write: &RegisterWrite,
        cause: WriteCause,
    ) -> Option<PermittedWrite<'_>> {
        match (self, cause) {
            (Self::Ours, _) | (Self::Unknown, WriteCause::Hold) => Some(PermittedWrite(write)),
            (Self::Unknown | Self::Other, _) => None,
        }
    }
}

/// A group of memory that is read for the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SeriesQuestion {
    /// Faults, status and temperatures.
    Drives,
    /// Positions and angles: each determines the joint position.
    Motion,
    /// The network address.
    Ip,
    /// Speeds and forces after power-up.
    Defaults,
}

impl SeriesQuestion {
    /// All groups, in read order.
    pub(crate) const ALL: [Self; 4] = [Self::Drives, Self::Motion, Self::Ip, Self::Defaults];

    /// The possible read shapes, each of another length.
    pub(crate) const fn shapes(self) -> &'static [Span] {
        const DRIVES: [Span; 2] = [
            Span::new(ERROR.address, 18),
            Span::new(ERROR.address + 12, 6),
        ];
        const MOTION: [Span; 3] = [
            Span::new(POS_ACT.address, 24),
            Span::new(POS_ACT.address, 22),
            Span::new(POS_ACT.address, 20),
        ];
        const IP: [Span; 1] = [Span::new(IP_ADDRESS, 4)];
        const DEFAULTS: [Span; 2] = [
            Span::new(DEFAULT_SPEED_SET.address, 24),
            Span::new(DEFAULT_SPEED_SET.address, 12),
        ];
        match self {
            Self::Drives => &DRIVES,
            Self::Motion => &MOTION,
            Self::Ip => &IP,
            Self::Defaults => &DEFAULTS,
        }
    }

    /// Judges the bytes of one of its shapes.
    fn judge(self, span: Span, bytes: &[u8]) -> Sign {
        match self {
            Self::Drives => drives(span, bytes),
            Self::Motion => motion(bytes),
            Self::Ip => ip(bytes),
            Self::Defaults => defaults(bytes),
        }
    }

    /// Judges a refusal: every hand of the series has drives and joints, not all have a network.
    const fn refused(self) -> Sign {
        match self {
            Self::Drives | Self::Motion => Sign::Against,
            Self::Ip | Self::Defaults => Sign::Neither,
        }
    }
}

/// Verdict on one group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sign {
    /// Matches this series, and hardly by chance.
    For,
    /// Inconclusive.
    Neither,
    /// Contradicts this series.
    Against,
}

/// The evidence read so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SeriesEvidence {
    signs: [Option<Sign>; SeriesQuestion::ALL.len()],
    has_fingertips: bool,
    /// Number of groups that had their turn in the present round.
    asked: usize,
}

impl SeriesEvidence {
    /// Applies a reply for one of the groups.
    pub(crate) fn read(&mut self, question: SeriesQuestion, span: Span, bytes: &[u8]) {
        self.note(question, question.judge(span, bytes));
    }

    /// Applies a refusal by the device itself.
    pub(crate) fn refused(&mut self, question: SeriesQuestion) {
        self.note(question, question.refused());
    }

    /// Applies the detected fingertips; a valid checksum is evidence for this series.
    pub(crate) fn fingertips(&mut self, touch: Option<TouchVariant>) {
        self.has_fingertips = touch == Some(TouchVariant::Capacitive);
    }

    fn note(&mut self, question: SeriesQuestion, sign: Sign) {
        if let Some(place) = self.signs.get_mut(question as usize) {
            *place = Some(sign);
        }
    }

    /// True if the verdict still needs a reply for this group.
    pub(crate) fn needs(&self, question: SeriesQuestion) -> bool {
        let is_open = self.unanswered().any(|open| open == question);
        is_open && self.verdict() == DeviceSeries::Unknown
    }

    /// The next group of this round without a reply; `None` once, at the end of each round.
    pub(crate) fn next_question(&mut self) -> Option<SeriesQuestion> {
        while let Some(question) = SeriesQuestion::ALL.get(self.asked) {
            self.asked += 1;
            if self.needs(*question) {
                return Some(*question);
            }
        }
        self.asked = 0;
        None
    }

    /// Reads all groups again if all were answered without a verdict: a hand that moves or warms up gives more evidence.
    pub(crate) fn begin_again(&mut self) {
        if self.unanswered().next().is_none() {
            self.signs = Default::default();
        }
    }

    /// The groups without any reply yet.
    fn unanswered(&self) -> impl Iterator<Item = SeriesQuestion> {
        let signs = self.signs;
        let all = SeriesQuestion::ALL.into_iter().zip(signs);
        all.filter(|(_, sign)| sign.is_none())
            .map(|(question, _)| question)
    }

    /// Computes the verdict. Two groups that match outweigh a third that does not: a cold hand has no temperature
    /// readings, and one on a serial line perhaps no address.
    pub(crate) fn verdict(&self) -> DeviceSeries {
        let count = |wanted| {
            self.signs
                .iter()
                .filter(|sign| **sign == Some(wanted))
                .count()
        };
        let good = count(Sign::For) + usize::from(self.has_fingertips);
        let bad = count(Sign::Against);
        let all_read = self.unanswered().next().is_none();
        if bad >= 2 + good {
            DeviceSeries::Other
        } else if good >= 2 || all_read && good >= 1 && bad <= 1 {
            DeviceSeries::Ours
        } else {
            DeviceSeries::Unknown
        }
    }
}

/// Plausible temperatures, °C, and the number of joints that must be within them.
const WARM: std::ops::RangeInclusive<u8> = 5..=100;
const WARM_LEAST: usize = 4;
/// A temperature or a status that the hand does not know.
const NOT_KNOWN: u8 = 255;
/// The largest code of STATUS (manual 2.6.19).
const STATUS_MAX: u8 = 7;

fn drives(span: Span, bytes: &[u8]) -> Sign {
    let group = |group: Group| span.slice(bytes, group.span()).unwrap_or_default();
    let (temperatures, status) = (group(Group::Temperature), group(Group::Status));
    let warm = temperatures
        .iter()
        .filter(|byte| WARM.contains(byte))
        .count();
    let known = temperatures
        .iter()
        .filter(|byte| **byte != NOT_KNOWN)
        .count();
    let odd = status
        .iter()
        .filter(|code| **code > STATUS_MAX && **code != NOT_KNOWN);
    if odd.count() >= WARM_LEAST || warm == 0 && known >= WARM_LEAST {
        Sign::Against
    } else if warm >= WARM_LEAST {
        Sign::For
    } else {
        Sign::Neither
    }
}

/// Tolerance between a position and its angle: the linkage is nonlinear.
const APART: i32 = 600;
/// Number of joints that must match or contradict.
const JOINTS_LEAST: usize = 4;

/// POS_ACT is 0 where ANGLE_ACT is 1000, and 2000 where it is 0; all twelve are never equal.
fn motion(bytes: &[u8]) -> Sign {
    let (pairs, _) = bytes.as_chunks::<2>();
    let value = |at: usize| pairs.get(at).map(|pair| i16::from_le_bytes(*pair));
    if pairs.windows(2).all(|two| matches!(two, [a, b] if a == b)) {
        return Sign::Against;
    }
    let (mut fits, mut contradicts) = (0, 0);
    for joint in 0..Dof::ALL.len() {
        let (Some(position), Some(angle)) = (value(joint), value(Dof::ALL.len() + joint)) else {
            continue;
        };
        let is_angle = AngleReading::new(angle).hold().is_some();
        let apart = (i32::from(position) - 2 * (1000 - i32::from(angle))).abs();
        if is_angle && apart <= APART {
            fits += 1;
        } else if !is_angle || apart >= 2 * APART {
            contradicts += 1;
        }
    }
    if fits >= JOINTS_LEAST {
        Sign::For
    } else if contradicts >= JOINTS_LEAST {
        Sign::Against
    } else {
        Sign::Neither
    }
}

/// Expects a host address: neither a network nor a multicast address.
fn ip(bytes: &[u8]) -> Sign {
    let Some([first, second, third, last]) = bytes.first_chunk::<4>() else {
        return Sign::Neither;
    };
    let is_alike = first == second && second == third && third == last;
    if (1..=223).contains(first) && !matches!(last, 0 | 255) && !is_alike {
        Sign::For
    } else {
        Sign::Against
    }
}

/// Small numbers match by chance, so they are only evidence against.
fn defaults(bytes: &[u8]) -> Sign {
    let (pairs, _) = bytes.as_chunks::<2>();
    let values = pairs.iter().map(|pair| u16::from_le_bytes(*pair));
    let limits = (0..).map(|at| if at < Dof::ALL.len() { 1000 } else { 3000 });
    let beyond = values.zip(limits).filter(|(value, limit)| value > limit);
    if beyond.count() >= JOINTS_LEAST || pairs.iter().all(|pair| *pair == [0, 0]) {
        Sign::Against
    } else {
        Sign::Neither
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::HandCommand;

    /// The verdict on a device that holds these bytes, after as many reads as needed.
    fn verdict(byte: impl Fn(u16) -> Option<u8>) -> DeviceSeries {
        let mut evidence = SeriesEvidence::default();
        for question in SeriesQuestion::ALL {
            if !evidence.needs(question) {
                continue;
            }
            let span = question.shapes()[0];
            let bytes: Option<Vec<u8>> =
                (span.address..).take(span.len.into()).map(&byte).collect();
            match bytes {
                Some(bytes) => evidence.read(question, span, &bytes),
                None => evidence.refused(question),
            }
        }
        evidence.verdict()
    }

    /// A hand at rest: open, with these temperatures and this address.
    fn hand(degrees: u8, ip: [u8; 4]) -> impl Fn(u16) -> Option<u8> {
        move |at| {
            let word = |word: u16| word.to_le_bytes()[usize::from(at % 2)];
            Some(match at {
                1534..1546 => 0,
                1546..1558 => word(1000),
                1032..1044 => word(1000),
                1044..1056 => word(500),
                1618..1624 => degrees,
                1700..1704 => ip[usize::from(at - 1700)],
                _ => 0,
            })
        }
    }

    #[test]
    fn questions_without_an_answer_have_their_turns_and_then_a_pause() {
        let mut evidence = SeriesEvidence::default();
        for _ in 0..2 {
            let asked = std::iter::from_fn(|| evidence.next_question());
            assert!(asked.eq(SeriesQuestion::ALL));
        }
        evidence.refused(SeriesQuestion::ALL[0]);
        assert_eq!(evidence.next_question(), Some(SeriesQuestion::ALL[1]));
    }

    #[test]
    fn hands_of_the_series_pass_warm_or_cold_with_a_network_or_without() {
        for degrees in [25, 45, 99, 255, 0, 1] {
            for ip in [[192, 168, 11, 210], [10, 0, 0, 7], [0; 4], [255; 4]] {
                let series = verdict(hand(degrees, ip));
                let is_odd = degrees < 5 && matches!(ip, [0 | 255, ..]);
                let wanted = if is_odd {
                    DeviceSeries::Unknown
                } else {
                    DeviceSeries::Ours
                };
                assert_eq!(series, wanted, "{degrees} {ip:?}");
            }
        }
    }

    #[test]
    fn fingertips_speak_for_a_cold_hand_without_a_network() {
        let hand = hand(0, [0; 4]);
        let mut evidence = SeriesEvidence::default();
        evidence.fingertips(Some(TouchVariant::Capacitive));
        for question in SeriesQuestion::ALL {
            let span = question.shapes()[0];
            let bytes = (span.address..).take(span.len.into()).filter_map(&hand);
            evidence.read(question, span, &bytes.collect::<Vec<_>>());
        }
        assert_eq!(evidence.verdict(), DeviceSeries::Ours);
    }

    #[test]
    fn a_hand_of_another_series_does_not_pass() {
        // RH56F1: registers are words at addresses of their own; undefined ones read 0.
        let f1 = |at: u16| {
            let words = match at {
                1000 => 1,
                1032 | 1033 => 500,
                1034..1040 => 100,
                1040..1046 => 900,
                1046..1058 => 500,
                _ => 0u16,
            };
            Some(words.to_le_bytes()[0])
        };
        assert_eq!(verdict(f1), DeviceSeries::Other);
        // The same, but undefined registers are refused.
        let shy = |at| f1(at).filter(|_| !(1140..3000).contains(&at));
        assert_eq!(verdict(shy), DeviceSeries::Other);
    }

    #[test]
    fn devices_whose_registers_are_all_alike_do_not_pass() {
        for value in [0u16, 1, 30, 100, 500, 667, 0x1E1E, 0x2828, 0xFFFF] {
            let all_alike = |at: u16| Some(value.to_le_bytes()[usize::from(at % 2)]);
            assert_eq!(verdict(all_alike), DeviceSeries::Other, "{value}");
        }
        // An energy meter: small numbers that differ by address.
        let meter = |at: u16| Some((230 + at % 7).to_le_bytes()[usize::from(at % 2)]);
        assert_eq!(verdict(meter), DeviceSeries::Other);
    }

    #[test]
    fn what_is_not_known_may_be_stopped_and_what_is_other_not_even_that() {
        let write = &HandCommand::ClearErrors.writes()[0];
        for cause in WriteCause::ALL {
            let is_hold = cause == WriteCause::Hold;
            assert!(DeviceSeries::Ours.permit(write, cause).is_some());
            assert_eq!(
                DeviceSeries::Unknown.permit(write, cause).is_some(),
                is_hold
            );
            assert!(DeviceSeries::Other.permit(write, cause).is_none());
        }
    }
}
