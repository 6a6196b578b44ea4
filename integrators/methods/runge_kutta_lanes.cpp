#include "integrators/lane_method.hpp"
#include "integrators/methods/explicit_tableaus.hpp"
#include "integrators/methods/lane_sums_simd.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace noether::lane_methods {

namespace {

/// Weights and rates of the terms of a sum that are there.
struct LaneTerms {
  std::vector<double> weights;
  std::vector<std::size_t> stages;

  explicit LaneTerms(const std::vector<Quad>& row) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (row[j] == Quad(0)) continue;
      weights.push_back(static_cast<double>(row[j]));
      stages.push_back(j);
    }
  }
};

/// Any explicit tableau, as `RungeKutta` with steps of one length.
class RungeKuttaLanes final : public LaneMethod {
 public:
  explicit RungeKuttaLanes(const Tableau& table)
      : first_same_as_last_(table.first_same_as_last),
        c_(as_real<double>(table.c)),
        end_(table.b),
        k_(table.stages()),
        terms_(table.stages()) {
    for (const auto& row : table.a) rows_.emplace_back(row);
  }

  std::vector<LaneNumbers*> memory() override {
    if (!first_same_as_last_) return {};
    return {&k_[0]};
  }
  void begin(LaneField& f, double t, double h, const LaneNumbers& y) override {
    h_ = h;
    for (LaneNumbers& k : k_) k.resize(y.size());
    y1_.resize(y.size());
    if (first_same_as_last_) rate(f, t, y, k_[0]);
  }
  std::optional<Failure> step(LaneField& f, double t, LaneNumbers& y) override {
    if (!first_same_as_last_) rate(f, t, y, k_[0]);
    for (std::size_t i = 1; i < k_.size(); ++i) {
      combine(rows_[i], y, y1_);
      rate(f, t + c_[i] * h_, y1_, k_[i]);
    }
    if (!first_same_as_last_) {
      combine(end_, y, y);
    } else {  // the last stage stands at the new point already
      std::swap(y, y1_);
      std::swap(k_.front(), k_.back());
    }
    return {};
  }

 private:
  /// y' = (v, a).
  void rate(LaneField& f, double t, const LaneNumbers& y, LaneNumbers& dy) const {
    const auto half = static_cast<std::ptrdiff_t>(y.size() / 2);
    std::copy(y.begin() + half, y.end(), dy.begin());
    f.accelerations(t, y.data(), y.data() + half, dy.data() + half);
  }
  void combine(const LaneTerms& of, const LaneNumbers& y, LaneNumbers& out) {
    for (std::size_t j = 0; j < of.stages.size(); ++j) terms_[j] = k_[of.stages[j]].data();
    lane_sums_kernels().sum({.n = static_cast<std::ptrdiff_t>(y.size() / LaneField::lanes),
                             .y = y.data(),
                             .v = nullptr,
                             .h = h_,
                             .c = 0,
                             .g = 1,
                             .terms = std::ssize(of.stages),
                             .k = terms_.data(),
                             .w = of.weights.data(),
                             .out = out.data()});
  }

  bool first_same_as_last_;
  std::vector<double> c_;
  std::vector<LaneTerms> rows_;
  LaneTerms end_;
  std::vector<LaneNumbers> k_;
  std::vector<const double*> terms_;  ///< work
  LaneNumbers y1_;
  double h_ = 0;
};

}  // namespace

std::unique_ptr<LaneMethod> runge_kutta(const MethodChoice& choice) {
  for (const tableaus::NamedTableau& known : tableaus::all_explicit()) {
    if (known.name == choice.info->name) return std::make_unique<RungeKuttaLanes>(known.table());
  }
  return nullptr;
}

}  // namespace noether::lane_methods
