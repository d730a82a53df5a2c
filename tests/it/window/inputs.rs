//! Inputs in the window: nothing listens before a person says so, a program that sends moves nothing before a person lets it, and
//! every view says who does and ends it.

use crate::setup::window::{ANGLE_SET, Bench, Role};
use egui::Key;
use handscope::app::action::Action;
use handscope::app::inputs::InputAction;
use handscope::app::settings::Language;
use handscope::app::settings::Settings;
use handscope::hand::{Angle, Dof, Moment};
use handscope::link::Owner;
use handscope::record::LinkState;
use handscope::sim::SimConfig;
use handscope::ui::View;
use std::io::Write as _;
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::time::{Duration, Instant};

/// Listens for datagrams on a free port, as a person does it; where that is.
fn listening(bench: &mut Bench) -> SocketAddr {
    bench.show(View::Inputs);
    bench.run(100);
    let free = UdpSocket::bind("127.0.0.1:0").unwrap();
    let at = free.local_addr().unwrap();
    drop(free);
    bench.type_into("Address for lines", &at.to_string());
    bench.click_button("Listen");
    bench.run(200);
    assert_eq!(bench.state().hand().inputs.stream_at, Some(at));
    at
}

/// Sends a line each 20 ms for a while.
fn send(bench: &mut Bench, sender: &UdpSocket, to: SocketAddr, ms: u64) {
    for n in 0..ms / 20 {
        let index = 0.6 + f64::from(u32::try_from(n % 10).unwrap()) / 1000.0;
        let line = format!(r#"{{"right":[null,null,null,{index},null,null]}}"#);
        sender.send_to(line.as_bytes(), to).unwrap();
        bench.run(20);
    }
}

#[test]
fn a_program_moves_the_hand_only_once_a_person_lets_it_and_every_view_ends_it() {
    let mut bench = Bench::live();
    let to = listening(&mut bench);
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    let open = bench.angle(Dof::Index);
    send(&mut bench, &sender, to, 600);
    assert!(bench.state().hand().inputs.stream_view.not_granted > 5);
    assert_eq!(bench.writes(), []);
    assert!(
        !bench
            .texts_with(&format!("Hz from {}", sender.local_addr().unwrap()))
            .is_empty()
    );
    bench.click_button("Let it move the hand: Another program");
    send(&mut bench, &sender, to, 1500);
    assert!(bench.shows("moves the hand"));
    assert!(
        bench
            .buttons_with("Let it move the hand: Another program")
            .is_empty()
    );
    let hand = bench.state().hand();
    assert_eq!(hand.connection.status.state, LinkState::Armed);
    let from = sender.local_addr().unwrap();
    assert_eq!(hand.connection.outside_owner(), Some(Owner::Stream(from)));
    assert!(
        (bench.angle(Dof::Index) - open).abs() > 20,
        "{}",
        bench.angle(Dof::Index)
    );
    // Its sliders are not a person's now.
    bench.show(View::Live);
    send(&mut bench, &sender, to, 100);
    assert!(bench.is_disabled(Role::Slider, "Index angle target"));
    for view in [View::Live, View::Traffic, View::Connection] {
        bench.show(view);
        send(&mut bench, &sender, to, 100);
        assert!(!bench.texts_with(&from.to_string()).is_empty(), "{view:?}");
    }
    bench.click_button("STOP");
    send(&mut bench, &sender, to, 1500);
    let hand = bench.state().hand();
    assert_eq!(
        (
            hand.connection.outside_owner(),
            hand.connection.status.armed
        ),
        (None, None)
    );
    let before = bench.writes().len();
    send(&mut bench, &sender, to, 500);
    assert_eq!(bench.writes().len(), before, "nothing after a stop");
    assert!(
        bench
            .writes()
            .iter()
            .any(|write| write.address == ANGLE_SET)
    );
}

#[test]
fn take_back_stops_the_hand_and_silence_is_told() {
    let mut bench = Bench::live();
    let to = listening(&mut bench);
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    for ends_by_click in [true, false] {
        send(&mut bench, &sender, to, 300);
        bench.click_button("Let it move the hand: Another program");
        send(&mut bench, &sender, to, 500);
        assert!(bench.state().hand().connection.outside_owner().is_some());
        if ends_by_click {
            bench.click_button("Take back");
            send(&mut bench, &sender, to, 1200);
        } else {
            bench.run(2500);
        }
        let hand = bench.state().hand();
        assert_eq!(
            (
                hand.connection.outside_owner(),
                hand.connection.status.armed
            ),
            (None, None)
        );
    }
    assert!(!bench.texts_with("fell silent").is_empty());
}

#[test]
fn nothing_listens_before_a_person_says_so_or_after_the_hand_is_left() {
    let mut bench = Bench::live();
    assert!(!bench.state().hand().inputs.is_open());
    bench.show(View::Inputs);
    bench.run(100);
    bench.click_button("Share: Gateway");
    bench.run(60);
    bench.type_into("Address of the gateway", "127.0.0.1:0");
    bench.click_button("Open the gateway");
    bench.run(200);
    let at = bench.state().hand().inputs.gateway_at.unwrap();
    assert!(TcpStream::connect(at).is_ok());
    let free = "127.0.0.1:0".parse().unwrap();
    bench.act(Action::Input(InputAction::Show(Some(free))));
    bench.click_button("Join");
    bench.run(200);
    let inputs = &bench.state().hand().inputs;
    let (viewed, viewers) = inputs.foxglove_at.unwrap();
    assert!(viewers == 0 && TcpStream::connect(viewed).is_ok());
    assert!(inputs.dds_view.as_ref().unwrap().at.is_loopback());
    assert!(!bench.is_disabled(Role::Button, "Join"));
    assert!(bench.is_disabled(Role::Button, "Let it move the hand: DDS"));
    bench.show(View::Connection);
    bench.run(100);
    // A badge in every view leads to where it can be ended.
    bench.click_button("Shared · DDS");
    bench.run(100);
    assert_eq!(bench.view(), View::Inputs);
    bench.show(View::Connection);
    bench.run(100);
    bench.click_button("Disconnect");
    bench.run(1500);
    assert!(!bench.state().hand().inputs.is_open());
    assert!(bench.buttons_with("Shared").is_empty());
    assert!(TcpStream::connect(at).is_err());
    assert!(TcpStream::connect(viewed).is_err());
    assert!(bench.state().hand().inputs.dds_view.is_none());
}

/// When the first angle was written that holds the joints, after this moment.
fn held_after(bench: &Bench, at: Moment) -> Moment {
    let writes = bench.writes();
    let mut holds = writes.iter().filter(|write| write.address == ANGLE_SET);
    holds.find(|write| write.at >= at).unwrap().at
}

#[test]
fn with_hold_to_run_the_hand_moves_only_while_the_key_is_held() {
    let mut bench = Bench::live();
    bench.act(Action::HoldToRun(true));
    bench.run(100);
    assert!(bench.is_disabled(Role::Button, "Hold H"));
    assert!(!bench.shows("Arm the hand"));
    for ends in ["let go", "lost focus", "hung"] {
        bench.key_down(Key::H);
        bench.run(1500);
        assert!(bench.state().hand().connection.is_armed(), "{ends}");
        let to = Angle::nearest(100);
        bench.act(Action::Target(Dof::Index, to));
        bench.run(100);
        let let_go = bench.now();
        match ends {
            "let go" => bench.key_up(Key::H),
            "lost focus" => bench.lose_focus(),
            _ => bench.hang(600),
        }
        let within = if ends == "hung" { 350 } else { 50 };
        bench.key_up(Key::H);
        bench.run(100);
        let held = held_after(&bench, let_go).since(let_go);
        assert!(held <= Duration::from_millis(within), "{ends}: {held:?}");
        let hand = bench.state().hand();
        assert_eq!(hand.connection.status.armed, None, "{ends}");
        bench.run(1500);
        let away = (bench.angle(Dof::Index) - to.get()).abs();
        assert!(away > 100, "{ends}: it went on to {away}");
    }
}

#[test]
fn while_hold_to_run_is_on_the_button_says_which_key_arms() {
    let mut bench = Bench::live();
    assert!(!bench.is_disabled(Role::Button, "Arm the hand"));
    bench.act(Action::HoldToRun(true));
    bench.run(100);
    assert!(bench.is_disabled(Role::Button, "Hold H"));
    let button = bench.rect(Role::Button, "Hold H");
    bench.point(button.center());
    bench.run(1000);
    assert!(!bench.texts_with("holding the H key arms").is_empty());
    bench.point_away();
    bench.click("Go to Thumbs up");
    bench.run(100);
    assert!(bench.shows("Hold the H key: hold to run is on."));
    assert!(!bench.shows("Not armed: press Arm first."));
    bench.key_down(Key::H);
    bench.run(300);
    assert!(!bench.is_disabled(Role::Button, "Disarm the hand"));
    bench.key_up(Key::H);
    bench.run(1000);
    bench.act(Action::Language(Language::Zh));
    bench.run(100);
    assert!(bench.is_disabled(Role::Button, "按住 H"));
    bench.act(Action::HoldToRun(false));
    bench.run(100);
    assert!(!bench.is_disabled(Role::Button, "使能灵巧手"));
}

#[test]
fn a_stop_while_the_key_is_held_is_not_undone_by_it() {
    let mut bench = Bench::live();
    bench.act(Action::HoldToRun(true));
    bench.run(100);
    bench.key_down(Key::H);
    bench.run(300);
    assert!(bench.state().hand().connection.is_armed());
    bench.click_button("STOP");
    bench.run(3000);
    assert!(!bench.state().hand().connection.is_armed());
    bench.key_up(Key::H);
    bench.key_down(Key::H);
    bench.run(300);
    assert!(bench.state().hand().connection.is_armed(), "pressed anew");
}

#[test]
fn a_program_too_moves_the_hand_only_while_the_key_is_held() {
    let mut bench = Bench::live();
    bench.act(Action::HoldToRun(true));
    let to = listening(&mut bench);
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    send(&mut bench, &sender, to, 300);
    bench.click_button("Let it move the hand: Another program");
    send(&mut bench, &sender, to, 600);
    let owner = Some(Owner::Stream(sender.local_addr().unwrap()));
    assert_eq!(bench.state().hand().connection.outside_owner(), owner);
    assert_eq!(bench.writes(), [], "not held yet");
    for _ in 0..2 {
        bench.key_down(Key::H);
        send(&mut bench, &sender, to, 1500);
        assert!(bench.state().hand().connection.is_armed());
        bench.key_up(Key::H);
        send(&mut bench, &sender, to, 1500);
        let hand = bench.state().hand();
        assert_eq!(
            (
                hand.connection.status.armed,
                hand.connection.outside_owner()
            ),
            (None, owner)
        );
        let before = bench.writes().len();
        send(&mut bench, &sender, to, 500);
        assert_eq!(bench.writes().len(), before);
    }
}

#[test]
fn the_first_client_moves_the_hand_only_where_the_settings_file_says_so() {
    for allows in [false, true] {
        let mut bench = Bench::with(Settings {
            first_client_moves: allows,
            ..Settings::default()
        });
        bench.wait(1000);
        bench.show(View::Inputs);
        bench.run(60);
        bench.click_button("Share: Gateway");
        bench.act(Action::Input(InputAction::Share(
            "127.0.0.1:0".parse().ok(),
        )));
        bench.run(200);
        let told = bench.texts_with("The first client that writes may move the hand");
        assert_eq!(told.is_empty(), !allows);
        let at = bench.state().hand().inputs.gateway_at.unwrap();
        let mut client = TcpStream::connect(at).unwrap();
        // One register of Modbus TCP: the index finger, to 700.
        let write = [0, 1, 0, 0, 0, 6, 255, 6, 0x05, 0xD4, 0x02, 0xBC];
        client.write_all(&write).unwrap();
        let patience = Instant::now() + Duration::from_secs(20);
        let is_answered = |bench: &Bench| {
            let clients = &bench.state().hand().inputs.clients;
            clients.iter().any(|client| client.refusal.is_some())
                || bench.state().hand().connection.outside_owner().is_some()
        };
        while !is_answered(&bench) {
            assert!(Instant::now() < patience);
            bench.run(100);
            std::thread::sleep(Duration::from_millis(5));
        }
        bench.run(500);
        assert_eq!(
            bench.state().hand().connection.outside_owner().is_some(),
            allows
        );
        assert_eq!(bench.writes().is_empty(), !allows);
    }
}

#[test]
fn a_switch_shows_that_it_is_on_and_ends_where_it_began() {
    let mut bench = Bench::live();
    listening(&mut bench);
    assert!(bench.is_on("Listen") && !bench.is_on("Open the gateway"));
    bench.click_button("Listen");
    bench.run(200);
    assert!(!bench.is_on("Listen"));
    assert_eq!(bench.state().hand().inputs.stream_at, None);
}

#[test]
fn each_source_has_its_switch_in_the_list_and_the_chosen_one_its_settings() {
    for size in [egui::vec2(1024.0, 640.0), egui::vec2(2560.0, 1440.0)] {
        let mut bench = Bench::open(SimConfig::default(), size);
        bench.wait(1000);
        bench.show(View::Inputs);
        bench.run(200);
        let switches = ["Listen", "Join", "Read gamepad", "Open the gateway", "Show"];
        let places = switches.map(|name| bench.rects(name)[0]);
        for pair in places.windows(2) {
            assert!(pair[0].left() == pair[1].left() && pair[0].bottom() < pair[1].top());
        }
        let settings = [
            ("Another program", "Address for lines"),
            ("DDS", "Interface of DDS"),
            ("Gateway", "Address of the gateway"),
            ("Live viewers", "Address for viewers"),
        ];
        for (source, field) in settings {
            bench.click_button(&format!("Share: {source}"));
            bench.run(60);
            for (_, other) in settings {
                assert_eq!(bench.shows(other), other == field, "{source}: {other}");
            }
        }
        assert!(!bench.state().hand().inputs.is_open());
    }
}

#[test]
fn without_a_gamepad_neither_its_picture_nor_its_list_is_there() {
    let mut bench = Bench::live();
    bench.show(View::Inputs);
    bench.run(100);
    bench.click_button("Share: Gamepad");
    bench.run(60);
    assert!(!bench.texts_with("Plug a gamepad in").is_empty());
    assert!(bench.all(Role::ComboBox).is_empty());
    assert!(!bench.shows("A (bottom): Pose Pinch"));
    assert!(bench.is_disabled(Role::Button, "Let it move the hand: Gamepad"));
}

#[test]
fn the_exhibition_is_started_from_its_card() {
    let mut bench = Bench::live();
    bench.show(View::Inputs);
    bench.run(100);
    bench.click_button("Share: Exhibition");
    bench.run(60);
    bench.click_button("Start the exhibition");
    bench.run(200);
    assert!(bench.state().exhibit.is_some());
}

#[test]
fn lines_that_are_all_refused_are_not_called_silence() {
    let mut bench = Bench::live();
    let to = listening(&mut bench);
    assert!(bench.shows("No sender now."));
    let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
    for _ in 0..20 {
        let line = br#"{"left":[null,null,null,0.6,null,null]}"#;
        sender.send_to(line, to).unwrap();
        bench.run(20);
    }
    let refused = &bench.state().hand().inputs.stream_view.intake.refused;
    assert!(refused.values().sum::<u64>() > 5, "{refused:?}");
    assert!(bench.shows("Lines arrive, and each is refused."));
    bench.wait(5000);
    assert!(bench.shows("No sender now."), "{:?}", bench.texts());
}
