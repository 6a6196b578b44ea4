#include "cli/commands.hpp"

#include "cli/method_text.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/rotating.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"
#include "scene/json.hpp"
#include "scene/parts.hpp"
#include "scene/read_builder.hpp"
#include "study/frame_traits.hpp"
#include "study/methods_page.hpp"
#include "study/turning_traits.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

namespace {

/// A list: names of the columns, and rows of text for people or values for machines, which may have more columns.
struct Listing {
  std::vector<std::string_view> columns;
  std::vector<std::vector<Json>> values;
  std::vector<std::vector<std::string>> rows;

  void add(std::vector<std::string> texts, std::vector<Json> json) {
    rows.push_back(std::move(texts));
    values.push_back(std::move(json));
  }
  void add(const std::vector<std::string>& texts) { add(texts, std::vector<Json>(texts.begin(), texts.end())); }
};

std::string class_text(const Scheme& scheme) {
  if (scheme.scheme_class == SchemeClass::rkn) return "nystrom";
  return scheme.scheme_class == SchemeClass::near_integrable ? "near-integrable" : "general";
}

std::string order_text(const Order& order) {
  const auto [p1, p2, p3] = order.near_integrable;
  if (p1 == 0) return fmt::format("{}", order.classical);
  if (p2 == 0) return fmt::format("{} ({})", order.classical, p1);
  return p3 == 0 ? fmt::format("{} ({},{})", order.classical, p1, p2)
                 : fmt::format("{} ({},{},{})", order.classical, p1, p2, p3);
}

Listing methods(const Parts& parts) {
  Listing list{{"name", "order", "class", "evaluations", "stability_limit", "aliases", "kicks"}, {}, {}};
  for (const Scheme* scheme : schemes::all()) {
    const std::vector<std::string> aliases = schemes::aliases_of(*scheme);
    list.add({std::string(scheme->name), order_text(scheme->order), class_text(*scheme),
              fmt::format("{}", scheme->evaluations()), limit_text(scheme->stability_limit),
              fmt::format("{}", fmt::join(aliases, " "))},
             {scheme->name, scheme->order.classical, class_text(*scheme), scheme->evaluations(),
              limit_json(scheme->stability_limit), Json::list_of(aliases), scheme->evaluations()});
  }
  for (const MethodInfo* info : parts.methods()) {
    const std::vector<std::string> aliases = methods::aliases_of(*info);
    list.add({std::string(info->name), order_text(*info), std::string(info->family), evaluations_text(*info),
              limit_text(info->stability_limit), fmt::format("{}", fmt::join(aliases, " "))},
             {info->name, info->order, info->family, info->evaluations > 0 ? Json(info->evaluations) : Json(),
              limit_json(info->stability_limit), Json::list_of(aliases), Json()});
  }
  return list;
}

Listing listing_of_parts(const std::vector<PartInfo>& infos) {
  Listing list{{"name", "help"}, {}, {}};
  for (const PartInfo& info : infos) list.add({info.name, info.help});
  return list;
}

template <class Kinds> std::vector<PartInfo> infos_of(const Kinds& kinds) {
  std::vector<PartInfo> infos;
  for (const auto& kind : kinds) infos.push_back(kind.info);
  return infos;
}

Listing units() {
  Listing list{{"unit", "constant", "dimension", "solar", "molecular", "si", "reduced"}, {}, {}};
  for (const UnitRow& row : list_units()) {
    const auto text = [](const std::optional<double>& x) { return x ? format_number(*x) : std::string("-"); };
    list.add({row.symbol, row.constant.empty() ? "-" : row.constant, row.dimension, text(row.solar),
              text(row.molecular), text(row.si), text(row.reduced)},
             {row.symbol, row.constant, row.dimension, row.solar, row.molecular, row.si, row.reduced});
  }
  return list;
}

Listing monitors(const Parts& parts) {
  Listing list{{"name", "kind", "help"}, {}, {}};
  for (const PartInfo& info : infos_of(parts.monitors())) list.add({info.name, "monitor", info.help});
  for (const PartInfo& info : writer_parts()) list.add({info.name, "writer", info.help});
  for (const PartInfo& info : infos_of(parts.stops())) list.add({info.name, "stop", info.help});
  return list;
}

struct NamedListing {
  std::string_view name;
  Listing (*make)(const Parts&);
};

/// A list of one kind of parts.
template <auto kinds> Listing parts_of(const Parts& parts) { return listing_of_parts(infos_of((parts.*kinds)())); }

/// Forces alone, or the fields of charges among them.
template <bool fields> Listing forces(const Parts& parts) {
  std::vector<PartInfo> infos;
  for (const Parts::ForceKind& kind : parts.forces()) {
    if (kind.field == fields) infos.push_back(kind.info);
  }
  return listing_of_parts(infos);
}

constexpr std::array<NamedListing, 11> listings = {{
    {"methods", methods},
    {"hamiltonians", parts_of<&Parts::hamiltonians>},
    {"forces", forces<false>},
    {"fields", forces<true>},
    {"thermostats", parts_of<&Parts::thermostats>},
    {"constraints", parts_of<&Parts::constraints>},
    {"systems", parts_of<&Parts::systems>},
    {"decorators", parts_of<&Parts::decorators>},
    {"monitors", monitors},
    {"builders", [](const Parts&) { return listing_of_parts(infos_of(builders())); }},
    {"units", [](const Parts&) { return units(); }},
}};

std::vector<std::string> names_of_listings() {
  std::vector<std::string> names;
  for (const NamedListing& listing : listings) names.emplace_back(listing.name);
  return names;
}

Listing listing_of(const std::string& what, const Parts& parts) {
  const auto found = std::find_if(listings.begin(), listings.end(), [&](const auto& one) { return one.name == what; });
  if (found != listings.end()) return found->make(parts);
  throw Error(fmt::format("there is no list of '{}'{}", what, did_you_mean(what, names_of_listings())));
}

void print_json(const std::string& what, const Listing& list) {
  std::vector<Json> items;
  for (const auto& row : list.values) {
    Json::Members members;
    for (std::size_t k = 0; k < row.size(); ++k) members.emplace_back(list.columns[k], row[k]);
    items.push_back(Json::object(members));
  }
  fmt::print("{}\n", Json::object({{"schema", "noether.list/1"}, {"list", what}, {"items", Json::list(items)}}).text());
}

void print_text(const std::string& what, const Listing& list) {
  if (list.rows.empty()) {
    fmt::print("this program has no {}\n", what);
    return;
  }
  std::vector<std::vector<std::string>> rows = list.rows;
  const auto shown = static_cast<std::ptrdiff_t>(list.rows[0].size());
  rows.insert(rows.begin(), std::vector<std::string>(list.columns.begin(), list.columns.begin() + shown));
  std::vector<std::size_t> widths(list.columns.size(), 0);
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) line += fmt::format("{:<{}}  ", row[k], widths[k]);
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

Json traits_json(const MethodTraits& traits) {
  const double limit = traits.stability_limit.value_or(0);
  const Json stable = !traits.stability_limit ? Json() : std::isinf(limit) ? Json("always") : Json(limit);
  return Json::object({{"order", traits.order},
                       {"evaluations", traits.evaluations},
                       {"symplectic", traits.symplectic},
                       {"reversible", traits.reversible},
                       {"momentum", traits.momentum},
                       {"angular_momentum", traits.angular_momentum},
                       {"energy", text_of(traits.energy)},
                       {"fixed_steps", traits.fixed_steps},
                       {"own_steps", traits.own_steps},
                       {"stability_limit", stable}});
}

/// docs/methods.md, or its cells for machines.
void print_measured(bool json) {
  std::vector<MeasuredMethod> methods_measured;
  for (const KnownMethod& known : all_known_methods()) methods_measured.push_back(measured_method(known));
  const std::vector<MeasuredFrames> frames = measured_frames();
  const std::vector<MeasuredTurns> turns = measured_turns();
  if (!json) {
    fmt::print("{}{}{}", methods_page(methods_measured), frames_section(frames), turning_section(turns));
    return;
  }
  std::vector<Json> items;
  for (const MeasuredMethod& method : methods_measured) {
    items.push_back(Json::object({{"name", method.name},
                                  {"family", method.family},
                                  {"use", method.use},
                                  {"measured", traits_json(method.measured)},
                                  {"claimed", traits_json(method.claimed)},
                                  {"differences", Json::list_of(method.differences())}}));
  }
  std::vector<Json> rotating;
  for (const MeasuredFrames& one : frames) {
    rotating.push_back(Json::object({{"method", one.method},
                                     {"order", one.order},
                                     {"claimed_order", one.claimed_order},
                                     {"evaluations", one.evaluations},
                                     {"exponentials", one.work.exponentials},
                                     {"commutators", one.work.commutators},
                                     {"reversible", one.reversible},
                                     {"defect", one.defect},
                                     {"error", one.error}}));
  }
  std::vector<Json> turning;
  for (const MeasuredTurns& one : turns) {
    turning.push_back(Json::object({{"method", one.method},
                                    {"rotor", one.turns()},
                                    {"order", one.order},
                                    {"claimed_order", one.claimed_order},
                                    {"kicks", one.kicks},
                                    {"error", one.error}}));
  }
  fmt::print("{}\n", Json::object({{"schema", "noether.list/1"},
                                   {"list", "methods"},
                                   {"items", Json::list(items)},
                                   {"frames", Json::list(rotating)},
                                   {"turns", Json::list(turning)}})
                         .text());
}

}  // namespace

void add_list_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto what = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  const std::string names = fmt::format("{}", fmt::join(names_of_listings(), ", "));
  CLI::App* command = app.add_subcommand("list", "what there is: " + names);
  command->add_option("what", *what, "one of: " + names)->required()->type_name("WHAT");
  command->add_flag("--json", *json, "as one line of JSON");
  const auto measured = std::make_shared<bool>(false);
  command->add_flag("--measured", *measured, "methods: what each of them does when it is run, as docs/methods.md");
  command->callback([what, json, measured, &parts, &exit_code] {
    exit_code = 0;
    if (*measured) {
      if (*what != "methods")
        throw Error(fmt::format("only methods are measured, not {}; leave --measured out", *what));
      return print_measured(*json);
    }
    const Listing list = listing_of(*what, parts);
    if (*json) {
      print_json(*what, list);
    } else {
      print_text(*what, list);
    }
  });
}

}  // namespace noether
