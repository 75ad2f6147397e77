#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "problems.hpp"

using namespace exact_test;

namespace {

using Table = std::vector<int>;

/// Every table of whole numbers with these sums.
void for_each_table(const Table& rows, const Table& columns, const std::function<void(const Table&)>& visit) {
  Table table(rows.size() * columns.size(), 0), left_of_row = rows, left_of_column = columns;
  const std::function<void(std::size_t)> fill = [&](std::size_t place) {
    if (place == table.size()) {
      if (std::all_of(left_of_column.begin(), left_of_column.end(), [](int left) { return left == 0; })) visit(table);
      return;
    }
    const std::size_t i = place / columns.size(), j = place % columns.size();
    const bool last = j + 1 == columns.size();
    for (int mass = last ? left_of_row[i] : 0; mass <= std::min(left_of_row[i], left_of_column[j]); ++mass) {
      table[place] = mass;
      left_of_row[i] -= mass;
      left_of_column[j] -= mass;
      fill(place + 1);
      left_of_row[i] += mass;
      left_of_column[j] += mass;
    }
  };
  fill(0);
}

Table random_sums(std::mt19937& random, int places, int whole) {
  Table out(static_cast<std::size_t>(places), 0);
  for (int k = 0; k < whole; ++k) ++out[static_cast<std::size_t>(below(random, places))];
  return out;
}

}  // namespace

TEST_CASE("unique or not, and the slack, against all plans of small problems") {
  std::mt19937 random(10);
  int several = 0, single = 0, with_slack = 0;
  for (int repeat = 0; repeat < 3000; ++repeat) {
    const int whole = 2 + below(random, 5);
    const Table rows = random_sums(random, 2 + below(random, 3), whole);
    const Table columns = random_sums(random, 2 + below(random, 2), whole);
    MatrixProblem problem{{rows.begin(), rows.end()}, {columns.begin(), columns.end()}, {}};
    const int spread = 2 + below(random, 20);
    for (std::size_t k = 0; k < rows.size() * columns.size(); ++k) problem.cost.push_back(below(random, spread));
    // Of whole sums all vertices are tables of whole numbers: there are several optima where several tables are.
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, Table>> tables;
    for_each_table(rows, columns, [&](const Table& table) {
      double cost = 0.0;
      for (std::size_t k = 0; k < table.size(); ++k) cost += table[k] * problem.cost[k];
      tables.emplace_back(cost, table);
      least = std::min(least, cost);
    });
    const auto optima =
        std::count_if(tables.begin(), tables.end(), [&](const auto& entry) { return entry.first == least; });
    (optima > 1 ? several : single) += 1;
    for (const std::string& method : exact_methods()) {
      CAPTURE(method);
      CAPTURE(repeat);
      const TransportAnswer answer = solve_cold(method, problem);
      CHECK(answer.value == doctest::Approx(least).epsilon(1e-13));
      CHECK(answer.uniqueness_known);
      CHECK(answer.multiple == (optima > 1));
      Table plan(rows.size() * columns.size(), 0);
      for (std::size_t k = 0; k < answer.plan.value.size(); ++k) {
        plan[static_cast<std::size_t>(answer.plan.row[k]) * columns.size() +
             static_cast<std::size_t>(answer.plan.column[k])] = static_cast<int>(std::lround(answer.plan.value[k]));
      }
      CHECK(answer.slack >= 0.0);
      if (optima > 1) CHECK(answer.slack == 0.0);
      if (answer.slack > 0.5) ++with_slack;
      for (const auto& [cost, table] : tables) {
        int change = 0;
        for (std::size_t k = 0; k < table.size(); ++k) change = std::max(change, std::abs(table[k] - plan[k]));
        if (change > 0) CHECK(cost - least >= answer.slack * change - 1e-9);
      }
    }
  }
  CHECK(several > 300);
  CHECK(single > 300);
  CHECK(with_slack > 300);
}

TEST_CASE("where all costs are alike every plan is optimal, whatever its size") {
  for (const std::string& method : exact_methods()) {
    for (const int count : {1, 2, 200}) {
      const auto places = static_cast<std::size_t>(count);
      const MatrixProblem problem{std::vector<double>(places, 1.0), std::vector<double>(places, 1.0),
                                  std::vector<double>(places * places, 3.0)};
      const TransportAnswer answer = solve_cold(method, problem);
      CHECK(answer.value == doctest::Approx(3.0 * count).epsilon(1e-14));
      CHECK(answer.multiple == (count > 1));
      CHECK(answer.plan.value.size() == places);
      check_proof(problem, answer);
    }
  }
}
