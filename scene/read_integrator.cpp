#include "scene/read_integrator.hpp"

#include "engine/schedule.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "io/text_table.hpp"
#include "numbers/text.hpp"
#include "scene/foreign_names.hpp"
#include "scene/gyration.hpp"
#include "scene/read_decorators.hpp"
#include "scene/read_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

namespace noether {

namespace {

/// More than can be counted in doubles.
constexpr double most_steps = 9e15;

/// A time as scenes of these units write it.
std::string time_text(double time, const UnitSystem& units) {
  const std::string unit = unit_of(dimensions::time, units), number = format_number(time);
  return unit == "1" ? number : "\"" + number + " " + unit + "\"";
}

/// How many steps a time is: as it is, and as a whole number where it is one but for rounding.
struct StepCount {
  double exact = 0;
  std::optional<std::int64_t> whole;
};

/// Counts the steps from `from` to a time.
StepCount steps_to(const SceneIntegrator& integrator, double time, double from) {
  const double exact = (time - from) / integrator.step, whole = std::round(exact);
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  // Beside 1e-9 of a step, the rounding of a long duration, and of times far from 0.
  const double far = from == 0 ? 0 : 4 * epsilon * std::max(std::abs(time), std::abs(from)) / std::abs(integrator.step);
  if (std::abs(exact) <= most_steps &&
      std::abs(exact - whole) <= 1e-9 + 16 * epsilon * std::abs(exact) + std::min(far, 0.01))
    return {exact, static_cast<std::int64_t>(whole)};
  return {exact, {}};
}

/// The time after so many steps, as it would be written, without what rounding has added to it, where that reads back
/// as the same whole step.
double written_time(const SceneIntegrator& integrator, double steps, double from) {
  const double time = from + steps * integrator.step, written = std::stod(fmt::format("{:.15g}", time));
  const StepCount read = steps_to(integrator, written, from);
  return read.whole && static_cast<double>(*read.whole) == steps ? written : time;
}

/// A number of steps from `from` on, as a time: "\"3653 day\" (3653 steps)".
std::string step_text(const SceneIntegrator& integrator, const UnitSystem& units, double steps, double from) {
  return fmt::format("{} ({} {})", time_text(written_time(integrator, steps, from), units), format_number(steps),
                     steps == 1 ? "step" : "steps");
}

/// A time that is no whole number of steps, in words: "is 3652.5 steps of \"1 day\"".
std::string is_steps(const SceneIntegrator& integrator, const UnitSystem& units, double exact, double from) {
  return fmt::format("is {:.12g} steps of {}{}", exact, integrator.step_text,
                     from == 0 ? "" : " after " + time_text(from, units));
}

/// What is wrong with a time that is no whole number of steps, where it must be one: the two nearest are told.
std::string not_whole(const SceneIntegrator& integrator, const UnitSystem& units, double exact, double from) {
  const auto nearest = [&](double steps) { return step_text(integrator, units, steps, from); };
  const std::string is = is_steps(integrator, units, exact, from);
  if (exact < 1) return fmt::format("{}; the shortest time is {}", is, nearest(1));
  return fmt::format("{}; the nearest whole numbers are {} and {}", is, nearest(std::floor(exact)),
                     nearest(std::ceil(exact)));
}

/// Where a time between two steps goes.
enum class Between : std::uint8_t { later, nearest };

/// Whether a duration lies between two steps, of a method that tells states there.
bool is_between(const SceneIntegrator& integrator, double duration) {
  if (!integrator.between_steps) return false;
  const auto [exact, whole] = steps_to(integrator, duration, 0);
  return !whole && exact <= most_steps;
}

/// How many steps lead from `from`, the start of a run or 0 for a duration, to the time that a key gives: at least 1.
/// A time between two steps goes to one of them, which is noted.
/// @throws SceneError  for a time that lies behind; with `exact` for one between two steps, too, with the nearest two
std::int64_t whole_steps(const TableReader& reader, std::string_view key, const SceneValue& value,
                         const SceneIntegrator& integrator, Between between, double from = 0) {
  const UnitSystem& units = *reader.context().units;
  const auto [exact, whole] = steps_to(integrator, reader.number(value, key, "time"), from);
  const auto fail = [&](const std::string& message) {
    reader.fail(&value, key, fmt::format("{} = {} {}", key, to_text(value), message));
  };
  const std::string origin = from == 0 ? "0" : time_text(from, units);
  if (exact < 0) {
    fail(fmt::format("lies {}; the step is {}, so give a time {} {}",
                     from == 0 ? "in the opposite direction" : "on the wrong side of the start_time",
                     integrator.step_text, integrator.step > 0 ? "above" : "below", origin));
  }
  if (!(exact > 0)) {
    fail(fmt::format("leaves no time for a step; the step is {}{}", integrator.step_text,
                     from == 0 ? "" : fmt::format(", and the start_time is {}", origin)));
  }
  if (exact > most_steps)
    fail(fmt::format("is {:.3g} steps of {}, more than can be counted", exact, integrator.step_text));
  if (whole) return *whole;
  if (integrator.exact) fail(not_whole(integrator, units, exact, from));
  const double taken = std::max(between == Between::later ? std::ceil(exact) : std::round(exact), 1.0);
  reader.note(value, fmt::format("{} = {} {}; {} {}", key, to_text(value), is_steps(integrator, units, exact, from),
                                 between == Between::later ? "the run ends at the first whole step after it,"
                                                           : "the nearest whole number of steps is taken,",
                                 step_text(integrator, units, taken, from)));
  return static_cast<std::int64_t>(taken);
}

std::int64_t counted_steps(TableReader& reader, std::string_view key) {
  const std::int64_t steps = *reader.integer(key);
  if (steps < 1) reader.fail(key, fmt::format("{} = {} is too few; at least 1 is expected", key, steps));
  return steps;
}

const MethodInfo* find_method(TableReader& reader, const std::string& name, const Parts& parts) {
  try {
    return parts.find_method(name);
  } catch (const Error& error) {
    reader.fail("method", error.message());
  }
}

void unknown_method(TableReader& reader, const std::string& name, const Parts& parts) {
  reader.fail("method", fmt::format("unknown method '{}'{}", name,
                                    proposal(name, parts.method_names(), "; see `noether list methods`")));
}

void read_method(TableReader& reader, const Parts& parts, SceneIntegrator& made) {
  const std::string name = reader.text("method");
  if (!reader.has("method")) reader.fail(nullptr, "method", "[integrator] has no method; see `noether list methods`");
  const bool letters = !name.empty() && name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos;
  if (const Scheme* scheme = schemes::find(name)) {
    made.scheme = *scheme;
    made.method = std::string(scheme->name);
  } else if (const MethodInfo* info = find_method(reader, name, parts)) {
    made.classical = MethodChoice{info, {}};
    made.method = std::string(info->name);
  } else if (letters) {
    try {
      made.scheme = word(name);
    } catch (const Error& error) {
      if (!proposal(name, parts.method_names(), "").empty()) unknown_method(reader, name, parts);  // "VERLET"
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
  made.composition = read_composition(reader);
  try {
    if (constrained) made.composition.check_with_constraints();
  } catch (const Error& error) {
    reader.refuse(error);
  }
  put_fields(reader, made.composition, effective);
  // Scenes without them are stored as they always were, so that runs begun before these keys existed can be resumed.
  for_each_field<CompositionOptions>([&](const auto& field) {
    const bool plain = made.composition.*(field.member) == CompositionOptions().*(field.member);
    const bool changes_scheme = field.name != "compensated";
    if (plain && changes_scheme) effective.erase(field.name);
  });
}

/// Refuses what only a splitting takes, where it is more than its default.
void refuse_scheme_options(TableReader& reader, const SceneIntegrator& made) {
  const CompositionOptions given = read_composition(reader), defaults;
  for_each_field<CompositionOptions>([&](const auto& field) {
    if (given.*(field.member) == defaults.*(field.member)) return;
    reader.fail(field.name,
                fmt::format("method '{}' {}; {} = {} is for splitting schemes such as 'verlet'", made.method,
                            CompositionOptions::elsewhere(field.name), field.name, to_text(*reader.find(field.name))));
  });
}

/// What a classical method takes beside its step.
void read_method_options(TableReader& reader, const Parts& parts, SceneIntegrator& made, bool constrained,
                         SceneValue& effective) {
  const MethodInfo& info = *made.classical->info;
  MethodOptions& options = made.classical->options;
  if (constrained) {
    reader.fail("method", fmt::format("method '{}' does not support constraints; use 'verlet', which is RATTLE with "
                                      "them, or a composition of it such as 'yoshida_4'",
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
    static_cast<void>(make_method<double>(info, options));  // it may know more than its groups of options do
  } catch (const Error& error) {
    reader.refuse(error);
  }
  MethodOptions resolved = info.resolved(options);
  const bool default_is_zero = !reader.context().of_system;
  if (default_is_zero && !options.atol && info.atol > 0) resolved.atol.reset();
  for (const OptionGroup* group : info.option_groups()) put_options(reader, *group, resolved, effective);
}

/// A step as scenes of these units write it.
std::string example_step(const UnitSystem& units) {
  const std::string unit = unit_of(dimensions::time, units);
  return unit == "1" ? "0.01" : unit == "ps" ? "\"1 fs\"" : "\"1 " + unit + "\"";
}

/// A step that is told by how long a charge takes to turn, "0.05 gyration"; empty for a time.
std::optional<double> gyration_step(const TableReader& reader, const SceneValue& step) {
  constexpr std::string_view word = "gyration";
  const std::string* text = step.get<std::string>();
  const std::string wrong = text == nullptr ? "" : misspelt_gyration(*text);
  if (!wrong.empty()) reader.fail(&step, "step", "unknown unit '" + wrong + "' in step; did you mean 'gyration'?");
  if (text == nullptr || !text->ends_with(word)) return {};
  const std::optional<double>& period = reader.context().gyration;
  if (!period) {
    reader.fail(&step, "step",
                fmt::format("step = {} needs a charge that a magnetic field turns where the run begins; give a time",
                            to_text(step)));
  }
  std::string number = text->substr(0, text->size() - word.size());
  number.erase(number.find_last_not_of(' ') + 1);
  return reader.number(SceneValue::of(number.empty() ? "1" : number, step.line), "step", "1") * *period;
}

void read_step(TableReader& reader, SceneIntegrator& made, SceneValue& effective) {
  const SceneValue* step = reader.find("step");
  if (step == nullptr && made.adaptive()) return;
  if (step == nullptr) {
    reader.fail(nullptr, "step",
                fmt::format("[integrator] has no step; give one, such as {}", example_step(*reader.context().units)));
  }
  const std::optional<double> turning = gyration_step(reader, *step);
  made.step = turning ? *turning : reader.number(*step, "step", "time");
  made.step_text = to_text(*step);
  if (made.step == 0)
    reader.fail("step", fmt::format("a step of {} is not valid; a time other than 0 is expected", made.step_text));
  if (made.adaptive()) made.classical->options.first = std::abs(made.step);
  effective.put("step", *step);
}

void read_start_time(TableReader& reader, SceneIntegrator& made, SceneValue& effective) {
  const SceneValue* start = reader.find("start_time");
  if (start == nullptr) return;
  made.start = reader.number(*start, "start_time", "time");
  if (made.start == 0) return;  // as if nobody had said it
  if (made.step != 0 && std::abs(made.step) < 4 * std::numeric_limits<double>::epsilon() * std::abs(made.start)) {
    reader.fail(
        start, "start_time",
        fmt::format(
            "start_time = {} is too far from 0: a step of {} is lost in its rounding; choose another origin of time",
            to_text(*start), made.step_text));
  }
  effective.put("start_time", *start);
}

void read_end(TableReader& reader, SceneIntegrator& made, SceneValue& effective) {
  const SceneValue* until = reader.find("until");
  if (until != nullptr && reader.has("steps")) {
    reader.fail(until, "until", "until and steps are both given in [integrator]; give only one of them");
  }
  if (until != nullptr && made.adaptive()) {
    made.until = reader.number(*until, "until", "time");
    const double length = *made.until - made.start;
    const std::string origin = made.start == 0 ? "0" : time_text(made.start, *reader.context().units);
    if (length == 0) {
      reader.fail("until",
                  fmt::format("until = {} leaves no time to run; give a time above {}, or one below {} to go back",
                              to_text(*until), origin, made.start == 0 ? "0" : "it"));
    }
    if (made.step != 0 && (length > 0) != (made.step > 0)) {
      const std::string_view side = made.step > 0 ? "above" : "below", other = made.step > 0 ? "below" : "above";
      reader.fail(
          "until",
          fmt::format("until = {} lies in the opposite direction; the first step is {}, so give a time {} {}, or a "
                      "first step {} 0",
                      to_text(*until), made.step_text, side, origin, other));
    }
  } else if (until != nullptr) {
    made.steps = whole_steps(reader, "until", *until, made, Between::later, made.start);
  }
  if (until != nullptr) effective.put("until", *until);
  if (reader.has("steps")) made.steps = reader.integer("steps");
  if (made.steps && *made.steps < 0)
    reader.fail("steps", fmt::format("steps = {} is negative; 0 or more is expected", *made.steps));
  if (reader.has("steps")) effective.put("steps", SceneValue::of(*made.steps));
}

double wall_seconds(const TableReader& reader, const SceneValue& wall) {
  const std::string* text = wall.get<std::string>();
  if (text == nullptr) reader.wrong_kind(wall, "wall", "a time in quotes, such as \"5 min\",");
  double seconds = 0;
  try {
    seconds = parse_quantity(*text, dimensions::time, unit_system("si"));
  } catch (const Error& error) {
    reader.fail(&wall, "wall", fmt::format("wall: {}", error.message()));
  }
  if (!(seconds > 0))
    reader.fail(&wall, "wall", fmt::format("wall = \"{}\" is not a valid interval; a time above 0 is expected", *text));
  return seconds;
}

/// One of the times of a list.
struct ListedTime {
  double time;
  std::string text;  ///< as it was written
  SceneValue value;
  std::size_t line = 0;  ///< of its file, where it comes from one
};

std::vector<ListedTime> times_in_file(const TableReader& reader, const SceneValue& name,
                                      std::optional<io::TextFile>& file) {
  const UnitSystem& units = *reader.context().units;
  const std::string& given = *name.get<std::string>();
  bool is_time = true;
  try {
    parse_quantity(given, dimensions::time, units);
  } catch (const Error&) {
    is_time = false;
  }
  if (is_time) {
    reader.fail(&name, "times",
                fmt::format("times = {0} is one time; a list is expected, times = [{0}], or the name of a file",
                            to_text(name)));
  }
  if (given.empty()) reader.fail(&name, "times", "times = \"\" names no file; give one, such as \"times.txt\"");
  const std::filesystem::path path = std::filesystem::path(reader.context().source.file).parent_path() / given;
  try {
    file.emplace(path, "a list of times, one per line");
  } catch (const FileError& error) {
    if (name.line <= 0) throw;
    throw FileError(error.what(), {.file = reader.context().source.file,
                                   .line = name.line,
                                   .key = reader.path_of("times"),
                                   .value = path.string()});
  }
  std::vector<ListedTime> all;
  for (std::size_t k = 0; k < file->lines().size(); ++k) {
    const std::string_view line = file->lines()[k];
    const std::string one(io::trimmed(line.substr(0, line.find('#'))));
    if (one.empty()) continue;
    try {
      const double time = parse_quantity(one, dimensions::time, units);
      all.push_back({time, one, units.is_reduced() ? SceneValue::of(time) : SceneValue::of(one), k + 1});
    } catch (const Error& error) {
      file->fail(k + 1, error.message(), one);
    }
  }
  return all;
}

/// Takes the times of a list to whole steps, one after the other, unless the method tells states between them.
class StepsOfList {
 public:
  StepsOfList(const SceneIntegrator& integrator, const UnitSystem& units) : integrator_(integrator), units_(units) {}

  /// Moves a time to its step. @return false for one that has come to the step of the time before
  template <class Refuse> bool take(ListedTime& one, const std::string& before, const Refuse& refuse) {
    const double start = integrator_.start;
    const auto [exact, whole] = steps_to(integrator_, one.time, start);
    if (exact > most_steps)
      refuse(one, fmt::format("is {:.3g} steps of {}, more than can be counted", exact, integrator_.step_text));
    if (!whole && integrator_.between_steps) return true;
    if (!whole && integrator_.exact) refuse(one, not_whole(integrator_, units_, exact, start));
    const std::int64_t step = whole ? *whole : std::llround(exact);
    const bool same = step == last_, may_be_same = !whole || last_moved_;
    if (same && !may_be_same) refuse(one, fmt::format("is at the step of {} too", before));
    if (!whole) {
      ++moved_;
      one.time = start + static_cast<double>(step) * integrator_.step;
    }
    left_out_ += same ? 1 : 0;
    last_ = step;
    last_moved_ = !whole || (same && last_moved_);
    return !same;
  }

  /// What was done, in words; "" where all times are at whole steps.
  std::string note(std::size_t times) const {
    if (moved_ == 0) return "";
    std::string text = fmt::format("{} of {} lie between steps of {}; the nearest whole steps are taken", moved_,
                                   counted(static_cast<std::int64_t>(times), "time"), integrator_.step_text);
    if (moved_ == 1)
      text = fmt::format("1 of {} lies between steps of {}; the nearest whole step is taken",
                         counted(static_cast<std::int64_t>(times), "time"), integrator_.step_text);
    if (left_out_ == 0) return text;
    return text + fmt::format(", and {} left out where two come to one step",
                              left_out_ == 1 ? "1 is" : fmt::format("{} are", left_out_));
  }

 private:
  const SceneIntegrator& integrator_;
  const UnitSystem& units_;
  std::int64_t last_ = -1;
  bool last_moved_ = false;
  std::int64_t moved_ = 0, left_out_ = 0;
};

/// Reads the times of a list, or of a file with one a line: each later than the one before, none before the start.
void read_times(TableReader& reader, const SceneValue& value, const SceneIntegrator& integrator, Cadence& cadence,
                SceneValue& effective) {
  const UnitSystem& units = *reader.context().units;
  std::optional<io::TextFile> file;
  std::vector<ListedTime> all;
  if (const auto* list = value.get<SceneValue::Array>()) {
    for (const SceneValue& one : *list) all.push_back({reader.number(one, "times", "time"), to_text(one), one});
  } else if (value.get<std::string>() != nullptr) {
    all = times_in_file(reader, value, file);
  } else {
    reader.wrong_kind(value, "times", "a list of times, or the name of a file with one per line,");
  }
  const auto refuse = [&](const ListedTime& one, const std::string& why) {
    if (file) file->fail(one.line, fmt::format("time {} {}", one.text, why), one.text);
    reader.fail(one.value.line != 0 ? &one.value : &value, "times",
                fmt::format("times contains {}, which {}", one.text, why));
  };
  if (all.empty() && file) file->fail(0, "there is no time in this file; one per line is expected");
  if (all.empty()) reader.fail(&value, "times", "times = [] is an empty list; give some times, or take the table out");
  const double sign = integrator.direction() == Direction::forward ? 1 : -1;
  if (!all.empty()) all[0].time = detail::at_start_if_rounded(all[0].time, integrator.start);
  StepsOfList steps(integrator, units);
  for (std::size_t k = 0; k < all.size(); ++k) {
    ListedTime one = all[k];
    if (sign * (one.time - integrator.start) < 0) {
      refuse(one, fmt::format("the run does not reach: it goes {} in time from {}", sign > 0 ? "forward" : "back",
                              time_text(integrator.start, units)));
    }
    if (k > 0 && one.time == all[k - 1].time) refuse(one, "is listed twice");
    if (k > 0 && sign * (one.time - all[k - 1].time) < 0) {
      refuse(one, fmt::format("is listed after {}, which the run reaches later; put the times in the order of the run",
                              all[k - 1].text));
    }
    if (!integrator.adaptive() && !steps.take(one, k > 0 ? all[k - 1].text : "", refuse)) continue;
    cadence.times.push_back(one.time);
  }
  if (const std::string note = steps.note(all.size()); !note.empty()) reader.note(value, note);
  SceneValue::Array written;
  for (ListedTime& one : all) written.push_back(std::move(one.value));
  effective.put("times", SceneValue::of(std::move(written), value.line));
}

/// A misspelt key is told before a missing one.
void know_options(TableReader& reader, const Parts& parts) {
  for_each_field<CompositionOptions>([&](const auto& field) { reader.find(field.name); });
  for (const OptionGroup* group : parts.method_options()) {
    for (const OptionValue& one : group->values({})) reader.find(one.name);
  }
  reader.finish();
}

}  // namespace

SceneIntegrator read_method_alone(const SceneContext& context, const SceneValue& table, const Parts& parts,
                                  SceneValue& effective) {
  SceneIntegrator made;
  TableReader reader(context, table, "[integrator]", "integrator");
  reader.find("method");
  know_options(reader, parts);
  read_method(reader, parts, made);
  effective.put("method", SceneValue::of(made.method, reader.line("method")));
  if (made.classical) {
    read_method_options(reader, parts, made, false, effective);
  } else {
    read_scheme_options(reader, parts, made, false, effective);
  }
  return made;
}

SceneIntegrator read_integrator(const SceneContext& context, const SceneValue& table, const Parts& parts,
                                bool constrained, SceneValue& effective) {
  SceneIntegrator made;
  TableReader reader(context, table, "[integrator]", "integrator");
  for (const char* key : {"method", "step", "start_time", "until", "steps", "exact", "decorator"}) reader.find(key);
  for (const Parts::DecoratorKind& kind : parts.decorators()) reader.find(kind.info.name);
  know_options(reader, parts);
  read_method(reader, parts, made);
  effective.put("method", SceneValue::of(made.method, reader.line("method")));
  SceneValue options = SceneValue::table();
  if (made.classical) read_method_options(reader, parts, made, constrained, options);
  if (made.classical && !made.adaptive()) {
    made.between_steps = make_method<double>(*made.classical->info, made.classical->options)->dense();
  }
  read_step(reader, made, effective);
  read_start_time(reader, made, effective);
  made.exact = reader.flag("exact", false);
  if (made.exact) effective.put("exact", SceneValue::of(true, reader.line("exact")));
  read_end(reader, made, effective);
  if (!made.classical) read_scheme_options(reader, parts, made, constrained, options);
  for (auto& [key, value] : *options.get<SceneValue::Table>()) effective.put(key, value);
  read_decorators(reader, parts, made, effective);
  return made;
}

Cadence read_cadence(TableReader& reader, bool may_be_wall, const SceneIntegrator& integrator, SceneValue& effective) {
  const SceneValue *every = reader.find("every"), *steps = reader.find("steps"), *times = reader.find("times");
  const SceneValue* wall = may_be_wall ? reader.find("wall") : nullptr;
  const int given = (every != nullptr) + (steps != nullptr) + (wall != nullptr) + (times != nullptr);
  const std::string_view choices = may_be_wall ? "every, steps, wall or times" : "every, steps or times";
  if (given == 0) reader.fail(nullptr, "steps", fmt::format("{} has no cadence; give {}", reader.what(), choices));
  if (given > 1) {
    const std::string_view key = every != nullptr ? "every" : wall != nullptr ? "wall" : "times";
    reader.fail(key, fmt::format("{} has two cadences; give only one of {}", reader.what(), choices));
  }
  Cadence cadence;
  const bool by_time =
      every != nullptr && (integrator.adaptive() || is_between(integrator, reader.number(*every, "every", "time")));
  if (by_time) {
    cadence.interval = reader.number(*every, "every", "time");
    const bool forward = integrator.direction() == Direction::forward;
    if (cadence.interval == 0)
      reader.fail("every",
                  fmt::format("every = {} is not a valid interval; a time other than 0 is expected", to_text(*every)));
    if ((cadence.interval > 0) != forward) {
      reader.fail("every",
                  fmt::format("every = {} lies in the opposite direction; the run goes {} in time, so give a time {} 0",
                              to_text(*every), forward ? "forward" : "back", forward ? "above" : "below"));
    }
  } else if (every != nullptr) {
    cadence.steps = whole_steps(reader, "every", *every, integrator, Between::nearest);
  }
  if (steps != nullptr) cadence.steps = counted_steps(reader, "steps");
  if (wall != nullptr) cadence.wall = wall_seconds(reader, *wall);
  if (times != nullptr) read_times(reader, *times, integrator, cadence, effective);
  if (every != nullptr) effective.put("every", *every);
  if (steps != nullptr) effective.put("steps", SceneValue::of(cadence.steps, reader.line("steps")));
  if (wall != nullptr) effective.put("wall", *wall);
  return cadence;
}

void read_after(TableReader& reader, const SceneIntegrator& integrator, Cadence& cadence, SceneValue& effective) {
  const SceneValue* after = reader.find("after");
  if (after == nullptr) return;
  const UnitSystem& units = *reader.context().units;
  const double time = reader.number(*after, "after", "time"), start = integrator.start;
  const auto fail = [&](const std::string& message) {
    reader.fail(after, "after", fmt::format("after = {} {}", to_text(*after), message));
  };
  if (!cadence.times.empty()) fail("is for every and steps; take times before it out of the list instead");
  if (cadence.wall > 0) fail("is for every and steps; wall time has nothing to do with it");
  if (!std::isfinite(time)) fail("is not a valid time; a finite one is expected");
  const double sign = integrator.direction() == Direction::forward ? 1 : -1;
  if (sign * (time - start) < 0)
    fail(fmt::format("lies before the start at {}; give a later time", time_text(start, units)));
  // The first look of the cadence, as the run will take it.
  double first = time;
  if (integrator.step != 0 && !integrator.adaptive() && cadence.steps > 0) {
    first = start +
            integrator.step * static_cast<double>(detail::first_multiple(time, start, integrator.step, cadence.steps));
  } else if (cadence.interval != 0) {
    first = start + cadence.interval * std::ceil((time - start) / cadence.interval * (1 - 1e-12));
  }
  const auto length = integrator.length();
  const double rounding = cadence.interval != 0 ? 1e-8 : 0.5;  // between two steps, or to the nearest one
  const double grace = integrator.adaptive() ? 1e-12 * std::abs(first - start) : rounding * std::abs(integrator.step);
  if (length && std::abs(first - start) > std::abs(*length) + grace) {
    const std::string end = time_text(start + *length, units);
    fail(sign * (time - start - *length) > grace
             ? fmt::format("is beyond the end of the run at {}, so there would be no sample; give an earlier time", end)
             : fmt::format("leaves no sample: the next one would be at {}, beyond the end of the run at {}",
                           time_text(first, units), end));
  }
  cadence.after = time;
  effective.put("after", *after);
}

}  // namespace noether
