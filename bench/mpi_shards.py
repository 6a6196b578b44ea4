"""Two shards of an ensemble under mpirun beside one process: mpi_shards.py NOETHER [ROUNDS].

Each round makes the ensemble once by one process with one thread, and once by two processes of mpirun with one thread each, for
every mpirun that is installed (Open MPI's and MPICH's), in turn. Prints medians of wall times, their ratio, and the processor
seconds of both: where other programs use the processors, wall times are theirs too, and only processor times tell what two
shards cost.
"""

import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

SCENE = pathlib.Path(__file__).resolve().parents[1] / "examples" / "trojans_and_plutinos" / "scene.toml"
VARY = ["--vary", "particles.body.plutino.a=38.8:40.2:16", "--vary", "particles.body.plutino.e=0.02:0.35:16"]
# As any user, on as many processors as there are.
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1"}


def seconds(command, folder):
    """By the clock, and of the processors."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.perf_counter()
    subprocess.run(command, cwd=folder, env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    noether, rounds = os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 5
    launchers = [one for one in ("mpirun.openmpi", "mpirun.mpich") if shutil.which(one)]
    if not launchers:
        sys.exit("neither mpirun.openmpi nor mpirun.mpich is installed")
    for launcher in launchers:
        times = {"one": [], "two": []}
        for _ in range(rounds):
            for name, start in (("one", []), ("two", [launcher, "-n", "2"])):
                with tempfile.TemporaryDirectory() as folder:
                    command = [*start, noether, "ensemble", str(SCENE), *VARY, "--out", "map.h5", "--threads", "1"]
                    times[name].append(seconds(command, folder))
        one, two = (([statistics.median(column) for column in zip(*times[name])]) for name in ("one", "two"))
        ratio = statistics.median(a[0] / b[0] for a, b in zip(times["one"], times["two"]))
        print(f"{launcher}: one process {one[0]:.2f} s ({one[1]:.2f} s of processor), two shards {two[0]:.2f} s "
              f"({two[1]:.2f} s); {ratio:.2f} times as fast, median of {rounds} rounds")


if __name__ == "__main__":
    main()
