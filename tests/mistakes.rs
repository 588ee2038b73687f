//! Studies that cannot be meant: each is refused before any work, with its place and what is accepted.

use crate::reports::{Desk, study};

/// One task, and a piece of it that is replaced by what cannot be meant.
struct Wrong {
    task: &'static str,
    good: &'static str,
    bad: &'static str,
    /// What the message says.
    told: &'static [&'static str],
}

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

const WRONG: &[Wrong] = &[
    // k is forgotten.
    Wrong {
        task: CRITICAL,
        good: "k = 1.0",
        bad: "",
        told: &["task 1 (critical)", "`k` is missing", "positive number"],
    },
    Wrong {
        task: PLACE,
        good: "k = 1.0",
        bad: "",
        told: &["task 1 (claims)", "claim 1", "`k` is missing"],
    },
    Wrong {
        task: CLAIMS,
        good: "k = 1.0",
        bad: "",
        told: &["`k` is missing"],
    },
    Wrong {
        task: LARGEST,
        good: "name = \"k\", from",
        bad: "name = \"r\", from",
        told: &["`k` is missing"],
    },
    Wrong {
        task: SWEEP,
        good: "k = 1.0",
        bad: "",
        told: &["task 1 (sweep)", "`k` is missing", "positive number"],
    },
    Wrong {
        task: CONVERGENCE,
        good: "k = 1.0",
        bad: "",
        told: &["`k` is missing"],
    },
    Wrong {
        task: VALUES,
        good: "k = 1.0",
        bad: "",
        told: &["`k` is missing"],
    },
    Wrong {
        task: PATTERN,
        good: "k = 1.0",
        bad: "",
        told: &["`k` is missing"],
    },
    Wrong {
        task: POWER_LAW,
        good: "k = 0.9",
        bad: "",
        told: &["`k` is missing"],
    },
    // A wavenumber that is none.
    Wrong {
        task: CRITICAL,
        good: "k = 1.0",
        bad: "k = 0.0",
        told: &["k = 0", "positive number"],
    },
    Wrong {
        task: VALUES,
        good: "k = 1.0",
        bad: "k = nan",
        told: &["positive number"],
    },
    Wrong {
        task: ORDERS,
        good: "name = \"k\"",
        bad: "name = \"r\"",
        told: &["goes along `k` alone"],
    },
    Wrong {
        task: ORDERS,
        good: "from = 0.9",
        bad: "from = -0.9",
        told: &["positive number"],
    },
    // Ranges.
    Wrong {
        task: SWEEP,
        good: "from = 0.1",
        bad: "from = nan",
        told: &["from = NaN", "finite"],
    },
    Wrong {
        task: SWEEP,
        good: "to = 0.5",
        bad: "to = inf",
        told: &["to = inf", "finite"],
    },
    Wrong {
        task: SWEEP,
        good: "from = 0.1",
        bad: "from = 0.7",
        told: &["from 0.7 to 0.5", "lower end"],
    },
    Wrong {
        task: SWEEP,
        good: "from = 0.1",
        bad: "from = 0.5",
        told: &["lower end"],
    },
    Wrong {
        task: CRITICAL,
        good: "[-0.2, 0.9]",
        bad: "[0.9, -0.2]",
        told: &["between = [0.9, -0.2]", "the lower first"],
    },
    Wrong {
        task: MINIMUM,
        good: "[0.5, 1.5]",
        bad: "[1.5, 0.5]",
        told: &["minimize = [1.5, 0.5]", "the lower first"],
    },
    Wrong {
        task: MINIMUM,
        good: "[0.5, 1.5]",
        bad: "[-0.5, 1.5]",
        told: &["minimize", "positive number"],
    },
    Wrong {
        task: MINIMUM,
        good: "vary = \"r\"",
        bad: "vary = \"k\"",
        told: &["accepts a parameter"],
    },
    Wrong {
        task: MINIMUM,
        good: "minimize",
        bad: "of = \"c2\", minimize",
        told: &["growth rate"],
    },
    Wrong {
        task: AGAINST,
        good: "vary = \"r\"",
        bad: "vary = \"k\"",
        told: &["accepts a parameter"],
    },
    Wrong {
        task: AGAINST,
        good: "[-0.5, 0.9] }",
        bad: "[-0.5, 0.9], k = 1.0 }",
        told: &["one wavenumber"],
    },
    Wrong {
        task: POWER_LAW,
        good: "[1e-4, 1e-2]",
        bad: "[1e-2, 1e-4]",
        told: &["the nearer first"],
    },
    Wrong {
        task: POWER_LAW,
        good: "[1e-4, 1e-2]",
        bad: "[-1e-4, 1e-2]",
        told: &["one sign"],
    },
    Wrong {
        task: POWER_LAW,
        good: "[1e-4, 1e-2]",
        bad: "[0.0, 1e-2]",
        told: &["one sign"],
    },
    // Counts.
    Wrong {
        task: SWEEP,
        good: "count = 5",
        bad: "count = 1000000000",
        told: &["count = 1000000000", "from 2 to 10000"],
    },
    Wrong {
        task: SWEEP,
        good: "count = 5",
        bad: "count = 1",
        told: &["count = 1", "from 2 to 10000"],
    },
    Wrong {
        task: SWEEP,
        good: "count = 5",
        bad: "count = -3",
        told: &["count"],
    },
    Wrong {
        task: POWER_LAW,
        good: "count = 5",
        bad: "count = 100000",
        told: &["count = 100000", "from 3 to 1000"],
    },
    Wrong {
        task: CONVERGENCE,
        good: "[8, 16]",
        bad: "[8, 0]",
        told: &["-M 0 is out of range: -M accepts 4 to 1000"],
    },
    Wrong {
        task: CONVERGENCE,
        good: "[8, 16]",
        bad: "[8, 100000]",
        told: &["-M 100000 is out of range: -M accepts 4 to 1000"],
    },
    Wrong {
        task: CONVERGENCE,
        good: "[8, 16]",
        bad: "[]",
        told: &["resolutions", "two or more"],
    },
    Wrong {
        task: VALUES,
        good: "k = 1.0",
        bad: "k = 1.0\nresolution = 100000",
        told: &["-M 100000 is out of range: -M accepts 4 to 1000"],
    },
    Wrong {
        task: ORDERS,
        good: "highest = 7",
        bad: "highest = 8",
        told: &["highest = 8", "odd numbers from 5 to 15"],
    },
    Wrong {
        task: ORDERS,
        good: "highest = 7",
        bad: "highest = 1001",
        told: &["odd numbers from 5 to 15"],
    },
    Wrong {
        task: PATTERN,
        good: "wavelengths = 2.0",
        bad: "wavelengths = 0.0",
        told: &["wavelengths = 0", "above 0"],
    },
    Wrong {
        task: PATTERN,
        good: "wavelengths = 2.0",
        bad: "wavelengths = nan",
        told: &["wavelengths = NaN", "above 0"],
    },
    Wrong {
        task: PATTERN,
        good: "wavelengths = 2.0",
        bad: "wavelengths = 1e9",
        told: &["up to 100"],
    },
    // Empty lists.
    Wrong {
        task: SWEEP,
        good: "[\"a0\"]",
        bad: "[]",
        told: &["`columns` is empty"],
    },
    Wrong {
        task: SWEEP,
        good: "[\"a0\"]",
        bad: "[[]]",
        told: &["one or more"],
    },
    Wrong {
        task: CRITICAL,
        good: "[{ name = \"r_c\", vary = \"r\", between = [-0.2, 0.9] }]",
        bad: "[]",
        told: &["`asked` is empty"],
    },
    Wrong {
        task: SWEEP,
        good: "[[figure.task.case]]\nk = 1.0",
        bad: "case = []",
        told: &["`case` is empty"],
    },
    // Statements that nothing decides, or that ask for what has no meaning.
    Wrong {
        task: CLAIMS,
        good: "above = 0.0",
        bad: "",
        told: &["nothing decides the statement"],
    },
    Wrong {
        task: CLAIMS,
        good: "above = 0.0",
        bad: "above = nan",
        told: &["above = NaN", "finite"],
    },
    Wrong {
        task: CLAIMS,
        good: "above = 0.0",
        bad: "above = 1.0\nbelow = 0.0",
        told: &["above < below"],
    },
    Wrong {
        task: CLAIMS,
        good: "above = 0.0",
        bad: "as_first_within = 0.1",
        told: &["two or more cases"],
    },
    Wrong {
        task: CLAIMS,
        good: "above = 0.0",
        bad: "trend = \"rising\"",
        told: &["two or more cases"],
    },
    Wrong {
        task: CLAIMS,
        good: "says = \"It grows\"",
        bad: "",
        told: &["either `quote`"],
    },
    Wrong {
        task: CLAIMS,
        good: "says = \"It grows\"",
        bad: "quote = \"It grows\"",
        told: &["`section` is missing"],
    },
    Wrong {
        task: CLAIMS,
        good: "\"a0\"\nabove",
        bad: "\"place\"\nabove",
        told: &["`at` is missing"],
    },
    Wrong {
        task: CLAIMS,
        good: "\"a0\"\nabove",
        bad: "\"column\"\nabove",
        told: &["`column` is missing"],
    },
    Wrong {
        task: CLAIMS,
        good: "\"a0\"\nabove",
        bad: "\"largest_growth\"\nabove",
        told: &["`over` is missing"],
    },
    // What the model does not have.
    Wrong {
        task: SWEEP,
        good: "name = \"r\"",
        bad: "name = \"q\"",
        told: &["no parameter `q`", "it has r, b"],
    },
    Wrong {
        task: SWEEP,
        good: "[\"a0\"]",
        bad: "[\"nusselt\"]",
        told: &["nusselt"],
    },
    Wrong {
        task: CRITICAL,
        good: "vary = \"r\"",
        bad: "vary = \"q\"",
        told: &["no parameter `q`"],
    },
    Wrong {
        task: VALUES,
        good: "k = 1.0",
        bad: "k = 1.0\nset = [\"q=1\"]",
        told: &["no parameter `q`"],
    },
    Wrong {
        task: VALUES,
        good: "k = 1.0",
        bad: "k = 1.0\nset = [\"q\"]",
        told: &["NAME=VALUE"],
    },
    Wrong {
        task: VALUES,
        good: "k = 1.0",
        bad: "k = 1.0\nmodel = \"swift\"",
        told: &["no model `swift`"],
    },
    Wrong {
        task: LAW,
        good: "name = \"u\"",
        bad: "name = \"v\"",
        told: &["no field `v`"],
    },
    Wrong {
        task: PATTERN,
        good: "shade = \"u\"",
        bad: "shade = \"v\"",
        told: &["`v`"],
    },
];

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
    for wrong in WRONG {
        let Wrong {
            task,
            good,
            bad,
            told,
        } = wrong;
        assert!(task.contains(good), "{good} in {task}");
        let answer = desk.reproduce(&study(&task.replacen(good, bad, 1)));
        assert_eq!(answer.status, 2, "{bad}: {} {}", answer.out, answer.err);
        for part in *told {
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
            .contains("-M 100000 is out of range: -M accepts 4 to 1000"),
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
