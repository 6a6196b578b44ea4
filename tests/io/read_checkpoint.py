"""Reads a checkpoint with h5py and checks its hash with hashlib: read_checkpoint.py FILE STEP DIGEST"""

import hashlib
import sys

try:
    import h5py
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def main(path, step, digest):
    with open(path, "rb") as source:
        content = source.read()
    body, trailer = content[:-72], content[-72:]
    assert trailer.decode() == "sha256:" + hashlib.sha256(body).hexdigest() + "\n"
    with h5py.File(path, "r") as file:
        assert file["state/position"].shape == file["state/velocity"].shape == (3 * len(file["state/id"]),)
        assert {"simulation", "integrator", "energy"} <= set(file["parts"]), list(file["parts"])
        noether = file["noether"]
        assert text(noether["digest"][()]) == digest
        assert text(noether["scene"][()]) == 'title = "x"\n'
        assert "checksum" in noether
        assert noether.attrs["complete"] == 1
        assert noether.attrs["step"] == step


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), sys.argv[3])
