//! The lifetime counters in flash: records one after another in two sectors, each record twice. The
//! older sector is erased only when the newer one is full, so the newest record is always there.

use embedded_storage::nor_flash::{NorFlash, ReadNorFlash};
use touchdown_protocol::log::counters::{COUNTERS_BYTES, Counters};

use super::layout::{COUNTER_SECTORS, SECTOR_BYTES};

const CELLS: u32 = SECTOR_BYTES / COUNTERS_BYTES as u32;
/// A wrong bit must not lose the newest record.
const COPIES: u8 = 2;

#[derive(Clone, Debug)]
pub(super) struct Ledger {
    pub(super) counters: Counters,
    sector: u32,
    /// First free cell of the sector.
    cell: u32,
    /// Copies yet to be written.
    copies: u8,
}

impl Ledger {
    /// Finds the newest record.
    pub(super) fn mount<F: ReadNorFlash>(flash: &mut F) -> Result<Self, F::Error> {
        let mut ledger = Self {
            counters: Counters::default(),
            // As if the second one were full: the first record goes to the first, once erased.
            sector: COUNTER_SECTORS - 1,
            cell: CELLS,
            copies: 0,
        };
        let mut bytes = [0; COUNTERS_BYTES];
        for sector in 0..COUNTER_SECTORS {
            let (mut newest, mut free) = (false, 0);
            for cell in 0..CELLS {
                flash.read(address(sector, cell), &mut bytes)?;
                if let Some(found) = Counters::decode(&bytes)
                    && found.generation > ledger.counters.generation
                {
                    ledger.counters = found;
                    newest = true;
                }
                if bytes.iter().any(|&byte| byte != 0xff) {
                    free = cell + 1;
                }
            }
            if newest {
                (ledger.sector, ledger.cell) = (sector, free);
            }
        }
        Ok(ledger)
    }

    pub(super) fn update(&mut self, change: impl FnOnce(&mut Counters)) {
        change(&mut self.counters);
        self.counters.generation = self.counters.generation.saturating_add(1);
        self.copies = COPIES;
    }

    /// Whether the flash does not have the counters yet.
    pub(super) fn is_ahead(&self) -> bool {
        self.copies > 0
    }

    /// One operation towards it.
    pub(super) fn write<F: NorFlash>(&mut self, flash: &mut F) -> Result<(), F::Error> {
        if self.cell == CELLS {
            let other = (self.sector + 1) % COUNTER_SECTORS;
            let from = address(other, 0);
            flash.erase(from, from + SECTOR_BYTES)?;
            (self.sector, self.cell) = (other, 0);
            return Ok(());
        }
        let address = address(self.sector, self.cell);
        // What went wrong may have used up the cell.
        self.cell += 1;
        flash.write(address, &self.counters.encode())?;
        self.copies -= 1;
        Ok(())
    }
}

fn address(sector: u32, cell: u32) -> u32 {
    sector * SECTOR_BYTES + cell * COUNTERS_BYTES as u32
}
