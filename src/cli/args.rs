//! The command line as clap sees it: names, defaults, help. Does nothing.

use crate::cli::about::help::{self, HelpArgs};
use crate::cli::about::model::ModelArgs;
use crate::cli::about::packaging::{CompletionsArgs, ManArgs};
use crate::cli::about::ros2::Ros2Args;
use crate::cli::check::CheckArgs;
use crate::cli::doctor::DoctorArgs;
use crate::cli::grip::GripArgs;
use crate::cli::guard::GuardArgs;
use crate::cli::hold::HoldArgs;
use crate::cli::inputs::follow::FollowArgs;
use crate::cli::inputs::show::InputsArgs;
use crate::cli::params::ParamsArgs;
use crate::cli::quirks::QuirksArgs;
use crate::cli::read::ReadArgs;
use crate::cli::recordings::export::{ExportArgs, RecoverArgs};
use crate::cli::recordings::import::ImportArgs;
use crate::cli::recordings::info::InfoArgs;
use crate::cli::recordings::record::RecordArgs;
use crate::cli::recordings::replay::ReplayArgs;
use crate::cli::report::ReportArgs;
use crate::cli::scale::ScaleArgs;
use crate::cli::scan::ScanArgs;
use crate::cli::share::ShareArgs;
use crate::cli::share::fleet::FleetArgs;
use crate::cli::sim::{self, SimArgs};
use crate::cli::trial::TrialArgs;
use crate::cli::trial::overshoot::OvershootArgs;
use crate::cli::tune::TuneArgs;
use crate::cli::watch::WatchArgs;
use crate::cli::window::WindowArgs;
use crate::cli::window::exhibit::ExhibitArgs;
use crate::cli::window::snapshot::SnapshotArgs;
use clap::{Args, Parser, Subcommand};

/// Watch, drive and tune the FTP series tactile hand.
///
/// Without a command the window opens, on the last hand or on the built-in simulated one.
#[derive(Debug, Parser)]
#[command(name = "handscope", version, args_conflicts_with_subcommands = true, disable_help_subcommand = true, after_help = after_help())]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) window: WindowArgs,

    #[command(subcommand)]
    pub(crate) command: Option<CliCommand>,
}

/// What to do instead of opening the window.
#[derive(Debug, Subcommand)]
pub(crate) enum CliCommand {
    /// Draw the window to PNG files, without display, GPU or driver
    #[command(
        after_help = "Examples:\n  handscope snapshot --scenario grasp --at 3 --view all --out pictures\n  handscope snapshot --view live --size 1024x640 --theme light --lang zh --out pictures\n  handscope snapshot --scenario grasp --view all --theme all --lang all --out pictures\n\nBeside each PNG lies a JSON file that lists what is visible: role, name, value, rectangle. Themes differ only in colours and share one list."
    )]
    Snapshot(SnapshotArgs),
    /// Print what the hand reports, as it arrives
    #[command(
        after_help = "Examples:\n  handscope watch --hand sim: --for 5\n  handscope watch --hand rs485:/dev/ttyUSB0 --for 5 --json\n  handscope watch --hand sim: --json --udp 127.0.0.1:9870\n\nIt only reads. With --json each line is one object; the last one holds the statistics."
    )]
    Watch(WatchArgs),
    /// Read registers by the names in the maker's manual
    #[command(
        after_help = "Examples:\n  handscope read ANGLE_ACT TEMP --hand rs485:/dev/ttyUSB0\n  handscope read HAND_ID --hand tcp:192.168.11.210 --json\n\n'handscope registers' lists the names."
    )]
    Read(ReadArgs),
    /// Find hands on all serial ports and CAN interfaces, or only on those named
    #[command(
        after_help = "Examples:\n  handscope scan\n  handscope scan --serial /dev/ttyUSB0 --all-ids\n  handscope scan --tcp 192.168.11.210 --tcp 192.168.11.0/24 --json\n\nOn serial ports both protocols and all four speeds are tried, the likely ones first. Each port is opened and asked for HAND_ID; nothing is written. Only network addresses that you name are tried. Ctrl-C ends the scan with what was found.\n\nExit status: 0 hands found, or every place checked; 1 nothing found and a place could not be checked; 2 wrong usage."
    )]
    Scan(ScanArgs),
    /// Diagnose a hand and the connection to it, and say what to do
    #[command(
        after_help = "Examples:\n  handscope doctor --hand rs485:/dev/ttyUSB0\n  handscope doctor --hand tcp:192.168.11.210 --for 20 --json\n\nIt only reads, and asks only the named hand. Exit status: 0 all is well, 1 something is wrong, 2 wrong usage."
    )]
    Doctor(DoctorArgs),
    /// Collect everything that support asks for about a hand into one ZIP file
    #[command(
        after_help = "Examples:\n  handscope report --hand rs485:/dev/ttyUSB0\n  handscope report --hand rs485:/dev/ttyUSB0 --out for-support.zip\n\nIt only reads from the hand, lists what the file contains before it writes it, and sends nothing anywhere. 'handscope help wiring' describes the file. Exit status: 0 done, also if the hand does not answer; 1 the file cannot be written; 2 wrong usage."
    )]
    Report(ReportArgs),
    /// Find out how this hand differs from others, by reading only
    #[command(
        after_help = "Examples:\n  handscope quirks --hand rtu:/dev/ttyUSB0\n  handscope quirks --hand tcp:192.168.11.210 --json\n  handscope quirks --hand rs485:/dev/ttyUSB0 --out left-hand.toml\n\nThe window keeps such a sheet for every hand, beside its settings."
    )]
    Quirks(QuirksArgs),
    /// Read, compare, write, save and reset the parameters a hand keeps
    #[command(
        after_help = "Examples:\n  handscope params dump --hand rs485:/dev/ttyUSB0 --out left-hand.toml\n  handscope params apply left-hand.toml --only default_force --hand rs485:/dev/ttyUSB0\n  handscope params save --yes --hand rs485:/dev/ttyUSB0\n  handscope params diff --saved --hand rs485:/dev/ttyUSB0\n\nNothing moves. Only apply, save and reset write to the hand, and each makes a backup first."
    )]
    Params(ParamsArgs),
    /// Let visitors of a booth play with a hand: full screen, one page, left with a PIN only
    #[command(
        after_help = "Examples:\n  handscope exhibit\n  handscope exhibit booth.toml --hand rs485:/dev/ttyUSB0\n  handscope exhibit booth.toml --check\n\nNothing moves before staff arm with their PIN. Visitors can play what FILE names, within its limits, and press STOP. 'handscope help exhibit' describes FILE, the day's report, and how the program starts again by itself.\n\nExit status: 0 staff left, or FILE is valid; 1 FILE is not valid, or no window opens; 2 wrong usage."
    )]
    Exhibit(ExhibitArgs),
    /// List gamepads, or print what one does as it is moved, without a hand
    #[command(
        after_help = "Examples:\n  handscope inputs\n  handscope inputs --watch\n  handscope inputs --watch --map my-pad.toml --json\n\nNothing moves. 'handscope help gamepad' describes the controls and the file. Linux only.\n\nExit status: 0 done, also where no gamepad is there; 1 gamepads cannot be read, or FILE is not valid; 2 wrong usage."
    )]
    Inputs(InputsArgs),
    /// Close joints on an object repeatedly, and measure each grasp
    #[command(
        after_help = "Examples:\n  handscope trial --hand rs485:/dev/ttyUSB0 --joint index --speed 25 --force 500 --arm\n  handscope trial --hand tcp:192.168.11.210 --joint index,thumb_bend --speed 25,100,250 --force 200,500 --repeat 3 --arm --out egg --best least-overshoot --hold 300\n  handscope trial --hand rs485:/dev/ttyUSB0 --joint index --approach 1000 --until measured:40 --force 500 --arm --json\n\nThis moves the hand, and only with --arm: keep everything but the object out of its way. The joints go to --start gently, rest for half a second, close, hold for --dwell after they have stopped, and go back. No joint closes before the hand confirms the speed and the threshold that were set. Ctrl-C stops the hand, and the program stays until feedback shows rest; so it does after a fault, too much heat or force, or a lost link. After a stop the hand keeps what it holds: open it yourself.\n\nExit status: 0 all trials done; 1 ended early, or no setting qualifies for --best; 2 wrong usage."
    )]
    Trial(TrialArgs),
    /// Find the fastest close on an object whose peak stays under a limit, and confirm it
    #[command(
        after_help = "Examples:\n  handscope tune --hand rs485:/dev/ttyUSB0 --joint index --limit 500 --arm\n  handscope tune --hand tcp:192.168.11.210 --joint index,thumb_bend --pose thumb_rotate=300 --limit 300 --hold 150 --arm --out egg\n  handscope tune --hand rs485:/dev/ttyUSB0 --joint index --limit 500 --closes 22 --distribution-free --arm --json\n\nThis moves the hand, and only with --arm: put the object in its place, and keep everything else out of its way. Two slow closes find the object, then each is faster as far as what was measured allows, then 59 measure how late stops are, the last of them at the setting that was found: about 65 closes in five minutes (with --closes 10 about twenty in two, for a claim that holds only if the peaks vary normally). Each close is a trial as of 'handscope trial', with the same limits. Ctrl-C stops the hand, and the program stays until feedback shows rest; so it does after a fault, too much heat or force, or a lost link. 'handscope help tune' explains the result.\n\nExit status: 0 a setting was confirmed; 1 ended early, or none could be; 2 wrong usage."
    )]
    Tune(TuneArgs),
    /// Show what trials measured of a hand: how far its fingers went past their thresholds
    #[command(
        after_help = "Examples:\n  handscope overshoot --hand rs485:/dev/ttyUSB0\n  handscope overshoot --hand tcp:192.168.11.210 --out overshoot.csv\n  handscope overshoot --hand rs485:/dev/ttyUSB0 --forget\n\nNo hand is contacted. Each close of 'handscope trial', 'handscope tune' and the window's Tune that its threshold stopped is counted by joint, speed, threshold and stiffness of the object. The warnings of hard contacts use it in place of what was measured on another hand."
    )]
    Overshoot(OvershootArgs),
    /// Write the hand as a model for simulators and viewers: URDF, MJCF, and a table of joints
    #[command(
        after_help = "Examples:\n  handscope model --urdf --out model\n  handscope model --urdf --mjcf --side left --out model\n\nNo hand is contacted. The table lists for each joint its name, its drive, its place in the registers, and the conversion of counts to radians. 'handscope help dds' describes the files."
    )]
    Model(ModelArgs),
    /// Write a workspace of ROS 2: the messages as a package, and a launch file that shows the hand in RViz
    #[command(
        after_help = "Examples:\n  handscope ros2 --out hand_ws\n  cd hand_ws && colcon build\n\nNo hand is contacted, and no ROS is needed. The messages are those that recordings and DDS use. Nothing is overwritten: the folder must be new or empty. 'handscope help dds' describes the topics."
    )]
    Ros2(Ros2Args),
    /// Print the shell completion script for commands and options: bash, zsh, fish, ...
    #[command(
        after_help = "Examples:\n  handscope completions bash > ~/.local/share/bash-completion/completions/handscope\n  handscope completions fish > ~/.config/fish/completions/handscope.fish\n\nThe package includes them; this is for a program that was built from source."
    )]
    Completions(CompletionsArgs),
    /// Write the manual pages, for packages
    #[command(hide = true)]
    Man(ManArgs),
    /// Close thumb and index to a gap in mm, or on an object between them
    #[command(
        after_help = "Examples:\n  handscope grip --hand rs485:/dev/ttyUSB0 --gap 30 --arm\n  handscope grip --hand tcp:192.168.11.210 --kind pinch --gap 12.5 --speed 100 --force 300 --arm --json\n  handscope grip --hand rs485:/dev/ttyUSB0 --gap 120 --arm\n\nThe hand opens, and closes along the path on which the pads of thumb and index meet. It ends where the hand rests: at the gap, or on what it holds, whose size the model gives. Ctrl-C stops the hand. 'handscope help grip' describes it.\n\nExit status: 0 at the gap, or something is held; 1 ended early, or stopped by something that is not held; 2 wrong usage."
    )]
    Grip(GripArgs),
    /// Hold an object with the least force that holds it, between two limits
    #[command(
        after_help = "Examples:\n  handscope hold --hand 'sim:?object=egg' --pose 'Power grasp' --at-least 120 --at-most 300 --arm --for 30\n  handscope hold --hand rs485:/dev/ttyUSB0 --gap 20 --at-least 150 --at-most 400 --arm --json\n  handscope hold --hand tcp:192.168.11.210 --at-least 1.5 --at-most 4 --newtons --arm\n  handscope hold --hand tcp:192.168.11.210 --gap 20 --for 20 --save egg --arm\n  handscope hold --hand tcp:192.168.11.211 --grasp egg --arm\n\nThis moves the hand, and only with --arm: the fingers close slowly until each presses with --at-least. What the hand holds already is taken over without opening, with its present pose. Then the force follows the load: a finger presses harder where the object is about to slide, never with more than --at-most, and less again when it is quiet. Ctrl-C stops the hand: it keeps its position, and so what it holds. --save stores a hold that worked; another hand confirms it with five closes before it holds with --grasp. 'handscope help hold' describes it.\n\nExit status: 0 held until --for was over or Ctrl-C; 1 nothing was held, the object was lost, the grasp was not confirmed or saved, or it ended early; 2 wrong usage."
    )]
    Hold(HoldArgs),
    /// Find out what the forces of a joint are in newtons, with a kitchen scale
    #[command(
        after_help = "Examples:\n  handscope scale --hand rs485:/dev/ttyUSB0 --joint index --arm\n  handscope scale --hand rs485:/dev/ttyUSB0\n  handscope scale --hand rs485:/dev/ttyUSB0 --out newtons.csv\n  handscope scale --hand rs485:/dev/ttyUSB0 --forget --joint index\n\nWith --arm the finger presses the scale at five loads below --limit, each time from the air, and lets go afterwards. At each load type what the scale shows in g, 'again' to press once more, or 'skip'. The end of standard input ends it, Ctrl-C stops the hand. Loads that were accepted remain, and the next run measures the others. 'handscope help scale' describes it.\n\nExit status: 0 all five loads accepted, or shown; 1 ended early or contradicted; 2 wrong usage."
    )]
    Scale(ScaleArgs),
    /// Check an empty hand: strokes, backlash, friction, speed, forces, fingertips, supply
    #[command(
        after_help = "Examples:\n  handscope check --hand rs485:/dev/ttyUSB0 --arm\n  handscope check --hand tcp:192.168.11.210 --arm --out checked\n  handscope check --hand rs485:/dev/ttyUSB0 --arm --json\n\nThis moves the hand, and only with --arm: take everything out of it and out of its way. Each joint bends and opens alone, at speeds 200 and 500, then all six open and close a little, in about 80 seconds. Each joint stops by itself at 150 g; the hand is stopped at 300 g or 60 degrees, and where it is not empty. With --press it asks for a press of each fingertip at the end, when nothing moves. Ctrl-C stops the hand, and the program stays until feedback shows rest. 'handscope help check' explains each figure, and what is stored.\n\nExit status: 0 no action needed; 1 action needed, or it ended early; 2 wrong usage."
    )]
    Check(CheckArgs),
    /// Let a hand follow another program: hand tracking, a glove, a script
    #[command(
        after_help = "Examples:\n  handscope follow --hand sim: --udp 127.0.0.1:6010\n  handscope follow --hand rs485:/dev/ttyUSB0 --udp 127.0.0.1:6010 --arm\n  handscope follow --hand tcp:192.168.11.210 --dds --arm\n  handscope follow --hand rs485:/dev/ttyUSB0 --mirror rs485:/dev/ttyUSB1 --scale 0.5 --arm\n\nEach line is one object, {\"seq\":1,\"right\":[six of 0..1 or null]}, 0 bent, 1 open ('handscope help stream'). With --dds it accepts what Unitree's programs and those of ROS 2 send, and publishes the hand's state to them ('handscope help dds'); no other computer is contacted unless you name an interface.\n\nThis moves the hand, and only with --arm. It begins where the hand is, and stays within --lead and --rate. Without a fresh line for 200 ms the hand is held, after 1 s it is stopped and disarmed: press Enter to let it move again. Ctrl-C stops the hand, and the program stays until feedback shows rest.\n\nExit status: 0 ended by the user; 1 ended otherwise; 2 wrong usage."
    )]
    Follow(FollowArgs),
    /// Record everything a hand reports into a recording file
    #[command(
        after_help = "Examples:\n  handscope record --hand rs485:/dev/ttyUSB0\n  handscope record --hand tcp:192.168.11.210 --for 60 --out grasp.mcap\n\nIt only reads. Ctrl-C ends the recording and closes the file; the last line on standard output is one JSON object of statistics. No file is overwritten. After a crash the file still opens: 'handscope info' says what is missing.\n\nThe file is MCAP with ROS 2 messages ('handscope help sessions')."
    )]
    Record(RecordArgs),
    /// Show what a recording file holds, and what is missing from it
    #[command(
        after_help = "Examples:\n  handscope info grasp.mcap\n  handscope info grasp.mcap --json\n\nThe file is read to its end, so that every checksum is checked. Exit status: 0 the file could be read, complete or not; 1 it could not; 2 wrong usage."
    )]
    Info(InfoArgs),
    /// Convert a recording file, or a part of it, into CSV, Parquet, a rosbag2 folder, LeRobot, or a shorter recording file
    #[command(
        after_help = "Examples:\n  handscope export grasp.mcap --csv --out grasp.csv\n  handscope export grasp.mcap --parquet --from 12.5 --to 20 --out grasp.parquet\n  handscope export grasp.mcap --rosbag --out grasp\n  handscope export long.mcap --mcap --from 600 --to 660 --out minute.mcap\n  handscope export grasp.mcap --lerobot --fps 30 --task 'close on an egg' --out egg\n  handscope export mon.mcap tue.mcap --lerobot --episode notes --out eggs\n  handscope export grasp.mcap --csv --from -10 --out - | gzip > end.csv.gz\n\nNothing is overwritten, and no partial file is left. 'handscope help sessions' lists the columns."
    )]
    Export(ExportArgs),
    /// Write a repaired copy of a recording file that is damaged or was not closed
    #[command(
        after_help = "Examples:\n  handscope recover crashed.mcap\n  handscope recover damaged.mcap --out whole.mcap\n\nThe file itself stays as it is. The copy holds all that can be read, and a note of what was lost."
    )]
    Recover(RecoverArgs),
    /// Make a recording file of the values that 'export --csv' wrote
    #[command(
        after_help = "Examples:\n  handscope import grasp.csv\n  handscope import grasp.csv --out again.mcap\n  handscope import monday.csv tuesday.csv\n\nColumns are known by their names, in any order; others are skipped and named. What no column gives stays unknown: the day, the hand, its parameters, the bytes on the wire."
    )]
    Import(ImportArgs),
    /// Act as a hand that replays a recording, on the wires of 'handscope sim'
    #[command(
        after_help = "Examples:\n  handscope replay grasp.mcap --tcp 127.0.0.1:6000\n  handscope replay grasp.mcap --rs485 /tmp/hand --speed 0.5 --loop\n\nEach wire is announced as 'ready KIND PLACE'. Writes are acknowledged and change nothing. While the link was down the hand is silent. It ends with the recording, or at Ctrl-C."
    )]
    Replay(ReplayArgs),
    /// Let several programs use one hand at a time, over Modbus TCP, and show it to live viewers
    #[command(
        after_help = "Examples:\n  handscope share --hand rs485:/dev/ttyUSB0 --tcp 127.0.0.1:6001\n  handscope share --hand tcp:192.168.11.210 --tcp 127.0.0.1:6001 --writers\n  handscope share --hand sim: --dds\n  handscope share --hand sim: --foxglove 127.0.0.1:8765\n  handscope share --hand sim: --stdio\n\nIt prints 'ready tcp ADDRESS', 'ready foxglove ADDRESS' or 'ready dds ADDRESS' and runs until Ctrl-C, with --stdio until standard input ends. With --dds the hand's state is published as Unitree's driver does it, and for ROS 2 ('handscope help dds'); no other computer is contacted unless you name an interface. Programs find the registers where the hand itself has them, at every unit id. Their reads are answered from what is read anyway. Without --writers no client can move the hand; with it the first that writes can, and the hand is stopped when that ends. 'handscope help share' lists what may be written.\n\nExit status: 0 ended by Ctrl-C; 1 no hand, or the address cannot be served; 2 wrong usage."
    )]
    Share(ShareArgs),
    /// List the hands that other Handscopes share, as they come and go
    #[command(
        after_help = "Examples:\n  handscope fleet\n  handscope fleet eth0 --for 3 --json\n\nIt listens on DDS for hands shared with 'share --dds' or with 'Join' in a window ('handscope help dds'), and connects to none. Each line gives the computer, the hand, its state, who moves it, and the URL to watch it at.\n\nExit status: 0 ended by Ctrl-C or by --for; 1 there is no such interface; 2 wrong usage."
    )]
    Fleet(FleetArgs),
    /// Simulate a hand for other programs, on pseudo-terminals, TCP and CAN
    #[command(
        after_help = sim::help()
    )]
    Sim(SimArgs),
    /// Hold a hand if the program that started this one dies: started by each program that arms a hand, connected by its standard input
    #[command(hide = true)]
    Guard(GuardArgs),
    /// Print the register map
    Registers(RegistersArgs),
    /// Explain a command or a topic of the manual
    Help(HelpArgs),
}

#[derive(Debug, Args)]
pub(crate) struct RegistersArgs {
    /// Print one JSON list
    #[arg(long)]
    pub(crate) json: bool,
}

const ENDPOINTS: &str = "\
Hands are named by URL:
  sim:                                     the built-in simulated hand
  sim:?seed=7&scenario=grasp               the same, playing a scenario
  sim:?body=worn.toml                      the same, with a body of yours
  sim:?object=egg                          the same, with an object to hold
  rs485:/dev/ttyUSB0?baud=115200&id=1      RS485, the maker's own framing
  rtu:/dev/ttyUSB0?baud=115200&id=1        Modbus RTU on the same kind of port
  tcp:192.168.11.210:6000?unit=255         Modbus TCP
  slcan:/dev/ttyACM0?bitrate=1000000&id=1  CAN through a serial adapter
  usbcan:/dev/ttyUSB0?baud=115200&id=1     CAN through the maker's own adapter
  can:can0?id=1                            CAN interface (Linux)

Exit status: 0 done, 1 failed, 2 wrong usage.";

fn after_help() -> String {
    format!("{ENDPOINTS}\n\n{}", help::topics())
}

#[cfg(test)]
mod tests {
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
            "handscope grip --hand sim: --arm",
            "handscope grip --hand sim: --gap 2 --arm",
            "handscope grip --hand sim: --gap 30 --kind around --arm",
            "handscope grip --hand sim: --gap 30 --force 2001 --arm",
            "handscope scale --hand sim: --arm",
            "handscope scale --hand sim: --joint thumb_rotate --arm",
            "handscope scale --hand sim: --joint index --limit 200 --arm",
            "handscope scale --hand sim: --joint index --arm --forget",
            "handscope share --hand sim:",
            "handscope share --tcp 127.0.0.1:6001",
            "handscope share --hand sim: --tcp localhost:6001",
            "handscope share --hand sim: --dds --writers",
            "handscope share --hand sim: --dds --domain 233",
            "handscope share --hand sim: --tcp 127.0.0.1:6001 --domain 1",
            "handscope follow --hand sim: --dds --udp 127.0.0.1:6010",
            "handscope share --hand sim: --foxglove localhost:8765",
            "handscope share --hand sim: --foxglove 127.0.0.1:8765 --writers",
            "handscope share --hand sim: --tcp 127.0.0.1:6001 --silence 5",
            "handscope share --hand sim: --tcp 127.0.0.1:6001 --writers --silence 0",
            "handscope snapshot",
            "handscope snapshot --out x --view nowhere",
            "handscope snapshot --out x --scenario party",
            "handscope snapshot --out x --size 10x10",
            "handscope snapshot --out x --scale 0",
            "handscope snapshot --out x --hand sim: --scenario grasp",
            "handscope inputs --map pad.toml",
            "handscope --hand sim: watch --hand sim:",
        ] {
            let error = Cli::try_parse_from(line.split(' ')).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{line}");
        }
    }
}
