//! Claims about what the hand keeps: read when it is looked at, staged, written, verified, saved, compared; and that looking writes nothing.

use crate::setup::window::{Bench, LARGE, Role, SPEED_SET};
use egui::{Key, vec2};
use handscope::app::action::Action;
use handscope::app::notices::NoticeKind;
use handscope::app::params::state::Doing;
use handscope::app::params::state::ParamAction;
use handscope::app::settings::Language;
use handscope::hand::Dof;
use handscope::params::rows::{ParamId, Value};
use handscope::record::{ArmRefusal, SaveDoubt, Saved};
use handscope::sim::SimConfig;
use handscope::ui::View;
use std::time::Duration;

/// DEFAULT_SPEED_SET and DEFAULT_FORCE_SET (manual 2.6.8, 2.6.9).
const DEFAULTS: [u16; 2] = [1032, 1044];
/// SAVE (manual 2.6.4).
const SAVE: u16 = 1005;
const INDEX: ParamId = ParamId::DefaultSpeed(Dof::Index);

fn quirk(name: &str, value: &str) -> SimConfig {
    let mut config = SimConfig::default();
    config.personality.set(name, value).unwrap();
    config
}

/// Every joint wakes up like this.
fn defaults(bench: &mut Bench, value: i16) {
    let bytes = value.to_le_bytes().repeat(6);
    for address in DEFAULTS {
        bench.hand(|hand, now| hand.write(address, &bytes, now).unwrap());
    }
}

fn open(bench: &mut Bench) {
    bench.show(View::Device);
    bench.until(2000, |bench| {
        let book = &bench.state().hand().params;
        book.read_at.is_some() && !book.is_busy()
    });
    bench.run(40);
}

fn stage(bench: &mut Bench, field: &str, text: &str) {
    bench.type_into(field, text);
    bench.key(Key::Enter);
    bench.run(60);
}

/// Saves what nobody changed here: what the flash holds is not known.
fn save(bench: &mut Bench) {
    bench.click("Save to flash");
    bench.run(60);
    assert!(bench.shows("Nothing to save, as far as this program knows"));
    bench.click("Save anyway");
}

fn settle(bench: &mut Bench) {
    bench.run(60);
    bench.until(9000, |bench| {
        let params = &bench.state().hand().params;
        !params.is_busy() || params.question().is_some()
    });
    bench.run(60);
}

fn staged(bench: &Bench, id: ParamId) -> Option<Value> {
    bench.state().hand().params.staged(id)
}

#[test]
fn looking_at_the_rows_reads_them_and_connecting_does_not() {
    let mut bench = Bench::live();
    bench.wait(3000);
    assert_eq!(bench.state().hand().params.read_at, None);
    open(&mut bench);
    assert_eq!(bench.reading("Index speed live"), "1000");
    assert_eq!(bench.reading("Hand id live"), "1");
    assert_eq!(bench.reading("IP address factory"), "192.168.11.210");
    assert_eq!(bench.reading("Index speed last saved"), "-");
    // Somebody looks at them all the time: who comes back to look has them read again.
    for _ in 0..175 {
        bench.wait(400);
    }
    assert!(!bench.texts_with("min ago").is_empty(), "old values say so");
    bench.click("Read again");
    settle(&mut bench);
    assert_eq!(bench.texts_with("1 min ago").len(), 0);
    assert_eq!(bench.writes(), []);
}

#[test]
fn without_a_hand_every_value_is_a_dash_and_the_reason_is_said() {
    let mut bench = Bench::open(SimConfig::default(), LARGE);
    bench.unplug();
    bench.wait(1000);
    bench.show(View::Device);
    bench.run(100);
    assert_eq!(bench.reading("Index speed live"), "-");
    assert_eq!(bench.texts_with("No hand answers. What was read").len(), 1);
    for button in [
        "Read again",
        "Apply",
        "Undo apply",
        "Save to flash",
        "Export to file",
    ] {
        assert!(bench.is_disabled(Role::Button, button), "{button}");
    }
}

#[test]
fn half_a_number_and_one_out_of_range_stage_nothing_and_staging_writes_nothing() {
    let mut bench = Bench::live();
    open(&mut bench);
    bench.type_into("Index speed staged", "25");
    bench.run(60);
    assert_eq!(staged(&bench, INDEX), None, "not before Enter");
    bench.key(Key::Enter);
    bench.run(60);
    assert_eq!(staged(&bench, INDEX), Some(Value::Number(25)));
    stage(&mut bench, "Index speed staged", "1001");
    assert_eq!(staged(&bench, INDEX), Some(Value::Number(25)));
    // A field that is left is as good as Enter, as it sends nothing.
    for typed in ["30", "31"] {
        bench.type_into("Index speed staged", typed);
        bench.key(Key::Tab);
        bench.run(60);
        let number = typed.parse().unwrap();
        assert_eq!(staged(&bench, INDEX), Some(Value::Number(number)));
    }
    bench.type_into("Index speed staged", "40");
    bench.key(Key::Escape);
    bench.run(60);
    assert_eq!(staged(&bench, INDEX), Some(Value::Number(31)), "given back");
    bench.click("Drop Index speed");
    bench.run(60);
    assert_eq!(staged(&bench, INDEX), None);
    assert_eq!(bench.writes(), []);
}

#[test]
fn a_wrong_address_stays_with_the_reason_beside_it_and_stages_nothing() {
    let mut bench = Bench::live();
    open(&mut bench);
    let reason = "Not an IP address: four numbers 0 to 255, as 192.168.11.210";
    for wrong in ["192.168.11", "192.168.11.999"] {
        stage(&mut bench, "IP address staged", wrong);
        assert_eq!(staged(&bench, ParamId::IpAddress), None);
        assert_eq!(bench.typed("IP address staged"), wrong);
        assert!(bench.shows(reason), "{wrong}");
    }
    stage(&mut bench, "IP address staged", "192.168.11.7");
    assert!(staged(&bench, ParamId::IpAddress).is_some());
    assert!(!bench.shows(reason));
}

#[test]
fn the_serial_speed_is_chosen_in_baud_and_shown_in_baud() {
    let mut bench = Bench::live();
    open(&mut bench);
    assert_eq!(bench.reading("Serial speed live"), "115200");
    bench.choose("Serial speed staged", "19200");
    let code = Value::Number(2);
    assert_eq!(staged(&bench, ParamId::ReduRatio), Some(code));
    bench.choose("Serial speed staged", "115200");
    assert_eq!(
        staged(&bench, ParamId::ReduRatio),
        None,
        "the hand holds it already"
    );
    assert_eq!(bench.writes(), []);
}

#[test]
fn apply_writes_only_staged_rows_and_undo_puts_them_back() {
    let mut bench = Bench::live();
    defaults(&mut bench, 100);
    open(&mut bench);
    let begun = bench.writes().len();
    assert!(bench.is_disabled(Role::Button, "Apply"));
    stage(&mut bench, "Index speed staged", "50");
    stage(&mut bench, "Hand id staged", "7");
    bench.click("Apply");
    settle(&mut bench);
    assert_eq!(bench.reading("Index speed live"), "50");
    assert_eq!(bench.reading("Index speed verdict"), "applied, read back");
    assert_eq!(
        bench.reading("Hand id live"),
        "1",
        "where the hand is stays"
    );
    let applied = bench.addresses().len();
    let elements = DEFAULTS[0]..DEFAULTS[0] + 12;
    assert!(
        bench.addresses()[begun..]
            .iter()
            .all(|at| elements.contains(at))
    );
    assert!(applied > begun);
    bench.click("Undo apply");
    settle(&mut bench);
    assert_eq!(bench.reading("Index speed live"), "100");
    assert!(bench.addresses().len() > applied);
}

#[test]
fn where_the_hand_is_found_changes_only_under_a_card() {
    let mut bench = Bench::kept(SimConfig::default(), "rs485:/dev/hand?id=1", LARGE);
    bench.wait(1500);
    open(&mut bench);
    assert!(bench.is_disabled(Role::Button, "Change... Hand id"));
    stage(&mut bench, "Hand id staged", "7");
    assert!(bench.is_disabled(Role::Button, "Apply"));
    bench.click("Change... Hand id");
    bench.run(100);
    assert_eq!(bench.writes(), [], "the card asks first");
    assert!(
        bench.shows("Change where the hand is found?"),
        "{:?}",
        bench.texts()
    );
}

#[test]
fn a_row_that_the_hand_drops_or_clamps_shows_what_the_hand_holds() {
    for (value, live, words) in [
        (
            "drop",
            "1000",
            "silently refused: the hand keeps its old value (wanted 700)",
        ),
        (
            "exception",
            "1000",
            "silently refused: the hand keeps its old value (wanted 700)",
        ),
        ("clamp", "500", "the hand took another value than 700"),
    ] {
        let mut bench = Bench::open(quirk("defaults", value), LARGE);
        bench.wait(1000);
        open(&mut bench);
        stage(&mut bench, "Index speed staged", "700");
        bench.click("Apply");
        settle(&mut bench);
        assert_eq!(bench.reading("Index speed verdict"), words, "{value}");
        assert_eq!(bench.reading("Index speed live"), live, "{value}");
        assert_eq!(bench.typed("Index speed staged"), live, "{value}");
    }
}

#[test]
fn a_link_lost_while_writing_leaves_the_row_unverified_and_unknown() {
    let mut config = SimConfig::default();
    config.personality.turnaround = Duration::from_millis(45);
    let mut bench = Bench::open(config, LARGE);
    bench.wait(2000);
    open(&mut bench);
    stage(&mut bench, "Index speed staged", "250");
    bench.click("Apply");
    bench.until(2000, |bench| !bench.writes().is_empty());
    bench.unplug();
    settle(&mut bench);
    let verdict = bench.reading("Index speed verdict");
    assert!(verdict.starts_with("unverified"), "{verdict}");
    assert_eq!(bench.reading("Index speed live"), "-");
    assert_eq!(staged(&bench, INDEX), Some(Value::Number(250)));
}

#[test]
fn an_armed_hand_is_not_written_and_the_reason_is_said() {
    let mut bench = Bench::armed();
    open(&mut bench);
    stage(&mut bench, "Index speed staged", "250");
    let before = bench.addresses();
    assert!(bench.is_disabled(Role::Button, "Apply"));
    assert!(bench.is_disabled(Role::Button, "Save to flash"));
    assert!(bench.shows("The hand is armed: disarm it first."));
    bench.run(200);
    let after = bench.addresses();
    assert!(!after.contains(&SAVE) && before.iter().all(|address| after.contains(address)));
    assert!(
        after
            .iter()
            .all(|address| !(DEFAULTS[0]..DEFAULTS[1] + 12).contains(address))
    );
}

/// Stages hard defaults for the index finger and asks for them.
fn ask_for_hard_defaults(bench: &mut Bench) {
    defaults(bench, 100);
    open(bench);
    stage(bench, "Index speed staged", "1000");
    stage(bench, "Index force staged", "1000");
    bench.click("Apply");
    settle(bench);
}

fn default_writes(bench: &Bench) -> usize {
    let all = DEFAULTS[0]..DEFAULTS[1] + 12;
    let written = bench.addresses().into_iter();
    written.filter(|address| all.contains(address)).count()
}

#[test]
fn what_could_hurt_is_asked_about_on_a_card_with_the_measured_figures() {
    let mut bench = Bench::live();
    ask_for_hard_defaults(&mut bench);
    let before = default_writes(&bench);
    assert_eq!(bench.all(Role::AlertDialog).len(), 1);
    assert!(bench.shows("Apply defaults that hit hard?"));
    for figure in ["1000", "+2502", "3502"] {
        assert!(bench.has_reading("Index", figure), "{figure}");
    }
    assert!(
        !bench.has_reading("Ring", "+2502"),
        "only the joints that are meant"
    );
    assert!(
        bench.shows("With speed 25 the same thresholds were passed by at most 69 g"),
        "what to do about it"
    );
    bench.show(handscope::ui::View::Live);
    assert!(
        bench.shows("Apply defaults that hit hard?"),
        "over every view"
    );
    bench.click_button("Apply anyway");
    settle(&mut bench);
    open(&mut bench);
    assert_eq!(bench.reading("Index force live"), "1000");
    assert_eq!(default_writes(&bench), before + 2);
}

#[test]
fn no_key_agrees_to_what_could_hurt_and_what_is_staged_stays() {
    let mut bench = Bench::live();
    ask_for_hard_defaults(&mut bench);
    let before = default_writes(&bench);
    assert!(bench.is_focused("Back"));
    bench.key(Key::Tab);
    bench.key(Key::Enter);
    bench.run(100);
    assert!(bench.shows("Apply defaults that hit hard?"));
    bench.key(Key::Escape);
    settle(&mut bench);
    assert!(!bench.shows("Apply defaults that hit hard?"));
    assert!(
        bench.addresses().contains(&crate::setup::window::ANGLE_SET),
        "the key stops the hand, as everywhere"
    );
    assert_eq!(staged(&bench, INDEX), Some(Value::Number(1000)));
    assert_eq!(default_writes(&bench), before);
}

#[test]
fn a_stop_passes_a_card_and_nothing_is_written_until_it_is_confirmed() {
    let mut bench = Bench::live();
    ask_for_hard_defaults(&mut bench);
    bench.press("STOP");
    bench.run(40);
    assert!(bench.addresses().contains(&crate::setup::window::ANGLE_SET));
    assert!(bench.is_disabled(Role::Button, "Apply anyway"));
    bench.wait(1500);
    assert!(!bench.is_disabled(Role::Button, "Apply anyway"));
    bench.unplug();
    bench.wait(1000);
    assert!(bench.is_disabled(Role::Button, "Apply anyway"));
    bench.click_button("Back");
    bench.run(60);
    assert_eq!(bench.state().hand().params.question(), None);
}

#[test]
fn the_card_of_hard_defaults_fits_the_least_window_in_both_languages() {
    let least = vec2(1024.0, 640.0);
    for language in [Language::En, Language::Zh] {
        let mut bench = Bench::open(SimConfig::default(), least);
        bench.wait(1000);
        defaults(&mut bench, 100);
        for dof in Dof::ALL {
            for id in [ParamId::DefaultSpeed(dof), ParamId::DefaultForce(dof)] {
                let (_, most) = id.range().unwrap();
                bench.act(Action::Stage(id, Some(Value::Number(most))));
            }
        }
        bench.act(Action::Language(language));
        bench.act(Action::Param(ParamAction::Apply));
        settle(&mut bench);
        let dialog = bench.all(Role::AlertDialog);
        assert_eq!(dialog.len(), 1, "{language:?}");
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, least);
        for (name, rect) in bench.all(Role::Button) {
            assert!(window.contains_rect(rect), "{name} {rect:?}");
        }
        let cut = bench.texts_with("\u{2026}");
        assert!(cut.is_empty(), "{cut:?}");
    }
}

#[test]
fn a_save_is_backed_up_confirmed_by_the_hand_and_shown_with_its_date() {
    let mut bench = Bench::keeping(SimConfig::default());
    defaults(&mut bench, 100);
    open(&mut bench);
    save(&mut bench);
    bench.until(2000, |bench| {
        bench.state().hand().params.doing == Doing::Saving
    });
    let folder = bench
        .state()
        .hand()
        .params
        .files
        .as_ref()
        .unwrap()
        .folder()
        .to_owned();
    assert_eq!(
        std::fs::read_dir(folder.join("backups")).unwrap().count(),
        1
    );
    settle(&mut bench);
    assert_eq!(
        bench.addresses().iter().filter(|at| **at == SAVE).count(),
        1
    );
    assert!(bench.shows("Saved: the hand reports its parameters in flash."));
    let errors = bench.texts_with("Errors ");
    assert!(errors.is_empty(), "the wire had none: {errors:?}");
    assert_eq!(bench.reading("Index speed last saved"), "100");
    let saved = bench.state().hand().params.known.saved.clone().unwrap();
    let day = saved.at.get(..10).unwrap().to_owned();
    assert!(!bench.texts_with(&day).is_empty(), "{day}");
    bench.click("Only differences");
    bench.run(60);
    assert!(
        !bench.shows("Hand id live"),
        "all as saved and as delivered"
    );
    assert!(bench.shows("No row differs."));
}

#[test]
fn a_wire_without_a_result_frame_is_told_as_read_back_and_not_as_confirmed() {
    for endpoint in [
        "tcp:127.0.0.1:6000",
        "can:can0?id=1",
        "rtu:/dev/hand?baud=115200&id=1",
    ] {
        let mut bench = Bench::kept(SimConfig::default(), endpoint, LARGE);
        bench.wait(1500);
        defaults(&mut bench, 100);
        open(&mut bench);
        save(&mut bench);
        settle(&mut bench);
        let told = bench.texts_with("acknowledged, and read back the same");
        assert_eq!(told.len(), 1, "{endpoint}");
        assert!(told[0].contains("Only the next power-up shows what is in flash."));
        assert!(!bench.texts_with("(read back the same)").is_empty());
        assert!(bench.texts_with("the hand says").is_empty());
        assert!(bench.texts_with("confirmed by the hand").is_empty());
        assert_eq!(bench.reading("Index speed last saved"), "100");
    }
}

#[test]
fn arming_while_the_hand_saves_is_refused_with_its_own_reason() {
    let mut bench = Bench::keeping(SimConfig::default());
    defaults(&mut bench, 100);
    open(&mut bench);
    save(&mut bench);
    bench.until(2000, |bench| {
        bench.state().hand().params.doing == Doing::Saving
    });
    bench.wait(300);
    assert!(bench.is_disabled(Role::Button, "Arm the hand"));
    bench.act(Action::Arm);
    bench.run(100);
    let all = bench.state().notices.iter();
    let refused = all.filter_map(|notice| match &notice.what {
        NoticeKind::ArmRefused(why) => Some(*why),
        _ => None,
    });
    assert_eq!(refused.collect::<Vec<_>>(), [ArmRefusal::HandBusy]);
    bench.show(handscope::ui::View::Faults);
    let words = "The hand is writing its flash or calibrating: wait until done.";
    assert!(!bench.texts_with(words).is_empty(), "{:?}", bench.texts());
    settle(&mut bench);
    assert!(!bench.state().hand().connection.is_armed());
    assert!(!bench.addresses().contains(&SPEED_SET));
}

#[test]
fn a_save_that_failed_or_gave_no_result_is_told_so_and_is_not_the_last_saved() {
    let no_result = SaveDoubt::NoResult;
    for (value, told, words) in [
        (
            "failed",
            Saved::Failed { code: 255 },
            "Not saved: the hand reports",
        ),
        (
            "never",
            Saved::Unknown { why: no_result },
            "Unknown whether it was saved:",
        ),
    ] {
        let mut bench = Bench::keeping(quirk("save-result", value));
        defaults(&mut bench, 100);
        open(&mut bench);
        save(&mut bench);
        settle(&mut bench);
        let (end, _) = bench.state().hand().params.save.clone().unwrap();
        assert_eq!(end.map(|report| report.saved), Ok(told));
        assert!(!bench.texts_with(words).is_empty(), "{value}");
        assert_eq!(bench.reading("Index speed last saved"), "-", "{value}");
        let doubtful = bench.state().hand().params.known.doubtful.is_some();
        assert_eq!(doubtful, value == "never");
    }
}

#[test]
fn dangerous_defaults_are_asked_about_before_they_are_saved() {
    let mut bench = Bench::keeping(SimConfig::default());
    ask_for_hard_defaults(&mut bench);
    bench.click("Apply anyway");
    settle(&mut bench);
    bench.click("Export to file");
    bench.run(400);
    bench.click("Open file");
    bench.run(400);
    bench.click("Save to flash");
    settle(&mut bench);
    assert!(
        bench.shows("Save defaults that hit hard?"),
        "beside a file too"
    );
    assert!(
        bench.has_reading("Index", "+2502") && !bench.has_reading("Ring", "+2502"),
        "only the joint that was changed"
    );
    assert!(!bench.addresses().contains(&SAVE));
    bench.click("Save anyway");
    settle(&mut bench);
    assert!(bench.addresses().contains(&SAVE));
}

#[test]
fn the_filter_and_the_differences_leave_the_rows_that_are_meant() {
    let mut bench = Bench::live();
    open(&mut bench);
    bench.type_into("Find parameters", "index force");
    bench.run(60);
    assert!(
        bench.has_reading("Index force live", "1000")
            && !bench.has_reading("Index speed live", "1000")
    );
    assert!(!bench.has_reading("Hand id live", "1"));
    bench.type_into("Find parameters", "x");
    bench.key(Key::Backspace);
    bench.run(60);
    stage(&mut bench, "Ring speed staged", "300");
    bench.click("Only differences");
    bench.run(60);
    assert!(
        bench.has_reading("Ring speed live", "1000")
            && !bench.has_reading("Index speed live", "1000")
    );
}

#[test]
fn the_speed_that_the_hand_has_now_is_staged_for_all() {
    let mut bench = Bench::live();
    let bytes = 300_i16.to_le_bytes().repeat(6);
    bench.hand(|hand, now| hand.write(SPEED_SET, &bytes, now).unwrap());
    bench.wait(3000);
    open(&mut bench);
    let before = bench.writes().len();
    bench.click("Copy the hand's speed and force");
    bench.run(60);
    for dof in Dof::ALL {
        let speed = staged(&bench, ParamId::DefaultSpeed(dof));
        assert_eq!(speed, Some(Value::Number(300)), "{dof:?}");
        assert!(staged(&bench, ParamId::DefaultForce(dof)).is_some());
    }
    assert_eq!(bench.writes().len(), before);
}

#[test]
fn a_file_is_compared_row_by_row_and_only_ticked_rows_are_staged() {
    let mut bench = Bench::live();
    open(&mut bench);
    bench.click("Export to file");
    bench.run(400);
    let path = bench.folder().join("handscope-params.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let text = text.replacen("hand_id = 1", "hand_id = 9", 1);
    let (place, speeds) = text.split_once("[default_speed]").unwrap();
    let speeds = speeds.replacen("index = 1000", "index = 300", 1);
    let speeds = speeds.replacen("ring = 1000", "ring = 400", 1);
    std::fs::write(&path, format!("{place}[default_speed]{speeds}")).unwrap();
    bench.click("Open file");
    bench.run(400);
    assert_eq!(bench.reading("Index speed in the file"), "300");
    let compared = bench.state().hand().params.compared.clone().unwrap();
    assert!(compared.is_ticked(INDEX) && !compared.is_ticked(ParamId::HandId));
    bench.click("Take Ring speed");
    bench.run(60);
    bench.click("Stage ticked rows");
    bench.run(60);
    let all: Vec<_> = bench.state().hand().params.all_staged().iter().collect();
    assert_eq!(all, [(INDEX, Value::Number(300))]);
    assert_eq!(bench.writes(), []);
}

#[test]
fn where_no_file_was_chosen_its_path_can_be_typed_and_the_outcome_stands_there() {
    let mut bench = Bench::live();
    open(&mut bench);
    assert!(!bench.shows("Path of the file"));
    bench.click("Open file");
    bench.run(400);
    assert!(bench.shows("Path of the file"), "there was none");
    let path = bench.folder().join("elsewhere.toml");
    bench.type_into("Path of the file", &path.display().to_string());
    bench.key(Key::Enter);
    bench.run(400);
    let told = bench.texts_with("elsewhere.toml");
    assert_eq!(told.len(), 2, "in the view and in the line: {told:?}");
    bench.click("Export to file");
    bench.run(400);
    std::fs::rename(bench.folder().join("handscope-params.toml"), path).unwrap();
    bench.click("Open path");
    bench.run(400);
    let compared = bench.state().hand().params.compared.as_ref().unwrap();
    assert_eq!(compared.name, "elsewhere.toml");
    assert!(!bench.shows("Path of the file"), "it was taken");
    assert_eq!(bench.writes(), []);
}

#[test]
fn a_bad_file_is_refused_whole_with_the_name_of_the_field() {
    let mut bench = Bench::live();
    open(&mut bench);
    bench.click("Export to file");
    bench.run(400);
    let path = bench.folder().join("handscope-params.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let (before, forces) = text.split_once("[default_force]").unwrap();
    let forces = forces.replace("ring = 1000", "ring = 3001");
    std::fs::write(&path, format!("{before}[default_force]{forces}")).unwrap();
    bench.click("Open file");
    bench.run(400);
    assert_eq!(bench.state().hand().params.compared, None);
    let refused = bench
        .state()
        .notices
        .iter()
        .find_map(|notice| match &notice.what {
            NoticeKind::FileRefused { error, .. } => Some(error.to_string()),
            _ => None,
        });
    assert!(refused.unwrap().contains("`default_force.ring`: 3001"));
}

#[test]
fn a_backup_is_a_way_back() {
    let mut bench = Bench::keeping(SimConfig::default());
    defaults(&mut bench, 100);
    open(&mut bench);
    save(&mut bench);
    settle(&mut bench);
    defaults(&mut bench, 50);
    bench.click("Read again");
    settle(&mut bench);
    let before = bench.writes().len();
    let backups = bench.all(Role::Button);
    let name = backups.into_iter().map(|(name, _)| name);
    let name = name
        .into_iter()
        .find(|name| name.ends_with("before save"))
        .unwrap();
    assert!(name.contains(" UTC "), "its time: {name}");
    let hand = bench.reading(&format!("Hand of the backup: {name}"));
    assert_eq!(hand, bench.state().hand().connection.name());
    bench.click_button(&name);
    bench.run(400);
    bench.click("Stage ticked rows");
    bench.run(60);
    assert_eq!(staged(&bench, INDEX), Some(Value::Number(100)));
    assert_eq!(bench.writes().len(), before);
}

#[test]
fn everything_can_be_reached_in_the_least_window_in_both_languages() {
    for (language, button) in [
        (Language::En, "Save to flash"),
        (Language::Zh, "保存到闪存"),
    ] {
        let mut bench = Bench::open(SimConfig::default(), vec2(1024.0, 640.0));
        bench.wait(1000);
        bench.act(Action::Language(language));
        bench.show(View::Device);
        bench.run(600);
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, vec2(1024.0, 640.0));
        assert!(
            window.contains_rect(bench.rect(Role::Button, button)),
            "{button}"
        );
    }
}

#[test]
fn with_nothing_to_save_it_says_so_and_writes_nothing() {
    let mut bench = Bench::keeping(SimConfig::default());
    open(&mut bench);
    assert_eq!(bench.reading("Thumb rotate force live"), "1000", "hard");
    bench.click("Save to flash");
    bench.wait(4000);
    assert!(bench.shows("Nothing to save, as far as this program knows"));
    assert_eq!(bench.addresses(), [0_u16; 0], "one click writes nothing");
    bench.click("Save anyway");
    settle(&mut bench);
    let saves = |bench: &Bench| bench.addresses().iter().filter(|at| **at == SAVE).count();
    assert_eq!(saves(&bench), 1);
    bench.wait(2000);
    assert!(bench.is_disabled(Role::Button, "Save to flash"));
    let told = bench.texts_with("Nothing to save: the hand holds what was saved last.");
    assert_eq!(told.len(), 1);
    stage(&mut bench, "Index speed staged", "50");
    assert!(!bench.is_disabled(Role::Button, "Save to flash"));
}

#[test]
fn a_save_with_staged_rows_shows_them_applies_them_and_saves_them_in_one_step() {
    let mut bench = Bench::keeping(SimConfig::default());
    defaults(&mut bench, 100);
    open(&mut bench);
    stage(&mut bench, "Index speed staged", "50");
    assert!(bench.shows("Rows are staged and not applied. Save to flash applies them first."));
    assert!(bench.shows("Not in flash yet: Index speed"));
    bench.click("Save to flash");
    settle(&mut bench);
    assert!(bench.shows("Save these changes to flash?"));
    for value in ["100", "50"] {
        assert!(bench.has_reading("Index speed", value), "{value}");
    }
    assert!(!bench.addresses().contains(&SAVE), "nothing is written yet");
    bench.click("Apply and save");
    settle(&mut bench);
    assert_eq!(bench.reading("Index speed live"), "50");
    assert_eq!(bench.reading("Index speed last saved"), "50");
    assert!(bench.shows("Saved: the hand reports its parameters in flash."));
    bench.hand(handscope::sim::SimHand::power_cycle);
    bench.wait(3000);
    bench.click("Read again");
    settle(&mut bench);
    assert_eq!(bench.reading("Index speed live"), "50");
}

#[test]
fn a_save_of_staged_rows_that_the_hand_drops_is_not_done_and_says_so() {
    let mut bench = Bench::keeping(quirk("defaults", "drop"));
    open(&mut bench);
    stage(&mut bench, "Index speed staged", "50");
    bench.click("Save to flash");
    settle(&mut bench);
    bench.click("Apply and save");
    settle(&mut bench);
    assert_eq!(
        bench.texts_with("Not saved: not all that was staged").len(),
        1
    );
    assert!(!bench.addresses().contains(&SAVE));
}

#[test]
fn value_and_range_stand_near_each_other_on_a_wide_screen() {
    let mut bench = Bench::open(SimConfig::default(), vec2(2560.0, 1440.0));
    bench.wait(1000);
    open(&mut bench);
    let place = |name: &str| {
        let labels = bench.all(Role::Label);
        let mut named = labels.into_iter().filter(|(own, _)| own == name);
        named.next().unwrap().1
    };
    let live = place("Index speed live");
    let range = place("Index speed range");
    assert!(range.left() - live.right() < 480.0, "{live} {range}");
}

#[test]
fn a_backup_is_no_wider_than_the_list_it_stands_in() {
    for size in [vec2(1024.0, 640.0), vec2(1366.0, 768.0)] {
        let mut bench = Bench::kept(SimConfig::default(), "sim:", size);
        bench.wait(1000);
        defaults(&mut bench, 100);
        open(&mut bench);
        save(&mut bench);
        settle(&mut bench);
        let buttons = bench.all(Role::Button);
        let mut backups = buttons
            .iter()
            .filter(|(name, _)| name.ends_with("before save"));
        let backup = backups.next().unwrap().1;
        let dump = bench.rect(Role::Button, "Export to file");
        assert!(backup.right() <= size.x - 20.0, "{backup}");
        assert!(backup.left() >= dump.left() - 1.0, "{backup} {dump}");
    }
}
