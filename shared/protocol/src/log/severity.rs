//! Payload of a severity block: version, then [`Severity`] in postcard.

use heapless::Vec;

use touchdown_core::severity::Severity;

/// Version of the bytes behind it.
pub const VERSION: u8 = 1;
/// Bytes with the version, at most: a varint of 16 bits and seven f32.
pub const SEVERITY_BYTES: usize = 1 + 3 + 7 * 4;

/// Severity to payload.
pub fn encode(severity: &Severity) -> Vec<u8, SEVERITY_BYTES> {
    let mut bytes = [0; SEVERITY_BYTES];
    // It always fits.
    let payload = postcard::to_slice(&(VERSION, severity), &mut bytes);
    payload.map_or(Vec::new(), |it| it.iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn severity_comes_back() {
        let severity = Severity {
            impacts: u16::MAX,
            impact_speed: 0.1,
            impulse: 0.2,
            total_impulse: f32::MAX,
            dwell: -0.0,
            velocity_index: 1.41,
            whirl_frequency: 160.0,
            whirl_load: 1e4,
        };
        let bytes = encode(&severity);
        assert_eq!(bytes.len(), SEVERITY_BYTES);
        assert_eq!(bytes[0], VERSION);
        assert_eq!(postcard::from_bytes(&bytes[1..]), Ok(severity));
    }
}
