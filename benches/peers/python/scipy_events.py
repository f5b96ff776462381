"""solve_ivp with events: each flight to its contact, the impact law between them, then sliding.

Arguments: variant, method, rtol, max_step (s, inf, or hop: a quarter of how long the next hop will
take about), duration (s), repeats."""

import math
import sys

import numpy as np
from scipy.integrate import solve_ivp

import drop

variant, method = sys.argv[1:3]
rtol, duration = float(sys.argv[3]), float(sys.argv[5])
max_step = math.inf if sys.argv[4] == "hop" else float(sys.argv[4])
by_hops = sys.argv[4] == "hop"
repeats = int(sys.argv[6])
friction, restitution = drop.VARIANTS[variant]
BETA = 0.5


def flight(_, s):
    return [s[2], s[3], 0.0, -drop.GRAVITY]


def gap(_, s):
    return math.hypot(s[0], s[1]) - drop.CLEARANCE


gap.terminal = True
gap.direction = 1.0


def sliding(_, s):
    angle, rate, spin = s
    slip = rate * drop.CLEARANCE + drop.RADIUS * spin
    press = rate * rate + drop.GRAVITY / drop.CLEARANCE * math.cos(angle)
    rub = -math.copysign(friction, slip) * press
    pull = drop.GRAVITY / drop.CLEARANCE * math.sin(angle)
    return [rate, rub - pull, rub * drop.CLEARANCE / drop.RADIUS / BETA]


def collide(s, spin):
    """State and spin after an impact, the speed into the wall before it and the one along it after."""
    nx, ny = np.array(s[:2]) / math.hypot(s[0], s[1])
    into, along = s[2] * nx + s[3] * ny, s[3] * nx - s[2] * ny
    limit = friction * (1.0 + restitution) * into
    rub = -(along + drop.RADIUS * spin) * BETA / (1.0 + BETA)
    rub = min(max(rub, -limit), limit)
    along += rub
    spin += rub / BETA / drop.RADIUS
    out = -restitution * into
    x, y = nx * drop.CLEARANCE, ny * drop.CLEARANCE
    return [x, y, out * nx - along * ny, out * ny + along * nx], spin, into, along


def quarter_hop(s, into, along):
    """Of a rebound whose wall pulls it back as along a straight one; inf where it does not."""
    height = s[1] / drop.CLEARANCE
    back = along * along / drop.CLEARANCE - drop.GRAVITY * height
    return 0.5 * restitution * into / back if back > 0.0 else math.inf


def fall():
    """Impacts until the bounces are slow; sliding from there on."""
    time, s, spin, impacts = 0.0, [0.0, 0.0, 0.0, 0.0], drop.SPIN, []
    longest = max_step
    while time < duration:
        found = solve_ivp(
            flight,
            (time, duration),
            s,
            method,
            events=gap,
            rtol=rtol,
            atol=rtol * 1e-4,
            max_step=longest,
        )
        if found.status != 1:
            break
        time = found.t[-1]
        s, spin, into, along = collide(found.y[:, -1], spin)
        impacts.append([time, *s, into])
        if by_hops:
            longest = quarter_hop(s, into, along)
        if restitution * into < drop.CUT_OFF:
            start = [math.atan2(s[0], -s[1]), along / drop.CLEARANCE, spin]
            solve_ivp(
                sliding, (time, duration), start, method, rtol=rtol, atol=rtol, max_step=max_step
            )
            break
    return impacts


impacts = fall()
taken = drop.median_time(repeats, fall)
drop.answer(cpu_s=taken, steps=None, impacts=impacts)
