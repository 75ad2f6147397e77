#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "core/assembly/pattern.hpp"
#include "tests/assembly/differences.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

BlockLayout random_layout(int blocks, std::mt19937& random) {
  BlockLayout layout;
  layout.begin.assign(1, 0);
  for (int b = 0; b < blocks; ++b) {
    const int size = std::uniform_int_distribution<int>(1, 3)(random);
    for (int k = 0; k < size; ++k) layout.block_of_unknown.push_back(b);
    layout.begin.push_back(layout.begin.back() + size);
  }
  return layout;
}

/// Some unknowns in any order, with repetitions and eliminated ones (−1).
std::vector<int> random_stencil(int unknowns, std::mt19937& random) {
  std::vector<int> out(at(std::uniform_int_distribution<int>(1, 7)(random)));
  for (int& u : out) u = std::uniform_int_distribution<int>(-1, unknowns - 1)(random);
  return out;
}

}  // namespace

TEST_CASE("a Hessian pattern holds exactly the coupled pairs of blocks, and finds each of their entries") {
  std::mt19937 random(41);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const BlockLayout layout = random_layout(12, random);
    const int n = layout.begin.back();
    HessianPattern pattern;
    std::vector<char> stored(at(n * n), 0);  // dense, both triangles
    const auto couple = [&](int a, int b) {
      for (int i = layout.begin[at(a)]; i < layout.begin[at(a) + 1]; ++i) {
        for (int j = layout.begin[at(b)]; j < layout.begin[at(b) + 1]; ++j)
          stored[at(i * n + j)] = stored[at(j * n + i)] = 1;
      }
    };
    for (int b = 0; b < layout.blocks(); ++b) couple(b, b);
    for (int k = 0; k < 8; ++k) {
      const std::vector<int> stencil = random_stencil(n, random);
      pattern.couple(layout, stencil.data(), static_cast<int>(stencil.size()));
      for (const int a : stencil) {
        for (const int b : stencil) {
          if (a >= 0 && b >= 0) couple(layout.block_of_unknown[at(a)], layout.block_of_unknown[at(b)]);
        }
      }
    }
    pattern.finish(layout);

    const SparsityPattern view = pattern.view();
    REQUIRE(static_cast<int>(view.begin.size()) == n + 1);
    int entry = 0;
    for (int j = 0; j < n; ++j) {
      CHECK(view.begin[at(j)] == entry);
      for (int i = j; i < n; ++i) {
        if (stored[at(i * n + j)] == 0) continue;
        REQUIRE(entry < view.entries());
        CHECK(view.inner[at(entry)] == i);
        CHECK(pattern.position(layout, i, j) == entry);
        CHECK(pattern.position(layout, j, i) == entry);
        ++entry;
      }
    }
    CHECK(entry == view.entries());
    CHECK(entry > n);
  }
}

TEST_CASE("a Jacobian pattern holds each row's unknowns once, in increasing order, and finds them") {
  std::mt19937 random(42);
  JacobianPattern pattern;
  std::vector<std::vector<int>> expected;
  for (int r = 0; r < 30; ++r) {
    const std::vector<int> stencil = random_stencil(25, random);
    pattern.add_row(stencil.data(), static_cast<int>(stencil.size()));
    std::vector<int> row;
    for (const int u : stencil) {
      if (u >= 0) row.push_back(u);
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    expected.push_back(row);
  }
  const SparsityPattern view = pattern.view();
  REQUIRE(view.begin.size() == expected.size() + 1);
  for (int r = 0; r < 30; ++r) {
    const std::vector<int> row(view.inner.begin() + view.begin[at(r)], view.inner.begin() + view.begin[at(r) + 1]);
    CHECK(row == expected[at(r)]);
    for (std::size_t k = 0; k < row.size(); ++k) {
      CHECK(pattern.position(r, row[k]) == view.begin[at(r)] + static_cast<int>(k));
    }
  }
  pattern.clear();
  CHECK(pattern.view().entries() == 0);
}

TEST_CASE("the Hessian's pattern has room for the products of what one contact row reads") {
  for (const int dimension : {2, 3}) {
    SmallScene scene;
    scene.dimension = dimension;
    const auto session = session_of(scene);
    const Assembly& assembly = *session->assembly;
    const int n = assembly.unknowns();
    const SparsityPattern triangle = assembly.hessian_pattern();
    const std::vector<double> stored = dense_symmetric(triangle, std::vector<double>(at(triangle.entries()), 1.0), n);
    const SparsityPattern rows = assembly.jacobian_pattern();
    int pairs = 0;
    for (const RowOrigin& group : assembly.row_origins()) {
      if (group.constraint < 0) continue;
      for (int r = group.first; r < group.first + group.count; ++r) {
        for (int a = rows.begin[at(r)]; a < rows.begin[at(r) + 1]; ++a) {
          for (int b = rows.begin[at(r)]; b < rows.begin[at(r) + 1]; ++b, ++pairs) {
            CHECK(stored[at(rows.inner[at(a)] * n + rows.inner[at(b)])] == 1.0);
          }
        }
      }
    }
    CHECK(pairs > 0);
  }
}

TEST_CASE("the order along the curves is a permutation in which a row follows the unknowns that it reads") {
  SmallScene scene;
  scene.dimension = 3;
  const auto session = session_of(scene);
  const Assembly& assembly = *session->assembly;
  const int n = assembly.unknowns();
  const Span<const int> order = assembly.order();
  REQUIRE(static_cast<int>(order.size()) == n + assembly.rows());
  std::vector<int> place(order.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) place[at(order[k])] = static_cast<int>(k);
  for (const int p : place) CHECK(p >= 0);
  const SparsityPattern rows = assembly.jacobian_pattern();
  for (int r = 0; r < assembly.rows(); ++r) {
    for (int k = rows.begin[at(r)]; k < rows.begin[at(r) + 1]; ++k) {
      CHECK(place[at(rows.inner[at(k)])] < place[at(n + r)]);
    }
  }
}

}  // namespace bowstring::testing
