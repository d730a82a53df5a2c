//! What a frame says, taken out of its protocol, before it is set against what was asked.

use crate::hand::Span;
use crate::link::traffic::frame::{Kind, Wrong};

/// Content of a frame, apart from its framing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameContent {
    /// Request, reply, event of the wire, or noise.
    pub kind: Kind,
    /// The hand that is addressed, or that answers.
    pub hand: Option<u16>,
    /// The memory it is about; a Modbus reply to a read does not say.
    pub span: Option<Span>,
    /// How many bytes of memory it is about; equals the span's where there is one.
    pub len: Option<u16>,
    /// Number by which a reply belongs to its request (Modbus TCP).
    pub transaction: Option<u16>,
    /// Bytes of memory, in memory order.
    pub memory: Vec<u8>,
    /// What can be seen to be wrong about it by itself.
    pub wrong: Option<Wrong>,
}

impl FrameContent {
    /// Of this kind, and nothing more.
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

    /// To or from this hand.
    #[must_use]
    pub const fn hand(mut self, hand: u16) -> Self {
        self.hand = Some(hand);
        self
    }

    /// Sets the memory that the frame is about.
    #[must_use]
    pub const fn about(mut self, span: Span) -> Self {
        self.len = Some(span.len);
        self.span = Some(span);
        self
    }

    /// Carrying these bytes of memory.
    #[must_use]
    pub fn with(mut self, memory: &[u8]) -> Self {
        self.memory = memory.to_vec();
        self
    }

    /// With this fault, unless one is known already.
    #[must_use]
    pub fn wrong(mut self, wrong: impl Into<Option<Wrong>>) -> Self {
        self.wrong = self.wrong.or(wrong.into());
        self
    }

    /// Bytes that are no frame.
    pub fn noise(wrong: Wrong) -> Self {
        Self::new(Kind::Noise).wrong(wrong)
    }
}
