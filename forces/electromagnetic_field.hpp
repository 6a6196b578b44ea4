#pragma once
/// Electric and magnetic fields as forces on charges.

#include "engine/any_force.hpp"
#include "engine/charge.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/sum.hpp"
#include "numbers/parallel.hpp"

#include <string>
#include <type_traits>
#include <utility>

namespace noether {

/// Values of a field at one time and place. Fields begin with zeros and write what they have.
template <class Real> struct FieldValues {
  Vec3<Real> E = Vec3<Real>::Zero();  ///< [mass length/time^2/charge]
  Vec3<Real> B = Vec3<Real>::Zero();  ///< [mass/time/charge]
  Vec3<Real> A = Vec3<Real>::Zero();  ///< B = rot A, and of fields that change, E = - dA/dt - grad phi
  Real phi = Real(0);                 ///< E = - grad phi where nothing changes [energy/charge]
};

/// A field: a struct that tells its values at (t, x), over the number type where derivatives, truth in 113 bits and
/// lanes are to be had:
///
///     struct MyField {
///       template <class Real> void at(const Real& t, const Vec3<Real>& x, FieldValues<Real>& field) const;
///       static constexpr ElectromagneticClaims field_claims() { return {.vector_potential = false}; }  // optional
///     };
template <class F, class Real>
concept ElectromagneticField = requires(const F& field, const Real& t, const Vec3<Real>& x, FieldValues<Real>& values) {
  field.at(t, x, values);
};

/// What a field says of itself.
struct ElectromagneticClaims {
  bool potential = true;         ///< it tells phi, or its electric field comes from A alone
  bool vector_potential = true;  ///< it tells A
  bool time_dependent = false;
};

namespace detail {
template <class F> constexpr ElectromagneticClaims field_claims() {
  if constexpr (requires { F::field_claims(); }) {
    return F::field_claims();
  } else {
    return {};
  }
}
}  // namespace detail

/// A field as a force on everything that has a charge:
///
///     f_i = q_i (E(t, x_i) + v_i x B(t, x_i)),   U = sum_i q_i phi(t, x_i)
///
/// It depends on velocities. Methods for q'' = f(t, q, v) take it as it is; of splittings `charged_particles`, which
/// turns velocities instead of kicking them. Charges are the column `charge`; tracers have no mass, and feel nothing.
/// @cost one evaluation of the field for each charge, no allocation
/// @source Jackson1999
template <class F> struct InField : F {
  InField() = default;
  InField(F field) : F(std::move(field)) {}  // NOLINT: a field is the force that it is

  using columns = ColumnList<Charge>;
  static constexpr bool is_field = true;

  ForceClaims claims() const {
    constexpr ElectromagneticClaims own = detail::field_claims<F>();
    return {.energy = own.potential,
            .virial = false,
            .velocity_dependent = true,
            .gyrates = true,
            .time_dependent = own.time_dependent,
            .keeps_momentum = false,
            .keeps_angular_momentum = false,
            .charges = true};
  }

  /// @throws Error  for what the field itself refuses
  void check() const { check_part(static_cast<const F&>(*this)); }
  /// @throws Error  where particles have no charges
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    if constexpr (requires { this->expect_values(); }) this->expect_values();
    if (!s.template has<Charge>()) {
      throw Error("the field '" + detail::name_of(static_cast<const F&>(*this)) +
                  "' acts on charges, but the particles have none; give them a column `charge`");
    }
  }

  /// Whether it tells A: as its claims say, or, where it depends on how it was made, by a function of this name.
  bool tells_vector_potential() const {
    if constexpr (requires { this->has_vector_potential(); }) {
      return this->has_vector_potential();
    } else {
      return detail::field_claims<F>().vector_potential;
    }
  }

  /// Of a field that is known in a part of space only: it says so by `bool covers(x) const`.
  template <class Real> static Failure beyond(const ParticleSystem<Real>& s, Index i) {
    return {.particle = i,
            .quantity = "position",
            .message = "'" + s.name(i) + "' has left the places where the field is known"};
  }

  template <class Real>
    requires ElectromagneticField<F, Real>
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const auto& charges = s.template column<Charge>();
    const Real t = s.time();
    const bool momenta = out.wants_field_momenta();
    if (momenta && !tells_vector_potential()) {
      out.fail(
          {.quantity = "vector potential",
           .message = "the field '" + detail::name_of(static_cast<const F&>(*this)) + "' has no vector potential"});
    }
    const auto act = [&](Index i) {
      const Real& q = charges[i];
      const Real& m = s.masses()[i];
      if (all(q == Real(0)) || all(m == Real(0))) return;
      FieldValues<Real> here;
      const Vec3<Real> x = s.positions()[i];
      if constexpr (requires { this->covers(x); }) {
        if (!this->covers(x)) return out.fail(beyond(s, i));
      }
      this->at(t, x, here);
      out.force(i, Vec3<Real>(q * here.E));
      out.gyration(i, Vec3<Real>(q / m * here.B));
      if (out.wants_energy()) out.energy(q * here.phi);
      if (momenta) out.field_momentum(i, Vec3<Real>(q * here.A));
    };
    // Threads may write rows of accelerations. Energies, and a failure, belong to all charges: one thread tells them.
    constexpr bool anywhere = !requires(const Vec3<Real>& x) { this->covers(x); };
    if constexpr (anywhere && std::is_same_v<Real, double>) {
      if (!out.wants_energy() && !out.wants_virial()) {
        for_blocks(s.size(), [&](Index begin, Index end) {
          for (Index i = begin; i < end; ++i) act(i);
        });
        return;
      }
    }
    for (Index i = 0; i < s.size(); ++i) act(i);
  }
};

template <class F> InField(F) -> InField<F>;

/// The fields among forces; of forces that the compiler knows, all.
template <class F> F fields_among(const F& forces) { return forces; }
template <class Real> ForceField<Real> fields_among(const ForceField<Real>& forces) {
  ForceField<Real> fields;
  for (const AnyForce<Real>& term : forces.terms()) {
    if (term.claims().gyrates) fields.add(term);
  }
  return fields;
}

}  // namespace noether
