//! A wire between a hand and a program that notes all that passes, with its time. Claims nothing.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};

/// What passed over one connection.
#[derive(Debug, Default)]
pub(super) struct Connection {
    /// Bytes to the hand.
    pub(super) asked: Vec<u8>,
    /// Bytes from the hand, before the program could have them.
    pub(super) answered: Vec<u8>,
    /// How many bytes the hand had sent at which time, in nanoseconds of [`nanos_now`].
    pub(super) times: Vec<(u64, usize)>,
}

/// One connection after the other.
pub(super) type Journal = Arc<Mutex<Vec<Connection>>>;

/// Nanoseconds of a clock that all programs of this machine share and nobody sets.
pub(super) fn nanos_now() -> u64 {
    let now = nix::time::clock_gettime(nix::time::ClockId::CLOCK_MONOTONIC);
    u64::try_from(Duration::from(now.unwrap()).as_nanos()).unwrap()
}

/// Passes on what programs and the hand at this address say to each other.
pub(super) async fn pass_on(listener: TcpListener, hand: SocketAddr, journal: Journal) {
    while let Ok((program, _)) = listener.accept().await {
        let hand = TcpStream::connect(hand).await.unwrap();
        program.set_nodelay(true).unwrap();
        hand.set_nodelay(true).unwrap();
        let number = {
            let mut all = journal.lock().unwrap();
            all.push(Connection::default());
            all.len() - 1
        };
        tokio::spawn(both_ways(program, hand, Arc::clone(&journal), number));
    }
}

async fn both_ways(mut program: TcpStream, mut hand: TcpStream, journal: Journal, number: usize) {
    let (mut asked, mut answered) = ([0; 2048], [0; 2048]);
    loop {
        tokio::select! {
            read = program.read(&mut asked) => {
                let Ok(len @ 1..) = read else { return };
                journal.lock().unwrap()[number].asked.extend(&asked[..len]);
                if hand.write_all(&asked[..len]).await.is_err() {
                    return;
                }
            }
            read = hand.read(&mut answered) => {
                let Ok(len @ 1..) = read else { return };
                {
                    let connection = &mut journal.lock().unwrap()[number];
                    connection.answered.extend(&answered[..len]);
                    let sent = connection.answered.len();
                    connection.times.push((nanos_now(), sent));
                }
                if program.write_all(&answered[..len]).await.is_err() {
                    return;
                }
            }
        }
    }
}

/// What the hand said to stand from this address on.
#[derive(Debug, PartialEq)]
pub(super) struct Said {
    pub(super) address: u16,
    pub(super) bytes: Vec<u8>,
}

impl Said {
    /// The bytes of a part of it.
    pub(super) fn part(&self, address: u16, len: u16) -> Option<&[u8]> {
        let from = usize::from(address.checked_sub(self.address)?);
        self.bytes.get(from..from + usize::from(len))
    }
}

/// Messages of Modbus TCP: transaction, function, and what follows it (manual 2.5).
fn messages(mut bytes: &[u8]) -> Vec<(u16, u8, &[u8])> {
    let mut all = Vec::new();
    while bytes.len() >= 8 {
        let len = usize::from(u16::from_be_bytes([bytes[4], bytes[5]]));
        let Some(rest) = bytes.get(6 + len..) else {
            break;
        };
        let transaction = u16::from_be_bytes([bytes[0], bytes[1]]);
        all.push((transaction, bytes[7], &bytes[8..6 + len]));
        bytes = rest;
    }
    all
}

impl Connection {
    /// What the hand answered to reads, in its order. Reckoned here anew, not by the program's decoder.
    pub(super) fn said(&self) -> Vec<Said> {
        let mut asked = messages(&self.asked).into_iter();
        let mut said = Vec::new();
        for (transaction, function, body) in messages(&self.answered) {
            let request = asked.find(|(number, _, _)| *number == transaction);
            let (_, _, request) = request.expect("each reply has its request");
            if function == 3 || function == 4 {
                let words = body[1..].chunks_exact(2);
                said.push(Said {
                    address: u16::from_be_bytes([request[0], request[1]]),
                    bytes: words.flat_map(|word| [word[1], word[0]]).collect(),
                });
            }
        }
        said
    }
}
