"""pymunk on an equivalent smaller disk in a ring of segments: the slip of the contact is the same,
and the ring's corners are flatter. Clearance scaled to 300 length units.

Arguments: variant, step (s), segments, duration (s), file for the samples, repeats."""

import math
import sys

import pymunk

import drop

variant = sys.argv[1]
step, segments = float(sys.argv[2]), int(sys.argv[3])
duration, path, repeats = float(sys.argv[4]), sys.argv[5], int(sys.argv[6])
friction, restitution = drop.VARIANTS[variant]
UNIT = 1e-6
DISK = 1e-4
WALL = 1e-4


def build():
    space = pymunk.Space()
    space.gravity = (0.0, -drop.GRAVITY / UNIT)
    space.collision_slop = 0.0
    shrunk = DISK / drop.RADIUS
    rotor = pymunk.Body(drop.MASS, drop.INERTIA * (shrunk / UNIT) ** 2)
    rotor.angular_velocity = drop.SPIN / shrunk
    disk = pymunk.Circle(rotor, DISK / UNIT)
    ring = (DISK + drop.CLEARANCE + WALL) / UNIT / math.cos(math.pi / segments)
    # A corner is never at the bottom.
    turn = lambda k: 2.0 * math.pi * (k + 0.5) / segments - math.pi / 2.0
    corners = [(ring * math.cos(turn(k)), ring * math.sin(turn(k))) for k in range(segments + 1)]
    wall = [
        pymunk.Segment(space.static_body, a, b, WALL / UNIT) for a, b in zip(corners, corners[1:])
    ]
    for shape in [disk, *wall]:
        shape.elasticity, shape.friction = math.sqrt(restitution), math.sqrt(friction)
    space.add(rotor, disk, *wall)
    return space, rotor


steps = round(duration / step)
space, rotor = build()
rows = []
for k in range(1, steps + 1):
    space.step(step)
    numbers = (*rotor.position, *rotor.velocity)
    rows.append((k * step, *(number * UNIT for number in numbers)))
drop.write_samples(path, rows)


def fall(space):
    go = space.step
    for _ in range(steps):
        go(step)


spaces = iter([build() for _ in range(repeats + 1)])
drop.answer(cpu_s=drop.median_time(repeats, lambda: fall(next(spaces)[0])), steps=steps)
