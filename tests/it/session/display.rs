//! A display in memory with a mouse: starts Xvfb, moves and presses through xdotool, reads the pixels. Claims nothing.

use crate::setup::skipped::skipped;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;
use tempfile::TempDir;
use x11rb::protocol::xproto::{ClientMessageEvent, ConnectionExt as _, EventMask};

/// The size of the display, and of the window that fills it: without a window manager it stands at the top left.
pub(crate) const SIZE: (u32, u32) = (1440, 900);
/// Between two steps of the mouse a frame passes, as with a hand on a real one.
const FRAME: Duration = Duration::from_millis(60);

/// So long a pointer stays where it clicked: a hand does not leave within a slow frame.
const LINGERS: Duration = Duration::from_millis(400);

/// A display that nobody sees. Dropping it ends it.
pub(crate) struct Display {
    server: Child,
    name: String,
    folder: TempDir,
}

impl Display {
    /// None where it is skipped, as Xvfb or xdotool is not installed.
    pub(crate) fn start() -> Option<Self> {
        Self::start_with(SIZE, &[])
    }

    /// One with a screen of this size.
    pub(crate) fn start_sized(size: (u32, u32)) -> Option<Self> {
        Self::start_with(size, &[])
    }

    /// One that offers no OpenGL.
    pub(crate) fn start_without_opengl() -> Option<Self> {
        Self::start_with(SIZE, &["-extension", "GLX"])
    }

    fn start_with(size: (u32, u32), more: &[&str]) -> Option<Self> {
        let there = |program| Command::new(program).arg("-version").output().is_ok();
        if !there("Xvfb") || !there("xdotool") {
            skipped("the real window", "Xvfb or xdotool is not installed");
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        let screen = format!("{}x{}x24", size.0, size.1);
        let mut server = Command::new("Xvfb")
            // Without -noreset it turns clients away for a moment whenever its last one has left, as when the window has closed.
            .args(["-noreset", "-displayfd", "1", "-nolisten", "tcp"])
            .args(["-screen", "0"])
            .args([&screen, "-fbdir", folder.path().to_str().unwrap()])
            .args(more)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        let out = server.stdout.take().unwrap();
        BufReader::new(out).read_line(&mut number).unwrap();
        Some(Self {
            server,
            name: format!(":{}", number.trim()),
            folder,
        })
    }

    /// As programs are told of it.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    fn tool(&self, args: &[&str]) -> String {
        let done = Command::new("xdotool")
            .args(args)
            .env("DISPLAY", &self.name)
            .output()
            .unwrap();
        assert!(done.status.success(), "{args:?}: {done:?}");
        String::from_utf8(done.stdout).unwrap()
    }

    pub(crate) fn move_to(&self, [x, y]: [f64; 2]) {
        self.tool(&["mousemove", &x.round().to_string(), &y.round().to_string()]);
        sleep(FRAME);
    }

    pub(crate) fn press(&self) {
        self.tool(&["mousedown", "1"]);
        sleep(FRAME);
    }

    pub(crate) fn release(&self) {
        self.tool(&["mouseup", "1"]);
        sleep(FRAME);
    }

    pub(crate) fn click(&self, at: [f64; 2]) {
        self.move_to(at);
        self.press();
        self.release();
        sleep(LINGERS);
        // Away from what shows a tip under the pointer.
        self.move_to([4.0, f64::from(SIZE.1) - 4.0]);
    }

    /// Clicks with another button: 2 the middle one, 3 the right one.
    pub(crate) fn click_with(&self, button: u8, at: [f64; 2]) {
        self.move_to(at);
        self.tool(&["click", &button.to_string()]);
        sleep(FRAME);
    }

    /// Presses a key, or several together.
    pub(crate) fn key(&self, key: &str) {
        self.tool(&["key", key]);
        sleep(FRAME);
    }

    /// Moves the window or gives it another size, as a person does at its frame.
    pub(crate) fn change(&self, how: &str, title: &str, [x, y]: [&str; 2]) {
        self.tool(&["search", "--onlyvisible", "--name", title, how, x, y]);
        sleep(FRAME);
    }

    /// Presses a key with Shift, in the time that a person takes.
    pub(crate) fn shifted(&self, key: &str) {
        self.tool(&["keydown", "shift"]);
        sleep(2 * FRAME);
        self.key(key);
        sleep(FRAME);
        self.tool(&["keyup", "shift"]);
        sleep(FRAME);
    }

    /// Left, top, width and height of the window.
    pub(crate) fn geometry(&self, title: &str) -> [i32; 4] {
        let told = self.tool(&[
            "search",
            "--onlyvisible",
            "--name",
            title,
            "getwindowgeometry",
            "--shell",
        ]);
        ["X=", "Y=", "WIDTH=", "HEIGHT="].map(|name| {
            let mut lines = told.lines();
            let value = lines.find_map(|line| line.strip_prefix(name));
            value.unwrap().parse().unwrap()
        })
    }

    /// Waits until a window of this title is there.
    pub(crate) fn waits_for(&self, title: &str) {
        self.tool(&["search", "--sync", "--onlyvisible", "--name", title]);
    }

    /// Sends a signal to the server: it may be gone already.
    pub(crate) fn signal(&self, signal: Signal) {
        let id = i32::try_from(self.server.id()).unwrap();
        let _sent = kill(Pid::from_raw(id), signal);
    }

    /// Gives the window the keyboard, as a window manager does.
    pub(crate) fn focus(&self, title: &str) {
        self.tool(&[
            "search",
            "--onlyvisible",
            "--name",
            title,
            "windowfocus",
            "--sync",
        ]);
    }

    /// Types on the keyboard, and Enter.
    pub(crate) fn enter(&self, text: &str) {
        self.tool(&["type", "--delay", "60", text]);
        self.tool(&["key", "Return"]);
        sleep(FRAME);
    }

    /// Asks the window to close, as a window manager does when its cross is pressed.
    pub(crate) fn close(&self, title: &str) {
        let windows = self.tool(&["search", "--onlyvisible", "--name", title]);
        let window: u32 = windows.lines().next().unwrap().parse().unwrap();
        let (display, _) = x11rb::connect(Some(&self.name)).unwrap();
        let atom = |name: &str| {
            let asked = display.intern_atom(false, name.as_bytes()).unwrap();
            asked.reply().unwrap().atom
        };
        let data = [atom("WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0];
        let asks = ClientMessageEvent::new(32, window, atom("WM_PROTOCOLS"), data);
        let sent = display.send_event(false, window, EventMask::NO_EVENT, asks);
        sent.unwrap().check().unwrap();
    }

    /// What was on the display when a step failed, for whoever looks into it.
    fn keep_picture(&self) {
        let file = concat!(env!("CARGO_TARGET_TMPDIR"), "/window_session.png");
        let pixels = self.pixels();
        let rgb = pixels.as_flattened();
        let kept = handscope::shell::headless::png::save(file.as_ref(), rgb, SIZE);
        println!("what the display showed: {file} ({kept:?})");
    }

    /// What is on the display: RGB, row by row from the top left.
    pub(crate) fn pixels(&self) -> Vec<[u8; 3]> {
        let file: PathBuf = self.folder.path().join("Xvfb_screen0");
        let dump = fs::read(file).unwrap();
        // X Window Dump, version 7: numbers of 32 bits, high byte first; then colours of 12 bytes; then rows.
        let word = |at: usize| {
            let bytes = dump[at * 4..at * 4 + 4].try_into().unwrap();
            usize::try_from(u32::from_be_bytes(bytes)).unwrap()
        };
        let (head, width, height, colours) = (word(0), word(4), word(5), word(19));
        let (low_first, bits, row) = (word(7) == 0, word(11), word(12));
        assert_eq!((word(1), bits, low_first), (7, 32, true));
        let begin = head + colours * 12;
        let rows = dump[begin..].chunks_exact(row).take(height);
        let pixels = rows.flat_map(|row| row.chunks_exact(4).take(width));
        pixels.map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.keep_picture();
        }
        let _gone = self.server.kill();
        let _ended = self.server.wait();
    }
}
