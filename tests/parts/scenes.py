"""A short scene for every part: what tests/parts/every_part.py walks through all commands.

Parts are found by the program itself; one that has no scene here fails the test by name. A case is the text of its
tables; units are reduced and times bare numbers in all of them but those of water.
"""

import dataclasses
import pathlib

STEPS = 60

# Methods for `compare`, of which `stability` takes the first: of order 2 and 4; with steps forward only, for what is
# irreversible; made of whole steps of RATTLE.
RIVALS = ("verlet", "blanes_moan_s6")
FORWARD = ("verlet", "mclachlan_2_s2")
WHOLE_STEPS = ("verlet", "yoshida_4")


@dataclasses.dataclass
class Case:
    """One scene; its Hamiltonian or system is `motion`, and `watch` what looks on beside energy and files."""
    place: str
    motion: str
    method: str = "verlet"
    step: float = 0.02
    watch: str = ""
    stop: str = ""
    around: str = ""                             # what stands around the method, as tables of [integrator]
    flow: str = "dop853"                         # the method for y' = f that chooses its steps
    rivals: tuple = RIVALS                       # methods of `compare` and `advise`; the first is that of `stability`
    energy: bool = True
    particles: bool = True
    units: str = "reduced"
    unit: str = ""                               # of times, where units are not reduced
    files: dict = dataclasses.field(default_factory=dict)

    def time(self, steps=1):
        """So many steps, as a number or with its unit."""
        return f"{self.step * steps:.12g} {self.unit}" if self.unit else self.step * steps


def body(name, mass, x, v, more=""):
    return f'[[particles.body]]\nname = "{name}"\nmass = {mass}\nx = {list(x)}\nv = {list(v)}\n{more}'


def table(place, keys):
    return f"[[{place}]]\n" + "\n".join(keys.split("; ")) + "\n"


def forces(*lists):
    return '[hamiltonian]\ntype = "kinetic_potential"\n' + "".join(table("hamiltonian.force", keys) for keys in lists)


def fields(*lists, kind="charged_particles"):
    return f'[hamiltonian]\ntype = "{kind}"\n' + "".join(table("hamiltonian.field", keys) for keys in lists)


def constrained(place, keys, *more):
    """Under a weight and a weak spring, so that everything that is free to move does."""
    motion = forces(WEIGHT, "type = 'harmonic_field'; k = 0.5", *more) + table("hamiltonian.constraint", keys)
    return Case(place, motion, rivals=WHOLE_STEPS)


WEIGHT = "type = 'uniform_field'; acceleration = [0.0, 0.3, -1.0]"
SPRING = "type = 'harmonic_field'; k = 1"

PAIR = body("a", 1.0, (0.5, 0.1, 0.0), (0.0, 0.2, 0.1)) + body("b", 2.0, (-0.3, 0.2, 0.1), (0.1, 0.0, -0.1))

CHARGES = (body("a", 1.0, (1.1, 0.1, 0.0), (0.0, 0.2, 0.1), "charge = 1.0\n") +
           body("b", 2.0, (-0.9, 0.6, 0.2), (0.1, 0.0, -0.1), "charge = -1.0\n"))
SOLENOID = "type = 'uniform_electromagnetic'; B = [0.0, 0.3, 2.0]; E = [0.1, 0.0, 0.05]"

PLANETS = (body("star", 1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)) +
           body("inner", 1e-3, (1.0, 0.0, 0.0), (0.0, 1.0, 0.05)) +
           body("outer", 1e-3, (0.0, -2.0, 0.1), (0.7, 0.0, 0.0)))
GRAVITY = "type = 'gravity'; G = 1"

ROW = "".join(body(f"q{k}", 1.0, (x, 0.0, 0.0), (v, 0.0, 0.0))
              for k, (x, v) in enumerate([(0.1, 0.2), (-0.1, 0.0), (0.2, -0.1), (0.05, 0.1)]))

# Three that a constraint can tie: on a bar of length 2, with the middle of it between them.
BAR = (body("one", 1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)) + body("two", 0.5, (1.0, 0.0, 0.0), (0.0, 0.1, 0.0)) +
       body("three", 1.0, (2.0, 0.0, 0.0), (0.0, 0.2, 0.0)))
BENT = (body("one", 1.0, (1.0, 0.0, 0.0), (0.0, 0.0, 0.1)) + body("two", 1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.1)) +
        body("three", 1.0, (0.0, 1.0, 0.0), (0.0, 0.0, 0.1)))
BEAD = body("bead", 1.0, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)) + body("free", 1.0, (0.0, 2.0, 0.0), (0.1, 0.0, 0.0))

# Four charged atoms of two types about a corner of their box. In all scenes with a range pairs stay on one side of it:
# some derivative of the force jumps there, and truth in 113 bits is dear where it does.
SALT_FILE = """4
Lattice="6 0 0 0 6 0 0 0 6" Properties=species:S:1:pos:R:3:velo:R:3:mass:R:1:charge:R:1 pbc="T T T"
A 5.80 0.10 5.70 0.2 0.1 0.0 1.0 0.3
B 0.90 0.15 5.90 -0.1 0.0 0.2 1.5 -0.3
B 0.30 1.10 5.75 0.0 -0.2 0.1 1.5 -0.3
A 0.35 0.50 0.65 0.1 0.1 -0.2 1.0 0.3
"""
SALT = '[particles]\nstructure = "salt.xyz"\nfile_units = "lj"\n'
LENNARD_JONES = "type = 'lennard_jones'; epsilon = 1; sigma = 1; cutoff = 2.5"


def salt(*lists, **options):
    return Case(SALT, forces(*lists), step=0.002, files={"salt.xyz": SALT_FILE}, **options)


# A chain of five beads that bends and twists, with a bond of each kind, across the faces of its box.
CHAIN_FILE = """five beads

5 atoms
4 bonds
3 angles
2 dihedrals
1 impropers
1 atom types
2 bond types
2 angle types
2 dihedral types
1 improper types

0 8 xlo xhi
0 8 ylo yhi
0 8 zlo zhi

Masses

1 1.0

Atoms # molecular

1 1 1 3.550 4.000 7.200
2 1 1 2.902 4.541 7.550
3 1 1 2.485 3.807 7.900
4 1 1 3.282 3.528 0.250
5 1 1 3.415 4.361 0.600

Velocities

1 0.1 0.0 0.2
2 0.0 -0.1 0.1
3 -0.1 0.1 0.0
4 0.1 0.0 -0.1
5 0.0 0.1 -0.1

Bonds

1 1 1 2
2 2 2 3
3 1 3 4
4 2 4 5

Angles

1 1 1 2 3
2 2 2 3 4
3 1 3 4 5

Dihedrals

1 1 1 2 3 4
2 2 2 3 4 5

Impropers

1 1 1 2 3 4

Bond Coeffs # hybrid

1 harmonic 20.0 1.0
2 morse 20.0 2.0 1.0

Angle Coeffs # hybrid

1 harmonic 5.0 120.0
2 cosine 1.0

Dihedral Coeffs # hybrid

1 charmm 0.5 3 60 0.0
2 opls 0.4 -0.2 0.6 0.1

Improper Coeffs # hybrid

1 harmonic 5.0 70.0
"""
CHAIN = '[particles]\nstructure = "chain.data"\nfile_units = "lj"\n'


def system(keys, **options):
    options = {"method": "rk4", "flow": "dop853", "rivals": ("rk4", "heun"), **options}
    return Case("", "[system]\n" + "\n".join(keys.split("; ")) + "\n", energy=False, particles=False, **options)


STIFF = {"method": "backward_euler", "flow": "bdf", "rivals": ("backward_euler", "trapezoidal")}

# Two rigid bodies about each other, and a point.
ROCKS = ("[[particles.rigid_body]]\nname = 'one'\nmass = 1.0\nx = [0.0, 0.0, 0.0]\nv = [0.0, -0.2, 0.0]\n"
         "inertia = [0.02, 0.03, 0.04]\nangular_velocity = [0.3, 0.2, 1.0]\n"
         "[[particles.rigid_body]]\nname = 'two'\nmass = 0.3\nx = [1.0, 0.0, 0.0]\nv = [0.0, 0.9, 0.1]\n"
         "inertia = [0.002, 0.003, 0.003]\nangular_velocity = [0.0, 0.5, 1.0]\naxis = [0, 1, 0]\nangle = 0.3\n" +
         body("stone", 0.001, (0.0, -2.0, 0.1), (0.7, 0.0, 0.0)))
PULL = "type = 'gravity_of_bodies'; G = 1"
SPHERES = ("[particles]\nbox = [10, 8, 20]\n" +
           body("one", 1.0, (1.0, 1.0, 0.0), (0.5, -1.5, 0.0), "radius = 0.5\n") +
           body("other", 2.0, (3.0, 1.0, 0.25), (-0.5, -4.5, 0.0), "radius = 0.75\n"))
# What the second degree of the first leaves out, about its own axis.
OWN_AXIS = "type = 'oblateness'; J4 = -0.05; radius = 0.2; axis = [0.1, 0.0, 1.0]; frame = 'body'; G = 1"
SPHERES_IN_SHEET = ('[hamiltonian]\ntype = "shearing_sheet"\nOmega = 1\n' +
                    table("hamiltonian.force", "type = 'hard_spheres'; restitution = 0.5") +
                    table("hamiltonian.force", GRAVITY))

HAMILTONIANS = {
    "kinetic_potential": Case(PLANETS, forces(GRAVITY)),
    "wisdom_holman": Case(PLANETS, '[hamiltonian]\ntype = "wisdom_holman"\nG = 1\n'),
    "charged_particles": Case(CHARGES, fields(SOLENOID)),
    "k_symplectic": Case(CHARGES, fields(SOLENOID, kind="k_symplectic"), rivals=WHOLE_STEPS),
    "shearing_sheet": Case(PLANETS, '[hamiltonian]\ntype = "shearing_sheet"\nOmega = 0.5\nOmega_z = 0.8\n' +
                           table("hamiltonian.force", GRAVITY)),
}

# A of the field of a weak dipole below the charges, on 10 x 10 x 10 places 0.6 apart.
GRID_FILE = (pathlib.Path(__file__).parent / "grid.h5").read_bytes()

FIELDS = {
    "uniform_electromagnetic": Case(CHARGES, fields(SOLENOID)),
    "magnetic_gradient": Case(CHARGES, fields("type = 'magnetic_gradient'; B0 = 1; gradient = 0.1")),
    "magnetic_mirror": Case(CHARGES, fields("type = 'magnetic_mirror'; B0 = 3; radius = 1.5; distance = 2")),
    "magnetic_dipole": Case(CHARGES, fields("type = 'magnetic_dipole'; moment = [0.0, 0.1, -2.0]")),
    "tokamak": Case(CHARGES, fields("type = 'tokamak'; B0 = 1; R0 = 1; safety = 2")),
    "penning_trap": Case(CHARGES, fields("type = 'penning_trap'; B0 = 5; gradient = 2")),
    "plane_wave": Case(CHARGES, fields("type = 'plane_wave'; E0 = [0.3, 0.1, 0.0]; omega = 3; c = 2")),
    "field_grid": Case(CHARGES, fields("type = 'field_grid'; file = 'grid.h5'"), files={"grid.h5": GRID_FILE}),
    "radio_frequency_gap": Case(CHARGES, fields(
        "type = 'radio_frequency_gap'; E0 = 0.5; length = 0.4; omega = 3; c = 5")),
}

BLOCK = ("[particles]\ntype = 'block'\ncells = [1, 1, 1]\nsize = [1, 1, 1]\ndensity = 1\nstretch = [1.2, 0.9, 1.05]\n"
         "angular_velocity = [1.0, 0.3, 2.0]\n")

FORCES = {
    "gravity": Case(PLANETS, forces("type = 'gravity'; G = 1; softening = 0.01")),
    "gravity_of_bodies": Case(ROCKS, forces(PULL)),
    "oblateness": Case(PLANETS, forces(GRAVITY, "type = 'oblateness'; J2 = 0.01; J4 = -0.001; radius = 0.1; G = 1")),
    "gr_potential": Case(PLANETS, forces(GRAVITY, "type = 'gr_potential'; c = 30; G = 1")),
    "post_newtonian": Case(PLANETS, forces(GRAVITY, "type = 'post_newtonian'; c = 30; G = 1"), method="rk4",
                           rivals=("rk4", "heun"), energy=False),
    "uniform_field": Case(PAIR, forces(WEIGHT, SPRING)),
    "oscillating_field": Case(PAIR, forces(
        "type = 'oscillating_field'; acceleration = [0.1, 0.0, 0.2]; omega = 3.0; phase = 0.2", SPRING)),
    "harmonic_field": Case(PAIR, forces(SPRING)),
    "henon_heiles": Case(PAIR, forces("type = 'henon_heiles'; omega = 1.0; length = 2.0")),
    "anharmonic_chain": Case(ROW, forces("type = 'anharmonic_chain'; k = 1; cubic = 0.25; quartic = 2")),
    "fermi_pasta_ulam": Case(ROW, forces("type = 'fermi_pasta_ulam'; k = 100")),
    "lennard_jones": salt(LENNARD_JONES),
    "wca": salt("type = 'wca'; epsilon = 0.1; sigma = 1.4"),
    "morse": salt("type = 'morse'; depth = 1; a = 2; length = 1.1; cutoff = 2.5; cutoff_style = 'switch_c4'"),
    "buckingham": salt("type = 'buckingham'; A = 1000; rho = 0.3; C = 1; cutoff = 2.5; cutoff_style = 'switch_c2'"),
    "reaction_field": salt(LENNARD_JONES, "type = 'reaction_field'; cutoff = 2.5"),
    # Of one sign: two that attract each other would nearly meet.
    "coulomb": Case(CHARGES.replace("charge = -1.0", "charge = 1.0"), forces("type = 'coulomb'", SPRING)),
    "ewald": salt(LENNARD_JONES, "type = 'ewald'; cutoff = 2.5"),
    "particle_mesh_ewald": salt(LENNARD_JONES, "type = 'particle_mesh_ewald'; cutoff = 3.0; relative_error = 1e-4; order = 8"),
    "harmonic_bond": Case(PAIR, forces("type = 'harmonic_bond'; chain = ['a', 'b']; k = 10; length = 0.7")),
    "tether": Case(PAIR, forces("type = 'tether'; bodies = 'all'; k = 10; length = 0.2; point = [0.0, 0.0, 0.3]")),
    "bonded": Case(CHAIN, forces("type = 'bonded'"), step=0.01, files={"chain.data": CHAIN_FILE}),
    "hyperelastic": Case(BLOCK, forces("type = 'hyperelastic'; material = 'neo_hookean'; lambda = 1; mu = 0.8")),
    "traction": Case(BLOCK, forces("type = 'hyperelastic'; young_modulus = 2; poisson_ratio = 0.3",
                                   "type = 'traction'; surface = 'x_high'; traction = [0.1, 0.0, 0.05]")),
    "tides": Case(ROCKS.replace("angular_velocity = [0.3", "love_number = 0.4\nradius = 0.2\ntide_lag = 0.01\nangular_velocity = [0.3"),
                  forces(PULL, "type = 'tides'; G = 1"), rivals=FORWARD),
    "linear_drag": Case(PAIR, forces(SPRING, "type = 'linear_drag'; rate = 0.1"), rivals=FORWARD),
    "hard_spheres": Case(SPHERES, SPHERES_IN_SHEET, rivals=FORWARD),
}

THERMOSTATS = {
    "langevin": Case(PAIR, forces(SPRING) + "[hamiltonian.thermostat]\ntype = 'langevin'\ntemperature = 1\n"
                     "friction = 0.5\nseed = 7\n", method="BAOAB"),
    "velocity_rescaling": Case(PAIR, forces(SPRING) + "[hamiltonian.thermostat]\ntype = 'velocity_rescaling'\n"
                               "temperature = 1\nrelaxation_time = 0.5\nseed = 7\n"),
}

DECORATORS = {
    "projection": Case(PLANETS, forces(GRAVITY), around='[integrator.projection]\nonto = ["energy", "angular_momentum"]\n'),
}

# A molecule of four that is no plane, under a weak spring: a chain whose bonds and ends of angles are held.
BRANCH_FILE = """four beads

4 atoms
3 bonds
2 angles
2 atom types
1 bond types
1 angle types

0 8 xlo xhi
0 8 ylo yhi
0 8 zlo zhi

Masses

1 1.0
2 0.5

Atoms # molecular

1 1 2 3.0 3.0 3.0
2 1 1 4.0 3.0 3.0
3 1 1 4.0 4.0 3.0
4 1 2 4.0 4.0 4.0

Velocities

1 0.1 0.0 0.2
2 0.0 -0.1 0.1
3 -0.1 0.1 0.0
4 0.1 0.0 -0.1

Bonds

1 1 1 2
2 1 2 3
3 1 3 4

Angles

1 1 1 2 3
2 1 2 3 4

Bond Coeffs # harmonic

1 20.0 1.0

Angle Coeffs # harmonic

1 5.0 90.0
"""
BRANCH = '[particles]\nstructure = "branch.data"\nfile_units = "lj"\n'
WATER = ("[particles]\ntype = 'water_box'\nmodel = 'spc_fw'\nmolecules = 2\ndensity = '0.3 g/cm^3'\n"
         "temperature = '100 K'\n")


def held(what):
    """A constraint that finds its particles in a structure, in which it leaves something to move."""
    return Case(BRANCH, forces("type = 'bonded'") + table("hamiltonian.constraint", f"type = '{what}'"),
                rivals=WHOLE_STEPS, step=0.01, files={"branch.data": BRANCH_FILE})


def water(constraint=""):
    """Flexible water, or with a constraint; in units of its own."""
    more = table("hamiltonian.constraint", constraint) if constraint else ""
    return Case(WATER, forces("type = 'bonded'") + more, units="molecular", step=0.2, unit="fs",
                rivals=WHOLE_STEPS if constraint else RIVALS)


TIED = "type = 'distance'; pairs = [['one', 'two'], ['two', 'three']]"

CONSTRAINTS = {
    "distance": constrained(BAR, TIED),
    "rigid_bar": constrained(BAR, "type = 'rigid_bar'; bodies = ['one', 'two', 'three']"),
    "angle": constrained(BENT, "type = 'angle'; triples = [['one', 'two', 'three']]",
                         "type = 'harmonic_bond'; pairs = [['one', 'two'], ['two', 'three']]; k = 50; length = 1"),
    "bonds": held("bonds"),
    "hydrogen_bonds": water("type = 'hydrogen_bonds'"),
    "bonds_and_angles": held("bonds_and_angles"),
    "rigid_molecules": held("rigid_molecules"),
    "fixed": constrained(BEAD, "type = 'fixed'; bodies = ['bead']"),
    "on_sphere": constrained(BEAD, "type = 'on_sphere'; bodies = ['bead']"),
    "on_plane": constrained(BEAD, "type = 'on_plane'; bodies = ['bead']; normal = [1, 0, 1]"),
    "on_cylinder": constrained(BEAD, "type = 'on_cylinder'; bodies = ['bead']"),
    "on_circle": constrained(BEAD, "type = 'on_circle'; bodies = ['bead']; normal = [0, 1, 0]"),
    "on_line": constrained(BEAD, "type = 'on_line'; bodies = ['bead']; direction = [1, 0, 1]"),
}

# How equations of constraints are solved.
SOLVERS = {
    "newton": constrained(BAR, TIED + "; solver = 'newton'"),
    "rattle": constrained(BAR, TIED + "; solver = 'rattle'; tolerance = 1e-12; iterations = 1000"),
    "settle": water("type = 'rigid_molecules'; solver = 'settle'"),
    "m_shake": water("type = 'rigid_molecules'; solver = 'm_shake'"),
    "p_shake": constrained(BAR, TIED + "; solver = 'p_shake'; tolerance = 1e-12; iterations = 1000"),
    "lincs": constrained(BAR, TIED + "; solver = 'lincs'; order = 30; iterations = 10"),
    "p_lincs": constrained(BAR, TIED + "; solver = 'p_lincs'; order = 30; iterations = 10"),
}


def action(keys):
    """A system by its Lagrangian, under methods that make its action stationary."""
    rivals = ("variational_midpoint", "galerkin_gauss_2")
    return dataclasses.replace(system(keys, method="galerkin_gauss_2", step=0.05, rivals=rivals), energy=True)


SYSTEMS = {
    "robertson": system("type = 'robertson'", step=0.01, **STIFF),
    "rc_ladder": system("type = 'rc_ladder'; stages = 4; spread = 100; omega = 1; start = [1.0, 0.5, 0.2, 0.1]",
                        **STIFF),
    "heat_line": system("type = 'heat_line'; points = 6", **STIFF),
    "lorenz": system("type = 'lorenz'", step=0.01),
    "prothero_robinson": system("type = 'prothero_robinson'; lambda = -100", **STIFF),
    "forced_damped_oscillator": system("type = 'forced_damped_oscillator'"),
    "nonseparable_oscillator": dataclasses.replace(system("type = 'nonseparable_oscillator'; position = 0.5"),
                                                   energy=True),
    "schwarzschild": dataclasses.replace(system("type = 'schwarzschild'; r = 30.0; angular_momentum = 6.0",
                                                method="semiexplicit_4", step=1.0,
                                                rivals=("semiexplicit_4", "semiexplicit_2")), energy=True),
    "kerr": dataclasses.replace(system("type = 'kerr'; r = 30.0; angular_momentum = 6.0", method="semiexplicit_4",
                                       step=1.0, rivals=("semiexplicit_4", "semiexplicit_2")), energy=True),
    "turning_frame": system("type = 'turning_frame'; drive = 1.5", method="magnus_4", flow="rkmk_dormand_prince_5",
                            rivals=("magnus_4", "magnus_2")),
    "pendulum": action("type = 'pendulum'"),
    "double_pendulum": action("type = 'double_pendulum'; start = [0.5, 0.2, 0.0, 0.0]"),
    "polar_kepler": action("type = 'polar_kepler'"),
    "weber": action("type = 'weber'"),
    "darwin": dataclasses.replace(action("type = 'darwin'"), step=0.005),  # in 113 bits ten units of time take a minute
    "lorentz_pairs": action("type = 'lorentz_pairs'"),
}


def seen(keys, case):
    """The same scene with a watcher."""
    return dataclasses.replace(case, watch=table("every", keys))


MONITORS = {
    "energy": Case(PLANETS, forces(GRAVITY)),
    "momentum": seen("type = 'momentum'; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "angular_momentum": seen("type = 'angular_momentum'; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "center_of_mass": seen("type = 'center_of_mass'; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "spin": seen("type = 'spin'; body = 'two'; G = 1; steps = {cadence}", Case(ROCKS, forces(PULL, OWN_AXIS))),
    "orientation_defect": seen("type = 'orientation_defect'; steps = {cadence}", Case(ROCKS, forces(PULL))),
    "turning_energy": seen("type = 'turning_energy'; steps = {cadence}", Case(ROCKS, forces(PULL))),
    "elements": seen("type = 'elements'; G = 1; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "resonance_angle": seen("type = 'resonance_angle'; bodies = ['inner', 'outer']; p = 1; q = 2; pericenter = 'inner'; "
                            "G = 1; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "closest_approach": seen("type = 'closest_approach'; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "temperature": seen("type = 'temperature'; steps = {cadence}", salt(LENNARD_JONES)),
    "pressure": seen("type = 'pressure'; steps = {cadence}", salt(LENNARD_JONES)),
    "radial_distribution": seen("type = 'radial_distribution'; bins = 10; types = ['A', 'B']; steps = {cadence}",
                                salt(LENNARD_JONES)),
    "dihedrals": seen("type = 'dihedrals'; bins = 12; quadruples = [['atom_1', 'atom_2', 'atom_3', 'atom_4']]; "
                      "steps = {cadence}",
                      Case(CHAIN, forces("type = 'bonded'"), step=0.01, files={"chain.data": CHAIN_FILE})),
    "dipole_moment": seen("type = 'dipole_moment'; steps = {cadence}", salt(LENNARD_JONES)),
    "dielectric_constant": seen("type = 'dielectric_constant'; temperature = '300 K'; steps = {cadence}", water()),
    "mean_square_displacement": seen("type = 'mean_square_displacement'; length = 4; origins = 2; steps = {cadence}",
                                     salt(LENNARD_JONES)),
    "velocity_autocorrelation": seen("type = 'velocity_autocorrelation'; length = 4; origins = 2; steps = {cadence}",
                                     salt(LENNARD_JONES)),
    "velocity_dispersion": seen("type = 'velocity_dispersion'; Omega = 1; steps = {cadence}",
                                Case(SPHERES, SPHERES_IN_SHEET, rivals=FORWARD)),
    "filling_factor": seen("type = 'filling_factor'; steps = {cadence}",
                           Case(SPHERES, SPHERES_IN_SHEET, rivals=FORWARD)),
    "viscosity": seen("type = 'viscosity'; Omega = 1; G = 1; steps = {cadence}",
                      Case(SPHERES, SPHERES_IN_SHEET, rivals=FORWARD)),
    "wakes": seen("type = 'wakes'; Omega = 1; shortest = 4; steps = {cadence}",
                  Case(SPHERES, SPHERES_IN_SHEET, rivals=FORWARD)),
    "variables": seen("type = 'variables'; variable = 'z'; steps = {cadence}", system("type = 'lorenz'", step=0.01)),
    "canonical_momentum": seen("type = 'canonical_momentum'; steps = {cadence}", Case(CHARGES, fields(SOLENOID))),
    "magnetic_moment": seen("type = 'magnetic_moment'; steps = {cadence}", Case(CHARGES, fields(SOLENOID))),
    "momentum_map": seen("type = 'momentum_map'; symmetry = 'rotation'; steps = {cadence}",
                         action("type = 'polar_kepler'")),
    "field_momentum": seen("type = 'field_momentum'; steps = {cadence}", action("type = 'darwin'")),
    "constraint_residual": seen("type = 'constraint_residual'; steps = {cadence}",
                                constrained(BAR, TIED)),
    "shadow_hamiltonian": seen("type = 'shadow_hamiltonian'; orders = [4, 8]; steps = 1",
                               Case(PLANETS, forces(GRAVITY))),
    "megno": seen("type = 'megno'; seed = 3; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "lyapunov": seen("type = 'lyapunov'; vectors = 2; steps = {cadence}", Case(PLANETS, forces(GRAVITY))),
    "trajectory": Case(PLANETS, forces(GRAVITY)),
    "checkpoint": Case(PLANETS, forces(GRAVITY)),
    # Both end the run between its half and its end.
    "escape": Case(body("here", 1.0, (0.0, 0.0, 0.0), (-1.0, 0.0, 0.0)) +
                   body("there", 1.0, (1.0, 0.0, 0.0), (1.0, 0.0, 0.0)), forces(GRAVITY),
                   stop=table("stop", "type = 'escape'; distance = 1.2; steps = 1")),
    "collision": Case(body("here", 1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)) +
                      body("there", 1.0, (1.0, 0.1, 0.0), (-1.0, 0.0, 0.0)), forces(
                          "type = 'gravity'; G = 0.1; softening = 0.1"),
                      stop=table("stop", "type = 'collision'; distance = 0.2; steps = 1")),
}

BUILDERS = {
    "lattice": Case("[particles]\ntype = 'lattice'\nlattice = 'sc'\ncells = [2, 2, 1]\nconstant = 2\nmass = 1\n"
                    "temperature = 0.1\n", forces(LENNARD_JONES), step=0.002),
    "liquid": Case("[particles]\ntype = 'liquid'\nparticles = 4\ndensity = 0.1\nmass = 1\ntemperature = 0.1\n",
                   forces(LENNARD_JONES), step=0.002),
    "polymer_chains": Case("[particles]\ntype = 'polymer_chains'\nchains = 2\nbeads = 4\ndensity = 0.1\nmass = 1\n"
                           "bending = 1\ntemperature = 0.5\n", forces("type = 'bonded'"), step=0.002),
    "water_box": water(),
    "ionic_crystal": Case("[particles]\ntype = 'ionic_crystal'\ncells = [1, 1, 1]\nions = ['A', 'B']\nmasses = [1, 2]\n"
                          "charge = 0.1\nconstant = 2.4\nepsilon = [1, 1]\nsigma = [1, 1]\ntemperature = 0.1\n",
                          forces("type = 'lennard_jones'; cutoff = 2.5", "type = 'reaction_field'; cutoff = 2.5"),
                          step=0.002),
    "block": Case(BLOCK, forces("type = 'hyperelastic'; lambda = 1; mu = 0.8")),
    "ring_patch": Case("[particles]\ntype = 'ring_patch'\nsize = [10, 8, 20]\nOmega = 1\nsmallest = 0.4\nlargest = 0.8\n"
                       "density = 0.5\noptical_depth = 0.1\n", SPHERES_IN_SHEET, rivals=FORWARD),
}

# A list that the program has of each kind, the table of cases for it, and what a page says of it.
KINDS = {
    "hamiltonians": (HAMILTONIANS, "Hamiltonians"),
    "forces": (FORCES, "Forces"),
    "fields": (FIELDS, "Fields of charges"),
    "thermostats": (THERMOSTATS, "Thermostats"),
    "constraints": (CONSTRAINTS, "Constraints"),
    "solvers": (SOLVERS, "Solvers of constraints"),
    "systems": (SYSTEMS, "First-order systems"),
    "decorators": (DECORATORS, "Decorators of integrators"),
    "monitors": (MONITORS, "Monitors, writers and stops"),
    "builders": (BUILDERS, "Builders of particles"),
}
# Lists of what is no part to be walked: units, and methods, each of which is measured in docs/methods.md.
OTHER_LISTS = {"units", "methods"}
