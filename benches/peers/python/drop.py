"""The drop that every peer computes, and what their programs have in common. SI."""

import json
import math
import statistics
import struct
import time
from dataclasses import dataclass

import numpy as np

MASS, RADIUS, CLEARANCE, GRAVITY, SPIN = 3.42, 0.024, 3e-4, 9.81, 3141.6
INERTIA = 0.5 * MASS * RADIUS**2
# Friction and restitution.
VARIANTS = {"A": (0.1, 0.8), "C": (0.05, 0.3), "E": (0.0, 1.0), "S": (0.1, 0.8), "T": (0.1, 0.8)}
# The ring of S on its mount; what tilts in T, and its start.
RING_MASS, RING_STIFFNESS, RING_DAMPING = 0.5, 2.6e6, 320.0
TRANSVERSE, TILT = 0.03078, 6e-4
# Slip at which a regularised friction has reached 76 % of its value, m/s.
FRICTION_SPEED = 0.05
# Bounces that leave the wall more slowly are not asked for, m/s.
CUT_OFF = 1e-4


@dataclass
class Machine:
    """M q'' + (C + spin G) q' + K q = f. q: the rotor's centre, and two more numbers of the same
    directions: the ring's place or the axis' slope. M: its diagonal."""

    mass: np.ndarray
    damping: np.ndarray
    gyration: np.ndarray
    stiffness: np.ndarray
    force: np.ndarray
    start: np.ndarray
    # By name: how far the two more numbers move the axis in the ring.
    rings: dict
    tilts: bool

    def axis(self, q, factor):
        """The rotor's axis in a ring, from the bearing's centre; of q or its rate."""
        return q[:2] + factor * q[2:] if self.tilts else q[:2]


def machine(variant):
    """A variant of the drop for those who take any machine."""
    more = {"S": [RING_MASS] * 2, "T": [TRANSVERSE] * 2}.get(variant, [])
    mass = np.array([MASS, MASS, *more])
    size = len(mass)
    damping, gyration, stiffness = (np.zeros((size, size)) for _ in range(3))
    force, start = np.zeros(size), np.zeros(size)
    force[1] = -MASS * GRAVITY
    rings = {"fixed": 0.0}
    if variant == "S":
        damping[[2, 3], [2, 3]] = RING_DAMPING
        stiffness[[2, 3], [2, 3]] = RING_STIFFNESS
        rings = {"sprung": -1.0}
    if variant == "T":
        gyration[2, 3], gyration[3, 2] = INERTIA, -INERTIA
        start[3] = TILT
        rings = {"left": -0.12, "right": 0.12}
    return Machine(mass, damping, gyration, stiffness, force, start, rings, variant == "T")


def penalty(contact_time, restitution):
    """Stiffness (N/m) and damping (N s/m) of a Kelvin-Voigt contact without tension that takes
    `contact_time` and gives this restitution: it ends where its force is 0, not where it is left."""
    low, high = 0.0, 0.9
    if restitution < 1.0:
        for _ in range(60):
            ratio = 0.5 * (low + high)
            phase = math.pi - 2.0 * math.asin(ratio)
            if math.exp(-ratio * phase / math.sqrt(1.0 - ratio**2)) > restitution:
                low = ratio
            else:
                high = ratio
    ratio = low
    phase = math.pi - 2.0 * math.asin(ratio)
    frequency = phase / (contact_time * math.sqrt(1.0 - ratio**2))
    return MASS * frequency**2, 2.0 * ratio * frequency * MASS


def median_time(repeats, call):
    """Median of the processor times, s, after one call that is not counted."""
    call()
    times = []
    for _ in range(repeats):
        begun = time.process_time()
        call()
        times.append(time.process_time() - begun)
    return statistics.median(times)


def write_samples(path, rows):
    """Rows of t and for each ring x, y, vx, vy of the axis there as little-endian doubles."""
    with open(path, "wb") as out:
        for row in rows:
            out.write(struct.pack(f"<{len(row)}d", *row))


def answer(**fields):
    """What a peer's program prints: one line of JSON."""
    print(json.dumps(fields))
