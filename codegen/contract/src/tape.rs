//! A model that runs from its spec without a build, by interpreting the operations of its kernels.

use crate::ids::{BalanceId, CaseId, Table};
use crate::kernel::{Kernel, ModelKernels};
use crate::model::Model;
use crate::number::C64;
use crate::structure::{KernelId, ResidualId, Structure};
use std::cell::RefCell;
use std::collections::HashMap;

/// A model that interprets its kernels: the same operations in the same order as emitted code.
pub struct TapeModel {
    structure: Structure,
    sources: Vec<(String, String)>,
    laws: Vec<(String, String)>,
    generator: &'static str,
    kernels: HashMap<KernelId, Kernel>,
    forms: Vec<Table<BalanceId, Option<Kernel>>>,
    residuals: HashMap<ResidualId, Kernel>,
    undeclared: HashMap<CaseId, Vec<String>>,
}

impl TapeModel {
    /// A model of kernels. `sources` and `laws` are path and text of files, as [`Model::sources`] and [`Model::laws`] give
    /// them; `generator` is the identity of the build that made the kernels.
    pub fn new(
        kernels: ModelKernels,
        sources: Vec<(String, String)>,
        laws: Vec<(String, String)>,
        generator: &'static str,
    ) -> Self {
        let ModelKernels {
            structure,
            kernels,
            forms,
            residuals,
            undeclared,
        } = kernels;
        TapeModel {
            structure,
            sources,
            laws,
            generator,
            kernels: kernels.into_iter().collect(),
            forms,
            residuals: residuals.into_iter().collect(),
            undeclared: undeclared.into_iter().collect(),
        }
    }
}

impl Model for TapeModel {
    fn structure(&self) -> &Structure {
        &self.structure
    }

    fn sources(&self) -> Vec<(String, String)> {
        self.sources.clone()
    }

    fn laws(&self) -> Vec<(String, String)> {
        self.laws.clone()
    }

    fn generator(&self) -> &str {
        self.generator
    }

    fn evaluate(&self, kernel: KernelId, point: &[f64], out: &mut [f64]) {
        thread_local!(static REGISTERS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) });
        let Some(kernel) = self.kernels.get(&kernel) else {
            panic!("this model has no kernel {kernel:?}");
        };
        REGISTERS.with_borrow_mut(|registers| kernel.run(|_, i| point[i], registers));
        REGISTERS.with_borrow(|registers| copy_outputs(kernel, registers, out));
    }

    fn form(&self, degree: usize, row: BalanceId, c: &[f64], x: &[&[C64]]) -> C64 {
        thread_local!(static REGISTERS: RefCell<Vec<C64>> = const { RefCell::new(Vec::new()) });
        let Some(kernel) = &self.forms[degree - 2][row] else {
            return C64::new(0.0, 0.0);
        };
        REGISTERS.with_borrow_mut(|registers| {
            let input = |array: usize, i: usize| match array {
                0 => C64::from(c[i]),
                _ => x[array - 1][i],
            };
            kernel.run(input, registers);
            registers[kernel.outputs[0]]
        })
    }

    fn residual(&self, residual: ResidualId) -> Option<&Kernel> {
        self.residuals.get(&residual)
    }

    fn undeclared(&self, case: CaseId) -> Vec<String> {
        self.undeclared.get(&case).cloned().unwrap_or_default()
    }
}

fn copy_outputs<T: Copy>(kernel: &Kernel, registers: &[T], out: &mut [T]) {
    for (value, &register) in out.iter_mut().zip(kernel.outputs.iter()) {
        *value = registers[register];
    }
}
