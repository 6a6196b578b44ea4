"""Writes the true motion of a system, NAME_truth.csv: truth.py PROGRAM SYSTEM...

The truth is a run of noether's wide_gauss_8, whose state has 106 bits. Three runs test it: the same with steps of three quarters,
and heyoka, which shares no code with noether, in 113 bits over the time to the first look and in 64 bits to the end. The head of the
table has the differences."""

import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from orbits import errors, ours, systems  # noqa: E402


def wide_run(program, system, step):
    divisions = system.divisions(step)
    method = {"method": "wide_gauss_8", "hamiltonian": "kinetic_potential", "divisions": divisions}
    report, _, states = program.run(system, method, systems.SAMPLES, True, 3600)
    return states, systems.looks_of(divisions), report["monitors"]["energy"]["worst"], system.sample / divisions


def heyoka_run(system, real, interval, count):
    """Positions and velocities at so many times after the start."""
    import heyoka

    bodies = system.bodies
    equations = heyoka.model.nbody(len(bodies), masses=[real(body[0]) for body in bodies], Gconst=real(system.G))
    start = numpy.array([real(value) for body in bodies for value in body[1:]], dtype=real)
    run = heyoka.taylor_adaptive(equations, start, fp_type=real, compact_mode=True, high_accuracy=True)
    states = []
    for k in range(1, count + 1):
        run.propagate_until(real(interval) * real(k))
        states.append([float(value) for value in run.state])
    return numpy.array(states).reshape(count, len(bodies), 6)


def about_first(states):
    return states[:, :, :3].astype(numpy.longdouble) - states[:, :1, :3]


def write(program, system):
    states, looks, energy, step = wide_run(program, system, system.truth_step)
    finer, finer_looks, _, finer_step = wide_run(program, system, system.truth_step * 0.75)
    truth = about_first(states[::looks])
    off = errors.position_error(finer[finer_looks::finer_looks], truth[1:])
    lines = [
        f"{system.title}: days, then x, y, z [au] of each body about the first one.",
        f"noether {program.version}, commit {program.commit}, wide_gauss_8, steps of {step!r} day; energy error {energy:.1e} "
        "in 113 bits.",
        f"Steps of {finer_step!r} day: differs by {off:.1e} of a body's mean distance.",
    ]
    try:
        import heyoka

        first = system.sample / looks
        for real, bits, interval, truths in ((heyoka.real128, 113, first, about_first(states[1:2])),
                                             (numpy.longdouble, 64, system.sample, truth[1:])):
            off = errors.position_error(heyoka_run(system, real, interval, len(truths)), truths)
            lines.append(f"heyoka {heyoka.__version__} in {bits} bits, {interval * len(truths):g} days: differs by {off:.1e}.")
    except ImportError:
        lines.append("Not compared with heyoka, which was not installed.")
    with open(systems.HERE / f"{system.name}_truth.csv", "w", encoding="utf-8") as file:
        file.write("".join(f"# {line}\n" for line in lines))
        for k, positions in enumerate(truth):
            file.write(",".join([str(system.sample * k)] + [repr(float(x)) for x in positions.ravel()]) + "\n")


if __name__ == "__main__":
    for name in sys.argv[2:]:
        write(ours.Program(sys.argv[1]), systems.SYSTEMS[name])
