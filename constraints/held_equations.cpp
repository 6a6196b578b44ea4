// Constraints as equations of a state: g(x) = 0, and dg/dt = g'(x) v = 0.

#include "constraints/constraint_set.hpp"

#include <cmath>
#include <limits>

namespace noether {

namespace {

template <class Real> class HeldEquations final : public Equations<Real> {
 public:
  using Gradients = typename Equations<Real>::Gradients;

  explicit HeldEquations(const ConstraintSet& set) : set_(set) {}

  std::unique_ptr<Equations<Real>> clone() const override { return std::make_unique<HeldEquations>(*this); }
  std::string name() const override { return "constraints"; }
  std::string signature() const override { return set_.signature(); }
  bool vanish() const override { return true; }
  void bind(const ParticleSystem<Real>& s) override {
    if (s.box().is_periodic()) {
      throw SchemeMismatch("constraints in a periodic box are not projected onto; take the projection out",
                           {.key = "onto"});
    }
    set_.find(s.ids());
    moved_ = VectorColumn<Real>(s.size());
  }
  Index size() const override { return 2 * set_.equations(); }

  /// All g, then all dg/dt.
  void values(const ParticleSystem<Real>& s, Real* g, Real* scale) override {
    using std::sqrt;
    const Index count = set_.equations();
    const ConstraintPositions<Real> x(s.positions()), moved(moved_);
    const Real step = small_step(s);
    Index at = 0;
    each([&](const ConstraintGroup& group, Index c) {
      group.values(x, c, c + 1, g + at);
      gradients_.resize(static_cast<std::size_t>(group.equations() * group.particles()));
      group.gradients(x, c, c + 1, gradients_.data());
      turned_ = gradients_;
      if (step > Real(0)) {
        for (Index k = 0; k < group.particles(); ++k) move(s, group.particle(c, k), step);
        group.gradients(moved, c, c + 1, turned_.data());
      }
      for (Index e = 0; e < group.equations(); ++e, ++at) {
        scale[at] = Real(group.scale(c));  // and what rounding of positions makes of it, far from the origin
        g[count + at] = scale[count + at] = Real(0);
        for (Index k = 0; k < group.particles(); ++k) {
          const Vec3<Real> slope = gradients_[static_cast<std::size_t>(e * group.particles() + k)];
          const Vec3<Real> place = s.positions()[group.particle(c, k)], v = s.velocities()[group.particle(c, k)];
          scale[at] += Real(sqrt(norm2(slope) * norm2(place)));
          if (step > Real(0)) {  // dg/dt changes with x by g'' v
            const Vec3<Real> change = turned_[static_cast<std::size_t>(e * group.particles() + k)] - slope;
            scale[count + at] += Real(sqrt(norm2(change) * norm2(place))) / step;
          }
          g[count + at] += dot(slope, v);
          scale[count + at] += Real(sqrt(norm2(slope) * norm2(v)));
        }
      }
    });
  }
  void gradients(const ParticleSystem<Real>& s, Gradients& G, Index first) override {
    const Index n = s.size(), count = set_.equations();
    put(ConstraintPositions<Real>(s.positions()), Real(1), G, 0, first);
    put(ConstraintPositions<Real>(s.positions()), Real(1), G, 3 * n, first + count);
    // What dg/dt changes by with x is g'' v: differences of gradients along v.
    const Real step = small_step(s);
    if (step == Real(0)) return;
    for (const int side : {1, -1}) {
      for (Index i = 0; i < n; ++i) move(s, i, Real(side) * step);
      put(ConstraintPositions<Real>(moved_), Real(side) / (Real(2) * step), G, 0, first + count);
    }
  }

 private:
  template <class Visit> void each(const Visit& visit) const {
    for (const auto& group : set_.groups()) {
      for (Index c = 0; c < group->size(); ++c) visit(*group, c);
    }
  }
  /// Puts a particle where it would be after a short time.
  void move(const ParticleSystem<Real>& s, Index i, const Real& time) {
    const Vec3<Real> x = s.positions()[i], v = s.velocities()[i];
    moved_.set(i, Vec3<Real>(x + time * v));
  }
  /// Adds `factor` times the gradients at x to rows from `row` on.
  void put(const ConstraintPositions<Real>& x, const Real& factor, Gradients& G, Index row, Index column) {
    const Index n = G.rows() / 6;
    each([&](const ConstraintGroup& group, Index c) {
      gradients_.resize(static_cast<std::size_t>(group.equations() * group.particles()));
      group.gradients(x, c, c + 1, gradients_.data());
      for (Index e = 0; e < group.equations(); ++e, ++column) {
        for (Index k = 0; k < group.particles(); ++k) {
          const Vec3<Real> slope = gradients_[static_cast<std::size_t>(e * group.particles() + k)];
          for (Index d = 0; d < 3; ++d) G(row + d * n + group.particle(c, k), column) += factor * slope[d];
        }
      }
    });
  }
  /// A time in which nothing held moves far beside what holds it; 0 where nothing moves.
  Real small_step(const ParticleSystem<Real>& s) const {
    using std::cbrt, std::max, std::min, std::sqrt;
    Real least(std::numeric_limits<double>::max()), fast(0);
    each([&](const ConstraintGroup& group, Index c) {
      const Vec3<Real> first = s.positions()[group.particle(c, 0)];
      Real reach2 = group.particles() == 1 ? norm2(first) : Real(0);
      for (Index k = 0; k < group.particles(); ++k) {
        reach2 = max(reach2, norm2(Vec3<Real>(s.positions()[group.particle(c, k)] - first)));
        fast = max(fast, norm2(Vec3<Real>(s.velocities()[group.particle(c, k)])));
      }
      if (reach2 > Real(0)) least = min(least, reach2);
    });
    if (fast == Real(0)) return Real(0);
    return Real(cbrt(std::numeric_limits<Real>::epsilon())) * Real(sqrt(least / fast));
  }

  ConstraintSet set_;
  std::vector<Vec3<Real>> gradients_, turned_;
  VectorColumn<Real> moved_;
};

}  // namespace

template <class Real> std::unique_ptr<Equations<Real>> ConstraintSet::as_equations() const {
  return std::make_unique<HeldEquations<Real>>(*this);
}
template std::unique_ptr<Equations<double>> ConstraintSet::as_equations() const;
template std::unique_ptr<Equations<Quad>> ConstraintSet::as_equations() const;

}  // namespace noether
