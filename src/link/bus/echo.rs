//! Detects an adapter that echoes what is sent, from whole exchanges; the protocols identify the echoes.

/// Consecutive exchanges, all alike, that are proof: one echo may be another controller with the same request.
const SURE: u32 = 3;

/// Echo state of one wire.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Echo {
    came_back: bool,
    in_a_row: u32,
}

impl Echo {
    /// Records that a request is sent.
    pub(crate) const fn sent(&mut self) {
        self.came_back = false;
    }

    /// Records that the request came back.
    pub(crate) const fn came_back(&mut self) {
        self.came_back = true;
    }

    /// Records the reply. An echo precedes it or does not come at all.
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
