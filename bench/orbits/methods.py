"""The methods whose fronts are measured: noether's, and every one of REBOUND and heyoka that serves planets.

Those that are on fronts come first, for what stands last is left out where there is no time. Steps are in units of a twentieth
of a turn of the fastest body at its fastest (System.step)."""

PLAIN = (2, 1, 0.5, 0.25)
PROCESSED = (2, 1.4, 1, 0.7, 0.5, 0.25)
HIGH = (5.6, 4, 2.8, 2, 1.4, 1)
LEAPFROG = {2: (0.5, 0.125), 4: (1, 0.5, 0.25), 6: (1, 0.5, 0.25), 8: (2, 1.4, 1, 0.7)}
WIDE = (2.8, 2.4, 2, 1.6, 1.3, 1)
EXACT = (2.4, 2, 1.6, 1.3)  # never the step of the truth, which wide_gauss_8 made
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16)  # the last is the default of noether's methods to rounding
TAYLOR = (1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 2.220446049250313e-16)  # the last is heyoka's default
FEW_TOLERANCES = (1e-6, 1e-9, 1e-12)


class Entry:
    """One method of a program, and its settings: steps, as ratios, or tolerances.

    `spec` is what the program is told; `with_tolerance(spec, tolerance)` adds a tolerance to it."""

    def __init__(self, program, label, family, spec, ratios=(), tolerances=(), with_tolerance=None):
        self.program, self.label, self.family, self.spec = program, label, family, spec
        self.ratios, self.tolerances, self.with_tolerance = ratios, tolerances, with_tolerance


def splitting(label, family, method, ratios, hamiltonian="wisdom_holman", coordinates=None, **keys):
    spec = {"method": method, "hamiltonian": hamiltonian, "keys": keys}
    if coordinates:
        spec["coordinates"] = coordinates
    return Entry("noether", label, family, spec, ratios)


def with_rtol(spec, tolerance):
    return {**spec, "keys": {**spec["keys"], "rtol": tolerance}}


def classical(method, family, ratios=(), tolerances=(), **keys):
    spec = {"method": method, "hamiltonian": "kinetic_potential", "keys": keys}
    label = method + (" fixed" if keys.get("adaptive") is False else "")
    return Entry("noether", label, family, spec, ratios, tolerances, with_rtol)


def noether_methods():
    found = [splitting("verlet_aba", "Wisdom-Holman", "verlet_aba", PLAIN)]
    for coordinates in ("democratic", "whds", "barycentric"):
        found.append(splitting(f"verlet_aba {coordinates}", "Wisdom-Holman", "verlet_aba", PLAIN, coordinates=coordinates))
    for order in (3, 5, 7, 11, 17):
        found.append(splitting(f"verlet_aba corrector {order}", "Wisdom-Holman", "verlet_aba", PROCESSED, corrector=order))
    for kernel in ("modified", "composed", "lazy"):
        found.append(splitting(f"verlet_aba corrector 17 kernel {kernel}", "Wisdom-Holman", "verlet_aba", PROCESSED,
                               corrector=17, kernel=kernel))
    found.append(splitting("verlet_aba corrector 17 kernel modified second_corrector", "Wisdom-Holman", "verlet_aba", PROCESSED,
                           corrector=17, kernel="modified", second_corrector=True))
    found.append(splitting("verlet_aba corrector 17 compensated", "Wisdom-Holman", "verlet_aba", PROCESSED, corrector=17,
                           compensated=True))
    for stages in (1, 2, 3, 4):
        found.append(splitting(f"saba_{stages}", "ABA", f"saba_{stages}", PLAIN))
        found.append(splitting(f"saba_{stages} kernel modified", "ABA", f"saba_{stages}", HIGH, kernel="modified"))
    for method in ("aba_8_4", "aba_10_4", "aba_8_6_4", "aba_10_6_4"):
        found.append(splitting(method, "ABA", method, HIGH))
    found.append(splitting("aba_10_6_4 compensated", "ABA", "aba_10_6_4", HIGH, compensated=True))
    for method in ("abah_8_4_4", "abah_8_6_4", "abah_10_6_4"):
        found.append(splitting(f"{method} democratic", "ABA", method, HIGH, coordinates="democratic"))
    found.append(classical("gauss_8", "Gauss", tolerances=TOLERANCES))
    found.append(classical("gauss_8", "Gauss", WIDE, adaptive=False))
    found.append(classical("gauss_6", "Gauss", (2, 1.3, 1), adaptive=False))
    found.append(classical("gauss_4", "Gauss", (1.3, 1), adaptive=False))
    found.append(classical("gauss_radau_15", "Gauss", tolerances=TOLERANCES))
    found.append(classical("encke_gauss_8", "exact", EXACT))
    found.append(classical("wide_gauss_8", "exact", EXACT))
    for method, ratios in (("verlet", LEAPFROG[2]), ("blanes_moan_s6", LEAPFROG[4]), ("srkn11b", LEAPFROG[8]),
                           ("srkn14a", LEAPFROG[8]), ("kahan_li_8_s17", LEAPFROG[8])):
        found.append(splitting(f"{method} kinetic_potential", "drift and kick", method, ratios, "kinetic_potential"))
    for method in ("dop853", "dprkn_12", "gragg_bulirsch_stoer", "adams_pece"):
        found.append(classical(method, "adaptive", tolerances=FEW_TOLERANCES))
    found.append(classical("stormer_cowell_13", "multistep", (0.14, 0.1, 0.07, 0.05)))
    return found


def rebound(label, family, integrator, ratios=(), tolerances=(), with_tolerance=None, **options):
    return Entry("rebound", label, family, {"integrator": integrator, "options": options}, ratios, tolerances,
                 with_tolerance)


def with_options(*names):
    return lambda spec, tolerance: {**spec, "options": {**spec["options"], **dict.fromkeys(names, tolerance)}}


def rebound_methods(avx512):
    quick = {"safe_mode": 0, "keep_unsynchronized": 1}
    found = []
    found.append(rebound("IAS15", "IAS15", "ias15", (), (1e-9, 1e-7, 1e-5, 1e-3), with_options("epsilon")))
    for coordinates in ("JACOBI", "DEMOCRATICHELIOCENTRIC", "WHDS", "BARYCENTRIC"):
        found.append(rebound(f"WHFast {coordinates.lower()}", "WHFast", "whfast", PLAIN, coordinates=coordinates, **quick))
    for order in (3, 5, 7, 11, 17):
        found.append(rebound(f"WHFast corrector {order}", "WHFast", "whfast", PROCESSED, corrector=order, **quick))
    for kernel in ("MODIFIEDKICK", "COMPOSITION", "LAZY"):
        found.append(rebound(f"WHFast corrector 17 kernel {kernel.lower()}", "WHFast", "whfast", PROCESSED, corrector=17,
                             kernel=kernel, **quick))
    found.append(rebound("WHFast corrector 17 kernel modifiedkick corrector2", "WHFast", "whfast", PROCESSED, corrector=17,
                         kernel="MODIFIEDKICK", corrector2=1, **quick))
    if avx512:
        found.append(rebound("WHFast512", "WHFast512", "whfast512", PLAIN))
        found.append(rebound("WHFast512 corrector 17", "WHFast512", "whfast512", PROCESSED, corrector=17))
    for kind in ("1", "2", "3", "4"):
        found.append(rebound(f"SABA{kind}", "SABA", "saba", PLAIN, type=kind, **quick))
        for corrector in ("CM", "CL"):
            found.append(rebound(f"SABA{corrector}{kind}", "SABA", "saba", HIGH, type=f"{corrector}_{kind}", **quick))
    for kind in ("10_4", "8_6_4", "10_6_4", "H_8_4_4", "H_8_6_4", "H_10_6_4"):
        found.append(rebound(f"SABA({kind.replace('_', ',')})", "SABA", "saba", HIGH, type=kind, **quick))
    for order, ratios in LEAPFROG.items():
        found.append(rebound(f"Leapfrog {order}", "Leapfrog", "leapfrog", ratios, order=order))
    for outer, inner in (("LF", "LF"), ("LF4", "LF4"), ("LF6", "LF6"), ("LF8", "LF8"), ("LF4_2", "LF8"), ("LF8_6_4", "LF8"),
                         ("PLF7_6_4", "LF8"), ("PMLF4", "LF8"), ("PMLF6", "LF8")):
        found.append(rebound(f"EOS {outer} {inner}", "EOS", "eos", (4, 2, 1), safe_mode=0, phi0=outer, phi1=inner))
    for order in (2, 4, 6, 8, 10):
        found.append(rebound(f"JANUS {order}", "JANUS", "janus", (1.4, 0.7) if order > 4 else LEAPFROG[order], order=order))
    found.append(rebound("Mercurius", "Mercurius", "mercurius", PLAIN, safe_mode=0))
    found.append(rebound("TRACE", "TRACE", "trace", PLAIN))
    found.append(rebound("BS", "BS", "bs", (), (1e-6, 1e-8, 1e-10, 1e-12, 1e-14), with_options("eps_abs", "eps_rel")))
    return found


def heyoka_methods():
    def tolerant(spec, tolerance):
        return {**spec, "tolerance": tolerance}

    return [Entry("heyoka", "Taylor" + (" high accuracy" if accurate else ""), "Taylor", {"high_accuracy": accurate}, (), TAYLOR,
                  tolerant) for accurate in (False, True)]


def all_methods(avx512):
    return noether_methods() + rebound_methods(avx512) + heyoka_methods()
