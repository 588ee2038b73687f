//! The Landau coefficient over a range of r, by calls of the library rather than of the command line.

use landau_solver::error::Result;
use landau_solver::study::Setup;
use landau_solver::weakly::Selection;

include!(concat!(env!("OUT_DIR"), "/models.rs"));

/// c0 and c2 at wavenumber 1; by hand the second harmonic is −i/(9 + r), and so c2 = −1/(9 + r).
fn coefficients(r: f64) -> Result<(f64, f64)> {
    let models = models();
    let mut setup = Setup::new(models[0].clone(), 4).expect("M");
    setup
        .parameters
        .set_text(setup.model.structure(), "r", &r.to_string())?;
    let base = setup.base(None)?;
    let found = setup.point(&base, 1.0, Selection::Leading)?;
    Ok((found.c0.re, found.c2.re))
}

fn main() -> Result<()> {
    println!("{:>6} {:>12} {:>14}", "r", "c0", "c2");
    for step in 0..=5 {
        let r = 0.1 * f64::from(step);
        let (c0, c2) = coefficients(r)?;
        println!("{r:>6.2} {c0:>12.8} {c2:>14.10}");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use landau_solver::study::Setup;

    /// A model whose name is a word of Rust, two balances whose names differ in case alone, and a parameter that
    /// takes whole numbers: c0 = r − k² − 1/m².
    #[test]
    fn names_of_any_kind() {
        let models = super::models();
        let model = models
            .iter()
            .find(|m| m.structure().name == "type")
            .expect("the model");
        let mut setup = Setup::new(model.clone(), 20).expect("M");
        for m in [1.0, 3.0] {
            setup.set(&[format!("m={m}")]).expect("a whole number");
            let base = setup.base(None).expect("a base state");
            let found = setup
                .point(&base, 0.3, landau_solver::weakly::Selection::Leading)
                .expect("a Landau point");
            let expected = 0.1 - 0.09 - 1.0 / (m * m);
            assert!((found.c0.re - expected).abs() < 1e-11, "{}", found.c0);
        }
        assert!(setup.set(&["m=1.5".to_owned()]).is_err());
    }

    #[test]
    fn coefficients_by_hand() {
        for r in [0.0, 0.1, 0.5] {
            let (c0, c2) = super::coefficients(r).expect("a Landau point");
            assert!((c0 - r).abs() < 1e-14, "{c0}");
            assert!((c2 + 1.0 / (9.0 + r)).abs() < 1e-14, "{c2}");
        }
    }
}
