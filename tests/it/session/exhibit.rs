//! The real window as a booth has it: every way out that a visitor could try leads nowhere, and it comes back after a kill.

use crate::session::display::Display;
use crate::session::program::{Hand, Window};
use crate::session::twin::Twin;
use crate::setup::busy::alone;
use handscope::app::action::Action;
use handscope::app::exhibit::ExhibitAction;
use handscope::hand::Dof;
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

/// Does on the page that is drawn in memory what was done in the real window.
fn act(page: &mut Twin, action: ExhibitAction) {
    page.act(Action::Exhibit(action));
}

/// Waits until the display shows the page.
fn is_shown(page: &mut Twin, display: &Display, (within, step): (Duration, &str)) {
    let begun = Instant::now();
    loop {
        page.pass(Duration::from_millis(200));
        let differs = page.differs(&display.pixels());
        if differs < 0.02 {
            let (part, took) = (differs * 100.0, begun.elapsed());
            println!("{step}: {part:.2} % differ after {took:?}");
            return;
        }
        assert!(begun.elapsed() < within, "{step}: {differs}");
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

/// With a PIN in it, the file is for nobody else.
fn write_booth(file: &Path) {
    std::fs::write(file, FILE).unwrap();
    let only_ours = std::os::unix::fs::PermissionsExt::from_mode(0o600);
    std::fs::set_permissions(file, only_ours).unwrap();
}

#[test]
fn no_way_out_of_an_exhibition_but_the_pin_and_back_after_a_kill() {
    alone(|| {
        let Some(display) = Display::start() else {
            return;
        };
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("booth.toml");
        write_booth(&file);
        let hand = Hand::start();
        let before = hand.read("ANGLE_SET");
        let mut page = Twin::start();
        page.exhibit(&file);
        let window = Window::exhibit(display.name(), &hand, &file);
        is_shown(&mut page, &display, (WITHIN, "begin"));
        tries_every_way_out(&display, &mut page);
        assert_eq!(hand.read("ANGLE_SET"), before, "nothing moved");
        // Dropping kills, as SIGKILL does.
        drop(window);
        let window = Window::exhibit(display.name(), &hand, &file);
        is_shown(&mut page, &display, (BACK_WITHIN, "after a kill"));
        assert_eq!(hand.read("ANGLE_SET"), before, "nothing moved by itself");
        unlock(&display, &mut page);
        display.click(page.middle("Arm"));
        act(&mut page, ExhibitAction::CloseStaff);
        let fist = page.middle("Fist");
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
        display.click(page.middle("Leave the exhibition"));
        window.ends_well();
    });
}

fn tries_every_way_out(display: &Display, page: &mut Twin) {
    display.focus("Handscope");
    for key in KEYS {
        display.key(key);
    }
    is_shown(page, display, (WITHIN, "keys"));
    for name in ["Fist", "Staff: unlock", "STOP"] {
        let at = page.middle(name);
        display.click_with(3, at);
        display.click_with(2, at);
    }
    is_shown(page, display, (WITHIN, "other buttons of the mouse"));
    for change in ["windowsize", "windowmove"] {
        display.change(change, "Handscope", ["500", "300"]);
        is_shown(page, display, (WITHIN, change));
    }
    display.close("Handscope");
    act(page, ExhibitAction::AskPin);
    is_shown(
        page,
        display,
        (WITHIN, "the cross of the window asks for the PIN"),
    );
    display.click(page.middle("Cancel"));
    act(page, ExhibitAction::CloseStaff);
    is_shown(page, display, (WITHIN, "cancelled"));
}

/// Types the PIN, in the window and on the page.
fn unlock(display: &Display, page: &mut Twin) {
    display.click(page.middle("Staff: unlock"));
    act(page, ExhibitAction::AskPin);
    display.focus("Handscope");
    display.enter("2468");
    act(page, ExhibitAction::Pin("2468".into()));
    sleep(Duration::from_secs(1));
}

#[test]
fn the_page_has_the_size_of_its_screen_both_ways_also_without_a_window_manager() {
    alone(|| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("booth.toml");
        write_booth(&file);
        let hand = Hand::start();
        for (width, height) in [(1024, 768), (800, 600), (1920, 1200)] {
            let Some(display) = Display::start_sized((width, height)) else {
                return;
            };
            let (width, height) = (
                i32::try_from(width).unwrap(),
                i32::try_from(height).unwrap(),
            );
            let _window = Window::exhibit(display.name(), &hand, &file);
            display.waits_for("Handscope");
            // Smaller and larger than the screen, as a window that lost its full screen.
            for size in [None, Some(["500", "300"]), Some(["2000", "1500"])] {
                if let Some(size) = size {
                    display.change("windowsize", "Handscope", size);
                }
                let begun = Instant::now();
                while display.geometry("Handscope") != [0, 0, width, height] {
                    let is = display.geometry("Handscope");
                    assert!(
                        begun.elapsed() < WITHIN,
                        "{width}x{height}, {size:?}: {is:?}"
                    );
                    sleep(Duration::from_millis(100));
                }
            }
        }
    });
}
