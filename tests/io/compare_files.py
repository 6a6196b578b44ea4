"""Compares two HDF5 files, value for value: every group, dataset and attribute. compare_files.py A B"""

import sys

try:
    import h5py
    import numpy
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)


def content(path):
    """{path: bytes} of all datasets, and of all attributes by "path@name"."""
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset):
            value = item[()]
            found[name] = repr((item.shape, str(item.dtype), value.tolist() if item.dtype.kind == "O" and item.shape
                                else value.tobytes() if hasattr(value, "tobytes") else value))
        for key, value in item.attrs.items():
            found[f"{name}@{key}"] = repr(numpy.asarray(value).tolist())

    with h5py.File(path, "r") as file:
        file.visititems(visit)
        # Groups that are linked twice are visited once; name the second paths too.
        for path in ("particles/system/velocity/step", "particles/system/velocity/time"):
            if path in file:
                found[path] = repr(file[path][:].tobytes())
    return found


if __name__ == "__main__":
    first, second = content(sys.argv[1]), content(sys.argv[2])
    different = sorted(k for k in first.keys() | second.keys() if first.get(k) != second.get(k))
    print(f"{len(first)} objects" if not different else "different: " + ", ".join(different))
    sys.exit(1 if different else 0)
