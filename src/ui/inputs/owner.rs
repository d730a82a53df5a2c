//! Current owner of the hand: its state, the button that ends its control, and the limits that apply to it.

use crate::app::action::Action;
use crate::app::inputs::InputAction;
use crate::app::slot::SlotId;
use crate::app::state::State;
use crate::hand::newtons::ForceUnit;
use crate::link::Owner;
use crate::motion::follow::step::{FollowLimits, FollowPhase};
use crate::ui::kit::{self, Button, Label, NumberField, Pane, Weight, format};
use crate::ui::text::{hold as hold_text, inputs, words};
use crate::ui::theme;
use egui::Ui;

/// Draws the owner with its end button on one line, and the limits for any owner.
pub(crate) fn owner_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    kit::card_ui(ui, look, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.set_min_height(theme::CONTROL_LARGE);
            Label::muted(look, inputs::OWNER).ui(ui);
            let owner = pane.hand().connection.outside_owner();
            let (words, color) = match owner {
                Some(owner) => (owner_words(pane, owner), look.palette.accent),
                None => {
                    let nobody = look.tr(inputs::NOBODY_OUTSIDE);
                    (nobody.to_owned(), look.palette.text)
                }
            };
            Label::new(&words, color).ui(ui);
            let run = pane.hand().running.following();
            if let Some(view) = run.and_then(|run| run.view) {
                let delay = format::millis(view.delay_p99);
                let words = look.fill(inputs::FOLLOW_NOW, &[&view.lead, &delay]);
                Label::new(&words, look.palette.muted).small().ui(ui);
                if let Some(hold) = view.hold {
                    let ended = hold.end.map(|end| hold_text::end(look, Ok(end)));
                    let words = ended
                        .unwrap_or_else(|| hold_text::state(look, &hold.view, ForceUnit::Grams));
                    Label::new(&words, look.palette.text).small().ui(ui);
                }
            }
            if owner.is_some() {
                let button = Button::text(look, inputs::TAKE_BACK).large();
                let button = button.weight(Weight::Strong);
                button.on_click(ui, pane, Action::Input(InputAction::TakeBack));
            }
        });
        ui.horizontal_wrapped(|ui| {
            limits_ui(ui, pane);
            ui.add_space(theme::PAD);
            let settings = &pane.state.settings;
            let (mut held, mut idle) = (settings.hold_to_run, settings.disarm_idle);
            if kit::tick_ui(ui, look, inputs::HOLD_TO_RUN, &mut held) {
                pane.actions.push(Action::HoldToRun(held));
            }
            if kit::tick_ui(ui, look, inputs::DISARM_IDLE, &mut idle) {
                pane.actions.push(Action::DisarmIdle(idle));
            }
        });
        if pane.state.settings.hold_to_run {
            kit::small_text_ui(ui, look.tip(inputs::HOLD_TO_RUN), look.palette.muted);
        }
    });
}

fn limits_ui(ui: &mut Ui, pane: &mut Pane<'_>) {
    let look = pane.look;
    let limits = pane.state.settings.follow;
    Label::muted(look, inputs::LIMITS).ui(ui);
    let mut field = |ui: &mut Ui, text, (from, to): (u16, u16), now: u16| {
        Label::muted(look, text).ui(ui);
        let field = NumberField::new(look.tr(text), look.tip(text), from.into()..=to.into());
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
}

/// Name and rate of the external owner, for every view.
pub(crate) fn owner_words(pane: &Pane<'_>, owner: Owner) -> String {
    let look = pane.look;
    let hand = pane.hand();
    let mirror = hand.inputs.mirror.as_ref();
    let mirror = mirror.filter(|_| owner == Owner::Mirror);
    let leader = mirror.and_then(|mirror| leader_name(pane.state, mirror.leader));
    let name = words::owner(look, owner);
    let name = leader.map_or(name.clone(), |leader| look.pair(&name, &leader));
    let rate = match owner {
        Owner::Mirror => mirror.map(|mirror| mirror.view.rate_hz),
        Owner::Stream(_) => Some(hand.inputs.stream_view.intake.rate_hz),
        Owner::Dds => hand.inputs.dds_view.as_ref().map(|dds| dds.view.rate_hz),
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
    let view = hand.running.following().and_then(|run| run.view);
    let words = match view.and_then(|view| view.heat) {
        Some(heat) => {
            let joint = look.tr(words::dof(heat.dof));
            format!("{words} · {joint} {} °C", heat.celsius)
        }
        None => words,
    };
    match view {
        Some(view) if view.phase != FollowPhase::Following => {
            format!("{words} · {}", look.tr(inputs::phase(view.phase)))
        }
        _ => words,
    }
}

/// Name of the hand in this slot, with its number; `None` without a hand.
pub(crate) fn leader_name(state: &State, slot: SlotId) -> Option<String> {
    let mut all = state.hands.iter().enumerate();
    let (at, hand) = all.find(|(_, hand)| hand.label.slot == slot)?;
    hand.connection.endpoint.as_ref()?;
    Some(format!("{} · {}", at + 1, hand.label.name))
}
