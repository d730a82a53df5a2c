//! The same program without a display, in the same state: where things stand in the window, and what it should look like. Its hand
//! is built in and its time virtual, so that no other work on this machine holds it up; it catches up with the clock.

use crate::session::display::SIZE;
use handscope::app::action::Action;
use handscope::app::exhibit::exhibit_file;
use handscope::app::recordings::RecordingAction;
use handscope::app::settings::{Language, Theme};
use handscope::hand::Moment;
use handscope::shell::headless::canvas::Picture;
use handscope::shell::headless::driver::{Driver, Scene};
use handscope::ui::View;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Pixels that differ by more than this in a channel count as different; edges of letters differ by less.
const CHANNEL: u8 = 48;

/// A program whose window is drawn in memory.
pub(crate) struct Twin {
    driver: Driver,
    pub(crate) view: View,
    began: Instant,
}

impl Twin {
    /// Connects to a hand of its own.
    pub(crate) fn start() -> Self {
        let began = Instant::now();
        let mut driver = Driver::start(&Scene {
            endpoint: "sim:?scenario=idle".parse().unwrap(),
            size: SIZE,
            scale: 1.0,
            theme: Theme::Dark,
            language: Language::En,
        })
        .unwrap();
        driver.connect().unwrap();
        let view = View::Live;
        Self {
            driver,
            view,
            began,
        }
    }

    pub(crate) fn pass(&mut self, time: Duration) {
        sleep(time);
        self.catch_up();
    }

    fn catch_up(&mut self) {
        let passed = self.driver.now().since(Moment::ZERO);
        self.driver
            .run_for(self.began.elapsed().saturating_sub(passed));
    }

    /// Does what the mouse did in the real window.
    pub(crate) fn act(&mut self, action: Action) {
        self.catch_up();
        self.driver.act(action);
        self.pass(Duration::from_millis(100));
    }

    /// Shows the moment at this share of the recording's length, as a drag of its time line does.
    pub(crate) fn seek(&mut self, share: f64) {
        let state = self.driver.desktop_app().app().state();
        let line = state.timeline.as_ref().unwrap();
        let at = line.first.plus(line.last.since(line.first).mul_f64(share));
        self.act(Action::Recording(RecordingAction::Seek(at)));
    }

    pub(crate) fn picture(&mut self, view: View) -> Picture {
        self.driver.picture(view)
    }

    /// Shows the exhibition of a file in place of the window.
    pub(crate) fn exhibit(&mut self, file: &Path) {
        let exhibition = exhibit_file::read(file).unwrap();
        let now = self.driver.now();
        self.driver
            .desktop_app()
            .app()
            .enter_exhibit(exhibition, now);
        self.pass(Duration::from_secs(1));
    }

    /// Share of these pixels in which they differ from what it draws.
    pub(crate) fn differs(&mut self, pixels: &[[u8; 3]]) -> f64 {
        let view = self.view;
        difference(&self.picture(view), pixels)
    }

    /// Where each control stands. Some change their names.
    pub(crate) fn places(&mut self) -> Vec<String> {
        let view = self.view;
        let labels = self.picture(view).labels;
        let controls = labels.as_array().unwrap().iter();
        let controls =
            controls.filter(|label| label["role"] != "label" && label["role"] != "image");
        let place = |label: &serde_json::Value| format!("{} {}", label["role"], label["rect"]);
        controls.map(place).collect()
    }

    /// Left, top, width and height of what has this name.
    pub(crate) fn place(&mut self, name: &str) -> [f64; 4] {
        let view = self.view;
        let labels = self.picture(view).labels;
        let found = labels.as_array().unwrap().iter().find(|label| {
            let role = label["role"].as_str().unwrap();
            label["name"] == name && role != "label"
        });
        let rect = &found.unwrap_or_else(|| panic!("no {name} in {view:?}"))["rect"];
        [0, 1, 2, 3].map(|side| rect[side].as_f64().unwrap())
    }

    pub(crate) fn middle(&mut self, name: &str) -> [f64; 2] {
        let [left, top, width, height] = self.place(name);
        [left + width / 2.0, top + height / 2.0]
    }

    /// Of these views and languages the one whose picture is nearest to these pixels, and the share of pixels that differ from it.
    pub(crate) fn nearest(
        &mut self,
        pixels: &[[u8; 3]],
        among: &[(View, Language)],
    ) -> (View, Language, f64) {
        let before = self.driver.desktop_app().state().settings.language;
        let mut all = Vec::new();
        for (view, language) in among.iter().copied() {
            if self.driver.desktop_app().state().settings.language != language {
                self.act(Action::Language(language));
            }
            let differs = difference(&self.picture(view), pixels);
            all.push((view, language, differs));
        }
        self.act(Action::Language(before));
        all.sort_by(|one, other| one.2.total_cmp(&other.2));
        println!("nearest: {:?}, next: {:?}", all[0], all[1]);
        all[0]
    }
}

fn difference(picture: &Picture, pixels: &[[u8; 3]]) -> f64 {
    let drawn = picture.rgb.chunks_exact(3);
    assert_eq!(drawn.len(), pixels.len());
    let far = |one: &u8, other: &u8| one.abs_diff(*other) > CHANNEL;
    let differing = drawn.zip(pixels).filter(|(drawn, shown)| {
        let mut channels = drawn.iter().zip(shown.iter());
        channels.any(|(one, other)| far(one, other))
    });
    ratio(differing.count(), pixels.len())
}

fn ratio(part: usize, whole: usize) -> f64 {
    let number = |count: usize| f64::from(u32::try_from(count).unwrap());
    number(part) / number(whole)
}
