#pragma once
/// What builders of particles have in common.

#include "engine/particle_system.hpp"
#include "numbers/random.hpp"
#include "scene/lattice_kind.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace noether::detail {

/// Streams of a seed: what is drawn for one purpose does not depend on another.
enum Stream : std::uint32_t { velocity_stream = 1, vacancy_stream, displacement_stream, walk_stream, turn_stream };

/// The most particles that a builder makes.
constexpr std::int64_t most_built = 100'000'000;

using Site = Vec3<double>;

/// All sites of a lattice, cell by cell, in edges of a cell.
std::vector<Site> all_sites(LatticeKind kind, const std::vector<std::int64_t>& cells);
/// Sites of one cell.
std::size_t sites_of_cell(LatticeKind kind);

/// @throws Error  for what is not a finite number above 0. @param what  in words: "density"
void check_above_zero(std::string_view key, double value, const char* what);
/// @throws Error  for a number that is not from `least` to `most`
void check_count(std::string_view key, std::int64_t value, std::int64_t least, std::int64_t most = most_built);
/// @throws Error  for one below 0
void check_temperature(const std::optional<double>& temperature);

/// A periodic box with edges of one length.
Box cube(double edge);

/// A vector of length 1 in any direction.
Vec3<double> direction(Philox& random);

/// A whole number below `count` [count below 2^32].
std::size_t lot(Philox& random, std::size_t count);

/// Takes sites out by lot until so many are left.
void leave_vacancies(std::vector<Site>& sites, std::size_t wanted, std::int64_t seed);

/// Moves the centre of mass to rest; returns twice the kinetic energy that is left. Plain sums, made once before a run
/// begins, in the order of ids: their roundings stand in the trajectories of all runs that begin so.
double take_off_drift(ParticleSystem<double>& s);

}  // namespace noether::detail
