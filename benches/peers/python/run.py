"""Runs every peer over the same drops and writes RESULTS.md and results.json."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import drop
import scoring
import table
from peers import DURATION, FIVE, HERE, PEERS, RUST, UNTIL_FIVE, has_siconos

BUILD = HERE.parent / "build"


def run(command):
    """The JSON line that a peer's program prints last."""
    environment = {**os.environ, "LD_LIBRARY_PATH": str(BUILD), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [str(word) for word in command],
        cwd=BUILD,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    if done.returncode != 0:
        raise RuntimeError(f"{command[0]}: {done.stderr[-500:]}")
    return json.loads(done.stdout.splitlines()[-1])


def course(peer, variant, folder, duration, repeats):
    """What a peer's program answers, its samples and its impacts."""
    file = Path(folder) / "samples"
    found = run(peer.command(variant, file, duration, repeats))
    samples = None
    if file.exists():
        samples = np.fromfile(file, "<f8").reshape(-1, 1 + 4 * len(drop.machine(variant).rings))
        file.unlink()
    return found, samples, scoring.told(found["impacts"]) if peer.tells else scoring.seen(samples)


def timed(row, found):
    row["cpu_per_simulated"] = found["cpu_s"] / DURATION
    steps = found["steps"]
    row["ns_per_step"] = found["cpu_s"] / steps * 1e9 if steps else None


def score(peer, row, exact, folder):
    """The figures of a row of the first table."""
    for variant in "ACE":
        repeats = peer.repeats if variant == "A" else 1
        found, samples, impacts = course(peer, variant, folder, DURATION, repeats)
        if variant == "E":
            row["E_energy_drift"] = scoring.energy_drift(
                found["impacts"] if samples is None else samples
            )
            continue
        row[f"{variant}_errors"] = scoring.errors(impacts, exact[variant]["impacts"], 3)
        if variant == "A":
            row["A_counted"] = scoring.counted(impacts, exact["A"]["contact_starts"][0])
            timed(row, found)


def score_five(peer, row, variant, exact, folder):
    """The figures of a row of the tables of five impacts. Events are not followed beyond these."""
    until = UNTIL_FIVE[variant]
    found, _, impacts = course(peer, variant, folder, until, 5 * peer.repeats)
    row["cpu_to_five"] = found["cpu_s"]
    if peer.kind != "events":
        found, _, impacts = course(peer, variant, folder, DURATION, peer.repeats)
        timed(row, found)
    row["errors"] = scoring.errors(impacts, exact[variant]["impacts"], 5)


def main():
    variants = ["A", "C", "E", *FIVE]
    exact = {variant: run([RUST / "ours", variant, "exact", DURATION]) for variant in variants}
    installed = has_siconos()
    tables = {"": PEERS, **FIVE}
    rows = {variant: [] for variant in tables}
    with tempfile.TemporaryDirectory() as folder:
        for variant, peers in tables.items():
            for peer in peers:
                setting = f"{variant}: {peer.setting}" if variant else peer.setting
                print(f"{peer.name}: {setting}", file=sys.stderr, flush=True)
                row = {"peer": peer.name, "setting": setting, "kind": peer.kind}
                rows[variant].append(row)
                if peer.name == "Siconos" and not installed:
                    row["kind"] = "not installed"
                elif variant:
                    score_five(peer, row, variant, exact, folder)
                else:
                    score(peer, row, exact, folder)
    count = scoring.counted(
        scoring.told(exact["A"]["impacts"]), exact["A"]["contact_starts"][0]
    )
    table.write(rows, count, HERE.parent)


if __name__ == "__main__":
    main()
