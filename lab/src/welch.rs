//! Whether two means differ by more than chance: Welch's t-test, which allows each side a variance of its own.

use statrs::distribution::{ContinuousCDF as _, StudentsT};

/// Two means of independent samples against each other (B. L. Welch, "The generalization of Student's problem
/// when several different population variances are involved", 1947).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Welch {
    /// The first mean less the second.
    pub difference: f64,
    /// The standard error of that.
    pub error: f64,
    /// Degrees of freedom (Satterthwaite), from 1 on; infinite where neither side varies.
    pub freedom: f64,
    /// How often chance alone puts the means this far apart or farther, where they are equal: 0 to 1.
    pub chance: f64,
}

impl Welch {
    /// Tests two lots of samples; nothing unless each has two or more, all finite.
    #[must_use]
    pub fn test(first: &[f64], second: &[f64]) -> Option<Self> {
        let [first, second] = [Moments::of(first)?, Moments::of(second)?];
        let difference = first.mean - second.mean;
        let square = first.error_square + second.error_square;
        if square <= 0.0 {
            let chance = if difference == 0.0 { 1.0 } else { 0.0 };
            return Some(Self { difference, error: 0.0, freedom: f64::INFINITY, chance });
        }
        // In shares of the whole, so that the square of a tiny variance is not lost.
        let spread = |of: &Moments| (of.error_square / square).powi(2) / of.freedom;
        let freedom = 1.0 / (spread(&first) + spread(&second));
        let error = square.sqrt();
        let distribution = StudentsT::new(0.0, 1.0, freedom).ok()?;
        let chance = (2.0 * distribution.sf((difference / error).abs())).min(1.0);
        Some(Self { difference, error, freedom, chance })
    }

    /// Whether the means differ, where chance may say so falsely in this share of tests.
    #[must_use]
    pub fn differs(&self, level: f64) -> bool {
        self.chance < level
    }
}

/// A mean, the square of its standard error, and how many samples less one.
struct Moments {
    mean: f64,
    error_square: f64,
    freedom: f64,
}

impl Moments {
    fn of(samples: &[f64]) -> Option<Self> {
        if samples.len() < 2 || samples.iter().any(|sample| !sample.is_finite()) {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^52 samples")]
        let count = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / count;
        let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
        Some(Self { mean, error_square: squares / (count - 1.0) / count, freedom: count - 1.0 })
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;

    /// 1, 2, 3 (variance 1) and 4, 6, 8, 10 (variance 20/3): squared errors of 1/3 and 5/3, 2 together.
    #[test]
    fn two_means_by_hand() {
        let test = Welch::test(&[1.0, 2.0, 3.0], &[4.0, 6.0, 8.0, 10.0]).unwrap();
        assert!((test.difference + 5.0).abs() < 1e-12 && (test.error - 2.0_f64.sqrt()).abs() < 1e-12);
        // 4 / (1/9 / 2 + 25/9 / 3) = 72 / 17.5... : (1/18 + 25/27) = 53/54, so 216/53.
        assert!((test.freedom - 216.0 / 53.0).abs() < 1e-9, "{test:?}");
        // t = 3.5355 with 4.08 degrees: between the printed 5 % (2.776) and 1 % (4.604) of 4 degrees.
        assert!(test.chance > 0.01 && test.chance < 0.05, "{test:?}");
        assert!(test.differs(0.05) && !test.differs(0.01));
        let turned = Welch::test(&[4.0, 6.0, 8.0, 10.0], &[1.0, 2.0, 3.0]).unwrap();
        assert!((turned.chance - test.chance).abs() < 1e-12 && (turned.difference - 5.0).abs() < 1e-12);
    }

    /// Two lots of two with one variance: two degrees of freedom, whose distribution has a closed form.
    #[test]
    fn two_degrees_of_freedom_in_closed_form() {
        let test = Welch::test(&[0.0, 2.0], &[3.0, 5.0]).unwrap();
        let t = 3.0 / 2.0_f64.sqrt();
        let chance = 1.0 - t / (t * t + 2.0).sqrt();
        assert!((test.freedom - 2.0).abs() < 1e-12 && (test.chance - chance).abs() < 1e-9, "{test:?}");
    }

    #[test]
    fn what_does_not_vary_and_what_is_too_little() {
        assert!((Welch::test(&[2.0; 3], &[2.0; 4]).unwrap().chance - 1.0).abs() < 1e-15);
        assert!(Welch::test(&[2.0; 3], &[2.5; 4]).unwrap().differs(1e-9));
        assert_eq!(Welch::test(&[2.0], &[2.0, 3.0]), None);
        assert_eq!(Welch::test(&[2.0, f64::NAN], &[2.0, 3.0]), None);
    }

    /// Of tests without a difference, as many are significant as the level says; a planted one is found.
    #[test]
    fn the_level_is_kept_and_a_planted_bias_is_seen() {
        let mut random = Pcg64::seed_from_u64(7);
        // Twelve uniform numbers are close to a normal one, of variance 1 and mean 6.
        let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>();
        let mut share = |bias: f64| {
            let mut found = 0;
            for _ in 0..2000 {
                let first: Vec<f64> = (0..8).map(|_| 3.0 * normal() + bias).collect();
                let second: Vec<f64> = (0..16).map(|_| 3.0 * normal()).collect();
                found += u32::from(Welch::test(&first, &second).unwrap().differs(0.05));
            }
            f64::from(found) / 2000.0
        };
        // 5 % within four standard errors of 0.5 %.
        let (none, planted) = (share(0.0), share(6.0));
        assert!((none - 0.05).abs() < 0.02, "{none}");
        assert!(planted > 0.95, "{planted}");
    }
}
