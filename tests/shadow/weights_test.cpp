/// The weights of the closed form against the tables of EngleSkeelDrees2005.

#include "numbers/real.hpp"
#include "tests/shadow/support.hpp"

#include <fstream>
#include <map>
#include <sstream>
#include <utility>

using namespace noether;

namespace {

Quad binomial(int n, int k) {
  Quad result(1);
  for (int i = 1; i <= k; ++i) result = result * Quad(n - k + i) / Quad(i);
  return result;
}

Quad fraction(const std::string& text) {
  const auto slash = text.find('/');
  const Quad top(std::stod(text.substr(0, slash)));
  return slash == std::string::npos ? top : top / Quad(std::stod(text.substr(slash + 1)));
}

using Weights = std::map<std::pair<int, int>, Quad>;

/// Weights of w(y_(n-a), y_(n-b)), a < b, in  sum c_ij (1/2) w(nabla^i y_n, nabla^j y_n).
Weights taken_apart(const std::vector<Quad>& c, int k) {
  Weights weights;
  std::size_t at = 0;
  for (int i = 1; i <= k; ++i) {
    for (int j = 0; j < i; ++j, ++at) {
      for (int a = 0; a <= i; ++a) {
        for (int b = 0; b <= j; ++b) {
          const Quad term = c.at(at) / Quad(2) * binomial(i, a) * binomial(j, b) * Quad((a + b) % 2 == 0 ? 1 : -1);
          if (a < b) weights[{a, b}] += term;
          if (a > b) weights[{b, a}] -= term;
        }
      }
    }
  }
  return weights;
}

}  // namespace

TEST_CASE("the closed form has the weights of the published tables, to order 24", "[shadow]") {
  std::ifstream file(std::string(NOETHER_SOURCE_DIR) + "/tests/data/shadow/engle_skeel_drees_2005.txt");
  int tables = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream words(line);
    int order = 0;
    char colon = 0;
    words >> order >> colon;
    const int k = order / 2;
    std::vector<Quad> c;
    for (std::string one; std::getline(words, one, ',');) c.push_back(fraction(one));
    REQUIRE(static_cast<int>(c.size()) == k * (k + 1) / 2);
    for (const auto& [pair, weight] : taken_apart(c, k)) {
      CAPTURE(order, pair.first, pair.second);
      const Quad mine = Quad(shadow_weight(k, pair.first, pair.second)) / Quad(pair.second - pair.first);
      CHECK(static_cast<double>(abs(weight * binomial(2 * k, k) - mine)) < 1e-18);
    }
    ++tables;
  }
  CHECK(tables == 6);
}
