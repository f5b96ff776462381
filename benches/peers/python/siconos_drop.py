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


machine = drop.machine(variant)


def with_angle(numbers, last):
    """What machine() has, with the angle as the last coordinate."""
    more = np.pad(numbers, (0, 1))
    more.flat[-1] = last
    return more


def build():
    rotor = sk.LagrangianLinearTIDS(
        with_angle(machine.start, 0.0),
        with_angle(0.0 * machine.start, drop.SPIN),
        with_angle(np.diag(machine.mass), drop.INERTIA),
    )
    rotor.setFExtPtr(with_angle(machine.force, 0.0))
    # The axis nutates at the spin of the start: what friction takes in the scored part is little.
    damping = machine.damping + drop.SPIN * machine.gyration
    if damping.any():
        rotor.setCPtr(with_angle(damping, 0.0))
    if machine.stiffness.any():
        rotor.setKPtr(with_angle(machine.stiffness, 0.0))
    law = sk.NewtonImpactFrictionNSL(restitution, 0.0, friction, 2)
    model = sk.NonSmoothDynamicalSystem(0.0, duration)
    model.insertDynamicalSystem(rotor)
    for name in machine.rings:
        relation = sk.LagrangianScleronomousR(f"gap:h_{name}", f"gap:G_{name}")
        model.link(sk.Interaction(law, relation), rotor)
    simulation = sk.TimeStepping(
        model, sk.TimeDiscretisation(0.0, step), sk.MoreauJeanOSI(0.5), sk.FrictionContact(2)
    )
    return simulation, rotor, model


def timed():
    """Processor time of the stepping alone, in Siconos' own loop."""
    simulation, _, model = build()
    simulation.initialize()
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
    q, v = rotor.q()[:-1], rotor.velocity()[:-1]
    ends = [it for f in machine.rings.values() for it in (machine.axis(q, f), machine.axis(v, f))]
    rows.append((simulation.nextTime(), *np.concatenate(ends)))
    simulation.nextStep()
drop.write_samples(path, rows)
taken = sorted(timed() for _ in range(repeats))[repeats // 2]
drop.answer(cpu_s=taken, steps=len(rows))
