//! An episode as COMTRADE (IEEE C37.111-1999): a configuration and an ASCII data file.

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
    let fitted: Vec<usize> = (0..CHANNELS)
        .filter(|it| header.fitted & (1 << it) != 0)
        .collect();
    let mut cfg = format!(
        "{STATION},{DEVICE}{},1999\r\n{},{}A,0D\r\n",
        episode.sequence,
        fitted.len(),
        fitted.len()
    );
    let record = header.calibration.unwrap_or_default();
    for (number, &channel) in fitted.iter().enumerate() {
        let plane = &record.planes[channel / 2];
        let (zero, gain) = (plane.zero[channel % 2], plane.gain[channel % 2]);
        let um = f64::from(header.resolution) * 1e6 / f64::from(gain);
        let zero_um = f64::from(zero) * 1e6 / f64::from(gain);
        cfg += &format!(
            "{},{},,,um,{},{},0,0,{},1,1,P\r\n",
            number + 1,
            channel_name(channel as u8),
            um,
            -um * f64::from(header.zero_count) - zero_um,
            header.full_scale
        );
    }
    let rate = f64::from(header.sample_rate) / f64::from(header.decimation);
    let at = |tick: u64| date(tick as f64 / f64::from(header.sample_rate));
    cfg += &format!(
        "50\r\n1\r\n{rate},{}\r\n{}\r\n{}\r\nASCII\r\n1\r\n",
        episode.samples.len(),
        at(header.first),
        at(header.trigger)
    );
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
    let whole = seconds.floor();
    let days = (whole / 86_400.0) as i64;
    // Howard Hinnant's days to civil date.
    let z = days + 719_468;
    let era = z.div_euclid(146_097);
    let of_era = z.rem_euclid(146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * of_year + 2) / 153;
    let day = of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 {
        shifted + 3
    } else {
        shifted - 9
    };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    let within = seconds - 86_400.0 * days as f64;
    let (hours, minutes) = ((within / 3600.0) as u32, (within / 60.0) as u32 % 60);
    let rest = within - f64::from(60 * (60 * hours + minutes));
    format!("{day:02}/{month:02}/{year:04},{hours:02}:{minutes:02}:{rest:09.6}")
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
