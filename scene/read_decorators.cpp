#include "scene/read_decorators.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace noether {

namespace {

/// A decorator that stands under its own name, such as [integrator.projection].
void read_named_decorator(TableReader& integrator, const Parts::DecoratorKind& kind, SceneIntegrator& made,
                          SceneValue& effective) {
  const std::string& name = kind.info.name;
  const SceneValue* table = integrator.find(name);
  if (table == nullptr) return;
  const std::string path = "integrator." + name;
  if (!table->is_table()) integrator.wrong_kind(*table, name, "a table headed [" + path + "]");
  TableReader reader(integrator.context(), *table, "[" + path + "]", path);
  made.decorators.push_back(kind.read(reader));
  made.decorators.back().path = path;
  effective.put(name, made.decorators.back().effective);
}

}  // namespace

void read_decorators(TableReader& integrator, const Parts& parts, SceneIntegrator& made, SceneValue& effective) {
  const SceneContext& context = integrator.context();
  for (const Parts::DecoratorKind& kind : parts.decorators()) read_named_decorator(integrator, kind, made, effective);
  SceneValue::Array list;
  for (const SceneValue* table : tables_of(integrator, "decorator")) {
    if (parts.decorators().empty()) {
      integrator.fail(table, "decorator",
                      "this program has no decorators; a program of your own can add them with `parts.add_decorator`");
    }
    const std::string path = fmt::format("integrator.decorator.{}", list.size());
    const auto [kind, type] = kind_of_part(context, *table, path, "decorator", parts.decorators(), {});
    TableReader reader(context, *table, fmt::format("decorator '{}'", type), path);
    reader.find("type");
    SceneDecorator decorator = kind->read(reader);
    SceneValue one = SceneValue::table();
    one.put("type", SceneValue::of(type, reader.line("type")));
    for (const auto& [key, value] : *decorator.effective.get<SceneValue::Table>()) one.put(key, value);
    list.push_back(std::move(one));
    made.decorators.push_back(std::move(decorator));
    made.decorators.back().path = path;
  }
  if (!list.empty()) effective.put("decorator", SceneValue::of(std::move(list)));
}

}  // namespace noether
