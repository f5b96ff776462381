//! From the monitor's notices, on the sample clock, to events in seconds.

use touchdown_core::event::{Event, EventKind, Notice, Touch};
use touchdown_core::forecast::Outlook;

use crate::controller_trace::MonitorOutput;
use crate::outcome::{DetectedEvent, Detection, Forecast, TouchEvent};
use crate::timebase::Timebase;
use touchdown_files::drop_log::ChannelFault;
use touchdown_scene::names::channel_name;

/// An event, as far as its declaration tells.
pub fn declared(event: &Event, timebase: Timebase) -> DetectedEvent {
    DetectedEvent {
        number: event.number,
        event: event.kind,
        onset_s: timebase.time(event.onset.samples()),
        declared_s: timebase.time(event.declared as f64),
        confirmed_s: None,
        withdrawn_s: None,
        sample: event.declared,
        plane: event.plane.into(),
        normal_speed_m_s: (event.kind == EventKind::Impact)
            .then_some(f64::from(event.normal_speed)),
        motion: event.motion.into(),
        fault: event.fault.map(|fault| ChannelFault {
            channel: channel_name(fault.channel),
            kind: fault.kind,
        }),
    }
}

/// Takes what a notice tells into `events`: a new one, or what became of the last one of its number.
pub fn take(events: &mut Vec<DetectedEvent>, notice: &Notice, timebase: Timebase) {
    let (Notice::Confirmed { number, sample } | Notice::Withdrawn { number, sample }) = notice
    else {
        if let Notice::Declared(event) = notice {
            events.push(declared(event, timebase));
        }
        return;
    };
    if let Some(event) = events.iter_mut().rfind(|it| it.number == *number) {
        let time = Some(timebase.time(*sample as f64));
        match notice {
            Notice::Confirmed { .. } => event.confirmed_s = time,
            _ => event.withdrawn_s = time,
        }
    }
}

/// A touch, as far as it is told; how fast it came the detector may say.
pub fn touch(touch: &Touch, timebase: Timebase) -> TouchEvent {
    TouchEvent {
        onset_s: timebase.time(touch.onset as f64),
        declared_s: timebase.time(touch.declared as f64),
        end_s: touch.end.map(|end| timebase.time(end as f64)),
        sample: touch.declared,
        plane: touch.plane.into(),
        peak_fraction: f64::from(touch.peak),
        normal_speed_m_s: None,
    }
}

/// Longest time from a touch to the detector's impact that it is, s.
const SAME_IMPACT: f64 = 4e-3;

/// Speed of the first impact that the detector found in each touch.
fn add_speeds(touches: &mut [TouchEvent], events: &[DetectedEvent]) {
    for touch in touches {
        let end = touch.end_s.unwrap_or(f64::INFINITY);
        let span = touch.onset_s - SAME_IMPACT..=end.min(touch.onset_s + SAME_IMPACT);
        let impact = events
            .iter()
            .find(|it| it.event == EventKind::Impact && span.contains(&it.onset_s));
        touch.normal_speed_m_s = impact.and_then(|it| it.normal_speed_m_s);
    }
}

/// The events of `answer`; a free fall has its confirmation or withdrawal with it.
pub fn detection(answer: &MonitorOutput, timebase: Timebase) -> Detection {
    let mut found = Detection {
        left_out: answer.left_out,
        severity: answer.severity.into(),
        summary: answer.summary,
        ..Detection::default()
    };
    for notice in &answer.notices {
        match *notice {
            Notice::Outlook(outlook) => found.forecasts.push(forecast(&outlook, timebase)),
            // One that has ended is told a second time; none begins before.
            Notice::Touch(it) if it.end.is_none() => found.touches.push(touch(&it, timebase)),
            Notice::Touch(it) => {
                if let Some(last) = found.touches.last_mut() {
                    *last = TouchEvent {
                        sample: last.sample,
                        declared_s: last.declared_s,
                        ..touch(&it, timebase)
                    };
                }
            }
            _ => take(&mut found.events, notice, timebase),
        }
    }
    add_speeds(&mut found.touches, &found.events);
    found
}

/// What an outlook foretells.
pub fn forecast(outlook: &Outlook, timebase: Timebase) -> Forecast {
    let made_s = timebase.time(outlook.made_at as f64);
    let time_left = outlook.onset.map(|onset| f64::from(onset.time_left));
    Forecast {
        from_s: timebase.time(outlook.from.samples()),
        made_s,
        probability_forward: f64::from(outlook.probability_forward),
        probability_backward: f64::from(outlook.probability_backward),
        time_left_s: time_left,
        begins_s: time_left.map(|left| made_s + left),
        growth_s: outlook.onset.map(|onset| f64::from(onset.growth_time)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_core::event::{Moment, Motion, Plane};
    use touchdown_core::monitor::Summary;
    use touchdown_core::severity::Severity;

    #[test]
    fn stamps_are_whole_samples() {
        let timebase = Timebase::new(-0.2, 30_000.0);
        assert_eq!(timebase.time(6000.0), 0.0);
        assert_eq!(timebase.time(6001.0), 1.0 / 30_000.0);
        assert_eq!(Timebase::new(0.123_456_7, 20_000.0).time(0.0), 0.123_456_7);
    }

    #[test]
    fn a_free_fall_carries_its_fate() {
        let fall = |number, sample| {
            Notice::Declared(Event {
                number,
                kind: EventKind::FreeFall,
                onset: Moment::of_sample(sample - 10),
                declared: sample,
                plane: Plane::Both,
                normal_speed: 0.0,
                motion: Motion::Cylindrical,
                fault: None,
            })
        };
        let answer = MonitorOutput {
            notices: vec![
                fall(0, 100),
                Notice::Withdrawn {
                    number: 0,
                    sample: 140,
                },
                fall(1, 300),
                Notice::Confirmed {
                    number: 1,
                    sample: 350,
                },
            ],
            left_out: 0,
            severity: Severity::default(),
            summary: Summary {
                samples: 1000,
                faults: 2,
                conditions: Default::default(),
                state_hash: 0,
            },
            log: Vec::new(),
        };
        let detection = detection(&answer, Timebase::new(0.0, 1000.0));
        let fates: Vec<_> = detection
            .events
            .iter()
            .map(|event| (event.onset_s, event.confirmed_s, event.withdrawn_s))
            .collect();
        assert_eq!(fates, [(0.09, None, Some(0.14)), (0.29, Some(0.35), None)]);
        assert_eq!(detection.events[0].normal_speed_m_s, None);
    }
}
