//! Intake of lines of one stream, from any sender: one sender at a time, in order, counted. Pure.

use crate::hand::Moment;
use crate::hand::kinematics::Side;
use crate::inputs::line::{LineField, LineRefusal, StreamLine, StreamLineFault};
use crate::inputs::offer::END_TIMEOUT;
use crate::link::stats::EventRate;
use std::collections::BTreeMap;
use std::net::SocketAddr;

/// Statistics of one stream.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct IntakeView {
    /// Current sender, and the time of its last line.
    pub sender: Option<(SocketAddr, Moment)>,
    /// Lines per second.
    pub rate_hz: f64,
    /// Accepted lines.
    pub taken: u64,
    /// Refused lines, by reason.
    pub refused: BTreeMap<StreamLineFault, u64>,
    /// Last refusal, with the field.
    pub last_refused: Option<LineRefusal>,
    /// Time of the last refusal.
    pub refused_at: Option<Moment>,
    /// Lines that stopped the hand or released the dead-man although something else in them was wrong.
    pub odd_stops: u64,
    /// The last of them: its sender, and the error.
    pub last_odd: Option<(SocketAddr, LineRefusal)>,
}

/// Accepts or refuses lines.
#[derive(Debug)]
pub struct Intake {
    side: Side,
    view: IntakeView,
    seq: Option<f64>,
    rate: EventRate,
}

impl Intake {
    /// Creates the intake for the hand of this side.
    pub fn new(side: Side) -> Self {
        Self {
            side,
            view: IntakeView::default(),
            seq: None,
            rate: EventRate::default(),
        }
    }

    /// Accepts or refuses a line of a sender. A stop is accepted from any sender.
    ///
    /// # Errors
    /// [`LineRefusal`], the reason; it is counted.
    pub fn accept(
        &mut self,
        line: &[u8],
        from: SocketAddr,
        now: Moment,
    ) -> Result<StreamLine, LineRefusal> {
        self.accept_parsed(StreamLine::parse(line, self.side), from, now)
    }

    /// Like [`Self::accept`], for a line that is already parsed.
    ///
    /// # Errors
    /// [`LineRefusal`], the reason; it is counted.
    pub fn accept_parsed(
        &mut self,
        line: Result<StreamLine, LineRefusal>,
        from: SocketAddr,
        now: Moment,
    ) -> Result<StreamLine, LineRefusal> {
        let taken = line.and_then(|line| self.in_turn(&line, from, now).map(|()| line));
        match &taken {
            Ok(line) => {
                self.view.taken += 1;
                self.rate.hit(now);
                if let Some(odd) = line.odd {
                    self.view.odd_stops += 1;
                    self.view.last_odd = Some((from, odd));
                }
            }
            Err(refusal) => {
                *self.view.refused.entry(refusal.fault).or_default() += 1;
                self.view.last_refused = Some(*refusal);
                self.view.refused_at = Some(now);
            }
        }
        taken
    }

    fn in_turn(
        &mut self,
        line: &StreamLine,
        from: SocketAddr,
        now: Moment,
    ) -> Result<(), LineRefusal> {
        if line.stop {
            return Ok(());
        }
        if let Some((sender, last)) = self.view.sender
            && now.since(last) < END_TIMEOUT
        {
            if sender != from {
                return Err(StreamLineFault::OtherSender.into());
            }
            if self.seq.is_some() && line.seq.is_some() && line.seq <= self.seq {
                return Err(StreamLineFault::Late.of(LineField::Seq));
            }
        }
        self.seq = line.seq;
        self.view.sender = Some((from, now));
        Ok(())
    }

    /// Statistics as of `now`.
    pub fn view(&mut self, now: Moment) -> &IntakeView {
        self.view.rate_hz = self.rate.hz(now);
        &self.view
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Moment {
        Moment::from_micros(ms * 1000)
    }

    fn peer(port: u16) -> SocketAddr {
        ([127, 0, 0, 1], port).into()
    }

    const LINE: &[u8] = br#"{"right":[1,1,1,1,1,1]}"#;

    fn numbered(seq: u64) -> Vec<u8> {
        format!(r#"{{"seq":{seq},"right":[1,1,1,1,1,1]}}"#).into_bytes()
    }

    #[test]
    fn one_sender_is_listened_to_until_it_is_silent() {
        let mut intake = Intake::new(Side::Right);
        assert!(intake.accept(LINE, peer(1), at(0)).is_ok());
        assert_eq!(
            intake.accept(LINE, peer(2), at(999)),
            Err(StreamLineFault::OtherSender.into())
        );
        let stop = intake.accept(br#"{"stop":true}"#, peer(2), at(999));
        assert!(stop.is_ok_and(|line| line.stop), "a stop passes");
        assert!(intake.accept(LINE, peer(2), at(1000)).is_ok());
        assert_eq!(
            intake.accept(LINE, peer(1), at(1001)),
            Err(StreamLineFault::OtherSender.into())
        );
        assert_eq!(
            intake.view(at(1001)).refused[&StreamLineFault::OtherSender],
            2
        );
    }

    #[test]
    fn late_and_doubled_lines_are_refused_and_a_sender_that_begins_anew_is_not() {
        let mut intake = Intake::new(Side::Right);
        for (seq, ms, taken) in [
            (5, 0, true),
            (5, 10, false),
            (4, 20, false),
            (7, 30, true),
            (6, 40, false),
            (1, 1030, true),
        ] {
            let result = intake.accept(&numbered(seq), peer(1), at(ms));
            assert_eq!(result.is_ok(), taken, "{seq} at {ms}");
        }
        assert_eq!(intake.view(at(1030)).refused[&StreamLineFault::Late], 3);
    }

    #[test]
    fn an_odd_stop_is_obeyed_and_told_with_its_sender() {
        let mut intake = Intake::new(Side::Right);
        intake.accept(LINE, peer(1), at(0)).unwrap();
        let odd = br#"{"stop":true,"right":[NaN,1,1,1,1,1]}"#;
        assert!(intake.accept(odd, peer(2), at(5)).unwrap().stop);
        let view = intake.view(at(5));
        assert_eq!((view.taken, view.odd_stops), (2, 1));
        let (from, why) = view.last_odd.unwrap();
        assert_eq!((from, why.fault), (peer(2), StreamLineFault::NotFinite));
        assert!(view.refused.is_empty());
    }

    #[test]
    fn the_rate_is_that_of_the_last_second() {
        let mut intake = Intake::new(Side::Right);
        for n in 0..300 {
            intake.accept(LINE, peer(1), at(n * 5)).unwrap();
        }
        let rate = intake.view(at(1500)).rate_hz;
        assert!((rate - 200.0).abs() < 1.0, "{rate}");
        assert!(intake.view(at(2600)).rate_hz.abs() < 0.1);
    }
}
