//! `inputs`: lists the gamepads of this computer, and shows the effect of their controls without a hand. Moves nothing.

use crate::cli::inputs::source::{is_folder, pad_input};
use crate::cli::out::{Out, notify};
use crate::hand::{Angle, Dof, Moment, PerDof};
use crate::inputs::Offer;
use crate::inputs::pad::device::{FOLDER, PadReader, find};
use crate::inputs::pad::state::FULL;
use crate::inputs::pad::{
    ControlKind, PadAction, PadControl, PadEvent, PadFacts, PadInput, PadMap, PadNews, PadReport,
    PadState, PadTrouble,
};
use crate::link::Clock;
use crate::shell::interrupt::Interrupt;
use anyhow::bail;
use serde_json::{Map, Value, json};
use std::path::PathBuf;
use std::sync::Arc;

/// Initial position of the joints of the imaginary hand.
const BEGIN: Angle = Angle::MAX;

#[derive(Debug, clap::Args)]
pub(crate) struct InputsArgs {
    /// Print what each control does as it is moved, until Ctrl-C
    #[arg(long)]
    watch: bool,
    /// Take what the controls do from this file
    #[arg(long, value_name = "FILE", requires = "watch")]
    map: Option<PathBuf>,
    /// Look for gamepads in this folder
    #[arg(long, value_name = "FOLDER", default_value = FOLDER)]
    devices: PathBuf,
    /// Print one JSON object per line
    #[arg(long)]
    json: bool,
}

/// Lists the gamepads, or prints the input of one until the user ends it.
pub(crate) async fn run(out: &mut Out, args: &InputsArgs) -> anyhow::Result<()> {
    if args.watch {
        watch(out, args).await
    } else {
        list(out, args)
    }
}

fn list(out: &mut Out, args: &InputsArgs) -> anyhow::Result<()> {
    let found = find(&args.devices)?;
    for facts in &found {
        out.result(
            args.json,
            &json!({ "pad": pad_json(facts) }),
            [pad_text(facts)],
        )?;
    }
    if found.is_empty() {
        let folder = args.devices.display();
        notify(&format!(
            "there is no gamepad in {folder}: plug one in, or pair it; 'handscope inputs --watch' waits for one"
        ));
    }
    Ok(())
}

async fn watch(out: &mut Out, args: &InputsArgs) -> anyhow::Result<()> {
    let input = pad_input(args.map.as_deref())?;
    is_folder(&args.devices)?;
    let mut interrupt = Interrupt::listen()?;
    let clock = Clock::start();
    let mut reader = PadReader::start(args.devices.clone(), Arc::new(move || clock.now()))?;
    let mut printer = PadPrinter::new(input, args.json);
    let hint = dead_man_name(printer.input.map());
    notify(&format!(
        "waiting for a gamepad; hold {hint} to see where the joints would go; Ctrl-C ends"
    ));
    loop {
        let report = tokio::select! {
            biased;
            () = interrupt.wished() => return Ok(()),
            report = reader.report() => report,
        };
        let Some(report) = report else {
            bail!("the gamepads are no longer read");
        };
        if let PadNews::Trouble(trouble) = &report.news {
            match trouble {
                PadTrouble::LinuxOnly => return Err(trouble.clone().into()),
                trouble => notify(&trouble.to_string()),
            }
        }
        if let Some(line) = printer.line(&report) {
            if args.json {
                out.stream_json(&line)?;
            } else {
                out.stream_line(&line)?;
            }
        }
    }
}

fn dead_man_name(map: &PadMap) -> &'static str {
    let dead_man = map.doing(&PadAction::DeadMan).next();
    dead_man.map_or("nothing", PadControl::name)
}

/// The last printed state, for printing changes only.
#[derive(Debug, Clone, PartialEq)]
struct Printed {
    state: PadState,
    aims: PerDof<Option<Angle>>,
    is_held: bool,
}

/// Follows the gamepad with an imaginary hand that is always at its target.
struct PadPrinter {
    input: PadInput,
    actual: PerDof<Angle>,
    last: Option<Printed>,
    as_json: bool,
}

impl PadPrinter {
    fn new(mut input: PadInput, as_json: bool) -> Self {
        let actual = PerDof::splat(BEGIN);
        input.set_actual(actual.map(Some));
        Self {
            input,
            actual,
            last: None,
            as_json,
        }
    }

    /// Line to print for this report; `None` if nothing printable has changed.
    fn line(&mut self, report: &PadReport) -> Option<String> {
        let event = self.input.receive(report);
        let offer = self.input.offer(report.at);
        if let Some(offer) = &offer {
            for (dof, joint) in self.actual.iter_mut() {
                *joint = offer.aims[dof].unwrap_or(*joint);
            }
            self.input.set_actual(self.actual.map(Some));
        }
        let moved = offer.and_then(|offer| self.moved(report.at, &offer, event));
        match (event, &report.news) {
            (Some(PadEvent::Found), PadNews::Found { facts, .. }) => Some(if self.as_json {
                json!({ "pad": pad_json(facts) }).to_string()
            } else {
                pad_text(facts)
            }),
            (Some(PadEvent::Gone), _) => Some(self.event_line("gone", "the gamepad is gone")),
            (Some(PadEvent::Lost), _) => Some(self.event_line(
                "lost",
                "events were lost: release everything and press it again",
            )),
            _ => moved,
        }
    }

    fn event_line(&self, key: &str, words: &str) -> String {
        if self.as_json {
            json!({ key: words }).to_string()
        } else {
            words.into()
        }
    }

    fn moved(&mut self, at: Moment, offer: &Offer, event: Option<PadEvent>) -> Option<String> {
        let now = Printed {
            state: self.input.state().clone(),
            aims: offer.aims,
            is_held: offer.held == Some(true),
        };
        let before = self.last.replace(now.clone())?;
        let mut all = PadControl::ALL.into_iter();
        let control =
            all.find(|control| value(&before.state, *control) != value(&now.state, *control));
        let is_stop = event == Some(PadEvent::Stop);
        if control.is_none() && !is_stop && (before.aims, before.is_held) == (now.aims, now.is_held)
        {
            // Not printed: movements below a hundredth accumulate.
            self.last = Some(Printed {
                state: before.state,
                ..now
            });
            return None;
        }
        Some(if self.as_json {
            move_json(at, control, &now, is_stop).to_string()
        } else {
            self.move_text(control, &now, is_stop)
        })
    }

    fn move_text(&self, control: Option<PadControl>, now: &Printed, is_stop: bool) -> String {
        let name = control.map_or("", PadControl::name);
        let amount = control.map_or(String::new(), |control| match value(&now.state, control) {
            ControlValue::Button(true) => "down".into(),
            ControlValue::Button(false) => "up".into(),
            ControlValue::Amount(amount) => hundredths(amount),
            ControlValue::Place([right, up]) => format!("{} {}", hundredths(right), hundredths(up)),
        });
        let asked = match (is_stop, now.is_held) {
            (true, _) => "STOP".into(),
            (false, false) => format!("nothing: hold {}", dead_man_name(self.input.map())),
            (false, true) => {
                let aims = now.aims.iter().map(|(dof, aim)| {
                    let aim = aim.map_or("-".into(), |aim| aim.get().to_string());
                    format!("{} {aim:>4}", dof.name())
                });
                aims.collect::<Vec<_>>().join("  ")
            }
        };
        format!("{name:<17}  {amount:>11}  {asked}")
    }
}

/// Value of a control as printed: in hundredths, to suppress a trembling stick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ControlValue {
    Button(bool),
    Amount(i16),
    /// To the right and up.
    Place([i16; 2]),
}

fn value(state: &PadState, control: PadControl) -> ControlValue {
    // Full deflection must remain exactly full.
    let rounded = |thousandths: i16| thousandths / (FULL / 100);
    match control.kind() {
        ControlKind::Button => ControlValue::Button(state.is_held(control)),
        ControlKind::Trigger => ControlValue::Amount(rounded(state.trigger(control))),
        ControlKind::Stick => {
            let place = state.stick(control);
            ControlValue::Place([rounded(place.right), rounded(place.up)])
        }
    }
}

fn share(hundredths: i16) -> f64 {
    f64::from(hundredths) / 100.0
}

fn hundredths(amount: i16) -> String {
    format!("{:.2}", share(amount))
}

fn pad_text(facts: &PadFacts) -> String {
    let path = facts.path.display();
    let (vendor, product) = (facts.vendor, facts.product);
    format!("{path}  {}  {vendor:04x}:{product:04x}", facts.name)
}

fn pad_json(facts: &PadFacts) -> Value {
    json!({
        "path": facts.path.display().to_string(),
        "name": facts.name,
        "vendor_id": format!("{:04x}", facts.vendor),
        "product_id": format!("{:04x}", facts.product),
    })
}

fn move_json(at: Moment, control: Option<PadControl>, now: &Printed, is_stop: bool) -> Value {
    let aims = Dof::ALL.map(|dof| (dof.name().to_owned(), json!(now.aims[dof])));
    let shown = control.map(|control| match value(&now.state, control) {
        ControlValue::Button(is_down) => json!(is_down),
        ControlValue::Amount(amount) => json!(share(amount)),
        ControlValue::Place(place) => json!(place.map(share)),
    });
    json!({ "move": {
        "at_s": at.secs(),
        "control": control.map(PadControl::name),
        "value": shown,
        "held": now.is_held,
        "stop": is_stop,
        "aims": Map::from_iter(aims),
    }})
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inputs::pad::{FaceOrder, KernelEvent, PadId};
    use std::collections::BTreeMap;
    use std::time::Duration;

    const PAD: PadId = PadId(0);

    fn facts() -> PadFacts {
        PadFacts {
            name: "Test pad".into(),
            path: "/dev/input/event7".into(),
            vendor: 0x45e,
            product: 0x28e,
            axes: BTreeMap::new(),
            face: FaceOrder::ByPlace,
        }
    }

    /// Output for each of these reports, 50 ms apart.
    fn printed(as_json: bool, news: &[PadNews]) -> Vec<String> {
        let mut printer = PadPrinter::new(pad_input(None).unwrap(), as_json);
        let found = PadNews::Found {
            pad: PAD,
            facts: facts(),
            now: Vec::new(),
        };
        let all = std::iter::once(&found).chain(news).enumerate();
        let lines = all.filter_map(|(step, news)| {
            let at = Moment::ZERO.plus(Duration::from_millis(50) * u32::try_from(step).unwrap());
            let news = news.clone();
            printer.line(&PadReport { at, news })
        });
        lines.collect()
    }

    fn moved(name: &str, value: i32) -> PadNews {
        let event = KernelEvent::named(name, value).unwrap();
        PadNews::Moved { pad: PAD, event }
    }

    #[test]
    fn each_change_is_one_line_with_the_control_its_amount_and_the_six_aims() {
        let lines = printed(
            false,
            &[
                moved("BTN_TR2", 1),
                moved("BTN_TL", 1),
                PadNews::Alive(PAD),
                moved("BTN_TR2", 0),
                moved("BTN_SOUTH", 1),
                moved("BTN_EAST", 1),
                PadNews::Gone(PAD),
            ],
        );
        let wanted = [
            "/dev/input/event7  Test pad  045e:028e",
            "right_trigger             1.00  nothing: hold left_bumper",
            "left_bumper               down  little    0  ring    0  middle    0  index    0  thumb_bend 1000  thumb_rotate    -",
            "right_trigger             0.00  little 1000  ring 1000  middle 1000  index 1000  thumb_bend 1000  thumb_rotate    -",
        ];
        assert_eq!(lines.get(..4).unwrap(), wanted);
        assert!(lines[4].starts_with("south                     down  little "));
        assert_eq!(lines[5], "east                      down  STOP");
        assert_eq!(lines.last().unwrap(), "the gamepad is gone");
        assert_eq!(lines.len(), 7);
    }

    #[test]
    fn with_json_each_line_is_one_object() {
        let lines = printed(
            true,
            &[
                moved("BTN_TL", 1),
                moved("BTN_TR2", 1),
                PadNews::Lost {
                    pad: PAD,
                    now: Vec::new(),
                },
            ],
        );
        let lines: Vec<Value> = lines
            .iter()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        assert_eq!(lines[0]["pad"]["product_id"], "028e");
        let close = &lines[2]["move"];
        assert_eq!(close["control"], "right_trigger");
        assert_eq!(close["value"], 1.0);
        assert_eq!(close["held"], true);
        assert_eq!(close["stop"], false);
        assert_eq!(close["aims"]["index"], 0);
        assert_eq!(close["aims"]["thumb_rotate"], Value::Null);
        assert!(lines[3]["lost"].is_string());
    }
}
