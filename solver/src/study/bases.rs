//! Base states of a study, solved once for each set of parameters.

use crate::base::BaseState;
use crate::parameters::Parameters;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Base states that are remembered: those of a sweep that follows a mode, which passes over its places three times.
const MOST: usize = 1024;

/// The base states of one model that were solved without a neighbour, the latest last.
#[derive(Default)]
pub struct Bases(Mutex<VecDeque<(Parameters, Arc<BaseState>)>>);

impl Bases {
    /// The base state of these parameters, where it was solved before.
    pub(super) fn at(&self, parameters: &Parameters) -> Option<Arc<BaseState>> {
        let bases = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut same = bases.iter().filter(|(solved, _)| solved == parameters);
        same.next().map(|(_, base)| base.clone())
    }

    /// Remembers a base state that had to be solved for; the oldest gives way.
    pub(super) fn add(&self, parameters: &Parameters, base: &Arc<BaseState>) {
        if base.is_closed() {
            return;
        }
        let mut bases = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if bases.len() == MOST {
            bases.pop_front();
        }
        bases.push_back((parameters.clone(), base.clone()));
    }
}
