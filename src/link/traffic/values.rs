//! Bytes of the hand's memory as register names and numbers. No text in any language but the manual's own names.

use crate::hand::register::{Element, REGISTERS, Register};
use crate::hand::{Span, TactileBlock};
use crate::link::traffic::frame::hex;

/// Values of one register or a part of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RegisterValues {
    /// Register that the value belongs to.
    pub row: &'static Register,
    /// The part of it that the bytes cover.
    pub span: Span,
    /// Its numbers, separated by spaces.
    pub numbers: String,
}

impl RegisterValues {
    /// The manual's name, with the elements in brackets if it is not all of them.
    pub fn name(&self) -> String {
        part_name(self.row, self.span)
    }
}

/// The registers that a range of memory touches, by address.
fn rows(span: Span) -> impl Iterator<Item = (&'static Register, Span)> {
    REGISTERS.iter().filter_map(move |row| {
        let from = row.address.max(span.address);
        let to = row.span().end().min(span.end());
        let len = u16::try_from(to.checked_sub(u32::from(from))?).ok()?;
        (len > 0).then_some((row, Span::new(from, len)))
    })
}

/// The names of the registers in a range of memory: one, or the first and the last; the bare range if none is listed.
pub fn names(span: Span) -> String {
    let mut all = rows(span);
    let Some((row, part)) = all.next() else {
        return format!("{}+{}", span.address, span.len);
    };
    match all.last() {
        None => part_name(row, part),
        Some((last, _)) => format!("{}..{}", row.name, last.name),
    }
}

/// Values of the registers in these bytes.
pub fn held(span: Span, memory: &[u8]) -> Vec<RegisterValues> {
    rows(span)
        .filter_map(|(row, part)| {
            let bytes = span.slice(memory, part)?;
            Some(RegisterValues {
                row,
                span: part,
                numbers: numbers(row, part, bytes),
            })
        })
        .collect()
}

fn part_name(row: &Register, part: Span) -> String {
    let size = row.element_len();
    if part == row.span() || size == 0 || row.count() == 1 {
        return row.name.into();
    }
    let first = (part.address - row.address) / size;
    let last = (part.address + part.len - 1 - row.address) / size;
    if first == last {
        format!("{}({first})", row.name)
    } else {
        format!("{}({first}..{last})", row.name)
    }
}

fn numbers(row: &Register, part: Span, bytes: &[u8]) -> String {
    let joined = |all: Vec<String>| all.join(" ");
    match row.element {
        Element::Byte => joined(bytes.iter().map(u8::to_string).collect()),
        Element::Short if (part.address - row.address).is_multiple_of(2) => {
            let (pairs, odd) = bytes.as_chunks::<2>();
            let shorts = pairs.iter().map(|pair| i16::from_le_bytes(*pair));
            let odd = odd.iter().map(|byte| format!("{byte:02X}h"));
            joined(shorts.map(|n| n.to_string()).chain(odd).collect())
        }
        Element::Tactile if part == row.span() => TactileBlock::decode(bytes)
            .map(|block| tactile(&block))
            .unwrap_or_default(),
        Element::Short | Element::Tactile => format!("{}h", hex(bytes)),
    }
}

fn tactile(block: &TactileBlock) -> String {
    let direction = block
        .direction_deg()
        .map_or_else(|| "-".into(), |degrees| format!("{degrees}°"));
    format!(
        "{:.2} N {:.2} N {direction} {}",
        block.normal_n, block.tangential_n, block.proximity
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::register::{STATE, TEMP};

    #[test]
    fn registers_are_named_as_the_manual_names_them() {
        for (span, name) in [
            (STATE, "ANGLE_ACT..TEMP"),
            (TEMP.span(), "TEMP"),
            (Span::new(1552, 2), "ANGLE_ACT(3)"),
            (Span::new(1546, 8), "ANGLE_ACT(0..3)"),
            (Span::new(1005, 1), "SAVE"),
            (Span::new(1560, 4), "1560+4"),
            (Span::new(3000, 8), "FINGERONE_TOUCH"),
        ] {
            assert_eq!(names(span), name);
        }
    }

    #[test]
    fn bytes_become_signed_numbers_and_the_gap_none() {
        let span = Span::new(1554, 30);
        let mut memory = vec![0; 30];
        memory.splice(0..4, [0xF4, 0x01, 0xFF, 0xFF]);
        memory.splice(28..30, [0x9C, 0xFF]);
        let got: Vec<_> = held(span, &memory)
            .into_iter()
            .map(|held| (held.name(), held.numbers))
            .collect();
        let wanted = [("ANGLE_ACT(4..5)", "500 -1"), ("FORCE_ACT(0)", "-100")];
        let wanted = wanted.map(|(name, numbers)| (name.to_owned(), numbers.to_owned()));
        assert_eq!(got, wanted);
    }

    #[test]
    fn fewer_bytes_than_said_hold_nothing() {
        assert_eq!(held(TEMP.span(), &[1, 2]), []);
        assert_eq!(held(Span::new(u16::MAX, u16::MAX), &[]), []);
    }
}
