//! 168 MHz from the crystal.

use stm32f4::stm32f405::{FLASH, RCC};

/// Crystal, MHz: 12 on the Feather STM32F405, 25 on the Netduino Plus 2, 8 on the STM32F4DISCOVERY.
const CRYSTAL_MHZ: u8 = 12;
/// Core and AHB, Hz.
pub const CORE_HZ: u32 = 168_000_000;
/// Peripherals of APB2, Hz.
pub const APB2_HZ: u32 = 84_000_000;
/// Timers of APB1: twice its 42 MHz, Hz.
pub const APB1_TIMER_HZ: u32 = 84_000_000;

/// Brings up the clocks: AHB 168 MHz, APB2 84 MHz, APB1 42 MHz. Without a working crystal it waits
/// for ever, with the trip output de-energised as after reset.
pub fn start(rcc: &RCC, flash: &FLASH) {
    rcc.cr().modify(|_, w| w.hseon().on());
    while rcc.cr().read().hserdy().is_not_ready() {}

    // Crystal / M = 1 MHz, times N = 336 MHz, / P = 168 MHz; Q makes 48 MHz.
    rcc.pllcfgr().write(|w| {
        // SAFETY: M, N and Q are inside their ranges of RM0090, RCC_PLLCFGR.
        unsafe { w.pllm().bits(CRYSTAL_MHZ).plln().bits(336).pllq().bits(7) };
        w.pllsrc().hse().pllp().div2()
    });
    rcc.cr().modify(|_, w| w.pllon().on());

    // Five wait states above 150 MHz at 2.7 to 3.6 V: RM0090, flash wait states.
    flash.acr().modify(|_, w| {
        w.latency().ws5();
        w.prften().enabled().icen().enabled().dcen().enabled()
    });
    while !flash.acr().read().latency().is_ws5() {}

    rcc.cfgr()
        .modify(|_, w| w.hpre().div1().ppre1().div4().ppre2().div2());
    while rcc.cr().read().pllrdy().is_not_ready() {}
    rcc.cfgr().modify(|_, w| w.sw().pll());
    while !rcc.cfgr().read().sws().is_pll() {}
}
