//! What each state means for the outputs: the table of docs/build/firmware.md.

use touchdown_protocol::controller::{Faults, Mode, Outputs};

/// All that the outputs depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Condition {
    /// What the controller is doing.
    pub mode: Mode,
    /// What is latched.
    pub faults: Faults,
    /// Whether the rotor lies still enough on the retainer to be lifted.
    pub lies_still: bool,
    /// Whether it whirls without having been proven to float.
    pub whirls: bool,
    /// Whether the detector is armed.
    pub armed: bool,
}

/// The outputs in a condition. A fault that trips rules, whatever the mode says.
pub const fn outputs(it: &Condition) -> Outputs {
    if it.faults.trip() {
        return Outputs::SAFE;
    }
    match it.mode {
        Mode::SelfTest | Mode::Faulted => Outputs::SAFE,
        Mode::Arming => Outputs {
            no_brake: !it.whirls,
            permit: it.lies_still,
            ..Outputs::SAFE
        },
        Mode::Watching => Outputs {
            run: true,
            no_brake: true,
            permit: false,
            ready: it.armed && it.faults.is_empty(),
        },
        Mode::Dropped => Outputs {
            permit: it.lies_still,
            ..Outputs::SAFE
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::VariantArray as _;

    /// The table of docs/build/firmware.md: mode, then the outputs in the order of their bits, each `on`,
    /// `off` or on only where something holds.
    fn table() -> Vec<(String, Vec<String>)> {
        let text = include_str!("../../docs/build/firmware.md");
        let rows = text.split("| mode | run |").nth(1).expect("the table");
        let rows = rows.lines().skip(2).take_while(|row| row.starts_with('|'));
        rows.map(|row| {
            let mut cells = row
                .trim_matches('|')
                .split('|')
                .map(|it| it.trim().to_owned());
            (cells.next().unwrap(), cells.collect())
        })
        .collect()
    }

    #[test]
    fn every_condition_gives_what_the_table_says() {
        let table = table();
        assert_eq!(table.len(), Mode::VARIANTS.len());
        let mut conditions = 0;
        for &mode in Mode::VARIANTS {
            let row = table.iter().find(|row| row.0 == <&str>::from(mode));
            let (_, cells) = row.expect("a row for each mode");
            // The seven bits of the faults: every set of them.
            for faults in (0..1 << 7).map(Faults) {
                for bits in 0..8 {
                    let [lies_still, whirls, armed] = [1, 2, 4].map(|it| bits & it != 0);
                    let condition = Condition {
                        mode,
                        faults,
                        lies_still,
                        whirls,
                        armed,
                    };
                    let is_on = |cell: &String| match cell.as_str() {
                        "on" => true,
                        "off" => false,
                        "if it lies still" => lies_still,
                        "unless it whirls" => !whirls,
                        "if armed and no fault" => armed && faults == Faults::NONE,
                        other => panic!("{other}"),
                    };
                    let on = cells.iter().enumerate();
                    let expected: u8 = on.map(|(bit, cell)| u8::from(is_on(cell)) << bit).sum();
                    // All but the overrun, which has code 0, trip.
                    let expected = if faults.0 > 1 { 0 } else { expected };
                    assert_eq!(outputs(&condition).bits(), expected, "{condition:?}");
                    conditions += 1;
                }
            }
        }
        assert_eq!(conditions, 5 * 128 * 8);
    }
}
