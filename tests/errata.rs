//! Printed formulas against the derivation: what agrees, what does not, what is refused.

use crate::support::{Answer, landau};
use std::fs;

const FILE: &str = "spec/errata/shukla2014.toml";

/// Compares the formulas of a file of errata with the vibrated bed.
fn against(text: &str) -> Answer {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("printed.toml");
    fs::write(&file, format!("source = \"a test\"\n{text}")).expect("written");
    let path = file.to_str().expect("a path");
    landau(&["explain", "vibrated_bed", "--against", path])
}

#[test]
fn the_paper_agrees_or_its_slips_are_proved() {
    let answer = landau(&["explain", "vibrated_bed", "--against", FILE]);
    assert_eq!(answer.status, 0, "{}{}", answer.out, answer.err);
    let verdict = |start: &str| {
        let mut lines = answer.out.lines();
        let line = lines.find(|line| line.starts_with(start));
        line.unwrap_or_else(|| panic!("{start} is not in\n{}", answer.out))
            .ends_with("agrees")
    };
    // P: the square of (2.13) is missing in (2.20), gravity has the wrong sign in (2.8) and (2.18),
    // (4.7) contradicts (3.4), (6.4) holds y for the fields, l31† has a term too many.
    for wrong in [
        "(2.8)",
        "(2.18)",
        "(2.20), f4",
        "(4.7), u' at y = 0",
        "(6.4), u'",
        "(6.4), v'",
        "(6.4), T'",
        "(A 2), l31†",
        "(B 3)",
        "(B 5)",
        "(B 6)",
        "(B 7)",
    ] {
        assert!(!verdict(wrong), "{wrong} agrees");
    }
    for right in [
        "(2.17)",
        "(2.19)",
        "(2.20), f1",
        "(2.24)",
        "(3.11), u† at y = 0",
        "(6.6), T† at y = H",
        "(A 1), l44",
        "(A 2), l33†",
        "(B 2)",
    ] {
        assert!(verdict(right), "{right} differs");
    }
}

#[test]
fn a_sign_planted_in_a_printed_formula_is_found() {
    let entry = |printed: &str| {
        against(&format!(
            "[[formula]]\nnumber = \"l22\"\nabout = {{ linear = {{ balance = \"momentum_x\", field = \"u\" }} }}\nprinted = \"{printed}\""
        ))
    };
    let right = entry("1/n0*((2*mu0 + lambda0)*dx(dx(u)) + mu0_y*dy(u) + mu0*dy(dy(u)))");
    assert_eq!(right.status, 0, "{}", right.err);
    // The chain rule is seen through.
    let opened = "(mu0_n*n0_y + mu0_T*T0_y)";
    let right = entry(&format!(
        "1/n0*((2*mu0 + lambda0)*dx(dx(u)) + {opened}*dy(u) + mu0*dy(dy(u)))"
    ));
    assert_eq!(right.status, 0, "{}", right.err);
    let wrong = entry("1/n0*((2*mu0 + lambda0)*dx(dx(u)) - mu0_y*dy(u) + mu0*dy(dy(u)))");
    assert_eq!(wrong.status, 3, "{}", wrong.out);
    assert!(
        wrong
            .out
            .contains("printed -mu⁰_y/n⁰ u'_y, derived mu⁰_y/n⁰ u'_y"),
        "{}",
        wrong.out
    );
    assert!(wrong.err.contains("no slip says why"), "{}", wrong.err);
}

#[test]
fn a_formula_may_be_printed_for_set_parameters() {
    // f5 of P (2.20) for e = 0.9: 1 − e² = 19/100.
    let entry = |set: &str| {
        against(&format!(
            "[[abbreviation]]\nname = \"l\"\ntext = \"sqrt(3/32)*(1/n - 1)/(1 - (1 - sqrt(3/8))*n)\"\n[[formula]]\nnumber = \"f5\"\nabout = {{ law = \"D\" }}\nset = [\"{set}\"]\nprinted = \"19/100/gamma_c/l*n*T^(3/2)\""
        ))
    };
    assert_eq!(entry("e=0.9").status, 0, "{}", entry("e=0.9").err);
    assert_eq!(entry("e=0.8").status, 3);
    let answer = entry("e=much");
    assert_eq!(answer.status, 2);
    assert!(answer.err.contains("value of `e` `much`"), "{}", answer.err);
}

#[test]
fn a_slip_that_is_none_is_refused() {
    let text = "[[formula]]\nnumber = \"(2.24)\"\nabout = { base = \"momentum_y\" }\nprinted = \"-dy(p0) - n0/S = 0\"\n[[formula.slip]]\nprinted = \"n0/S\"\nderived = \"1/S*n0\"\nverdict = \"misprint\"";
    let answer = against(text);
    assert_eq!(answer.status, 3, "{}", answer.out);
    assert!(answer.err.contains("`n0/S` is no slip"), "{}", answer.err);
}

#[test]
fn a_formula_that_cannot_be_read_is_named() {
    let cases = [
        ("{ law = \"kapa\" }", "T", "did you mean `kappa`?"),
        (
            "{ base = \"momentum_y\" }",
            "dy(p0) + n0/(S = 0",
            "`(` is never closed",
        ),
        ("{ base = \"momentum_y\" }", "dy(q0) + n0/S", "`q0`"),
        ("{ base = \"mass\" }", "n0 = 0", "base-state balance `mass`"),
        (
            "{ nonlinear = { degree = 4, balance = \"mass\" } }",
            "n",
            "degree `4`",
        ),
    ];
    for (about, printed, expected) in cases {
        let text =
            format!("[[formula]]\nnumber = \"(9.9)\"\nabout = {about}\nprinted = \"{printed}\"");
        let answer = against(&text);
        assert_eq!(answer.status, 2, "{about} {printed}: {}", answer.out);
        assert!(
            answer.err.contains(expected) && answer.err.contains("(9.9)"),
            "{}",
            answer.err
        );
    }
}

/// What papers write, in LaTeX, means what the same says in the language of the spec.
#[test]
fn latex_is_read_as_papers_write_it() {
    let linear = |row: &str, field: &str| {
        format!("{{ linear = {{ balance = \"{row}\", field = \"{field}\" }} }}")
    };
    let nonlinear = || "{ nonlinear = { degree = 2, balance = \"mass\" } }".to_owned();
    let vector = "[[vector]]\nname = \"u\"\ncomponents = [\"u\", \"v\"]\n";
    for (about, latex, status) in [
        // An operator acts on the field that is not written; a coefficient multiplies it.
        (
            linear("mass", "v"),
            r"-\left(n_y^0 + n^0 \frac{\partial}{\partial y}\right)",
            0,
        ),
        // The same with d, with braces, and with a power of one.
        (
            linear("mass", "v"),
            r"-\Big\{n^0_{y} + {n^0}^{1} \frac{d}{dy}\Big\}",
            0,
        ),
        (
            nonlinear(),
            r"-\frac{\partial (n' u')}{\partial x} - \frac{\partial}{\partial y} \left( n' v' \right)",
            0,
        ),
        (
            nonlinear(),
            r"-(\mathbf{u}' \cdot \nabla) n' - n' (\nabla \cdot \mathbf{u}')",
            0,
        ),
        (
            nonlinear(),
            r"-n'_x u' - n' u'_x - n'_y v' - n' \times \frac{\partial v'}{\partial y}",
            0,
        ),
        (
            "{ base = \"momentum_y\" }".to_owned(),
            r"\frac{dp}{dy} + \frac{n}{S} = 0",
            0,
        ),
        ("{ law = \"p\" }".to_owned(), r"n T [(1 + n)/(1 - n)]", 0),
        // A notation that is not known is named, not guessed.
        (linear("mass", "v"), r"-n_y^0 - n^0 \partial_y", 2),
        (nonlinear(), r"-\operatorname{div}(n' u')", 2),
    ] {
        let text = format!(
            "{vector}[[formula]]\nnumber = \"l\"\nabout = {about}\nlatex = '''{latex}'''\n"
        );
        let answer = against(&text);
        assert_eq!(
            answer.status, status,
            "{latex}: {}{}",
            answer.out, answer.err
        );
    }
}

/// A sign, an index, a mark and a bracket planted in LaTeX are seen.
#[test]
fn slips_in_latex_are_seen() {
    let of = |latex: &str| {
        against(&format!(
            "[[formula]]\nnumber = \"l31\"\nabout = {{ linear = {{ balance = \"momentum_y\", field = \"n\" }} }}\nlatex = '{latex}'\n"
        ))
    };
    let right =
        r"-\frac{1}{n^0} \left(\frac{1}{S} + p_{ny}^0 + p_n^0 \frac{\partial}{\partial y} \right)";
    assert_eq!(of(right).status, 0, "{}", of(right).err);
    for (from, to) in [
        (r"-\frac", r"\frac"),
        ("p_{ny}^0", "p_{Ty}^0"),
        ("p_{ny}^0", "p_{my}^0"),
        ("p_n^0", "p_T^0"),
        ("{n^0}", "{n}"),
        (r" \right)", ""),
        ("partial y", "partial x"),
    ] {
        let wrong = right.replace(from, to);
        let answer = of(&wrong);
        assert_eq!(answer.status, 3, "{wrong}: {}{}", answer.out, answer.err);
        assert!(
            answer.err.contains("no slip says why"),
            "{wrong}: {}",
            answer.err
        );
    }
    let open = of(&right.replace(r" \right)", ""));
    assert!(open.err.contains("1 bracket(s) stay open"), "{}", open.err);
}

#[test]
fn a_file_cannot_make_any_formula_right() {
    let entry = |rest: &str| {
        format!(
            "[[formula]]\nnumber = \"l21†\"\nabout = {{ adjoint = {{ row = \"u\", field = \"n\" }} }}\n{rest}"
        )
    };
    let slip = |printed: &str, derived: &str, more: &str| {
        format!("[[formula.slip]]\nprinted = '{printed}'\nderived = '{derived}'\n{more}")
    };
    let right = r"n^0 \frac{\partial}{\partial x}";
    let latex = |text: &str| format!("latex = '{text}'\n");
    let cases = [
        // A slip that replaces the formula.
        (
            latex("S v^0_y") + &slip("S v^0_y", right, ""),
            "replace most of the formula",
        ),
        // Whose slip it is follows from the rule.
        (
            latex(r"n \frac{\partial}{\partial x}") + &slip("n ", "n^0 ", "verdict = \"misprint\""),
            "follows from its LaTeX by the rule",
        ),
        (
            latex(right) + "printed = 'n0*dx(n)'\n",
            "`latex` or `printed`",
        ),
        (String::new(), "`latex` or `printed`"),
        (
            latex(right) + "where = [['q', 'n']]\n",
            "`q` is not in its text",
        ),
        (
            "printed = 'n*dx(n)'\n".to_owned() + &slip("n*", "n0*", ""),
            "needs a `verdict`",
        ),
    ];
    for (rest, expected) in cases {
        let answer = against(&entry(&rest));
        assert_eq!(answer.status, 2, "{rest}: {}{}", answer.out, answer.err);
        assert!(answer.err.contains(expected), "{rest}: {}", answer.err);
    }
}

/// Every formula of the file is in the source's own LaTeX, and the rule decides for all of them.
#[test]
fn the_paper_is_quoted_in_latex() {
    let text = fs::read_to_string(crate::support::root().join(FILE)).expect("the file");
    let count = |what: &str| text.lines().filter(|line| line.starts_with(what)).count();
    // Six remarks quote a formula too.
    assert_eq!(count("latex = "), count("[[formula]]") + 6);
    assert_eq!(count("verdict"), 0);
    let answer = landau(&["explain", "vibrated_bed", "--against", FILE]);
    for expected in [
        r"`\mu_{my}^0` for `\mu_{nny}^0`, misreading by the copy",
        r"`\mu_{Ty}^0 T'^2` for `\mu_{TTy}^0 T'^2`, misprint",
        r"`\mu_{ny}^0 n'^2` for `\mu_{nny}^0 n'^2`, cannot tell",
        r"`\frac{\partial n T'^2}{\partial y}` for `\frac{\partial n' T'^2}{\partial y}`, cannot tell",
        r"`\right]` for `\right] \Big]`, cannot tell",
        "(2.2), not compared: the mean of cos²",
    ] {
        assert!(
            answer.out.contains(expected),
            "{expected} is not in\n{}",
            answer.out
        );
    }
}
