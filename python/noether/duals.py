"""Dual numbers in Python: a value and its derivatives, carried through every operation, and through NumPy's functions.

Constraints of your own are called with arrays of these in the place of floats, so that their derivatives are exact: write
them with arithmetic and NumPy's sqrt, exp, log, sin, cos, tan, arctan2, arcsin, arccos, and do not turn them into floats.
"""

import math

import numpy


class Dual:
    """a + sum of b_k e_k with e_j e_k = 0. Values and slopes may be dual themselves."""

    __slots__ = ("value", "slopes")

    def __init__(self, value, slopes):
        self.value, self.slopes = value, list(slopes)

    def _chain(self, value, rate):
        return Dual(value, [rate * slope for slope in self.slopes])

    def __add__(self, other):
        if isinstance(other, Dual):
            return Dual(self.value + other.value, [a + b for a, b in zip(self.slopes, other.slopes)])
        return Dual(self.value + other, self.slopes)

    __radd__ = __add__

    def __neg__(self):
        return self._chain(-self.value, -1.0)

    def __pos__(self):
        return self

    def __sub__(self, other):
        return self + (-other)

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        if isinstance(other, Dual):
            return Dual(self.value * other.value,
                        [self.value * b + a * other.value for a, b in zip(self.slopes, other.slopes)])
        return self._chain(self.value * other, other)

    __rmul__ = __mul__

    def __truediv__(self, other):
        return self * (1.0 / other) if not isinstance(other, Dual) else self * other._reciprocal()

    def __rtruediv__(self, other):
        return self._reciprocal() * other

    def _reciprocal(self):
        one = 1.0 / self.value
        return self._chain(one, -one * one)

    def __pow__(self, power):
        if isinstance(power, Dual):
            return (power * self.log()).exp()
        if power == 0:
            return self._chain(1.0 + 0 * self.value, 0.0)
        return self._chain(self.value ** power, power * self.value ** (power - 1))

    def __rpow__(self, base):
        return (self * math.log(base)).exp()

    def __abs__(self):
        return -self if self < 0 else self

    def sqrt(self):
        root = _of("sqrt", self.value)
        return self._chain(root, 0.5 / root)

    def exp(self):
        value = _of("exp", self.value)
        return self._chain(value, value)

    def log(self):
        return self._chain(_of("log", self.value), 1.0 / self.value)

    def sin(self):
        return self._chain(_of("sin", self.value), _of("cos", self.value))

    def cos(self):
        return self._chain(_of("cos", self.value), -_of("sin", self.value))

    def tan(self):
        return self.sin() / self.cos()

    def arcsin(self):
        return self._chain(_of("arcsin", self.value), 1.0 / _of("sqrt", 1.0 - self.value * self.value))

    def arccos(self):
        return self._chain(_of("arccos", self.value), -1.0 / _of("sqrt", 1.0 - self.value * self.value))

    def arctan(self):
        return self._chain(_of("arctan", self.value), 1.0 / (1.0 + self.value * self.value))

    def arctan2(self, other):
        x = other if isinstance(other, Dual) else Dual(other, [0.0] * len(self.slopes))
        square = self.value * self.value + x.value * x.value
        angle = self.value.arctan2(x.value) if isinstance(self.value, Dual) else math.atan2(self.value, x.value)
        return Dual(angle, [(x.value * a - self.value * b) / square for a, b in zip(self.slopes, x.slopes)])

    def conjugate(self):
        return self

    # Comparisons see the value only.
    def __eq__(self, other):
        return self.value == (other.value if isinstance(other, Dual) else other)

    def __lt__(self, other):
        return self.value < (other.value if isinstance(other, Dual) else other)

    def __gt__(self, other):
        return self.value > (other.value if isinstance(other, Dual) else other)

    def __le__(self, other):
        return not self > other

    def __ge__(self, other):
        return not self < other

    __hash__ = None

    def __float__(self):
        raise TypeError("a constraint of your own turned a position into a float, which has no derivative; "
                        "use arithmetic and NumPy's functions, not those of math")

    def __repr__(self):
        return f"Dual({self.value!r}, {self.slopes!r})"


def _of(name, x):
    return getattr(x, name)() if isinstance(x, Dual) else getattr(numpy, name)(x)


def call(function, rows):
    """The value of a constraint at positions of shape (particles, 3), floats or dual numbers."""
    kind = object if isinstance(rows[0][0], Dual) else float
    x = numpy.array(rows, dtype=kind)
    found = function(x)
    if isinstance(found, numpy.ndarray) and found.size == 1:
        found = found.item()
    if found is None or isinstance(found, (numpy.ndarray, list, tuple)):
        raise TypeError(f"a constraint of your own returned {type(found).__name__}; one number is expected, which is 0 where "
                        "it holds")
    return found
