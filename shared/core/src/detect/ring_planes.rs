//! The rotor at the retainer's rings, where the sensors are elsewhere along the shaft: on a straight shaft two places say
//! where any other one is.

use crate::sensing::{AxialPlaces, PLANES, PlanePositions};
use crate::vector::{less, sum};
use touchdown_rotor::error::ConfigError;

/// Coefficients.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RingPlanes {
    /// How far each ring lies beyond its sensors, away from the others, in distances between the sensors.
    overhang: [f32; PLANES],
    /// Variance of each ring's position, and of half their distance, in that of the sensors.
    pub(crate) growth: [f32; PLANES],
    pub(crate) growth_apart: f32,
}

impl RingPlanes {
    /// Without places each ring is where its sensors are.
    pub(crate) fn try_new(places: Option<&AxialPlaces>) -> Result<Self, ConfigError> {
        let overhang = places.map_or(Some([0.0; PLANES]), AxialPlaces::overhang);
        let rule = "-0.45 to 10 distances of the sensors beyond them";
        let overhang = overhang.ok_or(ConfigError::OutOfRange("ring_z", rule))?;
        let [a, b] = overhang;
        Ok(Self {
            overhang,
            growth: overhang.map(|it| (1.0 + it) * (1.0 + it) + it * it),
            growth_apart: (1.0 + a + b) * (1.0 + a + b),
        })
    }

    /// Position at each ring, m; where one plane is seen alone, that of its sensors.
    pub(crate) fn positions(&self, planes: &PlanePositions) -> PlanePositions {
        let [Some(a), Some(b)] = *planes else {
            return *planes;
        };
        let [of_a, of_b] = self.overhang;
        let apart = less(b, a);
        let ends = [
            less(a, apart.map(|it| it * of_a)),
            sum(b, apart.map(|it| it * of_b)),
        ];
        ends.map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_shaft_is_seen_at_its_rings() {
        let places = AxialPlaces {
            sensors: [-0.241, 0.119],
            rings: [-0.25, 0.139],
        };
        let planes = RingPlanes::try_new(Some(&places)).expect("valid");
        let at = |z: f32| [1e-4 + 2e-4 * z, -3e-4 - 5e-4 * z];
        let found = planes.positions(&places.sensors.map(|z| Some(at(z))));
        for (found, z) in found.into_iter().zip(places.rings) {
            let found = found.expect("both are seen");
            assert!(less(found, at(z)).iter().all(|off| off.abs() < 1e-9));
        }
        let alone = [None, Some([1e-4, 2e-4])];
        assert_eq!(planes.positions(&alone), alone);
    }

    #[test]
    fn planes_that_show_no_tilt_are_refused() {
        let places = |sensors| AxialPlaces {
            sensors,
            rings: [-0.1, 0.1],
        };
        for sensors in [
            [0.1; 2],
            [0.1, -0.1],
            [f32::NAN, 0.1],
            [-0.1, 1.0],
            [0.0, 9e-3],
        ] {
            assert!(
                RingPlanes::try_new(Some(&places(sensors))).is_err(),
                "{sensors:?}"
            );
        }
        assert!(RingPlanes::try_new(Some(&places([0.0, 0.01]))).is_ok());
        assert!(RingPlanes::try_new(None).is_ok());
    }
}
