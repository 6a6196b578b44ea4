#include "integrators/lie/group_work.hpp"

#include "integrators/lie/graded_brackets.hpp"
#include "integrators/lie/lie_field.hpp"
#include "integrators/lie/rotations.hpp"
#include "integrators/methods/explicit_tableaus.hpp"

#include <memory>
#include <string>

namespace noether {

namespace {

/// One orientation and one number that changes it, counting what is asked for.
class CountingField final : public LieField<double> {
 public:
  explicit CountingField(bool linear) : linear_(linear) {}

  std::unique_ptr<VectorField<double>> clone() const override { return std::make_unique<CountingField>(*this); }
  FieldClaims claims() const override { return {.name = "counted", .variables = true}; }
  std::string signature() const override { return "counted"; }
  void bind(const ParticleSystem<double>& /*s*/) override {}
  Index size() const override { return 4; }
  void gather(const ParticleSystem<double>& /*s*/, Vector<double>& /*y*/) const override {}
  void scatter(const Vector<double>& /*y*/, ParticleSystem<double>& /*s*/) const override {}
  EnergyTerms<double> energy(const ParticleSystem<double>& /*s*/) override { return {}; }
  void accelerations(const ParticleSystem<double>& /*s*/, VectorColumn<double>& /*a*/) override {}

  Index algebra() const override { return 3; }
  bool linear() const override { return linear_; }
  void act(const Vector<double>& u, const Vector<double>& y, Vector<double>& out) override {
    exponentials += u.isZero(0) ? 0 : 1;
    const Quaternion<double> q(y[0], y[1], y[2], y[3]);
    out = quaternion_product<double>(rotation_by<double>(Vec3<double>(u[0], u[1], u[2])), q);
  }
  void bracket(const Vector<double>& u, const Vector<double>& v, Vector<double>& out) override {
    commutators += u.isZero(0) || v.isZero(0) ? 0 : 1;
    out = cross<double>(Vec3<double>(u[0], u[1], u[2]), Vec3<double>(v[0], v[1], v[2]));
  }
  void sizes(const Vector<double>& /*y*/, const Vector<double>& /*y1*/, double /*h*/,
             Vector<double>& out) const override {
    out.setOnes(3);
  }

  int exponentials = 0, commutators = 0;

 protected:
  void find_velocity(const double& t, const Vector<double>& y, Vector<double>& a) override {
    a.resize(3);
    const double place = linear_ ? 0.5 : y[1];
    a << 1 + 0.25 * t, 0.5 * place - t * t, 0.75 + t * place;
  }
  void evaluate(const double& t, const Vector<double>& y, Vector<double>& dy) override {
    Vector<double> a;
    find_velocity(t, y, a);
    const Quaternion<double> q(y[0], y[1], y[2], y[3]);
    dy = quaternion_product<double>(quaternion<double>(0, Vec3<double>(a[0], a[1], a[2]) / 2), q);
  }

 private:
  bool linear_;
};

}  // namespace

GroupWork counted_work(const MethodInfo& info, const MethodOptions& options) {
  CountingField field(info.linear_only);
  MethodOptions fixed = options;
  if (info.adaptive) fixed = {.adaptive = false, .own = options.own};
  const auto method = info.make(info, fixed);
  method->bind(field);
  Vector<double> y(4);
  y << 1, 0, 0, 0;
  method->step(field, 0, y, 0.1);
  field.evaluations() = {};
  field.exponentials = field.commutators = 0;
  method->step(field, 0.1, y, 0.1);
  return {.evaluations = static_cast<int>(field.evaluations().force),
          .exponentials = field.exponentials,
          .commutators = field.commutators};
}

GroupWork rkmk_work(const MethodInfo& info, const MethodOptions& options) {
  GroupWork work = counted_work(info, options);
  for (const tableaus::NamedTableau& table : tableaus::all_explicit()) {
    if (info.name == "rkmk_" + std::string(table.name)) work.least_commutators = least_commutators(table.table());
  }
  return work;
}

}  // namespace noether
