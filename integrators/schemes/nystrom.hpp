#pragma once
/// Runge-Kutta-Nystroem splittings: quadratic kinetic energy, kicks that depend on positions.
/// A new scheme is one more table here and its name in the list at the end; tests and `noether list` follow the list.

#include "integrators/scheme.hpp"

#include <array>

namespace noether::schemes {

// clang-format off

inline constexpr Scheme mclachlan_sb3a_m4 = palindrome(
    {.name = "mclachlan_sb3a_m4", .summary = "order 4, 4 kicks, drift first",
     .use = "forces of positions, four kicks; srkn6b is more accurate per kick",
     .source = "McLachlan1995",
     .order = {4}, .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 2.96781,
     .printed_digits = 20}, 'A',
    list(0.18819521776883821787_q, -0.021528551102171551201_q, rest),
    list(1.0_q, rest));

inline constexpr Scheme mclachlan_sb3a_m5 = palindrome(
    {.name = "mclachlan_sb3a_m5", .summary = "order 4, 5 kicks, drift first",
     .use = "forces of positions, five kicks; srkn6b is more accurate per kick",
     .source = "McLachlan1995",
     .order = {4}, .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 2.92184,
     .printed_digits = 20}, 'A',
    list(0.40518861839525227722_q, -0.28714404081652408900_q, rest),
    list(-0.041095890410958904110_q, 0.28813559322033898305_q, rest));

inline constexpr Scheme srkn6b = palindrome(
    {.name = "srkn6b", .aliases = "blanes_moan_srkn6b", .summary = "order 4, 6 kicks, kick first",
     .use = "forces of positions, moderate accuracy",
     .source = "BlanesMoan2002", .order = {4},
     .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 3.16347, .printed_digits = 15}, 'B',
    list(0.0829844064174052_q, 0.396309801498368_q, -0.0390563049223486_q, rest),
    list(0.245298957184271_q, 0.604872665711080_q, rest));

inline constexpr Scheme srkn11b = palindrome(
    {.name = "srkn11b", .aliases = "blanes_moan_srkn11b", .summary = "order 6, 11 kicks, kick first",
     .use = "forces of positions, errors from 1e-5 to 1e-13: nearly as good as srkn14a",
     .source = "BlanesMoan2002", .order = {.classical = 6, .outside_class = 4},
     .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 3.14143, .printed_digits = 15}, 'B',
    list(0.0414649985182624_q, 0.198128671918067_q, -0.0400061921041533_q, 0.0752539843015807_q,
         -0.0115113874206879_q, rest),
    list(0.123229775946271_q, 0.290553797799558_q, -0.127049212625417_q, -0.246331761062075_q, 0.357208872795928_q,
         rest));

inline constexpr Scheme srkn14a = palindrome(
    {.name = "srkn14a", .aliases = "blanes_moan_srkn14a", .summary = "order 6, 14 kicks, drift first",
     .use = "forces of positions, errors from 1e-5 to 1e-13: the least work of all",
     .source = "BlanesMoan2002", .order = {.classical = 6, .outside_class = 4},
     .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 3.14093, .printed_digits = 15}, 'A',
    list(0.0378593198406116_q, 0.102635633102435_q, -0.0258678882665587_q, 0.314241403071447_q, -0.130144459517415_q,
         0.106417700369543_q, -0.00879424312851058_q, rest),
    list(0.09171915262446165_q, 0.183983170005006_q, -0.05653436583288827_q, 0.004914688774712854_q,
         0.143761127168358_q, 0.328567693746804_q, rest));

inline constexpr Scheme okunbor_skeel_6_13 = palindrome(
    {.name = "okunbor_skeel_6_13", .aliases = "okunbor_skeel6_13", .summary = "order 6, 7 kicks, drift first",
     .use = "order 6 at seven kicks; srkn11b is more accurate per kick",
     .source = "OkunborSkeel1994", .order = {.classical = 6, .outside_class = 4},
     .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 3.0674, .printed_digits = 17}, 'A',
    list(-1.0130879789171747298_q, 1.1874295737325427070_q, -0.018335852096460590340_q, rest),
    list(0.00016600692650009894_q, -0.37962421426377360608_q, 0.68913741185181063674_q, rest));

inline constexpr Scheme mclachlan_atela_4 = alternating(
    {.name = "mclachlan_atela_4", .aliases = "mclachlan_atela4", .summary = "order 4, 4 kicks, not symmetric",
     .use = "small errors over short times; it is not symmetric",
     .source = "McLachlanAtela1992", .order = {.classical = 4, .outside_class = 3},
     .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 3.03895, .printed_digits = 17}, 'B',
    list(0.1344961992774310892_q, -0.2248198030794208058_q, 0.7563200005156682911_q, rest),
    list(0.5153528374311229364_q, -0.085782019412973646_q, 0.4415830236164665242_q, rest));

inline constexpr Scheme mclachlan_atela_5 = alternating(
    {.name = "mclachlan_atela_5", .aliases = "mclachlan_atela5", .summary = "order 5, 6 kicks, not symmetric",
     .use = "small errors over short times; it is not symmetric",
     .source = "McLachlanAtela1992", .order = {.classical = 5, .outside_class = 3},
     .scheme_class = SchemeClass::rkn, .exact = "AB", .stability_limit = 3.0625, .printed_digits = 17}, 'B',
    list(0.1193900292875672758_q, 0.6989273703824752308_q, -0.1713123582716007754_q, 0.4012695022513534480_q,
         0.0107050818482359840_q, rest),
    list(0.339839625839110000_q, -0.088601336903027329_q, 0.5858564768259621188_q, -0.603039356536491888_q,
         0.3235807965546976394_q, rest));

inline constexpr std::array nystrom_list = {
    &mclachlan_sb3a_m4, &mclachlan_sb3a_m5, &srkn6b, &srkn11b, &srkn14a, &okunbor_skeel_6_13, &mclachlan_atela_4,
    &mclachlan_atela_5};

// clang-format on

}  // namespace noether::schemes
