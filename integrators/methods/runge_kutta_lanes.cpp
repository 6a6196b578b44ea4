#include "integrators/lane_method.hpp"
#include "integrators/lie/exponential_products.hpp"
#include "integrators/methods/explicit_tableaus.hpp"
#include "integrators/methods/lane_terms.hpp"

#include <string_view>
#include <utility>

namespace noether::lane_methods {

namespace {

/// Any explicit tableau, as `RungeKutta` with steps of one length.
class RungeKuttaLanes final : public LaneMethod {
 public:
  explicit RungeKuttaLanes(const Tableau& table)
      : first_same_as_last_(table.first_same_as_last),
        c_(as_real<double>(table.c)),
        end_(LaneTerms::of_stages(table.b)),
        k_(table.stages()) {
    for (const auto& row : table.a) rows_.push_back(LaneTerms::of_stages(row));
  }

  std::vector<LaneNumbers*> memory() override {
    if (!first_same_as_last_) return {};
    return {&k_[0]};
  }
  void scale_change(std::size_t lane, std::size_t change, double factor) override {
    if (first_same_as_last_) parts_.scale_change(k_[0], lane, change, factor);
  }
  void begin(LaneField& f, double t, double h, const LaneNumbers& y) override {
    h_ = h;
    parts_ = LaneParts(f);
    for (LaneNumbers& k : k_) k.resize(y.size());
    y1_.resize(y.size());
    if (first_same_as_last_) lane_rate(f, t, y, k_[0]);
  }
  std::optional<Failure> step(LaneField& f, double t, LaneNumbers& y) override {
    if (!first_same_as_last_) lane_rate(f, t, y, k_[0]);
    for (std::size_t i = 1; i < k_.size(); ++i) {
      rows_[i].sum(y, h_, k_, y1_);
      lane_rate(f, t + c_[i] * h_, y1_, k_[i]);
    }
    if (!first_same_as_last_) {
      end_.sum(y, h_, k_, y);
    } else {  // the last stage stands at the new point already
      std::swap(y, y1_);
      std::swap(k_.front(), k_.back());
    }
    return {};
  }

 private:
  bool first_same_as_last_;
  std::vector<double> c_;
  std::vector<LaneTerms> rows_;
  LaneTerms end_;
  std::vector<LaneNumbers> k_;
  LaneNumbers y1_;
  LaneParts parts_;
  double h_ = 0;
};

/// What products of exponentials are where points move along straight lines: a row has the sums of theirs.
Tableau on_straight_lines(const ExponentialTableau& products) {
  Tableau made{.a = {{}}, .b = {}, .c = {Quad(0)}, .order = products.order};
  const auto row_of = [&](const ExponentialProduct& product) {
    std::vector<Quad> row = made.a[static_cast<std::size_t>(product.from)];
    row.resize(products.stages.size() + 1, Quad(0));
    for (const std::vector<Quad>& weights : product.weights) {
      for (std::size_t j = 0; j < weights.size(); ++j) row[j] += weights[j];
    }
    return row;
  };
  for (const ExponentialProduct& stage : products.stages) {
    made.a.push_back(row_of(stage));
    made.c.push_back(stage.c);
  }
  made.b = row_of(products.end);
  return made;
}

}  // namespace

/// With methods on groups, which on points are Runge-Kutta methods too: Munthe-Kaas's that of the table under it.
std::unique_ptr<LaneMethod> runge_kutta(const MethodChoice& choice) {
  std::string_view name = choice.info->name;
  if (const ExponentialTableau* products = tableaus::exponential_table(name))
    return std::make_unique<RungeKuttaLanes>(on_straight_lines(*products));
  if (name.starts_with("rkmk_")) name.remove_prefix(5);
  for (const tableaus::NamedTableau& known : tableaus::all_explicit()) {
    if (known.name == name) return std::make_unique<RungeKuttaLanes>(known.table());
  }
  return nullptr;
}

}  // namespace noether::lane_methods
