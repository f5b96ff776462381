//! The device's transfer function from known hits.
//!
//! H1 = sum(A conj F)/sum(|F|^2) over the hits, A and F being the spectra of acceleration and force:
//! noise of the acceleration averages out of it. F is taken as 0 outside the hit itself, where only noise is left.

use std::ops::RangeInclusive;

use rustfft::num_complex::Complex64;

use super::quiet::{Quiet, greatest};
use super::recording::{Axis, Hit, Hits};
use super::spectrum::Transform;
use touchdown_base::input_error::InputError;

/// A hit's force stands out of its noise by this factor.
const CLEAR: f64 = 20.0;
/// The force is over where it stays below this part of its peak.
const OVER: f64 = 0.02;
/// Kept on either side of the hit, s: the anti-alias filter's ringing.
const SKIRT: f64 = 0.3e-3;
/// A force above this part of the peak outside the hit is a second hit.
const SECOND: f64 = 0.1;
/// The last tenth of a hit is below this part of the greatest acceleration: it has died out.
const DIED_OUT: f64 = 0.01;
/// Error of H that is still usable, part of H.
const USABLE: f64 = 0.1;
/// Noise is averaged over this part of the frequency to either side.
const SMOOTH: f64 = 0.02;
/// The band ends at this part of the rate: above, the anti-alias filter has the say.
const HIGHEST: f64 = 0.4;

/// A calibrated axis.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Of the hammer and the accelerometer.
    pub axis: Axis,
    /// Samples per second, Hz.
    pub rate: f64,
    /// Lowest and highest frequency where H is known to a tenth, Hz.
    pub band: RangeInclusive<f64>,
    /// Mean coherence of acceleration and force in the band; none of a single hit.
    pub coherence: Option<f64>,
    hits: Vec<Clean>,
    /// Mean energy of the acceleration's noise in a hit, (m/s^2)^2.
    noise: f64,
}

/// Force (N) and acceleration (m/s^2) of a hit from their zeros, the force alone in its time.
#[derive(Clone, Debug)]
struct Clean {
    force: Vec<f64>,
    acceleration: Vec<f64>,
    /// Energy of the acceleration's noise, (m/s^2)^2.
    noise: f64,
}

/// H at the frequencies of a transform.
pub struct Response {
    /// 1/kg.
    pub h: Vec<Complex64>,
    /// Variance of `h`, 1/kg^2.
    pub variance: Vec<f64>,
    coherence: Vec<f64>,
}

impl Calibration {
    /// Evaluates the hits.
    pub fn new(hits: &Hits) -> Result<Self, InputError> {
        let clean = |hit| {
            prepare(hit, hits.rate).map_err(|rule| InputError::at_line(&hits.file, hit.line, rule))
        };
        let clean: Vec<Clean> = hits.hits.iter().map(clean).collect::<Result<_, _>>()?;
        let mut calibration = Self {
            axis: hits.axis,
            rate: hits.rate,
            band: 0.0..=0.0,
            coherence: None,
            noise: clean.iter().map(|it| it.noise).sum::<f64>() / clean.len() as f64,
            hits: clean,
        };
        let transform = Transform::holding(calibration.longest());
        let response = calibration.response(&transform);
        let highest = (HIGHEST * transform.length as f64) as usize;
        let Some((low, high)) = usable(&response, highest) else {
            let rule = "at no frequency do the hits stand clear of the acceleration's noise";
            return Err(InputError::at_line(&hits.file, hits.hits[0].line, rule));
        };
        let resolution = hits.rate / transform.length as f64;
        calibration.band = low as f64 * resolution..=high as f64 * resolution;
        if calibration.hits.len() > 1 {
            let part = &response.coherence[low..=high];
            calibration.coherence = Some(part.iter().sum::<f64>() / part.len() as f64);
        }
        Ok(calibration)
    }

    /// Samples of the longest hit.
    pub fn longest(&self) -> usize {
        let lengths = self.hits.iter().map(|it| it.force.len());
        lengths.max().unwrap_or(0)
    }

    /// H at the frequencies of `transform`, which holds the longest hit.
    pub fn response(&self, transform: &Transform) -> Response {
        let spectra = |it: &Clean| [&it.force, &it.acceleration].map(|it| transform.spectrum(it));
        let spectra: Vec<_> = self.hits.iter().map(spectra).collect();
        let bins = 0..transform.bins();
        let sum = |of: fn(Complex64, Complex64) -> Complex64| -> Vec<Complex64> {
            let of_hits = |k: usize| spectra.iter().map(|[f, a]| of(f[k], a[k])).sum();
            bins.clone().map(of_hits).collect()
        };
        let cross = sum(|f, a| a * f.conj());
        let force = sum(|f, _| f.norm_sqr().into());
        let motion = sum(|_, a| a.norm_sqr().into());
        let force = |k: usize| force[k].re.max(f64::MIN_POSITIVE);
        let rest = |k: usize| (motion[k].re - cross[k].norm_sqr() / force(k)).max(0.0);
        let rest: Vec<f64> = bins.clone().map(rest).collect();
        // What the hits disagree by, where it is more than the noise.
        let free = (self.hits.len() - 1).max(1) as f64;
        let spread = smooth(&rest);
        let variance = |k: usize| (spread[k] / free).max(self.noise) / force(k);
        let coherence = |k: usize| 1.0 - rest[k] / motion[k].re.max(f64::MIN_POSITIVE);
        Response {
            h: bins.clone().map(|k| cross[k] / force(k)).collect(),
            variance: bins.clone().map(variance).collect(),
            coherence: bins.map(coherence).collect(),
        }
    }
}

fn prepare(hit: &Hit, rate: f64) -> Result<Clean, String> {
    let force = Quiet::find(&hit.force, rate)?;
    let motion = Quiet::of(&hit.acceleration, force.samples);
    let from_zero = |signal: &[f64], zero: f64| signal.iter().map(|it| it - zero).collect();
    let mut pushed: Vec<f64> = from_zero(&hit.force, force.mean);
    let moved: Vec<f64> = from_zero(&hit.acceleration, motion.mean);
    let peak = greatest(&pushed, 0.0);
    if peak <= CLEAR * force.noise {
        let noise = force.noise;
        return Err(format!(
            "the hit has no force: its greatest, {peak:.3e} N, is not {CLEAR} times its noise, {noise:.3e} N"
        ));
    }
    if greatest(&moved, 0.0) <= CLEAR * motion.noise {
        return Err("the hit moves nothing: its acceleration is all noise".to_owned());
    }
    let top = pushed.iter().position(|it| it.abs() == peak).unwrap_or(0);
    let skirt = (SKIRT * rate).ceil() as usize;
    let quiet = |it: &f64| it.abs() < OVER * peak;
    let begin = pushed[..top].iter().rposition(quiet).unwrap_or(0);
    let end = pushed[top..].iter().position(quiet);
    let end = end.map_or(pushed.len(), |it| top + it);
    let window = begin.saturating_sub(skirt)..(end + skirt).min(pushed.len());
    let outside = (pushed.iter_mut().enumerate()).filter(|(k, _)| !window.contains(k));
    for (k, value) in outside {
        if value.abs() >= SECOND * peak {
            let apart = 1e3 * k.abs_diff(top) as f64 / rate;
            return Err(format!(
                "the hammer hits twice: {value:.3e} N, {apart:.3} ms from the peak"
            ));
        }
        *value = 0.0;
    }
    let tail = &moved[moved.len() - moved.len() / 10..];
    let rms = (tail.iter().map(|it| it * it).sum::<f64>() / tail.len().max(1) as f64).sqrt();
    if rms > (DIED_OUT * greatest(&moved, 0.0)).max(3.0 * motion.noise) {
        return Err("the hit is cut off: its acceleration must die out before it ends".to_owned());
    }
    Ok(Clean {
        force: pushed,
        noise: moved.len() as f64 * motion.noise * motion.noise,
        acceleration: moved,
    })
}

/// First and last frequency around the clearest where the error of H is small, below `highest`.
fn usable(response: &Response, highest: usize) -> Option<(usize, usize)> {
    let power: Vec<f64> = response.h.iter().map(Complex64::norm_sqr).collect();
    let power = smooth(&power);
    let ratio = |k: usize| power[k] / response.variance[k].max(f64::MIN_POSITIVE);
    let enough = |k: &usize| ratio(*k) * USABLE * USABLE >= 1.0;
    let clearest = (1..highest).max_by(|a, b| ratio(*a).total_cmp(&ratio(*b)))?;
    if !enough(&clearest) {
        return None;
    }
    let low = (1..=clearest).rev().take_while(enough).last()?;
    let high = (clearest..highest).take_while(enough).last()?;
    Some((low, high))
}

/// Mean over neighbours, a part of the frequency to either side.
fn smooth(values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    for value in values {
        sums.push(sums[sums.len() - 1] + value);
    }
    let mean = |k: usize| {
        let reach = (SMOOTH * k as f64) as usize;
        let (from, to) = (k.saturating_sub(reach), (k + reach + 1).min(values.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}
