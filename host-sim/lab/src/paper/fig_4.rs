//! Fig. 4: a drop that whirls (a) and one that swings (b): path in the clearance circle, theta' over time.

use std::io;

use maud::{Markup, html};

use super::Curve;
use super::rig::rate;
use touchdown_base::failure::Failure;
use touchdown_chart::plot::{Axis, Chart};
use touchdown_page::report::orbit::orbit;
use touchdown_run::drop;
use touchdown_run::outcome::Outcome;
use touchdown_run::target::Target;
use touchdown_scene::Scene;

/// Part of the clearance beyond which theta' is drawn: at the centre it has no bound.
const NEAR: f64 = 0.8;
const HEIGHT: f64 = 240.0;

/// A drop of the figure.
#[derive(Clone, Debug)]
pub struct Drawn {
    scene: Scene,
    outcome: Outcome,
    figure: &'static str,
}

/// Simulates both on their built-in scenes.
pub fn drops() -> Result<Vec<Drawn>, Failure> {
    [("4a", "backward-whirl"), ("4b", "rig")]
        .into_iter()
        .map(|(figure, name)| {
            let scene = Scene::load(name)?;
            let (outcome, _) = drop::by_reference(&scene, &Target::Host, None::<io::Sink>)?;
            Ok(Drawn {
                scene,
                outcome,
                figure,
            })
        })
        .collect()
}

/// theta' over time, near the wall.
pub fn curve(drawn: &Drawn) -> Curve {
    let near = NEAR * drawn.scene.retainer.clearance;
    let points = drawn.outcome.trace.iter().filter(|it| it.state.time >= 0.0);
    Curve {
        figure: drawn.figure,
        name: "theta' beyond 80 % of the clearance".to_owned(),
        x: "time since release, s",
        y: "theta', rad/s",
        points: points
            .map(|point| {
                let [x, y] = point.state.position;
                (f64::hypot(x, y) > near).then(|| [point.state.time, rate(&point.state)])
            })
            .collect(),
        class: "motion",
    }
}

pub fn drawing(drawn: &Drawn, curve: &Curve) -> Markup {
    let end = drawn.scene.run.duration * 1e3;
    let x = Axis::new(0.0, end, "time since release, ms", 6.0);
    let (low, top) = (curve.values().fold(0.0, f64::min), curve.top());
    let margin = 0.06 * (top - low);
    let title = "\u{3b8}\u{2032} near the wall, rad/s";
    let y = Axis::new(low - margin, top + margin, title, 6.0);
    let chart = Chart {
        title: "theta' over time",
        description: "Angular speed round the bearing over time, where the rotor is beyond 80 % of the clearance.",
        x: &x,
        y: &y,
        height: HEIGHT,
    };
    html! {
        (orbit(drawn.scene.retainer.clearance, drawn.scene.rotor.spin, &drawn.outcome))
        (chart.plain(&curve.draw(&chart, [1e3, 1.0])))
    }
}
