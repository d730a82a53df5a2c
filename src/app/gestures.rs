//! Stand-in.
use crate::hand::Gesture;
use std::collections::BTreeMap;
/// Names.
#[derive(Debug, Clone, Default)]
pub struct GestureBook(pub BTreeMap<u8, String>);
impl GestureBook {
    /// A name.
    #[must_use]
    pub fn name(&self, gesture: Gesture) -> Option<&str> {
        self.0.get(&gesture.get()).map(String::as_str)
    }
}
