/// noether frequencies: the quasi-periodic terms of orbital elements that a run has stored.

#include "study/frequencies.hpp"
#include "cli/commands.hpp"
#include "engine/orbital_elements.hpp"
#include "io/frames.hpp"
#include "io/inspect.hpp"
#include "numbers/suggest.hpp"
#include "numbers/units.hpp"
#include "scene/json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace noether {

namespace {

constexpr double full_circle = 2 * std::numbers::pi, arcsecond = full_circle / 1'296'000;
constexpr std::size_t element_columns = 6;

struct FrequencyArguments {
  std::string file, monitor = "elements", signal = "eccentricity";
  std::vector<std::string> bodies;
  std::size_t terms = 6;
  int window = 1, sweeps = 2;
  bool diffusion = false, json = false;
};

/// A signal made of the elements of a body.
std::complex<double> signal_of(const std::string& kind, const double* o) {
  const double e = o[1], inc = o[2], node = o[3], pericenter = o[3] + o[4], longitude = o[3] + o[4] + o[5];
  if (kind == "inclination") return std::polar(1.0, node) * std::sin(inc / 2);
  if (kind == "longitude") return std::polar(1.0, longitude) * o[0];
  return std::polar(1.0, pericenter) * e;
}

/// The distance in time of samples.
/// @throws Error  where it is not always the same
double even_step(const io::MonitorSeries& monitor) {
  const std::vector<double>& t = monitor.time;
  if (t.size() < 2)
    throw Error(fmt::format("monitor '{}' has {} samples, which do not determine a frequency", monitor.name, t.size()));
  const double step = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  for (std::size_t k = 0; k < t.size(); ++k) {
    if (std::abs(t.front() + step * static_cast<double>(k) - t[k]) < 1e-6 * std::abs(step)) continue;
    throw Error(
        fmt::format("monitor '{}' has looked at times that are not at equal distances; give it a cadence in "
                    "steps",
                    monitor.name));
  }
  return step;
}

Json json_of(const FrequencyTerm& term) {
  return Json::object({{"frequency", term.frequency}, {"amplitude", term.amplitude}, {"phase", term.phase}});
}

void print_terms(const std::string& name, const std::vector<FrequencyTerm>& terms, const std::string& unit,
                 double year) {
  fmt::print("{}\n", name);
  const bool years = year > 0;
  fmt::print("  {:>22} {:>14} {:>14} {:>10}\n", years ? "frequency [arcsec/yr]" : "frequency [rad/" + unit + "]",
             years ? "period [yr]" : "period [" + unit + "]", "amplitude", "phase [deg]");
  for (const FrequencyTerm& one : terms) {
    const double frequency = years ? one.frequency * year / arcsecond : one.frequency;
    const double period = full_circle / std::abs(one.frequency) / (years ? year : 1);
    fmt::print("  {:>22.8f} {:>14.6g} {:>14.6e} {:>10.3f}\n", frequency, period, one.amplitude,
               one.phase * 360 / full_circle);
  }
}

void frequencies(const FrequencyArguments& given) {
  const std::vector<io::MonitorSeries> all =
      io::read_monitors(given.file, {.wanted = [&](const std::string& monitor, const std::string& quantity) {
                          return monitor == given.monitor && quantity == "value";
                        }});
  if (all.empty()) {
    std::vector<std::string> names;
    for (const io::MonitorSummary& one : io::info(given.file).monitors) names.push_back(one.name);
    throw Error(fmt::format("{} has no monitor '{}'{}; a scene has elements by [[every]] type = \"elements\"",
                            given.file, given.monitor, did_you_mean(given.monitor, names)));
  }
  const io::MonitorSeries& monitor = all.front();
  const auto& [shape, values] = monitor.quantities.at("value");
  if (shape.size() != 2 || shape[1] != static_cast<Index>(element_columns))
    throw Error(
        fmt::format("monitor '{}' has no orbital elements; give --of a monitor of the type elements", given.monitor));
  const auto count = static_cast<std::size_t>(shape[0]);
  std::vector<std::string> names = io::read_frames(given.file).names;
  for (std::size_t i = names.size(); i < count; ++i) names.push_back(fmt::format("body {}", i));
  std::vector<std::size_t> chosen;
  for (const std::string& name : given.bodies) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw Error(fmt::format("--body {} is not in the file{}", name, did_you_mean(name, names)));
    chosen.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  const bool every = chosen.empty();
  for (std::size_t i = 0; every && i < count; ++i) {
    if (std::isfinite(values[element_columns * i])) chosen.push_back(i);  // not the primary
  }
  const double step = even_step(monitor), start = monitor.time.front();
  const auto found_unit = monitor.units.find("time");
  const std::string unit = found_unit == monitor.units.end() ? "1" : found_unit->second;
  const double year = unit == "day" ? 365.25 : unit == "s" ? 365.25 * 86400 : 0;
  const FrequencyOptions options{.terms = given.terms, .window = given.window, .sweeps = given.sweeps};
  std::vector<Json> rows;
  if (!given.json)
    fmt::print("{} of {}: {} samples over {:.6g} {}\n", given.signal, given.monitor, monitor.time.size(),
               std::abs(step) * static_cast<double>(monitor.time.size() - 1) / (year > 0 ? year : 1),
               year > 0 ? "yr" : unit);
  for (const std::size_t body : chosen) {
    std::vector<std::complex<double>> signal;
    for (std::size_t k = 0; k < monitor.time.size(); ++k)
      signal.push_back(signal_of(given.signal, values.data() + (k * count + body) * element_columns));
    Json::Members row = {{"body", names[body]}};
    std::vector<Json> terms, changes;
    const std::vector<FrequencyTerm> found = frequency_terms(signal, start, step, options);
    for (const FrequencyTerm& one : found) terms.push_back(json_of(one));
    row.emplace_back("terms", Json::list(terms));
    if (!given.json) print_terms(names[body], found, unit, year);
    if (given.diffusion) {
      for (const FrequencyChange& one : frequency_changes(signal, start, step, options)) {
        changes.push_back(Json::object(
            {{"first", one.first.frequency}, {"second", one.second.frequency}, {"diffusion", one.diffusion()}}));
        if (!given.json) {
          const double scale = year > 0 ? year / arcsecond : 1;
          fmt::print("  halves: {:.8f} and {:.8f}, log10 |1 - nu2/nu1| = {:.2f}\n", one.first.frequency * scale,
                     one.second.frequency * scale, one.diffusion());
        }
      }
      row.emplace_back("halves", Json::list(changes));
    }
    rows.push_back(Json::object(row));
  }
  if (!given.json) return;
  fmt::print("{}\n", Json::object({{"schema", "noether.frequencies/1"},
                                   {"file", given.file},
                                   {"signal", given.signal},
                                   {"samples", static_cast<std::int64_t>(monitor.time.size())},
                                   {"unit", "rad/" + unit},
                                   {"rows", Json::list(rows)}})
                         .text());
}

}  // namespace

void add_frequencies_command(CLI::App& app, const Parts& /*parts*/, int& exit_code) {
  CLI::App* command = app.add_subcommand("frequencies", "secular frequencies of a run, by frequency analysis");
  const auto given = std::make_shared<FrequencyArguments>();
  command->add_option("FILE", given->file, "a run.h5 with the monitor elements")->required()->type_name("");
  command->add_option("--of", given->monitor, "which monitor of elements; default: elements")->type_name("MONITOR");
  command
      ->add_option("--signal", given->signal,
                   "eccentricity: e exp(i varpi); inclination: sin(inc/2) exp(i Omega); longitude: a exp(i lambda)")
      ->check(CLI::IsMember({"eccentricity", "inclination", "longitude"}))
      ->type_name("NAME");
  command->add_option("--body", given->bodies, "names of bodies; default: all")->delimiter(',')->type_name("NAME,...");
  command->add_option("--terms", given->terms, "how many terms of each")->check(CLI::Range(1, 100))->type_name("N");
  command->add_option("--window", given->window, "power of Hann's window")->check(CLI::Range(1, 8))->type_name("P");
  command->add_flag("--diffusion", given->diffusion, "compare the two halves of the run");
  command->add_flag("--json", given->json, "as one line of JSON");
  command->callback([given, &exit_code] {
    frequencies(*given);
    exit_code = 0;
  });
}

}  // namespace noether
