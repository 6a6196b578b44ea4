"""Lets LAMMPS write data files, and record what it computes of them: see README.md."""

import os
import pathlib
import sys

import numpy
from lammps import lammps

HERE = pathlib.Path(__file__).parent


# write_data leaves out the coefficients of hybrid styles; these are those of molecule(), in the form of read_data.
COEFFICIENTS = """
Bond Coeffs # hybrid

1 harmonic 310.0 1.526
2 morse 95.0 2.1 1.41

Angle Coeffs # hybrid

1 harmonic 63.0 112.4
2 cosine 7.5
3 harmonic 50.0 109.5

Dihedral Coeffs # hybrid

1 charmm 1.4 3 60 0.0
2 harmonic 0.9 1 2
3 harmonic 1.1 -1 3
4 multi/harmonic 1.7 -2.1 0.3 3.3 -0.4
5 opls 1.411 -0.271 3.145 0.5
6 charmm 0.2 2 180 0.0

Improper Coeffs # hybrid

1 harmonic 45.0 35.0
2 cvff 1.3 -1 2
3 cvff 0.7 1 3
"""


def number(value):
    return repr(float(value))


def record(lmp, name, quantities):
    lines = [f"{key} {number(value)}\n" for key, value in quantities.items()]
    (HERE / f"{name}.energies.txt").write_text("# name, energy in the units of the file\n" + "".join(lines))


def by_atom(lmp, name):
    """A column in the order of the atoms' ids."""
    own = lmp.extract_global("nlocal")
    return lmp.numpy.extract_atom(name)[:own][numpy.argsort(lmp.numpy.extract_atom("id")[:own])]


def per_style(lmp, identifier, styles):
    """Energies of the styles of a hybrid; LAMMPS lists them as the input does."""
    values = lmp.extract_compute(identifier, 0, 1)
    return {f"{identifier}.{style}": values[k] for k, style in enumerate(styles)}


def molecule():
    """Seven atoms in a twisted chain under every style that is read; units real."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    bonds, angles = ["harmonic", "morse"], ["harmonic", "cosine"]
    dihedrals, impropers = ["charmm", "harmonic", "multi/harmonic", "opls"], ["harmonic", "cvff"]
    styles = f"""
units real
atom_style full
boundary p p p
pair_style lj/cut/coul/cut 9.0
bond_style hybrid {" ".join(bonds)}
angle_style hybrid {" ".join(angles)}
dihedral_style hybrid {" ".join(dihedrals)}
improper_style hybrid {" ".join(impropers)}"""
    lmp.commands_string(f"""{styles}
region cell block -10 14 2 25 -12.5 12.5
create_box 2 cell bond/types 2 angle/types 3 dihedral/types 6 improper/types 3 &
  extra/bond/per/atom 4 extra/angle/per/atom 6 extra/dihedral/per/atom 8 extra/improper/per/atom 4 extra/special/per/atom 12
mass 1 12.011
mass 2 15.9994
create_atoms 1 single 13.1 10.0 0.2
create_atoms 2 single -9.7 10.7 1.1
create_atoms 1 single -8.4 9.8 1.4
create_atoms 1 single -7.3 10.6 2.3
create_atoms 2 single -6.2 9.9 1.5
create_atoms 1 single -5.1 10.9 0.9
create_atoms 1 single -8.6 8.9 2.6
set atom 1*7 mol 1
set atom 1 charge 0.25
set atom 2 charge -0.43
set atom 3 charge 0.18
set atom 5 charge -0.5
set atom 6 charge 0.5
set atom 1 image -1 0 0
set atom 5 image 0 1 -2
velocity all create 300 4711 loop all
pair_coeff 1 1 0.086 3.4
pair_coeff 2 2 0.17 3.1
pair_coeff 1 2 0.11 3.3
bond_coeff 1 harmonic 310.0 1.526
bond_coeff 2 morse 95.0 2.1 1.41
angle_coeff 1 harmonic 63.0 112.4
angle_coeff 2 cosine 7.5
angle_coeff 3 harmonic 50.0 109.5
dihedral_coeff 1 charmm 1.4 3 60 0.0
dihedral_coeff 2 harmonic 0.9 1 2
dihedral_coeff 3 harmonic 1.1 -1 3
dihedral_coeff 4 multi/harmonic 1.7 -2.1 0.3 3.3 -0.4
dihedral_coeff 5 opls 1.411 -0.271 3.145 0.5
dihedral_coeff 6 charmm 0.2 2 180 0.0
improper_coeff 1 harmonic 45.0 35.0
improper_coeff 2 cvff 1.3 -1 2
improper_coeff 3 cvff 0.7 1 3
special_bonds lj/coul 0.0 0.0 0.5
create_bonds single/bond 1 1 2
create_bonds single/bond 1 2 3
create_bonds single/bond 2 3 4
create_bonds single/bond 1 4 5
create_bonds single/bond 2 5 6
create_bonds single/bond 1 3 7
create_bonds single/angle 1 1 2 3
create_bonds single/angle 2 2 3 4
create_bonds single/angle 3 3 4 5
create_bonds single/angle 1 4 5 6
create_bonds single/angle 2 7 3 4
create_bonds single/dihedral 1 1 2 3 4
create_bonds single/dihedral 2 1 2 3 7
create_bonds single/dihedral 3 2 3 4 5
create_bonds single/dihedral 4 7 3 4 5
create_bonds single/dihedral 5 3 4 5 6
create_bonds single/dihedral 6 1 2 3 4
create_bonds single/improper 1 3 2 4 7
create_bonds single/improper 2 2 4 3 7
create_bonds single/improper 3 4 2 3 7
run 0
""")
    file = HERE / "molecule.data"
    lmp.command(f"write_data {file} pair ij")
    lmp.close()
    file.write_text(file.read_text() + COEFFICIENTS)
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(f"""{styles}
read_data {file}
special_bonds lj/coul 0.0 0.0 0.5
compute bond all bond
compute angle all angle
compute dihedral all dihedral
compute improper all improper
thermo_style custom step pe evdwl ecoul ebond eangle edihed eimp temp
run 0
""")
    for identifier in ("bond", "angle", "dihedral", "improper"):
        lmp.extract_compute(identifier, 0, 1)
    quantities = {key: lmp.get_thermo(key) for key in ("evdwl", "ecoul", "ebond", "eangle", "edihed", "eimp")}
    for identifier, names in (("bond", bonds), ("angle", angles), ("dihedral", dihedrals), ("improper", impropers)):
        quantities.update(per_style(lmp, identifier, names))
    record(lmp, "molecule", quantities)
    lmp.close()


def scripted(name):
    """The chain of charmm.data, by hand, with the coefficients of NAME.in."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    os.chdir(HERE)
    lmp.file(f"{name}.in")
    lmp.commands_string("""
thermo_style custom step pe evdwl ecoul ebond eangle edihed eimp
run 0
""")
    record(lmp, name, {key: lmp.get_thermo(key) for key in ("evdwl", "ecoul", "ebond", "eangle", "edihed", "eimp")})
    lmp.close()


def chains():
    """Three chains of four beads, bonds fene, angles cosine; units lj."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    positions = [(0.5 + 0.9 * bead, 0.5 + 1.04 * chain, 0.3 + 0.35 * (bead % 2)) for chain in range(3) for bead in range(4)]
    atoms = "".join(f"create_atoms {1 + k % 2} single {x} {y} {z}\n" for k, (x, y, z) in enumerate(positions))
    molecules = "".join(f"set atom {4 * c + 1}*{4 * c + 4} mol {c + 1}\n" for c in range(3))
    bonds = "".join(f"create_bonds single/bond 1 {i} {i + 1}\n" for i in range(1, 12) if i % 4)
    angles = "".join(f"create_bonds single/angle 1 {i} {i + 1} {i + 2}\n" for i in range(1, 11) if i % 4 in (1, 2))
    lmp.commands_string(f"""
units lj
atom_style molecular
pair_style lj/cut 1.122462048309373
pair_modify shift yes
bond_style fene
angle_style cosine
region cell block 0 5 0 6 0 7
create_box 2 cell bond/types 1 angle/types 1 extra/bond/per/atom 2 extra/angle/per/atom 2 extra/special/per/atom 6
mass * 1.0
{atoms}{molecules}
pair_coeff * * 1.0 1.0
bond_coeff 1 30.0 1.5 1.0 1.0
angle_coeff 1 1.5
special_bonds fene
{bonds}{angles}
velocity all create 1.0 4711 loop all
comm_modify cutoff 3
neigh_modify exclude none
thermo_style custom step evdwl ebond eangle
thermo_modify norm no
run 0
""")
    record(lmp, "chains", {key: lmp.get_thermo(key) for key in ("evdwl", "ebond", "eangle")})
    lmp.command(f"write_data {HERE}/chains.data")
    lmp.close()


def argon():
    """An fcc crystal of 32 atoms; units metal."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string("""
units metal
atom_style atomic
pair_style lj/cut 5.0
lattice fcc 5.4
region cell block 0 2 0 2 0 2
create_box 1 cell
create_atoms 1 box
mass 1 39.948
pair_coeff 1 1 0.01032 3.405
displace_atoms all random 0.1 0.1 0.1 4711
velocity all create 80 4711 loop all
thermo_style custom step evdwl ke
run 0
""")
    record(lmp, "argon", {key: lmp.get_thermo(key) for key in ("evdwl", "ke")})
    lmp.command(f"write_data {HERE}/argon.data")
    lmp.close()


def pairs():
    """256 atoms shaken from an fcc lattice, at rest, under potentials of pairs; units lj."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string("""
units lj
atom_style atomic
lattice fcc 0.8
region cell block 0 4 0 4 0 4
create_box 1 cell
create_atoms 1 box
mass 1 1.0
pair_style lj/cut 2.5
pair_coeff 1 1 1.0 1.0
displace_atoms all random 0.1 0.1 0.1 4711
thermo_style custom step evdwl pxx pyy pzz pxy pxz pyz
thermo_modify norm no
run 0
""")
    lmp.command(f"write_data {HERE}/pairs.data")
    quantities, forces = {}, []
    for name, style, coefficients, shift in (
        ("morse", "morse 2.3", "1.7 4.5 1.15", "no"),
        ("buckingham", "buck 2.4", "2500.0 0.18 3.1", "no"),
        ("wca", "lj/cut 1.122462048309373", "1.3 1.0", "yes"),
        ("plain", "lj/cut 2.5", "1.0 1.0", "no"),
        ("shifted", "lj/cut 2.5", "1.0 1.0", "yes"),
        ("shifted_force", "lj/smooth/linear 2.5", "1.0 1.0", "no"),
    ):
        lmp.commands_string(f"""
pair_style {style}
pair_coeff 1 1 {coefficients}
pair_modify shift {shift}
run 0
""")
        for key in ("evdwl", "pxx", "pyy", "pzz", "pxy", "pxz", "pyz"):
            quantities[f"{name}.{key}"] = lmp.get_thermo(key)
        forces += [f"{name} {' '.join(number(f) for f in force)}\n" for force in by_atom(lmp, "f")]
    record(lmp, "pairs", quantities)
    (HERE / "pairs.forces.txt").write_text("# potential, force on each atom\n" + "".join(forces))
    lmp.close()


def in_lj(cells):
    """LAMMPS's bench/in.lj with so many cells along each edge, neighbors looked at in every step."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(f"""
units lj
atom_style atomic
lattice fcc 0.8442
region box block 0 {cells} 0 {cells} 0 {cells}
create_box 1 box
create_atoms 1 box
mass 1 1.0
velocity all create 1.44 87287 loop geom
pair_style lj/cut 2.5
pair_coeff 1 1 1.0 1.0 2.5
neighbor 0.3 bin
neigh_modify every 1 delay 0 check yes
fix 1 all nve
run 0
""")
    return lmp


def record_melt(lmp, name):
    """Start, and 100 steps."""
    quantities = {f"0.{key}": lmp.get_thermo(key) for key in ("temp", "pe", "etotal", "press")}
    lmp.command("run 100")
    quantities.update({f"100.{key}": lmp.get_thermo(key) for key in ("temp", "pe", "etotal", "press")})
    record(lmp, name, quantities)
    lmp.close()


def melt():
    """864 atoms."""
    lmp = in_lj(6)
    lmp.command(f"write_data {HERE}/melt.data")
    record_melt(lmp, "melt")


def whole_melt():
    """32 000 atoms as in bench/in.lj: its velocities; its positions are a lattice, atom by atom."""
    lmp = in_lj(20)
    edge = (4 / 0.8442) ** (1 / 3)
    z, y, x = numpy.meshgrid(*[numpy.arange(20)] * 3, indexing="ij")
    corners = numpy.stack([x, y, z], axis=-1).reshape(-1, 1, 3)
    lattice = edge * (corners + numpy.array([(0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)])).reshape(-1, 3)
    if numpy.abs(by_atom(lmp, "x") - lattice).max() > 1e-13:
        sys.exit("LAMMPS numbers the places of a lattice in another way")
    (HERE / "in_lj.velocities").write_bytes(by_atom(lmp, "v").astype("<f8").tobytes())
    record_melt(lmp, "in_lj")


def chain_melt():
    """64 chains of eight beads as in bench/in.chain, molten: lines of a cubic lattice that LAMMPS has shaken for 100 tau."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    sites = [(x, y, z) for z in range(8) for y in range(8) for x in range(8)]
    edge = 0.85 ** (-1 / 3)
    atoms = "".join(f"create_atoms 1 single {edge * (x + 0.5)} {edge * (y + 0.5)} {edge * (z + 0.5)}\n" for x, y, z in sites)
    molecules = "".join(f"set atom {8 * c + 1}*{8 * c + 8} mol {c + 1}\n" for c in range(64))
    bonds = "".join(f"create_bonds single/bond 1 {i} {i + 1}\n" for i in range(1, 512) if i % 8)
    lmp.commands_string(f"""
units lj
atom_style bond
special_bonds fene
bond_style fene
pair_style lj/cut 1.12
pair_modify shift yes
region cell block 0 {8 * edge} 0 {8 * edge} 0 {8 * edge}
create_box 1 cell bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 6
mass 1 1.0
{atoms}{molecules}
pair_coeff 1 1 1.0 1.0
bond_coeff 1 30.0 1.5 1.0 1.0
{bonds}
velocity all create 1.0 4711 loop all
neighbor 0.4 bin
neigh_modify every 1 delay 1 check yes
fix bath all langevin 1.0 1.0 10.0 904297
fix motion all nve
timestep 0.01
run 10000
unfix bath
reset_timestep 0
velocity all zero linear
neigh_modify every 1 delay 0 check yes
thermo_style custom step temp evdwl ebond pe etotal press
run 0
write_data {HERE}/chain_melt.data
""")
    lmp.command("timestep 0.005")
    record_melt(lmp, "chain_melt")


def decane():
    """The liquid of examples/alkane_liquid, with its cutoff, tail and mixing."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(f"""
units real
atom_style molecular
pair_style lj/cut 14.0
bond_style harmonic
angle_style harmonic
dihedral_style opls
pair_modify mix arithmetic tail yes
special_bonds lj 0 0 0
read_data {HERE.parents[2]}/examples/alkane_liquid/decane.data
thermo_style custom step pe evdwl ebond eangle edihed etail
run 0
""")
    record(lmp, "decane", {key: lmp.get_thermo(key) for key in ("pe", "evdwl", "ebond", "eangle", "edihed", "etail")})
    lmp.close()


if __name__ == "__main__":
    molecule()
    scripted("charmm")
    scripted("amber")
    chains()
    argon()
    melt()
    whole_melt()
    chain_melt()
    pairs()
    decane()
    sys.exit(0)
