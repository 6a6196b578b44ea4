#include "integrators/particle_scales.hpp"

#include "engine/topology.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/parallel.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

using Vec = Eigen::Vector3d;

template <class Real> Vec in_doubles(const Vec3<Real>& x) {
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

/// Half the time until two bodies are nearest along a straight line, and twice what it takes to go as far as they are
/// apart then; infinity where they do not come nearer, or deflect each other by less than `rtol`.
double time_to_passage(const Vec& d, const Vec& v, double GM, double soft2, double rtol) {
  const double along = d.dot(v), v2 = v.squaredNorm();
  if (!(along < 0)) return std::numeric_limits<double>::infinity();
  const double nearest = std::sqrt(d.cross(v).squaredNorm() / v2 + soft2);
  if (2 * GM < rtol * nearest * v2) return std::numeric_limits<double>::infinity();
  return -0.5 * along / v2 + 2 * nearest / std::sqrt(v2);
}

template <class Real> class Measuring {
 public:
  Measuring(const ParticleSystem<Real>& s, const Coupling& coupling, double rtol, ParticleScales& out)
      : s_(s), coupling_(coupling), rtol_(rtol), out_(out) {}

  void gravity() {
    const Index n = s_.size();
    std::vector<Index>& massive = out_.work.massive;
    massive.clear();
    for (Index j = 0; j < n; ++j) {
      if (s_.masses()[j] != Real(0)) massive.push_back(j);
    }
    std::vector<double>& longest = out_.work.longest;
    longest.resize(static_cast<std::size_t>(n));
    for_blocks(n, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) longest[static_cast<std::size_t>(i)] = attract(i);
    });
    out_.longest = *std::min_element(longest.begin(), longest.end());
    for (Index i = 0; i < n && out_.lost < 0; ++i) {
      if (is_lost(i)) out_.lost = i;
    }
  }

  void all_pairs() {
    for_blocks(s_.size(), [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        for (Index j = 0; j < s_.size(); ++j) {
          if (j != i) pair(i, j);
        }
      }
    });
  }

  void listed(NeighborList& list) requires std::is_same_v<Real, double> {
    list.update(s_);
    const double* const records = list.records();
    const std::vector<std::int32_t>& particles = list.particles_of_records();
    const auto nobody = static_cast<Index>(particles.size()) - 1;
    for_blocks(list.groups(), [&](Index begin, Index end) {
      for (Index g = begin; g < end; ++g) {
        const NeighborList::Group group = list.group(g);
        for (Index lane = 0; lane < NeighborList::group_size; ++lane) {
          const Index i = group.particles[lane];
          if (i < 0) continue;
          const double* const own = records + group.records[lane];
          for (Index row = 0; row < group.rows; ++row) {
            const Index entry = group.entries[NeighborList::group_size * row + lane], record = entry / 4;
            if (record == nobody) continue;
            const double* const other = records + entry;
            take(i, particles[static_cast<std::size_t>(record)],
                 Vec(own[0] - other[0], own[1] - other[1], own[2] - other[2]).norm());
          }
        }
      }
    });
  }

  void bonds() {
    if (s_.topology() == nullptr) return;
    for (const BondedTerm<2>& bond : s_.topology()->bonds) {
      pair(bond.particles[0], bond.particles[1]);
      pair(bond.particles[1], bond.particles[0]);
    }
  }

 private:
  double mass(Index i) const { return static_cast<double>(s_.masses()[i]); }
  Vec relative_velocity(Index i, Index j) const {
    return in_doubles(Vec3<Real>(s_.velocities()[i] - s_.velocities()[j]));
  }

  /// Of a tracer massive bodies alone are neighbors; of a body all are, for what goes round it may have no mass.
  /// @return how far a step may go on its account
  double attract(Index i) {
    const bool tracer = s_.masses()[i] == Real(0);
    const std::vector<Index>& massive = out_.work.massive;
    const double soft2 = coupling_.softening * coupling_.softening;
    const Index n = tracer ? static_cast<Index>(massive.size()) : s_.size();
    double longest = std::numeric_limits<double>::infinity();
    for (Index k = 0; k < n; ++k) {
      const Index j = tracer ? massive[static_cast<std::size_t>(k)] : k;
      if (j == i) continue;
      const Vec d = in_doubles(Vec3<Real>(s_.positions()[i] - s_.positions()[j])), v = relative_velocity(i, j);
      const double M = mass(i) + mass(j), GM = coupling_.G * M, r = std::sqrt(d.squaredNorm() + soft2);
      if (is_nearest(i, M, r)) {
        const double v2 = v.squaredNorm();
        set(i, j, r, std::sqrt(std::max(v2, GM / r)));
        out_.work.binding[static_cast<std::size_t>(i)] = std::abs(v2 * r / GM - 2);
      }
      longest = std::min(longest, time_to_passage(d, v, GM, soft2, rtol_));
    }
    double& part = out_.part[static_cast<std::size_t>(i)];
    if (out_.length[static_cast<std::size_t>(i)] > 0)
      part = std::clamp(out_.work.binding[static_cast<std::size_t>(i)], ParticleScales::least_part, 1.0);
    return longest;
  }
  /// Whether rounding of its position is a tenth of its energy about its neighbor. Near the origin it never is: an
  /// orbit about the origin may be a parabola, whose energy is 0.
  bool is_lost(Index i) const {
    constexpr double rounding = 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    const auto at = static_cast<std::size_t>(i);
    if (out_.length[at] == 0) return false;
    const double far = in_doubles(Vec3<Real>(s_.positions()[i])).norm() / out_.length[at];
    return far > 1000 && rounding * far > 0.1 * std::min(out_.work.binding[at], 1.0);
  }

  void pair(Index i, Index j) {
    take(i, j, in_doubles(s_.box().minimum_image(Vec3<Real>(s_.positions()[i] - s_.positions()[j]))).norm());
  }
  void take(Index i, Index j, double r) {
    if (is_nearest(i, mass(i) + mass(j), r)) set(i, j, r, relative_velocity(i, j).norm());
  }
  /// Whether nobody before has had a larger (m_i + m_j) / r^3.
  bool is_nearest(Index i, double masses, double r) {
    double& strongest = out_.work.strength[static_cast<std::size_t>(i)];
    const double strength = masses / (r * r * r);
    if (!(strength > strongest)) return false;
    strongest = strength;
    return true;
  }
  void set(Index i, Index j, double r, double speed) {
    const auto at = static_cast<std::size_t>(i);
    out_.length[at] = r;
    out_.speed[at] = speed;
    out_.neighbor[at] = j;
  }

  const ParticleSystem<Real>& s_;
  const Coupling& coupling_;
  double rtol_;
  ParticleScales& out_;
};

/// So many particles are compared with each other sooner than sorted.
constexpr Index few = 64;

}  // namespace

template <class Real>
void measure(const ParticleSystem<Real>& s, const Coupling& coupling, NeighborList* list, double rtol,
             ParticleScales& out) {
  const auto n = static_cast<std::size_t>(s.size());
  out.length.assign(n, 0.0);
  out.speed.assign(n, 0.0);
  out.neighbor.assign(n, 0);
  out.part.assign(n, 1.0);
  out.lost = -1;
  for (auto* all : {&out.work.strength, &out.work.binding}) all->assign(n, 0.0);
  out.size = out.fastest = 0;
  out.gravity = coupling.gravity;
  out.longest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < s.size(); ++i) {
    out.size = std::max(out.size, in_doubles(Vec3<Real>(s.positions()[i])).norm());
    out.fastest = std::max(out.fastest, in_doubles(Vec3<Real>(s.velocities()[i])).norm());
  }
  if (!coupling.any() || n < 2) return;
  Measuring<Real> measuring(s, coupling, rtol, out);
  if (coupling.gravity) {
    measuring.gravity();
  } else {
    if constexpr (std::is_same_v<Real, double>) {
      if (coupling.range > 0 && list != nullptr && s.size() > few) measuring.listed(*list);
    }
    if (coupling.range > 0 && (list == nullptr || s.size() <= few)) measuring.all_pairs();
    if (coupling.bonded) measuring.bonds();
  }
}

template void measure(const ParticleSystem<double>&, const Coupling&, NeighborList*, double, ParticleScales&);
template void measure(const ParticleSystem<Quad>&, const Coupling&, NeighborList*, double, ParticleScales&);

}  // namespace noether
