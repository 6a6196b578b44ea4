/// `noether version`: which noether this is, what it was built with, and what it uses on this machine.

#include "numbers/version.hpp"
#include "cli/commands.hpp"
#include "io/hdf5_file.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd.hpp"
#include "scene/json.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace noether {

namespace {

/// The compiler of the program, such as "g++ 12.2.0".
std::string compiler() {
#if defined(__clang__)
  return fmt::format("clang++ {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#elif defined(__GNUC__)
  return fmt::format("g++ {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#else
  return "unknown";
#endif
}

constexpr bool has_openmp() {
#if defined(_OPENMP)
  return true;
#else
  return false;
#endif
}

Json version_report() {
  const std::string hdf5 = io::hdf5_version();
  return Json::object({{"schema", "noether.version/1"},
                       {"version", version()},
                       {"commit", commit()},
                       {"compiler", compiler()},
                       {"hdf5", hdf5.empty() ? Json() : Json(hdf5)},
                       {"openmp", has_openmp()},
                       {"simd", name(simd_level())},
                       {"threads", thread_count()}});
}

void print_version() {
  const auto print = [](const char* what, const std::string& value) { fmt::print("{:<12}{}\n", what, value); };
  const std::string hdf5 = io::hdf5_version();
  print("noether", version());
  print("commit", commit());
  print("compiler", compiler());
  print("HDF5", hdf5.empty() ? "none" : hdf5);
  print("SIMD level", std::string(name(simd_level())));
  print("threads", fmt::format("{}{}", thread_count(), has_openmp() ? "" : " (built without OpenMP)"));
}

}  // namespace

void add_version_command(CLI::App& app, const Parts&, int& exit_code) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("version", "version, commit, compiler and HDF5, SIMD level and threads on this machine");
  command->add_flag("--json", *json, "report as one line of JSON");
  command->callback([json, &exit_code] {
    if (*json) {
      fmt::print("{}\n", version_report().text());
    } else {
      print_version();
    }
    exit_code = 0;
  });
}

}  // namespace noether
