#include "engine/box_simd.hpp"

#include <hwy/highway.h>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Advances by registers of D; what is left over, and where it meets a border, is left to the caller.
template <class D>
HWY_INLINE std::ptrdiff_t advance_by(D d, const BoxAxis& axis, double h, const double* v, double* x,
                                     std::ptrdiff_t from, std::ptrdiff_t count) {
  const auto zero = hn::Zero(d), edge = hn::Set(d, axis.edge), magic = hn::Set(d, axis.magic);
  const auto longest = hn::Set(d, axis.longest), step = hn::Set(d, h);
  constexpr std::ptrdiff_t lanes = hn::MaxLanes(D());
  for (; from + lanes <= count; from += lanes) {
    const auto moved = hn::Mul(step, hn::LoadU(d, v + from));
    const auto to = hn::Add(hn::LoadU(d, x + from), hn::Sub(hn::Add(moved, magic), magic));
    const auto inside = hn::And(hn::And(hn::Ge(to, zero), hn::Lt(to, edge)), hn::Lt(hn::Abs(moved), longest));
    if (!hn::AllTrue(d, inside)) return from;
    hn::StoreU(to, d, x + from);
  }
  return from;
}

std::ptrdiff_t advance(const BoxAxis& axis, double h, const double* v, double* x, std::ptrdiff_t from,
                       std::ptrdiff_t count) {
  from = advance_by(hn::ScalableTag<double>(), axis, h, v, x, from, count);
  return advance_by(hn::CappedTag<double, 1>(), axis, h, v, x, from, count);
}

template <class D>
HWY_INLINE std::ptrdiff_t round_by(D d, const BoxAxis& axis, double* x, std::ptrdiff_t from, std::ptrdiff_t count) {
  // What is no smaller than 2^52 times the spacing is on the grid; the sum of it and the rest has the grid's last
  // place.
  const auto zero = hn::Zero(d), edge = hn::Set(d, axis.edge), large = hn::Set(d, axis.magic / 1.5);
  constexpr std::ptrdiff_t lanes = hn::MaxLanes(D());
  for (; from + lanes <= count; from += lanes) {
    const auto at = hn::LoadU(d, x + from);
    const auto to = hn::IfThenElse(hn::Lt(at, large), hn::Sub(hn::Add(at, large), large), at);
    if (!hn::AllTrue(d, hn::And(hn::And(hn::Ge(at, zero), hn::Lt(at, edge)), hn::Lt(to, edge)))) return from;
    hn::StoreU(to, d, x + from);
  }
  return from;
}

std::ptrdiff_t round(const BoxAxis& axis, double* x, std::ptrdiff_t from, std::ptrdiff_t count) {
  from = round_by(hn::ScalableTag<double>(), axis, x, from, count);
  return round_by(hn::CappedTag<double, 1>(), axis, x, from, count);
}

}  // namespace

extern const BoxKernels box_kernels;
const BoxKernels box_kernels{advance, round};

}  // namespace noether::NOETHER_SIMD_LEVEL
