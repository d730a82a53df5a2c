//! A virtual gamepad of the kernel, read as any other. Where there is no /dev/uinput it is skipped.

use crate::setup::skipped::skipped;
use evdev::uinput::VirtualDevice;
use evdev::{AbsInfo, AbsoluteAxisCode, AttributeSet, InputEvent, KeyCode, UinputAbsSetup};
use handscope::hand::{Angle, Moment};
use handscope::inputs::pad::device::{FOLDER, PadReader, find};
use handscope::inputs::pad::{PadControl, PadEvent, PadInput, PadMap, PadNews};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::Mutex;
use tokio::time::timeout;

const NAME: &str = "Handscope test pad";
/// Longer than anything here takes in an emulated processor.
const PATIENCE: Duration = Duration::from_secs(30);
/// One virtual pad at a time: the first that is found is followed.
static ONE_PAD: Mutex<()> = Mutex::const_new(());
const KEY: u16 = 1;
const ABS: u16 = 3;

/// An Xbox pad; unplugged when it is dropped.
fn plugged() -> Option<VirtualDevice> {
    let Ok(made) = VirtualDevice::builder() else {
        skipped("virtual gamepad", "this machine has no /dev/uinput for us");
        return None;
    };
    let keys = [
        KeyCode::BTN_SOUTH,
        KeyCode::BTN_EAST,
        KeyCode::BTN_NORTH,
        KeyCode::BTN_WEST,
        KeyCode::BTN_TL,
        KeyCode::BTN_TR,
        KeyCode::BTN_START,
    ];
    let axis =
        |axis, min, max, flat| UinputAbsSetup::new(axis, AbsInfo::new(0, min, max, 0, flat, 0));
    let stick = |code| axis(code, -32768, 32767, 128);
    let trigger = |code| axis(code, 0, 255, 0);
    let mut made = made
        .name(NAME)
        .with_keys(&AttributeSet::from_iter(keys))
        .unwrap();
    for axis in [
        stick(AbsoluteAxisCode::ABS_X),
        stick(AbsoluteAxisCode::ABS_Y),
        stick(AbsoluteAxisCode::ABS_RX),
        stick(AbsoluteAxisCode::ABS_RY),
        trigger(AbsoluteAxisCode::ABS_Z),
        trigger(AbsoluteAxisCode::ABS_RZ),
    ] {
        made = made.with_absolute_axis(&axis).unwrap();
    }
    Some(made.build().unwrap())
}

/// A pad that is followed, whatever others are plugged in here.
struct Followed {
    /// Unplugged when it is taken away.
    pad: Option<VirtualDevice>,
    reader: PadReader,
    input: PadInput,
}

impl Followed {
    async fn plugged() -> Option<Self> {
        let pad = Some(plugged()?);
        let start = Instant::now();
        let clock = Arc::new(move || Moment::from_duration(start.elapsed()));
        let mut followed = Self {
            pad,
            reader: PadReader::start(FOLDER.into(), clock).unwrap(),
            input: PadInput::new(PadMap::usual()),
        };
        followed
            .until(|_, event| event == Some(PadEvent::Found))
            .await;
        Some(followed)
    }

    /// Reads until something is so.
    async fn until(&mut self, wanted: impl Fn(&PadInput, Option<PadEvent>) -> bool) -> Moment {
        let so = async {
            loop {
                let report = self.reader.report().await.unwrap();
                // Another pad that is plugged in here.
                if matches!(&report.news, PadNews::Found { facts, .. } if facts.name != NAME) {
                    continue;
                }
                let event = self.input.receive(&report);
                if wanted(&self.input, event) {
                    return report.at;
                }
            }
        };
        timeout(PATIENCE, so).await.unwrap()
    }

    fn key(&mut self, key: KeyCode, value: i32) {
        let event = InputEvent::new(KEY, key.code(), value);
        self.pad.as_mut().unwrap().emit(&[event]).unwrap();
    }

    fn axis(&mut self, axis: AbsoluteAxisCode, value: i32) {
        let event = InputEvent::new(ABS, axis.0, value);
        self.pad.as_mut().unwrap().emit(&[event]).unwrap();
    }
}

fn is_closed(input: &PadInput, _event: Option<PadEvent>) -> bool {
    input.state().trigger(PadControl::RightTrigger) == 1000
}

#[tokio::test]
async fn a_virtual_pad_is_found_followed_and_gone() {
    let _alone = ONE_PAD.lock().await;
    let Some(mut followed) = Followed::plugged().await else {
        return;
    };
    let listed = find(Path::new(FOLDER)).unwrap();
    assert!(listed.iter().any(|facts| facts.name == NAME), "{listed:?}");
    followed.key(KeyCode::BTN_TL, 1);
    followed.axis(AbsoluteAxisCode::ABS_RZ, 255);
    let at = followed.until(is_closed).await;
    let aims = followed.input.offer(at).unwrap().aims;
    let aims = aims.map(|aim| aim.map_or(-1, Angle::get));
    assert_eq!(*aims.as_array(), [0, 0, 0, 0, 1000, -1]);
    followed.key(KeyCode::BTN_EAST, 1);
    followed
        .until(|_, event| event == Some(PadEvent::Stop))
        .await;
    followed.pad = None;
    let at = followed
        .until(|_, event| event == Some(PadEvent::Gone))
        .await;
    assert_eq!(followed.input.offer(at).unwrap().held, Some(false));
}

#[tokio::test]
async fn a_reader_that_sleeps_is_told_that_events_were_dropped() {
    let _alone = ONE_PAD.lock().await;
    let Some(mut followed) = Followed::plugged().await else {
        return;
    };
    followed.key(KeyCode::BTN_TL, 1);
    // More than the reports that may wait and what the kernel keeps together. Nobody reads meanwhile.
    for turn in 0..3000 {
        followed.axis(AbsoluteAxisCode::ABS_X, (turn % 200) * 100);
    }
    followed.axis(AbsoluteAxisCode::ABS_RZ, 255);
    let at = followed
        .until(|_, event| event == Some(PadEvent::Lost))
        .await;
    assert_eq!(followed.input.offer(at).unwrap().held, Some(false));
    // Read anew: the trigger is where it was last, and the dead-man must be pressed anew.
    let at = followed.until(is_closed).await;
    assert_eq!(followed.input.offer(at).unwrap().held, Some(false));
    followed.key(KeyCode::BTN_TL, 0);
    followed.key(KeyCode::BTN_TL, 1);
    let is_down = |input: &PadInput, _| input.state().is_held(PadControl::LeftBumper);
    followed.until(|input, _| !is_down(input, None)).await;
    let at = followed.until(is_down).await;
    assert_eq!(followed.input.offer(at).unwrap().held, Some(true));
}
