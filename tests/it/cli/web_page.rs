//! What a page in a browser can send to each socket of the program: an HTTP request with messages in its body. It moves nothing and
//! writes nothing, and its connection ends.

use crate::cli::follow::{phase, setpoint};
use crate::setup::busy::unless_busy;
use crate::setup::process::{Running, run, sim_on_tcp, start};
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

/// Twenty times each, so that whoever reads on finds some.
const MESSAGES: usize = 20;

/// Lines that ask for a fist.
fn lines() -> Vec<u8> {
    "{\"right\":[0,0,0,0,0,0]}\n".repeat(MESSAGES).into_bytes()
}

/// Function 16 to ANGLE_SET: a fist.
fn requests() -> Vec<u8> {
    let head = [
        0,
        1,
        0,
        0,
        0,
        19,
        255,
        16,
        1486_u16.to_be_bytes()[0],
        1486_u16.to_be_bytes()[1],
        0,
        6,
        12,
    ];
    [&head[..], &[0; 12]].concat().repeat(MESSAGES)
}

/// Sends that as a form, whole and then again without a head; true if the other side ends the connection.
fn post(address: &str, body: &[u8]) -> bool {
    let mut page = TcpStream::connect(address).unwrap();
    page.set_read_timeout(Some(Duration::from_secs(20)))
        .unwrap();
    let len = body.len();
    let head = format!(
        "POST / HTTP/1.1\r\nHost: {address}\r\nOrigin: http://example.org\r\nContent-Type: text/plain\r\nContent-Length: {len}\r\n\r\n"
    );
    page.write_all(&[head.as_bytes(), body].concat()).unwrap();
    // It may be closed already.
    let _closed = page.write_all(body);
    let mut said = Vec::new();
    match page.read_to_end(&mut said) {
        Ok(_) => true,
        Err(error) => matches!(
            error.kind(),
            ErrorKind::ConnectionReset | ErrorKind::BrokenPipe
        ),
    }
}

/// Starts a server; where it is.
fn serve(args: &[&str], ready: &str) -> (Running, String) {
    let mut running = start(args);
    let line = running.line();
    let address = line.strip_prefix(ready).expect(&line).trim().to_owned();
    (running, address)
}

#[test]
fn a_web_page_moves_no_hand_through_any_socket_of_the_program() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let recorded = folder.path().join("rest.mcap");
        let recorded = recorded.to_str().unwrap();
        run(&[
            "record", "--hand", "sim:", "--for", "0.5", "--out", recorded,
        ])
        .ok();
        let (_sim, hand) = sim_on_tcp(&["--scenario", "free"]);
        let own = hand.strip_prefix("tcp:").unwrap().to_owned();
        let before = setpoint(&hand);
        let any = "127.0.0.1:0";
        let follow = ["follow", "--hand", &hand, "--arm", "--json", "--tcp", any];
        let share = ["share", "--hand", &hand, "--writers", "--tcp", any];
        let show = ["share", "--hand", &hand, "--foxglove", any];
        let replay = ["replay", recorded, "--tcp", any];
        for (args, ready, body) in [
            (&follow[..], "ready tcp ", lines()),
            (&share, "ready tcp ", requests()),
            (&show, "ready foxglove ", lines()),
            (&replay, "ready tcp ", requests()),
        ] {
            let (mut running, address) = serve(args, ready);
            for _ in 0..3 {
                assert!(post(&address, &body), "{args:?} goes on to listen");
            }
            if args == follow {
                let told = running.until(|line| line.contains("malformed\":3"));
                assert!(told.contains("\"taken\":0"), "{told}");
                assert_eq!(phase(&told), "waiting");
            }
            drop(running);
            assert_eq!(setpoint(&hand), before, "{args:?}");
        }
        assert!(post(&own, &requests()), "the simulated hand");
        assert_eq!(setpoint(&hand), before);
        // The same without a head is what moves a hand: the bodies are good.
        let (mut running, address) = serve(&follow, "ready tcp ");
        let mut sender = TcpStream::connect(address).unwrap();
        sender.write_all(&lines()).unwrap();
        running.until(|line| phase(line) == "following" || line.contains("\"taken\":20"));
        running.signal(nix::sys::signal::Signal::SIGINT);
        running.end().ok();
        let mut client = TcpStream::connect(&own).unwrap();
        client.write_all(&requests()).unwrap();
        client.read_exact(&mut [0; 12 * MESSAGES]).unwrap();
        assert_eq!(setpoint(&hand), 0);
    });
}
