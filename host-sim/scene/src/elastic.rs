//! Whether a rigid rotor is one in its contacts: the band of the contact pulse against the rotor's first
//! elastic mode.
//!
//! A pulse of duration T_c has its band up to about 1/T_c. A half sine leaves a mode of frequency f at up to
//! 4 x/(4 x^2 - 1) of its static deflection, x = f T_c above 1.5: below a tenth from 10 on.

use core::fmt;

use serde::Serialize;
use touchdown_models::HertzConfig;
use touchdown_rotor::error::ConfigError;

/// Band over mode up to which the mode keeps less than a tenth of its static deflection.
const STIFF: f64 = 0.1;

/// What a rigid rotor is worth in its contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The mode follows the pulse and does not ring after it.
    Rigid,
    /// The mode rings by more than a tenth of its static deflection.
    Rings,
    /// The mode lies in the pulse's band: the rotor bends before the contact ends.
    Bends,
}

/// The validity of a rigid rotor in the contacts of a ring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Validity {
    /// Upper end of the pulse's band, 1/T_c, Hz.
    pub band_hz: f64,
    /// The rotor's first elastic mode, Hz.
    pub mode_hz: f64,
    /// Band over mode.
    pub ratio: f64,
    /// What follows.
    pub verdict: Verdict,
}

impl Validity {
    /// In the fastest impact of `contact` at the axial place `zeta` (in radii of gyration from the centre of
    /// mass), where an impact meets 1/(1 + zeta^2) of the mass.
    pub fn try_new(contact: &HertzConfig, zeta: f64, mode_hz: f64) -> Result<Self, ConfigError> {
        if !(mode_hz > 0.0 && mode_hz.is_finite()) {
            return Err(ConfigError::NotPositive("mode_hz"));
        }
        if !zeta.is_finite() {
            return Err(ConfigError::NotFinite("zeta"));
        }
        let mut there = *contact;
        there.rigid.mass = contact.rigid.mass / (1.0 + zeta * zeta);
        let band_hz = 1.0 / there.compliance()?.contact_time;
        let ratio = band_hz / mode_hz;
        let verdict = match ratio {
            _ if ratio <= STIFF => Verdict::Rigid,
            _ if ratio <= 1.0 => Verdict::Rings,
            _ => Verdict::Bends,
        };
        Ok(Self {
            band_hz,
            mode_hz,
            ratio,
            verdict,
        })
    }
}

impl fmt::Display for Validity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let says = match self.verdict {
            Verdict::Rigid => "the rotor is rigid in its contacts",
            Verdict::Rings => "the rotor rings after its contacts",
            Verdict::Bends => "the rotor bends in its contacts; impacts are those of a rigid one",
        };
        write!(
            f,
            "contact pulse to {:.0} Hz, first elastic mode {:.0} Hz, ratio {:.2}: {says}",
            self.band_hz, self.mode_hz, self.ratio
        )
    }
}
