//! What happens while the hand moves: the columns of the table that strike the hand, its wire or its time.

use crate::seams::hand::SeamHand;
use crate::seams::judge::{INDEX, Seen};
use crate::seams::mover::Mover;
use crate::seams::table::Column;
use handscope::hand::{Dof, Fault, Moment, PerDof, Span};
use nix::sys::signal::Signal;
use std::time::Duration;

/// DEFAULT_SPEED_SET and DEFAULT_FORCE_SET (manual 2.6).
const DEFAULTS: Span = Span::new(1032, 24);
const STEP: Duration = Duration::from_millis(20);
/// What is on its way has come so far.
const UNDER_WAY: i16 = 850;

/// As over a VPN or a relay, ms.
const SLOW_REPLIES: [u64; 4] = [60, 100, 150, 300];
/// Exceptions that mean: the gateway answers, the hand does not (Modbus application protocol 1.1b3, 7).
const REFUSALS: [u8; 4] = [0x0A, 0x0B, 0x04, 0x06];

/// Looks at the joints while time goes by.
pub(super) struct Witness<'a> {
    mover: &'a mut dyn Mover,
    /// The number of the cell: where an event has several kinds, it picks one.
    number: usize,
    event: Moment,
    points: Vec<(Moment, [i16; 6])>,
}

impl<'a> Witness<'a> {
    /// Waits until the index is on its way, where joints move at all.
    pub(super) fn of(mover: &'a mut dyn Mover, number: usize, moves: bool) -> Self {
        let mut witness = Self {
            event: Moment::ZERO,
            mover,
            number,
            points: Vec::new(),
        };
        if moves {
            witness.pass(200);
        }
        for _ in 0..1500 {
            if !moves || witness.index() < UNDER_WAY || witness.mover.has_ended() {
                break;
            }
            witness.pass(20);
        }
        assert!(
            !moves || (100..=UNDER_WAY).contains(&witness.index()),
            "it is not on its way: {} {}",
            witness.index(),
            witness.mover.said()
        );
        let said = witness.mover.said();
        let has_lost = ["lost: ", "link was lost", "LinkLost"]
            .iter()
            .any(|words| said.contains(words));
        assert!(
            !moves || !has_lost,
            "the link was lost before the event: {said}"
        );
        witness.event = witness.mover.hand().now();
        witness
    }

    fn index(&self) -> i16 {
        self.mover.hand().angles()[INDEX]
    }

    fn pass(&mut self, ms: u64) {
        for _ in 0..ms.div_ceil(20) {
            self.mover.pass(STEP);
            let hand = self.mover.hand();
            self.points.push((hand.now(), hand.angles()));
        }
    }

    /// Looks on until the program is over, and a moment longer.
    fn pass_to_the_end(&mut self) {
        for _ in 0..150 {
            if self.mover.has_ended() {
                break;
            }
            self.pass(200);
        }
        self.pass(1500);
    }

    /// A person closes its window, which waits for the hand.
    pub(super) fn closes(&mut self) {
        self.mover.close();
        self.pass(3000);
    }

    /// The temperature of a drive reads this, °C.
    pub(super) fn grows_hot(&mut self, celsius: u8) {
        self.mover.hand().reads_temperature(celsius);
        self.pass(4000);
    }

    /// Lets it happen to what only writes, and looks on until that is over.
    pub(super) fn happens_to_writes(&mut self, column: Column) {
        self.happens(column);
        self.pass_to_the_end();
    }

    /// Lets it happen, and looks on for some seconds.
    pub(super) fn happens(&mut self, column: Column) {
        let hand = std::sync::Arc::clone(self.mover.hand());
        match column {
            Column::Frozen => {
                self.mover.freeze();
                self.pass(12_000);
            }
            Column::Asleep => {
                self.mover.sleep(Duration::from_secs(10));
                self.pass(3000);
            }
            Column::LinkLost => {
                hand.silence(true);
                self.pass(2000);
                hand.silence(false);
                self.pass(4000);
            }
            Column::Replugged => {
                hand.unplug();
                self.pass(1000);
                hand.plug_in();
                self.pass(4000);
            }
            Column::PowerCycled => {
                hand.silence(true);
                hand.power_cycle();
                self.pass(500);
                hand.silence(false);
                self.pass(4000);
            }
            Column::OddReplies => {
                hand.odd_replies();
                self.pass(5000);
            }
            Column::Disobeys => {
                hand.disobey();
                self.pass(100);
                self.mover.stop();
                self.pass(5000);
            }
            Column::SecondMaster => {
                for _ in 0..15 {
                    hand.another_controller_writes();
                    self.pass(200);
                }
            }
            Column::FaultOrHeat => {
                hand.fault(Fault::Motor);
                self.pass(4000);
            }
            Column::FeedbackFrozen => {
                hand.freeze_feedback();
                self.pass(4000);
            }
            Column::Signal => {
                self.mover.signal(Signal::SIGTERM);
                self.pass(3000);
            }
            Column::Killed => {
                self.mover.signal(Signal::SIGKILL);
                self.pass(3000);
            }
            Column::ReaderGone => {
                self.mover.lose_reader();
                self.pass_to_the_end();
            }
            Column::OutputUnread => {
                self.mover.stop_reading();
                self.pass(2000);
                self.mover.signal(Signal::SIGTERM);
                self.pass(6000);
            }
            Column::HolderKilled => {
                self.mover.signal_holder(Signal::SIGKILL);
                self.pass(500);
                self.mover.signal(Signal::SIGKILL);
                self.pass(4000);
            }
            Column::HolderFrozen => {
                self.mover.signal_holder(Signal::SIGSTOP);
                self.mover.signal(Signal::SIGKILL);
                self.pass(1000);
                self.mover.signal_holder(Signal::SIGCONT);
                self.pass(4000);
            }
            Column::SecondHandscope => {
                self.mover.second_handscope();
                self.pass(9000);
            }
            Column::GatewayRefuses => self.gateway_refuses(&hand),
            Column::StopThenLost => self.stop_then_lost(&hand),
            Column::RepliesSlow => self.replies_are_slow(&hand),
            Column::RestsShort => self.stopped_after_a_second(),
            Column::Busy => self.computer_is_busy(),
            Column::NoDescriptors => self.no_descriptor_is_left(),
            Column::JointFrozen => self.angles_freeze(&hand),
            Column::OddStop => self.stop_is_odd(),
            Column::GrantedAgain => self.control_is_given_again(),
            Column::Panic | Column::DisplayLost => panic!("tried elsewhere"),
        }
    }

    /// Of the index alone, or of all joints, while everything else that the hand tells lives on.
    fn angles_freeze(&mut self, hand: &SeamHand) {
        let all = self.number.is_multiple_of(2);
        hand.freeze_angles(PerDof::from_fn(|dof| all || dof == Dof::Index));
        self.pass(4000);
    }

    /// A person or a program stops it, in a message of which little else is right.
    fn stop_is_odd(&mut self) {
        self.mover.stop_oddly();
        self.pass(4000);
    }

    /// For two seconds a gateway answers that the hand does not.
    fn gateway_refuses(&mut self, hand: &SeamHand) {
        hand.refuse(REFUSALS[self.number % REFUSALS.len()]);
        self.pass(2000);
        hand.silence(false);
        self.pass(4000);
    }

    /// A person presses STOP before the link is known to be lost, and the hand is back within 3 s.
    fn stop_then_lost(&mut self, hand: &SeamHand) {
        hand.silence(true);
        self.pass(100);
        self.mover.stop();
        self.pass(800);
        hand.silence(false);
        self.pass(5000);
    }

    fn stopped_after_a_second(&mut self) {
        self.pass(1000);
        self.mover.stop();
        self.pass(5000);
    }

    /// Replies come later from now on, as over a VPN or a relay, and a person presses STOP.
    fn replies_are_slow(&mut self, hand: &SeamHand) {
        let ms = SLOW_REPLIES[self.number % SLOW_REPLIES.len()];
        hand.delay_replies(Duration::from_millis(ms));
        self.pass(600);
        self.mover.stop();
        self.pass(5000);
    }

    /// The program gets no processor four times, for 100 to 400 ms each, before a person stops the hand.
    fn computer_is_busy(&mut self) {
        let mut rng = fastrand::Rng::with_seed(self.event.micros());
        for _ in 0..4 {
            self.mover.sleep(Duration::from_millis(rng.u64(100..=400)));
            self.pass(rng.u64(100..=500));
        }
        self.mover.stop();
        self.pass(5000);
    }

    /// Twice within 100 ms; a second later control is taken for good.
    fn control_is_given_again(&mut self) {
        for may in [false, true, false, true] {
            self.mover.grant(may);
            self.pass(20);
        }
        self.pass(1000);
        self.mover.grant(false);
        self.pass(4000);
    }

    /// The program can open nothing more, and is ended.
    fn no_descriptor_is_left(&mut self) {
        self.mover.exhaust_descriptors();
        self.pass(1500);
        self.mover.signal(Signal::SIGTERM);
        self.pass(4000);
    }

    pub(super) fn seen(self) -> Seen {
        Seen {
            event: self.event,
            writes: self.mover.hand().writes_since(self.event),
            said: self.mover.said(),
            has_ended: self.mover.has_ended(),
            defaults: self.mover.hand().holds(DEFAULTS),
            points: self.points,
        }
    }
}
