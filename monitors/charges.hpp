#pragma once
/// Monitors of charges in fields: the canonical momentum along a symmetry, and the magnetic moment.

#include "engine/any_force.hpp"
#include "engine/monitor.hpp"
#include "engine/statistics.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// In what charges move; scenes give it to the monitors that ask for it.
struct ChargeMotion {
  std::vector<AnyForce<double>> fields;
  std::optional<double> c = {};  ///< speed of light, where particles are relativistic [length/time]
};

/// A symmetry of space.
enum class SpaceSymmetry : std::uint8_t { rotation, translation };
template <> struct EnumNames<SpaceSymmetry> {
  static constexpr std::array<std::pair<SpaceSymmetry, std::string_view>, 2> values = {
      {{SpaceSymmetry::rotation, "rotation"}, {SpaceSymmetry::translation, "translation"}}};
};

/// Watches what a symmetry of the fields keeps: the canonical momentum m v + q A along an axis, or its moment about
/// one, of all particles together.
///
///     rotation:     J = sum n . (x - x0) x (gamma m v + q A)      translation:  J = sum n . (gamma m v + q A)
///
/// @cost one evaluation of the fields
/// @source Goldstein1980
class CanonicalMomentum {
 public:
  std::array<double, 3> axis = {0, 0, 1};  ///< n, of any length
  SpaceSymmetry symmetry = SpaceSymmetry::rotation;
  std::array<double, 3> center = {0, 0, 0};  ///< x0, through which the axis of a rotation goes [length]

  static constexpr auto describe() {
    return part<CanonicalMomentum>(
        "canonical_momentum", "the canonical momentum of charges that a symmetry of the fields keeps",
        formula("J = n.(x x (m v + q A)) about an axis, J = n.(m v + q A) along one"),
        quantities("value [see unit], relative_error [1]"), source("Goldstein1980"),
        field<&CanonicalMomentum::axis>("axis", "1", "direction of the axis, of any length"),
        field<&CanonicalMomentum::symmetry>("symmetry", "1", "rotation about the axis, or translation along it"),
        field<&CanonicalMomentum::center>("center", "length", "a point of the axis of a rotation"),
        state<&CanonicalMomentum::begun_>("begun"), state<&CanonicalMomentum::reference_>("reference"),
        state<&CanonicalMomentum::scale_>("scale"), state<&CanonicalMomentum::last_>("last"),
        state<&CanonicalMomentum::errors_>("errors"), state<&CanonicalMomentum::time_unit_>("time_unit"));
  }

  /// @throws Error  for an axis without length
  void check() const;
  /// @throws Error  where no field tells its vector potential
  template <class Real> void check(const ParticleSystem<Real>& s) const;
  void watch(const ChargeMotion& motion) { motion_ = motion; }
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  std::optional<double> scale() const { return scale_; }
  MonitorReport report() const;

  double worst() const { return errors_.worst(); }
  double last() const { return last_; }

 private:
  struct Momentum {
    double sum = 0, parts = 0;  ///< J, and the sum of the sizes of its terms
  };
  /// Empty where a field cannot be told.
  template <class Real> std::optional<Momentum> momentum_of(const ParticleSystem<Real>& s, double time) const;

  ChargeMotion motion_;
  bool begun_ = false;
  double reference_ = 0, scale_ = 0, last_ = 0, error_ = 0;
  SeriesStatistics errors_;
  std::string time_unit_;
};

/// Where the magnetic moment is taken.
enum class MomentPlace : std::uint8_t { gyrocentre, particle };
template <> struct EnumNames<MomentPlace> {
  static constexpr std::array<std::pair<MomentPlace, std::string_view>, 2> values = {
      {{MomentPlace::gyrocentre, "gyrocentre"}, {MomentPlace::particle, "particle"}}};
};

/// Watches one charge: its magnetic moment, the centre about which it gyrates, and where it turns back.
///
///     mu = gamma^2 m w_perp^2/2 |B|,   w = v - v_E,  v_E = E x B/B^2,   X = x + gamma m w x B/(q B^2)
///
/// B is that of the gyrocentre (three sweeps), where mu is an adiabatic invariant to the next order, or of the place of
/// the particle, where it swings with every gyration. Turning points are those where v . B changes its sign between two
/// looks.
/// Where no magnetic field is, or the field is not known, there is nothing to tell, and the statistics leave the look
/// out.
/// @cost four evaluations of the fields at one place
/// @source Northrop1963
class MagneticMoment {
 public:
  std::string body = {};  ///< its name; default: the first charge
  MomentPlace at = MomentPlace::gyrocentre;

  static constexpr auto describe() {
    return part<MagneticMoment>(
        "magnetic_moment", "the magnetic moment of a charge, its gyrocentre, and where it turns back",
        formula("mu = m w^2/2B across B, w = v - E x B/B^2;  X = x + m w x B/(q B^2)"),
        quantities("value [energy charge time/mass], center[3] [length], parallel [length/time], relative_error [1]"),
        source("Northrop1963"), field<&MagneticMoment::body>("body", "1", "name of the charge; default: the first"),
        field<&MagneticMoment::at>("at", "1", "where B is taken: gyrocentre or particle"),
        state<&MagneticMoment::begun_>("begun"), state<&MagneticMoment::reference_>("reference"),
        state<&MagneticMoment::least_>("least"), state<&MagneticMoment::most_>("most"),
        state<&MagneticMoment::parallel_>("parallel"), state<&MagneticMoment::time_>("time"),
        state<&MagneticMoment::start_>("start"), state<&MagneticMoment::began_at_>("began_at"),
        state<&MagneticMoment::turns_>("turns"), state<&MagneticMoment::first_turn_>("first_turn"),
        state<&MagneticMoment::last_turn_>("last_turn"), state<&MagneticMoment::errors_>("errors"),
        state<&MagneticMoment::time_unit_>("time_unit"), state<&MagneticMoment::unit_>("unit"));
  }

  /// @throws Error  for a body that is not there or has no charge
  template <class Real> void check(const ParticleSystem<Real>& s) const;
  void watch(const ChargeMotion& motion) { motion_ = motion; }
  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;

  double value() const { return value_; }
  const std::array<double, 3>& center() const { return center_; }
  /// Mean velocity of the gyrocentre since the start [length/time].
  std::array<double, 3> drift() const;
  /// (max - min)/mean of what was seen.
  double swing() const { return (most_ - least_) / ((most_ + least_) / 2); }
  std::int64_t turns() const { return turns_; }
  /// Twice the mean time between two turning points; NaN below three of them.
  double bounce_period() const;
  double worst() const { return errors_.worst(); }

 private:
  template <class Real> Index charge_of(const ParticleSystem<Real>& s) const;
  /// Sets what is shown; NaN where the field is unknown or no field turns the charge. @return whether it is known
  template <class Real> bool look(const ParticleSystem<Real>& s, Index i, double time);

  ChargeMotion motion_;
  bool begun_ = false;
  double value_ = 0, error_ = 0, reference_ = 0, least_ = 0, most_ = 0, parallel_ = 0, time_ = 0, began_at_ = 0;
  std::array<double, 3> center_{}, start_{};
  std::int64_t turns_ = 0;
  double first_turn_ = 0, last_turn_ = 0;
  SeriesStatistics errors_;
  std::string time_unit_, unit_;
};

namespace detail {  // compiled once, in charges.cpp

extern template struct MonitorModel<CanonicalMomentum, double>;
extern template struct MonitorModel<CanonicalMomentum, Quad>;
extern template struct MonitorModel<MagneticMoment, double>;
extern template struct MonitorModel<MagneticMoment, Quad>;

}  // namespace detail

}  // namespace noether
