"""Writes the true motion of a system, NAME_truth.csv, and tests it: truth.py PROGRAM SYSTEM [TEST...]

The truth is a run of noether's wide_gauss_8, whose state has 106 bits. Tests compare other runs with it, and add a line each to
the head of the table: `finer`, the same with steps of three quarters, and the energy error of states in doubles; `encke`, noether's
encke_gauss_8; `heyoka64` and `heyoka113`, heyoka, which shares no code with noether, in so many bits, the former over the span, the
latter over the time to the first look. Without a test the table is written.

The page leaves out what `finer` says cannot be seen: systems.resolution reads its line."""

import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from orbits import errors, ours, systems  # noqa: E402


def exact_run(program, system, method, step):
    """States of the looks, how many there are from one sample to the next, and the report."""
    divisions = system.divisions(step)
    spec = {"method": method, "hamiltonian": "kinetic_potential", "divisions": divisions}
    report, _, states = program.run(system, spec, systems.SAMPLES, True, 3600)
    return states, systems.looks_of(divisions), report


def states_error(system, states):
    """The energy error of states that were rounded to doubles: what no program that writes doubles can be seen to be below."""
    return errors.energy_error(system.G, numpy.array([body[0] for body in system.bodies]), states)


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
    states, looks, report = exact_run(program, system, "wide_gauss_8", system.truth_step)
    with open(systems.truth_table(system), "w", encoding="utf-8") as file:
        file.write(f"# {system.title}: days, then x, y, z [au] of each body about the first one.\n")
        file.write(f"# noether {program.version}, commit {program.commit}, wide_gauss_8, steps of {report['dt']!r} day; energy "
                   f"error {report['monitors']['energy']['worst']:.1e} in 113 bits.\n")
        for k, positions in enumerate(about_first(states[::looks])):
            file.write(",".join([str(system.sample * k)] + [repr(float(x)) for x in positions.ravel()]) + "\n")


def test(program, system, name):
    """The line for the head of the table."""
    truth = systems.read_truth(system)[1:]
    if name in ("finer", "encke"):
        method = "wide_gauss_8" if name == "finer" else "encke_gauss_8"
        states, looks, report = exact_run(program, system, method, system.truth_step * (0.75 if name == "finer" else 1))
        off = errors.position_error(states[looks::looks], truth)
        line = f"{method}, steps of {report['dt']!r} day: differs by {off:.1e} of a body's mean distance at most"
        return line + (f"; energy error of its states in doubles {states_error(system, states):.1e}." if name == "finer" else ".")
    import heyoka

    if name == "heyoka64":
        off = errors.position_error(heyoka_run(system, numpy.longdouble, system.sample, len(truth)), truth)
        return f"heyoka {heyoka.__version__} in 64 bits: differs by {off:.1e}."
    divisions = system.divisions(system.truth_step)
    spec = {"method": "wide_gauss_8", "hamiltonian": "kinetic_potential", "divisions": divisions}
    looks = systems.looks_of(divisions)
    states = program.run(system, spec, 1, True, 3600)[2]
    first = about_first(states[1:2])
    off = errors.position_error(heyoka_run(system, heyoka.real128, system.sample / looks, 1), first)
    return f"heyoka {heyoka.__version__} in 113 bits, over {system.sample / looks:g} days: differs by {off:.1e}."


def main(path, name, *tests):
    program, system = ours.Program(path), systems.SYSTEMS[name]
    if not tests:
        write(program, system)
    for one in tests:
        line = test(program, system, one)
        print(f"{name}: {line}", flush=True)
        table = systems.truth_table(system)
        lines = table.read_text(encoding="utf-8").splitlines(keepends=True)
        lines = [text for text in lines if text.split(":")[0] != "# " + line.split(":")[0]]
        lines.insert(sum(text.startswith("#") for text in lines), f"# {line}\n")
        table.write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
