//! The hand of unit tests: a real link handle, and in place of a session a memory, a flash and a script of failures. Uses no protocol.

use crate::hand::{
    AngleReading, ArmEpoch, Faults, Force, ForceReading, Group, HandSample, Moment, PerDof,
    RegisterWrite, Setpoints, Setting, Span, Speed, Status, TemperatureReading, Timed,
};
use crate::link::handle::channels;
use crate::link::request::Request;
use crate::link::wanted::{PendingControl, SessionChannels};
use crate::link::{ArmRequest, Clock, LinkHandle, LinkStatus, PollRates, RequestError};
use crate::params::changes::plan_writes;
use crate::params::rows::{ParamId, Value};
use crate::params::values::{Params, decoded, span_of};
use crate::record::{
    Calibrated, Disarmed, Hold, LinkState, NotSent, Record, Reset, Rest, Saved, Verdict, Written,
};
use std::ops::Deref;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;
use tokio::sync::{broadcast, mpsc, watch};

/// Bytes of memory: more than any address of a persistent row.
const MEMORY: usize = 4096;
/// Duration of a request, so that no task spins.
const REQUEST_DURATION: Duration = Duration::from_millis(5);

/// A request or an order that the hand received.
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

/// Fate of a request.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Fate {
    /// The hand executes it and replies.
    Answered,
    /// The hand executes it, and the reply is lost.
    AnswerLost,
    /// The hand never receives it.
    Unheard,
    /// The request fails with this error, and the hand does nothing.
    Fails(RequestError),
    /// The link withholds it.
    NotSent(NotSent),
    /// The hand stores this value for every joint, or for the row, and replies as if it had obeyed.
    Takes(i16),
    /// The hand does nothing and replies with this verdict.
    Verdict(Verdict),
}

type Script = Box<dyn FnMut(&Asked) -> Fate + Send>;

/// State of the hand, and the requests that its session received.
pub(crate) struct Facts {
    memory: Vec<u8>,
    flash: Vec<u8>,
    asked: Vec<Asked>,
    runs_until: Option<Moment>,
    script: Script,
}

/// One hand on an open link. Copies are the same hand.
#[derive(Clone)]
pub(crate) struct FakeHand {
    link: LinkHandle,
    facts: Arc<Mutex<Facts>>,
    wanted: Arc<watch::Sender<PendingControl>>,
    status: watch::Sender<LinkStatus>,
    records: broadcast::Sender<Record>,
    pub(crate) clock: Clock,
}

/// Passes on everything that a handle requests, as a session receives it.
pub(crate) async fn each_control(
    wanted: Arc<watch::Sender<PendingControl>>,
    obey: impl Fn(PendingControl),
) {
    let mut news = wanted.subscribe();
    while news.changed().await.is_ok() {
        let mut control = PendingControl::default();
        wanted.send_if_modified(|wanted| {
            control = wanted.take();
            false
        });
        obey(control);
    }
}

impl Deref for FakeHand {
    type Target = LinkHandle;

    fn deref(&self) -> &LinkHandle {
        &self.link
    }
}

impl FakeHand {
    /// A hand as delivered, monitored, at rest, with 100 in all its defaults. Must be called within a tokio runtime.
    pub(crate) fn new() -> Self {
        let clock = Clock::start();
        let (link, ends, _) = channels(clock);
        let SessionChannels {
            wanted,
            requests,
            records,
            status,
            ..
        } = ends;
        let facts = Facts {
            memory: vec![0; MEMORY],
            flash: Vec::new(),
            asked: Vec::new(),
            runs_until: None,
            script: Box::new(|_| Fate::Answered),
        };
        let hand = Self {
            link,
            facts: Arc::new(Mutex::new(facts)),
            wanted,
            status,
            records,
            clock,
        };
        hand.change(|status| {
            status.state = LinkState::Monitoring;
            status.rest = Rest::Resting;
        });
        let session = hand.clone();
        let wanted = Arc::clone(&hand.wanted);
        tokio::spawn(each_control(wanted, move |control| session.obey(control)));
        tokio::spawn(hand.clone().serve_all(requests));
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

    fn facts(&self) -> MutexGuard<'_, Facts> {
        self.facts.lock().unwrap()
    }

    /// Publishes a changed status, as the session does.
    pub(crate) fn change(&self, change: impl FnOnce(&mut LinkStatus)) {
        self.status.send_modify(change);
    }

    /// Sets the script that decides the fate of each request from now on.
    pub(crate) fn script(&self, script: impl FnMut(&Asked) -> Fate + Send + 'static) {
        self.facts().script = Box::new(script);
    }

    /// Requests since the last call.
    pub(crate) fn asked(&self) -> Vec<Asked> {
        std::mem::take(&mut self.facts().asked)
    }

    /// The newest setpoints since [`Self::asked`] was called.
    pub(crate) fn last_move(&self) -> Option<Setpoints> {
        let facts = self.facts();
        facts.asked.iter().rev().find_map(|asked| match asked {
            Asked::Move(setpoints) => Some(*setpoints),
            _ => None,
        })
    }

    /// Value of a row in memory.
    pub(crate) fn holds(&self, id: ParamId) -> Option<Value> {
        let facts = self.facts();
        decoded(id, span_of(id), facts.bytes(&facts.memory, span_of(id)))
    }

    /// Value of a row in flash, which a power cycle restores.
    pub(crate) fn in_flash(&self, id: ParamId) -> Option<Value> {
        let facts = self.facts();
        decoded(id, span_of(id), facts.bytes(&facts.flash, span_of(id)))
    }

    /// Puts a value directly into memory.
    pub(crate) fn put(&self, id: ParamId, value: Value) {
        let mut wanted = Params::default();
        wanted.put(id, value);
        for setting in plan_writes(&wanted, &Params::default()).settings {
            self.facts().take(&setting);
        }
    }

    /// Switches the hand off and on.
    pub(crate) fn power_cycle(&self) {
        let mut facts = self.facts();
        facts.memory = facts.flash.clone();
    }

    /// Arms the hand, as the user does.
    pub(crate) fn arm_as(&self, epoch: u64) {
        self.change(|status| {
            status.state = LinkState::Armed;
            status.armed = Some(ArmEpoch(epoch));
        });
    }

    /// Disarms the hand for this reason, as the session does.
    pub(crate) fn disarm_for(&self, why: Disarmed) {
        self.wanted.send_modify(|wanted| wanted.book.end(why));
        self.disarmed();
        self.change(|status| status.disarmed = Some(why));
    }

    /// Publishes a reading with these values, and returns it.
    pub(crate) fn says(&self, said: Said) -> HandSample {
        let sample = said.sample(self.clock.now());
        self.tells(sample);
        sample
    }

    /// Publishes a reading.
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
        // There may be no reader.
        let _heard = self.records.send(record);
    }

    fn disarmed(&self) {
        self.change(|status| {
            status.armed = None;
            if status.state == LinkState::Armed {
                status.state = LinkState::Monitoring;
            }
        });
    }

    fn held(&self) {
        let at = self.clock.now();
        self.change(|status| {
            status.armed = None;
            if status.state.is_live() {
                status.state = LinkState::Monitoring;
                status.hold = Hold::Confirmed { at, rest: at };
            }
        });
    }

    fn obey(&self, control: PendingControl) {
        if control.stop {
            self.note(Asked::Stop);
            self.held();
        } else if control.disarm {
            self.note(Asked::Disarm);
            self.disarmed();
        }
        if let Some(rates) = control.rates {
            self.note(Asked::ReadAt(rates));
        }
        let before = std::mem::replace(&mut self.facts().runs_until, control.runs_until);
        if let Some(until) = control.runs_until.filter(|until| before != Some(*until)) {
            self.note(Asked::RunUntil(until));
        }
        if let Some(arm) = control.arm {
            self.note(Asked::Arm(arm.request));
        }
        if let Some(setpoints) = control.setpoints {
            self.note(Asked::Move(setpoints));
        }
    }

    fn note(&self, asked: Asked) {
        self.facts().asked.push(asked);
    }

    async fn serve_all(self, mut requests: mpsc::Receiver<Request>) {
        while let Some(request) = requests.recv().await {
            tokio::time::sleep(REQUEST_DURATION).await;
            // The task that sent it may be gone.
            let _heard = match request {
                Request::Read(span, answer) => answer.send(self.read_now(span)).is_ok(),
                Request::Set(setting, answer) => answer.send(self.set_now(setting)).is_ok(),
                Request::SetUnread(setting, answer) => {
                    answer.send(self.set_unread_now(setting)).is_ok()
                }
                Request::Save(answer) => answer.send(self.save_now()).is_ok(),
                Request::Reset(answer) => answer.send(self.reset_now()).is_ok(),
                Request::Calibrate(answer) => answer.send(self.calibrate_now()).is_ok(),
                Request::Command(command, ..) => panic!("no task here asks for {command:?}"),
            };
        }
    }

    fn ask(&self, asked: Asked) -> Fate {
        let mut script = {
            let mut facts = self.facts();
            facts.asked.push(asked.clone());
            if !self.status().state.is_live() {
                return Fate::Fails(RequestError::NotConnected);
            }
            std::mem::replace(&mut facts.script, Box::new(|_| Fate::Answered))
        };
        // A script may inspect the hand.
        let fate = script(&asked);
        self.facts().script = script;
        fate
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

impl FakeHand {
    fn read_now(&self, span: Span) -> Result<Vec<u8>, RequestError> {
        match self.ask(Asked::Read(span)) {
            Fate::Answered => {
                let facts = self.facts();
                Ok(facts.bytes(&facts.memory, span).to_vec())
            }
            Fate::AnswerLost | Fate::Unheard => Err(timeout(span.address)),
            Fate::Fails(error) => Err(error),
            other => panic!("a read does not end as {other:?}"),
        }
    }

    fn set_unread_now(&self, setting: Setting) -> Result<(), RequestError> {
        let address = setting.span().address;
        match self.ask(Asked::SetUnread(setting)) {
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

    fn set_now(&self, setting: Setting) -> Result<Written, RequestError> {
        let span = setting.span();
        let verdict = match self.ask(Asked::Keep(setting)) {
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

    fn save_now(&self) -> Result<Saved, RequestError> {
        match self.ask(Asked::Save) {
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

    fn reset_now(&self) -> Result<Reset, RequestError> {
        let fate = self.ask(Asked::Reset);
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

    fn calibrate_now(&self) -> Result<Calibrated, RequestError> {
        match self.ask(Asked::Calibrate) {
            Fate::Answered => Ok(Calibrated::Finished),
            Fate::NotSent(why) => Ok(Calibrated::NotSent(why)),
            Fate::Fails(error) => Err(error),
            other => panic!("a calibration does not end as {other:?}"),
        }
    }
}

/// Readings of a hand, equal for all joints; each test changes one of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Said {
    pub(crate) angle: i16,
    pub(crate) grams: i16,
    pub(crate) celsius: u8,
    pub(crate) faults: u8,
    /// SPEED_SET and FORCE_SET.
    pub(crate) limits: Option<(Speed, Force)>,
}

/// A healthy hand, open and free.
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
