#pragma once
/// Input scripts of LAMMPS, as far as they say coefficients: what a data file may leave to them.

#include "io/structure_options.hpp"
#include "io/text_table.hpp"

#include <array>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

/// One command: its words, the name of the command first.
struct LammpsCommand {
  const TextFile* text;
  std::size_t line;
  std::vector<std::string_view> words;

  [[noreturn]] void fail(const std::string& message, const std::string& value = "") const {
    text->fail(line, message, value);
  }
};

/// The commands mass, pair_coeff, bond_coeff, ..., pair_style, bond_style, ..., pair_modify, special_bonds, units and
/// atom_style of scripts that stand one behind the other. What only says how a run goes (read_data, neighbor, thermo,
/// kspace_style, ...) is passed over; any other command is refused, because it may change what is computed.
class LammpsScript {
 public:
  /// @throws FileError, SceneError
  explicit LammpsScript(const StructureOptions& options);

  /// Options with what the scripts say: units, style of atoms, special_bonds, the mixing of pair_modify. Where there
  /// are `end_factors`, special leaves nothing of such pairs.
  /// @throws SceneError  where the options say something else
  StructureOptions completed(StructureOptions options) const;

  /// What special_bonds leaves of the two forces of particles three bonds apart, where it is not the same of both.
  struct EndFactors {
    double lennard_jones, charges;
  };
  /// @throws SceneError
  std::optional<EndFactors> end_factors() const;

  /// The last command of a name, such as "bond_style"; null if there is none.
  const LammpsCommand* find(std::string_view name) const;
  /// All of a name, in their order: "bond_coeff", "mass".
  std::vector<const LammpsCommand*> all(std::string_view name) const;
  /// The style that a family has by "bond_style"; empty if none is said.
  std::string style(const std::string& family) const;

 private:
  void read(const TextFile& text, const StructureOptions& options);
  void check(const LammpsCommand& command, const StructureOptions& options) const;
  std::optional<std::array<double, 3>> special() const;
  std::optional<Mixing> mixing() const;

  std::deque<TextFile> texts_;
  std::deque<std::string> joined_;  ///< lines that go on behind "&"
  std::vector<LammpsCommand> commands_;
};

}  // namespace noether::io
