//! The last frames of a link, decoded from its tap by a viewer. Costs the link only the copying of pieces.

use crate::hand::Moment;
use crate::link::tap::WireTap;
use crate::link::traffic::decode::{Decoder, TrafficEvent};
use crate::link::traffic::frame::{Frame, Wrong};
use crate::transport::Endpoint;
use std::collections::VecDeque;
use std::sync::Arc;

/// Maximum frames kept: half a minute of the fastest wire, and as much as the user looks through.
pub const FRAMES_MAX: usize = 10_000;
/// Number of frames back at which requests are marked "no reply": the next request follows directly.
const LOOK_BACK: usize = 64;

/// The last frames of one link.
#[derive(Debug, Clone, Default)]
pub struct Traffic {
    source: Option<TapSource>,
    frames: VecDeque<Arc<Frame>>,
    changes: u64,
}

#[derive(Debug, Clone)]
struct TapSource {
    tap: WireTap,
    decoder: Decoder,
    next: u64,
}

impl Traffic {
    /// The traffic of this link, from the oldest piece in its tap.
    pub fn of(tap: WireTap, endpoint: &Endpoint) -> Self {
        Self {
            source: Some(TapSource {
                tap,
                decoder: Decoder::new(endpoint),
                next: 0,
            }),
            ..Self::default()
        }
    }

    /// Decodes all available pieces.
    pub fn read_on(&mut self, now: Moment) {
        while self.read_some(now) {}
    }

    /// Decodes some pieces; true if others are available.
    pub fn read_some(&mut self, now: Moment) -> bool {
        let Some(source) = &mut self.source else {
            return false;
        };
        let got = source.tap.after(source.next);
        let is_first = source.next == 0;
        source.next = got.next;
        let mut events = Vec::new();
        if got.lost > 0 && !is_first {
            let at = got.pieces.first().map_or(now, |piece| piece.at);
            source.decoder.gap(at, got.lost, &mut events);
        }
        for piece in &got.pieces {
            source.decoder.push(piece, &mut events);
        }
        if !got.more {
            source.decoder.tick(now, &mut events);
        }
        for event in events {
            self.push(event);
        }
        got.more
    }

    fn push(&mut self, event: TrafficEvent) {
        self.changes += 1;
        match event {
            TrafficEvent::Frame(frame) => {
                if self.frames.len() >= FRAMES_MAX {
                    self.frames.pop_front();
                }
                let later = self.frames.iter().rev().take(LOOK_BACK);
                let later = later.take_while(|other| other.at > frame.at).count();
                let at = self.frames.len().saturating_sub(later);
                self.frames.insert(at, Arc::new(frame));
            }
            TrafficEvent::NoReply(number) => {
                let found = self
                    .frames
                    .iter_mut()
                    .rev()
                    .take(LOOK_BACK)
                    .find(|frame| frame.number == number);
                if let Some(frame) = found.filter(|frame| frame.wrong.is_none()) {
                    Arc::make_mut(frame).wrong = Some(Wrong::NoReply);
                }
            }
        }
    }

    /// The frames, oldest first, at most [`FRAMES_MAX`].
    pub const fn frames(&self) -> &VecDeque<Arc<Frame>> {
        &self.frames
    }

    /// Counter that grows with each change of the frames.
    pub const fn changes(&self) -> u64 {
        self.changes
    }

    /// Number of the newest frame; 0 before the first.
    pub fn newest(&self) -> u64 {
        // A frame that ended by silence may precede one with a smaller number.
        let last = self.frames.iter().rev().take(LOOK_BACK);
        last.map(|frame| frame.number).max().unwrap_or_default()
    }
}
