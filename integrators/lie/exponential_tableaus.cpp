#include "integrators/lie/exponential_products.hpp"

#include <string_view>

namespace noether::tableaus {

namespace {

/// The product of one exponential for each weight, the first stage acting first: a row of Crouch and Grossman.
ExponentialProduct one_by_one(std::string_view row) {
  const std::vector<Quad> weights = coefficients(row);
  ExponentialProduct product;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    product.c += weights[j];
    if (weights[j] == Quad(0)) continue;
    std::vector<Quad> alone(j + 1, Quad(0));
    alone[j] = weights[j];
    product.weights.push_back(alone);
  }
  return product;
}
/// The same from weights of all stages in each exponential.
ExponentialProduct all_stages(std::initializer_list<std::string_view> exponentials, Quad c, int from = 0) {
  return {.from = from, .weights = rows(exponentials), .c = c};
}

}  // namespace

const ExponentialTableau& crouch_grossman_3() {
  static const ExponentialTableau table{
      .stages = {one_by_one("3/4"), one_by_one("119/216 17/108")}, .end = one_by_one("13/51 -2/3 24/17"), .order = 3};
  return table;
}

const ExponentialTableau& crouch_grossman_4() {
  static const ExponentialTableau table{
      .stages = {one_by_one("0.8177227988124852"), one_by_one("0.3199876375476427 0.0659864263556022"),
                 one_by_one("0.9214417194464946 0.4997857776773573 -1.0969984448371582"),
                 one_by_one("0.3552358559023322 0.2390958372307326 1.3918565724203246 -1.1092979392113465")},
      .end = one_by_one("0.1370831520630755 -0.0183698531564020 0.7397813985370780 -0.1907142565505889 "
                        "0.3322195591068374"),
      .order = 4};
  return table;
}

const ExponentialTableau& commutator_free_3() {
  static const ExponentialTableau table{
      .stages = {all_stages({"1/3"}, Quad(1) / Quad(3)), all_stages({"0 2/3"}, Quad(2) / Quad(3))},
      .end = all_stages({"-1/12 0 3/4"}, Quad(1), 1),
      .order = 3};
  return table;
}

const ExponentialTableau& commutator_free_4() {
  static const ExponentialTableau table{.stages = {all_stages({"1/2"}, Quad(0.5)), all_stages({"0 1/2"}, Quad(0.5)),
                                                   all_stages({"-1/2 0 1"}, Quad(1), 1)},
                                        .end = all_stages({"1/4 1/6 1/6 -1/12", "-1/12 1/6 1/6 1/4"}, Quad(1)),
                                        .order = 4};
  return table;
}

const ExponentialTableau* exponential_table(std::string_view name) {
  if (name == "crouch_grossman_3") return &crouch_grossman_3();
  if (name == "crouch_grossman_4") return &crouch_grossman_4();
  if (name == "commutator_free_3") return &commutator_free_3();
  if (name == "commutator_free_4") return &commutator_free_4();
  return nullptr;
}

}  // namespace noether::tableaus
