#pragma once
/// How an erased type is written. All members of it stand in one list, a macro of two others with a row for each:
///
///     OWN(double, time, () const)
///     ANSWERED(void, wind, (double turns, bool back), turns, back)
///
/// A row has the result, the name, the parameters as a member declares them, and then their names. The held object is
/// asked for a member of its OWN. What it may lack is ANSWERED by a static function of this name in a class `Answers`
/// of the model, which takes the held object and then the parameters.
///
/// From this list come the interface (NOETHER_SEAM_PURE), the model around a held object called `held`
/// (NOETHER_SEAM_HELD, NOETHER_SEAM_ANSWERED) and the members of the erased type itself (NOETHER_SEAM_CALL). So one
/// more member is one more row, and where a held type may lack it, its answer.

#include <memory>
#include <utility>

#define NOETHER_SEAM_PURE(RESULT, NAME, PARAMETERS, ...) virtual RESULT NAME PARAMETERS = 0;
#define NOETHER_SEAM_HELD(RESULT, NAME, PARAMETERS, ...) \
  RESULT NAME PARAMETERS override { return static_cast<RESULT>(held.NAME(__VA_ARGS__)); }
#define NOETHER_SEAM_ANSWERED(RESULT, NAME, PARAMETERS, ...) \
  RESULT NAME PARAMETERS override { return Answers::NAME(held __VA_OPT__(, ) __VA_ARGS__); }
#define NOETHER_SEAM_CALL(RESULT, NAME, PARAMETERS, ...) \
  RESULT NAME PARAMETERS { return this->held_->NAME(__VA_ARGS__); }

namespace noether::detail {

/// Value semantics for a polymorphic `Base` with `clone`.
template <class Base> class Erased {
 public:
  explicit Erased(std::unique_ptr<Base> held) : held_(std::move(held)) {}
  Erased(const Erased& other) : held_(other.held_->clone()) {}
  Erased(Erased&&) noexcept = default;
  Erased& operator=(const Erased& other) {
    held_ = other.held_->clone();
    return *this;
  }
  Erased& operator=(Erased&&) noexcept = default;
  ~Erased() = default;

 protected:
  std::unique_ptr<Base> held_;
};

}  // namespace noether::detail
