#pragma once
/// Orbits as people and catalogs give them, and what they are about.

#include "engine/particle_system.hpp"
#include "numbers/types.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// Orbital elements about a center of attraction, of each kind in the way in which it is known.
///
/// One of a, P, q says how large the orbit is; at most one of omega, pomega where its pericenter lies (default: omega =
/// 0); at most one of M, f, l, T where the body is (default: in the pericenter). e, inc and Omega are 0 unless given.
///
///     pomega = Omega + omega,   l = pomega + M,   M = -n T with n^2 |a|^3 = mu
///
/// An ellipse has e < 1 and a > 0, a hyperbola e > 1 and a < 0; a parabola, e = 1, is given by q, and by f or T.
/// @source MurrayDermott1999
struct GivenOrbit {
  std::optional<double> a = {};       ///< semi-major axis [length]
  std::optional<double> P = {};       ///< period of an ellipse [time]
  std::optional<double> q = {};       ///< distance of the pericenter [length]
  std::optional<double> e = {};       ///< eccentricity [1]
  std::optional<double> inc = {};     ///< inclination [angle]
  std::optional<double> Omega = {};   ///< longitude of the ascending node [angle]
  std::optional<double> omega = {};   ///< argument of the pericenter [angle]
  std::optional<double> pomega = {};  ///< longitude of the pericenter [angle]
  std::optional<double> M = {};       ///< mean anomaly [angle]
  std::optional<double> f = {};       ///< true anomaly [angle]
  std::optional<double> l = {};       ///< mean longitude [angle]
  std::optional<double> T = {};       ///< when the body passes the pericenter, from now on [time]
};

/// One element: its key in scenes and tables, its dimension in words, and its place. Of those with one `choice` an
/// orbit has one.
struct OrbitKey {
  enum class Choice { size, shape, inclination, node, pericenter, place };
  std::string_view name, dimension;
  std::optional<double> GivenOrbit::*value;
  Choice choice;
};

inline constexpr std::array orbit_keys = {
    OrbitKey{"a", "length", &GivenOrbit::a, OrbitKey::Choice::size},
    OrbitKey{"P", "time", &GivenOrbit::P, OrbitKey::Choice::size},
    OrbitKey{"q", "length", &GivenOrbit::q, OrbitKey::Choice::size},
    OrbitKey{"e", "1", &GivenOrbit::e, OrbitKey::Choice::shape},
    OrbitKey{"inc", "angle", &GivenOrbit::inc, OrbitKey::Choice::inclination},
    OrbitKey{"Omega", "angle", &GivenOrbit::Omega, OrbitKey::Choice::node},
    OrbitKey{"omega", "angle", &GivenOrbit::omega, OrbitKey::Choice::pericenter},
    OrbitKey{"pomega", "angle", &GivenOrbit::pomega, OrbitKey::Choice::pericenter},
    OrbitKey{"M", "angle", &GivenOrbit::M, OrbitKey::Choice::place},
    OrbitKey{"f", "angle", &GivenOrbit::f, OrbitKey::Choice::place},
    OrbitKey{"l", "angle", &GivenOrbit::l, OrbitKey::Choice::place},
    OrbitKey{"T", "time", &GivenOrbit::T, OrbitKey::Choice::place},
};

/// A name by which others call an element, or a column of a table of them.
struct OtherName {
  std::string_view key;   ///< its name here; empty where there is none
  std::string_view told;  ///< the end of a message about it: "; did you mean 'Omega'?"; empty for a name nobody knows
};

/// What is meant by a name of the catalogs of JPL and of the Minor Planet Center, of textbooks and of REBOUND: "om",
/// "node", "raan" are Omega. Upper and lower case are the same but where they differ in meaning: m, E, L.
/// @throws never
OtherName other_name_of(std::string_view name);

/// Position [length] and velocity [length/time] relative to the center of attraction.
///
/// Given by a, e, inc, Omega, omega and M it is that of `state_from_elements`, to the bit.
/// @param mu  G times the sum of both masses [length^3/time^2]
/// @throws Error  with the key of the element that is wrong: two of one choice, none of the first, no orbit
/// @source MurrayDermott1999
std::pair<Vec3<double>, Vec3<double>> state_of_orbit(const GivenOrbit& orbit, double mu);

/// What an orbit is about: a body, or the barycenter of some.
class OrbitCenter {
 public:
  /// Takes a body in. Plain arithmetic in the order of the bodies; one body alone is kept to the bit.
  void add(double mass, const Vec3<double>& x, const Vec3<double>& v);

  double mass() const { return mass_; }
  const Vec3<double>& x() const { return x_; }
  const Vec3<double>& v() const { return v_; }

 private:
  bool empty_ = true;
  double mass_ = 0;
  Vec3<double> x_ = Vec3<double>::Zero(), v_ = Vec3<double>::Zero();
};

/// The barycenter of some particles, or one of them.
/// @throws Error  with the key "about" if several have no mass
OrbitCenter center_of(const ParticleSystem<double>& s, const std::vector<Index>& particles);

/// That the orbit of a body is about the first particle although one of the first `count`, those above it, has more
/// mass: a warning; empty where none has.
/// @cost O(count)
std::string about_a_light_body(const ParticleSystem<double>& s, Index count, const std::string& body);

}  // namespace noether
