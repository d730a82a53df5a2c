//! The hands of the program, and which of them is shown.

use crate::app::hand::Connection;
use crate::app::hands::Hand;
use crate::app::slot::SlotId;
use crate::hand::Moment;

/// Hands in one window: as many keys as there are for them, and as many strips as fit a header.
pub const HANDS_MAX: usize = 8;

/// The hands of the program, and which of them is shown. There is always one, connected or not.
#[derive(Debug, Default)]
pub struct HandList {
    first: Hand,
    more: Vec<Hand>,
    shown: usize,
    /// The slot that was given last.
    given: SlotId,
    /// Poses and demos go to all hands that are armed.
    poses_for_all: bool,
}

impl HandList {
    /// The hand that is shown.
    pub fn shown(&self) -> &Hand {
        let more = self.shown.checked_sub(1);
        more.and_then(|at| self.more.get(at)).unwrap_or(&self.first)
    }

    /// The same, to be changed.
    pub fn shown_mut(&mut self) -> &mut Hand {
        let more = self.shown.checked_sub(1);
        match more.and_then(|at| self.more.get_mut(at)) {
            Some(hand) => hand,
            None => &mut self.first,
        }
    }

    /// All hands.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Hand> {
        std::iter::once(&mut self.first).chain(&mut self.more)
    }

    /// All hands.
    pub fn iter(&self) -> impl Iterator<Item = &Hand> {
        std::iter::once(&self.first).chain(&self.more)
    }

    /// How many slots there are.
    pub const fn count(&self) -> usize {
        1 + self.more.len()
    }

    /// True if there is more than one.
    pub const fn is_several(&self) -> bool {
        !self.more.is_empty()
    }

    /// True if there is room for another.
    pub const fn has_room(&self) -> bool {
        self.count() < HANDS_MAX
    }

    /// The hand of this slot.
    pub(crate) fn get_mut(&mut self, slot: SlotId) -> Option<&mut Hand> {
        self.iter_mut().find(|hand| hand.label.slot == slot)
    }

    /// True if this hand would lead itself by leading that one, directly or over others.
    pub fn is_circle(&self, leader: SlotId, follower: SlotId) -> bool {
        let before = |slot| {
            let mut all = self.iter();
            let hand = all.find(|hand| hand.label.slot == slot)?;
            hand.leader()
        };
        let line = std::iter::successors(Some(leader), |slot| before(*slot));
        line.take(HANDS_MAX).any(|slot| slot == follower)
    }

    /// The shown hand, and where poses go to all, the others of which this is so.
    pub(crate) fn with_shown(
        &mut self,
        goes_along: impl Fn(&Hand) -> bool,
    ) -> impl Iterator<Item = &mut Hand> {
        let (shown, to_all) = (self.shown().label.slot, self.poses_for_all());
        let is_meant =
            move |hand: &&mut Hand| hand.label.slot == shown || to_all && goes_along(hand);
        self.iter_mut().filter(is_meant)
    }

    /// Whether poses and demos go to all hands that are armed.
    pub const fn poses_for_all(&self) -> bool {
        self.poses_for_all && self.is_several()
    }

    /// Lets them go to all hands that are armed, or to the shown one alone.
    pub(crate) const fn set_poses_for_all(&mut self, on: bool) {
        self.poses_for_all = on;
    }

    /// Another slot, which is shown from now on. Nothing where there is no room.
    pub fn add(&mut self, now: Moment) {
        if !self.has_room() {
            return;
        }
        self.given = self.given.next();
        let mut hand = Hand {
            connection: Connection::none(now),
            ..Hand::default()
        };
        hand.label.slot = self.given;
        self.more.push(hand);
        self.shown = self.more.len();
    }

    pub fn show(&mut self, slot: SlotId) {
        let at = self.iter().position(|hand| hand.label.slot == slot);
        self.shown = at.unwrap_or(self.shown);
    }

    /// Takes this slot away, with all that is known of its hand. The last one stays.
    pub(crate) fn remove(&mut self, slot: SlotId) {
        let shown = self.shown().label.slot;
        if self.first.label.slot == slot && self.is_several() {
            self.first = self.more.remove(0);
        } else {
            self.more.retain(|hand| hand.label.slot != slot);
        }
        // The one that is shown stays so; in place of one that went, the first.
        self.shown = 0;
        self.show(shown);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slots(list: &HandList) -> Vec<SlotId> {
        list.iter().map(|hand| hand.label.slot).collect()
    }

    #[test]
    fn there_is_always_a_hand_and_never_more_than_fit() {
        let mut list = HandList::default();
        for _ in 0..20 {
            list.add(Moment::ZERO);
        }
        assert_eq!(list.count(), HANDS_MAX);
        for slot in slots(&list) {
            list.remove(slot);
        }
        assert_eq!((list.count(), list.is_several()), (1, false));
    }

    #[test]
    fn the_shown_hand_stays_shown_while_others_go_and_no_slot_comes_again() {
        let mut list = HandList::default();
        list.add(Moment::ZERO);
        list.add(Moment::ZERO);
        let [first, second, third] = slots(&list)[..] else {
            panic!("three")
        };
        list.show(second);
        list.remove(first);
        assert_eq!(list.shown().label.slot, second);
        list.remove(third);
        assert_eq!(list.shown().label.slot, second);
        list.add(Moment::ZERO);
        assert!(![first, second, third].contains(&list.shown().label.slot));
        list.remove(list.shown().label.slot);
        assert_eq!(list.shown().label.slot, second);
    }
}

/// What the user does with the list of hands. None of it moves a hand.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum HandsAction {
    /// Another slot, without a hand so far, that is shown from now on.
    Add,
    /// Show this hand.
    Show(SlotId),
    /// Leave this hand as *Disconnect* does, and take its slot away. The last slot stays.
    Remove(SlotId),
    /// Give this hand a name; empty takes it away.
    Name(SlotId, String),
    /// Hold this hand now, and no other.
    StopOne(SlotId),
    /// Poses and demos go to all hands that are armed, or to the shown one alone.
    PosesForAll(bool),
}
