//! Chooses the range of memory of one read: the due parts, joined if one longer read is cheaper than two, through a gap
//! between registers if the hand permits it. Pure; does not decide when a part is due.

use crate::hand::register::{POS_SET, TOUCH, by_address};
use crate::hand::{Finger, Group, RateClass, Span};
use crate::link::poll::cost::WireCost;
use crate::link::quirks::GapRead;
use arrayvec::ArrayVec;
use std::time::Duration;

/// Maximum shapes of one window.
pub(crate) const SHAPES_MAX: usize = 32;
/// Maximum shapes that differ from the window by bytes before or after it.
const VARIED_MAX: usize = 14;
/// Maximum bytes that a shape adds to its window. A further fingertip would cost more than the distinction is worth.
const VARIED_BYTES_MAX: u16 = 24;
/// Ranges without registers, through which a hand may refuse to be read (manual 2.6 lists none there).
pub(crate) const GAPS: [Span; 2] = [Span::new(1510, 12), Span::new(1558, 24)];
/// Memory with registers, gaps included.
const REGIONS: [Span; 2] = [Span::new(POS_SET.address, 1624 - POS_SET.address), TOUCH];
/// Failures of a window through a gap before the gap is blamed: one may be chance.
const STRIKES: u8 = 2;

/// Memory that is read as a whole: groups that belong together. On Modbus RTU a reply is identified by its length
/// alone, and with short reads of equal length a hand that duplicates its replies would be lost
/// ([`LinkTrouble::Ambiguous`](crate::link::LinkTrouble::Ambiguous)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ReadPart {
    /// ANGLE_ACT.
    Angle,
    /// FORCE_ACT.
    Force,
    /// CURRENT, ERROR and STATUS.
    Drives,
    /// TEMP.
    Temperature,
    /// POS_ACT.
    Position,
    /// ANGLE_SET and FORCE_SET.
    Targets,
    /// SPEED_SET.
    Speeds,
    /// One fingertip.
    Tip(Finger),
}

impl ReadPart {
    pub(crate) const ALL: [Self; 12] = [
        Self::Angle,
        Self::Force,
        Self::Drives,
        Self::Temperature,
        Self::Position,
        Self::Targets,
        Self::Speeds,
        Self::Tip(Finger::Little),
        Self::Tip(Finger::Ring),
        Self::Tip(Finger::Middle),
        Self::Tip(Finger::Index),
        Self::Tip(Finger::Thumb),
    ];

    /// The first and the last of its groups, which are contiguous.
    const fn groups(self) -> (Group, Group) {
        match self {
            Self::Angle => (Group::Angle, Group::Angle),
            Self::Force => (Group::Force, Group::Force),
            Self::Drives => (Group::Current, Group::Status),
            Self::Temperature => (Group::Temperature, Group::Temperature),
            Self::Position => (Group::Position, Group::Position),
            Self::Targets => (Group::AngleSet, Group::ForceSet),
            Self::Speeds => (Group::SpeedSet, Group::SpeedSet),
            Self::Tip(finger) => (Group::Tactile(finger), Group::Tactile(finger)),
        }
    }

    /// Its memory range.
    pub(crate) fn span(self) -> Span {
        let (first, last) = self.groups();
        hull(first.span(), last.span())
    }

    /// Its rate class.
    pub(crate) const fn rate(self) -> RateClass {
        self.groups().0.rate()
    }

    /// True for angles and forces: the motion state.
    pub(crate) const fn is_motion(self) -> bool {
        matches!(self, Self::Angle | Self::Force)
    }
}

/// State of the gaps on this connection.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Gaps([GapState; GAPS.len()]);

#[derive(Debug, Clone, Copy, Default)]
struct GapState {
    /// A window through it was answered.
    open: bool,
    /// Failed windows through it, while none was answered.
    strikes: u8,
    /// The last window through it failed, and nothing was answered since.
    suspect: bool,
    refused: bool,
}

impl Gaps {
    /// State for a known gap between angles and forces; the other is unknown.
    pub(crate) fn known(read: GapRead) -> Self {
        let gap = GapState {
            open: read == GapRead::Through,
            refused: read == GapRead::Split,
            ..GapState::default()
        };
        Self([GapState::default(), gap])
    }

    /// True if a window may cover this memory.
    fn allow(&self, span: Span) -> bool {
        let mut gaps = self.0.iter().zip(GAPS);
        gaps.all(|(gap, place)| !overlap(span, place) || !(gap.refused || gap.suspect))
    }

    /// Records an answered window. If only windows through a gap fail, the gap is the cause.
    pub(crate) fn answered(&mut self, span: Span) {
        for (gap, place) in self.0.iter_mut().zip(GAPS) {
            if overlap(span, place) {
                gap.open = true;
                gap.strikes = 0;
            } else if gap.suspect {
                gap.refused |= gap.strikes >= STRIKES;
            }
            gap.suspect = false;
        }
    }

    /// Records a window without a valid reply.
    pub(crate) fn failed(&mut self, span: Span) {
        for (gap, place) in self.0.iter_mut().zip(GAPS) {
            if overlap(span, place) && !gap.open && !gap.refused {
                gap.strikes = gap.strikes.saturating_add(1);
                gap.suspect = true;
            }
        }
    }

    /// True if windows are split because of a gap.
    pub(crate) fn are_split(&self) -> bool {
        self.0.iter().any(|gap| gap.refused)
    }
}

/// Parameters for joining windows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Joining {
    pub(crate) cost: WireCost,
    pub(crate) turnaround: Duration,
    /// Maximum data bytes.
    pub(crate) longest: u16,
    pub(crate) gaps: Gaps,
}

impl Joining {
    /// The window around `first`: other parts join if they cost less in it than by themselves.
    pub(crate) fn window(
        &self,
        first: Span,
        others: impl Iterator<Item = ReadPart> + Clone,
    ) -> Span {
        let mut window = first;
        loop {
            let wider = others
                .clone()
                .map(|part| (part.span(), hull(window, part.span())))
                .filter(|(part, hull)| !window.covers(*part) && self.pays(window, *part, *hull))
                .min_by_key(|(_, hull)| hull.len);
            match wider {
                Some((_, hull)) => window = hull,
                None => return window,
            }
        }
    }

    fn pays(&self, window: Span, part: Span, hull: Span) -> bool {
        let read = |span: Span| self.cost.read(span.len, self.turnaround);
        hull.len <= self.longest && self.gaps.allow(hull) && read(hull) <= read(window) + read(part)
    }

    /// The window, and shapes of it with more bytes at its ends, shortest first. No two consecutive replies may look
    /// alike, and no late one may look like the next.
    pub(crate) fn shapes(&self, window: Span) -> ArrayVec<Span, SHAPES_MAX> {
        let room = room(window);
        let most = self.longest.saturating_sub(window.len);
        let most = most.min(VARIED_BYTES_MAX);
        let ends = (0..=most / 2).flat_map(|extra| {
            let all = 2 * extra;
            let behind = (all <= room.behind).then_some((0, all));
            let before = (all > 0 && all <= room.before).then_some((all, 0));
            let both = (all > room.behind && all > room.before && all <= room.behind + room.before)
                .then(|| (all - room.behind, room.behind));
            let begins = |ends: &(u16, u16)| {
                !self.cost.begins_groups || begins_group(window.address - ends.0)
            };
            let (before, both) = (before.filter(begins), both.filter(begins));
            behind.into_iter().chain(before).chain(both)
        });
        ends.map(|(before, behind)| {
            Span::new(window.address - before, window.len + before + behind)
        })
        .take(VARIED_MAX)
        .collect()
    }
}

/// Bytes of registers around a window that could be read with it.
struct Margins {
    before: u16,
    behind: u16,
}

fn room(window: Span) -> Margins {
    let region = REGIONS.into_iter().find(|region| region.covers(window));
    let region = region.unwrap_or(window);
    let gaps_before = GAPS.iter().map(|gap| gap.end());
    let start = gaps_before
        .filter(|end| *end <= u32::from(window.address))
        .fold(u32::from(region.address), u32::max);
    let gaps_behind = GAPS.iter().map(|gap| u32::from(gap.address));
    let end = gaps_behind
        .filter(|start| *start >= window.end())
        .fold(region.end(), u32::min);
    Margins {
        before: u16::try_from(u32::from(window.address).saturating_sub(start)).unwrap_or(0) / 2 * 2,
        behind: u16::try_from(end.saturating_sub(window.end())).unwrap_or(0) / 2 * 2,
    }
}

fn begins_group(address: u16) -> bool {
    by_address(address).is_some_and(|group| group.address == address)
}

fn overlap(a: Span, b: Span) -> bool {
    u32::from(a.address) < b.end() && u32::from(b.address) < a.end()
}

fn hull(a: Span, b: Span) -> Span {
    let from = a.address.min(b.address);
    let len = a.end().max(b.end()) - u32::from(from);
    Span::new(from, u16::try_from(len).unwrap_or(u16::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn joining(cost: WireCost, turnaround: Duration, longest: u16) -> Joining {
        Joining {
            cost,
            turnaround,
            longest,
            gaps: Gaps::default(),
        }
    }

    fn window(joining: &Joining, first: ReadPart, others: &[ReadPart]) -> (u16, u16) {
        let window = joining.window(first.span(), others.iter().copied());
        (window.address, window.len)
    }

    const STATE_PARTS: [ReadPart; 4] = [
        ReadPart::Angle,
        ReadPart::Force,
        ReadPart::Drives,
        ReadPart::Temperature,
    ];

    #[test]
    fn a_gap_is_read_through_where_that_is_cheaper_than_asking_twice() {
        let fast = joining(WireCost::rs485(Some(115_200)), MS * 3, 252);
        assert_eq!(window(&fast, ReadPart::Angle, &STATE_PARTS), (1546, 78));
        // 24 bytes take 12.5 ms at 19200 baud; another request and reply take 8.9 and the hand's turnaround.
        let slow = WireCost::rs485(Some(19_200));
        let quick_hand = joining(slow, MS, 252);
        assert_eq!(
            window(&quick_hand, ReadPart::Angle, &STATE_PARTS),
            (1546, 12)
        );
        assert_eq!(
            window(&quick_hand, ReadPart::Force, &STATE_PARTS),
            (1582, 42)
        );
        let slow_hand = joining(slow, MS * 8, 252);
        assert_eq!(
            window(&slow_hand, ReadPart::Angle, &STATE_PARTS),
            (1546, 78)
        );
        // Pieces of 8 bytes: the gap is three more of them, and separate reads cost none more.
        let can = joining(WireCost::can(1_000_000), MS, 250);
        assert_eq!(window(&can, ReadPart::Angle, &STATE_PARTS), (1546, 12));
    }

    #[test]
    fn a_window_keeps_to_the_longest_reply() {
        let tips: Vec<ReadPart> = Finger::ALL.map(ReadPart::Tip).to_vec();
        for (longest, wanted) in [(252, 4), (135, 2), (58, 1)] {
            let joining = joining(WireCost::rs485(Some(115_200)), MS, longest);
            assert_eq!(
                window(&joining, ReadPart::Tip(Finger::ALL[0]), &tips),
                (3000, 58 * wanted)
            );
        }
        let short = joining(WireCost::rs485(Some(115_200)), MS * 3, 58);
        assert_eq!(window(&short, ReadPart::Angle, &STATE_PARTS), (1546, 48));
        assert_eq!(
            window(&short, ReadPart::Drives, &[ReadPart::Temperature]),
            (1594, 30)
        );
    }

    #[test]
    fn a_gap_that_is_refused_twice_splits_the_window_and_other_failures_do_not() {
        let mut joining = joining(WireCost::rs485(Some(115_200)), MS * 3, 252);
        let through = joining.window(ReadPart::Angle.span(), STATE_PARTS.into_iter());
        let single = ReadPart::Angle.span();
        joining.gaps.failed(through);
        assert_eq!(window(&joining, ReadPart::Angle, &STATE_PARTS), (1546, 12));
        joining.gaps.failed(single);
        joining.gaps.answered(single);
        assert_eq!(
            joining.window(ReadPart::Angle.span(), STATE_PARTS.into_iter()),
            through
        );
        joining.gaps.failed(through);
        joining.gaps.answered(single);
        assert!(joining.gaps.are_split());
        assert_eq!(window(&joining, ReadPart::Angle, &STATE_PARTS), (1546, 12));
        assert_eq!(window(&joining, ReadPart::Force, &STATE_PARTS), (1582, 42));
        // Once it was read through, it is never blamed.
        let mut known = Gaps::default();
        known.answered(through);
        for _ in 0..9 {
            known.failed(through);
            known.answered(single);
        }
        assert!(!known.are_split());
    }

    #[test]
    fn the_forms_of_a_window_differ_cover_it_and_stay_within_registers() {
        let (rs485, rtu) = (WireCost::rs485(Some(115_200)), WireCost::rtu(115_200, MS));
        for (cost, part, others, longest, least) in [
            (rs485, ReadPart::Angle, &STATE_PARTS[..2], 58, 6),
            (rs485, ReadPart::Angle, &STATE_PARTS[..3], 252, 12),
            (rs485, ReadPart::Drives, &STATE_PARTS[2..], 58, 7),
            (rs485, ReadPart::Tip(Finger::ALL[0]), &[][..], 58, 1),
            (rs485, ReadPart::Tip(Finger::ALL[4]), &[][..], 60, 2),
            (rs485, ReadPart::Targets, &[ReadPart::Speeds][..], 58, 6),
            (rtu, ReadPart::Angle, &STATE_PARTS[..3], 250, 6),
            (rtu, ReadPart::Drives, &STATE_PARTS[2..], 60, 2),
            (rtu, ReadPart::Tip(Finger::ALL[4]), &[][..], 116, 1),
            (WireCost::tcp(), ReadPart::Angle, &STATE_PARTS[..3], 250, 6),
        ] {
            let joining = joining(cost, MS * 3, longest);
            let window = joining.window(part.span(), others.iter().copied());
            let shapes = joining.shapes(window);
            assert!(shapes.len() >= least, "{part:?}: {shapes:?}");
            assert_eq!(shapes[0], window);
            for (n, shape) in shapes.iter().enumerate() {
                assert!(
                    shape.covers(window) && shape.len <= longest,
                    "{part:?} {shape:?}"
                );
                assert!(!shapes[..n].contains(shape), "{part:?} {shape:?}");
                assert!(
                    begins_group(shape.address) || !cost.begins_groups,
                    "{part:?} {shape:?}"
                );
                assert!(
                    REGIONS.iter().any(|region| region.covers(*shape)),
                    "{shape:?}"
                );
                for gap in GAPS {
                    assert_eq!(overlap(*shape, gap), overlap(window, gap), "{shape:?}");
                }
            }
        }
    }
}
