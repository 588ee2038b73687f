//! Models with exact or published numbers, through the command line's own path.
//!
//! The exact values follow from the amplitude expansion by hand; the others were computed to
//! 200 bits and confirmed by fully nonlinear codes.

use crate::support::{close, json, landau, number};

#[test]
fn swift_hohenberg_line() {
    for (r, b, k) in [(0.1, 1.0, 1.0), (0.3, 0.4, 0.93), (-0.2, 1.7, 1.08)] {
        let q = (1.0 - f64::powi(k, 2)).powi(2);
        let q2 = (1.0 - 4.0 * f64::powi(k, 2)).powi(2);
        let c2 = -3.0 + 4.0 * b * b / (r + 1.0 - 2.0 * q) + 2.0 * b * b / (r - 2.0 * q + q2);
        let found = json(&format!(
            "point swift_hohenberg --k {k} --set r={r} --set b={b}"
        ));
        close("c0", number(&found, "/c0/0"), r - q, 1e-12);
        close("c2", number(&found, "/c2/0"), c2, 1e-10 * c2.abs());
    }
}

#[test]
fn swift_hohenberg_strip() {
    for (r, b, c2) in [
        (1.0, 1.0, -2.25 + 3.058_475_500_030_313),
        (1.1, 1.0, 0.544_552_684_231_559_4),
        (1.0, 0.5, -1.485_381_124_992_421_7),
    ] {
        let found = json(&format!(
            "point swift_hohenberg_strip --k 1 -M 24 --set r={r} --set b={b}"
        ));
        close("c0", number(&found, "/c0/0"), r - 1.0, 1e-10);
        close("c2", number(&found, "/c2/0"), c2, 1e-10);
    }
}

#[test]
fn kuramoto_sivashinsky() {
    for (nu, delta) in [(1.0, 1.0), (1.0, 0.0), (0.8, 0.3)] {
        // c2 = −1/(2(7ν − 1) − 6iδ)
        let (re, im) = (2.0 * (7.0 * nu - 1.0), -6.0 * delta);
        let square = re * re + im * im;
        let found = json(&format!(
            "point kuramoto_sivashinsky --k 1 --set nu={nu} --set delta={delta}"
        ));
        close("a0", number(&found, "/c0/0"), 1.0 - nu, 1e-12);
        close("b0", number(&found, "/c0/1"), delta, 1e-12);
        close("a2", number(&found, "/c2/0"), -re / square, 1e-10);
        close("b2", number(&found, "/c2/1"), im / square, 1e-10);
    }
}

#[test]
fn brusselator() {
    let line = json("point brusselator --k 2");
    close("c2", number(&line, "/c2/0"), -1.0, 1e-10);
    close("dc0/dB", number(&line, "/dc0/B/0"), 2.0 / 3.0, 1e-9);
    for height in ["0.3", "0.7", "2"] {
        let strip = json(&format!(
            "point brusselator_strip --k 2 -M 16 --set h={height}"
        ));
        close("c2 of the strip", number(&strip, "/c2/0"), -1.0, 1e-9);
    }
    let critical = json("critical brusselator --vary B --from 3 --to 5 --minimize k=1.5:2.5");
    close("B_c", number(&critical, "/value"), 4.0, 1e-9);
    close("k_c", number(&critical, "/k"), 2.0, 1e-6);
}

#[test]
fn rayleigh_benard_free() {
    let (pi, k) = (std::f64::consts::PI, std::f64::consts::PI / 2.0_f64.sqrt());
    let rayleigh = 27.0 * pi.powi(4) / 4.0;
    for prandtl in [0.7, 1.0, 7.0] {
        let found = json(&format!(
            "point rayleigh_benard --k {k} -M 24 --set walls=free --set Ra={rayleigh} --set Pr={prandtl}"
        ));
        let c2 = -9.0 * pi.powi(4) / 8.0 * prandtl / (1.0 + prandtl);
        close("c0", number(&found, "/c0/0"), 0.0, 1e-9);
        close("c2", number(&found, "/c2/0"), c2, 1e-9 * c2.abs());
        // d(Nu − 1)/dε = Nu2 · Ra_c dc0/dRa / (−c2)
        let slope =
            number(&found, "/outputs/nusselt/1") * rayleigh * number(&found, "/dc0/Ra/0") / -c2;
        close("dNu/dε", slope, 2.0, 1e-7);
    }
}

#[test]
fn rayleigh_benard_rigid() {
    let (rayleigh, k) = (1707.761777104718, 3.116323554821122);
    for (prandtl, slope, c2, nusselt) in [
        (
            0.71,
            0.00668696856873038,
            -151.0868252236843,
            1.410151986580189,
        ),
        (
            1.0,
            0.00761142836307175,
            -170.4557650828144,
            1.422714336209892,
        ),
        (
            7.0,
            0.01072207978755939,
            -238.7135246614527,
            1.431084398860809,
        ),
    ] {
        let found = json(&format!(
            "point rayleigh_benard --k {k} -M 32 --set Ra={rayleigh} --set Pr={prandtl}"
        ));
        close("c2", number(&found, "/c2/0"), c2, 1e-8 * f64::abs(c2));
        close("dc0/dRa", number(&found, "/dc0/Ra/0"), slope, 1e-8 * slope);
        let gain = number(&found, "/outputs/nusselt/1") * rayleigh * slope / -c2;
        close("dNu/dε", gain, nusselt, 1e-7);
    }
    let critical =
        json("critical rayleigh_benard --vary Ra --from 1500 --to 2000 --minimize k=2.5:4 -M 24");
    close(
        "Ra_c",
        number(&critical, "/value"),
        rayleigh,
        1e-9 * rayleigh,
    );
    close("k_c", number(&critical, "/k"), k, 1e-6);
}

#[test]
fn plane_poiseuille() {
    let (reynolds, alpha) = (5772.22181620970, 1.02054744928533);
    let critical =
        json("critical plane_poiseuille --vary R --from 5600 --to 5900 --minimize k=1:1.04 -M 60");
    close(
        "R_c",
        number(&critical, "/value"),
        reynolds,
        1e-7 * reynolds,
    );
    close("alpha_c", number(&critical, "/k"), alpha, 1e-7);
    close(
        "omega",
        number(&critical, "/c0/1"),
        -0.269424792442301,
        1e-7,
    );
    let fixed_gradient = json(&format!(
        "point plane_poiseuille --k {alpha} --set R={reynolds} -M 70"
    ));
    close(
        "a2",
        number(&fixed_gradient, "/c2/0"),
        29.68782061,
        1e-6 * 29.7,
    );
    close(
        "b2",
        number(&fixed_gradient, "/c2/1"),
        -143.76235656,
        1e-6 * 143.8,
    );
    let fixed_flux = json(&format!(
        "point plane_poiseuille_flux --k {alpha} --set R={reynolds} -M 70"
    ));
    close(
        "a2 at fixed flux",
        number(&fixed_flux, "/c2/0"),
        30.95618697,
        1e-6 * 31.0,
    );
    close(
        "b2 at fixed flux",
        number(&fixed_flux, "/c2/1"),
        -172.83352332,
        1e-6 * 172.8,
    );
    let unstable = json("point plane_poiseuille --k 1 --set R=10000 -M 80");
    close(
        "a0 at R = 10000",
        number(&unstable, "/c0/0"),
        0.003739670623,
        1e-9,
    );
    close(
        "b0 at R = 10000",
        number(&unstable, "/c0/1"),
        -0.237526488820,
        1e-9,
    );
}

#[test]
fn granular_couette() {
    let k = std::f64::consts::PI;
    let found = json(&format!(
        "point granular_couette --k {k} --near 0 --set H=26.6442211932569"
    ));
    close("c0", number(&found, "/c0/0"), 0.0, 1e-12);
    close(
        "c2",
        number(&found, "/c2/0"),
        -0.0656628352441,
        1e-6 * 0.0657,
    );
    close(
        "dc0/dH",
        number(&found, "/dc0/H/0"),
        2.93829885e-5,
        1e-8 * 2.9e-5 * 10.0,
    );
    let critical = json(&format!(
        "critical granular_couette --vary H --from 20 --to 35 --k {k}"
    ));
    close(
        "H_c",
        number(&critical, "/value"),
        26.6442211932569,
        1e-8 * 26.6,
    );
    // Long waves become unstable: the limit k/H → 0 by Richardson's extrapolation in H⁻².
    let onset = |gap: f64| {
        let line = format!("critical granular_couette --vary phi0 --from 0.12 --to 0.19 --k {k}");
        number(&json(&format!("{line} --set H={gap} --near 0")), "/value")
    };
    let limit = (9.0 * onset(3000.0) - onset(1000.0)) / 8.0;
    close("long waves", limit, 0.154044114980447, 1e-8);
    // c2 changes sign on the neutral curve, at 0.17323 as printed.
    let c2 = |fraction: f64| {
        let line = format!("--k {k} --set phi0={fraction}");
        let gap = json(&format!(
            "critical granular_couette --vary H --from 20 --to 100 {line}"
        ));
        let line = format!("{line} --near 0 --set H={}", number(&gap, "/value"));
        number(&json(&format!("point granular_couette {line}")), "/c2/0")
    };
    assert!(c2(0.173225) > 0.0 && c2(0.173235) < 0.0);
}

/// The critical point of plane Poiseuille flow from intervals far from it and in either direction.
#[test]
fn poiseuille_from_many_intervals() {
    let from = [200.0, 2000.0, 5000.0, 5700.0];
    let to = [5850.0, 8000.0, 30_000.0];
    let bands = [(0.4, 1.2), (0.9, 3.5), (1.0, 1.05)];
    for (i, from) in from.into_iter().enumerate() {
        for (j, to) in to.into_iter().enumerate() {
            let (low, high) = bands[(i + j) % bands.len()];
            let (a, b) = if (i + j) % 2 == 0 {
                (from, to)
            } else {
                (to, from)
            };
            let line = format!(
                "critical plane_poiseuille --vary R --from {a} --to {b} --minimize k={low}:{high} -M 56"
            );
            let found = json(&line);
            close(&line, number(&found, "/value"), 5_772.221_816_2, 1e-4);
            close(&line, number(&found, "/k"), 1.020_547_449_3, 1e-7);
        }
    }
    // The growth of the range rises to its end; or does not change sign at all.
    for (line, text) in [
        (
            "--from 5000 --to 9000 --minimize k=1.03:1.08",
            "at the end k = 1.03",
        ),
        (
            "--from 3000 --to 5000 --minimize k=0.9:1.1",
            "does not change sign",
        ),
    ] {
        let line = format!("critical plane_poiseuille --vary R {line} -M 56");
        let answer = landau(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(answer.status, 3, "{line}: {}", answer.out);
        assert!(answer.err.contains(text), "{line}: {}", answer.err);
    }
}
