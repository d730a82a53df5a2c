//! What besides the window may move the hand, and who reads it: who does now, lines of JSON, the gamepad, the gateway.

use crate::app::action::Action;
use crate::app::inputs::InputAction;
use crate::app::settings::Language;
use crate::hand::{Angle, Moment, PerDof};
use crate::inputs::follow::{FollowLimits, FollowPhase, HOLDS_AFTER};
use crate::inputs::pad::PadControl;
use crate::inputs::pad::source::PadView;
use crate::inputs::stream::StreamPlace;
use crate::link::Owner;
use crate::poses::starter::starter;
use crate::record::ArmRefusal;
use crate::share::gateway::{ClientLease, GatewayClient};
use crate::ui::hand::panel::pose_ui;
use crate::ui::inputs::{PadShown, PoseName, pad_picture_ui, pad_table_ui};
use crate::ui::kit::{self, Button, Label, Look, NumberField, Pane, Weight};
use crate::ui::text::{inputs, words};
use crate::ui::theme;
use egui::{Grid, Panel, Role, ScrollArea, Sense, Ui, WidgetInfo, vec2};
use std::net::SocketAddr;
use std::time::Duration;

/// Where is listened and served unless a person says otherwise: this computer only.
const STREAM_FIRST: &str = "127.0.0.1:6010";
const SHARE_FIRST: &str = "127.0.0.1:6001";
/// A view as wide as this has the gamepad beside the rest.
const WIDE: f32 = 1160.0;
/// Width of what is beside the gamepad.
const SOURCES: f32 = 420.0;
/// The drawn hand needs at least this width, and has this height.
const HAND_LEAST: f32 = 180.0;
const HAND: f32 = 380.0;

/// What was typed and chosen.
#[derive(Debug)]
pub(crate) struct InputsView {
    stream: String,
    is_tcp: bool,
    share: String,
    chosen: Option<PadControl>,
}

impl Default for InputsView {
    fn default() -> Self {
        Self {
            stream: STREAM_FIRST.into(),
            is_tcp: false,
            share: SHARE_FIRST.into(),
            chosen: None,
        }
    }
}

impl InputsView {
    /// Draws it.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        if ui.available_width() < WIDE {
            scroll_ui(ui, "inputs", |ui| {
                self.sources_ui(ui, pane);
                self.pad_ui(ui, pane);
            });
            return;
        }
        let sources = Panel::left("sources");
        kit::bare(sources, SOURCES, theme::GAP_RIGHT).show(ui, |ui| {
            scroll_ui(ui, "inputs", |ui| self.sources_ui(ui, pane));
        });
        scroll_ui(ui, "pad", |ui| self.pad_ui(ui, pane));
    }

    fn sources_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        owner_ui(ui, pane);
        self.stream_ui(ui, pane);
        self.gateway_ui(ui, pane);
    }

    fn stream_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            let at = pane.state.hand().inputs.stream_at;
            kit::head_ui(ui, look, look.say(inputs::STREAM), |_| ());
            kit::say_ui(ui, look.tip(inputs::STREAM), look.palette.muted);
            ui.add_enabled_ui(at.is_none(), |ui| {
                ui.horizontal(|ui| {
                    let both = [(false, inputs::UDP), (true, inputs::TCP)];
                    kit::pick_ui(ui, look, (&mut self.is_tcp, inputs::STREAM), both);
                    address_ui(ui, look.say(inputs::STREAM_AT), &mut self.stream);
                });
            });
            let wanted = place(&self.stream).map(|at| match self.is_tcp {
                true => StreamPlace::Tcp(at),
                false => StreamPlace::Udp(at),
            });
            ui.horizontal_wrapped(|ui| {
                let action = InputAction::Listen(wanted.filter(|_| at.is_none()));
                switch_ui(ui, pane, at, (inputs::LISTEN, action, wanted.is_none()));
                let missing = silence(pane);
                grant_ui(
                    ui,
                    pane,
                    (look.say(inputs::STREAM), InputAction::GrantStream),
                    missing,
                );
            });
            if at.is_some() {
                stream_figures_ui(ui, pane);
            }
        });
    }

    fn gateway_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            let at = pane.state.hand().inputs.gateway_at;
            kit::head_ui(ui, look, look.say(inputs::GATEWAY), |_| ());
            kit::say_ui(ui, look.tip(inputs::GATEWAY), look.palette.muted);
            ui.add_enabled_ui(at.is_none(), |ui| {
                address_ui(ui, look.say(inputs::GATEWAY_AT), &mut self.share);
            });
            let wanted = place(&self.share);
            let action = InputAction::Share(wanted.filter(|_| at.is_none()));
            switch_ui(ui, pane, at, (inputs::SHARE, action, wanted.is_none()));
            let clients = pane.state.hand().inputs.clients.clone();
            if at.is_some() && clients.is_empty() {
                Label::muted(look, inputs::NO_CLIENTS).ui(ui);
            }
            for client in &clients {
                client_ui(ui, pane, client);
            }
        });
    }

    fn pad_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        kit::card_ui(ui, look, |ui| {
            let view = pane.state.hand().inputs.pad_view.clone();
            kit::head_ui(ui, look, look.say(inputs::PAD), |_| ());
            kit::say_ui(ui, look.tip(inputs::PAD), look.palette.muted);
            pad_switch_ui(ui, pane, view.as_ref());
            let (map, poses) = (pane.state.settings.pad_map(), pose_names(look));
            let there = view.as_ref().filter(|view| view.name.is_some());
            let shown = PadShown {
                state: there.map(|view| &view.state),
                map: &map,
                chosen: self.chosen,
                fingers: there.map(|view| view.fingers).unwrap_or_default(),
                poses: &poses,
            };
            let picture = ScrollArea::horizontal().id_salt("pad picture");
            let clicked = picture.show(ui, |ui| pad_picture_ui(ui, look, &shown));
            self.chosen = clicked.inner.or(self.chosen);
            ui.add_space(theme::STEP);
            ui.horizontal_top(|ui| {
                let changed = ui.vertical(|ui| pad_table_ui(ui, look, &shown)).inner;
                let map = changed.map(|map| Action::Input(InputAction::Map(map)));
                pane.actions.extend(map);
                dry_run_ui(ui, pane, there);
            });
        });
    }
}

/// The poses that a button can have.
fn pose_names(look: Look) -> Vec<PoseName> {
    let poses = starter().poses.iter();
    let named = poses.map(|pose| PoseName {
        name: pose.name.clone(),
        shown: match look.language {
            Language::Zh if !pose.name_zh.is_empty() => pose.name_zh.clone(),
            _ => pose.name.clone(),
        },
    });
    named.collect()
}

/// Whether gamepads are looked for, which one is there, and whether it may move the hand.
fn pad_switch_ui(ui: &mut Ui, pane: &mut Pane<'_>, view: Option<&PadView>) {
    let look = pane.look;
    ui.horizontal_wrapped(|ui| {
        let button = Button::said(look, inputs::READ_PAD).selected(view.is_some());
        let button = button.disabled(no_hand(pane)).large();
        let action = InputAction::ReadPad(view.is_none());
        button.sends(ui, pane, Action::Input(action));
        let is_there = view.is_some_and(|view| view.name.is_some());
        let missing = (!is_there).then_some(look.say(inputs::NONE));
        grant_ui(
            ui,
            pane,
            (look.say(inputs::PAD), InputAction::GrantPad),
            missing,
        );
    });
    let Some(view) = view else { return };
    let (text, color) = match (&view.name, &view.trouble) {
        (Some(name), _) => (name.as_str(), look.palette.text),
        (None, Some(trouble)) => (trouble.as_str(), look.palette.warn),
        (None, None) => (look.say(inputs::PLUG_IN), look.palette.muted),
    };
    Label::new(text, color).wrap().ui(ui);
}

/// Where the gamepad wants the hand, drawn, whether it may move it or not; joints that it leaves alone are where they are.
fn dry_run_ui(ui: &mut Ui, pane: &Pane<'_>, view: Option<&PadView>) {
    let room = ui.available_width();
    if room < HAND_LEAST {
        return;
    }
    let look = pane.look;
    let angle = pane.state.hand().sample.angle;
    let shares = PerDof::from_fn(|dof| {
        let wanted = view.and_then(|view| view.aims[dof]);
        let raw = wanted.map(Angle::get).or(angle?.value[dof].documented())?;
        Some(f32::from(raw) / f32::from(Angle::MAX.get()))
    });
    ui.vertical(|ui| {
        kit::say_ui(ui, look.say(inputs::DRY_RUN), look.palette.muted);
        let (rect, response) = ui.allocate_exact_size(vec2(room, HAND), Sense::hover());
        pose_ui(ui, look, rect, &shares);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, look.say(inputs::DRY_RUN)));
    });
}

fn scroll_ui(ui: &mut Ui, salt: &str, add: impl FnOnce(&mut Ui)) {
    ScrollArea::vertical()
        .id_salt(salt)
        .auto_shrink(false)
        .show(ui, add);
}

fn address_ui(ui: &mut Ui, name: &str, text: &mut String) {
    let width = ui.available_width();
    ui.allocate_ui(vec2(width, theme::CONTROL), |ui| {
        kit::edit_ui(ui, (name, name), text)
    });
}

fn place(text: &str) -> Option<SocketAddr> {
    text.trim().parse().ok()
}

fn no_hand(pane: &Pane<'_>) -> Option<&'static str> {
    let is_live = pane.state.hand().link.state.is_live();
    (!is_live).then(|| pane.look.say(inputs::NO_HAND))
}

/// Opens something or closes it, and says where it is.
fn switch_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    at: Option<SocketAddr>,
    (text, action, is_wrong): (crate::ui::text::Text, InputAction, bool),
) {
    let look = pane.look;
    let wrong = (is_wrong && at.is_none()).then(|| look.say(inputs::ADDRESS_WRONG));
    let button = Button::said(look, text).selected(at.is_some()).large();
    let button = button.disabled(no_hand(pane).or(wrong));
    button.sends(ui, pane, Action::Input(action));
    if let Some(at) = at {
        let is_open = !at.ip().is_loopback();
        let color = if is_open {
            look.palette.warn
        } else {
            look.palette.text
        };
        let label = Label::new(&at.to_string(), color).number().ui(ui);
        if is_open {
            label.on_hover_text(look.say(inputs::OPEN_TO_ALL));
        }
    } else if let Some(refused) = &pane.state.hand().inputs.refused {
        Label::new(refused, look.palette.warn).wrap().ui(ui);
    }
}

/// Lets a source move the hand.
fn grant_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    (source, action): (&str, InputAction),
    missing: Option<&str>,
) {
    let look = pane.look;
    let hand = pane.state.hand();
    // What has to be held can still be held once it may.
    let refusal = hand.arm_refusal();
    let refusal = refusal.filter(|reason| *reason != ArmRefusal::LetGo);
    let refusal = refusal.map(|reason| words::refusal(look, reason));
    let taken = hand.outside_owner().map(|_| look.say(inputs::TAKEN));
    let reason = no_hand(pane).or(taken).or(missing);
    let reason = reason.map(ToOwned::to_owned).or(refusal);
    let name = look.pair(look.say(inputs::GRANT), source);
    let button = Button::said(look, inputs::GRANT)
        .named(&name)
        .weight(Weight::Strong)
        .large();
    let button = button.disabled(reason.as_deref());
    button.sends(ui, pane, Action::Input(action));
}

/// Why nobody can be followed over the stream now.
fn silence(pane: &Pane<'_>) -> Option<&'static str> {
    let hand = pane.state.hand();
    let sender = hand.inputs.stream_view.intake.sender;
    let is_fresh = |(_, last): (SocketAddr, Moment)| hand.now.since(last) < HOLDS_AFTER;
    let is_there = hand.inputs.stream_at.is_some() && sender.is_some_and(is_fresh);
    (!is_there).then(|| pane.look.say(inputs::NOBODY_SENDS))
}

fn stream_figures_ui(ui: &mut Ui, pane: &Pane<'_>) {
    let look = pane.look;
    let view = &pane.state.hand().inputs.stream_view;
    let sender = view.intake.sender.map(|(sender, _)| sender.to_string());
    let mut rows = vec![
        (
            look.say(inputs::SENDER),
            sender.unwrap_or_else(|| "-".into()),
        ),
        (
            look.say(inputs::RATE),
            format!("{:.0} Hz", view.intake.rate_hz),
        ),
        (look.say(inputs::TAKEN_LINES), view.intake.taken.to_string()),
        (look.say(inputs::NOT_GRANTED), view.not_granted.to_string()),
    ];
    for (fault, count) in &view.intake.refused {
        rows.push((look.say(inputs::fault(*fault)), count.to_string()));
    }
    figures_ui(ui, look, "stream figures", &rows);
}

fn figures_ui(ui: &mut Ui, look: Look, salt: &str, rows: &[(&str, String)]) {
    Grid::new(salt).num_columns(2).show(ui, |ui| {
        for (name, value) in rows {
            Label::new(name, look.palette.muted).ui(ui);
            Label::new(value, look.palette.text)
                .number()
                .named(name)
                .ui(ui);
            ui.end_row();
        }
    });
}

fn client_ui(ui: &mut Ui, pane: &mut Pane<'_>, client: &GatewayClient) {
    let look = pane.look;
    ui.separator();
    let address = client.address.to_string();
    let holds = matches!(client.lease, ClientLease::Held(_));
    ui.horizontal_wrapped(|ui| {
        Label::new(&address, look.palette.text).number().ui(ui);
        if holds {
            Label::new(look.say(inputs::MOVES), look.palette.accent).ui(ui);
        } else {
            grant_ui(
                ui,
                pane,
                (&address, InputAction::GrantClient(client.id)),
                None,
            );
        }
    });
    let words = look.fill(
        inputs::CLIENT,
        &[&client.hz, &client.reads, &client.writes, &client.refused],
    );
    kit::say_ui(ui, &words, look.palette.muted);
    if let Some(refusal) = &client.refusal {
        kit::say_ui(ui, &refusal.to_string(), look.palette.warn);
    }
}

/// Who may move the hand now, how it goes, and its end.
fn owner_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    kit::card_ui(ui, look, |ui| {
        kit::head_ui(ui, look, look.say(inputs::OWNER), |_| ());
        let owner = pane.state.hand().outside_owner();
        let words = match owner {
            Some(owner) => owner_words(pane, owner),
            None => look.say(inputs::NOBODY_OUTSIDE).to_owned(),
        };
        let color = if owner.is_some() {
            look.palette.accent
        } else {
            look.palette.text
        };
        Label::new(&words, color).wrap().ui(ui);
        if owner.is_some() {
            let button = Button::said(look, inputs::TAKE_BACK).weight(Weight::Strong);
            button
                .large()
                .sends(ui, pane, Action::Input(InputAction::TakeBack));
        }
        if let Some(view) = pane
            .state
            .hand()
            .inputs
            .follow
            .as_ref()
            .and_then(|run| run.view)
        {
            let delay = view.delay_p99.unwrap_or_default();
            let delay = match delay {
                Duration::ZERO => "-".to_owned(),
                delay => format!("{:.1} ms", delay.as_secs_f64() * 1e3),
            };
            let rows = [
                (
                    look.say(inputs::PHASE),
                    look.say(phase(view.phase)).to_owned(),
                ),
                (look.say(inputs::LEAD_NOW), view.lead.to_string()),
                (look.say(inputs::DELAY), delay),
            ];
            figures_ui(ui, look, "follow figures", &rows);
        }
        limits_ui(ui, pane);
        hold_ui(ui, pane);
    });
}

/// Whether a key has to be held while the hand moves.
fn hold_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let mut on = pane.state.settings.hold_to_run;
    let switch = ui.checkbox(&mut on, look.say(inputs::HOLD_TO_RUN));
    if switch
        .on_hover_text(look.tip(inputs::HOLD_TO_RUN))
        .changed()
    {
        pane.actions.push(Action::HoldToRun(on));
    }
    if on {
        kit::say_ui(ui, look.tip(inputs::HOLD_TO_RUN), look.palette.muted);
    }
}

fn limits_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let limits = pane.state.settings.follow;
    ui.horizontal_wrapped(|ui| {
        let mut field = |ui: &mut Ui, text, (from, to): (u16, u16), now: u16| {
            Label::muted(look, text).ui(ui);
            let field = NumberField::new(look.say(text), look.tip(text), from.into()..=to.into());
            let typed = field.whole_ui(ui, pane, Some(f64::from(now)))?;
            u16::try_from(typed).ok()
        };
        let lead = field(ui, inputs::LEAD, FollowLimits::LEAD, limits.lead);
        let rate = field(ui, inputs::FOLLOW_RATE, FollowLimits::RATE, limits.rate);
        if lead.or(rate).is_some() {
            let limits = FollowLimits {
                lead: lead.unwrap_or(limits.lead),
                rate: rate.unwrap_or(limits.rate),
            };
            pane.actions.push(Action::Input(InputAction::Limit(limits)));
        }
    });
}

const fn phase(phase: FollowPhase) -> crate::ui::text::Text {
    match phase {
        FollowPhase::Waiting => inputs::PHASE_WAITING,
        FollowPhase::Following => inputs::PHASE_FOLLOWING,
        FollowPhase::Frozen => inputs::PHASE_FROZEN,
        FollowPhase::Silent => inputs::PHASE_SILENT,
        FollowPhase::Released => inputs::PHASE_RELEASED,
    }
}

/// Who moves the hand from outside, with name and rate, for every view.
pub(crate) fn owner_words(pane: &Pane<'_>, owner: Owner) -> String {
    let look = pane.look;
    let hand = pane.state.hand();
    let name = words::owner(look, owner);
    let rate = match owner {
        Owner::Stream(_) => Some(hand.inputs.stream_view.intake.rate_hz),
        Owner::Gateway(address) => {
            let mut clients = hand.inputs.clients.iter();
            let client = clients.find(|client| client.address == address);
            client.map(|client| f64::from(client.hz))
        }
        _ => None,
    };
    let words = match rate {
        Some(rate) => format!("{name} · {rate:.0} Hz"),
        None => name,
    };
    match hand.inputs.follow.as_ref().and_then(|run| run.view) {
        Some(view) if view.phase != FollowPhase::Following => {
            format!("{words} · {}", look.say(phase(view.phase)))
        }
        _ => words,
    }
}
