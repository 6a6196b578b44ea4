#include "scene/read_tied.hpp"

#include "engine/mesh.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace noether {

namespace {

std::string key_of(std::size_t particles) {
  return particles < 2 ? "bodies" : particles == 2 ? "pairs" : particles == 3 ? "triples" : "groups";
}

std::string example_of(std::size_t particles) {
  std::string tuple;
  for (std::size_t k = 0; k < std::max<std::size_t>(particles, 2); ++k) {
    tuple += fmt::format("{}\"{}\"", k == 0 ? "" : ", ", static_cast<char>('a' + static_cast<int>(k)));
  }
  return particles < 2 ? "[" + tuple + "]" : "[[" + tuple + "]]";
}

}  // namespace

TiedReader::TiedReader(TableReader& reader, std::size_t particles, const ParticleSystem<double>& s)
    : reader_(reader), particles_(particles), key_(key_of(particles)), s_(s) {
  for (Index i = 0; i < s.size(); ++i) index_.emplace(s.name(i), i);
  reader.find(key_);
  if (particles == 1) reader.find("surface");
  if (particles == 2) reader.find("chain");
}

TiedParticles TiedReader::read(SceneValue& effective) {
  const SceneValue* value = reader_.find(key_);
  const SceneValue* chain = particles_ == 2 ? reader_.find("chain") : nullptr;
  if (value != nullptr && chain != nullptr) {
    reader_.fail(chain, "chain",
                 fmt::format("{} and chain are both given in {}; give only one of them", key_, reader_.what()));
  }
  if (chain != nullptr) {
    effective.put("chain", *chain);
    return links(*chain);
  }
  const SceneValue* surface = particles_ == 1 ? reader_.find("surface") : nullptr;
  if (value != nullptr && surface != nullptr) {
    reader_.fail(surface, "surface",
                 fmt::format("bodies and surface are both given in {}; give only one of them", reader_.what()));
  }
  if (surface != nullptr) {
    effective.put("surface", *surface);
    return of_surface(*surface);
  }
  if (value == nullptr) {
    reader_.fail(nullptr, key_,
                 fmt::format("{} does not say which particles it ties; give {} = {}", reader_.what(), key_,
                             example_of(particles_)));
  }
  effective.put(key_, *value);
  if (particles_ == 1 && value->get<std::string>() != nullptr && *value->get<std::string>() == "all") return all();
  if (value->get<std::string>() != nullptr && (particles_ == 2 || particles_ == 3)) return of_structure(*value);
  const auto* list = value->get<SceneValue::Array>();
  if (list == nullptr || list->empty()) wrong(*value);
  TiedParticles tied;
  if (particles_ == 0) return {names(*value, *list)};
  for (const SceneValue& one : *list) {
    if (particles_ == 1) {
      tied.push_back({particle(*value, one)});
      continue;
    }
    const auto* tuple = one.get<SceneValue::Array>();
    if (tuple == nullptr || tuple->size() != particles_) wrong(*value);
    tied.push_back(names(*value, *tuple));
  }
  return tied;
}

void TiedReader::wrong(const SceneValue& value) const {
  const std::string tuples = particles_ < 2 ? "names" : key_ + " of names";
  reader_.fail(&value, key_,
               fmt::format("{} = {} is not a list of {}; a list such as {} is expected", key_, to_text(value), tuples,
                           example_of(particles_)));
}

std::vector<Index> TiedReader::names(const SceneValue& at, const SceneValue::Array& list) const {
  std::vector<Index> particles;
  for (const SceneValue& one : list) particles.push_back(particle(at, one));
  return particles;
}

Index TiedReader::particle(const SceneValue& at, const SceneValue& name) const {
  const std::string* text = name.get<std::string>();
  if (text == nullptr) wrong(at);
  const auto found = index_.find(*text);
  if (found != index_.end()) return found->second;
  reader_.fail(
      &at, key_,
      fmt::format("{} ties '{}', which is not a particle{}", reader_.what(), *text, did_you_mean(*text, s_.names())));
}

TiedParticles TiedReader::all() const {
  TiedParticles tied;
  for (Index i = 0; i < s_.size(); ++i) tied.push_back({i});
  return tied;
}

/// All bonds, or all angles, that a structure has brought.
TiedParticles TiedReader::of_structure(const SceneValue& value) const {
  const std::string terms = particles_ == 2 ? "bonds" : "angles";
  if (*value.get<std::string>() != terms) {
    reader_.fail(
        &value, key_,
        fmt::format("{} = {} is not understood; {} of names are expected, or \"{}\" for all those of the structure",
                    key_, to_text(value), key_, terms));
  }
  TiedParticles tied;
  const Topology none, &topology = s_.topology() != nullptr ? *s_.topology() : none;
  for (const BondedTerm<2>& bond : topology.bonds) {
    if (particles_ == 2) tied.emplace_back(bond.particles.begin(), bond.particles.end());
  }
  for (const BondedTerm<3>& angle : topology.angles) {
    if (particles_ == 3) tied.emplace_back(angle.particles.begin(), angle.particles.end());
  }
  if (tied.empty()) {
    reader_.fail(
        &value, key_,
        fmt::format("{} = \"{}\" ties no particles: there are no {} from a structure or a builder; name the particles",
                    key_, terms, terms));
  }
  return tied;
}

/// The particles of a surface of the mesh.
TiedParticles TiedReader::of_surface(const SceneValue& name) const {
  const std::string* text = name.get<std::string>();
  if (text == nullptr) reader_.wrong_kind(name, "surface", "the name of a surface of the mesh");
  const Mesh* mesh = s_.topology() != nullptr ? s_.topology()->mesh.get() : nullptr;
  if (mesh == nullptr) {
    reader_.fail(
        &name, "surface",
        fmt::format("surface = \"{}\" ties no particles: they have no mesh; name the particles as bodies", *text));
  }
  TiedParticles tied;
  try {
    for (const Index i : mesh->particles_of(mesh->surface(*text))) tied.push_back({i});
  } catch (const Error& error) {
    reader_.fail(&name, "surface", error.message());
  }
  return tied;
}

/// Each particle from the first to the last of `chain` with the next one.
TiedParticles TiedReader::links(const SceneValue& chain) const {
  const auto* ends = chain.get<SceneValue::Array>();
  if (ends == nullptr || ends->size() != 2) {
    reader_.wrong_kind(chain, "chain", "the names of its first and last particle, such as [\"a\", \"z\"]");
  }
  const Index first = particle(chain, ends->front()), last = particle(chain, ends->back());
  if (first >= last)
    reader_.fail(
        &chain, "chain",
        fmt::format("chain = {} goes backwards; give the particles in the order of their table", to_text(chain)));
  TiedParticles tied;
  for (Index i = first; i < last; ++i) tied.push_back({i, i + 1});
  return tied;
}

}  // namespace noether
