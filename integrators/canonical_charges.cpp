#include "integrators/canonical_charges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// B and rot A of a field may differ by this part of the slopes of A, as sums of series do.
constexpr double rounding_of_potentials = 1e-6;
/// Momenta below this part of q A cannot be told from 0 where they are found from velocities of two words.
constexpr double least_momentum = 0x1p-98;

constexpr const char* without_momenta =
    "use a method for y' = f that moves velocities, such as 'gauss_8' with canonical = false, or the Hamiltonian "
    "'k_symplectic', which needs no A";

}  // namespace

template <class Real>
CanonicalCharges<Real>::CanonicalCharges(ForceField<Real> forces, std::string name)
    : forces_(std::move(forces)),
      fields_(fields_among(forces_)),
      name_(std::move(name)),
      by_velocities_(forces_, name_),
      along_(unit_system("reduced")) {
  for (const AnyForce<Real>& term : forces_.terms()) {
    const ForceClaims claims = term.claims();
    if (claims.velocity_dependent && !claims.gyrates) {
      throw SchemeMismatch(fmt::format(
          "force '{}' depends on velocities otherwise than by a magnetic field, so no H(q, p) of these charges is "
          "known; use a method for y' = f that moves velocities, such as 'gauss_8' with canonical = false",
          term.name()));
    }
    if (claims.gyrates && !term.has_derivative()) {
      throw SchemeMismatch(fmt::format(
          "the field '{}' is written for doubles only, so the slopes of its vector potential are not known; {}",
          term.name(), without_momenta));
    }
  }
}

template <class Real> FieldClaims CanonicalCharges<Real>::claims() const {
  const ForceClaims forces = forces_.claims();
  return {.name = name_,
          .canonical = true,
          .time_dependent = forces.time_dependent,
          .energy = forces.energy,
          .no_action = "methods over the momenta m v + q A have no action",
          .keeps_momentum = forces.keeps_momentum,
          .keeps_angular_momentum = forces.keeps_angular_momentum};
}

template <class Real> std::string CanonicalCharges<Real>::signature() const {
  return "canonical(" + forces_.signature() + ")";
}

template <class Real> void CanonicalCharges<Real>::bind(const ParticleSystem<Real>& s) {
  by_velocities_.bind(s);
  bind_force(forces_, s);
  bind_force(fields_, s);
  workspace_ = Workspace();
  workspace_.put(NeighborList(forces_.claims().range));
  work_ = s;
  work_.keep_low_words(false);
  work_.clock() = Clock<Real>::free(0);
  for (VectorColumn<Real>* column : {&a_, &rates_, &of_fields_, &seen_a_, &seen_of_fields_})
    *column = VectorColumn<Real>(s.size());
  along_ = work_.template as<Moving>();
  along_.clock() = Clock<Moving>::free(0);
  for (VectorColumn<Moving>* column : {&along_a_, &along_rates_, &along_of_fields_})
    *column = VectorColumn<Moving>(s.size());
  coupling_ = Coupling::of(forces_.claims(), s.units().G);
  unit_ = s.masses().all().maxCoeff();
  for (Index i = 0; i < s.size(); ++i) {
    if (s.masses()[i] > Real(0)) continue;
    throw SchemeMismatch(
        fmt::format("'{}' has no mass, so no momentum m v + q A moves it; give it one, or {}", s.name(i),
                    "use a method for y' = f that moves velocities, such as 'gauss_8' with canonical = false"));
  }
  check_potentials(s);
  this->forget_scales();
}

/// Every field has to tell A, and a B that is rot A where the charges begin.
template <class Real> void CanonicalCharges<Real>::check_potentials(const ParticleSystem<Real>& s) {
  using std::abs, std::max;
  for (const AnyForce<Real>& term : fields_.terms()) {
    ForceSink<Real> sink(a_, s, {});
    sink.set_field_momenta(of_fields_);
    term.add_to(sink, s);
    if (sink.failure() && sink.failure()->quantity == "vector potential") {
      throw SchemeMismatch(fmt::format("{}, and momenta are m v + q A; {}", sink.failure()->message, without_momenta));
    }
    ForceField<Real> alone;
    alone.add(term);
    VectorColumn<Real> axis(s.size()), rot(s.size()), size(s.size());
    for (int k = 0; k < 3; ++k) {
      axis.set_zero();
      std::fill_n(axis.component(k), s.size(), Real(1));
      go_along(alone, s, s.time(), Real(0), axis);
      for (Index i = 0; i < s.size(); ++i) {
        const auto slope = [&](int c) { return along_of_fields_.component(c)[i].slope[0]; };
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        rot.component(last)[i] += slope(next);
        rot.component(next)[i] -= slope(last);
        for (const int c : {next, last}) size.component(0)[i] = max(size.component(0)[i], Real(abs(slope(c))));
      }
    }
    for (Index i = 0; i < s.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const Real B = s.masses()[i] * along_rates_.component(k)[i].value;
        const Real missing = abs(rot.component(k)[i] - B);
        if (!(missing > Real(rounding_of_potentials) * max(size.component(0)[i], Real(abs(B))))) continue;
        throw SchemeMismatch(
            fmt::format("the field '{}' has a vector potential A whose rotation is not its B where '{}' begins, so m v "
                        "+ q A is not a "
                        "momentum; give it the A of its B, or say vector_potential = false in its field_claims()",
                        term.name(), s.name(i)));
      }
    }
  }
}

template <class Real>
void CanonicalCharges<Real>::go_along(const ForceField<Real>& fields, const ParticleSystem<Real>& s, const Real& t,
                                      const Real& dt, const VectorColumn<Real>& v) {
  for (int k = 0; k < 3; ++k) {
    Moving* const x = along_.positions().component(k);
    const Real *const from = s.positions().component(k), *const by = v.component(k);
    for (Index i = 0; i < s.size(); ++i) x[i] = detail::along(from[i], by[i]);
  }
  along_.clock().set_stage_offset(detail::along(t, dt));
  along_.moved();
  ForceSink<Moving> sink(along_a_, along_, {});
  sink.set_gyrations(along_rates_);
  sink.set_field_momenta(along_of_fields_);
  fields.add_to(sink, along_);
}

template <class Real> void CanonicalCharges<Real>::gather(const ParticleSystem<Real>& s, Vector<Real>& y) const {
  using Wide = FastNumber<Real>;
  using std::abs;
  ForceSink<Real> sink(seen_a_, s, {});
  sink.set_field_momenta(seen_of_fields_);
  fields_.add_to(sink, s);
  const Index n = s.size();
  y.resize(6 * n);
  for (Index i = 0; i < n; ++i) {
    const Vec3<Wide> v = whole_velocity(s, i);
    for (int k = 0; k < 3; ++k) {
      y[k * n + i] = s.positions().component(k)[i];
      const Wide own = Wide(s.masses()[i]) * v[k], of_field = Wide(seen_of_fields_.component(k)[i]), p = own + of_field;
      const bool none = abs(p) < Wide(least_momentum) * abs(of_field);
      y[(3 + k) * n + i] = none ? Real(0) : Real(p / Wide(unit_));
    }
  }
}

template <class Real> void CanonicalCharges<Real>::scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const {
  using Wide = FastNumber<Real>;
  const Index n = s.size();
  for (int k = 0; k < 3; ++k) std::copy_n(y.data() + k * n, n, s.positions().component(k));
  s.moved();
  ForceSink<Real> sink(seen_a_, s, {});
  sink.set_field_momenta(seen_of_fields_);
  fields_.add_to(sink, s);
  if constexpr (std::is_same_v<Real, double>) s.keep_low_words(true);
  for (Index i = 0; i < n; ++i) {
    Vec3<Wide> v;
    for (int k = 0; k < 3; ++k) {
      v[k] = (Wide(unit_) * Wide(y[(3 + k) * n + i]) - Wide(seen_of_fields_.component(k)[i])) / Wide(s.masses()[i]);
    }
    set_whole_velocity<Real>(s, i, v);
  }
}

template <class Real> Real CanonicalCharges<Real>::find_velocities(const Real& t, const Vector<Real>& y, bool energy) {
  const Index n = work_.size();
  for (int k = 0; k < 3; ++k) std::copy_n(y.data() + k * n, n, work_.positions().component(k));
  work_.clock().set_stage_offset(t);
  work_.moved();
  ForceSink<Real> sink(a_, work_, {.energy = energy}, &workspace_);
  sink.set_gyrations(rates_);
  sink.set_field_momenta(of_fields_);
  forces_.add_to(sink, work_);
  for (int k = 0; k < 3; ++k) {
    const Real* const p = y.data() + (3 + k) * n;
    Real* const v = work_.velocities().component(k);
    for (Index i = 0; i < n; ++i) v[i] = (unit_ * p[i] - of_fields_.component(k)[i]) / work_.masses()[i];
  }
  if (!sink.failure()) return sink.potential();
  this->note(sink.failure());
  for (int k = 0; k < 3; ++k) std::fill_n(a_.component(k), n, Real(std::numeric_limits<double>::quiet_NaN()));
  return Real(std::numeric_limits<double>::quiet_NaN());
}

template <class Real> void CanonicalCharges<Real>::evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  static_cast<void>(find_velocities(t, y, false));
  const VectorColumn<Real>& v = std::as_const(work_).velocities();
  go_along(fields_, work_, t, Real(1), v);
  const Index n = work_.size();
  dy.resize(6 * n);
  for (Index i = 0; i < n; ++i) {
    const Vec3<Real> force = work_.masses()[i] * (std::as_const(a_)[i] + cross<Real>(v[i], std::as_const(rates_)[i]));
    for (int k = 0; k < 3; ++k) {
      dy[k * n + i] = v.component(k)[i];
      dy[(3 + k) * n + i] = (force[k] + along_of_fields_.component(k)[i].slope[0]) / unit_;
    }
  }
}

template <class Real> Real CanonicalCharges<Real>::hamiltonian(const Real& t, const Vector<Real>& y) {
  const Real potential = find_velocities(t, y, true);
  return (kinetic_energy(work_) + potential) / unit_;
}

template <class Real> Vector<Real> CanonicalCharges<Real>::masses() const {
  return (work_.masses().all() / unit_).matrix().replicate(3, 1);
}

template <class Real>
void CanonicalCharges<Real>::measure_particles(const Vector<Real>& y, double rtol, ParticleScales& scales) {
  const Index n = work_.size();
  for (int k = 0; k < 3; ++k) {
    std::copy_n(y.data() + k * n, n, work_.positions().component(k));
    std::copy_n(y.data() + (3 + k) * n, n, work_.velocities().component(k));
  }
  work_.moved();
  measure(work_, coupling_, workspace_.template find<NeighborList>(), rtol, scales);
}

template class CanonicalCharges<double>;
template class CanonicalCharges<Quad>;

}  // namespace noether
