"""Runs every peer over the same drops and writes RESULTS.md and results.json."""

import json
import os
import statistics
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
ROUNDS = 7


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


def timed(row, taken, steps):
    row["cpu_per_simulated"] = taken / DURATION
    row["ns_per_step"] = taken / steps * 1e9 if steps else None


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
            timed(row, found["cpu_s"], found["steps"])


def score_five(peers, rows, variant, exact, folder):
    """The figures of a table of five impacts. Each time is the median over rounds through the table,
    so that a slow spell of the machine is not one row's. Events are not followed beyond impact 5."""
    taken = [([], []) for _ in rows]
    for turn in range(ROUNDS):
        for peer, row, (to_five, whole) in zip(peers, rows, taken):
            if row["kind"] == "not installed":
                continue
            print(f"{turn + 1}/{ROUNDS} {row['setting']}", file=sys.stderr, flush=True)
            found = course(peer, variant, folder, UNTIL_FIVE[variant], 5 * peer.repeats)
            to_five.append(found[0]["cpu_s"])
            if peer.kind != "events":
                found = course(peer, variant, folder, DURATION, peer.repeats)
                whole.append(found[0]["cpu_s"])
            row["errors"] = scoring.errors(found[2], exact[variant]["impacts"], 5)
            row["cpu_to_five"] = statistics.median(to_five)
            if whole:
                timed(row, statistics.median(whole), found[0]["steps"])


def main():
    variants = ["A", "C", "E", *FIVE]
    exact = {variant: run([RUST / "ours", variant, "exact", DURATION]) for variant in variants}
    installed = has_siconos()

    def rows(peers, prefix=""):
        there = lambda peer: installed or peer.name != "Siconos"
        kind = lambda peer: peer.kind if there(peer) else "not installed"
        return [
            {"peer": peer.name, "setting": prefix + peer.setting, "kind": kind(peer)}
            for peer in peers
        ]

    drops = rows(PEERS)
    five = {variant: rows(peers, f"{variant}: ") for variant, peers in FIVE.items()}
    with tempfile.TemporaryDirectory() as folder:
        for peer, row in zip(PEERS, drops):
            print(f"{peer.name}: {peer.setting}", file=sys.stderr, flush=True)
            if row["kind"] != "not installed":
                score(peer, row, exact, folder)
        for variant, peers in FIVE.items():
            score_five(peers, five[variant], variant, exact, folder)
    count = scoring.counted(
        scoring.told(exact["A"]["impacts"]), exact["A"]["contact_starts"][0]
    )
    table.write(drops, five, count, HERE.parent)


if __name__ == "__main__":
    main()
