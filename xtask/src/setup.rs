//! Installs what is missing, after saying so.

use std::io::{self, IsTerminal, Write};
use std::process::Command;

use anyhow::{Context, ensure};

use crate::machine::Machine;
use crate::toolchain::{TARGET, Toolchain};

/// Installs what the firmware and its emulator need; does nothing where nothing is missing. With
/// `yes`, or where nobody could answer, it does not ask.
pub fn run(yes: bool) -> anyhow::Result<()> {
    let commands = plan(&Machine::look())?;
    if commands.is_empty() {
        println!("Set-up: nothing is missing.");
        return Ok(());
    }
    println!("Set-up installs what the firmware and its emulator need, by:");
    for command in &commands {
        println!("    {}", command.join(" "));
    }
    ensure!(yes || agrees()?, "set-up was declined");
    for command in &commands {
        execute(command)?;
    }
    let left = plan(&Machine::look())?;
    ensure!(left.is_empty(), "still missing after set-up: {left:?}");
    Ok(())
}

type CommandLine = Vec<&'static str>;

/// The commands that install what `machine` lacks.
fn plan(machine: &Machine) -> anyhow::Result<Vec<CommandLine>> {
    let mut commands: Vec<CommandLine> = Vec::new();
    if machine.toolchain == Toolchain::Default && !machine.target_installed {
        commands.push(vec!["rustup", "target", "add", TARGET]);
    }
    if !machine.missing_packages.is_empty() {
        let missing = machine.missing_packages.join(", ");
        ensure!(
            machine.has_apt,
            "install these first, by their names in Debian: {missing} (there is no apt-get here)"
        );
        let sudo: &[&str] = if machine.is_root { &[] } else { &["sudo"] };
        let install = ["apt-get", "install", "-y", "--no-install-recommends"];
        commands.push([sudo, &["apt-get", "update"]].concat());
        commands.push([sudo, &install, &machine.missing_packages].concat());
    }
    Ok(commands)
}

fn agrees() -> io::Result<bool> {
    if !io::stdin().is_terminal() {
        return Ok(true);
    }
    print!("Go on? [Y/n] ");
    io::stdout().flush()?;
    let mut answer = String::new();
    // No byte at all is the end of input, not a plain Enter.
    let read = io::stdin().read_line(&mut answer)?;
    let answer = answer.trim().to_lowercase();
    Ok(read > 0 && ["", "y", "yes"].contains(&answer.as_str()))
}

fn execute(command: &[&str]) -> anyhow::Result<()> {
    let shown = command.join(" ");
    println!("+ {shown}");
    let (program, arguments) = command.split_first().context("an empty command")?;
    let status = Command::new(program)
        .args(arguments)
        .env("DEBIAN_FRONTEND", "noninteractive")
        .status()
        .with_context(|| format!("cannot run `{shown}`"))?;
    ensure!(status.success(), "`{shown}` failed ({status})");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complete() -> Machine {
        Machine {
            toolchain: Toolchain::Default,
            target_installed: true,
            missing_packages: vec![],
            has_apt: true,
            is_root: true,
        }
    }

    fn lines(machine: &Machine) -> Vec<String> {
        let commands = plan(machine).unwrap();
        commands.iter().map(|command| command.join(" ")).collect()
    }

    #[test]
    fn complete_machine_needs_nothing() {
        assert!(lines(&complete()).is_empty());
        let debian = Machine {
            toolchain: Toolchain::Debian,
            target_installed: false,
            ..complete()
        };
        assert!(lines(&debian).is_empty());
    }

    #[test]
    fn rustup_adds_the_target_where_it_may() {
        let machine = Machine {
            target_installed: false,
            ..complete()
        };
        assert_eq!(lines(&machine), ["rustup target add thumbv7em-none-eabihf"]);
    }

    #[test]
    fn debian_toolchain_never_calls_rustup() {
        let machine = Machine {
            toolchain: Toolchain::Debian,
            target_installed: false,
            missing_packages: vec!["rustc-web", "lld"],
            ..complete()
        };
        assert_eq!(
            lines(&machine),
            [
                "apt-get update",
                "apt-get install -y --no-install-recommends rustc-web lld"
            ]
        );
    }

    #[test]
    fn packages_need_sudo_unless_root() {
        let machine = Machine {
            missing_packages: vec!["qemu-system-arm"],
            is_root: false,
            ..complete()
        };
        assert_eq!(
            lines(&machine),
            [
                "sudo apt-get update",
                "sudo apt-get install -y --no-install-recommends qemu-system-arm"
            ]
        );
    }

    #[test]
    fn without_apt_it_names_what_is_missing() {
        let machine = Machine {
            missing_packages: vec!["qemu-system-arm"],
            has_apt: false,
            ..complete()
        };
        let error = plan(&machine).unwrap_err().to_string();
        assert!(error.contains("qemu-system-arm"), "{error}");
    }
}
