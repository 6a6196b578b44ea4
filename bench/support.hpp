#pragma once
/// What the benchmarks share: timing by medians, and rows for people or, with --json, one object a line.

#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "numbers/version.hpp"
#include "scene/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

namespace noether::bench {

/// Median and median absolute deviation of repeated measurements.
struct Measured {
  double median = 0, mad = 0;
  int repeats = 0;

  explicit Measured(std::vector<double> values) : median(middle(values)), repeats(static_cast<int>(values.size())) {
    for (double& value : values) value = std::abs(value - median);
    mad = middle(values);
  }

 private:
  static double middle(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
  }
};

/// Memory of this process that is really there.
inline double resident_bytes() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Seconds of one call.
template <class Work> double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Processor seconds that this thread spends on one call: what other programs take does not count.
template <class Work> double processor_seconds_of(const Work& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

/// How many times as quick threads are as one: medians of pairs. One thread is left to work.
/// @param seconds  of one piece of work, by the clock
template <class Seconds> Measured times_as_quick(int threads, const Seconds& seconds) {
  std::vector<double> times;
  for (int k = 0; k < 7; ++k) {
    set_thread_count(1);
    const double alone = seconds();
    set_thread_count(threads);
    times.push_back(alone / seconds());
  }
  set_thread_count(1);
  return Measured(times);
}

/// The processor's name.
inline std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

/// Another program, measured in the same run.
struct Peer {
  std::string name, version;
  double value = 0;
};

/// Prints the rows of one benchmark.
class Rows {
 public:
  /// @param parts  of which arguments may name some; another argument ends the program
  Rows(std::string bench, int count, char** arguments, const std::vector<std::string>& parts = {})
      : bench_(std::move(bench)) {
    for (const std::string argument : std::vector<const char*>(arguments + 1, arguments + count)) {
      if (argument == "--json") {
        json_ = true;
      } else if (std::find(parts.begin(), parts.end(), argument) != parts.end()) {
        wanted_.push_back(argument);
      } else {
        fmt::print(stderr, "{} has no part '{}'; it has: {}\n", bench_, argument, fmt::join(parts, ", "));
        std::exit(2);
      }
    }
    if (!json_) fmt::print("{} on {}, SIMD level {}\n", bench_, processor(), name(simd_level()));
  }

  /// Whether a part of the benchmark is to run: all are, unless arguments name some.
  bool wants(std::string_view part) const {
    return wanted_.empty() || std::find(wanted_.begin(), wanted_.end(), part) != wanted_.end();
  }

  void add(const std::string& one_case, const std::string& metric, const Measured& value, const std::string& unit,
           Index n, const std::optional<Peer>& peer = {}) const {
    if (json_) {
      fmt::print("{}\n", Json::object({{"bench", bench_},
                                       {"case", one_case},
                                       {"metric", metric},
                                       {"value", value.median},
                                       {"unit", unit},
                                       {"n", std::int64_t{n}},
                                       {"threads", std::int64_t{thread_count()}},
                                       {"simd", std::string(name(simd_level()))},
                                       {"repeats", std::int64_t{value.repeats}},
                                       {"mad", value.mad},
                                       {"peer", peer ? Json(peer->name) : Json()},
                                       {"peer_version", peer ? Json(peer->version) : Json()},
                                       {"peer_value", peer ? Json(peer->value) : Json()},
                                       {"ratio", peer ? Json(peer->value / value.median) : Json()},
                                       {"commit", std::string(commit())},
                                       {"cpu", processor()}})
                             .text());
    } else {
      fmt::print("{:<24} {:<22} n {:>7}  {} threads  {:<7}{:>10.4g} {} (+- {:.1g}, {} repeats)", one_case, metric, n,
                 thread_count(), name(simd_level()), value.median, unit, value.mad, value.repeats);
      if (peer) {
        fmt::print("; {} {}: {:.4g}, {:.3g} times as much", peer->name, peer->version, peer->value,
                   peer->value / value.median);
      }
      fmt::print("\n");
    }
  }

 private:
  std::string bench_;
  bool json_ = false;
  std::vector<std::string> wanted_;
};

}  // namespace noether::bench
