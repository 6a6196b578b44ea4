#!/usr/bin/env bash
# Runs tests/python by pytest, with the Python package of a build folder.
#     run.sh BUILD_FOLDER [PYTHON]      without a Python the package was not built
# NOETHER_NIGHTLY=1 in the environment adds all notebooks, and the peers' scripts beside ours.
set -eu
build=$1 python=${2:-}
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if [ -z "$python" ]; then
  echo "skipped: the Python package is not built; ./noether test says why, and pip install . makes it"
  exit 77
fi
for module in numpy h5py pytest; do
  "$python" -c "import $module" 2>/dev/null || {
    echo "skipped: $python has no $module"
    exit 77
  }
done
export PYTHONPATH=$build/python NOETHER_PROGRAM=$build/cli/noether PYTHONDONTWRITEBYTECODE=1
exec "$python" -m pytest -q -rs -p no:cacheprovider --durations=5 tests/python
