#pragma once
/// Members of an ensemble eight at a time, one to a lane.

#include "study/ensemble_member.hpp"

#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace noether {

/// Why the members of a scene are run one by one; empty where they go in lanes.
std::string why_alone(const Scene& scene);

/// What has become of a member: its row, or why there is none.
struct EnsembleMember {
  std::int64_t member = 0;
  std::optional<io::EnsembleRow> row;  ///< empty where it was interrupted
  std::string refusal;                 ///< of one whose values make no scene, which has a row nevertheless
};

/// Runs members, at most eight: those of one make side by side in lanes, others by themselves. A member has the bits
/// that it has in a call of its own.
/// @param in_lanes  false: each by itself
/// @throws FileError, LogicError; what is wrong with the scene of a member is told in its place
std::vector<EnsembleMember> run_members(const EnsembleScene& ensemble, std::span<const std::int64_t> members,
                                        bool in_lanes, const std::atomic<bool>* stop);

}  // namespace noether
