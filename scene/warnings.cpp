#include "scene/warnings.hpp"

#include "engine/bodies.hpp"
#include "engine/charge.hpp"
#include "engine/given_orbit.hpp"
#include "integrators/encounters.hpp"
#include "numbers/quantity.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace noether {

namespace {

/// Whether a particle or a site of a body has one.
bool has_charges(const ParticleSystem<double>& s) {
  if (const Bodies* bodies = s.bodies()) {
    for (const BodyKind& kind : bodies->kinds) {
      if (std::any_of(kind.sites.begin(), kind.sites.end(), [](const BodySite& site) { return site.charge != 0; }))
        return true;
    }
  }
  if (!s.has<Charge>()) return false;
  const auto& q = s.column<Charge>();
  for (Index i = 0; i < s.size(); ++i) {
    if (q[i] != 0) return true;
  }
  return false;
}

bool some(const Scene& scene, bool ForceClaims::*says) {
  const auto& forces = scene.hamiltonian.forces;
  return std::any_of(forces.begin(), forces.end(), [&](const SceneForce& f) { return f.force.claims().*says; });
}

/// Whether every force says that it does not do something; of one that says nothing nobody knows.
bool none_does(const Scene& scene, std::optional<bool> ForceClaims::*says) {
  const auto& forces = scene.hamiltonian.forces;
  return std::all_of(forces.begin(), forces.end(),
                     [&](const SceneForce& f) { return !(f.force.claims().*says).value_or(true); });
}

/// How many terms are what is left of pair forces that the topology excludes. Constraints may stand in the place of
/// all other terms, but not of these.
std::size_t terms_of_ends(const Topology& topology) {
  return static_cast<std::size_t>(
      std::count_if(topology.dihedrals.begin(), topology.dihedrals.end(),
                    [&](const BondedTerm<4>& term) { return topology.acts_on_ends(term); }));
}

/// Names of the forces that leave excluded pairs out.
std::vector<std::string> with_exclusions(const Parts& parts) {
  std::vector<std::string> names;
  for (const Parts::ForceKind& kind : parts.forces()) {
    if (kind.claims.exclusions.value_or(false)) names.push_back(kind.info.name);
  }
  return names;
}

/// Trace of one step of a word of drifts and kicks on an oscillator with h omega = z, halved; other letters rest. Above
/// 1 in size its powers grow.
double half_trace(const Word& word, double z) {
  std::array<double, 2> first = {1, 0}, second = {0, 1};  // columns: position, velocity
  for (const Stage& stage : word) {
    const double w = static_cast<double>(stage.weight) * z;
    for (auto* column : {&first, &second}) {
      if (stage.letter == 'A') (*column)[0] += w * (*column)[1];
      if (stage.letter == 'B') (*column)[1] -= w * (*column)[0];
    }
  }
  return (first[0] + second[1]) / 2;
}

/// Whether an oscillator with h omega = z grows without bounds under the method of a scene, as far as its tables or its
/// word tell.
bool grows(const SceneIntegrator& integrator, double z) {
  if (integrator.adaptive()) return false;
  const double limit =
      integrator.classical ? integrator.classical->info->stability_limit : integrator.scheme.stability_limit;
  if (!std::isnan(limit)) return z > limit;
  return !integrator.classical && std::abs(half_trace(integrator.scheme.word, z)) > 1;
}

/// U'' of a bond at its rest length [energy/length^2]; 0 for kinds that end a run themselves where they are too stiff.
double stiffness(const TermKind& kind) {
  if (kind.potential == "harmonic") return kind.parameters[0];
  if (kind.potential == "morse") return 2 * kind.parameters[0] * kind.parameters[1] * kind.parameters[1];
  return 0;
}

/// The bond that swings fastest, of those that no constraint holds.
struct FastestBond {
  double omega = 0;  ///< [1/time]
  Index first = 0, second = 0;
};

FastestBond fastest_bond(const Scene& scene) {
  FastestBond fastest;
  const Topology* topology = scene.particles.topology();
  if (topology == nullptr || !some(scene, &ForceClaims::bonded)) return fastest;
  std::set<std::pair<Index, Index>> held;
  for (const SceneConstraint& constraint : scene.hamiltonian.constraints) {
    for (const std::vector<Index>& tied : constraint.tied) {
      if (tied.size() == 2) held.insert(std::minmax(tied[0], tied[1]));
    }
  }
  const auto& masses = scene.particles.masses();
  for (const BondedTerm<2>& bond : topology->bonds) {
    const auto [i, j] = bond.particles;
    const double k = stiffness(topology->bond_kinds[static_cast<std::size_t>(bond.type)]);
    const double omega = std::sqrt(k * (1 / masses[i] + 1 / masses[j]));
    if (omega > fastest.omega && !held.contains(std::minmax(i, j))) fastest = {omega, i, j};
  }
  return fastest;
}

/// A bond that no step of this length can follow; empty if there is none.
std::string too_stiff(const Scene& scene) {
  const FastestBond bond = fastest_bond(scene);
  const double step = std::abs(scene.integrator.step), z = step * bond.omega;
  if (!std::isfinite(z) || !grows(scene.integrator, z)) return "";
  double bearable = z;
  while (bearable > 0.01 && grows(scene.integrator, bearable)) bearable -= 0.01;
  const std::string unit = scene.units->time == "1" ? "" : fmt::format(" {}", scene.units->time);
  const std::string remedy = bearable > 0.01 ? fmt::format("take a step below {:.2g}{}", bearable / bond.omega, unit)
                                             : "take another method, such as 'verlet'";
  return fmt::format("the bond of '{}' and '{}' oscillates with h omega = {:.3g}, which '{}' cannot keep bounded; {}{}",
                     scene.particles.name(bond.first), scene.particles.name(bond.second), z, scene.integrator.method,
                     remedy, scene.hamiltonian.thermostat ? "" : ", or constraints");
}

/// A file that names another cutoff than the force has; empty if it does not.
std::string other_cutoff(const Scene& scene) {
  const Topology* topology = scene.particles.topology();
  if (topology == nullptr || topology->stated_cutoff == 0) return "";
  const double stated = topology->stated_cutoff;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    const ForceClaims claims = force.force.claims();
    if (!claims.pair_coefficients || std::abs(stated - claims.range) <= 1e-9 * stated) continue;
    const std::string unit = scene.units->length == "1" ? "" : fmt::format(" {}", scene.units->length);
    return fmt::format(
        "the structure's pairs have a cutoff of {:.6g}{}, but the force {} has one of {:.6g}{}, which is used", stated,
        unit, force.name, claims.range, unit);
  }
  return "";
}

/// The first force that takes particle 0 for the heaviest one; empty where there is none.
std::string about_heaviest(const Scene& scene) {
  for (const SceneForce& force : scene.hamiltonian.forces) {
    for (const Parts::ForceKind& kind : scene.parts->forces()) {
      if (kind.about_heaviest && kind.info.name == force.name) return force.name;
    }
  }
  return "";
}

/// That a splitting into Kepler arcs, or relativity, is about a body that is not the heaviest; empty where it is.
std::string other_primary(const Scene& scene) {
  const ParticleSystem<double>& s = scene.particles;
  if (s.size() == 0) return "";
  Index heaviest = 0;
  for (Index i = 1; i < s.size(); ++i) heaviest = s.masses()[i] > s.masses()[heaviest] ? i : heaviest;
  if (heaviest == 0) return "";
  const bool arcs = scene.hamiltonian.splitting.claims().kepler;
  const std::string force = about_heaviest(scene);
  if (!arcs && force.empty()) return "";
  const std::string what = arcs ? fmt::format("so the Kepler arcs of {} go round it", scene.hamiltonian.splitting.name)
                                : fmt::format("so {} is about it", force);
  return fmt::format("'{}' comes first, {}, but '{}' has {:.3g} times its mass; put '{}' first", s.name(0), what,
                     s.name(heaviest), s.masses()[heaviest] / s.masses()[0], s.name(heaviest));
}

/// The first body of the scene's own tables whose elements are about a first body that is not the heaviest above it;
/// empty if there is none. (Tables in files tell their own.)
std::string other_center(const Scene& scene) {
  const SceneValue* particles = scene.effective.find("particles");
  const SceneValue* bodies = particles == nullptr ? nullptr : particles->find("body");
  const auto* tables = bodies == nullptr ? nullptr : bodies->get<SceneValue::Array>();
  const SceneValue* elements = particles == nullptr ? nullptr : particles->find("elements");
  if (tables == nullptr || (elements != nullptr && *elements->get<std::string>() == "jacobi")) return "";
  Index i = scene.particles.size() - static_cast<Index>(tables->size());
  for (const SceneValue& table : *tables) {
    const bool orbit = std::any_of(orbit_keys.begin(), orbit_keys.end(), [&](const OrbitKey& key) {
      return key.choice == OrbitKey::Choice::size && table.find(key.name) != nullptr;
    });
    if (orbit && table.find("about") == nullptr) {
      std::string told = about_a_light_body(scene.particles, i, scene.particles.name(i));
      if (!told.empty()) return told;
    }
    ++i;
  }
  return "";
}

/// Particles that no force moves for want of mass, where pair forces are all there is; empty if there are none.
std::string unmoved_tracers(const Scene& scene) {
  const ParticleSystem<double>& s = scene.particles;
  const auto acts_without_mass = [](const SceneForce& force) {
    const ForceClaims claims = force.force.claims();
    return claims.kepler || !(claims.range > 0 || claims.bonded || claims.meshed);
  };
  const std::vector<SceneForce> terms = scene.hamiltonian.terms();
  if (terms.empty() || std::any_of(terms.begin(), terms.end(), acts_without_mass)) return "";
  Index count = 0, first = -1;
  for (Index i = 0; i < s.size(); ++i) {
    if (s.masses()[i] != 0) continue;
    if (first < 0) first = i;
    ++count;
  }
  if (count == 0) return "";
  return fmt::format(
      "{} of mass 0, such as '{}', {} not moved by any force of this scene, because forces between molecules act on "
      "masses only; give masses",
      counted(count, "particle"), s.name(first), count == 1 ? "is" : "are");
}

/// A rigid body whose moments of inertia differ, but that attraction does not turn; empty where there is none.
std::string unturned_body(const Scene& scene) {
  const ParticleSystem<double>& s = scene.particles;
  const std::vector<SceneForce> terms = scene.hamiltonian.terms();
  const auto attracts = [](const SceneForce& f) { return f.force.claims().kepler; };
  const auto found = std::find_if(terms.begin(), terms.end(), attracts);
  if (found == terms.end() || some(scene, &ForceClaims::turning_figures)) return "";
  for (Index i = 0; i < s.size(); ++i) {
    if (is_sphere(s, i) || s.bodies()->is_held(i)) continue;
    const bool own = found - terms.begin() < static_cast<std::ptrdiff_t>(scene.hamiltonian.splitting.own.size());
    return fmt::format("{} attracts '{}' at its centre and does not turn it, though its moments of inertia differ; {}",
                       own ? scene.hamiltonian.splitting.name : found->name, s.name(i),
                       own ? "add gravity_of_bodies with point_masses = false" : "use gravity_of_bodies");
  }
  return "";
}

/// A constant of gravitation that is not the one of the units, however it is given; empty where it is. Names the
/// units that it has, where they are known.
std::string other_gravitation(const Scene& scene) {
  const UnitSystem& units = *scene.units;
  if (units.is_reduced() || !scene.hamiltonian.G || !scene.hamiltonian.is_keplerian()) return "";
  const double G = *scene.hamiltonian.G;
  if (std::abs(G / units.G - 1) < 0.01) return "";
  std::string meant;
  for (const char* unit : {"m^3/kg/s^2", "km^3/kg/s^2", "cm^3/g/s^2", "au^3/Msun/yr^2", "au^3/Msun/day^2",
                           "pc km^2/s^2/Msun", "kpc km^2/s^2/Msun", "pc^3/Msun/Myr^2"}) {
    const double same = unit_value(unit, units) * G / units.G;
    if (std::abs(same - 1) < 0.01) meant = fmt::format(", and is that of {0}: give it as \"{1:.12g} {0}\"", unit, G);
  }
  return fmt::format("G = {:.6g} is {:.3g} times the gravitational constant in these units, {:.6g} {}{}", G,
                     G / units.G, units.G, unit_of(parse_dimension("length^3/mass/time^2"), units), meant);
}

/// Times of a list that the run does not come to; empty where there are none.
std::string times_after_the_end(const SceneWatch& watch, const Scene& scene) {
  const auto length = scene.integrator.length();
  const std::vector<double>& times = watch.cadence.times;
  if (!length || times.empty()) return "";
  const double start = scene.integrator.start;
  const double rounding = scene.integrator.between_steps ? 1e-8 : 0.5;
  const double grace = scene.integrator.adaptive() ? 0 : rounding * std::abs(scene.integrator.step);
  const auto later = [&](double time) { return std::abs(time - start) > std::abs(*length) + grace; };
  const auto count = std::count_if(times.begin(), times.end(), later);
  if (count == 0) return "";
  const std::string unit = scene.units->time == "1" ? "" : fmt::format(" {}", scene.units->time);
  const std::string name = watch.kind == SceneWatch::Kind::monitor      ? watch.monitor.name
                           : watch.kind == SceneWatch::Kind::trajectory ? "trajectory"
                                                                        : "checkpoint";
  return fmt::format("{} of {} of '{}' {} after the end at {:.12g}{}, so it does not sample then", count,
                     counted(static_cast<std::int64_t>(times.size()), "time"), name, count == 1 ? "lies" : "lie",
                     start + *length, unit);
}

}  // namespace

std::vector<std::string> warnings_of(const Scene& scene) {
  std::vector<std::string> warnings = scene.warnings;
  warnings.insert(warnings.end(), scene.unread.begin(), scene.unread.end());
  for (const SceneError& wrong : scene.wrong_verdicts) warnings.emplace_back(wrong.what());
  const auto add = [&](std::string warning) {
    if (!warning.empty()) warnings.push_back(std::move(warning));
  };
  const std::vector<SceneForce>& forces = scene.hamiltonian.forces;
  if (const Topology* t = scene.particles.topology(); t != nullptr && !some(scene, &ForceClaims::bonded)) {
    const std::size_t terms = scene.hamiltonian.constraints.empty()
                                  ? t->bonds.size() + t->angles.size() + t->dihedrals.size() + t->impropers.size()
                                  : terms_of_ends(*t);
    if (terms > 0) {
      add(fmt::format("the structure has {} that nothing acts on: there is no force 'bonded'",
                      counted(static_cast<std::int64_t>(terms), "bonded term")));
    }
  }
  if (const Topology* t = scene.particles.topology();
      t != nullptr && t->mesh != nullptr && !some(scene, &ForceClaims::meshed)) {
    add("the structure has tetrahedra that nothing acts on: there is no force 'hyperelastic'");
  }
  if (!forces.empty() && scene.hamiltonian.splitting.only_forces && none_does(scene, &ForceClaims::charges) &&
      has_charges(scene.particles)) {
    add("the particles have charges that no force uses");
  }
  const auto field =
      std::find_if(forces.begin(), forces.end(), [](const SceneForce& force) { return force.force.claims().gyrates; });
  if (field != forces.end() && !has_charges(scene.particles)) {
    add(fmt::format("no particle has a charge, so the field '{}' does nothing; give a body a charge", field->name));
  }
  const auto of_charges = std::find_if(forces.begin(), forces.end(), [](const SceneForce& force) {
    return force.force.claims().charges == true && !force.force.claims().gyrates;
  });
  if (of_charges != forces.end() && !has_charges(scene.particles))
    add(fmt::format("no particle has a charge for the force '{}'; give a body a charge", of_charges->name));
  const SceneValue* particles = scene.effective.find("particles");
  if (none_does(scene, &ForceClaims::exclusions) && particles != nullptr && particles->find("exclusions") != nullptr) {
    add(fmt::format("exclusions have no effect: no force of this scene leaves pairs out; forces that do are {}",
                    fmt::join(with_exclusions(*scene.parts), ", ")));
  }
  add(other_cutoff(scene));
  add(too_stiff(scene));
  add(other_primary(scene));
  add(other_center(scene));
  add(other_gravitation(scene));
  add(unmoved_tracers(scene));
  add(unturned_body(scene));
  for (const SceneWatch& watch : scene.watches) add(times_after_the_end(watch, scene));
  return warnings;
}

std::string warning_of(const Encounter& encounter, const std::string& hamiltonian,
                       const ParticleSystem<double>& particles, const UnitSystem& units) {
  const auto name = [&](std::int64_t id) {
    for (Index i = 0; i < particles.size(); ++i) {
      if (particles.ids()[static_cast<std::size_t>(i)] == id) return fmt::format("'{}'", particles.name(i));
    }
    return fmt::format("a body that is gone (id {})", id);
  };
  const std::string unit = units.time == "1" ? "" : fmt::format(" {}", units.time);
  const std::string first = encounter.since == encounter.time
                                ? ""
                                : fmt::format(", and bodies within {} for the first time at time {:.6g}{}",
                                              encounter_hill_radii, encounter.since, unit);
  return fmt::format(
      "{} and {} came within {:.2g} Hill radii of each other at time {:.6g}{}{}; {} does not follow such "
      "encounters, so use a method whose steps shrink in them, such as 'gauss_8'",
      name(encounter.first), name(encounter.second), encounter.hill_radii, encounter.time, unit, first, hamiltonian);
}

std::string warning_of(const Evaluations& evaluations, std::string_view method) {
  if (method.starts_with("hbvm_") || method.starts_with("avf")) {
    return fmt::format(
        "in {} of '{}' 64 nodes did not integrate the forces to rounding, as past a kink of a force, so that the "
        "energy "
        "was not kept to rounding; take a shorter step",
        counted(evaluations.unsettled, "step"), method);
  }
  return fmt::format(
      "in {} of '{}' two bodies were so near to each other that doubles do not tell their pull well enough for errors "
      "below 1e-18; use 'wide_gauss_8'",
      counted(evaluations.unsettled, "step"), method);
}

void tell_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", escaped(note));
}

void tell_notes_and_warnings(const Scene& scene) {
  tell_notes(scene.notes);
  for (const std::string& warning : warnings_of(scene)) fmt::print(stderr, "warning: {}\n", escaped(warning));
}

}  // namespace noether
