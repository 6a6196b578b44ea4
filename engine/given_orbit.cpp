#include "engine/given_orbit.hpp"

#include "engine/description.hpp"
#include "engine/orbital_elements.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

namespace noether {

namespace {

using Choice = OrbitKey::Choice;

/// The names of a choice: "a, P or q".
std::string names_of(Choice choice) {
  std::vector<std::string_view> names;
  for (const OrbitKey& key : orbit_keys) {
    if (key.choice == choice) names.push_back(key.name);
  }
  const std::string_view last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

/// Finite numbers, and one of each choice at most.
void check_choices(const GivenOrbit& orbit) {
  for (const OrbitKey& key : orbit_keys) {
    const std::optional<double>& value = orbit.*key.value;
    if (!value) continue;
    if (!std::isfinite(*value)) refuse_field(key.name, *value, "is not finite; a finite number is expected");
    for (const OrbitKey& other : orbit_keys) {
      if (other.name == key.name) break;
      if (other.choice != key.choice || !(orbit.*other.value)) continue;
      refuse_field(key.name, *value,
                   fmt::format("is given together with {}; give only one of {}", other.name, names_of(key.choice)));
    }
  }
  if (!orbit.a && !orbit.P && !orbit.q)
    throw Error("the orbit has no size; give " + names_of(Choice::size), {.key = "a"});
  if (orbit.P && !(*orbit.P > 0)) refuse_field("P", *orbit.P, "is not a valid period; a time above 0 is expected");
  if (orbit.q && !(*orbit.q > 0))
    refuse_field("q", *orbit.q, "is not a valid pericenter distance; a length above 0 is expected");
}

/// What an eccentricity allows.
void check_shape(const GivenOrbit& orbit, double e) {
  if (e < 0) refuse_field("e", e, "is not a valid eccentricity; 0 or more is expected");
  if (orbit.P && e >= 1) refuse_field("P", *orbit.P, "is a period, but only an ellipse, e < 1, has one; give a or q");
  if (e != 1) return;
  if (!orbit.q) refuse_field("e", e, "is a parabola, which has no semi-major axis; give q, its pericenter distance");
  for (const char* key : {"M", "l"}) {
    const auto value = key[0] == 'M' ? orbit.M : orbit.l;
    if (value) refuse_field(key, *value, "has no meaning on a parabola, e = 1; give f or T");
  }
}

/// Cosine and sine of half the true anomaly.
struct HalfAnomaly {
  double cosine = 1, sine = 0;
};

/// r = q (1 + e)/(1 + e cos f), turned to its place: exact to rounding for every e and f.
std::pair<Vec3<double>, Vec3<double>> state_at(const HalfAnomaly& half, double q, double e, double inc, double Omega,
                                               double omega, double mu) {
  const double square = 2 * half.cosine * half.cosine, sine = 2 * half.sine * half.cosine;
  const double one_plus = (1 - e) + e * square;  // 1 + e cos f without cancellation
  if (!(one_plus > 0)) {
    const double f = 2 * std::atan2(half.sine, half.cosine);
    refuse_field("f", f,
                 fmt::format("lies beyond the asymptote of this orbit; less than {:.6g} deg is expected",
                             std::acos(-1 / e) / units::value("deg", units::si_scale)));
  }
  const double p = q * (1 + e), r = p / one_plus, speed = std::sqrt(mu / p);
  const Vec3<double> place(r * (square - 1), r * sine, 0), rate(-speed * sine, speed * (square - (1 - e)), 0);
  const double co = std::cos(omega), so = std::sin(omega), ci = std::cos(inc), si = std::sin(inc);
  const double cO = std::cos(Omega), sO = std::sin(Omega);
  const Vec3<double> along(cO * co - sO * so * ci, sO * co + cO * so * ci, so * si);
  const Vec3<double> across(-cO * so - sO * co * ci, -sO * so + cO * co * ci, co * si);
  return {place[0] * along + place[1] * across, rate[0] * along + rate[1] * across};
}

HalfAnomaly half_of(double f) { return {std::cos(f / 2), std::sin(f / 2)}; }

/// Barker's equation D + D^3/3 = sqrt(mu/(2 q^3)) t, D = tan(f/2), of a parabola, solved in closed form.
HalfAnomaly parabolic_anomaly(double q, double t, double mu) {
  const double D = 2 * std::sinh(std::asinh(1.5 * std::sqrt(mu / (2 * q)) / q * t) / 3);
  const double cosine = 1 / std::hypot(1, D);
  return {cosine, D * cosine};
}

}  // namespace

OtherName other_name_of(std::string_view name) {
  struct Meaning {
    std::string_view words, key, told;
  };
  // Words between blanks, in small letters but for those of one letter.
  static constexpr std::array meanings = {
      Meaning{" m weight m_star mstar m_planet mplanet ", "mass", "; did you mean 'mass'?"},
      Meaning{" gm mu standard_gravitational_parameter ", "",
              "; a gravitational parameter G m is not supported: give the mass"},
      Meaning{" sma semimajor semimajor_axis semi_major_axis A ", "a", "; did you mean 'a'?"},
      Meaning{" per period orbital_period pr ", "P", "; did you mean 'P'?"},
      Meaning{" qr perihelion_distance periapsis_distance pericenter_distance ", "q", "; did you mean 'q'?"},
      Meaning{" ecc eccentricity ec ", "e", "; did you mean 'e'?"},
      Meaning{" i I incl incl. inclination in ", "inc", "; did you mean 'inc'?"},
      Meaning{" om node raan lan long_node longnode asc_node ascending_node longitude_of_ascending_node "
              "longitude_of_the_ascending_node right_ascension_of_ascending_node ",
              "Omega", "; did you mean 'Omega'?"},
      Meaning{" w W peri peri. argp argperi arg_peri argper aop arg_pericenter argument_of_pericenter "
              "argument_of_periapsis argument_of_perihelion argument_of_the_pericenter ",
              "omega", "; did you mean 'omega'?"},
      Meaning{" varpi longp long_peri longperi curlypi longitude_of_pericenter longitude_of_perihelion "
              "longitude_of_periapsis ",
              "pomega", "; did you mean 'pomega'?"},
      Meaning{" ma m0 mean_anomaly meananomaly ", "M", "; did you mean 'M'?"},
      Meaning{" nu ta true_anomaly trueanomaly ", "f", "; did you mean 'f'?"},
      Meaning{" L lambda mean_longitude meanlongitude ", "l", "; did you mean 'l'?"},
      Meaning{" tp tperi t_peri time_of_perihelion time_of_pericenter time_of_periapsis ", "T", "; did you mean 'T'?"},
      Meaning{" n N mean_motion ", "", "; a mean motion n is not supported: give the period P = 360 deg / n, or a"},
      Meaning{" E eccentric_anomaly ", "", "; an eccentric anomaly E is not supported: give M = E - e sin E, or f"},
      Meaning{" Q ad aphelion ", "", "; the apocenter distance is not supported: give a or q"},
      Meaning{" theta true_longitude ", "", "; a true longitude is not supported: give f, or the mean longitude l"},
  };
  std::string word(name);
  if (word.empty()) return {};
  for (char& letter : word) letter = letter == '-' || letter == ' ' ? '_' : letter;
  if (word.size() > 1) {
    for (char& letter : word) letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  word = ' ' + word + ' ';
  for (const Meaning& meaning : meanings) {
    if (meaning.words.find(word) != std::string_view::npos) return {meaning.key, meaning.told};
  }
  return {};
}

std::pair<Vec3<double>, Vec3<double>> state_of_orbit(const GivenOrbit& orbit, double mu) {
  check_choices(orbit);
  const double e = orbit.e.value_or(0), inc = orbit.inc.value_or(0), Omega = orbit.Omega.value_or(0);
  const double omega = orbit.pomega ? *orbit.pomega - Omega : orbit.omega.value_or(0);
  if (!(mu > 0)) detail::refuse_elements({1, 0, 0, 0, 0, 0}, mu);
  check_shape(orbit, e);
  const double turn = detail::full_turn<double>();
  if (e == 1) {
    const HalfAnomaly half = orbit.T ? parabolic_anomaly(*orbit.q, -*orbit.T, mu) : half_of(orbit.f.value_or(0));
    return state_at(half, *orbit.q, e, inc, Omega, omega, mu);
  }
  double a = 0;
  if (orbit.a) a = *orbit.a;
  if (orbit.P) a = std::cbrt(mu * (*orbit.P / turn) * (*orbit.P / turn));
  if (orbit.q) a = *orbit.q / (1 - e);
  OrbitalElements<double> elements{a, e, inc, Omega, omega, orbit.M.value_or(0)};
  detail::check_elements(elements, mu);
  if (orbit.f) return state_at(half_of(*orbit.f), orbit.q ? *orbit.q : a * (1 - e), e, inc, Omega, omega, mu);
  if (orbit.l) elements.M = *orbit.l - (orbit.pomega ? *orbit.pomega : Omega + omega);
  if (orbit.T) {
    const double motion = orbit.P ? turn / *orbit.P : std::sqrt(mu / std::abs(a)) / std::abs(a);
    elements.M = -motion * *orbit.T;
  }
  return state_from_elements(elements, mu);
}

void OrbitCenter::add(double mass, const Vec3<double>& x, const Vec3<double>& v) {
  const double whole = mass_ + mass;
  if (empty_) {
    x_ = x, v_ = v;
  } else if (mass > 0) {
    x_ += mass / whole * (x - x_);
    v_ += mass / whole * (v - v_);
  }
  empty_ = false;
  mass_ = whole;
}

OrbitCenter center_of(const ParticleSystem<double>& s, const std::vector<Index>& particles) {
  OrbitCenter center;
  for (const Index i : particles) center.add(s.masses()[i], s.positions()[i], s.velocities()[i]);
  if (particles.size() > 1 && center.mass() == 0) {
    throw Error("these bodies have no mass, so they have no barycenter", {.key = "about"});
  }
  return center;
}

std::string about_a_light_body(const ParticleSystem<double>& s, Index count, const std::string& body) {
  Index heaviest = 0;
  for (Index i = 1; i < count; ++i) heaviest = s.masses()[i] > s.masses()[heaviest] ? i : heaviest;
  if (heaviest == 0) return "";
  if (!(s.masses()[0] > 0)) {
    return fmt::format(
        "the elements of '{0}' are about '{1}', which comes first and has no mass; put '{2}' first, or say what they "
        "are about: about = \"{2}\"",
        body, s.name(0), s.name(heaviest));
  }
  return fmt::format(
      "the elements of '{0}' are about '{1}', which comes first, but '{2}' has {3:.3g} times its mass; put '{2}' "
      "first, or say what they are about: about = \"{2}\" or \"{1}\"",
      body, s.name(0), s.name(heaviest), s.masses()[heaviest] / s.masses()[0]);
}

}  // namespace noether
