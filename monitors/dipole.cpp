#include "monitors/dipole.hpp"

#include "engine/charge.hpp"
#include "engine/sums.hpp"
#include "monitors/series_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace noether {

namespace {

constexpr std::int64_t most_dipole_blocks = 64;

template <class Real> void expect_charges(const ParticleSystem<Real>& s, const char* monitor) {
  if (s.template has<Charge>()) return;
  throw Error(fmt::format(
      "monitor '{}' watches charges, but the particles have none; give charges, or take the monitor out", monitor));
}

std::array<double, 3> doubles_of(const std::array<Quad, 3>& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}
std::array<double, 3> doubles_of(const std::array<double, 3>& a) { return a; }

/// A debye is 1e-21 C m^2/s divided by the speed of light.
double debye_in(const UnitSystem& units) {
  if (units.is_reduced()) return 0;
  return (units.scale->charge * units.scale->length * units::decimal(299792458, 0) / units::decimal(1, -21)).rounded();
}

}  // namespace

void detail::WholeMolecules::find(const std::shared_ptr<const Topology>& topology, Index n) {
  if (topology == topology_ && static_cast<Index>(order_.size()) == n) return;
  topology_ = topology;
  order_.clear();
  parent_.assign(static_cast<std::size_t>(n), -1);
  first_.assign(static_cast<std::size_t>(n), -1);
  std::vector<std::vector<Index>> bonded(static_cast<std::size_t>(n));
  if (topology != nullptr) {
    for (const BondedTerm<2>& bond : topology->bonds) {
      const auto [i, j] = bond.particles;
      bonded[static_cast<std::size_t>(i)].push_back(j);
      bonded[static_cast<std::size_t>(j)].push_back(i);
    }
  }
  for (Index root = 0; root < n; ++root) {
    if (parent_[static_cast<std::size_t>(root)] >= 0) continue;
    parent_[static_cast<std::size_t>(root)] = root;
    std::size_t next = order_.size();
    order_.push_back(root);
    for (; next < order_.size(); ++next) {
      const Index i = order_[next];
      first_[static_cast<std::size_t>(i)] = root;
      for (const Index j : bonded[static_cast<std::size_t>(i)]) {
        if (parent_[static_cast<std::size_t>(j)] >= 0) continue;
        parent_[static_cast<std::size_t>(j)] = i;
        order_.push_back(j);
      }
    }
  }
}

template <class Real> std::array<Real, 3> detail::WholeMolecules::dipole_moment(const ParticleSystem<Real>& s) const {
  VectorColumn<Real> whole(s.size());
  for (const Index i : order_) {
    const Index parent = parent_[static_cast<std::size_t>(i)];
    if (parent == i) {
      whole.set(i, s.unwrapped(i));
    } else {
      const Vec3<Real> d = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[parent]));
      whole.set(i, Vec3<Real>(whole[parent] + d));
    }
  }
  const auto& charges = s.template column<Charge>();
  return sums_over<Real, 3>(s.size(), [&](Index i) {
    const Vec3<Real> x = whole[i];
    const Real q(charges[i]);
    return std::array<Real, 3>{q * x[0], q * x[1], q * x[2]};
  });
}

template <class Real> void DipoleMoment::check(const ParticleSystem<Real>& s) const {
  expect_charges(s, "dipole_moment");
}
template void DipoleMoment::check(const ParticleSystem<double>&) const;
template void DipoleMoment::check(const ParticleSystem<Quad>&) const;

template <class Real> void DipoleMoment::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  molecules_.find(s.shared_topology(), s.size());
  now_ = doubles_of(molecules_.dipole_moment(s));
  const UnitSystem& units = now.units();
  unit_ = units.is_reduced() ? "1" : fmt::format("{} {}", units.charge, units.length);
  slope_unit_ = units.is_reduced() ? "1" : fmt::format("{}/{}", unit_, units.time);
  debye_ = debye_in(units);
  sizes_.add(now.time(), size());
}

double DipoleMoment::size() const { return std::sqrt(now_[0] * now_[0] + now_[1] * now_[1] + now_[2] * now_[2]); }

std::vector<Series> DipoleMoment::series() const {
  return {{"value", "charge length", {3}, {now_[0], now_[1], now_[2]}, {"x", "y", "z"}},
          {"size", "charge length", {}, {size()}}};
}

MonitorReport DipoleMoment::report() const {
  MonitorReport report = report_of(sizes_, slope_unit_);
  if (report.samples == 0) return report;
  report.note = fmt::format("of |M|: mean {:.6g}", sizes_.mean());
  if (const auto error = sizes_.mean_error()) report.note += fmt::format(" +- {:.1g}", *error);
  if (debye_ != 0) report.note += fmt::format(" {}, which is {:.6g} D", unit_, sizes_.mean() * debye_);
  return report;
}

void DielectricConstant::check() const {
  if (!(temperature > 0 && std::isfinite(temperature)))
    refuse_field("temperature", temperature, "is not a valid temperature; one above 0 is expected");
}

template <class Real> void DielectricConstant::check(const ParticleSystem<Real>& s) const {
  check();
  expect_charges(s, "dielectric_constant");
  if (!s.box().is_periodic()) {
    throw Error(
        "monitor 'dielectric_constant' needs a periodic box, because it divides by the volume; give the particles a "
        "box");
  }
  detail::WholeMolecules molecules;
  molecules.find(s.shared_topology(), s.size());
  std::vector<double> sums(static_cast<std::size_t>(s.size())), sizes(sums);
  for (Index i = 0; i < s.size(); ++i) {
    const auto first = static_cast<std::size_t>(molecules.first()[static_cast<std::size_t>(i)]);
    const auto q = static_cast<double>(s.template column<Charge>()[i]);
    sums[first] += q;
    sizes[first] += std::abs(q);
  }
  for (Index i = 0; i < s.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (std::abs(sums[k]) <= 1e-6 * sizes[k]) continue;
    throw Error(
        fmt::format("monitor 'dielectric_constant' watches neutral molecules, but that of particle {} has a charge of "
                    "{:.6g}; bonds "
                    "say which particles are a molecule",
                    s.name(i).empty() ? fmt::format("{}", s.ids()[k]) : fmt::format("'{}'", s.name(i)), sums[k]));
  }
}
template void DielectricConstant::check(const ParticleSystem<double>&) const;
template void DielectricConstant::check(const ParticleSystem<Quad>&) const;

template <class Real> void DielectricConstant::observe(const Snapshot<Real>& now) {
  const ParticleSystem<Real>& s = now.state();
  molecules_.find(s.shared_topology(), s.size());
  const std::array<double, 3> m = doubles_of(molecules_.dipole_moment(s));
  const UnitSystem& units = now.units();
  factor_ = 4 * std::numbers::pi * units.coulomb_constant / (3 * s.box().volume() * units.k_B * temperature);
  const Sums look = {m[0] * m[0] + m[1] * m[1] + m[2] * m[2], m[0], m[1], m[2]};
  ++samples_;
  for (std::size_t k = 0; k < look.size(); ++k) {
    sums_[k] += look[k];
    open_sums_[k] += look[k];
  }
  if (++open_ < block_) return;
  for (const double sum : open_sums_) blocks_.push_back(sum / static_cast<double>(block_));
  open_ = 0;
  open_sums_ = {};
  if (blocks_.size() < 4 * most_dipole_blocks) return;
  for (std::size_t b = 0; b < most_dipole_blocks / 2; ++b) {
    for (std::size_t k = 0; k < 4; ++k) blocks_[4 * b + k] = (blocks_[8 * b + k] + blocks_[8 * b + 4 + k]) / 2;
  }
  blocks_.resize(2 * most_dipole_blocks);
  block_ *= 2;
}

std::array<double, 3> DielectricConstant::mean() const {
  const auto n = static_cast<double>(samples_);
  return {sums_[1] / n, sums_[2] / n, sums_[3] / n};
}

double DielectricConstant::value() const {
  const auto [x, y, z] = mean();
  return 1 + factor_ * (sums_[0] / static_cast<double>(samples_) - (x * x + y * y + z * z));
}

std::optional<double> DielectricConstant::error() const {
  const auto [x, y, z] = mean();
  SeriesStatistics blocks;
  for (std::size_t b = 0; b < blocks_.size(); b += 4) {
    blocks.add(static_cast<double>(b), blocks_[b] - 2 * (x * blocks_[b + 1] + y * blocks_[b + 2] + z * blocks_[b + 3]));
  }
  const std::optional<double> error = blocks.mean_error();
  if (!error) return {};
  return factor_ * *error;
}

std::vector<Series> DielectricConstant::series() const {
  const auto [x, y, z] = mean();
  return {{"value", "1", {}, {value()}},
          {"error", "1", {}, {error().value_or(std::numeric_limits<double>::quiet_NaN())}},
          {"mean", "charge length", {3}, {x, y, z}, {"x", "y", "z"}}};
}

MonitorReport DielectricConstant::report() const {
  MonitorReport report;
  report.samples = samples_;
  if (samples_ == 0) return report;
  report.last = value();
  const std::optional<double> bar = error();
  report.note = fmt::format("{:.6g}", value()) + (bar ? fmt::format(" +- {:.1g}", *bar) : "");
  if (!bar) report.reason = "the error takes 20 looks";
  return report;
}

void DielectricConstant::load(const SavedState& saved, const std::string& prefix) {
  load_part(saved, prefix, *this);
  if (samples_ < 0 || block_ < 1 || open_ < 0 || open_ >= block_ || blocks_.size() % 4 != 0 ||
      blocks_.size() >= 4 * most_dipole_blocks) {
    throw Error(
        fmt::format("the saved dielectric constant has blocks of {} samples and {} numbers of them, which do not "
                    "fit each other",
                    block_, blocks_.size()));
  }
}

#define NOETHER_COMPILE(Type)                           \
  template void Type::observe(const Snapshot<double>&); \
  template void Type::observe(const Snapshot<Quad>&);   \
  template struct detail::MonitorModel<Type, double>;   \
  template struct detail::MonitorModel<Type, Quad>
NOETHER_COMPILE(DipoleMoment);
NOETHER_COMPILE(DielectricConstant);
#undef NOETHER_COMPILE

}  // namespace noether
