//! An episode as COMTRADE (IEEE C37.111-1999): a configuration and an ASCII data file.

use chrono::DateTime;
use touchdown_core::sample::CHANNELS;
use touchdown_protocol::log::waveform::NO_VALUE;

use super::episode::Episode;
use crate::recording::{DEVICE, STATION};
use touchdown_scene::names::channel_name;

/// What stands for a missing value.
const MISSING: u32 = 99_999;

/// Texts of the .cfg and the .dat file; `None` without a header, or with an impossible one. The monitor has no calendar: dates count from
/// 1 January 1970 at its last reset.
pub fn comtrade(episode: &Episode) -> Option<[String; 2]> {
    let header = episode.scale()?;
    let fitted = (0..CHANNELS).filter(|it| header.fitted & (1 << it) != 0);
    let fitted: Vec<usize> = fitted.collect();
    let (number, count) = (episode.sequence, fitted.len());
    let mut cfg = format!("{STATION},{DEVICE}{number},1999\r\n{count},{count}A,0D\r\n");
    let record = header.calibration.unwrap_or_default();
    for (number, &channel) in (1..).zip(&fitted) {
        let plane = &record.planes[channel / 2];
        let (zero, gain) = (plane.zero[channel % 2], plane.gain[channel % 2]);
        let um = f64::from(header.resolution) * 1e6 / f64::from(gain);
        let zero_um = f64::from(zero) * 1e6 / f64::from(gain);
        let (name, most) = (channel_name(channel as u8), header.full_scale);
        let shift = -um * f64::from(header.zero_count) - zero_um;
        cfg += &format!("{number},{name},,,um,{um},{shift},0,0,{most},1,1,P\r\n");
    }
    let rate = f64::from(header.sample_rate) / f64::from(header.decimation);
    let at = |tick: u64| date(tick as f64 / f64::from(header.sample_rate));
    let (count, first, trigger) = (episode.samples.len(), at(header.first), at(header.trigger));
    cfg += &format!("50\r\n1\r\n{rate},{count}\r\n{first}\r\n{trigger}\r\nASCII\r\n1\r\n");
    let mut dat = String::new();
    for (number, counts) in episode.samples.iter().enumerate() {
        dat += &format!("{},{:.0}", number + 1, 1e6 * number as f64 / rate);
        for &channel in &fitted {
            let count = counts.and_then(|it| it.get(channel).copied());
            let count = count.filter(|it| *it != NO_VALUE).map(u32::from);
            dat += &format!(",{}", count.unwrap_or(MISSING));
        }
        dat += "\r\n";
    }
    Some([cfg, dat])
}

/// `dd/mm/yyyy,hh:mm:ss.ssssss`, so many seconds after 1970 began.
fn date(seconds: f64) -> String {
    let date = DateTime::from_timestamp_micros((1e6 * seconds).round() as i64);
    let date = date.unwrap_or_default();
    date.format("%d/%m/%Y,%H:%M:%S%.6f").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_count_from_1970() {
        assert_eq!(date(0.0), "01/01/1970,00:00:00.000000");
        assert_eq!(date(86_399.5), "01/01/1970,23:59:59.500000");
        // 2000-02-29 12:34:56 is 951 827 696 s.
        assert_eq!(date(951_827_696.25), "29/02/2000,12:34:56.250000");
    }
}
