"""Runs every peer over the same drop and writes RESULTS.md and results.json."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import scoring
import table
from peers import DURATION, HERE, PEERS, RUST, has_siconos

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


def score(peer, exact, folder):
    """A row of the results."""
    row = {"peer": peer.name, "setting": peer.setting, "kind": peer.kind}
    for variant in "ACE":
        file = Path(folder) / "samples"
        found = run(peer.command(variant, file, peer.repeats if variant == "A" else 1))
        samples = None
        if file.exists():
            samples = np.fromfile(file, "<f8").reshape(-1, 5)
            file.unlink()
        impacts = scoring.told(found["impacts"]) if peer.tells else scoring.seen(samples)
        if variant == "E":
            row["E_energy_drift"] = scoring.energy_drift(
                found["impacts"] if samples is None else samples
            )
            continue
        row[f"{variant}_errors"] = scoring.errors(impacts, exact[variant]["impacts"])
        if variant == "A":
            row["A_counted"] = scoring.counted(impacts, exact["A"]["contact_starts"][0])
            row["cpu_per_simulated"] = found["cpu_s"] / DURATION
            steps = found["steps"]
            row["ns_per_step"] = found["cpu_s"] / steps * 1e9 if steps else None
    return row


def main():
    exact = {variant: run([RUST / "ours", variant, "exact", DURATION]) for variant in "ACE"}
    rows = []
    installed = has_siconos()
    with tempfile.TemporaryDirectory() as folder:
        for peer in PEERS:
            print(f"{peer.name}: {peer.setting}", file=sys.stderr, flush=True)
            if peer.name == "Siconos" and not installed:
                row = {"peer": peer.name, "setting": peer.setting, "kind": "not installed"}
            else:
                row = score(peer, exact, folder)
            rows.append(row)
    count = scoring.counted(
        scoring.told(exact["A"]["impacts"]), exact["A"]["contact_starts"][0]
    )
    table.write(rows, count, HERE.parent)


if __name__ == "__main__":
    main()
