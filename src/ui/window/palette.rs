//! The command palette: all keys, views, poses, demos and settings of the window, found by a part of their name in either
//! language. Executes nothing.

use crate::app::action::Action;
use crate::app::exhibit::ExhibitAction;
use crate::app::hand::list::HandsAction;
use crate::app::layout::RoomLayouts;
use crate::app::recordings::RecordingAction;
use crate::app::scan::{IdRange, ScanTarget};
use crate::app::settings::PlotWindow;
use crate::poses::library::EntryId;
use crate::transport::Endpoint;
use crate::ui::connection::hand_tiles::side_words;
use crate::ui::kit::{self, Button, Look, Pane, ViewRequest, Weight};
use crate::ui::plots::head::span_text;
use crate::ui::plots::panels::PANELS;
use crate::ui::recordings::toggle_recording;
use crate::ui::text::{Text, exhibit, inputs, main, panels, poses, recordings, scan, window};
use crate::ui::theme;
use crate::ui::view::{Tab, View};
use crate::ui::window::key_list::cap_ui;
use crate::ui::window::keys::{ROWS, Wish};
use egui::{Align2, Frame, Id, Key, Modifiers, Rect, Stroke, Ui, Window};

/// Maximum number of commands shown at once; a longer query finds the others.
const SHOWN_MAX: usize = 10;
/// Maximum number of recordings that are searched.
const RECORDINGS_MAX: usize = 200;
/// Width in points.
const WIDTH: f32 = 520.0;

/// A command chosen in the palette.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PaletteCommand {
    /// Effect of a key.
    Wish(Wish),
    /// A pose, demo or reaction.
    Entry(EntryId),
    /// An action without a key.
    Act(Action),
}

/// A command as listed.
#[derive(Debug)]
struct Listed {
    command: PaletteCommand,
    /// Name in the window's language.
    name: String,
    /// Names in both languages and lower case, for searching.
    names: String,
    /// Keywords of its content, searched after the names.
    about: String,
    keys: String,
}

/// The palette, shown or hidden.
#[derive(Debug, Default)]
pub(super) struct CommandPalette {
    query: Option<PaletteQuery>,
}

#[derive(Debug, Default)]
struct PaletteQuery {
    text: String,
    /// Index of the command that Enter chooses.
    chosen: usize,
    /// Drawn before: from now on a click beside it hides it.
    drawn: bool,
}

impl CommandPalette {
    /// Shows or hides the palette.
    pub(super) fn toggle(&mut self) {
        self.query = match self.query {
            None => Some(PaletteQuery::default()),
            Some(_) => None,
        };
    }

    /// True while it is shown.
    pub(super) const fn is_open(&self) -> bool {
        self.query.is_some()
    }

    /// Hides the palette.
    pub(super) fn hide(&mut self) {
        self.query = None;
    }

    /// Draws it at the top of `place`, if it is shown. Returns the chosen command.
    pub(super) fn ui(&mut self, ui: &Ui, place: Rect, pane: &Pane<'_>) -> Option<PaletteCommand> {
        let query = self.query.as_mut()?;
        let (look, unready) = (pane.look, pane.unready());
        let [down, up, enters] = ui.input_mut(|input| {
            let mut taken = |key| input.count_and_consume_key(Modifiers::NONE, key);
            [Key::ArrowDown, Key::ArrowUp, Key::Enter].map(&mut taken)
        });
        let found = found(ui, pane, &query.text);
        let last = found.len().saturating_sub(1);
        query.chosen = (query.chosen + down).saturating_sub(up).min(last);
        let edge = Stroke::new(theme::LINE, look.palette.accent);
        let window = Window::new(look.tr(window::COMMANDS))
            .id(Id::unique("command palette"))
            .title_bar(false)
            .resizable(false)
            .frame(Frame::window(ui.style()).stroke(edge))
            .pivot(Align2::CENTER_TOP)
            .fixed_pos(place.center_top() + egui::vec2(0.0, theme::PAD))
            .constrain_to(place);
        let shown = window.show(ui.ctx(), |ui| {
            ui.set_width((place.width() - 4.0 * theme::PAD).min(WIDTH));
            query.ui(ui, look, unready, &found)
        })?;
        let entered = (enters > 0).then(|| found.get(query.chosen)).flatten();
        let entered = entered.filter(|listed| unready.is_none() || !listed.command.needs_arming());
        let entered = entered.map(|listed| listed.command.clone());
        let chosen = shown.inner.flatten().or(entered);
        let beside = query.drawn && shown.response.clicked_elsewhere();
        query.drawn = true;
        if chosen.is_some() || beside {
            self.query = None;
        }
        chosen
    }
}

impl PaletteQuery {
    /// Draws the query field and the results. Returns the command clicked.
    fn ui(
        &mut self,
        ui: &mut Ui,
        look: Look,
        unready: Option<&str>,
        found: &[Listed],
    ) -> Option<PaletteCommand> {
        let field = kit::translated_edit_ui(ui, look, window::COMMANDS, &mut self.text);
        field.request_focus();
        if field.changed() {
            self.chosen = 0;
        }
        if found.is_empty() {
            kit::small_text_ui(ui, look.tr(window::COMMANDS_NONE), look.palette.muted);
        }
        let (mut clicked, mut why_not) = (None, None);
        // Scrolls so that the selected command is visible.
        let from = self.chosen.saturating_sub(SHOWN_MAX - 1);
        for (place, listed) in found.iter().enumerate().skip(from).take(SHOWN_MAX) {
            ui.horizontal(|ui| {
                let weight = if place == self.chosen {
                    Weight::Strong
                } else {
                    Weight::Quiet
                };
                let refused = unready.filter(|_| listed.command.needs_arming());
                why_not = why_not.or(refused.filter(|_| place == self.chosen));
                let button = Button::new(&listed.name, "").weight(weight);
                let button = button.disabled(refused);
                if button.ui(ui, look).clicked() {
                    clicked = Some(listed.command.clone());
                }
                kit::right_ui(ui, |ui| {
                    if !listed.keys.is_empty() {
                        cap_ui(ui, look, &listed.keys);
                    }
                });
            });
        }
        if let Some(why_not) = why_not {
            kit::small_text_ui(ui, why_not, look.palette.warn);
        }
        clicked
    }
}

impl PaletteCommand {
    /// True for commands that require an armed hand.
    const fn needs_arming(&self) -> bool {
        matches!(
            self,
            Self::Entry(_) | Self::Wish(Wish::Open | Wish::Half | Wish::Close)
        )
    }
}

/// Name outside the list of keys.
const fn name(wish: Wish) -> Text {
    match wish {
        Wish::Opens(ViewRequest::Keys) => window::KEYS,
        wish => wish.words(),
    }
}

/// Commands without a key: settings of the window, hands, recordings, exhibitions. None of them moves a hand.
fn unkeyed(ui: &Ui, pane: &Pane<'_>) -> Vec<(Text, String, Action)> {
    let settings = &pane.state.settings;
    let hand = pane.hand();
    let lay_out = |rooms| Action::Layout(pane.layout(ui, rooms));
    let hold_to_run = Action::HoldToRun(!settings.hold_to_run);
    let disarm_idle = Action::DisarmIdle(!settings.disarm_idle);
    let enter_file = Action::Exhibit(ExhibitAction::EnterFile);
    let other = hand.side.other();
    let mut acts: Vec<(Text, String, Action)> = [
        (window::RESET, lay_out(RoomLayouts::default())),
        (inputs::HOLD_TO_RUN, hold_to_run),
        (inputs::DISARM_IDLE, disarm_idle),
        (exhibit::ENTER, Action::Exhibit(ExhibitAction::Enter)),
        (exhibit::ENTER_FILE, enter_file),
        (side_words(other), Action::Side(other)),
        (
            main::UNIT_NAME,
            Action::AngleUnit(settings.angle_unit.next()),
        ),
    ]
    .map(|(text, action)| (text, String::new(), action))
    .into();
    let is_new = |span: &PlotWindow| *span != settings.plot_window;
    for span in PlotWindow::ALL.into_iter().filter(is_new) {
        let action = Action::PlotWindow(span);
        acts.push((panels::WINDOW_NAME, span_text(span).to_owned(), action));
    }
    for panel in PANELS
        .iter()
        .filter(|panel| settings.plots.shows(panel.kind))
    {
        let title = pane.look.tr(panel.title).to_owned();
        acts.push((panels::GROW, title, Action::GrowPlot(panel.kind)));
    }
    let mut act = |text, action| acts.push((text, String::new(), action));
    if pane.state.hands.has_room() {
        act(window::ADD_HAND, Action::Hands(HandsAction::Add));
    }
    if pane.recorded().is_none() {
        act(window::RECORD, toggle_recording(hand));
        act(scan::FIND, Action::Scan(ScanTarget::Ports(IdRange::Few)));
        if hand.readings.faults.nothing_to_clear().is_none() {
            act(panels::CLEAR, Action::ClearErrors);
        }
        if hand.pose_now(pane.state.now).is_some() {
            let name = pane.look.tr(poses::POSE).to_owned();
            act(poses::CAPTURE, Action::Capture(name));
        }
        if hand.connection.endpoint.is_some() {
            act(panels::DISCONNECT, Action::Disconnect);
        }
        acts.extend(hands(pane));
        acts.extend(open_hands(pane));
    }
    acts.extend(recorded(pane));
    acts
}

/// Commands that connect the slot of the shown hand to another hand that was used before.
fn hands(pane: &Pane<'_>) -> impl Iterator<Item = (Text, String, Action)> {
    let settings = &pane.state.settings;
    let recent = settings.recent.iter().filter_map(|text| text.parse().ok());
    let is_open = |endpoint: &Endpoint| {
        let mut open = pane.state.hands.iter();
        open.any(|hand| hand.connection.endpoint.as_ref() == Some(endpoint))
    };
    let closed = recent.filter(move |endpoint: &Endpoint| !is_open(endpoint));
    closed.map(|endpoint| {
        let name = settings.hand_name(&endpoint).unwrap_or_default();
        let name = format!("{name} {endpoint}").trim().to_owned();
        (panels::CONNECT, name, Action::Connect(endpoint))
    })
}

/// Commands that show another open hand.
fn open_hands(pane: &Pane<'_>) -> impl Iterator<Item = (Text, String, Action)> {
    let shown = pane.hand().label.slot;
    let others = pane.state.hands.iter().map(|hand| &hand.label);
    let others = others.filter(move |label| label.slot != shown);
    others.map(|label| {
        let show = Action::Hands(HandsAction::Show(label.slot));
        (window::SHOW_HAND, label.name.to_string(), show)
    })
}

/// Commands that replay the newest recordings.
fn recorded(pane: &Pane<'_>) -> impl Iterator<Item = (Text, String, Action)> {
    let items = pane.state.recordings.items.iter();
    items.take(RECORDINGS_MAX).map(|item| {
        let name = format!("{} {}", item.title(), item.began());
        let open = RecordingAction::Open(item.path.clone());
        (recordings::REPLAY, name, Action::Recording(open))
    })
}

/// Keywords of a command's content, in addition to its name.
fn about(wish: Wish) -> String {
    let more = match wish {
        Wish::Opens(ViewRequest::View(view)) => view_words(view),
        Wish::Opens(ViewRequest::Tab(tab)) => tab_words(tab),
        Wish::Language => window::LANGUAGE_WORDS,
        Wish::Theme => window::THEME_WORDS,
        _ => return String::new(),
    };
    format!("{} {}", more.en, more.zh)
}

const fn view_words(view: View) -> Text {
    match view {
        View::Live => window::LIVE_WORDS,
        View::Touch => window::TOUCH_WORDS,
        View::Tune => window::TUNE_WORDS,
        View::Compare => window::COMPARE_WORDS,
        View::Faults => window::FAULTS_WORDS,
        View::Poses => window::POSES_WORDS,
        View::Device => window::DEVICE_WORDS,
        View::Checkup => window::CHECKUP_WORDS,
        View::Connection => window::CONNECTION_WORDS,
        View::Inputs => window::INPUTS_WORDS,
        View::Traffic => window::TRAFFIC_WORDS,
        View::Recordings => window::RECORDINGS_WORDS,
    }
}

const fn tab_words(tab: Tab) -> Text {
    match tab {
        Tab::Live => view_words(View::Live),
        Tab::Tune => view_words(View::Tune),
        Tab::Recordings => view_words(View::Recordings),
        Tab::Hand => window::HAND_WORDS,
        Tab::Share => view_words(View::Inputs),
    }
}

/// All commands whose names contain each typed word; those that begin with the first word come first.
fn found(ui: &Ui, pane: &Pane<'_>, typed: &str) -> Vec<Listed> {
    let look = pane.look;
    let (poses, settings) = (&pane.state.poses, &pane.state.settings);
    let listed = |wish: Wish| {
        let text = name(wish);
        Listed {
            command: PaletteCommand::Wish(wish),
            name: look.tr(text).to_owned(),
            names: format!("{} {}", text.en, text.zh).to_lowercase(),
            about: about(wish).to_lowercase(),
            keys: wish.keys(),
        }
    };
    let tabs = Tab::ALL.map(|tab| Wish::Opens(ViewRequest::Tab(tab)));
    let views = View::ALL.into_iter();
    // The faults have a key, and a tab shares the name of its first view.
    let views = views.filter(|view| *view != View::Faults && view.tab().title() != view.title());
    let views = views.map(|view| Wish::Opens(ViewRequest::View(view)));
    let views: Vec<Wish> = views.collect();
    // Hold-to-run, keys that represent many, and focus changes are available as keys only.
    let is_act = |wish: &Wish| {
        !matches!(
            wish,
            Wish::HoldToRun
                | Wish::Entry(_)
                | Wish::Hand(_)
                | Wish::Joint(_)
                | Wish::Opens(ViewRequest::Palette)
        ) && !views.contains(wish)
            && !tabs.contains(wish)
    };
    let mut acts: Vec<Wish> = ROWS.iter().map(|row| row.wish).filter(is_act).collect();
    acts.dedup();
    let wishes = acts.into_iter().chain(tabs).chain(views);
    let wishes = wishes.map(listed);
    let entries = poses.ready(&settings.hidden_poses).into_iter();
    let entries = entries.filter_map(|entry| {
        let names = poses.named(entry)?;
        let key = names.key.map(|key| format!("Shift+{}", key.get()));
        Some(Listed {
            command: PaletteCommand::Entry(entry),
            name: look.entry_name(poses, entry).to_owned(),
            names: format!("{} {}", names.text, names.zh).to_lowercase(),
            about: String::new(),
            keys: key.unwrap_or_default(),
        })
    });
    let typed = typed.to_lowercase();
    let has_all = |listed: &Listed| {
        let mut words = typed.split_whitespace();
        words.all(|word| listed.names.contains(word) || listed.about.contains(word))
    };
    let unkeyed = unkeyed(ui, pane).into_iter();
    let unkeyed = unkeyed.map(|(text, which, action)| Listed {
        command: PaletteCommand::Act(action),
        name: format!("{} {which}", look.tr(text)).trim().to_owned(),
        names: format!("{} {} {which}", text.en, text.zh).to_lowercase(),
        about: String::new(),
        keys: String::new(),
    });
    let all = wishes.chain(entries).chain(unkeyed);
    let mut found: Vec<Listed> = all.filter(has_all).collect();
    found.sort_by_key(|listed| {
        let mut words = listed.names.split_whitespace();
        let begins = words.any(|word| word.starts_with(typed.trim()));
        (!begins, !listed.names.contains(typed.trim()))
    });
    found
}
