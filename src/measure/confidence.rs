//! A mean of few samples, and how far the truth may be from it.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF as _, StudentsT};

/// A mean and half the length of the interval around it that holds the true mean with a confidence of 95 %, by Student's t.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// The mean of the samples.
    pub mean: f64,
    /// Half the length; 0 for a single sample, which tells nothing of it.
    pub half_width: f64,
}

impl Interval {
    /// Of independent samples that are distributed much as a normal variable.
    ///
    /// # Panics
    /// Without a sample.
    #[must_use]
    pub fn of(samples: &[f64]) -> Self {
        assert!(!samples.is_empty(), "a mean of some samples");
        #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^53 samples")]
        let count = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / count;
        if samples.len() == 1 {
            return Self { mean, half_width: 0.0 };
        }
        let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        let t =
            StudentsT::new(0.0, 1.0, count - 1.0).expect("at least one degree of freedom").inverse_cdf(0.975);
        Self { mean, half_width: t * deviation / count.sqrt() }
    }
}
