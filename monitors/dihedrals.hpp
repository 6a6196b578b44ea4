#pragma once
/// The monitor of dihedral angles.

#include "engine/monitor.hpp"
#include "engine/statistics.hpp"
#include "engine/tied.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Watches dihedral angles phi of four particles in a row, nearest images in a periodic box: 0 where the ends are on
/// one side (cis), 180 degrees where they are on opposite sides (trans), positive where the far end is turned clockwise
/// (IUPAC),
///
///     f = x_1 - x_2,  g = x_2 - x_3,  h = x_4 - x_3,   A = f x g,  B = h x g
///     phi = atan2(|g| h.A, A.B)
///
/// and their histogram over (-180, 180] degrees, as a density whose integral is 1, averaged over angles and looks.
/// An angle is trans where |phi| > 120 degrees, else gauche+ where phi >= 0, else gauche-. The errors of the three
/// fractions are those of block means over time, from 20 looks on.
///
/// The angles are those of the dihedrals of the topology, of these those whose particles have the given `types` in one
/// direction or the other, or those of the named `quadruples`, bonded or not. Four particles that several terms of the
/// topology share are one angle; terms that act on the ends only (`one_four`) are none. Four particles of which three
/// are exactly in line have no angle and are not counted.
/// @throws Error  when attached to a run without such angles, with a type or a particle that is not there, or where a
///   named particle has been taken out
/// @cost some 100 ns for each angle and look, on all threads; O(angles + bins) memory
/// @source BlondelKarplus1996
class Dihedrals {
 public:
  std::int64_t bins = 180;
  std::vector<std::string> types = {};                    ///< of the four particles; empty: all dihedrals
  std::vector<std::vector<std::string>> quadruples = {};  ///< names of particles, four each; empty: the topology's

  Dihedrals() = default;
  explicit Dihedrals(std::int64_t intervals, std::vector<std::string> of_types = {},
                     std::vector<std::vector<std::string>> of_names = {})
      : bins(intervals), types(std::move(of_types)), quadruples(std::move(of_names)) {}

  static constexpr bool needs_particles = true;

  static constexpr auto describe() {
    return part<Dihedrals>(
        "dihedrals",
        "dihedral angles of molecules: histogram, and fractions trans and gauche, averaged over the samples",
        formula(
            "phi = atan2(|g| h.A, A.B),  A = f x g,  B = h x g;  180 degrees is trans; gauche: |phi| <= 120 degrees"),
        quantities("angle[bins] [angle], density[bins] [1/angle], fraction[3], fraction_error[3] [1] (trans, gauche+, "
                   "gauche-), now[quadruples] [angle]"),
        source("BlondelKarplus1996"), field<&Dihedrals::bins>("bins", "1", "intervals of the histogram"),
        field<&Dihedrals::types>("types", "1",
                                 "the four types of the angles, in either direction; default: all angles"),
        field<&Dihedrals::quadruples>("quadruples", "1",
                                      "names of four particles for each angle; default: dihedrals of the structure"),
        state<&Dihedrals::counts_>("counts"), state<&Dihedrals::last_>("last"),
        state<&Dihedrals::undefined_>("undefined"), state<&Dihedrals::samples_>("samples"),
        state<&Dihedrals::trans_>("trans"), state<&Dihedrals::gauche_plus_>("gauche_plus"),
        state<&Dihedrals::gauche_minus_>("gauche_minus"), state<&Dihedrals::kinds_>("kinds"));
  }

  /// @throws Error  for no bins, more than 100 000 of them, other than no or four types, other than four names, or both
  ///   types and names
  void check() const;
  /// @throws Error  as the class says
  template <class Real> void check(const ParticleSystem<Real>& s) const {
    find_named(s.names());
    named_.find(s);
    choose(s.shared_topology());
  }

  template <class Real> void observe(const Snapshot<Real>& now);
  std::vector<Series> series() const;
  MonitorReport report() const;
  /// @throws Error if parts of the saved state do not fit
  void load(const SavedState& saved, const std::string& prefix);

  /// Angles that are watched.
  Index size() const { return static_cast<Index>(named_.empty() ? chosen_.size() : named_.size()); }
  /// Middle of interval `k`, in (-pi, pi).
  double angle(std::int64_t k) const;
  /// Angles counted so far by interval, shape (bins).
  const std::vector<std::int64_t>& counts() const { return counts_; }
  /// Their density by interval [1/angle], shape (bins); NaN before the first look.
  std::vector<double> density() const;
  /// Fractions trans, gauche+ and gauche- of all angles counted so far; NaN before the first look.
  std::array<double, 3> fractions() const;
  /// Their errors; NaN below 20 looks.
  std::array<double, 3> fraction_errors() const;
  /// The named angles at the last look, in (-pi, pi], in the order of their names; NaN where there is none.
  const std::vector<double>& named_angles() const { return last_; }

 private:
  void find_named(const std::vector<std::string>& names) const;
  void choose(const std::shared_ptr<const Topology>& topology) const;
  void count(double time, const std::vector<double>& angles);

  std::vector<std::int64_t> counts_;
  std::vector<std::int64_t> kinds_ = {0, 0, 0};  ///< trans, gauche+, gauche- so far
  std::vector<double> last_;                     ///< named angles at the last look
  std::int64_t undefined_ = 0;                   ///< angles that were none, so far
  std::int64_t samples_ = 0;
  SeriesStatistics trans_, gauche_plus_, gauche_minus_;  ///< of one look each

  mutable Tied<4> named_;
  mutable std::shared_ptr<const Topology> topology_;  ///< whose dihedrals are chosen
  mutable std::vector<std::array<Index, 4>> chosen_;
};

namespace detail {  // compiled once, in dihedrals.cpp

/// The dihedral angle of four particles in (-pi, pi], from x_1 - x_2, x_2 - x_3 and x_4 - x_3; NaN where three of them
/// are in line. @source BlondelKarplus1996
double dihedral_angle(const Vec3<double>& f, const Vec3<double>& g, const Vec3<double>& h);

extern template struct MonitorModel<Dihedrals, double>;
extern template struct MonitorModel<Dihedrals, Quad>;

}  // namespace detail

}  // namespace noether
