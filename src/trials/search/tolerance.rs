//! One-sided tolerance factors: the distance of a bound from the mean, so that it holds for a share of all closes. Pure.

/// A statement about future closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assurance {
    /// Share of all closes that stay within the bound, 0..1.
    pub coverage: f64,
    /// Confidence in that share, 0..1.
    pub confidence: f64,
}

impl Assurance {
    /// 95 of 100 closes, with 95 % confidence.
    pub const USUAL: Self = Self {
        coverage: 0.95,
        confidence: 0.95,
    };

    /// The statement that the largest of this many closes supports, for any distribution: 59 closes for [`Self::USUAL`], 22 for 90 of
    /// 100 with 90 %. `None` for fewer.
    pub const fn distribution_free(closes: usize) -> Option<Self> {
        match closes {
            0..FREE_90 => None,
            FREE_90..FREE_95 => Some(Self {
                coverage: 0.9,
                confidence: 0.9,
            }),
            _ => Some(Self::USUAL),
        }
    }
}

/// Closes for 90/90 and 95/95 without a distribution: the smallest n with `1 - coverage^n >= confidence`.
pub const FREE_90: usize = 22;
pub const FREE_95: usize = 59;

/// Steps of the integration, and of the bisection.
const STEPS: u32 = 400;
const HALVINGS: u32 = 60;

/// The factor k for which the mean plus k standard deviations of `closes` values is a bound, if they are normally distributed.
/// `None` for fewer than 2.
///
/// The mean of n values is normally distributed, their standard deviation as the root of a chi-square: k is chosen so that the share
/// of samples with a sufficient bound is the confidence (the non-central t distribution, integrated over the standard deviation).
pub fn tolerance_factor(closes: usize, assurance: Assurance) -> Option<f64> {
    let n = f64::from(u32::try_from(closes).ok().filter(|n| *n >= 2)?);
    let beyond = root(|z| normal_below(z) - assurance.coverage, (-8.0, 8.0));
    let share = |k: f64| share_within(n, |u| normal_below(n.sqrt() * (k * u - beyond)));
    Some(root(|k| share(k) - assurance.confidence, (0.0, 100.0)))
}

/// The mean of `within` over the standard deviations of samples of size `n`, in units of the true one.
fn share_within(n: f64, within: impl Fn(f64) -> f64) -> f64 {
    let freedom = n - 1.0;
    let half_width = 9.0 / (2.0 * freedom).sqrt();
    let (least, most) = ((1.0 - half_width).max(1e-9), 1.0 + half_width);
    let step = (most - least) / f64::from(STEPS);
    let (mut whole, mut part) = (0.0, 0.0);
    for at in 0..=STEPS {
        let u = least + step * f64::from(at);
        // The density without its constant, which cancels.
        let log = (freedom - 1.0) * u.ln() - freedom * (u * u - 1.0) / 2.0;
        let edge = if at == 0 || at == STEPS { 0.5 } else { 1.0 };
        let density = edge * log.exp();
        whole += density;
        part += density * within(u);
    }
    part / whole
}

/// The root of an increasing function, by bisection.
fn root(rises: impl Fn(f64) -> f64, within: (f64, f64)) -> f64 {
    let (mut low, mut high) = within;
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if rises(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    f64::midpoint(low, high)
}

/// Share of a standard normal distribution below `z`, within 1e-7 (Abramowitz and Stegun 26.2.17).
fn normal_below(z: f64) -> f64 {
    const WEIGHTS: [f64; 5] = [
        0.319_381_530,
        -0.356_563_782,
        1.781_477_937,
        -1.821_255_978,
        1.330_274_429,
    ];
    let t = 1.0 / (1.0 + 0.231_641_9 * z.abs());
    let series = WEIGHTS.iter().rev().fold(0.0, |sum, own| (sum + own) * t);
    let above = series * (-z * z / 2.0).exp() / std::f64::consts::TAU.sqrt();
    if z < 0.0 { above } else { 1.0 - above }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_are_those_of_the_tables() {
        for (closes, factor) in [(5, 4.20), (8, 3.19), (10, 2.91), (15, 2.56), (20, 2.39)] {
            let own = tolerance_factor(closes, Assurance::USUAL).unwrap();
            assert!((own - factor).abs() < 0.015, "{closes}: {own}");
        }
        let many = tolerance_factor(100_000, Assurance::USUAL).unwrap();
        assert!((many - 1.645).abs() < 0.02, "{many}");
        assert_eq!(tolerance_factor(1, Assurance::USUAL), None);
    }

    #[test]
    fn without_a_distribution_59_closes_are_needed_and_22_say_less() {
        for (closes, share) in [(FREE_95, 0.95_f64), (FREE_90, 0.9)] {
            let sure = |closes: usize| 1.0 - share.powi(i32::try_from(closes).unwrap());
            assert!(sure(closes) >= share && sure(closes - 1) < share);
            let said = Assurance::distribution_free(closes).unwrap();
            assert_eq!((said.coverage, said.confidence), (share, share));
        }
        assert_eq!(Assurance::distribution_free(21), None);
    }
}
