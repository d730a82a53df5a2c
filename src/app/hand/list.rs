//! The hands of the program, and the shown one.

use crate::app::connection::Connection;
use crate::app::hand::Hand;
use crate::app::slot::SlotId;
use crate::hand::Moment;

/// Maximum number of hands in one window: the keys available for them, and the strips that fit a header.
pub const HANDS_MAX: usize = 8;

/// The hands of the program, and the shown one. There is always one, connected or not.
#[derive(Debug, Default)]
pub struct HandList {
    first: Hand,
    more: Vec<Hand>,
    shown: usize,
    /// Newest slot.
    given: SlotId,
    /// Poses and demos apply to all armed hands.
    poses_for_all: bool,
    /// The user opened, left or removed a hand in this run.
    chosen: bool,
}

impl HandList {
    /// The shown hand.
    pub fn shown(&self) -> &Hand {
        let more = self.shown.checked_sub(1);
        more.and_then(|at| self.more.get(at)).unwrap_or(&self.first)
    }

    /// The shown hand, mutable.
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

    /// Number of slots.
    pub const fn count(&self) -> usize {
        1 + self.more.len()
    }

    /// True if there is more than one.
    pub const fn is_several(&self) -> bool {
        !self.more.is_empty()
    }

    /// True if there is room for another hand.
    pub const fn has_room(&self) -> bool {
        self.count() < HANDS_MAX
    }

    /// True if the user opened, left or removed a hand in this run.
    pub(crate) const fn are_chosen(&self) -> bool {
        self.chosen
    }

    /// Notes that the user opened, left or removed a hand.
    pub(crate) const fn set_chosen(&mut self) {
        self.chosen = true;
    }

    /// The hand of this slot.
    pub(crate) fn get_mut(&mut self, slot: SlotId) -> Option<&mut Hand> {
        self.iter_mut().find(|hand| hand.label.slot == slot)
    }

    /// True if `follower` would lead itself by following `leader`, directly or through others.
    pub fn is_circle(&self, leader: SlotId, follower: SlotId) -> bool {
        let before = |slot| {
            let mut all = self.iter();
            let hand = all.find(|hand| hand.label.slot == slot)?;
            hand.leader()
        };
        let line = std::iter::successors(Some(leader), |slot| before(*slot));
        line.take(HANDS_MAX).any(|slot| slot == follower)
    }

    /// The shown hand, and if poses apply to all, the others that satisfy `goes_along`.
    pub(crate) fn with_shown(
        &mut self,
        goes_along: impl Fn(&Hand) -> bool,
    ) -> impl Iterator<Item = &mut Hand> {
        let (shown, to_all) = (self.shown().label.slot, self.poses_for_all());
        let is_meant =
            move |hand: &&mut Hand| hand.label.slot == shown || to_all && goes_along(hand);
        self.iter_mut().filter(is_meant)
    }

    /// True if poses and demos apply to all armed hands.
    pub const fn poses_for_all(&self) -> bool {
        self.poses_for_all && self.is_several()
    }

    /// Applies poses and demos to all armed hands, or to the shown one only.
    pub(crate) const fn set_poses_for_all(&mut self, on: bool) {
        self.poses_for_all = on;
    }

    /// Adds a slot and shows it, if there is room.
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

    /// Removes a slot with all data of its hand. The last slot remains.
    pub(crate) fn remove(&mut self, slot: SlotId) {
        let shown = self.shown().label.slot;
        if self.first.label.slot == slot && self.is_several() {
            self.first = self.more.remove(0);
        } else {
            self.more.retain(|hand| hand.label.slot != slot);
        }
        // The shown hand remains shown; if it was removed, the first one is shown.
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

/// User actions on the list of hands. None of them moves a hand.
#[derive(Debug, Clone, PartialEq, Eq, strum::VariantNames, strum::IntoStaticStr)]
pub enum HandsAction {
    /// Add an empty slot and show it.
    Add,
    /// Show this hand.
    Show(SlotId),
    /// Disconnect this hand as *Disconnect* does, and remove its slot. The last slot remains.
    Remove(SlotId),
    /// Name this hand; an empty name removes it.
    Name(SlotId, String),
    /// Stop (hold) this hand, and no other.
    StopOne(SlotId),
    /// Apply poses and demos to all armed hands, or to the shown one only.
    PosesForAll(bool),
}
