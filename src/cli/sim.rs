//! `sim`: simulated hands on wires that other programs can open, until the program is ended. Their behaviour is defined in
//! [`crate::sim`].
use crate::cli::out::Out;
use crate::cli::parse::{HandIds, hand_ids};
use crate::cli::wires::{ServedWire, WireArgs, failed};
use crate::shell::interrupt::Interrupt;
use crate::sim::body_params::file;
use crate::sim::object_file::{self, ObjectError};
use crate::sim::{
    BodyParams, NamedObject, Object, Personality, SWITCHES, Scenario, SharedHand, SimConfig,
    SimHand, SimHands,
};
use anyhow::Context as _;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;
use tokio::time::{Instant, interval};

/// Update interval of the hands without requests, so that the first answer after an hour need not catch up.
const LIVE_INTERVAL: Duration = Duration::from_millis(10);

/// Silence of a hand during a power cycle. The manual gives no start-up time; operating the switch takes a user about as long.
const STARTS_UP: Duration = Duration::from_secs(1);

#[derive(Debug, clap::Args)]
pub(crate) struct SimArgs {
    #[command(flatten)]
    wires: WireArgs,
    /// Ids of the hands, 1 to 254, for example 1, 1,2,3 or 1-4
    #[arg(long, value_name = "IDS", default_value = "1", value_parser = few_ids)]
    id: HandIds,
    /// Random seed of the first hand; each further hand takes the next number
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// What the hand does: idle, free, rigid, fragile, grasp, touched, faults, extremes, frozen
    #[arg(long, value_name = "NAME", default_value = "idle")]
    scenario: Scenario,
    /// What the hand does where the manual leaves a choice, from the list below; may be repeated
    #[arg(long = "quirk", value_name = "NAME=VALUE", value_parser = quirk)]
    quirks: Vec<Quirk>,
    /// The body of the hands, from a file; --print-body writes one to start from
    #[arg(long, value_name = "FILE", value_parser = body)]
    body: Option<Box<BodyParams>>,
    /// The object between the fingers: cup, egg, sponge, block, tube, can or a file; --print-object writes one to start from
    #[arg(long, value_name = "OBJECT", value_parser = object)]
    object: Option<Box<Object>>,
    /// Print the default body with its units, and end
    #[arg(long, exclusive = true, group = "wire")]
    print_body: bool,
    /// Print an object with its units, and end
    #[arg(long, value_name = "NAME", exclusive = true, group = "wire", value_parser = named_object)]
    print_object: Option<NamedObject>,
}

const SIM_HELP: &str = "\
Examples:\n  handscope sim --rs485 /tmp/hand --tcp 127.0.0.1:6000\n  handscope sim --rtu /tmp/hand-rtu\n  handscope sim --slcan /tmp/adapter --can vcan0\n  handscope sim --tcp 127.0.0.1:6000 --scenario grasp --seed 7\n  handscope sim --rs485 /tmp/bus --id 1,2,3\n  handscope sim --print-body > worn.toml\n  handscope sim --tcp 127.0.0.1:6000 --body worn.toml\n  handscope sim --print-object egg > duck-egg.toml\n  handscope sim --tcp 127.0.0.1:6000 --object duck-egg.toml\n\nIt runs until Ctrl-C. All wires lead to the same hands. On Unix, SIGUSR1 switches them off for a second, and 'power cycled' is printed once they are back; what was not saved is gone. SIGUSR2 freezes their readings while their joints keep moving, and the next one undoes it; 'feedback frozen' and 'feedback live' are printed.
On Modbus TCP the unit id selects the hand; 255 means the first, and a single hand answers to every id.";

/// Text below the list of options.
pub(crate) fn help() -> String {
    format!("{SIM_HELP}\n\n{}", quirk_list())
}

/// Serves the hands until the user ends it.
pub(crate) async fn run(out: &mut Out, args: &SimArgs) -> anyhow::Result<()> {
    if args.print_body {
        return out.lines(file::print(&BodyParams::default()).trim_end().lines());
    }
    if let Some(named) = args.print_object {
        return out.lines(object_file::print(&named.object()).trim_end().lines());
    }
    if args.object.is_some() && !object_file::fits_scenario(args.scenario) {
        let got = args.scenario.name();
        return Err(ObjectError::Scenario { got }.into());
    }
    let mut interrupt = Interrupt::listen()?;
    let power = Interrupt::power_cut()?;
    let freeze = Interrupt::freeze()?;
    let hands = hands(args).context("no hand to simulate")?;
    // All wires are ready before the first is announced: a client that waits for one may use all.
    let wires = args.wires.serve(&hands).await?;
    out.lines(wires.iter().map(ServedWire::ready))?;
    out.flush()?;
    tokio::select! {
        biased;
        () = interrupt.wished() => Ok(()),
        error = failed(wires) => Err(error),
        error = handle_signals(out, power, freeze, &hands) => Err(error),
        () = live(&hands) => Ok(()),
    }
}

/// Power-cycles all hands at one signal, freezes or unfreezes their feedback at the other, and reports the action.
async fn handle_signals(
    out: &mut Out,
    mut power: Interrupt,
    mut freeze: Interrupt,
    hands: &SimHands,
) -> anyhow::Error {
    let mut frozen = false;
    loop {
        let done = tokio::select! {
            () = power.wished() => {
                hands.with_each(SimHand::switch_off);
                tokio::time::sleep(STARTS_UP).await;
                hands.with_each(SimHand::power_cycle);
                frozen = false;
                "power cycled"
            }
            () = freeze.wished() => {
                frozen = !frozen;
                hands.with_each(|hand, now| hand.freeze_feedback(frozen, now));
                if frozen { "feedback frozen" } else { "feedback live" }
            }
        };
        if let Err(error) = out.stream_line(done) {
            return error;
        }
    }
}

/// Creates the hands, each with its own memory, body and random numbers.
fn hands(args: &SimArgs) -> Option<SimHands> {
    let begun = Instant::now();
    let seeds = (0..).map(|nth| args.seed.wrapping_add(nth));
    let mut hands = args.id.0.iter().zip(seeds).map(|(id, seed)| {
        let hand = SimHand::new(SimConfig {
            seed,
            id: id.get(),
            scenario: args.scenario,
            personality: personality(&args.quirks),
            body: args.body.as_deref().copied().unwrap_or_default(),
            object: args.object.as_deref().copied(),
        });
        SharedHand::new(hand, begun)
    });
    let first = hands.next()?;
    Some(SimHands::new(first, hands.collect()))
}

async fn live(hands: &SimHands) {
    let mut tick = interval(LIVE_INTERVAL);
    loop {
        tick.tick().await;
        hands.with_each(SimHand::advance_to);
    }
}

/// Maximum number of simulated hands: an RS485 bus carries 32 (TIA-485-A), and each needs computing time.
const SIM_HANDS_MAX: usize = 32;

fn few_ids(text: &str) -> Result<HandIds, String> {
    let ids = hand_ids(text)?;
    let asked = ids.0.len();
    if asked > SIM_HANDS_MAX {
        return Err(format!(
            "'{text}' asks for {asked} hands; at most {SIM_HANDS_MAX} can be simulated at once"
        ));
    }
    Ok(ids)
}

/// Reads a body file.
fn body(path: &str) -> Result<Box<BodyParams>, String> {
    let body = file::read(Path::new(path)).map_err(|error| error.to_string())?;
    Ok(Box::new(body))
}

/// Returns a named object, or reads an object file.
fn object(text: &str) -> Result<Box<Object>, String> {
    let object = object_file::named_or_file(text).map_err(|error| error.to_string())?;
    Ok(Box::new(object))
}

fn named_object(name: &str) -> Result<NamedObject, String> {
    NamedObject::by_name(name).ok_or_else(|| {
        let known = NamedObject::ALL.map(NamedObject::name).join(", ");
        format!("'{name}' is not an object: choose {known}")
    })
}

/// Name and value of a switch.
type Quirk = (String, String);

/// Parses `NAME=VALUE`.
fn quirk(text: &str) -> Result<Quirk, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or_else(|| format!("'{text}' is not a quirk: write NAME=VALUE"))?;
    let known = Personality::default().set(name, value);
    known.map_err(|error| error.to_string())?;
    Ok((name.into(), value.into()))
}

/// A personality with these quirks; of a repeated switch, the last value counts.
fn personality(quirks: &[Quirk]) -> Personality {
    let mut personality = Personality::default();
    for (name, value) in quirks {
        let known = personality.set(name, value);
        debug_assert!(known.is_ok(), "it was looked up when it was read");
    }
    personality
}

/// All switches and values, for the help text.
fn quirk_list() -> String {
    let mut text = String::from(
        "Quirks: what the hand does where the manual leaves a choice. The first value of each is the default.\n",
    );
    for switch in SWITCHES {
        let values = switch.values.join("|");
        // Writing to a string cannot fail.
        let _written = writeln!(text, "  {}={values}\n      {}", switch.name, switch.about);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::GapAnswer;

    #[test]
    fn quirks_are_read_by_name_and_wrong_ones_say_what_there_is() {
        let all = [
            quirk("gap=refused").unwrap(),
            quirk("doubles=some").unwrap(),
        ];
        assert_eq!(personality(&all).gap, GapAnswer::Refused);
        for (text, part) in [
            ("gap", "NAME=VALUE"),
            ("gap=ajar", "through, refused"),
            ("warp=9", "no quirk 'warp'"),
        ] {
            let error = quirk(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
        for switch in SWITCHES {
            assert!(quirk_list().contains(switch.name));
        }
    }
}
