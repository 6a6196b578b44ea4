#pragma once
/// Which particles a table of a scene ties: `bodies`, `pairs`, `triples` or `groups` of names, a `surface` of a mesh.

#include "scene/parts.hpp"

#include <map>
#include <string>
#include <vector>

namespace noether {

/// Reads which particles a table ties: names, tuples of names, a `chain` of pairs, all "bonds" or "angles" of a
/// structure, one `surface` of a mesh.
class TiedReader {
 public:
  /// @param particles  of each tuple: 1 `bodies` (or `surface`), 2 `pairs` (or `chain`), 3 `triples`; 0 any number, in
  /// one tuple
  TiedReader(TableReader& reader, std::size_t particles, const ParticleSystem<double>& s);

  /// The particles by their places; what the scene says of them is put into `effective`.
  /// @throws SceneError  if the table names none, or one that is not there
  TiedParticles read(SceneValue& effective);

 private:
  [[noreturn]] void wrong(const SceneValue& value) const;
  std::vector<Index> names(const SceneValue& at, const SceneValue::Array& list) const;
  Index particle(const SceneValue& at, const SceneValue& name) const;
  TiedParticles all() const;
  TiedParticles of_structure(const SceneValue& value) const;
  TiedParticles of_surface(const SceneValue& name) const;
  TiedParticles links(const SceneValue& chain) const;

  TableReader& reader_;
  std::size_t particles_;
  std::string key_;
  const ParticleSystem<double>& s_;
  std::map<std::string, Index> index_;
};

}  // namespace noether
