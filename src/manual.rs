//! The manual: the pages that `handscope help TOPIC` prints. Each page is a file in `assets/manual`.

/// One page of the manual.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HelpTopic {
    /// Topic word after `handscope help`; also the name of the file.
    pub name: &'static str,
    /// Subject of the page, in a few words, for the list of topics.
    pub about: &'static str,
    /// The page, as Markdown in lines of at most 80 characters.
    pub text: &'static str,
}

/// Every topic, with its page as the documentation of a module of the same name.
macro_rules! topics {
    ($($name:ident: $about:literal;)*) => {
        /// All topics, in the order of the list.
        pub const TOPICS: &[HelpTopic] = &[$(HelpTopic {
            name: stringify!($name),
            about: $about,
            text: include_str!(concat!("../assets/manual/", stringify!($name), ".md")),
        }),*];
        $(
            #[doc = include_str!(concat!("../assets/manual/", stringify!($name), ".md"))]
            pub mod $name {}
        )*
    };
}

topics! {
    window: "what the window shows and does, view by view";
    safety: "stopping the hand, forces, and what this program cannot do";
    wiring: "power, Ethernet, RS485 and CAN, and how to find the hand";
    hands: "how a hand is named: sim:, rs485:, rtu:, tcp:, slcan:, usbcan:, can:";
    files: "poses, parameters, backups and trial sessions on disk";
    tune: "the fastest close on an object that stays under a limit";
    grip: "grips by size: which there are, how they close, how sure a size is";
    hold: "holding an object with the least force that holds it, between two limits";
    scale: "forces of a hand in newtons, with a kitchen scale";
    check: "a check-up of an empty hand: what is measured, what is good";
    sessions: "recordings of everything at a hand: files, exports, replay";
    gamepad: "driving a hand with a gamepad: controls, files, permission";
    exhibit: "a hand that visitors of a booth play with, and what staff do";
    stream: "a hand that follows another program, by lines of JSON";
    dds: "a hand on DDS: Unitree's programs and ROS 2";
    share: "one hand for several programs: reads, writes, who may move it";
    python: "a hand in Python: scripts, notebooks, LeRobot";
    json: "what the commands print with --json";
    licences: "what the program is linked with, by licence";
    figures: "how fast it is, and what each wire can carry";
}

/// The topic of this name; `None` if it is unknown.
pub fn topic(name: &str) -> Option<&'static HelpTopic> {
    TOPICS.iter().find(|topic| topic.name == name)
}
