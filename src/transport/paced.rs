//! Adds the timing of a serial line to a wire that has none: a pseudo-terminal transfers all bytes at once. Independent
//! of the protocol.

use crate::transport::pipe::{PIPE_LEN, Pipe, pair};
use crate::transport::serial::timer::Timer;
use crate::transport::wire::Wire;
use std::io;
use std::time::Duration;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::time::Instant;

/// Bits of one byte on a serial line: start, 8 data, stop.
const BITS_PER_BYTE: u64 = 10;

/// Timing of a line and the device on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LinePace {
    /// Bits per second; 0 counts as 1.
    pub baud: u32,
    /// Time from the last byte of a request to the first of its reply.
    pub turnaround: Duration,
}

impl LinePace {
    fn time_of(self, bytes: usize) -> Duration {
        let bits = u64::try_from(bytes)
            .unwrap_or(u64::MAX)
            .saturating_mul(BITS_PER_BYTE);
        Duration::from_nanos(bits.saturating_mul(1_000_000_000) / u64::from(self.baud.max(1)))
    }
}

/// Serves a device on a wire, at the pace of a half-duplex line. The device gets a wire without pacing.
///
/// Each byte takes its time in both directions, and a reply begins `turnaround` after the request's last byte however
/// fast the device is. Bytes received together are delivered at the end of the last one. Times continue from when the
/// line was free, not from when this task woke up, so that delays do not add up.
pub async fn paced<T, F: Future<Output = T>>(
    wire: impl Wire,
    pace: LinePace,
    device: impl FnOnce(Pipe) -> F,
) -> T {
    let (near, far) = pair();
    let line = PacedLine {
        wire,
        device: far,
        pace,
        timer: Timer::default(),
        free_at: Instant::now(),
        asked: false,
    };
    let served = device(near);
    tokio::pin!(served);
    tokio::select! {
        biased;
        _ended = line.carry() => {}
        done = &mut served => return done,
    }
    // The line is closed, which the device detects by itself.
    served.await
}

struct PacedLine<W> {
    wire: W,
    device: Pipe,
    pace: LinePace,
    timer: Timer,
    /// Time at which the line has carried all bytes given to it.
    free_at: Instant,
    /// The last bytes were a request's.
    asked: bool,
}

impl<W: Wire> PacedLine<W> {
    /// Transfers bytes until either end closes.
    async fn carry(mut self) -> io::Result<()> {
        let (mut request, mut reply) = ([0; PIPE_LEN], [0; PIPE_LEN]);
        loop {
            tokio::select! {
                biased;
                read = self.device.read(&mut reply) => match read? {
                    0 => return Ok(()),
                    len => self.reply(reply.get(..len).unwrap_or_default()).await?,
                },
                read = self.wire.read(&mut request) => match read? {
                    0 => return Ok(()),
                    len => self.request(request.get(..len).unwrap_or_default()).await?,
                },
            }
        }
    }

    async fn request(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.pass(Instant::now(), bytes.len()).await;
        self.asked = true;
        self.device.write_all(bytes).await
    }

    async fn reply(&mut self, bytes: &[u8]) -> io::Result<()> {
        let turned = self.free_at + self.pace.turnaround;
        let from = if self.asked { turned } else { self.free_at };
        self.pass(from.max(Instant::now()), bytes.len()).await;
        self.asked = false;
        self.wire.write_all(bytes).await?;
        self.wire.flush().await
    }

    /// Waits while this many bytes are on the line, starting at `from` or when the line is free.
    async fn pass(&mut self, from: Instant, bytes: usize) {
        self.free_at = self.free_at.max(from) + self.pace.time_of(bytes);
        self.timer.until(self.free_at).await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers each request of 9 bytes with a reply of this length.
    async fn device(mut wire: Pipe, reply: usize) {
        let mut request = [0; 9];
        while wire.read_exact(&mut request).await.is_ok() {
            wire.write_all(&vec![7; reply]).await.unwrap();
        }
    }

    #[tokio::test(start_paused = true)]
    async fn both_directions_and_the_turnaround_take_their_time_and_nothing_adds_up() {
        for (baud, turnaround, exchange_us) in [
            (115_200, Duration::from_millis(6), 781.25 + 6000.0 + 6944.4),
            (921_600, Duration::ZERO, 97.66 + 868.06),
            (
                19_200,
                Duration::from_millis(15),
                4687.5 + 15_000.0 + 41_666.7,
            ),
        ] {
            let pace = LinePace { baud, turnaround };
            let (mut near, far) = pair();
            tokio::spawn(paced(far, pace, |wire| device(wire, 80)));
            let begun = Instant::now();
            let mut reply = [0; 80];
            for _ in 0..100 {
                near.write_all(&[1; 9]).await.unwrap();
                near.read_exact(&mut reply).await.unwrap();
            }
            // The test's clock has a resolution of a millisecond, so each of the two waits may end one late.
            let took = begun.elapsed().as_secs_f64() * 1e4;
            assert!(
                (exchange_us - 1.0..exchange_us + 2000.0).contains(&took),
                "{baud}: {took} us"
            );
        }
    }

    #[tokio::test(start_paused = true)]
    async fn hanging_up_ends_it_at_both_ends() {
        let pace = LinePace {
            baud: 9600,
            turnaround: Duration::ZERO,
        };
        let (near, far) = pair();
        let served = tokio::spawn(paced(far, pace, |wire| device(wire, 8)));
        drop(near);
        served.await.unwrap();
        let (mut near, far) = pair();
        paced(far, pace, |_wire| async {}).await;
        assert_eq!(near.read(&mut [0; 8]).await.unwrap(), 0);
    }
}
