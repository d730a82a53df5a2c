//! A wire in memory that takes its time and makes seeded mistakes. Knows no protocol.

use fastrand::Rng;
use handscope::transport::{Pipe, pair};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt, ReadHalf, WriteHalf, split};
use tokio::sync::watch;
use tokio::time::{Instant, sleep, sleep_until};

/// Bytes taken from the wire at a time: the longest RS485 frame, so that a fault hits about one frame.
const CHUNK_LEN: usize = 260;
/// Bits of one byte on a serial line: start, 8 data, stop.
const BITS_PER_BYTE: u64 = 10;
/// Keeps the two directions' chances apart.
const BACK_SEED: u64 = 0x9E37_79B9_7F4A_7C15;

/// How likely each fault is for a chunk of one direction, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct FaultOdds {
    /// It is lost.
    pub(crate) drop: f64,
    /// It and all behind it come later, by up to [`FaultPlan::delay_max`].
    pub(crate) delay: f64,
    /// One to [`FaultPlan::flips_max`] bits are flipped.
    pub(crate) corrupt: f64,
    /// Its end is lost.
    pub(crate) truncate: f64,
    /// It comes twice.
    pub(crate) duplicate: f64,
    /// The wire is cut for good.
    pub(crate) hang_up: f64,
}

/// The speed of a serial line: bytes take ten bits each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct LineSpeed {
    /// Bits a second; 0 counts as 1.
    pub(crate) baud: u32,
}

impl LineSpeed {
    fn time_of(self, bytes: usize) -> Duration {
        let bits = u64::try_from(bytes)
            .unwrap_or(u64::MAX)
            .saturating_mul(BITS_PER_BYTE);
        Duration::from_nanos(bits.saturating_mul(1_000_000_000) / u64::from(self.baud.max(1)))
    }
}

/// Which faults a wire has. Equal plans and equal writes give equal faults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FaultPlan {
    /// Seed of all chances.
    pub(crate) seed: u64,
    /// From the first pipe to the second.
    pub(crate) out: FaultOdds,
    /// From the second pipe to the first.
    pub(crate) back: FaultOdds,
    /// Longest delay.
    pub(crate) delay_max: Duration,
    /// Most bits that are flipped in one chunk, at least 1.
    pub(crate) flips_max: u8,
    /// Speed of the line; `None` = no time at all.
    pub(crate) pace: Option<LineSpeed>,
}

impl FaultPlan {
    /// No faults, no delay: a start to put faults into.
    pub(crate) fn quiet(seed: u64) -> Self {
        Self {
            seed,
            out: FaultOdds::default(),
            back: FaultOdds::default(),
            delay_max: Duration::from_millis(50),
            flips_max: 3,
            pace: None,
        }
    }
}

/// How many faults were made, both directions together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct FaultCounts {
    /// Chunks that went through, harmed or not.
    pub(crate) chunks: u64,
    /// Chunks lost.
    pub(crate) dropped: u64,
    /// Chunks held back.
    pub(crate) delayed: u64,
    /// Chunks with flipped bits.
    pub(crate) corrupted: u64,
    /// Chunks cut short.
    pub(crate) truncated: u64,
    /// Chunks sent twice.
    pub(crate) duplicated: u64,
    /// 1 if the plan cut the wire.
    pub(crate) hang_ups: u64,
}

/// Governs a faulty wire from outside.
#[derive(Debug, Clone)]
pub(crate) struct FaultSwitch(Arc<FaultState>);

#[derive(Debug)]
struct FaultState {
    quiet: AtomicBool,
    cut: watch::Sender<bool>,
    counts: Mutex<FaultCounts>,
}

impl FaultState {
    fn counts(&self) -> MutexGuard<'_, FaultCounts> {
        self.counts.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl FaultSwitch {
    /// No faults from now on; the pace stays.
    pub(crate) fn quiet(&self) {
        self.0.quiet.store(true, Ordering::Relaxed);
    }

    /// Cuts the wire: both ends read zero bytes, writes fail, and what was on its way is lost.
    pub(crate) fn hang_up(&self) {
        self.0.cut.send_replace(true);
    }

    /// What was done so far.
    pub(crate) fn counts(&self) -> FaultCounts {
        *self.0.counts()
    }
}

/// Both ends of a wire with faults, and its switch. A delayed chunk delays what is behind it: a line never reorders.
/// When one end is dropped, the other end reads zero bytes after what was still carried to it.
/// Must be called within a tokio runtime; one task each way drives it.
pub(crate) fn faulty_pair(plan: FaultPlan) -> (Pipe, Pipe, FaultSwitch) {
    let (near, near_inner) = pair();
    let (far, far_inner) = pair();
    let (near_read, near_write) = split(near_inner);
    let (far_read, far_write) = split(far_inner);
    let shared = Arc::new(FaultState {
        quiet: AtomicBool::new(false),
        cut: watch::Sender::new(false),
        counts: Mutex::default(),
    });
    let lane = |from, to, odds, seed| FaultyDirection {
        from,
        to,
        odds,
        plan,
        rng: Rng::with_seed(seed),
        free_at: Instant::now(),
        shared: Arc::clone(&shared),
    };
    let out = lane(near_read, far_write, plan.out, plan.seed);
    let back = lane(far_read, near_write, plan.back, plan.seed ^ BACK_SEED);
    tokio::spawn(out.run());
    tokio::spawn(back.run());
    (near, far, FaultSwitch(shared))
}

/// One direction.
struct FaultyDirection {
    from: ReadHalf<Pipe>,
    to: WriteHalf<Pipe>,
    odds: FaultOdds,
    plan: FaultPlan,
    rng: Rng,
    /// When the line has sent all that was given to it.
    free_at: Instant,
    shared: Arc<FaultState>,
}

/// What happens to one chunk.
struct ChunkFate {
    drop: bool,
    hang_up: bool,
    copies: usize,
    delay: Duration,
}

impl FaultyDirection {
    async fn run(mut self) {
        let mut cut = self.shared.cut.subscribe();
        tokio::select! {
            biased;
            _ = cut.wait_for(|cut| *cut) => {}
            () = self.carry() => {}
        }
        self.shared.cut.send_replace(true);
    }

    /// Until an end is gone or the plan cuts the wire.
    async fn carry(&mut self) {
        let mut buffer = [0; CHUNK_LEN];
        while let Ok(len @ 1..) = self.from.read(&mut buffer).await {
            let mut chunk = buffer.get(..len).unwrap_or_default().to_vec();
            let fate = self.decide(&mut chunk);
            if fate.hang_up {
                return;
            }
            if !fate.delay.is_zero() {
                sleep(fate.delay).await;
            }
            for _ in 0..fate.copies {
                self.wait_for_line(chunk.len()).await;
                if !fate.drop && self.to.write_all(&chunk).await.is_err() {
                    return;
                }
            }
        }
    }

    async fn wait_for_line(&mut self, bytes: usize) {
        let Some(pace) = self.plan.pace else {
            return;
        };
        self.free_at = self.free_at.max(Instant::now()) + pace.time_of(bytes);
        sleep_until(self.free_at).await;
    }

    /// Throws the dice, the same number for each chunk whatever comes out.
    fn decide(&mut self, chunk: &mut Vec<u8>) -> ChunkFate {
        let loud = !self.shared.quiet.load(Ordering::Relaxed);
        let odds = self.odds;
        let mut roll = |chance: f64| self.rng.f64() < chance && loud;
        let (drop, delay, corrupt) = (roll(odds.drop), roll(odds.delay), roll(odds.corrupt));
        let (truncate, twice) = (roll(odds.truncate), roll(odds.duplicate));
        let hang_up = roll(odds.hang_up);
        let mut inner = self.rng.fork();
        if corrupt {
            flip_bits(chunk, self.plan.flips_max, &mut inner);
        }
        if truncate {
            chunk.truncate(inner.usize(..chunk.len().max(1)));
        }
        let most = u64::try_from(self.plan.delay_max.as_micros()).unwrap_or(u64::MAX);
        let mut counts = self.shared.counts();
        counts.chunks += 1;
        counts.dropped += u64::from(drop);
        counts.delayed += u64::from(delay);
        counts.corrupted += u64::from(corrupt);
        counts.truncated += u64::from(truncate);
        counts.duplicated += u64::from(twice);
        counts.hang_ups += u64::from(hang_up);
        ChunkFate {
            drop,
            hang_up,
            copies: if twice { 2 } else { 1 },
            delay: if delay {
                Duration::from_micros(inner.u64(..=most))
            } else {
                Duration::ZERO
            },
        }
    }
}

/// Flips one to `most` different bits.
fn flip_bits(chunk: &mut [u8], most: u8, rng: &mut Rng) {
    let bits = chunk.len() * 8;
    let first = rng.usize(..bits.max(1));
    for step in 0..rng.usize(1..=usize::from(most.max(1))) {
        let bit = (first + step * 3) % bits.max(1);
        if let Some(byte) = chunk.get_mut(bit / 8) {
            *byte ^= 1 << (bit % 8);
        }
    }
}

mod tests {
    #![allow(clippy::cast_possible_truncation, reason = "a test may")]
    use super::*;

    const ROUGH: FaultOdds = FaultOdds {
        drop: 0.1,
        delay: 0.2,
        corrupt: 0.1,
        truncate: 0.1,
        duplicate: 0.1,
        hang_up: 0.0,
    };

    /// What arrives of 200 numbered chunks, with the time of each, and the counts.
    async fn trial(plan: FaultPlan) -> (Vec<(u128, Vec<u8>)>, FaultCounts) {
        let (mut near, mut far, switch) = faulty_pair(plan);
        let start = Instant::now();
        let reader = tokio::spawn(async move {
            let mut seen = Vec::new();
            let mut buffer = [0; 1024];
            while let Ok(len @ 1..) = far.read(&mut buffer).await {
                seen.push((start.elapsed().as_micros(), buffer[..len].to_vec()));
            }
            seen
        });
        for number in 0..200_u32 {
            if near.write_all(&[number as u8; 20]).await.is_err() {
                break;
            }
            sleep(Duration::from_millis(5)).await;
        }
        drop(near);
        (reader.await.unwrap(), switch.counts())
    }

    #[tokio::test(start_paused = true)]
    async fn equal_seeds_give_equal_faults_and_other_seeds_others() {
        let plan = FaultPlan {
            out: ROUGH,
            ..FaultPlan::quiet(7)
        };
        let first = trial(plan).await;
        assert_eq!(trial(plan).await, first);
        assert_ne!(trial(FaultPlan { seed: 8, ..plan }).await, first);
        let counts = first.1;
        assert!(counts.dropped > 0 && counts.delayed > 0 && counts.corrupted > 0);
        assert!(counts.truncated > 0 && counts.duplicated > 0 && counts.hang_ups == 0);
    }

    #[tokio::test(start_paused = true)]
    async fn delays_keep_the_order_and_lose_nothing() {
        let out = FaultOdds {
            delay: 0.5,
            ..FaultOdds::default()
        };
        let (seen, counts) = trial(FaultPlan {
            out,
            ..FaultPlan::quiet(3)
        })
        .await;
        let bytes: Vec<u8> = seen.into_iter().flat_map(|(_, bytes)| bytes).collect();
        let sent: Vec<u8> = (0..200_u32).flat_map(|number| [number as u8; 20]).collect();
        assert_eq!(bytes, sent);
        assert!(counts.delayed > 0);
    }

    #[tokio::test(start_paused = true)]
    async fn a_quiet_switch_ends_all_faults() {
        let out = FaultOdds {
            drop: 1.0,
            ..FaultOdds::default()
        };
        let (mut near, mut far, switch) = faulty_pair(FaultPlan {
            out,
            ..FaultPlan::quiet(1)
        });
        near.write_all(b"lost").await.unwrap();
        sleep(Duration::from_millis(1)).await;
        switch.quiet();
        near.write_all(b"kept").await.unwrap();
        let mut got = [0; 4];
        far.read_exact(&mut got).await.unwrap();
        assert_eq!(&got, b"kept");
        assert_eq!(switch.counts().dropped, 1);
    }

    #[tokio::test(start_paused = true)]
    async fn cutting_the_wire_is_noticed_at_both_ends_at_once() {
        let (mut near, mut far, switch) = faulty_pair(FaultPlan::quiet(1));
        let start = Instant::now();
        switch.hang_up();
        assert_eq!(near.read(&mut [0; 8]).await.unwrap(), 0);
        assert_eq!(far.read(&mut [0; 8]).await.unwrap(), 0);
        assert!(near.write_all(b"x").await.is_err());
        assert_eq!(start.elapsed(), Duration::ZERO);
    }

    #[tokio::test(start_paused = true)]
    async fn a_planned_hang_up_is_counted() {
        let out = FaultOdds {
            hang_up: 1.0,
            ..FaultOdds::default()
        };
        let (seen, counts) = trial(FaultPlan {
            out,
            ..FaultPlan::quiet(1)
        })
        .await;
        assert!(seen.is_empty());
        assert_eq!(counts.hang_ups, 1);
    }

    #[tokio::test(start_paused = true)]
    async fn a_paced_line_takes_ten_bits_a_byte() {
        let pace = Some(LineSpeed { baud: 115_200 });
        let (mut near, mut far, _switch) = faulty_pair(FaultPlan {
            pace,
            ..FaultPlan::quiet(1)
        });
        let start = Instant::now();
        near.write_all(&[0; 1152]).await.unwrap();
        far.read_exact(&mut [0; 1152]).await.unwrap();
        let took = start.elapsed().as_millis();
        assert!((100..=102).contains(&took), "{took} ms");
    }
}
