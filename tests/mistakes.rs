//! Studies that cannot be meant: each is refused before any work, with its place and what is accepted.

use crate::reports::{Desk, study};

const CRITICAL: &str = r#"
[[figure.task]]
kind = "critical"
asked = [{ name = "r_c", vary = "r", between = [-0.2, 0.9] }]
[[figure.task.case]]
k = 1.0
"#;

const MINIMUM: &str = r#"
[[figure.task]]
kind = "critical"
asked = [{ name = "r_c", vary = "r", between = [-0.2, 0.9], minimize = [0.5, 1.5] }]
[[figure.task.case]]
"#;

const AGAINST: &str = r#"
[[figure.task]]
kind = "critical"
against = { name = "k", from = 0.8, to = 1.2, count = 5 }
asked = [{ name = "r_c", vary = "r", between = [-0.5, 0.9] }]
[[figure.task.case]]
"#;

const CLAIMS: &str = r#"
[[figure.task]]
kind = "claims"
[[figure.task.claim]]
says = "It grows"
name = "a0"
quantity = "a0"
above = 0.0
[[figure.task.case]]
k = 1.0
"#;

const PLACE: &str = r#"
[[figure.task]]
kind = "claims"
[[figure.task.claim]]
says = "The onset lies at zero"
name = "r_c"
quantity = "place"
at = { name = "r_c", vary = "r", between = [-0.2, 0.9] }
below = 0.1
[[figure.task.case]]
k = 1.0
"#;

const LARGEST: &str = r#"
[[figure.task]]
kind = "claims"
[[figure.task.claim]]
says = "It is largest near 1"
name = "k"
quantity = "largest_growth"
over = { name = "k", from = 0.8, to = 1.2, count = 5 }
above = 0.9
[[figure.task.case]]
"#;

const SWEEP: &str = r#"
[[figure.task]]
kind = "sweep"
over = { name = "r", from = 0.1, to = 0.5, count = 5 }
columns = ["a0"]
[[figure.task.case]]
k = 1.0
"#;

const CONVERGENCE: &str = r#"
[[figure.task]]
kind = "convergence"
over = { name = "r", from = 0.1, to = 0.5, count = 5 }
resolutions = [8, 16]
[[figure.task.case]]
k = 1.0
"#;

const VALUES: &str = r#"
[[figure.task]]
kind = "values"
[[figure.task.case]]
k = 1.0
"#;

const PATTERN: &str = r#"
[[figure.task]]
kind = "pattern"
shade = "u"
wavelengths = 2.0
[[figure.task.case]]
set = ["b=0"]
k = 1.0
"#;

const ORDERS: &str = r#"
[[figure.task]]
kind = "orders"
over = { name = "k", from = 0.9, to = 1.1, count = 3 }
highest = 7
[[figure.task.case]]
"#;

const POWER_LAW: &str = r#"
[[figure.task]]
kind = "power_law"
critical = { name = "r_c", vary = "r", between = [-0.2, 0.9] }
distances = [1e-4, 1e-2]
count = 5
[[figure.task.case]]
set = ["b=0"]
k = 0.9
"#;

const LAW: &str = r#"
[[figure.task]]
kind = "law"
expressions = ["u^2"]
over = { name = "u", from = 0.0, to = 1.0, count = 5 }
[[figure.task.case]]
"#;

/// A task, a piece of it, what cannot be meant in its place (⏎ ends a line), and parts of the message.
const WRONG: &str = r#"
# k is forgotten.
CRITICAL | k = 1.0 |  | task 1 (critical) & `k` is missing & positive number
PLACE | k = 1.0 |  | task 1 (claims) & claim 1 & `k` is missing
CLAIMS | k = 1.0 |  | `k` is missing
LARGEST | name = "k", from | name = "r", from | `k` is missing
SWEEP | k = 1.0 |  | task 1 (sweep) & `k` is missing & positive number
CONVERGENCE | k = 1.0 |  | `k` is missing
VALUES | k = 1.0 |  | `k` is missing
PATTERN | k = 1.0 |  | `k` is missing
POWER_LAW | k = 0.9 |  | `k` is missing
# A wavenumber that is none.
CRITICAL | k = 1.0 | k = 0.0 | k = 0 & positive number
VALUES | k = 1.0 | k = nan | positive number
ORDERS | name = "k" | name = "r" | goes along `k` alone
ORDERS | from = 0.9 | from = -0.9 | positive number
# Ranges.
SWEEP | from = 0.1 | from = nan | from = NaN & finite
SWEEP | to = 0.5 | to = inf | to = inf & finite
SWEEP | from = 0.1 | from = 0.7 | from 0.7 to 0.5 & lower end
SWEEP | from = 0.1 | from = 0.5 | lower end
CRITICAL | [-0.2, 0.9] | [0.9, -0.2] | between = [0.9, -0.2] & the lower first
MINIMUM | [0.5, 1.5] | [1.5, 0.5] | minimize = [1.5, 0.5] & the lower first
MINIMUM | [0.5, 1.5] | [-0.5, 1.5] | minimize & positive number
MINIMUM | vary = "r" | vary = "k" | accepts a parameter
MINIMUM | minimize | of = "c2", minimize | growth rate
AGAINST | vary = "r" | vary = "k" | accepts a parameter
AGAINST | [-0.5, 0.9] } | [-0.5, 0.9], k = 1.0 } | one wavenumber
POWER_LAW | [1e-4, 1e-2] | [1e-2, 1e-4] | the nearer first
POWER_LAW | [1e-4, 1e-2] | [-1e-4, 1e-2] | one sign
POWER_LAW | [1e-4, 1e-2] | [0.0, 1e-2] | one sign
SWEEP | from = 0.1, to = 0.5 | from = -1e308, to = 1e308 | from -1e308 to 1e308 & width is a number
SWEEP | from = 0.1, to = 0.5, count = 5 | from = 1e-300, to = 1e300, count = 5, spacing = "geometric" | quotient
CRITICAL | [-0.2, 0.9] | [-1e308, 1e308] | between = [-1e308, 1e308] & width is a number
# Cases that fix what varies.
SWEEP | k = 1.0 | k = 1.0⏎set = ["r=0.2"] | `r=0.2` stands beside an axis of r & accepts one of the two
SWEEP | name = "r" | name = "k" | k = 1 stands beside an axis of k & accepts one of the two
ORDERS | [[figure.task.case]] | [[figure.task.case]]⏎k = 1.0 | k = 1 stands beside an axis of k
AGAINST | [[figure.task.case]] | [[figure.task.case]]⏎k = 1.0 | k = 1 stands beside an axis of k
POWER_LAW | set = ["b=0"] | set = ["r=0"] | `r=0` stands beside an axis of r
VALUES | k = 1.0 | k = 1.0⏎set = ["r=0.1", "r=0.2"] | `r` is set twice, by `r=0.1` and by `r=0.2`
# Counts.
SWEEP | count = 5 | count = 1000000000 | count = 1000000000 & from 2 to 10000
SWEEP | count = 5 | count = 1 | count = 1 & from 2 to 10000
SWEEP | count = 5 | count = -3 | count
POWER_LAW | count = 5 | count = 100000 | count = 100000 & from 3 to 1000
CONVERGENCE | [8, 16] | [8, 0] | M = 0 is out of range: M accepts 4 to 1000
CONVERGENCE | [8, 16] | [8, 100000] | M = 100000 is out of range: M accepts 4 to 1000
CONVERGENCE | [8, 16] | [] | resolutions & two or more
VALUES | k = 1.0 | k = 1.0⏎resolution = 100000 | M = 100000 is out of range: M accepts 4 to 1000
ORDERS | highest = 7 | highest = 8 | highest = 8 & odd numbers from 5 to 15
ORDERS | highest = 7 | highest = 1001 | odd numbers from 5 to 15
PATTERN | wavelengths = 2.0 | wavelengths = 0.0 | wavelengths = 0 & above 0
PATTERN | wavelengths = 2.0 | wavelengths = nan | wavelengths = NaN & above 0
PATTERN | wavelengths = 2.0 | wavelengths = 1e9 | up to 100
# Empty lists.
SWEEP | ["a0"] | [] | `columns` is empty
SWEEP | ["a0"] | [[]] | one or more
CRITICAL | [{ name = "r_c", vary = "r", between = [-0.2, 0.9] }] | [] | `asked` is empty
SWEEP | [[figure.task.case]]⏎k = 1.0 | case = [] | `case` is empty
# Statements that nothing decides, or that ask for what has no meaning.
CLAIMS | above = 0.0 |  | nothing decides the statement
CLAIMS | above = 0.0 | above = nan | above = NaN & finite
CLAIMS | above = 0.0 | above = 1.0⏎below = 0.0 | above < below
CLAIMS | above = 0.0 | as_first_within = 0.1 | two or more cases
CLAIMS | above = 0.0 | trend = "rising" | two or more cases
CLAIMS | says = "It grows" |  | either `quote`
CLAIMS | says = "It grows" | quote = "It grows" | `section` is missing
CLAIMS | "a0"⏎above | "place"⏎above | `at` is missing
CLAIMS | "a0"⏎above | "column"⏎above | `column` is missing
CLAIMS | "a0"⏎above | "largest_growth"⏎above | `over` is missing
# What the model does not have.
SWEEP | name = "r" | name = "q" | no parameter `q` & it has r, b
SWEEP | ["a0"] | ["nusselt"] | nusselt
CRITICAL | vary = "r" | vary = "q" | no parameter `q`
VALUES | k = 1.0 | k = 1.0⏎set = ["q=1"] | no parameter `q`
VALUES | k = 1.0 | k = 1.0⏎set = ["q"] | NAME=VALUE
VALUES | k = 1.0 | k = 1.0⏎model = "swift" | no model `swift`
LAW | name = "u" | name = "v" | no field `v`
PATTERN | shade = "u" | shade = "v" | `v`
"#;

/// A task by its name.
fn task(name: &str) -> &'static str {
    let tasks = [
        ("CRITICAL", CRITICAL),
        ("MINIMUM", MINIMUM),
        ("AGAINST", AGAINST),
        ("CLAIMS", CLAIMS),
        ("PLACE", PLACE),
        ("LARGEST", LARGEST),
        ("SWEEP", SWEEP),
        ("CONVERGENCE", CONVERGENCE),
        ("VALUES", VALUES),
        ("PATTERN", PATTERN),
        ("ORDERS", ORDERS),
        ("POWER_LAW", POWER_LAW),
        ("LAW", LAW),
    ];
    let named = tasks.into_iter().find(|(known, _)| *known == name);
    named.unwrap_or_else(|| panic!("{name}")).1
}

/// A model without a bounded coordinate has no profile and no vortex between walls.
const UNBOUNDED: [&str; 2] = [
    "
[[figure.task]]
kind = \"profiles\"
fields = [\"u\"]
[[figure.task.case]]
",
    "
[[figure.task]]
kind = \"circulation\"
over = { name = \"r\", from = 0.1, to = 0.5, count = 3 }
k = 1.0
arrows = [\"u\", \"u\"]
side = 0.4
shade = \"u\"
[[figure.task.case]]
",
];

#[test]
fn what_cannot_be_meant_is_refused_before_any_work() {
    let desk = Desk::new();
    let lines = WRONG.lines().filter(|line| !line.is_empty());
    for line in lines.filter(|line| !line.starts_with('#')) {
        let mut parts = line.split(" | ");
        let mut next = || parts.next().unwrap_or_else(|| panic!("{line}")).trim();
        let task = task(next());
        let [good, bad] = [next(), next()].map(|text| text.replace('⏎', "\n"));
        assert!(task.contains(&good), "{good} in {task}");
        let answer = desk.reproduce(&study(&task.replacen(&good, &bad, 1)));
        assert_eq!(answer.status, 2, "{bad}: {} {}", answer.out, answer.err);
        for part in next().split(" & ") {
            assert!(answer.err.contains(part), "{part}: {}", answer.err);
        }
        assert!(answer.err.contains("study.toml"), "{}", answer.err);
        assert!(
            !desk.path("report").exists(),
            "{bad}: something was written"
        );
    }
    for task in UNBOUNDED {
        let answer = desk.reproduce(&study(task));
        assert_eq!(answer.status, 2, "{}", answer.err);
        assert!(
            answer.err.contains("no bounded coordinate"),
            "{}",
            answer.err
        );
    }
    let many = CONVERGENCE
        .replace("count = 5", "count = 10000")
        .replace("[8, 16]", "[4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]");
    let answer = desk.reproduce(&study(&many));
    assert!(
        answer.err.contains("more than 100000 points"),
        "{}",
        answer.err
    );
    let outer = study(VALUES).replace("model = ", "resolution = 100000\nmodel = ");
    let answer = desk.reproduce(&outer);
    assert!(
        answer
            .err
            .contains("M = 100000 is out of range: M accepts 4 to 1000"),
        "{}",
        answer.err
    );
    let empty = "title = \"t\"\nsource = \"s\"\nmodel = \"swift_hohenberg\"\nfigure = []\n";
    assert!(desk.reproduce(empty).err.contains("`figure` is empty"));
}

/// The mistake is shown by its own line.
#[test]
fn mistakes_have_their_line() {
    let desk = Desk::new();
    for (task, good, bad, line) in [
        (SWEEP, "count = 5", "count = 0", "over = { name = \"r\""),
        (
            SWEEP,
            "from = 0.1, to = 0.5",
            "from = -1e308, to = 1e308",
            "over = { name = \"r\", from = -1e308",
        ),
        (
            SWEEP,
            "k = 1.0",
            "k = 1.0\nset = [\"r=0.2\"]",
            "set = [\"r=0.2\"]",
        ),
        (SWEEP, "k = 1.0", "", "[[figure.task.case]]"),
        (CONVERGENCE, "[8, 16]", "[8, 0]", "resolutions = [8, 0]"),
        (
            PATTERN,
            "wavelengths = 2.0",
            "wavelengths = 0.0",
            "wavelengths = 0.0",
        ),
        (VALUES, "k = 1.0", "k = -1.0", "k = -1.0"),
    ] {
        let answer = desk.reproduce(&study(&task.replacen(good, bad, 1)));
        let shown = answer.err.split(" | ").nth(1).unwrap_or_default();
        assert!(shown.starts_with(line), "{line}: {}", answer.err);
    }
}

/// A study with a task of every kind that is made wrong here.
pub fn small() -> String {
    let tasks = [
        CRITICAL,
        MINIMUM,
        AGAINST,
        CLAIMS,
        PLACE,
        LARGEST,
        SWEEP,
        CONVERGENCE,
        VALUES,
        PATTERN,
        ORDERS,
        POWER_LAW,
        LAW,
    ];
    study(&tasks.concat())
}

/// The tasks from which the wrong ones are made are themselves accepted.
#[test]
fn what_can_be_meant_is_accepted() {
    let desk = Desk::new();
    let answer = desk.reproduce(&small());
    assert_eq!(answer.status, 0, "{}", answer.err);
}

/// A line of any length is answered in bounded words.
#[test]
fn long_lines_are_answered_in_few_words() {
    let desk = Desk::new();
    let long = "9, ".repeat(20_000);
    for text in [
        study(VALUES).replace("k = 1.0", &format!("k = [{long}]")),
        study(VALUES).replace("k = 1.0", &format!("\"{long}\" = 1")),
        study(VALUES).replace("\"values\"", &format!("\"{long}\"")),
        study(VALUES).replace("\"swift_hohenberg\"", &format!("\"{long}\"")),
        study(VALUES).replace("k = 1.0", &format!("label = \"{long}\"\nk = 1.0")),
        study(VALUES).replace("k = 1.0", &format!("set = [\"{long}\"]\nk = 1.0")),
        format!("{} {long}", study(VALUES)),
    ] {
        let answer = desk.reproduce(&text);
        assert_eq!(answer.status, 2, "{:.300}", answer.err);
        assert!(
            answer.err.len() < 4000,
            "{} bytes: {:.500}",
            answer.err.len(),
            answer.err
        );
    }
}
