//! A ring that knows each entry by its running number. No times, no meaning.

/// Entries added at once when a ring grows for the first time.
const FIRST_ROOM: usize = 1024;

/// The newest `room` entries of an endless row. Numbers run from 0 and never start again.
#[derive(Debug, Clone)]
pub(crate) struct Ring<T> {
    room: usize,
    kept: Vec<T>,
    end: usize,
}

impl<T: Copy> Ring<T> {
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
        self.kept.get(number % self.room).copied()
    }

    /// The newest.
    pub(crate) fn last(&self) -> Option<T> {
        self.get(self.end.checked_sub(1)?)
    }

    /// The newest, to change it.
    pub(crate) fn last_mut(&mut self) -> Option<&mut T> {
        let newest = self.end.checked_sub(1)?;
        self.kept.get_mut(newest % self.room)
    }

    /// Adds one; the oldest goes if there is no room.
    pub(crate) fn push(&mut self, value: T) {
        match self.kept.get_mut(self.end % self.room) {
            Some(slot) => *slot = value,
            None => {
                self.grow();
                self.kept.push(value);
            }
        }
        self.end += 1;
    }

    /// Bytes held.
    pub(crate) const fn bytes(&self) -> usize {
        self.kept.capacity() * size_of::<T>()
    }

    /// Doubles, and stops exactly at the room there is.
    fn grow(&mut self) {
        let len = self.kept.len();
        if len == self.kept.capacity() {
            let more = len.max(FIRST_ROOM).min(self.room.saturating_sub(len));
            self.kept.reserve_exact(more);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_goes_and_numbers_stay() {
        let mut ring = Ring::new(3);
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
        let mut ring = Ring::new(5000);
        for value in 0..20_000u32 {
            ring.push(value);
        }
        assert_eq!(ring.bytes(), 5000 * 4);
    }
}
