//! Names of Greek letters, for file formats and identifiers that take Latin letters alone.

const SMALL: [(char, &str); 28] = [
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "epsilon"),
    ('ϵ', "epsilon"),
    ('ζ', "zeta"),
    ('η', "eta"),
    ('θ', "theta"),
    ('ϑ', "theta"),
    ('ι', "iota"),
    ('κ', "kappa"),
    ('λ', "lambda"),
    ('μ', "mu"),
    // The sign of a millionth.
    ('µ', "mu"),
    ('ν', "nu"),
    ('ξ', "xi"),
    ('π', "pi"),
    ('ρ', "rho"),
    ('σ', "sigma"),
    ('ς', "sigma"),
    ('τ', "tau"),
    ('υ', "upsilon"),
    ('φ', "phi"),
    ('ϕ', "phi"),
    ('χ', "chi"),
    ('ψ', "psi"),
    ('ω', "omega"),
];

/// Whether a letter is called so.
pub fn names_a_letter(name: &str) -> bool {
    SMALL.iter().any(|(_, greek)| *greek == name)
}

/// The name of a small letter.
pub fn small_greek(letter: char) -> Option<&'static str> {
    let entry = SMALL.iter().find(|(small, _)| *small == letter);
    entry.map(|(_, name)| *name)
}

/// The name of a small letter, or of the small one of a capital.
pub fn greek(letter: char) -> Option<&'static str> {
    small_greek(letter).or_else(|| {
        let mut small = letter.to_lowercase();
        small.next().and_then(small_greek)
    })
}
