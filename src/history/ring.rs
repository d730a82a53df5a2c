//! A ring buffer whose entries are addressed by a running number.

/// Entries per memory chunk. Chunks are added and never moved, so that no frame pays for copying an hour of data.
const PIECE: usize = 4096;

/// The newest `room` entries of an endless sequence. Numbers start at 0 and are never reused.
#[derive(Debug, Clone)]
pub(crate) struct RowRing<T> {
    room: usize,
    kept: Vec<Vec<T>>,
    end: usize,
}

impl<T: Copy> RowRing<T> {
    /// Holds at most `room` entries, at least one. Allocates only as it fills.
    pub(crate) const fn new(room: usize) -> Self {
        let room = if room == 0 { 1 } else { room };
        Self {
            room,
            kept: Vec::new(),
            end: 0,
        }
    }

    /// Number after that of the newest entry.
    pub(crate) const fn end(&self) -> usize {
        self.end
    }

    /// Number of the oldest entry that is still held.
    pub(crate) const fn start(&self) -> usize {
        self.end.saturating_sub(self.room)
    }

    /// The entry with this number, if it is still held.
    pub(crate) fn get(&self, number: usize) -> Option<T> {
        if number < self.start() || number >= self.end {
            return None;
        }
        let slot = self.slot(number);
        self.kept.get(slot / PIECE)?.get(slot % PIECE).copied()
    }

    /// The newest entry.
    pub(crate) fn last(&self) -> Option<T> {
        self.get(self.end.checked_sub(1)?)
    }

    /// The newest entry, mutable.
    pub(crate) fn last_mut(&mut self) -> Option<&mut T> {
        let slot = self.slot(self.end.checked_sub(1)?);
        self.kept.get_mut(slot / PIECE)?.get_mut(slot % PIECE)
    }

    /// Adds an entry; drops the oldest if the ring is full.
    pub(crate) fn push(&mut self, value: T) {
        let slot = self.slot(self.end);
        if slot / PIECE == self.kept.len() {
            self.kept.push(self.piece(slot));
        }
        if let Some(piece) = self.kept.get_mut(slot / PIECE) {
            match piece.get_mut(slot % PIECE) {
                Some(kept) => *kept = value,
                None => piece.push(value),
            }
        }
        self.end += 1;
    }

    /// Memory held, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        let entries: usize = self.kept.iter().map(Vec::capacity).sum();
        entries * size_of::<T>()
    }

    /// An empty chunk that begins at this slot. The first one grows on demand, as short sequences need little memory.
    fn piece(&self, slot: usize) -> Vec<T> {
        if slot == 0 {
            return Vec::new();
        }
        Vec::with_capacity(PIECE.min(self.room.saturating_sub(slot)))
    }

    /// Slot of an entry. Division is slow, and not needed until the ring wraps, after the first hour.
    const fn slot(&self, number: usize) -> usize {
        if number < self.room {
            number
        } else {
            number % self.room
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_goes_and_numbers_stay() {
        let mut ring = RowRing::new(3);
        for value in 0..10 {
            ring.push(value * 10);
        }
        assert_eq!((ring.start(), ring.end(), ring.last()), (7, 10, Some(90)));
        assert_eq!(
            (6..11).map(|i| ring.get(i)).collect::<Vec<_>>(),
            [None, Some(70), Some(80), Some(90), None]
        );
    }

    #[test]
    fn memory_ends_at_the_room() {
        let mut ring = RowRing::new(5000);
        for value in 0..20_000u32 {
            ring.push(value);
        }
        assert_eq!(ring.bytes(), 5000 * 4);
        assert!((15_000..20_000).all(|row| ring.get(row) == u32::try_from(row).ok()));
    }

    #[test]
    fn what_is_held_never_moves_in_memory() {
        let mut ring = RowRing::new(100_000);
        (0..=PIECE).for_each(|value| ring.push(value));
        let place = ring.kept.first().map(Vec::as_ptr);
        (0..90_000).for_each(|value| ring.push(value));
        assert_eq!(ring.kept.first().map(Vec::as_ptr), place);
    }
}
