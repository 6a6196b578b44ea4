#include "engine/make_rigid.hpp"

#include "engine/charge.hpp"
#include "engine/topology.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace noether {

namespace {

using Molecule = std::vector<Index>;

/// The molecules in the order of their first atoms, single atoms among them.
std::vector<Molecule> molecules_of(const ParticleSystem<double>& atoms) {
  const Topology none, *given = atoms.topology();
  const Topology& topology = given != nullptr ? *given : none;
  const std::vector<Index> first =
      topology.bonds.empty() ? molecules_by_number(topology, atoms.size()) : molecules_by_bonds(topology, atoms.size());
  std::vector<Molecule> all;
  std::vector<std::size_t> place(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    const auto at = static_cast<std::size_t>(first[i]);
    if (at == i) place[i] = all.size(), all.emplace_back();
    all[place[at]].push_back(static_cast<Index>(i));
  }
  return all;
}

/// Types, masses and charges of the atoms: what makes molecules one kind.
using AtomKinds = std::vector<std::tuple<int, double, double>>;

/// The rotation that lays `from` over `to` by least squares, weighted by the masses of the sites.
Quaternion<double> laid_over(const std::vector<BodySite>& from, const std::vector<Vec3<double>>& to) {
  Mat3<double> s = Mat3<double>::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) {
    const double weight = from[k].mass > 0 ? from[k].mass : 1e-6 * from.front().mass;
    s += weight * from[k].place * to[k].transpose();
  }
  Eigen::Matrix4d n;
  n << s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),  //
      s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),   //
      s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1),   //
      s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
  Quaternion<double> q = solver.eigenvectors().col(3);
  if (q[0] < 0) q = -q;
  return q;
}

class MakeRigid {
 public:
  MakeRigid(const ParticleSystem<double>& atoms, double tolerance)
      : atoms_(atoms),
        tolerance_(tolerance),
        charges_(atoms.has<Charge>() ? &atoms.column<Charge>() : nullptr),
        made_(atoms.units()) {
    const Topology* topology = atoms.topology();
    if (topology == nullptr || topology->bonds.empty()) return;
    bonded_.resize(static_cast<std::size_t>(atoms.size()));
    for (const BondedTerm<2>& bond : topology->bonds) {
      const auto [i, j] = bond.particles;
      bonded_[static_cast<std::size_t>(i)].push_back(j);
      bonded_[static_cast<std::size_t>(j)].push_back(i);
    }
  }

  ParticleSystem<double> make(const std::vector<Molecule>& molecules) {
    if (charges_ != nullptr) made_.add_column<Charge>();
    for (const Molecule& molecule : molecules) {
      if (molecule.size() == 1) {
        add_point(molecule.front());
      } else {
        add_molecule(molecule);
      }
    }
    if (!bodies_.kinds.empty()) made_.set_bodies(std::make_shared<const Bodies>(std::move(bodies_)));
    give_topology();
    made_.set_box(atoms_.box());
    return std::move(made_);
  }

 private:
  double charge(Index i) const { return charges_ != nullptr ? (*charges_)[i] : 0; }
  int type(Index i) const { return atoms_.topology() != nullptr ? atoms_.topology()->type(i) : 0; }

  void add_point(Index i) {
    const Index at = made_.add(atoms_.name(i), atoms_.masses()[i], atoms_.unwrapped(i), atoms_.velocities()[i]);
    if (charges_ != nullptr) made_.column<Charge>()[at] = charge(i);
    types_.push_back(type(i));
  }

  void add_molecule(const Molecule& molecule) {
    const Index first = molecule.front();
    const Vec3<double> origin = atoms_.unwrapped(first);
    std::vector<Vec3<double>> x = unfolded(molecule);
    Vec3<double> center = Vec3<double>::Zero(), v = center;
    double mass = 0;
    AtomKinds kind;
    for (std::size_t k = 0; k < molecule.size(); ++k) {
      const Index i = molecule[k];
      const double m = atoms_.masses()[i];
      mass += m;
      center += m * x[k];
      v += m * Vec3<double>(atoms_.velocities()[i]);
      kind.emplace_back(type(i), m, charge(i));
    }
    center /= mass;
    v /= mass;
    for (Vec3<double>& one : x) one -= center;
    auto known = kinds_.find(kind);
    const bool is_new = known == kinds_.end();
    if (is_new) known = kinds_.emplace(kind, body_of(molecule, x)).first;
    RigidBody body = known->second;
    body.name = atoms_.name(first);
    const Quaternion<double> q = is_new ? body.axes : laid_over(body.sites, x);
    const Mat3<double> r = rotation_matrix<double>(q);
    Vec3<double> spin = Vec3<double>::Zero();
    double farthest = 0, most = 0;
    for (std::size_t k = 0; k < molecule.size(); ++k) {
      const Vec3<double> arm = to_space(r, body.sites[k].place);
      spin += body.sites[k].mass * cross<double>(arm, Vec3<double>(atoms_.velocities()[molecule[k]]) - v);
      farthest = std::max(farthest, arm.norm());
      most = std::max(most, (arm - x[k]).norm());
    }
    if (!(most <= tolerance_ * farthest)) refuse_shape(molecule, most);
    body.axes = {1, 0, 0, 0};  // the rotation is from the principal axes already
    const Index at = add_body(made_, bodies_, body, {.x = origin + center, .v = v, .orientation = q, .spin = spin});
    double total = 0;
    for (const Index i : molecule) total += charge(i);
    if (charges_ != nullptr) made_.column<Charge>()[at] = total;
    types_.push_back(type(first));
  }

  /// Places of the atoms from the first one: along bonds by nearest images, or of molecules by number all at once.
  std::vector<Vec3<double>> unfolded(const Molecule& molecule) const {
    const auto& x = atoms_.positions();
    const auto image = [&](Index i, Index from) { return atoms_.box().minimum_image(Vec3<double>(x[i] - x[from])); };
    std::vector<Vec3<double>> places(molecule.size(), Vec3<double>::Zero());
    std::vector<bool> placed(molecule.size(), false);
    placed[0] = true;
    if (!atoms_.box().is_periodic() || bonded_.empty()) {
      for (std::size_t k = 1; k < molecule.size(); ++k) {
        places[k] = image(molecule[k], molecule[0]);
        const bool whole = !atoms_.box().is_periodic() || places[k].norm() < atoms_.box().edges().minCoeff() / 4;
        if (!whole) refuse_folded(molecule);
      }
      return places;
    }
    std::vector<std::size_t> open = {0};
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      for (const Index next : bonded_[static_cast<std::size_t>(molecule[from])]) {
        const auto to =
            static_cast<std::size_t>(std::lower_bound(molecule.begin(), molecule.end(), next) - molecule.begin());
        if (placed[to]) continue;
        placed[to] = true;
        places[to] = places[from] + image(next, molecule[from]);
        open.push_back(to);
      }
    }
    return places;
  }

  [[noreturn]] void refuse_folded(const Molecule& molecule) const {
    throw Error(fmt::format("the molecule of '{}' reaches over a quarter of the box, so without bonds its shape is "
                            "ambiguous; add bonds",
                            atoms_.name(molecule.front())),
                {.key = "molecules"});
  }

  RigidBody body_of(const Molecule& molecule, const std::vector<Vec3<double>>& x) const {
    std::vector<BodySite> sites;
    for (std::size_t k = 0; k < molecule.size(); ++k) {
      const Index i = molecule[k];
      sites.push_back({x[k], atoms_.masses()[i], charge(i), type(i), atoms_.name(i)});
    }
    const std::string& name = atoms_.name(molecule.front());
    return body_of_sites(name, std::move(sites), std::nullopt,
                         1e-5);  // carbon dioxide in the digits of a file is a line
  }

  [[noreturn]] void refuse_shape(const Molecule& molecule, double most) const {
    throw Error(
        fmt::format("the molecule of '{}' has another shape than the first of its kind: an atom is {:.3g} {} off; "
                    "rigid molecules of one kind have one shape",
                    atoms_.name(molecule.front()), most, atoms_.units().length),
        {.key = "molecules"});
  }

  void give_topology() {
    const Topology* given = atoms_.topology();
    if (given == nullptr) return;
    auto topology = std::make_shared<Topology>();
    topology->type_names = given->type_names;
    topology->pair_kinds = given->pair_kinds;
    topology->mixing = given->mixing;
    topology->explicit_pairs = given->explicit_pairs;
    topology->stated_cutoff = given->stated_cutoff;
    topology->types = types_;
    made_.set_topology(std::move(topology));
  }

  const ParticleSystem<double>& atoms_;
  double tolerance_;
  const ScalarColumn<double>* charges_;
  ParticleSystem<double> made_;
  Bodies bodies_;
  std::vector<std::vector<Index>> bonded_;  ///< to each atom; empty without bonds
  std::map<AtomKinds, RigidBody> kinds_;
  std::vector<std::int64_t> types_;
};

/// @throws Error  for an excluded or scaled pair of atoms of two molecules, which bodies do not know
void check_pairs(const ParticleSystem<double>& atoms, const std::vector<Molecule>& all) {
  const Topology* topology = atoms.topology();
  if (topology == nullptr) return;
  std::vector<std::size_t> molecule(static_cast<std::size_t>(atoms.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const Index i : all[k]) molecule[static_cast<std::size_t>(i)] = k;
  }
  const auto check = [&](Index i, Index j) {
    if (molecule[static_cast<std::size_t>(i)] == molecule[static_cast<std::size_t>(j)]) return;
    throw Error(fmt::format("the pair of '{}' and '{}' is excluded, but they are of two molecules, and rigid molecules "
                            "have no such pairs",
                            atoms.name(i), atoms.name(j)),
                {.key = "exclusions"});
  };
  for (const auto& [i, j] : topology->exclusions) check(i, j);
  for (const auto& one : topology->scaled_pairs) check(one.pair.first, one.pair.second);
}

}  // namespace

ParticleSystem<double> make_rigid(const ParticleSystem<double>& atoms, double tolerance) {
  const std::vector<Molecule> molecules = molecules_of(atoms);
  check_pairs(atoms, molecules);
  return MakeRigid(atoms, tolerance).make(molecules);
}

}  // namespace noether
