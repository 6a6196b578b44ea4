#pragma once
/// A field of charges that is known on a grid of places.

#include "forces/electromagnetic_field.hpp"

#include <array>
#include <concepts>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace noether {

/// Values on a regular grid, z fastest. What is empty is not there.
struct FieldGrid {
  std::array<Index, 3> counts = {0, 0, 0};                        ///< of places along x, y, z; six or more each
  std::array<double, 3> origin = {0, 0, 0}, spacing = {1, 1, 1};  ///< [length]
  std::vector<double> A;                                          ///< shape (nx, ny, nz, 3) [mass length/time/charge]
  std::vector<double> B;                                          ///< the same, instead of A [mass/time/charge]
  std::vector<double> phi;                                        ///< shape (nx, ny, nz) [energy/charge]
  mutable std::uint64_t known_fingerprint = 0;                    ///< 0: not asked for yet

  /// @throws Error  for shapes that do not fit, too few places, B beside A, and for values that are not finite
  void check() const;
  /// Tells grids apart by all their numbers.
  /// @cost one look at all of them, at the first call
  std::uint64_t fingerprint() const;
  /// Values of a field at the places of a grid: A of it where it tells A, else B, and phi where it is not 0.
  template <class F>
  static FieldGrid of(const F& field, std::array<Index, 3> counts, std::array<double, 3> origin,
                      std::array<double, 3> spacing);
};

/// A field between the places of a grid, by cubics along each axis whose slopes at the places are differences of fourth
/// order: A and phi are smooth to first order, and B = rot A has no divergence, to rounding, whatever the grid is. With
/// a grid of B alone its components are such cubics, and `divergence` tells what is left.
///
/// It is known at places with two more on either side: beyond that a run ends by name. Double precision only, and
/// slopes of it.
/// @cost 216 places read, some 2000 operations
struct GridField {
  std::string file = {};  ///< as scenes name it
  std::shared_ptr<const FieldGrid> grid = {};

  static constexpr auto describe() {
    return part<GridField>(
        "field_grid", "a field on a grid of places in an HDF5 file: A, or B alone, and phi, by cubics between them",
        formula("B = rot A,  E = - grad phi"), source("LekienMarsden2005"),
        field<&GridField::file>("file", "1",
                                "HDF5 file with the datasets origin[3], spacing[3], A[nx,ny,nz,3] or "
                                "B[nx,ny,nz,3], phi[nx,ny,nz], in the units of the scene")
            .required("\"coils.h5\""));
  }
  /// Tells files of the same name apart.
  std::string signature() const;

  /// @throws Error  without a grid, and as its `check` does
  void expect_values() const;
  /// Whether it tells A: not where the grid has B alone.
  bool has_vector_potential() const { return grid == nullptr || grid->B.empty(); }
  /// Whether the field is known there.
  bool covers(const Vec3<double>& x) const;
  template <std::same_as<Dual<double, 1>> Number> bool covers(const Vec3<Number>& x) const {
    return covers(Vec3<double>(x[0].value, x[1].value, x[2].value));
  }
  /// Largest |div B| in the middles of cells, relative to the largest |B| over a spacing; of a large grid in some 1e5
  /// of them.
  double divergence() const;

  template <class Real>
    requires std::same_as<Real, double> || std::same_as<Real, Dual<double, 1>>
  void at(const Real& /*t*/, const Vec3<Real>& x, FieldValues<Real>& field) const { interpolate(x, field); }

 private:
  template <class Number> void interpolate(const Vec3<Number>& x, FieldValues<Number>& field) const;
};

template <class F>
FieldGrid FieldGrid::of(const F& field, std::array<Index, 3> counts, std::array<double, 3> origin,
                        std::array<double, 3> spacing) {
  FieldGrid grid{.counts = counts, .origin = origin, .spacing = spacing, .A = {}, .B = {}, .phi = {}};
  constexpr bool has_A = detail::field_claims<F>().vector_potential;
  bool electric = false;
  for (Index i = 0; i < counts[0]; ++i) {
    for (Index j = 0; j < counts[1]; ++j) {
      for (Index k = 0; k < counts[2]; ++k) {
        FieldValues<double> here;
        field.at(0.0,
                 Vec3<double>(origin[0] + static_cast<double>(i) * spacing[0],
                              origin[1] + static_cast<double>(j) * spacing[1],
                              origin[2] + static_cast<double>(k) * spacing[2]),
                 here);
        for (int c = 0; c < 3; ++c) (has_A ? grid.A : grid.B).push_back(has_A ? here.A[c] : here.B[c]);
        grid.phi.push_back(here.phi);
        electric = electric || here.phi != 0;
      }
    }
  }
  if (!electric) grid.phi.clear();
  return grid;
}

namespace detail {  // compiled once, in grid_field.cpp

extern template struct ForceModel<InField<GridField>, double>;

}  // namespace detail

}  // namespace noether
