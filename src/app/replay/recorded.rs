//! State of the window at a moment of a recording, restored by applying its entries as when they were received. Reads a second
//! recording, to be overlaid on the replayed one, in the same way.

use crate::app::activity::RecordedMover;
use crate::app::hand::Hand;
use crate::app::notices::{NoticeKind, Notices};
use crate::app::recordings::{BesideRecording, RecordingAbout, RecordingItem};
use crate::hand::Moment;
use crate::history::MarkKind;
use crate::link::Traffic;
use crate::link::tap::WireTap;
use crate::params;
use crate::record::file::reader::TimeRange;
use crate::record::file::{OpenError, RecordingFile};
use crate::record::{Entry, Event, EventKind, LinkReport};
use crate::store::on_thread;
use crate::transport::Endpoint;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Time before the moment that is applied entry by entry: the longest span inspected in detail. Older data comes from the
/// overview, second by second.
const CLOSE: Duration = Duration::from_secs(30);
/// Maximum length of an overlaid recording that is drawn reading by reading.
const CLOSE_WHOLE: Duration = Duration::from_secs(600);
/// Maximum length of a recording that is applied completely.
const WHOLE: Duration = Duration::from_secs(60);

/// The recorded hand and its notices.
#[derive(Debug, Default)]
pub(crate) struct Recorded {
    pub(crate) hand: Hand,
    pub(crate) notices: Notices,
    pub(crate) tap: WireTap,
}

/// Target for applying recorded entries.
pub(crate) struct ReplayTarget<'a> {
    pub(crate) hand: &'a mut Hand,
    pub(crate) notices: &'a mut Notices,
    pub(crate) tap: &'a WireTap,
}

impl Recorded {
    /// Restores the hand of a file at a moment.
    ///
    /// # Errors
    /// The I/O error of the system.
    pub(crate) fn at(file: &RecordingFile, at: Moment) -> io::Result<Self> {
        let mut from = file.first();
        if at.since(from) > WHOLE {
            from = Moment::from_duration(at.since(Moment::ZERO).saturating_sub(CLOSE));
        }
        Self::between(file, from, at)
    }

    /// Restores the hand at a moment, applying entries from another moment on.
    fn between(file: &RecordingFile, from: Moment, at: Moment) -> io::Result<Self> {
        let mut recorded = Self::new(file);
        if from > file.first() {
            recorded.apply_overview(file, from);
        }
        let stretch = TimeRange {
            from,
            to: at,
            wire: true,
        };
        let mut target = ReplayTarget {
            hand: &mut recorded.hand,
            notices: &mut recorded.notices,
            tap: &recorded.tap,
        };
        file.entries(stretch, |entry| {
            target.apply(&entry);
            ControlFlow::Continue(())
        })?;
        Ok(recorded)
    }

    /// Restores the hand at the end of a file with all measurements: reading by reading, or second by second for a long
    /// recording.
    ///
    /// # Errors
    /// The I/O error of the system.
    pub(crate) fn whole(file: &RecordingFile) -> io::Result<Self> {
        if file.last().since(file.first()) <= CLOSE_WHOLE {
            return Self::between(file, file.first(), file.last());
        }
        let mut recorded = Self::new(file);
        recorded.apply_overview(file, file.last());
        Ok(recorded)
    }

    fn new(file: &RecordingFile) -> Self {
        let endpoint: Option<Endpoint> = file.opening().hand.parse().ok();
        let mut recorded = Self::default();
        if let Some(endpoint) = &endpoint {
            recorded.hand.connection.traffic = Traffic::of(recorded.tap.clone(), endpoint);
        }
        recorded.hand.connection.endpoint = endpoint;
        recorded.hand.recorded = Some(RecordedMover::default());
        recorded
    }

    /// Applies the overview up to a moment.
    fn apply_overview(&mut self, file: &RecordingFile, until: Moment) {
        let longest = Duration::from_secs(crate::history::HISTORY_SECONDS.into());
        let from = Moment::from_duration(until.since(Moment::ZERO).saturating_sub(longest));
        let second = |at: Moment| u32::try_from(at.micros() / 1_000_000).unwrap_or(u32::MAX);
        let rows = file
            .overview()
            .rows_within(second(from), second(until).saturating_sub(1));
        for row in rows {
            self.hand.measured.history.overview(row);
        }
        let marks = file.overview().marks.iter();
        for mark in marks.filter(|mark| (from..until).contains(&mark.at)) {
            if let Some(kind) = mark_kind(mark.kind, &mark.words) {
                self.hand.measured.history.mark(mark.at, kind);
            }
            play(&mut self.hand, mark.kind, &mark.words);
        }
    }
}

impl ReplayTarget<'_> {
    /// Applies one entry at its own time.
    pub(crate) fn apply(&mut self, entry: &Entry) {
        let at = entry.at();
        match entry {
            Entry::Heard(record) => self.hand.apply(record, &mut self.notices.about(None), at),
            Entry::Wire(piece) => self.tap.record(piece.at, piece.kind, &piece.bytes),
            Entry::Link(report) => self.link(report),
            Entry::Event(event) => self.event(event),
        }
        if let Entry::Heard(record) = entry {
            self.hand.controls.apply_recorded(record);
        }
    }

    fn link(&mut self, report: &LinkReport) {
        if let Ok(status) = serde_json::from_str(&report.status) {
            self.hand
                .apply_status(status, &mut self.notices.about(None), report.at);
            if let Some(mover) = &mut self.hand.recorded {
                mover.apply_status(&self.hand.connection.status);
            }
        }
        if let Ok(figures) = serde_json::from_str(&report.figures) {
            self.hand.connection.stats = figures;
        }
    }

    fn event(&mut self, event: &Event) {
        match (event.kind, mark_kind(event.kind, &event.words)) {
            (EventKind::NoteRemoved, _) => {
                if let Some(kind) = MarkKind::note(&event.words) {
                    let at = event.at;
                    let mark = crate::history::Mark { at, kind };
                    self.hand.measured.history.remove_mark(&mark);
                }
            }
            (EventKind::Parameters, _) => {
                if let Ok(file) = params::file::read(&event.words) {
                    self.hand.params.set_recorded(&file.params, event.at);
                }
            }
            (EventKind::Trial, _) => {
                if let Some(mover) = &mut self.hand.recorded {
                    mover.begin_trial(&event.words);
                }
            }
            (EventKind::Play | EventKind::PlayEnd, _) => {
                play(self.hand, event.kind, &event.words);
            }
            (EventKind::Note, Some(kind)) => self.hand.measured.history.mark(event.at, kind),
            _ => {}
        }
    }
}

/// Applies the begin or the end of what plays.
fn play(hand: &mut Hand, kind: EventKind, words: &str) {
    let Some(mover) = &mut hand.recorded else {
        return;
    };
    match kind {
        EventKind::Play => mover.begin_play(words),
        EventKind::PlayEnd | EventKind::Armed | EventKind::Stop | EventKind::Disarmed => {
            mover.end_play();
        }
        _ => {}
    }
}

/// Reads a recording and aligns its start with this moment.
pub(crate) async fn read_beside(path: PathBuf, own: Moment) -> Result<BesideRecording, NoticeKind> {
    let place = path.clone();
    let read = on_thread(move || Ok(open_beside(&place, own))).await;
    let read = read.unwrap_or_else(|error| Err(error.into()));
    read.map_err(|why| NoticeKind::RecordingRefused { path, why })
}

fn open_beside(path: &Path, own: Moment) -> Result<BesideRecording, OpenError> {
    let file = RecordingFile::open(path)?;
    let recorded = Recorded::whole(&file)?;
    let item = RecordingItem::of(&file, RecordingAbout::load(path).unwrap_or_default());
    Ok(BesideRecording {
        title: item.title(),
        first: file.first(),
        marks: item.marks,
        history: recorded.hand.measured.history,
        own,
        other: file.first(),
    })
}

/// Plot mark for an event.
fn mark_kind(kind: EventKind, words: &str) -> Option<MarkKind> {
    match kind {
        EventKind::Note => MarkKind::note(words),
        EventKind::Fault => Some(MarkKind::Fault(words.into())),
        EventKind::Stop => Some(MarkKind::Stop),
        EventKind::Armed => Some(MarkKind::Armed),
        EventKind::Disarmed => Some(MarkKind::Disarmed),
        EventKind::LinkLost => Some(MarkKind::LinkLost),
        EventKind::Reconnected => Some(MarkKind::Reconnected),
        _ => None,
    }
}
