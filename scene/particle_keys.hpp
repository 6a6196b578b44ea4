#pragma once
/// Keys of `[particles]` that several sources of particles share: files with their hash, box, types and pairs.

#include "engine/particle_system.hpp"
#include "engine/type_parameters.hpp"
#include "scene/reader.hpp"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// Reads particles from the file that a key names, and keeps name and hash, `<key>_sha256`, in the effective table.
/// @param example  a name for messages, such as "bodies.csv"
/// @param what  how messages call it: "a table of bodies"
/// @param hash_of  the hash, asked for after the particles were read; of all bytes of the file unless it is given
/// @throws SceneError if the name is wrong or the file has changed; FileError, told of the scene's line
ParticleSystem<double> particles_in_file(
    TableReader& reader, const std::string& key, const std::filesystem::path& folder, const std::string& example,
    const std::string& what, SceneValue& effective,
    const std::function<ParticleSystem<double>(const std::filesystem::path&)>& read,
    const std::function<std::string()>& hash_of = {});

/// `box = ["10 nm", "10 nm", "10 nm"]` or `"open"`; empty where the scene says nothing. @throws SceneError
std::optional<Box> read_box(TableReader& reader, SceneValue& effective);

/// Whether `frame` is the number of a frame of a file, and not "barycenter" or "as_given".
bool has_frame_number(TableReader& reader);

/// What is wrong with a text as `frame`, of particles that come from a file with frames or not.
std::string no_such_frame(const std::string& frame, bool has_frames);

/// `mixing`; empty where the scene says nothing. @throws SceneError
std::optional<Mixing> read_mixing(TableReader& reader, SceneValue& effective);

/// What is left of pair forces by the bonds between two particles.
struct SpecialFactors {
  std::array<double, 3> pairs{};                      ///< of all pair forces, or of all but those of charges
  std::optional<std::array<double, 3>> charges = {};  ///< of those of charges, where the scene says them apart
};

/// `special = [s12, s13, s14]`, or two such lists, `special = {lennard_jones = [...], charges = [...]}`.
/// @throws SceneError
SpecialFactors read_special(TableReader& reader, SceneValue& effective);

/// `[[particles.special_pair]]`: pairs, by their ids, with parameters of their own: each is taken out of the pair
/// forces and becomes a term `one_four` of the force `bonded`. @throws SceneError
void read_special_pairs(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective);

/// `exclusions = [[1, 5], [2, 7]]`: takes away the pair forces of particles of these ids. @throws SceneError
void read_exclusions(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective);

/// `[[particles.type]]` and `[[particles.pair]]`. @throws SceneError
std::vector<TypeParameters> read_types(TableReader& reader, SceneValue& effective);
std::vector<PairParameters> read_pairs(TableReader& reader, SceneValue& effective);

/// Ends reading at a body without a mass, or at its M if that is one.
[[noreturn]] void refuse_without_mass(TableReader& body);

/// Ends reading with what is wrong with a key, or with table k of `[[particles.type]]` or `[[particles.pair]]`: an
/// error at key "special", "type.<k>", "pair.<k>".
[[noreturn]] void refuse_particle_key(TableReader& reader, const Error& error);

/// `temperature` and `seed`: velocities of the Maxwell-Boltzmann distribution where the scene asks for them.
/// @throws SceneError
void read_temperature(TableReader& reader, ParticleSystem<double>& s, SceneValue& effective);

}  // namespace noether
