//! The point state: coordinate, wavenumber, parameters and base fields at one point, as kernels read them.

use crate::ids::{FieldId, Id, ParameterId, Table};

/// Positions in the point state
/// `[y, k, parameters…, base field 0 and its y-derivatives to base_order, base field 1, …]`.
#[derive(Clone, Copy, Debug)]
pub struct StateLayout {
    parameters: usize,
    fields: usize,
    /// Highest y-derivative of each base field.
    base_order: usize,
}

impl StateLayout {
    /// The layout for a number of parameters and of fields, with y-derivatives of the base fields up to `base_order`.
    pub fn new(parameters: usize, fields: usize, base_order: usize) -> Self {
        StateLayout {
            parameters,
            fields,
            base_order,
        }
    }

    /// Number of elements.
    pub fn length(&self) -> usize {
        2 + self.parameters + self.fields * (self.base_order + 1)
    }

    /// Position of y.
    pub fn coordinate(&self) -> usize {
        0
    }

    /// Position of k.
    pub fn wavenumber(&self) -> usize {
        1
    }

    /// Position of a parameter.
    pub fn parameter(&self, parameter: ParameterId) -> usize {
        2 + parameter.index()
    }

    /// Position of ∂y^order of a base field.
    pub fn base(&self, field: FieldId, order: usize) -> usize {
        2 + self.parameters + field.index() * (self.base_order + 1) + order
    }
}

/// The values of the point state, in the order of [`StateLayout`].
#[derive(Clone, Debug)]
pub struct PointState {
    layout: StateLayout,
    values: Vec<f64>,
}

impl PointState {
    /// The state at `y` for a wavenumber and parameters. The base fields are zero until they are set.
    pub fn new(layout: StateLayout, y: f64, k: f64, parameters: &Table<ParameterId, f64>) -> Self {
        let mut values = vec![0.0; layout.length()];
        values[layout.coordinate()] = y;
        values[layout.wavenumber()] = k;
        for (parameter, value) in parameters.pairs() {
            values[layout.parameter(parameter)] = *value;
        }
        PointState { layout, values }
    }

    /// Sets every base field from the outputs of [`crate::KernelId::Closed`], which are zero for solved fields.
    pub fn set_closed(&mut self, closed: &[f64]) {
        let first = self.layout.base(FieldId(0), 0);
        self.values[first..].copy_from_slice(closed);
    }

    /// Sets ∂y^order of a base field.
    pub fn set_base(&mut self, field: FieldId, order: usize, value: f64) {
        let position = self.layout.base(field, order);
        self.values[position] = value;
    }

    /// The values, of length [`StateLayout::length`].
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values, of length [`StateLayout::length`].
    pub fn into_values(self) -> Vec<f64> {
        self.values
    }
}

#[cfg(test)]
mod tests {
    use super::{FieldId, ParameterId, StateLayout};

    #[test]
    fn the_state_holds_every_element_once() {
        let layout = StateLayout::new(3, 2, 2);
        let mut positions = vec![layout.coordinate(), layout.wavenumber()];
        positions.extend((0..3).map(|i| layout.parameter(ParameterId(i))));
        positions.extend((0..2).flat_map(|f| (0..=2).map(move |o| layout.base(FieldId(f), o))));
        assert_eq!(positions, (0..layout.length()).collect::<Vec<_>>());
    }
}
