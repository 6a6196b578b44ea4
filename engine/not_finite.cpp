#include "engine/not_finite.hpp"

#include "engine/finite_simd.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace noether {

namespace {

bool all_finite(const VectorColumn<double>& x, const VectorColumn<double>& v) {
  return finite_kernels().all(x.component(0), v.component(0), 3 * x.stride());
}
bool all_finite(const VectorColumn<Quad>& x, const VectorColumn<Quad>& v) {
  return x.all().allFinite() && v.all().allFinite();
}

/// The first particle of which a column holds something that is not finite; -1: none.
template <class Column> Index first_bad(const Column& values) {
  using std::isfinite;
  for (Index i = 0; i < values.size(); ++i) {
    for (int k = 0; k < values.width; ++k) {
      if (!isfinite(values.component(k)[i])) return i;
    }
  }
  return -1;
}
Index first_bad(const ScalarColumn<std::int64_t>& /*whole*/) { return -1; }

template <class Real> Failure of_particle(const ParticleSystem<Real>& s, Index i, const std::string& quantity) {
  return {Outcome::Kind::diverged, i, quantity, fmt::format("{} of {} is not finite", quantity, s.name(i))};
}

template <class Real> Failure of_variable(const ParticleSystem<Real>& s, Index i) {
  const std::string place = fmt::format("y[{}]", i), name = s.variable_name(i);
  const std::string called = name == place ? place : fmt::format("'{}', {},", name, place);
  return {Outcome::Kind::diverged, -1, place, fmt::format("variable {} is not finite", called)};
}

}  // namespace

template <class Real> std::optional<Failure> not_finite(const ParticleSystem<Real>& s) {
  using std::isfinite;
  for (std::size_t i = 0; i < s.variables().size(); ++i) {
    if (!isfinite(s.variables()[i])) return of_variable(s, static_cast<Index>(i));
  }
  for (const auto& column : s.columns()) {
    if (!column.info.moves()) continue;
    const Index bad = column.visit([](const auto& values) { return first_bad(values); });
    if (bad >= 0) return of_particle(s, bad, column.info.name);
  }
  if (all_finite(s.positions(), s.velocities())) return {};
  const Index position = first_bad(s.positions()), velocity = first_bad(s.velocities());
  if (position >= 0 && (velocity < 0 || position <= velocity)) return of_particle(s, position, "position");
  return velocity >= 0 ? std::optional<Failure>(of_particle(s, velocity, "velocity")) : std::nullopt;
}

template std::optional<Failure> not_finite(const ParticleSystem<double>&);
template std::optional<Failure> not_finite(const ParticleSystem<Quad>&);

}  // namespace noether
