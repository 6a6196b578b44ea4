#pragma once
/// One member of an ensemble: its scene, and its row.

#include "io/ensemble_file.hpp"
#include "scene/scene.hpp"
#include "study/variation.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// The scene of an ensemble, read once, from which members are made.
class EnsembleScene {
 public:
  /// @param sets  changes beside what varies
  /// @param in_lanes  whether members go side by side where they can: other rows
  /// @throws SceneError  where it cannot be read with the first values of what varies, or has no end
  EnsembleScene(const std::filesystem::path& file, const EnsemblePlan& plan, const std::vector<std::string>& sets,
                bool in_lanes, const Parts& parts);

  const io::EnsembleDefinition& definition() const { return definition_; }
  /// What of the scene was taken otherwise than written, and its warnings.
  const std::vector<std::string>& notes() const { return notes_; }

  /// The scene of a member; brought to a minimum where it asks for one.
  /// @throws Error  where its values make no scene
  SceneRun member(std::int64_t member) const;
  /// The row of a member before it has run: its number and its values, nothing else.
  io::EnsembleRow row(std::int64_t member) const;
  /// Puts into a row how its run has ended.
  /// @param for_each_monitor  calls what it is given with the name and the monitor of each
  void end_row(io::EnsembleRow& row, const Outcome& outcome, const ParticleSystem<double>& settled,
               const std::function<void(const std::function<void(const std::string&, AnyMonitor<double>&)>&)>&
                   for_each_monitor) const;
  /// The row of a member that cannot be made.
  io::EnsembleRow refused(std::int64_t member) const;

 private:
  SceneRun read(const std::vector<double>& values) const;
  void add_columns(Simulation<double>& sim, const Scene& scene);

  std::filesystem::path file_;
  EnsemblePlan plan_;
  std::vector<std::string> sets_;
  Parts parts_;
  SceneValue root_;  ///< as it was written
  VariedKeys keys_;
  io::EnsembleDefinition definition_;
  std::vector<std::string> notes_;
};

/// Runs a member by itself, as `noether run` does. Empty where it was interrupted.
/// @throws Error  where its values make no scene
std::optional<io::EnsembleRow> run_alone(const EnsembleScene& scene, std::int64_t member,
                                         const std::atomic<bool>* stop);

}  // namespace noether
