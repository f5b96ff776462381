//! Where the rotor has been, in the clearance circle.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::symbols::Marker;
use ratatui::widgets::canvas::{Canvas, Circle, Points};
use ratatui::widgets::{Block, Paragraph};

use super::watched::Watched;

/// Half of the picture, in clearances.
const HALF: f64 = 1.1;
/// Dots of a braille character.
const DOTS: [f64; 2] = [2.0, 4.0];

/// Draws the orbit of `plane` (0 is a).
pub(super) fn orbit(frame: &mut Frame<'_>, area: Rect, watched: &Watched, plane: usize) {
    let name = ["a", "b"].get(plane).unwrap_or(&"?");
    let told = watched.settings.map(|it| it.monitor.detector.machine);
    let clearance = told.map(|it| f64::from(it.clearance));
    let clearance = clearance.filter(|it| *it > 0.0);
    let title = clearance.map_or_else(
        || format!(" orbit, plane {name} "),
        |it| format!(" orbit, plane {name}, clearance {:.3} mm ", it * 1e3),
    );
    let block = Block::bordered().title(title);
    let inside = block.inner(area);
    let (trail, newest) = watched.trail(plane);
    let unit = clearance.unwrap_or(1.0);
    let points: Vec<(f64, f64)> = trail.map(|[x, y]| (x / unit, y / unit)).collect();
    if clearance.is_none() || points.is_empty() {
        let text = "no positions yet";
        frame.render_widget(Paragraph::new(text).centered().block(block), area);
        return;
    }
    let (old, new) = points.split_at(points.len().saturating_sub(newest));
    let dots = [inside.width, inside.height].map(f64::from);
    let [wide, high] = [dots[0] * DOTS[0], dots[1] * DOTS[1]];
    // Round on the screen: the shorter side sets the scale.
    let short = wide.min(high).max(1.0);
    let [x, y] = [HALF * wide / short, HALF * high / short];
    let canvas = Canvas::default()
        .block(block)
        .marker(Marker::Braille)
        .x_bounds([-x, x])
        .y_bounds([-y, y])
        .paint(|context| {
            context.draw(&Circle::new(0.0, 0.0, 1.0, Color::DarkGray));
            context.draw(&Points::new(old, Color::Blue));
            context.layer();
            context.draw(&Points::new(new, Color::LightYellow));
        });
    frame.render_widget(canvas, area);
}
