#include "scene/progress_line.hpp"

#include "monitors/monitors.hpp"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

namespace noether {

namespace {

std::string duration_text(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  if (seconds < 360'000) return fmt::format("{:.1f} h", seconds / 3600);
  return fmt::format("{:.0f} days", seconds / 86400);
}

/// A rate in three digits: "850", "12.3k", "1.2M".
std::string rate_text(double rate) {
  for (const auto& [size, letter] : {std::pair{1e9, "G"}, std::pair{1e6, "M"}, std::pair{1e3, "k"}}) {
    if (rate >= 0.9995 * size) return fmt::format("{:.3g}{}", rate / size, letter);
  }
  return fmt::format("{:.3g}", rate);
}

std::string bar_text(double share, std::size_t columns) {
  const auto done = static_cast<std::size_t>(std::lround(share * static_cast<double>(columns)));
  return "[" + std::string(done, '#') + std::string(columns - done, '-') + "]";
}

std::size_t terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string progress_text(const ProgressState& state, std::size_t columns) {
  constexpr std::size_t shortest_bar = 8, longest_bar = 40;
  const double share = std::isfinite(state.share) ? std::clamp(state.share, 0.0, 1.0) : 0;
  std::string text = fmt::format(" {:4.1f} %", 100 * share);
  std::vector<std::string> parts = {fmt::format("time {:>9.4g}{}{}", state.time, state.time_unit == "1" ? "" : " ",
                                                state.time_unit == "1" ? "" : state.time_unit)};
  if (state.seconds_left) parts.push_back(duration_text(*state.seconds_left) + " left");
  if (state.energy_error) parts.push_back(fmt::format("dE/E {:.0e}", *state.energy_error));
  if (state.rate > 0) parts.push_back(rate_text(state.rate) + " steps/s");
  const std::size_t room = columns > shortest_bar + 2 ? columns - shortest_bar - 2 : 0;
  for (const std::string& part : parts) {
    if (text.size() + 2 + part.size() > room) break;
    text += "  " + part;
  }
  const std::size_t left = columns > text.size() + 2 ? columns - text.size() - 2 : 0;
  return (bar_text(share, std::min(left, longest_bar)) + text).substr(0, columns);
}

ProgressLine::ProgressLine(bool wanted) : shows_(wanted && ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::attach(Simulation<double>& sim, double begin, std::string_view time_unit) {
  if (!shows_) return;
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
    show(state);
  });
}

void ProgressLine::show(const ProgressState& state) {
  shown_ = true;
  fmt::print(stderr, "\r\033[K{}", progress_text(state, terminal_columns() - 1));  // the last column may wrap
  std::fflush(stderr);
}

}  // namespace noether
