//! Register memory by byte address, with access rules, ranges and a flash copy. No motion.

use crate::hand::register::{
    ACTION_SEQ_RUN, ANGLE_SET, Access, CLEAR_ERROR, DEFAULT_FORCE_SET, DEFAULT_SPEED_SET, Element,
    FORCE_SET, GESTURE_FORCE_CLB, Persistence, REGISTERS, RESET_PARA, Register, SAVE, SPEED_SET,
    Span, by_address,
};
use crate::sim::personality::OutOfRangeWrite;

/// Size of the hand's address space: twelve bits, as in CAN ids.
pub const MEMORY_LEN: usize = 4096;
/// The unused bytes between ANGLE_ACT and FORCE_ACT.
pub const GAP: Span = Span::new(1558, 24);
/// Factory value of the speeds and force thresholds after power-up.
// Manual: 2.6.8 and 2.6.9 print no value.
const DEFAULT_SETTING: i16 = 1000;

/// Reason why the hand does not answer a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AccessError {
    /// The range leaves the memory.
    #[error("addresses {address} to {last} leave the memory")]
    Unmapped {
        /// First byte.
        address: u16,
        /// Last byte.
        last: u32,
    },
    /// This hand does not allow reads of the unused bytes.
    #[error("this hand does not answer reads of the unused bytes 1558 to 1581")]
    Gap,
    /// A value is out of range, on a hand that reports it.
    #[error("a value at {address} is out of range")]
    OutOfRange {
        /// First byte of the write.
        address: u16,
    },
    /// The register is read-only, on a hand that reports it.
    #[error("{address} can only be read")]
    ReadOnly {
        /// First byte of the write.
        address: u16,
    },
    /// This hand does not answer at all.
    #[error("the hand is silent")]
    Silent,
    /// The range is empty.
    #[error("a run of no bytes at {address}")]
    Empty {
        /// First byte.
        address: u16,
    },
}

/// One element that a write changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemoryChange {
    /// The row.
    pub register: &'static Register,
    /// Index of the element, from 0.
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
    /// Creates the memory in factory state with this id.
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
            // A gesture that was not taught moves no joint.
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

    /// Returns the bytes of a range, which must lie in the memory.
    ///
    /// # Errors
    /// [`AccessError::Unmapped`] beyond 4095, [`AccessError::Empty`] for an empty range.
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

    /// Like [`Self::read`], with zeros beyond the memory, up to address 65535.
    ///
    /// # Errors
    /// [`AccessError::Unmapped`] beyond 65535, [`AccessError::Empty`] for an empty range.
    pub fn read_on(&self, span: Span) -> Result<Vec<u8>, AccessError> {
        check(span, usize::from(u16::MAX) + 1)?;
        let inside = self.ram.iter().skip(usize::from(span.address)).copied();
        let all = inside.chain(std::iter::repeat(0));
        Ok(all.take(usize::from(span.len)).collect())
    }

    /// Returns one byte; zero outside the memory.
    pub fn byte(&self, address: u16) -> u8 {
        self.ram
            .get(usize::from(address))
            .copied()
            .unwrap_or_default()
    }

    /// Returns one element of a row of 16-bit values.
    pub fn short(&self, row: &Register, element: u16) -> i16 {
        let at = row.address + 2 * element;
        i16::from_le_bytes([self.byte(at), self.byte(at + 1)])
    }

    /// Writes a byte without access checks, for the hand itself.
    pub fn put_byte(&mut self, address: u16, value: u8) {
        if let Some(byte) = self.ram.get_mut(usize::from(address)) {
            *byte = value;
        }
    }

    /// Writes one element of a row of 16-bit values without access checks.
    pub fn put_short(&mut self, row: &Register, element: u16, value: i16) {
        self.put(row.address + 2 * element, &value.to_le_bytes());
    }

    /// Writes bytes without access checks.
    pub fn put(&mut self, address: u16, bytes: &[u8]) {
        for (at, byte) in (address..).zip(bytes) {
            self.put_byte(at, *byte);
        }
    }

    /// Applies a write from outside: stores the elements that access and range allow, and returns them.
    ///
    /// Manual: there is no negative acknowledgement. A refused element is acknowledged and has no effect.
    ///
    /// # Errors
    /// [`AccessError::Unmapped`] beyond 4095, [`AccessError::Empty`] for an empty range.
    pub fn write(
        &mut self,
        address: u16,
        bytes: &[u8],
        out_of_range: OutOfRangeWrite,
    ) -> Result<Vec<MemoryChange>, AccessError> {
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
    ) -> Option<MemoryChange> {
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
        Some(MemoryChange {
            register: row,
            element,
            value,
        })
    }

    /// Copies the saved parameters to flash (manual 2.6.4).
    pub fn save(&mut self) {
        copy_saved(&self.ram, &mut self.flash);
    }

    /// Restores the factory values of the saved parameters (manual 2.6.5), in memory and in flash.
    pub fn reset_parameters(&mut self) {
        for row in REGISTERS.iter().filter(|row| is_saved(row)) {
            self.put_default(row);
        }
        self.save();
    }

    /// Drops values that are not in flash, and loads the speeds and thresholds for power-up.
    pub fn power_cycle(&mut self) {
        for row in REGISTERS.iter().filter(|row| !is_saved(row)) {
            self.put_default(row);
        }
        copy_saved(&self.flash, &mut self.ram);
        self.load_power_up_settings();
    }

    /// Resets the registers that only trigger something.
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

    /// Sets ANGLE_SET to a joint's actual angle, as at power-up.
    pub fn put_angle_set(&mut self, element: u16, angle: i16) {
        self.put_short(&ANGLE_SET, element, angle);
    }
}

/// Extracts the whole elements of writable registers among these bytes, with their addresses and values.
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
