"""Parts from their descriptions: every one has a class, a signature, a docstring; what it does not know it refuses."""

import inspect

import pytest

import noether as nt
from noether import parts


@pytest.mark.parametrize("kind", parts.described())
def test_every_part_is_a_class(kind):
    plural = {one: many for many, one in parts.KINDS.items()}[kind]
    module = getattr(nt, plural)
    for name, info in parts.described()[kind].items():
        made = getattr(module, parts.class_name(name))
        assert made is getattr(module, name) and made.name == name
        assert info["help"][1:] in made.__doc__
        seen = [key.rstrip("_") for key in inspect.signature(made).parameters]
        assert sorted(seen) == sorted(made._fields)


def test_defaults_and_units_are_in_the_signature():
    signature = inspect.signature(nt.LennardJones)
    assert signature.parameters["precision"].default == "double"
    assert signature.parameters["cutoff"].annotation.__metadata__ == ("length",)
    assert signature.parameters["cutoff"].default is inspect.Parameter.empty
    assert "LennardJones1931" in nt.LennardJones.__doc__ and "[length]" in nt.LennardJones.__doc__


def test_methods():
    assert "gauss_8" in dir(nt.methods) and "aba_10_6_4" in dir(nt.methods)
    method = nt.methods.gauss_8(rtol=1e-12)
    assert method.name == "gauss_8" and method.options == {"rtol": 1e-12}
    with pytest.raises(AttributeError, match="did you mean 'yoshida_4'"):
        nt.methods.yoshida_44


def test_bare_numbers_get_the_units_of_the_scene():
    force = nt.LennardJones(cutoff=1.2, epsilon="0.65 kJ/mol", sigma=0.3)
    assert force.tree("molecular") == {"type": "lennard_jones", "cutoff": "1.2 nm", "epsilon": "0.65 kJ/mol", "sigma": "0.3 nm"}
    assert force.tree("reduced")["cutoff"] == 1.2


def test_pint_and_astropy():
    pint = pytest.importorskip("pint").UnitRegistry()
    assert nt.quantities.plain(5.2 * pint.au) == "5.2 au"
    assert nt.quantities.number_of(30 * pint.km / pint.s, "velocity", "si") == 30000
    units = pytest.importorskip("astropy.units")
    assert nt.quantities.plain(5.2 * units.au) == "5.2 au"
    assert nt.quantities.number_of(1 * units.M_sun, "mass", "solar") == 1
    assert nt.quantities.number_of(2 * units.km / units.s, "velocity", "si") == 2000
    assert nt.quantities.number_of([1, 2] * units.km, "length", "si") == [1000, 2000]


def test_names_that_two_kinds_have_are_told_apart():
    twice = [name for name, homes in parts._homes().items() if len(homes) > 1]
    for name in twice:
        with pytest.raises(AttributeError, match="several parts"):
            getattr(nt, name)
    assert len(parts.class_names()) > 80
