//! Source that a hand follows from the command line: JSON lines at an address, programs on DDS, a gamepad, or another hand.

use crate::cli::parse::number;
use crate::cli::share::dds::{self, DdsArgs};
use crate::cli::{listen, parse, session};
use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::inputs::Offer;
use crate::inputs::dds::source::DdsView;
use crate::inputs::mirror::MirrorScale;
use crate::inputs::offer::SourceSite;
use crate::inputs::pad::device::{FOLDER, PadReader};
use crate::inputs::pad::report::PadTrouble;
use crate::inputs::pad::source::{PadSource, PadSourceConfig};
use crate::inputs::pad::{PadInput, PadMap, file};
use crate::inputs::stream::{StreamPlace, StreamSource, StreamView};
use crate::link::{ArmRequest, Clock, LinkHandle, Owner, PollRates};
use crate::motion::source::{JoinedDds, Source};
use crate::share::dds::SharedOnDds;
use crate::share::fleet::{FleetCard, OtherFollowers};
use crate::store::toml_file;
use crate::transport::Endpoint;
use crate::transport::dds::DdsNode;
use anyhow::{Context as _, bail};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tokio::runtime::Handle;
use tokio::sync::mpsc;

#[derive(Debug, clap::Args)]
#[command(group = clap::ArgGroup::new("place").required(true).args(["udp", "tcp", "dds", "gamepad", "mirror"]))]
pub(super) struct SourceArgs {
    /// Take a line a datagram here, for example 127.0.0.1:6010; port 0 takes any free one
    #[arg(long, value_name = "ADDR:PORT", value_parser = listen::address)]
    udp: Option<SocketAddr>,
    /// Take lines over TCP connections here
    #[arg(long, value_name = "ADDR:PORT", value_parser = listen::address)]
    tcp: Option<SocketAddr>,
    #[command(flatten)]
    dds: DdsArgs,
    /// Follow the gamepad of this computer ('handscope help gamepad')
    #[arg(long)]
    gamepad: bool,
    /// Follow another hand, which is read and never written; left follows right, too
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    mirror: Option<Endpoint>,
    /// With --mirror: this share of each bend of the other hand, 0.2 to 1.0 [default: 1.0]
    #[arg(long, value_name = "SHARE", conflicts_with_all = ["udp", "tcp", "gamepad"], value_parser = scale)]
    scale: Option<MirrorScale>,
    /// With --gamepad: look for it in this folder
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["udp", "tcp", "dds", "mirror"], default_value = FOLDER)]
    devices: PathBuf,
    /// With --gamepad: take what the controls do from this file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["udp", "tcp", "dds", "mirror"])]
    map: Option<PathBuf>,
    /// Which values of a line, or which topics, are for this hand: right or left
    #[arg(long, value_name = "SIDE", default_value = "right", value_parser = parse::side)]
    side: Side,
}

fn scale(text: &str) -> Result<MirrorScale, String> {
    let what = "a share of 0.2 to 1.0";
    let (least, most) = MirrorScale::RANGE;
    let share = number(text, least..=most, what)?;
    MirrorScale::new(share).ok_or_else(|| what.to_owned())
}

impl SourceArgs {
    /// Side of the hand.
    pub(super) const fn side(&self) -> Side {
        self.side
    }

    /// Place of lines to listen at.
    fn stream(&self) -> Option<StreamPlace> {
        let udp = self.udp.map(StreamPlace::Udp);
        udp.or(self.tcp.map(StreamPlace::Tcp))
    }

    /// Reason why these arguments cannot apply to this hand, if any.
    pub(super) fn wrong(&self, hand: &Endpoint) -> Option<&'static str> {
        // Each built-in hand is a separate one.
        let is_built_in = matches!(hand, Endpoint::Sim { .. });
        if self.mirror.as_ref() == Some(hand) && !is_built_in {
            Some("a hand cannot follow itself; name another one with --mirror")
        } else {
            self.dds.wrong()
        }
    }
}

/// Permissions of a source.
#[derive(Clone, Copy)]
pub(super) struct Allowed {
    /// Maximum speeds and forces.
    pub(super) limits: ArmRequest,
    /// True if the source may move the hand.
    pub(super) moves: bool,
}

/// The source that the hand follows.
pub(super) struct FollowSource {
    source: Source,
    /// Endpoint and link of a leading hand.
    leader: Option<(Endpoint, LinkHandle)>,
}

impl FollowSource {
    /// Opens the source; its commands are limited to `allowed`, and nothing moves if that permits no motion.
    pub(super) async fn open(
        args: &SourceArgs,
        hand: &Endpoint,
        (link, clock): (&LinkHandle, Clock),
        allowed: Allowed,
    ) -> anyhow::Result<Self> {
        if let Some(other) = &args.mirror {
            let leader = session::open(other, PollRates::default(), clock);
            session::answered(&leader, other).await?;
            let scale = args.scale.unwrap_or(MirrorScale::WHOLE);
            return Ok(Self {
                source: Source::mirror(&leader, scale),
                leader: Some((other.clone(), leader)),
            });
        }
        let site = SourceSite::of(link, args.side, Arc::new(|| ()));
        let can = if allowed.moves {
            "read this hand and move it"
        } else {
            "read this hand and send to it"
        };
        let source = if let Some(node) = args.dds.join(can)? {
            let card = FleetCard {
                side: args.side,
                follows: allowed.moves,
                ..args.dds.card(hand)
            };
            on_dds(node, card, link, site, allowed).await?
        } else if let Some(place) = args.stream() {
            stream(place, site, allowed)?
        } else {
            let input = pad_input(args.map.as_deref())?;
            is_folder(&args.devices)?;
            Source::Pad(PadSource::open(PadSourceConfig {
                reader: PadReader::start(args.devices.clone(), Arc::new(move || clock.now()))?,
                input,
                records: link.records(),
                site,
            }))
        };
        Ok(Self {
            source,
            leader: None,
        })
    }

    /// Waits for a reason why the hand must not move any longer, and returns it.
    pub(super) async fn must_end(&self) -> String {
        followed(&self.source.other_follower_appears().await)
    }

    /// Line that reports readiness.
    pub(super) fn ready(&self) -> String {
        match &self.source {
            Source::Stream(source) => match source.place() {
                StreamPlace::Udp(at) => format!("ready udp {at}"),
                StreamPlace::Tcp(at) => format!("ready tcp {at}"),
            },
            Source::Dds(joined) => dds::ready(&joined.shared),
            Source::Pad(_) => "ready gamepad".into(),
            Source::Mirror(..) => format!("ready mirror {}", self.leader_name()),
        }
    }

    pub(super) fn follow(&self) -> mpsc::Receiver<Offer> {
        self.source.follow()
    }

    /// The source that would move the hand now, and its name.
    pub(super) fn owner(&self, now: Moment) -> Option<(Owner, String)> {
        let name = match &self.source {
            Source::Stream(source) => source.view().intake.sender?.0.to_string(),
            Source::Dds(joined) => {
                format!("the program on DDS ({})", joined.source.view().sender?.0)
            }
            Source::Pad(source) => source.view().name?,
            Source::Mirror(..) => self.leader_name(),
        };
        Some((self.source.owner(now)?, name))
    }

    fn leader_name(&self) -> String {
        let leader = self.leader.as_ref();
        leader.map_or_else(String::new, |(endpoint, _)| endpoint.to_string())
    }

    /// Number of irregular stops, which were obeyed despite another error in the message, and the newest one as text.
    pub(super) fn odd_stops(&self) -> Option<(u64, String)> {
        let text = |sender: &dyn Display, why: &dyn Display| {
            format!("{sender} sent a stop, which was carried out; irregular in it: {why}")
        };
        match &self.source {
            Source::Stream(source) => {
                let intake = source.view().intake;
                let (sender, why) = intake.last_odd?;
                Some((intake.odd_stops, text(&sender, &why)))
            }
            Source::Dds(joined) => {
                let view = joined.source.view();
                let (sender, why) = view.last_odd?;
                Some((view.odd_stops, text(&sender, &why)))
            }
            Source::Pad(_) | Source::Mirror(..) => None,
        }
    }

    /// Progress as text and as an object.
    pub(super) fn progress(&self, now: Moment) -> (String, Value) {
        match &self.source {
            Source::Stream(source) => {
                let StreamView {
                    intake,
                    not_granted,
                    ..
                } = source.view();
                let refused: BTreeMap<&str, u64> = intake
                    .refused
                    .iter()
                    .map(|(fault, count)| (fault.name(), *count))
                    .collect();
                let last = intake.last_refused.map(|refusal| refusal.to_string());
                let words = format!(
                    "{:6.1} lines/s  {} taken  {} refused{}",
                    intake.rate_hz,
                    intake.taken,
                    intake.refused.values().sum::<u64>(),
                    last.as_ref()
                        .map_or_else(String::new, |last| format!(" ({last})")),
                );
                let object = json!({
                    "sender": intake.sender.map(|(sender, _)| sender.to_string()),
                    "rate_hz": intake.rate_hz,
                    "taken": intake.taken,
                    "refused": refused,
                    "last_refused": last,
                    "odd_stops": intake.odd_stops,
                    "not_granted": not_granted,
                });
                (words, object)
            }
            Source::Dds(joined) => dds_progress(&joined.source.view(), &joined.shared),
            Source::Pad(source) => {
                let view = source.view();
                let held = if view.is_held { "held" } else { "not held" };
                let words = match (&view.name, &view.trouble) {
                    (Some(name), _) => format!("{name}, dead-man {held}"),
                    (None, Some(trouble)) => trouble.to_string(),
                    (None, None) => "no gamepad yet: plug one in, or pair it".into(),
                };
                let trouble = view.trouble.map(|trouble| trouble.to_string());
                let object =
                    json!({"gamepad": view.name, "trouble": trouble, "held": view.is_held});
                (words, object)
            }
            Source::Mirror(source, _) => {
                let (view, other) = (source.view(), self.leader_name());
                let leader = self.leader.as_ref();
                let trouble = leader.and_then(|(_, link)| link.status().trouble);
                let trouble = trouble.map(|trouble| trouble.to_string());
                // A silent hand has no rate.
                let rate_hz = view.owner(now).map(|_| view.rate_hz);
                let words = match (&trouble, rate_hz) {
                    (Some(trouble), _) => format!("{other}: {trouble}"),
                    (None, Some(rate)) => format!("{rate:6.1} readings/s of {other}"),
                    (None, None) => format!("{other} does not report its angles"),
                };
                let object = json!({"mirror": other, "rate_hz": rate_hz, "trouble": trouble});
                (words, object)
            }
        }
    }
}

/// Listens for lines, and warns if other computers can send them.
fn stream(place: StreamPlace, site: SourceSite, allowed: Allowed) -> anyhow::Result<Source> {
    let (StreamPlace::Udp(at) | StreamPlace::Tcp(at)) = place;
    let source = StreamSource::open(place, site, allowed.limits, &Handle::current())
        .map_err(|error| listen::refused(at, &error))?;
    let can = if allowed.moves {
        "move this hand"
    } else {
        "send to this hand"
    };
    listen::warn_if_reachable(source.local(), can);
    Ok(Source::Stream(source))
}

/// Opens DDS, but refuses a second hand of the same side: both would obey the same sender. A sender starts at the first state that it
/// receives, so none is published before this is known.
async fn on_dds(
    node: DdsNode,
    card: FleetCard,
    link: &LinkHandle,
    site: SourceSite,
    allowed: Allowed,
) -> anyhow::Result<Source> {
    let others = OtherFollowers::open(&node, card.side, site.clock);
    if allowed.moves
        && let Some(other) = others.was_there().await
    {
        bail!(followed(&other));
    }
    let joined = JoinedDds::open((node, others), card, allowed.limits, site, link);
    Ok(Source::Dds(joined))
}

fn dds_progress(view: &DdsView, out: &SharedOnDds) -> (String, Value) {
    let refused: BTreeMap<&str, u64> = view
        .refused
        .iter()
        .map(|(fault, count)| (fault.name(), *count))
        .collect();
    let newest = view.refused.keys().next_back();
    let sent = out.counts();
    let words = format!(
        "{:6.1} messages/s  {} taken  {} refused{}  {} states out",
        view.rate_hz,
        view.taken,
        refused.values().sum::<u64>(),
        newest.map_or_else(String::new, |fault| format!(" ({fault})")),
        sent.states,
    );
    let object = json!({
        "sender": view.sender.map(|(sender, _)| sender.to_string()),
        "rate_hz": view.rate_hz,
        "taken": view.taken,
        "refused": refused,
        "odd_stops": view.odd_stops,
        "not_granted": view.not_granted,
        "states": sent.states,
        "incomplete": sent.incomplete,
        "lost": sent.lost,
    });
    (words, object)
}

/// Error text: another hand obeys the same sender.
fn followed(other: &FleetCard) -> String {
    let side = match other.side {
        Side::Left => "left",
        Side::Right => "right",
    };
    let (name, host) = (&other.name, &other.host);
    format!(
        "the {side} hand {name} of {host} follows what is sent on DDS here, and one sender must not move two hands: end that, or choose another --domain or --side"
    )
}

/// Checks the folder in which gamepads appear; gamepads may appear later, but the folder must exist.
pub(super) fn is_folder(devices: &Path) -> anyhow::Result<()> {
    if !cfg!(target_os = "linux") {
        return Err(PadTrouble::LinuxOnly.into());
    }
    if devices.is_dir() {
        Ok(())
    } else {
        bail!(
            "there is no folder {} to find gamepads in; without --devices it is {FOLDER}",
            devices.display()
        )
    }
}

/// Gamepad with its mapping and poses from a file, else the defaults.
pub(super) fn pad_input(map: Option<&Path>) -> anyhow::Result<PadInput> {
    let map = match map {
        None => PadMap::usual(),
        Some(path) => toml_file::load(path, file::BYTES_MAX, file::read)
            .with_context(|| path.display().to_string())?,
    };
    Ok(PadInput::starting(map))
}
