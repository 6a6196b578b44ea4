#include "scene/read_verdicts.hpp"

#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

namespace {

std::vector<std::string> texts(TableReader& reader, std::string_view key, std::string_view example) {
  std::vector<std::string> all;
  const SceneValue* value = reader.find(key);
  if (value == nullptr) return all;
  const auto* list = value->get<SceneValue::Array>();
  if (list == nullptr) reader.wrong_kind(*value, key, fmt::format("a list of texts, such as {},", example));
  for (const SceneValue& one : *list) {
    const std::string* text = one.get<std::string>();
    if (text == nullptr) reader.wrong_kind(*value, key, fmt::format("a list of texts, such as {},", example));
    all.push_back(*text);
  }
  return all;
}

std::optional<double> figure(TableReader& reader, std::string_view key) {
  const auto value = reader.quantity(key, "1");
  if (value && !(*value > 0)) {
    reader.fail(key, fmt::format("{} = {} is not a valid bound of an error; a number above 0 is expected", key,
                                 to_text(*reader.find(key))));
  }
  return value;
}

SceneVerdict read_verdict(const SceneContext& context, const SceneValue& table, std::size_t index) {
  const std::vector<std::string> outcomes = {"bounded", "unbounded", "solver", "theory"};
  TableReader reader(context, table, "[[verdict]]", fmt::format("verdict.{}", index));
  reader.expect_only({"methods", "set", "outcome", "energy_below", "energy_above", "sharing_below", "sharing_above",
                      "nightly", "why"});
  SceneVerdict one;
  const SceneValue* methods = reader.find("methods");
  one.every_method = methods != nullptr && methods->get<std::string>() != nullptr && reader.text("methods") == "all";
  if (!one.every_method) one.methods = texts(reader, "methods", "[\"verlet\"], or \"all\"");
  one.sets = texts(reader, "set", "[\"integrator.step=0.1\"]");
  one.outcome = reader.text("outcome", "bounded");
  if (std::find(outcomes.begin(), outcomes.end(), one.outcome) == outcomes.end()) {
    reader.fail("outcome", fmt::format("unknown outcome '{}'{}", one.outcome, did_you_mean(one.outcome, outcomes)));
  }
  one.energy_below = figure(reader, "energy_below");
  one.energy_above = figure(reader, "energy_above");
  one.sharing_below = figure(reader, "sharing_below");
  one.sharing_above = figure(reader, "sharing_above");
  one.nightly = reader.flag("nightly", false);
  one.why = reader.text("why");
  return one;
}

}  // namespace

std::vector<SceneVerdict> read_verdicts(const SceneContext& context, TableReader& top, std::vector<SceneError>& wrong) {
  std::vector<SceneVerdict> all;
  std::size_t index = 0;
  const auto keeping_faults = [&](const auto& read) {
    try {
      read();
    } catch (const SceneError& error) {
      wrong.push_back(error);
    }
  };
  keeping_faults([&] {
    for (const SceneValue* table : tables_of(top, "verdict")) {
      keeping_faults([&] { all.push_back(read_verdict(context, *table, index++)); });
    }
  });
  return all;
}

}  // namespace noether
