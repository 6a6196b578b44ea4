#include "scene/builder_pieces.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace noether::detail {

namespace {

/// Sites of a cell, in its edges.
std::vector<Site> sites_of(LatticeKind kind) {
  if (kind == LatticeKind::simple_cubic) return {Site(0, 0, 0)};
  if (kind == LatticeKind::body_centered) return {Site(0, 0, 0), Site(0.5, 0.5, 0.5)};
  return {Site(0, 0, 0), Site(0, 0.5, 0.5), Site(0.5, 0, 0.5), Site(0.5, 0.5, 0)};
}

}  // namespace

std::vector<Site> all_sites(LatticeKind kind, const std::vector<std::int64_t>& cells) {
  const std::vector<Site> basis = sites_of(kind);
  std::vector<Site> sites;
  for (std::int64_t i = 0; i < cells[0]; ++i) {
    for (std::int64_t j = 0; j < cells[1]; ++j) {
      for (std::int64_t k = 0; k < cells[2]; ++k) {
        const Site corner(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        for (const Site& site : basis) sites.emplace_back(corner + site);
      }
    }
  }
  return sites;
}

std::size_t sites_of_cell(LatticeKind kind) { return sites_of(kind).size(); }

void check_above_zero(std::string_view key, double value, const char* what) {
  if (value > 0 && std::isfinite(value)) return;
  refuse_field(key, value, fmt::format("is not a valid {}; a number above 0 is expected", what));
}

void check_count(std::string_view key, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value >= least && value <= most) return;
  refuse_field(key, fmt::format("{}", value), fmt::format("is out of range; {} to {} is expected", least, most));
}

void check_temperature(const std::optional<double>& temperature) {
  if (temperature && !(*temperature >= 0)) {
    refuse_field("temperature", *temperature, "is not a valid temperature; 0 or more is expected");
  }
}

Box cube(double edge) { return Box::periodic(Vec3<double>(edge, edge, edge)); }

Vec3<double> direction(Philox& random) {
  const auto bits = random.next();
  const double z = 2 * open_uniform(bits[0], bits[1]) - 1, r = std::sqrt(1 - z * z);
  const auto [cosine, sine] = detail::turn_by_series(open_uniform(bits[2], bits[3]));
  return Vec3<double>(r * cosine, r * sine, z);
}

std::size_t lot(Philox& random, std::size_t count) {
  return static_cast<std::size_t>((std::uint64_t{random.next()[0]} * count) >> 32U);
}

void leave_vacancies(std::vector<Site>& sites, std::size_t wanted, std::int64_t seed) {
  Philox vacancies(static_cast<std::uint64_t>(seed), vacancy_stream);
  while (sites.size() > wanted) {
    sites[lot(vacancies, sites.size())] = sites.back();
    sites.pop_back();
  }
}

double take_off_drift(ParticleSystem<double>& s) {
  Vec3<double> momentum = Vec3<double>::Zero();
  double total = 0, twice = 0;
  const auto& masses = std::as_const(s).masses();
  for (Index i = 0; i < s.size(); ++i) {
    total += masses[i];
    momentum += masses[i] * std::as_const(s).velocities()[i];
  }
  const Vec3<double> drift = momentum / total;
  for (Index i = 0; i < s.size(); ++i) {
    if (!(masses[i] > 0)) continue;
    const Vec3<double> v = std::as_const(s).velocities()[i] - drift;
    s.velocities().set(i, v);
    twice += masses[i] * v.squaredNorm();
  }
  return twice;
}

}  // namespace noether::detail
