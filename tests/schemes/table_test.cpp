// The tables themselves: sums, symmetry, costs, names, and the weights a run works with.

#include "integrators/all_schemes.hpp"
#include "numbers/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace noether {
namespace {

std::vector<Quad> magnitudes(const Word& word, char letter) {
  std::vector<Quad> all;
  for (const Stage& stage : word) {
    if (stage.letter == letter) all.push_back(abs(stage.weight));
  }
  return all;
}

TEST_CASE("the weights of both letters sum to 1 in every table", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    for (const char letter : {'A', 'B'}) {
      CAPTURE(std::string(scheme->name), letter);
      Quad sizes = 0;
      for (const Quad& magnitude : magnitudes(scheme->word, letter)) sizes += magnitude;
      CHECK(abs(scheme->sum(letter) - Quad(1)) <= Quad(4) * std::numeric_limits<Quad>::epsilon() * sizes);
    }
  }
}

TEST_CASE("every scheme is a palindrome except the five that are not made so", "[schemes]") {
  std::set<std::string_view> others;
  for (const Scheme* scheme : schemes::all()) {
    if (!scheme->is_symmetric()) others.insert(scheme->name);
  }
  CHECK(others == std::set<std::string_view>{"symplectic_euler_a", "symplectic_euler_b", "ruth_3", "mclachlan_atela_4",
                                             "mclachlan_atela_5"});
}

TEST_CASE("orders above 2 need steps backwards in both letters", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(std::string(scheme->name));
    CHECK(scheme->has_negative_steps() == (scheme->order.classical > 2));
    for (const char letter : {'A', 'B'}) {
      Quad sum = 0;
      for (const Quad& magnitude : magnitudes(scheme->word, letter)) sum += magnitude;
      if (scheme->order.classical > 2) CHECK(sum > Quad(1.0001));
    }
  }
}

/// Cost and size of the weights as published comparisons give them, the latter to the digits shown.
struct Row {
  std::string_view name;
  int evaluations;
  double largest, sum;  ///< of the magnitudes of the step weights (compositions) or kicks, sums to three digits
};

const std::vector<Row> rows = {
    {"verlet", 1, 1, 1},
    {"mclachlan_2_s2", 2, 0.5, 1},
    {"ruth_3", 3, 0.75, 1.08},
    {"yoshida_4", 3, 1.70, 4.40},
    {"suzuki_4", 5, 0.66, 2.32},
    {"mclachlan_ss5", 5, 0.81, 2.62},
    {"pefrl", 4, 0.71, 1.85},
    {"vefrl", 4, 1.80, 4.60},
    {"mclachlan_s4", 4, 0.55, 1.18},
    {"mclachlan_s5", 5, 0.40, 1.40},
    {"mclachlan_sb3a_m4", 4, 1.00, 3.00},
    {"mclachlan_sb3a_m5", 5, 0.51, 1.16},
    {"mclachlan_atela_4", 4, 0.76, 1.45},
    {"mclachlan_atela_5", 6, 0.70, 1.46},
    {"blanes_moan_s6", 6, 0.43, 1.58},
    {"srkn6b", 6, 0.40, 1.16},
    {"okunbor_skeel_6_13", 7, 0.69, 2.52},
    {"yoshida_6", 7, 1.32, 5.71},
    {"yoshida_6_b", 7, 2.38, 9.53},
    {"yoshida_6_c", 7, 2.39, 9.58},
    {"kahan_li_6_s9", 9, 0.80, 3.82},
    {"mclachlan_ss9", 9, 0.94, 4.37},
    {"sofroniou_spaletta_6_s11", 11, 0.50, 2.77},
    {"sofroniou_spaletta_6_s13", 13, 0.40, 2.40},
    {"blanes_moan_s10", 10, 0.43, 1.60},
    {"srkn11b", 11, 0.24, 1.21},
    {"srkn14a", 14, 0.33, 2.01},
    {"yoshida_8_a", 15, 2.45, 20.8},
    {"yoshida_8_b", 15, 3.08, 28.1},
    {"yoshida_8_c", 15, 1.68, 18.2},
    {"yoshida_8", 15, 1.96, 15.3},
    {"yoshida_8_e", 15, 2.69, 14.9},
    {"suzuki_umeno_8_s15", 15, 0.80, 6.53},
    {"kahan_li_8_s17", 17, 0.61, 5.35},
    {"mclachlan_ss17", 17, 0.63, 5.53},
    {"morales_8_s17", 17, 0.61, 5.35},
    {"sofroniou_spaletta_8_s21", 21, 0.38, 3.68},
    {"kahan_li_10_s33", 33, 0.84, 12.4},
    {"sofroniou_spaletta_10_s35", 35, 0.41, 6.18},
};

/// Magnitudes that the table of costs speaks of: the steps of a composition of Verlet are the weights of its drifts.
std::vector<Quad> costly(const Scheme& scheme) { return magnitudes(scheme.word, scheme.is_composition() ? 'A' : 'B'); }

TEST_CASE("evaluations, largest weights and their sums are those of the published comparison", "[schemes]") {
  for (const Row& row : rows) {
    CAPTURE(std::string(row.name));
    const Scheme* scheme = schemes::find(row.name);
    REQUIRE(scheme != nullptr);
    CHECK(scheme->evaluations() == row.evaluations);
    double largest = 0, sum = 0;
    for (const Quad& weight : costly(*scheme)) {
      largest = std::max(largest, static_cast<double>(weight));
      sum += static_cast<double>(weight);
    }
    CHECK(std::abs(largest - row.largest) <= 0.00501);
    CHECK(std::abs(sum - row.sum) <= (row.sum >= 10 ? 0.0501 : 0.00501));
  }
}

TEST_CASE("near-integrable schemes cost the kicks of their tables", "[schemes]") {
  const int kicks[] = {1, 2, 3, 4, 5, 7, 7, 8, 6, 8, 9};
  for (std::size_t k = 0; k < std::size(kicks); ++k) {
    CAPTURE(std::string(schemes::near_integrable_list[k]->name));
    CHECK(schemes::near_integrable_list[k]->evaluations() == kicks[k]);
  }
}

TEST_CASE("names and aliases are unique, lead back to their scheme, and a wrong one leads nowhere", "[schemes]") {
  std::set<std::string> seen;
  for (const Scheme* scheme : schemes::all()) {
    std::vector<std::string> names = schemes::aliases_of(*scheme);
    names.emplace_back(scheme->name);
    for (const std::string& name : names) {
      CAPTURE(name);
      CHECK(seen.insert(name).second);
      CHECK(schemes::find(name) == scheme);
    }
    CHECK_FALSE(scheme->summary.empty());
    CHECK_FALSE(scheme->source.empty());
  }
  CHECK(schemes::names().size() == schemes::all().size());
  CHECK(schemes::find("yoshida_7") == nullptr);
  CHECK(schemes::find("") == nullptr);
}

/// A weight of a table and its closed form.
struct ClosedForm {
  Quad printed, exact;
};

TEST_CASE("printed coefficients agree with their closed forms", "[schemes]") {
  const auto stage = [](const Scheme& scheme, std::size_t k) { return scheme.word[k].weight; };
  const Quad third = 1_q / 3_q, z = sqrt(7_q / 8_q) / 3_q, root19 = sqrt(19_q), root471 = sqrt(471_q);
  const Quad s2 = cbrt(2_q * sqrt(326_q) + 36_q);
  const ClosedForm forms[] = {
      {stage(schemes::yoshida_4, 1), 1_q / (2_q - cbrt(2_q))},
      {stage(schemes::suzuki_4, 1), 1_q / (4_q - cbrt(4_q))},
      {stage(schemes::mclachlan_2_s2, 0), 0.5_q - s2 / 12_q + 1_q / (6_q * s2)},
      {stage(schemes::mclachlan_s4, 0), (642_q + root471) / 3924_q},
      {stage(schemes::mclachlan_s4, 1), 6_q / 11_q},
      {stage(schemes::mclachlan_s4, 2), 121_q * (12_q - root471) / 3924_q},
      {stage(schemes::mclachlan_s5, 0), (14_q - root19) / 108_q},
      {stage(schemes::mclachlan_s5, 2), (20_q - 7_q * root19) / 108_q},
      {stage(schemes::mclachlan_sb3a_m4, 0), 0.5_q - z},
      {stage(schemes::mclachlan_sb3a_m4, 2), z - third},
      {stage(schemes::mclachlan_sb3a_m5, 1), -3_q / 73_q},
      {stage(schemes::mclachlan_sb3a_m5, 3), 17_q / 59_q},
      {stage(schemes::saba_2, 0), (3_q - sqrt(3_q)) / 6_q},
      {stage(schemes::saba_3, 0), 0.5_q - sqrt(15_q) / 10_q},
  };
  for (const auto& [printed, exact] : forms) {
    CAPTURE(to_string(printed), to_string(exact));
    CHECK(abs(printed - exact) < Quad(1e-19));
  }
}

double half_ulp(double x) { return (std::nextafter(std::abs(x), HUGE_VAL) - std::abs(x)) / 2; }

TEST_CASE("weights rounded to double still sum to 1, to half an ulp of a middle weight", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    const std::vector<double> weights = rounded_weights<double>(scheme->word);
    REQUIRE(weights.size() == scheme->word.size());
    for (const char letter : {'A', 'B'}) {
      CAPTURE(std::string(scheme->name), letter);
      Quad sum = 0;
      std::vector<double> of_letter;
      for (std::size_t k = 0; k < weights.size(); ++k) {
        if (scheme->word[k].letter != letter) continue;
        sum += Quad(weights[k]);
        of_letter.push_back(weights[k]);
      }
      const std::size_t n = of_letter.size();
      const int stands = n % 2 == 0 && of_letter[n / 2] == of_letter[n / 2 - 1] ? 2 : 1;
      CHECK(abs(sum - scheme->sum(letter)) <= Quad(stands * half_ulp(of_letter[n / 2])));
    }
  }
}

TEST_CASE("rounding to double moves no weight by more than its share of the sum", "[schemes]") {
  for (const Scheme* scheme : schemes::all()) {
    CAPTURE(std::string(scheme->name));
    const std::vector<double> weights = rounded_weights<double>(scheme->word);
    bool mirrored = true;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      mirrored = mirrored && weights[k] == weights[weights.size() - 1 - k];
      const Quad ulps = Quad(static_cast<int>(weights.size())) * Quad(0x1p-52);
      CHECK(abs(Quad(weights[k]) - scheme->word[k].weight) <= ulps);
    }
    CHECK((mirrored || !scheme->is_symmetric()));
    CHECK(rounded_weights<Quad>(scheme->word)[0] == scheme->word[0].weight);
  }
}

TEST_CASE("a word joins neighbors of one letter and drops stages of weight zero", "[schemes]") {
  Word word;
  word.push_back({'A', 0_q});
  CHECK(word.size() == 0);
  word.push_back({'B', 0.25_q});
  word.push_back({'A', 0_q});
  word.push_back({'B', 0.5_q});
  word.push_back({'A', 1_q});
  REQUIRE(word.size() == 2);
  CHECK(word[0] == Stage{'B', 0.75_q});
  CHECK(word[1] == Stage{'A', 1_q});
  Word full;
  for (std::size_t k = 0; k < Word::capacity; ++k) full.push_back({k % 2 == 0 ? 'A' : 'B', 1_q});
  CHECK_THROWS_AS(full.push_back({'A', 1_q}), LogicError);
}

TEST_CASE("a word of letters is a scheme of equal weights", "[schemes]") {
  const Scheme baoab = word("BAOAB");
  REQUIRE(baoab.word.size() == 5);
  const Stage stages[] = {{'B', 0.5_q}, {'A', 0.5_q}, {'O', 1_q}, {'A', 0.5_q}, {'B', 0.5_q}};
  for (std::size_t k = 0; k < 5; ++k) CHECK(baoab.word[k] == stages[k]);
  CHECK(baoab.name == "BAOAB");
  CHECK(baoab.order.classical == 2);
  CHECK(baoab.evaluations() == 1);

  const Scheme verlet = word("BAB");
  REQUIRE(verlet.word.size() == schemes::verlet.word.size());
  for (std::size_t k = 0; k < verlet.word.size(); ++k) CHECK(verlet.word[k] == schemes::verlet.word[k]);
  CHECK(word("BA").order.classical == 1);
  CHECK(word("ABBA").word.size() == 3);
}

TEST_CASE("text that is no word is refused with the text", "[schemes]") {
  const std::string too_long(Word::capacity + 1, 'A');
  for (const std::string& text :
       {std::string(), std::string("BAb"), std::string("B A"), std::string("AA"), std::string("BOB"), too_long + "B"}) {
    CAPTURE(text);
    std::string message;
    try {
      word(text);
    } catch (const SchemeMismatch& mismatch) {
      message = mismatch.what();
    }
    CHECK(message.find("'" + text + "'") != message.npos);
  }
}

}  // namespace
}  // namespace noether
