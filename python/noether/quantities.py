"""Numbers with units: texts such as "5 day", quantities of pint and astropy, and bare numbers in the units of a scene."""

import numbers

from . import _core

# What astropy calls otherwise than noether.
_OTHER_NAMES = {"AU": "au", "solMass": "Msun", "M_sun": "Msun", "earthMass": "Mearth", "jupiterMass": "Mjup", "d": "day",
                "deg": "deg", "Angstrom": "angstrom", "u": "Da"}


def _text_of_units(unit):
    """A unit of astropy as noether reads it: factors and their powers, parted by blanks."""
    from fractions import Fraction

    words = []
    for base, power in zip(unit.bases, unit.powers):
        name = _OTHER_NAMES.get(base.name, base.name)
        power = Fraction(power).limit_denominator(1000)
        if power.denominator != 1:
            raise ValueError(f"the unit {unit} has the power {power}; whole powers are expected")
        words.append(name if power == 1 else f"{name}^{power.numerator}")
    return " ".join(words)


def plain(value):
    """A value as scenes have it: quantities of pint and astropy become texts, or lists of them."""
    unit = getattr(value, "unit", None)
    if unit is not None and hasattr(unit, "bases") and hasattr(value, "value"):  # astropy
        return _with_text(value.value, _text_of_units(unit) if unit.bases else "")
    if hasattr(value, "magnitude") and hasattr(value, "units"):  # pint
        return _with_text(value.magnitude, f"{value.units:~C}".replace("**", "^"))
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items() if one is not None}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    return value


def _with_text(number, unit):
    if hasattr(number, "tolist"):
        number = number.tolist()
    if isinstance(number, list):
        return [_with_text(one, unit) for one in number]
    return f"{number!r} {unit}" if unit else number


def with_units(value, dimension, units):
    """The same with the scene's own unit behind every bare number of a dimension."""
    value = plain(value)
    if units == "reduced" or dimension in ("1", ""):
        return value
    # To the engine angles are numbers; a scene says their unit all the same, and here bare ones are radians.
    return _put_unit(value, "rad" if dimension == "angle" else _core.unit_of(dimension, units))


def _put_unit(value, unit):
    if hasattr(value, "tolist") and not isinstance(value, str):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_put_unit(one, unit) for one in value]
    if isinstance(value, numbers.Real) and not isinstance(value, bool) and unit != "1":
        return f"{float(value)!r} {unit}"
    return value


def number_of(value, dimension, units):
    """The number of a quantity in the units of a scene; of a list, a list."""
    value = plain(value)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, list):
        return [number_of(one, dimension, units) for one in value]
    if isinstance(value, str):
        return _core.quantity(value, dimension, units)
    return float(value)
