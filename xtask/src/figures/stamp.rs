//! Where the figures of a table come from that no command of CI can measure.

use anyhow::{Context, ensure};

/// Fails unless it is `measured DATE at COMMIT on MACHINE; by: COMMAND`.
pub fn check(stamp: &str) -> anyhow::Result<()> {
    let parts = || {
        let (measured, command) = stamp.strip_prefix("measured ")?.split_once("; by: ")?;
        let (date, rest) = measured.split_once(" at ")?;
        let (commit, machine) = rest.split_once(" on ")?;
        Some((date, commit, machine, command))
    };
    let (date, commit, machine, command) = parts().with_context(|| {
        format!("\"{stamp}\" is not `measured DATE at COMMIT on MACHINE; by: COMMAND`")
    })?;
    let is_date = date.replace(|it: char| it.is_ascii_digit(), "0") == "0000-00-00";
    ensure!(is_date, "\"{date}\" is no date like 2026-11-21");
    let is_hash = commit.chars().all(|it| it.is_ascii_hexdigit());
    let is_commit = is_hash && (7..=40).contains(&commit.len());
    ensure!(is_commit, "\"{commit}\" is no commit");
    let is_whole = !machine.is_empty() && !command.is_empty();
    ensure!(is_whole, "\"{stamp}\" lacks machine or command");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_four_are_needed() {
        let stamp =
            "measured 2026-11-21 at 7a3f1b5 on x86-64, 2 cores; by: cargo test -- --nocapture";
        check(stamp).unwrap();
        for wrong in [
            "measured 21.11.2026 at 7a3f1b5 on x86-64; by: x",
            "measured 2026-11-21 at main on x86-64; by: x",
            "measured 2026-11-21 at 7a3f1b5 on x86-64",
            "measured 2026-11-21 at 7a3f1b5 on ; by: x",
            "2026-11-21, 7a3f1b5",
        ] {
            assert!(check(wrong).is_err(), "{wrong}");
        }
    }
}
