//! The hand of task tests: a memory, a flash, a power switch and a script of what goes wrong. Speaks no protocol.

use crate::hand::{
    AngleReading, ArmEpoch, Faults, ForceReading, Group, HandCommand, HandSample, Moment, PerDof,
    RegisterWrite, Setpoints, Setting, Span, Speed, Status, TemperatureReading, Timed,
};
use crate::link::lease::LeaseBook;
use crate::link::{
    ArmRequest, Clock, Lease, LeaseRefusal, LinkStatus, Owner, PollRates, Records, RequestError,
};
use crate::params::changes::plan_writes;
use crate::params::place;
use crate::params::rows::{ParamId, Value};
use crate::params::values::{Params, decoded, span_of};
use crate::record::{
    Calibrated, Disarmed, Hold, LinkState, NotSent, Record, Reset, Rest, Saved, Verdict, Written,
};
use crate::tasks::{Reach, TaskHand};
use crate::transport::Endpoint;
use std::sync::{Arc, Mutex, MutexGuard};
use tokio::sync::broadcast;

/// Bytes of memory: more than any address of a kept row.
const MEMORY: usize = 4096;
/// Records that may wait for a task.
const RECORDS: usize = 64;

/// One thing that a hand was asked or told.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Asked {
    Read(Span),
    SetUnread(Setting),
    Keep(Setting),
    Save,
    Reset,
    Calibrate,
    Stop,
    Disarm,
    Arm(ArmRequest),
    RunUntil(Moment),
    Move(Setpoints),
    ReadAt(PollRates),
}

/// What becomes of one request.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Fate {
    /// The hand does it and answers.
    Answered,
    /// The hand does it, and the answer is lost.
    AnswerLost,
    /// The hand never hears it.
    Unheard,
    /// It ends so, and the hand does nothing.
    Fails(RequestError),
    /// The link holds it back.
    NotSent(NotSent),
    /// The hand takes this for every joint, or for the row, and answers as if nothing were.
    Takes(i16),
    /// The hand does nothing and answers so.
    Verdict(Verdict),
}

type Script = Box<dyn FnMut(&Asked) -> Fate + Send>;

/// What there is of the hand and its link.
pub(crate) struct Facts {
    pub(crate) status: LinkStatus,
    memory: Vec<u8>,
    flash: Vec<u8>,
    pub(crate) asked: Vec<Asked>,
    script: Script,
    records: broadcast::Sender<Record>,
    book: LeaseBook,
}

/// One hand on an open link. Copies are the same hand.
#[derive(Clone)]
pub(crate) struct FakeHand {
    facts: Arc<Mutex<Facts>>,
    pub(crate) clock: Clock,
}

impl FakeHand {
    /// A hand as delivered, watched, at rest, with 100 in all its defaults.
    pub(crate) fn new() -> Self {
        let facts = Facts {
            status: LinkStatus {
                state: LinkState::Monitoring,
                rest: Rest::Resting,
                ..LinkStatus::default()
            },
            memory: vec![0; MEMORY],
            flash: Vec::new(),
            asked: Vec::new(),
            script: Box::new(|_| Fate::Answered),
            records: broadcast::channel(RECORDS).0,
            book: LeaseBook::default(),
        };
        let hand = Self {
            facts: Arc::new(Mutex::new(facts)),
            clock: Clock::start(),
        };
        let mut params = Params::factory();
        for id in ParamId::all() {
            if params.get(id).is_none() {
                params.put(id, Value::Number(100));
            }
        }
        for setting in plan_writes(&params, &Params::default()).settings {
            hand.facts().take(&setting);
        }
        hand.facts().burn();
        hand
    }

    pub(crate) fn facts(&self) -> MutexGuard<'_, Facts> {
        self.facts.lock().unwrap()
    }

    /// From now on this decides what becomes of each request.
    pub(crate) fn script(&self, script: impl FnMut(&Asked) -> Fate + Send + 'static) {
        self.facts().script = Box::new(script);
    }

    /// What was asked since the last call.
    pub(crate) fn asked(&self) -> Vec<Asked> {
        std::mem::take(&mut self.facts().asked)
    }

    /// What it holds in a row.
    pub(crate) fn holds(&self, id: ParamId) -> Option<Value> {
        let facts = self.facts();
        decoded(id, span_of(id), facts.bytes(&facts.memory, span_of(id)))
    }

    /// What it would wake up with.
    pub(crate) fn in_flash(&self, id: ParamId) -> Option<Value> {
        let facts = self.facts();
        decoded(id, span_of(id), facts.bytes(&facts.flash, span_of(id)))
    }

    /// Puts a value into its memory, past everybody.
    pub(crate) fn put(&self, id: ParamId, value: Value) {
        let mut wanted = Params::default();
        wanted.put(id, value);
        for setting in plan_writes(&wanted, &Params::default()).settings {
            self.facts().take(&setting);
        }
    }

    /// Switches it off and on.
    pub(crate) fn power_cycle(&self) {
        let mut facts = self.facts();
        facts.memory = facts.flash.clone();
    }

    /// The user armed it.
    pub(crate) fn arm_as(&self, epoch: u64) {
        let mut facts = self.facts();
        facts.status.state = LinkState::Armed;
        facts.status.armed = Some(ArmEpoch(epoch));
    }

    /// It says this of itself now, on all joints.
    pub(crate) fn says(&self, said: Said) -> HandSample {
        let sample = said.sample(self.clock.now());
        self.tells(sample);
        sample
    }

    /// This was read of it.
    pub(crate) fn tells(&self, sample: HandSample) {
        let usual = [
            Group::Angle,
            Group::Force,
            Group::Status,
            Group::Faults,
            Group::Temperature,
        ];
        let angle_set = sample.angle_set.map(|_| Group::AngleSet);
        let speed_set = sample.speed_set.map(|_| Group::SpeedSet);
        let read_back = angle_set.into_iter().chain(speed_set);
        let fresh = usual.into_iter().chain(read_back).collect();
        let record = Record::Reading {
            sample: Arc::new(sample),
            fresh,
        };
        // Nobody may be listening.
        let _heard = self.facts().records.send(record);
    }

    async fn ask(&self, asked: Asked) -> Fate {
        // A request takes a while, so that no task spins.
        tokio::time::sleep(std::time::Duration::from_millis(5)).await;
        let mut script = {
            let mut facts = self.facts();
            facts.asked.push(asked.clone());
            if !facts.status.state.is_live() {
                return Fate::Fails(RequestError::NotConnected);
            }
            std::mem::replace(&mut facts.script, Box::new(|_| Fate::Answered))
        };
        // A script may look at the hand.
        let fate = script(&asked);
        self.facts().script = script;
        fate
    }

    fn note(&self, asked: Asked) {
        self.facts().asked.push(asked);
    }
}

impl Facts {
    fn bytes<'a>(&self, of: &'a [u8], span: Span) -> &'a [u8] {
        let from = usize::from(span.address);
        &of[from..from + usize::from(span.len)]
    }

    fn take_write(&mut self, write: &RegisterWrite) {
        let from = usize::from(write.address());
        self.memory[from..from + write.bytes().len()].copy_from_slice(write.bytes());
    }

    fn take(&mut self, setting: &Setting) {
        for write in setting.writes() {
            self.take_write(&write);
        }
    }

    fn burn(&mut self) {
        self.flash = self.memory.clone();
    }
}

fn timeout(address: u16) -> RequestError {
    let after_ms = 100;
    RequestError::Timeout { address, after_ms }
}

impl Facts {
    fn disarm(&mut self) {
        self.status.armed = None;
        if self.status.state == LinkState::Armed {
            self.status.state = LinkState::Monitoring;
        }
    }

    fn hold_now(&mut self, at: Moment) {
        self.status.armed = None;
        if self.status.state.is_live() {
            self.status.state = LinkState::Monitoring;
            self.status.hold = Hold::Confirmed { at, rest: at };
        }
    }
}

impl FakeHand {
    /// The session disarms it for this reason.
    pub(crate) fn disarm_for(&self, why: Disarmed) {
        let mut facts = self.facts();
        facts.book.end(why);
        facts.disarm();
        facts.status.disarmed = Some(why);
    }

    fn hold(&self, why: Disarmed) {
        let at = self.clock.now();
        let mut facts = self.facts();
        facts.book.end(why);
        facts.hold_now(at);
    }
}

impl TaskHand for FakeHand {
    fn status(&self) -> LinkStatus {
        self.facts().status.clone()
    }

    fn records(&self) -> Records {
        Records::of(self.facts().records.subscribe())
    }

    async fn read(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        match self.ask(Asked::Read(span)).await {
            Fate::Answered => {
                let facts = self.facts();
                Ok(facts.bytes(&facts.memory, span).to_vec())
            }
            Fate::AnswerLost | Fate::Unheard => Err(timeout(span.address)),
            Fate::Fails(error) => Err(error),
            other => panic!("a read does not end as {other:?}"),
        }
    }

    async fn write(&self, command: HandCommand) -> Result<(), RequestError> {
        panic!("no task here asks for {command:?}")
    }

    async fn set_unread(&self, setting: Setting) -> Result<(), RequestError> {
        let address = setting.span().address;
        match self.ask(Asked::SetUnread(setting)).await {
            Fate::Answered => self.facts().take(&setting),
            Fate::AnswerLost => {
                self.facts().take(&setting);
                return Err(timeout(address));
            }
            Fate::Unheard => return Err(timeout(address)),
            Fate::Fails(error) => return Err(error),
            Fate::Takes(value) => {
                let at = usize::from(address);
                self.facts().memory[at] = u8::try_from(value).unwrap();
            }
            other => panic!("a write does not end as {other:?}"),
        }
        Ok(())
    }

    async fn set_kept(&self, setting: Setting) -> Result<Written, RequestError> {
        let span = setting.span();
        let verdict = match self.ask(Asked::Keep(setting)).await {
            Fate::Answered => {
                self.facts().take(&setting);
                Verdict::Applied
            }
            Fate::Takes(value) => {
                let from = usize::from(span.address);
                let bytes = value.to_le_bytes().repeat(6);
                self.facts().memory[from..from + 12].copy_from_slice(&bytes);
                Verdict::Differs
            }
            Fate::Fails(error) => return Err(error),
            Fate::NotSent(why) => Verdict::NotSent(why),
            Fate::Verdict(verdict) => verdict,
            other => panic!("a setting does not end as {other:?}"),
        };
        let is_read = matches!(
            verdict,
            Verdict::Applied | Verdict::Differs | Verdict::Refused { .. }
        );
        let facts = self.facts();
        let holds = is_read.then(|| facts.bytes(&facts.memory, span).to_vec());
        Ok(Written {
            span,
            verdict,
            holds,
        })
    }

    async fn save(&self) -> Result<Saved, RequestError> {
        match self.ask(Asked::Save).await {
            Fate::Answered => {
                self.facts().burn();
                Ok(Saved::Confirmed)
            }
            Fate::AnswerLost => {
                self.facts().burn();
                Err(RequestError::LinkLost)
            }
            Fate::Unheard => Err(RequestError::LinkLost),
            Fate::NotSent(why) => Ok(Saved::NotSent(why)),
            Fate::Fails(error) => Err(error),
            other => panic!("a SAVE does not end as {other:?}"),
        }
    }

    async fn reset(&self) -> Result<Reset, RequestError> {
        let fate = self.ask(Asked::Reset).await;
        if matches!(fate, Fate::Answered | Fate::AnswerLost) {
            let settings = plan_writes(&Params::factory(), &Params::default()).settings;
            for setting in settings {
                self.facts().take(&setting);
            }
        }
        match fate {
            Fate::Answered => Ok(Reset::Acknowledged),
            Fate::AnswerLost | Fate::Unheard => Ok(Reset::Unanswered),
            Fate::NotSent(why) => Ok(Reset::NotSent(why)),
            Fate::Verdict(Verdict::Refused { reason }) => Ok(Reset::Refused { reason }),
            Fate::Fails(error) => Err(error),
            other => panic!("a reset does not end as {other:?}"),
        }
    }

    async fn calibrate(&self) -> Result<Calibrated, RequestError> {
        match self.ask(Asked::Calibrate).await {
            Fate::Answered => Ok(Calibrated::Finished),
            Fate::NotSent(why) => Ok(Calibrated::NotSent(why)),
            Fate::Fails(error) => Err(error),
            other => panic!("a calibration does not end as {other:?}"),
        }
    }

    fn stop(&self) {
        self.note(Asked::Stop);
        self.hold(Disarmed::Stop);
    }

    fn disarm(&self) {
        self.note(Asked::Disarm);
        let mut facts = self.facts();
        facts.book.end(Disarmed::Person);
        facts.disarm();
    }

    fn grant(&self, owner: Owner) -> Lease {
        self.facts().book.grant(owner)
    }

    fn check(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.facts().book.check(lease)
    }

    fn arm(&self, lease: Lease, request: ArmRequest) -> Result<(), LeaseRefusal> {
        self.check(lease)?;
        self.note(Asked::Arm(request));
        Ok(())
    }

    fn set(&self, lease: Lease, setpoints: &Setpoints) -> Result<(), LeaseRefusal> {
        self.check(lease)?;
        self.note(Asked::Move(*setpoints));
        Ok(())
    }

    fn run_until(&self, lease: Lease, until: Moment) -> Result<(), LeaseRefusal> {
        self.check(lease)?;
        self.note(Asked::RunUntil(until));
        Ok(())
    }

    fn halt(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.check(lease)?;
        self.note(Asked::Stop);
        self.facts().hold_now(self.clock.now());
        Ok(())
    }

    fn rest(&self, lease: Lease) -> Result<(), LeaseRefusal> {
        self.check(lease)?;
        self.note(Asked::Disarm);
        self.facts().disarm();
        Ok(())
    }

    fn give_back(&self, lease: Lease, why: Disarmed) -> Result<(), LeaseRefusal> {
        self.check(lease)?;
        self.note(Asked::Stop);
        self.hold(why);
        Ok(())
    }

    fn read_at(&self, rates: PollRates) {
        self.note(Asked::ReadAt(rates));
    }
}

/// What a hand says of itself, on all joints; each test spoils one thing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Said {
    pub(crate) angle: i16,
    pub(crate) grams: i16,
    pub(crate) celsius: u8,
    pub(crate) faults: u8,
    /// SPEED_SET and FORCE_SET.
    pub(crate) limits: Option<(Speed, crate::hand::Force)>,
}

/// A well hand, open and free.
pub(crate) const WELL: Said = Said {
    angle: 1000,
    grams: 3,
    celsius: 30,
    faults: 0,
    limits: None,
};

impl Said {
    pub(crate) fn sample(self, at: Moment) -> HandSample {
        fn timed<T>(value: T, at: Moment) -> Option<Timed<T>> {
            Some(Timed {
                value,
                asked: at,
                received: at,
            })
        }
        let limits = self.limits;
        HandSample {
            angle: timed(PerDof::splat(AngleReading::new(self.angle)), at),
            force: timed(PerDof::splat(ForceReading::new(self.grams)), at),
            status: timed(PerDof::splat(Status::PositionReached), at),
            faults: timed(PerDof::splat(Faults::from_raw(self.faults)), at),
            temperature: timed(PerDof::splat(TemperatureReading::new(self.celsius)), at),
            speed_set: limits.and_then(|own| timed(PerDof::splat(Some(own.0)), at)),
            force_set: limits.and_then(|own| timed(PerDof::splat(Some(own.1)), at)),
            ..HandSample::default()
        }
    }
}

/// Goes where the hand may be: it is there where `is_there` says so.
pub(crate) struct FakeReach<F> {
    pub(crate) hand: FakeHand,
    pub(crate) is_there: F,
}

impl<F: FnMut(&Endpoint) -> bool + Send> Reach for FakeReach<F> {
    type Link = FakeHand;

    async fn reach(&mut self, place: &Endpoint) -> Option<FakeHand> {
        (self.is_there)(place).then(|| self.hand.clone())
    }
}

/// The write of a row by which a hand is found.
pub(crate) fn place_write(id: ParamId, value: Value) -> Asked {
    Asked::SetUnread(place::setting(id, value).unwrap())
}
