#include "numbers/progress.hpp"

#include "numbers/text.hpp"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace noether {

std::string spoken_duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  if (seconds < 360'000) return fmt::format("{:.1f} h", seconds / 3600);
  return fmt::format("{:.0f} days", seconds / 86400);
}

std::string progress_bar(double share, std::size_t width) {
  const double known = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0;
  const auto full = static_cast<std::size_t>(std::lround(known * static_cast<double>(width)));
  return "[" + std::string(full, '#') + std::string(width - full, '-') + "]";
}

std::string progress_text(const Share& share, double seconds) {
  if (share.rows == 0) return share.what;
  const double done = std::isfinite(share.done) ? std::clamp(share.done, 0.0, 1.0) : 0;
  const std::string row = share.row > 0 ? fmt::format("{} of {}  ", share.row, share.rows) : "";
  std::string line = fmt::format("{} {:3.0f} %  {}{}", progress_bar(done), 100 * done, row, share.what);
  if (share.row > 0 && done > 0 && seconds > 0)
    line += fmt::format("  {} left", spoken_duration(seconds / done * (1 - done)));
  return line;
}

TerminalLine::TerminalLine(bool wanted) : shows_(wanted && ::isatty(STDERR_FILENO) == 1) {}

TerminalLine::~TerminalLine() { clear(); }

std::size_t TerminalLine::room() const {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col - 1U : 79U;
}

void TerminalLine::show(std::string_view text) {
  if (!shows_) return;
  shown_ = true;
  fmt::print(stderr, "\r\033[K{}", first_characters(text, room()));
  std::fflush(stderr);
}

void TerminalLine::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

TellShare TerminalLine::teller() {
  if (!shows_) return {};
  return [this](const Share& share) {
    const auto now = std::chrono::steady_clock::now();
    if (share.row > 0 && !counting_) begin_ = now;
    counting_ = share.row > 0;
    if (shown_ && (counting_ || share.done > 0) && std::chrono::duration<double>(now - last_).count() < 0.1) return;
    last_ = now;
    show(progress_text(share, std::chrono::duration<double>(now - begin_).count()));
  };
}

}  // namespace noether
