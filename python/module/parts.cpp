#include "cli/described_parts.hpp"
#include "cli/scene_tables.hpp"
#include "integrators/all_schemes.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "numbers/units.hpp"
#include "numbers/version.hpp"
#include "python/module/scenes.hpp"
#include "scene/read_options.hpp"
#include "scene/references.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>

namespace noether::python {

namespace {

nb::list dicts_of(const std::vector<FieldInfo>& fields) {
  nb::list all;
  for (const FieldInfo& field : fields) {
    nb::dict one;
    one["name"] = field.name;
    one["kind"] = field.kind;
    one["dimension"] = field.dimension;
    one["default"] = field.default_value.empty() ? nb::none() : nb::object(nb::str(field.default_value.c_str()));
    one["example"] = field.example.empty() ? nb::none() : nb::object(nb::str(field.example.c_str()));
    one["choices"] = field.choices;
    one["help"] = field.help;
    all.append(one);
  }
  return all;
}

nb::list described() {
  nb::list all;
  for (const auto& [kind, info] : described_parts(known_parts())) {
    nb::dict one;
    one["kind"] = kind;
    one["name"] = info.name;
    one["help"] = info.help;
    one["formula"] = info.formula;
    one["source"] = info.source;
    one["quantities"] = info.quantities;
    one["fields"] = dicts_of(info.fields);
    all.append(one);
  }
  return all;
}

nb::list described_methods() {
  nb::list all;
  for (const MethodInfo* info : known_parts().methods()) {
    nb::dict one;
    one["name"] = std::string(info->name);
    one["family"] = std::string(info->family);
    one["order"] = info->order;
    one["fields"] = dicts_of(fields_of(*info));
    all.append(one);
  }
  return all;
}

nb::list described_columns() {
  nb::list all;
  const auto add = [&](const std::vector<ColumnInfo>& columns) {
    for (const ColumnInfo& column : columns) {
      nb::dict one;
      one["name"] = column.name;
      one["dimension"] = column.dimension;
      all.append(one);
    }
  };
  for (const auto& kind : known_parts().hamiltonians()) add(kind.columns);
  for (const auto& kind : known_parts().forces()) add(kind.columns);
  return all;
}

nb::list described_tables() {
  nb::list all;
  for (const SceneTable& table : scene_tables(known_parts())) {
    nb::dict one;
    one["name"] = table.name;
    one["help"] = table.help;
    one["fields"] = dicts_of(table.fields);
    all.append(one);
  }
  return all;
}

}  // namespace

void bind_parts(nb::module_& m) {
  m.def("parts", &described);
  m.def("methods", &described_methods);
  m.def("columns", &described_columns);
  m.def("tables", &described_tables);
  m.def("scheme_names", [] {
    std::vector<std::string> names;
    for (const Scheme* scheme : schemes::all()) names.emplace_back(scheme->name);
    return names;
  });
  m.def(
      "bibtex", [](const std::string& sources) { return entries_of(sources); }, nb::arg("sources"));
  m.def("version", [] { return std::string(version()); });
  m.def("commit", [] { return std::string(commit()); });
  m.def("thread_count", &thread_count);
  m.def("set_thread_count", &set_thread_count, nb::arg("threads"));
  m.def("simd_level", [] { return std::string(name(simd_level())); });
}

}  // namespace noether::python
