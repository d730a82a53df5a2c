//! How near the link comes to what a serial line can give: full cycles over a pseudo-terminal that keeps the time of a
//! line, against the sum of the bytes.

use crate::cycles::{Server, measure};
use crate::report::{Aim, Failure, Report};
use handscope::sim::serve::pty;
use handscope::transport::LinePace;
use std::path::Path;
use std::time::Duration;

/// The hand's own time: the middle of what was measured, 3 to 15 ms.
const TURNAROUND: Duration = Duration::from_millis(6);
/// Until the link has learnt the turnaround and windows have their length.
const WARM: Duration = Duration::from_secs(3);
/// How long is counted, and how often; the middle one counts.
const COUNTED: Duration = Duration::from_secs(4);
const TIMES: usize = 3;
/// What the link is to reach of the line's own rate.
const SHARE: f64 = 97.0;

#[derive(Clone, Copy)]
enum Protocol {
    Rs485,
    Rtu,
}

impl Protocol {
    const fn name(self) -> &'static str {
        match self {
            Self::Rs485 => "rs485",
            Self::Rtu => "rtu",
        }
    }

    /// Bytes of a read request and of its reply around the data, and the silence between frames (manual 2.2, 2.4).
    const fn frames(self) -> (f64, Duration) {
        match self {
            Self::Rs485 => (9.0 + 8.0, Duration::ZERO),
            Self::Rtu => (8.0 + 5.0, Duration::from_micros(1750)),
        }
    }

    /// Time on the line and in the hand of a read of so many bytes.
    fn read_s(self, baud: u32, bytes: f64) -> f64 {
        let (around, gap) = self.frames();
        10.0 * (around + bytes) / f64::from(baud) + (TURNAROUND + gap).as_secs_f64()
    }

    /// Cycles a second that the line gives: angles to status in one read of 72 bytes, fingertips in two of 290 together.
    fn alone(self, baud: u32) -> f64 {
        let cycle = [72.0, 290.0 / 2.0, 290.0 / 2.0];
        1.0 / cycle
            .map(|bytes| self.read_s(baud, bytes))
            .iter()
            .sum::<f64>()
    }

    /// The same beside the slow groups, which are read in any case: six temperatures more in five states a second, and
    /// the 48 bytes of the setpoints twice a second.
    fn could(self, baud: u32) -> f64 {
        let temperatures = 5.0 * 10.0 * 6.0 / f64::from(baud);
        let setpoints = 2.0 * self.read_s(baud, 48.0);
        self.alone(baud) * (1.0 - temperatures - setpoints)
    }
}

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    for protocol in [Protocol::Rs485, Protocol::Rtu] {
        for baud in [115_200, 921_600] {
            line(report, protocol, baud)?;
        }
    }
    Ok(())
}

fn line(report: &mut Report, protocol: Protocol, baud: u32) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let server = serve(protocol, &folder.path().join("hand"), baud)?;
    let mut runs = (0..TIMES)
        .map(|_| measure(&server.endpoint, WARM, COUNTED))
        .collect::<Result<Vec<_>, _>>()?;
    runs.sort_by(|a, b| a.cycles.total_cmp(&b.cycles));
    let middle = runs.get(TIMES / 2).ok_or("nothing was measured")?;
    let could = protocol.could(baud);
    let name = protocol.name();
    let what = format!("{name} at {baud} baud, hand of 6 ms: cycles and nothing else");
    report.row(&what, protocol.alone(baud), "cycles/s", Aim::None)?;
    let beside = "  what the line gives beside temperatures and setpoints";
    report.row(beside, could, "cycles/s", Aim::None)?;
    report.row("  reached", middle.cycles, "cycles/s", Aim::None)?;
    let share = middle.cycles / could * 100.0;
    report.row("  share of that", share, "%", Aim::AtLeast(SHARE))?;
    let used = middle.stats.line.utilisation * 100.0;
    report.row("  line utilisation", used, "%", Aim::None)?;
    report.row(
        "  requests that failed",
        middle.failed,
        "",
        Aim::AtMost(0.0),
    )
}

/// A hand of 6 ms on a line at this speed, in the maker's framing.
pub(crate) fn rs485(path: &Path, baud: u32) -> Result<Server, Failure> {
    serve(Protocol::Rs485, path, baud)
}

fn serve(protocol: Protocol, path: &Path, baud: u32) -> Result<Server, Failure> {
    let endpoint = format!("{}:{}?baud={baud}", protocol.name(), path.display()).parse()?;
    let pace = Some(LinePace {
        baud,
        turnaround: TURNAROUND,
    });
    let made = path.to_path_buf();
    let server = Server::start(endpoint, async move |hand| {
        match protocol {
            Protocol::Rs485 => pty::serve_rs485(hand, &made, pace)?.await,
            Protocol::Rtu => pty::serve_rtu(hand, &made, pace)?.await,
        }
        Ok(())
    })?;
    crate::cycles::wait_for(path);
    Ok(server)
}
