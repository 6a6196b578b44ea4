#include "integrators/methods/tableau.hpp"

#include <sstream>
#include <string>

namespace noether {

std::vector<Quad> coefficients(std::string_view text) {
  std::istringstream words{std::string(text)};
  std::vector<Quad> result;
  for (std::string word; words >> word;) {
    const std::size_t slash = word.find('/');
    result.push_back(slash == std::string::npos
                         ? parse_quad(word)
                         : parse_quad(word.substr(0, slash)) / parse_quad(word.substr(slash + 1)));
  }
  return result;
}

std::vector<std::vector<Quad>> rows(std::initializer_list<std::string_view> texts) {
  std::vector<std::vector<Quad>> result;
  for (const std::string_view text : texts) result.push_back(coefficients(text));
  return result;
}

std::vector<Quad> row_sums(const std::vector<std::vector<Quad>>& a) {
  std::vector<Quad> sums;
  for (const auto& row : a) {
    Quad sum = 0;
    for (const Quad& x : row) sum += x;
    sums.push_back(sum);
  }
  return sums;
}

}  // namespace noether
