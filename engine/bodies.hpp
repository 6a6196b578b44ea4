#pragma once
/// Rigid bodies: particles that turn. A body is a row of the particles, its centre, with columns of its own.

#include "engine/columns.hpp"
#include "engine/particle_system.hpp"
#include "engine/sums.hpp"
#include "numbers/quaternion.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// The rotation from a body's principal axes to space, a unit quaternion (w, x, y, z).
struct BodyOrientation {
  template <class Real> using type = RowColumn<Real, 4>;
  static constexpr std::string_view name = "orientation", dimension = "1";
  static constexpr ColumnRole role = ColumnRole::configuration;
  static constexpr std::array<double, 4> start = {1, 0, 0, 0};
};

/// The angular momentum about a body's centre, in space, not in the body: a free turn changes no bit of it.
struct BodySpin {
  template <class Real> using type = VectorColumn<Real>;
  static constexpr std::string_view name = "spin", dimension = "mass length^2/time";
  static constexpr ColumnRole role = ColumnRole::momentum;
};

/// The principal moments of inertia about a body's centre, or about the point that holds it; 0 0 0 of a point, which
/// does not turn, and one 0 of a body in a line.
struct BodyInertia {
  template <class Real> using type = VectorColumn<Real>;
  static constexpr std::string_view name = "inertia", dimension = "mass length^2";
  static constexpr ColumnRole role = ColumnRole::parameter;
};

/// A place of a body that forces act on.
struct BodySite {
  Vec3<double> place = Vec3<double>::Zero();  ///< in the principal axes, from the centre [length]
  double mass = 0;                            ///< [mass]; 0: it carries forces alone
  double charge = 0;                          ///< [charge]
  int type = 0;
  std::string name = {};

  bool operator==(const BodySite&) const = default;
};

/// What the bodies of one kind have in common.
struct BodyKind {
  std::vector<BodySite> sites;
  bool held = false;  ///< a fixed point holds it, about which it turns: its row is that point, and stays there

  Index massive_sites() const;

  bool operator==(const BodyKind&) const = default;
};

/// Which particles are bodies, and where their sites are. As the topology it belongs to the particles once and for all,
/// and copies of them share it.
struct Bodies {
  std::vector<BodyKind> kinds;
  std::vector<int> kind_of;  ///< by particle; -1: a point, or a particle behind the last body

  /// The kind of particle `i`; null for a point.
  const BodyKind* kind(Index i) const {
    const auto at = static_cast<std::size_t>(i);
    const int found = at < kind_of.size() ? kind_of[at] : -1;
    return found < 0 ? nullptr : &kinds[static_cast<std::size_t>(found)];
  }
  bool is_held(Index i) const {
    const BodyKind* of = kind(i);
    return of != nullptr && of->held;
  }
  bool any_held() const;
  /// How many more sites with mass there are than bodies.
  Index sites_beyond_one() const;

  bool operator==(const Bodies&) const = default;
};

/// A rigid body before it is anywhere.
struct RigidBody {
  std::string name;
  double mass = 0;                              ///< [mass]
  Vec3<double> inertia = Vec3<double>::Zero();  ///< principal moments [mass length^2]
  Quaternion<double> axes = {1, 0, 0, 0};       ///< from the principal axes to those that it was described in
  Vec3<double> center = Vec3<double>::Zero();   ///< of mass, in the axes of the description [length]
  std::vector<BodySite> sites = {};             ///< in the principal axes, from the centre or the fixed point
  bool held = false;                            ///< by a fixed point: `inertia` and `sites` are about that
  std::string warning = {};                     ///< what is odd in it, though it can be followed
};

/// A body of an inertia that is known: one site, in its centre.
/// @param inertia  principal moments [mass length^2]: above 0, one of them may be 0 where the body is a line
/// @throws Error  for a mass or moments that no body has
RigidBody body_of_inertia(std::string name, double mass, const Vec3<double>& inertia);

/// A body that turns about a fixed point, as a top does.
/// @param inertia  principal moments about the fixed point [mass length^2]
/// @param center  of mass, from the fixed point, in the principal axes [length]: its one site
/// @throws Error  for a mass or moments that no body has
RigidBody top(std::string name, double mass, const Vec3<double>& inertia, const Vec3<double>& center);

/// A homogeneous ellipsoid, of moments m (b^2 + c^2)/5, m (a^2 + c^2)/5, m (a^2 + b^2)/5.
/// @param semi_axes  a, b, c [length]
/// @throws Error  for a mass or a semi-axis that is not above 0
RigidBody ellipsoid(std::string name, double mass, const Vec3<double>& semi_axes);

/// A body of mass points: mass, centre, principal axes and moments follow from its sites.
/// @param sites  places in any axes [length], masses [mass], charges
/// @param linear  whether sites in a line are meant to be a body of two moments; empty: either is accepted
/// @param straight  the least moment by the largest at which sites are in a line
/// @throws Error  for fewer than two sites, no mass, or sites in a line that nobody said are
RigidBody body_of_sites(std::string name, std::vector<BodySite> sites, std::optional<bool> linear = false,
                        double straight = 1e-12);

/// Where a body is, and how it moves and turns.
struct BodyState {
  Vec3<double> x = Vec3<double>::Zero(), v = Vec3<double>::Zero();  ///< of its centre [length], [length/time]
  Quaternion<double> orientation = {1, 0, 0, 0};  ///< from the axes of its description to space; of any length but 0
  std::optional<Vec3<double>> spin = {};          ///< in space [mass length^2/time]
  std::optional<Vec3<double>> spin_in_body = {};  ///< in its principal axes [mass length^2/time]
  std::optional<Vec3<double>> angular_velocity = {};  ///< in its principal axes [1/time]
  std::optional<double> spin_period = {};             ///< about its axis of the largest moment [time]
};

/// Appends a body, with the columns that bodies have. @return its index
/// @throws Error  for an orientation of length 0, a period of 0, or more than one way to say how it turns
Index add_body(ParticleSystem<double>& s, const RigidBody& body, const BodyState& state = {});
/// The same of one of many bodies, whose kinds are collected: the particles get them by `set_bodies` after the last
/// one.
Index add_body(ParticleSystem<double>& s, Bodies& bodies, const RigidBody& body, const BodyState& state);

/// Whether some of the particles turn.
template <class Real> bool has_bodies(const ParticleSystem<Real>& s) { return s.bodies() != nullptr; }

/// The angular momentum in the principal axes, Pi = R^T S [mass length^2/time].
template <class Real> Vec3<Real> spin_in_body(const Quaternion<Real>& q, const Vec3<Real>& spin) {
  return to_body(rotation_matrix(q), spin);
}
/// The angular velocity in the principal axes; about the axis of a line there is none [1/time].
template <class Real> Vec3<Real> rate_in_body(const Vec3<Real>& in_body, const Vec3<Real>& inertia) {
  Vec3<Real> rate;
  for (int k = 0; k < 3; ++k) rate[k] = inertia[k] > Real(0) ? Real(in_body[k] / inertia[k]) : Real(0);
  return rate;
}
/// The same in space.
template <class Real>
Vec3<Real> angular_velocity(const Quaternion<Real>& q, const Vec3<Real>& spin, const Vec3<Real>& inertia) {
  const Mat3<Real> axes = rotation_matrix(q);
  return to_space<Real>(axes, rate_in_body<Real>(to_body<Real>(axes, spin), inertia));
}
/// Degrees of freedom in which particle `i` turns: 3, of a body in a line 2, of a point 0.
template <class Real> int turning_freedoms(const Vec3<Real>& inertia) {
  return (inertia[0] > Real(0) ? 1 : 0) + (inertia[1] > Real(0) ? 1 : 0) + (inertia[2] > Real(0) ? 1 : 0);
}
/// Whether particle `i` has three equal moments of inertia, or, as a point, none: nothing turns it by its moments.
template <class Real> bool is_sphere(const ParticleSystem<Real>& s, Index i) {
  if (!has_bodies(s)) return true;
  const Vec3<Real> inertia = s.template column<BodyInertia>()[i];
  return inertia[0] == inertia[1] && inertia[1] == inertia[2];
}
/// Those of all particles together, less the places of bodies that a fixed point holds.
template <class Real> int turning_freedoms(const ParticleSystem<Real>& s) {
  if (!has_bodies(s)) return 0;
  const auto& inertia = s.template column<BodyInertia>();
  int count = 0;
  for (Index i = 0; i < s.size(); ++i)
    count += turning_freedoms<Real>(Vec3<Real>(inertia[i])) - (s.bodies()->is_held(i) ? 3 : 0);
  return count;
}
/// The kinetic energy of a turn, sum Pi_k^2/2 I_k [energy].
template <class Real> Real turning_energy(const Vec3<Real>& in_body, const Vec3<Real>& inertia) {
  Real sum(0);
  for (int k = 0; k < 3; ++k) {
    if (inertia[k] > Real(0)) sum += in_body[k] * in_body[k] / (Real(2) * inertia[k]);
  }
  return sum;
}

/// That of all particles, the same in any order of them [energy].
template <class Real> Real turning_energy_of(const ParticleSystem<Real>& s) {
  const auto& q = s.template column<BodyOrientation>();
  const auto& spin = s.template column<BodySpin>();
  const auto& inertia = s.template column<BodyInertia>();
  return sum_over<Real>(s.size(),
                        [&](Index i) { return turning_energy<Real>(spin_in_body<Real>(q[i], spin[i]), inertia[i]); });
}

}  // namespace noether
