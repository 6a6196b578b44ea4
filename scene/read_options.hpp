#pragma once
/// Options of methods, read from a scene and shown by `noether describe` as they describe themselves.

#include "integrators/composition_options.hpp"
#include "integrators/method.hpp"
#include "scene/fields.hpp"

#include <vector>

namespace noether {

/// What a method takes beside its step, with its defaults.
std::vector<FieldInfo> fields_of(const MethodInfo& info);

/// Reads the options of splittings that a table gives.
/// @throws SceneError  at the line of the key
CompositionOptions read_composition(TableReader& reader);

/// Reads the options of a group that a table gives; the others stay as they are.
/// @throws SceneError  at the line of the key
void read_options(TableReader& reader, const OptionGroup& group, MethodOptions& options);

/// Appends the options of a group that are set: as the scene wrote them, or in its units.
void put_options(TableReader& reader, const OptionGroup& group, const MethodOptions& options, SceneValue& effective);

}  // namespace noether
