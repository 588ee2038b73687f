//! Onsets and neutral points: whatever mode leads, whatever range of k is given, with errors that hold. Truths are exact,
//! published, or from independent programs.

use crate::support::{built, close, json, landau, number, written};
use landau_solver::spectrum::eigenvalues;
use landau_solver::study::critical::{CriticalReport, Quantity, Question, Request, Tracking};
use landau_solver::study::{Setup, Silent};
use landau_solver::wavevector::WaveVector;
use serde_json::Value;

/// Two fields whose growth rates are r − (1 − k²)² and r + d − s (k2² − k²)².
const TWO_CRESTS: &str = "model crests \"Two crests, one of any width\";
coordinates { x: periodic; }
parameters { r = 0.1; d = 0.05; s = 400; k2 = 2.3; }
fields { u; v; }
let w = u + dx(dx(u));
let w2 = k2^2*v + dx(dx(v));
balance {
    eu: dt(u) = r*u - w - dx(dx(w)) - u^3 - u*v^2;
    ev: dt(v) = (r + d)*v - s*(k2^2*w2 + dx(dx(w2))) - v^3 - v*u^2;
}
base { u = 0; v = 0; }
amplitude { integral(|u|^2 + |v|^2) = 1; }
";

/// Growth rates r1 − (k1² − k²)² and r2 − (k2² − k²)²/4 with frequency om, coupled by eps.
const MODE_AND_WAVE: &str = "model crossing \"A real mode and a wave\";
coordinates { x: periodic; }
parameters { r1 = 0.5; r2 = 0.4; k1 = 1; k2 = 1.6; om = 1.5; eps = 0; r = 0; }
fields { u; a; b; }
let w1 = k1^2*u + dx(dx(u));
let w2 = k2^2*a + dx(dx(a));
let w3 = k2^2*b + dx(dx(b));
balance {
    eu: dt(u) = (r + r1)*u - k1^2*w1 - dx(dx(w1)) + eps*a - u^3 - u*(a^2 + b^2)/2;
    ea: dt(a) = (r + r2)*a - k2^2*w2/4 - dx(dx(w2))/4 - om*b + eps*u - a*(a^2 + b^2) - a*u^2;
    eb: dt(b) = (r + r2)*b - k2^2*w3/4 - dx(dx(w3))/4 + om*a - b*(a^2 + b^2) - b*u^2 + eps*u;
}
base { u = 0; a = 0; b = 0; }
amplitude { integral(|u|^2 + |a|^2 + |b|^2) = 1; }
";

/// A mixture with the Soret effect between rigid walls that let nothing through.
const SORET: &str = "model soret \"Convection of a mixture\";
coordinates { x: periodic; z: 0..1; }
parameters { Ra = 1000 in 0..; Pr = 10 in 0..; Le = 0.1 in 0..; psi = 0.5 in -1..1; }
fields { u; w; p; theta; c; }
let along(q)   = u*dx(q) + w*dz(q);
let laplace(q) = dx(dx(q)) + dz(dz(q));
balance {
    momentum_x: (dt(u) + along(u))/Pr = -dx(p) + laplace(u);
    momentum_z: (dt(w) + along(w))/Pr = -dz(p) + laplace(w) + Ra*(theta + psi*c);
    continuity: dx(u) + dz(w) = 0;
    heat:       dt(theta) + along(theta) = w + laplace(theta);
    solute:     dt(c) + along(c) = w + Le*(laplace(c) - laplace(theta));
}
base { u = 0; w = 0; p = 0; theta = 0; c = 0; }
boundary {
    at z = 0 { u = 0; w = 0; theta = 0; dz(c) - dz(theta) = 0; }
    at z = 1 { u = 0; w = 0; theta = 0; dz(c) - dz(theta) = 0; }
}
mean { gauge p; conserved integral(c); }
amplitude { at z = 1/2 { theta = 1; } }
";

/// A number and its error under the same name, in an object with errors of its own.
fn within(found: &Value, name: &str, truth: f64) {
    let (value, error) = match name {
        "value" => (number(found, "/value"), number(found, "/error")),
        "k" => (number(found, "/k"), number(found, "/k_error")),
        _ => (
            number(found, &format!("/envelope/{name}")),
            number(found, &format!("/envelope/error/{name}")),
        ),
    };
    close(name, value, truth, error);
}

fn onset(path: &std::path::Path, options: &str) -> Value {
    json(&format!("critical {} {options}", path.display()))
}

/// One answer for every range of k that contains it, and a growth rate that is zero within its error.
#[test]
fn an_onset_does_not_depend_on_the_range() {
    let path = written("soret.model", SORET);
    for range in ["0.02:4", "0.3:4", "0.3:2", "0.5:1", "0.1:1"] {
        let options = format!("--vary Ra --from 60 --to 400 --minimize k={range} -M 20");
        let found = onset(&path, &options);
        close(range, number(&found, "/value"), 143.817_373_2, 1e-6);
        close(range, number(&found, "/k"), 0.674_0, 1e-4);
        assert!(
            number(&found, "/c0/0").abs() <= number(&found, "/c0_error"),
            "{range}: {found}"
        );
    }
}

/// A crest between the wavenumbers of any scan: r_c = −d at k2, 1/τ0 = d, ξ0² = 4 s k2²/d, g = 3/d.
#[test]
fn a_narrow_crest_is_found() {
    let path = written("crests.model", TWO_CRESTS);
    for (d, s, k2) in [
        (0.1, 1.0, 2.3),
        (0.05, 400.0, 2.3),
        (0.02, 1e5, 1.77),
        (0.3, 30.0, 0.61),
    ] {
        for range in ["0.5:3", "0.2:6", "0.05:4"] {
            let options = format!(
                "--vary r --from=-1 --to 1 --minimize k={range} --set s={s} --set d={d} --set k2={k2}"
            );
            let found = onset(&path, &options);
            within(&found, "value", -d);
            within(&found, "k", k2);
            within(&found, "tau0", 1.0 / d);
            within(&found, "xi0_squared", 4.0 * s * k2 * k2 / d);
            within(&found, "g", 3.0 / d);
            // The errors say what is known, and that is much.
            assert!(number(&found, "/error") < 1e-10 * s.max(1.0), "{found}");
        }
    }
    // The lower crest alone, and the answer from the other direction.
    let found = onset(
        &path,
        "--vary r --from 1 --to=-1 --minimize k=0.5:1.5 --set s=400",
    );
    within(&found, "value", 0.0);
    // The largest growth rate at the end of a range is none of a neutral curve's extremum.
    let line = format!(
        "critical {} --vary r --from=-1 --to 1 --minimize k=0.5:2.2 --set s=1 --set d=0.3",
        path.display()
    );
    let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(answer.status, 3, "{}", answer.out);
    assert!(answer.err.contains("at the end k = 2.2"), "{}", answer.err);
}

/// A real mode and a wave that are neutral almost together, in either order.
#[test]
fn real_modes_and_waves_compete() {
    let path = written("crossing.model", MODE_AND_WAVE);
    for (r2, value, k, frequency) in [(-0.01, 0.0, 1.0, 0.0), (0.01, -0.01, 1.6, 1.5)] {
        for range in ["0.5:3", "0.3:2", "0.9:1.7"] {
            for interval in ["--from=-1 --to 1", "--from 1 --to=-1", "--from=-0.3 --to 7"] {
                let options =
                    format!("--vary r {interval} --minimize k={range} --set r1=0 --set r2={r2}");
                let found = onset(&path, &options);
                within(&found, "value", value);
                within(&found, "k", k);
                close(&options, number(&found, "/c0/1").abs(), frequency, 1e-10);
            }
        }
    }
}

/// A band of growth in the parameter: the onset is the end that comes first.
#[test]
fn islands_and_falling_growth() {
    let spec = "model island \"Growth between two values\";
coordinates { x: periodic; }
parameters { p = 0.3; w = 0.1; }
fields { u; }
let v = u + dx(dx(u));
balance { e: dt(u) = (w^2 - (p - 0.3)^2)*u - v - dx(dx(v)) - u^3; }
base { u = 0; }
amplitude { u = 1; }
";
    let path = written("island.model", spec);
    for (interval, value) in [
        ("--from=-1 --to 1", 0.2),
        ("--from 1 --to=-1", 0.4),
        ("--from 0.3 --to 1", 0.4),
        ("--from 0.25 --to=-3", 0.2),
        ("--from 0.3 --to 0.4", 0.4),
    ] {
        let found = onset(&path, &format!("--vary p {interval} --minimize k=0.5:2"));
        within(&found, "value", value);
        within(&found, "tau0", 1.0 / (0.2 * value));
        assert_eq!(
            found["envelope"]["epsilon"]
                .as_str()
                .expect("words")
                .starts_with('1'),
            value > 0.3
        );
    }
}

/// A wave grows where (r − r0)² < d, in an island that is narrower than the steps of the search. A steady mode grows
/// from r = 2.
#[test]
fn a_narrow_island_before_the_onset() {
    let spec = "model narrow_island \"An island of growing waves\";
coordinates { x: periodic; }
parameters { r = 0.1; d = 0.005; r0 = -0.5; k2 = 1.5; om = 1.5; }
fields { u; a; b; }
let w1 = u + dx(dx(u));
let w2 = k2^2*a + dx(dx(a));
let w3 = k2^2*b + dx(dx(b));
let s = d - (r - r0)^2;
balance {
    eu: dt(u) = (r - 2)*u - w1 - dx(dx(w1)) - u^3 - u*(a^2 + b^2)/2;
    ea: dt(a) = s*a - k2^2*w2/4 - dx(dx(w2))/4 - om*b - a*(a^2 + b^2) - a*u^2;
    eb: dt(b) = s*b - k2^2*w3/4 - dx(dx(w3))/4 + om*a - b*(a^2 + b^2) - b*u^2;
}
base { u = 0; a = 0; b = 0; }
amplitude { integral(|u|^2 + |a|^2 + |b|^2) = 1; }
";
    let path = written("narrow_island.model", spec);
    let half_width = 0.005_f64.sqrt();
    for (interval, value) in [
        ("--from=-1.93 --to 1.1", -0.5 - half_width),
        ("--from=-0.9 --to 0.3", -0.5 - half_width),
        ("--from=1.1 --to=-1.93", -0.5 + half_width),
        // The steady mode grows at the end of the interval, after the island.
        ("--from=-2 --to 3.7", -0.5 - half_width),
        ("--from=-0.4 --to 3.7", 2.0),
    ] {
        let answer = onset(&path, &format!("--vary r {interval} --minimize k=0.5:3"));
        within(&answer, "value", value);
        within(&answer, "k", if value < 0.0 { 1.5 } else { 1.0 });
    }
}

/// Plane Poiseuille flow: the errors of onset and envelope hold where digits are lost, and so do those of the picture's
/// neighbours in the answer. Truths: Orszag (1971) to the digits of a run with M = 100.
#[test]
fn errors_of_an_onset_hold() {
    for m in [32, 36, 40, 50] {
        let found = json(&format!(
            "critical plane_poiseuille --vary R --from 5600 --to 5900 --minimize k=0.9:1.15 -M {m}"
        ));
        within(&found, "value", 5_772.221_816_21);
        within(&found, "k", 1.020_547_449_285);
        if found["envelope"].is_null() {
            assert!(m < 36, "M = {m}: {found}");
            continue;
        }
        for (name, truth) in [
            ("tau0", 102.967_533),
            ("xi0_squared", 19.225_525_8),
            ("g", -3_056.881_6),
            ("group_velocity", 0.383_098_806),
        ] {
            if !found["envelope"][name].is_null() {
                within(&found, name, truth);
            }
        }
        // Digits that are not known are not printed.
        assert!(number(&found, "/envelope/error/tau0") > 0.0);
    }
}

/// Whatever leads: a wave that takes over from a real mode, and back to one mode by its shape.
#[test]
fn neutral_wavenumbers_of_the_leading_mode() {
    let path = written("crossing.model", MODE_AND_WAVE);
    // Uncoupled: 1 − √r1 = k², and k2² + 2 √r2 = k².
    let ends = [
        (1.0 - 0.5_f64.sqrt()).sqrt(),
        (2.56 + 2.0 * 0.4_f64.sqrt()).sqrt(),
    ];
    for (interval, truth) in [
        ("--from 0.3 --to 1.2", ends[0]),
        ("--from 1.2 --to 3", ends[1]),
        ("--from 3 --to 0.9", ends[1]),
        ("--from 1.9 --to 2.1", ends[1]),
    ] {
        let found = onset(&path, &format!("--vary k {interval}"));
        within(&found, "value", truth);
    }
    // Coupled: the leading growth rate at the answer is zero, and changes sign there.
    let found = onset(&path, "--vary k --from 1.2 --to 3 --set eps=0.05");
    let k = number(&found, "/value");
    close("k", k, 1.956, 1e-3);
    let growth = |k: f64| {
        let found = onset_of_spectrum(&path, k);
        number(&found, "/direct/0/0")
    };
    assert!(growth(k - 1e-6) > 0.0 && growth(k + 1e-6) < 0.0);
    assert!(growth(k).abs() < 1e-12);
    // The real mode by its shape is neutral where the wave grows, and the answer says so.
    let followed = onset(
        &path,
        "--vary k --from 1.0 --to 1.5 --set eps=0.05 --follow",
    );
    close("real mode", number(&followed, "/value"), 1.3061, 1e-4);
    let leading = number(&followed, "/leading_growth");
    let shown = onset_of_spectrum(&path, number(&followed, "/value"));
    close(
        "leading growth",
        leading,
        number(&shown, "/direct/0/0"),
        1e-10,
    );
    assert!(leading > 0.2);
    let line = format!(
        "critical {} --vary k --from 1.0 --to 1.5 --set eps=0.05 --follow",
        path.display()
    );
    let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
    assert!(
        answer.out.contains("another mode grows faster there"),
        "{}",
        answer.out
    );
}

fn onset_of_spectrum(path: &std::path::Path, k: f64) -> Value {
    json(&format!(
        "spectrum {} --k {k} --set eps=0.05",
        path.display()
    ))
}

/// A band of growth narrower than the distance of the places that are looked at.
#[test]
fn a_narrow_band_has_two_ends() {
    let path = written("crests.model", TWO_CRESTS);
    let (r, d, s, k2) = (-0.3_f64, 0.31, 1e3, 2.3_f64);
    let line = format!(
        "critical {} --vary k --from 1 --to 3 --set r={r} --set d={d} --set s={s}",
        path.display()
    );
    // s (k2² − k²)² = r + d
    let root = |side: f64| (k2 * k2 + side * ((r + d) / s).sqrt()).sqrt();
    let found = json(&line);
    within(&found, "value", root(-1.0));
    let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
    assert!(
        answer.err.contains(&format!("{:.6}", root(1.0))),
        "{}",
        answer.err
    );
}

/// What makes no sense is refused, from whatever side it comes.
#[test]
fn questions_without_meaning() {
    for (options, words) in [
        ("--vary r --from 0.2 --to 0.9", "--k"),
        (
            "--vary r --from 0.2 --to 0.2 --k 1",
            "two different numbers",
        ),
        ("--vary r --from nan --to 0.2 --k 1", "finite numbers"),
        ("--vary r --from 0.2 --to inf --k 1", "finite numbers"),
        ("--vary r --from 0.2 --to 0.9 --k 0", "k = 0"),
        ("--vary r --from 0.2 --to 0.9 --k nan", "k = NaN"),
        ("--vary r --from 0.2 --to 0.9 --minimize k=1.3:0.8", "A < B"),
        ("--vary r --from 0.2 --to 0.9 --minimize k=1:1", "A < B"),
        ("--vary r --from 0.2 --to 0.9 --minimize k=-1:1", "A < B"),
        (
            "--vary r --from 0.2 --to 0.9 --minimize k=0.8:1.2 --k 1",
            "exclude each other",
        ),
        (
            "--vary r --from 0.2 --to 0.9 --minimize k=0.8:1.2 --of c2",
            "--of growth",
        ),
        (
            "--vary k --from 0.2 --to 0.9 --minimize k=0.8:1.2",
            "k varies",
        ),
        ("--vary k --from 0.2 --to 0.9 --k 1", "k varies"),
        ("--vary k --from=-0.2 --to 0.9", "k = -0.2"),
        ("--vary q --from 0.2 --to 0.9", "`q`"),
    ] {
        let line = format!("critical swift_hohenberg {options}");
        let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(answer.status, 2, "{line}: {} {}", answer.out, answer.err);
        assert!(answer.err.contains(words), "{line}: {}", answer.err);
        assert_eq!(answer.out, "");
    }
}

/// The picture of a mode that is followed to where it is not converged draws what is.
#[test]
fn pictures_draw_converged_values() {
    let model = built("vibrated_bed");
    let setup = Setup::new(model.clone(), 40).expect("M");
    let request = Request {
        vary: "k",
        between: [0.12, 0.3],
        of: Quantity::Growth,
        k: None,
        minimize: None,
        tracking: Tracking::Fastest,
    };
    let question = Question::new(&setup, &request).expect("a question");
    let found = CriticalReport::compute(&setup, &question, &Silent).expect("a root");
    let curve = found.curve(&setup, &question, &Silent).expect("a curve");
    let finer = Setup::new(model.clone(), 100).expect("M");
    let problem = finer
        .problem(&finer.base(None).expect("a base state"))
        .expect("a problem");
    let finite: Vec<(f64, f64)> = curve
        .points
        .iter()
        .copied()
        .filter(|p| p.1.is_finite())
        .collect();
    let mut sizes: Vec<f64> = finite.iter().map(|p| p.1.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let middle = sizes[sizes.len() / 2];
    for (k, growth) in finite.iter().step_by(4) {
        let spectrum = eigenvalues(&problem, WaveVector::along_x(*k)).expect("a spectrum");
        let parts = spectrum.values.iter().map(|c| (c.re - growth).abs());
        let distance = parts.fold(f64::INFINITY, f64::min);
        assert!(
            distance <= 0.1 * growth.abs().max(middle),
            "{growth} at k = {k}: {distance:.1e}"
        );
    }
}

/// A second mode grows where d − s (r − a)² − w (q² − k²)² > 0: an island that is narrow in r and in k at once, at a place
/// that no scan looks at. It begins at r = a − √(d/s), k = q; the first mode grows from r = 0.8.
#[test]
fn islands_that_are_narrow_in_both_directions() {
    let spec = "model islands \"An island in a second field\";
coordinates { x: periodic; }
parameters { r = 0.1; a = 0.31; s = 400; d = 0.01; q = 1.7; w = 50; on = 0.8; }
fields { u; v; }
let w1 = u + dx(dx(u));
let w2 = q^2*v + dx(dx(v));
balance {
    eu: dt(u) = (r - on)*u - w1 - dx(dx(w1)) - u^3 - u*v^2;
    ev: dt(v) = (d - s*(r - a)^2)*v - w*(q^2*w2 + dx(dx(w2))) - v^3 - v*u^2;
}
base { u = 0; v = 0; }
amplitude { integral(|u|^2 + |v|^2) = 1; }
";
    let path = written("islands.model", spec);
    for (values, value, k) in [
        ("", 0.305, 1.7),
        ("--set w=1", 0.305, 1.7),
        ("--set s=2 --set d=0.003", 0.31 - 0.0015_f64.sqrt(), 1.7),
        // In the step in which the first mode begins to grow.
        ("--set on=0.35", 0.305, 1.7),
        ("--set on=0.316 --set q=1.4171", 0.305, 1.4171),
        ("--set a=0.9", 0.8, 1.0),
    ] {
        for range in ["0.5:2.5", "0.9:1.8"] {
            let options = format!("--vary r --from 0 --to 1 --minimize k={range} {values}");
            let answer = onset(&path, &options);
            within(&answer, "value", value);
            within(&answer, "k", k);
        }
    }
}

/// Zero is a value of a parameter like others, between walls too: growth is r − r0 − (1 − k²)² − (n² − 1) π².
#[test]
fn onsets_at_zero_between_walls() {
    let spec = "model zero_onset \"Onset at r = r0 between walls\";
coordinates { x: periodic; z: 0..1; }
parameters { r = 0.1; r0 = 0; }
fields { u; }
let w = u + dx(dx(u));
balance { e: dt(u) = (r - r0)*u - (w + dx(dx(w))) + dz(dz(u)) + pi^2*u - u^3; }
base { u = 0; }
boundary { at z = 0 { u = 0; } at z = 1 { u = 0; } }
amplitude { at z = 1/2 { u = 1; } }
";
    let path = written("zero_onset.model", spec);
    for interval in ["--from=-0.7 --to 1", "--from 0 --to 1", "--from 1 --to=-1"] {
        for value in [0.0, 1e-6, 1e-3] {
            let options = format!("--vary r {interval} --set r0={value} --minimize k=0.6:1.9");
            let answer = onset(&path, &options);
            within(&answer, "value", value);
            within(&answer, "k", 1.0);
        }
    }
    // A root beyond the end of the interval is no answer.
    let line = format!(
        "critical {} --vary r --from 0.1 --to 0.19999999 --set r0=0.2 --minimize k=0.6:1.9",
        path.display()
    );
    let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(answer.status, 3, "{}", answer.out);
}
