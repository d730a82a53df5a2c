//! The real window as a booth has it: every way out that a visitor could try leads nowhere, and it comes back after a kill.

use crate::session::alone;
use crate::session::display::{Display, SIZE};
use crate::session::program::{Hand, Window};
use handscope::app::action::Action;
use handscope::app::exhibit::ExhibitAction;
use handscope::app::files::exhibit_file;
use handscope::app::settings::{Language, Theme};
use handscope::hand::Dof;
use handscope::shell::headless::driver::{Driver, Scene};
use handscope::ui::View;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

const FILE: &str = r#"format = "handscope-exhibit"
version = 1
pin = "2468"
tiles = ["Open", "Fist", "Point", "V", "OK", "Rock"]
"#;
/// It is back after a kill by then.
const BACK_WITHIN: Duration = Duration::from_secs(10);
/// A picture that is not there by then does not come.
const WITHIN: Duration = Duration::from_secs(30);

/// Where things stand on the page, and what it looks like: the same page, drawn in memory.
struct Page {
    driver: Driver,
}

impl Page {
    fn new(file: &Path, hand: &Hand) -> Self {
        let mut driver = Driver::start(&Scene {
            endpoint: hand.endpoint.parse().unwrap(),
            size: SIZE,
            scale: 1.0,
            theme: Theme::Dark,
            language: Language::En,
        })
        .unwrap();
        driver.connect().unwrap();
        let now = driver.now();
        let start = exhibit_file::read(file).unwrap();
        driver.cockpit().app().enter_exhibit(start, now);
        driver.run_for(Duration::from_secs(1));
        Self { driver }
    }

    fn act(&mut self, action: ExhibitAction) {
        let now = self.driver.now();
        let app = self.driver.cockpit().app();
        app.act(Action::Exhibit(action), now);
        self.driver.run_for(Duration::from_millis(200));
    }

    /// The middle of what has this name.
    fn place(&mut self, name: &str) -> [f64; 2] {
        let labels = self.driver.picture(View::Live).labels;
        let all = labels.as_array().unwrap().iter();
        let mut named = all.filter(|label| label["name"] == name && label["role"] == "button");
        let rect = &named.next().unwrap_or_else(|| panic!("{name}: {labels}"))["rect"];
        let number = |at: usize| rect[at].as_f64().unwrap();
        [number(0) + number(2) / 2.0, number(1) + number(3) / 2.0]
    }

    /// Share of the pixels in which the display differs from the page.
    fn differs(&mut self, display: &Display) -> f64 {
        let picture = self.driver.picture(View::Live);
        let shown = display.pixels();
        let pairs = picture.rgba.chunks_exact(4).zip(&shown);
        let off = pairs.filter(|(page, shown)| {
            let channels = page.iter().zip(shown.iter());
            channels.into_iter().any(|(a, b)| a.abs_diff(*b) > 48)
        });
        let count = off.count() as f64;
        count / shown.len() as f64
    }

    /// Waits until the display shows the page.
    fn is_shown(&mut self, display: &Display, within: Duration, step: &str) {
        let begun = Instant::now();
        loop {
            let differs = self.differs(display);
            if differs < 0.02 {
                println!(
                    "{step}: {:.2} % differ after {:?}",
                    differs * 100.0,
                    begun.elapsed()
                );
                return;
            }
            assert!(begun.elapsed() < within, "{step}: {differs}");
            sleep(Duration::from_millis(200));
        }
    }
}

/// Keys that mean something in windows, on desktops or in this program's own window.
const KEYS: [&str; 24] = [
    "alt+F4",
    "Escape",
    "F1",
    "F5",
    "F10",
    "F11",
    "shift+F10",
    "Menu",
    "alt+Tab",
    "ctrl+Tab",
    "ctrl+q",
    "ctrl+w",
    "ctrl+r",
    "ctrl+o",
    "ctrl+n",
    "ctrl+plus",
    "ctrl+minus",
    "ctrl+0",
    "a",
    "shift+F",
    "shift+A",
    "question",
    "ctrl+1",
    "super",
];

#[test]
fn no_way_out_of_an_exhibition_but_the_pin_and_back_after_a_kill() {
    let _alone = alone();
    let Some(display) = Display::start() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("booth.toml");
    std::fs::write(&file, FILE).unwrap();
    let (hand, other) = (Hand::start(), Hand::start());
    let before = hand.read("ANGLE_SET");
    let mut page = Page::new(&file, &other);
    let window = Window::exhibit(display.name(), &hand, &file);
    page.is_shown(&display, WITHIN, "begin");
    tries_every_way_out(&display, &mut page);
    assert_eq!(hand.read("ANGLE_SET"), before, "nothing moved");
    // Dropping kills, as SIGKILL does.
    drop(window);
    let window = Window::exhibit(display.name(), &hand, &file);
    page.is_shown(&display, BACK_WITHIN, "after a kill");
    assert_eq!(hand.read("ANGLE_SET"), before, "nothing moved by itself");
    unlock(&display, &mut page);
    display.click(page.place("Arm"));
    page.act(ExhibitAction::CloseStaff);
    let fist = page.place("Fist");
    let armed = Instant::now();
    while hand.is_soon_set_to(Dof::Index, &(0..=5)).is_none() {
        assert!(
            armed.elapsed() < BACK_WITHIN,
            "a visitor saw no moving hand"
        );
        display.click(fist);
    }
    println!(
        "a visitor's hand moves {:?} after it was armed",
        armed.elapsed()
    );
    unlock(&display, &mut page);
    display.click(page.place("Leave the exhibition"));
    window.ends_well();
}

fn tries_every_way_out(display: &Display, page: &mut Page) {
    display.focus("Handscope");
    for key in KEYS {
        display.key(key);
    }
    page.is_shown(display, WITHIN, "keys");
    for name in ["Fist", "Staff: unlock", "STOP"] {
        let at = page.place(name);
        display.click_with(3, at);
        display.click_with(2, at);
    }
    page.is_shown(display, WITHIN, "other buttons of the mouse");
    for change in ["windowsize", "windowmove"] {
        display.change(change, "Handscope", ["500", "300"]);
        page.is_shown(display, WITHIN, change);
    }
    display.close("Handscope");
    page.act(ExhibitAction::AskPin);
    page.is_shown(display, WITHIN, "the cross of the window asks for the PIN");
    display.click(page.place("Cancel"));
    page.act(ExhibitAction::CloseStaff);
    page.is_shown(display, WITHIN, "cancelled");
}

/// Types the PIN, in the window and on the page.
fn unlock(display: &Display, page: &mut Page) {
    display.click(page.place("Staff: unlock"));
    page.act(ExhibitAction::AskPin);
    display.focus("Handscope");
    display.enter("2468");
    page.act(ExhibitAction::Pin("2468".into()));
    sleep(Duration::from_secs(1));
}
