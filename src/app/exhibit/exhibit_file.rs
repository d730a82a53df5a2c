//! Exhibition file on disk, with the pose file and the logo that it names. Loaded completely or not at all.

use crate::app::env::Env;
use crate::app::exhibit::{Exhibition, Logo};
use crate::app::files::{self, pose_file};
use crate::app::notices::NoticeKind;
use crate::exhibit::file::{self, ExhibitFile, NamedFile};
use crate::poses::library::PoseLibrary;
use crate::store::{FileCause, FileError, toml_file};
use std::fs::File;
use std::io::{Cursor, ErrorKind, Read as _};
use std::path::Path;
use std::sync::Arc;

/// Maximum size of an exhibition file in bytes.
const FILE_LEN_MAX: u64 = 64 * 1024;
/// Maximum size of a logo in bytes, and its maximum width and height in pixels.
const LOGO_LEN_MAX: u64 = 4 * 1024 * 1024;
const LOGO_SIZE_MAX: u32 = 2048;
/// File name suggested in the dialog.
const FILE_NAME: &str = "handscope-exhibit.toml";

/// The built-in exhibition, shown without a file.
pub fn built_in() -> Option<Exhibition> {
    file::built_in().map(|plan| Exhibition {
        plan: Arc::new(plan),
        logo: None,
        ends_program: false,
    })
}

/// Asks for an exhibition file and reads it.
pub(crate) fn open(
    env: &Env,
) -> impl Future<Output = Result<Exhibition, NoticeKind>> + Send + use<> {
    files::open(None, FILE_NAME, env, read)
}

/// Reads an exhibition file and the files that it names.
///
/// # Errors
/// [`FileError`] if a file cannot be read, with the location.
pub fn read(path: &Path) -> Result<Exhibition, FileError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    toml_file::load(path, FILE_LEN_MAX, |text| {
        let file = ExhibitFile::parse(text, folder)?;
        let own = match file.poses()? {
            Some(poses) => {
                stays_inside(folder, &poses)?;
                pose_file::read(&poses.path).map_err(|error| poses.refused(error))?
            }
            None => PoseLibrary::default(),
        };
        let plan = file.plan(&own)?;
        if plan.pin.is_some() {
            is_private(path)?;
        }
        let picture = |named: NamedFile<'_>| {
            stays_inside(folder, &named)?;
            let picture = pixels(&named.path);
            picture.map_err(|why| named.refused(picture_error(why)))
        };
        Ok(Exhibition {
            plan: Arc::new(plan),
            logo: file.logo()?.map(picture).transpose()?,
            ends_program: false,
        })
    })
}

/// Rejects a file with a PIN that users other than its owner can access.
#[cfg(unix)]
fn is_private(path: &Path) -> Result<(), FileError> {
    use std::os::unix::fs::PermissionsExt as _;
    // Read and write permissions of group and others.
    const OTHERS: u32 = 0o066;
    let mode = std::fs::metadata(path)?.permissions().mode();
    if mode & OTHERS == 0 {
        return Ok(());
    }
    let path = std::path::absolute(path)?.display().to_string();
    let is_plain = |letter: char| letter.is_alphanumeric() || "/._-+".contains(letter);
    let path = if path.chars().all(is_plain) {
        path
    } else {
        // Quoted for a shell.
        format!("'{}'", path.replace('\'', "'\\''"))
    };
    Err(FileError {
        field: Some("pin".into()),
        ..FileCause::NotPrivate { path }.into()
    })
}

/// File permissions are not checked on this platform.
#[cfg(not(unix))]
fn is_private(_path: &Path) -> Result<(), FileError> {
    Ok(())
}

/// Rejects a named file that lies outside the folder of the exhibition file, after resolving links.
fn stays_inside(folder: &Path, named: &NamedFile<'_>) -> Result<(), FileError> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    // A missing file is reported when it is read.
    let (Ok(folder), Ok(file)) = (folder.canonicalize(), named.path.canonicalize()) else {
        return Ok(());
    };
    if file.starts_with(&folder) {
        Ok(())
    } else {
        Err(named.outside())
    }
}

fn picture_error(error: png::DecodingError) -> FileError {
    match error {
        png::DecodingError::IoError(error) => error.into(),
        error => FileCause::Picture(error.to_string()).into(),
    }
}

fn pixels(path: &Path) -> Result<Logo, png::DecodingError> {
    let mut file = Vec::new();
    let opened = File::open(path)?;
    opened.take(LOGO_LEN_MAX + 1).read_to_end(&mut file)?;
    if file.len() as u64 > LOGO_LEN_MAX {
        let what = format!("it is too large: a logo has at most {LOGO_LEN_MAX} bytes");
        return Err(std::io::Error::new(ErrorKind::FileTooLarge, what).into());
    }
    let mut decoder = png::Decoder::new(Cursor::new(file));
    decoder.set_transformations(png::Transformations::ALPHA | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    if width > LOGO_SIZE_MAX || height > LOGO_SIZE_MAX {
        let what =
            format!("{width}x{height} pixels are too many: at most {LOGO_SIZE_MAX} each way");
        return Err(std::io::Error::new(ErrorKind::FileTooLarge, what).into());
    }
    let mut bytes = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let info = reader.next_frame(&mut bytes)?;
    bytes.truncate(info.buffer_size());
    // Gray and opacity per pixel: the picture has no colours.
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use std::path::PathBuf;
    use tempfile::TempDir;

    /// A booth of six tiles with own poses and a logo; line 4 names the poses, line 5 the logo.
    const FILE: &str = r#"format = "handscope-exhibit"
version = 1
tiles = ["Own", "Fist", "Point", "V", "OK", "Rock"]
poses = "poses.toml"
logo = "logo.png"
"#;
    const POSES: &str = r#"format = "handscope-poses"
version = 1

[[pose]]
name = "Own"
speed = 300
force = 800
angles = { little = 1, ring = 1, middle = 1, index = 1, thumb_bend = 1, thumb_rotate = 1 }
"#;

    /// A gray picture of this size.
    fn png(width: u32, height: u32) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        let mut writer = encoder.write_header().unwrap();
        let pixels = vec![7; (width * height) as usize];
        writer.write_image_data(&pixels).unwrap();
        writer.finish().unwrap();
        file
    }

    fn booth() -> (TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("booth.toml");
        std::fs::write(&path, FILE).unwrap();
        std::fs::write(folder.path().join("poses.toml"), POSES).unwrap();
        std::fs::write(folder.path().join("logo.png"), png(3, 2)).unwrap();
        (folder, path)
    }

    #[test]
    fn a_file_is_read_with_the_poses_and_the_logo_beside_it() {
        let (_folder, path) = booth();
        let start = read(&path).unwrap();
        assert_eq!(start.plan.tiles[0].name.en, "Own");
        assert!(!start.ends_program);
        let logo = start.logo.unwrap();
        assert_eq!(logo.size, [3, 2]);
        assert_eq!(*logo.rgba, [7, 7, 7, 255].repeat(6));
    }

    #[test]
    fn what_cannot_be_used_of_the_files_that_are_named_is_told_with_the_line_that_names_them() {
        let half = |file: Vec<u8>| file[..file.len() / 2].to_vec();
        for (name, content, line, field, said) in [
            ("poses.toml", None, 4, "poses", "there is no such file"),
            ("poses.toml", Some(vec![0xFF]), 4, "poses", "UTF-8"),
            (
                "poses.toml",
                Some(POSES.replace("version = 1", "version = 2").into()),
                4,
                "poses",
                "line 2, `version`: version 2 cannot be read",
            ),
            ("poses.toml", Some(vec![b'#'; 2 << 20]), 4, "poses", "bytes"),
            ("logo.png", None, 5, "logo", "No such file"),
            ("logo.png", Some(b"GIF89a".to_vec()), 5, "logo", "signature"),
            ("logo.png", Some(half(png(90, 90))), 5, "logo", "logo.png: "),
            ("logo.png", Some(vec![0; 5 << 20]), 5, "logo", "too large"),
            (
                "logo.png",
                Some(png(2049, 1)),
                5,
                "logo",
                "2049x1 pixels are too many",
            ),
        ] {
            let (folder, path) = booth();
            let place = folder.path().join(name);
            match content {
                Some(content) => std::fs::write(&place, content).unwrap(),
                None => std::fs::remove_file(&place).unwrap(),
            }
            let error = read(&path).unwrap_err();
            let told = error.to_string();
            let at = (error.line, error.field.as_deref());
            assert_eq!(at, (Some(line), Some(field)), "{told}");
            assert!(told.contains(said) && told.contains(name), "{told}");
            let unread = |words: &str| words.matches("cannot be read").count();
            assert_eq!(unread(&told), unread(said), "{told}");
            assert_eq!(told.lines().count(), 1, "{told}");
        }
        let (folder, path) = booth();
        std::fs::remove_file(&path).unwrap();
        let told = read(&path).unwrap_err().to_string();
        assert_eq!(told, "there is no such file");
        std::fs::write(&path, vec![b'#'; 70_000]).unwrap();
        let told = read(&path).unwrap_err().to_string();
        assert!(told.contains("70000 bytes"), "{told}");
        drop(folder);
    }
    #[cfg(unix)]
    #[test]
    fn what_is_named_stays_in_the_folder_of_the_file() {
        let (folder, path) = booth();
        let beside = tempfile::tempdir().unwrap();
        for name in ["poses.toml", "logo.png"] {
            std::fs::copy(folder.path().join(name), beside.path().join(name)).unwrap();
            let link = folder.path().join(format!("link-{name}"));
            std::os::unix::fs::symlink(beside.path().join(name), link).unwrap();
        }
        std::os::unix::fs::symlink(beside.path(), folder.path().join("elsewhere")).unwrap();
        std::fs::create_dir(folder.path().join("below")).unwrap();
        std::fs::copy(
            folder.path().join("poses.toml"),
            folder.path().join("below/poses.toml"),
        )
        .unwrap();
        let out = beside.path().display().to_string();
        for (line, field, name) in [(4, "poses", "poses.toml"), (5, "logo", "logo.png")] {
            for (named, is_inside) in [
                (name.to_owned(), true),
                (format!("./{name}"), true),
                (format!("{out}/{name}"), false),
                (format!("../{name}"), false),
                (format!("below/../{name}"), false),
                (format!("link-{name}"), false),
                (format!("elsewhere/{name}"), false),
            ] {
                let text = FILE.replace(&format!("\"{name}\""), &format!("\"{named}\""));
                std::fs::write(&path, text).unwrap();
                let told = read(&path).map(|_| ()).map_err(|error| {
                    let told = error.to_string();
                    assert!(told.contains("is not in the folder"), "{told}");
                    (error.line, error.field)
                });
                let refused = Err((Some(line), Some(field.to_owned())));
                assert_eq!(told, if is_inside { Ok(()) } else { refused }, "{named}");
            }
        }
        std::fs::write(&path, FILE.replace("poses.toml", "below/poses.toml")).unwrap();
        assert!(read(&path).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn a_file_with_a_pin_that_others_can_read_or_change_is_refused_with_what_mends_it() {
        use std::os::unix::fs::PermissionsExt as _;
        let (_folder, path) = booth();
        for (pin, mode, is_taken) in [
            ("", 0o644, true),
            ("pin = \"4711\"\n", 0o600, true),
            ("pin = \"4711\"\n", 0o400, true),
            ("pin = \"4711\"\n", 0o640, false),
            ("pin = \"4711\"\n", 0o604, false),
            ("pin = \"4711\"\n", 0o602, false),
        ] {
            std::fs::write(&path, format!("{FILE}{pin}")).unwrap();
            std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).unwrap();
            let told = read(&path).map(|_| ()).map_err(|error| error.to_string());
            let mended = format!("run 'chmod 600 {}'", path.display());
            match told {
                Ok(()) => assert!(is_taken, "{mode:o}"),
                Err(told) => assert!(!is_taken && told.contains(&mended), "{mode:o} {told}"),
            }
            std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o600)).unwrap();
        }
    }
}
