#include "integrators/methods/rosenbrock.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/methods/newton.hpp"
#include "integrators/methods/tableau.hpp"

#include <limits>
#include <utility>

namespace noether {

template <class Real>
Rosenbrock<Real>::Rosenbrock(const MethodInfo& info, const MethodOptions& options, const RosenbrockTable& table)
    : name_(info.name),
      order_(table.order),
      adaptive_(info.is_adaptive(options)),
      form_(options.jacobian),
      tolerance_(info, options),
      first_(options.first.value_or(0)),
      g_(table.g),
      a_(as_real<Real>(table.a)),
      c_(as_real<Real>(table.c)),
      dense_(as_real<Real>(table.dense)),
      b_(as_real<Real>(table.b)),
      nodes_(as_real<Real>(table.nodes)),
      d_(as_real<Real>(table.d)),
      control_(table.embedded_order + 1, 6) {}

template <class Real> void Rosenbrock<Real>::bind(const VectorField<Real>& f) {
  jacobian_.bind(f,
                 {.form = form_, .tolerance = adaptive_ ? std::optional(tolerance_) : std::nullopt, .rounding = true});
  u_.assign(b_.size(), Vector<Real>(f.size()));
  for (Vector<Real>* v : {&f0_, &slope_, &stage_, &rate_, &y0_, &y1_}) v->setZero(f.size());
  control_.forget();
}

template <class Real>
double Rosenbrock<Real>::next_step(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  if (control_.next() == 0)
    control_.start(first_ > 0 ? std::copysign(first_, h) : first_step(f, t, y, order_, tolerance_, h));
  return shorter(control_.next(), h, f.scales(y, tolerance_.rtol));
}

/// Leaves the stages of a step in `u_` and its end in `y1_`. @return nothing, or why it failed
template <class Real>
std::optional<Failure> Rosenbrock<Real>::trial(VectorField<Real>& f, const Real& t, const Vector<Real>& y, double h) {
  const Index n = y.size();
  const Real step(h), weight = step * g_;
  if (!jacobian_.factorize(Real(1), weight)) return singular_matrix(h);
  for (std::size_t s = 0; s < u_.size(); ++s) {
    Vector<Real>& u = u_[s];
    for (Index i = 0; i < n; ++i) {
      Real point(0), past(0);
      for (std::size_t j = 0; j < a_[s].size(); ++j) point += a_[s][j] * u_[j][i];
      for (std::size_t j = 0; j < c_[s].size(); ++j) past += c_[s][j] * u_[j][i];
      stage_[i] = y[i] + point;
      u[i] = g_ * past;
    }
    if (s > 0) f.rate(t + nodes_[s] * step, stage_, rate_);
    const Vector<Real>& rate = s == 0 ? f0_ : rate_;
    const Real slope = s < d_.size() ? step * d_[s] : Real(0);
    for (Index i = 0; i < n; ++i) u[i] += weight * (rate[i] + slope * slope_[i]);
    if (!jacobian_.solve(f, u)) return unsolved_system();
  }
  for (Index i = 0; i < n; ++i) {
    Real sum(0);
    for (std::size_t j = 0; j < u_.size(); ++j) sum += b_[j] * u_[j][i];
    y1_[i] = y[i] + sum;
  }
  return {};
}

template <class Real>
StepResult Rosenbrock<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  StepResult made{.h = adaptive_ ? next_step(f, t, y, h) : h};
  f.rate(t, y, f0_);
  jacobian_.evaluate(f, t, y);
  jacobian_.time_derivative(f, t, y, made.h, slope_);
  while (true) {
    if (adaptive_) made.failure = underflow(static_cast<double>(t), made.h, f.scales(y, tolerance_.rtol));
    if (made.failure) return made;
    std::optional<Failure> failure = trial(f, t, y, made.h);
    if (!adaptive_) {
      made.failure = std::move(failure);
      break;
    }
    const double error = failure ? std::numeric_limits<double>::infinity()
                                 : tolerance_.norm(f.scales(y, tolerance_.rtol), u_.back(), y, y1_);
    if (control_.accept(made.h, error)) break;
    ++made.rejected;
    made.h = shorter(control_.next(), h);
  }
  y0_ = y;
  y = y1_;
  return made;
}

/// y(t + theta h) = (1 - theta) y0 + theta (y1 + (1 - theta) (w_1 + theta (w_2 + ...))), w by rows of the table.
template <class Real> void Rosenbrock<Real>::interpolate(VectorField<Real>& /*f*/, const Real& theta, Vector<Real>& y) {
  const Real remaining = Real(1) - theta;
  for (Index i = 0; i < y.size(); ++i) {
    Real sum(0);
    for (std::size_t r = dense_.size(); r-- > 0;) {
      Real w(0);
      for (std::size_t j = 0; j < dense_[r].size(); ++j) w += dense_[r][j] * u_[j][i];
      sum = sum * theta + w;
    }
    y[i] = remaining * y0_[i] + theta * (y1_[i] + remaining * sum);
  }
}

template class Rosenbrock<double>;
template class Rosenbrock<Quad>;

namespace tableaus {

const RosenbrockTable& rodas_4() {
  static const RosenbrockTable table = [] {
    RosenbrockTable made;
    made.g = parse_quad("0.25");
    made.a = rows({"", "1.544", "0.9466785280815826 0.2557011698983284",
                   "3.314825187068521 2.896124015972201 0.9986419139977817",
                   "1.221224509226641 6.019134481288629 12.53708332932087 -0.687886036105895",
                   "1.221224509226641 6.019134481288629 12.53708332932087 -0.687886036105895 1"});
    made.c = rows({"", "-5.6688", "-2.430093356833875 -0.2063599157091915",
                   "-0.1073529058151375 -9.594562251023355 -20.47028614809616",
                   "7.496443313967647 -10.24680431464352 -33.99990352819905 11.7089089320616",
                   "8.083246795921522 -7.981132988064893 -31.52159432874371 16.31930543123136 -6.058818238834054"});
    made.b = made.a.back();
    made.b.push_back(1);
    made.nodes = coefficients("0 0.386 0.21 0.63 1 1");
    made.d = coefficients("0.25 -0.1043 0.1035 -0.0362");
    made.dense = rows({"10.12623508344586 -7.487995877610167 -34.80091861555747 -7.992771707568823 1.025137723295662",
                       "-0.6762803392801253 6.087714651680015 16.43084320892478 24.76722511418386 -6.594389125716872"});
    made.order = 4;
    made.embedded_order = 3;
    return made;
  }();
  return table;
}

const RosenbrockTable& rodas_5p() {
  static const RosenbrockTable table = [] {
    RosenbrockTable made;
    made.g = parse_quad("0.21193756319429014");
    made.a = rows(
        {"", "3.0", "2.849394379747939 0.45842242204463923", "-6.954028509809101 2.489845061869568 -10.358996098473584",
         "2.8029986275628964 0.5072464736228206 -0.3988312541770524 -0.04721187230404641",
         "-7.502846399306121 2.561846144803919 -11.627539656261098 -0.18268767659942256 0.030198172008377946",
         "-7.502846399306121 2.561846144803919 -11.627539656261098 -0.18268767659942256 0.030198172008377946 1",
         "-7.502846399306121 2.561846144803919 -11.627539656261098 -0.18268767659942256 0.030198172008377946 1 "
         "1"});
    made.c = rows({"", "-14.155112264123755", "-17.97296035885952 -2.859693295451294",
                   "147.12150275711716 -1.41221402718213 71.68940251302358",
                   "165.43517024871676 -0.4592823456491126 42.90938336958603 -5.961986721573306",
                   "24.854864614690072 -3.0009227002832186 47.4931110020768 5.5814197821558125 -0.6610691825249471",
                   "30.91273214028599 -3.1208243349937974 77.79954646070892 34.28646028294783 -19.097331116725623 "
                   "-28.087943162872662",
                   "37.80277123390563 -3.2571969029072276 112.26918849496327 66.9347231244047 -40.06618937091002 "
                   "-54.66780262877968 -9.48861652309627"});
    made.b = made.a.back();
    made.b.push_back(1);
    made.nodes = coefficients("0 0.6358126895828704 0.4095798393397535 0.9769306725060716 0.4288403609558664 1 1 1");
    made.d = coefficients(
        "0.21193756319429014 -0.42387512638858027 -0.3384627126235924 1.8046452872882734 2.325825639765069");
    made.dense =
        rows({"25.948786856663858 -2.5579724845846235 10.433815404888879 -2.3679251022685204 0.524948541321073 "
              "1.1241088310450404 0.4272876194431874 -0.17202221070155493",
              "-9.91568850695171 -0.9689944594115154 3.0438037242978453 -24.495224566215796 20.176138334709044 "
              "15.98066361424651 -6.789040303419874 -6.710236069923372",
              "11.419903575922262 2.8879645146136994 72.92137995996029 80.12511834622643 -52.072871366152654 "
              "-59.78993625266729 -0.15582684282751913 4.883087185713722"});
    made.order = 5;
    made.embedded_order = 4;
    return made;
  }();
  return table;
}

}  // namespace tableaus

namespace {

template <class Real>
std::unique_ptr<Method<Real>> make_rosenbrock(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<Rosenbrock<Real>>(info, options,
                                            info.name == "rodas_4" ? tableaus::rodas_4() : tableaus::rodas_5p());
}

}  // namespace

template <class Real> Rosenbrock<Real> starting_rosenbrock(std::optional<JacobianForm> form) {
  return Rosenbrock<Real>(methods::rosenbrock_list()[1], {.adaptive = false, .jacobian = form}, tableaus::rodas_5p());
}
template Rosenbrock<double> starting_rosenbrock(std::optional<JacobianForm> form);
template Rosenbrock<Quad> starting_rosenbrock(std::optional<JacobianForm> form);

std::span<const MethodInfo> methods::rosenbrock_list() {
  static const MethodInfo list[] = {
      {.name = "rodas_4",
       .aliases = "rodas4",
       .summary = "Rosenbrock, 6 stages, 4(3), L-stable, stiffly accurate, dense output of order 3",
       .use = "stiff systems of some ten variables, relative errors of 1e-3 to 1e-6",
       .source = "HairerWanner1996",
       .family = "rosenbrock",
       .options = {linear_solver},
       .order = 4,
       .evaluations = 6,
       .printed_digits = 16,
       .adaptive = true,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_rosenbrock<double>,
       .make_quad = make_rosenbrock<Quad>},
      {.name = "rodas_5p",
       .aliases = "rodas5p",
       .summary = "Rosenbrock, 8 stages, 5(4), L-stable, made against order reduction, dense output of order 4",
       .use = "stiff systems of some ten variables, relative errors of 1e-4 to 1e-8; driven ones above all",
       .source = "Steinebach2023",
       .family = "rosenbrock",
       .options = {linear_solver},
       .order = 5,
       .evaluations = 8,
       .printed_digits = 16,
       .adaptive = true,
       .stability_limit = std::numeric_limits<double>::infinity(),
       .make = make_rosenbrock<double>,
       .make_quad = make_rosenbrock<Quad>},
  };
  return list;
}

}  // namespace noether
