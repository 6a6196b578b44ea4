#pragma once
/// How far runs of a scene can be compared: as far as they can be paid for, and as far as positions mean anything.

#include "study/allowance.hpp"
#include "study/predictability.hpp"
#include "study/sampling.hpp"

#include <string>

namespace noether {

/// Where roundings have grown to about 1e-10 positions are still told well enough to compare methods by them.
inline constexpr double growth_compared = 1e6;
/// Where they would have grown beyond 1e-8 at the end, the end comes nearer.
inline constexpr double rounding_compared = 1e-8;

/// A sampling that is shorter than it was asked for, and why.
struct Horizon {
  Sampling sampling = {};
  std::string told = {};  ///< in words; empty where it is as asked for
};

/// Of more than `most_bodies` particles: 40 moments, which is enough for errors and their growth, and half as far until
/// a run of eight times the cost of the scene's own fits the budget.
/// @param may_shorten  whether the end may come nearer
/// @param row_budget  seconds of wall time for one run
/// @param work  what this takes is counted there
Horizon affordable_horizon(const Scene& scene, const Sampling& sampling, bool may_shorten, double row_budget,
                           Allowance& work);

/// Of a chaotic motion: half as far until small differences have not grown more than `growth_compared` times.
/// @param may_shorten  whether the end may come nearer; else it is only told where positions are lost
Horizon predictable_horizon(const Scene& scene, const Sampling& sampling, bool may_shorten,
                            const Predictability& motion);

/// Half as far until a run of eight times the cost of the scene's own takes no more than so many seconds, but at least
/// 200 steps of the scene.
/// @param work  what this takes is counted there
double chaotic_energy_end(const Scene& scene, const Sampling& sampling, double seconds, Allowance& work);

/// "0.5 ps", "0.5" in the reduced system.
std::string time_in_words(double time, const Scene& scene);

/// In which time differences grow tenfold, and what this was fitted over: "0.66 ps (fitted over 13 e-foldings)".
/// @param motion  a chaotic one
std::string tenfold_in_words(const Predictability& motion, const Scene& scene);

}  // namespace noether
