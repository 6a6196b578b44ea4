/// Many particles at one moment: spheres in their box, in perspective.

#include "cli/plot_source.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_kinds = 6;
/// Where the eye is: turned about the vertical, raised, and away from the middle in diagonals of the box.
constexpr double eye_turned = 0.55, eye_raised = 0.38, eye_away = 2.6;

/// A place as the eye sees it: x to the right, y up, z away from the eye; scale: how large things look there.
struct Seen {
  double x, y, z, scale;
};

class Camera {
 public:
  Camera(const PlotPlace& middle, double diagonal) : middle_(middle), distance_(eye_away * diagonal) {}
  Seen see(const PlotPlace& p) const {
    const double x = p[0] - middle_[0], y = p[1] - middle_[1], z = p[2] - middle_[2];
    const double right = std::cos(eye_turned) * x + std::sin(eye_turned) * y;
    const double behind = -std::sin(eye_turned) * x + std::cos(eye_turned) * y;
    const double up = std::cos(eye_raised) * z + std::sin(eye_raised) * behind;
    const double depth = std::cos(eye_raised) * behind - std::sin(eye_raised) * z;
    const double scale = distance_ / (distance_ + depth);
    return {right * scale, up * scale, depth, scale};
  }

 private:
  PlotPlace middle_;
  double distance_;
};

/// Which cells of the picture are covered by what is nearer.
class Covered {
 public:
  Covered(const PlotPoint& low, const PlotPoint& high)
      : low_(low), cell_((high.x - low.x) / cells), taken_(static_cast<std::size_t>(cells) * cells, false) {}
  /// Covers a disc. @return whether anything of it can be seen
  bool cover(const PlotDisc& disc) {
    const auto index = [&](double at, double from) { return static_cast<int>(std::floor((at - from) / cell_)); };
    const int x0 = std::max(0, index(disc.x - disc.radius, low_.x));
    const int x1 = std::min(cells - 1, index(disc.x + disc.radius, low_.x));
    const int y0 = std::max(0, index(disc.y - disc.radius, low_.y));
    const int y1 = std::min(cells - 1, index(disc.y + disc.radius, low_.y));
    bool seen = false;
    for (int j = y0; j <= y1; ++j) {
      for (int i = x0; i <= x1; ++i) {
        const double dx = low_.x + (i + 0.5) * cell_ - disc.x, dy = low_.y + (j + 0.5) * cell_ - disc.y;
        if (dx * dx + dy * dy > disc.radius * disc.radius) continue;
        const auto at = static_cast<std::size_t>(j) * cells + static_cast<std::size_t>(i);
        seen = seen || !taken_[at];
        taken_[at] = true;
      }
    }
    return seen || disc.radius < cell_;
  }

 private:
  static constexpr int cells = 500;
  PlotPoint low_;
  double cell_;
  std::vector<bool> taken_;
};

/// What particles are called and colored by: their types, masses, or molecules.
struct Kinds {
  std::vector<std::size_t> of;  ///< kind of each particle
  std::vector<PlotLegend> legend;
};

Kinds kinds_of(const ParticleSystem<double>& s, const std::string& mass_unit) {
  const Topology* topology = s.topology();
  const auto n = static_cast<std::size_t>(s.size());
  const bool typed = topology != nullptr && !topology->type_names.empty();
  std::map<std::string, std::size_t> numbers;
  std::vector<std::size_t> counts;
  Kinds kinds{.of = std::vector<std::size_t>(n), .legend = {}};
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = static_cast<Index>(i);
    const std::string type = typed ? topology->type_names[static_cast<std::size_t>(topology->type(at))] : "";
    const bool numbered = typed && type.find_first_not_of("0123456789") == std::string::npos;
    const std::string unit = mass_unit == "1" || mass_unit.empty() ? "" : " " + mass_unit;
    const std::string name =
        fmt::format("{}{}{}mass {:.5g}{}", numbered ? "type " : "", type, typed ? ", " : "", s.masses()[at], unit);
    const auto [found, added] = numbers.try_emplace(name, counts.size());
    if (added) counts.push_back(0), kinds.legend.push_back({name, found->second});
    kinds.of[i] = found->second;
    ++counts[found->second];
  }
  for (PlotLegend& entry : kinds.legend) entry.name = fmt::format("{} of {}", counts[entry.color], entry.name);
  if (kinds.legend.size() > most_kinds) {  // a heap of kinds is told as one
    kinds.legend = {{counted(s.size(), "particle"), 0}};
    kinds.of.assign(n, 0);
  }
  if (topology == nullptr || topology->molecules.empty() || topology->bonds.empty() || kinds.legend.size() > 1) {
    return kinds;
  }
  // Molecules of one kind of particle are told apart by their colors.
  std::map<std::int64_t, std::size_t> molecules;
  for (std::size_t i = 0; i < n; ++i) {
    kinds.of[i] = molecules.try_emplace(topology->molecules[i], molecules.size()).first->second;
  }
  kinds.legend[0].name +=
      fmt::format(" in {}, colored by molecule", counted(static_cast<std::int64_t>(molecules.size()), "molecule"));
  return kinds;
}

/// Half of the usual distance to the nearest neighbor, from some of the particles.
double usual_radius(const std::vector<PlotPlace>& places, const Box& box, double size) {
  const std::size_t n = places.size(), stride = std::max<std::size_t>(1, n / 150);
  std::vector<double> nearest;
  for (std::size_t i = 0; i < n; i += stride) {
    double least = INFINITY;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      Vec3<double> d(places[i][0] - places[j][0], places[i][1] - places[j][1], places[i][2] - places[j][2]);
      least = std::min(least, box.minimum_image(d).squaredNorm());
    }
    if (std::isfinite(least) && least > 0) nearest.push_back(std::sqrt(least));
  }
  if (nearest.empty()) return 0.02 * size;
  std::nth_element(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2), nearest.end());
  return std::clamp(0.5 * nearest[nearest.size() / 2], 0.002 * size, 0.05 * size);
}

/// The edges of a cuboid: those that meet in its farthest corner are behind everything.
void add_edges(PlotBox& picture, const Camera& camera, const PlotPlace& low, const PlotPlace& high) {
  std::array<Seen, 8> corners{};
  for (std::size_t c = 0; c < 8; ++c) {
    corners[c] = camera.see({c & 1U ? high[0] : low[0], c & 2U ? high[1] : low[1], c & 4U ? high[2] : low[2]});
  }
  std::size_t farthest = 0;
  for (std::size_t c = 1; c < 8; ++c) {
    if (corners[c].z > corners[farthest].z) farthest = c;
  }
  for (std::size_t a = 0; a < 8; ++a) {
    for (const std::size_t bit : {1U, 2U, 4U}) {
      const std::size_t b = a | bit;
      if (b == a) continue;
      auto& edges = a == farthest || b == farthest ? picture.far_edges : picture.near_edges;
      edges.push_back({{corners[a].x, corners[a].y}, {corners[b].x, corners[b].y}});
    }
  }
}

void add_sticks(PlotBox& picture, const ParticleSystem<double>& s, const std::vector<PlotPlace>& places,
                const Camera& camera, const Kinds& kinds, const std::vector<bool>& seen, double diagonal) {
  for (const BondedTerm<2>& bond : s.topology()->bonds) {
    const auto i = static_cast<std::size_t>(bond.particles[0]), j = static_cast<std::size_t>(bond.particles[1]);
    if (!seen[i] && !seen[j]) continue;
    bool crosses = false;
    PlotPlace middle;
    for (std::size_t k = 0; k < 3; ++k) {
      const double d = places[j][k] - places[i][k];
      crosses = crosses || (s.box().is_periodic() && std::abs(d) > 0.5 * s.box().edges()[static_cast<Index>(k)]);
      middle[k] = places[i][k] + d / 2;
    }
    if (crosses) continue;
    const Seen m = camera.see(middle);
    for (const std::size_t end : {i, j}) {
      const Seen e = camera.see(places[end]);
      picture.sticks.push_back({{e.x, e.y}, {m.x, m.y}, 0.5 + (e.z + m.z) / 2 / diagonal, kinds.of[end]});
    }
  }
  std::stable_sort(picture.sticks.begin(), picture.sticks.end(),
                   [](const PlotStick& a, const PlotStick& b) { return a.depth > b.depth; });
}

/// Takes out discs that others hide. @return which particles are left
std::vector<bool> take_out_hidden(PlotBox& picture, const std::vector<std::size_t>& order, std::size_t n) {
  Covered covered(picture.low, picture.high);
  std::vector<PlotDisc> left;
  std::vector<bool> seen(n, false);
  for (std::size_t k = picture.discs.size(); k-- > 0;) {  // the nearest first
    if (!covered.cover(picture.discs[k])) continue;
    seen[order[k]] = true;
    left.push_back(picture.discs[k]);
  }
  std::reverse(left.begin(), left.end());
  picture.discs = std::move(left);
  return seen;
}

void fit_square(PlotBox& picture) {
  PlotPoint low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
  const auto take = [&](double x, double y, double r) {
    low = {std::min(low.x, x - r), std::min(low.y, y - r)};
    high = {std::max(high.x, x + r), std::max(high.y, y + r)};
  };
  for (const PlotDisc& disc : picture.discs) take(disc.x, disc.y, disc.radius);
  for (const auto* edges : {&picture.far_edges, &picture.near_edges}) {
    for (const auto& [a, b] : *edges) take(a.x, a.y, 0), take(b.x, b.y, 0);
  }
  const PlotPoint middle{(low.x + high.x) / 2, (low.y + high.y) / 2};
  double half = 0.51 * std::max(high.x - low.x, high.y - low.y);
  if (!(half > 0)) half = 1;
  picture.low = {middle.x - half, middle.y - half};
  picture.high = {middle.x + half, middle.y + half};
}

}  // namespace

bool is_crowd(const PlotFrames& frames) {
  static constexpr std::size_t most_orbits = 150, few_in_box = 8;
  return !frames.empty() && frames.bodies() > (frames.periodic ? few_in_box : most_orbits);
}

PlotBox plot_box(const ParticleSystem<double>& s, const std::string& mass_unit, std::vector<PlotLegend>& legend) {
  const auto n = static_cast<std::size_t>(s.size());
  std::vector<PlotPlace> places(n);
  PlotPlace low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      places[i][k] = s.positions().component(static_cast<Index>(k))[static_cast<Index>(i)];
      low[k] = std::min(low[k], places[i][k]), high[k] = std::max(high[k], places[i][k]);
    }
  }
  for (std::size_t k = 0; k < 3 && s.box().is_periodic(); ++k) {
    low[k] = 0, high[k] = s.box().edges()[static_cast<Index>(k)];
  }
  PlotPlace middle;
  for (std::size_t k = 0; k < 3; ++k) middle[k] = (low[k] + high[k]) / 2;
  double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  if (!(diagonal > 0)) diagonal = 1;
  const Camera camera(middle, diagonal);
  const Kinds kinds = kinds_of(s, mass_unit);
  legend = kinds.legend;

  PlotBox picture;
  const bool bonded = s.topology() != nullptr && !s.topology()->bonds.empty();
  const double radius = usual_radius(places, s.box(), diagonal) * (bonded ? 0.72 : 0.95);
  std::vector<std::pair<Seen, std::size_t>> seen;
  for (std::size_t i = 0; i < n; ++i) seen.emplace_back(camera.see(places[i]), i);
  std::stable_sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.first.z > b.first.z; });
  std::vector<std::size_t> order;
  for (const auto& [at, i] : seen) {
    const double depth = std::clamp(0.5 + at.z / diagonal, 0.0, 1.0);
    picture.discs.push_back({at.x, at.y, radius * at.scale, depth, kinds.of[i]});
    order.push_back(i);
  }
  if (s.box().is_periodic()) add_edges(picture, camera, low, high);
  fit_square(picture);
  const std::vector<bool> left = take_out_hidden(picture, order, n);
  if (bonded) add_sticks(picture, s, places, camera, kinds, left, diagonal);
  return picture;
}

}  // namespace noether
