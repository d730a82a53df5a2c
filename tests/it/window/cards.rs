//! What is done to a hand only under a card: its place, its factory's parameters, its force sensors.

use crate::setup::window::{Bench, CLEAR_ERROR, LARGE, Role, SPEED_SET};
use egui::{Key, Vec2, vec2};
use handscope::app::action::Action;
use handscope::app::notices::NoticeKind;
use handscope::app::params::state::ParamAction;
use handscope::app::procedures::{Procedure, ProcedureAction};
use handscope::app::settings::Language;
use handscope::hand::{Dof, Span, register};
use handscope::params::rows::{ParamId, Value};
use handscope::record::LinkState;
use handscope::sim::{Personality, SimConfig, SimHand};
use handscope::tasks::TaskError;
use handscope::ui::View;

const SMALL: Vec2 = vec2(1024.0, 640.0);
const HAND_ID: u16 = 1000;
const RESET_PARA: u16 = 1006;
const FORCE_CLB: u16 = 1009;
const SAVE: u16 = 1005;

/// A hand on a serial line, with settings on disk.
fn on_a_line(personality: Personality) -> Bench {
    let config = SimConfig {
        personality,
        ..SimConfig::default()
    };
    let mut bench = Bench::kept(config, "rs485:/dev/hand?id=1", LARGE);
    bench.wait(1500);
    assert_eq!(
        bench.state().hand().connection.status.state,
        LinkState::Monitoring
    );
    bench
}

fn change_id(bench: &mut Bench, id: i32) {
    bench.act(Action::ChangePlace(ParamId::HandId, Value::Number(id)));
    bench.run(100);
    assert!(bench.shows("Change where the hand is found?"));
    bench.click_button("Change");
}

/// Every file that a backup was made as.
fn backups(bench: &Bench) -> usize {
    let mut count = 0;
    let mut open = vec![bench.folder().to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                open.push(path);
            } else if path
                .parent()
                .is_some_and(|parent| parent.ends_with("backups"))
            {
                count += 1;
            }
        }
    }
    count
}

fn count(bench: &Bench, address: u16) -> usize {
    let all = bench.addresses();
    all.iter().filter(|written| **written == address).count()
}

fn id_of(bench: &Bench) -> u8 {
    bench.hand(|hand, _| hand.id())
}

#[test]
fn a_hand_that_is_kept_at_its_new_id_and_saved_wakes_up_there() {
    let mut bench = on_a_line(Personality::default());
    change_id(&mut bench, 7);
    bench.until(20_000, |bench| bench.shows("Keep the change?"));
    assert!(!bench.shows("Change where the hand is found?"));
    assert_eq!((id_of(&bench), backups(&bench)), (7, 1));
    assert_eq!(
        bench.state().settings.endpoint.as_deref(),
        Some("rs485:/dev/hand?id=1")
    );
    bench.click_button("Keep");
    assert!(bench.shows("Save it in the hand?"));
    bench.click_button("Save");
    bench.until(10_000, |bench| {
        bench.shows("Saved: the hand reports its parameters in flash.")
    });
    assert!(
        bench.shows("Change of where the hand is found"),
        "it is no question any more"
    );
    assert_eq!(count(&bench, SAVE), 1);
    let saved = |bench: &Bench| bench.state().hand().params.known.saved.is_some();
    bench.until(1000, saved);
    assert_eq!(
        bench.state().hand().params.backups.len(),
        1,
        "what was kept before is found where the hand went"
    );
    bench.hand(SimHand::power_cycle);
    assert_eq!(id_of(&bench), 7);
    bench.click_button("Done");
    assert!(bench.state().hand().procedures.card.is_none());
    assert!(!bench.state().hand().connection.is_armed());
    let kept = bench.state().settings.endpoint.clone().unwrap();
    assert!(kept.contains("id=7"), "{kept}");
}

#[test]
fn a_hand_that_nobody_keeps_goes_back_after_fifteen_seconds() {
    let mut bench = on_a_line(Personality::default());
    change_id(&mut bench, 7);
    bench.until(20_000, |bench| bench.shows("Keep the change?"));
    bench.key(Key::Enter);
    bench.key(Key::Escape);
    assert!(bench.shows("Keep the change?"), "neither key decides");
    bench.wait(10_000);
    assert_eq!(id_of(&bench), 7);
    bench.until(30_000, |bench| {
        bench.shows("The hand holds the former value and answers where it was.")
    });
    assert_eq!(
        (id_of(&bench), count(&bench, HAND_ID), count(&bench, SAVE)),
        (1, 2, 0)
    );
}

#[test]
fn an_id_that_another_hand_has_is_refused_and_the_window_stays_with_its_hand() {
    let mut bench = on_a_line(Personality::default());
    bench.add_hand(7);
    change_id(&mut bench, 7);
    bench.until(20_000, |bench| {
        bench.shows("Another hand answers there. Nothing was written.")
    });
    assert_eq!((count(&bench, HAND_ID), bench.writes_to_others()), (0, 0));
    assert_eq!(id_of(&bench), 1);
    bench.until(5_000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
            && place(bench).contains("id=1")
    });
    bench.click_button("Done");
    bench.wait(1000);
    assert!(bench.state().hand().procedures.card.is_none());
    assert!(place(&bench).contains("id=1"), "{}", place(&bench));
    let kept = bench.state().settings.endpoint.clone().unwrap();
    assert!(kept.contains("id=1"), "{kept}");
}

#[test]
fn a_cable_that_is_back_in_time_can_still_be_kept() {
    let mut bench = on_a_line(Personality::default());
    change_id(&mut bench, 7);
    bench.until(20_000, |bench| bench.shows("Keep the change?"));
    bench.unplug();
    bench.wait(1000);
    assert!(bench.is_disabled(Role::Button, "Keep"));
    assert!(!bench.is_disabled(Role::Button, "Go back"));
    bench.plug();
    bench.until(8_000, |bench| !bench.is_disabled(Role::Button, "Keep"));
    bench.click_button("Keep");
    assert!(bench.shows("Save it in the hand?"));
    bench.click_button("Until power off");
    bench.run(100);
    assert!(
        bench.shows(
            "It is not in flash: switched off and on the hand is found at the former place."
        )
    );
    assert_eq!((id_of(&bench), count(&bench, SAVE)), (7, 0));
    let listed = |bench: &Bench| bench.state().hand().params.backups.len() == 1;
    bench.until(2_000, listed);
}

/// A hand that takes another speed as this, on a line that carries only what has its speed.
fn with_speed(effect: &str) -> Bench {
    let mut personality = Personality::default();
    personality.set("baud-effect", effect).unwrap();
    let mut bench = on_a_line(personality);
    bench.act(Action::ChangePlace(ParamId::ReduRatio, Value::Number(2)));
    bench.run(100);
    assert!(bench.shows("Change where the hand is found?"));
    bench.click_button("Change");
    bench.until(30_000, |bench| bench.shows("Keep the change?"));
    bench
}

fn code_of(bench: &Bench) -> u8 {
    bench.hand(|hand, _| hand.baud_code())
}

fn place(bench: &Bench) -> String {
    let place = bench.state().hand().connection.endpoint.as_ref();
    place.map(ToString::to_string).unwrap_or_default()
}

#[test]
fn a_speed_that_acts_at_once_is_followed_kept_saved_and_there_after_power() {
    let mut bench = with_speed("now");
    assert_eq!(code_of(&bench), 2);
    assert!(place(&bench).contains("baud=19200"), "{}", place(&bench));
    bench.click_button("Keep");
    bench.click_button("Save");
    bench.until(10_000, |bench| {
        bench.shows("Saved: the hand reports its parameters in flash.")
    });
    bench.hand(SimHand::power_cycle);
    bench.click_button("Done");
    bench.wait(3000);
    assert_eq!(code_of(&bench), 2);
    assert_eq!(
        bench.state().hand().connection.status.state,
        LinkState::Monitoring
    );
    let kept = bench.state().settings.endpoint.clone().unwrap();
    assert!(kept.contains("baud=19200"), "{kept}");
}

#[test]
fn a_speed_that_acts_at_save_is_found_again_after_it() {
    let mut bench = with_speed("after-save");
    assert_eq!(code_of(&bench), 0);
    bench.click_button("Keep");
    bench.click_button("Save");
    let answers = |bench: &Bench| bench.texts_with("The hand answers here:");
    bench.until(60_000, |bench| !answers(bench).is_empty());
    assert_eq!(code_of(&bench), 2);
    let there = answers(&bench);
    assert!(there[0].contains("baud=19200"), "{there:?}");
    // The result went out at the new speed, which nobody heard.
    assert!(
        !bench
            .texts_with("It is not known whether it is in flash.")
            .is_empty()
    );
    bench.click_button("Done");
    bench.wait(3000);
    assert_eq!(
        bench.state().hand().connection.status.state,
        LinkState::Monitoring
    );
    let kept = bench.state().settings.endpoint.clone().unwrap();
    assert!(kept.contains("baud=19200"), "{kept}");
}

#[test]
fn a_speed_that_nobody_keeps_is_taken_back_over_the_new_speed() {
    let mut bench = with_speed("now");
    bench.until(40_000, |bench| {
        bench.shows("The hand holds the former value and answers where it was.")
    });
    assert_eq!(code_of(&bench), 0);
    bench.click_button("Done");
    bench.wait(3000);
    assert_eq!(
        bench.state().hand().connection.status.state,
        LinkState::Monitoring
    );
    assert!(place(&bench).contains("baud=115200"), "{}", place(&bench));
    let kept = bench.state().settings.endpoint.clone().unwrap();
    assert_eq!(kept, "rs485:/dev/hand?id=1", "nothing else is remembered");
}

#[test]
fn a_hand_that_is_gone_leaves_a_card_with_the_way_back() {
    let mut bench = on_a_line(Personality::default());
    change_id(&mut bench, 7);
    bench.until(20_000, |bench| bench.shows("Keep the change?"));
    bench.unplug();
    bench.wait(1000);
    assert!(
        bench.is_disabled(Role::Button, "Keep"),
        "nobody knows where it is"
    );
    bench.until(60_000, |bench| bench.shows("Connect: former place"));
    assert!(bench.shows("Connect: new place"));
    assert_eq!(count(&bench, HAND_ID), 1);
    bench.hand(SimHand::power_cycle);
    bench.plug();
    bench.click_button("Connect: former place");
    bench.until(5_000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
    });
    assert!(bench.state().hand().procedures.card.is_none());
}

#[test]
fn nothing_begins_while_the_hand_is_armed_or_on_a_key() {
    let mut bench = on_a_line(Personality::default());
    bench.click("Arm the hand");
    bench.run(300);
    assert!(bench.state().hand().connection.is_armed());
    bench.act(Action::ChangePlace(ParamId::HandId, Value::Number(7)));
    bench.run(100);
    assert!(bench.is_disabled(Role::Button, "Change"));
    bench.key(Key::Space);
    bench.until(3_000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
    });
    bench.wait(1500);
    assert!(!bench.is_disabled(Role::Button, "Change"));
    bench.key(Key::Enter);
    bench.run(200);
    assert_eq!((backups(&bench), count(&bench, HAND_ID)), (0, 0));
    assert!(
        bench.state().hand().procedures.card.is_none(),
        "Enter cancels"
    );
}

#[test]
fn a_speed_that_waits_for_power_is_kept_with_both_places_and_the_way_to_the_new_one() {
    let mut bench = with_speed("after-power");
    assert_eq!(code_of(&bench), 0);
    bench.click_button("Keep");
    bench.click_button("Save");
    bench.until(10_000, |bench| bench.shows("Connect: new place"));
    assert!(bench.shows("Connect: former place"));
    bench.hand(SimHand::power_cycle);
    bench.wait(3000);
    assert_ne!(
        bench.state().hand().connection.status.state,
        LinkState::Monitoring
    );
    bench.click_button("Connect: new place");
    bench.until(5_000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
    });
    assert!(place(&bench).contains("baud=19200"), "{}", place(&bench));
    let known = |bench: &Bench| bench.state().hand().params.known.saved.is_some();
    bench.until(2_000, known);
    assert_eq!(
        bench.state().hand().params.backups.len(),
        1,
        "its record is here too"
    );
}

#[test]
fn without_a_backup_nothing_is_written() {
    let mut bench = on_a_line(Personality::default());
    let params = bench.folder().join("kept/params");
    let _former = std::fs::remove_dir_all(&params);
    std::fs::write(&params, "a file where the folder should be").unwrap();
    change_id(&mut bench, 7);
    bench.until(10_000, |bench| {
        bench.shows("No backup could be made, and nothing was written.")
    });
    assert_eq!(count(&bench, HAND_ID), 0);
    let Some(Procedure::Place(card)) = &bench.state().hand().procedures.card else {
        panic!("the card is open");
    };
    let end = card.stage.end();
    assert!(
        matches!(end, Some(Err(TaskError::NoBackup { .. }))),
        "{end:?}"
    );
    bench.key(Key::Escape);
    bench.run(100);
    assert!(bench.state().hand().procedures.card.is_none());
}

#[test]
fn a_factory_reset_wants_its_word_and_a_hand_at_rest_and_tells_where_the_hand_is() {
    let mut bench = on_a_line(Personality::default());
    // What a reset did shows only where something was changed before.
    let gentle = 100_i16.to_le_bytes().repeat(6);
    bench.hand(|hand, now| hand.write(1032, &gentle, now).unwrap());
    bench.show(View::Device);
    bench.run(400);
    bench.click_button("Factory reset");
    bench.run(200);
    assert!(
        bench.shows("Return to the factory's parameters?"),
        "{:?}",
        bench.texts()
    );
    assert!(bench.is_disabled(Role::Button, "Reset"));
    assert_eq!(bench.focused().as_deref(), Some("To go on, type RESET"));
    bench.type_into("To go on, type RESET", "RESET");
    bench.key(Key::Enter);
    bench.run(200);
    assert_eq!(count(&bench, RESET_PARA), 0, "Enter does not do it");
    bench.click_button("Reset");
    bench.until(20_000, |bench| {
        let begin = "The hand holds the factory's parameters and answers here:";
        !bench.texts_with(begin).is_empty()
    });
    assert_eq!((count(&bench, RESET_PARA), backups(&bench)), (1, 1));
    assert!(!bench.state().hand().connection.is_armed());
    bench.click_button("Done");
    assert!(bench.state().hand().procedures.card.is_none());
}

#[test]
fn the_view_of_the_device_opens_the_same_cards() {
    for (button, title) in [
        ("Factory reset", "Return to the factory's parameters?"),
        ("Calibrate force", "Calibrate the force sensors"),
    ] {
        let mut bench = on_a_line(Personality::default());
        bench.show(View::Device);
        bench.run(400);
        bench.click_button(button);
        bench.run(100);
        assert_eq!(bench.all(Role::AlertDialog).len(), 1);
        assert!(bench.shows(title), "{button}");
        bench.click_button("Cancel");
        bench.unplug();
        bench.wait(1000);
        assert!(bench.is_disabled(Role::Button, button));
        assert_eq!(bench.writes(), []);
    }
}

#[test]
fn a_factory_reset_takes_the_record_of_the_hand_along() {
    let mut bench = on_a_line(Personality::default());
    change_id(&mut bench, 7);
    bench.until(20_000, |bench| bench.shows("Keep the change?"));
    bench.click_button("Keep");
    bench.click_button("Until power off");
    bench.click_button("Done");
    bench.act(Action::FactoryReset);
    bench.run(100);
    bench.type_into("To go on, type RESET", "RESET");
    bench.click_button("Reset");
    bench.until(20_000, |bench| {
        let begin = "The hand holds the factory's parameters and answers here:";
        !bench.texts_with(begin).is_empty()
    });
    assert!(place(&bench).contains("id=1"), "{}", place(&bench));
    let listed = |bench: &Bench| bench.state().hand().params.backups.len() == 2;
    bench.until(2_000, listed);
    assert_eq!(bench.state().hand().params.known.saved, None);
}

#[test]
fn a_calibration_measures_first_locks_motion_and_shows_the_offsets() {
    let mut bench = on_a_line(Personality::default());
    bench.show(View::Device);
    bench.run(400);
    bench.click_button("Calibrate force");
    bench.run(100);
    assert!(
        bench.is_disabled(Role::Button, "Calibrate"),
        "the force is not yet known to be steady"
    );
    bench.until(8_000, |bench| !bench.is_disabled(Role::Button, "Calibrate"));
    bench.click_button("Calibrate");
    bench.wait(2_000);
    assert_eq!(count(&bench, FORCE_CLB), 1);
    bench.act(Action::Arm);
    bench.act(Action::ClearErrors);
    bench.run(300);
    assert_eq!(
        (count(&bench, SPEED_SET), count(&bench, CLEAR_ERROR)),
        (0, 0)
    );
    bench.until(12_000, |bench| {
        bench.shows("The hand reports that it is done.")
    });
    assert!(bench.shows("Before, g") && bench.shows("After, g"));
    for dof in Dof::ALL {
        let Some(Procedure::Calibrate(card)) = &bench.state().hand().procedures.card else {
            panic!("the card is open");
        };
        assert!(card.before.is_some());
        let after = card.stage.end().unwrap().after.unwrap();
        assert!(after[dof].abs() <= 10, "{dof:?} {after:?}");
    }
    let angles = register::ANGLE_SET.span();
    let is_angle = |at: &u16| angles.covers(Span::new(*at, 2));
    assert!(!bench.addresses().iter().any(is_angle));
    bench.click_button("Done");
    assert!(bench.state().hand().procedures.card.is_none());
}

#[test]
fn a_stop_passes_while_the_hand_calibrates() {
    let mut bench = on_a_line(Personality::default());
    bench.act(Action::CalibrateForce);
    bench.run(100);
    bench.until(8_000, |bench| !bench.is_disabled(Role::Button, "Calibrate"));
    bench.click_button("Calibrate");
    bench.wait(1_000);
    bench.click_button("STOP");
    bench.run(100);
    assert!(bench.addresses().contains(&register::ANGLE_SET.address));
    bench.until(14_000, |bench| bench.shows("Before, g"));
}

#[test]
fn a_closed_hand_is_not_calibrated() {
    let mut bench = on_a_line(Personality::default());
    bench.click("Arm the hand");
    bench.run(300);
    bench.key_with(egui::Modifiers::SHIFT, Key::C);
    bench.wait(4_000);
    bench.click("Disarm the hand");
    bench.act(Action::CalibrateForce);
    bench.wait(4_000);
    assert!(bench.is_disabled(Role::Button, "Calibrate"));
    assert_eq!(count(&bench, FORCE_CLB), 0);
}

#[test]
fn the_cards_fit_the_smallest_window_in_both_languages() {
    for language in [Language::En, Language::Zh] {
        for action in [
            Action::ChangePlace(ParamId::HandId, Value::Number(7)),
            Action::FactoryReset,
            Action::CalibrateForce,
        ] {
            let mut bench = Bench::kept(SimConfig::default(), "rs485:/dev/hand?id=1", SMALL);
            bench.wait(1500);
            bench.act(Action::Language(language));
            bench.act(action.clone());
            bench.run(200);
            let body = egui::Rect::from_min_size(egui::Pos2::ZERO, SMALL);
            let card = bench.all(Role::AlertDialog);
            assert_eq!(card.len(), 1, "{action:?}");
            for (name, rect) in bench.all(Role::Button) {
                assert!(body.contains_rect(rect), "{name} {rect:?}");
            }
            assert!(bench.texts().iter().all(|text| !text.ends_with('\u{2026}')));
        }
    }
}

/// All joints wake up with this speed and this force threshold.
fn write_defaults(bench: &mut Bench, value: i16) {
    let bytes = value.to_le_bytes().repeat(12);
    bench.hand(|hand, now| hand.write(1032, &bytes, now).unwrap());
}

#[test]
fn the_card_before_a_save_shows_all_that_is_hard_in_the_smallest_window() {
    for (language, keep, save) in [
        (Language::En, "Keep", "Save anyway"),
        (Language::Zh, "保留", "仍然保存"),
    ] {
        let mut bench = Bench::kept(SimConfig::default(), "rs485:/dev/hand?id=1", SMALL);
        bench.wait(1500);
        bench.act(Action::Language(language));
        write_defaults(&mut bench, 100);
        bench.act(Action::Param(ParamAction::Read));
        bench.wait(1000);
        write_defaults(&mut bench, 1000);
        bench.act(Action::ChangePlace(ParamId::HandId, Value::Number(7)));
        bench.act(Action::Procedure(ProcedureAction::Begin));
        bench.until(20_000, |bench| {
            bench.all(Role::Button).iter().any(|(name, _)| name == keep)
        });
        bench.click_button(keep);
        bench.run(100);
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, SMALL);
        assert!(window.contains_rect(bench.rect(Role::Button, save)));
        let peaks = bench.texts_with("+2502");
        assert_eq!(peaks.len(), Dof::ALL.len(), "{peaks:?}");
        let cut = bench.texts_with("\u{2026}");
        assert!(cut.is_empty(), "{cut:?}");
    }
}

#[test]
fn with_gentle_defaults_there_is_nothing_to_warn_of_before_a_save() {
    let mut bench = on_a_line(Personality::default());
    write_defaults(&mut bench, 100);
    change_id(&mut bench, 7);
    bench.until(20_000, |bench| bench.shows("Keep the change?"));
    bench.click_button("Keep");
    assert!(bench.shows("Save it in the hand?"));
    bench.click_button("Save");
    bench.until(10_000, |bench| {
        bench.shows("Saved: the hand reports its parameters in flash.")
    });
}

#[test]
fn a_lost_link_and_the_header_stay_bright_above_a_card() {
    let mut bench = on_a_line(Personality::default());
    bench.act(Action::FactoryReset);
    bench.run(200);
    let card = bench.rect(Role::AlertDialog, "Return to the factory's parameters?");
    assert!(!bench.is_bright("Joints"), "the view below is dimmed");
    bench.unplug();
    bench.until(3_000, |bench| !bench.texts_with("LINK LOST").is_empty());
    bench.run(100);
    let title = bench.texts_with("LINK LOST").remove(0);
    assert!(bench.is_bright(&title), "{title}");
    assert!(bench.is_bright("STOP") && bench.is_bright("Live"));
    let after = bench.rect(Role::AlertDialog, "Return to the factory's parameters?");
    assert_eq!(card, after, "nothing moves under the pointer");
}

#[test]
fn an_id_that_this_program_changed_is_not_staged_any_more_nor_warned_of() {
    let config = SimConfig::default();
    let mut bench = Bench::kept(config, "tcp:127.0.0.1:6000", LARGE);
    bench.wait(1500);
    bench.act(Action::Param(ParamAction::Read));
    bench.wait(1000);
    let id = ParamId::HandId;
    bench.act(Action::Stage(id, Some(Value::Number(3))));
    bench.act(Action::ChangePlace(id, Value::Number(3)));
    bench.run(100);
    bench.click_button("Change");
    bench.until(20_000, |bench| bench.shows("Keep the change?"));
    bench.click_button("Keep");
    bench.click_button("Save");
    bench.until(10_000, |bench| bench.shows("Done"));
    bench.click_button("Done");
    assert_eq!(bench.state().hand().params.staged(id), None);
    bench.hand(SimHand::power_cycle);
    bench.unplug();
    bench.wait(1000);
    bench.plug();
    bench.until(10_000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
    });
    bench.wait(2000);
    assert_eq!(
        bench.state().hand().connection.status.quirks.hand_id,
        Some(3)
    );
    let mut notices = bench.state().notices.iter();
    let warned = notices.any(|notice| matches!(notice.what, NoticeKind::HandDiffers { .. }));
    assert!(!warned, "its own change");
}
