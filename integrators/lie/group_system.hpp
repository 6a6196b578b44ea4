#pragma once
/// Fields that users write on SO(3)^n x SE(3)^m x R^k.

#include "engine/signature.hpp"
#include "integrators/classical.hpp"
#include "integrators/first_order_system.hpp"
#include "integrators/lie/lie_field.hpp"
#include "integrators/lie/linear_rotation.hpp"
#include "integrators/lie/rotations.hpp"

#include <cmath>
#include <concepts>
#include <memory>
#include <string>
#include <utility>

namespace noether {

/// What such a field offers: how many rotations, rigid motions and numbers y is, and how fast they change.
///
///     struct Top {                                  // about a point: R' = R hat(Pi/I),  Pi' = Pi x Pi/I + m g R^T e x
///     c
///       Index rotations() const { return 1; }
///       Index motions() const { return 0; }
///       Index numbers() const { return 3; }
///       Index size() const { return 7; }            // of y: 4 for each rotation, 7 for each motion
///       template <class Real> void velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) const;
///     };
///
/// y holds the quaternions (w, x, y, z) of the rotations, then the quaternion and the place of each motion, then the
/// numbers. The element a, shape (3 n + 6 m + k), holds the angular velocities of the rotations, then angular velocity
/// and velocity of each motion, all in the axes of what turns, then the rates of the numbers.
template <class S, class Real>
concept GroupSystem = requires(const S& system, const Real& t, const Vector<Real>& y, Vector<Real>& a) {
  { system.rotations() } -> std::convertible_to<Index>;
  { system.motions() } -> std::convertible_to<Index>;
  { system.numbers() } -> std::convertible_to<Index>;
  system.velocity(t, y, a);
};

/// The quaternion that begins at y[at].
template <class Real> Quaternion<Real> quaternion_at(const Vector<Real>& y, Index at) {
  return Quaternion<Real>(y[at], y[at + 1], y[at + 2], y[at + 3]);
}
/// The vector that begins at y[at].
template <class Real> Vec3<Real> triple_at(const Vector<Real>& y, Index at) {
  return Vec3<Real>(y[at], y[at + 1], y[at + 2]);
}

/// SO(3)^n x SE(3)^m x R^k acting on y.
template <class Real> class GroupSystemField : public LieField<Real> {
 public:
  GroupSystemField(Index rotations, Index motions, Index numbers) : n_(rotations), m_(motions), k_(numbers) {}

  Index size() const override { return 4 * n_ + 7 * m_ + k_; }
  Index algebra() const override { return 3 * n_ + 6 * m_ + k_; }
  void act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) override;
  void bracket(const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) override;
  void sizes(const Vector<Real>& y, const Vector<Real>& y1, double h, Vector<double>& out) const override;
  void bind(const ParticleSystem<Real>& s) override;
  void check_start(const ParticleSystem<Real>& s) const override;
  void gather(const ParticleSystem<Real>& s, Vector<Real>& y) const override;
  void scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const override;
  EnergyTerms<Real> energy(const ParticleSystem<Real>& /*s*/) override { return {}; }
  void accelerations(const ParticleSystem<Real>& /*s*/, VectorColumn<Real>& /*a*/) override {}

 protected:
  void evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) override;

 private:
  Index n_, m_, k_;
  Vector<Real> a_;  ///< work
};

extern template class GroupSystemField<double>;
extern template class GroupSystemField<Quad>;

/// A system of a user as such a field.
template <class S, class Real> class GroupSystemMotion final : public GroupSystemField<Real> {
 public:
  explicit GroupSystemMotion(S system)
      : GroupSystemField<Real>(system.rotations(), system.motions(), system.numbers()), system_(std::move(system)) {}

  std::unique_ptr<VectorField<Real>> clone() const override { return std::make_unique<GroupSystemMotion>(*this); }
  FieldClaims claims() const override {
    return {.name = detail::name_of(system_), .variables = true, .time_dependent = true};
  }
  std::string signature() const override { return detail::signature_of(system_); }

 protected:
  void find_velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) override {
    a.resize(this->algebra());
    system_.velocity(t, y, a);
  }

 private:
  S system_;
};

/// A method over such a field.
/// @throws Error  see `make_method`
template <class S>
  requires GroupSystem<S, double> Classical<double> lie(S system, const MethodChoice& choice) {
    return Classical<double>(std::make_unique<GroupSystemMotion<S, double>>(std::move(system)), choice);
  }

/// Such systems as methods see them.
template <class S, class Real>
  requires GroupSystem<S, Real>
struct detail::MotionOf<S, Real> {
  using type = GroupSystemMotion<S, Real>;
};
template <class S, class Real>
  requires LinearRotation<S, Real>
struct detail::MotionOf<S, Real> {
  using type = LinearRotationField<S, Real>;
};

}  // namespace noether
