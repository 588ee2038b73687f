//! One mode beyond third order, and its envelope: coefficients that are exact or of an independent program of 200 bits,
//! and the fully nonlinear bed.

use crate::support::{close, json, landau, number, written};
use landau_solver::model::C64;

#[test]
fn higher_orders_of_one_mode() {
    let c4 = |line: &str, expected: C64, tolerance: f64| {
        let found = json(&format!("point {line} --order 5"));
        let c4 = C64::new(number(&found, "/c4/0"), number(&found, "/c4/1"));
        let (difference, size) = ((c4 - expected).norm(), expected.norm());
        assert!(
            difference <= tolerance * size,
            "{line}: {c4} instead of {expected}"
        );
        assert!(
            difference <= 2.0 * number(&found, "/error/c4") + 1e-9 * size,
            "{line}"
        );
    };
    let real = |x: f64| C64::new(x, 0.0);
    for b in [0.0_f64, 0.5, 1.0, -1.3] {
        let (b2, b4) = (b * b, b.powi(4));
        let exact = 3.0 / 64.0 - 6953.0 * b2 / 432.0 - 301_349.0 * b4 / 11664.0;
        c4(
            &format!("swift_hohenberg --k 1 --set r=0 --set b={b}"),
            real(exact),
            1e-8,
        );
    }
    c4(
        "swift_hohenberg --k 1 --set r=0.1 --set b=1",
        real(-29.893_618_010_920_69),
        1e-8,
    );
    let ks = "kuramoto_sivashinsky --k 1 --set nu=";
    let waves = C64::new(-2.175_925_925_925_926e-4, -4.675_925_925_925_926e-4);
    c4(&format!("{ks}1 --set delta=1"), waves, 1e-8);
    for nu in [0.9_f64, 1.4] {
        let exact = -3.0 / (8.0 * (7.0 * nu - 1.0).powi(2) * (13.0 * nu - 1.0));
        // Off criticality the problems carry shifts: exact at onset alone.
        if nu == 1.0 {
            c4(&format!("{ks}{nu} --set delta=0"), real(exact), 1e-8);
        }
    }
    let strip = "swift_hohenberg_strip --k 1 -M 40 --set";
    c4(
        &format!("{strip} b=1 --set r=1"),
        real(-22.510_024_109_642_609),
        1e-8,
    );
    c4(
        &format!("{strip} b=1 --set r=1.1"),
        real(-16.151_795_656_340_954),
        1e-8,
    );
    c4(
        &format!("{strip} b=0.5 --set r=1"),
        real(-2.957_036_039_559_663),
        1e-8,
    );
    for pr in [0.71_f64, 1.0, 7.0] {
        let exact =
            -27.0 * std::f64::consts::PI.powi(6) * pr * (3987.0 * pr * pr + 16514.0 * pr - 7969.0)
                / (218_624.0 * (1.0 + pr).powi(3));
        let line = format!(
            "rayleigh_benard --k 2.221441469079183 --set walls=free --set Ra=657.5113644795163 --set Pr={pr} -M 32"
        );
        c4(&line, real(exact), 1e-6);
    }
    for (pr, exact) in [
        (0.71, -1_442.763_319),
        (1.0, -1_841.963_326),
        (7.0, -2_697.683_917),
    ] {
        let line = format!(
            "rayleigh_benard --k 3.116323554821122 --set Ra=1707.761777104718 --set Pr={pr} -M 32"
        );
        c4(&line, real(exact), 1e-6);
    }
}

#[test]
fn higher_orders_of_poiseuille() {
    for (model, expected) in [
        ("plane_poiseuille", 127_465.968),
        ("plane_poiseuille_flux", -300_294.872),
    ] {
        let line =
            format!("point {model} --k 1.02054744928533 --set R=5772.2218162097 -M 80 --order 5");
        close(
            model,
            number(&json(&line), "/c4/0"),
            expected,
            1e-6 * expected.abs() + 2e-1,
        );
    }
}

/// The bed's amplitudes by order; the fully nonlinear state is what they tend to.
#[test]
fn amplitudes_of_the_bed_by_order() {
    // In units where the largest |v̂| on the grid is 1: ratios alone are compared.
    let table = [
        (
            0.174,
            [0.005_348_78, 0.005_294_86, 0.005_292_91],
            0.053_931_35,
        ),
        (0.173, [0.009_205_98, 0.008_965_82, 0.008_945_89], f64::NAN),
        (
            0.17,
            [0.016_741_10, 0.015_707_19, 0.015_560_18],
            0.157_297_09,
        ),
        (0.16, [f64::NAN; 3], 0.290_899_54),
    ];
    let series = [
        (0.174, 0.054_502_4, 0.053_933_1),
        (0.17, 0.170_466_9, 0.158_441_9),
        (0.16, 0.360_932_7, 0.306_972_6),
    ];
    for (k, by_order, nonlinear) in table {
        let found = json(&format!("point vibrated_bed --k {k} -M 40 --order 7"));
        let [a3, a5, a7] = ["3", "5", "7"].map(|o| number(&found, &format!("/amplitudes/{o}")));
        if by_order[0].is_finite() {
            close("order 5 over 3", a5 / a3, by_order[1] / by_order[0], 2e-6);
            close("order 7 over 3", a7 / a3, by_order[2] / by_order[0], 5e-6);
        }
        if let Some((_, third, seventh)) = series.iter().find(|(other, ..)| *other == k) {
            close("order 3", a3, *third, 5e-6);
            close("order 7", a7, *seventh, 5e-6);
        }
        if nonlinear.is_finite() {
            let [d3, d5, d7] = [a3, a5, a7].map(|a| (a - nonlinear).abs());
            assert!(
                d7 < d5 && d5 < d3,
                "k = {k}: {a3} {a5} {a7} against {nonlinear}"
            );
            let pade = number(&found, "/amplitudes/pade");
            assert!(
                (pade - nonlinear).abs() < d7 || d7 < 1e-5,
                "k = {k}: Padé {pade}"
            );
        }
    }
    let near = json("point vibrated_bed --k 0.174 -M 40 --order 7");
    close(
        "c6",
        number(&near, "/c6/0"),
        -2.2768632,
        number(&near, "/error/c6"),
    );
}

/// u_t = r u − (1 + ∂xx)² u + b u³ − u⁵: c2 = 3b, c4 = −10 + 3b²/64.
#[test]
fn quintic_swift_hohenberg() {
    let text = "model quintic \"Quintic Swift–Hohenberg equation\";
coordinates { x: periodic; }
parameters { r = 0; b = 1; }
fields { u; }
balance { evolution: dt(u) = r*u - (u + 2*dx(dx(u)) + dx(dx(dx(dx(u))))) + b*u^3 - u^5; }
base { u = 0; }
amplitude { u = 1; }
";
    let path = written("quintic.model", text);
    for b in [1.0_f64, -0.4, 3.0] {
        let found = json(&format!(
            "point {} --k 1 --set b={b} --order 7",
            path.display()
        ));
        close("c2", number(&found, "/c2/0"), 3.0 * b, 1e-12 * b.abs());
        close(
            "c4",
            number(&found, "/c4/0"),
            -10.0 + 3.0 * b * b / 64.0,
            1e-11,
        );
    }
    // dA/dt = r A + 3b A³ + c4 A⁵ at r < 0: the smaller root is the unstable branch.
    let found = json(&format!(
        "point {} --k 1 --set b=1 --set r=-0.05 --order 5",
        path.display()
    ));
    let (a0, a2, a4) = (-0.05, number(&found, "/c2/0"), number(&found, "/c4/0"));
    let square = (-a2 + (a2 * a2 - 4.0 * a4 * a0).sqrt()) / (2.0 * a4);
    close("A_e", number(&found, "/amplitudes/5"), square.sqrt(), 1e-12);
}

#[test]
fn envelopes() {
    let envelope = |line: &str, slope: [f64; 2], curvature: [f64; 2], number_of: Option<f64>| {
        let found = json(&format!("point {line}"));
        let size = curvature[0].hypot(curvature[1]);
        for i in 0..2 {
            let at = |key: &str| number(&found, &format!("/envelope/{key}/{i}"));
            close(line, at("dc0_dk"), slope[i], 1e-9 * size);
            close(line, at("d2c0_dk2"), curvature[i], 1e-9 * size);
        }
        if let Some(expected) = number_of {
            close(
                line,
                number(&found, "/envelope/benjamin_feir"),
                expected,
                1e-8,
            );
        }
    };
    envelope(
        "rayleigh_benard --k 3.116323554821122 --set Ra=1707.761777104718 -M 32",
        [0.0, 0.0],
        [-3.848_453_562_852, 0.0],
        None,
    );
    let free = "rayleigh_benard --k 2.221441469079183 --set walls=free --set Ra=657.5113644795163 -M 32 --set Pr=";
    for pr in [0.71, 3.0] {
        envelope(
            &format!("{free}{pr}"),
            [0.0, 0.0],
            [-8.0 * pr / (1.0 + pr), 0.0],
            None,
        );
    }
    envelope(
        "plane_poiseuille --k 1.02054744928533 --set R=5772.2218162097 -M 80",
        [0.0, -0.383_098_805_761_5],
        [-0.373_428_889_595_3, -0.054_962_988_874_6],
        Some(0.287_263_017_16),
    );
    envelope(
        "kuramoto_sivashinsky --k 0.9 --set nu=0.9 --set delta=1",
        [-0.8244, 2.43],
        [-6.748, 5.4],
        None,
    );
    envelope(
        "brusselator --k 0.8 --set A=2 --set B=6 --set D1=1 --set D2=0.3 --near 0,1",
        [-1.04, 1.001_581_512_769],
        [-1.3, 0.701_208_479_138_3],
        Some(0.264_406_879_807),
    );
}

/// τ0 ∂A/∂t = ε A + ξ0² ∂²A/∂x² − g |A|²A at the extremum of a neutral curve.
#[test]
fn onsets() {
    let critical = |line: &str| json(&format!("critical {line}"));
    let values = |found: &serde_json::Value| {
        ["tau0", "xi0_squared", "g"].map(|name| number(found, &format!("/envelope/{name}")))
    };
    // Free walls, exact: (σ + q²)(σ/Pr + q²) q² = Ra k² with q² = k² + π², k² = π²/2; c2 = −9π⁴ Pr/(8 (1 + Pr)).
    for pr in [0.71, 7.0] {
        let found = critical(&format!(
            "rayleigh_benard --vary Ra --from 500 --to 900 --minimize k=1.5:3 --set walls=free --set Pr={pr} -M 30"
        ));
        let pi2 = std::f64::consts::PI.powi(2);
        let exact = [
            2.0 * (1.0 + 1.0 / pr) / (3.0 * pi2),
            8.0 / (3.0 * pi2),
            0.75 * pi2,
        ];
        for (found, exact) in values(&found).iter().zip(exact) {
            close("free walls", *found, exact, 1e-8 * exact);
        }
    }
    // Rigid walls: Cross & Hohenberg (1993): 1/τ0 = 19.65 Pr/(Pr + 0.5117), ξ0² = 0.148.
    for pr in [0.7, 1.0, 10.0] {
        let found = critical(&format!(
            "rayleigh_benard --vary Ra --from 1500 --to 2000 --minimize k=2.5:4 --set Pr={pr} -M 30"
        ));
        let [tau0, xi0_squared, _] = values(&found);
        close("τ0", tau0, (pr + 0.5117) / (19.65 * pr), 2e-5);
        close("ξ0²", xi0_squared, 0.148, 5e-4);
    }
    // A parameter that is zero at onset measures the distance itself: τ0 = 1, ξ0² = 4, g = 3 − 4b² − 2b²/9.
    let found =
        critical("swift_hohenberg --vary r --from -0.3 --to 0.4 --minimize k=0.8:1.3 --set b=0.5");
    assert_eq!(found["envelope"]["epsilon"], "r");
    for (found, exact) in values(&found).iter().zip([1.0, 4.0, 3.0 - 19.0 / 18.0]) {
        close("Swift-Hohenberg", *found, exact, 1e-9);
    }
    // ∂ψ/∂t = [(r − 2)(1 + i s) + i w − (1 + i b)(1 + ∂²)²] ψ − (1 + i c) |ψ|²ψ for ψ = p + i q = 2 A e^{iθ}; onset from
    // above in r, or from below in its negative.
    let spec = "model wave \"Complex Swift-Hohenberg equation\";
coordinates { x: periodic; }
parameters { r = 2; w = 1; s = 0.3; b = 0.7; c = -0.4; way = up in {up, down}; }
fields { p; q; }
let e = select way { up: r - 2, down: 2 - r };
let wide(f) = f + 2*dx(dx(f)) + dx(dx(dx(dx(f))));
balance {
    real:      dt(p) = e*p - (e*s + w)*q - wide(p) + b*wide(q) - (p^2 + q^2)*(p - c*q);
    imaginary: dt(q) = e*q + (e*s + w)*p - wide(q) - b*wide(p) - (p^2 + q^2)*(q + c*p);
}
base { p = 0; q = 0; }
amplitude { p = 1; }
";
    let path = written("wave.model", spec);
    for (way, words) in [("up", "r/2 − 1"), ("down", "1 − r/2")] {
        let found = critical(&format!(
            "{} --vary r --from 1.5 --to 2.6 --minimize k=0.7:1.2 --set way={way}",
            path.display()
        ));
        close("r_c", number(&found, "/value"), 2.0, 1e-10);
        for (found, exact) in values(&found).iter().zip([0.5, 2.0, 2.0]) {
            close(way, *found, exact, 1e-8);
        }
        assert_eq!(found["envelope"]["epsilon"], words);
        // The mode may be ψ's or that of its conjugate.
        let sign = number(&found, "/c0/1");
        close("w", sign.abs(), 1.0, 1e-10);
        for (name, exact) in [
            ("frequency_shift", 0.3),
            ("dispersion", 0.7),
            ("nonlinear_dispersion", -0.4),
        ] {
            let value = number(&found, &format!("/envelope/{name}"));
            close(name, value, sign * exact, 1e-8);
        }
        close("v", number(&found, "/envelope/group_velocity"), 0.0, 1e-8);
    }
}

/// The mirror x → −x holds to third degree and is broken by a term of fourth degree: the series goes on in complex
/// numbers. Truths: an independent expansion in 40 digits.
#[test]
fn a_mirror_that_breaks_at_fourth_degree() {
    for (term, c6) in [
        ("u*dx(u)^3", 0.382_004_820_63),
        ("dx(u^4)", -6.952_015_768_4),
    ] {
        let spec = format!(
            "model broken_mirror \"Swift–Hohenberg with a term of fourth degree\";\n\
             coordinates {{ x: periodic; }}\n\
             parameters {{ r = 0.1; }}\n\
             fields {{ u; }}\n\
             let w = u + dx(dx(u));\n\
             balance {{ e: dt(u) = r*u - w - dx(dx(w)) - u^3 + {term}; }}\n\
             base {{ u = 0; }}\n\
             amplitude {{ u = 1; }}\n"
        );
        let path = written("broken_mirror.model", &spec);
        let point = json(&format!("point {} --k 1 --order 7", path.display()));
        close("c4", number(&point, "/c4/0"), 0.046_728_971_962_6, 1e-12);
        close("c6", number(&point, "/c6/0"), c6, 1e-10);
        let line = format!("verify {} --k 1 --order 5", path.display());
        let certificate = landau(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(certificate.status, 0, "{}", certificate.out);
    }
}
