#include "constraints/molecule_lanes.hpp"

#include "constraints/bond_tree.hpp"
#include "constraints/distance.hpp"
#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/partition.hpp"
#include "constraints/rigid_triangle.hpp"
#include "constraints/velocity_passes.hpp"
#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace noether {

namespace {

/// Smaller trees are solved quicker as molecules of any shape, sixteen of them side by side.
constexpr std::size_t least_tree = 8;
/// Of masses: cofactors of nearly singular blocks lose more digits than elimination entry by entry.
constexpr double most_ratio_of_tree = 1e7;
constexpr int segments = 16;
/// Constraints that a thread takes at a time.
constexpr Index share_of_thread = 256;
/// So many tell what violations are, and cost nothing beside a stage of all.
constexpr Index bonds_to_look_at = 64;

const ConstraintsOf<Distance>* distances(const ConstraintGroup& group) {
  return dynamic_cast<const ConstraintsOf<Distance>*>(&group);
}

MoleculeColumns columns_of(const ParticleSystem<double>& s, const VectorColumn<double>& start, VectorColumn<double>* x,
                           VectorColumn<double>& v) {
  MoleculeColumns columns{};
  for (int k = 0; k < 3; ++k) {
    columns.start[k] = start.component(k);
    columns.x[k] = x != nullptr ? x->component(k) : nullptr;
    columns.v[k] = v.component(k);
    if (!s.box().is_periodic()) continue;
    columns.edge[k] = s.box().edges()[k];
    columns.magic[k] = 1.5 * 0x1p52 * s.box().spacing(k);
  }
  return columns;
}

}  // namespace

std::vector<double> MoleculeLanes::inverse_masses(const Molecule& molecule, const ParticleSystem<double>& s) {
  std::vector<double> inverse;
  for (const Index i : molecule.particles) inverse.push_back(1 / s.masses()[i]);
  return inverse;
}

/// A component that lanes take, a lone apex of three atoms in front.
std::optional<MoleculeLanes::Molecule> MoleculeLanes::molecule_of(const ConstraintSet& set, const Partition& parts,
                                                                  Index component,
                                                                  const ParticleSystem<double>& s) const {
  const auto constraints = parts.constraints(component);
  const auto is_distance = [&](const Partition::Member& m) { return distances(*set.groups()[at(m.group)]) != nullptr; };
  const ConstraintMethodInfo& info = info_of(options_.solver);
  const bool too_large = info.lanes != nullptr && constraints.size() > at(info.lanes().most_constraints);
  const bool by_segments = info.lanes == newton_in_lanes;
  if ((too_large && !by_segments) || !std::all_of(constraints.begin(), constraints.end(), is_distance)) return {};
  Molecule molecule{{parts.particles(component).begin(), parts.particles(component).end()}, {}, {}};
  std::vector<int> place(molecule.particles.size());
  for (std::size_t a = 0; a < place.size(); ++a) place[a] = static_cast<int>(a);
  if (place.size() == 3) {
    const auto mass = [&](std::size_t a) { return s.masses()[molecule.particles[a]]; };
    const std::size_t apex = mass(1) == mass(2) ? 0 : mass(0) == mass(2) ? 1 : mass(0) == mass(1) ? 2 : 0;
    std::swap(molecule.particles[0], molecule.particles[apex]);
    std::swap(place[0], place[apex]);
  }
  const auto places = parts.places(parts.kind(component));
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const Partition::Member& m = constraints[k];
    molecule.pairs.emplace_back(place[at(places[2 * k])], place[at(places[2 * k + 1])]);
    molecule.lengths.push_back(*distances(*set.groups()[at(m.group)])->constraint(m.constraint).length);
  }
  if (too_large && !bond_path(molecule.pairs, inverse_masses(molecule, s))) return {};
  return molecule;
}

std::array<double, 3> MoleculeLanes::sides2(const Molecule& molecule) {
  std::array<double, 3> sides2{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [a, b] = molecule.pairs[k];
    sides2[static_cast<std::size_t>(a + b - 1)] = molecule.lengths[k] * molecule.lengths[k];
  }
  return sides2;
}

Index MoleculeLanes::packs() const {
  Index packs = 0;
  for (const Kind& kind : kinds_) packs += kind.packs;
  return packs;
}

ConstraintSet MoleculeLanes::lay_out(const ConstraintSet& set, const ParticleSystem<double>& s) {
  *this = {};
  options_ = set.options();
  const ConstraintMethodInfo& info = info_of(options_.solver);
  const bool all = info.lanes != nullptr;
  if (!all && info.triangles == nullptr) return set;
  const Partition parts(set, s.masses());
  std::vector<bool> left(at(set.equations()), true);
  std::map<std::vector<double>, std::vector<Index>> kinds;  // by all that makes a molecule what it is
  std::vector<std::vector<double>> order;
  for (Index component = 0; component < parts.components(); ++component) {
    std::optional<Molecule> molecule = molecule_of(set, parts, component, s);
    if (!molecule) continue;
    std::vector<double> what{static_cast<double>(molecule->particles.size())};
    for (const Index i : molecule->particles) what.push_back(s.masses()[i]);
    for (const auto& [a, b] : molecule->pairs)
      what.insert(what.end(), {static_cast<double>(a), static_cast<double>(b)});
    if (info.equal_lengths)
      std::transform(molecule->lengths.begin(), molecule->lengths.end(), std::back_inserter(what),
                     Preconditioner::near);
    for (const Partition::Member& m : parts.constraints(component)) left[at(m.equation)] = false;
    auto [found, is_new] = kinds.emplace(what, std::vector<Index>{});
    if (is_new) order.push_back(what);
    found->second.push_back(static_cast<Index>(molecules_.size()));
    molecules_.push_back(std::move(*molecule));
  }
  for (const auto& what : order) add_kind(std::move(kinds[what]), s);
  if (all) return set.only(left);
  const auto refuse = [&](const std::string& words) {
    throw BadConstraints(
        fmt::format("{} is not of a rigid molecule of three sites, two of them equal, which solver = "
                    "\"{}\" is for; use \"newton\"",
                    words, info.name));
  };
  for (std::size_t e = 0; e < left.size(); ++e) {
    if (left[e]) refuse(set.words(static_cast<Index>(e), s));
  }
  for (const Molecule& molecule : molecules_) {
    const std::vector<Index>& tied = molecule.particles;
    if (molecule.is_triangle() && s.masses()[tied[1]] == s.masses()[tied[2]] &&
        sides2(molecule)[0] == sides2(molecule)[1])
      continue;
    refuse(fmt::format("distance of '{}' and '{}'", s.name(tied[0]), s.name(tied[1])));
  }
  return set.only(left);
}

void MoleculeLanes::add_kind(std::vector<Index> molecules, const ParticleSystem<double>& s) {
  Kind kind{.molecules = std::move(molecules)};
  const Molecule& first = molecules_[at(kind.molecules.front())];
  const ConstraintMethodInfo& info = info_of(options_.solver);
  choose_kernels(kind, s);
  if (kind.in_segments) {
    lay_in_segments(kind);
  } else {
    lay_side_by_side(kind);
    if (first.is_triangle() && info.triangles != info.lanes) lay_triangles(kind, s);
  }
  kind.first_report = static_cast<Index>(reports_.size());
  reports_.resize(reports_.size() + at(kind.packs));
  kinds_.push_back(std::move(kind));
}

/// Those of the solver, and of Newton's method those for the shape of the molecules: nothing else of them matters, so
/// that bits do not depend on company.
void MoleculeLanes::choose_kernels(Kind& kind, const ParticleSystem<double>& s) const {
  const ConstraintMethodInfo& info = info_of(options_.solver);
  const Molecule& first = molecules_[at(kind.molecules.front())];
  const std::size_t constraints = first.pairs.size();
  std::vector<double> inverse = inverse_masses(first, s);
  const auto [least, most] = std::minmax_element(inverse.begin(), inverse.end());
  const double ratio = *most / *least;
  if (info.lanes == newton_in_lanes) kind.passes = velocity_passes(ratio);
  if (info.lanes == newton_in_lanes) kind.path = bond_path(first.pairs, inverse);
  if (info.lanes != nullptr && constraints > at(info.lanes().most_constraints)) {
    kind.kernels = segment_lanes;
    kind.in_segments = true;
    kind.lanes = segments;
    return;
  }
  kind.kernels = first.is_triangle() ? info.triangles : info.lanes;
  if (kind.kernels == nullptr) kind.kernels = info.triangles;  // of molecules that will be refused
  kind.elimination.emplace(first.pairs, std::move(inverse));
  if (kind.kernels == newton_in_lanes) {
    if (!kind.path && constraints >= least_tree && ratio <= most_ratio_of_tree) kind.tree = tree_centers(kind.lists());
    if (kind.path) kind.kernels = path_lanes;
    if (!kind.tree.empty()) kind.kernels = tree_lanes;
  }
  if (kind.molecules.size() > 8 && constraints <= at(kind.kernels().most_of_sixteen)) kind.lanes = 16;
  if (!info.equal_lengths) return;
  std::vector<double> lengths;
  for (const int place : kind.elimination->places()) lengths.push_back(Preconditioner::near(first.lengths[at(place)]));
  kind.preconditioner = Preconditioner(kind.lists(), lengths);
}

EliminationLists MoleculeLanes::Kind::lists() const {
  if (elimination) return elimination->lists();
  EliminationLists lists{};
  const int bonds = static_cast<int>(path->bonds.size());
  lists.constraints = bonds / segments + 1;
  lists.atoms = lists.constraints + 1;
  return lists;
}

/// Where atoms of molecules are, and what lengths they have, as kernels read them.
void MoleculeLanes::lay_side_by_side(Kind& kind) const {
  const EliminationLists lists = kind.lists();
  const Index lanes = kind.lanes, n = lists.constraints, atoms = lists.atoms;
  const auto count = static_cast<Index>(kind.molecules.size());
  const Molecule& first = molecules_[at(kind.molecules.front())];
  for (const Index m : kind.molecules) kind.alike = kind.alike && molecules_[at(m)].lengths == first.lengths;
  kind.packs = (count + lanes - 1) / lanes;
  kind.atoms.resize(at(kind.packs * atoms * lanes));
  kind.lengths2.resize(at((kind.alike ? 1 : kind.packs) * 2 * n * lanes));
  for (Index slot = 0; slot < kind.packs * lanes; ++slot) {
    const Molecule& molecule = molecules_[at(kind.molecules[at(std::min(slot, count - 1))])];
    const Index pack = slot / lanes, lane = slot % lanes;
    for (Index a = 0; a < atoms; ++a) {
      const Index particle = molecule.particles[at(a)];
      kind.atoms[at((pack * atoms + a) * lanes + lane)] = static_cast<std::int32_t>(particle);
      kind.side_by_side = kind.side_by_side && particle == molecule.particles.front() + a;
    }
    if (kind.alike && pack > 0) continue;
    for (Index k = 0; k < n; ++k) {
      const double length = molecule.lengths[at(kind.order()[at(k)])];
      kind.lengths2[at((pack * 2 * n + k) * lanes + lane)] = length * length;
      kind.lengths2[at((pack * 2 * n + n + k) * lanes + lane)] = 1 / (length * length);
    }
  }
}

/// What is constant of rigid molecules of three sites, each in its lane.
void MoleculeLanes::lay_triangles(Kind& kind, const ParticleSystem<double>& s) const {
  const auto count = static_cast<Index>(kind.molecules.size());
  kind.triangles.resize(at(kind.alike ? 1 : kind.packs));
  for (Index slot = 0; slot < std::ssize(kind.triangles) * RigidTriangles::lanes; ++slot) {
    const Molecule& molecule = molecules_[at(kind.molecules[at(std::min(slot, count - 1))])];
    std::array<double, 3> inverse{};
    for (std::size_t a = 0; a < 3; ++a) inverse[a] = 1 / s.masses()[molecule.particles[a]];
    put_triangle(kind.triangles[at(slot / RigidTriangles::lanes)], static_cast<int>(slot % RigidTriangles::lanes),
                 inverse, sides2(molecule));
  }
}

/// The same for long paths: lane l has the bonds from l (m + 1) on, m + 1 of them, and behind the end of the path bonds
/// from its last atom to itself.
void MoleculeLanes::lay_in_segments(Kind& kind) const {
  const EliminationLists lists = kind.lists();
  const Index lanes = kind.lanes, n = lists.constraints, atoms = lists.atoms;
  const Index bonds = static_cast<Index>(kind.path->bonds.size());
  kind.packs = static_cast<Index>(kind.molecules.size());
  kind.alike = false;
  kind.atoms.resize(at(kind.packs * atoms * lanes));
  kind.segment_masses.resize(at(atoms * lanes));
  kind.lengths2.resize(at(kind.packs * 2 * n * lanes));
  for (Index pack = 0; pack < kind.packs; ++pack) {
    const Molecule& molecule = molecules_[at(kind.molecules[at(pack)])];
    for (Index lane = 0; lane < lanes; ++lane) {
      for (Index a = 0; a < atoms; ++a) {
        const Index along = std::min(lane * n + a, bonds);
        const Index particle = molecule.particles[at(kind.path->atoms[at(along)])];
        kind.atoms[at((pack * atoms + a) * lanes + lane)] = static_cast<std::int32_t>(particle);
        kind.segment_masses[at(a * lanes + lane)] = kind.path->inverse_masses[at(along)];
        kind.side_by_side = kind.side_by_side && particle == molecule.particles.front() + along;
      }
      for (Index k = 0; k < n; ++k) {
        const bool behind = lane * n + k >= bonds;
        const double length = behind ? 1 : molecule.lengths[at(kind.path->bonds[at(lane * n + k)])];
        kind.lengths2[at((pack * 2 * n + k) * lanes + lane)] = length * length;
        kind.lengths2[at((pack * 2 * n + n + k) * lanes + lane)] = behind ? 0 : 1 / (length * length);
      }
    }
  }
}

template <class Work> void MoleculeLanes::for_packs(const Work& work) {
  for (const Kind& kind : kinds_) {
    const MoleculeKernels& kernels = kind.kernels();
    const EliminationLists lists = kind.lists();
    const PreconditionerLists preconditioner = kind.preconditioner.lists();
    const BondPathRow path = kind.path ? kind.path->row() : BondPathRow{};
    const BondSegmentsRow in_segments{path.bonds, kind.segment_masses.data()};
    const Index of_pack = kind.molecules_of_pack();
    const Index share = std::max<Index>(1, share_of_thread / (lists.constraints * kind.lanes));
    const Index shares = (kind.packs + share - 1) / share;
    for_blocks(shares * block_size, [&](Index begin, Index) {
      static thread_local AlignedVector<double> scratch;
      const int own = kernels.slots != nullptr ? kernels.slots(lists) : 0;
      const std::size_t needed = (molecule_scratch(lists) + at(own)) * at(kind.lanes);
      if (scratch.size() < needed) scratch.resize(needed);
      const Index from = begin / block_size * share;
      for (Index p = from; p < std::min(kind.packs, from + share); ++p) {
        const Index molecules = std::min(of_pack, static_cast<Index>(kind.molecules.size()) - p * of_pack);
        const std::int32_t* const atoms = kind.atoms.data() + p * lists.atoms * kind.lanes;
        const bool full = molecules == kind.lanes;
        const MoleculePack pack{
            .lanes = kind.lanes,
            .live = (1U << molecules) - 1,
            .kind = &lists,
            .atoms = atoms,
            .side_by_side = kind.side_by_side,
            .in_a_row = kind.side_by_side && full && atoms[kind.lanes - 1] - atoms[0] == lists.atoms * (kind.lanes - 1),
            .triangles = kind.triangles.empty() ? nullptr : &kind.triangles[at(kind.alike ? 0 : p)],
            .path = kind.path ? &path : nullptr,
            .segments = kind.in_segments ? &in_segments : nullptr,
            .tree = kind.tree.data(),
            .preconditioner = &preconditioner,
            .lengths2 = kind.lengths2.data() + (kind.alike ? 0 : p * 2 * lists.constraints * kind.lanes),
            .passes = kind.passes,
            .scratch = scratch.data()};
        work(kernels, pack, reports_[at(kind.first_report + p)]);
      }
    });
  }
}

MoleculeTask MoleculeLanes::task(double h) const {
  return {.h = h,
          .tolerance = options_.tolerance,
          .iterations = static_cast<int>(std::min<Index>(options_.most_iterations(), 1 << 20)),
          .order = static_cast<int>(options_.order)};
}

MoleculeLanes::Solved MoleculeLanes::solve_positions(const ParticleSystem<double>& s, const VectorColumn<double>& start,
                                                     VectorColumn<double>& x, VectorColumn<double>& v, double h,
                                                     bool look) {
  const double before = look ? violation(s, start, x) : 0;
  const MoleculeColumns columns = columns_of(s, start, &x, v);
  for_packs([&, task = task(h)](const MoleculeKernels& kernels, const MoleculePack& pack, MoleculeReport& report) {
    report = kernels.solve_positions(pack, columns, task);
  });
  Solved all = solved();
  if (look && all.open.empty()) all.before = before, all.after = violation(s, start, x);
  return all;
}

double MoleculeLanes::violation(const ParticleSystem<double>& s, const VectorColumn<double>& start,
                                const VectorColumn<double>& x) const {
  double worst = 0;
  Index looks = 0;
  const Index apart = 1 + std::ssize(molecules_) / bonds_to_look_at;
  for (Index m = 0; m < std::ssize(molecules_); m += apart) {
    const Molecule& molecule = molecules_[at(m)];
    for (std::size_t k = 0; k < molecule.pairs.size(); ++k) {
      const Index i = molecule.particles[at(molecule.pairs[k].first)];
      const Index j = molecule.particles[at(molecule.pairs[k].second)];
      Vec3<double> d = x[i] - x[j];
      if (s.box().is_periodic()) d += s.box().minimum_image(Vec3<double>(start[i] - start[j]));
      worst = std::max(worst, std::abs(norm2(d) / (molecule.lengths[k] * molecule.lengths[k]) - 1) / 2);
      if (++looks == bonds_to_look_at) return worst;
    }
  }
  return worst;
}

MoleculeLanes::Solved MoleculeLanes::project_velocities(ParticleSystem<double>& s, double h) {
  const MoleculeColumns columns = columns_of(s, std::as_const(s).positions(), nullptr, s.velocities());
  for_packs([&, task = task(h)](const MoleculeKernels& kernels, const MoleculePack& pack, MoleculeReport& report) {
    report = kernels.project_velocities(pack, columns, task);
    // Multipliers of a light atom between heavy ones cancel: what rounding leaves of their sum is taken away anew.
    for (int again = 2; again < pack.passes; ++again)
      report.open |= kernels.project_velocities(pack, columns, task).open;
  });
  return solved();
}

/// What the packs report.
MoleculeLanes::Solved MoleculeLanes::solved() const {
  Solved solved;
  for (const Kind& kind : kinds_) {
    for (Index p = 0; p < kind.packs; ++p) {
      const MoleculeReport& report = reports_[at(kind.first_report + p)];
      if (report.sweeps > solved.sweeps) {
        solved.sweeps = report.sweeps;
        solved.before = report.before, solved.after = report.after;
      }
      for (Index lane = 0; report.open >> lane != 0; ++lane) {
        if ((report.open >> lane & 1U) != 0)
          solved.open.push_back(kind.molecules[at(p * kind.molecules_of_pack() + lane)]);
      }
    }
  }
  return solved;
}

const MoleculeKernels& newton_in_lanes() { return newton_lanes(); }
const MoleculeKernels& sweeps_in_lanes() { return sweep_lanes(); }
const MoleculeKernels& triangles_in_lanes() { return triangle_lanes(); }
const MoleculeKernels& settle_in_lanes() { return settle_lanes(); }
const MoleculeKernels& m_shake_in_lanes() { return m_shake_lanes(); }
const MoleculeKernels& p_shake_in_lanes() { return p_shake_lanes(); }
const MoleculeKernels& lincs_in_lanes() { return lincs_lanes(); }

ConstraintSet MoleculeLanes::constraints(Index molecule, const ParticleSystem<double>& alone) const {
  const Molecule& of = molecules_[at(molecule)];
  ConstraintSet set(options_);
  for (std::size_t k = 0; k < of.pairs.size(); ++k) {
    set.add(alone, Distance{.length = of.lengths[k]}, {of.pairs[k].first, of.pairs[k].second});
  }
  return set;
}

}  // namespace noether
