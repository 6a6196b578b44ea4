#include "cli/view_paths.hpp"

#include "integrators/kepler.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

/// The path of a body turns by less than this from one frame to the next where they are dense [rad].
constexpr double smooth_turn = 0.4;
/// An arc leads to the next frame if it misses the direction there by less than this [rad].
constexpr double most_missed = 0.5;
/// An ellipse stands for a path that frames show densely if its size changes by less than this part.
constexpr double steady = 0.05;
constexpr std::size_t sampled_intervals = 400, sampled_particles = 200;

Vec3<double> of_body(const ViewData& data, const std::vector<float>& rows, std::size_t frame, std::size_t body) {
  const float* row = &rows[3 * (frame * data.particles() + body)];
  return {row[0], row[1], row[2]};
}

double angle_between(const Vec3<double>& a, const Vec3<double>& b) {
  return std::atan2(std::sqrt(norm2(cross(a, b))), dot(a, b));
}

/// Numbers of the frames whose intervals to the next are looked at.
std::vector<std::size_t> intervals_of(const ViewData& data) {
  const std::size_t all = data.frames.size() - 1;
  return spread_numbers(all, std::min(all, sampled_intervals));
}

double time_between(const ViewData& data, std::size_t k) { return data.frames[k + 1].time - data.frames[k].time; }

/// Whether a body comes as far from frame to frame as its velocity says, and turns little.
bool is_seen_densely(const ViewData& data, std::size_t body) {
  std::size_t rough = 0;
  const std::vector<std::size_t> intervals = intervals_of(data);
  for (const std::size_t k : intervals) {
    const Vec3<double> way = of_body(data, data.positions, k + 1, body) - of_body(data, data.positions, k, body);
    const Vec3<double> expected = time_between(data, k) * of_body(data, data.velocities, k, body);
    if (expected.norm() == 0) continue;
    if (angle_between(expected, way) > smooth_turn || way.norm() < 0.7 * expected.norm()) ++rough;
  }
  return 10 * rough <= intervals.size();
}

/// How the orbit of a body about the primary goes with the frames.
struct OrbitSeen {
  bool bound = true, leads = true, steady = true;
};

OrbitSeen orbit_seen(const ViewData& data, std::size_t body) {
  const double mu = data.mu[body];
  double least = INFINITY, most = 0;
  std::size_t missed = 0;
  const std::vector<std::size_t> intervals = intervals_of(data);
  for (const std::size_t k : intervals) {
    const Vec3<double> x = of_body(data, data.positions, k, body), v = of_body(data, data.velocities, k, body);
    const double axis = 1 / (2 / x.norm() - v.squaredNorm() / mu);
    if (!(axis > 0) || !std::isfinite(axis)) return {false, false, false};
    least = std::min(least, axis), most = std::max(most, axis);
    const KeplerArc<double> arc = kepler_arc(x, v, mu, time_between(data, k));
    const Vec3<double> there = of_body(data, data.positions, k + 1, body);
    const bool reached = arc.status == KeplerStatus::converged && angle_between(x + arc.dx, there) < most_missed;
    if (!reached) ++missed;
  }
  return {true, 10 * missed <= intervals.size(), most - least < steady * most};
}

ViewPath path_of(const ViewData& data, std::size_t body) {
  const bool dense = is_seen_densely(data, body);
  if (data.primary < 0 || body == static_cast<std::size_t>(data.primary)) {
    return dense || data.primary >= 0 ? ViewPath::smooth : ViewPath::jumps;
  }
  const OrbitSeen orbit = orbit_seen(data, body);
  if (dense) return orbit.leads && orbit.steady ? ViewPath::arcs : ViewPath::smooth;
  if (!orbit.bound) return ViewPath::jumps;
  return orbit.leads ? ViewPath::arcs : ViewPath::ellipse;
}

/// What a particle of many has done from one frame to the next; through a periodic box the shorter way.
Vec3<double> way_of(const ViewData& data, std::size_t k, std::size_t i) {
  Vec3<double> way;
  for (Index axis = 0; axis < 3; ++axis) {
    const std::size_t at = 3 * (k * data.particles() + i) + static_cast<std::size_t>(axis);
    const std::size_t next = at + 3 * data.particles();
    if (data.periodic()) {
      const auto moved = static_cast<std::int16_t>(data.fractions[next] - data.fractions[at]);
      way[axis] = moved / 65536.0 * data.frames[k].edges[axis];
    } else {
      way[axis] = double{data.positions[next]} - double{data.positions[at]};
    }
  }
  return way;
}

/// Whether a line from frame to frame is near what many particles do: they come less far than half of the way to their
/// neighbors, or hardly turn.
bool are_seen_densely(const ViewData& data) {
  double largest = 0;
  std::size_t turned = 0, looked = 0;
  const std::vector<std::size_t> particles =
      spread_numbers(data.particles(), std::min(data.particles(), sampled_particles));
  const std::size_t all = data.frames.size() - 1;
  for (const std::size_t k : spread_numbers(all, std::min<std::size_t>(all, 20))) {
    std::vector<double> ways;
    for (const std::size_t i : particles) {
      const Vec3<double> way = way_of(data, k, i);
      ways.push_back(way.norm());
      if (k + 2 >= data.frames.size()) continue;
      ++looked;
      if (angle_between(way, way_of(data, k + 1, i)) > smooth_turn) ++turned;
    }
    std::nth_element(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2), ways.end());
    largest = std::max(largest, ways[ways.size() / 2]);
  }
  return largest < 0.5 * data.spacing || (looked > 0 && 10 * turned < looked);
}

/// The distance of neighbors if particles filled their box, or a ball as wide as they stand on average, evenly.
double spacing_of(const ViewData& data) {
  const auto n = static_cast<double>(data.particles());
  if (data.periodic()) return std::cbrt(data.frames.front().edges.prod() / n);
  std::vector<double> distances;
  for (std::size_t i = 0; i < data.particles(); ++i) distances.push_back(of_body(data, data.positions, 0, i).norm());
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                   distances.end());
  // Half of them are within the median: a ball of n / 2.
  return distances[distances.size() / 2] * std::cbrt(4 * std::numbers::pi / 3 / (0.5 * n));
}

}  // namespace

void choose_paths(ViewData& data) {
  data.spacing = spacing_of(data);
  data.paths.clear();
  if (data.frames.size() < 2) {
    const bool ellipses = !data.mu.empty();
    for (std::size_t i = 0; i < data.particles() && !data.velocities.empty(); ++i)
      data.paths.push_back(ellipses && static_cast<std::int64_t>(i) != data.primary ? ViewPath::ellipse
                                                                                    : ViewPath::jumps);
    if (data.paths.empty()) data.paths = {ViewPath::jumps};
  } else if (data.velocities.empty()) {
    data.paths = {are_seen_densely(data) ? ViewPath::smooth : ViewPath::jumps};
  } else {
    for (std::size_t i = 0; i < data.particles(); ++i) data.paths.push_back(path_of(data, i));
  }
}

}  // namespace noether
