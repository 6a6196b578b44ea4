#include "monitors/dihedrals.hpp"

#include "numbers/parallel.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace noether {

namespace {

constexpr std::int64_t most_intervals = 100'000;
constexpr double no_angle = std::numeric_limits<double>::quiet_NaN();

/// The same four particles from the other end.
std::array<Index, 4> reversed(std::array<Index, 4> four) {
  std::reverse(four.begin(), four.end());
  return four;
}

/// The dihedrals of a topology, each four once: those whose particles have these types, all without any.
std::vector<std::array<Index, 4>> dihedrals_of(const Topology& topology, const std::vector<std::string>& types) {
  const auto has_types = [&](const std::array<Index, 4>& four) {
    for (std::size_t k = 0; k < types.size(); ++k) {
      if (topology.type_names[static_cast<std::size_t>(topology.type(four[k]))] != types[k]) return false;
    }
    return true;
  };
  std::vector<std::array<Index, 4>> chosen;
  std::set<std::array<Index, 4>> seen;
  for (const BondedTerm<4>& term : topology.dihedrals) {
    if (topology.acts_on_ends(term)) continue;
    const std::array<Index, 4>& four = term.particles;
    if (!has_types(four) && !has_types(reversed(four))) continue;
    if (seen.insert(std::min(four, reversed(four))).second) chosen.push_back(four);
  }
  return chosen;
}

/// The types that dihedrals of a topology have, as a proposal: "[a, b, b, a] or [a, b, b, c]", at most four.
std::string types_there(const Topology& topology, const std::vector<std::array<Index, 4>>& dihedrals) {
  std::set<std::string> found;
  for (const std::array<Index, 4>& four : dihedrals) {
    std::vector<std::string> names;
    for (const Index i : four) names.push_back(topology.type_names[static_cast<std::size_t>(topology.type(i))]);
    const std::vector<std::string> back(names.rbegin(), names.rend());
    found.insert(fmt::format("[{}]", fmt::join(std::min(names, back), ", ")));
    if (found.size() == 4) break;
  }
  return fmt::format("{}", fmt::join(found, " or "));
}

/// trans, gauche+ or gauche-, in this order.
std::size_t kind_of_angle(double phi) {
  if (std::abs(phi) > 2 * std::numbers::pi / 3) return 0;
  return phi >= 0 ? 1 : 2;
}

}  // namespace

double detail::dihedral_angle(const Vec3<double>& f, const Vec3<double>& g, const Vec3<double>& h) {
  const Vec3<double> A = cross(f, g), B = cross(h, g);
  if (norm2(A) == 0 || norm2(B) == 0) return no_angle;
  const double phi = std::atan2(std::sqrt(norm2(g)) * dot(h, A), dot(A, B));
  return phi == -std::numbers::pi ? std::numbers::pi : phi;  // of a sine of -0
}

void Dihedrals::check() const {
  if (bins < 1 || bins > most_intervals) {
    refuse_field("bins", std::to_string(bins),
                 fmt::format("is not a valid number of intervals; 1 to {} is expected", most_intervals));
  }
  if (!types.empty() && types.size() != 4) {
    refuse_field("types", fmt::format("[{}]", fmt::join(types, ", ")),
                 "are not the types of four particles; give four types, or none for all dihedrals");
  }
  for (const std::vector<std::string>& names : quadruples) {
    if (names.size() == 4) continue;
    refuse_field(
        "quadruples", fmt::format("[[{}]]", fmt::join(names, ", ")),
        "does not name four particles for each angle; a list such as [[\"a\", \"b\", \"c\", \"d\"]] is expected");
  }
  if (!types.empty() && !quadruples.empty()) {
    throw Error("types and quadruples are both given in monitor 'dihedrals'; give only one of them", {.key = "types"});
  }
}

void Dihedrals::find_named(const std::vector<std::string>& names) const {
  check();
  if (quadruples.empty() || !named_.empty()) return;
  std::map<std::string, Index> places;
  for (std::size_t i = 0; i < names.size(); ++i) places.emplace(names[i], static_cast<Index>(i));
  std::vector<std::array<Index, 4>> groups;
  for (const std::vector<std::string>& four : quadruples) {
    std::array<Index, 4>& group = groups.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto found = places.find(four[k]);
      if (found == places.end()) {
        throw Error(
            fmt::format("unknown particle '{}' in monitor 'dihedrals'{}", four[k], did_you_mean(four[k], names)),
            {.key = "quadruples", .value = four[k]});
      }
      group[k] = found->second;
      if (std::find(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(k), group[k]) ==
          group.begin() + static_cast<std::ptrdiff_t>(k)) {
        continue;
      }
      throw Error(
          fmt::format("particle '{}' appears twice in a quadruple of monitor 'dihedrals'; four different ones are "
                      "expected",
                      four[k]),
          {.key = "quadruples", .value = four[k]});
    }
  }
  named_ = Tied<4>(std::move(groups));
}

void Dihedrals::choose(const std::shared_ptr<const Topology>& topology) const {
  if (!named_.empty() || (topology_ != nullptr && topology_ == topology)) return;
  const Topology none, &of = topology == nullptr ? none : *topology;
  for (const std::string& type : types) {
    if (std::find(of.type_names.begin(), of.type_names.end(), type) != of.type_names.end()) continue;
    throw Error(
        fmt::format("unknown type '{}' in monitor 'dihedrals'{}", type,
                    of.type_names.empty() ? "; the particles have no types" : did_you_mean(type, of.type_names)),
        {.key = "types", .value = type});
  }
  chosen_ = dihedrals_of(of, types);
  topology_ = topology;
  if (!chosen_.empty()) return;
  const std::vector<std::array<Index, 4>> all = dihedrals_of(of, {});
  if (all.empty()) {
    throw Error(
        "monitor 'dihedrals' finds no dihedrals, because the structure has none; name the particles, such as "
        "quadruples = [[\"a\", \"b\", \"c\", \"d\"]]");
  }
  refuse_field("types", fmt::format("[{}]", fmt::join(types, ", ")),
               fmt::format("are the types of no dihedral of the structure; types such as {} are expected",
                           types_there(of, all)));
}

template <class Real> void Dihedrals::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  check(s);
  std::vector<double> angles(static_cast<std::size_t>(size()));
  for_blocks(size(), [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const auto& [a, b, c, d] = named_.empty() ? chosen_[at] : std::as_const(named_)[at];
      const auto from = [&](Index i, Index j) {
        const Vec3<Real> r = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
        return Vec3<double>(static_cast<double>(r[0]), static_cast<double>(r[1]), static_cast<double>(r[2]));
      };
      angles[at] = detail::dihedral_angle(from(a, b), from(b, c), from(d, c));
    }
  });
  count(now.time(), angles);
}

void Dihedrals::count(double time, const std::vector<double>& angles) {
  counts_.resize(static_cast<std::size_t>(bins));
  std::array<std::int64_t, 3> seen{};
  const double width = 2 * std::numbers::pi / static_cast<double>(bins);
  for (const double phi : angles) {
    if (std::isnan(phi)) continue;
    const auto place = static_cast<std::int64_t>(std::ceil((phi + std::numbers::pi) / width)) - 1;
    ++counts_[static_cast<std::size_t>(std::clamp<std::int64_t>(place, 0, bins - 1))];
    ++seen[kind_of_angle(phi)];
  }
  const std::int64_t all = seen[0] + seen[1] + seen[2];
  undefined_ += static_cast<std::int64_t>(angles.size()) - all;
  for (std::size_t k = 0; k < 3; ++k) {
    kinds_[k] += seen[k];
    SeriesStatistics& one = k == 0 ? trans_ : k == 1 ? gauche_plus_ : gauche_minus_;
    if (all > 0) one.add(time, static_cast<double>(seen[k]) / static_cast<double>(all));
  }
  if (!named_.empty()) last_ = angles;
  ++samples_;
}

double Dihedrals::angle(std::int64_t k) const {
  return (2 * static_cast<double>(k) + 1 - static_cast<double>(bins)) * (std::numbers::pi / static_cast<double>(bins));
}

std::vector<double> Dihedrals::density() const {
  std::vector<double> density(static_cast<std::size_t>(bins), no_angle);
  const auto all = static_cast<double>(kinds_[0] + kinds_[1] + kinds_[2]);
  const double width = 2 * std::numbers::pi / static_cast<double>(bins);
  for (std::size_t k = 0; k < counts_.size() && all > 0; ++k) {
    density[k] = static_cast<double>(counts_[k]) / (all * width);
  }
  return density;
}

std::array<double, 3> Dihedrals::fractions() const {
  const auto all = static_cast<double>(kinds_[0] + kinds_[1] + kinds_[2]);
  if (!(all > 0)) return {no_angle, no_angle, no_angle};
  std::array<double, 3> fractions;
  for (std::size_t k = 0; k < 3; ++k) fractions[k] = static_cast<double>(kinds_[k]) / all;
  return fractions;
}

std::array<double, 3> Dihedrals::fraction_errors() const {
  return {trans_.mean_error().value_or(no_angle), gauche_plus_.mean_error().value_or(no_angle),
          gauche_minus_.mean_error().value_or(no_angle)};
}

std::vector<Series> Dihedrals::series() const {
  std::vector<double> angles;
  for (std::int64_t k = 0; k < bins; ++k) angles.push_back(angle(k));
  const std::vector<Index> shape{static_cast<Index>(bins)};
  const std::vector<std::string> kinds = {"trans", "gauche+", "gauche-"};
  const std::array<double, 3> parts = fractions(), errors = fraction_errors();
  std::vector<Series> all = {{"angle", "angle", shape, std::move(angles)},
                             {"density", "1/angle", shape, density()},
                             {"fraction", "1", {3}, {parts.begin(), parts.end()}, kinds},
                             {"fraction_error", "1", {3}, {errors.begin(), errors.end()}, kinds}};
  if (!quadruples.empty()) all.push_back({"now", "angle", {static_cast<Index>(quadruples.size())}, last_});
  return all;
}

MonitorReport Dihedrals::report() const {
  MonitorReport report;
  report.samples = samples_;
  if (samples_ == 0) return report;
  const std::array<double, 3> parts = fractions(), errors = fraction_errors();
  if (std::isnan(parts[0])) {
    report.reason = "three particles of every dihedral are in line, so there is no angle";
    return report;
  }
  const auto told = [&](std::size_t k) {
    const bool scatters = errors[k] > 1e-12;  // beyond rounding
    return fmt::format("{:.4f}", parts[k]) + (scatters ? fmt::format(" +- {:.1g}", errors[k]) : "");
  };
  report.note = fmt::format("trans {}, gauche+ {}, gauche- {} of {} angle{}; all {} intervals: see the trajectory file",
                            told(0), told(1), told(2), size(), size() == 1 ? "" : "s", bins);
  if (undefined_ > 0) report.note += fmt::format("; {} times three particles were in line", undefined_);
  return report;
}

void Dihedrals::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  const bool fits = samples_ == 0 || counts_.size() == static_cast<std::size_t>(bins);
  if (!fits || kinds_.size() != 3 || (samples_ > 0 && last_.size() != quadruples.size())) {
    throw Error(fmt::format("the saved dihedrals are of {} intervals and {} named angles; {} and {} are expected",
                            counts_.size(), last_.size(), bins, quadruples.size()));
  }
}

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(Dihedrals);
#undef NOETHER_COMPILE

}  // namespace noether
