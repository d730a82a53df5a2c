//! `info`: contents of a recording file and what is missing in it. Reads the file to its end, so that every checksum is verified.

use crate::cli::out::Out;
use crate::cli::recordings::recording_file::{self, FileArgs, add_files, length, lost};
use crate::hand::Moment;
use crate::record::EventKind;
use crate::record::file::{
    Contents, Damage, GOES_ON_FROM, GOES_ON_IN, MessageGap, RecordingFile, Remark,
};
use crate::store::calendar;
use anyhow::Context as _;
use serde_json::{Value, json};
use std::time::Duration;

/// Maximum number of gaps printed individually.
const GAPS_PRINTED: usize = 20;

#[derive(Debug, clap::Args)]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    file: FileArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(out: &mut Out, args: &InfoArgs) -> anyhow::Result<()> {
    let path = &args.file.file;
    let file = recording_file::open(path)?;
    let contents = Contents::of(&file)
        .with_context(|| format!("cannot read {} to its end", path.display()))?;
    let summary = RecordingSummary {
        file: &file,
        contents,
        bytes: file.bytes(),
    };
    out.result(args.json, &summary.json(), summary.lines())
}

struct RecordingSummary<'a> {
    file: &'a RecordingFile,
    contents: Contents,
    bytes: u64,
}

impl RecordingSummary<'_> {
    /// Start time; `None` if the day is unknown.
    fn start(&self) -> Option<String> {
        let opening = self.file.opening();
        (!opening.is_imported()).then(|| calendar::stamp(opening.began_since_1970()))
    }

    /// Time ranges that the recorder reported as missing.
    fn reported_gaps(&self) -> impl Iterator<Item = (Duration, &str)> {
        let marks = self.file.overview().marks.iter();
        marks
            .filter(|mark| mark.kind == EventKind::Recording)
            .map(|mark| (mark.at.since(self.file.first()), mark.words.as_str()))
    }

    /// Another part of the same recording that this file refers to by this prefix.
    fn part(&self, named: &str) -> Option<&str> {
        let mut reported = self.reported_gaps();
        reported.find_map(|(_, words)| Some(words.strip_prefix(named)?.split_once(": ")?.0))
    }

    fn gaps(&self) -> u64 {
        let Damage {
            chunks,
            bytes,
            ref gaps,
            ..
        } = self.contents.damage;
        // Gaps reported by the recorder are also among those of known length.
        let reported = self.reported_gaps().count();
        let reported = u64::try_from(reported).unwrap_or(u64::MAX);
        let known = u64::try_from(gaps.len()).unwrap_or(u64::MAX);
        known.max(chunks + u64::from(bytes > 0) + reported)
    }

    /// A moment in seconds from the start.
    fn seconds(&self, at: Moment) -> f64 {
        at.since(self.file.first()).as_secs_f64()
    }

    /// A count, and the number of readable entries if not all.
    fn count(written: u64, read: u64) -> String {
        if written > read {
            format!("{written}, of which {read} can be read")
        } else {
            written.to_string()
        }
    }

    fn json(&self) -> Value {
        let (opening, counts) = (self.file.opening(), self.file.overview().counts);
        let Contents {
            counts: read,
            damage,
            ..
        } = &self.contents;
        let remarks = self.file.remarks().iter();
        let gaps = damage.gaps.iter().map(|gap| {
            json!({
                "from_s": self.seconds(gap.from),
                "to_s": self.seconds(gap.to),
                "messages": gap.messages,
            })
        });
        let not_read =
            self.contents.unread.iter().map(
                |gap| json!({ "from_s": self.seconds(gap.from), "to_s": self.seconds(gap.to) }),
            );
        let mut object = json!({
            "file": self.file.path(),
            "start": self.start(),
            "length_s": length(self.file).as_secs_f64(),
            "hand": opening.hand,
            "simulated": opening.is_simulated(),
            "version": opening.version,
            "states": counts.states,
            "touch_sweeps": counts.touch_sweeps(),
            "writes": counts.writes,
            "faults": counts.faults,
            "notes": counts.notes,
            "gaps": self.gaps(),
            "damaged_chunks": damage.chunks,
            "damaged_bytes": damage.bytes,
            "missing_entries": counts.missing,
            "missing_messages": damage.messages,
            "missing_s": damage.length().as_secs_f64(),
            "gap_list": gaps.collect::<Vec<_>>(),
            "not_read": not_read.collect::<Vec<_>>(),
            "readable": {
                "states": read.states,
                "touch_sweeps": read.touch_sweeps(),
                "writes": read.writes,
                "notes": read.notes,
            },
            "remarks": remarks.map(ToString::to_string).collect::<Vec<_>>(),
            "closed": self.file.is_closed(),
            "previous": self.part(GOES_ON_FROM),
            "next": self.part(GOES_ON_IN),
            "bytes": self.bytes,
        });
        add_files(&mut object, Some(self.file));
        object
    }

    fn lines(&self) -> Vec<String> {
        let (opening, counts) = (self.file.opening(), self.file.overview().counts);
        let read = self.contents.counts;
        let known = |text: &str| match text {
            "" => "not known".to_owned(),
            text => text.to_owned(),
        };
        let simulated = if opening.is_simulated() == Some(true) {
            " (simulated)"
        } else {
            ""
        };
        #[expect(clippy::cast_precision_loss, reason = "far below 2^53 bytes")]
        let megabytes = self.bytes as f64 / 1e6;
        let mut lines = vec![
            format!("start         {}", known(&self.start().unwrap_or_default())),
            format!("length        {:.3} s", length(self.file).as_secs_f64()),
            format!("hand          {}{simulated}", known(&opening.hand)),
            format!("version       {}", known(&opening.version)),
            format!("states        {}", Self::count(counts.states, read.states)),
            format!(
                "touch sweeps  {}",
                Self::count(counts.touch_sweeps(), read.touch_sweeps())
            ),
            format!("writes        {}", Self::count(counts.writes, read.writes)),
            format!("faults        {}", counts.faults),
            format!("notes         {}", Self::count(counts.notes, read.notes)),
            format!("size          {megabytes:.1} MB"),
        ];
        if self.file.paths().count() > 1 {
            let files = self.file.paths().map(|path| path.display().to_string());
            lines.push(format!(
                "files         {}",
                Vec::from_iter(files).join(", ")
            ));
        }
        if !self.file.is_closed() {
            lines.push(format!(
                "not closed: the program ended without closing the file. It can be read up to {:.3} s; what came after is in no file: a quarter of a second where the program was killed, more where the disk was full or the power lost; 'handscope recover' writes a closed copy",
                self.seconds(self.contents.last)
            ));
        }
        lines.extend(self.file.remarks().iter().map(ToString::to_string));
        lines.extend(lost(&self.contents.damage).map(|words| format!("missing: {words}")));
        lines.extend(self.gap_lines());
        lines.extend(
            self.reported_gaps()
                .map(|(at, words)| format!("at {:.3} s: {words}", at.as_secs_f64())),
        );
        let unread = &self.contents.unread;
        lines.extend(unread.iter().take(GAPS_PRINTED).map(|gap| {
            let when = self.stretch(gap);
            format!("no readings: {when}): the hand did not answer, or was not read")
        }));
        lines.extend(more_than_printed(unread, "stretches without readings"));
        let is_whole = !self.file.remarks().iter().any(Remark::is_loss)
            && self.contents.damage == Damage::default();
        if self.file.is_closed() && self.gaps() == 0 && is_whole {
            let words = if unread.is_empty() {
                "nothing is missing"
            } else {
                "nothing else is missing"
            };
            lines.push(words.into());
        }
        lines
    }

    /// Time and length of a gap; the bracket is left open.
    fn stretch(&self, gap: &MessageGap) -> String {
        let (from, to) = (self.seconds(gap.from), self.seconds(gap.to));
        let length = to - from;
        format!("{from:.3} s to {to:.3} s ({length:.3} s")
    }

    /// Lines with time and length of each gap.
    fn gap_lines(&self) -> Vec<String> {
        let gaps = &self.contents.damage.gaps;
        let mut lines: Vec<String> = gaps
            .iter()
            .take(GAPS_PRINTED)
            .map(|gap| {
                let when = self.stretch(gap);
                let count = match gap.messages {
                    0 => String::new(),
                    count => format!(", {count} messages"),
                };
                format!("gap: {when}{count})")
            })
            .collect();
        lines.extend(more_than_printed(gaps, "gaps"));
        lines
    }
}

/// Number of entries beyond those printed.
fn more_than_printed(gaps: &[MessageGap], what: &str) -> Option<String> {
    let more = gaps.len().checked_sub(GAPS_PRINTED)?;
    (more > 0).then(|| format!("and {more} more {what}; --json lists them"))
}
