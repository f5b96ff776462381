"""solve_ivp on the penalty contact of penalty.rs.

Arguments: variant, stiffness (N/m), damping (N s/m), method, rtol, duration (s), interval of the
samples (s), file for them, repeats."""

import math
import sys

import numpy as np
from scipy.integrate import solve_ivp

import drop

variant = sys.argv[1]
stiffness, damping = map(float, sys.argv[2:4])
method = sys.argv[4]
rtol, duration, every = map(float, sys.argv[5:8])
path, repeats = sys.argv[8], int(sys.argv[9])
friction = drop.VARIANTS[variant][0]


def rotor(_, s):
    x, y, u, v, spin = s.tolist()
    distance = math.hypot(x, y)
    if distance <= drop.CLEARANCE:
        return [u, v, 0.0, -drop.GRAVITY, 0.0]
    nx, ny = x / distance, y / distance
    force = stiffness * (distance - drop.CLEARANCE) + damping * (u * nx + v * ny)
    force = max(force, 0.0)
    slip = v * nx - u * ny + drop.RADIUS * spin
    rub = -friction * force * math.tanh(slip / drop.FRICTION_SPEED)
    ax = -(force * nx + rub * ny) / drop.MASS
    ay = -(force * ny - rub * nx) / drop.MASS - drop.GRAVITY
    return [u, v, ax, ay, rub * drop.RADIUS / drop.INERTIA]


def fall(**more):
    start = [0.0, 0.0, 0.0, 0.0, drop.SPIN]
    # No step may fly over a whole contact.
    return solve_ivp(
        rotor, (0.0, duration), start, method, rtol=rtol, atol=rtol * 1e-4, max_step=1e-3, **more
    )


times = np.arange(0.0, duration, every)
seen = fall(t_eval=times)
drop.write_samples(path, zip(seen.t, *seen.y[:4]))
steps = len(fall().t) - 1
drop.answer(cpu_s=drop.median_time(repeats, fall), steps=steps)
