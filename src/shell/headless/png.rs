//! Pictures as PNG files: same pixels, same bytes. Draws nothing.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Reason why a picture could not be saved.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ImageError {
    /// The number of bytes does not match the size.
    #[error("a picture of {width}x{height} has {wanted} bytes, got {got}")]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Expected number of RGB8 bytes.
        wanted: u64,
        /// Actual number of bytes.
        got: u64,
    },
    /// The encoder failed, for instance on a picture without pixels.
    #[error("cannot encode a picture of {width}x{height}: {words}")]
    Encode {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The encoder's error text.
        words: String,
    },
    /// The file could not be written. The old file, if any, is unchanged.
    #[error("cannot write {}: {words}; choose a folder that exists and that you may write to", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        kind: io::ErrorKind,
        /// The system's error text.
        words: String,
    },
}

/// Encodes RGB8 pixels, row by row from the top left, as a PNG file.
///
/// # Errors
/// [`ImageError::Size`] and [`ImageError::Encode`].
pub fn encode(pixels: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>, ImageError> {
    let wanted = u64::from(width) * u64::from(height) * 3;
    let got = u64::try_from(pixels.len()).unwrap_or(u64::MAX);
    if got != wanted {
        return Err(ImageError::Size {
            width,
            height,
            wanted,
            got,
        });
    }
    let refused = |error: ::png::EncodingError| ImageError::Encode {
        width,
        height,
        words: error.to_string(),
    };
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::Fast);
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(pixels).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

/// Saves a picture at `path` atomically: writes it beside the path, then renames it.
///
/// # Errors
/// Those of [`encode`] and [`ImageError::Write`].
pub fn save(path: &Path, pixels: &[u8], size: (u32, u32)) -> Result<(), ImageError> {
    let bytes = encode(pixels, size)?;
    let refused = |error: io::Error| ImageError::Write {
        path: path.to_path_buf(),
        kind: error.kind(),
        words: error.to_string(),
    };
    let part = part_of(path);
    let written = fs::write(&part, bytes).and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        // A partial file is useless, and may not even exist.
        fs::remove_file(&part).ok();
    }
    written.map_err(refused)
}

/// Temporary name of an incomplete file; the process id separates concurrent writers.
fn part_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIXELS: [u8; 12] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12];

    #[test]
    fn saved_picture_reads_back_and_bytes_repeat() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("view.png");
        fs::write(&path, "old").unwrap();
        save(&path, &PIXELS, (2, 2)).unwrap();
        assert_eq!(fs::read(&path).unwrap(), encode(&PIXELS, (2, 2)).unwrap());
        let file = io::BufReader::new(fs::File::open(&path).unwrap());
        let mut reader = ::png::Decoder::new(file).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!((info.width, info.height), (2, 2));
        assert_eq!(rgb, PIXELS);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn failed_save_names_the_path_and_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("none").join("view.png");
        let error = save(&missing, &PIXELS, (2, 2)).unwrap_err();
        assert!(
            matches!(&error, ImageError::Write { path, kind: io::ErrorKind::NotFound, .. } if *path == missing)
        );
        assert!(error.to_string().contains("view.png"), "{error}");

        let blocked = folder.path().join("folder.png");
        fs::create_dir(&blocked).unwrap();
        fs::write(blocked.join("inside"), "").unwrap();
        assert!(save(&blocked, &PIXELS, (2, 2)).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn wrong_size_and_empty_picture_are_refused() {
        let wrong = encode(&PIXELS, (2, 3)).unwrap_err();
        assert_eq!(
            wrong,
            ImageError::Size {
                width: 2,
                height: 3,
                wanted: 18,
                got: 12
            }
        );
        assert!(matches!(
            encode(&[], (0, 0)),
            Err(ImageError::Encode { .. })
        ));
    }
}
