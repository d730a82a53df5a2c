//! `export --png`: a picture of the window replaying a recording, with its plots over a time range.

use crate::app::settings::{Language, Theme};
use crate::cli::out::ending::EndFlag;
use crate::hand::Moment;
use crate::record::export::ExportError;
use crate::record::file::RecordingFile;
use crate::record::file::reader::TimeRange;
use crate::record::{Entry, Record};
use crate::shell::headless::driver::{Driver, Scene};
use crate::shell::headless::png;
use crate::transport::Endpoint;
use crate::ui::View;
use anyhow::bail;
use std::ops::ControlFlow;
use std::path::Path;

/// Initial size of the window.
const SIZE: (u32, u32) = (1440, 900);

/// Draws the picture. The path must not exist.
pub(crate) fn draw(file: &RecordingFile, stretch: TimeRange, out: &Path) -> anyhow::Result<()> {
    let (first, last): (Moment, Moment) = (file.first(), file.last());
    let (from, to) = (stretch.from.max(first), stretch.to.min(last));
    if from >= to {
        let length_s = last.since(first).as_secs_f64();
        bail!(
            "there is nothing to draw between --from and --to: the recording is {length_s:.1} s long"
        );
    }
    if out.symlink_metadata().is_ok() {
        let path = out.to_owned();
        return Err(ExportError::Exists { path }.into());
    }
    let mut is_read = false;
    let _damage = file.entries(
        TimeRange {
            from,
            to,
            ..stretch
        },
        |entry| {
            is_read = matches!(entry, Entry::Heard(Record::Reading { .. }));
            match is_read {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        },
    )?;
    if !is_read {
        return Err(ExportError::Empty.into());
    }
    let scene = Scene {
        // No other hand must be connected behind a replay.
        endpoint: Endpoint::sim(),
        size: SIZE,
        scale: 1.0,
        theme: Theme::default(),
        language: Language::default(),
    };
    let mut driver = Driver::start(&scene)?;
    driver.replay(file.path().to_owned(), (from, to))?;
    let picture = driver.picture(View::Live);
    // From here on, a signal leaves either a complete file or none.
    let _wished = EndFlag::listen()?;
    Ok(png::save(out, &picture.rgb, picture.size)?)
}
