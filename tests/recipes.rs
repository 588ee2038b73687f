//! The specs of `spec/RECIPES.md`, run against the numbers that stand beside them.

use crate::support::{close, json, landau, number, root, written};
use landau_solver::model::{End, FieldId, Model};
use landau_solver::spectrum::leading;
use landau_solver::study::Setup;
use landau_solver::wavevector::WaveVector;
use std::path::PathBuf;
use std::sync::Arc;

fn recipe(name: &str) -> PathBuf {
    let page = std::fs::read_to_string(root().join("spec/RECIPES.md")).expect("the page");
    let head = format!("```landau {name}\n");
    let start = page.find(&head).expect("a recipe") + head.len();
    let end = start + page[start..].find("```").expect("its end");
    let path = written(name, &page[start..end]);
    let answer = landau(&["check", &path.to_string_lossy()]);
    assert_eq!(answer.status, 0, "{name}: {}", answer.err);
    path
}

fn critical(name: &str, options: &str) -> serde_json::Value {
    json(&format!("critical {} {options}", recipe(name).display()))
}

#[test]
fn taylor_couette() {
    let found = critical(
        "taylor_couette.model",
        "--vary Re --from 60 --to 80 --minimize k=2.5:4 -M 30",
    );
    close("Re", number(&found, "/value"), 68.1862683464, 1e-8);
    close("k", number(&found, "/k"), 3.1624759, 1e-6);
}

/// 60..120 with k = 1:3, where the largest growth lies at an end of the range for some Ma.
#[test]
fn marangoni() {
    let found = critical(
        "marangoni.model",
        "--vary Ma --from 60 --to 120 --minimize k=1:3 -M 30",
    );
    close("Ma", number(&found, "/value"), 79.6066948, 1e-7);
    close("k", number(&found, "/k"), 1.9929, 1e-3);
}

#[test]
fn axis() {
    let path = recipe("axis.model");
    let found = json(&format!("spectrum {} --k 1e-6 -M 24", path.display()));
    close("L", number(&found, "/direct/0/0"), -14.681970642, 1e-8);
    close("L†", number(&found, "/adjoint/0/0"), -14.681970642, 1e-8);
}

#[test]
fn solved_channel() {
    let path = recipe("force.model");
    let found = json(&format!("base {} --points 5", path.display()));
    for (i, y) in [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
        let value = number(&found, &format!("/profiles/u/{i}"));
        close("u", value, 0.5 * y * (1.0 - y), 1e-12);
        close("p", number(&found, &format!("/profiles/p/{i}")), 0.0, 1e-12);
    }
}

#[test]
fn surface_waves() {
    let path = recipe("surface.model");
    let found = json(&format!("spectrum {} --k 1e-4 -M 30", path.display()));
    let lubrication = -1e-8 / 0.03;
    close("decay", number(&found, "/direct/0/0"), lubrication, 1e-11);
}

#[test]
fn stream_function() {
    let path = recipe("stream.model");
    let found = json(&format!("point {} -M 80", path.display()));
    close("a0", number(&found, "/c0/0"), 0.003739670623, 1e-9);
    close("b0", number(&found, "/c0/1"), -0.237526488820, 1e-9);
}

/// The growth rate at the critical wavenumber passes through zero at the critical Reynolds number.
#[test]
fn blasius() {
    let sources = landau_codegen::build::read_sources(&recipe("blasius.model")).expect("a spec");
    let model: Arc<dyn Model> = Arc::new(landau_codegen::tape(&sources).expect("well formed"));
    let k = 0.3038 / 1.7207876573;
    let growth = |reynolds: f64| {
        let mut setup = Setup::new(model.clone(), 90).expect("M");
        setup.set(&[format!("R={reynolds}")]).expect("a parameter");
        let base = setup.base(None).expect("a base state");
        // f''(0) of Blasius
        let wall = base.value(FieldId(5), base.space.end(End::Lower));
        close("curvature at the wall", wall, 0.332057336215, 1e-9);
        let problem = setup.problem(&base).expect("a problem");
        leading(&problem, WaveVector::along_x(k))
            .expect("a mode")
            .c
            .re
    };
    let (low, high) = (growth(518.5), growth(520.3));
    let critical = 518.5 - low * 1.8 / (high - low);
    // By an independent program on the same box, and on one of 60.
    close("R", critical, 519.06, 0.01);
}
