#![no_std]
#![no_main]
//! The image for an STM32G474.

use defmt_rtt as _;
use stm32g4::stm32g474::interrupt;
use touchdown_firmware::board::g474::{G474, start};

touchdown_firmware::chip_image!(G474, start, EXTI0);
