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

TEST_CASE(
    "a Hessian pattern of lasting couplings and rows is that of all couplings, and says where the lasting ones are") {
  std::mt19937 random(43);
  HessianPattern merged;
  std::vector<int> position;
  for (int repetition = 0; repetition < 20; ++repetition) {
    const BlockLayout layout = random_layout(12 + repetition % 5, random);
    const int n = layout.begin.back();
    HessianPattern lasting, all;
    for (int k = 0; k < 5; ++k) {
      const std::vector<int> stencil = random_stencil(n, random);
      lasting.couple(layout, stencil.data(), static_cast<int>(stencil.size()));
      all.couple(layout, stencil.data(), static_cast<int>(stencil.size()));
    }
    lasting.finish(layout);
    RowBlocks rows;
    for (int r = 0; r < 6; ++r) {
      const std::vector<int> stencil = random_stencil(n, random);
      all.couple(layout, stencil.data(), static_cast<int>(stencil.size()));
      std::vector<int> blocks;
      for (const int u : stencil) {
        if (u >= 0) blocks.push_back(layout.block_of_unknown[at(u)]);
      }
      std::sort(blocks.begin(), blocks.end());
      blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
      rows.add_row(blocks.data(), static_cast<int>(blocks.size()));
    }
    all.finish(layout);
    merged.assign(layout, lasting, rows, position);

    const SparsityPattern expected = all.view(), found = merged.view(), part = lasting.view();
    REQUIRE(expected.entries() > part.entries());
    CHECK(std::equal(expected.begin.begin(), expected.begin.end(), found.begin.begin(), found.begin.end()));
    CHECK(std::equal(expected.inner.begin(), expected.inner.end(), found.inner.begin(), found.inner.end()));
    REQUIRE(static_cast<int>(position.size()) == part.entries());
    for (int j = 0; j < n; ++j) {
      for (int k = part.begin[at(j)]; k < part.begin[at(j) + 1]; ++k) {
        CHECK(position[at(k)] == merged.position(layout, part.inner[at(k)], j));
      }
    }
    for (std::size_t p = 0; p < merged.pairs().size(); ++p) {
      const HessianPattern::Pair& pair = merged.pairs()[p];
      for (const int guess : {-1, static_cast<int>(p), static_cast<int>(p) + 1, 1 << 30}) {
        CHECK(merged.find_pair(pair.row, pair.column, guess) == static_cast<int>(p));
      }
    }
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
  const int kept = pattern.view().begin[3];
  pattern.keep(3);
  CHECK(pattern.rows() == 3);
  CHECK(pattern.view().entries() == kept);
  CHECK(pattern.add_run(2, 3) == kept);
  CHECK(pattern.add_run(9, 1) == kept + 3);
  pattern.end_row();
  CHECK(pattern.rows() == 4);
  CHECK(pattern.position(3, 4) == kept + 2);
  CHECK(pattern.position(3, 9) == kept + 3);
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

namespace {

/// Whether the order holds every number once, those that read whole curves last, and a row after the other unknowns
/// that it reads.
void check_order(const Assembly& assembly) {
  const int n = assembly.unknowns(), numbers = n + assembly.rows();
  const Span<const int> order = assembly.order();
  REQUIRE(static_cast<int>(order.size()) == numbers);
  std::vector<int> place(order.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) place[at(order[k])] = static_cast<int>(k);
  for (const int p : place) CHECK(p >= 0);
  const int bordered = numbers - assembly.border();
  for (int k = bordered; k < numbers; ++k) CHECK(order[at(k)] < n);
  const SparsityPattern rows = assembly.jacobian_pattern();
  int followed = 0;
  for (int r = 0; r < assembly.rows(); ++r) {
    for (int k = rows.begin[at(r)]; k < rows.begin[at(r) + 1]; ++k) {
      const int unknown = place[at(rows.inner[at(k)])];
      if (unknown >= bordered) continue;
      CHECK(unknown < place[at(n + r)]);
      ++followed;
    }
  }
  CHECK(followed > 0);
}

}  // namespace

TEST_CASE("the order along the curves is a permutation in which a row follows the unknowns that it reads") {
  SmallScene scene;
  scene.dimension = 3;
  const auto session = session_of(scene);
  CHECK(session->assembly->border() == 1);  // the wire's length
  check_order(*session->assembly);

  const auto narrow = narrow_session(scene);
  const Span<const int> order = narrow->assembly->order();
  const std::vector<int> before(order.begin(), order.end());
  REQUIRE(narrow->assembly->accept(slid(*narrow, 1.4)).ok());
  REQUIRE(narrow->assembly->new_epoch().ok());
  const Span<const int> after = narrow->assembly->order();
  CHECK_FALSE(std::equal(before.begin(), before.end(), after.begin(), after.end()));
  check_order(*narrow->assembly);
}

}  // namespace bowstring::testing
