//! `info`: what a session file holds and what is missing in it. Reads the file to its end, so that every checksum is looked at.

use crate::cli::out::Out;
use crate::cli::recordings::session_file::{self, FileArgs, length, lost};
use crate::record::EventKind;
use crate::record::file::SessionFile;
use crate::record::file::reader::{Damage, Stretch};
use crate::store::calendar;
use anyhow::Context as _;
use serde_json::{Value, json};
use std::time::Duration;

#[derive(Debug, clap::Args)]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    file: FileArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Prints what there is.
pub(crate) fn run(out: &mut Out, args: &InfoArgs) -> anyhow::Result<()> {
    let path = &args.file.file;
    let file = session_file::open(path)?;
    let damage = file
        .messages(Stretch::WHOLE.from, Stretch::WHOLE.to, |_, _, _| ())
        .with_context(|| format!("cannot read {} to its end", path.display()))?;
    let bytes = std::fs::metadata(path).map_or(0, |data| data.len());
    let told = Told {
        file: &file,
        damage,
        bytes,
    };
    out.result(args.json, &told.json(), told.lines())
}

struct Told<'a> {
    file: &'a SessionFile,
    damage: Damage,
    bytes: u64,
}

impl Told<'_> {
    /// `None` if the day is not known.
    fn start(&self) -> Option<String> {
        let opening = self.file.opening();
        (!opening.is_imported()).then(|| calendar::stamp(opening.began_since_1970()))
    }

    /// Stretches that the recorder said to be missing.
    fn said_missing(&self) -> impl Iterator<Item = (Duration, &str)> {
        let marks = self.file.overview().marks.iter();
        marks
            .filter(|mark| mark.kind == EventKind::Recording)
            .map(|mark| (mark.at.since(self.file.first()), mark.words.as_str()))
    }

    fn gaps(&self) -> u64 {
        let said = u64::try_from(self.said_missing().count()).unwrap_or(u64::MAX);
        self.damage.chunks + u64::from(self.damage.bytes > 0) + said
    }

    fn json(&self) -> Value {
        let (opening, counts) = (self.file.opening(), self.file.overview().counts);
        json!({
            "file": self.file.path(),
            "start": self.start(),
            "length_s": length(self.file).as_secs_f64(),
            "hand": opening.hand,
            "simulated": opening.simulated,
            "version": opening.version,
            "states": counts.states,
            "touch_sweeps": counts.touch_sweeps(),
            "writes": counts.writes,
            "faults": counts.faults,
            "notes": counts.notes,
            "gaps": self.gaps(),
            "damaged_chunks": self.damage.chunks,
            "damaged_bytes": self.damage.bytes,
            "missing_entries": counts.missing,
            "closed": self.file.is_closed(),
            "bytes": self.bytes,
        })
    }

    fn lines(&self) -> Vec<String> {
        let (opening, counts) = (self.file.opening(), self.file.overview().counts);
        let known = |text: &str| match text {
            "" => "not known".to_owned(),
            text => text.to_owned(),
        };
        let simulated = match opening.simulated {
            true => " (simulated)",
            false => "",
        };
        #[expect(clippy::cast_precision_loss, reason = "far below 2^53 bytes")]
        let megabytes = self.bytes as f64 / 1e6;
        let mut lines = vec![
            format!("start         {}", known(&self.start().unwrap_or_default())),
            format!("length        {:.3} s", length(self.file).as_secs_f64()),
            format!("hand          {}{simulated}", known(&opening.hand)),
            format!("version       {}", known(&opening.version)),
            format!("states        {}", counts.states),
            format!("touch sweeps  {}", counts.touch_sweeps()),
            format!("writes        {}", counts.writes),
            format!("faults        {}", counts.faults),
            format!("notes         {}", counts.notes),
            format!("size          {megabytes:.1} MB"),
        ];
        if !self.file.is_closed() {
            lines.push(
                "not closed: the program ended without ending the file, so up to a quarter of a second is missing at its end; 'handscope recover' writes a closed copy".into(),
            );
        }
        lines.extend(lost(self.damage).map(|words| format!("missing: {words}")));
        lines.extend(
            self.said_missing()
                .map(|(at, words)| format!("at {:.3} s: {words}", at.as_secs_f64())),
        );
        if self.file.is_closed() && self.gaps() == 0 {
            lines.push("nothing is missing".into());
        }
        lines
    }
}
