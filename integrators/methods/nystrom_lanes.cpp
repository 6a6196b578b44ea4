#include "integrators/lane_method.hpp"
#include "integrators/methods/lane_sums_simd.hpp"
#include "integrators/methods/nystrom_tableaus.hpp"

#include <utility>

namespace noether::lane_methods {

namespace {

/// A Runge-Kutta-Nystroem method, as `NystromPair` with steps of one length.
class NystromLanes final : public LaneMethod {
 public:
  explicit NystromLanes(const NystromTableau& table)
      : a_(as_real<double>(table.a)),
        c_(as_real<double>(table.c)),
        b_q_(as_real<double>(table.b_q)),
        b_v_(as_real<double>(table.b_v)),
        k_(table.stages()),
        rates_(table.stages()) {}

  void begin(LaneField& f, double /*t*/, double h, const LaneNumbers& y) override {
    h_ = h;
    n_ = f.size();
    for (std::size_t j = 0; j < k_.size(); ++j) {
      k_[j].resize(y.size() / 2);
      rates_[j] = k_[j].data();
    }
    q_.resize(y.size() / 2);
  }
  std::optional<Failure> step(LaneField& f, double t, LaneNumbers& y) override {
    double* const v = y.data() + y.size() / 2;
    f.accelerations(t, y.data(), nullptr, k_[0].data());
    for (std::size_t s = 1; s < k_.size(); ++s) {
      sum(y.data(), v, c_[s], h_, a_[s], q_.data());
      f.accelerations(t + c_[s] * h_, q_.data(), nullptr, k_[s].data());
    }
    sum(y.data(), v, 1, h_, b_q_, y.data());
    sum(v, nullptr, 0, 1, b_v_, v);
    return {};
  }

 private:
  /// out = y + h (c v + g sum_j w_j k_j)
  void sum(const double* y, const double* v, double c, double g, const std::vector<double>& w, double* out) const {
    lane_sums_kernels().sum({.n = n_,
                             .y = y,
                             .v = v,
                             .h = h_,
                             .c = c,
                             .g = g,
                             .terms = std::ssize(w),
                             .k = rates_.data(),
                             .w = w.data(),
                             .out = out});
  }

  std::vector<std::vector<double>> a_;
  std::vector<double> c_, b_q_, b_v_;
  std::vector<LaneNumbers> k_;
  std::vector<const double*> rates_;  ///< where they are
  LaneNumbers q_;
  Index n_ = 0;
  double h_ = 0;
};

}  // namespace

std::unique_ptr<LaneMethod> nystrom(const MethodChoice& choice) {
  if (choice.info->name != "dprkn_12") return nullptr;
  return std::make_unique<NystromLanes>(tableaus::dprkn_12());
}

}  // namespace noether::lane_methods
