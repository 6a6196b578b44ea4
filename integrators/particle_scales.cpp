#include "integrators/particle_scales.hpp"

#include "engine/topology.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

template <class Real> Eigen::Vector3d in_doubles(const Vec3<Real>& x) {
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

/// The state of one particle in doubles, or differences of two.
struct Point {
  double x, y, z, vx, vy, vz;

  double distance2() const { return x * x + y * y + z * z; }
  double speed2() const { return vx * vx + vy * vy + vz * vz; }
  /// How fast the square of the distance grows, halved.
  double along() const { return x * vx + y * vy + z * vz; }
  /// |x cross v|^2.
  double swept2() const {
    const double a = y * vz - z * vy, b = z * vx - x * vz, c = x * vy - y * vx;
    return a * a + b * b + c * c;
  }
};

template <class Real> class Measuring {
 public:
  Measuring(const ParticleSystem<Real>& s, const Coupling& coupling, double rtol, ParticleScales& out)
      : s_(s), coupling_(coupling), rtol_(rtol), out_(out), soft2_(coupling.softening * coupling.softening) {}

  void gravity() {
    const Index n = s_.size();
    std::vector<Index>& massive = out_.work.massive;
    massive.clear();
    for (Index j = 0; j < n; ++j) {
      if (s_.masses()[j] != Real(0)) massive.push_back(j);
      mass_unit_ = std::max(mass_unit_, mass(j));
    }
    length_unit_ = out_.size > 0 ? out_.size : 1;
    for (auto* all : {&out_.work.forward, &out_.work.backward})
      all->assign(static_cast<std::size_t>(n), std::numeric_limits<double>::infinity());
    for_blocks(n, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) attract(i);
    });
    const auto least = [](const std::vector<double>& all) { return *std::min_element(all.begin(), all.end()); };
    out_.forward.longest = least(out_.work.forward);
    out_.backward.longest = least(out_.work.backward);
    for (Index i = 0; i < n; ++i) note_if_lost(i);
  }

  void all_pairs() {
    for_blocks(s_.size(), [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        for (Index j = 0; j < s_.size(); ++j) {
          if (j != i) pair(i, j, coupling_.range);
        }
      }
    });
  }

  /// Distances are taken from the positions: those of records, and who stands in the skin, depend on the last search.
  void listed(NeighborList& list) requires std::is_same_v<Real, double> {
    list.update(s_);
    const std::vector<std::int32_t>& particles = list.particles_of_records();
    const auto nobody = static_cast<Index>(particles.size());  // the record behind the last one
    for_blocks(list.groups(), [&](Index begin, Index end) {
      for (Index g = begin; g < end; ++g) {
        const NeighborList::Group group = list.group(g);
        for (Index lane = 0; lane < NeighborList::group_size; ++lane) {
          const Index i = group.particles[lane];
          if (i < 0) continue;
          for (Index row = 0; row < group.rows; ++row) {
            const Index record = group.entries[NeighborList::group_size * row + lane] / 4;
            if (record >= nobody) continue;
            const Index j = particles[static_cast<std::size_t>(record)];
            if (j != i) pair(i, j, coupling_.range);
          }
        }
      }
    });
  }

  void bonds() {
    if (s_.topology() == nullptr) return;
    for (const BondedTerm<2>& bond : s_.topology()->bonds) {
      pair(bond.particles[0], bond.particles[1], std::numeric_limits<double>::infinity());
      pair(bond.particles[1], bond.particles[0], std::numeric_limits<double>::infinity());
    }
  }

 private:
  double mass(Index i) const { return static_cast<double>(s_.masses()[i]); }
  /// State of i less that of j.
  Point difference(Index i, Index j) const {
    const auto& x = s_.positions();
    const auto& v = s_.velocities();
    const auto less = [&](const VectorColumn<Real>& column, int k) {
      return static_cast<double>(column.component(k)[i] - column.component(k)[j]);
    };
    return {less(x, 0), less(x, 1), less(x, 2), less(v, 0), less(v, 1), less(v, 2)};
  }

  /// Of a tracer massive bodies alone are neighbors; of a body all are, for what goes round it may have no mass.
  void attract(Index i) {
    const bool tracer = s_.masses()[i] == Real(0);
    const Index* const massive = out_.work.massive.data();
    const Index n = tracer ? static_cast<Index>(out_.work.massive.size()) : s_.size();
    const auto& positions = s_.positions();
    const auto& velocities = s_.velocities();
    const Real *x = positions.component(0), *y = positions.component(1), *z = positions.component(2);
    const Real *vx = velocities.component(0), *vy = velocities.component(1), *vz = velocities.component(2);
    const Real* const m = s_.masses().data();
    const Real x_i = x[i], y_i = y[i], z_i = z[i], vx_i = vx[i], vy_i = vy[i], vz_i = vz[i];
    const double own = mass(i), per_length2 = 1 / (length_unit_ * length_unit_), per_mass = 1 / mass_unit_;
    const double soft2 = soft2_;
    // (m_i + m_j)^2 and r^6 of the neighbor so far, in units in which both stay in the range of doubles.
    double best_masses2 = 0, best_r6 = 1;
    double forward = std::numeric_limits<double>::infinity(), backward = forward;
    Index best = -1;
    for (Index k = 0; k < n; ++k) {
      const Index j = tracer ? massive[k] : k;
      if (j == i) continue;
      const Point d{static_cast<double>(x_i - x[j]),   static_cast<double>(y_i - y[j]),
                    static_cast<double>(z_i - z[j]),   static_cast<double>(vx_i - vx[j]),
                    static_cast<double>(vy_i - vy[j]), static_cast<double>(vz_i - vz[j])};
      const double both = own + static_cast<double>(m[j]), masses = both * per_mass, masses2 = masses * masses;
      const double r2 = (d.distance2() + soft2) * per_length2, r6 = r2 * r2 * r2;
      if (masses2 * best_r6 > best_masses2 * r6) {
        best_masses2 = masses2;
        best_r6 = r6;
        best = j;
      }
      const double along = d.along(), v2 = d.speed2(), half = 0.5 * std::abs(along);
      // Neither part of the time alone may be longer than the bound at hand: most pairs end here, without a root.
      double& longest = along < 0 ? forward : backward;
      const double reach = longest * v2;
      if (along == 0 || !(half < reach) || !(4 * d.swept2() < reach * reach)) continue;
      longest = std::min(longest, time_to_passage(d, v2, coupling_.G * both));
    }
    out_.work.forward[static_cast<std::size_t>(i)] = forward;
    out_.work.backward[static_cast<std::size_t>(i)] = backward;
    if (best >= 0) set_orbit(i, best);
  }
  /// Half the time until two bodies are nearest along a straight line, and twice what it takes to go as far as they are
  /// apart then; infinity where they deflect each other by less than `rtol`.
  double time_to_passage(const Point& d, double v2, double GM) const {
    const double nearest = std::sqrt(d.swept2() / v2 + soft2_);
    if (2 * GM < rtol_ * nearest * v2) return std::numeric_limits<double>::infinity();
    return 0.5 * std::abs(d.along()) / v2 + 2 * nearest / std::sqrt(v2);
  }
  void set_orbit(Index i, Index j) {
    const auto at = static_cast<std::size_t>(i);
    const Point d = difference(i, j);
    const double GM = coupling_.G * (mass(i) + mass(j)), r = std::sqrt(d.distance2() + soft2_), v2 = d.speed2();
    if (!(r > 0)) return;
    set(i, j, r, std::sqrt(std::max(v2, GM / r)));
    out_.work.binding[at] = std::abs(v2 * r / GM - 2);
    out_.work.along[at] = d.along();
    out_.part[at] = std::clamp(out_.work.binding[at], ParticleScales::least_part, 1.0);
  }
  /// Near the origin no orbit is lost: there it may be a parabola, whose energy is 0.
  void note_if_lost(Index i) {
    constexpr double rounding = 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    const auto at = static_cast<std::size_t>(i);
    if (out_.length[at] == 0) return;
    const double far = in_doubles(Vec3<Real>(s_.positions()[i])).norm() / out_.length[at];
    if (!(far > 1000 && rounding * far > 0.1 * out_.part[at])) return;
    ParticleScales::Lost& lost = out_.work.along[at] < 0 ? out_.forward.lost : out_.backward.lost;
    const Index j = out_.neighbor[at];
    if (lost.particle >= 0 || out_.work.along[at] == 0) return;
    const bool lighter = mass(i) <= mass(j);
    lost.particle = lighter ? i : j;
    lost.neighbor = lighter ? j : i;
    lost.name = s_.name(lost.particle);
    lost.neighbor_name = s_.name(lost.neighbor);
    lost.distance = out_.length[at];
  }

  void pair(Index i, Index j, double most) {
    const double r = in_doubles(s_.box().minimum_image(Vec3<Real>(s_.positions()[i] - s_.positions()[j]))).norm();
    if (!(r <= most)) return;
    double& strongest = out_.work.strength[static_cast<std::size_t>(i)];
    const double strength = (mass(i) + mass(j)) / (r * r * r);
    // Of two that are as strong the first counts, in whatever order they come.
    const bool first = strength == strongest && j < out_.neighbor[static_cast<std::size_t>(i)];
    if (!(strength > strongest || (first && strength > 0))) return;
    strongest = strength;
    set(i, j, r, std::sqrt(difference(i, j).speed2()));
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
  double soft2_, length_unit_ = 1, mass_unit_ = 0;
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
  for (auto* all : {&out.work.strength, &out.work.binding, &out.work.along}) all->assign(n, 0.0);
  out.size = out.fastest = 0;
  out.gravity = coupling.gravity;
  out.forward = out.backward = {};
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
    const bool sorted = std::is_same_v<Real, double> && list != nullptr && s.size() > few;
    if (coupling.range > 0 && !sorted) measuring.all_pairs();
    if (coupling.bonded) measuring.bonds();
  }
}

template void measure(const ParticleSystem<double>&, const Coupling&, NeighborList*, double, ParticleScales&);
template void measure(const ParticleSystem<Quad>&, const Coupling&, NeighborList*, double, ParticleScales&);

}  // namespace noether
