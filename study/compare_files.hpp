#pragma once
/// What a comparison leaves on disk.

#include "study/compare.hpp"

#include <filesystem>
#include <string>

namespace noether {

/// Where the files of a comparison are.
struct CompareFiles {
  std::filesystem::path csv, json, report;
};

/// All rows, a line each, after the line of column names; numbers read back to the same doubles.
std::string to_csv(const Comparison& comparison);
/// The comparison on one line of JSON, schema noether.compare/1.
/// @param files  where it was written; empty paths are null
std::string to_json(const Comparison& comparison, const CompareFiles& files = {});
/// For people: the front, the orders, and how the reference was found.
std::string to_text(const Comparison& comparison);

/// Writes compare.csv, compare.json and report.html into a folder, which is made if it is not there.
/// @throws FileError  if one cannot be written
CompareFiles write_files(const Comparison& comparison, const std::filesystem::path& folder, const std::string& report);

}  // namespace noether
