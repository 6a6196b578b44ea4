#include "integrators/methods/lane_sums_simd.hpp"

#include "numbers/compensated_sum_simd.hpp"

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Lanes>;
using BitLanes = hn::RebindToSigned<Lanes>;
using Bits = hn::Vec<BitLanes>;
constexpr std::ptrdiff_t systems = 8;
constexpr std::ptrdiff_t lanes = hn::MaxLanes(Lanes());

void sum(const LaneSum& sums) {
  const Lanes d;
  const LaneSum s = sums;
  const Vector h = hn::Set(d, s.h), c = hn::Set(d, s.c), g = hn::Set(d, s.g);
  constexpr std::ptrdiff_t together = systems / lanes >= 4 ? 4 : 2;  // chains: each addition waits for the one before
  const std::ptrdiff_t all = systems * s.n;
  const auto end = [&](std::ptrdiff_t at, Vector total) HWY_ATTR {
    const Vector slope = s.v != nullptr ? hn::MulAdd(g, total, hn::Mul(c, hn::LoadU(d, s.v + at))) : total;
    hn::StoreU(hn::MulAdd(h, slope, hn::LoadU(d, s.y + at)), d, s.out + at);
  };
  std::ptrdiff_t at = 0;
  for (; at + together * lanes <= all; at += together * lanes) {
    Vector total[together];
    for (std::ptrdiff_t m = 0; m < together; ++m) total[m] = hn::Zero(d);
    for (std::ptrdiff_t j = 0; j < s.terms; ++j) {
      const Vector w = hn::Set(d, s.w[j]);
      const double* const k = s.k[j] + at;
      for (std::ptrdiff_t m = 0; m < together; ++m) total[m] = hn::MulAdd(w, hn::LoadU(d, k + m * lanes), total[m]);
    }
    for (std::ptrdiff_t m = 0; m < together; ++m) end(at + m * lanes, total[m]);
  }
  for (; at < all; at += lanes) {
    Vector total = hn::Zero(d);
    for (std::ptrdiff_t j = 0; j < s.terms; ++j) {
      total = hn::MulAdd(hn::Set(d, s.w[j]), hn::LoadU(d, s.k[j] + at), total);
    }
    end(at, total);
  }
}

template <int count> void stages_of(const LaneStages& s) {
  const Lanes d;
  const std::ptrdiff_t all = systems * s.n;
  for (std::ptrdiff_t at = 0; at < all; at += lanes) {
    Vector rate[count];
    for (int j = 0; j < count; ++j) rate[j] = hn::LoadU(d, s.rates + j * all + at);
    const Vector y = hn::LoadU(d, s.y + at), low = hn::LoadU(d, s.low + at), v = hn::LoadU(d, s.v + at);
    for (int i = 0; i < count; ++i) {
      Vector total = hn::MulAdd(hn::Set(d, s.d_low[i]), v, low);
      for (int j = 0; j < count; ++j) total = hn::MulAdd(hn::Set(d, s.w[8 * j + i]), rate[j], total);
      hn::StoreU(hn::Add(y, hn::MulAdd(hn::Set(d, s.d[i]), v, total)), d, s.out + i * all + at);
    }
  }
}

template <int count> void stages_up_to(const LaneStages& s) {
  if (s.stages == count) return stages_of<count>(s);
  if constexpr (count > 1) stages_up_to<count - 1>(s);
}

void stages(const LaneStages& sums) {
  const LaneStages s = sums;
  stages_up_to<8>(s);
}

/// Sizes compare as their bits do, and what is no number is larger than all.
HWY_INLINE Bits size_of(Vector x) { return hn::BitCast(BitLanes(), hn::Abs(x)); }

void take(std::ptrdiff_t n, const double* fresh, const std::int64_t* on, double* rates, double* change, double* size) {
  const Lanes d;
  for (std::ptrdiff_t lane = 0; lane < systems; lane += lanes) {
    const auto taken = hn::MaskFromVec(hn::BitCast(d, hn::LoadU(BitLanes(), on + lane)));
    Bits most = hn::Zero(BitLanes()), largest = most;
    for (std::ptrdiff_t at = lane; at < systems * n; at += systems) {
      const Vector x = hn::LoadU(d, fresh + at), before = hn::LoadU(d, rates + at);
      most = hn::Max(most, size_of(hn::Sub(x, before)));
      largest = hn::Max(largest, size_of(x));
      hn::StoreU(hn::IfThenElse(taken, x, before), d, rates + at);
    }
    hn::StoreU(hn::BitCast(d, most), d, change + lane);
    hn::StoreU(hn::BitCast(d, largest), d, size + lane);
  }
}

/// A variable at a time.
void finish(const LaneEnd& sums) {
  const Lanes d;
  const LaneEnd s = sums;
  const Vector h = hn::Set(d, s.h);
  const std::ptrdiff_t all = systems * s.n;
  for (std::ptrdiff_t at = 0; at < all; at += lanes) {
    Vector kick = hn::Zero(d), kick_low = kick, bend = kick, bend_low = kick;
    for (int j = 0; j < s.stages; ++j) {
      const Vector rate = hn::LoadU(d, s.rates + j * all + at);
      kick = hn::MulAdd(hn::Set(d, s.once[j]), rate, kick);
      kick_low = hn::MulAdd(hn::Set(d, s.once_low[j]), rate, kick_low);
      bend = hn::MulAdd(hn::Set(d, s.twice[j]), rate, bend);
      bend_low = hn::MulAdd(hn::Set(d, s.twice_low[j]), rate, bend_low);
    }
    const Vector v = hn::LoadU(d, s.v + at), hv = hn::Mul(h, v);
    const Vector lower = hn::MulAdd(h, hn::LoadU(d, s.v_low + at), fused_product_error(d, h, v, hv));
    add_with_error(d, s.q + at, s.q_low + at, lanes, hv, hn::Add(bend, hn::Add(bend_low, lower)));
    add_with_error(d, s.v + at, s.v_low + at, lanes, kick, kick_low);
  }
}

void add(std::ptrdiff_t n, const double* x, double* value, double* low) {
  const Lanes d;
  for (std::ptrdiff_t at = 0; at < n; at += lanes)
    add_with_error(d, value + at, low + at, lanes, hn::LoadU(d, x + at), hn::Zero(d));
}

void correct(const LaneCorrection& by, double* moved) {
  const Lanes d;
  const LaneCorrection c = by;
  const Vector h = hn::Set(d, c.h), weight = hn::Set(d, c.weight);
  for (std::ptrdiff_t lane = 0; lane < systems; lane += lanes) {
    const auto taken = hn::MaskFromVec(hn::BitCast(d, hn::LoadU(BitLanes(), c.on + lane)));
    Bits most = hn::Zero(BitLanes());
    for (std::ptrdiff_t at = lane; at < systems * c.n; at += systems) {
      const Vector fresh = hn::LoadU(d, c.fresh + at), before = hn::LoadU(d, c.point + at);
      const Vector next = hn::MulAdd(weight, fresh, hn::LoadU(d, c.known + at));
      const Vector change = hn::Abs(hn::Sub(next, before)), reach = hn::Abs(hn::Mul(h, hn::LoadU(d, c.rate + at)));
      const Vector size = hn::Max(hn::Max(hn::Abs(hn::LoadU(d, c.y + at)), hn::Abs(next)), reach);
      const Vector relative = hn::IfThenZeroElse(hn::Eq(change, hn::Zero(d)), hn::Div(change, size));
      most = hn::Max(most, size_of(relative));
      hn::StoreU(hn::IfThenElse(taken, next, before), d, c.point + at);
      hn::StoreU(hn::IfThenElse(taken, fresh, hn::LoadU(d, c.of_rate + at)), d, c.of_rate + at);
    }
    hn::StoreU(hn::BitCast(d, most), d, moved + lane);
  }
}

}  // namespace

extern const LaneSumsKernels lane_sums_kernels;
const LaneSumsKernels lane_sums_kernels{sum, stages, take, finish, add, correct};

}  // namespace noether::NOETHER_SIMD_LEVEL
