//! Modbus TCP between the program and a simulated hand: a test decides what becomes of each request. Claims nothing.

use std::io::{self, Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread;

/// One request: whether it writes, and the first byte's address.
pub(crate) type Asked = (bool, u16);

/// What becomes of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fate {
    /// The hand gets it, and its answer comes.
    Passed,
    /// It is acknowledged, and the hand never hears of it.
    Ignored,
    /// The answer is that the hand does not do it.
    Refused,
}

/// The endpoint of a hand behind this wire.
pub(crate) fn between(hand: &str, fate: impl FnMut(Asked) -> Fate + Send + 'static) -> String {
    let hand = hand.strip_prefix("tcp:").unwrap().to_owned();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let endpoint = format!("tcp:{}", listener.local_addr().unwrap());
    let fate = Arc::new(Mutex::new(fate));
    thread::spawn(move || {
        for ours in listener.incoming() {
            let (Ok(ours), Ok(theirs)) = (ours, TcpStream::connect(&hand)) else {
                return;
            };
            let fate = Arc::clone(&fate);
            // It ends with either side.
            thread::spawn(move || carry(ours, theirs, |asked| (fate.lock().unwrap())(asked)));
        }
    });
    endpoint
}

fn carry(
    mut ours: TcpStream,
    mut theirs: TcpStream,
    mut fate: impl FnMut(Asked) -> Fate,
) -> io::Result<()> {
    ours.set_nodelay(true)?;
    theirs.set_nodelay(true)?;
    loop {
        let asked = message(&mut ours)?;
        let (head, pdu) = asked.split_at(7);
        let address = u16::from_be_bytes([pdu[1], pdu[2]]);
        let answer = match fate((pdu[0] != 3, address)) {
            Fate::Passed => {
                theirs.write_all(&asked)?;
                message(&mut theirs)?
            }
            Fate::Ignored => framed(head, &pdu[..5]),
            Fate::Refused => framed(head, &[pdu[0] | 0x80, 4]),
        };
        ours.write_all(&answer)?;
    }
}

fn message(from: &mut TcpStream) -> io::Result<Vec<u8>> {
    let mut message = vec![0; 7];
    from.read_exact(&mut message)?;
    let len = usize::from(u16::from_be_bytes([message[4], message[5]]));
    message.resize(6 + len, 0);
    from.read_exact(&mut message[7..])?;
    Ok(message)
}

fn framed(head: &[u8], pdu: &[u8]) -> Vec<u8> {
    let len = u16::try_from(pdu.len() + 1).unwrap().to_be_bytes();
    [&head[..4], &len, &head[6..7], pdu].concat()
}
