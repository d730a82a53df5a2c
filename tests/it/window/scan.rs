//! Claims about looking for hands: a click finds them, a click connects, nothing is written, nothing is asked unasked.

use crate::setup::states::usb_port;
use crate::setup::window::{Bench, LARGE, Role};
use crate::window::layout::check;
use egui::vec2;
use handscope::app::action::Action;
use handscope::app::inputs::InputAction;
use handscope::app::scan::{IdRange, ScanStage, ScanTarget};
use handscope::hand::kinematics::Side;
use handscope::link::Owner;
use handscope::motion::source::SourceKind;
use handscope::record::LinkState;
use handscope::share::fleet::{self, FleetCard, FleetHand};
use handscope::sim::{SimConfig, SimHand};
use handscope::transport::dds::{DdsNode, DdsPlace, DdsWriter};
use handscope::ui::View;
use std::time::{Duration, Instant};

const PORT: &str = "/dev/ttyUSB7";
const ADDRESS: &str = "Address, port or name";
const URL: &str = "rs485:/dev/ttyUSB7?baud=115200&id=1";

/// The connection view, with an adapter plugged in and the hand behind it.
fn at_connection(config: SimConfig) -> Bench {
    let mut bench = Bench::open(config, LARGE);
    bench.list_ports(vec![usb_port(PORT)]);
    bench.wait(200);
    bench.show(View::Connection);
    bench.run(60);
    bench
}

fn is_done(bench: &Bench) -> bool {
    matches!(bench.state().scan.stage, ScanStage::Done(_))
}

#[test]
fn a_click_finds_the_hand_and_a_click_connects_without_a_write() {
    let mut bench = at_connection(SimConfig::default());
    bench.click_button("Find hands");
    bench.until(1000, |bench| !bench.state().scan.found.is_empty());
    assert!(bench.state().scan.is_running(), "further ids are asked");
    assert!(bench.shows("ID 1, RS485, 115200"));
    assert!(bench.shows(&format!("{PORT}  FTDI FT232R A50285BI USB 0403:6001")));
    bench.click(&format!("Connect: {URL}"));
    assert_eq!(bench.state().scan.stage, ScanStage::Cancelled);
    bench.until(1000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
    });
    assert_eq!(
        bench.state().hand().connection.endpoint,
        Some(URL.parse().unwrap())
    );
    bench.run(200);
    assert!(bench.shows(&format!("Connected: {URL}")));
    assert!(bench.writes().is_empty());
}

#[test]
fn progress_is_shown_and_cancel_ends_it_with_what_was_found() {
    let mut bench = at_connection(SimConfig::default());
    bench.click("Ids: 1 to 254");
    bench.run(40);
    bench.click_button("Find hands");
    bench.run(400);
    let progress = bench.reading("Scan progress");
    // One hand answers at once, so that 253 further ids of its line are left of 2032 questions: 16 s.
    assert!(
        progress.contains("/ 2032 questions, time left about 16 s"),
        "{progress}"
    );
    bench.click_button("Cancel");
    bench.run(60);
    assert!(bench.shows("Cancelled. Hands that answered: 1"));
    let dials = bench.dials();
    bench.wait(5000);
    assert_eq!(bench.dials(), dials, "nothing is asked any more");
    assert!(bench.writes().is_empty());
}

#[test]
fn each_way_to_find_nothing_has_its_words() {
    let far = SimConfig {
        id: 99,
        ..SimConfig::default()
    };
    let mut bench = at_connection(far);
    assert!(!bench.texts_with("Nothing was scanned yet").is_empty());
    bench.click_button("Find hands");
    bench.until(8000, is_done);
    bench.run(40);
    assert!(
        !bench
            .texts_with("a hand may have an id above 10")
            .is_empty()
    );
    bench.list_ports(Vec::new());
    bench.click_button("Find hands");
    bench.until(1000, is_done);
    bench.run(40);
    assert!(
        !bench
            .texts_with("no serial port and no CAN interface")
            .is_empty()
    );
    bench.list_ports(vec![usb_port(PORT)]);
    bench.unplug();
    bench.click_button("Find hands");
    bench.until(1000, is_done);
    bench.run(40);
    assert!(bench.shows("Nothing could be scanned:"));
    assert!(!bench.texts_with("is not there").is_empty());
}

#[test]
fn the_port_of_the_connected_hand_is_left_alone_with_words() {
    let mut bench = at_connection(SimConfig::default());
    bench.click_button("Find hands");
    bench.until(1000, |bench| !bench.state().scan.found.is_empty());
    bench.click(&format!("Connect: {URL}"));
    bench.until(1000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
    });
    let dials = bench.dials();
    bench.click_button("Find hands");
    bench.until(1000, is_done);
    bench.run(40);
    assert!(!bench.texts_with("Disconnect first to scan it").is_empty());
    assert_eq!(bench.dials(), dials);
    assert_eq!(
        bench.state().hand().connection.status.state,
        LinkState::Monitoring
    );
}

#[test]
fn an_address_is_asked_only_when_the_button_is_pressed() {
    let mut bench = at_connection(SimConfig::default());
    let dials = bench.dials();
    for address in [
        "192.168.11.210:6000",
        "192.168.123.210:6000",
        "192.168.123.211:6000",
    ] {
        bench.click_button(address);
        bench.run(40);
        assert_eq!(bench.typed(ADDRESS), address);
    }
    bench.wait(3000);
    assert_eq!(bench.dials(), dials, "offering is not asking");
    assert_eq!(bench.state().scan.stage, ScanStage::Never);
    for (wrong, words) in [
        ("10.0.0.0/8", "more than 1024"),
        ("a b", "is not an address"),
    ] {
        bench.type_into(ADDRESS, wrong);
        assert!(bench.texts_with(words).is_empty(), "only once it is typed");
        bench.key(egui::Key::Enter);
        bench.run(40);
        assert!(!bench.texts_with(words).is_empty(), "{wrong}");
        assert!(!bench.shows("Scan"), "nothing to scan: {wrong}");
        assert_eq!(bench.state().scan.stage, ScanStage::Never);
    }
    bench.type_into(ADDRESS, "127.0.0.5:6001");
    bench.click_button("Disconnect");
    bench.run(200);
    bench.hand(SimHand::switch_off);
    bench.click_button("Scan");
    bench.until(20_000, is_done);
    assert_eq!(
        bench.dials(),
        dials + 12,
        "two units of one address, ten tries of a device server there, no port"
    );
    assert!(
        !bench
            .texts_with("Check power, cable and address")
            .is_empty()
    );
}

#[test]
fn in_a_small_window_all_scrolls_together() {
    let size = vec2(1024.0, 640.0);
    let mut bench = Bench::open(SimConfig::default(), size);
    bench.list_ports(vec![usb_port(PORT)]);
    bench.wait(200);
    bench.show(View::Connection);
    bench.run(60);
    bench.act(Action::Scan(ScanTarget::Ports(IdRange::Few)));
    bench.until(1000, |bench| !bench.state().scan.found.is_empty());
    assert!(bench.shows(&format!("Connect: {URL}")));
    check(&bench, size, "STOP", "scanning");
    bench.type_into(ADDRESS, "10.0.0.0/8");
    bench.key(egui::Key::Enter);
    check(&bench, size, "STOP", "a wrong address");
    assert!(bench.shows("Kind of link: RS485"));
}

#[test]
fn the_serial_port_that_was_typed_is_scanned_alone() {
    let mut bench = at_connection(SimConfig::default());
    bench.type_into(ADDRESS, "/dev/ttyUSB9");
    bench.click_button("Scan");
    bench.until(4000, |bench| !bench.state().scan.found.is_empty());
    let found = &bench.state().scan.found[0];
    assert_eq!(found.endpoint.port(), Some("/dev/ttyUSB9"));
    assert!(bench.writes().is_empty());
}

/// Tells on DDS of a hand of another Handscope until the window is as wanted.
#[cfg(target_os = "linux")]
fn told_until(
    bench: &mut Bench,
    (writer, hand): (&DdsWriter, &FleetHand),
    wanted: impl Fn(&Bench) -> bool,
) {
    let patience = Instant::now() + Duration::from_secs(20);
    while !wanted(bench) {
        assert!(Instant::now() < patience, "{:?}", bench.state().fleet);
        let _is_sent = writer.send(hand.message());
        bench.run(100);
        // Its way through the sockets takes real time.
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn hands_that_others_share_are_listed_once_a_person_looks_and_a_click_watches_one() {
    let mut bench = at_connection(SimConfig::default());
    assert_eq!(bench.state().fleet.interface(), None);
    let mut hand = FleetHand {
        card: FleetCard {
            host: "lab".into(),
            name: "their hand".into(),
            side: Side::Left,
            at: None,
            first_may_move: false,
            follows: false,
        },
        state: LinkState::Fault,
        owner: Some(Owner::Gamepad),
    };
    let (interface, domain) = ("127.0.0.1".into(), 0);
    let node = DdsNode::open(&DdsPlace { interface, domain }).unwrap();
    let other = node.writer(&fleet::topic());
    bench.type_into("Interface of DDS", "nowhere0");
    bench.click_button("Find hands");
    bench.run(100);
    assert!(!bench.texts_with("network interface nowhere0").is_empty());
    bench.click_button("Cancel");
    bench.run(60);
    bench.type_into("Interface of DDS", "127.0.0.1");
    bench.click_button("Find hands");
    bench.run(100);
    told_until(&mut bench, (&other, &hand), |bench| {
        bench.shows("their hand · lab")
    });
    assert!(bench.is_disabled(Role::Button, "Connect: their hand"));
    assert!(bench.shows("Left hand · moved by: Gamepad"));
    hand.card.at = "127.0.0.1:6111".parse().ok();
    hand.state = LinkState::Monitoring;
    // While ports are scanned, what is found moves the list.
    let is_open = |bench: &Bench| {
        let scans = bench.state().scan.stage == ScanStage::Running;
        !scans && !bench.is_disabled(Role::Button, "Connect: their hand")
    };
    told_until(&mut bench, (&other, &hand), is_open);
    bench.click("Connect: their hand");
    bench.run(100);
    let endpoint = bench.state().hand().connection.endpoint.clone();
    assert_eq!(endpoint, Some("tcp:127.0.0.1:6111".parse().unwrap()));
    assert!(bench.writes().is_empty());
    bench.run(2500);
    assert!(
        !bench.shows("their hand · lab"),
        "nobody tells of it any more"
    );
    bench.click_button("Stop looking");
    bench.run(100);
    assert_eq!(bench.state().fleet.interface(), None);
}

#[cfg(target_os = "linux")]
#[test]
fn a_hand_elsewhere_that_follows_on_dds_keeps_this_one_from_following_too() {
    let mut bench = Bench::live();
    let joined = InputAction::JoinDds(Some("127.0.0.1".into()));
    bench.act(Action::Input(joined));
    bench.show(View::Inputs);
    bench.run(100);
    let other = |bench: &Bench| {
        let view = bench.state().hand().inputs.dds_view.as_ref();
        view.and_then(|view| view.other.clone())
    };
    let (interface, domain) = ("127.0.0.1".into(), 0);
    let node = DdsNode::open(&DdsPlace { interface, domain }).unwrap();
    let writer = node.writer(&fleet::topic());
    let hand = FleetHand {
        card: FleetCard {
            host: "lab".into(),
            name: "first".into(),
            side: Side::Right,
            at: None,
            first_may_move: false,
            follows: true,
        },
        state: LinkState::Armed,
        owner: Some(Owner::Dds),
    };
    told_until(&mut bench, (&writer, &hand), |bench| other(bench).is_some());
    bench.click_button("Share: DDS");
    bench.run(60);
    assert_eq!(other(&bench).map(|card| card.name), Some("first".into()));
    assert!(bench.is_disabled(Role::Button, "Let it move the hand: DDS"));
    bench.act(Action::Input(InputAction::Grant(SourceKind::Dds)));
    bench.run(200);
    assert_eq!(bench.state().hand().connection.outside_owner(), None);
}

#[cfg(target_os = "linux")]
#[test]
fn the_window_tells_of_its_own_shared_hand_and_does_not_connect_to_it() {
    let mut bench = Bench::live();
    for action in [
        InputAction::Share("127.0.0.1:0".parse().ok()),
        InputAction::JoinDds(Some("127.0.0.1".into())),
    ] {
        bench.act(Action::Input(action));
    }
    bench.show(View::Connection);
    bench.run(100);
    bench.click_button("Find hands");
    let at = bench.state().hand().inputs.gateway_at;
    let is_own = |bench: &Bench| {
        let hands = &bench.state().fleet.hands;
        hands.iter().any(|hand| hand.card.at == at)
    };
    let patience = Instant::now() + Duration::from_secs(20);
    while !is_own(&bench) {
        assert!(Instant::now() < patience);
        bench.run(100);
        std::thread::sleep(Duration::from_millis(5));
    }
    let name = bench.state().hand().label.name.clone();
    assert!(
        bench
            .all_disabled(&format!("Connect: {name}"))
            .contains(&true)
    );
}

#[test]
fn while_an_address_is_typed_nobody_is_asked_and_another_hand_keeps_what_was_typed() {
    let mut bench = at_connection(SimConfig::default());
    let dials = bench.dials();
    for typed in ["1", "192.168.11.9", "/dev/ttyUSB7", "can0", "hand.local"] {
        bench.type_into(ADDRESS, typed);
        bench.run(500);
    }
    assert_eq!(bench.dials(), dials);
    bench.click_button("Add a hand");
    bench.run(100);
    assert_eq!(bench.state().hands.count(), 2);
    assert_eq!(bench.typed(ADDRESS), "hand.local");
    assert!(bench.is_focused(ADDRESS), "Enter connects");
}

#[test]
fn the_day_of_the_last_connection_is_remembered_with_the_hand() {
    let mut bench = at_connection(SimConfig::default());
    bench.type_into(ADDRESS, PORT);
    bench.key(egui::Key::Enter);
    bench.until(1000, |bench| {
        bench.state().hand().connection.status.state == LinkState::Monitoring
    });
    let endpoint = URL.parse().unwrap();
    let day = bench.state().settings.last_day(&endpoint).unwrap();
    assert_eq!(day.len(), "2026-11-24".len(), "{day}");
    assert!(bench.writes().is_empty());
}

#[test]
fn figures_of_the_link_are_in_a_drawer_and_their_columns_apart() {
    let mut bench = at_connection(SimConfig::default());
    assert!(!bench.shows("Checksum errors"));
    assert!(bench.texts_with("Motion state ").len() == 1, "in one line");
    bench.open_drawer("Details");
    assert!(bench.shows("Checksum errors"));
    let labels = bench.all(Role::Label);
    let place = |name: &str| {
        let mut named = labels.iter().filter(|(own, _)| own == name);
        named.next().unwrap_or_else(|| panic!("{name}")).1
    };
    for group in ["Angles, forces", "Temperatures", "Setpoints"] {
        let now = place(&format!("{group}: now"));
        let share = place(&format!("{group}: of its time"));
        let most = place(&format!("{group}: at most"));
        assert!(now.right() + 8.0 <= share.left(), "{now} {share}");
        assert!(share.right() + 8.0 <= most.left(), "{share} {most}");
    }
}
