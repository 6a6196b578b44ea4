/// An erased type of somebody else's, from one list of its members.

#include "engine/seam.hpp"

#include "tests/support/catch.hpp"

#include <type_traits>

using namespace noether;

namespace {

struct MeterAnswers {
  template <class M> static double unit(const M& m) {
    if constexpr (requires { m.unit(); }) return m.unit();
    return 1;
  }
  template <class M> static void add(M& m, double a, double b) { m.sum += a * b; }
};

#define METER_SEAM(OWN, ANSWERED)  \
  OWN(double, read, () const)      \
  OWN(void, set, (double to), to)  \
  ANSWERED(double, unit, () const) \
  ANSWERED(void, add, (double a, double b), a, b)

struct MeterBase {
  virtual ~MeterBase() = default;
  virtual std::unique_ptr<MeterBase> clone() const = 0;
  METER_SEAM(NOETHER_SEAM_PURE, NOETHER_SEAM_PURE)
};
template <class M> struct MeterModel final : MeterBase {
  using Answers = MeterAnswers;
  explicit MeterModel(M m) : held(std::move(m)) {}
  std::unique_ptr<MeterBase> clone() const override { return std::make_unique<MeterModel>(held); }
  METER_SEAM(NOETHER_SEAM_HELD, NOETHER_SEAM_ANSWERED)
  M held;
};
struct AnyMeter : private detail::Erased<MeterBase> {
  template <class M> AnyMeter(M m) : Erased(std::make_unique<MeterModel<M>>(std::move(m))) {}  // NOLINT
  METER_SEAM(NOETHER_SEAM_CALL, NOETHER_SEAM_CALL)
};

struct Plain {
  double sum = 0;
  double read() const { return sum; }
  bool set(double to) {  // what it gives is not asked for
    sum = to;
    return true;
  }
};
struct InFeet : Plain {
  double unit() const { return 0.3048; }
};

}  // namespace

TEST_CASE("an erased type has the members of its list, and answers for those that a held type lacks", "[seam]") {
  AnyMeter plain = Plain{}, feet = InFeet{};
  CHECK(plain.unit() == 1);
  CHECK(feet.unit() == 0.3048);
  plain.set(2);
  plain.add(3, 4);
  CHECK(plain.read() == 14);
  AnyMeter copy = plain;
  copy.set(5);
  CHECK(plain.read() == 14);
  CHECK(copy.read() == 5);
  copy = feet;
  CHECK(copy.unit() == 0.3048);
  STATIC_REQUIRE(std::is_nothrow_move_constructible_v<AnyMeter>);
}
