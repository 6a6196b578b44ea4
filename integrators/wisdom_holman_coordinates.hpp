#pragma once
/// Coordinates in which a system about a primary is split, and the order of its bodies.

#include "engine/description.hpp"
#include "engine/particle_system.hpp"
#include "engine/saved_state.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// What the position and velocity columns hold while the splitting runs; 0 is inertial, as everywhere.
enum class Coordinates : std::uint8_t {
  jacobi = 1,   ///< row 0: centre of mass; others relative to the centre of mass of all bodies further in
  democratic,   ///< row 0: centre of mass; positions relative to particle 0, velocities to the centre of mass
  whds,         ///< as democratic, velocities times (m_0 + m_i)/m_0
  barycentric,  ///< row 0: centre of mass; positions relative to it, velocities to particle 0 times (M - m_i)/M
};

template <> struct EnumNames<Coordinates> {
  static constexpr std::array<std::pair<Coordinates, std::string_view>, 4> values = {
      {{Coordinates::jacobi, "jacobi"},
       {Coordinates::democratic, "democratic"},
       {Coordinates::whds, "whds"},
       {Coordinates::barycentric, "barycentric"}}};
};

namespace detail {

/// Particles about a primary, and their way into working coordinates and back.
template <class Real> class AboutPrimary {
 protected:
  explicit AboutPrimary(Coordinates coordinates) : coordinates_(coordinates) {}

  bool jacobi() const { return coordinates_ == Coordinates::jacobi; }
  bool barycentric() const { return coordinates_ == Coordinates::barycentric; }
  /// Whether velocities are scaled: what each body has of |sum p_i|^2 is part of A, and J is what they have together.
  bool scaled() const { return coordinates_ == Coordinates::whds || barycentric(); }
  void gather_masses();
  void place_within(const std::vector<double>& axis);
  void load_order(const SavedState& saved, const std::string& prefix);
  void load_within(const SavedState& saved, const std::string& prefix);
  std::size_t massive() const { return interior_.size(); }
  bool has_tracers() const { return massive() < order_.size(); }
  Index at(std::size_t k) const { return static_cast<Index>(order_[k]); }
  std::size_t within(Index i) const { return static_cast<std::size_t>(within_[static_cast<std::size_t>(i)]); }

  void to_jacobi(VectorColumn<Real>& column) const;
  void from_jacobi(const VectorColumn<Real>& from, VectorColumn<Real>& to, const Vec3<Real>& center_of_all) const;
  void to_democratic(ParticleSystem<Real>& s) const;
  void from_democratic(ParticleSystem<Real>& s) const;
  void to_barycentric(ParticleSystem<Real>& s) const;
  void from_barycentric(ParticleSystem<Real>& s) const;
  void scale(VectorColumn<Real>& column, bool back) const;
  Vec3<Real> half_jump(const ParticleSystem<Real>& s, const Real& h) const;
  void inertial_positions(const VectorColumn<Real>& from, const Vec3<Real>& center, VectorColumn<Real>& to) const;

  std::vector<std::int64_t> order_;
  std::vector<std::int64_t> within_;         ///< by particle, k of the mass M_k that its Kepler arc goes round
  std::vector<Real> masses_;                 ///< by particle
  std::vector<Real> interior_;               ///< M_k, mass of the first k + 1 bodies in order
  std::vector<Real> scale_;                  ///< by particle, of its velocity: m_i over the reduced mass
  mutable std::vector<Vec3<Real>> centers_;  ///< of the interior masses, as the last change of coordinates met them

 private:
  Vec3<Real> mean_of(const VectorColumn<Real>& column) const;

  Coordinates coordinates_;
};

template <class Real> void AboutPrimary<Real>::gather_masses() {
  interior_.clear();
  Real total(0);
  for (const std::int64_t i : order_) {
    const Real m = masses_[static_cast<std::size_t>(i)];
    if (m == Real(0)) break;
    interior_.push_back(total += m);
  }
}

/// Tracers go round the bodies whose orbits about the primary are smaller than theirs, as bodies do.
template <class Real> void AboutPrimary<Real>::place_within(const std::vector<double>& axis) {
  within_.assign(order_.size(), 0);
  centers_.assign(massive(), Vec3<Real>::Zero());
  if (!jacobi()) return;
  for (std::size_t k = 1; k < order_.size(); ++k) {
    const auto i = static_cast<std::size_t>(at(k));
    std::size_t inner = 0;
    if (k < massive()) {
      inner = k;
    } else {
      while (inner + 1 < massive() && axis[static_cast<std::size_t>(at(inner + 1))] < axis[i]) ++inner;
    }
    within_[i] = static_cast<std::int64_t>(inner);
  }
}

/// x'_k = x_k - X_{k-1},  X_k = X_{k-1} + (m_k/M_k) x'_k, of a tracer x - X of the bodies within its orbit; row 0
/// becomes X of all.
template <class Real> void AboutPrimary<Real>::to_jacobi(VectorColumn<Real>& column) const {
  const auto& read = std::as_const(column);
  Vec3<Real> center = read[0];
  centers_[0] = center;
  for (std::size_t k = 1; k < massive(); ++k) {
    const Vec3<Real> relative = read[at(k)] - center;
    column.set(at(k), relative);
    centers_[k] = center += masses_[static_cast<std::size_t>(at(k))] / interior_[k] * relative;
  }
  for (std::size_t k = massive(); k < order_.size(); ++k) column.set(at(k), read[at(k)] - centers_[within(at(k))]);
  column.set(0, center);
}

/// The inverse, from the outermost body inwards; `from` and `to` may be the same column.
template <class Real>
void AboutPrimary<Real>::from_jacobi(const VectorColumn<Real>& from, VectorColumn<Real>& to,
                                     const Vec3<Real>& center_of_all) const {
  Vec3<Real> center = center_of_all;
  for (std::size_t k = massive() - 1; k > 0; --k) {
    const Vec3<Real> relative = from[at(k)];
    centers_[k] = center;
    center -= masses_[static_cast<std::size_t>(at(k))] / interior_[k] * relative;
    to.set(at(k), center + relative);
  }
  centers_[0] = center;
  for (std::size_t k = massive(); k < order_.size(); ++k) to.set(at(k), centers_[within(at(k))] + from[at(k)]);
  to.set(0, center);
}

/// Of the massive bodies, by mass.
template <class Real> Vec3<Real> AboutPrimary<Real>::mean_of(const VectorColumn<Real>& column) const {
  Vec3<Real> sum = Vec3<Real>::Zero();
  for (std::size_t k = 0; k < massive(); ++k) sum += masses_[k] * column[static_cast<Index>(k)];
  return sum / interior_.back();
}

template <class Real> void AboutPrimary<Real>::to_democratic(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  const Vec3<Real> x = mean_of(c.positions()), v = mean_of(c.velocities());
  const Vec3<Real> primary = c.positions()[0];
  for (Index i = 1; i < s.size(); ++i) {
    s.positions().set(i, c.positions()[i] - primary);
    s.velocities().set(i, c.velocities()[i] - v);
  }
  s.positions().set(0, x);
  s.velocities().set(0, v);
}

template <class Real> void AboutPrimary<Real>::from_democratic(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  Vec3<Real> x = Vec3<Real>::Zero(), v = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) {
    x += masses_[k] * c.positions()[static_cast<Index>(k)];
    v += masses_[k] * c.velocities()[static_cast<Index>(k)];
  }
  const Vec3<Real> center_v = c.velocities()[0];
  const Vec3<Real> primary_x = c.positions()[0] - x / interior_.back();
  for (Index i = 1; i < s.size(); ++i) {
    s.positions().set(i, primary_x + c.positions()[i]);
    s.velocities().set(i, center_v + c.velocities()[i]);
  }
  s.positions().set(0, primary_x);
  s.velocities().set(0, center_v - v / masses_[0]);
}

/// R_i = x_i - X and v_i - v_0, which are scaled afterwards.
template <class Real> void AboutPrimary<Real>::to_barycentric(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  const Vec3<Real> x = mean_of(c.positions()), v = mean_of(c.velocities());
  const Vec3<Real> of_primary = c.velocities()[0];
  for (Index i = 1; i < s.size(); ++i) {
    s.positions().set(i, c.positions()[i] - x);
    s.velocities().set(i, c.velocities()[i] - of_primary);
  }
  s.positions().set(0, x);
  s.velocities().set(0, v);
}

template <class Real> void AboutPrimary<Real>::from_barycentric(ParticleSystem<Real>& s) const {
  const auto& c = std::as_const(s);
  Vec3<Real> v = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) v += masses_[k] * c.velocities()[static_cast<Index>(k)];
  const Vec3<Real> of_primary = c.velocities()[0] - v / interior_.back();
  inertial_positions(c.positions(), c.positions()[0], s.positions());
  for (Index i = 1; i < s.size(); ++i) s.velocities().set(i, of_primary + c.velocities()[i]);
  s.velocities().set(0, of_primary);
}

/// Velocities, or accelerations, times `scale_`, or back.
template <class Real> void AboutPrimary<Real>::scale(VectorColumn<Real>& column, bool back) const {
  for (std::size_t k = 1; k < massive(); ++k) {
    const auto i = static_cast<Index>(k);
    const Vec3<Real> v = std::as_const(column)[i];
    column.set(i, back ? Vec3<Real>(v / scale_[k]) : Vec3<Real>(scale_[k] * v));
  }
}

/// Inertial positions of all, for a centre of mass at `center`; `to` may be the positions themselves.
template <class Real>
void AboutPrimary<Real>::inertial_positions(const VectorColumn<Real>& from, const Vec3<Real>& center,
                                            VectorColumn<Real>& to) const {
  if (jacobi()) {
    from_jacobi(from, to, center);
    return;
  }
  Vec3<Real> x = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) x += masses_[k] * from[static_cast<Index>(k)];
  const Vec3<Real> primary = center - x / (barycentric() ? masses_[0] : interior_.back());
  const Vec3<Real> origin = barycentric() ? center : primary;
  for (Index i = 1; i < from.size(); ++i) to.set(i, origin + from[i]);
  to.set(0, primary);
}

/// What the jump over h/2 moves all bodies by in democratic coordinates.
template <class Real> Vec3<Real> AboutPrimary<Real>::half_jump(const ParticleSystem<Real>& s, const Real& h) const {
  Vec3<Real> momentum = Vec3<Real>::Zero();
  for (std::size_t k = 1; k < massive(); ++k) momentum += masses_[k] * s.velocities()[static_cast<Index>(k)];
  return h / (Real(2) * masses_[0]) * momentum;
}

/// @throws Error if the saved places are none of these particles'
template <class Real> void AboutPrimary<Real>::load_within(const SavedState& saved, const std::string& prefix) {
  std::vector<std::int64_t> within(order_.size(), 0);
  if (saved.contains(prefix + "within")) {
    load_value(saved, prefix + "within", within);
  } else if (jacobi()) {  // written when tracers went round all bodies, wherever they were
    for (std::size_t k = 1; k < order_.size(); ++k)
      within[static_cast<std::size_t>(at(k))] = static_cast<std::int64_t>(std::min(k, massive() - 1));
  }
  bool fits = within.size() == order_.size();
  for (std::size_t k = 0; fits && k < order_.size(); ++k) {
    const std::int64_t w = within[static_cast<std::size_t>(at(k))], own = jacobi() ? static_cast<std::int64_t>(k) : 0;
    fits = k < massive() ? w == own : w >= 0 && w < static_cast<std::int64_t>(massive());
  }
  if (!fits) throw Error("the saved places of tracers among the bodies do not match these particles");
  within_ = std::move(within);
}

/// @throws Error if the saved order does not name each particle once, the primary first and tracers last
template <class Real> void AboutPrimary<Real>::load_order(const SavedState& saved, const std::string& prefix) {
  std::vector<std::int64_t> order;
  load_value(saved, prefix + "order", order);
  const auto sorted = [](std::vector<std::int64_t> ranks) {
    std::sort(ranks.begin(), ranks.end());
    return ranks;
  };
  const auto massive = [&](std::int64_t i) { return masses_[static_cast<std::size_t>(i)] != Real(0); };
  if (sorted(order) != sorted(order_) || order[0] != 0 || !std::is_partitioned(order.begin(), order.end(), massive)) {
    throw Error("the saved order of Jacobi coordinates does not match these particles");
  }
  order_ = std::move(order);
}

}  // namespace detail

}  // namespace noether
