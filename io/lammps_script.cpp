#include "io/lammps_script.hpp"

#include "io/lammps_text.hpp"
#include "io/structure_parts.hpp"
#include "numbers/quantity.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether::io {

namespace {

constexpr std::array<std::string_view, 15> commands_read = {
    "mass",           "pair_coeff",  "bond_coeff",    "angle_coeff", "dihedral_coeff",
    "improper_coeff", "pair_style",  "bond_style",    "angle_style", "dihedral_style",
    "improper_style", "pair_modify", "special_bonds", "units",       "atom_style"};
/// Commands that say how a run goes, and what of it is written.
constexpr std::array<std::string_view, 20> commands_passed_over = {
    "read_data",   "newton",       "processors",    "neighbor", "neigh_modify", "kspace_style", "kspace_modify",
    "thermo",      "thermo_style", "thermo_modify", "log",      "echo",         "print",        "atom_modify",
    "comm_modify", "comm_style",   "suffix",        "package",  "info",         "timestep"};

template <std::size_t n> bool is_command_of(const std::array<std::string_view, n>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

double number_of_command(const LammpsCommand& command, std::size_t k) {
  return number_in(*command.text, command.line, command.words[k],
                   fmt::format("word {} of '{}'", k + 1, command.words[0]));
}

/// Factors of a force by special_bonds, for pairs one, two and three bonds apart.
using Factors = std::array<double, 3>;

/// What special_bonds says: of Lennard-Jones and of charges.
std::pair<Factors, Factors> factors_of(const LammpsCommand& command) {
  const auto& words = command.words;
  Factors lennard_jones = {0, 0, 0}, charges = {0, 0, 0};
  for (std::size_t k = 1; k < words.size(); ++k) {
    const std::string_view word = words[k];
    const bool all = word == "lj/coul", one_more = k + 1 < words.size();
    if (word == "fene") {
      lennard_jones = charges = {0, 1, 1};
    } else if (word == "charmm") {
      lennard_jones = charges = {0, 0, 0};
    } else if (word == "amber") {
      lennard_jones = {0, 0, 0.5}, charges = {0, 0, 5.0 / 6};
    } else if (word == "dreiding") {
      lennard_jones = charges = {0, 0, 1};
    } else if ((word == "lj" || word == "coul" || all) && k + 3 < words.size()) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double factor = number_of_command(command, k + 1 + i);
        if (word != "coul") lennard_jones[i] = factor;
        if (word != "lj") charges[i] = factor;
      }
      k += 3;
    } else if ((word == "angle" || word == "dihedral" || word == "one/five") && one_more && words[k + 1] == "no") {
      ++k;
    } else {
      command.fail(
          fmt::format("'{}' of special_bonds is not supported; expected fene, charmm, amber, dreiding, or three "
                      "factors after lj, coul or lj/coul",
                      fmt::join(words.begin() + static_cast<std::ptrdiff_t>(k), words.end(), " ")));
    }
  }
  return {lennard_jones, charges};
}

std::string factors_told(const Factors& factors) {
  return fmt::format("[{}, {}, {}]", format_number(factors[0]), format_number(factors[1]), format_number(factors[2]));
}

/// Takes a text that a script says, where the options say none or the same.
void complete_option(std::string& option, const LammpsCommand* command, const std::string& said, std::string_view key) {
  if (command == nullptr || said.empty()) return;
  if (!option.empty() && option != said) {
    command->fail(fmt::format("{} {} is given here, but the file's {} is '{}' elsewhere; take one of them out",
                              command->words[0], said, key, option),
                  said);
  }
  option = said;
}

}  // namespace

LammpsScript::LammpsScript(const StructureOptions& options) {
  for (const std::filesystem::path& file : options.coefficients) {
    read(texts_.emplace_back(file, "an input script of LAMMPS"), options);
  }
}

void LammpsScript::read(const TextFile& text, const StructureOptions& options) {
  const auto& lines = text.lines();
  std::vector<std::string_view> words;
  for (std::size_t line = 1; line <= lines.size(); ++line) {
    const std::size_t begun = line;
    std::string_view content = lines[line - 1];
    while (trimmed(content.substr(0, content.find('#'))).ends_with('&') && line < lines.size()) {
      const std::string_view kept = trimmed(content.substr(0, content.find('#')));
      content = joined_.emplace_back(fmt::format("{} {}", kept.substr(0, kept.size() - 1), lines[line]));
      ++line;
    }
    split_words(content, words);
    if (words.empty()) continue;
    commands_.push_back({&text, begun, words});
    check(commands_.back(), options);
  }
}

/// Refuses what is no coefficient and may matter; tells of what the scene has to say itself.
void LammpsScript::check(const LammpsCommand& command, const StructureOptions& options) const {
  const std::string name(command.words[0]), line = fmt::format("{}", fmt::join(command.words, " "));
  if (line.find('$') != std::string::npos) {
    command.fail(fmt::format("'{}' uses a variable; write its value instead", line), line);
  }
  if (name == "include") {
    command.fail(
        fmt::format("'{}' is not followed to the other file; list both files: coefficients = [\"a\", \"b\"]", line),
        line);
  }
  const bool plain = line == "dimension 3" || line == "boundary p p p";
  if (!plain && !is_command_of(commands_read, name) && !is_command_of(commands_passed_over, name)) {
    std::vector<std::string> known(commands_read.begin(), commands_read.end());
    const std::string meant = suggest(name, known);
    command.fail(fmt::format("'{}' does more than give coefficients, which is not supported{}", name,
                             meant.empty()
                                 ? "; keep mass, *_coeff, *_style, special_bonds and pair_modify in a file of their own"
                                 : fmt::format("; did you mean '{}'?", meant)),
                 name);
  }
  if (name != "pair_modify") {
    if (is_command_of(commands_read, name) && command.words.size() < 2)
      command.fail(fmt::format("'{}' has no value", name));
    return;
  }
  for (std::size_t k = 1; k < command.words.size(); k += 2) {
    const std::string_view key = command.words[k], value = k + 1 < command.words.size() ? command.words[k + 1] : "";
    if (key == "mix" || key == "table" || key == "tabinner" || (value == "no" && (key == "shift" || key == "tail"))) {
      continue;
    }
    if (value != "yes" || (key != "shift" && key != "tail")) {
      command.fail(fmt::format("'{} {}' of pair_modify is not supported; only mix, shift and tail are", key, value));
    }
    note(options, fmt::format("pair_modify {} yes has no effect here; give it in the scene: {}", key,
                              key == "shift" ? "cutoff_style = \"shifted\"" : "tail = true"));
  }
}

const LammpsCommand* LammpsScript::find(std::string_view name) const {
  const std::vector<const LammpsCommand*> found = all(name);
  return found.empty() ? nullptr : found.back();
}

std::vector<const LammpsCommand*> LammpsScript::all(std::string_view name) const {
  std::vector<const LammpsCommand*> found;
  for (const LammpsCommand& command : commands_) {
    if (command.words[0] == name) found.push_back(&command);
  }
  return found;
}

std::string LammpsScript::style(const std::string& family) const {
  const LammpsCommand* command = find(family + "_style");
  return command == nullptr ? "" : without_suffix(command->words[1]);
}

std::optional<LammpsScript::EndFactors> LammpsScript::end_factors() const {
  const LammpsCommand *command = find("special_bonds"), *pairs = find("pair_style");
  if (command == nullptr) return {};
  const auto [lennard_jones, charges] = factors_of(*command);
  // Where no style has charges, what is left of their forces means nothing.
  const bool has_charges =
      pairs == nullptr || fmt::format("{}", fmt::join(pairs->words, " ")).find("coul") != std::string::npos;
  if (!has_charges || lennard_jones == charges) return {};
  if (lennard_jones[0] == charges[0] && lennard_jones[1] == charges[1]) return EndFactors{lennard_jones[2], charges[2]};
  command->fail(fmt::format(
      "special_bonds keeps {} of Lennard-Jones forces and {} of forces of charges; only the third factor may differ",
      factors_told(lennard_jones), factors_told(charges)));
}

std::optional<Factors> LammpsScript::special() const {
  const LammpsCommand* command = find("special_bonds");
  if (command == nullptr) return {};
  Factors factors = factors_of(*command).first;
  if (end_factors()) factors[2] = 0;
  return factors;
}

std::optional<Mixing> LammpsScript::mixing() const {
  std::optional<Mixing> mixing;
  for (const LammpsCommand* command : all("pair_modify")) {
    for (std::size_t k = 1; k + 1 < command->words.size(); k += 2) {
      if (command->words[k] != "mix") continue;
      const std::string rule(command->words[k + 1]);
      if (rule != "geometric" && rule != "arithmetic") {
        command->fail(fmt::format("pair_modify mix {} is not supported; expected geometric or arithmetic", rule), rule);
      }
      mixing = rule == "geometric" ? Mixing::geometric : Mixing::lorentz_berthelot;
    }
  }
  return mixing;
}

StructureOptions LammpsScript::completed(StructureOptions options) const {
  const auto word = [](const LammpsCommand* command) {
    return command == nullptr ? std::string() : without_suffix(command->words[1]);
  };
  const LammpsCommand *units = find("units"), *atoms = find("atom_style");
  complete_option(options.file_units, units, word(units), "units");
  complete_option(options.atom_style, atoms, word(atoms), "atom_style");
  if (const LammpsCommand* command = find("special_bonds"); command != nullptr && options.special_charges) {
    const auto [lennard_jones, charges] = factors_of(*command);
    if (options.special != lennard_jones || *options.special_charges != charges) {
      command->fail(
          fmt::format("special_bonds keeps {} of Lennard-Jones forces and {} of forces of charges, but special says "
                      "others; take one "
                      "of them out",
                      factors_told(lennard_jones), factors_told(charges)));
    }
  } else if (const auto factors = special()) {
    if (options.special && *options.special != *factors) {
      find("special_bonds")
          ->fail(fmt::format("special_bonds keeps {}, but special says {}; take one of them out",
                             factors_told(*factors), factors_told(*options.special)));
    }
    options.special = factors;
  }
  if (const auto rule = mixing()) {
    if (options.mixing && *options.mixing != *rule) {
      find("pair_modify")->fail("pair_modify and mixing give different mixing rules; take one of them out");
    }
    options.mixing = rule;
  }
  return options;
}

}  // namespace noether::io
