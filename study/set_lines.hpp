#pragma once
/// The lines that make a scene run as an candidate has run it.

#include "study/candidate.hpp"

#include <string>
#include <vector>

namespace noether {

struct SetLines {
  std::vector<std::string> lines = {};  ///< "integrator.step=0.1", for `--set`, in order
  std::string refusal = {};             ///< why the scene cannot be read with them; empty if it can
};

/// Lines that give a scene the method of an candidate, its Hamiltonian, and a step or a tolerance, up to `end` [time].
///
/// All forces stay; gravity that was part of a splitting becomes the first of them. Keys of [integrator], and
/// coordinates of [hamiltonian], that the scene has written and that mean nothing to the method are taken out.
SetLines set_lines(const Scene& scene, const Candidate& who, const Setting& setting, double end);

}  // namespace noether
