#include "integrators/projection.hpp"

#include "engine/signature.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

void ProjectionOptions::check() const {
  if (onto.empty()) {
    refuse_field("onto", "[]", "is empty; expected some of energy, momentum, angular_momentum, constraints");
  }
  for (const auto& [one, name] : EnumNames<Invariant>::values) {
    if (std::count(onto.begin(), onto.end(), one) > 1) {
      refuse_field("onto", "[" + words() + "]", "has " + std::string(name) + " twice; give it once");
    }
  }
  check_directions();
}

void ProjectionOptions::check_directions() const {
  const bool given = moves.has_value() || !direction.empty();
  if (how == Projection::oblique && !given) {
    refuse_field("how", "oblique", "has no direction; give moves = \"velocities\" or \"positions\", or a direction");
  }
  if (moves.has_value() && !direction.empty()) {
    refuse_field("moves", choice_name(*moves), "and a direction are both given; give one of them");
  }
  if (how != Projection::oblique && given) {
    refuse_field(moves ? "moves" : "direction", "(given)", "is for how = \"oblique\"; take it out, or project so");
  }
  if (!(tolerance >= 0 && tolerance < 1)) {
    refuse_field("tolerance", tolerance, "is not a valid error; 0, which is rounding, or a part of 1 is expected");
  }
  if (!(time_scale > 0 && std::isfinite(time_scale))) {
    refuse_field("time_scale", time_scale, "is not a valid time; a time above 0 is expected");
  }
  if (iterations < 1) refuse_field("iterations", std::to_string(iterations), "is too few; at least 1 is expected");
}

bool ProjectionOptions::has(Invariant one) const { return std::count(onto.begin(), onto.end(), one) > 0; }

std::string ProjectionOptions::cost() const {
  return how == Projection::symmetric
             ? "some 7 iterations a step, each of them the step itself, forces and an energy"
             : "an energy a step; where it moves the state, forces too, and an energy for each iteration, mostly one";
}

std::string ProjectionOptions::words() const {
  std::string text;
  for (const Invariant one : onto) text += (text.empty() ? "" : ", ") + choice_name(one);
  return text;
}

std::string ProjectionOptions::signature() const {
  std::string along;
  for (const double number : direction) along += (along.empty() ? "" : " ") + detail::value_text(number);
  return fmt::format(
      "projection(onto = [{}], how = {}, moves = {}, direction = [{}], norm = {}, time_scale = {}, tolerance = {}, "
      "iterations = {})",
      words(), choice_name(how), moves ? choice_name(*moves) : "none", along, choice_name(norm),
      detail::value_text(time_scale), detail::value_text(tolerance), iterations);
}

}  // namespace noether
