//! Definitions of the plots: the curves of each, and its scale. Draws nothing.

use crate::app::settings::PlotKind;
use crate::hand::{Dof, Finger, PerDof, Quantity, QuantityRow, Touch};
use crate::history::Series;
use crate::ui::text::{Text, panels};

/// One of the stacked plots.
#[derive(Debug)]
pub(crate) struct Panel {
    /// Key in the settings.
    pub(crate) kind: PlotKind,
    /// Title with unit.
    pub(crate) title: Text,
    /// Title of the sparkline.
    pub(crate) short: Text,
    /// Decimals and scale.
    pub(crate) row: &'static QuantityRow,
}

/// All plots, from top to bottom.
pub(crate) const PANELS: [Panel; 6] = [
    Panel {
        kind: PlotKind::Force,
        title: panels::PLOT_FORCE,
        short: panels::SHORT_FORCE,
        row: Quantity::Force.row(),
    },
    Panel {
        kind: PlotKind::Normal,
        title: panels::NORMAL,
        short: panels::SHORT_NORMAL,
        row: Touch::Normal.row(),
    },
    Panel {
        kind: PlotKind::Tangential,
        title: panels::TANGENTIAL,
        short: panels::SHORT_TANGENTIAL,
        row: Touch::Tangential.row(),
    },
    Panel {
        kind: PlotKind::Current,
        title: panels::PLOT_CURRENT,
        short: panels::SHORT_CURRENT,
        row: Quantity::Current.row(),
    },
    Panel {
        kind: PlotKind::Temperature,
        title: panels::PLOT_TEMPERATURE,
        short: panels::SHORT_TEMPERATURE,
        row: Quantity::Temperature.row(),
    },
    Panel {
        kind: PlotKind::Angle,
        title: panels::PLOT_ANGLE,
        short: panels::SHORT_ANGLE,
        row: Quantity::Angle.row(),
    },
];

/// One curve of a plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PanelLine {
    /// Source of its points.
    pub(crate) series: Series,
    /// Joint that gives it its colour.
    pub(crate) dof: Dof,
    /// True for setpoints, as opposed to measurements.
    pub(crate) wished: bool,
}

impl Panel {
    /// Curves of all joints that are not hidden, setpoints first so that they are drawn under the measurements.
    pub(crate) fn lines(&self, hidden: &PerDof<bool>) -> Vec<PanelLine> {
        let joint = |quantity| {
            Dof::ALL.into_iter().map(move |dof| PanelLine {
                series: Series::Joint(quantity, dof),
                dof,
                wished: quantity == Quantity::TargetAngle,
            })
        };
        let tip = |touch| {
            Finger::ALL.into_iter().map(move |finger| PanelLine {
                series: Series::Tip(touch, finger),
                dof: finger.bend(),
                wished: false,
            })
        };
        let all: Vec<PanelLine> = match self.kind {
            PlotKind::Force => joint(Quantity::Force).collect(),
            PlotKind::Normal => tip(Touch::Normal).collect(),
            PlotKind::Tangential => tip(Touch::Tangential).collect(),
            PlotKind::Current => joint(Quantity::Current).collect(),
            PlotKind::Temperature => joint(Quantity::Temperature).collect(),
            PlotKind::Angle => joint(Quantity::TargetAngle)
                .chain(joint(Quantity::Angle))
                .collect(),
        };
        all.into_iter().filter(|line| !hidden[line.dof]).collect()
    }

    /// Measured curves only: those with figures.
    pub(crate) fn measured(&self, hidden: &PerDof<bool>) -> Vec<PanelLine> {
        let lines = self.lines(hidden).into_iter();
        lines.filter(|line| !line.wished).collect()
    }
}
