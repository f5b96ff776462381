"""solve_ivp with events: each flight to its contact, the impact law between them; in the plane then
sliding. A state is what machine() has for q and its rate, without the angle.

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


machine = drop.machine(variant)
MASS, SIZE = machine.mass, len(machine.mass)
# Of each pair of coordinates.
MASSES = MASS[::2].tolist()


def flight(spin):
    """Rate of the state at this spin; in the plane without matrices, which would cost time there."""
    if SIZE == 2:
        return lambda _, s: [s[2], s[3], 0.0, -drop.GRAVITY]
    damping = machine.damping + spin * machine.gyration
    spring, damper = (-matrix / MASS[:, None] for matrix in (machine.stiffness, damping))
    rates = np.block([[np.zeros((SIZE, SIZE)), np.eye(SIZE)], [spring, damper]])
    constant = np.concatenate([np.zeros(SIZE), machine.force / MASS])
    return lambda _, s: rates @ s + constant


def wall(factor):
    """The event of reaching a ring."""

    def in_plane(_, s):
        return math.hypot(s[0], s[1]) - drop.CLEARANCE

    def beside(_, s):
        return math.hypot(s[0] + factor * s[2], s[1] + factor * s[3]) - drop.CLEARANCE

    gap = beside if factor else in_plane

    gap.terminal = True
    gap.direction = 1.0
    return gap


FACTORS = list(machine.rings.values())
GAPS = [wall(factor) for factor in FACTORS]


def sliding(_, s):
    angle, rate, spin = s
    slip = rate * drop.CLEARANCE + drop.RADIUS * spin
    press = rate * rate + drop.GRAVITY / drop.CLEARANCE * math.cos(angle)
    rub = -math.copysign(friction, slip) * press
    pull = drop.GRAVITY / drop.CLEARANCE * math.sin(angle)
    return [rate, rub - pull, rub * drop.CLEARANCE / drop.RADIUS / BETA]


def collide(s, spin, factor):
    """State and spin after an impact, the speed into the wall before it and the one along it after."""
    s = s.tolist()
    shares = (1.0, factor)[: SIZE // 2]
    axis = lambda k: sum(b * s[k + 2 * i] for i, b in enumerate(shares))
    x, y, u, v = map(axis, (0, 1, SIZE, SIZE + 1))
    distance = math.hypot(x, y)
    nx, ny = x / distance, y / distance
    ease = sum(b * b / m for b, m in zip(shares, MASSES))
    ease_along = ease + drop.RADIUS**2 / drop.INERTIA
    into, along = u * nx + v * ny, v * nx - u * ny
    push = (1.0 + restitution) * into / ease
    rub = -(along + drop.RADIUS * spin) / ease_along
    rub = min(max(rub, -friction * push), friction * push)
    for i, (b, m) in enumerate(zip(shares, MASSES)):
        s[SIZE + 2 * i] -= b / m * (push * nx + rub * ny)
        s[SIZE + 2 * i + 1] -= b / m * (push * ny - rub * nx)
    s[0] += drop.CLEARANCE * nx - x
    s[1] += drop.CLEARANCE * ny - y
    return np.array(s), spin + drop.RADIUS * rub / drop.INERTIA, into, along + rub * ease


def quarter_hop(s, into, along):
    """Of a rebound whose wall pulls it back as along a straight one; inf where it does not."""
    height = s[1] / drop.CLEARANCE
    back = along * along / drop.CLEARANCE - drop.GRAVITY * height
    return 0.5 * restitution * into / back if back > 0.0 else math.inf


def fall():
    """Impacts until the bounces are slow; sliding from there on."""
    time, spin, impacts = 0.0, drop.SPIN, []
    s = np.concatenate([machine.start, np.zeros(SIZE)])
    longest = max_step
    while time < duration:
        found = solve_ivp(
            flight(spin),
            (time, duration),
            s,
            method,
            events=GAPS,
            rtol=rtol,
            atol=rtol * 1e-4,
            max_step=longest,
        )
        if found.status != 1:
            break
        time = found.t[-1]
        factor = next(f for f, times in zip(FACTORS, found.t_events) if len(times))
        s, spin, into, along = collide(found.y[:, -1], spin, factor)
        place, velocity = machine.axis(s[:SIZE], factor), machine.axis(s[SIZE:], factor)
        impacts.append([time, *place, *velocity, into])
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
