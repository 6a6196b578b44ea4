#include "constraints/constraint_stages.hpp"
#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace noether {

namespace {

/// A bond whose relative violation is larger is lost.
constexpr double lost_violation = 0.01;

/// LINCS of distances, all of them together: the matrix by a series of its couplings, then corrections of lengths,
/// which grow where bonds turn. Threads share the constraints, as P-LINCS has it: each power of the series needs of a
/// constraint nothing but its neighbors.
/// @source HessEtAl1997, Hess2008
class LincsConstraints final : public ConstraintStages<double> {
 public:
  using Equations = ConstraintEquations<double>;

  explicit LincsConstraints(const Equations& equations);

  bool prepare(Equations& equations, const ParticleSystem<double>& s) override;
  bool solve_positions(Equations& equations, const ParticleSystem<double>& s, VectorColumn<double>& x,
                       const double& h) override;
  void project_velocities(Equations& equations, ParticleSystem<double>& s, const double& h) override;

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  template <class Work> void for_bonds(const Work& work) const {
    for_blocks(static_cast<Index>(g_.size()), [&](Index begin, Index end) {
      for (Index e = begin; e < end; ++e) work(e);
    });
  }
  void expand(Index order);
  /// Adds what the series comes to, and moves particles from where free motion ends.
  void take(Equations& equations, const ParticleSystem<double>& s, VectorColumn<double>& x) const;
  /// The largest relative violation of the bond vectors found last.
  double violation(const Equations& equations) const;
  /// @return whether no bond is lost; else the first one is named
  bool check(Equations& equations, const ParticleSystem<double>& s, const char* why) const;
  const char* why_lost(Equations& equations, const ParticleSystem<double>& s);

  // Neighbors of bond e, which share a particle with it, are [first_[e], first_[e + 1]).
  std::vector<Index> first_, neighbor_;
  std::vector<double> weight_;    ///< of a neighbor: the inverse mass of the particle, with a sign
  std::vector<double> coupling_;  ///< weight times the product of the bond vectors
  std::vector<double> inverse_;   ///< of the diagonal
  std::vector<double> g_, sum_, next_;
  std::vector<double> lost_;  ///< by how much a bond is, or 0
  ConstraintGradients<double> now_;
  VectorColumn<double> free_;
};

LincsConstraints::LincsConstraints(const Equations& equations)
    : now_(equations.layout().particle.size(), Vec3<double>::Zero()), free_(equations.start()) {
  const ConstraintLayout<double>& layout = equations.layout();
  const Index n = layout.equations();
  std::vector<std::vector<Index>> ends(at(free_.size()));  // entries of the layout, by particle
  for (std::size_t a = 0; a < layout.particle.size(); ++a)
    ends[at(layout.particle[a])].push_back(static_cast<Index>(a));
  first_.push_back(0);
  for (Index e = 0; e < n; ++e) {
    double whole = 0;
    for (const Index a : {2 * e, 2 * e + 1}) {
      whole += layout.inverse_mass[at(a)];
      for (const Index b : ends[at(layout.particle[at(a)])]) {
        if (b == a) continue;
        neighbor_.push_back(b / 2);
        weight_.push_back(a % 2 == b % 2 ? layout.inverse_mass[at(a)] : -layout.inverse_mass[at(a)]);
      }
    }
    first_.push_back(static_cast<Index>(neighbor_.size()));
    inverse_.push_back(1 / (whole * equations.scale(e)));
  }
  coupling_.resize(weight_.size());
  for (std::vector<double>* list : {&g_, &sum_, &next_, &lost_}) list->assign(at(n), 0);
}

bool LincsConstraints::prepare(Equations& equations, const ParticleSystem<double>& /*s*/) {
  const ConstraintGradients<double>& r = equations.gradients();
  for_bonds([&](Index e) {
    for (Index k = first_[at(e)]; k < first_[at(e) + 1]; ++k)
      coupling_[at(k)] = weight_[at(k)] * dot(r[at(2 * e)], r[at(2 * neighbor_[at(k)])]);
  });
  return true;
}

/// (D + C)^-1 g by its series, D^-1 (g - C D^-1 g + ...), to so many powers of the couplings C.
void LincsConstraints::expand(Index order) {
  for_bonds([&](Index e) { sum_[at(e)] = inverse_[at(e)] * g_[at(e)]; });
  for (Index power = 0; power < order; ++power) {
    for_bonds([&](Index e) {
      double rest = g_[at(e)];
      for (Index k = first_[at(e)]; k < first_[at(e) + 1]; ++k) rest -= coupling_[at(k)] * sum_[at(neighbor_[at(k)])];
      next_[at(e)] = inverse_[at(e)] * rest;
    });
    std::swap(sum_, next_);
  }
}

void LincsConstraints::take(Equations& equations, const ParticleSystem<double>& s, VectorColumn<double>& x) const {
  for (Index e = 0; e < equations.size(); ++e) equations.multipliers()[e] += sum_[at(e)];
  x = free_;
  equations.push(x, equations.start_gradients(), equations.multipliers(), 1);
  equations.round_to_grid(s.box(), x);
}

double LincsConstraints::violation(const Equations& equations) const {
  double worst = 0;
  for (Index e = 0; e < equations.size(); ++e)
    worst = std::max(worst, std::abs(norm2(now_[at(2 * e)]) / equations.scale(e) - 1) / 2);
  return worst;
}

bool LincsConstraints::check(Equations& equations, const ParticleSystem<double>& s, const char* why) const {
  const auto worst = std::find_if(lost_.begin(), lost_.end(), [](double lost) { return lost != 0; });
  if (worst == lost_.end()) return true;
  equations.fail(s, static_cast<Index>(worst - lost_.begin()), fmt::format(fmt::runtime(why), *worst));
  return false;
}

/// Why a bond that is so many times as long as it ought to be cannot be corrected: it has turned, or the series
/// diverges.
const char* LincsConstraints::why_lost(Equations& equations, const ParticleSystem<double>& s) {
  const auto lost = std::find_if(lost_.begin(), lost_.end(), [](double by) { return by != 0; });
  if (lost == lost_.end()) return "";
  const Index e = lost - lost_.begin();
  const Vec3<double>& r = equations.start_gradients()[at(2 * e)];
  equations.find_gradients(equations.seen(s, free_), now_);
  const Vec3<double>& free = now_[at(2 * e)];
  const double along = dot(free, r), across2 = norm2(free) - along * along / norm2(r);
  if (across2 >= 0.5 * equations.scale(e)) {
    return "turns by more than 45 degrees in a step, where lincs cannot correct its length (it would be {:.3g} times "
           "as "
           "long): the step is too large";
  }
  return "is {:.3g} times as long after the series of lincs, which does not converge for its neighbors; use solver = "
         "\"newton\"";
}

bool LincsConstraints::solve_positions(Equations& equations, const ParticleSystem<double>& s, VectorColumn<double>& x,
                                       const double& /*h*/) {
  const ConstraintOptions& options = equations.options();
  const ConstraintGradients<double>& start = equations.start_gradients();
  equations.multipliers().setZero();
  free_ = x;
  equations.find_gradients(equations.seen(s, x), now_);
  const bool looks = equations.looks();
  const double before = looks ? violation(equations) : 0;
  for_bonds([&](Index e) {
    const Vec3<double>& r = start[at(2 * e)];
    const double d2 = equations.scale(e), r2 = norm2(r), violation = std::abs(r2 - d2) / (2 * d2);
    lost_[at(e)] = violation <= lost_violation ? 0 : violation;
    g_[at(e)] = dot(r, now_[at(2 * e)]) - 0.5 * (d2 + r2);  // |r| d, but for a square of their difference
  });
  if (!check(equations, s,
             "is violated by {:.3g} where a step starts: lincs no longer holds it; shorten the step, raise the order, "
             "or use solver = \"newton\""))
    return false;
  expand(options.order);
  take(equations, s, x);
  for (Index k = 0; k < options.most_iterations(); ++k) {
    equations.find_gradients(equations.seen(s, x), now_);
    for_bonds([&](Index e) {
      const double d2 = equations.scale(e), l2 = norm2(now_[at(2 * e)]), left = 2 * d2 - l2;
      lost_[at(e)] = left >= 0 ? 0 : std::sqrt(l2 / d2);
      g_[at(e)] = d2 - std::sqrt(d2 * left);
    });
    if (!check(equations, s, why_lost(equations, s))) return false;
    expand(options.order);
    take(equations, s, x);
  }
  equations.find_gradients(equations.seen(s, x), now_);
  for_bonds([&](Index e) {
    const double d2 = equations.scale(e), l2 = norm2(now_[at(2 * e)]);
    lost_[at(e)] = std::abs(l2 - d2) <= 2 * lost_violation * d2 ? 0 : std::sqrt(l2 / d2);
  });
  if (!check(equations, s, why_lost(equations, s))) return false;
  const Index powers = (options.most_iterations() + 1) * options.order;
  equations.count_iterations(powers);
  if (looks) equations.measure(before, violation(equations), powers);
  return true;
}

void LincsConstraints::project_velocities(Equations& equations, ParticleSystem<double>& s, const double& /*h*/) {
  const Index order = equations.options().order;
  for_bonds([&](Index e) {
    g_[at(e)] = equations.along(e, s.velocities(), equations.gradients());
    lost_[at(e)] = std::isfinite(g_[at(e)]) ? 0 : g_[at(e)];
  });
  if (!check(equations, s, "has a velocity across it of {}, which is not a finite number")) return;
  expand(order);
  equations.count_iterations(order);
  for (Index e = 0; e < equations.size(); ++e) equations.values()[e] = sum_[at(e)];
  equations.push(s.velocities(), equations.gradients(), equations.values(), 1);
}

}  // namespace

std::unique_ptr<ConstraintStages<double>> lincs_constraints(const ConstraintEquations<double>& equations) {
  return std::make_unique<LincsConstraints>(equations);
}

}  // namespace noether
