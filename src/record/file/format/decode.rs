//! Converts messages to entries.

use crate::hand::command::WRITE_LEN_MAX;
use crate::hand::{Finger, Group, Groups, HandSample, Moment, Reply, Span};
use crate::record::file::format::cdr;
use crate::record::file::format::encode::{ARM_REFUSED, link_state_key};
use crate::record::file::format::message::{
    CommandFate, CommandMessage, EventMessage, LinkMessage, StateMessage, Time, TouchMessage,
    WireMessage,
};
use crate::record::file::format::opening::{Opening, moment_of};
use crate::record::file::format::topic::Topic;
use crate::record::{
    Direction, Entry, Event, EventKind, LinkReport, LinkState, Piece, PieceKind, Record,
    WriteCause, WriteFate, WrittenMemory,
};
use std::sync::Arc;

/// Converts messages to entries: each reading holds the newest of all groups before it, as at the time of receipt.
#[derive(Debug, Clone)]
pub struct EntryDecoder {
    base_nanos: u64,
    sample: HandSample,
    /// True if derived events are returned as entries too.
    with_derived: bool,
}

impl EntryDecoder {
    /// For a file whose moments count from this time, nanoseconds since 1970.
    pub fn new(base_nanos: u64) -> Self {
        Self {
            base_nanos,
            sample: HandSample::default(),
            with_derived: false,
        }
    }

    /// For a file with this opening.
    pub(crate) fn of(opening: &Opening) -> Self {
        Self {
            with_derived: opening.is_imported(),
            ..Self::new(opening.base_nanos)
        }
    }

    /// Returns the entry of a message; `None` if it is derived from others, empty, or unreadable. `times` are those of the log:
    /// receipt and request, nanoseconds since 1970. Of its stamps only the difference counts.
    pub fn decode(&mut self, topic: Topic, times: (u64, u64), bytes: &[u8]) -> Option<Entry> {
        let at = moment_of(self.base_nanos, times.0);
        match topic {
            Topic::Joints
            | Topic::Grip
            | Topic::Frames
            | Topic::FixedFrames
            | Topic::Description => None,
            Topic::State => {
                let state: StateMessage = cdr::decode(bytes)?;
                let asked = self.request_time(times, (state.asked, state.received));
                self.state((asked, at), &state)
            }
            Topic::Touch(finger) => {
                let touch: TouchMessage = cdr::decode(bytes)?;
                let asked = self.request_time(times, (touch.asked, touch.received));
                self.touch((asked, at), finger, &touch)
            }
            Topic::Command => command(at, &cdr::decode(bytes)?),
            Topic::CommandFate => fate(at, cdr::decode(bytes)?),
            Topic::Link => self.link(at, cdr::decode(bytes)?),
            Topic::Event => self.event(at, cdr::decode(bytes)?),
            Topic::Wire => wire(at, cdr::decode(bytes)?),
        }
    }

    /// Time of the request.
    fn request_time(&self, (log, publish): (u64, u64), (asked, received): (Time, Time)) -> Moment {
        let before = if asked.has_ended() || received.has_ended() {
            log.saturating_sub(publish)
        } else {
            received.nanos().saturating_sub(asked.nanos())
        };
        moment_of(self.base_nanos, log.saturating_sub(before))
    }

    fn reading(&self, fresh: Groups) -> Option<Entry> {
        (!fresh.is_empty()).then(|| {
            Entry::Heard(Record::Reading {
                sample: Arc::new(self.sample),
                fresh,
            })
        })
    }

    fn state(
        &mut self,
        (asked, received): (Moment, Moment),
        state: &StateMessage,
    ) -> Option<Entry> {
        let mut fresh = Groups::NONE;
        let mut take = |span: Span, bytes: &[u8]| {
            if !bytes.is_empty() {
                let taken = self.sample.apply(&Reply {
                    span,
                    bytes,
                    asked,
                    received,
                });
                fresh = fresh.and(taken);
            }
        };
        for (group, values) in [
            (Group::AngleSet, &state.angle_set),
            (Group::ForceSet, &state.force_set),
            (Group::SpeedSet, &state.speed_set),
            (Group::Position, &state.position),
            (Group::Angle, &state.angle),
            (Group::Force, &state.force),
            (Group::Current, &state.current),
        ] {
            let bytes: Vec<u8> = values.iter().flat_map(|raw| raw.to_le_bytes()).collect();
            take(group.span(), &bytes);
        }
        for (group, bytes) in [
            (Group::Faults, &state.faults),
            (Group::Status, &state.status),
            (Group::Temperature, &state.temperature),
        ] {
            take(group.span(), bytes);
        }
        self.reading(fresh)
    }

    fn touch(
        &mut self,
        (asked, received): (Moment, Moment),
        finger: Finger,
        touch: &TouchMessage,
    ) -> Option<Entry> {
        let fresh = self.sample.apply(&Reply {
            span: Group::Tactile(finger).span(),
            bytes: &touch.raw,
            asked,
            received,
        });
        self.reading(fresh)
    }

    fn link(&mut self, at: Moment, link: LinkMessage) -> Option<Entry> {
        const ALL: [LinkState; 6] = [
            LinkState::Offline,
            LinkState::Identifying,
            LinkState::Monitoring,
            LinkState::Armed,
            LinkState::Holding,
            LinkState::Fault,
        ];
        let mut known = ALL.into_iter();
        let state = known.find(|state| link_state_key(*state) == link.state)?;
        if !link.entered {
            return Some(Entry::Link(LinkReport {
                at,
                state,
                trouble: link.trouble,
                status: link.status,
                figures: link.figures,
            }));
        }
        if !state.is_live() {
            // No knowledge carries over from an earlier conversation.
            self.sample = HandSample::default();
        }
        Some(Entry::Heard(Record::State { at, state }))
    }

    fn event(&self, at: Moment, event: EventMessage) -> Option<Entry> {
        if event.kind == ARM_REFUSED {
            let reason = serde_json::from_str(&event.words).ok()?;
            return Some(Entry::Heard(Record::ArmRefused { at, reason }));
        }
        let kind = EventKind::by_key(&event.kind)
            .filter(|kind| self.with_derived || !kind.is_derived())?;
        Some(Entry::Event(Event {
            at,
            kind,
            words: event.words,
        }))
    }
}

fn command(at: Moment, command: &CommandMessage) -> Option<Entry> {
    let bytes = command
        .bytes
        .get(..command.bytes.len().min(WRITE_LEN_MAX))?;
    let cause = WriteCause::ALL.into_iter();
    Some(Entry::Heard(Record::Sent {
        at,
        number: command.number,
        cause: cause
            .clone()
            .find(|cause| cause.key() == command.cause)
            .unwrap_or(WriteCause::Request),
        write: WrittenMemory {
            address: command.address,
            bytes: bytes.iter().copied().collect(),
        },
    }))
}

fn fate(at: Moment, fate: CommandFate) -> Option<Entry> {
    Some(Entry::Heard(Record::Answered {
        at,
        number: fate.number,
        fate: match fate.fate.as_str() {
            "acknowledged" => WriteFate::Acknowledged,
            "refused" => WriteFate::Refused {
                reason: fate.reason,
            },
            _ => WriteFate::Unanswered,
        },
    }))
}

fn wire(at: Moment, wire: WireMessage) -> Option<Entry> {
    Some(Entry::Wire(Piece {
        at,
        kind: match wire.kind {
            0 => PieceKind::Opened,
            1 => PieceKind::Bytes(Direction::ToHand),
            2 => PieceKind::Bytes(Direction::FromHand),
            3 => PieceKind::Broken,
            4 => PieceKind::Closed,
            _ => return None,
        },
        bytes: wire.bytes,
    }))
}
