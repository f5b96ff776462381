//! A board that keeps nothing but its configuration.

use touchdown_core::event::Notice;
use touchdown_firmware::board::Board;
use touchdown_protocol::config_block::Block;
use touchdown_protocol::controller::Shown;

pub struct Desk(pub Block);

impl Board for Desk {
    fn report(&mut self, _: &Notice) {}

    fn drive(&mut self, _: Shown) {}

    fn config(&self) -> &[u8] {
        &self.0
    }

    fn feed(&mut self) {}
}
