#include "integrators/check_flows.hpp"

#include "engine/bodies.hpp"
#include "engine/sums.hpp"
#include "forces/check_gradient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

namespace {

constexpr double allowed = 1e-5, relative_step = 1e-4;

/// The slope at 0 of a function of whole steps of length h, by central differences of order 6.
template <class At> auto slope_at_zero(const At& at, double h) {
  using Value = decltype(at(1));
  const Value one = at(1) - at(-1), two = at(2) - at(-2), three = at(3) - at(-3);
  return Value((45 * one - 9 * two + three) / (60 * h));
}

/// How all particles change.
struct Rates {
  VectorColumn<double> velocity, acceleration, turn, twist;  ///< the last two of bodies, in space

  explicit Rates(Index n) : velocity(n), acceleration(n), turn(n), twist(n) {}
};

double largest_norm(Index n, const auto& of) {
  double largest = 0;
  for (Index i = 0; i < n; ++i) largest = std::max(largest, std::sqrt(norm2(Vec3<double>(of(i)))));
  return largest;
}

/// What is small beside the particles.
struct Scales {
  double length, speed, spin, time;
};

Scales scales_of(AnyHamiltonian<double>& hamiltonian, const ParticleSystem<double>& s) {
  const auto or_one = [](double value) { return value > 0 ? value : 1; };
  const Index n = s.size();
  VectorColumn<double> a(n);
  hamiltonian.accelerations(s, a);
  Scales scales{or_one(largest_norm(n, [&](Index i) { return s.positions()[i]; }) / std::cbrt(static_cast<double>(n))),
                or_one(largest_norm(n, [&](Index i) { return s.velocities()[i]; })), 1, 0};
  double rate = largest_norm(n, [&](Index i) { return s.velocities()[i]; }) / scales.length;
  rate = std::max(rate, std::sqrt(largest_norm(n, [&](Index i) { return a[i]; }) / scales.length));
  if (has_bodies(s)) {
    const auto& spin = s.column<BodySpin>();
    scales.spin = or_one(largest_norm(n, [&](Index i) { return spin[i]; }));
    rate =
        std::max(rate, largest_norm(n, [&](Index i) {
                   return angular_velocity<double>(s.column<BodyOrientation>()[i], spin[i], s.column<BodyInertia>()[i]);
                 }));
  }
  scales.time = 1 / or_one(rate);
  return scales;
}

/// Twice the vector part of q' q^-1: the angular velocity in space.
Vec3<double> turn_of(const Quaternion<double>& rate, const Quaternion<double>& q) {
  return 2 * vector_part(quaternion_product<double>(rate, conjugate(q)));
}

Rates rates_of_flows(AnyHamiltonian<double>& hamiltonian, const ParticleSystem<double>& s, double h) {
  const Index n = s.size();
  Rates rates(n);
  for (const char letter : hamiltonian.claims().alphabet) {
    std::vector<ParticleSystem<double>> states;  // 3, 2, 1 steps back, and forth
    for (const int steps : {-3, -2, -1, 1, 2, 3}) {
      states.push_back(s);
      hamiltonian.flow(letter, states.back(), steps * h);
    }
    const auto state = [&](int steps) -> const ParticleSystem<double>& {
      return states[static_cast<std::size_t>(steps < 0 ? steps + 3 : steps + 2)];
    };
    for (Index i = 0; i < n; ++i) {
      const auto add = [&](VectorColumn<double>& to, const auto& of) {
        to.add(i, slope_at_zero([&](int m) { return Vec3<double>(of(state(m))); }, h));
      };
      add(rates.velocity, [&](const ParticleSystem<double>& at) { return at.unwrapped(i); });
      add(rates.acceleration, [&](const ParticleSystem<double>& at) { return at.velocities()[i]; });
      if (!has_bodies(s)) continue;
      add(rates.twist, [&](const ParticleSystem<double>& at) { return at.column<BodySpin>()[i]; });
      const Quaternion<double> q = s.column<BodyOrientation>()[i];
      const Quaternion<double> rate =
          slope_at_zero([&](int m) { return Quaternion<double>(state(m).column<BodyOrientation>()[i]); }, h);
      rates.turn.add(i, turn_of(rate, q));
    }
  }
  return rates;
}

/// Of particle `i`, by the slopes of the energy.
class EnergySlopes {
 public:
  EnergySlopes(AnyHamiltonian<double>& hamiltonian, const ParticleSystem<double>& s, const Scales& scales)
      : hamiltonian_(hamiltonian), s_(s), moved_(s), scales_(scales) {}

  Vec3<double> velocity(Index i) {
    return along_axes(scales_.speed * 0.1, [&](const Vec3<double>& d) { moved_.velocities().add(i, d); }) /
           s_.masses()[i];
  }
  Vec3<double> acceleration(Index i) {
    return -along_axes(scales_.length * relative_step, [&](const Vec3<double>& d) {
      moved_.shift(i, d, Vec3<double>::Zero());
      moved_.moved();
    }) / s_.masses()[i];
  }
  Vec3<double> turn(Index i) {
    return along_axes(scales_.spin * 0.1, [&](const Vec3<double>& d) { moved_.column<BodySpin>().add(i, d); });
  }
  Vec3<double> twist(Index i) {
    return -along_axes(10 * relative_step, [&](const Vec3<double>& d) {
      const double angle = std::sqrt(norm2(d));
      const Vec3<double> half = d * (std::sin(angle / 2) / angle);
      const Quaternion<double> by = quaternion<double>(std::cos(angle / 2), half), q = s_.column<BodyOrientation>()[i];
      moved_.column<BodyOrientation>().set(i, quaternion_product(by, q));
      moved_.column<BodySpin>().set(i, to_space<double>(rotation_matrix(by), Vec3<double>(s_.column<BodySpin>()[i])));
    });
  }

 private:
  /// EnergySlopes of the energy with what `move` does to a copy.
  template <class Move> Vec3<double> along_axes(double h, const Move& move) {
    Vec3<double> slopes;
    for (int k = 0; k < 3; ++k) {
      const auto at = [&](int steps) {
        moved_ = s_;
        move(Vec3<double>(steps * h * Vec3<double>::Unit(k)));
        const EnergyTerms<double> energy = hamiltonian_.energy(moved_);
        return energy.kinetic + energy.potential;
      };
      slopes[k] = slope_at_zero(at, h);
    }
    return slopes;
  }

  AnyHamiltonian<double>& hamiltonian_;
  const ParticleSystem<double>& s_;
  ParticleSystem<double> moved_;
  Scales scales_;
};

/// Where flows and energy differ most in one of the four ways to change.
struct Worst {
  std::string_view does, way;  ///< in words
  double difference = 0, largest = 0;
  Index particle = 0;
  int axis = 0;
  double found = 0, expected = 0;

  void ask(Index i, const Vec3<double>& by_flows, const Vec3<double>& by_energy) {
    for (int k = 0; k < 3; ++k) {
      largest = std::max({largest, std::abs(by_flows[k]), std::abs(by_energy[k])});
      const double apart = std::abs(by_flows[k] - by_energy[k]);
      if (apart <= difference || std::isnan(difference)) continue;
      difference = apart;
      particle = i;
      axis = k;
      found = by_flows[k];
      expected = by_energy[k];
    }
  }
};

void refuse_unasked(const AnyHamiltonian<double>& hamiltonian) {
  const HamiltonianClaims claims = hamiltonian.claims();
  std::string why;
  if (!claims.energy) why = "one of its forces has no energy";
  if (claims.constraints > 0) why = "constraints hold its particles";
  if (claims.velocity_forces) why = "its kicks take forces that depend on velocities";
  if (!claims.inertial) why = "it has its own coordinates";
  if (!claims.symplectic || claims.dissipative || !claims.irreversible.empty() || !claims.no_action.empty())
    why = "some of its letters follow no energy";
  if (why.empty()) return;
  throw Error(fmt::format("the flows of '{}' cannot be compared with its energy: {}", hamiltonian.name(), why));
}

}  // namespace

void check_flows(AnyHamiltonian<double> hamiltonian, ParticleSystem<double> s) {
  hamiltonian.bind(s);
  refuse_unasked(hamiltonian);
  const Scales scales = scales_of(hamiltonian, s);
  const Rates flows = rates_of_flows(hamiltonian, s, 10 * relative_step * scales.time);
  EnergySlopes slopes(hamiltonian, s, scales);
  Worst moves{"moves", "along"}, kicks{"accelerates", "along"}, turns{"turns", "about its own axis"},
      twists{"twists", "about"};
  const Index asked = particles_asked(s.size());
  for (Index place = 0; place < asked; ++place) {
    const Index i = place * s.size() / asked;
    const bool held = has_bodies(s) && s.bodies()->is_held(i);
    if (s.masses()[i] > 0 && !held) {
      moves.ask(i, flows.velocity[i], slopes.velocity(i));
      kicks.ask(i, flows.acceleration[i], slopes.acceleration(i));
    }
    if (!has_bodies(s) || turning_freedoms<double>(Vec3<double>(std::as_const(s).column<BodyInertia>()[i])) == 0)
      continue;
    const Mat3<double> axes = rotation_matrix<double>(std::as_const(s).column<BodyOrientation>()[i]);
    turns.ask(i, to_body<double>(axes, flows.turn[i]), to_body<double>(axes, slopes.turn(i)));
    twists.ask(i, flows.twist[i], slopes.twist(i));
  }
  for (const Worst& worst : {moves, kicks, turns, twists}) {
    if (worst.difference <= allowed * worst.largest) continue;
    const auto shown = [&, &most = worst.largest](double value) { return std::abs(value) < 1e-9 * most ? 0 : value; };
    throw Error(
        fmt::format("'{}' {} '{}' {} {} by {:.6g}, where the slope of its energy has {:.6g}; check the flows of "
                    "its letters and the energy it reports",
                    hamiltonian.name(), worst.does, s.name(worst.particle), worst.way, "xyz"[worst.axis],
                    shown(worst.found), shown(worst.expected)));
  }
}

}  // namespace noether
