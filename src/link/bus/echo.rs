//! Whether an adapter echoes what is sent. Judged by whole exchanges; which bytes are ours is decided by the protocols.

/// Exchanges in a row, all alike, that tell how an adapter is: one echo may be another speaker that asked the same.
const SURE: u32 = 3;

/// What the exchanges of one wire showed so far.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Echo {
    came_back: bool,
    in_a_row: u32,
}

impl Echo {
    /// A request goes out.
    pub(crate) const fn sent(&mut self) {
        self.came_back = false;
    }

    /// What was sent came back.
    pub(crate) const fn came_back(&mut self) {
        self.came_back = true;
    }

    /// The reply to it came. An echo comes before it or not at all.
    pub(crate) fn answered(&mut self) {
        self.in_a_row = if self.came_back {
            self.in_a_row.saturating_add(1).min(SURE)
        } else {
            0
        };
    }

    /// True if the last whole exchange had an echo: the next one must expect it.
    pub(crate) const fn is_likely(&self) -> bool {
        self.in_a_row > 0
    }

    /// True if the adapter echoes.
    pub(crate) const fn is_sure(&self) -> bool {
        self.in_a_row >= SURE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_echoed_exchanges_in_a_row_tell_and_one_without_takes_it_back() {
        let mut echo = Echo::default();
        let mut exchange = |comes_back: bool| {
            echo.sent();
            if comes_back {
                echo.came_back();
            }
            echo.answered();
            (echo.is_likely(), echo.is_sure())
        };
        assert_eq!(exchange(true), (true, false));
        assert_eq!(exchange(true), (true, false));
        assert_eq!(exchange(true), (true, true));
        assert_eq!(exchange(false), (false, false));
        assert_eq!(exchange(true), (true, false));
    }
}
