//! What the wall took: the impulse of each impact, and its force over time where the materials are known.

use super::window::Window;
use maud::{Markup, html};
use touchdown_base::history::{History, Impact};
use touchdown_chart::plot::{Axis, Chart};
use touchdown_chart::text::{ms, si};
use touchdown_run::fidelity::force;
use touchdown_run::outcome::Outcome;
use touchdown_scene::{Fidelity, Scene};
use touchdown_truth::reference::press::Press;
use touchdown_truth::reference::pulse::Meeting;

const HEIGHT: f64 = 150.0;
/// Where the reference finds no damping below, no force is drawn.
const LEAST_RESTITUTION: f64 = 0.01;

/// Each ring's impulses, and the force of its first impact.
pub fn force(window: Window, scene: &Scene, outcome: &Outcome) -> Markup {
    // Fidelity `hertz` takes steel for what the scene does not give.
    let known = scene.materials.given || scene.model.rung == Fidelity::Hertz;
    let press = known.then(|| force::press(scene)).flatten();
    let rings: Vec<(Option<&str>, &History, f64)> = if outcome.truth.rings.is_empty() {
        vec![(None, &outcome.truth.whole, scene.retainer.restitution)]
    } else {
        let rings = scene.rings().iter().zip(&outcome.truth.rings);
        let rings = rings.map(|(it, truth)| (Some(&*it.name), truth, it.retainer.restitution));
        rings.collect()
    };
    html! {
        @for (name, truth, restitution) in rings {
            @if let Some(name) = name { h3 { "Ring " (name) } }
            @if let Some(first) = truth.impacts.first() {
                (impulses(window, &truth.impacts))
                @match press.and_then(|press| meeting(first, restitution, press)) {
                    Some(meeting) => { (pulse(first, &meeting)) },
                    None => {
                        p.note {
                            "The first impact: " (si(first.normal_impulse, "N s")) " at " (ms(first.state.time)) "\u{a0}ms. "
                            @if press.is_some() {
                                "No force over time is drawn: this impact has no rebound to find its damping from."
                            } @else {
                                "No force over time: a rigid contact has none, and the scene has no table [materials] to find it from."
                            }
                        }
                    },
                }
            } @else {
                p { "No impact." }
            }
        }
    }
}

fn impulses(window: Window, impacts: &[Impact]) -> Markup {
    let x = window.axis();
    let milli = |impact: &Impact| impact.normal_impulse * 1e3;
    let highest = impacts.iter().map(milli).fold(0.0, f64::max);
    let y = Axis::new(0.0, 1.1 * highest, "normal impulse, mN s", 4.0);
    let chart = Chart {
        title: "Impulses of the impacts",
        description: "An upright line for each impact, as high as its impulse.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    let front = html! {
        @for impact in impacts {
            @let (at, top) = (x.percent(impact.state.time), milli(impact));
            @if x.shows(impact.state.time) {
                line.hit x1=(at) x2=(at) y1=(HEIGHT) y2=(HEIGHT * (1.0 - y.fraction(top))) {}
            }
        }
    };
    chart.draw(&html! {}, &html! {}, &front)
}

/// The impact as that of a mass on a wall, with the mass that its impulse and its speed belong to: less than the
/// rotor's where the ring gives way or the rotor tilts.
fn meeting(impact: &Impact, restitution: f64, press: Press) -> Option<Meeting> {
    let mass = impact.normal_impulse / ((1.0 + restitution) * impact.normal_speed);
    let there = restitution >= LEAST_RESTITUTION && mass > 0.0 && mass.is_finite();
    there.then_some(Meeting {
        mass,
        speed: impact.normal_speed,
        restitution,
        press,
        gravity: 0.0,
    })
}

fn pulse(first: &Impact, meeting: &Meeting) -> Markup {
    let history = meeting.history();
    let peak = history.iter().map(|it| it.1).fold(0.0, f64::max);
    let duration = history.last().map_or(0.0, |it| it.0);
    let chart = Chart {
        title: "Force of the first impact",
        description: "Normal force over time, from touch to release, of a compliant contact of the scene's materials.",
        x: &Axis::new(0.0, 1.05e6 * duration, "\u{b5}s after the touch", 6.0),
        y: &Axis::new(0.0, 1.1 * peak, "normal force, N", 4.0),
        height: HEIGHT,
    };
    let curve = chart.curve("motion", history.iter().map(|it| (it.0 * 1e6, it.1)));
    html! {
        (chart.plain(&curve))
        p.note {
            "The first impact, at " (ms(first.state.time)) "\u{a0}ms: " (si(first.normal_impulse, "N s")) " in "
            (si(duration, "s")) ", at most " (si(peak, "N"))
            ". From the scene's materials, with the impact's impulse: where the model is rigid it does not see this force."
        }
    }
}
