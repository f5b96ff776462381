//! What the present tick does to the machine.

/// The rotor after a tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Exposure {
    /// In flight or in contact.
    pub(crate) is_released: bool,
    /// Speed of the centre and the error of each component, m/s.
    pub(crate) speed: f32,
    pub(crate) speed_error: f32,
    /// Samples since permanent contact began, while in it.
    pub(crate) contact_age: Option<u32>,
    /// Rate of a declared whirl, rad/s.
    pub(crate) whirl: Option<f32>,
    /// As seen in the impacts.
    pub(crate) restitution: f32,
    /// Sum of the speeds into the wall that the series has yet to come, m/s.
    pub(crate) ahead: f32,
}

impl Exposure {
    /// The greater of each, of two ends.
    pub(crate) fn worse(&self, other: &Self) -> Self {
        let faster = if self.speed >= other.speed {
            self
        } else {
            other
        };
        let whirls = [self.whirl, other.whirl].into_iter().flatten();
        Self {
            is_released: self.is_released || other.is_released,
            contact_age: self.contact_age.max(other.contact_age),
            whirl: whirls.reduce(|a, b| if a.abs() >= b.abs() { a } else { b }),
            ..*faster
        }
    }
}
