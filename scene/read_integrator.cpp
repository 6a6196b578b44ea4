#include "scene/read_integrator.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "numbers/suggest.hpp"
#include "scene/read_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// How many steps make a duration. @throws SceneError  unless it is a whole number, with the two nearest
std::int64_t whole_steps(const TableReader& reader, std::string_view key, const SceneValue& value,
                         const SceneIntegrator& integrator) {
  const double duration = reader.number(value, key, "time"), exact = duration / integrator.step,
               whole = std::round(exact);
  const auto fail = [&](const std::string& message) {
    reader.fail(&value, key, fmt::format("{} = {} {}", key, to_text(value), message));
  };
  if (exact < 0) {
    fail(fmt::format("lies the other way; steps are of {}, so give a time {} 0", integrator.step_text,
                     integrator.step > 0 ? "above" : "below"));
  }
  if (!(exact > 0)) fail(fmt::format("is no time ahead; steps are of {}", integrator.step_text));
  if (exact > 9e15) fail(fmt::format("is {:.3g} steps of {}, more than can be counted", exact, integrator.step_text));
  if (std::abs(exact - whole) > 1e-9 + 16 * std::numeric_limits<double>::epsilon() * exact) {
    const std::string unit = unit_of(dimensions::time, *reader.context().units);
    const auto nearest = [&](double steps) {
      const std::string number = format_number(steps * integrator.step);
      return fmt::format("{} ({} {})", unit == "1" ? number : "\"" + number + " " + unit + "\"", format_number(steps),
                         steps == 1 ? "step" : "steps");
    };
    const std::string is = fmt::format("is {:.12g} steps of {}", exact, integrator.step_text);
    if (exact < 1) fail(fmt::format("{}; the shortest time is {}", is, nearest(1)));
    fail(fmt::format("{}; the nearest whole numbers are {} and {}", is, nearest(std::floor(exact)),
                     nearest(std::ceil(exact))));
  }
  return static_cast<std::int64_t>(whole);
}

std::int64_t counted_steps(TableReader& reader, std::string_view key) {
  const std::int64_t steps = *reader.integer(key);
  if (steps < 1) reader.fail(key, fmt::format("{} = {} is too few; at least 1 is expected", key, steps));
  return steps;
}

void unknown_method(TableReader& reader, const std::string& name, const Parts& parts) {
  const std::string near = suggest(name, parts.method_names());
  reader.fail("method", fmt::format("unknown method '{}'; {}", name,
                                    near.empty() ? "see `noether list methods`" : "did you mean '" + near + "'?"));
}

void read_method(TableReader& reader, const Parts& parts, SceneIntegrator& made) {
  const std::string name = reader.text("method");
  if (!reader.has("method")) reader.fail(nullptr, "method", "[integrator] has no method; see `noether list methods`");
  const bool letters = !name.empty() && name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos;
  if (const Scheme* scheme = schemes::find(name)) {
    made.scheme = *scheme;
    made.method = std::string(scheme->name);
  } else if (const MethodInfo* info = parts.find_method(name)) {
    made.classical = MethodChoice{info, {}};
    made.method = std::string(info->name);
  } else if (letters) {
    try {
      made.scheme = word(name);
    } catch (const Error& error) {
      reader.fail("method", error.message());
    }
    made.method = name;
  } else {
    unknown_method(reader, name, parts);
  }
}

/// What a splitting scheme takes beside its step.
void read_scheme_options(TableReader& reader, const Parts& parts, SceneIntegrator& made, bool constrained,
                         SceneValue& effective) {
  for (const OptionGroup* group : parts.method_options()) {
    const std::string_view remedy = group == error_control ? ", or use a method such as 'dop853'" : "";
    for (const OptionValue& one : group->values({})) {
      if (reader.has(one.name))
        reader.fail(one.name, lacks_option(made.method, *group, one.name) + std::string(remedy));
    }
  }
  read_fields(reader, made.composition);
  try {
    if (constrained) made.composition.check_with_constraints();
  } catch (const Error& error) {
    reader.refuse(error);
  }
  put_fields(reader, made.composition, effective);
}

/// Refuses what only a splitting takes, where it is more than its default.
void refuse_scheme_options(TableReader& reader, const SceneIntegrator& made) {
  CompositionOptions given;
  const CompositionOptions defaults;
  read_fields(reader, given);
  for_each_field<CompositionOptions>([&](const auto& field) {
    if (given.*(field.member) == defaults.*(field.member)) return;
    reader.fail(field.name,
                fmt::format("method '{}' {}; {} = {} is for splitting schemes such as 'verlet'", made.method,
                            CompositionOptions::elsewhere, field.name, to_text(*reader.find(field.name))));
  });
}

/// What a classical method takes beside its step.
void read_method_options(TableReader& reader, const Parts& parts, SceneIntegrator& made, bool constrained,
                         SceneValue& effective) {
  const MethodInfo& info = *made.classical->info;
  MethodOptions& options = made.classical->options;
  if (constrained) {
    reader.fail("method", fmt::format("method '{}' knows no constraints; use 'verlet', which is RATTLE with them, or a "
                                      "composition of it such as 'yoshida_4'",
                                      made.method));
  }
  refuse_scheme_options(reader, made);
  for (const OptionGroup* group : parts.method_options()) {
    // What control of errors means to a method without it, `check_options` says.
    if (group == error_control || info.takes(*group)) {
      read_options(reader, *group, options);
      continue;
    }
    for (const OptionValue& one : group->values({})) {
      if (reader.has(one.name)) reader.fail(one.name, lacks_option(made.method, *group, one.name));
    }
  }
  try {
    check_options(info, options);
  } catch (const Error& error) {
    reader.refuse(error);
  }
  const MethodOptions resolved = info.resolved(options);
  for (const OptionGroup* group : info.option_groups()) put_options(reader, *group, resolved, effective);
}

/// What stands around the method, from the inside out.
void read_decorators(TableReader& integrator, const Parts& parts, SceneIntegrator& made, SceneValue& effective) {
  const SceneContext& context = integrator.context();
  SceneValue::Array list;
  for (const SceneValue* table : tables_of(integrator, "decorator")) {
    if (parts.decorators().empty()) {
      integrator.fail(table, "decorator", "this program knows no decorators; its `parts.add_decorator` adds them");
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
  }
  if (!list.empty()) effective.put("decorator", SceneValue::of(std::move(list)));
}

/// A step as scenes of these units write it.
std::string example_step(const UnitSystem& units) {
  const std::string unit = unit_of(dimensions::time, units);
  return unit == "1" ? "0.01" : unit == "ps" ? "\"1 fs\"" : "\"1 " + unit + "\"";
}

void read_step(TableReader& reader, SceneIntegrator& made, SceneValue& effective) {
  const SceneValue* step = reader.find("step");
  if (step == nullptr && made.adaptive()) return;
  if (step == nullptr) {
    reader.fail(nullptr, "step",
                fmt::format("[integrator] has no step; give one, such as {}", example_step(*reader.context().units)));
  }
  made.step = reader.number(*step, "step", "time");
  made.step_text = to_text(*step);
  if (made.step == 0)
    reader.fail("step", fmt::format("a step of {} is no step; a time other than 0 is expected", made.step_text));
  if (made.adaptive()) made.classical->options.first = std::abs(made.step);
  effective.put("step", *step);
}

void read_end(TableReader& reader, SceneIntegrator& made, SceneValue& effective) {
  const SceneValue* until = reader.find("until");
  if (until != nullptr && reader.has("steps")) {
    reader.fail(until, "until", "until and steps stand both in [integrator]; give one of them");
  }
  if (until != nullptr && made.adaptive()) {
    made.until = reader.number(*until, "until", "time");
    if (*made.until == 0) {
      reader.fail("until", fmt::format("until = {} is no time ahead; give a time above 0, or one below 0 to go back",
                                       to_text(*until)));
    }
    if (made.step != 0 && (*made.until > 0) != (made.step > 0)) {
      const std::string_view side = made.step > 0 ? "above" : "below", other = made.step > 0 ? "below" : "above";
      reader.fail("until", fmt::format("until = {} lies the other way; the first step is {}, so give a time {} 0, or a "
                                       "first step {} 0",
                                       to_text(*until), made.step_text, side, other));
    }
  } else if (until != nullptr) {
    made.steps = whole_steps(reader, "until", *until, made);
  }
  if (until != nullptr) effective.put("until", *until);
  if (reader.has("steps")) made.steps = reader.integer("steps");
  if (made.steps && *made.steps < 0)
    reader.fail("steps", fmt::format("steps = {} is negative; 0 or more is expected", *made.steps));
  if (reader.has("steps")) effective.put("steps", SceneValue::of(*made.steps));
}

double wall_seconds(const TableReader& reader, const SceneValue& wall) {
  const std::string* text = wall.get<std::string>();
  if (text == nullptr) reader.wrong_kind(wall, "wall", "a time in quotes, such as \"5 min\"");
  double seconds = 0;
  try {
    seconds = parse_quantity(*text, dimensions::time, unit_system("si"));
  } catch (const Error& error) {
    reader.fail(&wall, "wall", fmt::format("wall: {}", error.message()));
  }
  if (!(seconds > 0)) reader.fail(&wall, "wall", fmt::format("wall = \"{}\" is no time ahead", *text));
  return seconds;
}

/// A misspelt key is told before a missing one.
void know_keys(TableReader& reader, const Parts& parts) {
  for (const char* key : {"method", "step", "until", "steps", "decorator"}) reader.find(key);
  for_each_field<CompositionOptions>([&](const auto& field) { reader.find(field.name); });
  for (const OptionGroup* group : parts.method_options()) {
    for (const OptionValue& one : group->values({})) reader.find(one.name);
  }
  reader.finish();
}

}  // namespace

SceneIntegrator read_integrator(const SceneContext& context, const SceneValue& table, const Parts& parts,
                                bool constrained, SceneValue& effective) {
  SceneIntegrator made;
  TableReader reader(context, table, "[integrator]", "integrator");
  know_keys(reader, parts);
  read_method(reader, parts, made);
  effective.put("method", SceneValue::of(made.method, reader.line("method")));
  SceneValue options = SceneValue::table();
  if (made.classical) read_method_options(reader, parts, made, constrained, options);
  read_step(reader, made, effective);
  read_end(reader, made, effective);
  if (!made.classical) read_scheme_options(reader, parts, made, constrained, options);
  for (auto& [key, value] : *options.get<SceneValue::Table>()) effective.put(key, value);
  read_decorators(reader, parts, made, effective);
  return made;
}

Cadence read_cadence(TableReader& reader, bool may_be_wall, const SceneIntegrator& integrator, SceneValue& effective) {
  const SceneValue *every = reader.find("every"), *steps = reader.find("steps");
  const SceneValue* wall = may_be_wall ? reader.find("wall") : nullptr;
  const int given = (every != nullptr) + (steps != nullptr) + (wall != nullptr);
  const std::string_view choices = may_be_wall ? "every, steps or wall" : "every or steps";
  if (given == 0) reader.fail(nullptr, "steps", fmt::format("{} does not say when; give {}", reader.what(), choices));
  if (given > 1)
    reader.fail(every != nullptr ? every : wall, every != nullptr ? "every" : "wall",
                fmt::format("{} says twice when; give one of {}", reader.what(), choices));
  Cadence cadence;
  if (every != nullptr && integrator.adaptive()) {
    cadence.interval = reader.number(*every, "every", "time");
    const bool forward = integrator.direction() == Direction::forward;
    if (cadence.interval == 0) reader.fail("every", fmt::format("every = {} is no time ahead", to_text(*every)));
    if ((cadence.interval > 0) != forward) {
      reader.fail("every", fmt::format("every = {} lies the other way; the run goes {} in time, so give a time {} 0",
                                       to_text(*every), forward ? "forward" : "back", forward ? "above" : "below"));
    }
  } else if (every != nullptr) {
    cadence.steps = whole_steps(reader, "every", *every, integrator);
  }
  if (steps != nullptr) cadence.steps = counted_steps(reader, "steps");
  if (wall != nullptr) cadence.wall = wall_seconds(reader, *wall);
  if (every != nullptr) effective.put("every", *every);
  if (steps != nullptr) effective.put("steps", SceneValue::of(cadence.steps, reader.line("steps")));
  if (wall != nullptr) effective.put("wall", *wall);
  return cadence;
}

}  // namespace noether
