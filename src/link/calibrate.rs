//! A calibration of the force sensors on the wire: sent once, then the line is left to the hand until its frame comes or it must
//! be over. A stop passes meanwhile; nothing else that moves does.

use crate::hand::{HandCommand, Moment};
use crate::link::bus::{Bus, BusError};
use crate::link::session::{End, Session};
use crate::link::settled::{Calibrated, SaveDoubt};
use std::time::Duration;

/// From the request until it is over without a word (manual 2.6.6: about six seconds).
pub(crate) const QUIET_FOR: Duration = Duration::from_secs(8);

/// How far it is.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Calibrating {
    /// When it was sent.
    pub(crate) sent: Option<Moment>,
    is_acknowledged: bool,
}

impl Session {
    pub(crate) async fn settle_calibration(
        &mut self,
        bus: &mut Bus,
        mut run: Calibrating,
    ) -> Result<(), End> {
        let now = self.now();
        let Some(sent) = run.sent else {
            // What came until now is of an earlier one.
            let _earlier = bus.take_calibration_end();
            run.sent = Some(now);
            self.keep_calibrating(run);
            return match self.trigger(bus, &HandCommand::CalibrateForce).await {
                Ok(()) => {
                    run.is_acknowledged = true;
                    self.keep_calibrating(run);
                    Ok(())
                }
                Err(BusError::Refused { reason }) => {
                    self.calibrated(Calibrated::Refused { reason });
                    Ok(())
                }
                Err(BusError::Lost(error)) => Err(End::Lost(error.into())),
                // A hand that measures may be mute: that is no silence to be counted.
                Err(_) => Ok(()),
            };
        };
        let over = sent.plus(QUIET_FOR);
        if bus.take_calibration_end() {
            self.calibrated(Calibrated::Finished);
        } else if now < over {
            self.listen(bus, over).await?;
        } else if run.is_acknowledged {
            self.calibrated(Calibrated::Quiet);
        } else {
            let why = SaveDoubt::Unanswered;
            self.calibrated(Calibrated::Unknown { why });
        }
        Ok(())
    }
}
