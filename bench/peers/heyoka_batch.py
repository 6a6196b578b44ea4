"""Several systems at once by heyoka: heyoka_batch.py. Greets with its version, then answers each case, one a line, with the
processor seconds of the run and the states at its end, system by system as they were given. Ends at once where the program is absent; peers are never
needed: the benchmark continues without.

A case: {"G": ..., "masses": [...], "states": of each system [x, y, z, vx, vy, vz] of each body, in one list, "until": ...,
"tolerance": ...}. All systems have the same masses. An integrator is compiled once, in time that does not count."""

import json
import sys
import time


def integrator_of(case, heyoka, numpy, compiled):
    states = numpy.array(case["states"]).T.copy()  # a variable is a row, a system a column
    key = json.dumps([case["G"], case["masses"], case["tolerance"], states.shape[1]])
    if key not in compiled:
        equations = heyoka.model.nbody(len(case["masses"]), masses=case["masses"], Gconst=case["G"])
        compiled[key] = heyoka.taylor_adaptive_batch(equations, states, tol=case["tolerance"])
    own = compiled[key]
    own.state[:] = states
    own.set_time(0.0)
    return own


def answer(case, heyoka, numpy, compiled):
    own = integrator_of(case, heyoka, numpy, compiled)
    begin = time.process_time()
    own.propagate_until([case["until"]] * own.state.shape[1])
    seconds = time.process_time() - begin
    return " ".join(repr(float(number)) for number in [seconds, *own.state.T.ravel()])


def main():
    try:
        import heyoka
        import numpy
    except ImportError as error:
        print(f"heyoka: {error}", file=sys.stderr)
        return
    print(heyoka.__version__, flush=True)
    compiled = {}
    for line in sys.stdin:
        print(answer(json.loads(line), heyoka, numpy, compiled), flush=True)


if __name__ == "__main__":
    main()
