//! The thread that reads gamepads, against a folder whose files are devices because the test says so, and against real files.

use crate::pad::setup::{XBOX, angles, event, facts};
use crate::setup::link;
use handscope::hand::Moment;
use handscope::hand::kinematics::Side;
use handscope::inputs::offer::SourceSite;
use handscope::inputs::pad::device::{PadReader, find};
use handscope::inputs::pad::input::PadAim;
use handscope::inputs::pad::reader::{DeviceSays, OpenPad, PadDevice};
use handscope::inputs::pad::source::{PadSource, PadSourceConfig, PadView};
use handscope::inputs::pad::{
    KernelEvent, PadFacts, PadId, PadInput, PadMap, PadNews, PadReport, PadTrouble,
};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::os::fd::{AsFd as _, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tokio::time::timeout;

/// Longer than anything here takes on a busy machine; the folder is looked at each second.
const PATIENCE: Duration = Duration::from_secs(20);

/// What a fake device will say, and where its controls are.
#[derive(Default)]
struct Words {
    says: Vec<DeviceSays>,
    now: Vec<KernelEvent>,
}

/// The far end of a fake device. It is unplugged when this is dropped.
struct Plug {
    line: UnixStream,
    words: Arc<Mutex<Words>>,
}

struct FakePad {
    facts: PadFacts,
    line: UnixStream,
    words: Arc<Mutex<Words>>,
}

/// A file that says "pad" is a gamepad, one that says "locked" may not be opened, any other is another device.
#[derive(Clone, Default)]
struct FakePads(Arc<Mutex<BTreeMap<PathBuf, Plug>>>);

impl Plug {
    fn say(&mut self, says: &[DeviceSays], now: &[KernelEvent]) {
        let mut words = self.words.lock().unwrap();
        words.says.extend(says);
        words.now = now.to_vec();
        drop(words);
        self.line.write_all(&[1]).unwrap();
    }
}

impl PadDevice for FakePad {
    fn facts(&self) -> &PadFacts {
        &self.facts
    }
    fn fd(&self) -> BorrowedFd<'_> {
        self.line.as_fd()
    }
    fn now(&mut self) -> io::Result<Vec<KernelEvent>> {
        Ok(self.words.lock().unwrap().now.clone())
    }
    fn read(&mut self) -> io::Result<Vec<DeviceSays>> {
        match self.line.read(&mut [0; 64]) {
            Ok(0) => Err(ErrorKind::NotConnected.into()),
            Err(error) if error.kind() != ErrorKind::WouldBlock => Err(error),
            _ => Ok(std::mem::take(&mut self.words.lock().unwrap().says)),
        }
    }
}

impl OpenPad for FakePads {
    fn open(&self, path: &Path) -> io::Result<Option<Box<dyn PadDevice>>> {
        match fs::read_to_string(path)?.as_str() {
            "pad" => {}
            "locked" => return Err(ErrorKind::PermissionDenied.into()),
            _ => return Ok(None),
        }
        let (line, far) = UnixStream::pair()?;
        line.set_nonblocking(true)?;
        let words = Arc::<Mutex<Words>>::default();
        let plug = Plug {
            line: far,
            words: Arc::clone(&words),
        };
        self.0.lock().unwrap().insert(path.to_owned(), plug);
        let facts = PadFacts {
            path: path.to_owned(),
            ..facts(XBOX)
        };
        Ok(Some(Box::new(FakePad { facts, line, words })))
    }
}

/// A folder of such files, and who reads it.
struct Folder {
    folder: TempDir,
    pads: FakePads,
    reader: PadReader,
}

impl Folder {
    fn of(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, holds) in files {
            fs::write(folder.path().join(name), holds).unwrap();
        }
        let pads = FakePads::default();
        let opener = Box::new(pads.clone());
        let reader = PadReader::with(folder.path().into(), clock(), opener).unwrap();
        Self {
            folder,
            pads,
            reader,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The next report that says more than that a pad is alive.
    async fn news(&mut self) -> PadNews {
        next(&mut self.reader, |news| !matches!(news, PadNews::Alive(_))).await
    }

    async fn found(&mut self) -> PadId {
        match self.news().await {
            PadNews::Found { pad, .. } => pad,
            other => panic!("{other:?}"),
        }
    }

    fn say(&self, name: &str, says: &[DeviceSays], now: &[KernelEvent]) {
        let mut plugs = self.pads.0.lock().unwrap();
        plugs.get_mut(&self.path(name)).unwrap().say(says, now);
    }

    fn unplug(&self, name: &str) {
        fs::remove_file(self.path(name)).unwrap();
        self.pads.0.lock().unwrap().remove(&self.path(name));
    }
}

fn clock() -> Arc<dyn Fn() -> Moment + Send + Sync> {
    let start = Instant::now();
    Arc::new(move || Moment::from_duration(start.elapsed()))
}

async fn next(reader: &mut PadReader, wanted: impl Fn(&PadNews) -> bool) -> PadNews {
    let report = async {
        loop {
            let report = reader.report().await.unwrap();
            if wanted(&report.news) {
                return report.news;
            }
        }
    };
    timeout(PATIENCE, report).await.unwrap()
}

#[tokio::test]
async fn a_pad_appears_says_what_moves_and_disappears_at_once() {
    let mut folder = Folder::of(&[("event0", "keyboard"), ("mouse0", "pad"), ("js0", "pad")]);
    fs::write(folder.path("event1"), "pad").unwrap();
    let pad = folder.found().await;
    let moved = event("BTN_TL", 1);
    folder.say(
        "event1",
        &[DeviceSays::Event(moved), DeviceSays::Whole],
        &[],
    );
    let news = PadNews::Moved { pad, event: moved };
    assert_eq!(folder.news().await, news);
    let unplugged = Instant::now();
    folder.unplug("event1");
    assert_eq!(folder.news().await, PadNews::Gone(pad));
    let took = unplugged.elapsed();
    assert!(
        took < Duration::from_millis(900),
        "no look at the folder: {took:?}"
    );
    fs::write(folder.path("event1"), "pad").unwrap();
    assert_ne!(folder.found().await, pad, "it is a new one");
}

#[tokio::test]
async fn the_poses_of_a_pad_that_is_followed_can_be_changed() {
    let folder = Folder::of(&[("event0", "pad")]);
    let Folder {
        folder: _kept,
        pads,
        reader,
    } = folder;
    let (link, records) = handscope::link::open(
        link::config("rs485:x", link::dial(|to| link::missing(to.place()))),
        &tokio::runtime::Handle::current(),
    );
    let source = PadSource::open(PadSourceConfig {
        reader,
        input: PadInput::new(PadMap::usual()),
        records,
        site: SourceSite::of(&link, Side::Right, Arc::new(|| ())),
    });
    let until = async |so: &dyn Fn(&PadView) -> bool| {
        let waits = async {
            while !so(&source.view()) {
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
        };
        timeout(PATIENCE, waits).await.unwrap();
    };
    until(&|view| view.name.is_some()).await;
    for at in [400, 700] {
        let pose = [("Pinch".to_owned(), PadAim::joints(angles([at; 6])))];
        source.set_poses(pose.into());
        for (name, value) in [
            ("BTN_TL", 0),
            ("BTN_SOUTH", 0),
            ("BTN_TL", 1),
            ("BTN_SOUTH", 1),
        ] {
            let says = [DeviceSays::Event(event(name, value)), DeviceSays::Whole];
            let mut plugs = pads.0.lock().unwrap();
            plugs.values_mut().for_each(|plug| plug.say(&says, &[]));
        }
        until(&|view| view.aims == angles([at; 6])).await;
    }
    drop(link);
}

#[tokio::test]
async fn a_pad_says_all_the_time_that_it_is_alive_and_never_after_it_is_gone() {
    let mut folder = Folder::of(&[("event3", "pad")]);
    let pad = folder.found().await;
    let mut before = None;
    for _ in 0..5 {
        let report = timeout(PATIENCE, folder.reader.report()).await.unwrap();
        let PadReport { at, news } = report.unwrap();
        assert_eq!(news, PadNews::Alive(pad));
        assert!(before.is_none_or(|before| before < at), "{before:?} {at:?}");
        before = Some(at);
    }
    folder.unplug("event3");
    assert_eq!(folder.news().await, PadNews::Gone(pad));
    tokio::time::sleep(Duration::from_millis(200)).await;
    assert_eq!(folder.reader.try_report(), None);
}

#[tokio::test]
async fn dropped_events_are_told_at_once_and_what_comes_until_the_next_whole_is_not_believed() {
    let mut folder = Folder::of(&[("event0", "pad")]);
    let pad = folder.found().await;
    let (torn, after) = (event("BTN_TL", 1), event("BTN_SOUTH", 1));
    let now = [event("ABS_RZ", 90)];
    let says = [
        DeviceSays::Dropped,
        DeviceSays::Event(torn),
        DeviceSays::Whole,
        DeviceSays::Event(after),
    ];
    folder.say("event0", &says, &now);
    let now = now.to_vec();
    let lost = PadNews::Lost { pad, now };
    assert_eq!(folder.news().await, lost);
    // Only a stop counts of it.
    let doubtful = PadNews::Doubtful { pad, event: torn };
    assert_eq!(folder.news().await, doubtful);
    assert_eq!(folder.news().await, lost);
    let news = PadNews::Moved { pad, event: after };
    assert_eq!(folder.news().await, news);
}

#[tokio::test]
async fn a_reader_that_is_not_read_is_waited_for_and_loses_nothing() {
    let mut folder = Folder::of(&[("event0", "pad")]);
    folder.found().await;
    let many: Vec<_> = (0..2000)
        .map(|value| DeviceSays::Event(event("ABS_RZ", value)))
        .collect();
    folder.say("event0", &many, &[]);
    tokio::time::sleep(Duration::from_millis(300)).await;
    for wanted in 0..2000 {
        let PadNews::Moved { event: got, .. } = folder.news().await else {
            panic!("{wanted}");
        };
        assert_eq!(got, event("ABS_RZ", wanted));
    }
}

#[tokio::test]
async fn what_may_not_be_opened_is_told_once_in_one_sentence_and_opened_when_it_may() {
    let mut folder = Folder::of(&[
        ("event0", "locked"),
        ("event1", "keyboard"),
        ("event2", "locked"),
    ]);
    let PadNews::Trouble(trouble) = folder.news().await else {
        panic!("no trouble");
    };
    let words = trouble.to_string();
    let path = folder.path("event0").display().to_string();
    let start = format!("no gamepad can be read: {path} may not be opened, nor 1 other device; ");
    assert!(words.starts_with(&start), "{words}");
    assert_eq!(words.lines().count(), 1);
    fs::write(folder.path("event2"), "pad").unwrap();
    // The trouble is not told again each second, and not at all beside a pad.
    folder.found().await;
}

#[test]
fn the_pads_that_are_there_are_listed_and_what_is_in_the_way_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    assert_eq!(find(path), Ok(Vec::new()), "an empty folder");
    // Files that have such a name and are no devices.
    fs::write(path.join("event0"), "text").unwrap();
    fs::create_dir(path.join("event1")).unwrap();
    let made = nix::unistd::mkfifo(&path.join("event2"), nix::sys::stat::Mode::S_IRWXU);
    assert_eq!(made, Ok(()));
    assert_eq!(find(path), Ok(Vec::new()));
    let missing = path.join("none");
    let trouble = find(&missing).unwrap_err();
    assert!(matches!(&trouble, PadTrouble::NoFolder { folder, .. } if *folder == missing));
    assert_eq!(trouble.to_string().lines().count(), 1);
}

#[tokio::test]
async fn a_folder_that_is_missing_is_told_and_pads_are_found_once_it_is_there() {
    let mut folder = Folder::of(&[]);
    let missing = folder.path("input");
    let opener = Box::new(folder.pads.clone());
    folder.reader = PadReader::with(missing.clone(), clock(), opener).unwrap();
    let told = folder.news().await;
    assert!(matches!(
        told,
        PadNews::Trouble(PadTrouble::NoFolder { .. })
    ));
    fs::create_dir(&missing).unwrap();
    fs::write(missing.join("event0"), "pad").unwrap();
    folder.found().await;
}
