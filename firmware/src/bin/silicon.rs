#![no_std]
#![no_main]
//! The image for an STM32F405.

use defmt_rtt as _;
use stm32f4::stm32f405::interrupt;
use touchdown_firmware::board::f405::{F405, start};

touchdown_firmware::chip_image!(F405, start, ADC);
