#include "python/module/user_constraint.hpp"

#include "numbers/dual.hpp"
#include "numbers/error.hpp"
#include "numbers/real.hpp"
#include "scene/parts.hpp"

#include <fmt/format.h>

#include <limits>
#include <type_traits>

namespace noether::python {

namespace {

template <class Real> struct IsDual : std::false_type {};
template <class Real, std::size_t n> struct IsDual<Dual<Real, n>> : std::true_type {};

/// Whether a number is a double, or dual numbers over doubles.
template <class Real> struct OverDoubles : std::is_same<Real, double> {};
template <class Real, std::size_t n> struct OverDoubles<Dual<Real, n>> : OverDoubles<Real> {};

/// A number as Python has it: a float, or an object `dual` of a value and slopes.
template <class Real> nb::object python_number(const Real& x, const nb::object& dual) {
  if constexpr (IsDual<Real>::value) {
    nb::list slopes;
    for (const auto& slope : x.slope) slopes.append(python_number(slope, dual));
    return dual(python_number(x.value, dual), slopes);
  } else {
    return nb::float_(x);
  }
}

/// The same back; a float is a number without slopes.
template <class Real> Real number_of(nb::handle object) {
  if constexpr (IsDual<Real>::value) {
    using Inner = std::decay_t<decltype(Real().value)>;
    if (!nb::hasattr(object, "slopes")) return Real(number_of<Inner>(object));
    Real x(number_of<Inner>(object.attr("value")));
    std::size_t place = 0;
    for (nb::handle slope : nb::iter(object.attr("slopes"))) x.slope[place++] = number_of<Inner>(slope);
    return x;
  } else {
    return nb::cast<double>(nb::float_(object));
  }
}

}  // namespace

template <std::size_t k> void UserConstraint<k>::check() const {
  if (!(size > 0)) refuse_field("scale", size, "is not a valid scale; a number above 0 is expected");
}

template <std::size_t k> UserConstraint<k> UserConstraint<k>::at_start(const Points<double, k>& /*x*/) const {
  UserConstraint found = *this;
  found.callable_ = callable_of(function);
  if (found.callable_ == nullptr) {
    throw Error(fmt::format(
        "no function of Python has the number {}; constraints of one's own are added in Python, by add_constraint",
        function));
  }
  return found;
}

template <std::size_t k> template <class Real> Real UserConstraint<k>::value(const Points<Real, k>& x) const {
  if constexpr (!OverDoubles<Real>::value) {
    throw Error("a constraint of one's own in Python is known in double precision only");
  } else {
    Real found(std::numeric_limits<double>::quiet_NaN());
    callable_->call([&](nb::handle function) {
      const nb::module_ duals = nb::module_::import_("noether.duals");
      const nb::object dual = duals.attr("Dual");
      nb::list rows;
      for (const Vec3<Real>& place : x) {
        nb::list row;
        for (int c = 0; c < 3; ++c) row.append(python_number(Real(place[c]), dual));
        rows.append(row);
      }
      found = number_of<Real>(duals.attr("call")(function, rows));
    });
    return found;
  }
}

void add_user_constraints(Parts& parts) {
  parts.add_constraint<UserConstraint<1>>();
  parts.add_constraint<UserConstraint<2>>();
  parts.add_constraint<UserConstraint<3>>();
  parts.add_constraint<UserConstraint<4>>();
}

}  // namespace noether::python
