#pragma once
/// Symmetric compositions of Verlet, orders 8 and 10.
/// A new scheme is one more table here and its name in the list at the end; tests and `noether list` follow the list.

#include "integrators/scheme.hpp"

#include <array>

namespace noether::schemes {

// clang-format off

inline constexpr Scheme yoshida_8_a = symmetric_composition(
    {.name = "yoshida_8_a", .aliases = "yoshida8_a", .summary = "order 8, symmetric composition of 15 steps",
     .use = "comparison with published runs only: large weights, short steps",
     .source = "Yoshida1990", .order = {8}, .stability_limit = 0.92744, .printed_digits = 21},
    list(1.04242620869970426435_q, 1.82020630970698006933_q, 0.157739928123708321343_q, 2.44002732616634406382_q,
         -0.00716989419709533209981_q, -2.44699182370424588929_q, -1.61582374150065378479_q, rest));

inline constexpr Scheme yoshida_8_b = symmetric_composition(
    {.name = "yoshida_8_b", .aliases = "yoshida8_b", .summary = "order 8, symmetric composition of 15 steps",
     .use = "comparison with published runs only: large weights, short steps",
     .source = "Yoshida1990", .order = {8}, .stability_limit = 1.12108, .printed_digits = 21},
    list(1.48819229202921310080_q, -2.33864815101041943098_q, 2.89105148972198900311_q, -2.89688250330423987105_q,
         0.00378039588362668223674_q, 2.89195744315817391244_q, -0.00169248587771706559145_q, rest));

inline constexpr Scheme yoshida_8_c = symmetric_composition(
    {.name = "yoshida_8_c", .aliases = "yoshida8_c", .summary = "order 8, symmetric composition of 15 steps",
     .use = "comparison with published runs only: large weights, short steps",
     .source = "Yoshida1990", .order = {8}, .stability_limit = 1.21651, .printed_digits = 21},
    list(0.629030650210427818049_q, 1.36934946416874222370_q, -1.06458714789183904181_q, 1.66335809963311356298_q,
         -1.67896928259637402925_q, -1.55946803821449795876_q, 0.311790812418431890510_q, rest));

inline constexpr Scheme yoshida_8 = symmetric_composition(
    {.name = "yoshida_8", .aliases = "yoshida8_d yoshida_8_d",
     .summary = "order 8, symmetric composition of 15 steps",
     .use = "comparison with published runs; kahan_li_8_s17 is far more accurate",
     .source = "Yoshida1990", .order = {8},
     .stability_limit = 2.35651, .printed_digits = 21},
    list(0.914844246229642658287_q, 0.253693336566286009974_q, -1.44485223686030647660_q, -0.158240635368502468458_q,
         1.93813913762291232471_q, -1.96061023297558163691_q, 0.102799849392219431139_q, rest));

inline constexpr Scheme yoshida_8_e = symmetric_composition(
    {.name = "yoshida_8_e", .aliases = "yoshida8_e", .summary = "order 8, symmetric composition of 15 steps",
     .use = "comparison with published runs only: large weights, short steps",
     .source = "Yoshida1990", .order = {8}, .stability_limit = 1.79768, .printed_digits = 21},
    list(1.30300165757516838484_q, 0.107990467718098279648_q, -2.04809795883490205633_q, 0.00536018921375238082832_q,
         -0.0719180053650705075005_q, 2.52778927318028339169_q, 0.0227738840126312259937_q, rest));

inline constexpr Scheme suzuki_umeno_8_s15 = symmetric_composition(
    {.name = "suzuki_umeno_8_s15", .aliases = "suzuki_umeno8_s15 mclachlan_ss15",
     .summary = "order 8, symmetric composition of 15 steps",
     .use = "order 8 with the fewest kicks that are useful",
     .source = "SuzukiUmeno1993", .order = {8},
     .stability_limit = 3.39323},
    list(0.7416703643506129534482278017838063156035_q, -0.4091008258000315939973000958935634173099_q,
         0.1907547102962383799538762564503716627355_q, -0.5738624711160822666563877266355357421595_q,
         0.2990641813036559238444635406886029882258_q, 0.3346249182452981837849579798821822886337_q,
         0.3152930923967665966320566638110024309941_q, rest));

inline constexpr Scheme kahan_li_8_s17 = symmetric_composition(
    {.name = "kahan_li_8_s17", .aliases = "kahan_li8_s17",
     .summary = "order 8, symmetric composition of 17 steps",
     .use = "relative errors of 1e-10 and less for any splitting",
     .source = "KahanLi1997", .order = {8},
     .stability_limit = 3.09644, .printed_digits = 26},
    list(0.13020248308889008087881763_q, 0.56116298177510838456196441_q, -0.38947496264484728640807860_q,
         0.15884190655515560089621075_q, -0.39590389413323757733623154_q, 0.18453964097831570709183254_q,
         0.25837438768632204729397911_q, 0.29501172360931029887096624_q, rest));

inline constexpr Scheme mclachlan_ss17 = symmetric_composition(
    {.name = "mclachlan_ss17", .aliases = "mclachlan_8_ss17",
     .summary = "order 8, symmetric composition of 17 steps",
     .use = "as kahan_li_8_s17, of nearly the same weights",
     .source = "McLachlan1995", .order = {8},
     .stability_limit = 3.08713, .printed_digits = 19},
    list(0.12886597938144329897_q, 0.5815140871052509624_q, -0.41017537146985013753_q, 0.1851469357165877327_q,
         -0.40955234342085141934_q, 0.14440594108001204106_q, 0.27833550039367965131_q, 0.31495668391629485789_q,
         rest));

inline constexpr Scheme morales_8_s17 = symmetric_composition(
    {.name = "morales_8_s17", .aliases = "morales8_s17", .summary = "order 8, symmetric composition of 17 steps",
     .use = "relative errors of 1e-10 and less, a little below kahan_li_8_s17",
     .source = "MoralesEtAl2022", .order = {8}, .stability_limit = 3.0982, .printed_digits = 32},
    list(0.12783360986284110837857554950443_q, 0.56148845266356446893590729572808_q,
         -0.38400573301491401473462588779099_q, 0.15982762208609923217390166127256_q,
         -0.40049110428180105319963667975074_q, 0.18669648149540687549831902999911_q,
         0.26020394234904150277316667709864_q, 0.29137384767986663096528500968049_q, rest));

inline constexpr Scheme sofroniou_spaletta_8_s21 = symmetric_composition(
    {.name = "sofroniou_spaletta_8_s21", .aliases = "sofroniou_spaletta8_s21",
     .summary = "order 8, symmetric composition of 21 steps",
     .use = "relative errors of 1e-10 and less with long steps",
     .source = "SofroniouSpaletta2005", .order = {8},
     .stability_limit = 3.13701, .printed_digits = 32},
    list(0.10647728984550031823931967854896_q, 0.10837408645835726397433410591546_q,
         0.35337821052654342419534541324080_q, -0.23341414023165082198780281128319_q,
         -0.24445266791528841269462171413216_q, 0.11317848435755633314700952515599_q,
         0.11892905625000350062692972283951_q, 0.12603912321825988140305670268365_q,
         0.12581718736176041804392391641587_q, 0.11699135019217642180722881433533_q, rest));

inline constexpr Scheme kahan_li_10_s33 = symmetric_composition(
    {.name = "kahan_li_10_s33", .aliases = "kahan_li10_s33",
     .summary = "order 10, symmetric composition of 33 steps",
     .use = "errors at rounding in extended precision; in double precision order 8 does it with less work",
     .source = "KahanLi1997", .order = {10},
     .stability_limit = 2.96727, .printed_digits = 20},
    list(0.12313526870982994083_q, 0.77644981696937310520_q, 0.14905490079567045613_q, -0.17250761219393744420_q,
         -0.54871240818800177942_q, 0.14289765421841842100_q, -0.31419193263986861997_q, 0.12670943739561041022_q,
         0.17444734584181312998_q, 0.44318544665428572929_q, -0.81948900568299084419_q, 0.13382545738489583020_q,
         0.64509023524410605020_q, -0.71936337169922060719_q, 0.20951381813463649682_q, -0.26828113140636051966_q,
         rest));

inline constexpr Scheme sofroniou_spaletta_10_s35 = symmetric_composition(
    {.name = "sofroniou_spaletta_10_s35", .aliases = "sofroniou_spaletta10_s35",
     .summary = "order 10, symmetric composition of 35 steps",
     .use = "the smallest errors of any splitting here, extended precision above all",
     .source = "SofroniouSpaletta2005", .order = {10},
     .stability_limit = 3.14108, .printed_digits = 32},
    list(0.078795722521686419263907679337684_q, 0.31309610341510852776481247192647_q,
         0.027918383235078066109520273275299_q, -0.22959284159390709415121339679655_q,
         0.13096206107716486317465685927961_q, -0.26973340565451071434460973222411_q,
         0.074973343155891435666137105641410_q, 0.11199342399981020488957508073640_q,
         0.36613344954622675119314812353150_q, -0.39910563013603589787862981058340_q,
         0.10308739852747107731580277001372_q, 0.41143087395589023782070411897608_q,
         -0.0048663605831352617621956593099771_q, -0.39203335370863990644808193642610_q,
         0.051942502962449647037182904015976_q, 0.050665090759924496335874344156866_q,
         0.049674370639729879054568800279461_q, rest));

inline constexpr std::array symmetric_8_10_list = {
    &yoshida_8_a, &yoshida_8_b, &yoshida_8_c, &yoshida_8, &yoshida_8_e, &suzuki_umeno_8_s15, &kahan_li_8_s17,
    &mclachlan_ss17, &morales_8_s17, &sofroniou_spaletta_8_s21, &kahan_li_10_s33, &sofroniou_spaletta_10_s35};

// clang-format on

}  // namespace noether::schemes
