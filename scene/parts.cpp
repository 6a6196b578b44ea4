#include "scene/parts.hpp"

#include "constraints/angle.hpp"
#include "constraints/constraint_residual.hpp"
#include "constraints/distance.hpp"
#include "constraints/surfaces.hpp"
#include "forces/anharmonic_chain.hpp"
#include "forces/bonded.hpp"
#include "forces/coulomb.hpp"
#include "forces/electromagnetic_fields.hpp"
#include "forces/ewald.hpp"
#include "forces/external_fields.hpp"
#include "forces/fermi_pasta_ulam.hpp"
#include "forces/gr_potential.hpp"
#include "forces/gravity.hpp"
#include "forces/gravity_of_bodies.hpp"
#include "forces/hard_spheres.hpp"
#include "forces/henon_heiles.hpp"
#include "forces/hyperelastic.hpp"
#include "forces/lennard_jones.hpp"
#include "forces/oblateness.hpp"
#include "forces/pair_potentials.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/post_newtonian.hpp"
#include "forces/springs.hpp"
#include "forces/sum.hpp"
#include "forces/traction.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/charged_particles.hpp"
#include "integrators/damped.hpp"
#include "integrators/k_symplectic.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "integrators/minimize.hpp"
#include "integrators/projected.hpp"
#include "integrators/rotating.hpp"
#include "integrators/shearing_sheet.hpp"
#include "integrators/systems/darwin.hpp"
#include "integrators/systems/double_pendulum.hpp"
#include "integrators/systems/forced_damped_oscillator.hpp"
#include "integrators/systems/heat_line.hpp"
#include "integrators/systems/kerr.hpp"
#include "integrators/systems/lorentz_pairs.hpp"
#include "integrators/systems/lorenz.hpp"
#include "integrators/systems/nonseparable_oscillator.hpp"
#include "integrators/systems/pendulum.hpp"
#include "integrators/systems/polar_kepler.hpp"
#include "integrators/systems/prothero_robinson.hpp"
#include "integrators/systems/rc_ladder.hpp"
#include "integrators/systems/robertson.hpp"
#include "integrators/systems/schwarzschild.hpp"
#include "integrators/systems/turning_frame.hpp"
#include "integrators/systems/weber.hpp"
#include "integrators/tidal.hpp"
#include "integrators/velocity_rescaling.hpp"
#include "integrators/wisdom_holman.hpp"
#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "monitors/chaos.hpp"
#include "monitors/charges.hpp"
#include "monitors/dihedrals.hpp"
#include "monitors/dipole.hpp"
#include "monitors/field_momentum.hpp"
#include "monitors/momentum_map.hpp"
#include "monitors/monitors.hpp"
#include "monitors/orbital_monitors.hpp"
#include "monitors/pressure.hpp"
#include "monitors/radial_distribution.hpp"
#include "monitors/resonance_angle.hpp"
#include "monitors/ring_monitors.hpp"
#include "monitors/shadow_hamiltonian.hpp"
#include "monitors/spin.hpp"
#include "monitors/temperature.hpp"
#include "monitors/time_correlation.hpp"
#include "monitors/turning.hpp"
#include "monitors/variables.hpp"
#include "scene/constrained.hpp"
#include "scene/grid_files.hpp"
#include "scene/structure_parts.hpp"

#include <algorithm>
#include <map>
#include <memory>

namespace noether {

namespace {

/// Several constraints under one name.
struct RigidBar {
  static constexpr auto describe() {
    return part<RigidBar>("rigid_bar",
                          "keeps particles on a rigid bar: its two ends, and others in their places between them",
                          formula("|x_n - x_1| = d,  x_k = (1 - f_k) x_1 + f_k x_n, as at the start"),
                          source("CiccottiFerrarioRyckaert1982"));
  }
  static SceneConstraint read(TableReader& reader) {
    reader.finish();
    return {"rigid_bar", SceneValue::table(), {}, add_rigid_bar};
  }
};

void check_distance(double distance) {
  if (!(distance > 0)) refuse_field("distance", distance, "is not a valid distance; a length above 0 is expected");
}
void check_steps(std::int64_t steps) {
  if (steps < 1) refuse_field("steps", std::to_string(steps), "is too few; at least 1 is expected");
}

/// An escape is seen late as well as early.
struct Escape {
  double distance = 0;
  std::int64_t steps = 100;

  static constexpr auto describe() {
    return part<Escape>(
        "escape", "ends the run when a particle is far from the centre of mass",
        formula("|x_i - X| > distance,  X = sum m_j x_j / sum m_j"),
        quantities("the particle and, by interpolation, since when"),
        field<&Escape::distance>("distance", "length").required("\"100 au\""),
        field<&Escape::steps>("steps", "1",
                              "steps between two checks; of a method that chooses its steps 1 unless given"));
  }
  void check() const {
    check_distance(distance);
    check_steps(steps);
  }
  StopRule rule() const { return farther_than(distance); }
};

/// A collision is found between two looks only if they are close.
struct Collision {
  double distance = 0;
  std::int64_t steps = 1;

  static constexpr auto describe() {
    return part<Collision>("collision", "ends the run when two particles, one of them massive, come near each other",
                           formula("|x_i - x_j| < distance along quintic Hermite paths between two checks"),
                           quantities("the pair, its smallest distance, and since when"),
                           field<&Collision::distance>("distance", "length").required("\"0.001 au\""),
                           field<&Collision::steps>("steps", "1", "steps between two checks"));
  }
  void check() const {
    check_distance(distance);
    check_steps(steps);
  }
  StopRule rule() const { return closer_than(distance); }
};

void add_fields(Parts& parts) {
  parts.add_field<UniformElectromagnetic>();
  parts.add_field<GradientField>();
  parts.add_field<MagneticMirror>();
  parts.add_field<MagneticDipole>();
  parts.add_field<Tokamak>();
  parts.add_field<PenningTrap>();
  parts.add_field<PlaneWave>();
  parts.add_field<RadioFrequencyGap>();
  parts.add_field<GridField>();
}

void add_systems(Parts& parts) {
  parts.add_system<Robertson>();
  parts.add_system<RcLadder>();
  parts.add_system<HeatLine>();
  parts.add_system<Lorenz>();
  parts.add_system<ProtheroRobinson>();
  parts.add_system<ForcedDampedOscillator>();
  parts.add_system<NonseparableOscillator>();
  parts.add_system<Schwarzschild>();
  parts.add_system<Kerr>();
  parts.add_system<TurningFrame>();
  parts.add_system<SimplePendulum>();
  parts.add_system<DoublePendulum>();
  parts.add_system<PolarKepler>();
  parts.add_system<Weber>();
  parts.add_system<Darwin>();
  parts.add_system<LorentzPairs>();
}

void add_constraints(Parts& parts) {
  parts.add_constraint<Distance>();
  parts.add_constraint({part_info<RigidBar>(), 0, RigidBar::read, Drawn::chain});
  parts.add_constraint<Angle>();
  parts.add_structure_constraint<RigidBonds>();
  parts.add_structure_constraint<RigidHydrogenBonds>();
  parts.add_structure_constraint<RigidBondsAndAngles>();
  parts.add_structure_constraint<RigidMolecules>();
  parts.add_constraint<Fixed>();
  parts.add_constraint<OnSphere>();
  parts.add_constraint<OnPlane>();
  parts.add_constraint<OnCylinder>();
  parts.add_constraint<OnCircle>();
  parts.add_constraint<OnLine>();
}

}  // namespace

Parts standard_parts() {
  Parts parts;
  parts.add_hamiltonian<KineticPotentialOptions>();
  parts.add_hamiltonian<WisdomHolmanOptions>();
  parts.add_hamiltonian<ChargedParticlesOptions>();
  parts.add_hamiltonian<KSymplecticOptions>();
  parts.add_hamiltonian<ShearingSheetOptions>();
  parts.add_thermostat<LangevinOptions>();
  parts.add_thermostat<VelocityRescalingOptions>();
  parts.add_force<Gravity>();
  parts.add_force<GravityOfBodies>();
  parts.add_force<Oblateness>();
  parts.add_force<GrPotential>();
  parts.add_force<PostNewtonian>();
  parts.add_force<UniformField>();
  parts.add_force<OscillatingField>();
  parts.add_force<HarmonicField>();
  parts.add_force<HenonHeiles>();
  parts.add_force<FermiPastaUlam>();
  parts.add_force<AnharmonicChain>();
  parts.add_force<LennardJonesForce>();
  parts.add_force<WcaForce>();
  parts.add_force<MorseForce>();
  parts.add_force<BuckinghamForce>();
  parts.add_force<ReactionFieldForce>();
  parts.add_force<Coulomb>();
  parts.add_force<Ewald>();
  parts.add_force<ParticleMeshEwald>();
  parts.add_force<HarmonicBond>();
  parts.add_force<Tether>();
  parts.add_force<Bonded>();
  parts.add_force<HyperelasticForce>();
  parts.add_force<Traction>();
  parts.add_force<LinearDrag>();
  parts.add_force<Tides>();
  parts.add_force<HardSpheres>();
  add_fields(parts);
  add_constraints(parts);
  add_systems(parts);
  parts.add_monitor<Energy>();
  parts.add_monitor<Momentum>();
  parts.add_monitor<AngularMomentum>();
  parts.add_monitor<CenterOfMass>();
  parts.add_monitor<Spin>();
  parts.add_monitor<OrientationDefect>();
  parts.add_monitor<TurningEnergy>();
  parts.add_monitor<Elements>();
  parts.add_monitor<ResonanceAngle>();
  parts.add_monitor<ClosestApproach>();
  parts.add_monitor<Temperature>();
  parts.add_monitor<Pressure>();
  parts.add_monitor<RadialDistribution>();
  parts.add_monitor<Dihedrals>();
  parts.add_monitor<DipoleMoment>();
  parts.add_monitor<DielectricConstant>();
  parts.add_monitor<MeanSquareDisplacement>();
  parts.add_monitor<VelocityAutocorrelation>();
  parts.add_monitor<Variables>();
  parts.add_monitor<MomentumMap>();
  parts.add_monitor<FieldMomentum>();
  parts.add_monitor<CanonicalMomentum>();
  parts.add_monitor<MagneticMoment>();
  parts.add_monitor<VelocityDispersion>();
  parts.add_monitor<FillingFactor>();
  parts.add_monitor<Viscosity>();
  parts.add_monitor<Wakes>();
  parts.add_monitor<ConstraintResidual>();
  parts.add_monitor<ShadowHamiltonian<double>>();
  parts.add_monitor<Megno<double>>();
  parts.add_monitor<Lyapunov<double>>();
  parts.add_stop<Escape>();
  parts.add_stop<Collision>();
  parts.add_decorator<ProjectionOptions>();
  for (const auto& list : {methods::all(), methods::of_rotations()}) {
    for (const MethodInfo* method : list) parts.add_method(*method);
  }
  return parts;
}

Parts& Parts::add_method(const MethodInfo& method) {
  const auto known =
      std::find_if(methods_.begin(), methods_.end(), [&](auto* one) { return one->name == method.name; });
  if (known != methods_.end()) {
    *known = &method;
  } else {
    methods_.push_back(&method);
  }
  return *this;
}

const MethodInfo* Parts::find_method(std::string_view name) const {
  for (const MethodInfo* info : methods_) {
    const std::vector<std::string> aliases = methods::aliases_of(*info);
    if (info->name == name || std::find(aliases.begin(), aliases.end(), name) != aliases.end()) return info;
  }
  return methods::find_hbvm(name);
}

std::vector<std::string> Parts::method_names() const {
  std::vector<std::string> names;
  const auto add = [&](std::string_view name, const std::vector<std::string>& aliases) {
    names.emplace_back(name);
    names.insert(names.end(), aliases.begin(), aliases.end());
  };
  for (const Scheme* scheme : schemes::all()) add(scheme->name, schemes::aliases_of(*scheme));
  for (const MethodInfo* info : methods_) add(info->name, methods::aliases_of(*info));
  return names;
}

std::vector<const OptionGroup*> Parts::method_options() const {
  std::vector<const OptionGroup*> groups = {error_control};
  for (const MethodInfo* info : methods_) {
    for (const OptionGroup* group : info->option_groups()) {
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
    }
  }
  return groups;
}

std::vector<PartInfo> writer_parts() { return {part_info<io::TrajectoryOptions>(), part_info<io::CheckpointWriter>()}; }

std::vector<std::pair<std::string, PartInfo>> other_parts() {
  return {
      {"start", part_info<MinimizeOptions>()},
      {"hamiltonian", part_info<RotatingOptions>()},
      {"hamiltonian",
       {"damped", "the name of any Hamiltonian with friction: a force linear_drag in the scene adds it as the letter D",
        "D: v -> exp(-rate h) v", "", ""}}};
}

namespace detail {

void find_held(SceneConstraint& constraint, const std::vector<HeldDistance>& distances) {
  const auto of_pair = std::make_shared<std::map<std::vector<Index>, HeldDistance>>();
  for (const HeldDistance& one : distances) {
    constraint.tied.push_back({one.particles[0], one.particles[1]});
    of_pair->emplace(constraint.tied.back(), one);
  }
  constraint.add = [of_pair](ConstraintSet& set, const ParticleSystem<double>& s, const std::vector<Index>& pair) {
    add_held(set, s, {of_pair->at(pair)});
  };
}

void attach(Simulation<double>& sim, const Cadence& cadence, AnyMonitor<double> monitor) {
  sim.attach(std::move(monitor), {.steps = cadence.steps,
                                  .interval = cadence.interval,
                                  .wall = cadence.wall,
                                  .times = cadence.times,
                                  .after = cadence.after});
}

std::vector<double> read_start(const TableReader& reader, const SceneValue& list, Index size,
                               const std::vector<std::string>& names) {
  const auto* elements = list.get<SceneValue::Array>();
  if (elements == nullptr) reader.wrong_kind(list, "start", "a list of numbers");
  if (static_cast<Index>(elements->size()) != size) {
    const std::string which = names.empty() ? "" : fmt::format(": {}", fmt::join(names, ", "));
    reader.fail(
        &list, "start",
        fmt::format("start has {} {}, but {} has {} {}{}", elements->size(), elements->size() == 1 ? "value" : "values",
                    reader.what(), size, size == 1 ? "variable" : "variables", which));
  }
  std::vector<double> values;
  for (const SceneValue& one : *elements) values.push_back(reader.number(one, "start", "1"));
  return values;
}

}  // namespace detail

}  // namespace noether
