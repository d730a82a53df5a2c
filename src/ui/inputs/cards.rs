//! Each way in and out besides the window: where it is, whether it is open, who is there.

use crate::app::action::Action;
use crate::app::inputs::{InputAction, InputKind, InputSource};
use crate::inputs::stream::StreamPlace;
use crate::link::Owner;
use crate::record::ArmRefusal;
use crate::share::gateway::{ClientLease, GatewayClient};
use crate::ui::inputs::mirror_card::mirror_ui;
use crate::ui::inputs::owner::figures_ui;
use crate::ui::kit::{self, Button, Label, Look, Pane, Weight};
use crate::ui::text::{Text, errors, inputs, words};
use crate::ui::theme;
use egui::{Ui, vec2};
use std::net::{IpAddr, SocketAddr};

/// What was typed.
#[derive(Debug)]
pub(crate) struct SourceCards {
    stream: String,
    is_tcp: bool,
    share: String,
    viewers: String,
    dds: String,
}

impl Default for SourceCards {
    /// This computer only, unless a person says otherwise.
    fn default() -> Self {
        Self {
            stream: "127.0.0.1:6010".into(),
            is_tcp: false,
            share: "127.0.0.1:6001".into(),
            viewers: "127.0.0.1:8765".into(),
            dds: "127.0.0.1".into(),
        }
    }
}

/// What a switch opens, its words, and what a press does.
type Switch = (InputKind, Text, InputAction);
/// Where something is open, and what is wrong with the place that was typed.
type Place = (Option<(IpAddr, String)>, Option<Text>);

impl SourceCards {
    /// Draws all.
    pub(crate) fn ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        if pane.state.hands.is_several() {
            card_ui(ui, pane, inputs::MIRROR, |ui, pane| {
                let missing = mirror_ui(ui, pane);
                let source = (
                    look.say(inputs::MIRROR),
                    InputAction::Grant(InputSource::Mirror),
                );
                grant_ui(ui, pane, source, missing);
            });
        }
        card_ui(ui, pane, inputs::STREAM, |ui, pane| {
            self.stream_ui(ui, pane)
        });
        card_ui(ui, pane, inputs::DDS, |ui, pane| self.dds_ui(ui, pane));
        card_ui(ui, pane, inputs::GATEWAY, |ui, pane| {
            self.gateway_ui(ui, pane)
        });
        card_ui(ui, pane, inputs::VIEWERS, |ui, pane| {
            self.viewers_ui(ui, pane)
        });
    }

    fn stream_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let at = pane.state.hand().inputs.stream_at;
        ui.add_enabled_ui(at.is_none(), |ui| {
            ui.horizontal(|ui| {
                let both = [(false, inputs::UDP), (true, inputs::TCP)];
                kit::pick_ui(ui, look, (&mut self.is_tcp, inputs::STREAM), both);
                address_ui(ui, look.say(inputs::STREAM_AT), &mut self.stream);
            });
        });
        let wanted = place(&self.stream).map(|at| {
            if self.is_tcp {
                StreamPlace::Tcp(at)
            } else {
                StreamPlace::Udp(at)
            }
        });
        let action = InputAction::Listen(wanted.filter(|_| at.is_none()));
        ui.horizontal_wrapped(|ui| {
            let switch = (InputKind::Stream, inputs::LISTEN, action);
            switch_ui(ui, pane, switch, socket(at, wanted.is_none()));
            let view = &pane.state.hand().inputs.stream_view;
            let missing = silence(pane, view.owner(pane.state.now).filter(|_| at.is_some()));
            let source = (
                look.say(inputs::STREAM),
                InputAction::Grant(InputSource::Stream),
            );
            grant_ui(ui, pane, source, missing);
        });
        if at.is_some() {
            stream_figures_ui(ui, pane);
        }
    }

    fn dds_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let view = pane.state.hand().inputs.dds_view.clone();
        ui.add_enabled_ui(view.is_none(), |ui| {
            address_ui(ui, look.say(inputs::DDS_AT), &mut self.dds);
        });
        let wanted = Some(self.dds.trim().to_owned()).filter(|name| !name.is_empty());
        let action = InputAction::JoinDds(wanted.clone().filter(|_| view.is_none()));
        let at = view
            .as_ref()
            .map(|view| (view.at.into(), view.at.to_string()));
        let wrong = wanted.is_none().then_some(inputs::INTERFACE_WRONG);
        ui.horizontal_wrapped(|ui| {
            let switch = (InputKind::Dds, inputs::JOIN, action);
            switch_ui(ui, pane, switch, (at, wrong));
            let owner = view.as_ref();
            let owner = owner.and_then(|view| view.view.owner(pane.state.now));
            let missing = silence(pane, owner);
            let other = view.as_ref().and_then(|view| view.other.as_ref());
            let other =
                other.map(|other| look.fill(inputs::OTHER_FOLLOWS, &[&other.host, &other.name]));
            let source = (look.say(inputs::DDS), InputAction::Grant(InputSource::Dds));
            grant_ui(ui, pane, source, other.as_deref().or(missing));
        });
        let Some(view) = view else { return };
        let refused: u64 = view.view.refused.values().sum();
        let rows = [
            (look.say(inputs::STATES), view.told.states.to_string()),
            (
                look.say(inputs::RATE),
                format!("{:.0} Hz", view.view.rate_hz),
            ),
            (look.say(inputs::COMMANDS), view.view.taken.to_string()),
            (look.say(inputs::REFUSED), refused.to_string()),
            (
                look.say(inputs::NOT_GRANTED),
                view.view.not_granted.to_string(),
            ),
        ];
        figures_ui(ui, look, "dds figures", &rows);
        if let Some(newest) = view.view.refused.keys().next_back() {
            kit::say_ui(ui, look.say(inputs::ctrl_fault(*newest)), look.palette.warn);
        }
    }

    fn gateway_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let at = pane.state.hand().inputs.gateway_at;
        ui.add_enabled_ui(at.is_none(), |ui| {
            address_ui(ui, look.say(inputs::GATEWAY_AT), &mut self.share);
        });
        let wanted = place(&self.share);
        let action = InputAction::Share(wanted.filter(|_| at.is_none()));
        ui.horizontal_wrapped(|ui| {
            let switch = (InputKind::Gateway, inputs::SHARE, action);
            switch_ui(ui, pane, switch, socket(at, wanted.is_none()));
        });
        if pane.state.settings.first_client_moves {
            let label = Label::new(look.say(inputs::FIRST_CLIENT), look.palette.warn);
            label.wrap().ui(ui);
        }
        let clients = pane.state.hand().inputs.clients.clone();
        if at.is_some() && clients.is_empty() {
            Label::muted(look, inputs::NO_CLIENTS).ui(ui);
        }
        for client in &clients {
            client_ui(ui, pane, client);
        }
    }

    fn viewers_ui(&mut self, ui: &mut Ui, pane: &mut Pane<'_>) {
        let look = pane.look;
        let served = pane.state.hand().inputs.foxglove_at;
        ui.add_enabled_ui(served.is_none(), |ui| {
            address_ui(ui, look.say(inputs::VIEWERS_AT), &mut self.viewers);
        });
        let wanted = place(&self.viewers);
        let action = InputAction::Show(wanted.filter(|_| served.is_none()));
        let at = served.map(|(at, _)| at);
        ui.horizontal_wrapped(|ui| {
            let switch = (InputKind::Viewers, inputs::SHOW, action);
            switch_ui(ui, pane, switch, socket(at, wanted.is_none()));
        });
        if let Some((_, count)) = served {
            let rows = [(look.say(inputs::VIEWERS_NOW), count.to_string())];
            figures_ui(ui, look, "viewers", &rows);
        }
    }
}

fn card_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    title: Text,
    add: impl FnOnce(&mut Ui, &mut Pane<'_>),
) {
    let look = pane.look;
    kit::card_ui(ui, look, |ui| {
        kit::head_ui(ui, look, look.say(title), |_| ());
        kit::say_ui(ui, look.tip(title), look.palette.muted);
        add(ui, pane);
    });
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

/// Why nothing can be opened without a hand.
pub(crate) fn no_hand(pane: &Pane<'_>) -> Option<&'static str> {
    let is_live = pane.state.hand().connection.status.state.is_live();
    (!is_live).then(|| pane.look.say(inputs::NO_HAND))
}

fn socket(at: Option<SocketAddr>, is_wrong: bool) -> Place {
    let wrong = is_wrong.then_some(inputs::ADDRESS_WRONG);
    (at.map(|at| (at.ip(), at.to_string())), wrong)
}

/// A switch: while it is on it says so, and how it ends. Its name stays.
pub(crate) fn on_off(look: Look, text: Text, on: bool) -> Button<'static> {
    let shown = if on { inputs::ON } else { text };
    Button::new(look.say(shown), look.tip(shown))
        .named(look.say(text))
        .switch(on)
}

/// Opens something or closes it, and says where it is, or why it is not.
fn switch_ui(ui: &mut Ui, pane: &mut Pane<'_>, (kind, text, action): Switch, (at, wrong): Place) {
    let look = pane.look;
    let wrong = wrong.filter(|_| at.is_none()).map(|wrong| look.say(wrong));
    let button = on_off(look, text, at.is_some()).large();
    let button = button.disabled(no_hand(pane).or(wrong));
    button.on_click(ui, pane, Action::Input(action));
    let refused = pane.state.hand().inputs.refused.as_ref();
    match (at, refused.filter(|(refused, _)| *refused == kind)) {
        (Some((ip, at)), _) if !ip.is_loopback() => {
            let label = Label::new(&at, look.palette.warn).number().ui(ui);
            label.on_hover_text(look.say(inputs::OPEN_TO_ALL));
        }
        (Some((_, at)), _) => drop(Label::new(&at, look.palette.text).number().ui(ui)),
        (None, Some((_, why))) => {
            let why = errors::not_opened(look, why);
            Label::new(&why, look.palette.warn).wrap().ui(ui);
        }
        (None, None) => {}
    }
}

/// Lets a source move the hand.
pub(crate) fn grant_ui(
    ui: &mut Ui,
    pane: &mut Pane<'_>,
    (source, action): (&str, InputAction),
    missing: Option<&str>,
) {
    let look = pane.look;
    let hand = pane.state.hand();
    // What has to be held can still be held once it may.
    let refusal = hand.arm_refusal(pane.state.now);
    let refusal = refusal.filter(|reason| *reason != ArmRefusal::LetGo);
    let refusal = refusal.map(|reason| words::refusal(look, reason));
    let taken = hand
        .connection
        .outside_owner()
        .map(|_| look.say(inputs::TAKEN));
    let reason = no_hand(pane).or(taken).or(missing);
    let reason = reason.map(ToOwned::to_owned).or(refusal);
    let name = look.pair(look.say(inputs::GRANT), source);
    let button = Button::said(look, inputs::GRANT)
        .named(&name)
        .weight(Weight::Strong)
        .large();
    let button = button.disabled(reason.as_deref());
    button.on_click(ui, pane, Action::Input(action));
}

/// Why nobody can be followed now, if nobody sends.
fn silence(pane: &Pane<'_>, owner: Option<Owner>) -> Option<&'static str> {
    let is_silent = owner.is_none();
    is_silent.then(|| pane.look.say(inputs::NOBODY_SENDS))
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
        kit::say_ui(ui, &errors::write_refusal(look, refusal), look.palette.warn);
    }
}
