"""Other libraries in the same process, imported before and after: HDF5 a second time, OpenMP a second time."""

import subprocess
import sys

import pytest

CODE = """
import sys
{first}
import noether as nt
{last}
sys.stdout.write(nt.run("lj_melt", set={{"integrator.steps": 10}}, out="{out}").digest)
"""
LEARN = ("import numpy; from sklearn.cluster import KMeans; "
         "KMeans(2, n_init=1).fit(numpy.random.default_rng(1).normal(size=(5000, 4)))")
FILE = "import h5py; f = h5py.File('open.h5', 'w'); f['x'] = [1.0]"


def digest(first, last, out):
    done = subprocess.run([sys.executable, "-c", CODE.format(first=first, last=last, out=out)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("module, code", [("h5py", FILE), ("sklearn", LEARN)])
def test_either_order_gives_the_same_bits(module, code):
    pytest.importorskip(module)
    alone = digest("", "", "alone")
    assert len(alone) == 71
    assert digest(code, "", "after") == alone
    assert digest("", code, "before") == alone


def test_threads_of_openmp_do_not_spin_unless_asked():
    code = "import os{}; import noether; print(os.environ['OMP_WAIT_POLICY'])"
    assert subprocess.run([sys.executable, "-c", code.format("")], capture_output=True, text=True).stdout == "passive\n"
    asked = code.format("; os.environ['OMP_WAIT_POLICY'] = 'active'")
    assert subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True).stdout == "active\n"
