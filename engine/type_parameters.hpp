#pragma once
/// Parameters that belong to types of particles and pairs of types: given once, they reach every particle.

#include "engine/particle_system.hpp"
#include "engine/topology.hpp"

#include <optional>
#include <string>
#include <vector>

namespace noether {

/// What is said of one type; what is empty stays as it is.
struct TypeParameters {
  std::string type = {};                           ///< its name
  std::optional<double> mass = {}, charge = {};    ///< [mass], [charge], of every particle of the type
  std::optional<double> epsilon = {}, sigma = {};  ///< Lennard-Jones [energy], [length]; both or none
};

/// What is said of a pair of types, instead of mixing.
struct PairParameters {
  std::string first = {}, second = {};  ///< names of the types
  double epsilon = 0, sigma = 0;        ///< Lennard-Jones [energy], [length]
};

/// The type of a name.
/// @throws Error  if there is none, with a proposal
int type_of_name(const Topology& topology, const std::string& name);

/// Gives types of `topology` and particles of `s` their parameters; particles get charges if a type has one.
///
/// `topology` is the one of `s`, before it is shared. Where one type has Lennard-Jones parameters, all must.
/// @throws Error  at key "type.<k>" or "pair.<k>", counted from 0, for an unknown type, a negative or missing parameter
/// @cost O(n) for each type with a mass or a charge
void set_type_parameters(ParticleSystem<double>& s, Topology& topology, const std::vector<TypeParameters>& types,
                         const std::vector<PairParameters>& pairs = {});

}  // namespace noether
