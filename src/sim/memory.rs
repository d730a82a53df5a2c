//! Register memory by byte address, with access rules, ranges and a flash copy. Nothing moves here.

use crate::hand::register::{
    ACTION_SEQ_RUN, ANGLE_SET, Access, CLEAR_ERROR, DEFAULT_FORCE_SET, DEFAULT_SPEED_SET, Element,
    FORCE_SET, GESTURE_FORCE_CLB, Persistence, REGISTERS, RESET_PARA, Register, SAVE, SPEED_SET,
    Span, by_address,
};
use crate::sim::personality::OutOfRangeWrite;

/// Addresses of the hand: twelve bits, as CAN ids have room for.
pub const MEMORY_LEN: usize = 4096;
/// The unused bytes between ANGLE_ACT and FORCE_ACT.
pub const GAP: Span = Span::new(1558, 24);
/// Speeds and force thresholds after power-up, as delivered.
// Manual: 2.6.8 and 2.6.9 print no value.
const DEFAULT_SETTING: i16 = 1000;

/// Why the hand does not answer a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AccessError {
    /// The run leaves the memory.
    #[error("addresses {address} to {last} leave the memory")]
    Unmapped {
        /// First byte.
        address: u16,
        /// Last byte.
        last: u32,
    },
    /// This hand does not let the unused bytes be read.
    #[error("this hand does not answer reads of the unused bytes 1558 to 1581")]
    Gap,
    /// A value outside its range, on a hand that says so.
    #[error("a value at {address} is out of range")]
    OutOfRange {
        /// First byte of the write.
        address: u16,
    },
    /// A register that can only be read, on a hand that says so.
    #[error("{address} can only be read")]
    ReadOnly {
        /// First byte of the write.
        address: u16,
    },
    /// This hand says nothing at all.
    #[error("the hand is silent")]
    Silent,
    /// A run without a byte.
    #[error("a run of no bytes at {address}")]
    Empty {
        /// First byte.
        address: u16,
    },
}

/// One element that a write changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The row.
    pub register: &'static Register,
    /// Which element, 0 the first.
    pub element: u16,
    /// Its new value.
    pub value: i32,
}

/// The hand's memory and its flash copy.
#[derive(Debug, Clone)]
pub struct Memory {
    ram: Vec<u8>,
    flash: Vec<u8>,
}

impl Memory {
    /// As delivered, with this id.
    pub fn new(id: u8) -> Self {
        let mut memory = Self {
            ram: vec![0; MEMORY_LEN],
            flash: Vec::new(),
        };
        for row in &REGISTERS {
            memory.put_default(row);
        }
        memory.put_byte(1000, id);
        memory.flash.clone_from(&memory.ram);
        memory.load_power_up_settings();
        memory
    }

    fn put_default(&mut self, row: &Register) {
        let value = match (row.address, row.default) {
            (1032 | 1044, _) => i32::from(DEFAULT_SETTING),
            // A gesture that nobody has taught moves no joint.
            (1066, _) => -1,
            (_, Some(value)) => value,
            (_, None) => 0,
        };
        for element in 0..row.count() {
            match row.element {
                Element::Byte => self.put_byte(row.address + element, low_byte(value)),
                Element::Short => self.put_short(row, element, i16::try_from(value).unwrap_or(0)),
                Element::Tactile => {}
            }
        }
    }

    fn load_power_up_settings(&mut self) {
        for element in 0..6 {
            let speed = self.short(&DEFAULT_SPEED_SET, element);
            self.put_short(&SPEED_SET, element, speed);
            let force = self.short(&DEFAULT_FORCE_SET, element);
            self.put_short(&FORCE_SET, element, force);
        }
    }

    /// The bytes of a run, which must lie in the memory.
    ///
    /// # Errors
    /// [`AccessError::Unmapped`] beyond 4095, [`AccessError::Empty`] without a byte.
    pub fn read(&self, span: Span) -> Result<&[u8], AccessError> {
        check(span, MEMORY_LEN)?;
        let from = usize::from(span.address);
        self.ram
            .get(from..from + usize::from(span.len))
            .ok_or(AccessError::Unmapped {
                address: span.address,
                last: span.end() - 1,
            })
    }

    /// As [`Self::read`], with zeros for what lies beyond the memory, up to address 65535.
    ///
    /// # Errors
    /// [`AccessError::Unmapped`] beyond 65535, [`AccessError::Empty`] without a byte.
    pub fn read_on(&self, span: Span) -> Result<Vec<u8>, AccessError> {
        check(span, usize::from(u16::MAX) + 1)?;
        let inside = self.ram.iter().skip(usize::from(span.address)).copied();
        let all = inside.chain(std::iter::repeat(0));
        Ok(all.take(usize::from(span.len)).collect())
    }

    /// One byte; zero outside.
    pub fn byte(&self, address: u16) -> u8 {
        self.ram
            .get(usize::from(address))
            .copied()
            .unwrap_or_default()
    }

    /// One element of a row of shorts.
    pub fn short(&self, row: &Register, element: u16) -> i16 {
        let at = row.address + 2 * element;
        i16::from_le_bytes([self.byte(at), self.byte(at + 1)])
    }

    /// Puts a byte, past all rules: what the hand itself does.
    pub fn put_byte(&mut self, address: u16, value: u8) {
        if let Some(byte) = self.ram.get_mut(usize::from(address)) {
            *byte = value;
        }
    }

    /// Puts one element of a row of shorts, past all rules.
    pub fn put_short(&mut self, row: &Register, element: u16, value: i16) {
        self.put(row.address + 2 * element, &value.to_le_bytes());
    }

    /// Puts bytes, past all rules.
    pub fn put(&mut self, address: u16, bytes: &[u8]) {
        for (at, byte) in (address..).zip(bytes) {
            self.put_byte(at, *byte);
        }
    }

    /// A write from outside: keeps what access and range allow, and says what it kept.
    ///
    /// Manual: it has no answer that says no. A refused element is acknowledged and has no effect.
    ///
    /// # Errors
    /// [`AccessError::Unmapped`] beyond 4095, [`AccessError::Empty`] without a byte.
    pub fn write(
        &mut self,
        address: u16,
        bytes: &[u8],
        out_of_range: OutOfRangeWrite,
    ) -> Result<Vec<Change>, AccessError> {
        let len = u16::try_from(bytes.len()).unwrap_or(u16::MAX);
        check(Span::new(address, len), MEMORY_LEN)?;
        let elements = elements(address, bytes);
        let fits = |(_, row, value): &(u16, &Register, i32)| row.allows(*value);
        if out_of_range == OutOfRangeWrite::Exception && !elements.iter().all(fits) {
            return Err(AccessError::OutOfRange { address });
        }
        let kept = |(at, row, value)| self.keep(row, at, value, out_of_range);
        Ok(elements.into_iter().filter_map(kept).collect())
    }

    fn keep(
        &mut self,
        row: &'static Register,
        at: u16,
        value: i32,
        out_of_range: OutOfRangeWrite,
    ) -> Option<Change> {
        let value = match (row.allows(value), row.range, out_of_range) {
            (true, ..) => value,
            (false, Some((min, max)), OutOfRangeWrite::Clamp) => value.clamp(min, max),
            (false, Some((min, max)), OutOfRangeWrite::Wrap) => {
                min + (value - min).rem_euclid(max - min + 1)
            }
            _ => return None,
        };
        let element = (at - row.address) / row.element_len();
        match row.element {
            Element::Byte => self.put_byte(at, low_byte(value)),
            _ => self.put_short(row, element, i16::try_from(value).unwrap_or_default()),
        }
        Some(Change {
            register: row,
            element,
            value,
        })
    }

    /// Copies the saved parameters to flash (manual 2.6.4).
    pub fn save(&mut self) {
        copy_saved(&self.ram, &mut self.flash);
    }

    /// Returns the saved parameters to the factory's (manual 2.6.5), in memory and in flash.
    pub fn reset_parameters(&mut self) {
        for row in REGISTERS.iter().filter(|row| is_saved(row)) {
            self.put_default(row);
        }
        self.save();
    }

    /// Loses what is not in flash, and loads the speeds and thresholds for power-up.
    pub fn power_cycle(&mut self) {
        for row in REGISTERS.iter().filter(|row| !is_saved(row)) {
            self.put_default(row);
        }
        copy_saved(&self.flash, &mut self.ram);
        self.load_power_up_settings();
    }

    /// Puts back the registers that only trigger something.
    pub fn rearm_triggers(&mut self) {
        for row in [
            CLEAR_ERROR,
            SAVE,
            RESET_PARA,
            GESTURE_FORCE_CLB,
            ACTION_SEQ_RUN,
        ] {
            self.put_byte(row.address, 0);
        }
    }

    /// Sets ANGLE_SET to where a joint is, as at power-up.
    pub fn put_angle_set(&mut self, element: u16, angle: i16) {
        self.put_short(&ANGLE_SET, element, angle);
    }
}

/// The whole elements of writable registers among these bytes, with their addresses and values.
fn elements(address: u16, bytes: &[u8]) -> Vec<(u16, &'static Register, i32)> {
    let (mut at, mut rest) = (address, bytes);
    let mut elements = Vec::new();
    while let Some((first, after_one)) = rest.split_first() {
        let row = by_address(at).filter(|row| row.access == Access::ReadWrite);
        let (value, after) = match (row.map(|row| row.element), rest.split_first_chunk::<2>()) {
            (Some(Element::Byte), _) => (Some(i32::from(*first)), after_one),
            (Some(Element::Short), Some((pair, after))) if starts_element(row, at) => {
                (Some(i32::from(i16::from_le_bytes(*pair))), after)
            }
            _ => (None, after_one),
        };
        elements.extend(row.zip(value).map(|(row, value)| (at, row, value)));
        at = at.saturating_add(if after.len() + 1 == rest.len() { 1 } else { 2 });
        rest = after;
    }
    elements
}

fn starts_element(row: Option<&'static Register>, at: u16) -> bool {
    row.is_some_and(|row| (at - row.address).is_multiple_of(row.element_len()))
}

fn is_saved(row: &Register) -> bool {
    row.persistence == Persistence::Saved
}

fn copy_saved(from: &[u8], to: &mut [u8]) {
    for row in REGISTERS.iter().filter(|row| is_saved(row)) {
        let range = usize::from(row.address)..usize::from(row.address + row.len);
        if let (Some(from), Some(to)) = (from.get(range.clone()), to.get_mut(range)) {
            to.copy_from_slice(from);
        }
    }
}

fn check(span: Span, memory_len: usize) -> Result<(), AccessError> {
    if span.len == 0 {
        return Err(AccessError::Empty {
            address: span.address,
        });
    }
    if usize::try_from(span.end()).is_ok_and(|end| end <= memory_len) {
        return Ok(());
    }
    Err(AccessError::Unmapped {
        address: span.address,
        last: span.end() - 1,
    })
}

fn low_byte(value: i32) -> u8 {
    u8::try_from(value).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(memory: &mut Memory, address: u16, bytes: &[u8]) -> usize {
        memory
            .write(address, bytes, OutOfRangeWrite::Drop)
            .unwrap()
            .len()
    }

    #[test]
    fn writes_keep_to_access_and_range() {
        let mut memory = Memory::new(1);
        assert_eq!(write(&mut memory, 1546, &[1; 12]), 0);
        assert_eq!(write(&mut memory, 1486, &[0xD0, 0x07]), 0);
        assert_eq!(write(&mut memory, 1488, &[0xFF, 0xFF]), 1);
        assert_eq!(write(&mut memory, 1486, &[0x64, 0, 0xE8, 3, 0xE9, 3]), 2);
        assert_eq!(memory.short(&ANGLE_SET, 1), 1000);
        assert_eq!(memory.short(&ANGLE_SET, 2), 0);
        assert_eq!(write(&mut memory, 1487, &[1, 2, 0]), 1);
        assert_eq!(write(&mut memory, 1000, &[0]), 0);
        memory
            .write(1490, &[0xE9, 3], OutOfRangeWrite::Clamp)
            .unwrap();
        assert_eq!(memory.short(&ANGLE_SET, 2), 1000);
    }

    #[test]
    fn unmapped_addresses_read_as_zero_and_beyond_the_memory_not_at_all() {
        let memory = Memory::new(1);
        assert_eq!(memory.read(GAP).unwrap(), [0; 24]);
        assert_eq!(memory.read(Span::new(4000, 96)).unwrap(), [0; 96]);
        assert!(memory.read(Span::new(4095, 2)).is_err());
        assert!(memory.read(Span::new(0, 0)).is_err());
    }

    #[test]
    fn only_what_was_saved_outlives_the_power() {
        let mut memory = Memory::new(1);
        write(&mut memory, 1000, &[7]);
        write(&mut memory, 1032, &[0x64, 0]);
        memory.save();
        write(&mut memory, 1000, &[9]);
        write(&mut memory, 1522, &[5, 0]);
        write(&mut memory, 1700, &[10, 0, 0, 9]);
        memory.power_cycle();
        assert_eq!(memory.byte(1000), 7);
        assert_eq!(memory.short(&SPEED_SET, 0), 100);
        assert_eq!(memory.short(&SPEED_SET, 1), 1000);
        assert_eq!(
            memory.read(Span::new(1700, 4)).unwrap(),
            [192, 168, 11, 210]
        );
        memory.reset_parameters();
        assert_eq!(memory.byte(1000), 1);
        assert_eq!(memory.short(&DEFAULT_SPEED_SET, 0), 1000);
    }
}
