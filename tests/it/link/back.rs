//! The link comes back: a wire that hangs up or falls silent is noticed in time, and the adapter is found again, also
//! under another name. All in virtual time.

use crate::setup::body::Quirks;
use crate::setup::device;
use crate::setup::hand;
use crate::setup::link::{self, Client};
use futures::FutureExt as _;
use futures::future::BoxFuture;
use handscope::hand::Setpoints;
use handscope::hand::{Angle, Dof, Moment, Target, register};
use handscope::link::{Clock, LinkConfig, LinkStatus, LinkTrouble, STOP_PENDING, Stop};
use handscope::record::{Disarmed, Hold, LinkState};
use handscope::sim::serve::{rs485, slcan};
use handscope::sim::{Personality, SharedHand, SimHand};
use handscope::transport::{Dial, Endpoint, PortFound, TransportError, UsbFound, Wire, pair};
use std::sync::{Arc, Mutex};
use tokio::sync::watch;
use tokio::task::JoinHandle;
use tokio::time::{Duration, Instant, sleep};

/// Longer than this nobody should have to wait.
const UNPLUG_WITHIN: Duration = Duration::from_millis(100);
const SILENCE_WITHIN: Duration = Duration::from_millis(300);
const BACK_WITHIN: Duration = Duration::from_secs(2);

const WIRES: [&str; 4] = [
    "rs485:/dev/ttyT0",
    "rtu:/dev/ttyT0",
    "slcan:/dev/ttyT0",
    "tcp:127.0.0.1:6000",
];

/// A computer whose ports are a list, with one hand behind whichever port has the adapter `A5`.
struct Computer {
    hand: SharedHand,
    state: Mutex<Plugged>,
    mute: watch::Sender<bool>,
    /// Nothing passes either way.
    cut: watch::Sender<bool>,
}

#[derive(Default)]
struct Plugged {
    /// So many connections are accepted and closed at once.
    refuses: usize,
    ports: Vec<PortFound>,
    wires: Vec<JoinHandle<()>>,
    /// Paths that were opened.
    opened: Vec<String>,
    /// Open wires at the time of each opening.
    open_then: Vec<usize>,
    unreachable: bool,
}

impl Computer {
    fn new() -> Arc<Self> {
        Self::with_turnaround(Duration::ZERO)
    }

    /// The hand takes its time for each reply.
    fn with_turnaround(turnaround: Duration) -> Arc<Self> {
        let config = hand::like(Personality {
            turnaround,
            ..Personality::default()
        });
        let hand = hand::shared(config);
        let computer = Arc::new(Self {
            hand,
            state: Mutex::default(),
            mute: watch::Sender::new(false),
            cut: watch::Sender::new(false),
        });
        computer.plug(&[usb("/dev/ttyT0", Some("A5"), "1-2:1.0")]);
        computer
    }

    fn plug(&self, ports: &[PortFound]) {
        let mut state = self.state.lock().unwrap();
        state.ports = ports.to_vec();
        state.unreachable = false;
    }

    /// The adapter is pulled out: its wire hangs up, its port is gone.
    fn unplug(&self) {
        let mut state = self.state.lock().unwrap();
        state.ports.clear();
        state.unreachable = true;
        for wire in state.wires.drain(..) {
            wire.abort();
        }
    }

    fn mute(&self, mute: bool) {
        self.mute.send_replace(mute);
    }

    fn cut(&self, cut: bool) {
        self.cut.send_replace(cut);
    }

    fn index(&self) -> f64 {
        self.hand.with(|hand, now| {
            hand.advance_to(now);
            hand.true_angles()[Dof::Index]
        })
    }
}

fn usb(path: &str, serial: Option<&str>, location: &str) -> PortFound {
    PortFound {
        path: path.into(),
        usb: Some(UsbFound {
            vendor_id: 0x0403,
            product_id: 0x6001,
            serial: serial.map(str::to_owned),
            location: Some(location.into()),
            ..UsbFound::default()
        }),
    }
}

impl Dial for Computer {
    fn dial(&self, endpoint: &Endpoint) -> link::Dialled {
        let mut state = self.state.lock().unwrap();
        let place = endpoint.place();
        let is_there = match endpoint.port() {
            Some(port) => state.ports.iter().any(|found| found.path == port),
            None => !state.unreachable,
        };
        if !is_there {
            return link::missing(place);
        }
        state.opened.push(place);
        let open = state.wires.iter().filter(|wire| !wire.is_finished());
        let open = open.count();
        state.open_then.push(open);
        let (near, far) = pair();
        if state.refuses > 0 {
            state.refuses -= 1;
            return link::opened(near);
        }
        let far = Mutable {
            wire: far,
            mute: self.mute.subscribe(),
            cut: self.cut.subscribe(),
        };
        let hand = self.hand.clone();
        let quirks = Quirks::default();
        let wire = match endpoint {
            Endpoint::Rtu(_) => tokio::spawn(device::modbus_rtu(hand, far, quirks, 1)),
            Endpoint::Tcp { .. } => tokio::spawn(device::modbus_tcp(hand, far, quirks, 1)),
            Endpoint::Slcan { .. } => tokio::spawn(slcan::serve(hand, far)),
            _ => tokio::spawn(rs485::serve(hand, far)),
        };
        state.wires.push(wire);
        link::opened(near)
    }

    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        let ports = self.state.lock().unwrap().ports.clone();
        futures::future::ready(ports).boxed()
    }
}

/// A hand's end of a wire that says nothing while it is muted, and hears nothing either while it is cut.
struct Mutable<W> {
    wire: W,
    mute: watch::Receiver<bool>,
    cut: watch::Receiver<bool>,
}

impl<W: Wire> tokio::io::AsyncRead for Mutable<W> {
    fn poll_read(
        mut self: std::pin::Pin<&mut Self>,
        cx: &mut std::task::Context<'_>,
        buf: &mut tokio::io::ReadBuf<'_>,
    ) -> std::task::Poll<std::io::Result<()>> {
        loop {
            let before = buf.filled().len();
            let read = std::pin::Pin::new(&mut self.wire).poll_read(cx, buf);
            if read.is_pending() || buf.filled().len() == before || !*self.cut.borrow() {
                return read;
            }
            buf.set_filled(before);
        }
    }
}

impl<W: Wire> tokio::io::AsyncWrite for Mutable<W> {
    fn poll_write(
        mut self: std::pin::Pin<&mut Self>,
        cx: &mut std::task::Context<'_>,
        buf: &[u8],
    ) -> std::task::Poll<std::io::Result<usize>> {
        if *self.mute.borrow() || *self.cut.borrow() {
            return std::task::Poll::Ready(Ok(buf.len()));
        }
        std::pin::Pin::new(&mut self.wire).poll_write(cx, buf)
    }

    fn poll_flush(
        self: std::pin::Pin<&mut Self>,
        _cx: &mut std::task::Context<'_>,
    ) -> std::task::Poll<std::io::Result<()>> {
        std::task::Poll::Ready(Ok(()))
    }

    fn poll_shutdown(
        self: std::pin::Pin<&mut Self>,
        _cx: &mut std::task::Context<'_>,
    ) -> std::task::Poll<std::io::Result<()>> {
        std::task::Poll::Ready(Ok(()))
    }
}

fn open(computer: &Arc<Computer>, endpoint: &str) -> Client {
    link::connect(endpoint, Arc::clone(computer) as Arc<dyn Dial>)
}

/// Waits until the link is as wanted; how long that took, and how the link stands.
async fn until(
    link: &mut Client,
    within: Duration,
    wanted: impl Fn(&LinkStatus) -> bool,
) -> (Duration, LinkStatus) {
    let begun = Instant::now();
    let status = link::until(link, within + Duration::from_secs(10), wanted).await;
    let took = begun.elapsed();
    assert!(took <= within, "{took:?} > {within:?}: {status:?}");
    (took, status)
}

/// Arms and sets the hand in motion.
async fn armed(link: &mut Client) {
    until(link, BACK_WITHIN, |status| {
        status.state == LinkState::Monitoring
    })
    .await;
    sleep(Duration::from_millis(200)).await;
    link.arm(link::gentle());
    let (_, status) = until(link, BACK_WITHIN, |status| status.armed.is_some()).await;
    let mut setpoints = Setpoints::none(status.armed.unwrap());
    setpoints.angle[Dof::Index] = Some(Target::Go(Angle::nearest(300)));
    link.set(&setpoints);
    sleep(Duration::from_millis(100)).await;
}

/// After a loss: back in time, not armed, and nothing was written since `writes`.
async fn back(link: &mut Client, computer: &Computer, writes: usize) -> LinkStatus {
    let (_, status) = until(link, BACK_WITHIN, |status| status.state.is_live()).await;
    assert_eq!((status.state, status.armed), (LinkState::Monitoring, None));
    sleep(Duration::from_secs(1)).await;
    assert_eq!(link.status().disarmed, Some(Disarmed::LinkLost));
    let now = computer.hand.with(|hand, _| hand.journal().len());
    assert_eq!(now, writes, "nothing is written by coming back");
    status
}

fn is_lost(status: &LinkStatus) -> bool {
    status.state == LinkState::Offline
}

fn writes(computer: &Computer) -> usize {
    computer.hand.with(|hand, _| hand.journal().len())
}

#[tokio::test(start_paused = true)]
async fn a_pulled_plug_is_noticed_in_100_ms_and_the_same_name_serves_again_in_2_s() {
    for wire in WIRES {
        let computer = Computer::new();
        let mut link = open(&computer, wire);
        armed(&mut link).await;
        computer.unplug();
        let (_, status) = until(&mut link, UNPLUG_WITHIN, is_lost).await;
        let trouble = status.trouble.unwrap();
        assert!(
            matches!(
                trouble,
                LinkTrouble::Transport(TransportError::HungUp { .. })
            ),
            "{wire}: {trouble}"
        );
        let before = writes(&computer);
        sleep(Duration::from_secs(7)).await;
        computer.plug(&[usb("/dev/ttyT0", Some("A5"), "1-2:1.0")]);
        let status = back(&mut link, &computer, before).await;
        assert_eq!(status.moved_to, None, "{wire}");
    }
}

#[tokio::test(start_paused = true)]
async fn silence_is_noticed_in_300_ms_and_an_answer_within_2_s() {
    for wire in WIRES {
        let computer = Computer::new();
        let mut link = open(&computer, wire);
        armed(&mut link).await;
        computer.mute(true);
        let (_, status) = until(&mut link, SILENCE_WITHIN, is_lost).await;
        let trouble = status.trouble.unwrap();
        assert!(
            matches!(trouble, LinkTrouble::Silent { .. }),
            "{wire}: {trouble}"
        );
        sleep(Duration::from_secs(7)).await;
        computer.mute(false);
        let before = writes(&computer);
        back(&mut link, &computer, before).await;
    }
}

/// The writes since `writes`, as addresses.
fn written(computer: &Computer, writes: usize) -> Vec<u16> {
    computer.hand.with(|hand, _| {
        let written = hand.journal().iter().skip(writes);
        written.map(|own| own.address).collect()
    })
}

/// The hand was stopped on its way, by holds alone.
fn check_held(computer: &Computer, writes: usize, was: f64, name: &str) {
    let written = written(computer, writes);
    assert!(
        !written.is_empty() && written.iter().all(|address| [1486, 1494].contains(address)),
        "{name}: {written:?}"
    );
    let rests = computer.index();
    assert!(was - rests < 60.0 && rests > 350.0, "{name}: {was} {rests}");
}

#[tokio::test(start_paused = true)]
async fn a_stop_pressed_before_a_loss_is_noticed_is_sent_first_when_the_hand_is_back_in_time() {
    for wire in WIRES {
        let computer = Computer::new();
        let mut link = open(&computer, wire);
        armed(&mut link).await;
        computer.cut(true);
        sleep(Duration::from_millis(100)).await;
        assert!(
            link.status().state.is_live(),
            "{wire}: not known to be lost"
        );
        let stop = link.begin(|link| async move { link.stop().await });
        let (_, status) = until(&mut link, SILENCE_WITHIN, is_lost).await;
        assert!(
            matches!(status.hold, Hold::Alarm { .. }),
            "{wire}: {status:?}"
        );
        computer.cut(false);
        let before = writes(&computer);
        until(&mut link, BACK_WITHIN, |status| status.state.is_live()).await;
        let was = computer.index();
        let stop = stop.await.unwrap();
        assert!(matches!(stop, Stop::Confirmed { .. }), "{wire}: {stop:?}");
        check_held(&computer, before, was, wire);
        assert_eq!(link.status().state, LinkState::Monitoring, "{wire}");
    }
}

/// Where nothing tells whether the frames of the stop reached the hand, it is held where it was when that was asked for.
#[tokio::test(start_paused = true)]
async fn a_stop_after_a_loss_sends_no_joint_back_to_where_its_feedback_froze_before() {
    for wire in WIRES {
        for frozen_for in [250, 350] {
            let computer = Computer::new();
            let mut link = open(&computer, wire);
            armed(&mut link).await;
            let freeze = |hand: &mut SimHand, now: Moment| hand.freeze_feedback(true, now);
            computer.hand.with(freeze);
            sleep(Duration::from_millis(frozen_for)).await;
            computer.cut(true);
            let was = computer.index();
            let stop = link.begin(|link| async move { link.stop().await });
            until(&mut link, SILENCE_WITHIN, is_lost).await;
            computer.cut(false);
            until(&mut link, BACK_WITHIN, |status| status.state.is_live()).await;
            assert_eq!(stop.await.unwrap(), Stop::NotConfirmed, "{wire}");
            let rests = computer.index();
            assert!(
                (was - rests).abs() < 45.0,
                "{wire} {frozen_for}: {was} {rests}"
            );
            assert!(link.status().feedback_in_doubt, "{wire}");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_of_a_hand_that_comes_back_late_is_not_sent_and_its_alarm_ends_with_rest() {
    for wire in WIRES {
        let computer = Computer::new();
        let mut link = open(&computer, wire);
        armed(&mut link).await;
        computer.cut(true);
        let stop = link.begin(|link| async move { link.stop().await });
        sleep(STOP_PENDING + Duration::from_secs(2)).await;
        assert_eq!(stop.await.unwrap(), Stop::LinkLost, "{wire}");
        let status = link.status();
        let before = writes(&computer);
        computer.cut(false);
        assert!(
            matches!(status.hold, Hold::Alarm { .. }),
            "{wire}: {status:?}"
        );
        let confirmed = |status: &LinkStatus| matches!(status.hold, Hold::Confirmed { .. });
        until(&mut link, BACK_WITHIN, confirmed).await;
        assert!(written(&computer, before).is_empty(), "{wire}");
    }
}

#[tokio::test(start_paused = true)]
async fn a_stop_pressed_while_the_hand_is_gone_outlives_connections_that_are_closed_at_once() {
    for wire in WIRES {
        let computer = Computer::new();
        let mut link = open(&computer, wire);
        armed(&mut link).await;
        computer.unplug();
        until(&mut link, UNPLUG_WITHIN, is_lost).await;
        sleep(Duration::from_millis(50)).await;
        let stop = link.begin(|link| async move { link.stop().await });
        sleep(Duration::from_millis(20)).await;
        let alarm = |status: &LinkStatus| matches!(status.hold, Hold::Alarm { .. });
        until(&mut link, UNPLUG_WITHIN, alarm).await;
        let before = writes(&computer);
        computer.state.lock().unwrap().refuses = 3;
        computer.plug(&[usb("/dev/ttyT0", Some("A5"), "1-2:1.0")]);
        until(&mut link, BACK_WITHIN, |status| status.state.is_live()).await;
        let was = computer.index();
        let stop = stop.await.unwrap();
        assert!(matches!(stop, Stop::Confirmed { .. }), "{wire}: {stop:?}");
        check_held(&computer, before, was, wire);
    }
}

thread_local! {
    static ASLEEP: std::cell::Cell<Duration> = const { std::cell::Cell::new(Duration::ZERO) };
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_moved_when_the_computer_slept_is_stopped_first() {
    for wire in WIRES {
        let computer = Computer::new();
        let mut link = link::open(LinkConfig {
            clock: Clock::with_sleep(|| Some(ASLEEP.get())),
            ..link::config(wire, Arc::clone(&computer) as Arc<dyn Dial>)
        });
        armed(&mut link).await;
        ASLEEP.set(ASLEEP.get() + Duration::from_millis(900));
        sleep(Duration::from_millis(100)).await;
        assert!(link.status().armed.is_some(), "{wire}: too short to matter");
        let before = writes(&computer);
        ASLEEP.set(ASLEEP.get() + Duration::from_secs(5));
        let (_, status) = until(&mut link, UNPLUG_WITHIN, is_lost).await;
        let slept = LinkTrouble::Suspended { slept_s: 5 };
        assert_eq!(status.trouble, Some(slept), "{wire}");
        assert_eq!(status.disarmed, Some(Disarmed::Resume), "{wire}");
        until(&mut link, BACK_WITHIN, |status| status.state.is_live()).await;
        let was = computer.index();
        let confirmed = |status: &LinkStatus| matches!(status.hold, Hold::Confirmed { .. });
        until(&mut link, BACK_WITHIN, confirmed).await;
        check_held(&computer, before, was, wire);
    }
}

#[tokio::test(start_paused = true)]
async fn an_adapter_that_returns_under_another_name_is_followed_by_its_serial_number() {
    for wire in &WIRES[..3] {
        let computer = Computer::new();
        let mut link = open(&computer, wire);
        armed(&mut link).await;
        computer.unplug();
        until(&mut link, UNPLUG_WITHIN, is_lost).await;
        let before = writes(&computer);
        sleep(Duration::from_secs(3)).await;
        // In another USB port, beside another adapter that came first and has the old name.
        computer.plug(&[
            usb("/dev/ttyT0", Some("B6"), "1-2:1.0"),
            usb("/dev/ttyT1", Some("A5"), "1-3:1.0"),
        ]);
        let status = back(&mut link, &computer, before).await;
        assert_eq!(status.moved_to.as_deref(), Some("/dev/ttyT1"), "{wire}");
        let state = computer.state.lock().unwrap();
        assert_eq!(state.opened, ["/dev/ttyT0", "/dev/ttyT1"], "{wire}");
        assert_eq!(state.open_then, [0, 0], "the old wire is closed first");
    }
}

#[tokio::test(start_paused = true)]
async fn an_adapter_that_cannot_be_told_from_another_is_not_opened_but_named() {
    let computer = Computer::new();
    computer.plug(&[usb("/dev/ttyT0", None, "1-2:1.0")]);
    let mut link = open(&computer, WIRES[0]);
    armed(&mut link).await;
    computer.unplug();
    until(&mut link, UNPLUG_WITHIN, is_lost).await;
    for strangers in [
        // The same kind without a number, elsewhere; and another kind under the old name.
        usb("/dev/ttyT1", None, "1-3:1.0"),
        usb("/dev/ttyT0", Some("B6"), "1-2:1.0"),
    ] {
        computer.plug(std::slice::from_ref(&strangers));
        sleep(Duration::from_secs(5)).await;
        let status = link.status();
        assert!(is_lost(&status));
        let words = status.trouble.unwrap().to_string();
        assert!(
            words.contains("/dev/ttyT0 is unplugged") && words.contains(&strangers.path),
            "{words}"
        );
        assert_eq!(computer.state.lock().unwrap().opened.len(), 1);
    }
    // A person who means that one says so, and a fresh link goes by the name alone.
    drop(link);
    let mut link = open(&computer, WIRES[0]);
    until(&mut link, BACK_WITHIN, |status| status.state.is_live()).await;
}

#[tokio::test(start_paused = true)]
async fn while_waiting_a_port_is_looked_for_once_a_second_at_most() {
    let computer = Computer::new();
    let mut link = open(&computer, WIRES[0]);
    armed(&mut link).await;
    computer.unplug();
    until(&mut link, UNPLUG_WITHIN, is_lost).await;
    sleep(Duration::from_secs(2)).await;
    let mut tries = 0;
    let mut last = link.status().dialling;
    let end = Instant::now() + Duration::from_secs(60);
    while Instant::now() < end {
        sleep(Duration::from_millis(10)).await;
        let now = link.status().dialling;
        tries += u32::from(now != last);
        last = now;
    }
    assert!(tries <= 61, "{tries}");
}

#[tokio::test(start_paused = true)]
async fn replies_at_the_ticks_of_a_latency_timer_are_told_unless_the_system_knows_better() {
    for (turnaround_ms, told, seen) in [
        (16, None, true),
        (16, Some(1), false),
        (7, None, false),
        (7, Some(16), false),
    ] {
        let computer = Computer::with_turnaround(Duration::from_millis(turnaround_ms));
        let mut port = usb("/dev/ttyT0", Some("A5"), "1-2:1.0");
        port.usb.as_mut().unwrap().latency_timer_ms = told;
        computer.plug(&[port]);
        let mut link = open(&computer, WIRES[0]);
        until(&mut link, BACK_WITHIN, |status| status.state.is_live()).await;
        // The plan may ask for long windows alone; short ones are what someone looks up, or the doctor.
        for _ in 0..50 {
            while link.records.try_next().is_some() {}
            drop(link.begin(|link| async move { link.read(register::HAND_ID.span()).await }));
            sleep(Duration::from_millis(100)).await;
        }
        let status = link.status();
        assert_eq!(
            (status.latency_timer_ms, status.latency_ticks),
            (told, seen)
        );
    }
}

/// The system's own serial ports, with pseudo-terminals listed as if they were USB adapters.
#[cfg(unix)]
struct Listed(Mutex<Vec<PortFound>>);

#[cfg(unix)]
impl Dial for Listed {
    fn dial(&self, endpoint: &Endpoint) -> link::Dialled {
        handscope::transport::SystemDial.dial(endpoint)
    }

    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        futures::future::ready(self.0.lock().unwrap().clone()).boxed()
    }
}

/// In real time, over the system's own ports: what counts is the order of things, not how long they take.
#[cfg(unix)]
#[tokio::test]
async fn a_pseudo_terminal_that_comes_back_under_another_name_is_followed() {
    use handscope::sim::serve::pty;
    let folder = tempfile::tempdir().unwrap();
    let hand = hand::plain();
    let path = |name: &str| folder.path().join(name);
    let listed = |name: &str| {
        let path = path(name);
        usb(path.to_str().unwrap(), Some("A5"), "1-2:1.0")
    };
    let real = |mut port: PortFound| {
        port.path = std::fs::canonicalize(&port.path)
            .unwrap()
            .display()
            .to_string();
        port
    };
    let first = tokio::spawn(pty::serve_rs485(hand.clone(), &path("first"), None).unwrap());
    let dial = Arc::new(Listed(Mutex::new(vec![real(listed("first"))])));
    let endpoint = format!("rs485:{}", path("first").display());
    let mut link = link::connect(&endpoint, Arc::clone(&dial) as Arc<dyn Dial>);
    let patient = Duration::from_secs(30);
    until(&mut link, patient, |status| status.state.is_live()).await;
    assert_eq!(link.status().moved_to, None);
    dial.0.lock().unwrap().clear();
    first.abort();
    let (_, status) = until(&mut link, patient, is_lost).await;
    assert!(matches!(
        status.trouble,
        Some(LinkTrouble::Transport(TransportError::HungUp { .. }))
    ));
    let second = pty::serve_rs485(hand.clone(), &path("second"), None).unwrap();
    let moved = real(listed("second"));
    *dial.0.lock().unwrap() = vec![moved.clone()];
    let _second = tokio::spawn(second);
    let (_, status) = until(&mut link, patient, |status| status.state.is_live()).await;
    assert_eq!(status.state, LinkState::Monitoring);
    assert_eq!(status.moved_to, Some(moved.path));
    assert!(hand.with(|hand, _| hand.journal().is_empty()));
}

/// A hand that takes connections and closes them at once, until this moment; dialled as often as asked for.
struct Shuts {
    hand: SharedHand,
    until: Instant,
    retry_delay: Option<Duration>,
}

impl Dial for Shuts {
    fn dial(&self, endpoint: &Endpoint) -> link::Dialled {
        let (ours, its) = pair();
        if Instant::now() >= self.until {
            hand::serve(self.hand.clone(), endpoint, its);
        }
        link::opened(ours)
    }

    fn retry_delay(&self, _attempt: u32) -> Option<Duration> {
        self.retry_delay
    }
}

#[tokio::test(start_paused = true)]
async fn a_hand_that_closes_connections_at_once_is_reached_as_soon_as_it_is_dialled_again() {
    for (retry_ms, within_ms) in [(None, 1200), (Some(20), 560)] {
        let opens = Duration::from_millis(500);
        let begun = Instant::now();
        let link = link::connect(
            "tcp:test",
            Arc::new(Shuts {
                hand: hand::begin(hand::free(Default::default())),
                until: begun + opens,
                retry_delay: retry_ms.map(Duration::from_millis),
            }),
        );
        while !link.status().state.is_live() {
            sleep(Duration::from_millis(1)).await;
        }
        let took = begun.elapsed();
        let within = Duration::from_millis(within_ms);
        assert!((opens..within).contains(&took), "{retry_ms:?}: {took:?}");
    }
}
