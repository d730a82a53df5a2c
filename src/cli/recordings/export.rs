//! `export`: writes recordings, or a time range of each, in another format; `recover`: repairs a damaged one.

use crate::cli::out::ending::EndFlag;
use crate::cli::out::progress::Progress;
use crate::cli::out::{Out, ReaderGone, WrongUsage, notify};
use crate::cli::recordings::picture;
use crate::cli::recordings::recording_file::{
    self, FileArgs, StretchArgs, is_standard, lost, report_remarks,
};
use crate::record::export::lerobot::{EpisodeStart, LeRobotPlan, LeRobotSet};
use crate::record::export::output::Folder;
use crate::record::export::{
    Destination, ExportError, ExportSource, Exported, csv, cut, lerobot, parquet, rosbag,
};
use crate::record::file::RecordingFile;
use crate::record::file::reader::TimeRange;
use anyhow::{anyhow, bail};
use serde_json::json;
use std::io::{self, IsTerminal as _};
use std::path::{Path, PathBuf};

/// Frame rate in frames per second; typical for cameras.
const FPS: u32 = 30;

#[derive(Debug, clap::Args)]
pub(crate) struct ExportArgs {
    /// Recording files, as 'handscope record' and the window write them; - reads one from standard input
    #[arg(value_name = "FILE.mcap", required = true, num_args = 1..)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    form: FormArgs,
    #[command(flatten)]
    stretch: StretchArgs,
    /// The file or folder to write, which must not exist yet; of several recordings a folder; - is standard output
    #[arg(long, value_name = "PATH")]
    out: PathBuf,
    /// With --lerobot: frames a second [default: 30]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=200))]
    fps: Option<u32>,
    /// With --lerobot: what the hand does, in words [default: the note that begins the episode, or grasp]
    #[arg(long, value_name = "WORDS")]
    task: Option<String>,
    /// With --lerobot: where an episode begins: after a silence, or at each note [default: gaps]
    #[arg(long, value_name = "WHERE")]
    episode: Option<Episodes>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Where episodes begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Episodes {
    Gaps,
    Notes,
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
    /// A recording file again, with its own index
    #[arg(long)]
    mcap: bool,
    /// A LeRobot v3.0 data set without video
    #[arg(long)]
    lerobot: bool,
    /// A picture of the window, its plots over the stretch
    #[arg(long)]
    png: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Csv,
    Parquet,
    Rosbag,
    Mcap,
    LeRobot,
    Png,
}

impl FormArgs {
    fn form(&self) -> Form {
        match self {
            Self { csv: true, .. } => Form::Csv,
            Self { parquet: true, .. } => Form::Parquet,
            Self { rosbag: true, .. } => Form::Rosbag,
            Self { lerobot: true, .. } => Form::LeRobot,
            Self { png: true, .. } => Form::Png,
            _ => Form::Mcap,
        }
    }
}

impl Form {
    /// File extension; `None` for folders.
    const fn ending(self) -> Option<&'static str> {
        match self {
            Self::Csv => Some("csv"),
            Self::Parquet => Some("parquet"),
            Self::Mcap => Some("mcap"),
            Self::Png => Some("png"),
            Self::Rosbag | Self::LeRobot => None,
        }
    }

    /// Unit of the reported count.
    const fn rows(self) -> &'static str {
        match self {
            Self::Csv => "lines",
            Self::Parquet => "rows",
            Self::Rosbag => "messages",
            Self::Mcap => "entries",
            Self::LeRobot => "frames",
            Self::Png => "picture",
        }
    }
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

pub(crate) fn run(out: &mut Out, args: &ExportArgs) -> anyhow::Result<()> {
    let form = args.form.form();
    args.check(form)?;
    let mut files: Vec<RecordingFile> = Vec::new();
    for path in &args.files {
        // Several files of one recording, as matched by a pattern like *.mcap, are one recording.
        let file = path.canonicalize();
        let file = file.unwrap_or_else(|_unknown| path.clone());
        let is_it =
            |open: &Path| open.canonicalize().is_ok_and(|open| open == file) || open == path;
        if !files.iter().flat_map(RecordingFile::paths).any(is_it) {
            files.push(recording_file::open_or_stdin(path)?);
        }
    }
    files.iter().for_each(report_remarks);
    let named = |file: &RecordingFile| match args.stretch.of(file) {
        Err(why) if files.len() > 1 => Err(why.context(file.path().display().to_string())),
        stretch => stretch,
    };
    let stretches: Vec<TimeRange> = files.iter().map(named).collect::<anyhow::Result<_>>()?;
    if form == Form::Png {
        let (Some(file), Some(stretch)) = (files.first(), stretches.first()) else {
            return Ok(());
        };
        return picture(out, args, file, *stretch);
    }
    let to_stdout = is_standard(&args.out);
    // Standard output leaves no partial file, and its reader may stop reading.
    let wished = if to_stdout {
        EndFlag::never()
    } else {
        EndFlag::listen()?
    };
    let work = ExportJob {
        files: &files,
        stretches: &stretches,
        form,
        wished,
        progress: Progress::new(),
    };
    let done = match form {
        Form::LeRobot => work.lerobot(&args.out, &args.plan()),
        _ if to_stdout => work.one_by_one(&[Destination::Stdout]),
        _ if files.len() == 1 => work.one_by_one(&[Destination::Path(args.out.clone())]),
        _ => work.to_folder(&args.out),
    };
    drop(work.progress);
    let done = done.map_err(explained)?;
    done.report(out, args, &files)
}

impl ExportArgs {
    /// Checks that clap cannot do.
    fn check(&self, form: Form) -> anyhow::Result<()> {
        // clap does not require a flag that conflicts with another one of its group.
        let of_sets = self.fps.is_some() || self.task.is_some() || self.episode.is_some();
        if form != Form::LeRobot && of_sets {
            return Err(WrongUsage::error(
                "--fps, --task and --episode are for --lerobot; leave them out, or export with --lerobot",
            ));
        }
        let from_stdin = self.files.iter().filter(|file| is_standard(file)).count();
        if from_stdin > 1 {
            return Err(WrongUsage::error(
                "standard input holds one file: write - once",
            ));
        }
        if form == Form::Png && (self.files.len() > 1 || from_stdin > 0) {
            return Err(WrongUsage::error(
                "--png draws one recording: name its file",
            ));
        }
        if !is_standard(&self.out) {
            return Ok(());
        }
        let why = match form {
            _ if self.files.len() > 1 => {
                "of several recordings a folder is made: name it with --out"
            }
            Form::Rosbag | Form::LeRobot => "this format is a folder: name it with --out",
            Form::Png => "a picture is a file: name it with --out",
            _ if self.json => "standard output holds what is exported: leave out --json",
            Form::Csv => return Ok(()),
            _ if io::stdout().is_terminal() => {
                "this format is no text for a terminal: pipe it into a program, or name a file with --out"
            }
            _ => return Ok(()),
        };
        Err(WrongUsage::error(why))
    }

    fn plan(&self) -> LeRobotPlan {
        LeRobotPlan {
            fps: self.fps.unwrap_or(FPS),
            task: self.task.clone(),
            episodes: match self.episode {
                Some(Episodes::Notes) => EpisodeStart::Note,
                Some(Episodes::Gaps) | None => EpisodeStart::Gap,
            },
        }
    }
}

/// A complete export job.
struct ExportJob<'a> {
    files: &'a [RecordingFile],
    stretches: &'a [TimeRange],
    form: Form,
    wished: EndFlag,
    progress: Progress,
}

struct ExportedFiles {
    recordings: Vec<Exported>,
    set: Option<LeRobotSet>,
}

impl ExportJob<'_> {
    /// Passes a recording to `give`, with progress over all recordings.
    fn watched<T>(
        &self,
        number: usize,
        give: impl FnOnce(ExportSource<'_>) -> Result<T, ExportError>,
    ) -> Option<Result<T, ExportError>> {
        let (file, stretch) = (self.files.get(number)?, self.stretches.get(number)?);
        let watch = |share: f64| {
            self.progress
                .report(share_of_all(number, share, self.files.len()));
            self.wished.flow()
        };
        Some(give(ExportSource {
            file,
            stretch: *stretch,
            watch: &watch,
        }))
    }

    fn one_by_one(&self, places: &[Destination]) -> Result<ExportedFiles, ExportError> {
        let mut recordings = Vec::new();
        for (number, to) in places.iter().enumerate() {
            let export = |source: ExportSource<'_>| match (self.form, to) {
                (Form::Csv, _) => csv::write(source, to),
                (Form::Parquet, _) => parquet::write(source, to),
                (Form::Rosbag, Destination::Path(path)) => rosbag::write(source, path),
                _ => cut::write(source, to),
            };
            recordings.extend(match self.watched(number, export) {
                // Other recordings may have data if this one has none.
                Some(Err(ExportError::Empty)) if places.len() > 1 => Some(Exported::default()),
                exported => exported.transpose()?,
            });
        }
        Ok(ExportedFiles {
            recordings,
            set: None,
        })
    }

    /// Writes each recording into a file of its own, named after it.
    fn to_folder(&self, out: &Path) -> Result<ExportedFiles, ExportError> {
        let folder = Folder::new(out)?;
        let mut places: Vec<Destination> = Vec::new();
        for name in self.files.iter().map(RecordingFile::path) {
            let stem = if is_standard(name) {
                "stdin".into()
            } else {
                name.file_stem().unwrap_or_default().to_string_lossy()
            };
            let ending = self.form.ending().map(|ending| format!(".{ending}"));
            let ending = ending.unwrap_or_default();
            let named = |number: usize| match number {
                1 => format!("{stem}{ending}"),
                more => format!("{stem}-{more}{ending}"),
            };
            // Recordings of different days may share a name.
            let free = (1..).map(|number| Destination::Path(folder.path().join(named(number))));
            places.extend(
                free.filter(|place| !places.contains(place))
                    .take(1)
                    .collect::<Vec<_>>(),
            );
        }
        let done = self.one_by_one(&places)?;
        folder.finish(done.recordings.iter().map(|one| one.rows).sum())?;
        Ok(done)
    }

    fn lerobot(&self, out: &Path, plan: &LeRobotPlan) -> Result<ExportedFiles, ExportError> {
        let shares = (0..self.files.len()).map(|number| {
            move |share: f64| {
                self.progress
                    .report(share_of_all(number, share, self.files.len()));
                self.wished.flow()
            }
        });
        let watches: Vec<_> = shares.collect();
        let recordings = self.files.iter().zip(self.stretches).zip(&watches);
        let sources: Vec<ExportSource<'_>> = recordings
            .map(|((file, stretch), watch)| ExportSource {
                file,
                stretch: *stretch,
                watch,
            })
            .collect();
        let set = lerobot::write(&sources, out, plan)?;
        Ok(ExportedFiles {
            recordings: set.recordings.clone(),
            set: Some(set),
        })
    }
}

/// Total progress when recording `number` is at this share.
fn share_of_all(number: usize, share: f64, all: usize) -> f64 {
    let count = |number: usize| f64::from(u32::try_from(number).unwrap_or(u32::MAX));
    (count(number) + share) / count(all.max(1))
}

impl ExportedFiles {
    fn report(
        &self,
        out: &mut Out,
        args: &ExportArgs,
        files: &[RecordingFile],
    ) -> anyhow::Result<()> {
        let form = args.form.form();
        let mut all = Exported::default();
        for (file, recording) in files.iter().zip(&self.recordings) {
            if let Some(words) = lost(&recording.damage) {
                notify(&format!("{} is damaged: {words}", file.path().display()));
            }
            if recording.rows == 0 && files.len() > 1 {
                notify(&format!(
                    "there is nothing to export of {}",
                    file.path().display()
                ));
            }
            all.rows += recording.rows;
            all.readings = recording.readings;
            all.damage.add(&recording.damage);
        }
        let mut line = format!("{} {} in {}", all.rows, form.rows(), args.out.display());
        let mut object = as_json(&args.out, &all);
        if let Some(set) = &self.set {
            line = format!("{line}, {} episodes", set.episodes);
            if let Some(fields) = object.as_object_mut() {
                fields.insert("episodes".into(), set.episodes.into());
                fields.insert("action_read_back_frames".into(), set.read_back.into());
            }
            warn_read_back(set);
        }
        if is_standard(&args.out) {
            notify(&format!("{} {}", all.rows, form.rows()));
        } else {
            out.result(args.json, &object, [line])?;
        }
        if all.readings == Some(0) {
            bail!(
                "the hand was not read in this stretch, so what was exported has no readings; 'handscope info' shows where that is so"
            );
        }
        Ok(())
    }
}

fn warn_read_back(set: &LeRobotSet) {
    if set.read_back > 0 {
        notify(&format!(
            "in {} of {} frames something else than the recorded commands set a target, another controller or the hand itself for a gesture: 'action' is there what the hand held when it was read, up to half a second late",
            set.read_back,
            set.frames()
        ));
    }
}

fn picture(
    out: &mut Out,
    args: &ExportArgs,
    file: &RecordingFile,
    stretch: TimeRange,
) -> anyhow::Result<()> {
    let drawn = picture::draw(file, stretch, &args.out);
    drawn.map_err(|error| match error.downcast() {
        Ok(error) => explained(error),
        Err(error) => error,
    })?;
    let exported = Exported {
        rows: 1,
        ..Exported::default()
    };
    let line = format!("1 picture in {}", args.out.display());
    out.result(args.json, &as_json(&args.out, &exported), [line])
}

/// Writes a repaired copy of a file that is damaged or was not closed.
pub(crate) fn recover(out: &mut Out, args: &RecoverArgs) -> anyhow::Result<()> {
    let path = &args.file.file;
    let file = recording_file::open(path)?;
    report_remarks(&file);
    let to = args.out.clone().unwrap_or_else(|| beside(path));
    let wished = EndFlag::listen()?;
    let progress = Progress::new();
    let watch = |share: f64| {
        progress.report(share);
        wished.flow()
    };
    let source = ExportSource {
        file: &file,
        stretch: TimeRange::WHOLE,
        watch: &watch,
    };
    let recovered = cut::recover(source, &Destination::Path(to.clone()));
    drop(progress);
    let recovered = recovered.map_err(explained)?;
    let mut lines = vec![format!("{} entries in {}", recovered.rows, to.display())];
    lines.push(match (lost(&recovered.damage), file.is_closed()) {
        (Some(words), _) => format!("lost: {words}"),
        (None, true) => "nothing was lost: the file was whole".into(),
        (None, false) => "nothing that was on the disk was lost; the file was not closed".into(),
    });
    let mut object = as_json(&to, &recovered);
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

fn as_json(path: &Path, exported: &Exported) -> serde_json::Value {
    json!({
        "file": path,
        "rows": exported.rows,
        "damaged_chunks": exported.damage.chunks,
        "damaged_bytes": exported.damage.bytes,
    })
}

/// An export error with advice.
pub(crate) fn explained(error: ExportError) -> anyhow::Error {
    match error {
        ExportError::Exists { .. } => anyhow!("{error}; name another place with --out"),
        ExportError::Unwritable { .. } => {
            anyhow!("{error}; choose a folder that exists and has room")
        }
        ExportError::Unreadable { .. } | ExportError::Interrupted => {
            anyhow!("{error}; nothing was written")
        }
        ExportError::Empty => anyhow!(
            "{error}; 'handscope info' shows what a recording holds, --from and --to choose of it"
        ),
        ExportError::NoNotes => anyhow!("{error}; leave out --episode notes"),
        ExportError::BothSides => anyhow!("{error}; make a set of each"),
        ExportError::ReaderGone => ReaderGone.into(),
    }
}
