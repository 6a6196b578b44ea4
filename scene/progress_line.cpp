#include "scene/progress_line.hpp"

#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace noether {

namespace {

/// A rate in three digits: "850", "12.3k", "1.2M".
std::string rate_text(double rate) {
  for (const auto& [size, letter] : {std::pair{1e9, "G"}, std::pair{1e6, "M"}, std::pair{1e3, "k"}}) {
    if (rate >= 0.9995 * size) return fmt::format("{:.3g}{}", rate / size, letter);
  }
  return fmt::format("{:.3g}", rate);
}

}  // namespace

std::string progress_text(const ProgressState& state, std::size_t columns) {
  constexpr std::size_t shortest_bar = 8, longest_bar = 40;
  const double share = std::isfinite(state.share) ? std::clamp(state.share, 0.0, 1.0) : 0;
  std::string text = fmt::format(" {:4.1f} %", 100 * share);
  std::vector<std::string> parts = {fmt::format("time {:>9.4g}{}{}", state.time, state.time_unit == "1" ? "" : " ",
                                                state.time_unit == "1" ? "" : state.time_unit)};
  if (state.seconds_left) parts.push_back(spoken_duration(*state.seconds_left) + " left");
  if (state.energy_error) parts.push_back(fmt::format("dE/E {:.0e}", *state.energy_error));
  if (state.rate > 0) parts.push_back(rate_text(state.rate) + " steps/s");
  const std::size_t room = columns > shortest_bar + 2 ? columns - shortest_bar - 2 : 0;
  for (const std::string& part : parts) {
    if (text.size() + 2 + part.size() > room) break;
    text += "  " + part;
  }
  const std::size_t left = columns > text.size() + 2 ? columns - text.size() - 2 : 0;
  return (progress_bar(share, std::min(left, longest_bar)) + text).substr(0, columns);
}

void ProgressLine::attach(Simulation<double>& sim, double begin, std::string_view time_unit) {
  if (!line_.shows()) return;
  const Energy* energy = nullptr;
  sim.for_each_monitor([&](const std::string&, AnyMonitor<double>& monitor) {
    if (auto* found = monitor.get<Energy>()) energy = found;
  });
  const std::int64_t first = sim.step();
  const double from = sim.time();
  sim.on_progress([=, this](const Progress& now) {
    const auto made = static_cast<double>(now.step - first);
    const bool in_time = std::isfinite(now.until);
    const double done = in_time ? now.time - begin : static_cast<double>(now.step);
    const double end = in_time ? now.until - begin : static_cast<double>(now.end);
    const double gone = in_time ? now.time - from : made;
    ProgressState state;
    state.share = done / end;
    state.time = now.time;
    state.time_unit = time_unit;
    if (now.seconds > 0) state.rate = made / now.seconds;
    if (gone != 0) state.seconds_left = (end - done) / gone * now.seconds;
    if (energy != nullptr && std::isfinite(energy->worst())) state.energy_error = energy->worst();
    line_.show(progress_text(state, line_.room()));
  });
}

}  // namespace noether
