//! Hands to connect to, each as a tile with a drawn hand: one click connects.

use crate::app::action::Action;
use crate::hand::PerDof;
use crate::hand::kinematics::Side;
use crate::link::scan::FoundHand;
use crate::transport::Endpoint;
use crate::ui::hand::tile::pose_ui;
use crate::ui::kit::{Button, Label, Look, Pane, Weight};
use crate::ui::text::{Text, panels, scan};
use crate::ui::theme;
use egui::{Align, Color32, Id, Layout, Rect, Ui, UiBuilder, Vec2, vec2};

/// Minimum width of a tile, and its height.
const TILE: Vec2 = vec2(288.0, 88.0);
/// Width of the drawn hand.
const HAND: f32 = 56.0;

/// A hand to connect to.
pub(super) struct HandTile {
    /// `None` if it is unreachable.
    pub(super) endpoint: Option<Endpoint>,
    /// Accessible name.
    pub(super) name: String,
    pub(super) side: Side,
    pub(super) title: String,
    pub(super) place: String,
    /// Current state, with its colour.
    pub(super) state: (String, Color32),
    /// Reason why it cannot be connected to.
    pub(super) refusal: Option<Text>,
}

/// Previously used hands and those found by a scan, each once.
pub(super) fn known_hands(pane: &Pane<'_>) -> Vec<HandTile> {
    let (settings, found) = (&pane.state.settings, &pane.state.scan.found);
    let recent = settings.recent.iter().filter_map(|text| text.parse().ok());
    let mut all: Vec<(Endpoint, Option<&FoundHand>)> = recent
        .map(|endpoint: Endpoint| {
            let answer = found.iter().find(|found| found.endpoint == endpoint);
            (endpoint, answer)
        })
        .collect();
    for found in found {
        if all.iter().all(|(endpoint, _)| *endpoint != found.endpoint) {
            all.push((found.endpoint.clone(), Some(found)));
        }
    }
    let tiles = all.into_iter();
    tiles
        .map(|(endpoint, found)| tile(pane, endpoint, found))
        .collect()
}

fn tile(pane: &Pane<'_>, endpoint: Endpoint, found: Option<&FoundHand>) -> HandTile {
    let (look, settings) = (pane.look, &pane.state.settings);
    let id = match (found, &endpoint) {
        (Some(found), _) => Some(found.hand_id.into()),
        (None, Endpoint::Sim { .. } | Endpoint::Tcp { .. }) => None,
        (None, endpoint) => Some(endpoint.place_and_id().1),
    };
    let kind = scan::title(look, &endpoint, id);
    let place = match &endpoint {
        Endpoint::Sim { .. } => String::new(),
        endpoint => endpoint.place(),
    };
    let port = endpoint.port();
    let mut listed = pane.state.ports.iter();
    let listed = listed.find(|listed| Some(listed.path.as_str()) == port);
    let usb = found.and_then(|found| found.usb.as_ref());
    let usb = usb.or_else(|| listed?.usb.as_ref());
    let place = match usb {
        Some(usb) => format!("{place}  {usb}"),
        None => place,
    };
    let (title, place) = match settings.hand_name(&endpoint) {
        Some(name) => (name.to_owned(), format!("{kind}  {place}")),
        None => (kind, place),
    };
    let side = settings.side_of(Some(&endpoint));
    let day = settings.last_day(&endpoint);
    let day = day.map(|day| look.fill(scan::LAST_USED, &[&day]));
    let (seen, color) = match (found, listed) {
        (Some(_), _) => (Some(scan::ANSWERED), look.palette.ok),
        (None, Some(_)) => (Some(scan::PLUGGED_IN), look.palette.ok),
        (None, None) => (None, look.palette.muted),
    };
    let seen = seen.map(|text| look.tr(text).to_owned()).or(day);
    let state = [Some(look.tr(side_words(side)).to_owned()), seen];
    let state: Vec<String> = state.into_iter().flatten().collect();
    HandTile {
        name: endpoint.to_string(),
        endpoint: Some(endpoint),
        side,
        title,
        place: place.trim().to_owned(),
        state: (state.join(" · "), color),
        refusal: None,
    }
}

pub(crate) const fn side_words(side: Side) -> Text {
    match side {
        Side::Left => panels::LEFT_HAND,
        Side::Right => panels::RIGHT_HAND,
    }
}

/// Draws the tiles side by side.
pub(super) fn hand_tiles_ui(ui: &mut Ui, pane: &mut Pane<'_>, tiles: &[HandTile]) {
    tiles_ui(ui, TILE, tiles, |ui, at, tile| tile_ui(ui, pane, at, tile));
}

fn tile_ui(ui: &mut Ui, pane: &mut Pane<'_>, (id, place): (Id, Rect), tile: &HandTile) {
    let (look, hand) = (pane.look, pane.hand());
    let is_now = hand.connection.is_live()
        && tile.endpoint.is_some()
        && hand.connection.endpoint == tile.endpoint;
    let (text, weight) = if is_now {
        (scan::CONNECTED, Weight::Chosen)
    } else {
        (panels::CONNECT, Weight::Normal)
    };
    let name = format!("{}: {}", look.tr(text), tile.name);
    let refusal = tile.refusal.map(|reason| look.tr(reason));
    let button = Button::text(look, text).named(&name).weight(weight);
    let button = button.disabled(pane.recorded().or(refusal));
    let pressed = button.ground(ui, look, place, id).clicked() && !is_now;
    let connect = tile.endpoint.clone().filter(|_| pressed);
    pane.actions.extend(connect.map(Action::Connect));
    let inner = place.shrink(theme::GAP);
    let (picture, words) = inner.split_left_right_at_x(inner.left() + HAND);
    let own = Look {
        side: tile.side,
        ..look
    };
    pose_ui(ui, own, picture, &PerDof::splat(Some(1.0)));
    let words = words.with_min_x(words.left() + theme::PAD);
    let mut words = inside_of(ui, words);
    words.spacing_mut().item_spacing.y = 2.0;
    Label::new(&tile.title, look.palette.text).ui(&mut words);
    let small = |text, color| Label::new(text, color).small();
    if !tile.place.is_empty() {
        small(&tile.place, look.palette.muted).ui(&mut words);
    }
    let (state, color) = match is_now {
        true => (look.tr(scan::CONNECTED), look.palette.accent),
        false => (tile.state.0.as_str(), tile.state.1),
    };
    small(state, color).ui(&mut words);
}

/// Draws items of one size side by side, in rows that fill the width; `least` is the minimum width and the height.
pub(super) fn tiles_ui<T>(
    ui: &mut Ui,
    least: Vec2,
    items: &[T],
    mut add: impl FnMut(&mut Ui, (Id, Rect), &T),
) {
    if items.is_empty() {
        return;
    }
    let width = ui.available_width();
    let fits = |columns: &f32| least.x * columns + theme::GAP * (columns - 1.0) <= width;
    let columns = [4.0, 3.0, 2.0].into_iter().find(fits);
    let columns = columns.unwrap_or(1.0);
    let width = ((width - theme::GAP * (columns - 1.0)) / columns).floor();
    let size = vec2(width, least.y);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = Vec2::splat(theme::GAP);
        for item in items {
            let at = ui.allocate_space(size);
            add(ui, at, item);
        }
    });
}

/// A child `Ui` for the content of a tile, from its top.
fn inside_of(ui: &mut Ui, place: Rect) -> Ui {
    let layout = Layout::top_down(Align::Min);
    ui.new_child(UiBuilder::new().max_rect(place).layout(layout))
}
