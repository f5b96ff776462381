//! Wait states of the flash behind the accelerator of the STM32F4: RM0090 (Rev 21), 3.5.2.

use std::num::NonZeroUsize;

use lru::LruCache;

/// At 168 MHz and 2.7 V or more: RM0090, 3.5.1.
pub const WAIT_STATES: u64 = 5;
const LINE_BYTES: u32 = 16;
const CODE_LINES: NonZeroUsize = NonZeroUsize::new(64).expect("not 0");
const DATA_LINES: NonZeroUsize = NonZeroUsize::new(8).expect("not 0");
const NONE: u32 = u32::MAX;

/// The line that an address lies in.
pub fn line(address: u32) -> u32 {
    address / LINE_BYTES
}

/// What the accelerator holds: of its caches, the line used longest ago is given up first.
pub struct Flash {
    code: LruCache<u32, ()>,
    data: LruCache<u32, ()>,
    current: u32,
    /// Line that is read ahead, and the cycle at which it is there.
    ahead: (u32, u64),
}

impl Flash {
    /// Holds nothing.
    pub fn cold() -> Self {
        Self {
            code: LruCache::new(CODE_LINES),
            data: LruCache::new(DATA_LINES),
            current: NONE,
            ahead: (NONE, 0),
        }
    }

    /// Holds nothing again.
    pub fn forget(&mut self) {
        self.code.clear();
        self.data.clear();
        (self.current, self.ahead) = (NONE, (NONE, 0));
    }

    /// Cycles that the core waits, at cycle `now`, for the code of this line.
    pub fn wait_for_code(&mut self, line: u32, now: u64) -> u64 {
        if line == self.current {
            return 0;
        }
        let wait = if self.code.get(&line).is_some() {
            0
        } else if self.ahead.0 == line {
            // A line that was read ahead is not copied into the cache: only misses are.
            self.ahead.1.saturating_sub(now).min(WAIT_STATES)
        } else {
            self.code.put(line, ());
            WAIT_STATES
        };
        self.current = line;
        self.ahead = (line + 1, now + wait + WAIT_STATES + 1);
        wait
    }

    /// Likewise for a datum in flash.
    pub fn wait_for_data(&mut self, line: u32) -> u64 {
        match self.data.put(line, ()) {
            Some(()) => 0,
            None => WAIT_STATES,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missed_line_waits_once_and_is_kept() {
        let mut flash = Flash::cold();
        assert_eq!(flash.wait_for_code(10, 0), 5);
        assert_eq!(flash.wait_for_code(10, 6), 0);
        assert_eq!(flash.wait_for_code(30, 8), 5);
        assert_eq!(flash.wait_for_code(10, 20), 0);
    }

    #[test]
    fn the_next_line_is_read_ahead_while_this_one_runs() {
        let mut flash = Flash::cold();
        assert_eq!(flash.wait_for_code(10, 0), 5);
        // There at 0 + 5 + 6.
        assert_eq!(flash.wait_for_code(11, 8), 3);
        assert_eq!(flash.wait_for_code(12, 30), 0);
        // Read ahead, so not kept.
        assert_eq!(flash.wait_for_code(20, 40), 5);
        assert_eq!(flash.wait_for_code(11, 60), 5);
    }

    #[test]
    fn the_line_used_longest_ago_gives_way() {
        let mut flash = Flash::cold();
        for line in (0..65).map(|it| it * 2) {
            assert_eq!(flash.wait_for_code(line, 100 * u64::from(line)), 5);
        }
        assert_eq!(flash.wait_for_code(4, 100_000), 0);
        assert_eq!(flash.wait_for_code(0, 200_000), 5);
        for line in 0..8 {
            assert_eq!(flash.wait_for_data(line), 5);
            assert_eq!(flash.wait_for_data(line), 0);
        }
        assert_eq!(flash.wait_for_data(8), 5);
        assert_eq!(flash.wait_for_data(0), 5);
        assert_eq!(flash.wait_for_data(2), 0);
    }
}
