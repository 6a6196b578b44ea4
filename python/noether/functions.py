"""Forces of one's own: the C function that a compiled one has to be, and what a force costs."""


def force_signature():
    """The signature of a compiled force, for numba's `@cfunc`.

        float64 f(int64 n, int64 stride, float64 t, float64* x, float64* v, float64* m, float64* a, void* user)

    x, v and a point to 3 rows of `stride` numbers, of which the first n are those of the particles; m points to n masses;
    `user` is null. The function adds accelerations to a, which is 0 before, and returns the potential energy.

    >>> @numba.cfunc(nt.force_signature())
    ... def spring(n, stride, t, x_, v_, m_, a_, user):
    ...     x, a, m = numba.carray(x_, (3, stride)), numba.carray(a_, (3, stride)), numba.carray(m_, n)
    ...     energy = 0.0
    ...     for i in range(n):
    ...         a[0, i] -= x[0, i] / m[i]
    ...         energy += 0.5 * x[0, i] ** 2
    ...     return energy

    @raise ImportError without numba
    """
    try:
        from numba import types
    except ImportError:
        raise ImportError("force_signature is for numba's cfunc: pip install numba") from None
    numbers = types.CPointer(types.float64)
    return types.float64(types.int64, types.int64, types.float64, numbers, numbers, numbers, numbers, types.voidptr)


def force_type():
    """The same for ctypes: a type whose objects `add_force` takes, such as functions of a shared library.

    >>> pull = nt.functions.force_type()(("pull", ctypes.CDLL("./pull.so")))
    """
    import ctypes

    numbers = ctypes.POINTER(ctypes.c_double)
    return ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_int64, ctypes.c_int64, ctypes.c_double, numbers, numbers, numbers,
                            numbers, ctypes.c_void_p)


def time_per_step(force, particles, *, seconds=0.1, **claims):
    """Seconds that one step of velocity Verlet takes with this force, which is called once in each step.

    It runs a simulation of the particles with this force alone, with steps so short that nothing moves, for about so many
    `seconds`, three times; the fastest counts. Compilation of the force is not in it. The engine's own part of a step is: 50 ns
    for two bodies.

    force : what `Simulation.add_force` takes; `claims` are its keywords
    particles : Particles
    """
    from .simulation import Simulation

    sim = Simulation(particles, method="verlet", step=1e-12)
    sim.add_force(force, **claims)
    sim.run(1)
    steps, spent = 1, 0.0
    while spent < seconds:
        spent = _timed(sim, steps)
        steps = max(2 * steps, int(min(1000 * steps, 1.1 * seconds / max(spent, 1e-9) * steps))) if spent < seconds else steps
    return min(spent, _timed(sim, steps), _timed(sim, steps)) / steps


def _timed(sim, steps):
    import time

    begin = time.perf_counter()
    outcome = sim.run(steps)
    if not outcome.ok:
        raise RuntimeError(f"the force cannot be timed: {outcome.text}")
    return time.perf_counter() - begin
