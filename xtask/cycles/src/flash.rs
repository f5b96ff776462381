//! Wait states of the flash behind the accelerator of the STM32F4: RM0090 (Rev 21), 3.5.2.

use std::mem;

use crate::{FLASH, FLASH_BYTES};

/// At 168 MHz and 2.7 V or more: RM0090, 3.5.1.
pub const WAIT_STATES: u64 = 5;
const LINE_BYTES: u32 = 16;
const CODE_LINES: usize = 64;
const DATA_LINES: usize = 8;
const FIRST_LINE: u32 = FLASH / LINE_BYTES;
const FLASH_LINES: usize = (FLASH_BYTES / LINE_BYTES) as usize;
const NONE: u32 = u32::MAX;

/// The line that an address lies in.
pub fn line(address: u32) -> u32 {
    address / LINE_BYTES
}

/// Lines kept, the one used longest ago given up first.
struct LineCache<const N: usize> {
    /// In each place: the line, and the number of its last use.
    lines: [(u32, u64); N],
    /// 1 + the place of each line from the first of the flash on; 0 where it is not kept.
    places: Vec<u8>,
    uses: u64,
}

impl<const N: usize> LineCache<N> {
    fn new() -> Self {
        Self {
            lines: [(NONE, 0); N],
            places: vec![0; FLASH_LINES],
            uses: 0,
        }
    }

    fn forget(&mut self) {
        for (line, _) in mem::replace(&mut self.lines, [(NONE, 0); N]) {
            self.set(line, 0);
        }
    }

    fn set(&mut self, line: u32, place: u8) {
        if let Some(it) = self.places.get_mut(line.wrapping_sub(FIRST_LINE) as usize) {
            *it = place;
        }
    }

    fn has(&mut self, line: u32) -> bool {
        self.uses += 1;
        let place = self.places.get(line.wrapping_sub(FIRST_LINE) as usize);
        let place = place.and_then(|it| it.checked_sub(1)).map(usize::from);
        let used = place.and_then(|it| self.lines.get_mut(it));
        used.map(|it| it.1 = self.uses).is_some()
    }

    fn fill(&mut self, line: u32) {
        let oldest = (0..N).min_by_key(|place| self.lines[*place].1);
        let oldest = oldest.expect("some lines");
        self.set(self.lines[oldest].0, 0);
        self.lines[oldest] = (line, self.uses);
        self.set(line, oldest as u8 + 1);
    }
}

/// What the accelerator holds.
pub struct Flash {
    code: LineCache<CODE_LINES>,
    data: LineCache<DATA_LINES>,
    current: u32,
    /// Line that is read ahead, and the cycle at which it is there.
    ahead: (u32, u64),
}

impl Flash {
    /// Holds nothing.
    pub fn cold() -> Self {
        Self {
            code: LineCache::new(),
            data: LineCache::new(),
            current: NONE,
            ahead: (NONE, 0),
        }
    }

    /// Holds nothing again.
    pub fn forget(&mut self) {
        self.code.forget();
        self.data.forget();
        (self.current, self.ahead) = (NONE, (NONE, 0));
    }

    /// Cycles that the core waits, at cycle `now`, for the code of this line.
    pub fn wait_for_code(&mut self, line: u32, now: u64) -> u64 {
        if line == self.current {
            return 0;
        }
        let wait = if self.code.has(line) {
            0
        } else if self.ahead.0 == line {
            // A line that was read ahead is not copied into the cache: only misses are.
            self.ahead.1.saturating_sub(now).min(WAIT_STATES)
        } else {
            self.code.fill(line);
            WAIT_STATES
        };
        self.current = line;
        self.ahead = (line + 1, now + wait + WAIT_STATES + 1);
        wait
    }

    /// Likewise for a datum in flash.
    pub fn wait_for_data(&mut self, line: u32) -> u64 {
        if self.data.has(line) {
            return 0;
        }
        self.data.fill(line);
        WAIT_STATES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missed_line_waits_once_and_is_kept() {
        let mut flash = Flash::cold();
        assert_eq!(flash.wait_for_code(FIRST_LINE + 10, 0), 5);
        assert_eq!(flash.wait_for_code(FIRST_LINE + 10, 6), 0);
        assert_eq!(flash.wait_for_code(FIRST_LINE + 30, 8), 5);
        assert_eq!(flash.wait_for_code(FIRST_LINE + 10, 20), 0);
    }

    #[test]
    fn the_next_line_is_read_ahead_while_this_one_runs() {
        let mut flash = Flash::cold();
        assert_eq!(flash.wait_for_code(FIRST_LINE + 10, 0), 5);
        // There at 0 + 5 + 6.
        assert_eq!(flash.wait_for_code(FIRST_LINE + 11, 8), 3);
        assert_eq!(flash.wait_for_code(FIRST_LINE + 12, 30), 0);
        // Read ahead, so not kept.
        assert_eq!(flash.wait_for_code(FIRST_LINE + 20, 40), 5);
        assert_eq!(flash.wait_for_code(FIRST_LINE + 11, 60), 5);
    }

    #[test]
    fn the_line_used_longest_ago_gives_way() {
        let mut flash = Flash::cold();
        for line in (0..65).map(|it| it * 2) {
            assert_eq!(
                flash.wait_for_code(FIRST_LINE + line, 100 * u64::from(line)),
                5
            );
        }
        assert_eq!(flash.wait_for_code(FIRST_LINE + 4, 100_000), 0);
        assert_eq!(flash.wait_for_code(FIRST_LINE, 200_000), 5);
        for line in 0..8 {
            assert_eq!(flash.wait_for_data(FIRST_LINE + line), 5);
            assert_eq!(flash.wait_for_data(FIRST_LINE + line), 0);
        }
        assert_eq!(flash.wait_for_data(FIRST_LINE + 8), 5);
        assert_eq!(flash.wait_for_data(FIRST_LINE), 5);
        assert_eq!(flash.wait_for_data(FIRST_LINE + 2), 0);
    }
}
