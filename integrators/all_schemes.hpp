#pragma once
/// All schemes, by name.

#include "integrators/scheme.hpp"
#include "integrators/schemes/low_order.hpp"
#include "integrators/schemes/near_integrable.hpp"
#include "integrators/schemes/nystrom.hpp"
#include "integrators/schemes/splitting.hpp"
#include "integrators/schemes/symmetric_4_6.hpp"
#include "integrators/schemes/symmetric_8_10.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether::schemes {

/// Every scheme, once, family by family.
std::span<const Scheme* const> all();

/// The scheme of a name or an alias; null if there is none.
const Scheme* find(std::string_view name);

/// Names of all schemes, without aliases.
std::vector<std::string> names();

/// Other names of a scheme, one by one.
std::vector<std::string> aliases_of(const Scheme& scheme);

}  // namespace noether::schemes
