//! What a gamepad asks of a hand, control by control, and when it asks nothing.

use crate::pad::setup::{BLUETOOTH, PAD, Played, STEAM, SWITCH, XBOX, angles, event, facts};
use handscope::hand::gap::Gap;
use handscope::hand::{Angle, Moment, PerDof};
use handscope::inputs::pad::input::{HEARD_TIMEOUT, PadAim};
use handscope::inputs::pad::{
    FaceOrder, PadAction, PadControl, PadEvent, PadId, PadInput, PadMap, PadNews,
};
use handscope::poses::library::LibraryPose;
use std::collections::BTreeMap;
use std::time::Duration;

/// No joint is told anything.
const ALONE: [i16; 6] = [-1; 6];

#[test]
fn a_trigger_closes_by_amount_from_open_to_bent() {
    let mut pad = Played::xbox();
    pad.hold();
    let mut before = 1001;
    for raw in 0..=255 {
        pad.says("ABS_RZ", raw);
        let [little, ring, middle, index, bend, rotate] = pad.aims();
        assert_eq!([little, ring, middle], [index; 3], "{raw}");
        assert_eq!([bend, rotate], [1000, -1], "the thumb does not follow it");
        assert!(index <= before && (0..=1000).contains(&index), "{raw}");
        before = index;
    }
    for (raw, index) in [(0, 1000), (8, 1000), (128, 500), (247, 0), (255, 0)] {
        pad.says("ABS_RZ", raw);
        let near = (pad.aims()[3] - index).abs();
        assert!(near <= 4, "{raw}: {:?}", pad.aims());
    }
    pad.says("ABS_Z", 255);
    assert_eq!(pad.aims(), [0, 0, 0, 0, 0, -1]);
    pad.says("ABS_RZ", 0);
    assert_eq!(pad.aims(), [1000, 1000, 1000, 1000, 0, -1], "absolute");
}

#[test]
fn the_left_stick_chooses_the_fingers_that_close_and_leaves_the_others_alone() {
    let mut pad = Played::xbox();
    pad.hold();
    pad.says("ABS_RZ", 255);
    pad.says("ABS_Z", 255);
    for (axis, value, aims) in [
        ("ABS_X", -32768, [-1, -1, -1, 0, 0, -1]),
        ("ABS_Y", -32768, [-1, -1, 0, -1, 0, -1]),
        ("ABS_X", 32767, [-1, 0, -1, -1, 0, -1]),
        ("ABS_Y", 32767, [0, -1, -1, -1, 0, -1]),
        // A little way is none.
        ("ABS_X", 14000, [0, 0, 0, 0, 0, -1]),
    ] {
        pad.says(axis, value);
        assert_eq!(pad.aims(), aims, "{axis} {value}");
        pad.says(axis, 0);
        assert_eq!(pad.aims(), [0, 0, 0, 0, 0, -1], "back from {axis} {value}");
    }
}

#[test]
fn a_stick_between_two_fingers_keeps_to_the_one_it_chose() {
    let mut pad = Played::xbox();
    pad.hold();
    pad.says("ABS_X", -30000);
    let chosen = pad.input.fingers();
    pad.says("ABS_Y", -32768);
    assert_eq!(pad.input.fingers(), chosen, "the other way is farther now");
    pad.says("ABS_X", -12000);
    assert_ne!(pad.input.fingers(), chosen);
}

#[test]
fn the_right_stick_rotates_the_thumb_from_where_it_is_while_it_is_pushed() {
    let mut pad = Played::xbox();
    pad.hold();
    pad.says("ABS_RX", 32767);
    assert_eq!(pad.aims()[5], -1, "nobody knows where the thumb is");
    pad.input.set_actual(angles([500, 500, 500, 500, 500, 400]));
    assert_eq!(pad.aims()[5], 400, "no jump");
    for _ in 0..10 {
        pad.pass(50);
        pad.aims();
    }
    assert_eq!(pad.aims()[5], 650, "half a second at 500 a second");
    pad.says("ABS_RX", 0);
    assert_eq!(pad.aims()[5], -1, "left alone where it is");
    pad.says("ABS_RX", -32768);
    assert_eq!(pad.aims()[5], 400);
    for _ in 0..100 {
        pad.pass(50);
        pad.aims();
    }
    assert_eq!(pad.aims()[5], 0, "and no farther than bent");
}

#[test]
fn a_gap_between_two_offers_pushes_the_thumb_no_farther_than_a_short_one() {
    let mut pad = Played::xbox();
    pad.hold();
    pad.input.set_actual(angles([500; 6]));
    pad.says("ABS_RX", 32767);
    pad.aims();
    pad.pass(60_000);
    assert_eq!(pad.aims()[5], 550);
}

#[test]
fn a_stick_at_rest_asks_nothing_however_worn_it_is() {
    for (raw, moves) in [(0, false), (3900, false), (-3900, false), (4500, true)] {
        let mut pad = Played::xbox();
        pad.hold();
        pad.input.set_actual(angles([500; 6]));
        pad.says("ABS_RX", raw);
        pad.aims();
        pad.pass(50);
        assert_eq!(pad.aims()[5] != -1, moves, "{raw}");
    }
    // A device may ask for a wider rest.
    let wide = [
        ("ABS_RX", -32768, 32767, 9000),
        ("ABS_RY", -32768, 32767, 9000),
    ];
    let mut pad = Played::of(facts(&wide), &[]);
    pad.hold();
    pad.input.set_actual(angles([500; 6]));
    pad.says("ABS_RX", 8900);
    assert_eq!(pad.aims()[5], -1);
}

#[test]
fn a_pose_is_aimed_at_while_its_button_is_held_and_the_triggers_go_on_after() {
    let mut pad = Played::xbox();
    pad.hold();
    pad.says("ABS_RZ", 255);
    pad.says("BTN_SOUTH", 1);
    assert_eq!(pad.aims(), [1000, 1000, 1000, 420, 380, 150]);
    pad.says("BTN_WEST", 1);
    assert_eq!(pad.aims(), [0, 0, 0, 1000, -1, -1], "the last one counts");
    pad.says("BTN_WEST", 0);
    assert_eq!(pad.aims(), [1000, 1000, 1000, 420, 380, 150]);
    pad.says("BTN_SOUTH", 0);
    assert_eq!(pad.aims(), [0, 0, 0, 0, 1000, -1]);
    pad.input.set_poses(Default::default());
    pad.says("BTN_SOUTH", 1);
    assert_eq!(
        pad.aims(),
        [0, 0, 0, 0, 1000, -1],
        "a pose that is not there"
    );
}

#[test]
fn a_pose_that_is_changed_while_its_button_is_held_must_be_held_anew() {
    let library = |open: [i64; 6]| {
        let poses = [("Pinch", [400; 6]), ("Open", open)];
        let named = poses.map(|(name, raw)| (name.to_owned(), PadAim::joints(angles(raw))));
        BTreeMap::from(named)
    };
    let mut pad = Played::xbox();
    pad.hold();
    pad.input.set_poses(library([1000; 6]));
    pad.says("BTN_SOUTH", 1);
    assert_eq!(pad.aims(), [400; 6]);
    pad.input.set_poses(library([900; 6]));
    assert_eq!(pad.aims(), [400; 6], "another one was changed");
    pad.input.set_poses(BTreeMap::new());
    assert_eq!((pad.aims(), pad.offer().held), (ALONE, Some(false)));
    pad.input.set_poses(library([900; 6]));
    assert_eq!(pad.offer().held, Some(false));
    pad.says("BTN_TL", 0);
    pad.hold();
    assert_eq!(pad.aims(), [400; 6]);
}

#[test]
fn a_trigger_that_closes_to_a_gap_goes_from_the_widest_to_the_narrowest_and_nothing_else_counts() {
    let mut pad = Played::xbox();
    let map = PadMap::usual();
    let map = map
        .with(PadControl::RightTrigger, PadAction::CloseGap)
        .unwrap();
    pad.input.set_map(map);
    let gap = |pad: &mut Played| pad.offer().gap.map(Gap::mm);
    pad.says("ABS_RZ", 0);
    assert_eq!(gap(&mut pad), None, "without the dead-man nothing");
    pad.hold();
    assert_eq!(gap(&mut pad), Some(120.0));
    pad.says("ABS_Z", 255);
    pad.says("ABS_RX", 32767);
    let aims = pad.aims();
    let angles = Gap::MAX.angles().map(Angle::get);
    assert_eq!(aims, *angles.as_array(), "no thumb and no stick");
    let mut last = 120.0;
    for raw in [60, 130, 255] {
        pad.says("ABS_RZ", raw);
        let now = gap(&mut pad).unwrap();
        assert!(now < last, "{raw}: {now}");
        last = now;
    }
    assert_eq!(last, 3.0);
    pad.says("BTN_WEST", 1);
    assert_eq!(gap(&mut pad), None, "a pose counts");
    assert_eq!(pad.aims()[3], 1000);
    pad.says("BTN_WEST", 0);
    assert_eq!(gap(&mut pad), Some(3.0));
}

#[test]
fn a_pose_by_size_is_aimed_at_by_its_gap() {
    let mut pad = Played::xbox();
    let mut pose = LibraryPose::at(PerDof::splat(Angle::MAX));
    pose.set_gap(Some(Gap::nearest(25.0)));
    let poses = [("Pinch".to_owned(), PadAim::of(&pose))];
    pad.input.set_poses(BTreeMap::from(poses));
    pad.says("BTN_TL", 0);
    pad.hold();
    pad.says("BTN_SOUTH", 1);
    assert_eq!(pad.offer().gap, Some(Gap::nearest(25.0)));
}

#[test]
fn without_the_dead_man_nothing_is_asked_for() {
    let mut pad = Played::xbox();
    pad.input.set_actual(angles([500; 6]));
    for (name, value) in [
        ("ABS_RZ", 255),
        ("ABS_Z", 200),
        ("ABS_RX", 32767),
        ("BTN_SOUTH", 1),
    ] {
        pad.says(name, value);
        let offer = pad.offer();
        assert_eq!((pad.aims(), offer.held), (ALONE, Some(false)), "{name}");
    }
    pad.hold();
    assert_ne!(pad.aims(), ALONE);
    pad.says("BTN_TL", 0);
    assert_eq!(pad.aims(), ALONE);
    assert_eq!(pad.offer().held, Some(false));
}

#[test]
fn a_dead_man_that_was_down_when_the_pad_was_found_must_be_pressed_anew() {
    let mut pad = Played::of(facts(XBOX), &[event("BTN_TL", 1)]);
    assert_eq!(pad.offer().held, Some(false));
    pad.says("ABS_RZ", 255);
    assert_eq!(pad.offer().held, Some(false));
    pad.says("BTN_TL", 0);
    pad.hold();
}

#[test]
fn lost_events_release_everything_and_what_is_down_then_must_be_pressed_anew() {
    let mut pad = Played::xbox();
    pad.hold();
    pad.says("ABS_RZ", 255);
    // The dead-man is still down, the trigger was let go meanwhile.
    let lost = PadNews::Lost {
        pad: PAD,
        now: vec![event("BTN_TL", 1), event("ABS_RZ", 0)],
    };
    assert_eq!(pad.news(lost), Some(PadEvent::Lost));
    assert_eq!((pad.aims(), pad.offer().held), (ALONE, Some(false)));
    pad.says("BTN_TL", 0);
    pad.hold();
    assert_eq!(pad.aims(), [1000, 1000, 1000, 1000, 1000, -1]);
    // What is not read back was not kept.
    pad.says("ABS_RZ", 255);
    pad.news(PadNews::Lost {
        pad: PAD,
        now: Vec::new(),
    });
    pad.hold();
    assert_eq!(pad.aims(), [1000, 1000, 1000, 1000, 1000, -1]);
}

#[test]
fn a_stop_that_is_down_after_lost_events_stops() {
    let mut pad = Played::xbox();
    let lost = PadNews::Lost {
        pad: PAD,
        now: vec![event("BTN_EAST", 1)],
    };
    assert_eq!(pad.news(lost), Some(PadEvent::Stop));
}

#[test]
fn a_pad_that_is_gone_holds_nothing_and_must_begin_anew() {
    let mut pad = Played::xbox();
    pad.hold();
    pad.says("ABS_RZ", 255);
    assert_eq!(pad.news(PadNews::Gone(PAD)), Some(PadEvent::Gone));
    assert_eq!((pad.aims(), pad.offer().held), (ALONE, Some(false)));
    // Late words of the old one are nobody's.
    assert_eq!(pad.says("BTN_TL", 1), None);
    assert_eq!(pad.offer().held, Some(false));
    let news = PadNews::Found {
        pad: PadId(4),
        facts: facts(XBOX),
        now: Vec::new(),
    };
    assert_eq!(pad.news(news), Some(PadEvent::Found));
    assert_eq!((pad.aims(), pad.offer().held), (ALONE, Some(false)));
}

#[test]
fn a_dead_man_expires_when_nothing_is_heard_of_the_pad() {
    let mut pad = Played::xbox();
    pad.hold();
    let heard = pad.now;
    for (ms, held) in [(0, true), (199, true), (201, false), (9000, false)] {
        pad.now = heard.plus(Duration::from_millis(ms));
        let offer = pad.offer();
        assert_eq!((offer.held, offer.at), (Some(held), heard), "{ms} ms");
    }
    assert_eq!(HEARD_TIMEOUT, Duration::from_millis(200));
    for _ in 0..100 {
        pad.pass(150);
        assert_eq!(pad.offer().held, Some(true), "held all the time");
    }
}

#[test]
fn stop_needs_no_dead_man_and_lets_go_of_it() {
    let mut pad = Played::xbox();
    assert_eq!(pad.says("BTN_EAST", 1), Some(PadEvent::Stop));
    assert_eq!(pad.says("BTN_EAST", 0), None);
    pad.hold();
    assert_eq!(pad.says("BTN_EAST", 1), Some(PadEvent::Stop));
    assert_eq!((pad.aims(), pad.offer().held), (ALONE, Some(false)));
    pad.says("BTN_EAST", 0);
    assert_eq!(pad.offer().held, Some(false), "still down from before");
    pad.says("BTN_TL", 0);
    pad.hold();
}

#[test]
fn a_new_map_needs_the_dead_man_anew() {
    let mut pad = Played::xbox();
    pad.hold();
    let map = PadMap::usual();
    let map = map
        .with(PadControl::RightBumper, PadAction::DeadMan)
        .unwrap();
    pad.says("BTN_TR", 1);
    pad.input.set_map(map);
    assert_eq!(pad.offer().held, Some(false));
    pad.says("BTN_TL", 0);
    pad.says("BTN_TL", 1);
    assert_eq!(pad.offer().held, Some(false), "it is another one now");
    pad.says("BTN_TR", 0);
    pad.says("BTN_TR", 1);
    assert_eq!(pad.offer().held, Some(true));
}

#[test]
fn before_the_first_pad_there_is_no_offer_and_a_second_pad_is_passed_over() {
    assert_eq!(PadInput::new(PadMap::usual()).offer(Moment::ZERO), None);
    let mut pad = Played::xbox();
    let second = PadId(9);
    let news = PadNews::Found {
        pad: second,
        facts: facts(XBOX),
        now: Vec::new(),
    };
    assert_eq!(pad.news(news), None);
    pad.news(PadNews::Moved {
        pad: second,
        event: event("BTN_TL", 1),
    });
    assert_eq!(pad.offer().held, Some(false));
    assert_eq!(pad.input.pad(), Some(PAD));
}

#[test]
fn pads_with_other_axes_do_the_same() {
    for (axes, trigger, full, stick, right) in [
        (XBOX, "ABS_RZ", 255, "ABS_RX", 32767),
        (BLUETOOTH, "ABS_GAS", 1023, "ABS_Z", 65535),
        (SWITCH, "BTN_TR2", 1, "ABS_RX", 32767),
        (STEAM, "ABS_HAT2X", 255, "ABS_RX", 32767),
    ] {
        let mut pad = Played::of(facts(axes), &[]);
        pad.hold();
        pad.says(trigger, full);
        assert_eq!(pad.aims(), [0, 0, 0, 0, 1000, -1], "{trigger}");
        pad.says(stick, right);
        let place = pad.input.state().stick(PadControl::RightStick);
        assert_eq!((place.right, place.up), (1000, 0), "{stick}");
    }
    // A PlayStation pad says its triggers twice; the amount counts.
    let mut pad = Played::xbox();
    pad.hold();
    pad.says("BTN_TR2", 1);
    assert_eq!(pad.aims(), [1000, 1000, 1000, 1000, 1000, -1]);
}

#[test]
fn the_upper_and_the_left_button_are_told_apart_whatever_their_driver_calls_them() {
    for (face, north, west) in [
        (FaceOrder::ByPlace, PadControl::North, PadControl::West),
        (FaceOrder::ByLetter, PadControl::West, PadControl::North),
    ] {
        let facts = handscope::inputs::pad::PadFacts {
            face,
            ..facts(XBOX)
        };
        let mut pad = Played::of(facts, &[]);
        for (name, control) in [("BTN_NORTH", north), ("BTN_WEST", west)] {
            pad.says(name, 1);
            assert!(pad.input.state().is_held(control), "{face:?} {name}");
            pad.says(name, 0);
            assert!(pad.input.state().held().is_empty());
        }
    }
}

#[test]
fn the_cross_is_four_buttons_as_a_hat_and_as_keys() {
    let mut pad = Played::xbox();
    for (name, value, held) in [
        ("ABS_HAT0X", -1, &[PadControl::DpadLeft][..]),
        ("ABS_HAT0X", 1, &[PadControl::DpadRight]),
        (
            "ABS_HAT0Y",
            -1,
            &[PadControl::DpadUp, PadControl::DpadRight],
        ),
        ("ABS_HAT0X", 0, &[PadControl::DpadUp]),
        ("ABS_HAT0Y", 1, &[PadControl::DpadDown]),
        ("ABS_HAT0Y", 0, &[]),
        ("BTN_DPAD_LEFT", 1, &[PadControl::DpadLeft]),
    ] {
        pad.says(name, value);
        let now: Vec<_> = pad.input.state().held().iter().copied().collect();
        assert_eq!(now, held, "{name} {value}");
    }
}

#[test]
fn an_axis_whose_ends_make_no_sense_never_moves() {
    for (min, max) in [(0, 0), (10, -10), (i32::MAX, i32::MIN)] {
        let axes = [
            ("ABS_Z", min, max, 0),
            ("ABS_RZ", min, max, 0),
            ("ABS_RX", min, max, -5),
            ("ABS_RY", min, max, i32::MAX),
        ];
        let mut pad = Played::of(facts(&axes), &[]);
        pad.hold();
        for raw in [i32::MIN, -1, 0, 1, i32::MAX] {
            for (name, ..) in axes {
                pad.says(name, raw);
            }
            assert_eq!(pad.aims(), [1000, 1000, 1000, 1000, 1000, -1]);
        }
    }
    let axes = [("ABS_RX", i32::MIN, i32::MAX, 0), ("ABS_RY", 0, 255, 0)];
    let mut pad = Played::of(facts(&axes), &[]);
    for (raw, right) in [(i32::MIN, -1000), (0, 0), (i32::MAX, 1000)] {
        pad.says("ABS_RX", raw);
        let place = pad.input.state().stick(PadControl::RightStick);
        assert_eq!(place.right, right);
    }
}

#[test]
fn stop_counts_wherever_it_is_seen_down_and_at_whichever_pad() {
    let (down, up) = (event("BTN_EAST", 1), event("BTN_EAST", 0));
    let second = PadId(9);
    let found = |now: &[_]| PadNews::Found {
        pad: second,
        facts: facts(XBOX),
        now: now.to_vec(),
    };
    let moved = |event| PadNews::Moved { pad: second, event };
    let stop = Some(PadEvent::Stop);
    let mut pad = Played::xbox();
    pad.hold();
    // Another pad, which is not followed.
    assert_eq!(pad.news(found(&[])), None);
    assert_eq!(pad.news(moved(event("BTN_SOUTH", 1))), None);
    assert_eq!(pad.news(moved(down)), stop);
    assert_eq!(pad.offer().held, Some(false), "the dead-man is let go");
    assert_eq!(pad.news(moved(down)), None, "it is held, and said again");
    assert_eq!(pad.news(moved(up)), None);
    assert_eq!(pad.news(moved(down)), stop, "again");
    // Found with it.
    assert_eq!(pad.news(PadNews::Gone(second)), None);
    assert_eq!(pad.news(found(&[down])), stop);
    // While events are dropped, of which nothing else counts.
    let doubtful = |event| PadNews::Doubtful { pad: PAD, event };
    assert_eq!(pad.news(doubtful(event("BTN_TL", 0))), None);
    assert_eq!(pad.news(doubtful(down)), stop);
    assert_eq!(pad.says("BTN_EAST", 1), stop, "it was in doubt");
    // A value that no button has.
    assert_eq!(pad.says("BTN_EAST", 0), None);
    assert_eq!(pad.says("BTN_EAST", 2), stop);
}
