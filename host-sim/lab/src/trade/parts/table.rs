//! What each part is worth, as text in 80 columns.

use super::{Effect, Omission, Worth};
use touchdown_base::paint::Paint;

/// Of a line, for the list of what did not change.
const WIDTH: usize = 76;

/// A block for each part.
pub fn text(worth: &Worth, paint: Paint) -> String {
    if worth.without.is_empty() {
        return "The scene has no part that can be left out.\n".to_owned();
    }
    let mut text = paint.bold("What each part is worth") + "\n";
    text += &format!(
        "{} drops with the whole machine, and the same without the part; starts within half\n\
         of the clearance and 20 mm/s, friction and mounts to a factor of 2, restitution\n\
         to 0.1. Means; in brackets the change with its 95 % interval.\n\n",
        worth.drops
    );
    for it in &worth.without {
        text += &block(it, paint);
    }
    text
}

fn block(it: &Omission, paint: Paint) -> String {
    let head = format!("without {}", it.part);
    let mut text = format!("{:<55}{:>8.2} of the time\n", paint.bold(&head), it.cost);
    let (seen, alike): (Vec<&Effect>, Vec<_>) = it.changes.iter().partition(|it| it.is_seen());
    for change in seen {
        let [low, high] = change.interval;
        text += &format!(
            "  {:<20}{:>11} -> {:<11} ({} to {})\n",
            change.quantity,
            change.shown(change.whole),
            change.shown(change.without),
            signed(change, low),
            signed(change, high),
        );
    }
    let mut line = "  no change seen:".to_owned();
    for (k, change) in (1..).zip(&alike) {
        if line.len() + change.quantity.len() > WIDTH {
            text += &format!("{line}\n");
            line = "    ".to_owned();
        }
        line += &format!(
            " {}{}",
            change.quantity,
            if k < alike.len() { "," } else { "" }
        );
    }
    if !alike.is_empty() {
        text += &format!("{line}\n");
    }
    text + "\n"
}

fn signed(change: &Effect, of: f64) -> String {
    let sign = if of < 0.0 { "-" } else { "+" };
    sign.to_owned() + &change.shown(of.abs())
}
