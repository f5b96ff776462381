"""Who runs, at what settings: each row of a table is a command for each variant of the drop."""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import drop

HERE = Path(__file__).resolve().parent
RUST = HERE.parent / "rust/target/release"
SYSTEM_PYTHON = "/usr/bin/python3"
# Simulated time that is timed, s; the scored part of the variants but E is shorter than it.
DURATION = 0.5
# Until just after impact 5 of these.
UNTIL_FIVE = {"S": 0.0094, "T": 0.02}
# Interval of the samples of adaptive solvers, s, by duration of the contact, us.
EVERY = {280: "1e-5", 28: "1e-6"}


@dataclass
class Peer:
    """A row of the table."""

    name: str
    setting: str
    # ours, penalty (another law of contact), time-stepping or events.
    kind: str
    # From variant, file for samples, duration and repeats to the command.
    command: object
    repeats: int
    # Whether the program tells its impacts; else they are read from its samples.
    tells: bool = False


def ours(rung, precision, step_us, way, repeats=101, cutoff=None):
    model = f'rung = "{rung}"\nprecision = "{precision}"\nstep_us = {step_us}'
    setting = f"{rung} {precision}, " + (
        f"steps of {step_us} us" if way == "steps" else "changes alone"
    )
    if cutoff:
        model += f"\ncutoff_mm_s = {cutoff}"
        setting += f", cutoff {cutoff} mm/s"

    def command(variant, file, duration, repeats):
        # Read for the energy alone: it tells its impacts.
        samples = file if variant == "E" else "-"
        return [RUST / "ours", variant, model, way, duration, samples, repeats]

    return Peer("Touchdown", setting, "ours", command, repeats, tells=True)


def contact(variant, contact_time):
    return drop.penalty(contact_time, drop.VARIANTS[variant][1])


def ode_solvers(contact_us, method, setting, repeats):
    def command(variant, file, duration, repeats):
        law = contact(variant, contact_us * 1e-6)
        every = EVERY[contact_us] if method == "dopri5" else setting
        return [RUST / "penalty", variant, *law, method, setting, duration, every, file, repeats]

    what = "rtol" if method == "dopri5" else "step"
    setting_text = f"penalty {contact_us} us, {method}, {what} {setting}"
    return Peer("ode_solvers", setting_text, "penalty", command, repeats)


def scipy_penalty(contact_us, method, rtol, repeats):
    def command(variant, file, duration, repeats):
        law = contact(variant, contact_us * 1e-6)
        program, every = HERE / "scipy_penalty.py", EVERY[contact_us]
        return [sys.executable, program, variant, *law, method, rtol, duration, every, file, repeats]

    setting = f"penalty {contact_us} us, {method}, rtol {rtol}"
    return Peer("scipy", setting, "penalty", command, repeats)


def scipy_events(method, rtol, max_step, repeats):
    def command(variant, _, duration, repeats):
        program = HERE / "scipy_events.py"
        return [sys.executable, program, variant, method, rtol, max_step, duration, repeats]

    setting = f"events, {method}, rtol {rtol}, max_step {max_step}"
    return Peer("scipy", setting, "events", command, repeats, tells=True)


def siconos(step, repeats):
    def command(variant, file, duration, repeats):
        program = HERE / "siconos_drop.py"
        return [SYSTEM_PYTHON, program, variant, step, duration, file, repeats]

    return Peer("Siconos", f"Moreau-Jean, step {step}", "time-stepping", command, repeats)


def pymunk(step, repeats):
    def command(variant, file, duration, repeats):
        program = HERE / "pymunk_drop.py"
        return [sys.executable, program, variant, step, 32, duration, file, repeats]

    return Peer("pymunk", f"small disk, 32 segments, step {step}", "time-stepping", command, repeats)


def has_siconos():
    check = [SYSTEM_PYTHON, "-c", "import siconos.kernel"]
    return subprocess.run(check, capture_output=True, check=False).returncode == 0


PEERS = [
    *(
        ours("rigid", precision, step_us, "steps", repeats)
        for precision in ("f64", "f32")
        for step_us, repeats in ((1, 11), (10, 51), (100, 101), (1000, 101))
    ),
    ours("rigid", "f64", 100, "changes"),
    ours("rigid", "f32", 100, "changes"),
    ours("rigid", "f64", 100, "changes", cutoff=0.1),
    ours("moreau", "f64", 100, "steps", 51),
    ours("moreau", "f64", 10, "steps", 51),
    ours("hertz", "f64", 10, "steps", 51),
    scipy_events("RK45", "1e-6", "inf", 7),
    scipy_events("RK45", "1e-9", "2e-3", 5),
    scipy_events("DOP853", "1e-12", "2e-3", 5),
    scipy_events("RK45", "1e-9", "1e-5", 3),
    scipy_events("RK45", "1e-6", "hop", 7),
    scipy_events("DOP853", "1e-9", "hop", 7),
    scipy_penalty(280, "RK45", "1e-4", 3),
    scipy_penalty(280, "LSODA", "1e-6", 3),
    scipy_penalty(28, "LSODA", "1e-6", 3),
    ode_solvers(280, "rk4", "1e-5", 51),
    ode_solvers(280, "dopri5", "1e-5", 51),
    ode_solvers(280, "dopri5", "1e-8", 51),
    ode_solvers(28, "rk4", "1e-6", 7),
    ode_solvers(28, "dopri5", "1e-5", 21),
    ode_solvers(28, "dopri5", "1e-8", 11),
    siconos("1e-3", 5),
    siconos("1e-4", 5),
    siconos("1e-5", 3),
    pymunk("1e-4", 5),
    pymunk("1e-5", 3),
]

# The coarsest that show all five, by trial, one that does not, and finer ones.
SICONOS_STEPS = {
    "S": ("1e-4", "4.5e-5", "3e-5", "1e-5", "3e-6"),
    "T": ("1e-3", "7e-4", "5e-4", "3e-4", "1e-4", "3e-5", "1e-5", "3e-6"),
}
OUR_STEPS = ((1, 1), (3, 3), (10, 5), (30, 7), (100, 15), (200, 15), (1000, 31))
# Of the variants of which five impacts are scored.
FIVE = {
    variant: [
        *(
            ours("coupled", precision, step_us, "steps", repeats)
            for precision in ("f64", "f32")
            for step_us, repeats in OUR_STEPS
        ),
        scipy_events("RK45", "1e-3", "inf", 2),
        scipy_events("RK45", "1e-4", "1e-3", 2),
        scipy_events("RK45", "1e-6", "inf", 2),
        scipy_events("DOP853", "1e-9", "1e-3", 2),
        *(siconos(step, 1 if float(step) < 2e-5 else 5) for step in steps),
    ]
    for variant, steps in SICONOS_STEPS.items()
}
