//! The same problem with its data changed by relative noise: what rounding does to results.

use super::linear::LinearProblem;
use super::{Direct, Problem};
use crate::model::{Id, Jet};
use crate::numerics::Noise;
use std::sync::{Arc, OnceLock};

/// Names of the streams of noise.
const TERMS: u64 = 1;
const WALLS: u64 = 2;
const PRODUCTS: u64 = 3;
const JETS: u64 = 4;

impl Problem {
    /// Every coefficient of L, M0, N2, N3 and the boundary conditions at every point, and every entry of the
    /// differentiation matrices, times a factor of the noise. Terms that cancel are changed one by one, as rounding
    /// changes them. The separately discretised adjoint is not disturbed.
    pub fn disturbed(&self, noise: Noise) -> Problem {
        let products = noise.stream(PRODUCTS);
        Problem {
            base: self.base.clone(),
            resolution: self.resolution,
            direct: self.direct.disturbed(noise),
            adjoint: OnceLock::new(),
            borders: self.borders.clone(),
            nonlinear: self.nonlinear.map(|points| {
                let mut points = points.as_ref().clone();
                for (index, coefficients) in points.iter_mut().enumerate() {
                    products.stream(index as u64).disturb(coefficients);
                }
                Arc::new(points)
            }),
            gram: self.gram.clone(),
            noise: Some(noise),
        }
    }

    /// Multiplies the values of a jet at all points by the factors of the noise, where there is noise.
    pub fn disturb_jet(&self, jet: Jet, values: &mut [crate::model::C64]) {
        let Some(noise) = self.noise else {
            return;
        };
        let orders = [jet.x, jet.absx, jet.y, jet.t].map(u64::from);
        let name = orders
            .iter()
            .fold(jet.of.index() as u64, |sum, order| 16 * sum + order);
        let noise = noise.stream(JETS).stream(name);
        for (index, value) in values.iter_mut().enumerate() {
            *value *= noise.factor(index);
        }
    }
}

impl Direct {
    /// Every coefficient at every point, and every entry of the differentiation matrices, times a factor of the noise.
    pub fn disturbed(&self, noise: Noise) -> Direct {
        let mut terms = self.terms.clone();
        for (index, term) in terms.iter_mut().enumerate() {
            let noise = noise.stream(TERMS).stream(index as u64);
            noise.disturb(&mut term.coefficients);
        }
        let mut walls = self.walls.clone();
        for (index, wall) in walls.iter_mut().enumerate() {
            let noise = noise.stream(WALLS).stream(index as u64);
            let linear = wall.linear.iter_mut().map(|(_, c)| c);
            let products = wall.nonlinear.iter_mut().map(|(_, c)| c);
            for (index, coefficient) in linear.chain(products).enumerate() {
                *coefficient *= noise.factor(index);
            }
        }
        LinearProblem {
            terms,
            walls,
            space: self.space.disturbed(noise),
            ..self.clone()
        }
    }
}
