#include "constraints/constraint_residual.hpp"

namespace noether {

void ConstraintResidual::watch(const ConstraintSet& set) {
  if (set.empty()) {
    throw BadConstraints("constraint_residual has no constraint to watch; add a [[hamiltonian.constraint]] table");
  }
  set_ = set;
}

template <class Real> void ConstraintResidual::observe(const Snapshot<Real>& now) {
  const ConstraintSet::Worst worst = set_.worst(now.state());
  now_ = worst.residual;
  index_ = worst.equation;
  residuals_.add(now.time(), now_);
}

std::vector<Series> ConstraintResidual::series() const {
  return {{"worst", "1", {}, {now_}}, {"index", "1", {}, {static_cast<double>(index_)}}};
}

MonitorReport ConstraintResidual::report() const {
  MonitorReport report;
  report.samples = residuals_.samples();
  if (report.samples == 0) return report;
  report.first = residuals_.first();
  report.last = residuals_.last();
  report.worst = residuals_.worst();
  report.rms = residuals_.rms();
  return report;
}

template void ConstraintResidual::observe(const Snapshot<double>&);
template void ConstraintResidual::observe(const Snapshot<Quad>&);

}  // namespace noether
