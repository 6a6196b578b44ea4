#pragma once
/// A force from outside the library with a mesh in its workspace, and with a torque.

#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "tests/support/tops.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace noether::test {

/// A field along z that waves along x, known on a mesh, which holds the axes of bodies:
///
///     U = - sum moment e_z(q_i) f(x_i),   f = sum_k f_k B(x / h - k),  f_k = strength cos(2 pi k / cells),  h = period
///     / cells
///
/// B is the cubic B-spline. Forces and torques are the exact derivatives of this energy.
struct MeshField {
  double strength = 1, period = 4, moment = 1;
  std::int64_t cells = 32;

  static constexpr auto describe() {
    return part<MeshField>(
        "mesh_field", "a field along z that waves along x, from a mesh, and holds the axes of bodies",
        formula("U = - sum moment e_z f(x)"), field<&MeshField::strength>("strength", "1", "of the field"),
        field<&MeshField::period>("period", "length", "of its wave"),
        field<&MeshField::moment>("moment", "energy", "of each body"),
        field<&MeshField::cells>("cells", "1", "of the mesh in a period"));
  }
  static ForceClaims claims() {
    return {.virial = false,
            .keeps_momentum = false,
            .keeps_angular_momentum = false,
            .charges = false,
            .exclusions = false};
  }

  /// Values on the mesh: laid out by the first evaluation, found again by all later ones.
  template <class Real> struct Mesh {
    std::vector<Real> values;
    Index laid_out = 0;
  };

  template <class Real>
    requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad>)  // a cell has one number, in lanes it may not
  void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const Mesh<Real>& mesh = laid_out<Real>(out.workspace());
    const auto& orientation = s.template column<Orientation>();
    for (Index i = 0; i < s.size(); ++i) {
      const auto [f, slope] = field_at(mesh, std::as_const(s).positions()[i][0]);
      const Vec3<Real> e = Real(moment) * axis_of(Quaternion<Real>(orientation[i]));
      out.force(i, Vec3<Real>(e[2] * slope, Real(0), Real(0)));
      out.torque(i, cross(e, Vec3<Real>(Real(0), Real(0), f)));
      out.energy(-e[2] * f);
    }
  }

 private:
  template <class Real> const Mesh<Real>& laid_out(Workspace& workspace) const {
    auto& mesh = workspace.get<Mesh<Real>>();
    if (!mesh.values.empty()) return mesh;
    using std::cos;
    const Real turn = Real(2) * acos_of_minus_one<Real>() / Real(static_cast<double>(cells));
    for (Index k = 0; k < cells; ++k) {
      mesh.values.push_back(Real(strength) * cos(turn * Real(static_cast<double>(k))));
    }
    ++mesh.laid_out;
    return mesh;
  }
  template <class Real> static Real acos_of_minus_one() {
    using std::acos;
    return acos(Real(-1));
  }
  /// f and df/dx.
  template <class Real> std::pair<Real, Real> field_at(const Mesh<Real>& mesh, const Real& x) const {
    using std::floor;
    const Real h = Real(period) / Real(static_cast<double>(cells)), u = x / h, below = floor(u), t = u - below;
    const auto first = static_cast<Index>(static_cast<double>(below)) - 1;
    const Real r = Real(1) - t;
    const Real weights[4] = {r * r * r / Real(6), Real(2) / Real(3) - t * t + t * t * t / Real(2),
                             Real(2) / Real(3) - r * r + r * r * r / Real(2), t * t * t / Real(6)};
    const Real slopes[4] = {-r * r / Real(2), -Real(2) * t + Real(1.5) * t * t, Real(2) * r - Real(1.5) * r * r,
                            t * t / Real(2)};
    Real f(0), slope(0);
    for (Index k = 0; k < 4; ++k) {
      const auto cell = static_cast<std::size_t>(((first + k) % cells + cells) % cells);
      f += weights[k] * mesh.values[cell];
      slope += slopes[k] * mesh.values[cell];
    }
    return {f, slope / h};
  }
};

}  // namespace noether::test
