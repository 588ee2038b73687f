//! Ratios worth quoting: a warm Landau point, emitted against tape, the generator.

use criterion::{Criterion, criterion_group, criterion_main};
use landau_codegen::build::{generate_module, read_sources};
use landau_solver::Model;
use landau_solver::study::Setup;
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{Expansion, Selection, point, select, warm_point};
use std::path::Path;
use std::sync::Arc;

fn warm(criterion: &mut Criterion, name: &str, model: &Arc<dyn Model>) {
    let setup = Setup::new(model.clone(), 50).expect("M");
    let base = setup.base(None).expect("a base state");
    let problem = setup.problem(&base).expect("a problem");
    let near = point(&problem, WaveVector::along_x(0.16), Selection::Leading)
        .expect("a point")
        .pair;
    criterion.bench_function(name, |b| {
        b.iter(|| {
            warm_point(&problem, WaveVector::along_x(0.161), &near)
                .expect("a point")
                .c2
        })
    });
}

/// Coefficients of higher orders, and of a pair of modes: the modes known, everything else anew.
fn series(criterion: &mut Criterion, model: &Arc<dyn Model>) {
    let setup = Setup::new(model.clone(), 50).expect("M");
    let base = setup.base(None).expect("a base state");
    let problem = setup.problem(&base).expect("a problem");
    let pair =
        |k: f64| select(&problem, WaveVector::along_x(k), Selection::Leading).expect("a mode");
    let cases = [
        ("order 3 by series", vec![pair(0.16)], 3),
        ("order 5", vec![pair(0.16)], 5),
        ("order 7", vec![pair(0.16)], 7),
        ("order 9", vec![pair(0.16)], 9),
        ("a pair at order 3", vec![pair(0.054), pair(0.108)], 3),
    ];
    for (name, pairs, order) in cases {
        criterion.bench_function(&format!("warm {name}, M = 50"), |b| {
            b.iter(|| {
                let expansion = Expansion::to(&problem, pairs.clone(), order - 1);
                expansion.expect("the expansion").last_coefficients()
            });
        });
    }
}

fn benches(criterion: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../spec/models");
    let models = landau_spec::models();
    let bed = models
        .iter()
        .find(|m| m.structure().name == "vibrated_bed")
        .expect("the bed");
    warm(criterion, "warm Landau point, M = 50, emitted", bed);
    series(criterion, bed);
    let sources = read_sources(&folder.join("vibrated_bed.model")).expect("the spec");
    let tape = landau_codegen::tape(&sources).expect("a well-formed spec");
    let tape: Arc<dyn Model> = Arc::new(tape);
    warm(criterion, "warm Landau point, M = 50, tape", &tape);
    criterion.bench_function("base state", |b| {
        let setup = Setup::new(bed.clone(), 50).expect("M");
        b.iter(|| setup.base(None).expect("a base state").residual);
    });
    criterion.bench_function("generator, all specs", |b| {
        b.iter(|| {
            let paths = std::fs::read_dir(&folder)
                .expect("models")
                .filter_map(|e| e.ok());
            paths
                .map(|e| {
                    generate_module(read_sources(&e.path()).expect("a spec"))
                        .expect("well formed")
                        .2
                        .len()
                })
                .sum::<usize>()
        });
    });
}

criterion_group!(all, benches);
criterion_main!(all);
