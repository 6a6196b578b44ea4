#include "engine/orbital_elements.hpp"

#include "engine/given_orbit.hpp"
#include "io/horizons_table.hpp"
#include "numbers/quantity.hpp"
#include "python/module/scenes.hpp"

#include <fmt/format.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>

namespace noether::python {

namespace {

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// a, e, inc, Omega, omega, M and f of one orbit; f of an ellipse lies in [0, 2 pi), of a hyperbola in (-pi, pi).
std::array<double, 7> elements_with_anomaly(const Vec3<double>& x, const Vec3<double>& v, double mu) {
  const OrbitalElements<double> o = elements_from_state(x, v, mu);
  const Vec3<double> h = cross(x, v), node(std::cos(o.Omega), std::sin(o.Omega), 0.0);
  const double latitude = std::atan2(dot(x, cross(h, node)) / std::sqrt(norm2(h)), dot(x, node));
  double f = detail::positive_angle(latitude - o.omega);
  if (o.e == 0.0) f = o.M;  // both are counted from the node
  const double turn = detail::full_turn<double>();
  if (!(o.a > 0.0) && f > turn / 2.0) f -= turn;
  return {o.a, o.e, o.inc, o.Omega, o.omega, o.M, f};
}

/// Elements of many orbits at once.
/// @throws nb::value_error  if the arrays differ in length
nb::object elements_of_states(const Rows& x, const Rows& v, const Numbers& mu) {
  const std::size_t n = x.shape(0);
  if (x.shape(1) != 3 || v.shape(1) != 3 || v.shape(0) != n || mu.shape(0) != n) {
    throw nb::value_error(fmt::format("positions of shape ({}, {}), velocities of shape ({}, {}) and {} numbers of mu; "
                                      "(n, 3), (n, 3) and n are expected",
                                      n, x.shape(1), v.shape(0), v.shape(1), mu.shape(0))
                              .c_str());
  }
  constexpr std::size_t columns = 7;
  auto found = std::make_unique<double[]>(n * columns);
  {
    const nb::gil_scoped_release unlocked;
    const auto at = [](const Rows& rows, std::size_t k) {
      const double* row = rows.data() + 3 * k;
      return Vec3<double>(row[0], row[1], row[2]);
    };
    for (std::size_t k = 0; k < n; ++k) {
      const auto one = elements_with_anomaly(at(x, k), at(v, k), mu.data()[k]);
      std::copy(one.begin(), one.end(), found.get() + columns * k);
    }
  }
  double* data = found.release();
  const nb::capsule owner(data, [](void* held) noexcept { delete[] static_cast<double*>(held); });
  const std::size_t shape[2] = {n, columns};
  return nb::cast(nb::ndarray<nb::numpy, double, nb::ndim<2>>(data, 2, shape, owner));
}

}  // namespace

void bind_elements(nb::module_& m) {
  using Three = std::array<double, 3>;
  m.def(
      "elements_from_state",
      [](const Three& x, const Three& v, double mu) {
        const OrbitalElements<double> o =
            elements_from_state(Vec3<double>(x[0], x[1], x[2]), Vec3<double>(v[0], v[1], v[2]), mu);
        return std::array<double, 6>{o.a, o.e, o.inc, o.Omega, o.omega, o.M};
      },
      nb::arg("x"), nb::arg("v"), nb::arg("mu"));
  m.def("elements_of_states", &elements_of_states, nb::arg("x"), nb::arg("v"), nb::arg("mu"));
  m.def(
      "known_gm",  // of a body by its number at NAIF [km^3/s^2], or None
      [](int number) { return io::known_GM({.text = {}, .name = {}, .number = number}); }, nb::arg("number"));
  m.def(
      "other_name",  // what a key that other programs have is called here: "; did you mean 'inc'?"
      [](const std::string& name) { return std::string(other_name_of(name).told); }, nb::arg("name"));
  m.def(
      "state_from_elements",
      [](const std::array<double, 6>& o, double mu) {
        const auto [x, v] = state_from_elements(OrbitalElements<double>{o[0], o[1], o[2], o[3], o[4], o[5]}, mu);
        return std::array<Three, 2>{Three{x[0], x[1], x[2]}, Three{v[0], v[1], v[2]}};
      },
      nb::arg("elements"), nb::arg("mu"));
  m.def(
      "gravitational_constant", [](const std::string& units) { return unit_system(units).G; }, nb::arg("units"));
  m.def(
      "unit_names",
      [](const std::string& units) {
        const UnitSystem& system = unit_system(units);
        return std::array<std::string, 4>{std::string(system.length), std::string(system.mass),
                                          std::string(system.time), std::string(system.energy)};
      },
      nb::arg("units"));
  m.def(
      "unit_of",
      [](const std::string& dimension, const std::string& units) {
        return unit_of(parse_dimension(dimension), unit_system(units));
      },
      nb::arg("dimension"), nb::arg("units"));
  m.def(
      "quantity",
      [](const std::string& text, const std::string& dimension, const std::string& units) {
        return parse_quantity(text, parse_dimension(dimension), unit_system(units));
      },
      nb::arg("text"), nb::arg("dimension"), nb::arg("units"));
}

}  // namespace noether::python
