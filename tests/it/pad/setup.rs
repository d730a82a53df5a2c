//! Gamepads as their drivers describe them, and one that is in a person's hands.

use handscope::hand::{Angle, Moment, PerDof};
use handscope::inputs::Offer;
use handscope::inputs::pad::control::kernel_code;
use handscope::inputs::pad::input::PadAim;
use handscope::inputs::pad::{
    AxisRange, FaceOrder, KernelEvent, PadEvent, PadFacts, PadId, PadInput, PadMap, PadNews,
    PadReport,
};
use std::collections::BTreeMap;
use std::time::Duration;

/// Axes with their ends and rest, as `evtest` prints them for the driver xpad.
pub(crate) const XBOX: &[(&str, i32, i32, i32)] = &[
    ("ABS_X", -32768, 32767, 128),
    ("ABS_Y", -32768, 32767, 128),
    ("ABS_Z", 0, 255, 0),
    ("ABS_RX", -32768, 32767, 128),
    ("ABS_RY", -32768, 32767, 128),
    ("ABS_RZ", 0, 255, 0),
    ("ABS_HAT0X", -1, 1, 0),
    ("ABS_HAT0Y", -1, 1, 0),
];
/// An Xbox pad over Bluetooth: the right stick is where others have triggers.
pub(super) const BLUETOOTH: &[(&str, i32, i32, i32)] = &[
    ("ABS_X", 0, 65535, 4095),
    ("ABS_Y", 0, 65535, 4095),
    ("ABS_Z", 0, 65535, 4095),
    ("ABS_RZ", 0, 65535, 4095),
    ("ABS_GAS", 0, 1023, 63),
    ("ABS_BRAKE", 0, 1023, 63),
];
/// A Switch Pro pad: its triggers are buttons.
pub(super) const SWITCH: &[(&str, i32, i32, i32)] = &[
    ("ABS_X", -32767, 32767, 500),
    ("ABS_Y", -32767, 32767, 500),
    ("ABS_RX", -32767, 32767, 500),
    ("ABS_RY", -32767, 32767, 500),
];
/// A Steam controller: its triggers are hats.
pub(super) const STEAM: &[(&str, i32, i32, i32)] = &[
    ("ABS_X", -32767, 32767, 0),
    ("ABS_Y", -32767, 32767, 0),
    ("ABS_RX", -32767, 32767, 0),
    ("ABS_RY", -32767, 32767, 0),
    ("ABS_HAT2Y", 0, 255, 0),
    ("ABS_HAT2X", 0, 255, 0),
];

pub(crate) fn facts(axes: &[(&str, i32, i32, i32)]) -> PadFacts {
    let range = |(name, min, max, flat): &(&str, i32, i32, i32)| {
        let (min, max, flat) = (*min, *max, *flat);
        (kernel_code(name).unwrap(), AxisRange { min, max, flat })
    };
    PadFacts {
        name: "Test pad".into(),
        path: "/dev/input/event7".into(),
        vendor: 0x1234,
        product: 1,
        axes: axes.iter().map(range).collect(),
        face: FaceOrder::ByPlace,
    }
}

pub(crate) fn event(name: &str, value: i32) -> KernelEvent {
    KernelEvent::named(name, value).unwrap()
}

pub(super) fn angles(raw: [i64; 6]) -> PerDof<Option<Angle>> {
    PerDof::new(raw).map(|raw| Angle::new(raw).ok())
}

/// A pad in a person's hands, with a clock that only the test moves.
pub(crate) struct Played {
    pub(crate) input: PadInput,
    pub(crate) now: Moment,
}

pub(crate) const PAD: PadId = PadId(3);

impl Played {
    /// The usual map on an Xbox pad that was just found, nothing held.
    pub(crate) fn xbox() -> Self {
        Self::of(facts(XBOX), &[])
    }

    /// A pad that is found while this is held.
    pub(crate) fn of(facts: PadFacts, now: &[KernelEvent]) -> Self {
        let mut input = PadInput::new(PadMap::usual());
        let poses = [
            ("Open", [1000; 6]),
            ("Pinch", [1000, 1000, 1000, 420, 380, 150]),
            ("Point", [0, 0, 0, 1000, -1, -1]),
        ];
        let poses = poses.map(|(name, raw)| (name.to_owned(), PadAim::joints(angles(raw))));
        input.set_poses(BTreeMap::from(poses));
        let mut played = Self {
            input,
            now: Moment::from_micros(1_000_000),
        };
        let now = now.to_vec();
        let news = PadNews::Found {
            pad: PAD,
            facts,
            now,
        };
        assert_eq!(played.news(news), Some(PadEvent::Found));
        played
    }

    pub(crate) fn news(&mut self, news: PadNews) -> Option<PadEvent> {
        let at = self.now;
        self.input.receive(&PadReport { at, news })
    }

    /// The kernel says this.
    pub(crate) fn says(&mut self, name: &str, value: i32) -> Option<PadEvent> {
        let event = event(name, value);
        self.news(PadNews::Moved { pad: PAD, event })
    }

    /// Presses the dead-man of the usual map.
    pub(crate) fn hold(&mut self) {
        assert_eq!(self.says("BTN_TL", 1), None);
        assert_eq!(self.offer().held, Some(true));
    }

    pub(crate) fn offer(&mut self) -> Offer {
        self.input.offer(self.now).unwrap()
    }

    /// The aims as numbers; -1 for a joint that is left alone.
    pub(crate) fn aims(&mut self) -> [i16; 6] {
        let aims = self.offer().aims;
        aims.map(|aim| aim.map_or(-1, Angle::get))
            .as_array()
            .to_owned()
    }

    /// Time passes, and the pad says that it is there.
    pub(crate) fn pass(&mut self, ms: u64) {
        self.now = self.now.plus(Duration::from_millis(ms));
        self.news(PadNews::Alive(PAD));
    }
}
