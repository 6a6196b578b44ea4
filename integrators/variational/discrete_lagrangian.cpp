#include "integrators/variational/discrete_lagrangian.hpp"

#include <fmt/format.h>

#include <limits>

namespace noether {

namespace detail {

namespace {
[[noreturn]] void refuse_rates(const std::string& name) {
  throw LogicError("rates were requested of the discrete Lagrangian '" + name + "', which has none");
}
}  // namespace

void check_own_action(std::string_view name, bool has_force, const FieldClaims& field) {
  if (field.time_dependent) {
    throw SchemeMismatch(
        fmt::format("the discrete Lagrangian '{}' is told no time, but '{}' depends on it; use a method over its own "
                    "Lagrangian, such as 'galerkin_gauss_2'",
                    name, field.name));
  }
  if (field.symplectic || has_force) return;
  throw SchemeMismatch(
      fmt::format("the discrete Lagrangian '{}' has no force, but '{}' has one beside its Lagrangian; give the "
                  "discrete one a force too, or use a method such as 'galerkin_gauss_2'",
                  name, field.name));
}

void LoneState::bind(const ParticleSystem<double>& s) {
  const std::size_t count = s.variables().size();
  if (count == 0 || count % 2 != 0 || s.size() != 0) {
    throw Error(
        fmt::format("the discrete Lagrangian '{}' moves coordinates and as many momenta, but it was given {} "
                    "variables and {} particles",
                    name_, count, s.size()));
  }
  size_ = static_cast<Index>(count);
}

void LoneState::gather(const ParticleSystem<double>& s, Vector<double>& y) const {
  y.resize(size_);
  for (Index i = 0; i < size_; ++i) y[i] = s.variables()[static_cast<std::size_t>(i)];
}

void LoneState::scatter(const Vector<double>& y, ParticleSystem<double>& s) const {
  for (Index i = 0; i < size_; ++i) s.variables()[static_cast<std::size_t>(i)] = y[i];
}

double LoneState::action_density(const double&, const Vector<double>&, const Vector<double>&) { refuse_rates(name_); }
void LoneState::terms_along(const double&, const Vector<double>&, const Vector<double>&, const double&,
                            const Vector<double>&, const Vector<double>&, LagrangianTerms<double>&) {
  refuse_rates(name_);
}
void LoneState::find_terms(const double&, const Vector<double>&, const Vector<double>&, LagrangianTerms<double>&) {
  refuse_rates(name_);
}
void LoneState::find_tangent(const double&, const Vector<double>&, const Vector<double>&, LagrangianTangent<double>&) {
  refuse_rates(name_);
}

}  // namespace detail

ParticleSystem<double> phase_state(std::vector<double> q, const std::vector<double>& p) {
  if (q.empty() || q.size() != p.size()) {
    throw Error(
        fmt::format("{} coordinates with {} momenta are not a valid state; as many of each are expected, at least one",
                    q.size(), p.size()));
  }
  q.insert(q.end(), p.begin(), p.end());
  ParticleSystem<double> s;
  s.set_variables(std::move(q));
  return s;
}

}  // namespace noether
