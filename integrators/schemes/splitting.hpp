#pragma once
/// Splittings into drift and kick of order 2, 4 and 6 for any H = A + B.
/// A new scheme is one more table here and its name in the list at the end; tests and `noether list` follow the list.

#include "integrators/scheme.hpp"

#include <array>

namespace noether::schemes {

// clang-format off

inline constexpr Scheme mclachlan_2_s2 = palindrome(
    {.name = "mclachlan_2_s2", .aliases = "mclachlan2_s2", .summary = "order 2, 2 kicks, drift first",
     .use = "order 2 where accuracy counts a little: less error than verlet for the same kicks",
     .source = "McLachlan1995", .order = {2}, .stability_limit = 2.55315, .printed_digits = 20}, 'A',
    list(0.19318332750378357396_q, rest),
    list(0.5_q));

inline constexpr Scheme mclachlan_s4 = palindrome(
    {.name = "mclachlan_s4", .summary = "order 4, 4 kicks, drift first",
     .use = "moderate accuracy for any splitting",
     .source = "McLachlan1995", .order = {4},
     .exact = "AB", .stability_limit = 3.02997, .printed_digits = 20}, 'A',
    list(0.16913927992207204518_q, -0.29918620390405079951_q, rest),
    list(6_q / 11_q, rest));

inline constexpr Scheme mclachlan_s5 = palindrome(
    {.name = "mclachlan_s5", .summary = "order 4, 5 kicks, drift first",
     .use = "moderate accuracy for any splitting",
     .source = "McLachlan1995", .order = {4},
     .exact = "AB", .stability_limit = 3.0355, .printed_digits = 20}, 'A',
    list(0.089269454226475244887_q, -0.097336042636895508015_q, rest),
    list(0.4_q, -0.1_q, rest));

inline constexpr Scheme pefrl = palindrome(
    {.name = "pefrl", .summary = "order 4, 4 kicks, drift first",
     .use = "moderate accuracy for any splitting, at four kicks per step",
     .source = "OmelyanMryglodFolk2002",
     .order = {4}, .exact = "AB", .stability_limit = 2.98945, .printed_digits = 16}, 'A',
    list(0.1786178958448091_q, -0.06626458266981849_q, rest),
    list(0.7123418310626054_q, rest));

inline constexpr Scheme vefrl = palindrome(
    {.name = "vefrl", .summary = "order 4, 4 kicks, kick first",
     .use = "as pefrl, kick first, with longer steps",
     .source = "OmelyanMryglodFolk2002",
     .order = {4}, .exact = "AB", .stability_limit = 3.46964, .printed_digits = 16}, 'B',
    list(0.1644986515575760_q, 1.235692651138917_q, rest),
    list(0.52094333910398989_q, rest));

inline constexpr Scheme blanes_moan_s6 = palindrome(
    {.name = "blanes_moan_s6", .summary = "order 4, 6 kicks, drift first",
     .use = "the best of order 4 for any splitting",
     .source = "BlanesMoan2002",
     .order = {4}, .exact = "AB", .stability_limit = 3.13282, .printed_digits = 15}, 'A',
    list(0.0792036964311957_q, 0.353172906049774_q, -0.0420650803577195_q, rest),
    list(0.209515106613362_q, -0.143851773179818_q, rest));

inline constexpr Scheme blanes_moan_s10 = palindrome(
    {.name = "blanes_moan_s10", .summary = "order 6, 10 kicks, drift first",
     .use = "the best of order 6 for any splitting",
     .source = "BlanesMoan2002",
     .order = {6}, .exact = "AB", .stability_limit = 3.13425, .printed_digits = 14}, 'A',
    list(0.0502627644003922_q, 0.413514300428344_q, 0.0450798897943977_q, -0.188054853819569_q, 0.541960678450780_q,
         rest),
    list(0.148816447901042_q, -0.132385865767784_q, 0.067307604692185_q, 0.432666402578175_q, rest));

inline constexpr std::array splitting_list = {
    &mclachlan_2_s2, &mclachlan_s4, &mclachlan_s5, &pefrl, &vefrl, &blanes_moan_s6, &blanes_moan_s10};

// clang-format on

}  // namespace noether::schemes
