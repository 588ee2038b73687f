//! The structure of a model: the meaning of the inputs and outputs of its kernels.

use super::assemble::Assembler;
use crate::model::Model;
use landau_contract::*;

/// The parts of a structure that the assembly of kernels determines.
pub(super) struct Parts {
    pub base: BaseInfo,
    /// Jets that N2 and N3 multiply.
    pub form_jets: Vec<Jet>,
    /// Number of distinct coefficients of N2 and N3.
    pub form_coefficients: usize,
    pub cases: Table<CaseId, CaseInfo>,
    pub amplitude: AmplitudeInfo,
    pub outputs: Vec<OutputInfo>,
    /// Jets of the full state that the residuals read.
    pub residual_jets: Vec<Jet>,
    /// Operations as written, and after sharing.
    pub operations: [usize; 2],
}

/// The offsets of a system, as numbers of points and values.
pub(super) fn offsets<Row: Clone, Column: Clone>(
    offsets: &crate::derive::Offsets<Row, Column>,
) -> OffsetsInfo<Row, Column> {
    OffsetsInfo {
        rows: offsets.rows.clone(),
        columns: offsets.columns.clone(),
    }
}

impl Assembler<'_> {
    pub(super) fn structure(&self, parts: Parts) -> Structure {
        let (model, operators) = (self.model, self.operators);
        Structure {
            name: model.name.clone(),
            title: model.title.clone(),
            order: operators.order,
            periodic: model.periodic.clone(),
            coordinate: model.interval.as_ref().map(|i| i.name.clone()),
            fields: fields(model),
            parameters: parameters(model),
            balances: model.balances.map(|b| b.name.clone()),
            base_order: self.base_order,
            base: parts.base,
            offsets: offsets(&operators.offsets),
            adjoint_offsets: offsets(&operators.adjoint_offsets),
            parity: operators.parity.as_ref().map(|p| ParityInfo {
                fields: p.fields.clone(),
                rows: p.rows.clone(),
            }),
            linear: terms(&operators.linear),
            adjoint: terms(&operators.adjoint),
            form_jets: parts.form_jets,
            form_coefficients: parts.form_coefficients,
            forms: operators
                .nonlinear
                .iter()
                .map(|rows| rows.map(|form| !form.terms.is_empty()))
                .collect(),
            residual_jets: parts.residual_jets,
            switches: operators.switches.clone(),
            cases: parts.cases,
            amplitude: parts.amplitude,
            outputs: parts.outputs,
            typical: model.typical.map(|typical| TypicalInfo {
                k: typical.k,
                near: typical.near.map_or(Vec::new(), |near| near.to_vec()),
            }),
            lines: lines(model),
            operations: parts.operations.to_vec(),
        }
    }
}

fn fields(model: &Model) -> Table<FieldId, FieldInfo> {
    model.fields.map(|field| FieldInfo {
        name: field.name.clone(),
        doc: field.doc.clone(),
        lower: field.lower,
        upper: field.upper,
        uniform: field.uniform,
    })
}

fn parameters(model: &Model) -> Table<ParameterId, ParameterInfo> {
    let is_automatic = |id: ParameterId| model.base.automatic.iter().any(|(p, _)| *p == id);
    let infos = model
        .parameters
        .pairs()
        .map(|(id, parameter)| ParameterInfo {
            name: parameter.name.clone(),
            doc: parameter.doc.clone(),
            default: parameter.default,
            lower: parameter.lower,
            upper: parameter.upper,
            choices: parameter.choices.clone(),
            whole: parameter.whole,
            automatic: is_automatic(id),
        });
    infos.collect()
}

fn terms<Row: Copy, Column: Copy>(
    terms: &[crate::derive::Term<Row, Column>],
) -> Vec<TermInfo<Row, Column>> {
    let infos = terms.iter().map(|term| TermInfo {
        row: term.row,
        jet: term.jet,
    });
    infos.collect()
}

fn lines(model: &Model) -> LinesInfo {
    let interval = model.interval.as_ref();
    LinesInfo {
        coordinate: interval.map_or(0, |interval| model.line(&interval.location)),
        base: model.line(&model.base.location),
        fields: model.fields.map(|f| model.line(&f.location)),
        balances: model.balances.map(|b| model.line(&b.location)),
    }
}
