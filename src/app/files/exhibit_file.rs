//! The file of an exhibition on disk, with the poses and the logo that it names. Read whole or not at all.

use crate::app::env::Env;
use crate::app::exhibit::{ExhibitStart, Logo};
use crate::app::files::open;
use crate::app::files::pose_file;
use crate::app::notices::NoticeKind;
use crate::exhibit::file;
use crate::poses::library::PoseLibrary;
use crate::store::{BackgroundJob, FileCause, FileError, toml_file};
use std::fs::File;
use std::io::{Cursor, Read as _};
use std::path::Path;
use std::sync::Arc;

/// Anything longer is no file of an exhibition.
const FILE_LEN_MAX: u64 = 64 * 1024;
/// The same for a logo, and what it may have of rows and columns.
const LOGO_LEN_MAX: u64 = 4 * 1024 * 1024;
const LOGO_SIZE_MAX: u32 = 2048;
/// The name that is asked for.
const FILE_NAME: &str = "handscope-exhibit.toml";

/// What is shown without a file.
#[must_use]
pub fn built_in() -> Option<ExhibitStart> {
    file::built_in().map(|plan| ExhibitStart {
        plan: Arc::new(plan),
        logo: None,
        ends_program: false,
    })
}

/// Asks for a file and reads it.
pub(crate) fn open(env: &Env) -> BackgroundJob<Result<ExhibitStart, NoticeKind>> {
    open::open(None, FILE_NAME, env, read)
}

/// Reads a file of an exhibition, and what it names.
///
/// # Errors
/// [`FileError`]: what cannot be read, and where.
pub fn read(path: &Path) -> Result<ExhibitStart, FileError> {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let plan = toml_file::load(path, FILE_LEN_MAX, |text| {
        let own = match file::poses_of(text, &folder)? {
            Some(poses) => {
                pose_file::read(&poses).map_err(|error| of_other("poses", &poses, &error))?
            }
            None => PoseLibrary::default(),
        };
        file::read(text, &folder, &own)
    })?;
    let logo = plan.logo.as_deref().map(logo).transpose()?;
    Ok(ExhibitStart {
        plan: Arc::new(plan),
        logo,
        ends_program: false,
    })
}

/// The error of a file that another one names.
fn of_other(field: &str, path: &Path, why: &dyn std::fmt::Display) -> FileError {
    FileError {
        line: None,
        field: Some(field.into()),
        cause: FileCause::Unreadable(format!("{}: {why}", path.display())),
    }
}

fn logo(path: &Path) -> Result<Logo, FileError> {
    pixels(path).map_err(|why| of_other("logo", path, &why))
}

fn pixels(path: &Path) -> Result<Logo, png::DecodingError> {
    let mut file = Vec::new();
    File::open(path)?
        .take(LOGO_LEN_MAX)
        .read_to_end(&mut file)?;
    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_transformations(png::Transformations::ALPHA | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    if width > LOGO_SIZE_MAX || height > LOGO_SIZE_MAX {
        let what =
            format!("{width}x{height} pixels are too many: at most {LOGO_SIZE_MAX} each way");
        return Err(std::io::Error::other(what).into());
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let info = reader.next_frame(&mut bytes)?;
    bytes.truncate(info.buffer_size());
    // One gray and one opacity a pixel, where the picture has no colours.
    let rgba: Vec<u8> = match info.color_type.samples() {
        2 => {
            let pixels = bytes.as_chunks().0.iter();
            pixels
                .flat_map(|[gray, opacity]| [*gray, *gray, *gray, *opacity])
                .collect()
        }
        _ => bytes,
    };
    Ok(Logo {
        size: [width as usize, height as usize],
        rgba: rgba.into(),
    })
}
