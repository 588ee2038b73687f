//! What commands draw and store beside what they print.

use crate::reproduce::run;
use crate::support::{close, landau, written};
use std::fs;
use std::path::Path;

/// An array of an npz file.
fn array(file: &str, name: &str) -> Vec<f64> {
    let mut archive = npyz::npz::NpzArchive::open(file).expect("an archive");
    let found = archive.by_name(name).expect("readable").expect(name);
    found.into_vec().expect("numbers")
}

/// The path of a file in a folder.
fn inside(folder: &Path, name: &str) -> String {
    folder.join(name).display().to_string()
}

/// A list of numbers of a VTK file, after the line that begins with `start`.
fn values(text: &str, start: &str, skipped: usize) -> Vec<f64> {
    let lines = text
        .lines()
        .skip_while(|l| !l.starts_with(start))
        .skip(1 + skipped);
    lines
        .take_while(|l| l.starts_with(|c: char| c.is_ascii_digit() || c == '-'))
        .flat_map(|l| {
            l.split(' ')
                .map(|v| v.parse().expect("a number"))
                .collect::<Vec<f64>>()
        })
        .collect()
}

/// The modes carry no mass: ∫∫ n dx dy over wavelengths is F per length, for both patterns.
#[test]
fn patterns_keep_the_mass() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let files = [path("a.vtk"), path("a.npz"), path("a.nc"), path("a.svg")];
    run(&[
        "pattern",
        "vibrated_bed",
        "--k",
        "0.16",
        "--points",
        "33x401",
        "--out",
        &files[0],
        "--out",
        &files[1],
        "--out",
        &files[2],
        "--out",
        &files[3],
    ]);
    let text = fs::read_to_string(&files[0]).expect("the file");
    let (x, y) = (values(&text, "X_COORD", 0), values(&text, "Y_COORD", 0));
    assert_eq!((x.len(), y.len()), (33, 401));
    for name in ["n_linear", "n_nonlinear"] {
        let n = values(&text, &format!("SCALARS {name} "), 1);
        let row = |j: usize| -> f64 { n[j * 33..j * 33 + 32].iter().sum::<f64>() / 32.0 };
        let panels = (0..400).map(|j| 0.5 * (row(j) + row(j + 1)) * (y[j + 1] - y[j]));
        // The trapezoidal rule in y: (40/400)²/12 times slopes of order one.
        close(name, panels.sum(), 6.0, 2e-4);
    }
    let start = |file: &str| fs::read(file).expect("the file")[..4].to_vec();
    assert_eq!(start(&files[1]), b"PK\x03\x04");
    assert_eq!(start(&files[2]), b"CDF\x01");
    assert_eq!(start(&files[3]), b"<svg");
}

/// Modes as pictures and data: X[1;1] has the norm that the spec asks for, a mean mode is real, walls hold.
#[test]
fn modes_are_drawn_and_stored() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (svg, npz) = (path("modes.svg"), path("modes.npz"));
    run(&[
        "point",
        "rayleigh_benard",
        "--k",
        "3.1",
        "--set",
        "Ra=1800",
        "-M",
        "30",
        "--plot",
        &svg,
        "--out",
        &npz,
    ]);
    assert!(
        fs::read_to_string(&svg)
            .expect("a picture")
            .contains("X[3;3]")
    );
    let mut archive = npyz::npz::NpzArchive::open(&npz).expect("an archive");
    let mut array = |name: &str| -> Vec<f64> {
        let found = archive.by_name(name).expect("readable").expect(name);
        found.into_vec().expect("numbers")
    };
    let theta = array("X11_theta_re");
    close("theta at mid-height", theta[100], 1.0, 1e-9);
    close("theta at the wall", theta[0], 0.0, 1e-12);
    assert!(array("X02_theta_im").iter().all(|v| *v == 0.0));
    assert_eq!(array("adjoint_heat_re").len(), 201);
    let spectrum = path("spectrum.svg");
    run(&["spectrum", "rayleigh_benard", "--plot", &spectrum]);
    assert!(
        fs::read_to_string(&spectrum)
            .expect("a picture")
            .contains("growth rate")
    );
    let base = path("base.svg");
    run(&["base", "vibrated_bed", "--points", "3", "--plot", &base]);
    assert!(
        fs::read_to_string(&base)
            .expect("a picture")
            .contains("base state")
    );
    let lines = path("pattern.svg");
    run(&[
        "pattern",
        "swift_hohenberg",
        "--set",
        "b=0.5",
        "--out",
        &lines,
    ]);
    assert!(
        fs::read_to_string(&lines)
            .expect("a picture")
            .contains("through third order")
    );
    let refused = landau(&["point", "swift_hohenberg", "--plot", &svg]);
    assert_eq!(refused.status, 2, "{}", refused.err);
    let refused = landau(&["base", "vibrated_bed", "--plot", &npz]);
    assert_eq!(refused.status, 2, "{}", refused.err);
    assert!(refused.err.contains("it accepts .svg"), "{}", refused.err);
}

/// u = 1 − y² between the walls, and the same numbers as on the screen.
#[test]
fn base_states_are_stored() {
    let folder = tempfile::tempdir().expect("a folder");
    let [npz, nc] = ["base.npz", "base.nc"].map(|name| inside(folder.path(), name));
    let line = ["base", "plane_poiseuille", "--points", "21"];
    run(&[&line[..], &["--out", &npz, "--out", &nc]].concat());
    let (y, u) = (array(&npz, "y"), array(&npz, "u"));
    assert_eq!((y.len(), y[0], y[20]), (21, -1.0, 1.0));
    for (y, u) in y.iter().zip(&u) {
        close("u", *u, 1.0 - y * y, 1e-14);
    }
    assert_eq!(&fs::read(&nc).expect("the file")[..4], b"CDF\x01");
    let refused = landau(&[&line[..], &["--out", "base.csv"]].concat());
    assert_eq!(refused.status, 2);
    assert!(
        refused.err.contains("it accepts .npz, .nc"),
        "{}",
        refused.err
    );
}

/// r − (1 − k²)², of L and of L†.
#[test]
fn spectra_are_stored() {
    let folder = tempfile::tempdir().expect("a folder");
    let npz = inside(folder.path(), "spectrum.npz");
    run(&[
        "spectrum",
        "swift_hohenberg",
        "--k",
        "0.9",
        "--set",
        "r=0.3",
        "--out",
        &npz,
    ]);
    for name in ["direct_re", "adjoint_re"] {
        let found = array(&npz, name);
        assert_eq!(found.len(), 1);
        close(name, found[0], 0.3 - 0.19 * 0.19, 1e-14);
    }
    assert_eq!(array(&npz, "direct_im"), [0.0]);
    assert_eq!(array(&npz, "mode"), [0.0]);
}

/// Names in other letters come out in Latin ones, each another; the spec's own words stand beside them.
#[test]
fn names_in_other_letters() {
    let text = "model letters \"Letters\";
coordinates { ξ: periodic; η: 0..1; }
parameters { ε = 1; eps = 2; Γ = 2 in 0..; γ = 1; }
fields { φ \"order\"; phi; ψ; }
balance {
    a: dt(φ) = dξ(dξ(φ)) + dη(dη(φ)) + 30*φ + ε*φ*ψ - Γ*φ^3;
    b: dt(ψ) = dξ(dξ(ψ)) + dη(dη(ψ)) + γ*φ^2 - eps*ψ;
    c: dt(phi) = dξ(dξ(phi)) + dη(dη(phi)) + φ*ψ;
}
base { φ = 0; ψ = 0; phi = 0; }
boundary { at η = 0 { φ = 0; ψ = 0; phi = 0; } at η = 1 { φ = 0; ψ = 0; phi = 0; } }
typical { k = 1; }
";
    let spec = written("letters.model", text).display().to_string();
    let folder = tempfile::tempdir().expect("a folder");
    let files = ["a.npz", "a.nc", "a.vtk", "a.svg"].map(|name| inside(folder.path(), name));
    let outs: Vec<&str> = files.iter().flat_map(|f| ["--out", f.as_str()]).collect();
    let drawn = ["pattern", &spec, "--points", "9x9", "--arrows", "φ,ψ"];
    run(&[&drawn[..], &outs].concat());
    assert_eq!(array(&files[0], "xi").len(), 9);
    assert_eq!(array(&files[0], "eta").len(), 9);
    // The second `phi`: no part of the fundamental.
    let size = |name: &str| {
        array(&files[0], name)
            .iter()
            .fold(0.0_f64, |m, v| m.max(v.abs()))
    };
    assert!(size("phi_linear") > 0.1, "{}", size("phi_linear"));
    assert_eq!(size("phi_2_linear"), 0.0);
    let nc = fs::read(&files[1]).expect("the file");
    let has = |word: &str| nc.windows(word.len()).any(|w| w == word.as_bytes());
    for word in [
        "phi_2_linear",
        "psi_base",
        "parameter_gamma_2",
        "order, base state",
    ] {
        assert!(has(word), "{word}");
    }
    let vtk = fs::read_to_string(&files[2]).expect("the file");
    assert!(vtk.contains("SCALARS phi_linear ") && vtk.contains("VECTORS vector_linear "));
    let (npz, nc) = (
        inside(folder.path(), "modes.npz"),
        inside(folder.path(), "modes.nc"),
    );
    run(&["point", &spec, "--out", &npz, "--out", &nc]);
    assert_eq!(array(&npz, "X11_phi_re").len(), 201);
    // Typeset, they are commands that LaTeX knows.
    let typeset = run(&["explain", &spec, "--format", "latex"]);
    assert!(typeset.is_ascii(), "{typeset}");
    assert!(
        typeset.contains("\\varepsilon \\varphi^{\\prime} \\psi^{\\prime}"),
        "{typeset}"
    );
    assert!(typeset.contains("\\Gamma") && typeset.contains("\\partial_{\\xi}^{2}"));
}
