#pragma once
/// May a checkpoint go on as this scene?

#include "io/checkpoint.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace noether {

/// Compares the scene in a checkpoint with this one, key by key.
///
/// Title, expectations, verdicts and the end of the run may differ. So may `atol` of particles, where it was the
/// default that it had once and is none now.
/// @returns  warnings, one line each
/// @throws SceneError  naming the first other key that differs
std::vector<std::string> check_same_scene(const io::Checkpoint& checkpoint, const Scene& scene);

/// How a run ended, kept beside the state in its last checkpoint.
struct Ending {
  Outcome outcome;
  double wall_s = 0;
  std::int64_t steps_made = 0;
};
void save_ending(SavedRun& run, const Ending& ending);
/// @throws Error  if the checkpoint has none
Ending load_ending(const io::Checkpoint& checkpoint);

}  // namespace noether
