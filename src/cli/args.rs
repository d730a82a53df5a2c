//! The command line as clap sees it: names, defaults, help. Does nothing.

use crate::app::settings::{Language, Theme};
use crate::cli::ids::HandIds;
use crate::cli::names;
use crate::cli::params::ParamsArgs;
use crate::cli::quirks::QuirksArgs;
use crate::cli::scan::ScanArgs;
use crate::cli::sim_quirks::{self, Quirk};
use crate::cli::trial::TrialArgs;
use crate::hand::Register;
use crate::headless::cards::SceneCard;
use crate::sim::Scenario;
use crate::transport::Endpoint;
use crate::ui::View;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Duration;

/// Watch, drive and tune the FTP series tactile hand.
///
/// Without a command the window opens, on the hand of last time or on the built-in simulated one.
#[derive(Debug, Parser)]
#[command(name = "handscope", version, args_conflicts_with_subcommands = true, after_help = ENDPOINTS)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) window: WindowArgs,

    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

/// How the window opens.
#[derive(Debug, Default, Args)]
pub(crate) struct WindowArgs {
    /// The hand to open in the window, for example tcp:192.168.11.210:6000
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Option<Endpoint>,

    /// Draw the window without OpenGL; taken by itself where OpenGL does not start
    #[arg(long)]
    pub(crate) software: bool,

    /// The same, with the reason that the window then tells
    #[arg(long, value_name = "REASON", hide = true)]
    pub(crate) software_because: Option<String>,
}

/// What to do instead of opening the window.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draw the window to PNG files, without display, GPU or driver
    #[command(
        after_help = "Examples:\n  handscope snapshot --scenario grasp --at 3 --view all --out pictures\n  handscope snapshot --view live --size 1024x640 --theme light --lang zh --out pictures\n  handscope snapshot --scenario grasp --view all --theme all --lang all --out pictures\n\nNext to each PNG stands a JSON file that lists what is visible: role, name, value, place. Themes differ in colours only and share one."
    )]
    Snapshot(SnapshotArgs),
    /// Print what the hand says, as it says it
    #[command(
        after_help = "Examples:\n  handscope watch --hand sim: --for 5\n  handscope watch --hand rs485:/dev/ttyUSB0 --for 5 --json\n\nOnly reads are sent. With --json each line is one object; the last holds the statistics."
    )]
    Watch(WatchArgs),
    /// Read registers by the manual's names
    #[command(
        after_help = "Examples:\n  handscope read ANGLE_ACT TEMP --hand rs485:/dev/ttyUSB0\n  handscope read HAND_ID --hand tcp:192.168.11.210 --json\n\n'handscope registers' lists the names."
    )]
    Read(ReadArgs),
    /// Find hands: on all serial ports and CAN interfaces, or where you say
    #[command(
        after_help = "Examples:\n  handscope scan\n  handscope scan --serial /dev/ttyUSB0 --all-ids\n  handscope scan --tcp 192.168.11.210 --tcp 192.168.11.0/24 --json\n\nOn serial ports both protocols and all four speeds are tried, the likely ones first. Each port is opened and asked for HAND_ID; nothing is written. No address in the network is tried that is not named. Ctrl-C ends it with what was found.\n\nExit status: 0 hands found, or all looked at; 1 nothing found and something could not be looked at; 2 wrong usage."
    )]
    Scan(ScanArgs),
    /// Find out what is wrong with a hand and the way to it, and what to do
    #[command(
        after_help = "Examples:\n  handscope doctor --hand rs485:/dev/ttyUSB0\n  handscope doctor --hand tcp:192.168.11.210 --for 20 --json\n\nOnly reads are sent, and only the named hand is asked. Exit status 0 if all is well, 1 if something is wrong."
    )]
    Doctor(DoctorArgs),
    /// Find out, by reading only, what a hand does in its own way
    #[command(
        after_help = "Examples:\n  handscope quirks --hand rtu:/dev/ttyUSB0\n  handscope quirks --hand tcp:192.168.11.210 --json\n  handscope quirks --hand rs485:/dev/ttyUSB0 --out left-hand.toml\n\nThe window keeps these sheets by itself, beside its settings."
    )]
    Quirks(QuirksArgs),
    /// Read, compare, write, save and reset what a hand keeps
    #[command(
        after_help = "Examples:\n  handscope params dump --hand rs485:/dev/ttyUSB0 --out left-hand.toml\n  handscope params apply left-hand.toml --only default_force --hand rs485:/dev/ttyUSB0\n  handscope params save --yes --hand rs485:/dev/ttyUSB0\n  handscope params diff --saved --hand rs485:/dev/ttyUSB0\n\nNothing moves. Only apply, save and reset write to the hand, and each makes a backup first."
    )]
    Params(ParamsArgs),
    /// Close on an object again and again, and measure what comes of it
    #[command(
        after_help = "Examples:\n  handscope trial --hand rs485:/dev/ttyUSB0 --joint index --speed 25 --force 500 --arm\n  handscope trial --hand tcp:192.168.11.210 --joint index,thumb_bend --speed 25,100,250 --force 200,500 --repeat 3 --arm --out egg --best least-overshoot --hold 300\n  handscope trial --hand rs485:/dev/ttyUSB0 --joint index --approach 1000 --until measured:40 --force 500 --arm --json\n\nIt moves the hand, and only with --arm: nothing but the object may be in its way. The joints go to --start gently, rest half a second, close, hold for --dwell after they stopped, and go back. No joint closes before the hand shows the speed and the threshold that were set. Ctrl-C is a stop, and it is looked after until feedback shows rest; so is the end by a fault, heat, force or a lost link. After a stop the hand keeps what it holds: open it yourself.\n\nExit status: 0 all trials were made, 1 ended early or no setting will do, 2 wrong usage."
    )]
    Trial(TrialArgs),
    /// Be a hand for other programs: on pseudo-terminals, on TCP, on CAN, or on all of them
    #[command(
        after_help = sim_help()
    )]
    Sim(SimArgs),
    /// Print the register map
    Registers(RegistersArgs),
}

#[derive(Debug, Args)]
pub(crate) struct SnapshotArgs {
    /// The hand to show [default: the built-in one]
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Option<Endpoint>,
    /// What the built-in hand does: idle, rigid, fragile, grasp, faults, extremes
    #[arg(long, value_name = "NAME", conflicts_with = "hand")]
    pub(crate) scenario: Option<Scenario>,
    /// Seed of the built-in hand
    #[arg(long, default_value_t = 1, conflicts_with = "hand")]
    pub(crate) seed: u64,
    /// Seconds after connecting
    #[arg(long, value_name = "SECONDS", default_value = "3", value_parser = seconds)]
    pub(crate) at: Duration,
    /// One view (live, touch, faults, poses, connection, traffic), the window as it opens, or all of them
    #[arg(long, value_name = "NAME", default_value = "window", value_parser = views)]
    pub(crate) view: Views,
    /// A card over the view, which then names the files; keep and danger only with the built-in hand
    #[arg(long)]
    pub(crate) card: Option<CardArg>,
    /// Width x height in points
    #[arg(long, value_name = "WxH", default_value = "1440x900", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Pixels a point
    #[arg(long, default_value = "1", value_parser = scale)]
    pub(crate) scale: f32,
    /// Colours; with all, the names of light pictures end in -light
    #[arg(long, default_value = "dark")]
    pub(crate) theme: ThemeArg,
    /// Language of the window; with all, the names of Chinese pictures end in -zh
    #[arg(long, default_value = "en")]
    pub(crate) lang: LanguageArg,
    /// Folder for the files; made if it is not there
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct WatchArgs {
    /// The hand to watch
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Endpoint,
    /// Seconds to watch [default: until Ctrl-C]
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    pub(crate) length: Option<Duration>,
    /// One JSON object a line
    #[arg(long)]
    pub(crate) json: bool,
    /// Print what goes over the wire, frame by frame, in place of values
    #[arg(long)]
    pub(crate) wire: bool,
    /// Read as fast as the wire goes, not 100 states and 30 touch sweeps a second
    #[arg(long)]
    pub(crate) full_rate: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DoctorArgs {
    /// The hand to look at
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Endpoint,
    /// Seconds to measure, once it answers
    #[arg(long = "for", value_name = "SECONDS", default_value = "5", value_parser = seconds)]
    pub(crate) length: Duration,
    /// One JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ReadArgs {
    /// Registers by name, in any letter case
    #[arg(required = true, value_name = "NAME", value_parser = names::register)]
    pub(crate) names: Vec<&'static Register>,
    /// The hand to read
    #[arg(long, value_name = "URL")]
    pub(crate) hand: Endpoint,
    /// One JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("wire").required(true).multiple(true).args(["tcp", "rs485", "rtu", "slcan", "can"]))]
pub(crate) struct SimArgs {
    /// Serve Modbus TCP here, for example 127.0.0.1:6000
    #[arg(long, value_name = "ADDR:PORT", value_parser = address)]
    pub(crate) tcp: Option<SocketAddr>,
    /// Make a pseudo-terminal and link it here; serve RS485 private framing on it
    #[arg(long, value_name = "LINK")]
    pub(crate) rs485: Option<PathBuf>,
    /// Make a pseudo-terminal and link it here; serve Modbus RTU on it
    #[arg(long, value_name = "LINK")]
    pub(crate) rtu: Option<PathBuf>,
    /// Let --rs485 and --rtu take the time of a line of this speed, where a client that sets another hears nonsense
    /// [default: no time at all, and any speed]
    #[arg(long, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(1200..=4_000_000))]
    pub(crate) baud: Option<u32>,
    /// On such a line: milliseconds from the end of a request to the reply
    #[arg(long = "turnaround-ms", value_name = "MS", default_value = "6", requires = "baud", value_parser = turnaround)]
    pub(crate) turnaround: Duration,
    /// Make a pseudo-terminal and link it here; be a serial CAN adapter (slcan) with the hand on its bus
    #[arg(long, value_name = "LINK")]
    pub(crate) slcan: Option<PathBuf>,
    /// Answer on this CAN interface, for example vcan0 (Linux)
    #[arg(long, value_name = "INTERFACE")]
    pub(crate) can: Option<String>,
    /// Ids of the hands, 1 to 254: 1, or 1,2,3, or 1-4; each is a hand of its own
    #[arg(long, value_name = "IDS", default_value = "1", value_parser = few_ids)]
    pub(crate) id: HandIds,
    /// Seed of everything random in it; of several hands, that of the first, the next has the next number
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// What it does: idle, rigid, fragile, grasp, faults, extremes
    #[arg(long, value_name = "NAME", default_value = "idle")]
    pub(crate) scenario: Scenario,
    /// How it reads what the manual leaves open, one of the list below; may be given several times
    #[arg(long = "quirk", value_name = "NAME=VALUE", value_parser = sim_quirks::quirk)]
    pub(crate) quirks: Vec<Quirk>,
}

#[derive(Debug, Args)]
pub(crate) struct RegistersArgs {
    /// One JSON list
    #[arg(long)]
    pub(crate) json: bool,
}

/// Which pictures are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Views {
    /// The window as it opens.
    Window,
    /// The window with this view open.
    One(View),
    /// Each view, and the window as it opens.
    All,
}

/// A card that can be shown.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum CardArg {
    Reset,
    Calibrate,
    Address,
    Keep,
    Danger,
}

impl CardArg {
    /// The card, and what its files are called.
    pub(crate) const fn card(self) -> (SceneCard, &'static str) {
        match self {
            Self::Reset => (SceneCard::Reset, "card-reset"),
            Self::Calibrate => (SceneCard::Calibrate, "card-calibrate"),
            Self::Address => (SceneCard::Address, "card-address"),
            Self::Keep => (SceneCard::Keep, "card-keep"),
            Self::Danger => (SceneCard::Danger, "card-danger"),
        }
    }
}

/// The window's colours.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum ThemeArg {
    Dark,
    Light,
    All,
}

impl ThemeArg {
    /// The wanted ones, and what the names of their files end in.
    pub(crate) const fn each(self) -> &'static [(Theme, &'static str)] {
        match self {
            Self::Dark => &[(Theme::Dark, "")],
            Self::Light => &[(Theme::Light, "")],
            Self::All => &[(Theme::Dark, ""), (Theme::Light, "-light")],
        }
    }
}

/// The window's language.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum LanguageArg {
    En,
    Zh,
    All,
}

impl LanguageArg {
    /// The wanted ones, and what the names of their files end in.
    pub(crate) const fn each(self) -> &'static [(Language, &'static str)] {
        match self {
            Self::En => &[(Language::En, "")],
            Self::Zh => &[(Language::Zh, "")],
            Self::All => &[(Language::En, ""), (Language::Zh, "-zh")],
        }
    }
}

const SIM_HELP: &str = "\
Examples:\n  handscope sim --rs485 /tmp/hand --tcp 127.0.0.1:6000\n  handscope sim --rtu /tmp/hand-rtu\n  handscope sim --slcan /tmp/adapter --can vcan0\n  handscope sim --tcp 127.0.0.1:6000 --scenario grasp --seed 7\n  handscope sim --rs485 /tmp/bus --id 1,2,3\n\nIt runs until Ctrl-C. All wires lead to the same hands. On Unix SIGUSR1 switches them off for a second; once they are on again 'power cycled' is printed: what was not saved is gone.
On Modbus TCP the unit id says which hand is meant; 255 means the first, and a hand that is alone answers to all.";

fn sim_help() -> String {
    format!("{SIM_HELP}\n\n{}", sim_quirks::list())
}

const ENDPOINTS: &str = "\
Hands are named by URL:
  sim:                                     the built-in simulated hand
  sim:?seed=7&scenario=grasp               the same, playing a scenario
  rs485:/dev/ttyUSB0?baud=115200&id=1      RS485, the maker's own framing
  rtu:/dev/ttyUSB0?baud=115200&id=1        Modbus RTU on the same kind of port
  tcp:192.168.11.210:6000?unit=255         Modbus TCP
  slcan:/dev/ttyACM0?bitrate=1000000&id=1  CAN through a serial adapter
  can:can0?id=1                            CAN interface (Linux)

Exit status: 0 done, 1 could not, 2 wrong usage.";

/// The longest time that can be asked for: a day.
const SECONDS_MAX: f64 = 86_400.0;

pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text
        .parse()
        .map_err(|_not_one| format!("'{text}' is no number of seconds"))?;
    if !(0.0..=SECONDS_MAX).contains(&seconds) {
        return Err(format!("{text} is not between 0 and {SECONDS_MAX} seconds"));
    }
    Ok(Duration::from_secs_f64(seconds))
}

fn turnaround(text: &str) -> Result<Duration, String> {
    match text.parse::<f64>() {
        Ok(ms) if (0.0..=1000.0).contains(&ms) => Ok(Duration::from_secs_f64(ms / 1000.0)),
        _ => Err(format!(
            "'{text}' is no time between 0 and 1000 milliseconds"
        )),
    }
}

fn views(text: &str) -> Result<Views, String> {
    match text {
        "window" => Ok(Views::Window),
        "all" => Ok(Views::All),
        name => View::by_name(name).map(Views::One).ok_or_else(|| {
            let known = View::ALL.map(View::name).join(", ");
            format!("there is no such view: choose {known}, window or all")
        }),
    }
}

fn address(text: &str) -> Result<SocketAddr, String> {
    text.parse().map_err(|_not_one| {
        "write an address in numbers and a port, for example 127.0.0.1:6000".to_owned()
    })
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let wrong = || format!("'{text}' is no size: write WIDTHxHEIGHT, from 640x400 to 7680x4320");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
    let (width, height) = (
        width.parse().map_err(|_not_one| wrong())?,
        height.parse().map_err(|_not_one| wrong())?,
    );
    if (640..=7680).contains(&width) && (400..=4320).contains(&height) {
        return Ok((width, height));
    }
    Err(wrong())
}

fn scale(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(scale) if (0.5..=4.0).contains(&scale) => Ok(scale),
        _ => Err(format!(
            "'{text}' is no scale: write a number from 0.5 to 4"
        )),
    }
}

/// Hands that one process plays: a bus of RS485 carries 32 (TIA-485-A), and each costs computing time.
const SIM_HANDS_MAX: usize = 32;

fn few_ids(text: &str) -> Result<HandIds, String> {
    let ids: HandIds = text.parse()?;
    let asked = ids.iter().len();
    if asked > SIM_HANDS_MAX {
        return Err(format!(
            "'{text}' asks for {asked} hands; {SIM_HANDS_MAX} at most can be simulated at once"
        ));
    }
    Ok(ids)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may")]
    use super::*;
    use clap::CommandFactory as _;

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }

    #[test]
    fn wrong_usage_is_refused() {
        for line in [
            "handscope watch",
            "handscope watch --hand nonsense",
            "handscope watch --hand sim: --for -1",
            "handscope watch --hand sim: --for NaN",
            "handscope read --hand sim:",
            "handscope sim",
            "handscope sim --tcp 127.0.0.1:6000 --id 0",
            "handscope sim --tcp 127.0.0.1:6000 --id 255",
            "handscope sim --tcp 127.0.0.1:6000 --id 1,1",
            "handscope sim --tcp 127.0.0.1:6000 --id 1-33",
            "handscope read ANGLE_ATC --hand sim:",
            "handscope sim --rs485 x --baud 0",
            "handscope sim --rs485 x --turnaround-ms 3",
            "handscope sim --rs485 x --baud 115200 --turnaround-ms NaN",
            "handscope sim --tcp 127.0.0.1:6000 --quirk gap=ajar",
            "handscope sim --tcp 6000",
            "handscope sim --tcp localhost:6000",
            "handscope sim --tcp 127.0.0.1:6000 --scenario party",
            "handscope snapshot",
            "handscope snapshot --out x --view nowhere",
            "handscope snapshot --out x --scenario party",
            "handscope snapshot --out x --size 10x10",
            "handscope snapshot --out x --scale 0",
            "handscope snapshot --out x --hand sim: --scenario grasp",
            "handscope --hand sim: watch --hand sim:",
        ] {
            let error = Cli::try_parse_from(line.split(' ')).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{line}");
        }
    }
}
