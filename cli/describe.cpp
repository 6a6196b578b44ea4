#include "cli/commands.hpp"

#include "cli/describe_all.hpp"
#include "cli/described_parts.hpp"
#include "cli/method_text.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition_options.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"
#include "numbers/text.hpp"
#include "scene/foreign_names.hpp"
#include "scene/parts.hpp"
#include "scene/read_options.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

namespace {

void print_fields(const std::vector<FieldInfo>& fields) {
  if (!fields.empty()) fmt::print("\n");
  for (const FieldInfo& f : fields) {
    std::string value = f.default_value.empty() ? "" : ", default " + f.default_value;
    if (!f.example.empty()) value = ", required, such as " + f.example;
    const std::string choices = f.choices.empty() ? "" : fmt::format(", one of {}", fmt::join(f.choices, ", "));
    fmt::print("  {:<14} {} [{}]{}{}{}{}\n", f.name, f.kind, f.dimension, choices, value, f.help.empty() ? "" : ": ",
               f.help);
  }
}

void describe_part(const std::string& kind, const PartInfo& info, bool json) {
  if (json) {
    fmt::print("{}\n", Json::object({{"schema", "noether.describe/1"},
                                     {"kind", kind},
                                     {"name", info.name},
                                     {"help", info.help},
                                     {"formula", info.formula},
                                     {"quantities", info.quantities},
                                     {"table", table_of(kind)},
                                     {"fields", json_of(info.fields)},
                                     {"columns", json_of(info.columns)},
                                     {"source", info.source},
                                     {"bibtex", entries_of(info.source)}})
                           .text());
    return;
  }
  fmt::print("{} ({}): {}\n", info.name, kind, info.help);
  if (!info.formula.empty()) fmt::print("\n    {}\n", info.formula);
  if (!info.quantities.empty()) fmt::print("\n  quantities: {}\n", info.quantities);
  if (const std::string table = table_of(kind); !table.empty()) fmt::print("\n  belongs in {}\n", table);
  print_fields(info.fields);
  if (!info.columns.empty()) fmt::print("\n  bodies take {}\n", fmt::join(texts_of(info.columns), ", "));
  const std::string entries = entries_of(info.source);
  if (!entries.empty()) fmt::print("\n{}", entries);
}

std::string word_text(const Word& word) {
  std::string text;
  for (const Stage& stage : word) {
    text += fmt::format("  {}  {:.17g}\n", stage.letter, static_cast<double>(stage.weight));
  }
  return text;
}

void describe_scheme(const Scheme& scheme, bool json) {
  const std::vector<std::string> aliases = schemes::aliases_of(scheme);
  const auto orders = scheme.order.near_integrable;
  if (json) {
    std::vector<Json> stages;
    for (const Stage& stage : scheme.word) {
      stages.push_back(Json::list({std::string(1, stage.letter), static_cast<double>(stage.weight)}));
    }
    fmt::print("{}\n",
               Json::object({{"schema", "noether.describe/1"},
                             {"kind", "method"},
                             {"name", scheme.name},
                             {"help", scheme.summary},
                             {"aliases", Json::list_of(aliases)},
                             {"order", scheme.order.classical},
                             {"near_integrable_orders", Json::list_of(orders)},
                             {"kicks", scheme.evaluations()},
                             {"symmetric", scheme.is_symmetric()},
                             {"stability_limit", scheme.stability_limit > 0 ? Json(scheme.stability_limit) : Json()},
                             {"word", Json::list(stages)},
                             {"fields", json_of(part_info<CompositionOptions>().fields)},
                             {"source", scheme.source},
                             {"bibtex", entries_of(scheme.source)}})
                   .text());
    return;
  }
  fmt::print("{} (method): {}\n", scheme.name, scheme.summary);
  if (!aliases.empty()) fmt::print("also called {}\n", fmt::join(aliases, ", "));
  fmt::print("\n  order {}, {} per step, {}\n", scheme.order.classical, counted(scheme.evaluations(), "kick"),
             scheme.is_symmetric() ? "symmetric" : "not symmetric");
  if (orders[0] != 0) fmt::print("  for H = A + eps B: error orders {}\n", fmt::join(orders, ", "));
  if (scheme.scheme_class == SchemeClass::rkn) {
    fmt::print("  a Nystroem splitting: for quadratic kinetic energies only\n");
  }
  if (!scheme.exact.empty() && !scheme.is_composition()) fmt::print("  needs exact flows of {}\n", scheme.exact);
  if (scheme.stability_limit > 0)
    fmt::print("  stable on the oscillator up to h omega = {:.6g}\n", scheme.stability_limit);
  fmt::print("\n{}", word_text(scheme.word));
  print_fields(part_info<CompositionOptions>().fields);
  const std::string entries = entries_of(scheme.source);
  if (!entries.empty()) fmt::print("\n{}", entries);
}

/// How a classical method takes its steps.
std::string steps_text(const MethodInfo& info) {
  const std::string tolerances = fmt::format("rtol {:g} by default, atol of a system {:g}", info.rtol, info.atol);
  if (info.adaptive && info.fixed) return "chooses its steps, " + tolerances + "; fixed ones with adaptive = false";
  return info.adaptive ? "chooses its steps, " + tolerances : "takes steps of one length";
}

/// What a classical method can step, as it says itself.
struct Served {
  std::string_view equation, in_words;
};

Served served_by(const MethodInfo& info, const MethodClaims& claims) {
  if (info.linear_only) {
    return {"Y' = A(t) Y on rotations", "it supports systems of matrices of rotations, and neither forces nor others"};
  }
  if (info.on_groups) {
    return {"y' = A(t, y) y on a Lie group",
            "it supports rigid bodies under all forces and systems on groups; where there is no group it is a "
            "Runge-Kutta method"};
  }
  if (claims.gravity_only) {
    return {"gravity of point masses",
            "it supports gravity without softening, and beside it forces that depend on positions and time"};
  }
  if (claims.conservative_only) {
    if (claims.second_order_only) return {"q'' = -M^-1 grad U(q)", "it supports forces that know their secants"};
    return {"y' = J grad H(y)", "it supports forces of an energy of positions alone, and Hamiltonian systems"};
  }
  if (claims.turns_only) {
    return {"q'' = a(t, q) + q' x rate(t, q)",
            "it supports all forces that do not depend on velocities, and magnetic fields, but no first-order system"};
  }
  if (claims.positions_only) {
    return {"q'' = a(t, q)",
            "it supports forces that depend on positions and time, but not on velocities, and no first-order system"};
  }
  if (claims.second_order_only) {
    return {"q'' = a(t, q, q')",
            "it supports all forces, also those that depend on velocities, but no first-order system"};
  }
  return {"y' = f(t, y)", "it supports all forces, also those that depend on velocities"};
}

/// What a method takes beside step and error control.
std::vector<std::string> own_keys(const MethodInfo& info) {
  std::vector<std::string> keys;
  for (const OptionGroup* group : info.option_groups()) {
    if (group == error_control) continue;
    for (const OptionValue& one : group->values({})) keys.emplace_back(one.name);
  }
  return keys;
}

void describe_method(const MethodInfo& info, bool json) {
  const Served served = served_by(info, info.make(info, {})->claims());
  const std::optional<GroupWork> work =
      info.group_work != nullptr ? std::optional(info.group_work(info, {})) : std::nullopt;
  const std::vector<std::string> aliases = methods::aliases_of(info);
  if (json) {
    fmt::print("{}\n", Json::object({{"schema", "noether.describe/1"},
                                     {"kind", "method"},
                                     {"name", info.name},
                                     {"help", info.summary},
                                     {"aliases", Json::list_of(aliases)},
                                     {"family", info.family},
                                     {"order", info.order},
                                     {"order_in_quad", order_in_quad(info)},
                                     {"serves", served.equation},
                                     {"evaluations", info.evaluations > 0 ? Json(info.evaluations) : Json()},
                                     {"group_work", work ? group_work_json(*work) : Json()},
                                     {"fixed", info.fixed},
                                     {"adaptive", info.adaptive},
                                     {"options", Json::list_of(own_keys(info))},
                                     {"fields", json_of(fields_of(info))},
                                     {"rtol", info.adaptive ? Json(info.rtol) : Json()},
                                     {"atol", info.adaptive ? Json(info.atol) : Json()},
                                     {"stability_limit", limit_json(info.stability_limit)},
                                     {"source", info.source},
                                     {"bibtex", entries_of(info.source)}})
                           .text());
    return;
  }
  fmt::print("{} (method): {}\n", info.name, info.summary);
  if (!aliases.empty()) fmt::print("also called {}\n", fmt::join(aliases, ", "));
  fmt::print("\n  order {}, {}\n  for {}: {}\n", order_text(info), steps_text(info), served.equation, served.in_words);
  if (info.evaluations > 0) {
    fmt::print("  {} {} per step of given length\n", info.evaluations,
               info.evaluations == 1 ? "evaluation" : "evaluations");
  }
  if (work) fmt::print("  {}{}\n", group_work_text(*work), dexp_text(info, {}));
  if (std::isinf(info.stability_limit)) {
    fmt::print("  stable on the oscillator at any step\n");
  } else if (info.stability_limit == 0) {
    fmt::print("  unstable on the oscillator at any step\n");
  } else if (info.stability_limit > 0) {
    fmt::print("  stable on the oscillator up to h omega = {:.6g}\n", info.stability_limit);
  }
  print_fields(fields_of(info));
  const std::string entries = entries_of(info.source);
  if (!entries.empty()) fmt::print("\n{}", entries);
}

void describe_unit(const UnitRow& row, bool json) {
  const Json::Members values = {
      {"solar", row.solar}, {"molecular", row.molecular}, {"si", row.si}, {"reduced", row.reduced}};
  if (json) {
    fmt::print("{}\n", Json::object({{"schema", "noether.describe/1"},
                                     {"kind", "unit"},
                                     {"name", row.symbol},
                                     {"constant", row.constant},
                                     {"dimension", row.dimension},
                                     {"values", Json::object(values)}})
                           .text());
    return;
  }
  fmt::print("{} (unit, {} in C++): {}\n", row.symbol, row.constant, row.dimension);
  for (const auto& [system, value] : values) {
    fmt::print("  {:<10} {}\n", system, value.text() == "null" ? "-" : value.text());
  }
}

void describe(const std::string& name, const Parts& parts, bool json) {
  std::vector<std::string> known;
  for (const auto& [kind, info] : described_parts(parts)) {
    if (info.name == name) return describe_part(kind, info, json);
    known.push_back(info.name);
  }
  if (const Scheme* scheme = schemes::find(name)) return describe_scheme(*scheme, json);
  if (const MethodInfo* info = parts.find_method(name)) return describe_method(*info, json);
  for (const UnitRow& row : list_units()) {
    if (row.symbol == name) return describe_unit(row, json);
  }
  const std::vector<std::string> methods_too = parts.method_names();
  known.insert(known.end(), methods_too.begin(), methods_too.end());
  throw Error(fmt::format("there is nothing called '{}'{}", name, proposal(name, known, "; see `noether list`")));
}

}  // namespace

void add_describe_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false), all = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("describe", "formula, order, fields and source of a part or method");
  CLI::Option* one = command->add_option("name", *name, "as `noether list` shows it")->type_name("NAME");
  command->add_flag("--all", *all, "every key of a scene, of its tables and of every part, as Markdown")->excludes(one);
  command->add_flag("--json", *json, "as one line of JSON");
  command->callback([name, json, all, &parts, &exit_code] {
    if (!*all && name->empty()) throw CLI::RequiredError("NAME or --all");
    if (*all) {
      describe_all(parts, *json);
    } else {
      describe(*name, parts, *json);
    }
    exit_code = 0;
  });
}

}  // namespace noether
