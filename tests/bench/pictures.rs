//! Pictures without a display: time of one at 1440x900, and from the start of the process to its first file.

use crate::clock::{Sorted, millis, wall_and_cpu_ms};
use crate::report::{Aim, Failure, Report};
use handscope::app::settings::{Language, Theme};
use handscope::shell::headless::driver::{Driver, Scene};
use handscope::shell::headless::png;
use handscope::transport::Endpoint;
use handscope::ui::View;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Pictures of one figure.
const PICTURES: usize = 30;
/// Starts of the program.
const STARTS: usize = 7;
/// How often the file is looked for.
const LOOK_EACH: Duration = Duration::from_micros(500);
/// A file that is not there by then will not come.
const FILE_WITHIN: Duration = Duration::from_secs(20);

pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    pictures(report)?;
    let mut taken = Vec::with_capacity(STARTS);
    for _ in 0..STARTS {
        taken.push(millis(first_file()?));
    }
    let taken = Sorted::new(taken);
    report.row(
        "snapshot --at 3: process start to first file, median",
        taken.median(),
        "ms",
        Aim::AtMost(300.0),
    )?;
    report.row("  the fastest", taken.percentile(0), "ms", Aim::None)
}

fn pictures(report: &mut Report) -> Result<(), Failure> {
    let mut driver = Driver::start(&Scene {
        endpoint: Endpoint::Sim {
            seed: 1,
            scenario: "grasp".into(),
            body: None,
            object: None,
        },
        size: (1440, 900),
        scale: 1.0,
        theme: Theme::Dark,
        language: Language::En,
    })?;
    driver.connect()?;
    driver.run_for(Duration::from_secs(3));
    let (mut drawn, mut encoded, mut cpu) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..PICTURES {
        driver.run_for(Duration::from_millis(20));
        let ([wall, drawing], picture) = wall_and_cpu_ms(|| driver.picture(View::Live));
        drawn.push(wall);
        let ([wall, encoding], bytes) = wall_and_cpu_ms(|| png::encode(&picture.rgb, picture.size));
        encoded.push(wall);
        cpu.push(drawing + encoding);
        std::hint::black_box(bytes?);
    }
    let both = drawn.iter().zip(&encoded).map(|(a, b)| a + b).collect();
    report.row(
        "one picture of 1440x900 as PNG, median",
        Sorted::new(both).median(),
        "ms",
        Aim::AtMost(40.0),
    )?;
    let (drawn, encoded) = (Sorted::new(drawn).median(), Sorted::new(encoded).median());
    report.row("  layout and drawing", drawn, "ms", Aim::None)?;
    report.row("  encoding", encoded, "ms", Aim::None)?;
    let what = "  all threads together";
    report.row(what, Sorted::new(cpu).median(), "ms cpu", Aim::None)
}

/// Runs the program once; the time until the picture stands in the folder.
fn first_file() -> Result<Duration, Failure> {
    let folder = tempfile::tempdir()?;
    let begun = Instant::now();
    let mut program = Command::new(env!("CARGO_BIN_EXE_handscope"))
        .args(["snapshot", "--scenario", "grasp", "--at", "3", "--out"])
        .arg(folder.path())
        .stdout(Stdio::null())
        .spawn()?;
    while !has_picture(folder.path())? {
        if begun.elapsed() > FILE_WITHIN || program.try_wait()?.is_some_and(|end| !end.success()) {
            program.kill()?;
            program.wait()?;
            return Err("snapshot made no file".into());
        }
        std::thread::sleep(LOOK_EACH);
    }
    let took = begun.elapsed();
    program.wait()?;
    Ok(took)
}

fn has_picture(folder: &Path) -> Result<bool, Failure> {
    for entry in std::fs::read_dir(folder)? {
        if entry?.path().extension().is_some_and(|end| end == "png") {
            return Ok(true);
        }
    }
    Ok(false)
}
