//! Commands that compute.

use crate::arguments::{Common, CriticalOptions, Files, Of, OfMode, SweepOptions};
use crate::asked::{asked, resumed};
use crate::interrupt::{self, Kept};
use crate::progress::Bar;
use crate::values::range;
use crate::{cluster, outputs, picture, script};
use landau_report::data::{lines, table};
use landau_report::figure;
use landau_report::library::column;
use landau_solver::error::{Error, Result};
use landau_solver::file::Overwrite;
use landau_solver::measured::Measured;
use landau_solver::study::amplitudes::{AmplitudesReport, ModeChoice};
use landau_solver::study::critical::{CriticalReport, Quantity, Question, Request, Tracking};
use landau_solver::study::point::PointReport;
use landau_solver::study::profiles::BaseReport;
use landau_solver::study::row::Row;
use landau_solver::study::spectrum::SpectrumReport;
use landau_solver::study::sweep::{Range, RowMode, Sweep};
use landau_solver::study::verify::Certificate;
use landau_solver::study::{Axis, Setup, journal_path};
use landau_solver::words;
use serde_json::json;

pub fn base(setup: &Setup, points: usize, files: &Files, common: &Common) -> Result<()> {
    picture::check(files)?;
    let report = BaseReport::compute(setup, points)?;
    if let Some(plot) = &files.plot {
        let fine = BaseReport::compute(setup, figure::POINTS)?;
        picture::drawn(Some(plot), || figure::base(&fine))?;
    }
    let structure = setup.model.structure();
    picture::stored(setup, &report.parameters, None, &files.out, |facts| {
        lines::base(structure, &report, facts)
    })?;
    if common.json {
        say!("{}", report.json());
    } else {
        say!("{report}");
    }
    Ok(())
}

pub fn spectrum(setup: &Setup, k: Option<f64>, files: &Files, common: &Common) -> Result<()> {
    picture::check(files)?;
    let (k, _) = asked(setup, k, None)?;
    let report = SpectrumReport::compute(setup, k)?;
    picture::drawn(files.plot.as_deref(), || figure::spectrum(&report))?;
    picture::stored(setup, &report.parameters, Some(k), &files.out, |facts| {
        lines::spectrum(&report, facts)
    })?;
    if common.json {
        say!("{}", report.json());
    } else {
        say!("{report}");
    }
    Ok(())
}

pub fn point(
    setup: &Setup,
    k: Option<f64>,
    order: usize,
    of_mode: &OfMode,
    common: &Common,
) -> Result<()> {
    let (k, selection) = asked(setup, k, of_mode.near)?;
    let report = PointReport::compute(setup, k, selection, order)?;
    if common.json {
        say!("{}", report.json());
    } else {
        say!("{report}");
    }
    Ok(())
}

pub fn amplitudes(
    setup: &Setup,
    modes: &[ModeChoice],
    order: usize,
    common: &Common,
) -> Result<()> {
    let report = AmplitudesReport::compute(setup, modes, order, &Bar::new("expanding"))?;
    if common.json {
        say!("{}", report.json());
    } else {
        say!("{report}");
    }
    Ok(())
}

pub fn critical(
    setup: &Setup,
    options: &CriticalOptions,
    of_mode: &OfMode,
    common: &Common,
) -> Result<()> {
    let overwrite = Overwrite::forced(options.force);
    outputs::check_picture(options.plot.as_deref())?;
    outputs::check(options.plot.as_deref(), overwrite)?;
    let range_of_k = |text: &String| match range("--minimize", text, 2).map_err(Error::Input)? {
        (name, bounds) if name == "k" => Ok([bounds[0], bounds[1]]),
        _ => Err(Error::input(format!(
            "--minimize {text}: it accepts k=A:B with A < B, for a parameter that varies"
        ))),
    };
    let request = Request {
        vary: &options.vary,
        between: [options.from, options.to],
        of: match options.of {
            Of::Growth => Quantity::Growth,
            Of::C2 => Quantity::C2,
            Of::Resonance => Quantity::Resonance,
        },
        k: options.k,
        minimize: options.minimize.as_ref().map(range_of_k).transpose()?,
        tracking: match (of_mode.near, options.follow) {
            (Some(target), _) => Tracking::Near(target),
            (None, true) => Tracking::Fastest,
            (None, false) => Tracking::Leading,
        },
    };
    let question = Question::new(setup, &request)?;
    let bar = Bar::new("scanning");
    let report = CriticalReport::compute(setup, &question, &bar)?;
    let (first, further) = (&report.found[0], &report.found[1..]);
    if let Some(plot) = &options.plot {
        let curve = report.curve(setup, &question, &bar)?;
        let symbol = request.of.symbol();
        picture::drawn(Some(plot), || match request.minimize {
            None => {
                let title = &setup.model.structure().title;
                figure::critical(title, &options.vary, symbol, &curve)
            }
            Some(_) => {
                let title = format!("{} = {}", options.vary, words::short(first.value));
                figure::critical(&title, "k", symbol, &curve)
            }
        })?;
    }
    if !further.is_empty() {
        let values = further.iter();
        let values = values.map(|c| Measured::new(c.value, c.error).to_string());
        let values: Vec<String> = values.collect();
        note!(
            "note: further points in the interval: {}",
            values.join(", ")
        );
    }
    if common.json {
        say!("{}", report.json(first));
    } else {
        say!("{report}");
    }
    Ok(())
}

/// The evenly spaced values that `--over NAME=FROM:TO:COUNT` asks for.
fn over(setup: &Setup, text: &str) -> Result<Range> {
    let (name, numbers) = range("--over", text, 3).map_err(Error::Input)?;
    let count = numbers[2];
    if count < 1.0 || count.fract() != 0.0 || count > 1e6 {
        return Err(Error::input(format!(
            "--over {text}: COUNT is a whole number from 1 to 1000000"
        )));
    }
    if !(numbers[1] - numbers[0]).is_finite() {
        return Err(Error::input(format!(
            "--over {text}: TO − FROM has to be a number, below {:.1e}",
            f64::MAX
        )));
    }
    let axis = Axis::named(setup.model.as_ref(), &name)?;
    let count = count as usize;
    let step = if count > 1 {
        (numbers[1] - numbers[0]) / (count - 1) as f64
    } else {
        0.0
    };
    let value = |i: usize| {
        if i > 0 && i + 1 == count {
            numbers[1]
        } else {
            numbers[0] + step * i as f64
        }
    };
    let values = (0..count).map(value).collect();
    Ok(Range { name, axis, values })
}

pub fn sweep(
    setup: &Setup,
    options: &SweepOptions,
    of_mode: &OfMode,
    common: &Common,
) -> Result<()> {
    let ranges = options
        .over
        .iter()
        .map(|text| over(setup, text))
        .collect::<Result<_>>()?;
    let derived = options
        .column
        .iter()
        .map(|text| column(setup.model.as_ref(), text))
        .collect::<Result<_>>()?;
    let mode = match of_mode.near {
        near if options.follow => RowMode::Followed(near),
        Some(target) => RowMode::Nearest(target),
        None => RowMode::Leading,
    };
    let sweep = Sweep::new(setup, ranges, options.k, mode, derived)?;
    if let Some(engine) = options.emit {
        return script::emit(engine, &sweep, options, common);
    }
    if let Some(share) = &options.shard {
        return cluster::run_share(&sweep, share, options, common);
    }
    let overwrite = Overwrite::forced(options.force);
    outputs::check_picture(options.plot.as_deref())?;
    outputs::check(options.plot.as_deref(), overwrite)?;
    outputs::check_apart(&options.out, options.plot.as_deref())?;
    let target = table::check(&options.out, &sweep.identity(), overwrite)?;
    interrupt::keeping(Kept::Journal(journal_path(&target)));
    let bar = Bar::new("sweeping");
    let rows = table::sweep_into(&options.out, &sweep, overwrite, &bar, resumed)?;
    interrupt::finished();
    if let Some(path) = &options.plot
        && let Some(drawn) = picture::sweep(setup, &sweep, &rows)
    {
        drawn.write(path)?;
    }
    summary(&sweep, &rows, options, common)
}

/// What a sweep found, in numbers of rows.
///
/// # Errors
/// No row with a number.
fn summary(sweep: &Sweep, rows: &[Row], options: &SweepOptions, common: &Common) -> Result<()> {
    let good = rows.iter().filter(|r| r.status == "ok").count();
    let numbered = rows.iter().filter(|r| r.c0.is_some()).count();
    let unstable = rows
        .iter()
        .filter(|r| r.leading.is_some_and(|growth| growth > 0.0))
        .count();
    if common.json {
        say!(
            "{}",
            json!({"out": options.out.display().to_string(), "rows": rows.len(), "ok": good, "numbered": numbered, "unstable": unstable})
        );
    } else {
        picture::table(sweep, rows);
        say!(
            "{}, {numbered} with a number, {good} ok, {unstable} unstable: {}",
            words::counted(rows.len(), "row"),
            words::shown_path(&options.out)
        );
    }
    if numbered == 0 {
        return Err(Error::computation(format!(
            "no point of the sweep has a number: {}",
            rows[0].status
        )));
    }
    Ok(())
}

pub fn verify(
    setup: &Setup,
    k: Option<f64>,
    order: usize,
    of_mode: &OfMode,
    common: &Common,
) -> Result<()> {
    let (k, selection) = asked(setup, k, of_mode.near)?;
    let certificate = Certificate::compute(setup, k, selection, order)?;
    if common.json {
        say!("{}", certificate.json());
    } else {
        say!("{certificate}");
    }
    certificate.judge()
}
