//! What the controller does about what the guard and the detector say: mode, cause, proof and latches.
//!
//! `tests/safety.rs` explores every state and every input.

use touchdown_core::guard::Verdict;
use touchdown_protocol::controller::{Cause, Faults, Mode, Outputs, Shown};

/// What a tick shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// Of the guard.
    pub guard: Verdict,
    /// What the detector tells that trips: a fall, whirl, or contact.
    pub told: Option<Cause>,
    /// Whether each channel that is fitted gives values of its own.
    pub sees_all: bool,
    /// Whether a fault that trips is latched.
    pub faulted: bool,
    /// Whether the self-test has seen all that it waits for.
    pub tested: bool,
    /// Whether the detector takes the rotor for lying on the wall.
    pub lies: bool,
    /// Whether it lies still there.
    pub lies_still: bool,
}

/// Mode, cause and proof.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Safety {
    mode: Mode,
    /// Of no meaning while it watches.
    cause: Cause,
    proven: bool,
}

impl Safety {
    /// One tick.
    pub fn step(&mut self, findings: &Findings) {
        let guard = beyond(&findings.guard);
        if findings.faulted {
            let cause = guard.filter(|_| self.proven).unwrap_or(Cause::Fault);
            self.latch(Mode::Faulted, cause);
            return;
        }
        // What has not been proven to float may lie there, to be lifted, and a lift may fail: it does not run.
        let tripped = guard.or(findings.told);
        if let Some(cause) = tripped.filter(|_| self.proven) {
            self.latch(Mode::Dropped, cause);
            return;
        }
        if self.is_latched() {
            return;
        }
        if findings.told == Some(Cause::Whirl) {
            self.cause = Cause::Whirl;
        } else if self.whirls() && findings.lies_still {
            self.cause = Cause::NoProof;
        }
        if findings.told.is_some() {
            return;
        }
        self.proven |= findings.guard.floats && guard.is_none();
        if self.mode == Mode::SelfTest && findings.tested {
            self.mode = Mode::Arming;
            if !self.whirls() {
                self.cause = Cause::NoProof;
            }
        } else if self.mode == Mode::Arming && self.proven && findings.sees_all && !findings.lies {
            (self.mode, self.cause) = (Mode::Watching, Cause::NoProof);
        }
    }

    /// As it was before power went, latched by `cause`.
    pub fn recall(&mut self, cause: Cause) {
        (self.mode, self.cause) = (Mode::Dropped, cause);
    }

    /// An order to clear: all begins anew. It gives no right to run: that takes a new proof.
    pub fn clear(&mut self) {
        (self.mode, self.cause) = (Mode::SelfTest, Cause::Order);
        self.proven = false;
    }

    /// Mode, cause and outputs, these by the table of docs/build/firmware.md: of `faults` that are latched, a rotor that
    /// lies still enough on the retainer to be lifted or not, and a detector that is `armed` or not. A fault that trips
    /// rules, whatever the mode says.
    pub fn shown(&self, faults: Faults, lies_still: bool, armed: bool) -> Shown {
        let is = |mode| self.mode == mode && !faults.trip();
        let watches = is(Mode::Watching);
        Shown {
            outputs: Outputs {
                run: watches,
                no_brake: watches || is(Mode::Arming) && !self.whirls(),
                permit: lies_still && (is(Mode::Arming) || is(Mode::Dropped)),
                ready: watches && armed && faults == Faults::NONE,
            },
            mode: self.mode,
            cause: (self.mode != Mode::Watching).then_some(self.cause),
        }
    }

    /// Whether the rotor has been proven to float, and nothing has tripped since.
    pub fn is_proven(&self) -> bool {
        self.proven
    }

    /// Whether it whirled before it was proven to float, and has neither lain still nor floated since: that takes the
    /// brake, but no order.
    fn whirls(&self) -> bool {
        !self.is_latched() && self.cause == Cause::Whirl
    }

    /// Whether a trip waits for an order to clear.
    pub fn is_latched(&self) -> bool {
        matches!(self.mode, Mode::Dropped | Mode::Faulted)
    }

    /// The first cause stays.
    fn latch(&mut self, mode: Mode, cause: Cause) {
        if !self.is_latched() {
            self.cause = cause;
        }
        (self.mode, self.proven) = (mode, false);
    }
}

/// What the guard finds, if it trips.
fn beyond(guard: &Verdict) -> Option<Cause> {
    let danger = guard.danger.then_some(Cause::Danger);
    let off = guard.off.then_some(Cause::LevitationOff);
    let lost = guard.lost.then_some(Cause::PositionsLost);
    danger.or(off).or(lost)
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
    fn every_state_gives_what_the_table_says() {
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
                    let safety = Safety {
                        mode,
                        cause: if whirls { Cause::Whirl } else { Cause::NoProof },
                        proven: false,
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
                    let outputs = safety.shown(faults, lies_still, armed).outputs;
                    assert_eq!(
                        outputs.bits(),
                        expected,
                        "{safety:?}, {faults:?}, {bits:#b}"
                    );
                    conditions += 1;
                }
            }
        }
        assert_eq!(conditions, 5 * 128 * 8);
    }
}
