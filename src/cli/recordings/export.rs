//! `export`: a session, or a stretch of it, in a format of others; `recover`: a damaged one made whole again.

use crate::cli::out::{Out, WrongUsage, say};
use crate::cli::recordings::picture;
use crate::cli::recordings::session_file::{self, FileArgs, StretchArgs, lost};
use crate::record::export::lerobot::LeRobotPlan;
use crate::record::export::{ExportError, Exported, csv, cut, lerobot, parquet, rosbag};
use crate::record::file::SessionFile;
use anyhow::{anyhow, bail};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Frames a second, as cameras have it.
const FPS: u32 = 30;

#[derive(Debug, clap::Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    file: FileArgs,
    #[command(flatten)]
    form: FormArgs,
    #[command(flatten)]
    stretch: StretchArgs,
    /// The file or folder to write; it must not exist yet
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    /// With --lerobot: frames a second [default: 30]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=200))]
    fps: Option<u32>,
    /// With --lerobot: what the hand does, in words [default: grasp]
    #[arg(long, value_name = "WORDS")]
    task: Option<String>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The format, one of these.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct FormArgs {
    /// Comma-separated values, one line for each moment of receipt
    #[arg(long)]
    csv: bool,
    /// A Parquet table, one row for each reading
    #[arg(long)]
    parquet: bool,
    /// A rosbag2 folder for ROS 2
    #[arg(long)]
    rosbag: bool,
    /// A session file again, with its own index
    #[arg(long)]
    mcap: bool,
    /// A LeRobot v3.0 data set without video
    #[arg(long)]
    lerobot: bool,
    /// A picture of the window, its plots over the stretch
    #[arg(long)]
    png: bool,
}

#[derive(Debug, clap::Args)]
pub(crate) struct RecoverArgs {
    #[command(flatten)]
    file: FileArgs,
    /// The copy to write; it must not exist yet [default: FILE-recovered.mcap, beside the file]
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl ExportArgs {
    fn plan(&self) -> LeRobotPlan {
        LeRobotPlan {
            fps: self.fps.unwrap_or(FPS),
            task: self.task.clone().unwrap_or_else(|| "grasp".into()),
        }
    }
}

/// Exports.
pub(crate) fn run(out: &mut Out, args: &ExportArgs) -> anyhow::Result<()> {
    // clap does not ask for a flag that another one of its group rules out.
    if !args.form.lerobot && (args.fps.is_some() || args.task.is_some()) {
        return Err(WrongUsage::error(
            "--fps and --task are for --lerobot; leave them out, or export with --lerobot",
        ));
    }
    let file = session_file::open(&args.file.file)?;
    let stretch = args.stretch.of(&file)?;
    let form = &args.form;
    if form.png {
        return picture(out, args, &file);
    }
    let (done, what) = if form.csv {
        (csv::write(&file, stretch, &args.out), "lines")
    } else if form.parquet {
        (parquet::write(&file, stretch, &args.out), "rows")
    } else if form.rosbag {
        (rosbag::write(&file, stretch, &args.out), "messages")
    } else if form.lerobot {
        let plan = args.plan();
        (lerobot::write(&file, stretch, &args.out, &plan), "frames")
    } else {
        (cut::write(&file, stretch, &args.out), "entries")
    };
    let exported = done.map_err(told)?;
    if let Some(words) = lost(exported.damage) {
        say(&format!("{} is damaged: {words}", args.file.file.display()));
    }
    let line = format!("{} {what} in {}", exported.rows, args.out.display());
    out.result(args.json, &as_json(&args.out, exported), [line])
}

/// Draws the window.
fn picture(out: &mut Out, args: &ExportArgs, file: &SessionFile) -> anyhow::Result<()> {
    let drawn = picture::draw(file, args.stretch.of(file)?, &args.out);
    drawn.map_err(|error| match error.downcast() {
        Ok(error) => told(error),
        Err(error) => error,
    })?;
    let exported = Exported {
        rows: 1,
        ..Exported::default()
    };
    let line = format!("1 picture in {}", args.out.display());
    out.result(args.json, &as_json(&args.out, exported), [line])
}

/// Writes a whole copy of a file that is damaged or was not closed.
pub(crate) fn recover(out: &mut Out, args: &RecoverArgs) -> anyhow::Result<()> {
    let path = &args.file.file;
    let file = session_file::open(path)?;
    let to = args.out.clone().unwrap_or_else(|| beside(path));
    let recovered = cut::recover(&file, &to).map_err(told)?;
    let mut lines = vec![format!("{} entries in {}", recovered.rows, to.display())];
    lines.push(match (lost(recovered.damage), file.is_closed()) {
        (Some(words), _) => format!("lost: {words}"),
        (None, true) => "nothing was lost: the file was whole".into(),
        (None, false) => "nothing that was on the disk was lost; the file was not closed".into(),
    });
    let mut object = as_json(&to, recovered);
    if let Some(fields) = object.as_object_mut() {
        fields.insert("was_closed".into(), file.is_closed().into());
    }
    out.result(args.json, &object, lines)?;
    if recovered.rows == 0 {
        bail!("{} holds no entry that can be read", path.display());
    }
    Ok(())
}

fn beside(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-recovered.mcap"))
}

fn as_json(path: &Path, exported: Exported) -> serde_json::Value {
    json!({
        "file": path,
        "rows": exported.rows,
        "damaged_chunks": exported.damage.chunks,
        "damaged_bytes": exported.damage.bytes,
    })
}

/// An error of an export, with what to do.
pub(crate) fn told(error: ExportError) -> anyhow::Error {
    match error {
        ExportError::Exists { .. } => anyhow!("{error}; name another place with --out"),
        ExportError::Unwritable { .. } => {
            anyhow!("{error}; choose a folder that exists and has room")
        }
        ExportError::Unreadable { .. } => anyhow!("{error}; nothing was written"),
        ExportError::Empty => anyhow!("{error}; choose another with --from and --to"),
    }
}
