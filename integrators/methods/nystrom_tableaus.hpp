#pragma once
/// Tableaus of Runge-Kutta-Nystroem pairs, as data.

#include "integrators/methods/tableau.hpp"

#include <utility>

namespace noether {

/// k_i = a(t + c_i h, q + c_i h v + h^2 sum a_ij k_j),  q_1 = q + h v + h^2 sum b_q k,  v_1 = v + h sum b_v k.
///
/// Of the pairs here both formulas have b_q = b_v (1 - c), so only weights of the velocity are given.
struct NystromTableau {
  std::vector<std::vector<Quad>> a;
  std::vector<Quad> c, b_v, b_q = {};
  std::vector<Quad> e_v = {}, e_q = {};  ///< weights minus embedded weights

  /// @param embedded  weights of the velocity of the embedded formula
  NystromTableau(std::vector<std::vector<Quad>> table, std::vector<Quad> nodes, std::vector<Quad> weights,
                 const std::vector<Quad>& embedded);

  std::size_t stages() const { return b_v.size(); }
};

namespace tableaus {
/// Dormand, El-Mikkawy and Prince's 12(10) in 17 stages. @source DormandElMikkawyPrince1987
const NystromTableau& dprkn_12();
}  // namespace tableaus

}  // namespace noether
