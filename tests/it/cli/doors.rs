//! Bad input at each door of the program: every cause has its own sentence, soon, and exit status 1.

use crate::setup::busy::unless_busy;
use crate::setup::process::{run, sim_on_link, sim_on_rtu, start};
use nix::sys::socket::{
    AddressFamily, Backlog, SockFlag, SockType, SockaddrIn, bind, getsockname, listen, socket,
};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::fd::{AsRawFd as _, OwnedFd};
use std::time::Duration;

/// The program gives up after three seconds by its own limits; the rest is for a machine with other work.
const SOON: Duration = Duration::from_secs(12);

/// What is said through each door that opens a hand.
fn check(hand: &str, part: &str) {
    let folder = tempfile::tempdir().unwrap();
    let pictures = folder.path().join("pictures");
    let out = pictures.to_str().unwrap();
    for door in [
        &["watch", "--hand", hand][..],
        &["read", "HAND_ID", "--hand", hand],
        &["doctor", "--for", "1", "--hand", hand],
        &["snapshot", "--at", "1", "--out", out, "--hand", hand],
    ] {
        let ended = run(door);
        let said = format!("{}{}", ended.out, ended.err);
        assert_eq!(ended.code, Some(1), "{door:?}: {said}");
        assert!(said.contains(part), "{door:?}: {said}");
        assert!(!said.contains("no device"), "{door:?}: {said}");
        assert!(ended.took < SOON, "{door:?}: {:?}", ended.took);
    }
}

#[test]
fn a_port_that_is_none_is_told_from_one_that_is_not_there() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        for kind in ["rs485", "rtu", "slcan", "usbcan"] {
            check(&format!("{kind}:{}", place("")), "is not a serial port");
            check(
                &format!("{kind}:{}", place("ttyUSB0")),
                "is not there: plug",
            );
        }
    });
}

#[test]
fn a_missing_can_interface_is_named() {
    unless_busy(|| {
        let part = if cfg!(target_os = "linux") {
            "there is no CAN interface nocan7"
        } else {
            "need Linux"
        };
        check("can:nocan7", part);
    });
}

#[test]
fn a_wrong_id_and_a_wrong_baud_are_told_apart() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let link = |name: &str| folder.path().join(name);
        let (_one, rs485) = sim_on_link(&link("hand"), &["--id", "7", "--baud", "115200"]);
        let (_other, rtu) = sim_on_rtu(&link("rtu"), &["--id", "7", "--baud", "921600"]);
        run(&["read", "HAND_ID", "--hand", &format!("{rs485}?id=7")]).ok();
        run(&[
            "read",
            "HAND_ID",
            "--hand",
            &format!("{rtu}?id=7&baud=921600"),
        ])
        .ok();
        check(&format!("{rs485}?id=2"), "no answer from id 2");
        check(&format!("{rtu}?id=2&baud=921600"), "no answer from id 2");
        for wrong in [format!("{rs485}?id=7&baud=57600"), format!("{rtu}?id=7")] {
            check(&wrong, "something answers on");
            check(&wrong, "handscope scan");
        }
    });
}

/// A listener whose queue is full: what comes now gets no answer at all.
fn full() -> (OwnedFd, SocketAddr, TcpStream) {
    let inet = AddressFamily::Inet;
    let listener = socket(inet, SockType::Stream, SockFlag::empty(), None).unwrap();
    bind(listener.as_raw_fd(), &SockaddrIn::new(127, 0, 0, 1, 0)).unwrap();
    listen(&listener, Backlog::new(0).unwrap()).unwrap();
    let at: SockaddrIn = getsockname(listener.as_raw_fd()).unwrap();
    let address = SocketAddr::from((at.ip(), at.port()));
    let waiting = TcpStream::connect(address).unwrap();
    (listener, address, waiting)
}

#[test]
fn hosts_that_refuse_stay_silent_or_never_answer_have_their_own_words() {
    unless_busy(|| {
        let closed = TcpListener::bind("127.0.0.1:0").unwrap();
        let refused = closed.local_addr().unwrap();
        drop(closed);
        check(&format!("tcp:{refused}"), "refused the connection");
        // The system takes the connection in the listener's name; nobody ever reads it.
        let mute = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = mute.local_addr().unwrap();
        check(
            &format!("tcp:{address}"),
            "takes the connection, but nothing there answers as unit 255",
        );
        if cfg!(target_os = "linux") {
            let (_listener, address, _waiting) = full();
            check(&format!("tcp:{address}"), "did not answer within 2000 ms");
        }
    });
}

#[cfg(target_os = "linux")]
#[test]
fn a_port_in_use_names_the_program_and_its_process() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let (_sim, hand) = sim_on_link(&folder.path().join("hand"), &[]);
        let mut holder = start(&["watch", "--json", "--hand", &hand]);
        holder.until(|line| line.contains("\"angle\""));
        check(
            &hand,
            &format!("is in use by handscope (process {})", holder.id()),
        );
        holder.kill();
        run(&["read", "HAND_ID", "--hand", &hand]).ok();
    });
}
