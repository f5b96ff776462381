//! 170 MHz from the crystal.

use stm32g4::stm32g474::{FLASH, PWR, RCC};

/// Core, buses and timers, Hz.
pub const CORE_HZ: u32 = 170_000_000;

/// PLL: crystal of 24 MHz (Nucleo-G474RE) / 6 x 85 / 2. RM0440, RCC_PLLCFGR: M less 1 at bit 4, N at 8, R of 2 is 0 at
/// 25 and on by 24, HSE is source 3.
const PLL: u32 = 3 | 5 << 4 | 85 << 8 | 1 << 24;

/// Brings up the clocks. Without a working crystal it waits for ever, with the outputs de-energised as after reset.
pub fn start(rcc: &RCC, flash: &FLASH, power: &PWR) {
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    while rcc.cr().read().hserdy().bit_is_clear() {}
    // SAFETY: inside the ranges of the register.
    rcc.pllcfgr().write(|w| unsafe { w.bits(PLL) });
    rcc.cr().modify(|_, w| w.pllon().set_bit());

    // Range 1 boost, at half the speed until the voltage has followed, 1 us: RM0440, PWR, and four wait states: RM0440, flash.
    rcc.apb1enr1().modify(|_, w| w.pwren().set_bit());
    power.cr5().modify(|_, w| w.r1mode().clear_bit());
    // SAFETY: 4 wait states exist, AHB by 2 is 8, PLL is 3: RM0440, FLASH_ACR and RCC_CFGR.
    unsafe {
        flash.acr().modify(|_, w| w.latency().bits(4));
        flash
            .acr()
            .modify(|_, w| w.prften().set_bit().icen().set_bit().dcen().set_bit());
        while flash.acr().read().latency().bits() != 4 {}
        while rcc.cr().read().pllrdy().bit_is_clear() {}
        rcc.cfgr().modify(|_, w| w.hpre().bits(8).sw().bits(3));
        while rcc.cfgr().read().sws().bits() != 3 {}
        cortex_m::asm::delay(CORE_HZ / 1_000_000);
        rcc.cfgr().modify(|_, w| w.hpre().bits(0));
    }
}
