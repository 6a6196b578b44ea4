/// Orbits: the ways of few bodies, seen from above and from the side.

#include "cli/plot_source.hpp"
#include "engine/orbital_elements.hpp"
#include "engine/sums.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>

namespace noether {

namespace {

constexpr std::size_t most_path_points = 20'000, least_path_points = 2, most_orbit_samples = 2'000;
/// Bodies that a legend tells apart, beside a primary: so many as there are colors.
constexpr std::size_t most_named = 12;
/// Points of all paths together: more bodies have coarser ones.
constexpr std::size_t most_orbit_points = 120'000;
/// Frames are joined where the path turns by less than this between two of them [rad].
constexpr double joined_turn = 0.4;
/// Inner bodies get a picture of their own where they are this much smaller than the outermost.
constexpr double scale_gap = 8;
/// A motion is flat where it goes this little out of a plane, of its size.
constexpr double flatness = 2e-3;

/// What one body does in all frames, as if never wrapped into a periodic box, relative to the primary if there is one.
struct BodyTrack {
  std::vector<PlotPlace> x, v;
  std::vector<double> time;
};

/// The body that places are relative to; nothing: they are those of the file.
using Center = std::optional<std::size_t>;

template <class Number> PlotPlace relative_row(const std::vector<Number>& rows, std::size_t body, Center center) {
  PlotPlace result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = static_cast<double>(rows[3 * body + k]) - (center ? static_cast<double>(rows[3 * *center + k]) : 0);
  }
  return result;
}

PlotPlace place_of(const io::Frame& frame, std::size_t body, Center center) {
  PlotPlace x = relative_row(frame.positions, body, center);
  if (frame.edges.size() == 3 && !frame.images.empty()) {
    const PlotPlace crossings = relative_row(frame.images, body, center);
    for (std::size_t k = 0; k < 3; ++k) x[k] += crossings[k] * frame.edges[k];
  }
  return x;
}

BodyTrack track_of(const io::Frames& all, std::size_t body, Center center) {
  BodyTrack track;
  for (const io::Frame& frame : all.frames) {
    track.x.push_back(place_of(frame, body, center));
    track.v.push_back(relative_row(frame.velocities, body, center));
    track.time.push_back(frame.time);
  }
  return track;
}

Vec3<double> vector_of(const PlotPlace& place) { return {place[0], place[1], place[2]}; }

/// Whether frames are dense enough to join them: from one to the next the path turns little, and the body comes as far
/// as its velocity says (a body seen once in many periods does not).
bool is_dense(const BodyTrack& track) {
  std::size_t rough = 0;
  for (std::size_t k = 1; k < track.x.size(); ++k) {
    const Vec3<double> a = vector_of(track.v[k - 1]) * (track.time[k] - track.time[k - 1]);
    const Vec3<double> b = vector_of(track.x[k]) - vector_of(track.x[k - 1]);
    const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    if (turn > joined_turn || b.norm() < 0.7 * a.norm()) ++rough;
  }
  return track.x.size() > 2 && 10 * rough < track.x.size();
}

/// The path through all frames: between two of them the cubic that meets positions and velocities.
std::vector<PlotPlace> path_through(const BodyTrack& track) {
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

/// An ellipse about the center; empty for a body that is not bound.
std::vector<PlotPlace> ellipse_of(OrbitalElements<double> o) {
  if (!(o.a > 0) || !(o.e < 1) || !std::isfinite(o.inc)) return {};
  std::vector<PlotPlace> points;
  constexpr int pieces = 360;
  for (int k = 0; k <= pieces; ++k) {
    // Equal steps of the eccentric anomaly: round where the orbit is.
    const double E = 2 * std::numbers::pi * k / pieces;
    o.M = E - o.e * std::sin(E);
    const Vec3<double> x = state_from_elements<double>(o, 1.0).first;
    points.push_back({x[0], x[1], x[2]});
  }
  return points;
}

/// The Kepler ellipse a body follows about the primary at one frame; empty if it is not bound.
std::vector<PlotPlace> ellipse(const io::Frames& all, const io::Frame& frame, std::size_t body, std::size_t primary,
                               double G) {
  const auto relative = [&](const std::vector<double>& rows) {
    return Vec3<double>(rows[3 * body] - rows[3 * primary], rows[3 * body + 1] - rows[3 * primary + 1],
                        rows[3 * body + 2] - rows[3 * primary + 2]);
  };
  const double mu = G * (all.masses[primary] + all.masses[body]);
  return ellipse_of(elements_from_state<double>(relative(frame.positions), relative(frame.velocities), mu));
}

/// The corners of the smallest cuboid that holds every path.
std::pair<PlotPlace, PlotPlace> corners_of(const PlotOrbits& picture) {
  PlotPlace low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
  const auto take = [&](const PlotPlace& p) {
    for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  };
  for (const PlotOrbit& orbit : picture.orbits) {
    for (const auto* points : {&orbit.path, &orbit.samples}) std::for_each(points->begin(), points->end(), take);
    take(orbit.end);
  }
  for (const PlotLinks& links : picture.links) {
    for (const auto& [a, b] : links.lines) take(a), take(b);
  }
  return {low, high};
}

/// The views of a picture: the plane where most happens as a widest_view, others beside it on the same scale. One that
/// is flat is left out.
void choose_views(PlotOrbits& picture, bool centered, const std::string& projection, const std::string& about,
                  const std::string& unit) {
  auto [low, high] = corners_of(picture);
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
  PlotOrbits inner{.title = "Inner orbits", .orbits = all.orbits};
  std::erase_if(inner.orbits, [&](const PlotOrbit& o) { return !o.primary && o.extent >= sizes[first_outer]; });
  if (inner.orbits.size() < 3) return {};
  // Ends of links are places of bodies; those beyond the inner bodies' are of outer ones.
  const auto is_inner = [reach = sizes[first_outer - 1] * (1 + 1e-9)](const PlotPlace& p) {
    return std::hypot(p[0], p[1], p[2]) <= reach;
  };
  for (const PlotLinks& links : all.links) {
    PlotLinks kept{.lines = {}, .age = links.age};
    for (const auto& [a, b] : links.lines) {
      if (is_inner(a) && is_inner(b)) kept.lines.emplace_back(a, b);
    }
    if (!kept.lines.empty()) inner.links.push_back(std::move(kept));
  }
  return inner;
}

/// Whether links say more than paths: there are many bodies, and most are linked.
bool shows_links_alone(std::size_t bodies, const ParticleLinks& links) {
  return bodies > most_named && 2 * links.pairs.size() >= bodies;
}

/// Frames that follow each other in the file, up to the one that is shown: of a long run those that are kept stand too
/// far apart to tell whether the body was seen often enough. Read once, where they are asked for.
class RecentFrames {
 public:
  RecentFrames(const PlotFrames& all, const KeptFrames& kept, std::size_t shown)
      : all_(all), thinned_(kept.frames.frames.size() < all.size()), shown_(shown) {}

  /// Nothing where all frames are kept.
  const io::Frames* frames() {
    if (!thinned_) return nullptr;
    if (!read_) read();
    return &*read_;
  }

 private:
  void read() {
    static constexpr std::size_t most_recent = 500;
    const std::size_t count =
        std::min({all_.size(), most_recent, std::max<std::size_t>(most_frames_of_paths(all_.bodies()), 3)});
    const std::size_t begin = shown_ + 1 > count ? shown_ + 1 - count : 0;
    read_ = all_.shared;
    for (std::size_t k = begin; k < begin + count; ++k) read_->frames.push_back(all_.frame(k));
  }

  const PlotFrames& all_;
  bool thinned_;
  std::size_t shown_;
  std::optional<io::Frames> read_;
};

PlotOrbit orbit_of(const KeptFrames& kept, RecentFrames& recent, const PlotFrames& frames, std::size_t body,
                   Center center, std::optional<double> G) {
  const io::Frames& all = kept.frames;
  PlotOrbit orbit{.name = all.names[body], .color = body_color(frames, body)};
  const BodyTrack track = track_of(all, body, center);
  orbit.primary = center == body;
  orbit.end = track.x[kept.shown];
  for (const PlotPlace& p : track.x) orbit.extent = std::max(orbit.extent, std::hypot(p[0], p[1], p[2]));
  if (orbit.primary) return orbit;
  const std::size_t most =
      std::clamp<std::size_t>(most_orbit_points / all.masses.size(), least_path_points, most_path_points);
  if (is_dense(track)) {
    orbit.path = thinned(path_through(track), most);
  } else {
    orbit.samples = thinned(track.x, std::min(most_orbit_samples, most));
    if (const io::Frames* close = recent.frames()) {
      const BodyTrack way = track_of(*close, body, center);
      if (is_dense(way)) orbit.path = thinned(path_through(way), most);
    }
    if (orbit.path.empty() && center && G) orbit.path = ellipse(all, all.frames[kept.shown], body, *center, *G);
  }
  return orbit;
}

/// Links at one moment. One through the wall of a box is left out.
PlotLinks links_at(const io::Frame& frame, const ParticleLinks& links, Center center) {
  PlotLinks seen;
  const auto add = [&](const PlotPlace& a, const PlotPlace& b) {
    bool crosses = false;
    for (std::size_t k = 0; k < frame.edges.size(); ++k) {
      crosses = crosses || std::abs(a[k] - b[k]) > 0.5 * frame.edges[k];
    }
    if (!crosses) seen.lines.emplace_back(a, b);
  };
  for (const auto& [i, j] : links.pairs) add(place_of(frame, i, center), place_of(frame, j, center));
  for (const Anchor& anchor : links.anchors) {
    PlotPlace point = {anchor.point[0], anchor.point[1], anchor.point[2]};
    for (std::size_t k = 0; k < 3 && center; ++k) point[k] -= frame.positions[3 * *center + k];
    add(point, place_of(frame, anchor.body, center));
  }
  return seen;
}

/// Links at the frame that is shown, and where they stand for paths at moments before it.
std::vector<PlotLinks> links_seen(const KeptFrames& kept, const ParticleLinks& links, Center center) {
  static constexpr std::size_t moments = 14;
  std::vector<PlotLinks> all;
  if (links.empty()) return all;
  const std::size_t before = shows_links_alone(kept.frames.masses.size(), links) ? std::min(kept.shown, moments) : 0;
  for (std::size_t k = before + 1; k-- > 0;) {
    const std::size_t frame = kept.shown - (before == 0 ? 0 : k * kept.shown / before);
    all.push_back(links_at(kept.frames.frames[frame], links, center));
    all.back().age = before == 0 ? 0 : static_cast<double>(k) / static_cast<double>(before);
  }
  return all;
}

/// All places in another unit.
void rescale(PlotOrbits& picture, double unit) {
  const auto scale = [unit](PlotPlace& p) {
    for (double& x : p) x /= unit;
  };
  for (PlotOrbit& orbit : picture.orbits) {
    std::for_each(orbit.path.begin(), orbit.path.end(), scale);
    std::for_each(orbit.samples.begin(), orbit.samples.end(), scale);
    scale(orbit.end);
    orbit.extent /= unit;
  }
  for (PlotLinks& links : picture.links) {
    for (auto& [a, b] : links.lines) scale(a), scale(b);
  }
}

/// Chooses the views, and parts the picture where small orbits need a scale of their own.
std::vector<PlotOrbits> as_seen(PlotOrbits picture, const std::optional<std::string>& center,
                                const std::string& projection, const PlotLength& length) {
  if (length.length != 1) rescale(picture, length.length);
  const bool centered = center.has_value();
  choose_views(picture, centered, projection, centered ? " from " + *center : "", length.unit);
  std::optional<PlotOrbits> inner = centered ? inner_part(picture) : std::nullopt;
  if (!inner) return {std::move(picture)};
  picture.title = "All orbits";
  choose_views(*inner, true, projection, "", length.unit);
  return {std::move(picture), std::move(*inner)};
}

/// The palette's number of a color by its English name.
std::optional<std::size_t> color_called(std::string name) {
  static const std::map<std::string, std::size_t> colors = {
      {"blue", 0},   {"orange", 1}, {"teal", 2}, {"red", 3},    {"purple", 4}, {"violet", 4}, {"cyan", 5},
      {"yellow", 6}, {"green", 7},  {"pink", 8}, {"brown", 10}, {"gray", 11},  {"grey", 11}};
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = colors.find(name);
  return found == colors.end() ? std::nullopt : std::optional(found->second);
}

/// Whether all bodies but the primary are called by colors, such as red, green and blue.
bool called_by_colors(const PlotFrames& frames) {
  const std::vector<std::string>& names = frames.shared.names;
  if (names.empty() || names.size() > most_named) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (frames.primary != i && !color_called(names[i])) return false;
  }
  return true;
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

std::size_t body_color(const PlotFrames& frames, std::size_t body) {
  if (frames.primary == body) return primary_color;
  if (called_by_colors(frames)) return *color_called(frames.shared.names[body]);
  return frames.primary && *frames.primary < body ? body - 1 : body;
}

std::vector<PlotLegend> body_legend(const PlotFrames& frames) {
  const std::vector<std::string>& names = frames.shared.names;
  std::vector<PlotLegend> legend;
  if (names.size() > most_named + (frames.primary ? 1 : 0)) return legend;
  for (std::size_t i = 0; i < names.size(); ++i) legend.push_back({names[i], body_color(frames, i)});
  return legend;
}

std::vector<PlotOrbits> plot_orbits(const PlotFrames& frames, std::size_t shown, std::optional<double> G,
                                    const std::string& projection, const ParticleLinks& links,
                                    const std::optional<PlotLength>& length) {
  if (frames.empty() || frames.bodies() == 0) return {};
  const std::size_t n = frames.bodies();
  const KeptFrames kept = kept_frames(frames, most_frames_of_paths(n), shown);
  const Center center = frames.primary;
  RecentFrames recent(frames, kept, shown);
  PlotOrbits picture;
  const bool links_alone = shows_links_alone(n, links);
  for (std::size_t i = 0; i < n; ++i) {
    picture.orbits.push_back(orbit_of(kept, recent, frames, i, center, G));
    if (!links_alone) continue;
    picture.orbits.back().path.clear(), picture.orbits.back().samples.clear();
    picture.orbits.back().color = 0;
  }
  if (links_alone) picture.size_of_bodies = 0.5, picture.links_alone = true;
  picture.links = links_seen(kept, links, center);
  return as_seen(std::move(picture), center ? std::optional(frames.shared.names[*center]) : std::nullopt, projection,
                 length.value_or(PlotLength{frames.shared.length_unit, 1}));
}

std::vector<PlotOrbits> plot_orbits_of_elements(const PlotSource& source, const std::string& projection) {
  static constexpr std::size_t columns = 6, most_ellipses = 150;
  const io::MonitorSeries* monitor = find_monitor(source.monitors, "elements");
  const std::size_t n = source.frames.bodies();
  if (monitor == nullptr || !monitor->quantities.contains("value") || n > most_ellipses) return {};
  const auto& [shape, values] = monitor->quantities.at("value");
  const bool fits = shape.size() == 2 && shape[0] == static_cast<Index>(n) && shape[1] == Index{columns};
  if (!fits || values.size() < n * columns) return {};
  const double* last = &values[values.size() - n * columns];
  PlotOrbits picture{.title = "Orbits at t = " + told_time(source.time, monitor->time.back()), .orbits = {}};
  std::optional<std::string> center;
  for (std::size_t i = 0; i < n; ++i) {
    const double* o = last + i * columns;
    PlotOrbit orbit{.name = source.frames.shared.names[i], .color = body_color(source.frames, i)};
    orbit.primary = std::isnan(o[0]) && !center;
    if (orbit.primary) center = orbit.name;
    const OrbitalElements<double> elements{o[0], o[1], o[2], o[3], o[4], o[5]};
    orbit.path = ellipse_of(elements);
    if (!orbit.primary && orbit.path.empty()) continue;  // not bound: its path has no end
    if (!orbit.primary) {
      const Vec3<double> x = state_from_elements<double>(elements, 1.0).first;
      orbit.end = {x[0], x[1], x[2]};
    }
    for (const PlotPlace& p : orbit.path) orbit.extent = std::max(orbit.extent, std::hypot(p[0], p[1], p[2]));
    picture.orbits.push_back(std::move(orbit));
  }
  if (picture.orbits.size() < 2 || !center) return {};
  return as_seen(std::move(picture), center, projection,
                 source.length.value_or(PlotLength{source.frames.shared.length_unit, 1}));
}

std::optional<PlotPanel> plot_line_positions(const PlotFrames& frames, const PlotTime& time) {
  if (frames.empty() || frames.bodies() == 0) return {};
  const std::size_t n = frames.bodies();
  const io::Frames all = kept_frames(frames, most_frames_of_paths(n), frames.size() - 1).frames;
  if (!all_on_one_line(all)) return {};
  PlotPanel panel;
  panel.title = "Positions";
  panel.large = true;
  panel.x = time.axis;
  panel.y.label = with_unit("x", all.length_unit);
  for (std::size_t i = 0; i < n; ++i) {
    BodyTrack track = track_of(all, i, {});
    // Paths in the plane of time and x: the cubic of both passes through the frames as they are.
    for (std::size_t k = 0; k < track.x.size(); ++k) {
      track.x[k] = {track.time[k] / time.length, track.x[k][0], 0};
      track.v[k] = {1 / time.length, track.v[k][0], 0};
    }
    PlotCurve curve{.name = "", .points = {}, .color = body_color(frames, i)};
    for (const PlotPlace& p :
         thinned(path_through(track),
                 std::clamp<std::size_t>(most_orbit_points / n, least_path_points, most_path_points))) {
      curve.points.push_back({p[0], p[1]});
    }
    panel.curves.push_back(std::move(curve));
  }
  fit_values(panel);
  return panel;
}

}  // namespace noether
