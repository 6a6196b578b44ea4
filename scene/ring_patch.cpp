#include "scene/ring_patch.hpp"

#include "engine/sphere_columns.hpp"
#include "scene/builder_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace noether {

namespace {

/// Spheres in the plane of a patch that repeats, those of each doubling of radii in cells of their own.
class Placed {
 public:
  Placed(const std::array<double, 3>& size, double smallest, double largest) : size_(size) {
    for (double radius = smallest; levels_.empty() || radius < largest; radius *= 2) {
      Level level;
      level.largest = std::min(2 * radius, largest);
      for (int k = 0; k < 2; ++k) {
        const double cells = size[static_cast<std::size_t>(k)] / (2 * level.largest);
        level.cells[static_cast<std::size_t>(k)] = std::clamp<std::int64_t>(static_cast<std::int64_t>(cells), 1, 4096);
      }
      level.spheres.resize(static_cast<std::size_t>(level.cells[0] * level.cells[1]));
      levels_.push_back(std::move(level));
    }
  }

  bool is_free(const Vec3<double>& x, double radius) const {
    return std::all_of(levels_.begin(), levels_.end(), [&](const Level& level) {
      const double reach = radius + level.largest;
      std::array<std::int64_t, 2> low{}, high{};
      for (std::size_t k = 0; k < 2; ++k) {
        const double cell = size_[k] / static_cast<double>(level.cells[k]);
        low[k] = static_cast<std::int64_t>(std::floor((x[static_cast<Index>(k)] - reach) / cell));
        high[k] = static_cast<std::int64_t>(std::floor((x[static_cast<Index>(k)] + reach) / cell));
        if (high[k] - low[k] >= level.cells[k]) low[k] = 0, high[k] = level.cells[k] - 1;
      }
      for (std::int64_t a = low[0]; a <= high[0]; ++a) {
        for (std::int64_t b = low[1]; b <= high[1]; ++b) {
          for (const Sphere& other : level.spheres[place(level, a, b)]) {
            if (overlap(x, radius, other)) return false;
          }
        }
      }
      return true;
    });
  }
  void put(const Vec3<double>& x, double radius) {
    Level& level =
        *std::find_if(levels_.begin(), levels_.end() - 1, [&](const Level& one) { return radius <= one.largest; });
    const auto cell = [&](std::size_t k) {
      return static_cast<std::int64_t>(x[static_cast<Index>(k)] / size_[k] * static_cast<double>(level.cells[k]));
    };
    level.spheres[place(level, cell(0), cell(1))].push_back({x, radius});
  }

 private:
  struct Sphere {
    Vec3<double> x;
    double radius;
  };
  struct Level {
    double largest = 0;
    std::array<std::int64_t, 2> cells{};
    std::vector<std::vector<Sphere>> spheres;
  };

  static std::size_t place(const Level& level, std::int64_t a, std::int64_t b) {
    const auto in = [](std::int64_t cell, std::int64_t cells) { return ((cell % cells) + cells) % cells; };
    return static_cast<std::size_t>(in(a, level.cells[0]) * level.cells[1] + in(b, level.cells[1]));
  }
  bool overlap(const Vec3<double>& x, double radius, const Sphere& other) const {
    Vec3<double> d = x - other.x;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto at = static_cast<Index>(k);
      d[at] -= size_[k] * std::nearbyint(d[at] / size_[k]);
    }
    // Places will be rounded to the grid of the box.
    const double touch = (radius + other.radius) * (1 + 1e-9);
    return d.squaredNorm() <= touch * touch;
  }

  std::array<double, 3> size_;
  std::vector<Level> levels_;
};

}  // namespace

void RingPatch::check() const {
  for (const double edge : size) {
    if (edge > 0 && std::isfinite(edge)) continue;
    refuse_field("size", size, "is not a box; three lengths above 0 are expected");
  }
  if (!Omega) {
    throw Error("the angular velocity of the frame is missing; give Omega, or use the Hamiltonian 'shearing_sheet'",
                {.key = "Omega"});
  }
  detail::check_above_zero("Omega", *Omega, "angular velocity of the frame");
  detail::check_above_zero("smallest", smallest, "radius");
  if (largest && !(*largest >= smallest && std::isfinite(*largest)))
    refuse_field("largest", *largest, fmt::format("is below the smallest radius, {}", smallest));
  if (!std::isfinite(exponent)) refuse_field("exponent", exponent, "is not finite");
  detail::check_above_zero("density", density, "density");
  const int amounts = (surface_density ? 1 : 0) + (optical_depth ? 1 : 0) + (particles ? 1 : 0);
  if (amounts != 1) {
    throw Error(fmt::format("{} of surface_density, optical_depth and particles; give one of them",
                            amounts == 0 ? "none is given" : "more than one is given"),
                {.key = surface_density ? "surface_density"
                        : optical_depth ? "optical_depth"
                                        : "particles"});
  }
  if (surface_density) detail::check_above_zero("surface_density", *surface_density, "surface density");
  if (optical_depth) detail::check_above_zero("optical_depth", *optical_depth, "optical depth");
  if (particles) detail::check_count("particles", *particles, 1);
  if (dispersion && !(*dispersion >= 0))
    refuse_field("dispersion", *dispersion, "is negative; 0 or a speed above is expected");
}

ParticleSystem<double> RingPatch::build(const UnitSystem& units) const {
  check();
  const double most = largest.value_or(smallest), area = size[0] * size[1];
  Philox lots(static_cast<std::uint64_t>(seed), detail::displacement_stream);
  const auto draw_radius = [&] {
    const double u = lots.uniform(), power = 1 - exponent;
    if (most == smallest) return smallest;
    if (std::abs(power) < 1e-12) return smallest * std::pow(most / smallest, u);
    const double low = std::pow(smallest, power), high = std::pow(most, power);
    return std::clamp(std::pow(low + u * (high - low), 1 / power), smallest, most);
  };
  const double wanted = surface_density ? *surface_density * area
                        : optical_depth ? *optical_depth * area
                                        : static_cast<double>(*particles);
  std::vector<double> radii;
  for (double sum = 0; sum < wanted;) {
    const double r = draw_radius(), volume = 4 * std::numbers::pi / 3 * r * r * r;
    sum += surface_density ? volume * density : optical_depth ? std::numbers::pi * r * r : 1;
    radii.push_back(r);
    if (static_cast<std::int64_t>(radii.size()) > detail::most_built)
      throw Error(fmt::format("the patch would have more than {} spheres; make it smaller", detail::most_built));
  }
  std::sort(radii.rbegin(), radii.rend());

  const double speed = dispersion.value_or(*Omega * most);
  double height = std::max(speed / *Omega, smallest);
  Placed placed(size, smallest, most);
  std::vector<Vec3<double>> places;
  for (const double r : radii) {
    for (int tries = 1;; ++tries) {
      const double x = size[0] * lots.uniform(), y = size[1] * lots.uniform(), z = height * lots.normal_pair()[0];
      if (tries % 100 == 0) height *= 1.05;
      if (height > size[2]) {
        refuse_field(
            "size", size,
            fmt::format("has no room for spheres of all {} radii without overlaps; make it larger", radii.size()));
      }
      const Vec3<double> at(x, y, z);
      if (std::abs(z) + r > size[2] / 2 || !placed.is_free(at, r)) continue;
      placed.put(at, r);
      places.push_back(at);
      break;
    }
  }

  const Philox velocities(static_cast<std::uint64_t>(seed), detail::velocity_stream);
  ParticleSystem<double> s(units);
  std::vector<std::int64_t> ids;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const auto [a, b] = normal_pair(velocities.at(2 * i));
    const double c = normal_pair(velocities.at(2 * i + 1))[0];
    ids.push_back(static_cast<std::int64_t>(i) + 1);
    s.add(fmt::format("sphere_{}", i + 1), 4 * std::numbers::pi / 3 * radii[i] * radii[i] * radii[i] * density,
          places[i], speed * Vec3<double>(a, b, c));
  }
  detail::take_off_drift(s);
  auto& column = s.add_column<BodyRadius>();
  for (Index i = 0; i < s.size(); ++i) {
    column[i] = radii[static_cast<std::size_t>(i)];
    s.velocities().add(i, Vec3<double>(0, -1.5 * *Omega * places[static_cast<std::size_t>(i)][0], 0));
  }
  s.trim();
  s.restore_ids(ids);
  s.set_box(Box::periodic(Vec3<double>(size[0], size[1], size[2])));
  return s;
}

}  // namespace noether
