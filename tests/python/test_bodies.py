"""Bodies from tables and ephemerides; nothing here needs a net."""

import io
import pathlib
import struct
import urllib.error

import numpy as np
import pytest

import noether as nt

TABLES = pathlib.Path(__file__).resolve().parents[1] / "data" / "horizons"
AU_KM = 149597870.7


def test_the_solar_system_is_that_of_the_example():
    for bodies, example in ((nt.bodies.solar_system(), "solar_system"), (nt.bodies.outer_solar_system(), "outer_solar_system")):
        scene = nt.Scene(example)
        assert bodies.names == scene.names
        for ours, theirs in zip((bodies.masses, bodies.positions, bodies.velocities),
                                (scene.masses, scene.positions, scene.velocities)):
            assert (ours == theirs).all()


def test_the_solar_system_in_si_is_as_large():
    si, solar = nt.bodies.solar_system(units="si"), nt.bodies.solar_system()
    np.testing.assert_allclose(si.positions / (AU_KM * 1e3), solar.positions, rtol=1e-13)
    assert si["Saturn"].P / 86400 == pytest.approx(solar["Saturn"].P, rel=1e-6)


def test_a_table_of_elements_is_read_at_once(tmp_path):
    (tmp_path / "two.csv").write_text("name, mass [Msun], a [au], e, inc [deg], Omega, omega, M\n"
                                      "star, 1, , , , , ,\nplanet, 0.001, 5.2, 0.05, 1, 2, 3, 4\n")
    assert nt.bodies.from_csv(tmp_path / "two.csv")["planet"].a == pytest.approx(5.2, rel=1e-14)
    with pytest.raises(nt.FileError, match="nowhere.csv"):
        nt.bodies.from_csv("nowhere.csv")
    (tmp_path / "bad.csv").write_text("name, mass [Msun], x [au], y, z, vx [au/day], vy, vz\nstar, heavy, 0, 0, 0, 0, 0, 0\n")
    with pytest.raises(nt.Error, match="bad.csv:2"):
        nt.bodies.from_csv(tmp_path / "bad.csv")


def test_tables_of_horizons_in_several_files_are_one_system(tmp_path):
    one = nt.bodies.from_horizons_table(TABLES / "plain.txt")
    both = nt.bodies.from_horizons_table([TABLES / "plain.txt", TABLES / "commas.txt"])
    assert both.names == ["Jupiter Barycenter", "Saturn Barycenter"] and both.epoch == one.epoch == "JD 2451545 TDB"
    assert (both.positions[0] == one.positions[0]).all() and both.masses[0] == one.masses[0]
    (tmp_path / "both.txt").write_text((TABLES / "plain.txt").read_text() + "\n" + (TABLES / "commas.txt").read_text())
    assert (nt.Particles(str(tmp_path / "both.txt"), units="solar").velocities == both.velocities).all()
    with pytest.raises(nt.FileError, match="nowhere.txt"):
        nt.bodies.from_horizons_table([TABLES / "plain.txt", "nowhere.txt"])
    with pytest.raises(nt.Error, match="tables.txt:"):
        nt.bodies.from_horizons_table([TABLES / "positions.txt"])


# ---- SPK kernels ----------------------------------------------------------------------------------------------------


def write_kernel(path, orbits, days=(2451536.5, 2451552.5)):
    """A kernel of Chebyshev polynomials (type 2): {(target, center): coefficients (records, 3, n) [km]}."""
    seconds = [(day - 2451545) * 86400 for day in days]
    summaries, data, word = b"", b"", 385  # three records of 128 words come before the numbers
    for (target, center), coefficients in orbits.items():
        length = (seconds[1] - seconds[0]) / len(coefficients)
        numbers = []
        for k, record in enumerate(coefficients):
            numbers += [seconds[0] + (k + 0.5) * length, length / 2, *np.ravel(record)]
        size = len(numbers) // len(coefficients)
        numbers += [seconds[0], length, size, len(coefficients)]
        summaries += struct.pack("<2d6i", *seconds, target, center, 1, 2, word, word + len(numbers) - 1)
        data += struct.pack(f"<{len(numbers)}d", *numbers)
        word += len(numbers)
    head = struct.pack("<8sii60siii8s603s28s297s", b"DAF/SPK ", 2, 6, b"made up".ljust(60), 2, 2, word, b"LTL-IEEE", b"",
                       b"FTPSTR:\r:\n:\r\n:\r\x00:\x81:\x10\xce:ENDFTP", b"")
    table = (struct.pack("<3d", 0, 0, len(orbits)) + summaries).ljust(1024, b"\0")
    path.write_bytes(head + table + b" " * 1024 + data)


@pytest.fixture
def kernel(tmp_path):
    pytest.importorskip("jplephem")
    rng = np.random.default_rng(8)
    write_kernel(tmp_path / "small.bsp", {
        pair: size * rng.normal(size=(4, 3, 9)) for pair, size in
        (((10, 0), 1e5), ((3, 0), 1e8), ((399, 3), 4e3), ((301, 3), 4e5), ((5, 0), 7e8), ((2000433, 10), 4e8), ((599, 5), 1e2))})
    return tmp_path / "small.bsp"


def test_a_kernel_gives_what_jplephem_computes(kernel):
    from jplephem.spk import SPK

    day = 2451545.25
    bodies = nt.bodies.from_spk(kernel, day, ["Sun", "Earth", 301, "Jupiter"])
    assert bodies.names == ["Sun", "Earth", "Moon", "Jupiter"] and bodies.epoch == "JD 2451545.25 TDB"
    spk = SPK.open(str(kernel))
    for name, chain in (("Sun", [(0, 10)]), ("Earth", [(0, 3), (3, 399)]), ("Moon", [(0, 3), (3, 301)]), ("Jupiter", [(0, 5)])):
        x = sum(spk[pair].compute_and_differentiate(day)[0] for pair in chain)
        v = sum(spk[pair].compute_and_differentiate(day)[1] for pair in chain)
        k = bodies.index(name)
        assert (bodies.positions[k] == x / AU_KM).all() and (bodies.velocities[k] == v / AU_KM).all()
    spk.close()


def test_masses_are_those_that_the_engine_gives_to_tables_of_horizons(kernel):
    table = nt.bodies.from_horizons_table(TABLES / "plain.txt")
    assert nt.bodies.from_spk(kernel, 2451545, ["Jupiter"]).masses[0] == table.masses[0]
    GM = nt.bodies.from_spk(kernel, 2451545, ["Sun"], units="si").masses[0] * 6.6743e-11
    assert GM == pytest.approx(132712440041.27942e9, rel=1e-14)


def test_all_ways_to_tell_an_epoch_are_one(kernel):
    first = nt.bodies.from_spk(kernel, 2451545.0)
    assert first.names == ["Sun", "Earth", "Moon", "Jupiter"]
    for epoch in ("JD 2451545", "JD 2451545.0 TDB", "2000-01-01 12:00", "2000-01-01T12:00:00"):
        assert (nt.bodies.from_spk(kernel, epoch).positions == first.positions).all(), epoch
    time = pytest.importorskip("astropy.time")
    assert (nt.bodies.from_spk(kernel, time.Time("2000-01-01 12:00", scale="tdb")).positions == first.positions).all()


def test_the_ecliptic_is_turned_about_the_equinox(kernel):
    equatorial, ecliptic = nt.bodies.from_spk(kernel, 2451545), nt.bodies.from_spk(kernel, 2451545, axes="ecliptic")
    assert (equatorial.positions[:, 0] == ecliptic.positions[:, 0]).all()
    speeds = [np.linalg.norm(one.velocities, axis=1) for one in (equatorial, ecliptic)]
    np.testing.assert_allclose(*speeds, rtol=1e-14)
    pole = np.cross(ecliptic.positions[1], ecliptic.positions[3])
    turned = np.cross(equatorial.positions[1], equatorial.positions[3])
    angle = np.radians(84381.448 / 3600)
    assert pole[2] == pytest.approx(np.cos(angle) * turned[2] - np.sin(angle) * turned[1])


def test_a_body_whose_mass_is_not_built_in_needs_one(kernel):
    with pytest.raises(nt.Error, match="masses="):
        nt.bodies.from_spk(kernel, 2451545, [2000433])
    given = nt.bodies.from_spk(kernel, 2451545, [2000433, "Sun"], masses={2000433: "9.38e20 kg", "Sun": 2.0})
    assert given.masses[1] == 2.0 and given.masses[0] == pytest.approx(9.38e20 / 1.98841e30, rel=1e-5)


@pytest.mark.parametrize("arguments, kind, message", [
    ((2451545, ["Mars"]), KeyError, r"Mars \(4\) is not in .*; it has: "),
    ((2451545, ["Marz"]), KeyError, "did you mean 'Mars'"),
    ((2451645, ["Sun"]), nt.Error, "JD 2451645.0 is outside .* JD 2451536.5 to 2451552.5"),
    (("yesterday", ["Sun"]), ValueError, "epoch = 'yesterday'"),
    ((2451545, ["Earth-Moon", "Moon"]), nt.Error, "contains it"),
    ((2451545, ["Jupiter", 599]), nt.Error, "contains it"),
])
def test_what_a_kernel_does_not_have_raises(kernel, arguments, kind, message):
    with pytest.raises(kind, match=message):
        nt.bodies.from_spk(kernel, *arguments)


def test_a_file_that_is_not_a_kernel_raises(tmp_path):
    pytest.importorskip("jplephem")
    (tmp_path / "text.bsp").write_text("not a kernel" * 200)
    with pytest.raises(nt.FileError, match="not an SPK kernel"):
        nt.bodies.from_spk(tmp_path / "text.bsp", 2451545)
    with pytest.raises(nt.FileError, match="cannot be read"):
        nt.bodies.from_spk(tmp_path / "nowhere.bsp", 2451545)


def test_de421_gives_the_year_of_the_earth():
    pytest.importorskip("jplephem")
    data = pytest.importorskip("skyfield_data", reason="the kernel de421.bsp comes with skyfield-data")
    bodies = nt.bodies.from_spk(pathlib.Path(data.get_skyfield_data_path()) / "de421.bsp", "2000-01-01 12:00",
                                ["Sun", "Earth-Moon", "Jupiter"], axes="ecliptic")
    assert bodies["Earth-Moon"].P == pytest.approx(365.25, abs=0.1) and bodies["Earth-Moon"].inc < 1e-4
    assert bodies["Jupiter"].e == pytest.approx(0.0489, abs=5e-4)


# ---- the service of Horizons ----------------------------------------------------------------------------------------


def test_horizons_without_a_net_says_what_to_do_instead(monkeypatch):
    def unreachable(url, timeout):
        raise urllib.error.URLError("no route to host")

    monkeypatch.setattr("urllib.request.urlopen", unreachable)
    with pytest.raises(ConnectionError, match="no route to host.*from_horizons_table"):
        nt.bodies.horizons("Mars", 2451545)


def test_answers_of_horizons_are_read_and_saved(monkeypatch, tmp_path):
    asked = []

    def answer(url, timeout):
        asked.append(url)
        return io.BytesIO((TABLES / ("commas.txt" if "%276%27" in url else "plain.txt")).read_bytes())

    monkeypatch.setattr("urllib.request.urlopen", answer)
    bodies = nt.bodies.horizons(["Jupiter", "Saturn"], "2000-01-01 12:00", center="barycenter", save=tmp_path / "saved.txt")
    assert bodies.names == ["Jupiter", "Saturn"] and bodies.epoch == "JD 2451545 TDB"
    assert "COMMAND=%275%27" in asked[0] and "CENTER=%27500%400%27" in asked[0] and "TLIST=%272451545.0%27" in asked[0]
    again = nt.bodies.from_horizons_table(tmp_path / "saved.txt")
    assert (again.positions == bodies.positions).all() and (again.masses == bodies.masses).all()
    heavy = nt.bodies.horizons("Jupiter", 2451545, center="barycenter", masses={"Jupiter": "2e27 kg"})
    assert heavy.masses[0] == pytest.approx(2e27 / 1.98841e30, rel=1e-5)


def test_a_name_that_horizons_does_not_know_raises_with_its_answer(monkeypatch):
    monkeypatch.setattr("urllib.request.urlopen", lambda url, timeout: io.BytesIO(b"*****\n No matches found.\n*****\n"))
    with pytest.raises(nt.Error, match="'Marz': No matches found"):
        nt.bodies.horizons("Marz", 2451545)
    with pytest.raises(ValueError, match="at the center"):
        nt.bodies.horizons("Sun", 2451545)
