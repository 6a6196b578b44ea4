#include "integrators/all_methods.hpp"
#include "integrators/methods/average_field_4.hpp"
#include "integrators/methods/hbvm.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace noether {

namespace methods {

namespace {

/// K nodes, 0 for as many as rounding asks for, and S coefficients.
struct LineSize {
  int nodes = 0, coefficients = 0;
};

/// Of "hbvm_K_S" and "hbvm_S"; empty for other names.
std::optional<LineSize> line_size(std::string_view name) {
  constexpr std::string_view family = "hbvm_";
  if (!name.starts_with(family)) return {};
  std::array<int, 2> numbers{};
  std::size_t found = 0;
  const char *at = name.data() + family.size(), *const end = name.data() + name.size();
  for (; at < end && found < 2; ++found) {
    if (*at < '1' || *at > '9') return {};
    const auto read = std::from_chars(at, end, numbers[found]);
    if (read.ec != std::errc()) return {};
    at = read.ptr;
    if (at == end || found == 1) continue;
    if (*at != '_' || at + 1 == end) return {};
    ++at;
  }
  if (at != end) return {};
  return found == 1 ? LineSize{0, numbers[0]} : LineSize{numbers[0], numbers[1]};
}

template <class Real> std::unique_ptr<Method<Real>> make_hbvm(const MethodInfo& info, const MethodOptions& options) {
  const LineSize size = line_size(info.name).value_or(LineSize{0, 1});  // the average vector field
  return std::make_unique<Hbvm<Real>>(info, options, size.nodes, size.coefficients);
}

template <class Real> std::unique_ptr<Method<Real>> make_average(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<AverageField4<Real>>(info, options);
}

MethodInfo hbvm_info(std::string_view name, std::string_view summary, std::string_view use, int coefficients) {
  return {.name = name,
          .summary = summary,
          .use = use,
          .source = "BrugnanoIavernaroTrigiante2010",
          .family = "line integral",
          .options = {&own_options<LineInvariants>, linear_solver},
          .order = 2 * coefficients,
          .stability_limit = std::numeric_limits<double>::infinity(),
          .make = make_hbvm<double>,
          .make_quad = make_hbvm<Quad>};
}

MethodInfo average_vector_field() {
  MethodInfo info = hbvm_info("avf", "the average vector field: the energy to rounding at any step, order 2",
                              "an energy that must be the same at every step, where order 2 will do", 1);
  info.aliases = "hbvm_1";
  info.source = "QuispelMcLaren2008";
  return info;
}

MethodInfo average_vector_field_4() {
  return {
      .name = "avf_4",
      .summary = "the average vector field with a correction by second derivatives: the energy to rounding, order 4",
      .use = "comparisons; `hbvm_2` has the same order without second derivatives",
      .source = "QuispelMcLaren2008",
      .family = "line integral",
      .order = 4,
      .stability_limit = std::numeric_limits<double>::infinity(),
      .make = make_average<double>,
      .make_quad = make_average<Quad>};
}

void check_size(std::string_view name, const LineSize& size) {
  const int S = size.coefficients;
  if (S > lane_count) {
    throw Error(fmt::format("method '{}' has {} coefficients; up to {} are possible, order {}", name, S, lane_count,
                            2 * lane_count));
  }
  if (size.nodes > 64)
    throw Error(
        fmt::format("method '{}' has {} nodes; up to 64 are possible, as in 'hbvm_64_{}'", name, size.nodes, S));
  if (size.nodes != 0 && size.nodes < S) {
    throw Error(
        fmt::format("method '{}' has {} nodes for {} coefficients; at least as many nodes are expected, as in "
                    "'hbvm_{}_{}'",
                    name, size.nodes, S, 2 * S, S));
  }
}

}  // namespace

std::span<const MethodInfo> hbvm_list() {
  static const MethodInfo list[] = {
      average_vector_field(),
      average_vector_field_4(),
      hbvm_info(
          "hbvm_2", "HBVM of 2 coefficients, with as many nodes as rounding asks for",
          "an energy that must be the same at every step, at order 4; any S as in `hbvm_5`, any K as in `hbvm_4_2`", 2),
      hbvm_info("hbvm_3", "HBVM of 3 coefficients, with as many nodes as rounding asks for",
                "an energy that must be the same at every step, at order 6", 3),
      hbvm_info("hbvm_4", "HBVM of 4 coefficients, with as many nodes as rounding asks for",
                "an energy that must be the same at every step, at order 8", 4),
  };
  return list;
}

const MethodInfo* find_hbvm(std::string_view name) {
  const std::optional<LineSize> size = line_size(name);
  if (!size) return nullptr;
  check_size(name, *size);
  struct Named {
    std::string name, summary;
    MethodInfo info;
  };
  static std::mutex guard;
  static std::map<std::string, std::unique_ptr<Named>, std::less<>> known;
  const std::lock_guard lock(guard);
  auto& made = known[std::string(name)];
  if (!made) {
    made = std::make_unique<Named>();
    made->name = name;
    made->summary =
        size->nodes == 0
            ? fmt::format("HBVM of {} coefficients, with as many nodes as rounding asks for", size->coefficients)
            : fmt::format("HBVM of {} nodes and {} coefficients: exact for energies of degree {}", size->nodes,
                          size->coefficients, 2 * size->nodes / size->coefficients);
    made->info =
        hbvm_info(made->name, made->summary, "an energy that must be the same at every step", size->coefficients);
  }
  return &made->info;
}

}  // namespace methods

}  // namespace noether
