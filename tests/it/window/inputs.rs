//! Inputs in the window: nothing listens before a person says so, a program that sends moves nothing before a person lets it, and
//! every view says who does and ends it.

use crate::setup::window::{ANGLE_SET, Bench, Role};
use handscope::hand::Dof;
use handscope::link::Owner;
use handscope::record::LinkState;
use handscope::ui::View;
use std::net::{SocketAddr, TcpStream, UdpSocket};

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
    bench.click_button("Let it move the hand");
    send(&mut bench, &sender, to, 1500);
    let hand = bench.state().hand();
    assert_eq!(hand.link.state, LinkState::Armed);
    let from = sender.local_addr().unwrap();
    assert_eq!(hand.outside_owner(), Some(Owner::Stream(from)));
    assert!(
        (bench.angle(Dof::Index) - open).abs() > 20,
        "{}",
        bench.angle(Dof::Index)
    );
    // Its sliders are not a person's now.
    assert!(bench.is_disabled(Role::Slider, "Index angle target"));
    for view in [View::Live, View::Traffic, View::Connection] {
        bench.show(view);
        send(&mut bench, &sender, to, 100);
        assert!(!bench.texts_with(&from.to_string()).is_empty(), "{view:?}");
    }
    bench.click_button("STOP");
    send(&mut bench, &sender, to, 1500);
    let hand = bench.state().hand();
    assert_eq!((hand.outside_owner(), hand.link.armed), (None, None));
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
        bench.click_button("Let it move the hand");
        send(&mut bench, &sender, to, 500);
        assert!(bench.state().hand().outside_owner().is_some());
        if ends_by_click {
            bench.click_button("Take back");
            send(&mut bench, &sender, to, 1200);
        } else {
            bench.run(2500);
        }
        let hand = bench.state().hand();
        assert_eq!((hand.outside_owner(), hand.link.armed), (None, None));
    }
    assert!(!bench.texts_with("fell silent").is_empty());
}

#[test]
fn nothing_listens_before_a_person_says_so_or_after_the_hand_is_left() {
    let mut bench = Bench::live();
    assert!(!bench.state().hand().inputs.is_open());
    bench.show(View::Inputs);
    bench.run(100);
    bench.type_into("Address of the gateway", "127.0.0.1:0");
    bench.click_button("Share");
    bench.run(200);
    let at = bench.state().hand().inputs.gateway_at.unwrap();
    assert!(TcpStream::connect(at).is_ok());
    bench.show(View::Connection);
    bench.run(100);
    bench.click_button("Disconnect");
    bench.run(1500);
    assert!(!bench.state().hand().inputs.is_open());
    assert!(TcpStream::connect(at).is_err());
}
