"""How far a peer's drop is from the exact one."""

import math
from dataclasses import dataclass

import numpy as np

import drop


@dataclass
class Impact:
    """An impact; SI."""

    time: float
    after: tuple
    # Speed away from the wall after it.
    rebound: float


def rebound(x, y, u, v):
    return -(u * x + v * y) / math.hypot(x, y)


def told(rows):
    """Impacts as a program tells them: time, position, velocity after, speed into the wall."""
    return [Impact(t, (u, v), rebound(x, y, u, v)) for t, x, y, u, v, _ in rows]


def seen(samples):
    """Impacts as equidistant samples show them: steps in which the velocity of the rotor's middle
    changes by what is not gravity; at the mean time of that change, in the ring with the largest."""
    t, rings = samples[:, 0], samples[:, 1:].reshape(len(samples), -1, 4)
    dt = t[1] - t[0]
    u, v = rings.mean(axis=1)[:, 2:].T
    jump = np.hypot(np.diff(u), np.diff(v) + drop.GRAVITY * dt)
    hit = np.concatenate(([False], jump > 0.5 * drop.GRAVITY * dt, [False]))
    begins, ends = np.flatnonzero(np.diff(hit.astype(int))).reshape(-1, 2).T
    impacts = []
    for begin, end in zip(begins, ends):
        weight = jump[begin:end]
        time = float(np.sum(weight * (t[begin:end] + 0.5 * dt)) / np.sum(weight))
        changes = np.linalg.norm((rings[end] - rings[begin])[:, 2:], axis=1)
        after = [float(number) for number in rings[end][np.argmax(changes)]]
        impacts.append(Impact(time, tuple(after[2:]), rebound(*after)))
    return impacts


def counted(impacts, until):
    """Impacts before `until` that leave the wall faster than the cut-off."""
    return sum(1 for impact in impacts if impact.time < until and impact.rebound >= drop.CUT_OFF)


def errors(impacts, exact, count):
    """Of the first `count`: time, s, and velocity after over the speed into the wall before; None for
    an impact that is not there or is nearer to another one."""
    times = [row[0] for row in exact[: count + 2]]
    scores = []
    for k in range(count):
        impact = impacts[k] if k < len(impacts) else None
        if impact is None or min(times, key=lambda t: abs(t - impact.time)) != times[k]:
            scores.append(None)
            continue
        t, _, _, u, v, into = exact[k]
        off = math.hypot(impact.after[0] - u, impact.after[1] - v) / into
        scores.append((abs(impact.time - t), off))
    return scores


def energy_drift(rows):
    """Largest change of translation and height over m g rho0, where no spring is pressed; rows of t,
    x, y, vx, vy and more."""
    _, x, y, u, v = np.asarray(rows)[:, :5].T
    inside = np.hypot(x, y) <= drop.CLEARANCE * (1.0 + 1e-6)
    energy = 0.5 * (u**2 + v**2) + drop.GRAVITY * y
    return float(np.max(np.abs(energy[inside])) / (drop.GRAVITY * drop.CLEARANCE))
