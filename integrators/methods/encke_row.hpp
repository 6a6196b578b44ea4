#pragma once
/// What a step of `EnckeGauss` keeps of a body, for lanes.

namespace noether {

/// A body about the heaviest one in a step of `EnckeGauss`: vectors, and rows of eight stages.
struct EnckeBody {
  double x0[3] = {}, v0[3] = {};             ///< at the beginning of the step, relative to the heaviest body
  double gm = 0, mu = 0;                     ///< G m, G (M + m)
  double orbit[3][8] = {};                   ///< k
  double inverse_r2[8] = {}, mu_r3[8] = {};  ///< 1 / |k|^2, mu / |k|^3
  double upper[8][8] = {};                   ///< of the arc's derivative: f, g, f_x, f_eta, f_v, g_x, ...
  double away[3][8] = {}, place[3][8] = {}, pull[3][8] = {};  ///< d; q; G m q / |q|^3
  double perturbation[3][8] = {}, fresh[3][8] = {};           ///< p, as at hand, and by the sweep that goes on
  double rate_x[3][8] = {}, rate_v[3][8] = {};                ///< y'
  double change2[8] = {}, size2[8] = {};                      ///< of p by the last sweep, and the larger of both p
};

}  // namespace noether
