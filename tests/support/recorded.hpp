#pragma once
/// Figures that other programs gave, kept in files.

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace noether::test {

/// The lines `key value` of a file below tests/data.
inline std::map<std::string, double> recorded(const std::string& path) {
  std::map<std::string, double> values;
  std::ifstream file(std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "data" / path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    double value = 0;
    if (words >> key >> value) values[key] = value;
  }
  return values;
}

/// Those of tests/data/lammps/NAME.energies.txt.
inline std::map<std::string, double> lammps_energies(const std::string& name) {
  return recorded("lammps/" + name + ".energies.txt");
}

}  // namespace noether::test
