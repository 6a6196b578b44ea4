#pragma once
/// Symplectic correctors and kernels of Wisdom-Holman: words around a step of a drift, a kick and a drift.

#include "integrators/scheme.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace noether::schemes {

// clang-format off

/// sqrt(7/40): the drifts of a corrector are multiples of it.
inline constexpr Quad corrector_node = 0.41833001326703777398908601289259374469640768464934_q;

/// Kicks of the correctors in units of 1/(48 corrector_node), the one of the largest node first.
inline constexpr auto corrector_3 = list(1_q / 2_q);
inline constexpr auto corrector_5 = list(-1_q / 6_q, 5_q / 6_q);
inline constexpr auto corrector_7 = list(12361_q / 246960_q, -22651_q / 61740_q, 53521_q / 49392_q);
inline constexpr auto corrector_11 = list(
    2798927_q / 684573120_q, -329447_q / 6985440_q, 895249_q / 3622080_q, -14556229_q / 19015920_q,
    3394141_q / 2328480_q);
inline constexpr auto corrector_17 = list(
    -682938344463443_q / 7846175667762432000_q, 26880679644439_q / 17513784972684000_q,
    -33737961615779_q / 2641809989145600_q, 102433989269_q / 1539673404192_q,
    -27170077124018711_q / 112088223825177600_q, 422297952838709_q / 648658702692000_q,
    -104807478104929387_q / 80063017017984000_q, 45815578591785473_q / 24519298961757600_q);

/// sqrt(7/5760): the kicks of the second corrector.
inline constexpr Quad second_corrector_kick = 0.03486083443891981449909050107438281205803_q;

/// Five kicks that have the error of second order in B that the modified kick has.
inline constexpr auto composed_kernel_drifts = list(5_q / 8_q, -1_q / 4_q, 1_q / 8_q, -1_q / 8_q, 1_q / 4_q, 3_q / 8_q);
inline constexpr auto composed_kernel_kicks = list(-1_q / 6_q, 1_q / 6_q, 1_q, -1_q / 6_q, 1_q / 6_q);

/// Weights of G at both ends of `saba_1` to `saba_4`: half of what removes the error of second order in B.
inline constexpr auto saba_corrections = list(
    1_q / 24_q, 0.005582274842315056384844867885294325688692_q, 0.002817296681561404701133911884898769335781_q,
    0.00169838752410430066576607889174607189851071_q);

// clang-format on

/// The orders of correctors.
inline constexpr std::array<std::int64_t, 5> corrector_orders = {3, 5, 7, 11, 17};

/// The kicks of a corrector; empty where there is none of that order.
constexpr std::span<const Quad> corrector_kicks(std::int64_t order) {
  switch (order) {
    case 3:
      return corrector_3;
    case 5:
      return corrector_5;
    case 7:
      return corrector_7;
    case 11:
      return corrector_11;
    case 17:
      return corrector_17;
    default:
      return {};
  }
}

/// The word of a corrector, Z(-a_n, -b_n) ... Z(-a_1, -b_1) Z(a_1, b_1) ... Z(a_n, b_n) with
///
///     Z(a, b) = A(a) B(-b) A(-2a) B(b) A(a),    a_k = k sqrt(7/40)
///
/// It takes a point near the start to one from which steps of a drift, a kick and a drift have no error in the first
/// power of B, up to the order.
/// @source Wisdom2006
constexpr Word corrector_word(std::int64_t order) {
  Word word;
  const auto add = [&](const Quad& a, const Quad& b) {
    word.push_back({'A', a});
    word.push_back({'B', -b});
    word.push_back({'A', Quad(-2) * a});
    word.push_back({'B', b});
    word.push_back({'A', a});
  };
  const std::span<const Quad> kicks = corrector_kicks(order);
  const std::size_t n = kicks.size();
  const Quad unit = Quad(1) / (Quad(48) * corrector_node);
  for (std::size_t k = 0; k < n; ++k) add(-Quad(static_cast<int>(n - k)) * corrector_node, -kicks[k] * unit);
  for (std::size_t k = n; k-- > 0;) add(Quad(static_cast<int>(n - k)) * corrector_node, kicks[k] * unit);
  return word;
}

/// The word of the second corrector, U(1/2, b) U(-1/2, b). Of the error of kernels in the second power of B it leaves a
/// multiple of [B, [A, [A, [A, B]]]]:
///
///     U(a, b) = A(2a) B(b) A(-2a) B(-b) A(2a) B(-b) A(-2a) B(b)
///
/// @source ReinTamayoBrown2019
constexpr Word second_corrector_word() {
  Word word;
  for (const Quad& a : {1_q, -1_q}) {
    for (const Quad& b : {second_corrector_kick, -second_corrector_kick}) {
      word.push_back({'A', a});
      word.push_back({'B', b});
      word.push_back({'A', -a});
      word.push_back({'B', -b});
    }
  }
  return word;
}

/// The word that undoes another.
constexpr Word inverse(const Word& word) {
  Word back;
  for (std::size_t k = word.size(); k-- > 0;) back.push_back({word[k].letter, -word[k].weight});
  return back;
}

}  // namespace noether::schemes
