//! What one row of the register map says: place, element, access, range, persistence. The rows stand in `register`.

use std::fmt;

/// A run of bytes in the hand's memory, by byte address.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// First byte.
    pub address: u16,
    /// Number of bytes.
    pub len: u16,
}

impl Span {
    /// A run of `len` bytes from `address`.
    #[must_use]
    pub const fn new(address: u16, len: u16) -> Self {
        Self { address, len }
    }

    /// One past the last byte.
    #[must_use]
    pub const fn end(self) -> u32 {
        self.address as u32 + self.len as u32
    }

    /// True if `inner` lies wholly inside.
    #[must_use]
    pub const fn covers(self, inner: Self) -> bool {
        self.address <= inner.address && inner.end() <= self.end()
    }

    /// The part of `bytes`, which hold this run, that holds `inner`.
    #[must_use]
    pub fn slice(self, bytes: &[u8], inner: Self) -> Option<&[u8]> {
        let from = usize::from(inner.address.checked_sub(self.address)?);
        bytes.get(from..from + usize::from(inner.len))
    }
}

/// What one element of a register is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Element {
    /// An unsigned byte.
    Byte,
    /// A signed 16-bit number, low byte first.
    Short,
    /// A 58-byte fingertip block.
    Tactile,
}

/// Who may do what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Only read.
    Read,
    /// Read and written.
    ReadWrite,
}

/// What happens to a value when the power goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Persistence {
    /// Gone.
    Volatile,
    /// Kept once SAVE was written.
    Saved,
    /// Measured, not kept.
    Live,
}

/// Where a register is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The manual's table.
    Manual,
    /// Other people's drivers; not in the manual's table.
    Field,
}

/// One row of the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Register {
    /// As printed in the manual.
    pub name: &'static str,
    /// First byte.
    pub address: u16,
    /// Bytes.
    pub len: u16,
    /// What an element is.
    pub element: Element,
    /// Read, or read and write.
    pub access: Access,
    /// Smallest and largest value of an element; `None` where the manual gives none.
    pub range: Option<(i32, i32)>,
    /// A value outside the range that is allowed too (-1 = no action).
    pub also: Option<i32>,
    /// Value at delivery, if the manual gives one.
    pub default: Option<i32>,
    /// Unit, empty if none.
    pub unit: &'static str,
    /// Kept or not.
    pub persistence: Persistence,
    /// Section of the manual.
    pub section: &'static str,
    /// Manual or field.
    pub origin: Origin,
    /// One sentence.
    pub meaning: &'static str,
}

impl Register {
    /// The bytes it covers.
    #[must_use]
    pub const fn span(&self) -> Span {
        Span::new(self.address, self.len)
    }

    /// Bytes of one element.
    #[must_use]
    pub const fn element_len(&self) -> u16 {
        match self.element {
            Element::Byte => 1,
            Element::Short => 2,
            Element::Tactile => 58,
        }
    }

    /// Number of elements.
    #[must_use]
    pub const fn count(&self) -> u16 {
        self.len / self.element_len()
    }

    /// True if one element may hold `value`.
    #[must_use]
    pub fn allows(&self, value: i32) -> bool {
        self.also == Some(value)
            || self
                .range
                .is_none_or(|(min, max)| (min..=max).contains(&value))
    }
}

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name, self.address)
    }
}
