//! Starting an exhibition in place of the window, and ending it.

use crate::app::env::{Ctx, Env};
use crate::app::exhibit::{ExhibitAction, ExhibitState, Exhibition, StoredReport, exhibit_file};
use crate::app::hand::Hand;
use crate::app::notices::NoticeKind;
use crate::app::program::hands;
use crate::app::state::State;
use crate::hand::Moment;
use crate::store::{JobKind, Jobs};

/// Background work of exhibitions.
#[derive(Debug, Default)]
pub(crate) struct ExhibitWork {
    jobs: Jobs<OpenExhibition>,
    /// Report of an exhibition that has ended; it is being written.
    left: Option<StoredReport>,
}

/// Background job around exhibitions: choosing and reading an exhibition file.
#[derive(Debug, PartialEq, Eq)]
struct OpenExhibition;

impl JobKind for OpenExhibition {
    type State = ExhibitWork;
    type Ctx<'a> = State;
}

impl ExhibitWork {
    /// Shows an exhibition in place of the window. Nothing moves before staff arm.
    pub(crate) fn enter(&mut self, start: Exhibition, state: &mut State, env: &Env, now: Moment) {
        self.leave(state, env, now);
        // A file that is still being opened would replace this exhibition with its PIN.
        self.jobs.cancel(&OpenExhibition);
        state.now = now;
        let is_open = |hand: &&Hand| hand.connection.open.is_some();
        if state.hands.iter().filter(is_open).count() > 1 {
            state.notices.push(now, NoticeKind::ExhibitWantsOneHand);
            return;
        }
        let hand = state.hands.shown();
        if !hand.activity().lets_exhibit() || !is_open(&hand) {
            state.notices.push(now, NoticeKind::ExhibitNotBegun);
            return;
        }
        hands::with_shown(state, env, |hand, _, ctx| {
            stop_or_disarm(hand, ctx);
            hand.take_over();
        });
        let hand = state.hands.shown();
        state.exhibit = ExhibitState::begin(start, hand, &state.settings, env);
        if let Some(exhibit) = &mut state.exhibit
            && let Some(left) = self.left.take()
        {
            exhibit.report = left;
        }
    }

    /// Carries out a user action. True if the program should end with the exhibition.
    pub(crate) fn act(&mut self, action: ExhibitAction, state: &mut State, env: &Env) -> bool {
        let now = state.now;
        let Some(exhibit) = &mut state.exhibit else {
            match action {
                ExhibitAction::Enter => {
                    if let Some(start) = exhibit_file::built_in() {
                        self.enter(start, state, env, now);
                    }
                }
                ExhibitAction::EnterFile => self.enter_file(env),
                // These belong to a running exhibition.
                ExhibitAction::Wish(_)
                | ExhibitAction::AskPin
                | ExhibitAction::Pin(_)
                | ExhibitAction::CloseStaff
                | ExhibitAction::Leave => {}
            }
            return false;
        };
        let leaves = exhibit.act(action, now);
        let ends_program = exhibit.ends_program;
        if leaves {
            self.leave(state, env, now);
        }
        leaves && ends_program
    }

    /// Asks for an exhibition file, and shows its exhibition.
    fn enter_file(&mut self, env: &Env) {
        if self.jobs.is_running(&OpenExhibition) {
            return;
        }
        let to_enter = env.clone();
        self.jobs.start(
            OpenExhibition,
            env.background(),
            exhibit_file::open(env),
            move |work, state, opened| match opened {
                Ok(start) => work.enter(start, state, &to_enter, state.now),
                Err(refused) => state.notices.push(state.now, refused),
            },
        );
    }

    fn leave(&mut self, state: &mut State, env: &Env, now: Moment) {
        let Some(exhibit) = state.exhibit.take() else {
            return;
        };
        state.settings.language = exhibit.language;
        self.left = Some(exhibit.report);
        state.now = now;
        hands::with_shown(state, env, |hand, _, ctx| stop_or_disarm(hand, ctx));
    }

    /// Advances the exhibition, its file and its report.
    pub(crate) fn tick(&mut self, state: &mut State, now: Moment) {
        while let Some(effect) = self.jobs.next_ended() {
            effect(self, state);
        }
        if let Some(exhibit) = &mut state.exhibit
            && exhibit.tick(state.hands.shown_mut(), now)
        {
            state.settings.language = exhibit.language;
        }
        if let Some(mut report) = self.left.take() {
            if report.flush(now) {
                report
                    .troubles()
                    .for_each(|told| state.notices.push(now, told.clone()))
            } else {
                self.left = Some(report)
            }
        }
    }

    /// Writes unsaved reports. True once all are in files, or cannot be written.
    pub(crate) fn flush(&mut self, state: &mut State, now: Moment) -> bool {
        let shown = state.exhibit.iter_mut().map(|exhibit| &mut exhibit.report);
        let mut reports = shown.chain(&mut self.left);
        reports.all(|report| report.flush(now))
    }
}

/// Stops a hand that may move. A hand at rest is disarmed, so that an earlier request cannot arm it later.
fn stop_or_disarm(hand: &mut Hand, ctx: &mut Ctx<'_>) {
    if hand.connection.may_move() {
        hand.stop(ctx)
    } else {
        hand.disarm(ctx.now)
    }
}
