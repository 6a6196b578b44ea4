#include "study/frame_traits.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/systems/turning_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace noether {

namespace {

constexpr int frame_duration = 2;  // units of time
constexpr int evaluations_in_a_unit = 48;
constexpr int steps_on_frame = 64;

/// A method at work on the frame.
class FrameWalk {
 public:
  explicit FrameWalk(const MethodInfo& info)
      : field_(TurningFrame{}), method_(make_method<Quad>(info, steps_of_one_length(info))), y_(9) {
    method_->bind(field_);
    const std::vector<double> start = TurningFrame{}.start();
    for (Index i = 0; i < 9; ++i) y_[i] = Quad(start[static_cast<std::size_t>(i)]);
  }

  void go(int steps, double h) {
    for (int n = 0; n < steps; ++n) {
      method_->step(field_, t_, y_, h);
      t_ += Quad(h);
    }
  }
  double error() const {
    const Mat3<Quad> exact = TurningFrame{}.turned<Quad>(t_);
    double worst = 0;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) worst = std::max(worst, size_of(y_[3 * i + k] - exact(i, k)));
    }
    return worst;
  }
  double defect() const {
    double worst = 0;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        Quad sum(i == k ? -1 : 0);
        for (int j = 0; j < 3; ++j) sum += y_[3 * j + i] * y_[3 * j + k];
        worst = std::max(worst, size_of(sum));
      }
    }
    return worst;
  }
  int evaluations() const { return static_cast<int>(field_.evaluations().force); }

 private:
  static double size_of(const Quad& x) { return std::abs(static_cast<double>(x)); }
  static MethodOptions steps_of_one_length(const MethodInfo& info) {
    MethodOptions options;
    if (info.adaptive) options.adaptive = false;
    return options;
  }

  LinearRotationField<TurningFrame, Quad> field_;
  std::unique_ptr<Method<Quad>> method_;
  Quad t_ = Quad(0);
  Vector<Quad> y_;
};

double frame_error(const MethodInfo& info, int steps) {
  FrameWalk walk(info);
  walk.go(steps, static_cast<double>(frame_duration) / steps);
  return walk.error();
}

MeasuredFrames measured_frame(const MethodInfo& info) {
  MeasuredFrames made{.method = std::string(info.name),
                      .use = std::string(info.use),
                      .claimed_order = info.order,
                      .claimed_evaluations = info.evaluations,
                      .work = info.group_work(info, {})};
  made.order = std::log2(frame_error(info, 16 * frame_duration) / frame_error(info, 32 * frame_duration));
  FrameWalk walk(info);
  walk.go(1, 0.0625);
  const int before = walk.evaluations();
  walk.go(1, 0.0625);
  made.evaluations = walk.evaluations() - before;
  walk.go(1, -0.0625);
  walk.go(1, -0.0625);
  made.reversible = walk.error() < 1e-30;
  walk.go(steps_on_frame, 0.0625);
  made.defect = walk.defect();
  made.error = frame_error(info, frame_duration * evaluations_in_a_unit / made.evaluations);
  return made;
}

}  // namespace

std::vector<MeasuredFrames> measured_frames() {
  std::vector<MeasuredFrames> all;
  for (const auto& list : {methods::of_rotations(), methods::all()}) {
    for (const MethodInfo* info : list) {
      if (info->on_groups && info->fixed) all.push_back(measured_frame(*info));
    }
  }
  return all;
}

std::vector<std::string> MeasuredFrames::differences() const {
  std::vector<std::string> found;
  if (std::abs(order - claimed_order) > 0.35)
    found.push_back(fmt::format("order: claims {}, measured {:.2f}", claimed_order, order));
  if (evaluations != claimed_evaluations || evaluations != work.evaluations)
    found.push_back(
        fmt::format("evaluations: claims {}, counted {} and {}", claimed_evaluations, evaluations, work.evaluations));
  if (!(defect < 1e-31)) found.push_back(fmt::format("stays a rotation: off by {:.2g}", defect));
  return found;
}

std::string frames_section(const std::vector<MeasuredFrames>& measured) {
  std::string section =
      "\n## rotations, Y' = A(t) Y\n\n"
      "Methods on groups over the frame `turning_frame`, whose solution is closed, in 113 bits: the order of the error "
      "of\n"
      "Y between steps of 1/16 and 1/32, evaluations of A, exponentials and commutators a step, counted, and the error "
      "at\n"
      "t = 2 with about 48 evaluations in a unit of time. **R**: two steps of -h undo two of h. Y stays a rotation to\n"
      "rounding under all of them; `magnus` methods serve nothing but such frames.\n\n"
      "| method | order | evaluations | exponentials | commutators | R | error | best for |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const MeasuredFrames& one : measured) {
    const double whole = std::round(one.order);
    const std::string order =
        std::abs(one.order - whole) < 0.35 ? fmt::format("{:.0f}", whole) : fmt::format("{:.1f}", one.order);
    const std::vector<std::string> differences = one.differences();
    const std::string wrong = differences.empty() ? "" : fmt::format(" [{}]", fmt::join(differences, "; "));
    section += fmt::format("| {} | {} | {} | {} | {} |{} | {:.1e} | {}{} |\n", one.method, order, one.evaluations,
                           one.work.exponentials, one.work.commutators, one.reversible ? " yes" : "", one.error,
                           one.use, wrong);
  }
  return section;
}

}  // namespace noether
