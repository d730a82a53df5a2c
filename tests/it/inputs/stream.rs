//! Lines over real sockets of this computer: who is taken, what is refused, when nobody listens.

use handscope::hand::Dof;
use handscope::hand::gap::Gap;
use handscope::hand::kinematics::Side;
use handscope::inputs::line::StreamLineFault;
use handscope::inputs::offer::SourceSite;
use handscope::inputs::stream::{StreamPlace, StreamSource, StreamView};
use handscope::link::{ArmRequest, Clock};
use std::collections::BTreeMap;
use std::io::Write as _;
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use tokio::runtime::Handle;

pub(super) fn free() -> SocketAddr {
    "127.0.0.1:0".parse().unwrap()
}

pub(super) fn open(place: StreamPlace, stops: &Arc<AtomicU64>) -> StreamSource {
    let stops = Arc::clone(stops);
    let site = SourceSite {
        side: Side::Right,
        clock: Clock::start(),
        stop: Arc::new(move || {
            stops.fetch_add(1, Ordering::Relaxed);
        }),
        wake: Arc::new(|| ()),
    };
    StreamSource::open(place, site, ArmRequest::GENTLE, &Handle::current()).unwrap()
}

/// Waits until what came in is as wanted.
pub(super) async fn until(
    source: &StreamSource,
    wanted: impl Fn(&StreamView) -> bool,
) -> StreamView {
    let patience = Instant::now() + Duration::from_secs(10);
    loop {
        let view = source.view();
        if wanted(&view) {
            return view;
        }
        assert!(Instant::now() < patience, "{view:?}");
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn datagrams_are_counted_by_what_is_wrong_and_followed_when_a_person_lets_them() {
    let stops = Arc::default();
    let source = open(StreamPlace::Udp(free()), &stops);
    let sender = UdpSocket::bind(free()).unwrap();
    let send = |line: &str| sender.send_to(line.as_bytes(), source.local()).unwrap();
    send(r#"{"seq":1,"right":[1,1,1,0.25,null,1]}"#);
    send(r#"{"seq":1,"right":[1,1,1,0.25,null,1]}"#);
    send(r#"{"seq":2,"right":[1,1,1,NaN,null,1]}"#);
    send(r#"{"seq":3,"right":[1,1,1,7,null,1]}"#);
    send(r#"{"stop":true}"#);
    send(&"x".repeat(5000));
    let view = until(&source, |view| view.intake.refused.len() == 4).await;
    assert_eq!((view.intake.taken, view.not_granted), (2, 1));
    assert_eq!(stops.load(Ordering::Relaxed), 1);
    let faults: Vec<StreamLineFault> = view.intake.refused.keys().copied().collect();
    for fault in [
        StreamLineFault::Late,
        StreamLineFault::NotFinite,
        StreamLineFault::Range,
        StreamLineFault::TooLong,
    ] {
        assert!(faults.contains(&fault), "{fault:?}: {faults:?}");
    }
    let mut offers = source.follow();
    send(r#"{"seq":9,"right":[1,1,1,0.5,null,1]}"#);
    let offer = offers.recv().await.unwrap();
    let index = offer.aims[Dof::Index].unwrap().get();
    assert_eq!((index, offer.aims[Dof::ThumbBend]), (500, None));
    send(r#"{"seq":10,"grip_mm":30}"#);
    let offer = offers.recv().await.unwrap();
    assert_eq!(offer.gap, Some(Gap::nearest(30.0)));
    send(r#"{"seq":11,"grip_mm":30,"right":[1,1,1,0.5,null,1]}"#);
    send(r#"{"seq":12,"grip_mm":130}"#);
    let view = until(&source, |view| view.intake.refused.len() == 6).await;
    assert_eq!(view.intake.refused[&StreamLineFault::Both], 1);
    assert_eq!(view.intake.refused[&StreamLineFault::Gap], 1);
    send(r#"{"seq":13,"hold":{"at_least_g":150,"at_most_g":400}}"#);
    let offer = offers.recv().await.unwrap();
    assert_eq!(offer.hold.unwrap().at_most().get(), 400);
    // More than the user allows any joint.
    send(r#"{"seq":14,"hold":{"at_least_g":150,"at_most_g":600}}"#);
    let view = until(&source, |view| view.intake.refused.len() == 7).await;
    assert_eq!(view.intake.refused[&StreamLineFault::AboveLimit], 1);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn connections_that_send_too_much_or_are_too_many_do_not_keep_others_out() {
    let source = open(StreamPlace::Tcp(free()), &Arc::default());
    let mut bad = TcpStream::connect(source.local()).unwrap();
    bad.write_all(&[b'{'; 70_000]).unwrap();
    until(&source, |view| {
        view.intake.refused.contains_key(&StreamLineFault::TooLong)
    })
    .await;
    let mut good = TcpStream::connect(source.local()).unwrap();
    // Lines need not come in pieces of their own.
    good.write_all(b"{\"right\":[1,1,1,1,1,1]}\n{\"rig")
        .unwrap();
    until(&source, |view| view.intake.taken == 1).await;
    good.write_all(b"ht\":[1,1,1,1,1,1]}\r\n").unwrap();
    until(&source, |view| view.intake.taken == 2).await;
    let idle: Vec<TcpStream> = (0..30)
        .map(|_| TcpStream::connect(source.local()).unwrap())
        .collect();
    good.write_all(b"{\"right\":[1,1,1,1,1,1]}\n").unwrap();
    let view = until(&source, |view| {
        view.intake.taken == 3 && view.connections > 1
    })
    .await;
    assert!(view.connections <= 32, "{}", view.connections);
    drop(idle);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_connection_too_many_stops_the_hand_and_does_nothing_else() {
    let stops = Arc::default();
    let source = open(StreamPlace::Tcp(free()), &stops);
    let connect = || TcpStream::connect(source.local()).unwrap();
    let _idle: Vec<TcpStream> = (0..8).map(|_| connect()).collect();
    until(&source, |view| view.connections == 8).await;
    let mut button = connect();
    let mut other = connect();
    until(&source, |view| view.connections == 10).await;
    other.write_all(b"{\"right\":[1,1,1,1,1,1]}\n").unwrap();
    until(&source, |view| view.connections == 9).await;
    for nth in 1..=2 {
        button.write_all(b"{\n  \"stop\": true\n}\n").unwrap();
        while stops.load(Ordering::Relaxed) < nth {
            tokio::time::sleep(Duration::from_millis(2)).await;
        }
    }
    let view = source.view();
    assert_eq!((view.intake.taken, view.intake.refused.len()), (0, 0));
    assert_eq!(view.connections, 9);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn a_connection_ends_with_its_first_line_that_is_no_message_and_a_wrong_value_is_only_refused()
 {
    let good = r#"{"right":[1,1,1,1,1,1]}"#;
    for (first, fault, taken) in [
        ("\r\n", None, 1),
        (
            r#"{"right":[1,1,1,NaN,1,1]}"#,
            Some(StreamLineFault::NotFinite),
            1,
        ),
        (
            r#"{"right":[1,1,1,7,1,1]}"#,
            Some(StreamLineFault::Range),
            1,
        ),
        (
            r#"{"left":[1,1,1,1,1,1]}"#,
            Some(StreamLineFault::OtherSide),
            1,
        ),
        ("hello", Some(StreamLineFault::Malformed), 0),
        (r#"{"right":"fist"}"#, Some(StreamLineFault::Type), 1),
        (r#"{"right":["fist""#, Some(StreamLineFault::Malformed), 0),
        ("POST /NaN HTTP/1.1", Some(StreamLineFault::Malformed), 0),
        (
            "GET / HTTP/1.1\r\nUpgrade: websocket\r\n",
            Some(StreamLineFault::Malformed),
            0,
        ),
    ] {
        let source = open(StreamPlace::Tcp(free()), &Arc::default());
        let mut sender = TcpStream::connect(source.local()).unwrap();
        sender
            .write_all(format!("{first}\n{good}\n").as_bytes())
            .unwrap();
        let wanted: BTreeMap<_, _> = fault.into_iter().map(|fault| (fault, 1)).collect();
        let view = until(&source, |view| {
            view.intake.taken == taken && view.intake.refused == wanted
        })
        .await;
        if taken == 0 {
            until(&source, |view| view.connections == 0).await;
        }
        assert_eq!(view.intake.taken, taken, "{first}");
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 1)]
async fn nobody_listens_before_it_is_opened_or_after_it_is_closed() {
    let source = open(StreamPlace::Tcp(free()), &Arc::default());
    let at = source.local();
    assert!(TcpStream::connect(at).is_ok());
    drop(source);
    let patience = Instant::now() + Duration::from_secs(10);
    while TcpStream::connect(at).is_ok() {
        assert!(Instant::now() < patience, "somebody listens at {at}");
        tokio::time::sleep(Duration::from_millis(10)).await;
    }
}
