#include "constraints/rigid_frames.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace noether {

namespace {

/// Sines, and volumes of three unit vectors, below which directions are in line or in a plane: distances within would
/// be known to one digit in ten thousand of what they hold.
constexpr double flat = 1e-2;

std::string words_of(const ParticleSystem<double>& s, const std::vector<Index>& molecule) {
  constexpr std::size_t most_named = 4;
  std::string text;
  for (std::size_t k = 0; k < std::min(molecule.size(), most_named); ++k) {
    text += fmt::format("{}'{}'", k == 0 ? "" : ", ", s.name(molecule[k]));
  }
  if (molecule.size() > most_named) text += fmt::format(" and {} more", molecule.size() - most_named);
  return text;
}

/// Sites of a molecule relative to the first.
class Sites {
 public:
  Sites(const ParticleSystem<double>& s, const std::vector<Index>& molecule) {
    for (const Index i : molecule) {
      places_.push_back(s.box().minimum_image(Vec3<double>(s.positions()[i] - s.positions()[molecule[0]])));
    }
  }
  std::size_t size() const { return places_.size(); }
  Vec3<double> from(std::size_t a, std::size_t b) const { return places_[b] - places_[a]; }

  /// The site where a measure is largest.
  template <class Measure> std::size_t best(const Measure& measure) const {
    std::size_t best = 0;
    for (std::size_t k = 1; k < size(); ++k) {
      if (measure(k) > measure(best)) best = k;
    }
    return best;
  }

  /// How far three directions from one site are from a plane: the volume of their unit vectors.
  double spread(std::size_t at, const std::array<std::size_t, 3>& to) const {
    std::array<Vec3<double>, 3> d;
    double lengths = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = from(at, to[k]);
      lengths *= d[k].norm();
    }
    return lengths > 0 ? std::abs(dot(cross(d[0], d[1]), d[2])) / lengths : 0;
  }

  /// The sine of the angle at a site.
  double sine(std::size_t at, std::size_t one, std::size_t other) const {
    const Vec3<double> a = from(at, one), b = from(at, other);
    const double lengths = a.norm() * b.norm();
    return lengths > 0 ? cross(a, b).norm() / lengths : 0;
  }

  /// Four of them that span a tetrahedron, as wide as those before allow.
  std::array<std::size_t, 4> tetrahedron() const {
    const std::size_t a = 0, b = best([&](std::size_t k) { return from(a, k).norm(); });
    const Vec3<double> edge = from(a, b);
    const std::size_t c = best([&](std::size_t k) { return cross(edge, from(a, k)).norm(); });
    const Vec3<double> normal = cross(edge, from(a, c));
    const std::size_t d = best([&](std::size_t k) { return std::abs(normal.dot(from(a, k))); });
    return {a, b, c, d};
  }

 private:
  std::vector<Vec3<double>> places_;
};

/// The three corners that hold a site best.
std::array<std::size_t, 3> corners_for(const Sites& sites, std::size_t site, const std::array<std::size_t, 4>& of) {
  std::array<std::size_t, 3> chosen{};
  double most = -1;
  for (std::size_t left_out = 0; left_out < 4; ++left_out) {
    std::array<std::size_t, 3> corners{};
    for (std::size_t k = 0, at = 0; k < 4; ++k) {
      if (k != left_out) corners[at++] = of[k];
    }
    const double spread = sites.spread(site, corners);
    if (spread > most) most = spread, chosen = corners;
  }
  return chosen;
}

}  // namespace

std::vector<std::pair<Index, Index>> rigid_frame(const ParticleSystem<double>& s, const std::vector<Index>& molecule) {
  const Sites sites(s, molecule);
  std::vector<std::pair<Index, Index>> pairs;
  const auto tie = [&](std::size_t a, std::size_t b) { pairs.emplace_back(std::minmax(molecule[a], molecule[b])); };
  const auto refuse = [&](const char* why) {
    throw BadConstraints(fmt::format("the molecule of {} {}", words_of(s, molecule), why));
  };
  if (molecule.size() == 2) tie(0, 1);
  if (molecule.size() == 3) {
    if (!(sites.sine(0, 1, 2) > flat)) {
      refuse("is on a line, which distances do not hold; use rigid_bar with the names of its particles");
    }
    tie(0, 1), tie(0, 2), tie(1, 2);
  }
  if (molecule.size() < 4) return pairs;
  const std::array<std::size_t, 4> corners = sites.tetrahedron();
  if (!(sites.spread(corners[0], {corners[1], corners[2], corners[3]}) > flat)) {
    refuse("lies in a plane, which distances do not hold; use bonds or bonds_and_angles");
  }
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t other = 0; other < k; ++other) tie(corners[other], corners[k]);
  }
  for (std::size_t site = 0; site < sites.size(); ++site) {
    if (std::find(corners.begin(), corners.end(), site) != corners.end()) continue;
    for (const std::size_t corner : corners_for(sites, site, corners)) tie(site, corner);
  }
  return pairs;
}

}  // namespace noether
