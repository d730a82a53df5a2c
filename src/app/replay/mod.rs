//! Replay of a recording in place of the live hands, and operations on recordings: handles requests and continues what was
//! started. Files are read, written and deleted off the window's thread.

mod player;
mod recorded;

use crate::app::env::Env;
use crate::app::files;
use crate::app::hand::Hand;
use crate::app::notices::NoticeKind;
use crate::app::recordings::about::RecordingAbout;
use crate::app::recordings::budget::{self, PlannedDeletion, RecordingRoom};
use crate::app::recordings::export::{RecordingExport, RunningExport};
use crate::app::recordings::item::RecordingItem;
use crate::app::recordings::{self, FolderListing, OWN_MAX, OwnRecording, RecordingAction};
use crate::app::replay::player::RecordingPlayer;
use crate::app::state::State;
use crate::hand::Moment;
use crate::store::calendar::since_1970;
use crate::store::{JobKind, Jobs, on_thread};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Operations on recordings in progress.
#[derive(Default)]
pub(crate) struct ReplayWork {
    /// Player of the replayed recording.
    pub(crate) player: Option<RecordingPlayer>,
    jobs: Jobs<ReplayJob>,
    scan_again: bool,
    /// True if a recording has started since the last scan: deletions that are due make room for it.
    makes_room: bool,
    /// True once planned deletions have been announced in this run of the program.
    has_announced: bool,
    /// Files that the user opened last: the replayed one and the overlay.
    opened: [Option<PathBuf>; 2],
    /// Exports in progress.
    exporting: Vec<RunningExport>,
    /// Number of exports started in this run of the program.
    exports: u64,
    /// Pending writes and deletions, performed in order: of two edits of a recording, the later must end up in its file.
    to_write: VecDeque<FileWork>,
}

/// Background jobs on recordings.
#[derive(Debug, PartialEq, Eq)]
enum ReplayJob {
    /// Scan the folder.
    Scan,
    /// Open a recording to replay it.
    Open,
    ChooseFolder,
    /// Show a file in the file manager.
    Reveal,
    /// The export with this number; exports run side by side.
    Export(u64),
    /// Write or delete files.
    Write,
}

impl JobKind for ReplayJob {
    type State = ReplayWork;
    type Ctx<'a> = State;
}

/// A file operation.
enum FileWork {
    /// Write the user metadata of this recording.
    Save(PathBuf, RecordingAbout),
    /// Delete this recording.
    Delete(PathBuf),
    /// Delete these recordings, except those that the user has marked by now.
    MakeRoom(Vec<PlannedDeletion>),
    /// Save the announced deletions of this folder.
    Tell(PathBuf, Vec<PlannedDeletion>),
}

impl ReplayWork {
    /// Applies completed operations, and advances the replay.
    pub(crate) fn tick(&mut self, state: &mut State, env: &Env) {
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, state);
        }
        self.follow_recordings(state);
        if self.scan_again && !self.jobs.is_running(&ReplayJob::Scan) {
            self.scan_again = false;
            self.scan(state, env);
        }
        self.follow_exports(state);
        self.continue_writing(env);
        if let Some(player) = &mut self.player {
            player.tick(state, env);
        }
    }

    /// Updates the lists of recordings being made, and scans when one starts, to make room for it.
    fn follow_recordings(&mut self, state: &mut State) {
        let State {
            hands,
            recordings,
            now,
            ..
        } = state;
        let running = hands.iter().filter_map(|hand| hand.recording.as_ref());
        let mut recorded = Vec::new();
        for (recording, path) in
            running.filter_map(|recording| Some((recording, recording.status.path.clone()?)))
        {
            recordings.own.retain(|own| own.path != path);
            recordings.own.push(OwnRecording {
                path: path.clone(),
                hand: recording.hand.clone(),
                first: recording.began,
                last: *now,
            });
            recorded.push(path);
        }
        let over = recordings.own.len().saturating_sub(OWN_MAX);
        recordings.own.drain(..over);
        let begins = recorded
            .iter()
            .any(|path| !recordings.recorded.contains(path));
        self.makes_room |= begins;
        self.scan_again |= begins;
        recordings.recorded = recorded;
    }

    /// Applies a scan: announces planned deletions, and deletes those that are due when a recording starts.
    fn apply_listing(&mut self, listing: FolderListing, state: &mut State) {
        let recordings = &mut state.recordings;
        recordings.items = Arc::new(listing.items);
        recordings.unread = Arc::new(listing.unread);
        recordings.is_scanning = false;
        recordings.scans += 1;
        recordings.scanned_at = since_1970();
        let opened = self.opened.iter().flatten();
        let in_use: Vec<PathBuf> = recordings.recorded.iter().chain(opened).cloned().collect();
        let room = RecordingRoom {
            limit: state.settings.recordings.budget_bytes(),
            in_use: &in_use,
        };
        let now_unix_s = since_1970().as_secs();
        let planned = budget::plan(&recordings.items, &room, &listing.announced, now_unix_s);
        if std::mem::take(&mut self.makes_room) {
            let due = budget::due(&planned, &listing.announced, now_unix_s);
            let due = Some(due).filter(|due| !due.is_empty());
            self.to_write.extend(due.map(FileWork::MakeRoom));
        }
        let is_new = planned.iter().any(|one| !listing.announced.contains(one));
        recordings.planned.clone_from(&planned);
        if let Some(notice) = self.deletion_notice(state, is_new) {
            state.notices.push(state.now, notice);
        }
        if planned != listing.announced
            && let Some(folder) = state.recordings.folder.clone()
        {
            self.to_write.push_back(FileWork::Tell(folder, planned));
        }
    }

    /// Notice about planned deletions: when they change, and once in each run of the program.
    fn deletion_notice(&mut self, state: &State, is_new: bool) -> Option<NoticeKind> {
        let planned = &state.recordings.planned;
        if !is_new && self.has_announced {
            return None;
        }
        let day = |one: &PlannedDeletion| {
            let mut items = state.recordings.items.iter();
            let item = items.find(|item| item.path == one.path)?;
            Some(item.began().chars().take(10).collect::<String>())
        };
        let days = (day(planned.first()?)?, day(planned.last()?)?);
        let due = planned.iter().min_by_key(|one| one.due_unix_s())?.due();
        self.has_announced = true;
        Some(NoticeKind::RecordingsPlanned {
            recordings: planned.len(),
            bytes: planned.iter().map(|one| one.bytes).sum(),
            days,
            due,
        })
    }

    fn choose_folder(&mut self, typed: Option<PathBuf>, env: &Env) {
        if self.jobs.is_running(&ReplayJob::ChooseFolder) {
            return;
        }
        self.jobs.start(
            ReplayJob::ChooseFolder,
            env.background(),
            files::choose_folder(typed, env),
            |work, state, chosen| match chosen {
                Ok(folder) => work.record_into(Some(folder), state),
                Err(why) => {
                    state.recordings.asks_folder = true;
                    state.notices.push(state.now, why);
                }
            },
        );
    }

    fn reveal(&mut self, path: PathBuf, env: &Env) {
        self.jobs.start(
            ReplayJob::Reveal,
            env.background(),
            files::reveal(path, env),
            |_, state, revealed| {
                if let Err(why) = revealed {
                    state.notices.push(state.now, why);
                }
            },
        );
    }

    /// Starts an export. Its notice is shown where the user will see it: in the live window or in the replay.
    fn export(&mut self, export: RecordingExport, env: &Env) {
        self.exports += 1;
        let export = RunningExport::new(self.exports, export);
        self.jobs.start(
            ReplayJob::Export(export.number),
            env.background(),
            export.work(env),
            |work, state, notice| match &mut work.player {
                Some(player) => player.notify(notice),
                None => state.notices.push(state.now, notice),
            },
        );
        self.exporting.push(export);
    }

    /// Updates the list of exports in progress.
    fn follow_exports(&mut self, state: &mut State) {
        let is_running =
            |export: &RunningExport| self.jobs.is_running(&ReplayJob::Export(export.number));
        self.exporting.retain(is_running);
        let progress = self.exporting.iter().map(RunningExport::progress);
        state.recordings.exports = progress.collect();
    }

    /// Changes the folder from the next recording on; its recordings are listed immediately.
    fn record_into(&mut self, folder: Option<PathBuf>, state: &mut State) {
        state.settings.recordings.folder = folder;
        (state.recordings.asks_folder, self.scan_again) = (false, true);
    }

    /// Continues with pending file operations, one at a time.
    fn continue_writing(&mut self, env: &Env) {
        if self.jobs.is_running(&ReplayJob::Write) {
            return;
        }
        let Some(files) = self.to_write.pop_front() else {
            return;
        };
        self.jobs.start(
            ReplayJob::Write,
            env.background(),
            files.carry_out(),
            |work, state, written| match written {
                Ok(deleted) => {
                    work.scan_again = true;
                    if deleted > 0 {
                        let notice = NoticeKind::RecordingsDeleted {
                            recordings: deleted,
                        };
                        state.notices.push(state.now, notice);
                    }
                }
                Err(why) => state.notices.push(state.now, why),
            },
        );
    }

    /// True once all user metadata has been written.
    pub(crate) fn is_written(&self) -> bool {
        !self.jobs.is_running(&ReplayJob::Write) && self.to_write.is_empty()
    }

    /// Handles a user request.
    pub(crate) fn act(&mut self, action: RecordingAction, state: &mut State, env: &Env) {
        match action {
            RecordingAction::Record(on) => state.settings.recordings.record = on,
            RecordingAction::RecordSimulated(on) => {
                state.settings.recordings.record_simulated = on;
                state.settings.recordings.record |= on;
            }
            RecordingAction::ChooseFolder(typed) => self.choose_folder(typed, env),
            RecordingAction::DefaultFolder => self.record_into(None, state),
            RecordingAction::Reveal(path) => self.reveal(path, env),
            RecordingAction::Export(export) => self.export(export, env),
            RecordingAction::Refresh => self.scan(state, env),
            RecordingAction::Open(path) => self.open(path, None, env),
            RecordingAction::OpenAt(path, stretch) => self.open(path, Some(stretch), env),
            RecordingAction::Close => (self.player, self.scan_again) = (None, true),
            RecordingAction::Name(path, name) => {
                self.edit_about(state, &path, |about| about.name = name);
            }
            RecordingAction::Star(path, star) => {
                self.edit_about(state, &path, |about| about.star = star);
            }
            RecordingAction::AskDelete(path) => state.recordings.to_delete = Some(path),
            RecordingAction::KeepIt => state.recordings.to_delete = None,
            RecordingAction::Delete => {
                let going = state.recordings.to_delete.take();
                self.to_write.extend(going.map(FileWork::Delete));
            }
            RecordingAction::MakeRoom => {
                let going = std::mem::take(&mut state.recordings.planned);
                self.to_write.push_back(FileWork::MakeRoom(going));
            }
            RecordingAction::KeepPlanned => {
                for planned in std::mem::take(&mut state.recordings.planned) {
                    self.edit_about(state, &planned.path, |about| about.star = true);
                }
            }
            RecordingAction::EditNote(at, words) => {
                let edited = self.player.as_mut().and_then(|player| {
                    let notes = player.edit_note(at, &words)?;
                    Some((player.path().to_owned(), notes))
                });
                if let Some((path, notes)) = edited {
                    self.edit_about(state, &path, |about| about.notes = Some(notes));
                }
            }
            action @ (RecordingAction::Seek(_)
            | RecordingAction::Run(_)
            | RecordingAction::Pace(_)
            | RecordingAction::Step(_)
            | RecordingAction::Loop(_)
            | RecordingAction::Beside(_)
            | RecordingAction::Align(..)) => {
                if let (RecordingAction::Beside(Some(path)), [_, beside]) =
                    (&action, &mut self.opened)
                {
                    *beside = Some(path.clone());
                }
                if let Some(player) = &mut self.player {
                    player.act(&action, env);
                }
            }
        }
    }

    /// Opens a file, unless it is already shown and only another time range is requested.
    fn open(&mut self, path: PathBuf, stretch: Option<(Moment, Moment)>, env: &Env) {
        let shown = self.player.as_mut().filter(|player| player.holds(&path));
        if let (Some(player), Some(stretch)) = (shown, stretch) {
            return player.show_stretch(stretch, env);
        }
        self.opened = [Some(path.clone()), None];
        self.jobs.start(
            ReplayJob::Open,
            env.background(),
            player::open(path, stretch),
            |work, state, opened| match opened {
                Ok(_) if is_busy(state) => {
                    state.notices.push(state.now, NoticeKind::NotReplayedNow);
                }
                Ok(opened) => work.player = Some(RecordingPlayer::new(opened, state)),
                Err(refused) => state.notices.push(state.now, refused),
            },
        );
    }

    /// Scans for recordings.
    fn scan(&mut self, state: &mut State, env: &Env) {
        let folder = state.settings.recordings_folder(env.documents.as_deref());
        state.recordings.folder.clone_from(&folder);
        if let Some(folder) = folder {
            state.recordings.is_scanning = true;
            self.jobs.start(
                ReplayJob::Scan,
                env.background(),
                recordings::scan(folder, Arc::clone(&state.recordings.items)),
                |work, state, listing| work.apply_listing(listing, state),
            );
        }
    }

    /// Changes the user metadata of a recording, on screen immediately and in its file.
    fn edit_about(
        &mut self,
        state: &mut State,
        path: &Path,
        change: impl FnOnce(&mut RecordingAbout),
    ) {
        let items: &mut Vec<RecordingItem> = Arc::make_mut(&mut state.recordings.items);
        let listed = items.iter_mut().find(|item| item.path == path);
        let about = match (listed, &mut self.player) {
            (Some(item), _) => &mut item.about,
            (None, Some(player)) if player.path() == path => player.about_mut(),
            (None, _) => return,
        };
        change(about);
        let about = about.clone();
        self.to_write
            .push_back(FileWork::Save(path.to_owned(), about));
    }
}

impl FileWork {
    /// Yields the number of deleted recordings.
    async fn carry_out(self) -> Result<usize, NoticeKind> {
        match self {
            Self::Save(path, about) => {
                let place = RecordingAbout::path(&path);
                let saved = on_thread(move || about.save(&path)).await;
                saved.map_err(|error| NoticeKind::not_saved(place, &error))?;
                Ok(0)
            }
            Self::Delete(path) => {
                let place = path.clone();
                let deleted = on_thread(move || budget::delete(&place)).await;
                deleted.map_err(|error| NoticeKind::not_deleted(path, &error))?;
                Ok(1)
            }
            Self::MakeRoom(planned) => {
                let mut deleted = 0;
                for one in planned {
                    let path = one.path.clone();
                    let gone = on_thread(move || one.carry_out()).await;
                    let gone = gone.map_err(|error| NoticeKind::not_deleted(path, &error))?;
                    deleted += usize::from(gone);
                }
                Ok(deleted)
            }
            Self::Tell(folder, planned) => {
                let place = budget::announced_path(&folder);
                let saved = on_thread(move || budget::save_announced(&folder, planned)).await;
                saved.map_err(|error| NoticeKind::not_saved(place, &error))?;
                Ok(0)
            }
        }
    }
}

/// True while a live hand needs the user's attention.
fn is_busy(state: &State) -> bool {
    let is_busy = |hand: &Hand| {
        let asks = hand.procedures.card.is_some() || hand.params.question().is_some();
        hand.runs_series() || asks
    };
    state.hands.iter().any(is_busy) || state.exhibit.is_some()
}
