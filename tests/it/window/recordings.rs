//! Recordings in the running program: recorded as they happen, listed, replayed in the same window, named and deleted.

use crate::setup::window::{ANGLE_SET, Bench, LARGE, Role};
use crate::window::tune;
use handscope::app::action::Action;
use handscope::app::exhibit::ExhibitAction;
use handscope::app::hand::list::HandsAction;
use handscope::app::hand::mover::Mover;
use handscope::app::hand::running::SequenceRun;
use handscope::app::inputs::InputAction;
use handscope::app::notices::NoticeKind;
use handscope::app::recordings::recording::HandRecording;
use handscope::app::recordings::{RecordingAbout, RecordingAction, RecordingExport, RecordingItem};
use handscope::app::settings::Theme;
use handscope::hand::{Angle, Dof, Moment};
use handscope::inputs::mirror::MirrorScale;
use handscope::motion::source::SourceKind;
use handscope::record::Entry;
use handscope::record::EventKind;
use handscope::record::Rest;
use handscope::record::export::ExportFormat;
use handscope::record::file::reader::TimeRange;
use handscope::record::file::{OpenError, RecordingFile};
use handscope::sim::{Scenario, SimConfig};
use handscope::ui::View;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

const HAND: &str = "tcp:127.0.0.1:6000?unit=1";

fn bench(scenario: Scenario) -> Bench {
    bench_at(HAND, scenario)
}

fn bench_at(endpoint: &str, scenario: Scenario) -> Bench {
    let config = SimConfig {
        scenario,
        ..SimConfig::default()
    };
    let mut bench = Bench::kept(config, endpoint, LARGE);
    bench.wait(3000);
    bench
}

/// Frames until something is so that waits for files, which take real time.
fn settle(bench: &mut Bench, so: impl Fn(&Bench) -> bool) {
    for _ in 0..400 {
        if so(bench) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
        bench.run(20);
    }
    panic!("it does not settle: {:?}", bench.texts());
}

fn recording(bench: &mut Bench, action: RecordingAction) {
    bench.act(Action::Recording(action));
    bench.run(20);
}

fn read_item(path: &Path) -> Result<RecordingItem, OpenError> {
    let file = RecordingFile::open(path)?;
    Ok(RecordingItem::of(
        &file,
        RecordingAbout::load(path).unwrap_or_default(),
    ))
}

/// Ends the recording, and gives its file.
fn ended(bench: &mut Bench) -> PathBuf {
    let path = recorded(bench);
    recording(bench, RecordingAction::Record(false));
    settle(bench, |_| read_item(&path).is_ok_and(|item| item.closed));
    path
}

fn replay(bench: &mut Bench, path: PathBuf) {
    recording(bench, RecordingAction::Open(path));
    settle(bench, |bench| bench.state().timeline.is_some());
}

fn seek(bench: &mut Bench, at: Moment) {
    recording(bench, RecordingAction::Seek(at));
    settle(bench, |bench| {
        let line = bench.state().timeline.as_ref().unwrap();
        line.at == at && !line.waits
    });
}

#[test]
fn a_real_hand_is_recorded_by_itself_and_a_simulated_one_only_if_asked() {
    let mut real = bench(Scenario::Idle);
    assert!(real.shows("Recording"));
    let path = ended(&mut real);
    assert!(real.shows("Not recording"));
    let item = read_item(&path).unwrap();
    assert_eq!(item.opening.hand, HAND);
    assert!(item.counts.states > 100 && item.counts.touch_blocks > 20);
    assert!(!item.opening.simulated);

    let mut built_in = Bench::keeping(SimConfig::default());
    assert!(built_in.state().hand().recording.is_none());
    built_in.click("Not recording");
    built_in.run(100);
    let path = ended(&mut built_in);
    assert!(read_item(&path).unwrap().opening.simulated);
}

#[test]
fn the_hand_of_a_replay_leads_none() {
    let mut bench = bench(Scenario::Grasp);
    let path = ended(&mut bench);
    bench.open_another("tcp:10.0.0.2:6000");
    let leader = bench.state().hands.iter().next().unwrap().label.slot;
    replay(&mut bench, path);
    bench.show(View::Inputs);
    bench.run(100);
    assert!(!bench.shows("Leading hand"));
    let watch = InputAction::Mirror(Some((leader, MirrorScale::WHOLE)));
    for action in [watch, InputAction::Grant(SourceKind::Mirror)] {
        bench.act(Action::Input(action));
        bench.run(300);
    }
    let live = bench.live_state();
    for hand in live.hands.iter() {
        assert!(hand.inputs.mirror.is_none() && hand.connection.outside_owner().is_none());
    }
}

#[test]
fn a_stop_while_a_session_is_shown_holds_every_live_hand() {
    const OTHER: &str = "tcp:10.0.0.2:6000";
    for key in [egui::Key::Space, egui::Key::Escape] {
        let mut bench = bench(Scenario::Free);
        let path = ended(&mut bench);
        bench.open_another(OTHER);
        for slot in bench
            .state()
            .hands
            .iter()
            .map(|hand| hand.label.slot)
            .collect::<Vec<_>>()
        {
            bench.act(Action::Hands(HandsAction::Show(slot)));
            bench.run(40);
            bench.click("Arm the hand");
            bench.run(200);
        }
        assert!(
            bench
                .state()
                .hands
                .iter()
                .all(|hand| hand.connection.is_armed())
        );
        replay(&mut bench, path);
        let before = [bench.addresses().len(), bench.addresses_at(OTHER).len()];
        bench.key(key);
        bench.run(400);
        assert!(
            bench
                .live_state()
                .hands
                .iter()
                .all(|hand| !hand.connection.is_armed())
        );
        let written = [bench.addresses(), bench.addresses_at(OTHER)];
        for (written, before) in written.iter().zip(before) {
            assert!(
                written[before..].contains(&ANGLE_SET),
                "{key:?} {written:?}"
            );
        }
    }
}

#[test]
fn the_list_finds_names_stars_and_deletes_after_a_question() {
    let mut bench = bench(Scenario::Grasp);
    let path = ended(&mut bench);
    bench.show(View::Recordings);
    settle(&mut bench, |bench| bench.state().recordings.scans > 0);
    let title = read_item(&path).unwrap().title();
    let listed = format!("Keep: {title}");
    assert!(bench.shows(&listed), "{:?}", bench.texts());
    assert_eq!(bench.texts_with("Right hand, today ").len(), 1);
    bench.type_into("Find recordings", "nothing like it");
    assert!(bench.shows("No recording has these words."));
    bench.type_into("Find recordings", "127.0.0.1");
    assert!(bench.shows(&listed));

    bench.click(&listed);
    settle(&mut bench, |_| read_item(&path).unwrap().about.star);
    bench.click(&format!("More: {title}"));
    bench.run(100);
    bench.type_into("Name of the recording", "Old finger 捏");
    bench.key(egui::Key::Enter);
    settle(&mut bench, |_| {
        read_item(&path).unwrap().about.name == "Old finger 捏"
    });
    bench.run(100);
    assert_eq!(bench.texts_with("Old finger 捏, today ").len(), 1);
    bench.click_button("Delete ...");
    bench.run(100);
    assert!(bench.shows("Delete this recording?") && path.exists());
    bench.click_button("Keep it");
    bench.run(100);
    assert!(path.exists());
    recording(&mut bench, RecordingAction::AskDelete(path.clone()));
    bench.run(100);
    bench.click_button("Delete the recording");
    settle(&mut bench, |_| !path.exists());
    assert!(!path.with_extension("toml").exists());
}

#[test]
fn while_a_recording_is_shown_nothing_is_sent_and_stop_reaches_the_live_hand() {
    let mut bench = bench(Scenario::Idle);
    let path = ended(&mut bench);
    bench.click("Arm the hand");
    bench.run(200);
    assert!(bench.state().hand().connection.is_armed());
    replay(&mut bench, path);
    assert!(bench.shows("RECORDED") && !bench.shows("Arm the hand"));
    let writes = bench.writes().len();
    for action in [
        Action::Arm,
        Action::Preset(handscope::poses::Preset::Close),
        Action::ClearErrors,
        Action::FactoryReset,
        Action::CalibrateForce,
    ] {
        bench.act(action);
        bench.run(200);
    }
    assert_eq!(bench.writes().len(), writes, "a recording writes nothing");
    bench.key(egui::Key::Space);
    bench.run(100);
    assert!(bench.writes().len() > writes, "the live hand was stopped");
    bench.click_button("Back to live");
    bench.run(100);
    assert!(bench.state().timeline.is_none());
    assert!(!bench.state().hand().connection.is_armed());
}

#[test]
fn a_replay_tells_speed_force_target_and_mover_as_they_were() {
    let mut bench = bench(Scenario::Free);
    bench.gentle();
    bench.click("Arm the hand");
    bench.run(1500);
    bench.act(Action::Target(Dof::Index, Angle::nearest(300)));
    bench.run(700);
    let at = bench.now();
    let live = bench.state().hand().controls.joints[Dof::Index];
    let mover = Mover::of(bench.state().hand(), at);
    assert_eq!(mover, Some(Mover::Setpoints));
    bench.wait(3000);
    let path = ended(&mut bench);
    replay(&mut bench, path);
    seek(&mut bench, at);
    let shown = bench.state().hand();
    let joint = shown.controls.joints[Dof::Index];
    assert_eq!((joint.speed, joint.force), (live.speed, live.force));
    assert_eq!(joint.target, Some(Angle::nearest(300)), "not where it is");
    assert_eq!(Mover::of(shown, at), mover);
    for button in ["Open all", "Half", "Close", "Index lock"] {
        assert!(bench.is_disabled(Role::Button, button), "{button}");
    }
    for track in ["Index angle target", "Index force threshold", "All speed"] {
        assert!(bench.is_disabled(Role::Slider, track), "{track}");
    }
    let goes = bench.all(Role::Button).into_iter();
    let goes = goes.filter(|(name, _)| name.starts_with("Go to ")).count();
    assert!(goes > 0, "tiles are shown");
    assert!(bench.all_disabled("Go to Fist").iter().all(|is| *is));
}

#[test]
fn a_replay_names_what_was_played_also_while_it_presses_and_lists_it() {
    let mut bench = bench(Scenario::Rigid);
    bench.gentle();
    bench.click("Arm the hand");
    bench.run(500);
    let begun = bench.now();
    bench.click("Go to Fist");
    bench.run(400);
    let moves = bench.now();
    assert!(bench.shows("Pose Fist"), "{:?}", bench.texts());
    let at_rest = |bench: &Bench| bench.state().hand().connection.status.rest == Rest::Resting;
    let is_playing = |bench: &Bench| {
        let run = bench.state().hand().running.sequence();
        run.is_some_and(SequenceRun::is_running)
    };
    let mut presses = None;
    for _ in 0..200 {
        bench.run(100);
        if at_rest(&bench) && is_playing(&bench) {
            presses = Some(bench.now());
        }
        if !is_playing(&bench) {
            break;
        }
    }
    bench.run(1500);
    let over = bench.now();
    let path = ended(&mut bench);
    replay(&mut bench, path);
    for at in [Some(moves), presses].into_iter().flatten() {
        seek(&mut bench, at);
        assert!(bench.shows("Pose Fist"), "{:?}", bench.texts());
    }
    seek(&mut bench, over);
    assert!(!bench.shows("Pose Fist"), "it is over");
    bench.click("Marks");
    bench.run(60);
    let listed = bench.buttons_with("Pose Fist");
    assert_eq!(listed.len(), 1, "{:?}", bench.buttons_with(""));
    bench.click(&listed[0]);
    settle(&mut bench, |bench| {
        !bench.state().timeline.as_ref().unwrap().waits
    });
    let at = bench.state().timeline.as_ref().unwrap().at;
    assert!(at.since(begun) < Duration::from_millis(200));
}

#[test]
fn a_whole_session_is_exported_in_every_format_and_told_with_its_path() {
    let mut bench = bench(Scenario::Grasp);
    // A data set needs a command: the targets of a stop.
    bench.key(egui::Key::Space);
    bench.wait(1000);
    let path = ended(&mut bench);
    for &format in ExportFormat::ALL {
        let saved = |bench: &Bench| {
            let notices = bench.state().notices.iter();
            let paths = notices.filter_map(|notice| match &notice.what {
                NoticeKind::Saved { path, entries } => Some((path.clone(), *entries)),
                NoticeKind::NotSaved { error, .. } => panic!("{format:?}: {error:?}"),
                _ => None,
            });
            paths.collect::<Vec<_>>()
        };
        let before = saved(&bench).len();
        recording(&mut bench, export(&path, format, None));
        settle(&mut bench, |bench| saved(bench).len() > before);
        let (to, entries) = saved(&bench).remove(0);
        assert!(
            to.exists() && entries > 10,
            "{format:?}: {entries} in {to:?}"
        );
        let ending = match format {
            ExportFormat::Mcap => "-copy.mcap",
            format => format.properties().ending,
        };
        assert!(to.to_string_lossy().ends_with(ending), "{to:?}");
    }
}

#[test]
fn a_data_set_of_a_hand_that_was_only_watched_is_refused_with_the_reason() {
    let mut bench = bench(Scenario::Grasp);
    let path = ended(&mut bench);
    recording(&mut bench, export(&path, ExportFormat::LeRobot, None));
    settle(&mut bench, |bench| {
        let told = bench.texts_with("Not exported: ");
        told.iter()
            .any(|told| told.contains("No joint was commanded in this time range"))
    });
}

fn export(path: &Path, format: ExportFormat, stretch: Option<(Moment, Moment)>) -> RecordingAction {
    let path = path.to_owned();
    RecordingAction::Export(RecordingExport {
        path,
        format,
        stretch,
        uncommanded: false,
    })
}

#[test]
fn a_data_set_without_commands_is_exported_by_a_button_of_its_own() {
    let mut bench = bench(Scenario::Grasp);
    bench.wait(1000);
    let _path = ended(&mut bench);
    bench.show(View::Recordings);
    settle(&mut bench, |bench| {
        !bench.state().recordings.items.is_empty()
    });
    bench.run(100);
    let title = bench.state().recordings.items[0].title();
    bench.click_button(&format!("More: {title}"));
    bench.run(100);
    bench.click_button("Data set without commands (LeRobot)");
    let saved = |bench: &Bench| {
        let mut notices = bench.state().notices.iter();
        notices.find_map(|notice| match &notice.what {
            NoticeKind::Saved { path, .. } => Some(path.clone()),
            _ => None,
        })
    };
    settle(&mut bench, |bench| saved(bench).is_some());
    let info = std::fs::read_to_string(saved(&bench).unwrap().join("meta/info.json")).unwrap();
    let info: serde_json::Value = serde_json::from_str(&info).unwrap();
    assert_eq!(info["handscope"]["action_uncommanded_episodes"], 1);
    assert!(info["handscope"]["action_warning"].is_string());
}

#[test]
fn a_stretch_that_is_dragged_on_the_strip_is_exported_alone() {
    let mut bench = bench(Scenario::Grasp);
    bench.wait(5000);
    let path = ended(&mut bench);
    bench.show(View::Recordings);
    settle(&mut bench, |bench| {
        !bench.state().recordings.items.is_empty()
    });
    bench.run(100);
    let item = read_item(&path).unwrap();
    let strip = bench.rect(Role::Image, &format!("Force over time: {}", item.title()));
    let at = |part| strip.lerp_inside(egui::vec2(part, 0.5));
    bench.drag_from_to(at(0.25), at(0.5));
    bench.run(100);
    assert_eq!(bench.texts_with("Export the marked ").len(), 1);
    bench.click_button("Table (CSV)");
    let saved = |bench: &Bench| {
        let mut notices = bench.state().notices.iter();
        notices.find_map(|notice| match &notice.what {
            NoticeKind::Saved { path, .. } => Some(path.clone()),
            _ => None,
        })
    };
    settle(&mut bench, |bench| saved(bench).is_some());
    let to = saved(&bench).unwrap();
    assert!(to.to_string_lossy().ends_with("-part.csv"), "{to:?}");
    let csv = std::fs::read_to_string(to).unwrap();
    let time = |line: &str| line.split(',').next()?.parse::<f64>().ok();
    let times: Vec<f64> = csv.lines().filter_map(time).collect();
    let span = times.last().unwrap() - times[0];
    let wanted = item.length.as_secs_f64() / 4.0;
    assert!((span - wanted).abs() < 0.2, "{span} is not {wanted}");
    settle(&mut bench, |bench| {
        bench.state().recordings.exports.is_empty()
    });
}

#[test]
fn an_export_that_fails_says_why() {
    let mut bench = bench(Scenario::Idle);
    let path = ended(&mut bench);
    let first = read_item(&path).unwrap().first;
    let nothing = Some((first, first));
    recording(&mut bench, export(&path, ExportFormat::LeRobot, nothing));
    settle(&mut bench, |bench| {
        let told = bench.texts_with("Not exported: ");
        told.iter()
            .any(|told| told.contains("There is nothing to export in this time range."))
    });
}

#[test]
fn an_empty_place_says_what_comes_there_and_leads_to_a_hand() {
    let mut bench = Bench::keeping(SimConfig::default());
    bench.show(View::Recordings);
    settle(&mut bench, |bench| bench.state().recordings.scans > 0);
    bench.run(60);
    assert!(bench.shows("No recordings yet"));
    bench.act(Action::Disconnect);
    settle(&mut bench, |bench| {
        bench.state().hand().connection.endpoint.is_none()
    });
    bench.run(60);
    bench.click_button("Connect a hand");
    bench.run(60);
    assert!(
        bench.shows("Kind of link: Simulated"),
        "{:?}",
        bench.texts()
    );
}

#[test]
fn an_empty_place_offers_to_record_the_hand_that_is_connected() {
    let mut bench = Bench::keeping(SimConfig::default());
    bench.show(View::Recordings);
    settle(&mut bench, |bench| bench.state().recordings.scans > 0);
    bench.run(60);
    assert!(bench.state().hand().recording.is_none());
    bench.click_button("Record this hand");
    settle(&mut bench, |bench| bench.state().hand().recording.is_some());
}

#[test]
fn time_goes_on_stops_steps_and_loops() {
    let mut bench = bench(Scenario::Grasp);
    bench.wait(4000);
    let path = ended(&mut bench);
    replay(&mut bench, path);
    let at = |bench: &Bench| bench.state().timeline.as_ref().unwrap().at;
    let first = bench.state().timeline.as_ref().unwrap().first;
    seek(&mut bench, first.plus(Duration::from_secs(2)));
    let begun = at(&bench);
    bench.click_button("Play");
    settle(&mut bench, |bench| {
        at(bench).since(begun) > Duration::from_secs(1)
    });
    bench.click_button("Pause");
    bench.run(100);
    let stood = at(&bench);
    bench.run(500);
    assert_eq!(at(&bench), stood);
    let angle = |bench: &Bench| bench.state().hand().readings.sample.angle.unwrap().received;
    let before = angle(&bench);
    bench.click_button("Next reading");
    settle(&mut bench, |bench| at(bench) > stood);
    assert_eq!(angle(&bench), at(&bench), "at the reading itself");
    bench.click_button("Reading before");
    settle(&mut bench, |bench| at(bench) <= stood);
    assert!(angle(&bench) <= before.plus(Duration::from_millis(1)));

    let stretch = (
        first.plus(Duration::from_secs(1)),
        first.plus(Duration::from_secs(2)),
    );
    recording(&mut bench, RecordingAction::Loop(Some(stretch)));
    recording(&mut bench, RecordingAction::Pace(10.0));
    seek(&mut bench, stretch.0);
    recording(&mut bench, RecordingAction::Run(true));
    let mut rounds = 0;
    let mut last = at(&bench);
    settle_rounds(&mut bench, |bench| {
        let now = at(bench);
        assert!(now >= stretch.0 && now <= stretch.1);
        rounds += u32::from(now < last);
        last = now;
        rounds >= 2
    });
    bench.click_button("Loop off");
    bench.run(60);
    assert_eq!(bench.state().timeline.as_ref().unwrap().looped, None);
}

fn settle_rounds(bench: &mut Bench, mut so: impl FnMut(&Bench) -> bool) {
    for _ in 0..800 {
        if so(bench) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
        bench.run(20);
    }
    panic!("it does not go round");
}

#[test]
fn a_note_is_recorded_and_one_can_be_given_after_the_fact() {
    let mut bench = bench(Scenario::Idle);
    let at = bench.now();
    bench.act(Action::Note(at, "before the squeeze".into()));
    bench.wait(1000);
    let path = ended(&mut bench);
    let notes = |path: &PathBuf| read_item(path).unwrap().notes();
    assert_eq!(notes(&path).len(), 1);
    assert_eq!(notes(&path)[0].words, "before the squeeze");
    assert_eq!(notes(&path)[0].at(), at);
    replay(&mut bench, path.clone());
    let later = at.plus(Duration::from_millis(500));
    bench.act(Action::Note(later, "seen afterwards".into()));
    settle(&mut bench, |_| notes(&path).len() == 2);
    bench.click_button("Marks");
    bench.run(100);
    let entries = bench.buttons_with("seen afterwards");
    assert_eq!(entries.len(), 1, "{:?}", bench.texts());
    recording(&mut bench, RecordingAction::EditNote(at, String::new()));
    settle(&mut bench, |_| notes(&path).len() == 1);
}

#[test]
fn faults_stops_and_arming_are_marks_of_the_session() {
    let mut bench = bench(Scenario::Faults);
    bench.wait(6000);
    bench.key(egui::Key::Space);
    bench.wait(1000);
    let path = ended(&mut bench);
    let item = read_item(&path).unwrap();
    assert!(item.counts.faults > 0 && item.count(EventKind::Fault) > 0);
    assert!(item.count(EventKind::Stop) == 1);
    let fault = item.marks.iter().find(|mark| mark.kind == EventKind::Fault);
    let fault = fault.unwrap().at;
    replay(&mut bench, path);
    bench.show(View::Faults);
    seek(&mut bench, fault.plus(Duration::from_millis(100)));
    bench.run(60);
    let active = |bench: &Bench| bench.state().hand().readings.faults.active().count();
    let then = active(&bench);
    seek(&mut bench, Moment::from_micros(fault.micros() - 100_000));
    assert!(active(&bench) < then, "{then}");
}

/// What the views say, without what belongs to the window and not to the hand.
fn said(bench: &Bench) -> Vec<(String, String)> {
    let top = 150.0;
    let mut all = bench.labels_below(top);
    // A recording is not armed, and has no wishes beside what the hand held. A frame that passes in the very moment of the
    // picture is counted in one and not in the other.
    all.retain(|(name, text)| {
        let is_wish = name.contains(" · hand ") || text.starts_with("hand ");
        // Above a time line fewer plots are tall.
        let is_plot = ["Current, mA", "Temperature, °C"].contains(&text.as_str());
        !is_wish && !is_plot && !text.ends_with(" frames") && text != "Press Arm to move"
    });
    all
}

fn shows_again(endpoint: &str) {
    for scenario in [Scenario::Grasp, Scenario::Faults] {
        let mut bench = bench_at(endpoint, scenario);
        bench.wait(3500);
        let mut live = Vec::new();
        for view in [View::Live, View::Touch, View::Faults, View::Traffic] {
            bench.show(view);
            bench.run(60);
            live.push((view, bench.now(), said(&bench)));
        }
        bench.wait(300);
        let path = ended(&mut bench);
        replay(&mut bench, path);
        for (view, at, wanted) in live {
            bench.show(view);
            // What arrives in the very moment of a frame is taken in with the next, but its ages are of this one.
            let mut shown = Vec::new();
            for at in [Moment::from_micros(at.micros() - 1), at] {
                seek(&mut bench, at);
                bench.run(60);
                shown.extend(said(&bench));
            }
            let missing: Vec<_> = wanted.iter().filter(|one| !shown.contains(one)).collect();
            assert!(
                missing.is_empty(),
                "{view:?} of {scenario:?} on {endpoint}: {missing:#?} {shown:#?}"
            );
            assert!(wanted.len() > 10, "{view:?}: {}", wanted.len());
        }
    }
}

#[test]
fn what_was_shown_live_over_tcp_is_shown_again_at_the_same_moment() {
    shows_again(HAND);
}

#[test]
fn what_was_shown_live_over_rtu_is_shown_again_at_the_same_moment() {
    shows_again("rtu:/dev/ttyUSB0?baud=115200&id=1");
}

#[test]
fn what_was_shown_live_over_rs485_is_shown_again_at_the_same_moment() {
    shows_again("rs485:/dev/ttyUSB0?baud=115200&id=1");
}

#[test]
fn what_was_shown_live_over_can_is_shown_again_at_the_same_moment() {
    shows_again("can:can0?id=1");
}

#[test]
fn what_was_shown_live_over_slcan_is_shown_again_at_the_same_moment() {
    shows_again("slcan:/dev/ttyACM0?id=1");
}

#[test]
fn a_file_that_is_no_session_is_refused_in_words() {
    let mut bench = bench(Scenario::Idle);
    let path = ended(&mut bench).with_file_name("other.mcap");
    std::fs::write(&path, "not at all").unwrap();
    recording(&mut bench, RecordingAction::Open(path));
    settle(&mut bench, |bench| {
        !bench.texts_with("cannot be replayed").is_empty()
    });
    assert!(bench.state().timeline.is_none());
}

#[test]
fn closing_asks_while_a_value_is_staged_and_closes_once_a_person_says_so() {
    use handscope::params::rows::{ParamId, Value};
    let mut bench = bench(Scenario::Idle);
    assert!(!bench.wants_to_close(), "nothing is lost");
    let id = ParamId::all()
        .into_iter()
        .find(|id| !id.is_place())
        .unwrap();
    bench.act(Action::Stage(id, Some(Value::Number(300))));
    bench.run(100);
    assert!(bench.wants_to_close());
    bench.run(100);
    assert!(bench.shows("Close Handscope?"));
    bench.click_button("Keep it open");
    bench.run(100);
    assert!(!bench.shows("Close Handscope?"));
    assert!(bench.wants_to_close());
    bench.run(100);
    bench.click_button("Close the window");
    bench.run(100);
    assert!(!bench.wants_to_close(), "asked once, and answered");
}

#[test]
fn two_sessions_lie_over_each_other_aligned_by_a_mark_of_each() {
    let mut bench = bench(Scenario::Grasp);
    bench.wait(2000);
    bench.act(Action::Note(bench.now(), "first grasp".into()));
    bench.wait(1000);
    let first = ended(&mut bench);
    recording(&mut bench, RecordingAction::Record(true));
    bench.wait(3000);
    bench.act(Action::Note(bench.now(), "second grasp".into()));
    bench.wait(1000);
    let second = ended(&mut bench);
    bench.show(View::Recordings);
    settle(&mut bench, |bench| {
        bench.state().recordings.items.len() == 2
    });
    replay(&mut bench, first.clone());
    bench.show(View::Live);
    bench.click_button("Compare with");
    bench.run(100);
    let title = read_item(&second).unwrap().title();
    let offered = bench.buttons_with("Right hand, today ");
    bench.click_button(&offered[0]);
    settle(&mut bench, |bench| bench.state().beside.is_some());
    let note = |path| read_item(path).unwrap().notes()[0].at();
    let (own, other) = (note(&first), note(&second));
    recording(&mut bench, RecordingAction::Align(own, other));
    bench.run(100);
    let beside = bench.state().beside.as_ref().unwrap();
    assert_eq!(beside.offset_s(), other.secs() - own.secs());
    let force = handscope::history::Series::Joint(
        handscope::hand::Quantity::Force,
        handscope::hand::Dof::Index,
    );
    let there = beside.history.reading(force, other.secs());
    assert!(there.is_some(), "its own readings, at its own times");
    bench.click(&format!("Stop comparing: {title}"));
    bench.run(60);
    assert!(bench.state().beside.is_none());
}

#[test]
fn nothing_of_the_live_window_is_changed_from_within_a_recording() {
    let mut bench = bench(Scenario::Idle);
    let path = ended(&mut bench);
    bench.act(Action::Capture("Open hand".into()));
    bench.run(60);
    let live = |bench: &mut Bench| {
        let state = bench.live_state();
        (
            state.hand().connection.endpoint.clone(),
            state.poses.library.clone(),
            state.trials.plan.clone(),
        )
    };
    let before = live(&mut bench);
    replay(&mut bench, path.clone());
    bench.run(60);
    assert!(
        !bench.buttons_with("Open hand").is_empty(),
        "one's own poses are shown: {:?}",
        bench.texts()
    );
    let mut plan = before.2.clone();
    plan.note = "changed".into();
    for action in [
        Action::Disconnect,
        Action::Connect("sim:".parse().unwrap()),
        Action::Trial(handscope::app::trials::TrialAction::Plan(Box::new(plan))),
        Action::Capture("Another".into()),
    ] {
        bench.act(action);
        bench.run(200);
    }
    assert_eq!(live(&mut bench), before);
    bench.click_button("Back to live");
    bench.run(60);
    bench.act(Action::FactoryReset);
    bench.run(60);
    recording(&mut bench, RecordingAction::Open(path));
    settle(&mut bench, |bench| {
        !bench.texts_with("Not replayed now").is_empty()
    });
    assert!(bench.state().timeline.is_none(), "a question is open");
}

#[test]
fn a_replay_and_an_exhibition_are_never_shown_together() {
    let is_told = |bench: &Bench| {
        let mut told = bench.state().notices.iter();
        told.any(|notice| notice.what == NoticeKind::NotReplayedNow)
    };
    let mut late = bench(Scenario::Idle);
    let path = ended(&mut late);
    late.act(Action::Recording(RecordingAction::Open(path)));
    late.act(Action::Exhibit(ExhibitAction::Enter));
    settle(&mut late, is_told);
    assert!(late.state().exhibit.is_some() && late.state().timeline.is_none());

    let mut early = bench(Scenario::Idle);
    let path = ended(&mut early);
    let text = include_str!("../../../assets/exhibit.toml");
    std::fs::write(early.folder().join("handscope-exhibit.toml"), text).unwrap();
    early.act(Action::Exhibit(ExhibitAction::EnterFile));
    early.act(Action::Recording(RecordingAction::Open(path)));
    settle(&mut early, |bench| bench.state().exhibit.is_some());
    assert!(early.state().timeline.is_none());
}

#[test]
fn a_note_does_not_undo_a_name_and_a_bad_file_of_words_is_kept() {
    let mut bench = bench(Scenario::Idle);
    let at = bench.now();
    let path = ended(&mut bench);
    let about = path.with_extension("toml");
    std::fs::write(&about, "name = ").unwrap();
    bench.show(View::Recordings);
    settle(&mut bench, |bench| {
        bench.state().recordings.items.len() == 1
    });
    replay(&mut bench, path.clone());
    for name in ["one", "two", "three"] {
        bench.act(Action::Recording(RecordingAction::Name(
            path.clone(),
            name.into(),
        )));
    }
    bench.act(Action::Note(at, "seen".into()));
    settle(&mut bench, |_| read_item(&path).unwrap().notes().len() == 1);
    assert_eq!(read_item(&path).unwrap().about.name, "three");
    let folder = std::fs::read_dir(about.parent().unwrap()).unwrap();
    let mut texts = folder.map(|file| std::fs::read(file.unwrap().path()).unwrap());
    assert!(texts.any(|text| text == b"name = "), "it was put aside");
}

/// The file that is being recorded, once there is one.
fn recorded(bench: &mut Bench) -> PathBuf {
    let path = |bench: &Bench| {
        let recording = bench.state().hand().recording.as_ref()?;
        recording.status.path.clone()
    };
    settle(bench, |bench| path(bench).is_some());
    path(bench).unwrap()
}

#[test]
fn a_folder_is_chosen_for_the_next_recording_and_the_running_one_stays() {
    let mut bench = bench(Scenario::Idle);
    let first = recorded(&mut bench);
    let default = bench.folder().join("documents/Handscope");
    assert!(first.starts_with(&default));
    bench.show(View::Recordings);
    settle(&mut bench, |bench| bench.state().recordings.scans > 0);
    assert_eq!(bench.reading("Folder"), default.display().to_string());
    assert!(bench.is_disabled(egui::accesskit::Role::Button, "Default"));
    // In the place of a folder there is a file: it is told, and a path can be typed.
    let no_folder = Some(first.join("sessions"));
    recording(&mut bench, RecordingAction::ChooseFolder(no_folder));
    settle(&mut bench, |bench| bench.shows("Path of the folder"));
    assert!(!bench.texts_with("sessions").is_empty());
    let typed = bench.folder().join("typed");
    bench.type_into("Path of the folder", &typed.display().to_string());
    bench.click_button("Record here");
    settle(&mut bench, |bench| {
        bench.reading("Folder") == typed.display().to_string()
    });
    assert!(!bench.shows("Path of the folder") && typed.is_dir());
    assert_eq!(recorded(&mut bench), first);
    ended(&mut bench);
    recording(&mut bench, RecordingAction::Record(true));
    assert!(recorded(&mut bench).starts_with(&typed));
    let folder = bench.folder().to_owned();
    bench.click_button("Change ...");
    settle(&mut bench, |bench| {
        bench.reading("Folder") == folder.display().to_string()
    });
    bench.click_button("Default");
    settle(&mut bench, |bench| {
        bench.reading("Folder") == default.display().to_string()
    });
}

#[test]
fn a_session_is_shown_in_the_file_manager_and_a_failure_is_told_with_its_path() {
    let mut bench = bench(Scenario::Idle);
    let path = ended(&mut bench);
    bench.show(View::Recordings);
    settle(&mut bench, |bench| {
        !bench.state().recordings.items.is_empty()
    });
    let title = read_item(&path).unwrap().title();
    bench.click(&format!("More: {title}"));
    bench.run(100);
    bench.click_button("Show in folder");
    settle(&mut bench, |bench| !bench.revealed().is_empty());
    assert_eq!(bench.revealed(), std::slice::from_ref(&path));
    bench.click(&format!("More: {title}"));
    bench.run(100);
    let copied = bench.click_to_copy("Copy path");
    assert_eq!(copied, Some(path.display().to_string()));
    let gone = path.with_file_name("gone.mcap");
    recording(&mut bench, RecordingAction::Reveal(gone.clone()));
    settle(&mut bench, |bench| {
        let told = bench.texts_with("The file manager did not start");
        told.iter()
            .any(|told| told.contains(&gone.display().to_string()))
    });
    assert_eq!(bench.revealed().len(), 1, "nothing was started");
}

/// Copies of a recording in the folder of recordings: of five days, the oldest first.
fn old_sessions(bench: &Bench, of: &Path) -> Vec<PathBuf> {
    let folder = bench.folder().join("documents/Handscope/2020-01-01");
    std::fs::create_dir_all(&folder).unwrap();
    let paths = ["1", "2", "3"].map(|name| folder.join(format!("{name}.mcap")));
    for path in &paths {
        std::fs::copy(of, path).unwrap();
    }
    paths.into()
}

fn tell(bench: &Bench, path: &Path, told_unix_s: u64) {
    let bytes = std::fs::metadata(path).unwrap().len();
    let path = path.display();
    let text =
        format!("[[session]]\npath = '{path}'\nbytes = {bytes}\ntold_unix_s = {told_unix_s}\n");
    let folder = bench.folder().join("documents/Handscope");
    std::fs::write(folder.join("to-delete.toml"), text).unwrap();
}

#[test]
fn sessions_beyond_the_budget_are_told_and_go_a_day_later_when_a_recording_begins() {
    let config = SimConfig {
        scenario: Scenario::Idle,
        ..SimConfig::default()
    };
    let mut bench = Bench::kept_with(config, |settings| {
        settings.endpoint = Some(HAND.into());
        settings.recordings.budget_gb = 0.0;
    });
    bench.wait(2000);
    let first = ended(&mut bench);
    // Nobody may delete what somebody cares for.
    let mut about = RecordingAbout::load(&first).unwrap();
    about.name = "first".into();
    about.save(&first).unwrap();
    // A recording of some 20 MB: the least budget has no room for it.
    let old = old_sessions(&bench, &first);
    for path in &old {
        let file = std::fs::OpenOptions::new().append(true).open(path).unwrap();
        file.set_len(20_000_000).unwrap();
    }
    bench.show(View::Recordings);
    settle(&mut bench, |bench| {
        bench.state().recordings.planned.len() == 3
    });
    assert!(!bench.texts_with("Recordings exceed their room").is_empty());
    let told = bench.folder().join("documents/Handscope/to-delete.toml");
    settle(&mut bench, |_| told.exists());
    recording(&mut bench, RecordingAction::Record(true));
    recorded(&mut bench);
    bench.wait(1000);
    assert!(old.iter().all(|path| path.exists()), "told just now");

    // One of them was told long before, and one that was told has a star by now.
    ended(&mut bench);
    tell(&bench, &old[1], 1);
    recording(&mut bench, RecordingAction::Record(true));
    settle(&mut bench, |_| !old[1].exists());
    assert!(old[0].exists() && old[2].exists() && first.exists());
    assert!(!bench.texts_with("Recordings deleted").is_empty());
    settle(&mut bench, |bench| {
        bench.state().recordings.planned.len() == 2
    });
    bench.click_button("Keep them");
    settle(&mut bench, |_| read_item(&old[2]).unwrap().about.star);
    recording(&mut bench, RecordingAction::Star(old[0].clone(), false));
    settle(&mut bench, |bench| {
        !bench.state().recordings.planned.is_empty()
    });
    bench.click_button("Delete now");
    settle(&mut bench, |_| !old[0].exists());
    assert!(old[2].exists() && first.exists());
}

/// The words of all events of a kind, in order.
fn events(path: &Path, kind: EventKind) -> Vec<String> {
    let file = RecordingFile::open(path).unwrap();
    let mut words = Vec::new();
    let all = TimeRange {
        from: file.first(),
        to: file.last(),
        wire: false,
    };
    let read = file.entries(all, |entry| {
        if let Entry::Event(event) = entry
            && event.kind == kind
        {
            words.push(event.words);
        }
        ControlFlow::Continue(())
    });
    read.unwrap();
    words
}

#[test]
fn a_recording_tells_what_the_hand_keeps_and_the_settings_though_nobody_looked() {
    let mut bench = bench(Scenario::Idle);
    bench.act(Action::Theme(Theme::Light));
    bench.wait(1500);
    let layout = handscope::app::layout::Layout {
        window: [1300.0, 800.0].into(),
        ..bench.state().settings.layout
    };
    bench.act(Action::Layout(layout));
    bench.wait(1500);
    assert_eq!(bench.writes(), [], "it was only read");
    let path = ended(&mut bench);
    let kept = events(&path, EventKind::Parameters);
    assert_eq!(kept.len(), 1, "{kept:?}");
    let file = handscope::params::file::read(&kept[0]).unwrap();
    let all = handscope::params::rows::ParamId::all();
    assert_eq!(file.params.iter().count(), all.len());
    let settings = events(&path, EventKind::Settings);
    let themes = settings.iter().map(|text| {
        let table: toml::Table = text.parse().unwrap();
        table["theme"].as_str().unwrap().to_owned()
    });
    assert_eq!(themes.collect::<Vec<_>>(), ["dark", "light"]);
    assert!(
        read_item(&path).unwrap().marks.is_empty(),
        "no marks of the time line"
    );
}

#[test]
fn a_hand_that_moves_is_asked_for_what_it_keeps_only_once_it_rests() {
    let config = SimConfig {
        scenario: Scenario::Grasp,
        ..SimConfig::default()
    };
    let mut bench = Bench::kept(config, HAND, LARGE);
    let (mut moved, mut asked) = (false, false);
    for _ in 0..400 {
        let hand = bench.state().hand();
        moved |= hand.connection.status.rest == Rest::Moving;
        let was_asked = asked;
        asked = hand.recording.as_ref().is_some_and(HandRecording::is_asked);
        assert!(was_asked || !asked || hand.connection.status.rest == Rest::Resting);
        bench.wait(20);
    }
    assert!(moved, "it is looked at while it moves, too");
    assert_eq!(bench.writes(), []);
}

/// Presses the first button that replays what has these words, and gives the beginning and the end of what is looped.
fn replay_listed(bench: &mut Bench, words: &str, path: &Path) -> (Moment, Moment) {
    // The file has what happened a quarter of a second ago.
    std::thread::sleep(Duration::from_millis(400));
    bench.run(60);
    let buttons = bench.buttons_with("Replay: ");
    let button = buttons.iter().find(|name| name.contains(words));
    let button = button
        .unwrap_or_else(|| panic!("{words}: {buttons:?}"))
        .clone();
    bench.click_first_button(&button);
    let looped = |bench: &Bench| {
        let line = bench.state().timeline.as_ref()?;
        line.looped
            .filter(|looped| looped.0 == line.at && !line.waits)
    };
    settle(bench, |bench| looped(bench).is_some());
    assert_eq!(bench.state().timeline.as_ref().unwrap().path, path);
    looped(bench).unwrap()
}

#[test]
fn a_fault_is_replayed_from_two_seconds_before_while_its_session_is_recorded() {
    let mut bench = bench(Scenario::Faults);
    bench.wait(9000);
    let path = recorded(&mut bench);
    bench.show(View::Faults);
    bench.run(60);
    let fault = *bench.state().hand().readings.faults.iter().next().unwrap();
    let joint = "Replay: ";
    let looped = replay_listed(&mut bench, joint, &path);
    let mut faults = bench.live_state().hand().readings.faults.iter();
    let before = |since: Moment| Moment::from_micros(since.micros() - 2_000_000);
    assert!(
        faults.any(|fault| before(fault.since) == looped.0),
        "{fault:?}"
    );
    drop(faults);
    assert!(looped.1 > looped.0.plus(Duration::from_secs(2)));
    // In the replay the same button goes there within the same file.
    recording(&mut bench, RecordingAction::Loop(None));
    let end = bench.state().timeline.as_ref().unwrap().last;
    seek(&mut bench, end);
    let again = replay_listed(&mut bench, joint, &path);
    assert!(again.0 < end);
}

#[test]
fn what_no_session_holds_cannot_be_replayed_and_says_so() {
    let config = SimConfig {
        scenario: Scenario::Faults,
        ..SimConfig::default()
    };
    let mut bench = Bench::open(config, LARGE);
    bench.wait(10_000);
    bench.show(View::Faults);
    bench.run(60);
    let buttons = bench.buttons_with("Replay: ");
    assert!(!buttons.is_empty());
    for button in buttons {
        assert!(bench.all_disabled(&button).into_iter().all(|is| is));
    }
}

#[test]
fn a_trial_is_replayed_from_two_seconds_before_its_closing_command() {
    let config = SimConfig {
        scenario: Scenario::Rigid,
        ..SimConfig::default()
    };
    let mut bench = Bench::kept(config, HAND, LARGE);
    bench.wait(1000);
    tune::grid(&mut bench);
    bench.run(40);
    tune::short(&mut bench);
    tune::arm(&mut bench);
    bench.click("Start trials");
    tune::finish(&mut bench, 60_000);
    let path = recorded(&mut bench);
    bench.show(View::Compare);
    bench.run(100);
    let trials = &bench.state().trials.sessions[0];
    let (close, _) = trials.stretch(trials.trials[0].summary.number).unwrap();
    let looped = replay_listed(&mut bench, "Replay: 1 ", &path);
    assert_eq!(looped.0.plus(Duration::from_secs(2)), close);
    seek(&mut bench, close.plus(Duration::from_millis(200)));
    let mover = Mover::of(bench.state().hand(), bench.now());
    assert!(matches!(mover, Some(Mover::Series(1, _))), "{mover:?}");
    bench.click_first_button("Tune");
    bench.run(100);
    assert!(!bench.shows("Arm and start"), "the plan is the live hand's");
    let listed = bench.buttons_with("1 / 1, Index");
    assert_eq!(listed.len(), 1, "{:?}", bench.buttons_with(""));
    bench.click(&listed[0]);
    settle(&mut bench, |bench| {
        let line = bench.state().timeline.as_ref().unwrap();
        line.at < close && !line.waits
    });
}
