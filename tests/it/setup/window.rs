//! The real program with its real window, in front of a simulated hand on a wire that can be pulled. Virtual time only.

use crate::setup::faulty::{FaultPlan, faulty_pair};
use crate::setup::hand;
use crate::setup::link;
use crate::setup::program::{InFolder, Program, env};
use crate::setup::time::Time;
use egui::{Key, Modifiers, Rect, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use futures::future::BoxFuture;
use handscope::app::action::Action;
use handscope::app::env::Env;
use handscope::app::exhibit::Exhibition;
use handscope::app::hand::list::HandsAction;
use handscope::app::settings::Settings;
use handscope::app::state::State;
use handscope::exhibit::plan::ExhibitPlan;
use handscope::hand::{Dof, Force, Moment, SerialSpeed, Speed};
use handscope::record::LinkState;
use handscope::shell::headless::labels::displayed;
use handscope::sim::serve::SharedHand;
use handscope::sim::{SimConfig, SimHand, SimHands};
use handscope::transport::{BoxedWire, Dial, Endpoint, PortFound, Wire, pair};
use handscope::ui::View;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tempfile::TempDir;
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::task::{AbortHandle, JoinHandle};

pub(crate) use egui::accesskit::Role;

pub(crate) const LARGE: Vec2 = vec2(1440.0, 900.0);
/// Virtual time of one frame.
pub(crate) const FRAME_MS: u64 = 20;
/// While a person only waits, one frame of so many is drawn. With far fewer, the window would count as hung.
const DRAWN_EACH: u64 = 12;
/// And so many of the last ones: what one frame brings, the next shows.
const LAST_DRAWN: u64 = 2;

/// ANGLE_SET, FORCE_SET, SPEED_SET, CLEAR_ERROR and the gesture number (manual 2.6).
pub(crate) const ANGLE_SET: u16 = 1486;
pub(crate) const FORCE_SET: u16 = 1498;
pub(crate) const SPEED_SET: u16 = 1522;
pub(crate) const CLEAR_ERROR: u16 = 1004;
pub(crate) const GESTURE: u16 = 1008;

/// A hand at a place of its own, with a cable of its own.
struct Placed {
    endpoint: Endpoint,
    hand: SharedHand,
    is_plugged: bool,
    served: Vec<AbortHandle>,
}

/// The far end of the cable: plugged in or not.
struct Socket {
    hand: SharedHand,
    /// Hands at other places.
    placed: Mutex<Vec<Placed>>,
    /// Hands beside it on the next wire.
    others: Mutex<Vec<SharedHand>>,
    plugged: Mutex<bool>,
    /// What the next wire has.
    faults: Mutex<Option<FaultPlan>>,
    served: Mutex<Vec<AbortHandle>>,
    /// What the system lists.
    listed: Mutex<Vec<PortFound>>,
    dials: AtomicUsize,
}

impl Socket {
    fn to(hand: SharedHand) -> Self {
        Self {
            hand,
            placed: Mutex::default(),
            others: Mutex::default(),
            plugged: Mutex::new(true),
            faults: Mutex::default(),
            served: Mutex::default(),
            listed: Mutex::default(),
            dials: AtomicUsize::new(0),
        }
    }
}

impl Dial for Socket {
    fn dial(&self, endpoint: &Endpoint) -> link::Dialled {
        self.dials.fetch_add(1, Ordering::Relaxed);
        let mut placed = self.placed.lock().unwrap();
        if let Some(placed) = placed.iter_mut().find(|one| one.endpoint == *endpoint) {
            if !placed.is_plugged {
                return link::missing(endpoint.to_string());
            }
            let (ours, its) = pair();
            let served = hand::serve(placed.hand.clone(), endpoint, its);
            placed.served.push(served.abort_handle());
            return link::opened(ours);
        }
        drop(placed);
        if !*self.plugged.lock().unwrap() {
            return link::missing(endpoint.to_string());
        }
        let (ours, its) = match *self.faults.lock().unwrap() {
            None => pair(),
            Some(plan) => {
                let (ours, its, _) = faulty_pair(plan);
                (ours, its)
            }
        };
        let hands = SimHands::new(self.hand.clone(), self.others.lock().unwrap().clone());
        let mut tasks = Vec::new();
        let its = match endpoint {
            Endpoint::Rs485(line) | Endpoint::Rtu(line) => {
                let (at_line, far) = pair();
                let carried = at_speed(self.hand.clone(), line.baud, its, far);
                tasks.push(tokio::spawn(carried));
                Box::new(at_line) as BoxedWire
            }
            _ => Box::new(its) as BoxedWire,
        };
        tasks.push(hand::serve(hands, endpoint, its));
        let handles = tasks.iter().map(JoinHandle::abort_handle);
        self.served.lock().unwrap().extend(handles);
        link::opened(ours)
    }

    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        let listed = self.listed.lock().unwrap().clone();
        Box::pin(std::future::ready(listed))
    }
}

/// Carries bytes both ways while the hand has the speed at which the port was opened; at another speed nobody understands a byte.
async fn at_speed(hand: SharedHand, baud: u32, mut near: impl Wire, mut far: impl Wire) {
    let code = SerialSpeed::ALL
        .into_iter()
        .find(|speed| speed.baud() == baud)
        .map(SerialSpeed::code);
    let is_heard = || Some(hand.with(|hand, _| hand.baud_code())) == code;
    let (mut asked, mut answered) = ([0; 512], [0; 512]);
    loop {
        let passed = tokio::select! {
            read = near.read(&mut asked) => match read {
                Ok(len @ 1..) if is_heard() => far.write_all(&asked[..len]).await,
                Ok(1..) => Ok(()),
                _ => return,
            },
            read = far.read(&mut answered) => match read {
                Ok(len @ 1..) if is_heard() => near.write_all(&answered[..len]).await,
                Ok(1..) => Ok(()),
                _ => return,
            },
        };
        if passed.is_err() {
            return;
        }
    }
}

/// Whether settings and records are kept on disk.
#[derive(Debug, Clone, Copy)]
enum Keeps {
    Nothing,
    Records,
}

/// What the frames are drawn from.
struct Room {
    program: Program,
    socket: Arc<Socket>,
    /// Where files go that the person saves.
    folder: TempDir,
    /// Files that were shown in the file manager.
    revealed: Arc<Mutex<Vec<PathBuf>>>,
    /// Every state of the link there was at a frame's time, without repetitions.
    seen: Vec<LinkState>,
}

impl Room {
    fn new(config: SimConfig, settings: Settings, keeps: Keeps) -> Self {
        let folder = TempDir::new().unwrap();
        let revealed = Arc::new(Mutex::new(Vec::new()));
        let told = Arc::clone(&revealed);
        let mut socket = None;
        let mut program = Program::start(Time::Virtual, None, || {
            let socket = socket.insert(Arc::new(Socket::to(hand::shared(config))));
            let env = Env {
                dial: Arc::clone(socket) as Arc<dyn Dial>,
                files: Arc::new(InFolder(folder.path().into())),
                reveal: Arc::new(move |path| {
                    told.lock().unwrap().push(path.to_owned());
                    Ok(())
                }),
                documents: match keeps {
                    Keeps::Nothing => None,
                    Keeps::Records => Some(folder.path().join("documents")),
                },
                settings_path: match keeps {
                    Keeps::Nothing => None,
                    Keeps::Records => Some(folder.path().join("kept/settings.toml")),
                },
                ..env()
            };
            (env, settings)
        });
        program.desktop_app = program
            .desktop_app
            .with_snap(handscope::shell::headless::snap::snap);
        Self {
            program,
            socket: socket.unwrap(),
            folder,
            revealed,
            seen: Vec::new(),
        }
    }

    /// One frame's time goes by, drawn or not.
    fn tick(&mut self) {
        self.program.tick(Duration::from_millis(FRAME_MS));
        let state = self.program.state().hand().connection.status.state;
        if self.seen.last() != Some(&state) {
            self.seen.push(state);
        }
    }

    fn frame(&mut self, ui: &mut egui::Ui) {
        self.tick();
        self.program.ui(ui);
    }
}

/// A write that reached the hand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Write {
    pub(crate) at: Moment,
    pub(crate) address: u16,
    pub(crate) bytes: Vec<u8>,
}

impl Write {
    /// The bytes as shorts.
    pub(crate) fn shorts(&self) -> Vec<i16> {
        let (pairs, _) = self.bytes.as_chunks::<2>();
        pairs.iter().map(|pair| i16::from_le_bytes(*pair)).collect()
    }
}

/// A person in front of the window. Everything is found by its label.
pub(crate) struct Bench {
    harness: Harness<'static, Room>,
}

impl Bench {
    pub(crate) fn open(config: SimConfig, size: Vec2) -> Self {
        Self::begin(Room::new(config, Settings::default(), Keeps::Nothing), size)
    }

    /// A program that keeps settings and records in its folder, one second after its start.
    pub(crate) fn keeping(config: SimConfig) -> Self {
        let room = Room::new(config, Settings::default(), Keeps::Records);
        let mut bench = Self::begin(room, LARGE);
        bench.wait(1000);
        bench
    }

    fn begin(room: Room, size: Vec2) -> Self {
        let frame_s = Duration::from_millis(FRAME_MS).as_secs_f32();
        let harness = Harness::builder()
            .with_size(size)
            .with_step_dt(frame_s)
            .build_ui_state(|ui, room: &mut Room| room.frame(ui), room);
        Self { harness }
    }

    /// A start with a hand that is remembered, and everything kept in the folder of saved files.
    pub(crate) fn kept(config: SimConfig, endpoint: &str, size: Vec2) -> Self {
        let settings = Settings {
            endpoint: Some(endpoint.into()),
            ..Settings::default()
        };
        Self::begin(Room::new(config, settings, Keeps::Records), size)
    }

    /// A start with settings, and everything kept in the folder of saved files.
    pub(crate) fn kept_with(config: SimConfig, change: impl FnOnce(&mut Settings)) -> Self {
        let mut settings = Settings::default();
        change(&mut settings);
        Self::begin(Room::new(config, settings, Keeps::Records), LARGE)
    }

    /// A start with these settings; nothing is kept on disk.
    pub(crate) fn with(settings: Settings) -> Self {
        let room = Room::new(SimConfig::default(), settings, Keeps::Nothing);
        Self::begin(room, LARGE)
    }

    /// How much larger than designed everything is drawn.
    pub(crate) fn zoom(&self) -> f32 {
        self.harness.ctx.zoom_factor()
    }

    /// Asks for something as a view does that is not open.
    pub(crate) fn act(&mut self, action: Action) {
        self.harness.state_mut().program.act(action);
    }

    /// Shows an exhibition as the command line does, and waits until it knows its hand.
    pub(crate) fn exhibit(&mut self, plan: ExhibitPlan) {
        let room = self.harness.state_mut();
        room.program.exhibit(Exhibition {
            plan: Arc::new(plan),
            logo: None,
            ends_program: false,
        });
        self.run(400);
    }

    /// The pointer that is asked for.
    pub(crate) fn cursor(&self) -> egui::CursorIcon {
        self.harness.output().platform_output.cursor_icon
    }

    /// The secondary button, pressed and let go.
    pub(crate) fn press_secondary_at(&mut self, pos: egui::Pos2) {
        for pressed in [true, false] {
            self.harness.event(egui::Event::PointerButton {
                pos,
                button: egui::PointerButton::Secondary,
                pressed,
                modifiers: Modifiers::NONE,
            });
            self.harness.step();
        }
    }

    /// A finger comes down on the screen, which is no pointer.
    pub(crate) fn touch_at(&mut self, pos: egui::Pos2) {
        self.harness.event(egui::Event::Touch {
            device_id: egui::TouchDeviceId(0),
            id: egui::TouchId(2),
            phase: egui::TouchPhase::Start,
            pos,
            force: None,
        });
        self.harness.step();
    }

    /// The first start, one second later.
    pub(crate) fn live() -> Self {
        let mut bench = Self::open(SimConfig::default(), LARGE);
        bench.wait(1000);
        bench
    }

    /// The first start, then the hand armed by a click.
    pub(crate) fn armed() -> Self {
        let mut bench = Self::live();
        bench.gentle();
        bench.click("Arm the hand");
        bench.run(200);
        assert!(
            bench.state().hand().connection.is_armed(),
            "{:?}",
            bench.state().hand().connection.status
        );
        bench
    }

    /// Sets every joint as a careful person does before arming.
    pub(crate) fn gentle(&mut self) {
        self.act(Action::Speed(None, Speed::GENTLE));
        self.act(Action::Force(None, Force::GENTLE));
    }

    pub(crate) fn run(&mut self, millis: u64) {
        let frames = millis.div_ceil(FRAME_MS);
        for frame in 0..frames {
            self.pass(frames - frame <= LAST_DRAWN || frame.is_multiple_of(DRAWN_EACH));
        }
    }

    /// One frame's time goes by.
    fn pass(&mut self, is_drawn: bool) {
        if is_drawn {
            let now = self.harness.state().program.now();
            let since = now.since(Moment::ZERO) + Duration::from_millis(FRAME_MS);
            self.harness.input_mut().time = Some(since.as_secs_f64());
            self.harness.step();
        } else {
            self.harness.state_mut().tick();
        }
    }

    /// As [`Bench::run`], but only the last frames are drawn: as if the window had been hidden.
    pub(crate) fn wait(&mut self, millis: u64) {
        for _ in 0..millis.saturating_sub(2 * FRAME_MS).div_ceil(FRAME_MS) {
            self.harness.state_mut().tick();
        }
        self.run(2 * FRAME_MS);
    }

    /// Frames until something is so; the virtual time that it took.
    pub(crate) fn until(&mut self, within_ms: u64, so: impl Fn(&Self) -> bool) -> u64 {
        let start = self.now();
        let (mut frames, mut was_drawn) = (0_u64, true);
        while !so(self) {
            let took = self.now().since(start).as_millis();
            assert!(took < u128::from(within_ms), "not within {within_ms} ms");
            was_drawn = frames.is_multiple_of(DRAWN_EACH);
            self.pass(was_drawn);
            frames += 1;
        }
        let took = u64::try_from(self.now().since(start).as_millis()).unwrap();
        if !was_drawn {
            self.pass(true);
        }
        took
    }

    // --- what a person does -------------------------------------------------------------------

    pub(crate) fn click(&mut self, name: &str) {
        self.harness.get_by_label(name).click();
        self.harness.remove_cursor();
        self.harness.step();
    }

    /// For names that a text on the screen has too.
    pub(crate) fn click_button(&mut self, name: &str) {
        self.harness
            .get_by_role_and_label(Role::Button, name)
            .click();
        self.harness.remove_cursor();
        self.harness.step();
    }

    /// A box that is ticked or not.
    pub(crate) fn click_box(&mut self, name: &str) {
        self.harness
            .get_by_role_and_label(Role::CheckBox, name)
            .click();
        self.harness.remove_cursor();
        self.harness.step();
    }

    /// Pressed, released and left before the next frame is drawn.
    pub(crate) fn click_within_one_frame(&mut self, name: &str) {
        let at = self.rect(Role::Button, name).center();
        let events = [
            egui::Event::PointerMoved(at),
            primary(at, true),
            primary(at, false),
            egui::Event::PointerMoved(egui::pos2(2.0, 2.0)),
        ];
        self.harness.input_mut().events.extend(events);
        self.harness.step();
    }

    /// Pressed and held down.
    pub(crate) fn press(&mut self, name: &str) {
        self.press_at(self.rect(Role::Button, name).center());
    }

    pub(crate) fn press_at(&mut self, at: egui::Pos2) {
        let events = [egui::Event::PointerMoved(at), primary(at, true)];
        self.harness.input_mut().events.extend(events);
        self.harness.step();
    }

    /// Opens the first drawer of this name, and waits until it is open.
    pub(crate) fn open_drawer(&mut self, name: &str) {
        let mut all = self.harness.query_all_by_role(Role::DisclosureTriangle);
        let named = all.find(|node| node.accesskit_node().label().as_deref() == Some(name));
        named
            .unwrap_or_else(|| panic!("no drawer '{name}'"))
            .click();
        drop(all);
        self.harness.remove_cursor();
        self.run(400);
    }

    /// Opens the list of a choice and takes one of it.
    pub(crate) fn choose(&mut self, name: &str, value: &str) {
        self.harness
            .get_by_role_and_label(Role::ComboBox, name)
            .click();
        self.run(200);
        self.click_button(value);
        self.run(200);
    }

    /// Let go, with the pointer left where it is.
    pub(crate) fn release_at(&mut self, at: egui::Pos2) {
        self.harness.input_mut().events.push(primary(at, false));
        self.harness.step();
    }

    /// Puts the pointer to a place and leaves it there.
    pub(crate) fn point(&mut self, at: egui::Pos2) {
        self.harness.hover_at(at);
        self.harness.step();
    }

    /// Types a text into what has the keyboard.
    pub(crate) fn write(&mut self, text: &str) {
        self.harness.event(egui::Event::Text(text.to_owned()));
        self.run(40);
    }

    /// Takes the pointer out of the window.
    pub(crate) fn point_away(&mut self) {
        self.harness.remove_cursor();
        self.harness.step();
    }

    /// The secondary button on a row of a list, by a part of its name, newest first.
    pub(crate) fn click_row_secondary(&mut self, part: &str) {
        let mut rows = self.harness.query_all_by_role(Role::Row);
        let has = |node: &egui_kittest::Node<'_>| {
            let name = node.accesskit_node().label();
            name.is_some_and(|name| name.contains(part))
        };
        let found = rows.rfind(has);
        found
            .unwrap_or_else(|| panic!("no row with '{part}'"))
            .click_secondary();
        drop(rows);
        self.run(2 * FRAME_MS);
    }

    /// Where a view has a button of the same name: the one that is drawn first.
    pub(crate) fn click_first_button(&mut self, name: &str) {
        let mut all = self.harness.query_all_by_role(Role::Button);
        let named = all.find(|node| node.accesskit_node().label().as_deref() == Some(name));
        named
            .unwrap_or_else(|| panic!("no button '{name}'"))
            .click();
        drop(all);
        self.harness.remove_cursor();
        self.harness.step();
    }

    /// One notch of the wheel over a track.
    pub(crate) fn wheel(&mut self, name: &str, notches: f32) {
        self.wheel_at(self.rect(Role::Slider, name).center(), notches);
    }

    /// Scrolls the shelf of poses to its end.
    pub(crate) fn scroll_shelf(&mut self) {
        let first = self.rect(Role::Button, "Go to Open");
        self.wheel_at(first.center(), -100.0);
        self.run(1000);
    }

    /// Notches of the wheel with the pointer at a place.
    pub(crate) fn wheel_at(&mut self, at: egui::Pos2, notches: f32) {
        self.harness.hover_at(at);
        self.harness.step();
        self.harness.event(egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: vec2(0.0, notches),
            modifiers: Modifiers::NONE,
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
        });
        self.harness.step();
        self.harness.remove_cursor();
        self.run(60);
    }

    pub(crate) fn key(&mut self, key: Key) {
        self.harness.key_press(key);
        self.harness.step();
    }

    /// A key goes down and stays down.
    pub(crate) fn key_down(&mut self, key: Key) {
        self.harness.key_down(key);
        self.harness.step();
    }

    /// It comes up again.
    pub(crate) fn key_up(&mut self, key: Key) {
        self.harness.key_up(key);
        self.harness.step();
    }

    /// Another window has the keyboard now.
    pub(crate) fn lose_focus(&mut self) {
        self.harness.event(egui::Event::WindowFocused(false));
        self.harness.step();
    }

    /// Time passes, and the window neither draws nor looks at anything.
    pub(crate) fn hang(&mut self, millis: u64) {
        let program = &mut self.harness.state_mut().program;
        program.tick(Duration::from_millis(millis));
    }

    /// Drags along a track, from one part of its length to another, and lets go.
    pub(crate) fn drag(&mut self, name: &str, from: f32, to: f32) {
        let rect = self.rect(Role::Slider, name);
        let at = |part: f32| rect.lerp_inside(vec2(part, 0.5));
        self.harness.hover_at(at(from));
        self.harness.drag_at(at(from));
        for step in 1_u8..=10 {
            self.harness
                .hover_at(at(egui::lerp(from..=to, f32::from(step) / 10.0)));
        }
        self.harness.drop_at(at(to));
        self.harness.step();
    }

    /// Drags one button to the place of another, and lets go.
    pub(crate) fn drag_to(&mut self, name: &str, other: &str) {
        let from = self.rect(Role::Button, name).center();
        let to = self.rect(Role::Button, other).center();
        self.drag_from_to(from, to);
    }

    /// Drags from one place to another, and lets go.
    pub(crate) fn drag_from_to(&mut self, from: egui::Pos2, to: egui::Pos2) {
        self.harness.hover_at(from);
        self.harness.drag_at(from);
        for step in 1_u8..=10 {
            let part = f32::from(step) / 10.0;
            self.harness.hover_at(from.lerp(to, part));
            self.harness.step();
        }
        self.harness.drop_at(to);
        self.run(60);
        self.harness.remove_cursor();
        self.harness.step();
    }

    /// Drags from one place to another, presses a key there, and then lets go.
    pub(crate) fn drag_and_press(&mut self, from: egui::Pos2, to: egui::Pos2, key: Key) {
        self.harness.hover_at(from);
        self.harness.drag_at(from);
        self.harness.hover_at(to);
        self.run(60);
        self.key(key);
        self.harness.drop_at(to);
        self.run(60);
    }

    pub(crate) fn key_with(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.run(60);
    }

    pub(crate) fn focus(&mut self, name: &str) {
        self.harness
            .get_by_role_and_label(Role::TextInput, name)
            .focus();
        self.run(40);
        let field = self.harness.get_by_role_and_label(Role::TextInput, name);
        assert!(field.is_focused(), "{name}");
    }

    /// Gives a button the keyboard.
    pub(crate) fn focus_button(&mut self, name: &str) {
        self.harness
            .get_by_role_and_label(Role::Button, name)
            .focus();
        self.run(40);
    }

    /// Replaces what stands in a text field, without Enter.
    pub(crate) fn type_into(&mut self, name: &str, text: &str) {
        self.focus(name);
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.step();
        self.harness
            .get_by_role_and_label(Role::TextInput, name)
            .type_text(text);
        self.run(40);
    }

    /// Opens a view as the program does it.
    pub(crate) fn show(&mut self, view: View) {
        self.harness.state_mut().program.desktop_app.show(view);
        self.run(40);
    }

    /// The cross of the window is pressed: whether the person is asked first.
    pub(crate) fn wants_to_close(&mut self) -> bool {
        let desktop_app = &mut self.harness.state_mut().program.desktop_app;
        desktop_app.app().asks_before_closing()
    }

    pub(crate) fn step(&mut self) {
        self.harness.step();
    }

    // --- what a person sees -------------------------------------------------------------------

    pub(crate) fn state(&self) -> &State {
        self.harness.state().program.state()
    }

    /// The live hands, whatever is shown.
    pub(crate) fn live_state(&mut self) -> &State {
        self.harness.state_mut().program.desktop_app.app().live()
    }

    pub(crate) fn view(&self) -> View {
        self.harness.state().program.desktop_app.view()
    }

    /// The name of what has the keyboard.
    pub(crate) fn focused(&self) -> Option<String> {
        let mut all = self.harness.query_all_by(|node| node.is_focused());
        all.find_map(|node| node.accesskit_node().label())
    }

    /// Whether a switch is on.
    pub(crate) fn is_on(&self, name: &str) -> bool {
        let node = self.harness.get_by_role_and_label(Role::Button, name);
        node.accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    }

    pub(crate) fn is_focused(&self, name: &str) -> bool {
        self.focused().as_deref() == Some(name)
    }

    pub(crate) fn now(&self) -> Moment {
        self.state().now
    }

    /// The states of the link that were shown so far.
    pub(crate) fn seen(&self) -> &[LinkState] {
        &self.harness.state().seen
    }

    /// True if a text with exactly these words, or a control of this name, is on the screen.
    pub(crate) fn shows(&self, text: &str) -> bool {
        self.harness.query_all_by_label(text).next().is_some()
            || self.texts().iter().any(|shown| shown == text)
    }

    /// Every text on the screen that contains these words.
    pub(crate) fn texts_with(&self, part: &str) -> Vec<String> {
        let texts = self.texts().into_iter();
        texts.filter(|text| text.contains(part)).collect()
    }

    /// The names of all buttons that contain these words.
    pub(crate) fn buttons_with(&self, part: &str) -> Vec<String> {
        let all = self.harness.query_all_by_role(Role::Button);
        let names = all.filter_map(|node| node.accesskit_node().label());
        names.filter(|name| name.contains(part)).collect()
    }

    /// Name and text of every label below this height.
    pub(crate) fn labels_below(&self, top: f32) -> Vec<(String, String)> {
        let labels = self.harness.query_all_by_role(Role::Label);
        let below = labels.filter(|node| node.rect().top() > top);
        let pair = |node: egui_kittest::Node<'_>| {
            let name = node.accesskit_node().label().unwrap_or_default();
            let value = node.value().unwrap_or_default();
            let text = displayed(&name, &value).to_owned();
            (name, text)
        };
        below.map(pair).collect()
    }

    /// Every text on the screen.
    pub(crate) fn texts(&self) -> Vec<String> {
        let labels = self.harness.query_all_by_role(Role::Label);
        let text = |node: egui_kittest::Node<'_>| {
            let name = node.accesskit_node().label().unwrap_or_default();
            Some(displayed(&name, &node.value()?).to_owned())
        };
        labels.filter_map(text).collect()
    }

    /// The text that stands under a name: the first, if there are several.
    pub(crate) fn reading(&self, name: &str) -> String {
        let first = self.readings(name).into_iter().next();
        first.unwrap_or_else(|| panic!("no reading '{name}'"))
    }

    /// Whether this text stands anywhere under a name.
    pub(crate) fn has_reading(&self, name: &str, text: &str) -> bool {
        self.readings(name).iter().any(|reading| reading == text)
    }

    fn readings(&self, name: &str) -> Vec<String> {
        let labels = self.harness.query_all_by_role(Role::Label);
        let named = labels.filter(|node| node.accesskit_node().label().as_deref() == Some(name));
        let texts = named.filter_map(|node| node.value());
        texts
            .map(|text| displayed(name, &text).trim().to_owned())
            .collect()
    }

    /// Where the handle of a track stands.
    pub(crate) fn handle(&self, name: &str) -> Option<f64> {
        let node = self.harness.get_by_role_and_label(Role::Slider, name);
        node.accesskit_node().numeric_value()
    }

    /// What stands in a text field.
    pub(crate) fn typed(&self, name: &str) -> String {
        self.value(Role::TextInput, name)
    }

    /// The value of a control.
    pub(crate) fn value(&self, role: Role, name: &str) -> String {
        let node = self.harness.get_by_role_and_label(role, name);
        node.value().unwrap_or_default()
    }

    pub(crate) fn is_disabled(&self, role: Role, name: &str) -> bool {
        let node = self.harness.get_by_role_and_label(role, name);
        node.accesskit_node().is_disabled()
    }

    /// Whether each button of this name is disabled.
    pub(crate) fn all_disabled(&self, name: &str) -> Vec<bool> {
        let all = self.harness.query_all_by_role_and_label(Role::Button, name);
        all.map(|node| node.accesskit_node().is_disabled())
            .collect()
    }

    pub(crate) fn rect(&self, role: Role, name: &str) -> Rect {
        self.harness.get_by_role_and_label(role, name).rect()
    }

    /// Where each button of this name is.
    pub(crate) fn rects(&self, name: &str) -> Vec<Rect> {
        let all = self.harness.query_all_by_role_and_label(Role::Button, name);
        all.map(|node| node.rect()).collect()
    }

    /// Names and places of everything with this role, as far as it is not scrolled away: what can be pressed.
    pub(crate) fn all(&self, role: Role) -> Vec<(String, Rect)> {
        let nodes = self.harness.query_all_by_role(role);
        let named = nodes.map(|node| {
            // A plain text has its words as value.
            let words = node.accesskit_node();
            let name = words.label().or_else(|| words.value()).unwrap_or_default();
            let (id, _) = node.accesskit_node().locate();
            let pressed = self.harness.ctx.viewport(|viewport| {
                let mut layers = viewport.prev_pass.widgets.layers();
                layers.find_map(|(_, widgets)| {
                    let mut widgets = widgets.iter();
                    widgets
                        .find(|widget| widget.id.accesskit_id() == id)
                        .map(|widget| widget.interact_rect)
                })
            });
            (name, pressed.unwrap_or(node.rect()))
        });
        named.filter(|(_, rect)| rect.is_positive()).collect()
    }

    /// Whether a text is painted in full, and nothing is painted over it.
    pub(crate) fn is_bright(&self, text: &str) -> bool {
        let mut found = None;
        for clipped in &self.harness.output().shapes {
            match (&clipped.shape, found) {
                (egui::Shape::Text(shape), _) if shape.galley.text() == text => {
                    let full = shape.opacity_factor >= 1.0;
                    found = full.then(|| clipped.shape.visual_bounding_rect());
                }
                (egui::Shape::Rect(cover), Some(place)) if cover.fill.a() > 0 => {
                    let covers = cover.rect.intersect(clipped.clip_rect).intersects(place);
                    found = found.filter(|_| !covers);
                }
                _ => {}
            }
        }
        found.is_some()
    }

    /// Texts that are painted cut, with dots at their end, and where.
    pub(crate) fn cut(&self) -> Vec<(String, Rect)> {
        let shapes = self.harness.output().shapes.iter();
        shapes
            .filter_map(|clipped| match &clipped.shape {
                egui::Shape::Text(text) if text.galley.elided => {
                    let place = clipped.shape.visual_bounding_rect();
                    Some((text.galley.text().to_owned(), place))
                }
                _ => None,
            })
            .collect()
    }

    /// Colours of the frames that are painted around this place.
    pub(crate) fn edges(&self, place: Rect) -> Vec<egui::Color32> {
        let shapes = self.harness.output().shapes.iter();
        shapes
            .filter_map(|clipped| match &clipped.shape {
                egui::Shape::Rect(rect) if near(rect.rect, place) => Some(rect.stroke.color),
                _ => None,
            })
            .collect()
    }

    // --- the hand behind it -------------------------------------------------------------------

    pub(crate) fn hand<T>(&self, act: impl FnOnce(&mut SimHand, Moment) -> T) -> T {
        let room = self.harness.state();
        let _inside = room.program.enter();
        room.socket.hand.with(act)
    }

    /// Puts a hand at a place of its own, opens another slot for it, and waits until it is live there.
    pub(crate) fn open_another(&mut self, endpoint: &str) {
        let endpoint: Endpoint = endpoint.parse().unwrap();
        let room = self.harness.state();
        let inside = room.program.enter();
        room.socket.placed.lock().unwrap().push(Placed {
            endpoint: endpoint.clone(),
            hand: hand::plain(),
            is_plugged: true,
            served: Vec::new(),
        });
        drop(inside);
        self.act(Action::Hands(HandsAction::Add));
        self.act(Action::Connect(endpoint));
        self.until(2000, |bench| {
            let hand = bench.state().hand();
            hand.connection.status.state == LinkState::Monitoring
                && hand.pose_now(bench.state().now).is_some()
        });
    }

    /// Pulls the cable of the hand at this place.
    pub(crate) fn unplug_at(&mut self, endpoint: &str) {
        let endpoint: Endpoint = endpoint.parse().unwrap();
        let mut placed = self.harness.state().socket.placed.lock().unwrap();
        for one in placed.iter_mut().filter(|one| one.endpoint == endpoint) {
            one.is_plugged = false;
            one.served.drain(..).for_each(|task| task.abort());
        }
    }

    /// The addresses of every write that reached the hand at this place.
    pub(crate) fn addresses_at(&self, endpoint: &str) -> Vec<u16> {
        let endpoint: Endpoint = endpoint.parse().unwrap();
        let room = self.harness.state();
        let _inside = room.program.enter();
        let placed = room.socket.placed.lock().unwrap();
        let one = placed.iter().find(|one| one.endpoint == endpoint).unwrap();
        let journal =
            |hand: &mut SimHand, _| hand.journal().iter().map(|entry| entry.address).collect();
        one.hand.with(journal)
    }

    /// Puts a hand beside the first one, on every wire that is opened from now on.
    pub(crate) fn add_hand(&mut self, id: u8) {
        let room = self.harness.state();
        let _inside = room.program.enter();
        let hand = hand::shared(hand::numbered(id));
        room.socket.others.lock().unwrap().push(hand);
    }

    /// Writes that reached the hands beside the first one.
    pub(crate) fn writes_to_others(&self) -> usize {
        let room = self.harness.state();
        let _inside = room.program.enter();
        let others = room.socket.others.lock().unwrap();
        let count = |hand: &SharedHand| hand.with(|hand, _| hand.journal().len());
        others.iter().map(count).sum()
    }

    /// Every write that reached the hand, oldest first.
    pub(crate) fn writes(&self) -> Vec<Write> {
        self.hand(|hand, _| {
            let journal = hand.journal().iter();
            journal
                .map(|entry| Write {
                    at: entry.at,
                    address: entry.address,
                    bytes: entry.bytes.clone(),
                })
                .collect()
        })
    }

    pub(crate) fn addresses(&self) -> Vec<u16> {
        self.writes().iter().map(|write| write.address).collect()
    }

    /// The angle of a joint as the hand itself has it.
    pub(crate) fn angle(&self, dof: Dof) -> i16 {
        use handscope::hand::register::ANGLE_ACT;
        let bytes = self.hand(|hand, now| hand.read(ANGLE_ACT.span(), now).unwrap());
        let (pairs, _) = bytes.as_chunks::<2>();
        i16::from_le_bytes(pairs[dof.index()])
    }

    /// Pulls the cable out: the wire hangs up and the port is gone.
    pub(crate) fn unplug(&mut self) {
        let socket = &self.harness.state().socket;
        *socket.plugged.lock().unwrap() = false;
        for task in socket.served.lock().unwrap().drain(..) {
            task.abort();
        }
    }

    /// The next wire that is plugged in has these faults.
    pub(crate) fn faults(&mut self, plan: FaultPlan) {
        *self.harness.state().socket.faults.lock().unwrap() = Some(plan);
    }

    /// Clicks, and gives what that put on the clipboard.
    pub(crate) fn click_to_copy(&mut self, name: &str) -> Option<String> {
        self.harness
            .get_by_role_and_label(Role::Button, name)
            .click();
        (0..4).find_map(|_| {
            self.harness.step();
            let commands = &self.harness.output().platform_output.commands;
            commands.iter().find_map(|command| match command {
                egui::OutputCommand::CopyText(text) => Some(text.clone()),
                _ => None,
            })
        })
    }

    /// Clicks a row of a list, by a part of its name, newest first; its name.
    pub(crate) fn click_row(&mut self, part: &str) -> String {
        let mut rows = self.harness.query_all_by_role(Role::Row);
        let name = |node: &egui_kittest::Node<'_>| node.accesskit_node().label();
        let found = rows
            .rfind(|node| name(node).is_some_and(|name| name.contains(part)))
            .unwrap_or_else(|| panic!("no row with '{part}'"));
        let clicked = name(&found).unwrap();
        found.click();
        drop(rows);
        self.harness.remove_cursor();
        self.run(2 * FRAME_MS);
        clicked
    }

    /// Files that were shown in the file manager.
    pub(crate) fn revealed(&self) -> Vec<PathBuf> {
        self.harness.state().revealed.lock().unwrap().clone()
    }

    /// The folder of saved files.
    pub(crate) fn folder(&self) -> &std::path::Path {
        self.harness.state().folder.path()
    }

    /// From now on the system lists these ports; the hand is behind each.
    pub(crate) fn list_ports(&mut self, ports: Vec<PortFound>) {
        *self.harness.state().socket.listed.lock().unwrap() = ports;
    }

    /// How often a wire was opened, or was to be.
    pub(crate) fn dials(&self) -> usize {
        self.harness.state().socket.dials.load(Ordering::Relaxed)
    }

    pub(crate) fn plug(&mut self) {
        *self.harness.state().socket.plugged.lock().unwrap() = true;
    }
}

fn near(a: Rect, b: Rect) -> bool {
    (a.min - b.min).length() < 4.0 && (a.max - b.max).length() < 4.0
}

fn primary(pos: egui::Pos2, pressed: bool) -> egui::Event {
    egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    }
}
