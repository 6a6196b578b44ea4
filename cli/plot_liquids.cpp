/// What is asked of liquids: the radial distribution function and the mean square displacement.

#include "cli/plot_source.hpp"
#include "engine/sums.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace noether {

namespace {

/// Of more types the mean over all pairs is drawn.
constexpr std::size_t most_types = 3;
constexpr std::size_t most_frames = 10;
/// Distances per frame; of more pairs some particles in the middle are left out.
constexpr double most_distances = 2e7;
/// Displacements of particles that are summed up for all lags together.
constexpr double most_displacements = 5e7;

/// Particles by type, one type where there are none or too many.
struct ByType {
  std::vector<std::string> names;
  std::vector<std::size_t> of, counts;
};

ByType by_type(const io::Frames& frames) {  // what they share is enough
  const std::size_t n = frames.masses.size();
  ByType types{.names = {}, .of = std::vector<std::size_t>(n, 0), .counts = {n}};
  if (frames.types.size() != n) return types;
  std::map<std::string, std::size_t> numbers;
  for (const std::string& type : frames.types) numbers.try_emplace(type, 0);
  if (numbers.size() < 2 || numbers.size() > most_types) return types;
  for (auto& [name, number] : numbers) number = types.names.size(), types.names.push_back(name);
  types.counts.assign(types.names.size(), 0);
  for (std::size_t i = 0; i < n; ++i) ++types.counts[types.of[i] = numbers[frames.types[i]]];
  return types;
}

/// Counts of ordered pairs by type of the center, type of the other, and interval of distance.
struct PairCounts {
  double reach = 0;
  std::size_t bins = 0, types = 1;
  std::vector<double> counts;
  std::vector<double> expected;  ///< pairs in a volume 1 of an ideal gas, by types
};

/// The molecule of each particle, and how many particles of each type it has.
struct Molecules {
  std::vector<std::size_t> of;
  std::vector<std::size_t> counts;  ///< by molecule and type
};

/// @param molecules  by particle; empty: each particle is one
Molecules counted_molecules(const ByType& types, const std::vector<std::size_t>& molecules) {
  Molecules result{.of = molecules, .counts = {}};
  if (molecules.empty()) {
    result.of.resize(types.of.size());
    std::iota(result.of.begin(), result.of.end(), std::size_t{0});
  }
  const std::size_t kinds = types.counts.size();
  for (std::size_t i = 0; i < types.of.size(); ++i) {
    const std::size_t at = result.of[i] * kinds;
    if (result.counts.size() < at + kinds) result.counts.resize(at + kinds, 0);
    ++result.counts[at + types.of[i]];
  }
  return result;
}

void count_pairs(PairCounts& all, const io::Frame& frame, const ByType& types, const Molecules& molecules) {
  const std::size_t n = types.of.size();
  const double distances = static_cast<double>(n) * static_cast<double>(n);
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(distances / most_distances)));
  const Box box = Box::periodic({frame.edges[0], frame.edges[1], frame.edges[2]});
  const std::vector<double>& x = frame.positions;
  std::vector<std::size_t> seen(all.types, 0);
  for (std::size_t i = 0; i < n; ++i) {
    // Every type has its own stride: types that follow each other in a cycle would be missed by one over all.
    if (seen[types.of[i]]++ % stride != 0) continue;
    const std::size_t a = types.of[i], own = molecules.of[i];
    for (std::size_t b = 0; b < all.types; ++b) {
      const std::size_t others = types.counts[b] - molecules.counts[own * all.types + b];
      all.expected[a * all.types + b] += static_cast<double>(others) / box.volume();
    }
    for (std::size_t j = 0; j < n; ++j) {
      if (molecules.of[j] == own) continue;
      const double r =
          box.minimum_image(Vec3<double>(x[3 * i] - x[3 * j], x[3 * i + 1] - x[3 * j + 1], x[3 * i + 2] - x[3 * j + 2]))
              .norm();
      const auto bin = static_cast<std::size_t>(r / all.reach * static_cast<double>(all.bins));
      if (r < all.reach && bin < all.bins) ++all.counts[(a * all.types + types.of[j]) * all.bins + bin];
    }
  }
}

/// The frames g(r) is a mean of: some of the second half, the last among them.
std::vector<std::size_t> frames_of_second_half(std::size_t frames) {
  std::vector<std::size_t> chosen;
  const std::size_t first = frames / 2, stride = (frames - first) / most_frames + 1;
  for (std::size_t k = frames - 1;; k -= stride) {
    chosen.push_back(k);
    if (k < first + stride) break;
  }
  std::reverse(chosen.begin(), chosen.end());
  return chosen;
}

/// Particles whose displacements are looked at: all of `n`, or about `most` of them, a thousand at least. Their numbers
/// follow the golden ratio: types that follow each other in a cycle are all among them.
std::vector<std::size_t> looked_at(std::size_t n, std::size_t most) {
  static constexpr std::size_t least = 1000;
  const double part = static_cast<double>(std::max(most, least)) / static_cast<double>(n);
  std::vector<std::size_t> particles;
  for (std::size_t i = 0; i < n; ++i) {
    const double turn = static_cast<double>(i) * std::numbers::phi;
    if (part >= 1 || turn - std::floor(turn) < part) particles.push_back(i);
  }
  return particles;
}

/// Positions of particles in a frame as if never wrapped, about the center of mass of all, shape (particles, 3).
std::vector<double> unwrapped(const io::Frames& all, const io::Frame& frame,
                              const std::vector<std::size_t>& particles) {
  std::vector<double> x = frame.positions;
  for (std::size_t k = 0; k < x.size() && !frame.images.empty(); ++k) x[k] += frame.images[k] * frame.edges[k % 3];
  const auto n = static_cast<Index>(all.masses.size());
  const auto mass = [&](Index i) { return all.masses[static_cast<std::size_t>(i)]; };
  const double total = sum_over<double>(n, mass);
  std::vector<double> seen(3 * particles.size());
  for (std::size_t k = 0; k < 3; ++k) {
    const auto moment = [&](Index i) { return mass(i) * x[3 * static_cast<std::size_t>(i) + k]; };
    const double middle = total > 0 ? sum_over<double>(n, moment) / total : 0;
    for (std::size_t j = 0; j < particles.size(); ++j) seen[3 * j + k] = x[3 * particles[j] + k] - middle;
  }
  return seen;
}

double mean_square(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<Index>(a.size() / 3);
  const double sum = sum_over<double>(n, [&](Index i) {
    const auto at = 3 * static_cast<std::size_t>(i);
    const double x = a[at] - b[at], y = a[at + 1] - b[at + 1], z = a[at + 2] - b[at + 2];
    return x * x + y * y + z * z;
  });
  return sum / static_cast<double>(n);
}

bool at_equal_distances(const std::vector<double>& times) {
  const double first = times[1] - times[0];
  for (std::size_t k = 2; k < times.size(); ++k) {
    if (std::abs(times[k] - times[k - 1] - first) > 1e-6 * std::abs(first)) return false;
  }
  return true;
}

/// Slope of a straight line through the points from `first` on; `p` of t^p where logarithms are taken.
double slope_of(const std::vector<PlotPoint>& points, std::size_t first, bool logarithms) {
  const auto value = [&](double x) { return logarithms ? std::log(x) : x; };
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = first; k < points.size(); ++k) {
    const double a = value(points[k].x), b = value(points[k].y);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// "D = 0.031 nm^2/ps" from the second half of the lags, or how it grows where that is no diffusion.
std::string diffusion(const std::vector<PlotPoint>& points, const io::Frames& frames) {
  const std::size_t half = points.size() / 2;
  if (points.size() < half + 3) return "";
  const double power = slope_of(points, half, true);
  if (!(std::abs(power - 1) <= 0.1)) return std::isfinite(power) ? fmt::format(": grows as t^{:.2g}", power) : "";
  const bool plain = frames.length_unit == "1" || frames.length_unit.empty();
  const std::string unit = plain ? "" : fmt::format(" {}^2/{}", frames.length_unit, frames.time_unit);
  return fmt::format(": D = {:.2g}{}", slope_of(points, half, false) / 6, unit);
}

std::vector<PlotPoint> displacement_of_monitor(const io::MonitorSeries& monitor) {
  std::vector<PlotPoint> points;
  const auto lags = monitor.quantities.find("lag"), values = monitor.quantities.find("value");
  if (lags == monitor.quantities.end() || values == monitor.quantities.end() || lags->second.first.size() != 1) {
    return points;
  }
  const auto row = static_cast<std::size_t>(lags->second.first[0]);
  const std::vector<double>&t = lags->second.second, &y = values->second.second;
  if (row == 0 || t.size() < row || y.size() != t.size()) return points;
  for (std::size_t k = t.size() - row; k < t.size(); ++k) {  // the last look has the longest mean
    if (t[k] > 0 && std::isfinite(y[k])) points.push_back({t[k], y[k]});
  }
  return points;
}

/// Numbers of molecules whose pairs tell nothing of a liquid; nothing where no particles are linked, or where more than
/// half of them hang together, as in a network or a crystal.
std::vector<std::size_t> separate_molecules(std::size_t n, const ParticleLinks& links) {
  if (links.pairs.empty()) return {};
  std::vector<std::size_t> molecules = molecules_of(n, links), sizes(n, 0);
  for (const std::size_t molecule : molecules) ++sizes[molecule];
  if (2 * *std::max_element(sizes.begin(), sizes.end()) > n) return {};
  return molecules;
}

std::string told_distribution(bool bonded, bool between_molecules, const std::string& mean) {
  const std::string pairs = between_molecules ? " between molecules" : bonded ? ", bonded pairs too" : "";
  return fmt::format("{}{}, {}", bonded ? "g(r)" : "Radial distribution function", pairs, mean);
}

std::vector<PlotCurve> distribution_of_monitor(const io::MonitorSeries& monitor) {
  const auto at = monitor.quantities.find("distance"), values = monitor.quantities.find("value");
  if (at == monitor.quantities.end() || values == monitor.quantities.end() || at->second.first.size() != 1) return {};
  const auto row = static_cast<std::size_t>(at->second.first[0]);
  const std::vector<double>&r = at->second.second, &g = values->second.second;
  if (row == 0 || r.size() < row || g.size() != r.size()) return {};
  PlotCurve curve;
  for (std::size_t k = r.size() - row; k < r.size(); ++k) {
    if (std::isfinite(g[k])) curve.points.push_back({r[k], g[k]});
  }
  return {std::move(curve)};
}

}  // namespace

std::vector<PlotCurve> radial_distributions(const PlotFrames& frames, const std::vector<std::size_t>& chosen,
                                            const std::vector<std::size_t>& molecules) {
  const ByType types = by_type(frames.shared);
  const Molecules whole = counted_molecules(types, molecules);
  PairCounts all;
  all.types = types.counts.size();
  all.reach = INFINITY;
  for (const std::size_t k : chosen) {
    const std::vector<double> edges = frames.frame(k).edges;
    if (edges.size() != 3) return {};
    all.reach = std::min(all.reach, 0.5 * *std::min_element(edges.begin(), edges.end()));
  }
  const double distances = static_cast<double>(frames.bodies() * frames.bodies() * chosen.size());
  all.bins = static_cast<std::size_t>(std::clamp(std::sqrt(distances) / 10, 40.0, 150.0));
  all.counts.assign(all.types * all.types * all.bins, 0);
  all.expected.assign(all.types * all.types, 0);
  for (const std::size_t k : chosen) count_pairs(all, frames.frame(k), types, whole);
  std::vector<PlotCurve> curves;
  const double width = all.reach / static_cast<double>(all.bins);
  for (std::size_t a = 0; a < all.types; ++a) {
    for (std::size_t b = a; b < all.types; ++b) {
      const double expected = all.expected[a * all.types + b];
      if (!(expected > 0)) continue;
      PlotCurve curve{.name = types.names.empty() ? "" : types.names[a] + "-" + types.names[b], .points = {}};
      for (std::size_t k = 0; k < all.bins; ++k) {
        const double inner = width * static_cast<double>(k), outer = inner + width;
        const double shell = 4 * std::numbers::pi / 3 * (outer * outer * outer - inner * inner * inner);
        const double count = all.counts[(a * all.types + b) * all.bins + k];
        curve.points.push_back({(inner + outer) / 2, count / (expected * shell)});
      }
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

std::optional<PlotPanel> plot_radial_distribution(const PlotSource& source, bool one_frame) {
  const PlotFrames& frames = source.frames;
  const bool bonded = !source.links.pairs.empty();
  PlotPanel panel;
  const io::MonitorSeries* monitor = find_monitor(source.monitors, "radial_distribution");
  if (monitor != nullptr && !one_frame) {
    panel.curves = distribution_of_monitor(*monitor);
    panel.title = told_distribution(bonded, false, "mean of the run");
  }
  if (panel.curves.empty()) {
    if (frames.empty() || frames.bodies() < 2) return {};
    const auto chosen = one_frame ? std::vector<std::size_t>{source.shown} : frames_of_second_half(frames.size());
    const std::vector<std::size_t> molecules = separate_molecules(frames.bodies(), source.links);
    panel.curves = radial_distributions(frames, chosen, molecules);
    panel.title = told_distribution(bonded, !molecules.empty(),
                                    chosen.size() > 1 ? fmt::format("mean of {} frames", chosen.size()) : "one frame");
  }
  if (panel.curves.empty() || panel.curves[0].points.empty()) return {};
  const std::vector<PlotPoint>& first = panel.curves[0].points;
  panel.x = {.label = with_unit("r", frames.shared.length_unit), .low = 0, .high = first.back().x + first.front().x};
  panel.y.label = "g(r)";
  fit_values(panel);
  panel.y.low = 0;
  if (panel.curves.size() > 1) panel.y.high *= 1.2;  // room for the key
  return panel;
}

std::vector<PlotPoint> mean_square_displacement(const PlotFrames& frames, std::size_t most_numbers) {
  const std::size_t n = frames.bodies();
  if (frames.size() < 2 || n == 0) return {};
  const std::vector<std::size_t> particles = looked_at(n, most_numbers / 3 / frames.size());
  const std::size_t held = std::max<std::size_t>(most_numbers / 3 / particles.size() + 1, 3);
  const std::size_t apart = (frames.size() + held - 1) / held;
  std::vector<std::vector<double>> x;
  std::vector<double> times;
  for (std::size_t k = 0; k < frames.size(); k += apart) {
    x.push_back(unwrapped(frames.shared, frames.frame(k), particles));
    times.push_back(frames.times[k]);
  }
  const std::size_t count = x.size();
  if (count < 2) return {};
  std::vector<PlotPoint> points;
  const bool all_origins = at_equal_distances(times);
  // The longest lags have few origins: of many frames the second half of the lags is left out.
  const std::size_t longest = all_origins && count > 12 ? (count - 1) / 2 : count - 1;
  const double per_lag = most_displacements / static_cast<double>(particles.size()) / static_cast<double>(longest);
  for (std::size_t lag = 1; lag <= longest; ++lag) {
    const std::size_t origins = all_origins ? count - lag : 1;
    const auto stride = static_cast<std::size_t>(std::max(1.0, std::ceil(static_cast<double>(origins) / per_lag)));
    std::vector<double> means;
    for (std::size_t from = 0; from < origins; from += stride) means.push_back(mean_square(x[from + lag], x[from]));
    const auto looks = static_cast<Index>(means.size());
    const double mean = sum_over<double>(looks, [&](Index k) { return means[static_cast<std::size_t>(k)]; });
    points.push_back({std::abs(times[lag] - times[0]), mean / static_cast<double>(looks)});
  }
  return points;
}

std::optional<PlotPanel> plot_mean_square_displacement(const PlotSource& source) {
  const io::MonitorSeries* monitor = find_monitor(source.monitors, "mean_square_displacement");
  std::vector<PlotPoint> points;
  if (monitor != nullptr) points = displacement_of_monitor(*monitor);
  if (points.size() < 2) points = mean_square_displacement(source.frames);
  std::erase_if(points, [](const PlotPoint& p) { return !(p.x > 0) || !(p.y > 0); });
  if (points.size() < 2) return {};
  PlotPanel panel;
  panel.title = "Mean square displacement" + diffusion(points, source.frames.shared);
  panel.y.label = with_unit("msd", source.frames.shared.length_unit == "1" || source.frames.shared.length_unit.empty()
                                       ? ""
                                       : source.frames.shared.length_unit + "^2");
  for (PlotPoint& p : points) p.x /= source.time.length;
  const bool decades = points.back().x > 30 * points.front().x;
  panel.x = {.label = with_unit("lag", source.time.unit),
             .low = decades ? points.front().x : 0,
             .high = points.back().x,
             .logarithmic = decades};
  panel.y.logarithmic = decades;
  panel.curves.push_back({.name = "", .points = std::move(points)});
  fit_values(panel);
  return panel;
}

}  // namespace noether
