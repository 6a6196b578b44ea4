/// Orbits: the ways of few bodies, seen from above and from the side.

#include "cli/plot_source.hpp"
#include "engine/orbital_elements.hpp"
#include "engine/sums.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_path_points = 20'000, most_orbit_samples = 2'000;
/// Points of all paths together: more bodies have coarser ones.
constexpr std::size_t most_orbit_points = 120'000;
/// Frames are joined where the path turns by less than this between two of them [rad].
constexpr double smooth_turn = 0.4;
/// Inner bodies get a picture of their own where they are this much smaller than the outermost.
constexpr double scale_gap = 8;
/// A motion is flat where it goes this little out of a plane, of its size.
constexpr double flatness = 2e-3;

/// What one body does in all frames, as if never wrapped into a periodic box, relative to the primary if there is one.
struct Track {
  std::vector<PlotPlace> x, v;
  std::vector<double> time;
};

Track track_of(const io::Frames& all, std::size_t body, bool relative) {
  Track track;
  const auto place = [&](const auto& rows) {
    PlotPlace result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = rows[3 * body + k] - (relative ? rows[k] : 0);
    return result;
  };
  for (const io::Frame& frame : all.frames) {
    PlotPlace x = place(frame.positions);
    if (frame.edges.size() == 3 && !frame.images.empty()) {
      const PlotPlace crossings = place(frame.images);
      for (std::size_t k = 0; k < 3; ++k) x[k] += crossings[k] * frame.edges[k];
    }
    track.x.push_back(x);
    track.v.push_back(place(frame.velocities));
    track.time.push_back(frame.time);
  }
  return track;
}

Vec3<double> vector_of(const PlotPlace& place) { return {place[0], place[1], place[2]}; }

/// Whether frames are dense enough to join them: from one to the next the path turns little, and the body comes as far
/// as its velocity says (a body seen once in many periods does not).
bool is_dense(const Track& track) {
  std::size_t rough = 0;
  for (std::size_t k = 1; k < track.x.size(); ++k) {
    const Vec3<double> a = vector_of(track.v[k - 1]) * (track.time[k] - track.time[k - 1]);
    const Vec3<double> b = vector_of(track.x[k]) - vector_of(track.x[k - 1]);
    const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    if (turn > smooth_turn || b.norm() < 0.7 * a.norm()) ++rough;
  }
  return track.x.size() > 2 && 10 * rough < track.x.size();
}

/// The path through all frames: between two of them the cubic that meets positions and velocities.
std::vector<PlotPlace> path_through(const Track& track) {
  const std::size_t frames = track.x.size(), pieces = std::clamp<std::size_t>(most_path_points / frames, 1, 12);
  std::vector<PlotPlace> points = {track.x.front()};
  for (std::size_t k = 1; k < frames; ++k) {
    const double h = track.time[k] - track.time[k - 1];
    for (std::size_t j = 1; j <= pieces; ++j) {
      const double u = static_cast<double>(j) / static_cast<double>(pieces), w = 1 - u;
      const double fa = w * w * (1 + 2 * u), fb = u * u * (1 + 2 * w), ga = h * u * w * w, gb = -h * u * u * w;
      PlotPlace p;
      for (std::size_t c = 0; c < 3; ++c) {
        p[c] = fa * track.x[k - 1][c] + fb * track.x[k][c] + ga * track.v[k - 1][c] + gb * track.v[k][c];
      }
      points.push_back(p);
    }
  }
  return points;
}

/// The Kepler ellipse a body follows about particle 0 at one frame; empty if it is not bound.
std::vector<PlotPlace> ellipse(const io::Frames& all, const io::Frame& frame, std::size_t body, double G) {
  const auto relative = [&](const std::vector<double>& rows) {
    return Vec3<double>(rows[3 * body] - rows[0], rows[3 * body + 1] - rows[1], rows[3 * body + 2] - rows[2]);
  };
  const double mu = G * (all.masses[0] + all.masses[body]);
  OrbitalElements<double> o = elements_from_state<double>(relative(frame.positions), relative(frame.velocities), mu);
  if (!(o.a > 0) || !(o.e < 1) || !std::isfinite(o.inc)) return {};
  std::vector<PlotPlace> points;
  constexpr int pieces = 360;
  for (int k = 0; k <= pieces; ++k) {
    // Equal steps of the eccentric anomaly: round where the orbit is.
    const double E = 2 * std::numbers::pi * k / pieces;
    o.M = E - o.e * std::sin(E);
    const Vec3<double> x = state_from_elements<double>(o, mu).first;
    points.push_back({x[0], x[1], x[2]});
  }
  return points;
}

/// The corners of the smallest cuboid that holds every path.
std::pair<PlotPlace, PlotPlace> corners_of(const std::vector<PlotOrbit>& orbits) {
  PlotPlace low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
  const auto take = [&](const PlotPlace& p) {
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  };
  for (const PlotOrbit& orbit : orbits) {
    for (const auto* points : {&orbit.path, &orbit.samples}) std::for_each(points->begin(), points->end(), take);
    take(orbit.end);
  }
  return {low, high};
}

/// The views of a picture: the plane where most happens as a widest_view, others beside it on the same scale. One that
/// is flat is left out.
void choose_views(PlotOrbits& picture, bool centered, const std::string& projection, const std::string& about,
                  const std::string& unit) {
  auto [low, high] = corners_of(picture.orbits);
  PlotPlace middle{}, half{};
  for (std::size_t k = 0; k < 3; ++k) {
    middle[k] = centered ? 0 : (low[k] + high[k]) / 2;
    half[k] = std::max(high[k] - middle[k], middle[k] - low[k]);
  }
  double widest = *std::max_element(half.begin(), half.end());
  if (!(widest > 0)) widest = 1;
  std::vector<std::pair<std::size_t, std::size_t>> planes;
  if (projection == "xy" || projection == "xz" || projection == "yz") {
    planes = {{static_cast<std::size_t>(projection[0] - 'x'), static_cast<std::size_t>(projection[1] - 'x')}};
  } else if (projection == "all") {
    planes = {{0, 1}, {0, 2}, {2, 1}};
  } else if (half[2] < flatness * widest) {
    planes = {{0, 1}};
  } else if (half[1] < flatness * widest) {
    planes = {{0, 2}};
  } else if (half[0] < flatness * widest) {
    planes = {{1, 2}};
  } else if (half[2] <= std::max(half[0], half[1])) {
    planes = {{0, 1}, {0, 2}};
  } else if (half[0] >= half[1]) {
    planes = {{0, 2}, {0, 1}};
  } else {
    planes = {{1, 2}, {1, 0}};
  }
  const std::size_t aside = 3 - planes[0].first - planes[0].second;  // the axis that the first view does not have
  const auto label = [&](std::size_t axis) {
    // A side view has no room for more than the name of its axis.
    const std::string origin = picture.views.empty() ? about : "";
    return with_unit(std::string(1, static_cast<char>('x' + axis)) + origin, unit);
  };
  double widest_view = 0;
  for (std::size_t n = 0; n < planes.size(); ++n) {
    const auto [across, up] = planes[n];
    if (n == 0) widest_view = 1.08 * std::max(half[across], half[up]);
    if (!(widest_view > 0) || projection == "all") widest_view = 1.08 * widest;
    // A side view is as high as what it shows, and a seventh of the widest_view at least.
    const auto reach = [&](std::size_t axis) {
      const bool thin = n > 0 && axis == aside;
      return thin ? std::clamp(1.15 * half[aside], widest_view / 7, widest_view) : widest_view;
    };
    picture.views.push_back({.across = across,
                             .up = up,
                             .across_label = label(across),
                             .up_label = label(up),
                             .low = {middle[across] - reach(across), middle[up] - reach(up)},
                             .high = {middle[across] + reach(across), middle[up] + reach(up)}});
  }
}

/// Parts the inner bodies from the outer ones where the gap of scales is wide: the inner ones; nothing elsewhere.
std::optional<PlotOrbits> inner_part(const PlotOrbits& all) {
  std::vector<double> sizes;
  for (const PlotOrbit& orbit : all.orbits) {
    if (!orbit.primary) sizes.push_back(orbit.extent);
  }
  std::sort(sizes.begin(), sizes.end());
  if (sizes.size() < 4 || sizes[1] * scale_gap > sizes.back()) return {};
  // The widest gap (as a ratio) between neighbors divides them.
  std::size_t first_outer = 1;
  for (std::size_t k = 2; k < sizes.size(); ++k) {
    if (sizes[k] / sizes[k - 1] > sizes[first_outer] / sizes[first_outer - 1]) first_outer = k;
  }
  PlotOrbits inner{.title = "Inner orbits", .orbits = all.orbits, .views = {}};
  std::erase_if(inner.orbits, [&](const PlotOrbit& o) { return !o.primary && o.extent >= sizes[first_outer]; });
  if (inner.orbits.size() < 3) return {};
  return inner;
}

PlotOrbit orbit_of(const io::Frames& all, std::size_t body, std::size_t shown, std::optional<double> G) {
  const bool relative = has_primary(all);
  PlotOrbit orbit{.name = all.names[body], .color = body_color(all, body)};
  const Track track = track_of(all, body, relative);
  orbit.primary = relative && body == 0;
  orbit.end = track.x[shown];
  for (const PlotPlace& p : track.x) orbit.extent = std::max(orbit.extent, std::hypot(p[0], p[1], p[2]));
  if (orbit.primary) return orbit;
  const std::size_t most = std::min(most_path_points, most_orbit_points / all.masses.size());
  if (is_dense(track)) {
    orbit.path = thinned(path_through(track), most);
  } else {
    orbit.samples = thinned(track.x, std::min(most_orbit_samples, most));
    if (relative && G) orbit.path = ellipse(all, all.frames[shown], body, *G);
  }
  return orbit;
}

bool all_on_one_line(const io::Frames& all) {
  double x = 0, other = 0;
  for (const io::Frame& frame : all.frames) {
    for (std::size_t k = 0; k + 2 < frame.positions.size(); k += 3) {
      x = std::max(x, std::abs(frame.positions[k]));
      other = std::max({other, std::abs(frame.positions[k + 1]), std::abs(frame.positions[k + 2])});
    }
  }
  return x > 0 && other < 1e-9 * x;
}

}  // namespace

bool has_primary(const io::Frames& frames) {
  if (frames.masses.size() < 2) return false;
  const double others = sum_over<double>(static_cast<Index>(frames.masses.size()) - 1,
                                         [&](Index i) { return frames.masses[static_cast<std::size_t>(i) + 1]; });
  return frames.masses[0] > 10 * others;
}

std::size_t body_color(const io::Frames& frames, std::size_t body) {
  if (!has_primary(frames)) return body;
  return body == 0 ? primary_color : body - 1;
}

std::vector<PlotLegend> body_legend(const io::Frames& frames) {
  static constexpr std::size_t most = 13;  // the colors of the palette, and the one in the center
  std::vector<PlotLegend> legend;
  if (frames.names.size() > most - (has_primary(frames) ? 0 : 1)) return legend;
  for (std::size_t i = 0; i < frames.names.size(); ++i) legend.push_back({frames.names[i], body_color(frames, i)});
  return legend;
}

std::vector<PlotOrbits> plot_orbits(const io::Frames& frames, std::size_t shown, std::optional<double> G,
                                    const std::string& projection) {
  if (frames.frames.empty() || frames.masses.empty()) return {};
  const bool relative = has_primary(frames);
  PlotOrbits picture;
  for (std::size_t i = 0; i < frames.masses.size(); ++i) picture.orbits.push_back(orbit_of(frames, i, shown, G));
  const std::string about = relative ? " from " + frames.names[0] : "";
  choose_views(picture, relative, projection, about, frames.length_unit);
  std::optional<PlotOrbits> inner = relative ? inner_part(picture) : std::nullopt;
  if (!inner) return {std::move(picture)};
  picture.title = "All orbits";
  choose_views(*inner, true, projection, "", frames.length_unit);
  return {std::move(picture), std::move(*inner)};
}

std::optional<PlotPanel> plot_line_positions(const io::Frames& frames, const PlotTime& time) {
  if (frames.frames.empty() || frames.masses.empty() || !all_on_one_line(frames)) return {};
  PlotPanel panel;
  panel.title = "Positions";
  panel.large = true;
  panel.x = time.axis;
  panel.y.label = with_unit("x", frames.length_unit);
  const std::size_t n = frames.masses.size();
  for (std::size_t i = 0; i < n; ++i) {
    Track track = track_of(frames, i, false);
    // Paths in the plane of time and x: the cubic of both passes through the frames as they are.
    for (std::size_t k = 0; k < track.x.size(); ++k) {
      track.x[k] = {track.time[k] / time.length, track.x[k][0], 0};
      track.v[k] = {1 / time.length, track.v[k][0], 0};
    }
    PlotCurve curve{.name = "", .points = {}, .color = body_color(frames, i)};
    for (const PlotPlace& p : thinned(path_through(track), std::min(most_path_points, most_orbit_points / n))) {
      curve.points.push_back({p[0], p[1]});
    }
    panel.curves.push_back(std::move(curve));
  }
  fit_values(panel);
  return panel;
}

}  // namespace noether
