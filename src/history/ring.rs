//! A ring that knows each entry by its running number. No times, no meaning.

/// Entries in one piece of memory. Pieces are added and never moved, so that no frame pays for a copy of an hour.
const PIECE: usize = 4096;

/// The newest `room` entries of an endless row. Numbers run from 0 and never start again.
#[derive(Debug, Clone)]
pub(crate) struct RowRing<T> {
    room: usize,
    kept: Vec<Vec<T>>,
    end: usize,
}

impl<T: Copy> RowRing<T> {
    /// Keeps at most this many, at least one. Takes memory only as it fills.
    pub(crate) const fn new(room: usize) -> Self {
        let room = if room == 0 { 1 } else { room };
        Self {
            room,
            kept: Vec::new(),
            end: 0,
        }
    }

    /// The number after the newest.
    pub(crate) const fn end(&self) -> usize {
        self.end
    }

    /// The number of the oldest that is still held.
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

    /// The newest.
    pub(crate) fn last(&self) -> Option<T> {
        self.get(self.end.checked_sub(1)?)
    }

    /// The newest, to change it.
    pub(crate) fn last_mut(&mut self) -> Option<&mut T> {
        let slot = self.slot(self.end.checked_sub(1)?);
        self.kept.get_mut(slot / PIECE)?.get_mut(slot % PIECE)
    }

    /// Adds one; the oldest goes if there is no room.
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

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        let entries: usize = self.kept.iter().map(Vec::capacity).sum();
        entries * size_of::<T>()
    }

    /// An empty piece that begins at this slot. The first one grows, as short rows need little.
    fn piece(&self, slot: usize) -> Vec<T> {
        if slot == 0 {
            return Vec::new();
        }
        Vec::with_capacity(PIECE.min(self.room.saturating_sub(slot)))
    }

    /// Where an entry lies. A division is slow, and for the first hour there is none.
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
