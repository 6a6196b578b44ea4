#pragma once
/// Python's values as a tree of a scene, and back.

#include "scene/value.hpp"

#include <nanobind/nanobind.h>

#include <string>

namespace noether::python {

namespace nb = nanobind;

/// A value that a scene may have: flags, whole numbers, numbers, texts, paths, and lists and dicts of them, arrays of
/// NumPy among them. Entries that are None are left out.
/// @param what  names it in errors: "lennard_jones.cutoff"
/// @throws nb::type_error  for a value that no scene can have
SceneValue value_of(nb::handle object, const std::string& what);

/// The same as Python has it: dict, list, str, bool, int, float.
nb::object object_of(const SceneValue& value);

/// One line of JSON as Python has it.
nb::object from_json(const std::string& json);

}  // namespace noether::python
