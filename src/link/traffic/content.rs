//! Content of a frame, extracted from its protocol, before it is matched with its request.

use crate::hand::Span;
use crate::link::traffic::frame::{Kind, Wrong};

/// Content of a frame, apart from its framing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameContent {
    /// Request, reply, event of the wire, or noise.
    pub kind: Kind,
    /// The hand that is addressed, or that answers.
    pub hand: Option<u16>,
    /// The memory range; `None` in a Modbus reply to a read.
    pub span: Option<Span>,
    /// Number of bytes of memory; equals the span's length if there is one.
    pub len: Option<u16>,
    /// Number that links a reply to its request (Modbus TCP).
    pub transaction: Option<u16>,
    /// Bytes of memory, in memory order.
    pub memory: Vec<u8>,
    /// Fault that is visible without the request.
    pub wrong: Option<Wrong>,
}

impl FrameContent {
    /// Content of this kind, and nothing more.
    pub const fn new(kind: Kind) -> Self {
        Self {
            kind,
            hand: None,
            span: None,
            len: None,
            transaction: None,
            memory: Vec::new(),
            wrong: None,
        }
    }

    /// Sets the hand.
    #[must_use]
    pub const fn hand(mut self, hand: u16) -> Self {
        self.hand = Some(hand);
        self
    }

    /// Sets the memory range.
    #[must_use]
    pub const fn about(mut self, span: Span) -> Self {
        self.len = Some(span.len);
        self.span = Some(span);
        self
    }

    /// Sets the carried bytes of memory.
    #[must_use]
    pub fn with(mut self, memory: &[u8]) -> Self {
        self.memory = memory.to_vec();
        self
    }

    /// Sets this fault, unless one is set already.
    #[must_use]
    pub fn wrong(mut self, wrong: impl Into<Option<Wrong>>) -> Self {
        self.wrong = self.wrong.or(wrong.into());
        self
    }

    /// Content of bytes that are not a frame.
    pub fn noise(wrong: Wrong) -> Self {
        Self::new(Kind::Noise).wrong(wrong)
    }
}
