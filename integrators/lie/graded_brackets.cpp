#include "integrators/lie/graded_brackets.hpp"

#include "integrators/lie/dexp.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <string>

namespace noether {

namespace {

using WeightRow = std::vector<Quad>;
using WeightRows = std::vector<WeightRow>;

/// Below this a number is the rounding of printed coefficients, above it none is.
bool is_none(const Quad& x) { return abs(x) < Quad(1e-18); }

/// WeightRows in echelon form, one after the other.
class Echelon {
 public:
  /// Takes a row in, if it is not a combination of those before. @return whether it is not
  bool take(WeightRow row) {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Quad factor = row[pivots_[k]] / rows_[k][pivots_[k]];
      for (std::size_t i = 0; i < row.size(); ++i) row[i] -= factor * rows_[k][i];
    }
    std::size_t largest = 0;
    for (std::size_t i = 0; i < row.size(); ++i) largest = abs(row[i]) > abs(row[largest]) ? i : largest;
    if (row.empty() || is_none(row[largest])) return false;
    pivots_.push_back(largest);
    rows_.push_back(std::move(row));
    return true;
  }
  int rank() const { return static_cast<int>(rows_.size()); }

  /// Vectors of length n that are orthogonal to all rows.
  WeightRows orthogonal(std::size_t n) const {
    WeightRows reduced = rows_;
    for (std::size_t k = 0; k < reduced.size(); ++k) {  // so that each pivot stands alone
      const Quad size = reduced[k][pivots_[k]];
      for (Quad& x : reduced[k]) x /= size;
      for (std::size_t j = 0; j < reduced.size(); ++j) {
        const Quad factor = reduced[j][pivots_[k]];
        for (std::size_t i = 0; j != k && i < n; ++i) reduced[j][i] -= factor * reduced[k][i];
      }
    }
    WeightRows all;
    for (std::size_t free = 0; free < n; ++free) {
      if (std::find(pivots_.begin(), pivots_.end(), free) != pivots_.end()) continue;
      WeightRow one(n, Quad(0));
      one[free] = Quad(1);
      for (std::size_t k = 0; k < reduced.size(); ++k) one[pivots_[k]] = -reduced[k][free];
      all.push_back(one);
    }
    return all;
  }

 private:
  WeightRows rows_;
  std::vector<std::size_t> pivots_;
};

/// Elementary weights of all rooted trees of so many nodes at each stage, by the number of nodes less one.
std::vector<WeightRows> elementary_weights(const Tableau& table, int most) {
  const std::size_t s = table.stages();
  const auto product = [&](const WeightRow& v) {
    WeightRow out(s, Quad(0));
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t j = 0; j < table.a[i].size(); ++j) out[i] += table.a[i][j] * v[j];
    }
    return out;
  };
  std::vector<WeightRows> weights = {{WeightRow(s, Quad(1))}};
  for (int nodes = 2; nodes <= most; ++nodes) {
    WeightRows found;
    const std::function<void(int, int, const WeightRow&)> branch = [&](int left, int largest, const WeightRow& root) {
      if (left == 0) {
        found.push_back(root);
        return;
      }
      for (int nodes_of_it = std::min(left, largest); nodes_of_it > 0; --nodes_of_it) {
        for (const WeightRow& subtree : weights[static_cast<std::size_t>(nodes_of_it) - 1]) {
          const WeightRow below = product(subtree);
          WeightRow joined(s);
          for (std::size_t i = 0; i < s; ++i) joined[i] = root[i] * below[i];
          branch(left - nodes_of_it, nodes_of_it, joined);
        }
      }
    };
    branch(nodes - 1, nodes - 1, WeightRow(s, Quad(1)));
    weights.push_back(std::move(found));
  }
  return weights;
}

/// Combinations of stages, each of the highest power of h that it can be.
struct Graded {
  WeightRows combinations;
  std::vector<int> powers;
};

Graded graded_combinations(const Tableau& table) {
  const std::size_t s = table.stages();
  const std::vector<WeightRows> weights = elementary_weights(table, table.order);
  std::vector<WeightRows> spaces;  // of power w and more, by w - 1
  Echelon conditions;
  for (int power = 1; power <= table.order + 1; ++power) {
    spaces.push_back(conditions.orthogonal(s));
    if (power > table.order) break;
    for (const WeightRow& weight : weights[static_cast<std::size_t>(power) - 1]) conditions.take(weight);
  }
  Graded graded;
  Echelon taken;
  for (int power = table.order + 1; power > 0; --power) {
    for (const WeightRow& one : spaces[static_cast<std::size_t>(power) - 1]) {
      if (!taken.take(one)) continue;
      graded.combinations.push_back(one);
      graded.powers.push_back(power);
    }
  }
  return graded;
}

/// Polynomials of words, whose letters are the combinations; terms of more than some power are left out.
using Polynomial = std::map<std::string, Quad>;

class FreeAlgebra {
 public:
  FreeAlgebra(std::vector<int> powers, int most) : powers_(std::move(powers)), most_(most) {}

  int power(const std::string& word) const {
    return std::accumulate(word.begin(), word.end(), 0,
                           [&](int sum, char letter) { return sum + powers_[static_cast<std::size_t>(letter)]; });
  }
  static void add(Polynomial& to, const Polynomial& what, const Quad& times) {
    for (const auto& [word, weight] : what) to[word] += times * weight;
  }
  Polynomial bracket(const Polynomial& u, const Polynomial& v) const {
    Polynomial out;
    for (const auto& [one, first] : u) {
      for (const auto& [other, second] : v) {
        if (power(one) + power(other) > most_) continue;
        out[one + other] += first * second;
        out[other + one] -= first * second;
      }
    }
    std::erase_if(out, [](const auto& term) { return is_none(term.second); });
    return out;
  }
  Polynomial up_to(const Polynomial& u, int most) const {
    Polynomial out;
    for (const auto& term : u) {
      if (power(term.first) <= most) out.insert(term);
    }
    return out;
  }

 private:
  std::vector<int> powers_;
  int most_;
};

/// Stages as polynomials of the combinations: the inverse of these.
std::vector<Polynomial> graded_stages(const Graded& graded, int order) {
  const std::size_t s = graded.powers.size();
  WeightRows left = graded.combinations, right(s, WeightRow(s, Quad(0)));
  for (std::size_t i = 0; i < s; ++i) right[i][i] = Quad(1);
  for (std::size_t k = 0; k < s; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < s; ++i) pivot = abs(left[i][k]) > abs(left[pivot][k]) ? i : pivot;
    std::swap(left[k], left[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = 0; i < s; ++i) {
      if (i == k) continue;
      const Quad factor = left[i][k] / left[k][k];
      for (std::size_t j = 0; j < s; ++j) {
        left[i][j] -= factor * left[k][j];
        right[i][j] -= factor * right[k][j];
      }
    }
  }
  std::vector<Polynomial> stages(s);
  for (std::size_t k = 0; k < s; ++k) {
    for (std::size_t j = 0; j < s; ++j) {
      const Quad weight = right[k][j] / left[k][k];
      if (!is_none(weight) && graded.powers[j] <= order) stages[k][std::string(1, static_cast<char>(j))] = weight;
    }
  }
  return stages;
}

/// The elements of all stages and of the step.
std::vector<Polynomial> elements_of(const Tableau& table, const FreeAlgebra& algebra,
                                    const std::vector<Polynomial>& K) {
  const int order = table.order;
  std::vector<Polynomial> corrected, elements;
  for (std::size_t i = 0; i < table.stages(); ++i) {
    Polynomial u;
    for (std::size_t j = 0; j < table.a[i].size(); ++j) FreeAlgebra::add(u, corrected[j], table.a[i][j]);
    u = algebra.up_to(u, order - 1);
    Polynomial nested = K[i], sum = K[i];
    for (int terms = 1; terms <= order; ++terms) {
      nested = algebra.bracket(u, nested);
      FreeAlgebra::add(sum, nested, dexp_weight(terms));
    }
    elements.push_back(std::move(u));
    corrected.push_back(std::move(sum));
  }
  Polynomial last;
  for (std::size_t i = 0; i < table.stages(); ++i) FreeAlgebra::add(last, corrected[i], table.b[i]);
  elements.push_back(std::move(last));
  return elements;
}

}  // namespace

std::vector<int> bracket_dimensions(const Tableau& table) {
  const Graded graded = graded_combinations(table);
  const FreeAlgebra algebra(graded.powers, table.order);
  const std::vector<Polynomial> elements = elements_of(table, algebra, graded_stages(graded, table.order));
  std::vector<int> dimensions;
  for (int power = 3; power <= table.order; ++power) {
    std::map<std::string, std::size_t> place;
    for (const Polynomial& element : elements) {
      for (const auto& [word, weight] : element) {
        if (word.size() > 1 && algebra.power(word) == power) place.emplace(word, place.size());
      }
    }
    Echelon independent;
    for (const Polynomial& element : elements) {
      WeightRow row(place.size(), Quad(0));
      for (const auto& [word, at] : place) {
        const auto found = element.find(word);
        if (found != element.end()) row[at] = found->second;
      }
      independent.take(std::move(row));
    }
    dimensions.push_back(independent.rank());
  }
  return dimensions;
}

int least_commutators(const Tableau& table) {
  const std::vector<int> dimensions = bracket_dimensions(table);
  return std::accumulate(dimensions.begin(), dimensions.end(), 0);
}

}  // namespace noether
