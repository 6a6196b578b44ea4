#pragma once
/// An invariant that a program writes itself, as equations with gradients by dual numbers.

#include "engine/equations.hpp"
#include "engine/signature.hpp"
#include "integrators/particle_vector.hpp"
#include "numbers/dual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// Particles at one moment, over any number type: what an invariant of theirs is a function of.
template <class Real> class ParticleState {
 public:
  /// @param y  all x, y, z, then velocities likewise, shape (6 n)
  ParticleState(const Vector<Real>& y, const double* masses) : y_(&y), masses_(masses), n_(y.size() / 6) {}

  Index size() const { return n_; }
  Vec3<Real> x(Index i) const { return {(*y_)[i], (*y_)[n_ + i], (*y_)[2 * n_ + i]}; }
  Vec3<Real> v(Index i) const { return {(*y_)[3 * n_ + i], (*y_)[4 * n_ + i], (*y_)[5 * n_ + i]}; }
  Real m(Index i) const { return Real(masses_[i]); }

 private:
  const Vector<Real>* y_;
  const double* masses_;
  Index n_;
};

/// A function of particles, or of the variables of a first-order system: one value, or an array of some.
///
///     struct Laplace {  // the x component of Laplace's vector, G (m1 + m2) = 1
///       template <class Real> Real operator()(const ParticleState<Real>& s) const {
///         const Vec3<Real> r = s.x(1) - s.x(0), v = s.v(1) - s.v(0);
///         return v.cross(r.cross(v))[0] - r[0] / r.norm();
///       }
///     };
///     struct Rabbits {  // of a first-order system
///       template <class Real> Real operator()(const Vector<Real>& y) const {
///         using std::log;
///         return y[0] - log(y[0]) + y[1] - log(y[1]);
///       }
///     };
template <class G, class Real>
concept InvariantOfParticles = requires(const G& g, const ParticleState<Real>& s) {
  g(s);
};
template <class G, class Real>
concept InvariantOfVariables = requires(const G& g, const Vector<Real>& y) {
  g(y);
};
template <class G>
concept OwnInvariant = InvariantOfParticles<G, double> || InvariantOfVariables<G, double>;

/// Such a function as equations that keep the values of the start.
/// @cost gradients: an evaluation in four directions for every four numbers of y
template <OwnInvariant G, class Real> class OwnEquations final : public Equations<Real> {
 public:
  explicit OwnEquations(G g) : g_(std::move(g)) {}

  std::unique_ptr<Equations<Real>> clone() const override { return std::make_unique<OwnEquations>(*this); }
  std::string name() const override {
    const std::string own = detail::name_of(g_);
    return own.empty() ? "an invariant of your own" : own;
  }
  std::string signature() const override { return detail::name_of(g_).empty() ? name() : detail::signature_of(g_); }
  void bind(const ParticleSystem<Real>& s) override {
    if (of_particles != s.variables().empty()) {
      throw Error("an invariant of " + std::string(of_particles ? "particles" : "variables") +
                  " cannot be projected onto in a run of " + (of_particles ? "variables" : "particles"));
    }
    y_.resize(0);
    masses_.clear();
    for (Index i = 0; i < s.size(); ++i) masses_.push_back(static_cast<double>(s.masses()[i]));
  }
  Index size() const override { return static_cast<Index>(std::tuple_size_v<Array<Real>>); }

  void values(const ParticleSystem<Real>& s, Real* g, Real* scale) override {
    using std::abs;
    differentiate(s);
    const Array<Real> now = evaluate<Real>(y_);
    for (Index k = 0; k < size(); ++k) {
      g[k] = now[static_cast<std::size_t>(k)];
      // What rounding of y makes of it.
      scale[k] = Real(abs(g[k]));
      for (Index i = 0; i < y_.size(); ++i) scale[k] += Real(abs(G_(i, k) * y_[i]));
    }
  }
  void gradients(const ParticleSystem<Real>& s, Matrix<Real>& G_out, Index first) override {
    differentiate(s);
    G_out.middleCols(first, size()) = G_;
  }

 private:
  /// The gradients at y, in G_; those of the last y are known.
  void differentiate(const ParticleSystem<Real>& s) {
    constexpr std::size_t width = 4;
    using D = Dual<Real, width>;
    known_ = y_;
    gather(s);
    if (G_.cols() == size() && known_.size() == y_.size() && known_ == y_) return;
    G_.resize(y_.size(), size());
    Vector<D> point(y_.size());
    for (Index i = 0; i < y_.size(); ++i) point[i] = D(y_[i]);
    for (Index begin = 0; begin < y_.size(); begin += static_cast<Index>(width)) {
      const Index end = std::min<Index>(begin + static_cast<Index>(width), y_.size());
      for (Index i = begin; i < end; ++i) point[i].slope[static_cast<std::size_t>(i - begin)] = Real(1);
      const Array<D> g = evaluate<D>(point);
      for (Index k = 0; k < size(); ++k) {
        for (Index i = begin; i < end; ++i)
          G_(i, k) = g[static_cast<std::size_t>(k)].slope[static_cast<std::size_t>(i - begin)];
      }
      for (Index i = begin; i < end; ++i) point[i] = D(y_[i]);
    }
  }

  static constexpr bool of_particles = InvariantOfParticles<G, double>;

  template <class T> using Argument = std::conditional_t<of_particles, ParticleState<T>, Vector<T>>;
  template <class T>
  using Result = std::decay_t<decltype(std::declval<const G&>()(std::declval<const Argument<T>&>()))>;
  template <class T> struct as_array { using type = std::array<T, 1>; };
  template <class T, std::size_t m> struct as_array<std::array<T, m>> { using type = std::array<T, m>; };
  template <class T> using Array = typename as_array<Result<T>>::type;

  template <class T> Array<T> evaluate(const Vector<T>& y) const {
    if constexpr (of_particles) {
      return {g_(ParticleState<T>(y, masses_.data()))};
    } else {
      return {g_(y)};
    }
  }
  void gather(const ParticleSystem<Real>& s) {
    if constexpr (of_particles) {
      detail::gather_particles(s, y_);
    } else {
      y_.resize(static_cast<Index>(s.variables().size()));
      for (Index i = 0; i < y_.size(); ++i) y_[i] = s.variables()[static_cast<std::size_t>(i)];
    }
  }

  G g_;
  std::vector<double> masses_;
  Vector<Real> y_, known_;
  Matrix<Real> G_;  ///< the gradients at y
};

}  // namespace noether
