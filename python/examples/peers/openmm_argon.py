"""The same as ../argon.py, with OpenMM."""

import openmm
from openmm import app, unit

system = openmm.System()
force = openmm.NonbondedForce()
topology = app.Topology()
chain = topology.addChain()
for k in range(3):
    system.addParticle(39.95)
    force.addParticle(0, 0.3350, 0.996)
    topology.addAtom("AR", app.Element.getBySymbol("Ar"), topology.addResidue("AR", chain))
system.addForce(force)

simulation = app.Simulation(topology, system, openmm.VerletIntegrator(0.004))
simulation.context.setPositions([openmm.Vec3(0.5 * k, 0, 0) for k in range(3)])
simulation.reporters.append(app.PDBReporter("argon.pdb", 10))
simulation.step(2500)
positions = simulation.context.getState(getPositions=True).getPositions(asNumpy=True)
print(positions.value_in_unit(unit.nanometer)[:, 0])
