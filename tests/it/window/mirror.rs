//! One hand of the window that leads another: only once a person lets it, within the limits, never in a circle; and once either is
//! lost or stopped, neither moves on.

use crate::setup::window::{ANGLE_SET, Bench, Role};
use handscope::app::action::Action;
use handscope::app::hand::Hand;
use handscope::app::hand::list::HandsAction;
use handscope::app::inputs::InputAction;
use handscope::app::notices::NoticeKind;
use handscope::app::slot::SlotId;
use handscope::hand::{Angle, Dof, Fault, Gesture, register};
use handscope::inputs::mirror::MirrorScale;
use handscope::link::Owner;
use handscope::motion::follow::step::FollowPhase;
use handscope::motion::source::SourceKind;
use handscope::record::{Disarmed, LinkState};
use handscope::ui::View;

const SECOND: &str = "tcp:10.0.0.2:6000";
const THIRD: &str = "tcp:10.0.0.3:6000";
const GRANT: &str = "Let it move the hand: Another hand";
const CIRCLE: &str = "in a circle";

/// The built-in hand in the first slot and another in the second.
fn two() -> Bench {
    let mut bench = Bench::live();
    bench.open_another(SECOND);
    bench
}

fn hand(bench: &Bench, at: usize) -> &Hand {
    bench.state().hands.iter().nth(at).unwrap()
}

fn slot(bench: &Bench, at: usize) -> SlotId {
    hand(bench, at).label.slot
}

fn show(bench: &mut Bench, at: usize) {
    let slot = slot(bench, at);
    bench.act(Action::Hands(HandsAction::Show(slot)));
    bench.show(View::Inputs);
    bench.run(60);
    bench.click_button("Share: Another hand");
    bench.run(60);
}

/// The hand of one slot watches that of another.
fn watch(bench: &mut Bench, follower: usize, leader: usize) {
    show(bench, follower);
    let wanted = Some((slot(bench, leader), MirrorScale::WHOLE));
    bench.act(Action::Input(InputAction::Mirror(wanted)));
    bench.run(200);
}

/// A person lets the one lead the other.
fn lead(bench: &mut Bench, follower: usize, leader: usize) {
    watch(bench, follower, leader);
    bench.click_button(GRANT);
    bench.run(300);
    assert_eq!(
        hand(bench, follower).connection.outside_owner(),
        Some(Owner::Mirror)
    );
    assert!(hand(bench, follower).connection.is_armed());
}

fn arm(bench: &mut Bench, at: usize) {
    show(bench, at);
    bench.click("Arm the hand");
    bench.run(200);
    assert!(hand(bench, at).connection.is_armed());
}

/// A person moves the index of this hand.
fn send(bench: &mut Bench, at: usize, index: i64) {
    show(bench, at);
    bench.act(Action::Target(Dof::Index, Angle::nearest(index)));
}

/// Somebody else, at the first hand itself, moves its index: one write that is not this program's.
fn send_there(bench: &Bench, index: i16) {
    let mut bytes = [0xFF; 12];
    bytes[6..8].copy_from_slice(&index.to_le_bytes());
    let address = register::ANGLE_SET.span().address;
    bench.hand(|hand, now| hand.write(address, &bytes, now).unwrap());
}

/// The index as this hand told it last.
fn index(bench: &Bench, at: usize) -> i16 {
    hand(bench, at).readings.sample.angle.unwrap().value[Dof::Index].raw()
}

/// Where the index was sent last.
fn sent(bench: &Bench, at: usize) -> Option<i16> {
    let view = hand(bench, at).running.following()?.view?;
    Some(view.sent[Dof::Index]?.get())
}

/// Both are still, and nobody may move either.
fn both_rest(bench: &mut Bench) {
    bench.run(600);
    let before = [index(bench, 0), index(bench, 1)];
    bench.run(1000);
    for at in [0, 1] {
        let hand = hand(bench, at);
        assert_eq!(
            (hand.connection.status.armed, hand.connection.status.holder),
            (None, None),
            "{at}"
        );
        assert!((index(bench, at) - before[at]).abs() <= 2, "{at}");
    }
}

#[test]
fn a_hand_is_led_only_once_a_person_lets_it_and_stays_within_the_limits() {
    let mut bench = two();
    arm(&mut bench, 0);
    show(&mut bench, 1);
    assert!(bench.is_disabled(Role::Button, GRANT), "none is chosen");
    bench.choose("Leading hand", "1 · sim:?seed=1");
    bench.run(300);
    assert!(!bench.texts_with("The leading hand answers, ").is_empty());
    assert!(bench.is_on("Watch the leading hand"));
    let open = index(&bench, 1);
    send(&mut bench, 0, 600);
    bench.run(3000);
    assert!(index(&bench, 0).abs_diff(600) <= 25);
    assert_eq!(
        (bench.addresses_at(SECOND).len(), index(&bench, 1)),
        (0, open)
    );
    assert!(hand(&bench, 1).connection.outside_owner().is_none());
    show(&mut bench, 1);
    bench.click_button(GRANT);
    let limits = bench.state().settings.follow;
    let mut before = open;
    for _ in 0..200 {
        bench.run(20);
        let Some(to) = sent(&bench, 1) else { continue };
        let ahead = to.abs_diff(index(&bench, 1));
        // What was read is a reading older than what was sent.
        assert!(ahead <= limits.lead + 40, "{ahead} ahead");
        let most = limits.rate * 20 / 1000;
        assert!(to.abs_diff(before) <= most * 3, "{before} to {to} at once");
        before = to;
    }
    assert!(index(&bench, 1).abs_diff(600) <= 25, "{}", index(&bench, 1));
    assert!(!bench.texts_with("Another hand: 1 · sim:").is_empty());
    let leader = hand(&bench, 0);
    assert_eq!(
        leader.connection.status.holder.unwrap().owner,
        Owner::Person
    );
    let to = sent(&bench, 1).unwrap();
    bench.click_button("Take back");
    bench.run(1500);
    assert!(!hand(&bench, 1).connection.is_armed());
    assert!(index(&bench, 1).abs_diff(to) <= 25);
    assert!(
        hand(&bench, 0).connection.is_armed(),
        "a person took the other back"
    );
}

#[test]
fn half_a_bend_is_followed_where_that_is_wanted() {
    let mut bench = two();
    watch(&mut bench, 1, 0);
    bench.type_into("Share, %", "50");
    bench.key(egui::Key::Enter);
    bench.run(300);
    let mirror = hand(&bench, 1).inputs.mirror.as_ref().unwrap();
    assert_eq!(mirror.scale, MirrorScale::new(0.5).unwrap());
    bench.click_button(GRANT);
    send_there(&bench, 500);
    bench.run(4000);
    assert!(index(&bench, 1).abs_diff(750) <= 25, "{}", index(&bench, 1));
    assert!(bench.is_disabled(Role::ComboBox, "Leading hand"));
    assert_eq!(bench.writes().len(), 1, "what the test wrote itself");
}

#[test]
fn with_one_hand_there_is_none_that_could_lead() {
    let mut bench = Bench::live();
    bench.show(View::Inputs);
    bench.run(100);
    assert!(!bench.shows("Leading hand") && bench.buttons_with(GRANT).is_empty());
    let own = slot(&bench, 0);
    let itself = InputAction::Mirror(Some((own, MirrorScale::WHOLE)));
    bench.act(Action::Input(itself));
    bench.act(Action::Input(InputAction::Grant(SourceKind::Mirror)));
    bench.run(300);
    let hand = hand(&bench, 0);
    assert!(hand.inputs.mirror.is_none() && hand.connection.outside_owner().is_none());
}

#[test]
fn a_lost_leader_holds_the_hand_that_it_led() {
    let mut bench = two();
    arm(&mut bench, 1);
    lead(&mut bench, 0, 1);
    send(&mut bench, 1, 0);
    bench.run(400);
    bench.unplug_at(SECOND);
    bench.run(300);
    let run = hand(&bench, 0).running.following().unwrap();
    assert_eq!(run.view.unwrap().phase, FollowPhase::Silent);
    let held = bench.angle(Dof::Index);
    assert!((100..900).contains(&held), "on its way: {held}");
    bench.run(2000);
    assert!((bench.angle(Dof::Index) - held).abs() <= 25);
    let hand = hand(&bench, 0);
    assert_eq!(
        (
            hand.connection.status.armed,
            hand.connection.outside_owner()
        ),
        (None, None)
    );
    assert_eq!(hand.connection.status.disarmed, Some(Disarmed::Silent));
    show(&mut bench, 0);
    assert!(bench.is_disabled(Role::Button, GRANT));
}

#[test]
fn a_gesture_does_not_take_a_hand_from_the_one_that_leads_it() {
    let mut bench = two();
    lead(&mut bench, 0, 1);
    let before = bench.writes().len();
    bench.act(Action::Gesture(Gesture::MIN));
    bench.run(300);
    let led = hand(&bench, 0).connection.outside_owner();
    assert_eq!((led, bench.writes().len()), (Some(Owner::Mirror), before));
}

#[test]
fn a_lost_follower_stops_a_leader_that_is_moved_here() {
    let mut bench = two();
    arm(&mut bench, 0);
    lead(&mut bench, 1, 0);
    send(&mut bench, 0, 0);
    bench.run(400);
    bench.unplug_at(SECOND);
    let lost = bench.now();
    bench.until(1500, |bench| !hand(bench, 0).connection.is_armed());
    // The window knows of its stop before the wire carries it.
    bench.run(60);
    let writes = bench.writes();
    let held = writes.iter().rev().find(|write| write.address == ANGLE_SET);
    assert!(held.unwrap().at > lost);
    let at = bench.angle(Dof::Index);
    bench.run(2000);
    assert!((bench.angle(Dof::Index) - at).abs() <= 60, "it went on");
    let mut told = bench.state().notices.iter();
    assert!(told.any(|told| told.what == NoticeKind::LeaderStopped));
    assert!(bench.angle(Dof::Index) > 100);
    assert_eq!(hand(&bench, 0).connection.status.holder, None);
}

#[test]
fn a_leader_that_nobody_here_moves_is_never_written_to() {
    let mut bench = two();
    lead(&mut bench, 1, 0);
    send_there(&bench, 300);
    bench.run(400);
    bench.click_button("STOP hand 2");
    bench.run(500);
    assert!(!hand(&bench, 1).connection.is_armed());
    lead(&mut bench, 1, 0);
    bench.unplug_at(SECOND);
    bench.until(1500, |bench| !hand(bench, 1).connection.is_armed());
    bench.run(500);
    assert_eq!(bench.writes().len(), 1, "what the test wrote itself");
    let mut told = bench.state().notices.iter();
    assert!(told.all(|told| told.what != NoticeKind::LeaderStopped));
    assert_eq!(
        hand(&bench, 0).connection.status.state,
        LinkState::Monitoring
    );
}

#[test]
fn a_stop_of_either_stops_both() {
    for stops in ["STOP hand 1", "STOP hand 2", "STOP"] {
        let mut bench = two();
        arm(&mut bench, 0);
        lead(&mut bench, 1, 0);
        send(&mut bench, 0, 0);
        bench.run(300);
        bench.click_button(stops);
        bench.run(100);
        let armed = [0, 1].map(|at| hand(&bench, at).connection.is_armed());
        assert_eq!(armed, [false; 2], "{stops}");
        both_rest(&mut bench);
        assert!(index(&bench, 0) > 100, "{stops}: on its way");
    }
}

#[test]
fn a_fault_of_the_one_that_follows_stops_the_one_that_leads() {
    let mut bench = two();
    arm(&mut bench, 1);
    lead(&mut bench, 0, 1);
    send(&mut bench, 1, 0);
    bench.run(300);
    bench.hand(|hand, _| hand.inject_fault(Dof::Index, Fault::OverTemperature));
    bench.run(300);
    assert!(!hand(&bench, 0).connection.is_armed() && !hand(&bench, 1).connection.is_armed());
    assert_eq!(hand(&bench, 1).connection.status.holder, None);
}

#[test]
fn hands_lead_one_another_in_no_circle() {
    let mut bench = two();
    lead(&mut bench, 1, 0);
    watch(&mut bench, 0, 1);
    assert!(bench.is_disabled(Role::Button, GRANT));
    bench.act(Action::Input(InputAction::Grant(SourceKind::Mirror)));
    bench.run(300);
    assert_eq!(hand(&bench, 0).connection.outside_owner(), None);
    // Over a third one.
    bench.open_another(THIRD);
    lead(&mut bench, 2, 1);
    watch(&mut bench, 0, 2);
    assert!(bench.is_disabled(Role::Button, GRANT));
    let button = bench.rect(Role::Button, GRANT);
    bench.point(button.center());
    bench.run(1000);
    assert!(!bench.texts_with(CIRCLE).is_empty(), "it says why");
    bench.point_away();
    bench.act(Action::Input(InputAction::Grant(SourceKind::Mirror)));
    bench.run(300);
    assert_eq!(
        (
            hand(&bench, 0).connection.outside_owner(),
            bench.writes().len()
        ),
        (None, 0)
    );
    // Once the one in between is let go, it may.
    show(&mut bench, 1);
    bench.click_button("Take back");
    bench.run(500);
    lead(&mut bench, 0, 2);
}

#[test]
fn a_leader_that_is_left_leads_no_more() {
    for removes in [true, false] {
        let mut bench = two();
        lead(&mut bench, 0, 1);
        let gone = slot(&bench, 1);
        match removes {
            true => bench.act(Action::Hands(HandsAction::Remove(gone))),
            false => {
                show(&mut bench, 1);
                bench.act(Action::Disconnect);
            }
        }
        bench.run(1500);
        let led = hand(&bench, 0);
        assert!(led.inputs.mirror.is_none(), "{removes}");
        assert_eq!(
            (led.connection.status.armed, led.connection.outside_owner()),
            (None, None)
        );
    }
}

#[test]
fn the_switch_of_the_card_watches_the_other_hand_and_ends_it() {
    let mut bench = two();
    show(&mut bench, 1);
    assert!(!bench.is_on("Watch the leading hand"));
    bench.click_button("Watch the leading hand");
    bench.run(300);
    let leader = hand(&bench, 1)
        .inputs
        .mirror
        .as_ref()
        .map(|mirror| mirror.leader);
    assert_eq!(leader, Some(slot(&bench, 0)));
    bench.click_button("Watch the leading hand");
    bench.run(100);
    assert!(hand(&bench, 1).inputs.mirror.is_none());
    assert!(bench.writes().is_empty());
}
