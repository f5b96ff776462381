"""The drop that every peer computes, and what their programs have in common. SI."""

import json
import math
import statistics
import struct
import time

MASS, RADIUS, CLEARANCE, GRAVITY, SPIN = 3.42, 0.024, 3e-4, 9.81, 3141.6
INERTIA = 0.5 * MASS * RADIUS**2
# Friction and restitution.
VARIANTS = {"A": (0.1, 0.8), "C": (0.05, 0.3), "E": (0.0, 1.0)}
# Slip at which a regularised friction has reached 76 % of its value, m/s.
FRICTION_SPEED = 0.05
# Bounces that leave the wall more slowly are not asked for, m/s.
CUT_OFF = 1e-4


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
    """Rows of t, x, y, vx, vy as little-endian doubles."""
    with open(path, "wb") as out:
        for row in rows:
            out.write(struct.pack("<5d", *row))


def answer(**fields):
    """What a peer's program prints: one line of JSON."""
    print(json.dumps(fields))
