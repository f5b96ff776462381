//! `touchdown rig`.

use std::io::{self, BufRead};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use super::args::RigArgs;
use super::load;
use crate::gate::{Gate, print};
use crate::rig::{Options, Order, Rig};
use touchdown_base::failure::Failure;
use touchdown_base::interrupt::TemporaryFolder;
use touchdown_run::emulator::Emulator;
use touchdown_scene::names::channel_name;

const CHANNELS: u8 = 4;
/// What can be typed.
const ORDERS: &str =
    "lift, drop, fault CHANNEL KIND, repair, noise PART, cut, service on|off or quit";
const LOOK: Duration = Duration::from_millis(50);
/// What the rig and its emulator write in their folder.
const FILES: [&str; 6] = ["log", "settings", "replay", "answer", "out", "err"];

/// Starts a rig and takes orders from standard input until `quit`; its end is none.
pub(super) fn rig(args: &RigArgs) -> Result<(), Failure> {
    let emulator = Emulator::find(args.image.as_deref())?;
    let (folder, _temporary) = match &args.keep {
        Some(folder) => (PathBuf::from(folder), None),
        None => {
            let made = TemporaryFolder::new().map_err(Failure::output("a folder"))?;
            (made.path().to_owned(), Some(made))
        }
    };
    let log = folder.join("log");
    Gate::new()
        .reads("SCENE", [&args.scene])
        .reads("--image", [&emulator.image])
        .makes_folder(&folder.display().to_string())
        .claims("--keep", FILES.map(|it| folder.join(it)))
        .open()?;
    let scene = load(&args.scene)?;
    let rig = Rig::start(
        scene,
        emulator,
        Options {
            folder,
            port: args.port,
            noise: args.noise,
            fast: args.fast,
        },
    )?;
    let (address, log) = (rig.address, log.display());
    let where_to = format!("link: tcp:{address}\n    touchdown live tcp:{address}\nlog: {log}\n");
    print(&format!("{where_to}{ORDERS}\n"))?;
    obey(&rig, &lines())?;
    rig.stop()
}

fn obey(rig: &Rig, lines: &Receiver<String>) -> Result<(), Failure> {
    while !rig.has_stopped() {
        match lines.recv_timeout(LOOK) {
            Ok(line) => match order(&line) {
                Ok(None) if line.trim() == "quit" => return Ok(()),
                Ok(None) => {}
                Ok(Some(order)) => drop(rig.order(order)),
                Err(rule) => print(&format!("{}: {rule}\n", line.trim()))?,
            },
            // Nobody types: it goes on until it is killed.
            Err(RecvTimeoutError::Disconnected) => thread::sleep(LOOK),
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
    Ok(())
}

/// Lines of standard input, which is waited for elsewhere.
fn lines() -> Receiver<String> {
    let (sender, lines) = channel();
    thread::spawn(move || {
        for line in io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    lines
}

/// What a line orders; nothing for an empty one and `quit`.
fn order(line: &str) -> Result<Option<Order>, &'static str> {
    let words: Vec<_> = line.split_whitespace().collect();
    Ok(Some(match words[..] {
        [] | ["quit"] => return Ok(None),
        ["lift"] => Order::Lift,
        ["drop"] => Order::Drop,
        ["repair"] => Order::Repair,
        ["cut"] => Order::Cut,
        ["service", state @ ("on" | "off")] => Order::Service(state == "on"),
        ["noise", part] => match part.parse() {
            Ok(part) if (0.0..=1.0).contains(&part) => Order::Noise(part),
            _ => return Err("noise is a part from 0 to 1"),
        },
        ["fault", channel, kind] => {
            let channel = (0..CHANNELS).find(|it| channel_name(*it) == channel);
            let channel = channel.ok_or("the channels are ax, ay, bx, by")?;
            let kinds = "the kinds are open, short, dropped, stuck, reversed, swapped";
            Order::Spoil(channel.into(), kind.parse().map_err(|_| kinds)?)
        }
        _ => return Err(ORDERS),
    }))
}

#[cfg(test)]
mod tests {
    use touchdown_scene::sensors::Failing;

    use super::*;

    #[test]
    fn orders_are_what_their_line_says() {
        assert_eq!(order(" drop "), Ok(Some(Order::Drop)));
        assert_eq!(
            order("fault by stuck"),
            Ok(Some(Order::Spoil(3, Failing::Stuck)))
        );
        assert_eq!(order("noise 1e-3"), Ok(Some(Order::Noise(1e-3))));
        assert_eq!(order("service on"), Ok(Some(Order::Service(true))));
        assert_eq!(order(""), Ok(None));
        for wrong in [
            "noise 2",
            "noise NaN",
            "fault cx stuck",
            "fault ax odd",
            "service",
            "fly",
        ] {
            assert!(order(wrong).is_err(), "{wrong}");
        }
    }
}
