//! Rounding made visible: the data of a computation times fixed pseudo-random factors 1 + η r, |r| ≤ 1.
//!
//! What the factors change, divided by η, is what rounding errors of relative size one would change to first order;
//! sums that cancel included, for their terms are changed one by one.

/// A sequence of factors; the same for the same draw.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    seed: u64,
}

impl Noise {
    /// η: small enough for effects to be linear, and some 450 times the machine's precision, so that the rounding of
    /// the computation itself changes its effect by a part in a hundred.
    pub const SIZE: f64 = 1e-13;

    /// One of the sequences.
    pub fn new(draw: u64) -> Self {
        Noise {
            seed: scrambled(draw.wrapping_add(1)),
        }
    }

    /// An independent sequence for one array of data.
    pub fn stream(self, name: u64) -> Self {
        Noise {
            seed: scrambled(self.seed ^ scrambled(name)),
        }
    }

    /// 1 + η r with r of the entry `index`, uniform in [−1, 1].
    pub fn factor(self, index: usize) -> f64 {
        let bits = scrambled(self.seed ^ index as u64) >> 11;
        let r = 2.0 * (bits as f64) / (1_u64 << 53) as f64 - 1.0;
        1.0 + Self::SIZE * r
    }

    /// Multiplies every entry by its factor.
    pub fn disturb(self, values: &mut [f64]) {
        for (index, value) in values.iter_mut().enumerate() {
            *value *= self.factor(index);
        }
    }
}

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014).
fn scrambled(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::Noise;

    #[test]
    fn factors_are_spread_evenly() {
        let noise = Noise::new(0).stream(3);
        let r: Vec<f64> = (0..4000)
            .map(|i| (noise.factor(i) - 1.0) / Noise::SIZE)
            .collect();
        let mean = r.iter().sum::<f64>() / 4000.0;
        let square = r.iter().map(|r| r * r).sum::<f64>() / 4000.0;
        assert!(
            mean.abs() < 0.05 && (square - 1.0 / 3.0).abs() < 0.02,
            "{mean} {square}"
        );
        assert!(Noise::new(1).factor(7) != Noise::new(2).factor(7));
    }
}
