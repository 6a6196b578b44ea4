"""Energies by OpenMM's reference platform, which is in doubles: chain.data term by term, and how pairs end.

    python3 -m venv openmm && openmm/bin/pip install openmm && openmm/bin/python make.py

The numbers that it prints stand in tests/forces/cutoffs_of_others_test.cpp and tests/scene/special_pairs_test.cpp, in nm,
kJ/mol and e.
"""

import itertools
import math
import pathlib

import openmm

KCAL, ANGSTROM = 4.184, 0.1
# Pairs with parameters of their own: particles from 1, product of charges, sigma, epsilon.
OWN = [((1, 4), 0.07, 0.31, 0.4), ((2, 6), -0.05, 0.28, 0.9), ((3, 6), 0.0, 0.3, 0.0)]


def energy(system, positions, groups=-1):
    """Of these groups of forces [kJ/mol]."""
    context = openmm.Context(system, openmm.VerletIntegrator(0.001), openmm.Platform.getPlatformByName("Reference"))
    context.setPositions(positions)
    return context.getState(getEnergy=True, groups=groups).getPotentialEnergy()._value


def sections(file):
    """The rows of each section, as numbers."""
    found, name = {}, ""
    for line in file.read_text().splitlines()[1:]:
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0][0].isalpha():
            name = " ".join(words)
            found[name] = []
        elif name:
            found[name].append([float(word) for word in words])
    return found


def own_pair(product, sigma, epsilon, r):
    """Of one exception, by itself."""
    system = openmm.System()
    force = openmm.NonbondedForce()
    for _ in range(2):
        system.addParticle(1)
        force.addParticle(0, 1, 0)
    force.addException(0, 1, product, sigma, epsilon)
    system.addForce(force)
    return energy(system, [(0, 0, 0), (r, 0, 0)])


def chain():
    data = sections(pathlib.Path(__file__).parent / "chain.data")
    atoms = data["Atoms"]
    positions = [tuple(ANGSTROM * x for x in row[4:7]) for row in atoms]
    system = openmm.System()
    for row in atoms:
        system.addParticle(data["Masses"][int(row[2]) - 1][1])
    system.setDefaultPeriodicBoxVectors((4, 0, 0), (0, 4, 0), (0, 0, 4))

    bonds, angles, torsions = openmm.HarmonicBondForce(), openmm.HarmonicAngleForce(), openmm.PeriodicTorsionForce()
    for _, kind, i, j in data["Bonds"]:
        k, length = data["Bond Coeffs"][int(kind) - 1][1:]
        bonds.addBond(int(i) - 1, int(j) - 1, length * ANGSTROM, 2 * k * KCAL / ANGSTROM**2)
    for _, kind, i, j, k in data["Angles"]:
        stiffness, angle = data["Angle Coeffs"][int(kind) - 1][1:]
        angles.addAngle(int(i) - 1, int(j) - 1, int(k) - 1, math.radians(angle), 2 * stiffness * KCAL)
    for _, kind, *four in data["Dihedrals"]:
        k, n, phase, _ = data["Dihedral Coeffs"][int(kind) - 1][1:]
        torsions.addTorsion(*(int(i) - 1 for i in four), int(n), math.radians(phase), k * KCAL)
    for group, force in enumerate((bonds, angles, torsions)):
        force.setForceGroup(group)
        system.addForce(force)
    for group, name in enumerate(("bonds", "angles", "dihedrals")):
        print(f"{name:40s} {energy(system, positions, 1 << group):.15g}")

    def pairs(method, own=None, one_four=(0.5, 5 / 6), charges=True, depths=True):
        """All pairs; with the cutoffs of OpenMM where a method is given."""
        alone = openmm.System()
        force = openmm.NonbondedForce()
        for row in atoms:
            alone.addParticle(1)
            _, epsilon, sigma = data["Pair Coeffs"][int(row[2]) - 1]
            force.addParticle(row[3] if charges else 0, sigma * ANGSTROM, epsilon * KCAL if depths else 0)
        force.createExceptionsFromBonds([(int(b[2]) - 1, int(b[3]) - 1) for b in data["Bonds"]], one_four[1],
                                        one_four[0])
        for (i, j), product, sigma, epsilon in own or []:
            force.addException(i - 1, j - 1, product if charges else 0, sigma, epsilon if depths else 0, True)
        force.setNonbondedMethod(method)
        if method != openmm.NonbondedForce.NoCutoff:
            force.setCutoffDistance(0.5)
            force.setReactionFieldDielectric(78.3)
            force.setUseSwitchingFunction(True)
            force.setSwitchingDistance(0.4)
            force.setUseDispersionCorrection(False)
        alone.addForce(force)
        return energy(alone, positions)

    for kind in ({"charges": False}, {"depths": False}):
        name = "charges" if "depths" in kind else "Lennard-Jones"
        one_four = pairs(openmm.NonbondedForce.NoCutoff, **kind) - pairs(openmm.NonbondedForce.NoCutoff, None, (0, 0),
                                                                          **kind)
        print(f"{'1-4 ' + name:40s} {one_four:.15g}")
        print(f"{name + ', cutoff 0.5, switch 0.4, RF 78.3':40s} "
              f"{pairs(openmm.NonbondedForce.CutoffNonPeriodic, None, (0, 0), **kind):.15g}")
        print(f"{name + ', with 1-4':40s} {pairs(openmm.NonbondedForce.CutoffNonPeriodic, **kind):.15g}")
        print(f"{name + ', with 1-4 and OWN':40s} {pairs(openmm.NonbondedForce.CutoffNonPeriodic, OWN, **kind):.15g}")
    for (i, j), *own in OWN:
        r = math.dist(positions[i - 1], positions[j - 1])
        print(f"{f'OWN {i} {j}, r = {r:.6f}':40s} {own_pair(*own, r):.15g}")


def switch():
    """Two atoms of sigma 0.34 and epsilon 0.996 that end between 0.9 and 1.1."""
    system = openmm.System()
    force = openmm.NonbondedForce()
    for _ in range(2):
        system.addParticle(1)
        force.addParticle(0, 0.34, 0.996)
    force.setNonbondedMethod(openmm.NonbondedForce.CutoffNonPeriodic)
    force.setCutoffDistance(1.1)
    force.setUseSwitchingFunction(True)
    force.setSwitchingDistance(0.9)
    system.addForce(force)
    for r in (0.5, 0.875, 0.9375, 1.0, 1.0625, 1.09375):
        context = openmm.Context(system, openmm.VerletIntegrator(0.001),
                                 openmm.Platform.getPlatformByName("Reference"))
        context.setPositions([(0, 0, 0), (r, 0, 0)])
        state = context.getState(getEnergy=True, getForces=True)
        print(f"switch at {r}: {state.getPotentialEnergy()._value:.15g} {state.getForces()[1][0]._value:.15g}")


def tail():
    """What the correction for dispersion adds for 216 atoms of argon in a box of 2.4."""
    for switched in (False, True):
        system = openmm.System()
        system.setDefaultPeriodicBoxVectors((2.4, 0, 0), (0, 2.4, 0), (0, 0, 2.4))
        force = openmm.NonbondedForce()
        for _ in range(216):
            system.addParticle(1)
            force.addParticle(0, 0.34, 0.996)
        force.setNonbondedMethod(openmm.NonbondedForce.CutoffPeriodic)
        force.setCutoffDistance(1.1)
        force.setUseSwitchingFunction(switched)
        force.setSwitchingDistance(0.9)
        system.addForce(force)
        places = [tuple(0.4 * k for k in cell) for cell in itertools.product(range(6), repeat=3)]
        force.setUseDispersionCorrection(True)
        whole = energy(system, places)
        force.setUseDispersionCorrection(False)
        print(f"tail, switched = {switched}: {whole - energy(system, places):.15g} of {whole:.15g}")


chain()
switch()
tail()
