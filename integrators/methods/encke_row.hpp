#pragma once
/// What a step of `EnckeGauss` keeps of bodies, for lanes.

namespace noether {

/// A body about the heaviest one in a step of `EnckeGauss`: rows of eight stages, and vectors.
struct alignas(64) EnckeBody {
  double orbit[3][8] = {};                   ///< k
  double inverse_r2[8] = {}, mu_r3[8] = {};  ///< 1 / |k|^2, mu / |k|^3
  double upper[8][8] = {};                   ///< of the arc's derivative: f, g, f_x, f_eta, f_v, g_x, ...
  double away[3][8] = {}, place[3][8] = {}, pull[3][8] = {};  ///< d; q; G m q / |q|^3
  double perturbation[3][8] = {}, fresh[3][8] = {};           ///< p, as at hand, and by the sweep that goes on
  double rate[6][8] = {};                                     ///< y': of x, of v
  double functions[6][8] = {};                                ///< G_0 to G_5 at the stages
  double arc[8] = {};                                         ///< universal variables of the arcs
  double x0[3] = {}, v0[3] = {};      ///< at the beginning of the step, relative to the heaviest body
  double inverse_size2 = 0;           ///< of p: 1 over the largest |p|^2 of the stages, in the first sweep
  double gm = 0, mu = 0, mu_low = 0;  ///< G m; G (M + m), and what rounding takes from it where that is a perturbation
  double last_s = 0, last_r = 0, last_eta = 0;  ///< of the orbit at the last stage: s, |k|, k . k'
  unsigned missed = 0;  ///< a bit for each stage whose arc is too long, or was not found to rounding
};

/// Two words of a number of eight bodies.
using EightWords = double[2][8];

/// Eight bodies about the heaviest one side by side, in two words. Lanes without a body repeat the first one of their
/// row, with a share of 0. Six numbers are x, y, z and the components of the velocity.
struct alignas(64) EnckeEight {
  EightWords mu = {}, share = {};                           ///< G (M + m), m / (sum of all masses)
  EightWords at[6] = {};                                    ///< where the particles are
  EightWords own[6] = {};                                   ///< relative to the heaviest body
  EightWords moved[6] = {};                                 ///< by the step, relative to the heaviest body
  EightWords sums[6] = {};                                  ///< of the stages' rates, by both words of weights
  double last2[8] = {}, largest2[8] = {}, nearest[8] = {};  ///< of p: the last Legendre coefficient and the largest,
                                                            ///< squared; the largest 1 / |k|^2
  double last_s[8] = {}, last_r[8] = {}, last_eta[8] = {};  ///< as bodies have them
};

/// Weights of stages.
struct alignas(64) EnckeWeights {
  EightWords end = {};  ///< b, in two words
  double last[8] = {};  ///< of the last Legendre coefficient
};

}  // namespace noether
