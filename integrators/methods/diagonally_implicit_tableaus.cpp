#include "integrators/methods/diagonally_implicit_tableaus.hpp"

#include <utility>

namespace noether::tableaus {

namespace {

Tableau lower_triangular(std::vector<std::vector<Quad>> a, int order) {
  Tableau table;
  table.b = a.back();
  table.c = row_sums(a);
  table.a = std::move(a);
  table.order = order;
  return table;
}

}  // namespace

const Tableau& sdirk_2() {
  static const Tableau table = [] {
    const Quad g = Quad(1) - Quad(1) / sqrt(Quad(2));
    return lower_triangular({{g}, {Quad(1) - g, g}}, 2);
  }();
  return table;
}

const Tableau& sdirk_3() {
  static const Tableau table = [] {
    // The root of x^3 - 3 x^2 + 3 x / 2 - 1/6 between 1/6 and 1/2.
    Quad g = 0.4358665215084589;
    for (int k = 0; k < 4; ++k) {
      g -= (((g - Quad(3)) * g + Quad(1.5)) * g - Quad(1) / Quad(6)) / ((Quad(3) * g - Quad(6)) * g + Quad(1.5));
    }
    const Quad g2 = Quad(6) * g * g;
    return lower_triangular({{g},
                             {(Quad(1) - g) / Quad(2), g},
                             {(Quad(16) * g - g2 - Quad(1)) / Quad(4), (g2 - Quad(20) * g + Quad(5)) / Quad(4), g}},
                            3);
  }();
  return table;
}

const Tableau& sdirk_4() {
  static const Tableau table = lower_triangular(
      rows({"1/4", "1/2 1/4", "17/50 -1/25 1/4", "371/1360 -137/2720 15/544 1/4", "25/24 -49/48 125/16 -85/12 1/4"}),
      4);
  return table;
}

const Tableau& backward_euler() {
  static const Tableau table = lower_triangular(rows({"1"}), 1);
  return table;
}

const Tableau& trapezoidal() {
  static const Tableau table = lower_triangular(rows({"", "1/2 1/2"}), 2);
  return table;
}

}  // namespace noether::tableaus
