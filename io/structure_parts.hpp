#pragma once
/// What the readers of structures share: units of files, particles before they are put together, words and numbers.

#include "engine/particle_system.hpp"
#include "io/structure_options.hpp"
#include "io/text_table.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

enum class StructureFormat : std::uint8_t { lammps_data, extended_xyz, gro, gmsh };

/// Factors that take numbers of a file to the units of the particles: number times factor.
struct FileUnits {
  double length = 1, velocity = 1, energy = 1;
  double momentum_velocity = 1;  ///< of a momentum in sqrt(eV u) over a mass in u, as velocity
};

/// The units of a file of this format.
/// @throws Error  at key "file_units" or "units" where they do not fit each other
FileUnits file_units_of(StructureFormat format, const StructureOptions& options);

/// Options with the units that the file says itself: LAMMPS data in its first line, "units = real", XYZ in its comment.
/// @throws SceneError  where they are not read, or the options say others
StructureOptions with_units_of_file(const TextFile& text, StructureFormat format, StructureOptions options);

/// Particles as a file lists them, in the units of the particles.
struct Structure {
  std::vector<std::int64_t> ids;
  std::vector<std::string> names;
  std::vector<double> masses;  ///< not a number: unknown
  std::vector<Vec3<double>> x, v;
  std::vector<Vec3<std::int32_t>> images;  ///< empty: none were given
  std::vector<double> charges;             ///< empty: none were given
  Box box;
  Topology topology;
  std::vector<std::size_t> type_lines;  ///< of the first particle of each type; empty: not told
  /// The temperature that stands beside velocities, in kelvin or reduced, and its line.
  struct StatedTemperature {
    double value;
    std::size_t line;
    bool of_momenta;  ///< those are in one unit, whatever file_units says
  };
  std::optional<StatedTemperature> temperature;
  bool velocity_units_assumed = false;  ///< because nobody says them
  bool pair_style_assumed = false;      ///< of LAMMPS, because nobody says it
  std::optional<Mixing> mixing;         ///< as the program does it that wrote the file
  /// Particles three bonds apart that have a pair force of their own, and what is left of its two parts.
  struct EndPair {
    std::array<Index, 4> particles;  ///< with those between them
    double lennard_jones, charges;
  };
  std::vector<EndPair> end_pairs;
  std::vector<PairKind> end_kinds;  ///< their parameters by type; empty: those of all pairs
  std::map<std::pair<int, int>, PairKind> explicit_end_kinds;
};

/// The standard atomic weight of an element [u]; not a number for what is none, or has none.
/// @throws never
/// @source Meija2016
double standard_atomic_weight(std::string_view element);

/// The symbol of an element by its atomic number, 1 to 118; empty for other numbers.
/// @throws never
std::string_view symbol_of_element(int number);

/// The atomic number of an element; 0 for what is none.
/// @throws never
int number_of_element(std::string_view symbol);

/// The element that a label or a number may mean: "C1", "AR", "ar", "18"; empty where it is none.
/// @throws std::bad_alloc
std::string element_meant_by(std::string_view label);

/// Parts a line at blanks, and leaves out what stands behind `#`.
void split_words(std::string_view line, std::vector<std::string_view>& words);

/// Reads a whole number from `least` to `most`; `what` names it in messages. @throws SceneError
std::int64_t whole_number_in(const TextFile& text, std::size_t line, std::string_view word, std::string_view what,
                             std::int64_t least, std::int64_t most);

/// The box of three edges as numbers of a file. @throws SceneError
Box box_in(const TextFile& text, std::size_t line, const Vec3<double>& edges);

/// Whether a number that ought to be 0 beside these edges of a box is what rounding has left of it: below 1e-10 of
/// each.
/// @throws never
bool is_rounding_beside(double number, const Vec3<double>& edges);

/// Which of the frames of a file is asked for, counted from 0.
/// @throws Error  at key "frame" if there is none of that number
std::size_t frame_of(const StructureOptions& options, std::size_t frames);

/// Tells what the file holds and nobody reads.
void note(const StructureOptions& options, std::string what);

/// Refuses velocities that do not make the temperature that the file states, as those in other units do: where the
/// degrees of freedom that this takes are not between a tenth and three for a particle. Where no temperature is stated
/// and the units are assumed, more than 10 000 K is noted.
/// @throws SceneError
void check_stated_temperature(const TextFile& text, const Structure& structure, const ParticleSystem<double>& s,
                              const StructureOptions& options);

/// All pairs of particles three bonds apart, with what is left of their forces.
std::vector<Structure::EndPair> pairs_three_bonds_apart(const Topology& topology, Index n, double lennard_jones,
                                                        double charges);

/// Makes dihedrals of kind "one_four" of the ends that have a pair force of their own.
/// @throws SceneError  where particles have no Lennard-Jones parameters
void add_end_pairs(const TextFile& text, const Structure& structure, const ParticleSystem<double>& s,
                   Topology& topology);

/// The most particles a file is believed to have.
inline constexpr std::int64_t most_particles = 1'000'000'000;
/// The most types of particles or terms.
inline constexpr std::int64_t most_types = 100'000;

class LammpsScript;

Structure read_lammps_data(const TextFile& text, const LammpsScript& script, const FileUnits& units,
                           const StructureOptions& options);
Structure read_extended_xyz(const TextFile& text, const FileUnits& units, const StructureOptions& options);
Structure read_gro(const TextFile& text, const FileUnits& units, const StructureOptions& options);
Structure read_gmsh(const TextFile& text, const StructureOptions& options);

}  // namespace noether::io
