#include "engine/orbital_elements.hpp"

#include "numbers/quantity.hpp"
#include "python/module/scenes.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <array>

namespace noether::python {

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
