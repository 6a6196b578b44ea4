#pragma once
/// Rows of an ensemble on their way into its file.

#include "io/ensemble_file.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace noether::io {

/// The file in which the rows of another one stand until it is written: FILE.rows.
std::filesystem::path ensemble_journal_of(const std::filesystem::path& file);

/// Rows of an ensemble that is being made, one after the other as they are done: what a kill leaves are whole rows.
///
/// A line with the digest of the definition, then rows as they stand in memory, each with a checksum. The file is
/// locked as long as this lives.
class EnsembleJournal {
 public:
  /// Opens the journal of an ensemble or begins one; rows behind a damaged one are cut off.
  /// @param fresh  what is there is discarded
  /// @throws SceneError  if it is of another ensemble, or another process writes to it; FileError
  EnsembleJournal(std::filesystem::path file, const EnsembleDefinition& definition, bool fresh);
  ~EnsembleJournal();
  EnsembleJournal(const EnsembleJournal&) = delete;
  EnsembleJournal& operator=(const EnsembleJournal&) = delete;

  /// Those that were there, and those that were added, in that order.
  const std::vector<EnsembleRow>& rows() const { return rows_; }
  /// @throws FileError  if the disk refuses
  void append(EnsembleRow row);
  /// Takes the file away: its rows are elsewhere. @throws FileError
  void remove();

 private:
  void lock();
  void begin(bool fresh);
  void read_rows(const std::string& bytes);

  std::filesystem::path file_;
  std::size_t width_;
  std::string header_;
  int descriptor_ = -1;
  std::vector<EnsembleRow> rows_;
};

}  // namespace noether::io
