//! What the controls may do, and that the dead-man and STOP are never lost.

use handscope::inputs::pad::{ControlKind, PadAction, PadControl, PadMap, PadMapError};
use std::collections::BTreeMap;

fn count(map: &PadMap, action: &PadAction) -> usize {
    map.doing(action).count()
}

#[test]
fn the_usual_map_is_one_and_every_action_fits_its_control() {
    let map = PadMap::usual();
    let all = PadControl::ALL.map(|control| (control, map.action(control).clone()));
    assert_eq!(PadMap::of(BTreeMap::from(all)), Some(map));
}

#[test]
fn the_dead_man_and_stop_change_places_and_are_never_lost() {
    let mut map = PadMap::usual();
    let mut random = fastrand::Rng::with_seed(7);
    let buttons = PadControl::ALL.map(|control| (control, control.kind()));
    for _ in 0..2000 {
        let (control, kind) = buttons[random.usize(..buttons.len())];
        let choices = PadAction::choices(kind);
        let action = match random.bool() {
            true => PadAction::Pose("Open".into()),
            false => choices[random.usize(..choices.len())].clone(),
        };
        match map.with(control, action.clone()) {
            Ok(next) => {
                assert_eq!(*next.action(control), action);
                map = next;
            }
            Err(PadMapError::WrongKind) => assert_ne!(kind, ControlKind::Button),
            Err(PadMapError::OneMust) => assert!(map.action(control).is_single()),
        }
        assert_eq!(count(&map, &PadAction::DeadMan), 1);
        assert_eq!(count(&map, &PadAction::Stop), 1);
    }
    let map = PadMap::usual();
    let moved = map.with(PadControl::South, PadAction::Stop).unwrap();
    assert_eq!(
        *moved.action(PadControl::East),
        PadAction::Pose("Pinch".into()),
        "it does what the other did"
    );
}

#[test]
fn a_control_does_only_what_its_kind_can() {
    let map = PadMap::usual();
    for (control, action) in [
        (PadControl::LeftTrigger, PadAction::DeadMan),
        (PadControl::LeftTrigger, PadAction::Pose("Open".into())),
        (PadControl::LeftStick, PadAction::CloseFingers),
        (PadControl::South, PadAction::CloseFingers),
        (PadControl::South, PadAction::RotateThumb),
        (PadControl::RightTrigger, PadAction::ChooseFingers),
    ] {
        assert_eq!(map.with(control, action), Err(PadMapError::WrongKind));
    }
    let both = PadControl::ALL.map(|control| (control, PadAction::Nothing));
    assert_eq!(PadMap::of(BTreeMap::from(both)), None);
}
