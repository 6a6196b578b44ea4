#pragma once
/// Reading one table of a scene: every key that nobody asks for is an error.

#include "engine/columns.hpp"
#include "numbers/error.hpp"
#include "numbers/quantity.hpp"
#include "scene/value.hpp"

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// What a text of `SceneSource::sets` begins with when it is the option `--until`.
inline constexpr std::string_view until_option = "--until ";

/// Where a scene comes from: what errors point at.
struct SceneSource {
  std::string file;               ///< as the user typed it
  std::vector<std::string> sets;  ///< the texts of `--set`, in order; "--until T" stands for that option
};

/// What all tables of a scene share.
struct SceneContext {
  SceneSource source;
  const UnitSystem* units = &unit_system("solar");
  /// `hamiltonian.G`, or that of a force where it stands there alone: the default of every field of that name.
  std::optional<SceneValue> G = {};
  double start_time = 0;                 ///< what the clock of the run shows at its first step [time]
  std::optional<double> gyration = {};   ///< how long the first charge that turns takes for it at the start [time]
  bool of_system = false;                ///< it has a system of first order in the place of a Hamiltonian
  bool gravitates = false;               ///< the Hamiltonian, as far as it has been read, has a constant of gravitation
  std::vector<ColumnInfo> columns = {};  ///< that the Hamiltonian and the forces of the scene declare
  std::string program = {};              ///< how to run the program that has the parts of this scene, where it has own
  /// Where notes go, each with its place: what is taken otherwise than written. Null: nobody wants them.
  std::vector<std::string>* notes = nullptr;
  std::vector<ColumnInfo> other_columns = {};  ///< that those parts declare which the scene does not have
  /// Omega of a Hamiltonian in a turning frame: the default of every angular velocity of that name.
  std::optional<SceneValue> Omega = {};
};

/// Reads one table; remembers which keys were asked for.
class TableReader {
 public:
  /// @param what  how messages call the table: "[integrator]", "force 'gravity'"
  /// @param path  its dotted key: "integrator"
  TableReader(const SceneContext& context, const SceneValue& table, std::string what, std::string path);

  /// The value of a key, which is a known one from now on; null if it is not given.
  const SceneValue* find(std::string_view key);
  bool has(std::string_view key) { return find(key) != nullptr; }
  /// Where a key stands; 0 if it is not given.
  int line(std::string_view key) const {
    const SceneValue* value = table_.find(key);
    return value != nullptr ? value->line : 0;
  }

  /// Typed values; `fallback` where the key is not given. @throws SceneError for another type
  std::string text(std::string_view key, std::string fallback = "");
  bool flag(std::string_view key, bool fallback);
  std::optional<std::int64_t> integer(std::string_view key);
  /// A quantity in the units of the scene. @throws SceneError
  std::optional<double> quantity(std::string_view key, std::string_view dimension);
  std::optional<std::array<double, 3>> vector(std::string_view key, std::string_view dimension);
  /// The numbers of a particle in a column, under the name of the column.
  std::optional<std::vector<double>> row(const ColumnInfo& column);

  /// @throws SceneError  for a constant of gravitation that is not the one of the scene
  void expect_same_constant(double G) const;
  /// @throws SceneError  for an angular velocity that is not the one of the frame
  void expect_same_rate(double Omega) const;

  /// One number with a dimension, of this or another table.
  double number(const SceneValue& value, std::string_view key, std::string_view dimension) const;

  /// Knows these keys and no others, so that a misspelt key is told before a missing one. @throws SceneError
  void expect_only(std::initializer_list<std::string_view> keys, const std::vector<ColumnInfo>& columns = {}) {
    for (const std::string_view key : keys) find(key);
    for (const ColumnInfo& column : columns) find(column.name);
    finish();
  }
  /// @throws SceneError  naming the first key nobody has asked for, with a proposal
  void finish() const;

  /// Ends reading with a message at a value, or at the head of the table if there is none.
  [[noreturn]] void fail(const SceneValue* at, std::string_view key, const std::string& message) const;
  /// The same for a key.
  [[noreturn]] void fail(std::string_view key, const std::string& message) const {
    fail(table_.find(key), key, message);
  }
  /// Ends reading with what a part says of a field: at the key the error names, and with the value as it was written.
  [[noreturn]] void refuse(const Error& error) const;
  /// Notes that a value is taken otherwise than written.
  void note(const SceneValue& value, const std::string& message) const;
  /// A value of the wrong kind.
  [[noreturn]] void wrong_kind(const SceneValue& value, std::string_view key, std::string_view expected) const;

  const SceneContext& context() const { return context_; }
  const SceneValue& table() const { return table_; }
  const std::string& what() const { return what_; }
  const std::string& path() const { return path_; }
  std::string path_of(std::string_view key) const;

 private:
  const SceneContext& context_;
  const SceneValue& table_;
  std::string what_, path_;
  std::vector<std::string> known_;
};

/// The exception for something at a line (negative: at a `--set`) of a scene. What stands on the command line has no
/// file: the message begins with it.
SceneError scene_error(const SceneSource& source, int line, std::string key, std::string value,
                       const std::string& message);

/// What `TableReader::vector` has read.
inline Vec3<double> column(const std::array<double, 3>& v) { return Vec3<double>(v[0], v[1], v[2]); }

/// The elements of a list of tables, `[[every]]`; none if the key is absent. @throws SceneError for anything else
std::vector<const SceneValue*> tables_of(TableReader& reader, std::string_view key);

}  // namespace noether
