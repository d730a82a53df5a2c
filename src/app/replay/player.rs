//! Recording player: the moment shown, playback, and read-ahead. Reads files off the window's thread.

use crate::app::action::Action;
use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::app::recordings::about::{RecordingAbout, RecordingNote};
use crate::app::recordings::item::RecordingItem;
use crate::app::recordings::{RecordingAction, Timeline};
use crate::app::replay::recorded::{Recorded, ReplayTarget, read_beside};
use crate::app::state::State;
use crate::hand::{Group, Moment};
use crate::history::NOTE_MAX;
use crate::link::tap::WireTap;
use crate::record::file::reader::TimeRange;
use crate::record::file::{OpenError, RecordingFile};
use crate::record::{Entry, Record};
use crate::store::{JobKind, Jobs, on_thread};
use std::collections::VecDeque;
use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Read-ahead during playback, in seconds of the recording at speed 1.
const AHEAD: Duration = Duration::from_secs(2);
/// Maximum distance to the next reading for a step.
const STEP_TIMEOUT: Duration = Duration::from_secs(5);
/// Maximum advance per frame: a slow frame must not cause a jump.
const FRAME_MAX: Duration = Duration::from_millis(250);
/// Minimum and maximum playback speed.
pub(crate) const PACES: (f32, f32) = (0.1, 10.0);

/// An opened file, and the state of the hand shortly after the start, or at the start of the requested range.
pub(crate) struct OpenedRecording {
    file: Arc<RecordingFile>,
    found: HandSnapshot,
    stretch: Option<(Moment, Moment)>,
}

/// State of the hand at a moment.
type HandSnapshot = (Moment, Box<Recorded>);

/// Seek target.
#[derive(Debug, Clone, Copy)]
enum SeekTarget {
    At(Moment),
    /// The first reading of the angles after this moment.
    After(Moment),
    Before(Moment),
}

/// A recording being replayed.
pub(crate) struct RecordingPlayer {
    file: Arc<RecordingFile>,
    about: RecordingAbout,
    /// Everything the window shows of the recording.
    pub(crate) state: State,
    tap: WireTap,
    /// Time of the last tick, on the program's clock.
    ticked: Moment,
    seek_target: Option<SeekTarget>,
    ahead: VecDeque<Entry>,
    ahead_until: Moment,
    jobs: Jobs<PlayerJob>,
}

/// Background jobs of the player.
#[derive(Debug, PartialEq, Eq)]
enum PlayerJob {
    /// Read the state of the hand at the seek target.
    Seek,
    /// Read the next entries for playback.
    ReadAhead,
    /// Read the overlay.
    ReadBeside,
}

impl JobKind for PlayerJob {
    type State = RecordingPlayer;
    type Ctx<'a> = ();
}

/// Opens a file near its start or at a time range, off the window's thread.
pub(crate) async fn open(
    path: PathBuf,
    stretch: Option<(Moment, Moment)>,
) -> Result<OpenedRecording, NoticeKind> {
    let place = path.clone();
    let opened = on_thread(move || {
        Ok(RecordingFile::open(&place).and_then(|file| {
            let at = stretch.map_or(file.first().plus(AHEAD), |(from, _)| from);
            let at = at.clamp(file.first(), file.last());
            let found = find(&file, SeekTarget::At(at))?;
            Ok::<OpenedRecording, OpenError>(OpenedRecording {
                file: Arc::new(file),
                found,
                stretch,
            })
        }))
    });
    let opened = opened.await.unwrap_or_else(|error| Err(error.into()));
    opened.map_err(|why| NoticeKind::RecordingRefused { path, why })
}

/// Reads the state of the hand at the seek target.
fn find(file: &RecordingFile, target: SeekTarget) -> io::Result<HandSnapshot> {
    let one = Duration::from_micros(1);
    let earlier = |at: Moment, by| Moment::from_duration(at.since(Moment::ZERO).saturating_sub(by));
    let at = match target {
        SeekTarget::At(at) => at,
        SeekTarget::After(at) => {
            let stretch = (at.plus(one), at.plus(STEP_TIMEOUT));
            reading(file, stretch, true)?.unwrap_or(at)
        }
        SeekTarget::Before(at) => {
            let stretch = (earlier(at, STEP_TIMEOUT), earlier(at, one));
            reading(file, stretch, false)?.unwrap_or(at)
        }
    };
    Ok((at, Box::new(Recorded::at(file, at)?)))
}

/// Time of the first or last reading of the angles in a time range.
fn reading(
    file: &RecordingFile,
    (from, to): (Moment, Moment),
    first: bool,
) -> io::Result<Option<Moment>> {
    let mut found = None;
    let wire = false;
    file.entries(TimeRange { from, to, wire }, |entry| match &entry {
        Entry::Heard(Record::Reading { fresh, .. }) if fresh.contains(Group::Angle) => {
            found = Some(entry.at());
            if first {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }
        _ => ControlFlow::Continue(()),
    })?;
    Ok(found)
}

impl RecordingPlayer {
    /// Creates a player for an opened file, paused.
    pub(crate) fn new(opened: OpenedRecording, live: &State) -> Self {
        let OpenedRecording {
            file,
            found: (at, recorded),
            stretch,
        } = opened;
        let about = RecordingAbout::load(file.path()).unwrap_or_default();
        let item = RecordingItem::of(&file, about.clone());
        let timeline = Timeline {
            path: item.path.clone(),
            title: item.title(),
            began: item.began(),
            hand: item.opening.hand.clone(),
            first: file.first(),
            last: file.last(),
            at,
            runs: false,
            pace: 1.0,
            looped: None,
            notes: Arc::new(item.notes()),
            marks: Arc::new(item.marks),
            strip: Arc::new(item.strip),
            waits: false,
            damaged: file.is_damaged(),
            live_needs_eyes: false,
        };
        let mut player = Self {
            about,
            state: State {
                timeline: Some(timeline),
                poses: live.poses.clone(),
                ..State::default()
            },
            tap: WireTap::default(),
            ticked: live.now,
            seek_target: None,
            ahead: VecDeque::new(),
            ahead_until: at,
            jobs: Jobs::default(),
            file,
        };
        player.apply_found((at, recorded));
        player.set_loop(stretch);
        player
    }

    /// True if this file belongs to the replayed recording.
    pub(crate) fn holds(&self, path: &Path) -> bool {
        self.file.paths().any(|file| file == path)
    }

    /// The replayed file, or the first of several.
    pub(crate) fn path(&self) -> &Path {
        self.file.path()
    }

    /// User metadata of a recording that is not in the list.
    pub(crate) const fn about_mut(&mut self) -> &mut RecordingAbout {
        &mut self.about
    }

    /// Filters an action during replay; returns it if the program should handle it. A note is added to the recording.
    pub(crate) fn pass(&mut self, action: Action) -> Option<Action> {
        match action {
            Action::Note(at, words) => {
                Some(Action::Recording(RecordingAction::EditNote(at, words)))
            }
            Action::Dismiss(id) => {
                self.state.notices.dismiss(id);
                None
            }
            action if action.passes_in_replay() => Some(action),
            _ => {
                self.notify(NoticeKind::Recorded);
                None
            }
        }
    }

    /// Shows a notice in the replay.
    pub(crate) fn notify(&mut self, what: NoticeKind) {
        self.state.notices.push(self.state.now, what);
    }

    fn line(&mut self) -> Option<&mut Timeline> {
        self.state.timeline.as_mut()
    }

    fn at(&self) -> Moment {
        self.state.now
    }

    /// Shows the hand in the given state.
    fn apply_found(&mut self, (at, recorded): HandSnapshot) {
        *self.state.hands.shown_mut() = recorded.hand;
        self.state.notices = recorded.notices;
        self.tap = recorded.tap;
        self.ahead.clear();
        self.ahead_until = at;
        self.jobs.cancel(&PlayerJob::ReadAhead);
        self.show(at);
    }

    /// Moves the views to this moment.
    fn show(&mut self, at: Moment) {
        self.state.now = at;
        if let Some(line) = self.line() {
            line.at = at;
        }
    }

    /// Advances playback, and applies completed reads.
    pub(crate) fn tick(&mut self, live: &State, env: &Env) {
        let passed = live.now.since(self.ticked);
        self.ticked = live.now;
        self.state.settings.clone_from(&live.settings);
        self.state.recordings.clone_from(&live.recordings);
        let eyes = live.hands.iter().any(|hand| hand.connection.may_move());
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, &mut ());
        }
        self.seek(env);
        self.run(passed);
        self.read_ahead(env);
        let side = self.file.opening().side;
        let shown = self.state.hands.shown_mut();
        // The views continue with the slot of the live hand that was shown.
        (shown.label.slot, shown.side) = (live.hand().label.slot, side);
        let waits = self.is_seeking();
        if let Some(line) = self.line() {
            (line.live_needs_eyes, line.waits) = (eyes, waits);
        }
    }

    /// Seeks to the latest target, one at a time.
    fn seek(&mut self, env: &Env) {
        if self.is_seeking() {
            return;
        }
        let Some(target) = self.seek_target.take() else {
            return;
        };
        let file = Arc::clone(&self.file);
        let seek = on_thread(move || find(&file, target));
        let apply = |player: &mut Self, (): &mut (), found: io::Result<HandSnapshot>| match found {
            Ok(found) => player.apply_found(found),
            Err(error) => {
                let path = player.path().to_owned();
                let why = error.into();
                player.notify(NoticeKind::RecordingRefused { path, why });
            }
        };
        self.jobs
            .start(PlayerJob::Seek, env.background(), seek, apply);
    }

    fn is_seeking(&self) -> bool {
        self.jobs.is_running(&PlayerJob::Seek)
    }

    /// Advances by this much of the program's time.
    fn run(&mut self, passed: Duration) {
        let (ahead_until, last) = (self.ahead_until, self.file.last());
        let is_seeking = self.is_seeking();
        let Some(line) = self.line().filter(|line| line.runs && !is_seeking) else {
            return;
        };
        let end = line.looped.map_or(last, |(_, end)| end);
        let step = passed.min(FRAME_MAX).mul_f32(line.pace);
        // Playback waits for entries that have not been read yet.
        let next = line.at.plus(step).min(ahead_until.max(line.at)).min(end);
        let begin = line.looped.map(|(begin, _)| begin);
        let is_over = next >= end;
        line.runs = !is_over || begin.is_some();
        if is_over {
            self.seek_target = begin.map(SeekTarget::At);
        }
        let mut target = ReplayTarget {
            hand: self.state.hands.shown_mut(),
            notices: &mut self.state.notices,
            tap: &self.tap,
        };
        while let Some(entry) = self.ahead.pop_front_if(|entry| entry.at() <= next) {
            target.apply(&entry);
        }
        self.show(next);
    }

    fn read_ahead(&mut self, env: &Env) {
        let Some(line) = self.state.timeline.as_ref().filter(|line| line.runs) else {
            return;
        };
        let read_until = line.at.plus(AHEAD.mul_f32(line.pace.max(1.0)));
        let read_until = read_until.min(self.file.last());
        let is_reading = self.jobs.is_running(&PlayerJob::ReadAhead);
        if is_reading || self.is_seeking() || self.ahead_until >= read_until {
            return;
        }
        let file = Arc::clone(&self.file);
        let from = self.ahead_until.plus(Duration::from_micros(1));
        let read = on_thread(move || {
            let mut entries = Vec::new();
            let stretch = TimeRange {
                from,
                to: read_until,
                wire: true,
            };
            file.entries(stretch, |entry| {
                entries.push(entry);
                ControlFlow::Continue(())
            })?;
            entries.sort_by_key(Entry::at);
            Ok(entries)
        });
        self.jobs.start(
            PlayerJob::ReadAhead,
            env.background(),
            read,
            move |player, (), entries| {
                player.ahead.extend(entries.into_iter().flatten());
                player.ahead_until = read_until;
            },
        );
    }

    /// Handles the user's requests for the replayed recording.
    pub(crate) fn act(&mut self, action: &RecordingAction, env: &Env) {
        let (first, last) = (self.file.first(), self.file.last());
        let within = |at: Moment| at.clamp(first, last);
        match action {
            RecordingAction::Seek(at) => self.seek_target = Some(SeekTarget::At(within(*at))),
            RecordingAction::Run(on) => {
                let is_at_end = self.at() >= last;
                if let Some(line) = self.line() {
                    line.runs = *on;
                }
                if *on && is_at_end {
                    self.seek_target = Some(SeekTarget::At(first));
                }
            }
            RecordingAction::Pace(pace) => {
                if let Some(line) = self.line() {
                    line.pace = pace.clamp(PACES.0, PACES.1);
                }
            }
            RecordingAction::Loop(stretch) => self.set_loop(*stretch),
            RecordingAction::Step(forward) => {
                let at = self.at();
                self.seek_target = Some(if *forward {
                    SeekTarget::After(at)
                } else {
                    SeekTarget::Before(at)
                });
                if let Some(line) = self.line() {
                    line.runs = false;
                }
            }
            RecordingAction::Beside(Some(path)) => {
                self.jobs.start(
                    PlayerJob::ReadBeside,
                    env.background(),
                    read_beside(path.clone(), first),
                    |player, (), beside| match beside {
                        Ok(beside) => player.state.beside = Some(beside),
                        Err(refused) => player.notify(refused),
                    },
                );
            }
            RecordingAction::Beside(None) => {
                self.jobs.cancel(&PlayerJob::ReadBeside);
                self.state.beside = None;
            }
            RecordingAction::Align(own, other) => {
                if let Some(beside) = &mut self.state.beside {
                    (beside.own, beside.other) = (*own, *other);
                }
            }
            // Actions on the list, on files, or on the recording being made.
            RecordingAction::Record(_)
            | RecordingAction::RecordSimulated(_)
            | RecordingAction::ChooseFolder(_)
            | RecordingAction::DefaultFolder
            | RecordingAction::Refresh
            | RecordingAction::Open(_)
            | RecordingAction::OpenAt(..)
            | RecordingAction::Close
            | RecordingAction::Reveal(_)
            | RecordingAction::Export(..)
            | RecordingAction::Name(..)
            | RecordingAction::Star(..)
            | RecordingAction::AskDelete(_)
            | RecordingAction::Delete
            | RecordingAction::KeepIt
            | RecordingAction::MakeRoom
            | RecordingAction::KeepPlanned
            | RecordingAction::EditNote(..) => {}
        }
    }

    fn set_loop(&mut self, stretch: Option<(Moment, Moment)>) {
        let (first, last) = (self.file.first(), self.file.last());
        let within = |at: Moment| at.clamp(first, last);
        if let Some(line) = self.line() {
            line.looped = stretch
                .map(|(from, to)| (within(from.min(to)), within(from.max(to))))
                .filter(|(from, to)| from < to);
        }
    }

    /// Seeks to the start of a time range and loops over it.
    pub(crate) fn show_stretch(&mut self, stretch: (Moment, Moment), env: &Env) {
        self.act(&RecordingAction::Loop(Some(stretch)), env);
        self.act(&RecordingAction::Seek(stretch.0), env);
    }

    /// Edits, adds or removes the note at a moment; returns all notes after the change.
    pub(crate) fn edit_note(&mut self, at: Moment, words: &str) -> Option<Vec<RecordingNote>> {
        let words: String = words.trim().chars().take(NOTE_MAX).collect();
        let line = self.line()?;
        let mut notes: Vec<RecordingNote> = line.notes.to_vec();
        notes.retain(|note| note.at() != at);
        if !words.is_empty() {
            notes.push(RecordingNote {
                at_micros: at.micros(),
                words,
            });
        }
        notes.sort_by_key(RecordingNote::at);
        line.notes = Arc::new(notes.clone());
        Some(notes)
    }
}
