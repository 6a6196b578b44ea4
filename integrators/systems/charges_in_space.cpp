#include "integrators/systems/charges_in_space.hpp"

#include "engine/description.hpp"
#include "engine/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

void check_charges(const ChargeLists& of) {
  const std::size_t n = of.count();
  const auto long_enough = [&](std::string_view key, std::size_t found, std::size_t expected) {
    if (found == expected) return;
    refuse_field(key, fmt::format("a list of {}", found),
                 fmt::format("does not fit {} masses; {} numbers are expected", n, expected));
  };
  if (n < 2) refuse_field("masses", fmt::format("a list of {}", n), "is too short; two charges or more are expected");
  long_enough("charges", of.charges.size(), n);
  long_enough("positions", of.positions.size(), 3 * n);
  long_enough("velocities", of.velocities.size(), 3 * n);
  for (const double m : of.masses) {
    if (!(m > 0 && std::isfinite(m))) refuse_field("masses", m, "is not a valid mass; a mass above 0 is expected");
  }
  if (!(of.c > 0 && std::isfinite(of.c)))
    refuse_field("c", of.c, "is not a valid speed of light; one above 0 is expected");
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!std::equal(&of.positions[3 * i], &of.positions[3 * i] + 3, &of.positions[3 * j])) continue;
      const Vec3<double> at = of_charge(of.positions, i);
      refuse_field("positions", fmt::format("({:.9g}, {:.9g}, {:.9g})", at[0], at[1], at[2]),
                   fmt::format("puts charges {} and {} at one place; put them at two", j + 1, i + 1));
    }
  }
}

void check_speeds(const ChargeLists& of) {
  for (std::size_t i = 0; i < of.count(); ++i) {
    const double speed = std::sqrt(norm2(of_charge(of.velocities, i)));
    if (speed < of.c) continue;
    refuse_field("velocities", fmt::format("{:.9g} of charge {}", speed, i + 1),
                 fmt::format("is not below c = {:.9g}; slower charges are expected", of.c));
  }
}

std::vector<std::string> names_of_charges(std::size_t count) {
  std::vector<std::string> all;
  for (const char* kind : {"", "p_"}) {
    for (std::size_t i = 1; i <= count; ++i) {
      for (const char* axis : {"x", "y", "z"}) all.push_back(fmt::format("{}{}_{}", kind, axis, i));
    }
  }
  return all;
}

std::vector<Symmetry> symmetries_of_charges() {
  std::vector<Symmetry> all;
  const auto add = [&](const char* name, const std::function<Vec3<double>(const Vec3<double>& x)>& moved) {
    all.push_back({name, [moved](const Eigen::VectorXd& q) {
                     Eigen::VectorXd xi(q.size());
                     for (Index i = 0; i < q.size(); i += 3) xi.segment<3>(i) = moved(q.segment<3>(i));
                     return xi;
                   }});
  };
  const char* const translations[] = {"translation_x", "translation_y", "translation_z"};
  const char* const rotations[] = {"rotation_x", "rotation_y", "rotation_z"};
  for (int d = 0; d < 3; ++d) {
    const Vec3<double> axis = Vec3<double>::Unit(d);
    add(translations[d], [axis](const Vec3<double>&) { return axis; });
  }
  for (int d = 0; d < 3; ++d) {
    const Vec3<double> axis = Vec3<double>::Unit(d);
    add(rotations[d], [axis](const Vec3<double>& x) { return cross(axis, x); });
  }
  return all;
}

Vec3<double> of_charge(const std::vector<double>& all, std::size_t i) {
  return {all[3 * i], all[3 * i + 1], all[3 * i + 2]};
}

MomentumShares shares_of_charges(const ChargeLists& of, const Vector<double>& q, const Vector<double>& v,
                                 const Vector<double>& own) {
  const auto n = static_cast<Index>(of.count());
  const auto of_field = [&](Index i) {
    Vec3<double> sum(0, 0, 0);
    for (int d = 0; d < 3; ++d) {
      sum[d] = sum_over<double>(n, [&](Index j) {
        if (j == i) return 0.0;
        const double coupling =
            of.k * of.charges[static_cast<std::size_t>(i)] * of.charges[static_cast<std::size_t>(j)];
        const Vec3<double> between = of_charge(q, i) - of_charge(q, j);
        return potential_momentum(place_of_pair(between), coupling, of.c, of_charge(v, j))[d];
      });
    }
    return sum;
  };
  std::vector<Vec3<double>> field;
  for (Index i = 0; i < n; ++i) field.push_back(of_field(i));
  const auto add = [&](auto&& momentum, Vec3<double>& whole, Vec3<double>& about) {
    for (int d = 0; d < 3; ++d) {
      whole[d] = sum_over<double>(n, [&](Index i) { return momentum(i)[d]; });
      about[d] = sum_over<double>(n, [&](Index i) { return cross(of_charge(q, i), momentum(i))[d]; });
    }
  };
  MomentumShares shares;
  const auto alone = [&](Index i) { return of_charge(own, i); };
  add(alone, shares.particles, shares.particles_about);
  add([&](Index i) { return field[static_cast<std::size_t>(i)]; }, shares.field, shares.field_about);
  shares.size = sum_over<double>(n, [&](Index i) { return std::sqrt(norm2(alone(i))); });
  shares.size_about = sum_over<double>(n, [&](Index i) { return std::sqrt(norm2(of_charge(q, i)) * norm2(alone(i))); });
  return shares;
}

}  // namespace noether
