"""Writes the type stubs of the package: every part with its keywords and their units, for editors and type checkers.

    python3 stubs.py FOLDER     writes FOLDER/*.pyi; FOLDER is the package, with its module

They are made from what the parts say of themselves, when the package is built.
"""

import inspect
import pathlib
import sys

HEAD = '''"""{}"""

from typing import Annotated, Any, Literal, Sequence, Union

from .parts import Part as Part
'''


def annotation(field):
    if field["choices"]:
        return "Literal[" + ", ".join(repr(one) for one in field["choices"]) + "]"
    kind = {"number": "Union[float, str]", "whole number": "int", "flag": "bool", "text": "str", "choice": "str"}.get(
        field["kind"], "Sequence[Any]")
    if field["dimension"] not in ("", "1"):
        # Quantities of pint and astropy have no common type.
        kind = f'Annotated[Union[{"float, str" if field["kind"] == "number" else "Sequence[Any]"}, Any], "{field["dimension"]}"]'
    return kind


def class_of(made):
    lines = [f"class {made.__name__}(Part):", f"    {made.__doc__!r}"]
    parameters = ["self"]
    if made.__signature__.parameters:
        parameters.append("*")
    for name, parameter in made.__signature__.parameters.items():
        field = made._fields[name.rstrip("_")] if name not in made._fields else made._fields[name]
        default = "" if parameter.default is inspect.Parameter.empty else f" = {parameter.default!r}"
        kind = annotation(field)
        if default == " = None":
            kind = f"Union[{kind}, None]"
        parameters.append(f"{name}: {kind}{default}")
    body = f"    def __init__({', '.join(parameters)}) -> None: ..."
    return "\n".join([*lines, body])


def module_of(parts, plural, kind):
    classes = [class_of(parts.part_class(kind, name)) for name in parts.described().get(kind, {})]
    return HEAD.format(f"The {plural} of noether.") + "\n\n" + "\n\n\n".join(classes) + "\n"


def methods_of(parts, methods):
    lines = ['"""Schemes and methods for y\' = f."""', "", "from .parts import Method as Method", ""]
    for name in dir(methods):
        keywords = "".join(f", {key}: Any = ..." for key in getattr(methods, name)._fields)
        lines.append(f"class {name}(Method):\n    def __init__(self{', *' if keywords else ''}{keywords}) -> None: ...\n")
    return "from typing import Any\n" + "\n".join(lines)


def package(noether, parts):
    lines = ['"""' + noether.__doc__.splitlines()[0] + '"""', "", "from typing import Optional", ""]
    for plural in [*parts.KINDS, "methods", *noether._MODULES]:
        lines.append(f"from . import {plural} as {plural}")
    lines.append("from ._core import Error as Error, FileError as FileError")
    for name, home in noether._HOMES.items():
        lines.append(f"from .{home} import {name} as {name}")
    for name in parts.class_names():
        kind, _ = parts._homes()[name][0]
        plural = {one: many for many, one in parts.KINDS.items()}[kind]
        lines.append(f"from .{plural} import {name} as {name}")
    return "\n".join([*lines, "from .parts import Method as Method", "", "__version__: str",
                      "def threads(count: Optional[int] = ...) -> int: ...", ""])


CORE = '''"""The compiled module."""

from typing import Any

class Error(ValueError): ...
class FileError(Error, OSError): ...

def __getattr__(name: str) -> Any: ...
'''


def main(folder):
    folder = pathlib.Path(folder)
    sys.path.insert(0, str(folder.parent))
    import noether
    from noether import parts

    for plural, kind in parts.KINDS.items():
        (folder / f"{plural}.pyi").write_text(module_of(parts, plural, kind))
    (folder / "methods.pyi").write_text(methods_of(parts, noether.methods))
    (folder / "__init__.pyi").write_text(package(noether, parts))
    (folder / "_core.pyi").write_text(CORE)
    (folder / "py.typed").write_text("")


if __name__ == "__main__":
    main(sys.argv[1])
