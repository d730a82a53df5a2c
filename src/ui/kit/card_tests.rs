//! A card over a window of one button: what reaches what.

use crate::app::action::Action;
use crate::app::settings::{Language, Theme};
use crate::ui::kit::card::{ButtonRole, Card, CardButton, CardView};
use crate::ui::kit::controls::{Button, pressed};
use crate::ui::style::Look;
use crate::ui::text::{Text, cards};
use crate::ui::theme::{self, Palette};
use crate::ui::window;
use crate::ui::window::keys;
use crate::ui::window::keys::Wish;
use egui::{Id, Key, Pos2, Role, Ui, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

const fn at(x: f32, y: f32) -> Pos2 {
    Pos2::new(x, y)
}

const fn sized(width: f32, height: f32) -> Vec2 {
    Vec2::new(width, height)
}

struct Room {
    cards: CardView,
    card: Option<Card>,
    asked: Vec<Action>,
    stops: u32,
    below: u32,
    language: Language,
    installed: bool,
}

fn frame(ui: &mut Ui, room: &mut Room) {
    let look = Look {
        palette: Palette::of(Theme::Dark),
        language: room.language,
        side: crate::hand::kinematics::Side::Right,
    };
    if !std::mem::replace(&mut room.installed, true) {
        // Fonts hold from the second frame on.
        window::install(ui.ctx(), Theme::Dark, room.language);
        return;
    }
    let wishes = keys::consume(ui, keys::Escape::Stops);
    room.stops += u32::from(wishes.contains(&Wish::Stop));
    let (bar, body) = ui.max_rect().split_top_bottom_at_y(theme::TOP_BAR);
    let stop = Button::new("STOP", "tip").put(ui, look, bar, Id::unique("stop"));
    room.stops += u32::from(pressed(ui, &stop));
    if room.card.is_some() {
        ui.disable();
    }
    let below = Button::new("Below", "tip").put(ui, look, body, Id::unique("below"));
    room.below += u32::from(below.clicked());
    let card = room.card.clone();
    let asked = room.cards.ui(ui, body, card);
    if asked.is_some() {
        room.card = None;
    }
    room.asked.extend(asked);
}

const fn text(en: &'static str) -> Text {
    Text::new(en, en)
}

fn card() -> Card {
    titled("Really")
}

fn titled(title: &'static str) -> Card {
    let decline = Action::Leave;
    let cancel = CardButton::new(cards::CANCEL, ButtonRole::Safe, decline);
    offering(card_named(title).choice(cancel))
}

fn card_named(title: &'static str) -> Card {
    let look = Look {
        palette: Palette::of(Theme::Dark),
        language: Language::En,
        side: crate::hand::kinematics::Side::Right,
    };
    Card::new(look, text(title))
        .words("This is a sentence of many words. ".repeat(6))
        .warning(text("Look out."))
        .note(text("By the way."))
        .check(Some(true), text("open"))
        .check(None, text("still"))
        .row(text("Index"), ["12 g".into(), "0 g".into()])
        .progress(0.4, text("9 s"))
}

fn offering(card: Card) -> Card {
    let best = CardButton::new(text("Best"), ButtonRole::Main, Action::Arm);
    let danger = CardButton::new(cards::TYPE, ButtonRole::Danger, Action::Disarm);
    card.choice(CardButton::new(
        text("Other"),
        ButtonRole::Plain,
        Action::Arm,
    ))
    .choice(best.disabled(Some(text("not yet"))))
    .choice(danger)
}

fn open(card: Card, size: Vec2) -> Harness<'static, Room> {
    let room = Room {
        cards: CardView::default(),
        card: Some(card),
        asked: Vec::new(),
        stops: 0,
        below: 0,
        language: Language::En,
        installed: false,
    };
    let mut harness = Harness::builder()
        .with_size(size)
        .build_ui_state(frame, room);
    harness.run_steps(4);
    harness
}

const LARGE: Vec2 = sized(1440.0, 900.0);
const SMALL: Vec2 = sized(1024.0, 640.0);
const DANGER: &str = "To go on, type";

fn click(harness: &mut Harness<'static, Room>, name: &str) {
    harness.get_by_role_and_label(Role::Button, name).click();
    harness.run_steps(3);
}

#[test]
fn nothing_below_a_card_is_pressed_and_stop_is() {
    let mut harness = open(card(), LARGE);
    for place in [at(20.0, 880.0), at(700.0, 120.0)] {
        harness.drag_at(place);
        harness.drop_at(place);
        harness.run_steps(2);
    }
    click(&mut harness, "Below");
    let below = harness.get_by_role_and_label(Role::Button, "Below");
    assert!(below.accesskit_node().is_disabled());
    click(&mut harness, "STOP");
    let room = harness.state();
    assert_eq!((room.below, room.stops), (0, 1));
    assert!(room.card.is_some(), "a stop closes nothing by itself");
    click(&mut harness, "Cancel");
    click(&mut harness, "Below");
    assert_eq!(
        harness.state().below,
        1,
        "once it is gone, all is as before"
    );
}

#[test]
fn enter_does_what_is_safe_and_never_what_is_dangerous() {
    let mut harness = open(card(), LARGE);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    let room = harness.state();
    assert!(room.card.is_none());
    assert_eq!(room.asked, [Action::Leave]);

    let mut harness = open(card(), LARGE);
    harness.get_by_role_and_label(Role::Button, DANGER).focus();
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    assert!(harness.state().asked.is_empty());
    harness.key_press(Key::Space);
    harness.run_steps(3);
    let room = harness.state();
    assert_eq!((room.asked.len(), room.stops), (0, 1), "Space stops");
    assert!(room.card.is_some());
    click(&mut harness, "Best");
    assert!(harness.state().card.is_some(), "it is disabled");
    click(&mut harness, DANGER);
    assert_eq!(harness.state().asked, [Action::Disarm]);
    assert!(harness.state().card.is_none());
}

#[test]
fn escape_stops_and_closes_only_what_is_safe_to_close() {
    let mut harness = open(card(), LARGE);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    let room = harness.state();
    assert_eq!((room.stops, room.card.is_some()), (1, false));

    let mut harness = open(offering(card_named("Really")), LARGE);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    let room = harness.state();
    assert_eq!((room.stops, room.card.is_some()), (1, true));
}

#[test]
fn the_tab_key_stays_in_the_card() {
    let mut harness = open(card(), LARGE);
    for _ in 0..6 {
        harness.key_press(Key::Tab);
        harness.run_steps(2);
        let mut focused = harness.query_all_by(|node| node.is_focused());
        let name = focused.find_map(|node| node.accesskit_node().label());
        assert_ne!(name.as_deref(), Some("Below"));
    }
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    assert_eq!(harness.state().below, 0);
}

#[test]
fn what_is_dangerous_waits_for_its_word() {
    let mut harness = open(card().typed("RESET"), LARGE);
    let field = "To go on, type RESET";
    click(&mut harness, DANGER);
    assert!(harness.state().asked.is_empty());
    harness
        .get_by_role_and_label(Role::TextInput, field)
        .focus();
    harness.run_steps(2);
    for (typed, passes) in [("RESE", false), ("T", true)] {
        harness
            .get_by_role_and_label(Role::TextInput, field)
            .type_text(typed);
        harness.run_steps(3);
        let danger = harness.get_by_role_and_label(Role::Button, DANGER);
        assert_eq!(danger.accesskit_node().is_disabled(), !passes, "{typed}");
    }
    harness.key_press(Key::Space);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    let room = harness.state();
    assert_eq!(
        (room.stops, room.asked.len()),
        (0, 0),
        "who types is left alone"
    );
    click(&mut harness, DANGER);
    assert_eq!(harness.state().asked, [Action::Disarm]);
}

#[test]
fn a_card_fits_every_window_and_is_read_as_one() {
    for size in [SMALL, LARGE, sized(640.0, 400.0)] {
        let many = (0..40).map(|row| format!("Line {row} of many."));
        for card in [card(), many.fold(card(), Card::words)] {
            let harness = open(card, size);
            let dialog = harness.get_by_role_and_label(Role::AlertDialog, "Really");
            let body = egui::Rect::from_min_max(at(0.0, theme::TOP_BAR), size.to_pos2());
            assert!(
                body.expand(1.0).contains_rect(dialog.rect()),
                "{:?}",
                dialog.rect()
            );
            for name in ["Cancel", DANGER] {
                let rect = harness.get_by_role_and_label(Role::Button, name).rect();
                assert!(body.contains_rect(rect), "{size:?} {name} {rect:?}");
            }
        }
    }
}

#[test]
fn another_card_begins_with_an_empty_field() {
    let with_word = |title| titled(title).typed("RESET");
    let mut harness = open(with_word("One"), LARGE);
    let field = "To go on, type RESET";
    harness
        .get_by_role_and_label(Role::TextInput, field)
        .type_text("RESET");
    harness.run_steps(3);
    harness.state_mut().card = Some(with_word("Two"));
    harness.run_steps(3);
    let danger = harness.get_by_role_and_label(Role::Button, DANGER);
    assert!(danger.accesskit_node().is_disabled());
}
