//! A stop is the most tolerant input: every odd spelling of it at every door that takes text, over real sockets.

use crate::inputs::stream::{free, open, until};
use handscope::inputs::stream::{StreamPlace, StreamSource};
use std::io::{Read as _, Write as _};
use std::net::{Shutdown, TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

const GOOD: &[u8] = b"{\"right\":[1,1,1,1,1,1]}";

include!("../../odd_stops.rs");

/// Waits until the hand was stopped so often.
async fn stopped(stops: &Arc<AtomicU64>, times: u64, by: &[u8]) {
    let patience = Instant::now() + Duration::from_secs(10);
    while stops.load(Ordering::Relaxed) < times {
        let text = String::from_utf8_lossy(by);
        assert!(Instant::now() < patience, "no stop by {text}");
        tokio::time::sleep(Duration::from_millis(1)).await;
    }
}

fn count(source: &StreamSource) -> u64 {
    source.view().intake.taken
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_datagram_stops_the_hand_in_every_spelling_from_whoever_sends_it() {
    let stops = Arc::default();
    let source = open(StreamPlace::Udp(free()), &stops);
    let (mover, button) = (
        UdpSocket::bind(free()).unwrap(),
        UdpSocket::bind(free()).unwrap(),
    );
    for (nth, text) in odd_stops().iter().enumerate() {
        mover.send_to(GOOD, source.local()).unwrap();
        button.send_to(text, source.local()).unwrap();
        stopped(&stops, 1 + nth as u64, text).await;
    }
    let all = odd_stops().len() as u64;
    let view = until(&source, |view| view.intake.taken == 2 * all).await;
    assert_eq!(stops.load(Ordering::Relaxed), all);
    assert!(view.intake.refused.is_empty(), "{view:?}");
    // The spellings that are no fault are not told as odd.
    let odd = view.intake.odd_stops;
    assert!(odd > all / 2 && odd < all, "{odd} of {all}");
    let (sender, _why) = view.intake.last_odd.unwrap();
    assert_eq!(sender, button.local_addr().unwrap());
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_connection_that_sends_an_odd_stop_stays_open_and_can_stop_again() {
    let stops = Arc::default();
    let source = open(StreamPlace::Tcp(free()), &stops);
    let mut times = 0;
    for text in odd_stops() {
        let mut button = TcpStream::connect(source.local()).unwrap();
        button
            .write_all(&[&text, b"\n".as_slice()].concat())
            .unwrap();
        times += 1;
        stopped(&stops, times, &text).await;
        // What is no object at all may come from a page in a browser, of which nothing more is taken.
        let begins = text
            .iter()
            .find(|byte| !b" \0\xef\xbb\xbf\xff\xfe".contains(byte));
        if begins == Some(&b'{') {
            button.write_all(b"{\"stop\":true}\n").unwrap();
            times += 1;
            stopped(&stops, times, &text).await;
        } else {
            assert_eq!(button.read(&mut [0; 8]).unwrap_or(0), 0);
        }
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_stop_over_a_connection_counts_without_the_end_of_its_line_and_once() {
    let stops = Arc::default();
    let source = open(StreamPlace::Tcp(free()), &stops);
    let mut button = TcpStream::connect(source.local()).unwrap();
    button.set_nodelay(true).unwrap();
    // In pieces, and its line never ends.
    for piece in [b"{\"st".as_slice(), b"op\":tr", b"ue"] {
        button.write_all(piece).unwrap();
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    stopped(&stops, 1, b"pieces").await;
    button.write_all(b"}\n").unwrap();
    button.write_all(&[GOOD, b"\n"].concat()).unwrap();
    until(&source, |view| view.intake.taken == 2).await;
    assert_eq!(stops.load(Ordering::Relaxed), 1, "once a line");
    // A value that is not there yet asks for nothing.
    for piece in [
        b"{\"stop\":".as_slice(),
        b"fal",
        b"se,\"right\":[1,1,1,1,1,1]}\n",
    ] {
        button.write_all(piece).unwrap();
        tokio::time::sleep(Duration::from_millis(20)).await;
    }
    until(&source, |view| view.intake.taken == 3).await;
    assert_eq!(stops.load(Ordering::Relaxed), 1);
    // It ends in the middle.
    button.write_all(b"{\"stop\":").unwrap();
    button.shutdown(Shutdown::Write).unwrap();
    stopped(&stops, 2, b"an end").await;
    until(&source, |_| count(&source) == 4).await;
}
