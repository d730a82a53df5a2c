//! The real window with a real mouse, on a display in memory and in front of a hand in another process: what is pressed
//! reaches the hand, and each step looks as the headless pictures say. Where Xvfb or xdotool is missing this is skipped.

use crate::session::display::Display;
use crate::session::program::{Hand, REST, Window};
use crate::session::twin::Twin;
use crate::setup::busy::{alone, unless_busy};
use crate::setup::process;
use handscope::app::action::Action;
use handscope::app::recordings::RecordingAction;
use handscope::app::settings::Language;
use handscope::hand::{Angle, Dof};
use handscope::ui::View;
use std::ops::RangeInclusive;
use std::time::{Duration, Instant};

/// Share of pixels that may differ: lines in plots run on, live numbers flicker. A hand that is not armed differs in more.
const TOLERANCE: f64 = 0.02;
/// A list of frames scrolls.
const TRAFFIC_TOLERANCE: f64 = 0.03;
/// A picture that is not there by then does not come, on a machine with other work.
const WITHIN: Duration = Duration::from_secs(30);

const ATTEMPTS: usize = 4;

struct Session {
    display: Display,
    hand: Hand,
    window: Window,
    twin: Twin,
    /// Where the button that arms stands; armed, it has another name.
    arm: [f64; 2],
    /// It was armed before. Feedback that grew old may have disarmed it since.
    was_armed: bool,
}

impl Session {
    fn start(display: Display, more: &[&str]) -> Self {
        let hand = Hand::start();
        let window = Window::start(display.name(), &hand, more);
        Self::with(display, hand, window)
    }

    fn with(display: Display, hand: Hand, window: Window) -> Self {
        let mut twin = Twin::start();
        let arm = twin.middle("Arm the hand");
        Self {
            display,
            hand,
            window,
            twin,
            arm,
            was_armed: false,
        }
    }

    /// Waits until the display shows this view and language more than what was shown before or the other language, and nothing else
    /// than it should.
    fn looks(&mut self, step: &str, view: View, language: Language) {
        let mut among = vec![(view, language), (view, language.other())];
        if self.twin.view != view {
            among.push((self.twin.view, language));
        }
        let tolerance = match view {
            View::Traffic => TRAFFIC_TOLERANCE,
            _ => TOLERANCE,
        };
        let begun = Instant::now();
        loop {
            self.twin.pass(Duration::from_millis(200));
            let pixels = self.display.pixels();
            let (nearest, words, differs) = self.twin.nearest(&pixels, &among);
            if (nearest, words) == (view, language) && differs <= tolerance {
                println!("{step}: {:.2} % of the pixels differ", differs * 100.0);
                return;
            }
            assert!(
                begun.elapsed() < WITHIN,
                "{step}: shows {nearest:?} in {words:?}, {differs} differs"
            );
        }
    }

    fn click(&mut self, name: &str) {
        let at = self.twin.middle(name);
        self.display.click(at);
    }

    /// The setpoints after a step that sends the index here. On a machine with other work the feedback may have grown old
    /// and the hand be disarmed, as it should; then a person arms it again.
    fn armed(&mut self, to: &RangeInclusive<i16>, mut step: impl FnMut(&mut Self)) -> Vec<i16> {
        for _ in 0..ATTEMPTS {
            step(self);
            if let Some(asked) = self.hand.is_soon_set_to(Dof::Index, to) {
                let index = Angle::new(asked[Dof::Index.index()]).unwrap();
                self.twin.act(Action::Target(Dof::Index, index));
                return asked;
            }
            self.twin.pass(Duration::from_millis(200));
            // The same click disarms a hand that is still armed.
            if !self.was_armed || self.twin.differs(&self.display.pixels()) > TOLERANCE {
                self.display.click(self.arm);
                self.twin.act(Action::Arm);
                self.was_armed = true;
            }
            self.looks("armed", View::Live, Language::En);
        }
        panic!("the index does not follow");
    }

    /// Drags the handle of a track, which stands at `from`, to `to`; both are shares of the track.
    fn drag(&mut self, name: &str, from: f64, to: f64) {
        let [left, top, width, height] = self.twin.place(name);
        let at = |share: f64| [left + width * share, top + height / 2.0];
        self.display.move_to(at(from));
        self.display.press();
        for step in 1..=5 {
            self.display
                .move_to(at(from + (to - from) * f64::from(step) / 5.0));
        }
        self.display.release();
        self.display.move_to([4.0, 896.0]);
    }
}

fn session(more: &[&str]) {
    let Some(display) = Display::start() else {
        return;
    };
    let mut session = Session::start(display, more);
    session.looks("start", View::Live, Language::En);
    session.display.focus("Handscope");
    let open = session.hand.read("ANGLE_SET");
    assert_eq!(
        open,
        session.hand.read("ANGLE_SET"),
        "nothing moved by itself"
    );

    session.drag("Index angle target", 0.95, 0.4);
    assert_eq!(
        session.hand.read("ANGLE_SET"),
        open,
        "not armed: nothing moves"
    );
    let asked = session.armed(&(0..=700), |session| {
        session.drag("Index angle target", 0.95, 0.6);
    });
    let index = asked[Dof::Index.index()];
    session
        .hand
        .reads_at_most("ANGLE_ACT", Dof::Index, index + 20);
    let stands = session.hand.read("ANGLE_ACT");
    for dof in Dof::ALL.into_iter().filter(|dof| *dof != Dof::Index) {
        assert!(
            stands[dof.index()] >= 950,
            "{dof:?} was not dragged: {stands:?}"
        );
    }
    session.looks("dragged", View::Live, Language::En);
    // A click selects the number that stands in the field, and what is typed takes its place.
    session.armed(&(820..=820), |session| {
        session.click("Index angle number");
        session.display.enter("820");
    });
    session.looks("typed", View::Live, Language::En);

    let places = session.twin.places();
    session.drag("Middle angle target", 0.95, 0.05);
    session.click("STOP");
    let held = session.hand.rests_where_it_stands();
    assert!(
        held[Dof::Middle.index()] > 60,
        "it was stopped on its way: {held:?}"
    );
    session.twin.act(Action::Target(
        Dof::Middle,
        Angle::new(held[Dof::Middle.index()]).unwrap(),
    ));
    session.twin.pass(Duration::from_secs(3));
    session.twin.act(Action::Stop);
    session.looks("stopped", View::Live, Language::En);
    let now = session.twin.places();
    for place in places {
        assert!(now.contains(&place), "{place} is not in {now:#?}");
    }

    session.display.key("ctrl+l");
    session.twin.act(Action::Language(Language::Zh));
    session.looks("Chinese", View::Live, Language::Zh);
    session.display.key("ctrl+l");
    session.twin.act(Action::Language(Language::En));
    for (name, view) in [
        ("Faults", View::Faults),
        ("Tune", View::Tune),
        ("Hand", View::Connection),
        ("Traffic", View::Traffic),
        ("Live", View::Live),
    ] {
        session.click(name);
        session.looks(name, view, Language::En);
        session.twin.view = view;
        if view == View::Traffic {
            session.click("Export CSV");
            let (path, text) = session.window.saves();
            assert_eq!(path.extension(), Some("csv".as_ref()), "{path:?}");
            assert!(text.lines().count() > 10, "{text}");
        }
    }
    let stands = session.hand.rests_where_it_stands();
    let moved = held
        .iter()
        .zip(&stands)
        .map(|(held, stands)| held.abs_diff(*stands));
    assert!(
        moved.max() <= Some(REST),
        "looking moves nothing: {held:?}, {stands:?}"
    );
    session.display.close("Handscope");
    session.window.ends_well();
}

#[test]
fn a_session_with_the_mouse_in_the_window_with_opengl() {
    alone(|| {
        session(&["--opengl"]);
    });
}

#[test]
fn a_session_with_the_mouse_in_the_window_without_opengl() {
    alone(|| {
        session(&["--software"]);
    });
}

#[test]
fn a_recording_is_scrubbed_with_the_mouse() {
    alone(|| {
        let Some(display) = Display::start() else {
            return;
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grasp.mcap");
        let file = path.to_str().unwrap();
        let hand = "sim:?scenario=grasp";
        let recorded = process::run(&["record", "--hand", hand, "--for", "6", "--out", file]);
        assert_eq!(recorded.code, Some(0), "{}", recorded.err);
        let mut session = Session::start(display, &["--software", file]);
        let open = RecordingAction::Open(path.clone());
        session.twin.act(Action::Recording(open));
        session.looks("replayed", View::Live, Language::En);
        for share in [0.3, 0.9, 0.6] {
            session.drag("Time line", 0.45, share);
            session.twin.seek(share);
            session.looks("scrubbed", View::Live, Language::En);
        }
        let stands = session.hand.read("ANGLE_SET");
        session.click("Hand");
        session.twin.view = View::Connection;
        session.looks(
            "another view of that moment",
            View::Connection,
            Language::En,
        );
        session.click("Back to live");
        session.twin.act(Action::Recording(RecordingAction::Close));
        session.looks("live again", View::Connection, Language::En);
        assert_eq!(session.hand.read("ANGLE_SET"), stands, "nothing moved");
        session.display.close("Handscope");
        session.window.ends_well();
    });
}

#[test]
fn where_opengl_does_not_start_the_window_opens_without_it_and_says_so() {
    unless_busy(|| {
        let Some(display) = Display::start_without_opengl() else {
            return;
        };
        let hand = Hand::start();
        let window = Window::start_without_drivers(display.name(), &hand);
        let mut session = Session::with(display, hand, window);
        session.looks("without OpenGL", View::Live, Language::En);
        let arguments = session.window.arguments();
        assert!(arguments.contains("--software-because"), "{arguments}");
        assert!(arguments.contains(&session.hand.endpoint), "{arguments}");
        session.display.close("Handscope");
        session.window.ends_well();
    });
}
