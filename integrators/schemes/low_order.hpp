#pragma once
/// The classical schemes: symplectic Euler, Verlet, Ruth.
/// A new scheme is one more table here and its name in the list at the end; tests and `noether list` follow the list.

#include "integrators/scheme.hpp"

#include <array>

namespace noether::schemes {

// clang-format off

inline constexpr Scheme symplectic_euler_a = alternating(
    {.name = "symplectic_euler_a", .aliases = "symplectic_euler", .summary = "order 1: kick, then drift",
     .use = "teaching, and where a step may have only one kick and one drift",
     .source = "DeVogelaere1956", .order = {1}, .stability_limit = 2.0}, 'B', list(1_q), list(1_q));

inline constexpr Scheme symplectic_euler_b = alternating(
    {.name = "symplectic_euler_b", .summary = "order 1: drift, then kick",
     .use = "teaching, and as the adjoint of symplectic_euler_a",
     .source = "DeVogelaere1956", .order = {1},
     .stability_limit = 2.0}, 'A', list(1_q), list(1_q));

inline constexpr Scheme verlet = symmetric_composition(
    {.name = "verlet", .aliases = "strang_verlet leapfrog velocity_verlet stormer strang",
     .summary = "order 2, one kick: velocity Verlet, kick first",
     .use = "the first choice where stability, not accuracy, sets the step",
     .source = "Verlet1967", .order = {2},
     .stability_limit = 2.0},
    list(rest));

inline constexpr Scheme lie_group_variational = symmetric_composition(
    {.name = "lie_group_variational", .aliases = "lgvi discrete_moser_veselov",
     .summary = "order 2, one kick: velocity Verlet whose bodies turn by a discrete action on their group of rotations",
     .use = "bodies on their group, and comparison with published runs; exact turns are nearer and take longer steps",
     .source = "LeeLeokMcClamroch2005", .order = {2},
     .rotor = "variational",
     .stability_limit = 2.0},
    list(rest));

inline constexpr Scheme respa = symmetric_composition(
    {.name = "respa", .aliases = "r_respa mts",
     .summary = "order 2: velocity Verlet in multiple time steps, with inner steps of faster forces",
     .use = "forces that are dear and slow beside others that are cheap and fast: meshes and pairs beside bonds",
     .source = "TuckermanBerneMartyna1992", .order = {2}, .nested = true,
     .stability_limit = 2.0},
    list(rest));

inline constexpr Scheme verlet_aba = palindrome(
    {.name = "verlet_aba", .aliases = "position_verlet leapfrog_aba",
     .summary = "order 2, one kick: position Verlet, drift first",
     .use = "Wisdom-Holman as first published; otherwise as verlet",
     .source = "Verlet1967", .order = {2},
     .exact = "A",  // neighbouring steps join their drifts
     .stability_limit = 2.0}, 'A', list(rest), list(rest));

inline constexpr Scheme ruth_3 = alternating(
    {.name = "ruth_3", .aliases = "ruth3", .summary = "order 3, 3 kicks, not symmetric",
     .use = "history; pefrl costs one more kick and gains an order",
     .source = "Ruth1983",
     .order = {3}, .exact = "AB", .stability_limit = 2.50748}, 'B',
    list(7_q / 24_q, 3_q / 4_q, -1_q / 24_q),
    list(2_q / 3_q, -2_q / 3_q, 1_q));

inline constexpr std::array classical_list = {
    &symplectic_euler_a, &symplectic_euler_b, &verlet, &lie_group_variational, &respa, &verlet_aba,
    &ruth_3};

// clang-format on

}  // namespace noether::schemes
