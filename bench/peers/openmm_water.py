"""OpenMM on the water of bench/water.cpp: rigid SPC/E by SETTLE, 2 fs, on its CPU platform, whose forces are in single precision,
or its Reference platform, in double.

    openmm_water.py CPU|Reference pme|ewald|reaction_field START [THREADS [TOLERANCE]]

TOLERANCE is OpenMM's of errors of Ewald's sums, 5e-4 unless it is given. Greets with its version, then answers as
`water_start.serve` says: processor seconds of one thread, wall seconds of more. Ends at once without OpenMM, and says why."""

import sys
import time

sys.dont_write_bytecode = True

import water_start  # noqa: E402


def system_of(mm, start, charges, tolerance):
    system = mm.System()
    system.setDefaultPeriodicBoxVectors(*(mm.Vec3(*(start["edge"] if k == j else 0 for k in range(3))) for j in range(3)))
    force = mm.NonbondedForce()
    force.setNonbondedMethod({"pme": force.PME, "ewald": force.Ewald, "reaction_field": force.CutoffPeriodic}[charges])
    force.setCutoffDistance(start["cutoff"])
    force.setReactionFieldDielectric(1e9)
    force.setUseDispersionCorrection(False)
    force.setEwaldErrorTolerance(tolerance)
    for i in range(len(start["x"])):
        oxygen = i % 3 == 0
        system.addParticle(water_start.OXYGEN if oxygen else water_start.HYDROGEN)
        force.addParticle((-2 if oxygen else 1) * start["charge"], start["sigma"], start["epsilon"] if oxygen else 0)
    for o in range(0, len(start["x"]), 3):
        for i, j, length in ((o, o + 1, water_start.BOND), (o, o + 2, water_start.BOND), (o + 1, o + 2, water_start.ACROSS)):
            system.addConstraint(i, j, length)
            force.addException(i, j, 0, 1, 0)
    system.addForce(force)
    return system


def context_of(mm, start, charges, platform, threads, tolerance):
    integrator = mm.VerletIntegrator(0.002)
    integrator.setConstraintTolerance(1e-6)
    context = mm.Context(system_of(mm, start, charges, tolerance), integrator, mm.Platform.getPlatformByName(platform),
                         {"Threads": threads} if platform == "CPU" else {})
    context.setPositions(start["x"])
    context.setVelocities(start["v"])
    return context


def forces_in(mm, context):
    """[[fx, fy, fz], ...] in kJ/mol/nm; constraints have no part of them."""
    unit = mm.unit.kilojoule_per_mole / mm.unit.nanometer
    return [f.value_in_unit(unit) for f in context.getState(getForces=True).getForces()]


def main(platform, charges, start, threads="1", tolerance="5e-4"):
    try:
        import openmm as mm
    except (ImportError, OSError) as error:
        print(f"openmm: {error}", file=sys.stderr)
        return
    context = context_of(mm, water_start.read(start), charges, platform, threads, float(tolerance))
    forces = forces_in(mm, context)  # of the start
    clock = time.process_time if threads == "1" else time.perf_counter

    def seconds(steps):
        begin = clock()
        context.getIntegrator().step(steps)
        context.getState()
        return clock() - begin

    water_start.serve(mm.version.version, seconds, lambda exact: water_start.error(exact, lambda i: forces[i]))


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5, 6):
        sys.exit(__doc__)
    main(*sys.argv[1:])
