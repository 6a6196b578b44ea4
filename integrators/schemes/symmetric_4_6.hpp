#pragma once
/// Symmetric compositions of Verlet, orders 4 and 6.
/// A new scheme is one more table here and its name in the list at the end; tests and `noether list` follow the list.

#include "integrators/scheme.hpp"

#include <array>

namespace noether::schemes {

// clang-format off

inline constexpr Scheme yoshida_4 = symmetric_composition(
    {.name = "yoshida_4", .aliases = "yoshida4_forest_ruth forest_ruth candy_rozmus_4",
     .summary = "order 4, symmetric composition of 3 steps",
     .use = "comparison with published runs; pefrl and blanes_moan_s6 are far more accurate per kick",
     .source = "ForestRuth1990", .order = {4},
     .stability_limit = 1.5734, .printed_digits = 32},
    list(1.3512071919596576340476878089715_q, rest));

inline constexpr Scheme suzuki_4 = symmetric_composition(
    {.name = "suzuki_4", .aliases = "suzuki4", .summary = "order 4, symmetric composition of 5 steps",
     .use = "order 4 from any step of order 2, with moderate negative ones",
     .source = "Suzuki1990", .order = {4}, .stability_limit = 2.72097, .printed_digits = 30},
    list(0.414490771794375737142354062861_q, 0.414490771794375737142354062861_q, rest));

inline constexpr Scheme mclachlan_ss5 = symmetric_composition(
    {.name = "mclachlan_ss5", .aliases = "mclachlan_4_ss5",
     .summary = "order 4, symmetric composition of 5 steps",
     .use = "order 4 from any step of order 2, the most accurate of five",
     .source = "McLachlan1995", .order = {4},
     .stability_limit = 3.01818, .printed_digits = 19},
    list(0.28_q, 0.6254664284676700450_q, rest));

inline constexpr Scheme yoshida_6 = symmetric_composition(
    {.name = "yoshida_6", .aliases = "yoshida6_a yoshida_6_a",
     .summary = "order 6, symmetric composition of 7 steps",
     .use = "comparison with published runs; blanes_moan_s10 is more accurate per kick",
     .source = "Yoshida1990", .order = {6},
     .stability_limit = 2.26906},
    list(0.7845136104775572638194976338663498757768_q, 0.2355732133593581336847931829785346016865_q,
         -1.177679984178871006946415680964315734639_q, rest));

inline constexpr Scheme yoshida_6_b = symmetric_composition(
    {.name = "yoshida_6_b", .aliases = "yoshida6_b", .summary = "order 6, symmetric composition of 7 steps",
     .use = "comparison with published runs only: its steps must be short",
     .source = "Yoshida1990", .order = {6}, .stability_limit = 1.38435, .printed_digits = 18},
    list(1.43984816797678309102_q, 0.00426068187079201616_q, -2.13228522200145152088_q, rest));

inline constexpr Scheme yoshida_6_c = symmetric_composition(
    {.name = "yoshida_6_c", .aliases = "yoshida6_c", .summary = "order 6, symmetric composition of 7 steps",
     .use = "comparison with published runs only: its steps must be short",
     .source = "Yoshida1990", .order = {6}, .stability_limit = 1.36505, .printed_digits = 21},
    list(1.44778256239929793290_q, -2.14403531630538931060_q, 0.00152886228424927025338_q, rest));

inline constexpr Scheme kahan_li_6_s9 = symmetric_composition(
    {.name = "kahan_li_6_s9", .aliases = "kahan_li6_s9", .summary = "order 6, symmetric composition of 9 steps",
     .use = "order 6 from any step of order 2, such as RATTLE",
     .source = "KahanLi1997", .order = {6}, .stability_limit = 2.53263, .printed_digits = 25},
    list(0.39216144400731413927925056_q, 0.33259913678935943859974864_q, -0.70624617255763935980996482_q,
         0.08221359629355080023149045_q, rest));

inline constexpr Scheme mclachlan_ss9 = symmetric_composition(
    {.name = "mclachlan_ss9", .aliases = "mclachlan_6_ss9",
     .summary = "order 6, symmetric composition of 9 steps",
     .use = "order 6 from any step of order 2, such as RATTLE",
     .source = "McLachlan1995", .order = {6},
     .stability_limit = 2.7031, .printed_digits = 20},
    list(0.1867_q, 0.55549702371247839916_q, 0.12946694891347535806_q, -0.84326562338773460855_q, rest));

inline constexpr Scheme sofroniou_spaletta_6_s11 = symmetric_composition(
    {.name = "sofroniou_spaletta_6_s11", .aliases = "sofroniou_spaletta6_s11",
     .summary = "order 6, symmetric composition of 11 steps",
     .use = "order 6 from any step of order 2, smaller errors per kick than nine steps",
     .source = "SofroniouSpaletta2005", .order = {6},
     .stability_limit = 2.95729, .printed_digits = 32},
    list(0.21375583945878254555518066964857_q, 0.18329381407425713911385974425217_q,
         0.17692819473098943794898811709929_q, -0.44329082681170215849622829626258_q,
         0.11728560432865935385403585669136_q, rest));

inline constexpr Scheme sofroniou_spaletta_6_s13 = symmetric_composition(
    {.name = "sofroniou_spaletta_6_s13", .aliases = "sofroniou_spaletta6_s13",
     .summary = "order 6, symmetric composition of 13 steps",
     .use = "order 6 from any step of order 2, the longest steps of its order",
     .source = "SofroniouSpaletta2005", .order = {6},
     .stability_limit = 3.0716, .printed_digits = 32},
    list(0.13861930854051695245808013042625_q, 0.13346562851074760407046858832209_q,
         0.13070531011449225190542755785015_q, 0.12961893756907034772505366537091_q,
         -0.35000324893920896516170830911323_q, 0.11805530653002387170273438954049_q, rest));

inline constexpr std::array symmetric_4_6_list = {
    &yoshida_4, &suzuki_4, &mclachlan_ss5, &yoshida_6, &yoshida_6_b, &yoshida_6_c, &kahan_li_6_s9, &mclachlan_ss9,
    &sofroniou_spaletta_6_s11, &sofroniou_spaletta_6_s13};

// clang-format on

}  // namespace noether::schemes
