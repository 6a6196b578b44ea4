#include "python/module/values.hpp"

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include <cstdint>
#include <utility>

namespace noether::python {

namespace {

SceneValue::Table entries_of(nb::handle dict, const std::string& what) {
  SceneValue::Table entries;
  for (const auto& [key, value] : nb::borrow<nb::dict>(dict)) {
    if (!nb::isinstance<nb::str>(key)) {
      throw nb::type_error(fmt::format("{}: the key {} is not a text", what, nb::repr(key).c_str()).c_str());
    }
    if (value.is_none()) continue;
    std::string name = nb::cast<std::string>(key);
    SceneValue inside = value_of(value, what.empty() ? name : what + "." + name);
    entries.emplace_back(std::move(name), std::move(inside));
  }
  return entries;
}

SceneValue::Array elements_of(nb::handle sequence, const std::string& what) {
  SceneValue::Array list;
  for (nb::handle element : nb::iter(sequence)) {
    list.push_back(value_of(element, fmt::format("{}[{}]", what, list.size())));
  }
  return list;
}

bool has(nb::handle object, const char* attribute) { return nb::hasattr(object, attribute); }

/// A whole number of Python or NumPy, if it fits.
std::int64_t whole(nb::handle object, const std::string& what) {
  const nb::object number = nb::steal(PyNumber_Index(object.ptr()));
  if (!number.is_valid()) throw nb::python_error();
  const long long value = PyLong_AsLongLong(number.ptr());
  if (value == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw nb::value_error(
        fmt::format("{} = {} has no room in 64 bits; give it as a float", what, nb::str(number).c_str()).c_str());
  }
  return value;
}

}  // namespace

SceneValue value_of(nb::handle object, const std::string& what) {
  if (nb::isinstance<nb::bool_>(object)) return SceneValue::of(nb::cast<bool>(object));
  if (nb::isinstance<nb::str>(object)) return SceneValue::of(nb::cast<std::string>(object));
  if (nb::isinstance<nb::float_>(object)) return SceneValue::of(nb::cast<double>(object));
  if (nb::isinstance<nb::int_>(object)) return SceneValue::of(whole(object, what));
  if (nb::isinstance<nb::dict>(object)) return SceneValue::of(entries_of(object, what));
  if (has(object, "__fspath__")) return SceneValue::of(nb::cast<std::string>(object.attr("__fspath__")()));
  if (has(object, "tolist")) return value_of(object.attr("tolist")(), what);  // arrays and numbers of NumPy
  if (has(object, "__index__")) return SceneValue::of(whole(object, what));
  if (has(object, "__float__")) {
    const double number = PyFloat_AsDouble(object.ptr());
    if (number == -1 && PyErr_Occurred() != nullptr) throw nb::python_error();
    return SceneValue::of(number);
  }
  if (has(object, "__iter__")) return SceneValue::of(elements_of(object, what));
  throw nb::type_error(fmt::format("{} = {} is of type {}; a number, a text, a flag, or a list or dict of them is "
                                   "expected",
                                   what, nb::repr(object).c_str(), nb::type_name(object.type()).c_str())
                           .c_str());
}

nb::object object_of(const SceneValue& value) {
  if (const bool* flag = value.get<bool>()) return nb::bool_(*flag);
  if (const std::int64_t* number = value.get<std::int64_t>()) return nb::int_(*number);
  if (const double* number = value.get<double>()) return nb::float_(*number);
  if (const std::string* text = value.get<std::string>()) return nb::str(text->c_str(), text->size());
  if (const SceneValue::Array* list = value.get<SceneValue::Array>()) {
    nb::list made;
    for (const SceneValue& one : *list) made.append(object_of(one));
    return made;
  }
  nb::dict made;
  for (const auto& [key, one] : *value.get<SceneValue::Table>()) made[key.c_str()] = object_of(one);
  return made;
}

nb::object from_json(const std::string& json) { return nb::module_::import_("json").attr("loads")(json); }

}  // namespace noether::python
