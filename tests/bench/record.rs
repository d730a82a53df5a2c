//! What recording one hand costs, and how fast a long recording is opened and read, which has a file for each hour.
//! `HANDSCOPE_BENCH_HOURS=10` makes it as long as the aims are about; that takes minutes, and 2 GB of the disk.

use crate::clock::{Sorted, millis, wall_and_cpu_ms};
use crate::cycles::count;
use crate::memory::mib;
use crate::report::{Aim, Failure, Report, line};
use handscope::app::connect::SimDial;
use handscope::hand::kinematics::Side;
use handscope::hand::{HandSample, Moment, PerDof, Timed};
use handscope::link::{Clock, LinkConfig, PollRates, open};
use handscope::record::file::reader::{RecordingFile, TimeRange};
use handscope::record::file::writer::RecordingWriter;
use handscope::record::file::{
    FLUSH_INTERVAL, Opening, PART_LENGTH, Part, Recorder, RecordingPlan, SystemDisk,
};
use handscope::record::{Entry, Record};
use handscope::transport::Endpoint;
use std::fs::File;
use std::io::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The word that makes this program the one that opens a file.
pub(crate) const CHILD: &str = "--opens";
/// How long the built-in hand is recorded; all else is made of that.
const SOURCE: Duration = Duration::from_secs(20);
/// How long the cost is measured.
const COUNTED: Duration = Duration::from_secs(20);
/// Between two gifts of a link to its recorder.
const GIVE_EACH: Duration = Duration::from_millis(10);
/// Hours, if nobody says otherwise.
const HOURS: u32 = 1;
/// Places in a file that are read.
const PLACES: u32 = 100;
/// What a person sees of a plot at once.
const STRETCH: Duration = Duration::from_secs(60);

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("source.mcap");
    let megabytes = source(&path)?;
    let what = "recording one hand: size of the file";
    report.row(what, megabytes, "MB/h", Aim::AtMost(200.0))?;
    let entries = read(&path)?;
    cost(report, &entries, &folder.path().join("cost.mcap"))?;
    let hours = std::env::var("HANDSCOPE_BENCH_HOURS");
    let hours = hours.map_or(Ok(HOURS), |hours| hours.parse())?;
    let long = folder.path().join("long.mcap");
    let (mut writer, mut file) = write(report, &entries, &long, hours)?;
    opened(report, &long, &format!("{hours} h, never ended"))?;
    let before = mib("VmRSS:")?;
    end(&mut writer, &mut file)?;
    let what = "  memory that ending it took";
    report.row(what, mib("VmRSS:")? - before, "MiB", Aim::AtMost(24.0))?;
    drop((writer, file));
    opened(report, &long, &format!("{hours} h, ended"))
}

fn opening() -> Opening {
    Opening {
        base_nanos: 1_795_219_200_000_000_000,
        began: Moment::ZERO,
        hand: "sim:".into(),
        simulated: true,
        side: Side::Right,
        newtons_per_g: PerDof::splat(None),
        version: "bench".into(),
        part: None,
    }
}

fn plan(path: &Path) -> RecordingPlan {
    RecordingPlan {
        path: path.to_owned(),
        opening: opening(),
        disk: Arc::new(SystemDisk),
        part_length: PART_LENGTH,
    }
}

/// Records the built-in hand as the program does; megabytes an hour.
fn source(path: &Path) -> Result<f64, Failure> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()?;
    let clock = runtime.block_on(async { Clock::start() });
    let config = LinkConfig {
        endpoint: Endpoint::sim(),
        rates: PollRates::default(),
        clock,
        dial: Arc::new(SimDial::new(clock)),
        wake: Arc::new(|| ()),
    };
    let recorder = Recorder::start(plan(path))?;
    let (link, _records) = open(config, runtime.handle());
    let pump = handscope::link::entries::record(link.observe(), recorder.input(), clock);
    runtime.spawn(pump);
    sleep(SOURCE);
    let status = recorder.end();
    let megabytes = status.megabytes_an_hour();
    Ok(megabytes.ok_or("nothing was recorded")?)
}

fn read(path: &Path) -> Result<Vec<Entry>, Failure> {
    let file = RecordingFile::open(path)?;
    let mut entries = Vec::new();
    let all = TimeRange {
        from: Moment::from_micros(1_000_000),
        to: file.last(),
        wire: true,
    };
    file.entries(all, |entry| {
        entries.push(entry);
        ControlFlow::Continue(())
    })?;
    Ok(entries)
}

/// The entries again and again, each time later.
fn on_and_on(entries: &[Entry]) -> impl Iterator<Item = Entry> {
    let first = entries.first().map_or(Moment::ZERO, Entry::at);
    let last = entries.last().map_or(Moment::ZERO, Entry::at);
    let round = last.since(first);
    (0..u32::MAX).flat_map(move |nth| {
        entries
            .iter()
            .map(move |entry| later(entry.clone(), round * nth))
    })
}

fn later(mut entry: Entry, by: Duration) -> Entry {
    match &mut entry {
        Entry::Heard(Record::Reading { sample, .. }) => move_on(Arc::make_mut(sample), by),
        Entry::Heard(
            Record::State { at, .. }
            | Record::Sent { at, .. }
            | Record::Answered { at, .. }
            | Record::ArmRefused { at, .. },
        ) => *at = at.plus(by),
        Entry::Wire(piece) => piece.at = piece.at.plus(by),
        Entry::Link(report) => report.at = report.at.plus(by),
        Entry::Event(event) => event.at = event.at.plus(by),
    }
    entry
}

fn move_on(sample: &mut HandSample, by: Duration) {
    fn one<T>(timed: &mut Option<Timed<T>>, by: Duration) {
        if let Some(timed) = timed {
            timed.asked = timed.asked.plus(by);
            timed.received = timed.received.plus(by);
        }
    }
    one(&mut sample.angle_set, by);
    one(&mut sample.force_set, by);
    one(&mut sample.speed_set, by);
    one(&mut sample.position, by);
    one(&mut sample.angle, by);
    one(&mut sample.force, by);
    one(&mut sample.current, by);
    one(&mut sample.faults, by);
    one(&mut sample.status, by);
    one(&mut sample.temperature, by);
    for finger in handscope::hand::Finger::ALL {
        one(&mut sample.tactile[finger], by);
    }
}

/// What the thread takes while entries come as a link gives them.
fn cost(report: &mut Report, entries: &[Entry], path: &Path) -> Result<(), Failure> {
    let rate = count(u64::try_from(entries.len())?) / SOURCE.as_secs_f64();
    report.row("  entries given", rate, "1/s", Aim::None)?;
    let giving = give(entries, |entry| drop(std::hint::black_box(entry)));
    let before = mib("VmRSS:")?;
    let recorder = Recorder::start(plan(path))?;
    let input = recorder.input();
    let share = give(entries, |entry| input.push(entry)) - giving;
    report.row("  share of a core", share, "%", Aim::AtMost(1.0))?;
    let what = "  memory after the first seconds";
    report.row(what, mib("VmRSS:")? - before, "MiB", Aim::AtMost(30.0))?;
    let status = recorder.end();
    let missing = count(status.missing);
    report.row(
        "  entries that found no room",
        missing,
        "",
        Aim::AtMost(0.0),
    )
}

/// Gives entries as they come, for a while; the share of a core that this process took, in hundredths.
fn give(entries: &[Entry], mut take: impl FnMut(Entry)) -> f64 {
    let mut all = on_and_on(entries).peekable();
    let first = all.peek().map_or(Moment::ZERO, Entry::at);
    let began = Instant::now();
    let ([wall, cpu], ()) = wall_and_cpu_ms(|| {
        while began.elapsed() < COUNTED {
            while let Some(entry) = all.next_if(|entry| entry.at().since(first) <= began.elapsed())
            {
                take(entry);
            }
            sleep(GIVE_EACH);
        }
    });
    cpu / wall * 100.0
}

/// Makes a long recording without the end of its last file.
fn write(
    report: &mut Report,
    entries: &[Entry],
    path: &Path,
    hours: u32,
) -> Result<(RecordingWriter, File), Failure> {
    let before = mib("VmRSS:")?;
    let mut all = on_and_on(entries).peekable();
    let (mut cpu_ms, mut written, mut bytes) = (0.0, 0, 0);
    let mut last = None;
    for number in 1..=hours {
        if let Some((writer, file)) = &mut last {
            end(writer, file)?;
        }
        let until = Moment::ZERO.plus(PART_LENGTH * number);
        let opening = Opening {
            began: Moment::ZERO.plus(PART_LENGTH * (number - 1)),
            part: Some(Part {
                recording_began: Moment::ZERO,
                number,
            }),
            ..opening()
        };
        let (writer, file) = last.insert((
            RecordingWriter::new(&opening)?,
            File::create(match number {
                1 => path.to_owned(),
                number => path.with_file_name(format!("long-{number}.mcap")),
            })?,
        ));
        let hour = std::iter::from_fn(|| all.next_if(|entry| entry.at() < until));
        let ([_, cpu], count) = wall_and_cpu_ms(|| write_hour(hour, writer, file));
        (cpu_ms, written) = (cpu_ms + cpu, written + count?);
        bytes += file.metadata()?.len();
    }
    let what = "making the bytes of one entry";
    report.row(what, cpu_ms * 1000.0 / count(written), "us cpu", Aim::None)?;
    let what = format!("memory of the writer after {hours} h");
    report.row(&what, mib("VmRSS:")? - before, "MiB", Aim::AtMost(30.0))?;
    let what = format!("size of the files of {hours} h");
    report.row(&what, count(bytes / 1_000_000), "MB", Aim::None)?;
    last.ok_or_else(|| "no hour was written".into())
}

/// How many entries there were.
fn write_hour(
    entries: impl Iterator<Item = Entry>,
    writer: &mut RecordingWriter,
    file: &mut File,
) -> Result<u64, Failure> {
    let (mut flushed, mut written) = (Moment::ZERO, 0);
    for entry in entries {
        if entry.at().since(flushed) >= FLUSH_INTERVAL {
            flushed = entry.at();
            writer.flush()?;
            file.write_all(&writer.take_bytes())?;
        }
        writer.push(&entry)?;
        written += 1;
    }
    writer.flush()?;
    file.write_all(&writer.take_bytes())?;
    Ok(written)
}

fn end(writer: &mut RecordingWriter, file: &mut File) -> Result<(), Failure> {
    writer.finish()?;
    Ok(file.write_all(&writer.take_bytes())?)
}

/// Has another process open a file and read in it.
fn opened(report: &mut Report, path: &Path, what: &str) -> Result<(), Failure> {
    let mut command = Command::new(std::env::current_exe()?);
    let output = command.arg(CHILD).arg(path).output()?;
    let text = String::from_utf8(output.stdout)?;
    let figures: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    let [open, plot, plot_slow, moment, moment_slow, memory] = *figures?.as_slice() else {
        return Err(format!("the measured process said '{text}'").into());
    };
    let to_overview = format!("a file of {what}: to its overview");
    report.row(&to_overview, open, "ms", Aim::AtMost(500.0))?;
    report.row("  60 s of readings, median", plot, "ms", Aim::None)?;
    report.row("  60 s of readings, 99 of 100", plot_slow, "ms", Aim::None)?;
    report.row("  a moment, median", moment, "ms", Aim::None)?;
    report.row(
        "  a moment, 99 of 100",
        moment_slow,
        "ms",
        Aim::AtMost(50.0),
    )?;
    report.row("  memory at most", memory, "MiB", Aim::AtMost(286.0))
}

/// Opens a file, reads at many places, and says how long that took, and how much memory.
pub(crate) fn child(path: &Path) -> Result<(), Failure> {
    let begun = Instant::now();
    let file = RecordingFile::open(path)?;
    let open = millis(begun.elapsed());
    let mut random = fastrand::Rng::with_seed(1);
    let length = file.last().since(file.first()).saturating_sub(STRETCH);
    let mut timed = |long: Duration| -> Result<Sorted, Failure> {
        let mut figures = Vec::new();
        for _ in 0..PLACES {
            let from = file.first().plus(length.mul_f64(random.f64()));
            let stretch = TimeRange {
                from,
                to: from.plus(long),
                wire: false,
            };
            let begun = Instant::now();
            file.entries(stretch, |entry| {
                std::hint::black_box(&entry);
                ControlFlow::Continue(())
            })?;
            figures.push(millis(begun.elapsed()));
        }
        Ok(Sorted::new(figures))
    };
    let (plot, moment) = (timed(STRETCH)?, timed(Duration::ZERO)?);
    line(&format!(
        "{open} {} {} {} {} {}",
        plot.median(),
        plot.percentile(99),
        moment.median(),
        moment.percentile(99),
        mib("VmHWM:")?
    ))
}
