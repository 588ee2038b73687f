//! Newton's method, damped where that is asked for. Every nonlinear system of the solver is solved here.

use std::fmt;

/// A system F(x) = 0.
pub trait System {
    /// ∂F/∂x, in whatever form its linear solver takes.
    type Jacobian;
    /// What evaluating F yields besides F and its Jacobian, and later steps use.
    type Byproduct;
    /// How evaluation can fail.
    type Error: From<Failure>;

    /// F and ∂F/∂x at x; `None` where x lies outside the domain of F.
    ///
    /// # Errors
    /// An error that ends the iteration.
    fn linearise(&mut self, x: &[f64]) -> Result<Option<Linearised<Self>>, Self::Error>;

    /// Whether x lies in the domain, as far as that shows without evaluating F. A step is halved until its end does.
    fn admits(&self, _x: &[f64]) -> bool {
        true
    }

    /// The step s with J s = −F; `None` where J is singular.
    ///
    /// # Errors
    /// An error that ends the iteration.
    fn step(&mut self, x: &[f64], at: &Linearised<Self>) -> Result<Option<Vec<f64>>, Self::Error>;

    /// Whether a step from x is so small that its end counts as the solution.
    fn is_last(&self, x: &[f64], step: &[f64]) -> bool;

    /// Whether F counts as zero at x. Asked for once a step has been taken.
    fn is_solution(&self, _x: &[f64], _at: &Linearised<Self>) -> bool {
        false
    }
}

/// A system at one point.
pub struct Linearised<S: System + ?Sized> {
    /// F
    pub residual: Vec<f64>,
    /// ∂F/∂x
    pub jacobian: S::Jacobian,
    /// What evaluating F has yielded besides.
    pub byproduct: S::Byproduct,
}

impl<S: System + ?Sized> Linearised<S> {
    /// √ΣF²
    pub fn size(&self) -> f64 {
        self.residual.iter().map(|r| r * r).sum::<f64>().sqrt()
    }
}

/// Why an iteration gave up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// No part of the step lowers the residual.
    Damping {
        /// Size of the residual.
        residual: f64,
    },
    /// The residual has not vanished after all steps that are allowed.
    Steps {
        /// Size of the residual.
        residual: f64,
        /// Number of steps.
        steps: usize,
    },
    /// The start lies outside the domain.
    Start,
    /// A step leads out of the domain, or there is none.
    Lost,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Damping { residual } => {
                write!(f, "no step reduces the residual {residual:.1e}")
            }
            Failure::Steps { residual, steps } => {
                write!(f, "residual {residual:.1e} after {steps} iterations")
            }
            Failure::Start => f.write_str("a law has no value at the starting point"),
            Failure::Lost => f.write_str("the iteration leaves the domain"),
        }
    }
}

/// How the iteration is run.
#[derive(Clone, Copy, Debug)]
pub struct Newton {
    /// Most steps.
    pub most_steps: usize,
    /// Smallest part of a step that is tried when the step is halved. With 1 every step is taken whole.
    pub least_part: f64,
}

impl Newton {
    /// The solution that the iteration reaches from a start, with the system linearised there.
    ///
    /// # Errors
    /// A [`Failure`] of the iteration, or an error of the system.
    pub fn solve<S: System>(
        &self,
        system: &mut S,
        mut x: Vec<f64>,
    ) -> Result<(Vec<f64>, Linearised<S>), S::Error> {
        let mut at = system.linearise(&x)?.ok_or(Failure::Start)?;
        for taken in 0..self.most_steps {
            if taken > 0 && system.is_solution(&x, &at) {
                return Ok((x, at));
            }
            let step = system.step(&x, &at)?.ok_or(Failure::Lost)?;
            let last = system.is_last(&x, &step);
            let mut part = 1.0;
            loop {
                let moved = x.iter().zip(&step).map(|(x, s)| x + part * s);
                let moved: Vec<f64> = moved.collect();
                // The last step is taken whole: at the solution rounding may keep the residual from falling. Others have
                // to lower it by a quarter of the part that a linear system would (Armijo's rule).
                let enough = |next: &Linearised<S>| {
                    last || self.least_part == 1.0 || next.size() <= (1.0 - 0.25 * part) * at.size()
                };
                let next = if system.admits(&moved) {
                    system.linearise(&moved)?.filter(enough)
                } else {
                    None
                };
                if let Some(next) = next {
                    (x, at) = (moved, next);
                    break;
                }
                part *= 0.5;
                if part < self.least_part {
                    let residual = at.size();
                    return Err(if self.least_part == 1.0 {
                        Failure::Lost.into()
                    } else {
                        Failure::Damping { residual }.into()
                    });
                }
            }
            if last {
                return Ok((x, at));
            }
        }
        Err(Failure::Steps {
            residual: at.size(),
            steps: self.most_steps,
        }
        .into())
    }
}

#[cfg(test)]
mod tests {
    use super::{Failure, Linearised, Newton, System};

    /// atan(x) = 0, whose whole steps run away from |x| > 1.39, on |x| < 100.
    struct Arctangent;

    impl System for Arctangent {
        type Jacobian = f64;
        type Byproduct = ();
        type Error = Failure;

        fn linearise(&mut self, x: &[f64]) -> Result<Option<Linearised<Self>>, Failure> {
            Ok((x[0].abs() < 100.0).then(|| Linearised {
                residual: vec![x[0].atan()],
                jacobian: 1.0 / (1.0 + x[0] * x[0]),
                byproduct: (),
            }))
        }

        fn step(&mut self, _: &[f64], at: &Linearised<Self>) -> Result<Option<Vec<f64>>, Failure> {
            Ok(Some(vec![-at.residual[0] / at.jacobian]))
        }

        fn is_last(&self, _: &[f64], step: &[f64]) -> bool {
            step[0].abs() < 1e-8
        }
    }

    #[test]
    fn damping_keeps_the_iteration_from_running_away() {
        let whole = Newton {
            most_steps: 50,
            least_part: 1.0,
        };
        let damped = Newton {
            least_part: 1e-3,
            ..whole
        };
        let (x, at) = damped.solve(&mut Arctangent, vec![3.0]).expect("a root");
        assert!(x[0].abs() < 1e-15 && at.size() < 1e-15);
        assert!(whole.solve(&mut Arctangent, vec![1.0]).is_ok());
        let lost = whole.solve(&mut Arctangent, vec![3.0]).err();
        assert_eq!(lost, Some(Failure::Lost));
        let outside = damped.solve(&mut Arctangent, vec![1e3]).err();
        assert_eq!(outside, Some(Failure::Start));
    }
}
