//! Figures of `benches/peers/RESULTS.md`, which says when and on what machine they were measured.

use anyhow::{Context, bail, ensure};

use super::number::Format;
use super::template::Figure;

/// Errors below this are given by their worst.
const SMALL: f64 = 1e-4;
/// Columns of the first table, from 0, and where the tables of five impacts have others.
const FIRST: [(&str, usize); 4] = [("times", 2), ("velocities", 3), ("found", 4), ("cpu", 7)];
const FIVE: [(&str, usize); 3] = [("worst", 4), ("five", 5), ("factor", 6)];

/// `SETTING times|velocities|found|cpu|worst|five|factor`; `SETTING over SETTING`, of processor time; `claim TEXT`, the
/// factor of the claim that begins so, met or not.
pub fn figure(results: &str, words: &[&str]) -> anyhow::Result<Figure> {
    match *words {
        ["claim", text] => claim(results, text),
        [one, "over", other] => {
            let of = |it| cell(results, it, "cpu")?.parse::<f64>().context("no time");
            Ok(Figure::Number(of(one)? / of(other)?))
        }
        [setting, column @ ("times" | "velocities")] => {
            let cell = cell(results, setting, column)?;
            let errors: Result<Vec<f64>, _> = cell.split(" / ").map(str::parse).collect();
            let errors = errors.context("not three errors")?;
            let format = Format::Digits(2);
            let worst = errors.iter().copied().fold(0.0, f64::max);
            if worst < SMALL {
                return Ok(Figure::Text(format!("{} or less", format.of(worst)?)));
            }
            let errors: Result<Vec<_>, _> = errors.into_iter().map(|it| format.of(it)).collect();
            Ok(Figure::Text(errors?.join(" / ")))
        }
        [setting, column] => Ok(Figure::Number(cell(results, setting, column)?.parse()?)),
        _ => bail!("it takes a setting and a column"),
    }
}

fn cell<'a>(results: &'a str, setting: &str, column: &str) -> anyhow::Result<&'a str> {
    let place = FIRST
        .iter()
        .chain(&FIVE)
        .find(|it| it.0 == column)
        .context("no such column")?
        .1;
    let rows = results.lines().filter_map(|line| {
        let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
        (cells.len() > place && cells[1] == setting).then(|| cells[place])
    });
    let rows: Vec<_> = rows.collect();
    ensure!(rows.len() == 1, "{} rows are called so", rows.len());
    Ok(rows[0])
}

fn claim(results: &str, text: &str) -> anyhow::Result<Figure> {
    let start = format!("- {text}: ");
    let mut claims = results.lines().filter_map(|line| line.strip_prefix(&start));
    let claim = claims.next().context("no claim begins so")?;
    let claim = claim.split_once(", ").map_or(claim, |it| it.1);
    let (factor, _) = claim
        .split_once(" times")
        .context("the claim has no factor")?;
    Ok(Figure::Number(factor.parse()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const RESULTS: &str = "\
        | Touchdown | f64 | 0 / 1e-11 / 1e-12 | 1 / 0.5 / 3.7e+02 | 29 | 0 | 0 | 2e-05 | 27 |\n\
        | scipy | events | 0 / 1 / - | 0 / 0 / 0 | 14 | 0 | 0 | 0.045 | - |\n\
        \n- With f64: met, 99.8 times (ours).\n\
        - With f16: **not met**, 4.5 times (ours).\n";

    #[test]
    fn small_errors_are_given_by_their_worst() {
        let of = |words: &[&str]| figure(RESULTS, words).ok();
        let text = |it: &str| Some(Figure::Text(it.into()));
        assert_eq!(of(&["f64", "times"]), text("1.0e-11 or less"));
        assert_eq!(of(&["f64", "velocities"]), text("1.0 / 0.50 / 370"));
        assert_eq!(of(&["f64", "found"]), Some(Figure::Number(29.0)));
        assert_eq!(
            of(&["events", "over", "f64"]),
            Some(Figure::Number(0.045 / 2e-5))
        );
        assert_eq!(of(&["claim", "With f64"]), Some(Figure::Number(99.8)));
        assert_eq!(of(&["claim", "With f16"]), Some(Figure::Number(4.5)));
        assert_eq!(of(&["events", "times"]), None);
        assert_eq!(of(&["claim", "With f32"]), None);
    }
}
