"""Moreau-Jean time-stepping in Siconos, with a compiled gap function and its own loop.

Arguments: variant, step (s), duration (s), file for the samples, repeats. Runs where gap.so is."""

import sys
import time

import numpy as np
import siconos.kernel as sk

import drop

variant = sys.argv[1]
step, duration = map(float, sys.argv[2:4])
path, repeats = sys.argv[4], int(sys.argv[5])
friction, restitution = drop.VARIANTS[variant]


def build():
    rotor = sk.LagrangianLinearTIDS(
        [0.0, 0.0, 0.0], [0.0, 0.0, drop.SPIN], np.diag([drop.MASS, drop.MASS, drop.INERTIA])
    )
    rotor.setFExtPtr(np.array([0.0, -drop.MASS * drop.GRAVITY, 0.0]))
    law = sk.NewtonImpactFrictionNSL(restitution, 0.0, friction, 2)
    wall = sk.Interaction(law, sk.LagrangianScleronomousR("gap:h", "gap:G"))
    model = sk.NonSmoothDynamicalSystem(0.0, duration)
    model.insertDynamicalSystem(rotor)
    model.link(wall, rotor)
    simulation = sk.TimeStepping(
        model, sk.TimeDiscretisation(0.0, step), sk.MoreauJeanOSI(0.5), sk.FrictionContact(2)
    )
    return simulation, rotor, model


def timed():
    """Processor time of the stepping alone, in Siconos' own loop."""
    simulation, _, model = build()
    begun = time.process_time()
    simulation.run()
    taken = time.process_time() - begun
    # Kept until here: the simulation only borrows it.
    del model
    return taken


simulation, rotor, model = build()
rows = []
while simulation.hasNextEvent():
    simulation.computeOneStep()
    q, v = rotor.q(), rotor.velocity()
    rows.append((simulation.nextTime(), q[0], q[1], v[0], v[1]))
    simulation.nextStep()
drop.write_samples(path, rows)
taken = sorted(timed() for _ in range(repeats))[repeats // 2]
drop.answer(cpu_s=taken, steps=len(rows))
