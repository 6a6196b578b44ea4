"""The parts of noether as classes: forces, monitors, Hamiltonians, constraints, and all others.

They are made from what each part says of itself, so that a part added in C++ is here without a line of Python. An object
holds values; the engine makes the part itself when a simulation begins, and tells what is wrong with them then.
"""

import functools
import inspect
import json
import keyword
import types
import typing

from . import _core, quantities

# Kinds of parts, by the names of their modules here.
KINDS = {
    "hamiltonians": "hamiltonian", "forces": "force", "fields": "field", "constraints": "constraint",
    "thermostats": "thermostat", "systems": "system", "builders": "builder", "decorators": "decorator",
    "monitors": "monitor", "writers": "writer", "stops": "stop", "starts": "start",
}
_OWN = ("user_force", "user_monitor", "user_constraint", "user_constraint_of_pairs", "user_constraint_of_triples",
        "user_constraint_of_groups")  # what functions in Python become; nobody asks for them by name


def class_name(name):
    """`lennard_jones` as a class: LennardJones."""
    return "".join(word[:1].upper() + word[1:] for word in name.split("_"))


def _python_name(name):
    return name + "_" if keyword.iskeyword(name) else name


def _value_of(text):
    """A default as Python has it, from how a scene writes it."""
    if text is None:
        return None
    try:
        return json.loads(text)
    except ValueError:
        return text


_TYPES = {
    "number": typing.Union[float, str], "whole number": int, "flag": bool, "text": str, "choice": str,
    "vector": typing.Sequence, "list": typing.Sequence, "tables": typing.Sequence,
}


def _annotation(field):
    kind = _TYPES.get(field["kind"], typing.Any)
    if field["choices"]:
        return typing.Literal[tuple(field["choices"])]
    return typing.Annotated[kind, field["dimension"]] if hasattr(typing, "Annotated") and field["dimension"] != "1" else kind


def _signature(fields):
    required = [f for f in fields if f["example"] is not None]
    others = [f for f in fields if f["example"] is None]
    return inspect.Signature([
        inspect.Parameter(_python_name(f["name"]), inspect.Parameter.KEYWORD_ONLY,
                          default=inspect.Parameter.empty if f["example"] is not None else _value_of(f["default"]),
                          annotation=_annotation(f))
        for f in required + others])


def _document(info):
    lines = [info["help"][:1].upper() + info["help"][1:] + "."]
    if info.get("formula"):
        lines += ["", "    " + info["formula"]]
    if info["fields"]:
        lines += ["", "Keywords", "--------"]
    for field in info["fields"]:
        unit = "" if field["dimension"] in ("1", "") else f" [{field['dimension']}]"
        need = ", required" if field["example"] is not None else ""
        default = f"; default {field['default']}" if field["default"] is not None else ""
        choice = "; one of " + ", ".join(field["choices"]) if field["choices"] else ""
        lines.append(f"{_python_name(field['name'])} : {field['kind']}{unit}{need}")
        lines.append("    " + (field["help"] + default + choice).lstrip("; "))
    if info.get("quantities"):
        lines += ["", "It tells " + info["quantities"] + "."]
    if info.get("source"):
        lines += ["", "Source: " + info["source"]]
    return "\n".join(lines)


class Part:
    """A part of a scene: its type, and values of its keys."""

    kind = name = ""
    _fields = {}

    def __init__(self, **values):
        known = self._fields
        self.values = {}
        for key, value in values.items():
            field = key[:-1] if key.endswith("_") and keyword.iskeyword(key[:-1]) else key
            if field not in known and not self._takes(field):
                raise TypeError(f"{type(self).__name__} has no keyword {key!r}{_proposal(field, known)}")
            if value is not None:
                self.values[field] = value
        for field in known.values():
            if field["example"] is not None and field["name"] not in self.values and not self._may_lack(field["name"]):
                raise TypeError(f"{type(self).__name__} needs {field['name']}, such as {field['example']}")

    def _takes(self, key):
        # Keys that stand beside those of every force and constraint of a scene.
        return key in _BESIDE.get(self.kind, ())

    def _may_lack(self, key):
        # Which particles a part ties can be said in several ways, of which one is an example.
        return key in ("bodies", "pairs", "triples", "groups")

    def tree(self, units):
        """The table of a scene; bare numbers get the units of the scene."""
        table = {"type": self.name} if self.name else {}
        for key, value in self.values.items():
            table[key] = quantities.with_units(value, self._fields.get(key, {}).get("dimension", "1"), units)
        return table

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{k}={v!r}' for k, v in self.values.items())})"

    def __eq__(self, other):
        return type(self) is type(other) and self.values == other.values

    __hash__ = None


_BESIDE = {"force": ("kick",), "field": ("kick",), "constraint": ("solver", "tolerance", "iterations", "order")}


def _proposal(word, known):
    import difflib

    near = difflib.get_close_matches(word, known, 1, 0.6)
    return f"; did you mean {near[0]!r}?" if near else f"; it has: {', '.join(known) or 'none'}"


@functools.lru_cache(maxsize=None)
def described():
    """What every part says of itself: by kind, by name."""
    all_parts = {}
    for info in _core.parts():
        if info["name"] not in _OWN:
            all_parts.setdefault(info["kind"], {})[info["name"]] = info
    return all_parts


@functools.lru_cache(maxsize=None)
def _table_fields(table):
    for one in _core.tables():
        if one["name"] == table:
            return {field["name"]: field for field in one["fields"]}
    return {}


def table_fields(table):
    """The keys of a table of scenes, such as "[integrator]"."""
    return _table_fields(table)


@functools.lru_cache(maxsize=None)
def part_class(kind, name):
    info = described()[kind][name]
    extra = []
    if kind == "writer":
        extra = [{"name": "file", "kind": "text", "dimension": "1", "default": None, "example": None, "choices": [],
                  "help": "where it is written"}]
    if kind == "hamiltonian":
        taken = {field["name"] for field in info["fields"]}
        extra = [f for f in _table_fields("[hamiltonian]").values() if f["name"] != "type" and f["name"] not in taken]
    fields = info["fields"] + extra
    made = type(class_name(name), (Part,), {
        "__doc__": _document({**info, "fields": fields}), "kind": kind, "name": name,
        "_fields": {f["name"]: f for f in fields}, "__module__": "noether." + kind + "s",
    })
    made.__signature__ = _signature(fields)
    return made


@functools.lru_cache(maxsize=None)
def _homes():
    """Class names, and the parts that they are."""
    homes = {}
    for kind, infos in described().items():
        for name in infos:
            homes.setdefault(class_name(name), []).append((kind, name))
    return homes


def class_names():
    return [name for name, homes in _homes().items() if len(homes) == 1]


class _Kind(types.ModuleType):
    """Parts of one kind, as a module."""

    def __init__(self, plural, kind):
        super().__init__("noether." + plural, f"The {plural} of noether, each a class with its keywords.")
        self._kind = kind

    def __getattr__(self, name):
        for part in described().get(self._kind, {}):
            if name in (part, class_name(part)):
                return part_class(self._kind, part)
        raise AttributeError(f"noether has no {self._kind} {name!r}{_proposal(name, self.__dir__())}")

    def __dir__(self):
        return [class_name(part) for part in described().get(self._kind, {})]


class Method:
    """A method by its name, and options of [integrator]."""

    name, _fields = "", {}

    def __init__(self, name=None, **options):
        self.name = name or self.name
        self.options = {key: value for key, value in options.items() if value is not None}

    def __repr__(self):
        return f"Method({self.name!r}{''.join(f', {k}={v!r}' for k, v in self.options.items())})"


class _Methods(types.ModuleType):
    """Schemes and methods for y' = f, by the names that scenes give them."""

    def __init__(self):
        super().__init__("noether.methods", "Schemes and methods for y' = f, by the names that scenes give them.")

    @staticmethod
    @functools.lru_cache(maxsize=None)
    def _known():
        known = {info["name"]: info for info in _core.methods()}
        for name in _core.scheme_names():
            known.setdefault(name, {"name": name, "fields": list(_table_fields("[integrator]").values())})
        return known

    def __getattr__(self, name):
        info = self._known().get(name)
        if info is None:
            raise AttributeError(f"noether has no method {name!r}{_proposal(name, self._known())}")
        fields = [f for f in info["fields"] if f["name"] not in ("method", "step", "until", "steps", "start")]
        fields = [{**f, "example": None} for f in fields]
        made = type(name, (Method,), {"name": name, "_fields": {f["name"]: f for f in fields}, "__module__": "noether.methods",
                                      "__doc__": _document({"help": f"the method {name}", "fields": fields})})
        made.__signature__ = _signature(fields)
        return made

    def __dir__(self):
        return list(self._known())


def find(name):
    """A class of a part, or the module of a kind. @raise AttributeError"""
    if name in KINDS:
        return _Kind(name, KINDS[name])
    if name == "methods":
        return _Methods()
    if name == "Method":
        return Method
    homes = _homes().get(name, [])
    if len(homes) == 1:
        return part_class(*homes[0])
    if homes:
        plural = {kind: module for module, kind in KINDS.items()}
        places = " or ".join(f"noether.{plural.get(kind, kind)}.{name}" for kind, _ in homes)
        raise AttributeError(f"noether has several parts of the name {name!r}; write {places}")
    raise AttributeError(f"module 'noether' has no attribute {name!r}{_proposal(name, _homes())}")


def as_part(value, kind, module):
    """A part that was given as an object, a class, or by its name."""
    if isinstance(value, str):
        name = value if value in described().get(kind, {}) else None
        if name is None:
            raise ValueError(f"unknown {kind} {value!r}{_proposal(value, described().get(kind, {}))}")
        return part_class(kind, name)()
    if isinstance(value, type) and issubclass(value, Part):
        value = value()
    if not isinstance(value, Part):
        raise TypeError(f"{value!r} is not a {kind}; give one of noether.{module}, or its name")
    if value.kind != kind:
        raise TypeError(f"{type(value).__name__} is a {value.kind}, where a {kind} is expected")
    return value
