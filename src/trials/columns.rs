//! The columns of all tables of trials: one list for the window, the report and the command line.

use crate::trials::measure::metrics::JointMetrics;

/// A quantity of one joint in one trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Metric {
    /// Highest force minus the threshold.
    Overshoot,
    /// Highest force.
    Peak,
    /// Force at the end of the dwell.
    Steady,
    /// From the command to the contact, by force.
    Contact,
    /// From the command to the contact, by touch.
    Touch,
    /// From the contact to the steady force.
    Settle,
    /// From the command to the start of motion.
    DeadTime,
    /// Loss from peak to steady force.
    Relaxation,
    /// Slips during the dwell.
    Slips,
    /// Highest current.
    Current,
    /// Rise of the temperature.
    Heat,
    /// Force readings per second.
    Rate,
}

#[derive(Debug, Clone, Copy)]
pub struct TrialColumn {
    pub metric: Metric,
    pub name: &'static str,
    /// Its word in the trial line of the command line; `None` if it is not part of that line.
    pub word: Option<&'static str>,
    /// Its unit; empty for a count.
    pub unit: &'static str,
    /// Decimal places.
    pub decimals: usize,
    /// Reads it from the metrics.
    pub value: fn(&JointMetrics) -> Option<f64>,
}

const MS_PER_S: f64 = 1000.0;
const GRAMS: &str = "g";
const NEWTON_DECIMALS: usize = 1;

/// All columns, in the order in which tables show them.
pub static COLUMNS: [TrialColumn; 12] = [
    column(Metric::Overshoot, "Overshoot", |own| own.overshoot_g)
        .unit(GRAMS, 0)
        .word("overshoot"),
    column(Metric::Peak, "Peak", |own| own.peak_force_g)
        .unit(GRAMS, 0)
        .word("peak"),
    column(Metric::Steady, "Steady", |own| own.steady_force_g)
        .unit(GRAMS, 0)
        .word("steady"),
    column(Metric::Contact, "To contact", |own| own.time_to_contact_s)
        .unit("s", 3)
        .word("contact"),
    column(Metric::Touch, "To touch", |own| own.time_to_touch_s).unit("s", 3),
    column(Metric::Settle, "Settles", |own| own.settle_time_s).unit("s", 2),
    column(Metric::DeadTime, "Dead time", |own| {
        own.dead_time_s.map(|time_s| time_s * MS_PER_S)
    })
    .unit("ms", 0)
    .word("dead time"),
    column(Metric::Relaxation, "Relaxes", |own| own.relaxation_g).unit(GRAMS, 0),
    column(Metric::Slips, "Slips", |own| {
        let count = own.slip_count.and_then(|count| u32::try_from(count).ok());
        count.map(f64::from)
    }),
    column(Metric::Current, "Current", |own| own.peak_current_ma).unit("mA", 0),
    column(Metric::Heat, "Warmer", |own| own.temperature_rise_c).unit("°C", 0),
    column(Metric::Rate, "Reads/s", |own| own.rate_hz),
];

const fn column(
    metric: Metric,
    name: &'static str,
    value: fn(&JointMetrics) -> Option<f64>,
) -> TrialColumn {
    TrialColumn {
        metric,
        name,
        word: None,
        unit: "",
        decimals: 0,
        value,
    }
}

impl TrialColumn {
    const fn unit(self, unit: &'static str, decimals: usize) -> Self {
        Self {
            unit,
            decimals,
            ..self
        }
    }

    const fn word(self, word: &'static str) -> Self {
        Self {
            word: Some(word),
            ..self
        }
    }

    /// Name and unit.
    pub fn title(&self) -> String {
        match self.unit {
            "" => self.name.to_owned(),
            unit => format!("{}, {unit}", self.name),
        }
    }

    /// The value, or "-"; with a trailing "+" if the peak may have been higher than any reading.
    pub fn text(&self, joint: &JointMetrics) -> String {
        self.doubted(joint, number((self.value)(joint), self.decimals))
    }

    /// A force in newtons, at these newtons for a gram; `None` if it is no force, or unknown.
    pub fn newtons(&self, joint: &JointMetrics, per_g: Option<f64>) -> Option<f64> {
        let grams = (self.value)(joint).filter(|_| self.unit == GRAMS)?;
        Some(grams * per_g?)
    }

    /// The same as text, as [`text`](Self::text).
    pub fn newtons_text(&self, joint: &JointMetrics, per_g: Option<f64>) -> String {
        self.doubted(joint, number(self.newtons(joint, per_g), NEWTON_DECIMALS))
    }

    fn doubted(&self, joint: &JointMetrics, text: String) -> String {
        let is_of_peak = matches!(self.metric, Metric::Peak | Metric::Overshoot);
        if is_of_peak && joint.peak_doubt.is_some() {
            return format!("{text}+");
        }
        text
    }
}

/// A number with this many decimals, or "-".
pub fn number(value: Option<f64>, decimals: usize) -> String {
    // Adding zero removes the sign of a negative zero.
    value.map_or_else(
        || "-".to_owned(),
        |value| format!("{:.decimals$}", value + 0.0),
    )
}
