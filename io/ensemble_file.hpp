#pragma once
/// The file of an ensemble: a row for each member, its parameters, how it ended, and the figures of its monitors.

#include "io/digest.hpp"
#include "numbers/types.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace noether::io {

/// What rows hold beside the numbers that all of them have.
struct EnsembleColumn {
  std::string name;                       ///< of the dataset below /ensemble: "energy_worst", "position"
  std::vector<Index> shape = {};          ///< of one row; empty for a number
  std::string dimension = "1";            ///< in words; where columns differ, one for each
  std::vector<std::string> columns = {};  ///< names along the last axis, where it has any

  /// Numbers of one row.
  Index width() const;
  bool operator==(const EnsembleColumn&) const = default;
};

/// What an ensemble is. Two files with equal definitions hold rows of one ensemble.
struct EnsembleDefinition {
  std::string scene_toml;               ///< effective, without what varies
  std::vector<std::string> variations;  ///< as they were written: "KEY=a:b:n"
  std::vector<std::string> keys;        ///< of what varies
  std::vector<Index> grid = {};         ///< points of each grid, the first key's first; then draws, where there are any
  std::int64_t members = 0, seed = 0;
  bool in_lanes = true;                    ///< whether members went side by side, on which bits depend
  std::string simd;                        ///< level of the kernels in lanes, on which bits depend
  std::vector<EnsembleColumn> columns;     ///< of monitors and of the end
  std::vector<std::string> outcomes = {};  ///< names of the numbers in the dataset `outcome`

  /// SHA-256 of all of it, and of the version that rows were made by.
  std::string digest() const;
  /// Numbers in `EnsembleRow::values`.
  Index width() const;
};

/// One member.
struct EnsembleRow {
  std::int64_t member = 0, outcome = 0, step = 0;
  std::int64_t particle = -1;  ///< id of the one that the outcome speaks of; -1: none
  RowDigest digest = {};       ///< of the state at the end; 0 where there is none
  double time = 0;
  std::vector<double> values;  ///< parameters in the order of the keys, then each column

  /// As it stands in memory: equal bytes are equal rows, NaN and all.
  std::string bytes() const;
  /// @param bytes  of `EnsembleRow::bytes`  @param width  of `values`
  static EnsembleRow from_bytes(const char* bytes, std::size_t width);
};

/// Which rows of an ensemble a file is to hold: those whose member is `shard` modulo `shards`.
struct EnsembleShard {
  std::int64_t shard = 0, shards = 1;

  bool whole() const { return shards == 1; }
  bool has(std::int64_t member) const { return member % shards == shard; }
  /// How many of so many members.
  std::int64_t count(std::int64_t members) const { return (members - shard + shards - 1) / shards; }
};

/// How often members have ended in each way.
std::map<std::string, std::int64_t> outcomes_of(const EnsembleDefinition& definition,
                                                const std::vector<EnsembleRow>& rows);

/// All rows of an ensemble, or of a shard of it, in the order of members.
struct EnsembleTable {
  EnsembleDefinition definition;
  EnsembleShard shard;
  std::vector<EnsembleRow> rows;

  /// Equal digests mean equal rows, to the bit: "sha256:<hex>".
  std::string digest() const;
};

/// Writes the file of an ensemble whole, and gives it its name when it is on disk. Its bytes depend on the table alone.
/// @throws FileError
void write_ensemble(const std::filesystem::path& file, const EnsembleTable& table);

/// Whether a file says that it is that of an ensemble, or a shard of one; it may be damaged.
/// @throws never
bool holds_ensemble(const std::filesystem::path& file) noexcept;

/// @throws FileError  if it is missing, damaged, or holds something else
EnsembleTable read_ensemble(const std::filesystem::path& file);

/// The table of all shards of one ensemble.
/// @throws SceneError  for shards of two ensembles, a shard twice, and members that are in none of them
EnsembleTable merge_ensembles(const std::vector<std::filesystem::path>& files);

/// What differs between two ensembles, in words.
std::string difference_of(const EnsembleDefinition& there, const EnsembleDefinition& here);

}  // namespace noether::io
