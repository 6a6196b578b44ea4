#pragma once
/// Sums to twice the digits of a double, as code in lanes and all others know them.

namespace noether {

/// Three sums, each high + low; low is not rounded off against high.
struct WideSums {
  double high[3], low[3];
};

}  // namespace noether
