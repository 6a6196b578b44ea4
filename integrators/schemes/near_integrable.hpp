#pragma once
/// Splittings for near-integrable systems, H = A + eps B: Wisdom-Holman and its high-order relatives.
/// A new scheme is one more table here and its name in the list at the end; tests and `noether list` follow the list.

#include "integrators/scheme.hpp"

#include <array>

namespace noether::schemes {

// clang-format off

inline constexpr Scheme saba_1 = palindrome(
    {.name = "saba_1", .aliases = "saba1", .summary = "order (2, 2) for H = A + eps B, 1 kicks",
     .use = "planets: Wisdom-Holman, drift first",
     .source = "LaskarRobutel2001", .order = {2, {2, 2, 0}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "A", .stability_limit = 2.0}, 'A',
    list(0.5_q),
    list(1_q));

inline constexpr Scheme saba_2 = palindrome(
    {.name = "saba_2", .aliases = "saba2", .summary = "order (4, 2) for H = A + eps B, 2 kicks",
     .use = "planets where all steps must go forward",
     .source = "LaskarRobutel2001", .order = {2, {4, 2, 0}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "A", .stability_limit = 2.63215}, 'A',
    list(0.2113248654051871177454256097490212721762_q, rest),
    list(0.5_q));

inline constexpr Scheme saba_3 = palindrome(
    {.name = "saba_3", .aliases = "saba3", .summary = "order (6, 2) for H = A + eps B, 3 kicks",
     .use = "planets where all steps must go forward",
     .source = "LaskarRobutel2001", .order = {2, {6, 2, 0}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "A", .stability_limit = 2.88729}, 'A',
    list(0.1127016653792583114820734600217600389167_q, rest),
    list(0.2777777777777777777777777777777777777778_q, rest));

inline constexpr Scheme saba_4 = palindrome(
    {.name = "saba_4", .aliases = "saba4_aba82 saba4 aba_8_2",
     .summary = "order (8, 2) for H = A + eps B, 4 kicks",
     .use = "planets of small masses where all steps must go forward",
     .source = "LaskarRobutel2001",
     .order = {2, {8, 2, 0}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "A", .stability_limit = 3.00981}, 'A',
    list(0.06943184420297371238802675555359524745214_q, 0.2605776340045981552106403648947824089476_q, rest),
    list(0.1739274225687269286865319746109997036177_q, rest));

inline constexpr Scheme aba_8_4 = palindrome(
    {.name = "aba_8_4", .aliases = "aba84", .summary = "order (8, 4) for H = A + eps B, 5 kicks",
     .use = "planets of moderate masses, five kicks",
     .source = "McLachlan1995b", .order = {4, {8, 4, 0}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "AB", .stability_limit = 3.34986, .printed_digits = 15}, 'A',
    list(0.0753469602698929_q, 0.5179168546882568_q, rest),
    list(0.1902259393736766_q, 0.8465240704435263_q, rest));

inline constexpr Scheme aba_10_4 = palindrome(
    {.name = "aba_10_4", .aliases = "aba104", .summary = "order (10, 4) for H = A + eps B, 7 kicks",
     .use = "planets of small masses",
     .source = "BlanesEtAl2013", .order = {4, {10, 4, 0}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "AB", .stability_limit = 3.08962}, 'A',
    list(0.04706710064597250612947887637243678556564_q, 0.1847569354170881069247376193702560968574_q,
         0.2827060056798362053243616565541452479160_q, rest),
    list(0.1188819173681970199453503950853885936957_q, 0.2410504605515015657441667865901651105675_q,
         -0.2732866667053238060543113981664559460630_q, rest));

inline constexpr Scheme aba_8_6_4 = palindrome(
    {.name = "aba_8_6_4", .aliases = "aba864", .summary = "order (8, 6, 4) for H = A + eps B, 7 kicks",
     .use = "planets, a little less work than aba_10_6_4 at larger errors",
     .source = "BlanesEtAl2013", .order = {4, {8, 6, 4}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "AB", .stability_limit = 3.14218}, 'A',
    list(0.0711334264982231177779387300061549964174_q, 0.241153427956640098736487795326289649618_q,
         0.521411761772814789212136078067994229991_q, rest),
    list(0.183083687472197221961703757166430291072_q, 0.310782859898574869507522291054262796375_q,
         -0.0265646185119588006972121379164987592663_q, rest));

inline constexpr Scheme aba_10_6_4 = palindrome(
    {.name = "aba_10_6_4", .aliases = "aba1064", .summary = "order (10, 6, 4) for H = A + eps B, 8 kicks",
     .use = "planets in Jacobi coordinates over millions of years",
     .source = "BlanesEtAl2013", .order = {4, {10, 6, 4}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "AB", .stability_limit = 3.14611}, 'A',
    list(0.03809449742241219545697532230863756534060_q, 0.1452987161169137492940200726606637497442_q,
         0.2076276957255412507162056113249882065158_q, 0.4359097036515261592231548624010651844006_q, rest),
    list(0.09585888083707521061077150377145884776921_q, 0.2044461531429987806805077839164344779763_q,
         0.2170703479789911017143385924306336714532_q, rest));

inline constexpr Scheme abah_8_4_4 = palindrome(
    {.name = "abah_8_4_4", .aliases = "abah844", .summary = "order (8, 4, 4) for H = A + eps B, 6 kicks",
     .use = "planets in democratic coordinates, six kicks",
     .source = "BlanesEtAl2013", .order = {4, {8, 4, 4}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "A", .stability_limit = 3.46343}, 'A',
    list(0.2741402689434018761640565440378637101205_q, -0.1075684384401642306251105297063236526845_q,
         -0.0480185025906016926911954171508475065370_q, rest),
    list(0.6408857951625127177322491164716010349386_q, -0.8585754489567828565881283246356000103664_q, rest));

inline constexpr Scheme abah_8_6_4 = palindrome(
    {.name = "abah_8_6_4", .aliases = "abah864", .summary = "order (8, 6, 4) for H = A + eps B, 8 kicks",
     .use = "planets in democratic coordinates",
     .source = "BlanesEtAl2013", .order = {4, {8, 6, 4}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "A", .stability_limit = 3.18984}, 'A',
    list(0.06810235651658372084723976682061164571212_q, 0.2511360387221033233072829580455350680082_q,
         -0.07507264957216562516006821767601620052338_q, -0.009544719701745007811488218957217113269121_q, rest),
    list(0.1684432593618954534310382697756917558148_q, 0.4243177173742677224300351657407231801453_q,
         -0.5858109694681756812309015355404036521923_q, rest));

inline constexpr Scheme abah_10_6_4 = palindrome(
    {.name = "abah_10_6_4", .aliases = "abah1064", .summary = "order (10, 6, 4) for H = A + eps B, 9 kicks",
     .use = "planets in democratic coordinates over millions of years",
     .source = "BlanesEtAl2013", .order = {4, {10, 6, 4}}, .scheme_class = SchemeClass::near_integrable,
     .exact = "A", .stability_limit = 3.14569}, 'A',
    list(0.04731908697653382270404371796320813250988_q, 0.2651105235748785159539480036185693201078_q,
         -0.009976522883811240843267468164812380613143_q, -0.05992919973494155126395247987729676004016_q, rest),
    list(0.1196884624585322035312864297489892143852_q, 0.3752955855379374250420128537687503199451_q,
         -0.4684593418325993783650820409805381740605_q, 0.3351397342755897010393098942949569049275_q, rest));

inline constexpr std::array near_integrable_list = {
    &saba_1, &saba_2, &saba_3, &saba_4, &aba_8_4, &aba_10_4, &aba_8_6_4, &aba_10_6_4, &abah_8_4_4, &abah_8_6_4,
    &abah_10_6_4};

// clang-format on

}  // namespace noether::schemes
