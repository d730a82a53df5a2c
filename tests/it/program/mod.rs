//! The whole program without its window, in virtual time, in front of a simulated hand on a wire: what a person asks, what
//! reaches the hand, and what is told.

mod actions;
mod exhibit_report;
mod gripping;
mod keeping;
mod lost_replies;
mod motion;
mod parameters;
mod pinch;
mod playing;
mod starter;
mod targets;
mod tuning;

use crate::setup::hand;
use crate::setup::line::{Dialled, Line, Trouble};
use crate::setup::link::{to_hand, to_hand_at_pace};
use crate::setup::program::{env, start};
use handscope::app::action::Action;
use handscope::app::env::Env;
use handscope::app::hand::Hand;
use handscope::app::notices::NoticeKind;
use handscope::app::program::App;
use handscope::app::settings::Settings;
use handscope::app::state::State;
use handscope::hand::{Angle, Dof, Force, Speed};
use handscope::link::Clock;
use handscope::record::LinkState;
use handscope::sim::{JournalEntry, Personality, SharedHand, SimConfig};
use handscope::transport::Dial;
use std::sync::Arc;
use tempfile::TempDir;
use tokio::time::{Duration, Instant, sleep};

/// ANGLE_SET (manual 2.6.11).
const ANGLE_SET: u16 = 1486;

/// The program in front of a hand.
struct Bench {
    /// On the heap: a test keeps several programs, and a thread has 2 MB.
    app: Box<App>,
    clock: Clock,
    hand: SharedHand,
    folder: TempDir,
    /// Writes to the hand that are not looked at any more.
    seen: usize,
}

impl Bench {
    /// Lets nothing be saved in the documents any more: a file stands where their folder was.
    fn block_documents(&self) {
        let place = self.folder.path().join("documents");
        // The recording may just be making its folder.
        while std::fs::write(&place, "a file").is_err() {
            drop(std::fs::remove_dir_all(&place));
        }
    }

    /// With a hand that has nothing in its reach, live since a second.
    async fn live() -> Self {
        let hand = hand::begin(hand::free(SimConfig::default()));
        Self::on(to_hand_at_pace(hand.clone()), hand, "rs485:x").await
    }

    /// The same on a wire that takes no time.
    async fn live_without_delay() -> Self {
        let hand = hand::begin(hand::free(SimConfig::default()));
        Self::on(to_hand(hand.clone()), hand, "rs485:x").await
    }

    async fn on(dial: Arc<dyn Dial>, hand: SharedHand, endpoint: &str) -> Self {
        let folder = TempDir::new().unwrap();
        let env = Env {
            dial,
            settings_path: Some(folder.path().join("settings.toml")),
            documents: Some(folder.path().join("documents")),
            ..env()
        };
        let clock = env.clock;
        let app = Box::new(start(env, Settings::default(), Some(endpoint)));
        let mut bench = Self {
            app,
            clock,
            hand,
            folder,
            seen: 0,
        };
        bench.run(1000).await;
        assert_eq!(bench.hand().connection.status.state, LinkState::Monitoring);
        bench
    }

    /// Over a line on which the next answer can be made to go wrong, once so many angles were written.
    async fn on_line(endpoint: &str, angles: usize) -> (Self, Arc<Line>) {
        let mut line = Line::new(Personality::default(), ANGLE_SET, Trouble::None);
        line.nth = angles;
        let line = Arc::new(line);
        let dial = Arc::new(Dialled(Arc::clone(&line)));
        let bench = Self::on(dial, line.hand.clone(), endpoint).await;
        (bench, line)
    }

    async fn armed() -> Self {
        let mut bench = Self::live().await;
        bench.arm().await;
        bench
    }

    /// As a careful person arms.
    async fn arm(&mut self) {
        self.act(Action::Speed(None, Speed::GENTLE));
        self.act(Action::Force(None, Force::GENTLE));
        self.act(Action::Arm);
        self.run(100).await;
        assert!(self.hand().connection.is_armed());
        self.forget();
    }

    async fn run(&mut self, millis: u64) {
        for _ in 0..millis / 10 {
            sleep(Duration::from_millis(10)).await;
            self.app.logic(self.clock.now());
            // A window draws as often.
            self.app.drawn(self.clock.now());
        }
    }

    /// The window does nothing for so long; the links go on.
    async fn hang(&mut self, millis: u64) {
        for _ in 0..millis / 10 {
            sleep(Duration::from_millis(10)).await;
        }
    }

    /// Lets time go by until it is so.
    async fn until(&mut self, what: &str, is_so: impl Fn(&State) -> bool) {
        let over = Instant::now() + Duration::from_secs(60);
        while !is_so(self.app.state()) {
            assert!(Instant::now() < over, "{what}");
            self.run(10).await;
        }
    }

    fn act(&mut self, action: Action) {
        self.app.act(action, self.clock.now());
    }

    fn state(&self) -> &State {
        self.app.state()
    }

    fn hand(&self) -> &Hand {
        self.app.state().hand()
    }

    fn angle(&self, dof: Dof) -> i16 {
        self.hand().readings.sample.angle.unwrap().value[dof].raw()
    }

    fn target(&self, dof: Dof) -> Option<i16> {
        self.hand().controls.joints[dof].target.map(Angle::get)
    }

    fn told(&self) -> Vec<NoticeKind> {
        let notices = self.state().notices.iter();
        notices.map(|notice| notice.what.clone()).collect()
    }

    /// What was written to the hand since [`Self::forget`].
    fn written(&self) -> Vec<JournalEntry> {
        self.hand
            .with(|hand, _| hand.journal()[self.seen..].to_vec())
    }

    fn forget(&mut self) {
        self.seen = self.hand.with(|hand, _| hand.journal().len());
    }

    /// Addresses of what was written.
    fn addresses(&self) -> Vec<u16> {
        self.written().iter().map(|entry| entry.address).collect()
    }
}

/// What goes wrong with the next answer on a line.
fn spoil(line: &Line, trouble: Trouble) {
    *line.trouble.lock().unwrap() = trouble;
}

/// Where the joints were told to go, one entry a write of angles: joints that were left alone are -1.
fn angles_told(bench: &Bench) -> Vec<[i16; 6]> {
    let written = bench.written();
    let angles = written
        .iter()
        .filter(|one| (ANGLE_SET..ANGLE_SET + 12).contains(&one.address));
    let mut told: Vec<[i16; 6]> = Vec::new();
    for one in angles {
        let first = usize::from((one.address - ANGLE_SET) / 2);
        let mut all = [-1; 6];
        for (at, value) in shorts(one).into_iter().enumerate() {
            all[first + at] = value;
        }
        if told.last() != Some(&all) {
            told.push(all);
        }
    }
    told
}

/// The shorts of a write.
fn shorts(entry: &JournalEntry) -> Vec<i16> {
    let (pairs, _) = entry.bytes.as_chunks::<2>();
    pairs.iter().map(|pair| i16::from_le_bytes(*pair)).collect()
}
