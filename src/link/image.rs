//! The hand's memory as last read, with the time of each range, shared by all clients of one hand. Pure: applies
//! replies, writes and failures, and returns bytes with an age. Ranges that were not read are absent.

use crate::hand::feedback::group::TIP_BYTES;
use crate::hand::{Moment, Reply, Span};
use crate::link::poll::window::{GAPS, ReadPart};
use crate::link::request::RequestError;
use arrayvec::ArrayVec;
use std::time::Duration;

/// A range read on request also serves other clients for this long: the period of the slowest polled part.
const AREA_FRESH: Duration = Duration::from_millis(500);
/// However rarely a part is polled, nothing older than this is returned.
const OLDEST: Duration = Duration::from_secs(1);
/// A polled part that does not arrive within this is requested.
const JOIN_WINDOW: Duration = Duration::from_millis(250);
/// Requested ranges kept; the oldest is dropped. Clients of one hand request the same few.
const AREAS_MAX: usize = 16;
/// Number of ranges that are polled as a whole.
const BLOCKS: usize = ReadPart::ALL.len() + GAPS.len();

/// Result of looking up a range of memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum ImageLookup {
    /// The bytes.
    Bytes(Vec<u8>),
    /// A part of it is due soon: look it up again when the image changes, or at this time.
    Soon(Moment),
    /// This range must be requested.
    Missing(Span),
    /// A request for it failed just now.
    Failed(RequestError),
    /// There is no live hand.
    Offline,
}

/// The memory of one hand. While there is no live hand only [`Self::newest`] returns the last values.
#[derive(Debug, Default)]
pub(crate) struct RegisterImage {
    is_live: bool,
    blocks: ArrayVec<PolledRange, BLOCKS>,
    areas: ArrayVec<Area, AREAS_MAX>,
}

/// A range that the session polls, always as a whole.
#[derive(Debug)]
struct PolledRange {
    span: Span,
    /// Configured poll period.
    period: Duration,
    came: Option<Came>,
}

#[derive(Debug)]
struct Came {
    asked: Moment,
    /// Time since the previous read.
    after: Duration,
    bytes: ArrayVec<u8, { TIP_BYTES as usize }>,
}

/// A range read on request, and the result.
#[derive(Debug)]
struct Area {
    span: Span,
    asked: Moment,
    read: Result<Vec<u8>, RequestError>,
}

impl RegisterImage {
    /// The image of a hand that is live from now on, whose parts are polled with these periods.
    pub(crate) fn live(periods: impl Iterator<Item = (ReadPart, Duration)>) -> Self {
        let parts = periods.map(|(part, period)| (part.span(), period));
        // Gaps are read along with their neighbours if the hand allows it.
        let all = parts.chain(GAPS.map(|gap| (gap, AREA_FRESH)));
        let block = |(span, period)| PolledRange {
            span,
            period,
            came: None,
        };
        Self {
            is_live: true,
            blocks: all.map(block).take(BLOCKS).collect(),
            areas: ArrayVec::new(),
        }
    }

    /// Marks the hand as lost.
    pub(crate) fn lose(&mut self) {
        self.is_live = false;
        self.areas.clear();
    }

    /// The last bytes of a polled range, however old.
    pub(crate) fn newest(&self, span: Span) -> Option<Vec<u8>> {
        let mut blocks = self.blocks.iter();
        let block = blocks.find(|block| block.span.covers(span))?;
        let came = block.came.as_ref()?;
        block.span.slice(&came.bytes, span).map(<[u8]>::to_vec)
    }

    /// Applies new poll periods.
    pub(crate) fn change_periods(&mut self, periods: impl Iterator<Item = (ReadPart, Duration)>) {
        for (part, period) in periods {
            let mut blocks = self.blocks.iter_mut();
            if let Some(block) = blocks.find(|block| block.span == part.span()) {
                block.period = period;
            }
        }
    }

    /// Applies a reply to every block that it covers.
    pub(crate) fn apply(&mut self, reply: &Reply<'_>) {
        let held = self
            .blocks
            .iter_mut()
            .filter(|block| reply.span.covers(block.span));
        for block in held {
            let Some(bytes) = reply.span.slice(reply.bytes, block.span) else {
                continue;
            };
            let before = block.came.as_ref().map(|came| came.asked);
            block.came = Some(Came {
                asked: reply.asked,
                after: before.map_or(block.period, |before| reply.asked.since(before)),
                bytes: bytes.iter().copied().collect(),
            });
        }
    }

    /// Stores the result of a requested range.
    pub(crate) fn store_area(
        &mut self,
        span: Span,
        asked: Moment,
        read: Result<Vec<u8>, RequestError>,
    ) {
        self.areas.retain(|area| area.span != span);
        if self.areas.is_full() {
            self.areas.remove(0);
        }
        self.areas.push(Area { span, asked, read });
    }

    /// Drops everything that overlaps a write: the old bytes are no longer valid.
    pub(crate) fn forget(&mut self, written: Span) {
        for block in &mut self.blocks {
            if overlap(block.span, written) {
                block.came = None;
            }
        }
        self.areas.retain(|area| !overlap(area.span, written));
    }

    /// Looks up a range at `now`, for a client that has waited since `since`.
    pub(crate) fn look_up(&self, span: Span, since: Moment, now: Moment) -> ImageLookup {
        if !self.is_live {
            return ImageLookup::Offline;
        }
        let mut bytes = Vec::with_capacity(usize::from(span.len));
        let mut soon = None;
        let mut at = u32::from(span.address);
        while at < span.end() {
            let run = self.run(at, span.end());
            match self.look_up_run(run, since, now) {
                ImageLookup::Bytes(more) => bytes.extend(more),
                ImageLookup::Soon(until) => {
                    soon = Some(soon.map_or(until, |soon: Moment| soon.min(until)))
                }
                other => return other,
            }
            at = run.end();
        }
        soon.map_or(ImageLookup::Bytes(bytes), ImageLookup::Soon)
    }

    /// The range from `at` that lies in one block, or in none.
    fn run(&self, at: u32, end: u32) -> Span {
        let starts = self
            .blocks
            .iter()
            .map(|block| u32::from(block.span.address));
        let edges = starts.chain(self.blocks.iter().map(|block| block.span.end()));
        let until = edges.filter(|edge| *edge > at).fold(end, u32::min);
        let part = |bytes: u32| u16::try_from(bytes).unwrap_or(u16::MAX);
        Span::new(part(at), part(until - at))
    }

    fn look_up_run(&self, run: Span, since: Moment, now: Moment) -> ImageLookup {
        let block = self.blocks.iter().find(|block| block.span.covers(run));
        if let Some(bytes) = block.and_then(|block| block.fresh(run, now)) {
            return ImageLookup::Bytes(bytes);
        }
        let mut areas = self.areas.iter().rev();
        // A reply requested during the wait is fresh for that client, however long all parts of its range take.
        let is_fresh = |area: &&Area| {
            let is_new = area.asked >= since || now.since(area.asked) <= AREA_FRESH;
            area.span.covers(run) && is_new
        };
        if let Some(area) = areas.find(is_fresh) {
            return match &area.read {
                Ok(bytes) => {
                    let bytes = area.span.slice(bytes, run).unwrap_or_default();
                    ImageLookup::Bytes(bytes.to_vec())
                }
                Err(error) => ImageLookup::Failed(error.clone()),
            };
        }
        match block {
            // Requested as a whole, so that it serves all clients of any part.
            Some(block) => match block.comes_by(since) {
                Some(until) if until > now => ImageLookup::Soon(until),
                _ => ImageLookup::Missing(block.span),
            },
            None => ImageLookup::Missing(run),
        }
    }
}

impl PolledRange {
    /// The bytes of a range inside, unless they are older than the block's poll period.
    fn fresh(&self, run: Span, now: Moment) -> Option<Vec<u8>> {
        let came = self.came.as_ref()?;
        let is_fresh = now.since(came.asked) <= self.lasts(came);
        let bytes = self.span.slice(&came.bytes, run)?;
        is_fresh.then(|| bytes.to_vec())
    }

    fn lasts(&self, came: &Came) -> Duration {
        self.period.max(came.after).min(OLDEST)
    }

    /// Time until which it is worth waiting for the next poll; `None` if that is too far off.
    fn comes_by(&self, since: Moment) -> Option<Moment> {
        match &self.came {
            Some(came) => Some(came.asked.plus(self.lasts(came) + JOIN_WINDOW)),
            None => (self.period < JOIN_WINDOW).then(|| since.plus(JOIN_WINDOW)),
        }
    }
}

fn overlap(a: Span, b: Span) -> bool {
    u32::from(a.address) < b.end() && u32::from(b.address) < a.end()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);
    const ANGLES: Span = Span::new(1546, 12);
    const SET: Span = Span::new(1486, 12);

    fn image() -> RegisterImage {
        let period = |part: ReadPart| if part.is_motion() { 10 } else { 500 };
        RegisterImage::live(
            ReadPart::ALL
                .map(|part| (part, MS * period(part)))
                .into_iter(),
        )
    }

    fn at(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    fn apply(image: &mut RegisterImage, span: Span, ms: u64, fill: u8) {
        image.apply(&Reply {
            span,
            bytes: &vec![fill; usize::from(span.len)],
            asked: at(ms),
            received: at(ms + 2),
        });
    }

    fn seen(image: &RegisterImage, span: Span, ms: u64) -> ImageLookup {
        image.look_up(span, at(ms), at(ms))
    }

    #[test]
    fn bytes_are_given_for_one_period_and_then_the_next_read_is_waited_for() {
        let mut image = image();
        assert_eq!(seen(&image, ANGLES, 5), ImageLookup::Soon(at(255)));
        apply(&mut image, Span::new(1546, 24), 10, 7);
        assert_eq!(seen(&image, ANGLES, 20), ImageLookup::Bytes(vec![7; 12]));
        assert_eq!(
            seen(&image, Span::new(1549, 3), 20),
            ImageLookup::Bytes(vec![7; 3])
        );
        assert_eq!(seen(&image, ANGLES, 21), ImageLookup::Soon(at(270)));
        // A session that polls as fast as it can, every 30 ms, serves each reply for that long.
        apply(&mut image, ANGLES, 40, 8);
        assert_eq!(seen(&image, ANGLES, 70), ImageLookup::Bytes(vec![8; 12]));
        assert_eq!(seen(&image, ANGLES, 71), ImageLookup::Soon(at(320)));
        assert_eq!(seen(&image, ANGLES, 320), ImageLookup::Missing(ANGLES));
    }

    #[test]
    fn a_part_of_a_block_is_never_mixed_into_it() {
        let mut image = image();
        apply(&mut image, ANGLES, 10, 7);
        apply(&mut image, Span::new(1550, 8), 12, 8);
        assert_eq!(seen(&image, ANGLES, 13), ImageLookup::Bytes(vec![7; 12]));
    }

    #[test]
    fn what_is_not_read_by_itself_is_asked_for_once_and_then_shared() {
        let (mut image, id) = (image(), Span::new(1000, 2));
        assert_eq!(seen(&image, id, 10), ImageLookup::Missing(id));
        image.store_area(id, at(10), Ok(vec![1, 0]));
        assert_eq!(seen(&image, id, 510), ImageLookup::Bytes(vec![1, 0]));
        assert_eq!(seen(&image, id, 511), ImageLookup::Missing(id));
        let lost = RequestError::LinkLost;
        image.store_area(id, at(600), Err(lost.clone()));
        assert_eq!(seen(&image, id, 601), ImageLookup::Failed(lost));
        // Bytes of two reads are not combined.
        image.store_area(Span::new(1002, 2), at(602), Ok(vec![3, 0]));
        assert_eq!(
            seen(&image, Span::new(1001, 2), 603),
            ImageLookup::Missing(Span::new(1001, 2))
        );
    }

    #[test]
    fn a_read_over_several_blocks_needs_all_of_them() {
        let mut image = image();
        let all = Span::new(1546, 48);
        apply(&mut image, all, 10, 7);
        assert_eq!(
            seen(&image, all, 11),
            ImageLookup::Bytes(vec![7; 48]),
            "the gap came along"
        );
        image.forget(Span::new(1582, 2));
        assert_eq!(seen(&image, all, 11), ImageLookup::Soon(at(261)));
    }

    #[test]
    fn what_was_written_is_asked_for_again() {
        let mut image = image();
        apply(&mut image, Span::new(1486, 48), 10, 7);
        assert_eq!(seen(&image, SET, 100), ImageLookup::Bytes(vec![7; 12]));
        image.forget(Span::new(1488, 2));
        let block = Span::new(1486, 24);
        assert_eq!(seen(&image, SET, 100), ImageLookup::Missing(block));
        image.store_area(block, at(100), Ok(vec![9; 24]));
        assert_eq!(seen(&image, SET, 101), ImageLookup::Bytes(vec![9; 12]));
        image.forget(Span::new(1488, 2));
        assert_eq!(seen(&image, SET, 101), ImageLookup::Missing(block));
    }

    #[test]
    fn without_a_live_hand_nothing_is_known() {
        let image = RegisterImage::default();
        assert_eq!(seen(&image, ANGLES, 1), ImageLookup::Offline);
    }

    #[test]
    fn the_oldest_areas_make_room() {
        let mut image = image();
        for nth in 0..20 {
            image.store_area(Span::new(2000 + 2 * nth, 2), at(1), Ok(vec![0, 0]));
        }
        assert_eq!(image.areas.len(), AREAS_MAX);
        assert_eq!(
            seen(&image, Span::new(2000, 2), 2),
            ImageLookup::Missing(Span::new(2000, 2))
        );
        assert!(matches!(
            seen(&image, Span::new(2038, 2), 2),
            ImageLookup::Bytes(_)
        ));
    }
}
