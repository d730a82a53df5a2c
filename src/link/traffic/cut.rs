//! Splits a stream of one direction into frames and runs of other bytes, by a protocol's verdict at each position.
//! Bounded; independent of the protocol.

use crate::link::traffic::frame::Wrong;

/// Maximum bytes kept for an incomplete frame: the longest frame of any wire has 261.
pub const WAITING_MAX: usize = 600;
/// Maximum length of a run of other bytes in one entry.
const RUN_MAX: usize = 128;

/// A protocol's verdict at one position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameCut {
    /// A frame of this many bytes.
    Whole(usize),
    /// A damaged frame of this many bytes. A valid one may begin inside.
    Damaged(usize, Wrong),
    /// An incomplete frame; its length if known.
    Open(Option<usize>),
    /// No frame begins here.
    Nothing(Wrong),
}

/// One cut piece of the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StreamPiece {
    /// The bytes, at least one.
    pub bytes: Vec<u8>,
    /// Fault of the bytes; `None` for a valid frame.
    pub wrong: Option<Wrong>,
}

/// The bytes of one direction that are still incomplete.
#[derive(Debug, Clone, Default)]
pub struct Cutter {
    waiting: Vec<u8>,
}

impl Cutter {
    /// Applies bytes and passes the resulting pieces to `out`. At most [`WAITING_MAX`] bytes are kept.
    pub fn push(
        &mut self,
        mut bytes: &[u8],
        look: impl Fn(&[u8]) -> FrameCut,
        mut out: impl FnMut(StreamPiece),
    ) {
        while !bytes.is_empty() {
            let room = WAITING_MAX.saturating_sub(self.waiting.len()).max(1);
            let (now, later) = bytes.split_at(room.min(bytes.len()));
            self.waiting.extend_from_slice(now);
            bytes = later;
            self.cut(&look, &mut out, false);
            if self.waiting.len() >= WAITING_MAX {
                self.cut(&look, &mut out, true);
            }
        }
    }

    /// Called when the line is silent: cuts all incomplete bytes, as the rest will not come.
    pub fn flush(&mut self, look: impl Fn(&[u8]) -> FrameCut, mut out: impl FnMut(StreamPiece)) {
        self.cut(&look, &mut out, true);
    }

    /// Number of incomplete bytes.
    pub const fn waiting(&self) -> usize {
        self.waiting.len()
    }

    fn cut(
        &mut self,
        look: &impl Fn(&[u8]) -> FrameCut,
        out: &mut impl FnMut(StreamPiece),
        silent: bool,
    ) {
        let mut run = NoiseRun::default();
        let mut at = 0;
        while let Some(rest @ [_, ..]) = self.waiting.get(at..) {
            let (len, wrong) = match look(rest) {
                FrameCut::Whole(len) => (len, None),
                FrameCut::Damaged(len, wrong) => (until_next(rest, len, look), Some(wrong)),
                FrameCut::Open(_) if !silent => break,
                FrameCut::Open(want) => {
                    let got = until_next(rest, rest.len(), look);
                    (got, Some(Wrong::CutOff { got, want }))
                }
                FrameCut::Nothing(wrong) => {
                    run.push(rest, wrong, out);
                    at += 1;
                    continue;
                }
            };
            run.end(out);
            let len = len.clamp(1, rest.len());
            let bytes = rest.get(..len).unwrap_or_default().to_vec();
            out(StreamPiece { bytes, wrong });
            at += len;
        }
        run.end(out);
        self.waiting.drain(..at.min(self.waiting.len()));
    }
}

/// Bytes up to the first valid frame after a damaged beginning, or all `len`.
fn until_next(bytes: &[u8], len: usize, look: impl Fn(&[u8]) -> FrameCut) -> usize {
    let good = |at: &usize| {
        let rest = bytes.get(*at..).unwrap_or_default();
        matches!(look(rest), FrameCut::Whole(_))
    };
    (1..len.min(bytes.len())).find(good).unwrap_or(len)
}

/// Consecutive bytes at which no frame begins.
#[derive(Default)]
struct NoiseRun {
    bytes: Vec<u8>,
    wrong: Option<Wrong>,
}

impl NoiseRun {
    fn push(&mut self, rest: &[u8], wrong: Wrong, out: &mut impl FnMut(StreamPiece)) {
        if self.bytes.len() >= RUN_MAX {
            self.end(out);
        }
        self.bytes.extend(rest.first());
        self.wrong.get_or_insert(wrong);
    }

    fn end(&mut self, out: &mut impl FnMut(StreamPiece)) {
        let run = std::mem::take(self);
        if run.bytes.is_empty() {
            return;
        }
        // The length of a run is known only at its end.
        let len = run.bytes.len();
        let wrong = match run.wrong {
            Some(Wrong::NoFrame { .. }) | None => Wrong::NoFrame { len },
            Some(wrong) => wrong,
        };
        out(StreamPiece {
            bytes: run.bytes,
            wrong: Some(wrong),
        });
    }
}
