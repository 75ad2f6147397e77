#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/assembly/finite.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// A constraint's answer with its rows' supports, spread over all places of each row.
struct Spread {
  std::vector<double> jacobian, hessian;
};

struct Rows {
  const RowDeclaration& declared;
  int dimension;

  int places(int row) const { return declared.place_begin[at(row) + 1] - declared.place_begin[at(row)]; }
  std::size_t numbers() const { return declared.places.size() * at(dimension); }
  std::size_t pairs() const {
    std::size_t sum = 0;
    for (int r = 0; r < declared.rows; ++r) sum += at(packed_size(places(r) * dimension));
    return sum;
  }
};

Spread spread(const Rows& rows, const std::vector<RowSupport>& support, const std::vector<double>& jacobian,
              const std::vector<double>& hessian) {
  Spread out{std::vector<double>(jacobian.size(), 0.0), std::vector<double>(hessian.size(), 0.0)};
  std::size_t first = 0, first_pair = 0;
  for (int r = 0; r < rows.declared.rows; ++r) {
    const auto place = [&](int k) {
      return support[at(r)].place(k / rows.dimension) * rows.dimension + k % rows.dimension;
    };
    for (int a = 0, k = 0; a < support[at(r)].places() * rows.dimension; ++a) {
      out.jacobian[first + at(place(a))] = jacobian[first + at(a)];
      for (int b = 0; b <= a; ++b, ++k) {
        out.hessian[first_pair + at(packed_index(place(a), place(b)))] = hessian[first_pair + at(k)];
      }
    }
    first += at(rows.places(r) * rows.dimension);
    first_pair += at(packed_size(rows.places(r) * rows.dimension));
  }
  return out;
}

/// Reads two nodes of the first curve and answers what it is told to.
class TestRow final : public Constraint {
 public:
  RowSupport support{0, 0, 2};
  double derivative = 1.0;

  Status declare(const ConstraintScene&, RowDeclaration&) noexcept override { return {}; }
  Status evaluate(const RowEvaluation& evaluation) const noexcept override {
    if (!evaluation.support.empty()) evaluation.support[0] = support;
    std::fill(evaluation.residual.begin(), evaluation.residual.end(), 0.0);
    std::fill(evaluation.jacobian.begin(), evaluation.jacobian.end(), derivative);
    std::fill(evaluation.hessian.begin(), evaluation.hessian.end(), derivative);
    return {};
  }
};

struct TestRowScene {
  explicit TestRowScene(const SmallScene& text) : session(session_of(text)) {
    ConstraintUse& use = session->scene->constraints[0];
    use.constraint = Owned<Constraint>(&row, [](void*) {});
    use.rows = {};
    use.rows.rows = 1;
    use.rows.place_begin = {0, 2};
    use.rows.places = {{0, Site::node, 2}, {0, Site::node, 3}};
    use.rows.lower = {-1.0};
    use.rows.upper = {1.0};
    session->assembly = std::make_unique<Assembly>(*session->scene);
  }
  Status evaluate() {
    Assembly& assembly = *session->assembly;
    std::vector<double> jacobian(at(assembly.jacobian_pattern().entries()));
    ProblemEvaluation evaluation;
    evaluation.jacobian = jacobian;
    return assembly.evaluate(moved_start(*session, 0.1, ++seed), evaluation);
  }
  TestRow row;
  std::unique_ptr<Session> session;
  unsigned seed = 0;
};

}  // namespace

TEST_CASE("what a contact row says of its support is what it writes over all its places") {
  for (const int dimension : {2, 3}) {
    for (const char* type : {"node-wise-contact", "segment-wise-contact", "same-index-contact"}) {
      SmallScene scene;
      scene.dimension = dimension;
      scene.contact_type = type;
      scene.wire_nodes = 8;
      CAPTURE(scene.text());
      const auto session = session_of(scene);
      Assembly& assembly = *session->assembly;
      const std::vector<double> q = moved_start(*session, 0.1, 5);
      REQUIRE(assembly.evaluate(q, {}).ok());
      const ConstraintUse& use = session->scene->constraints[0];
      const Rows rows{use.rows, dimension};
      const std::vector<double> weight = random_numbers(use.rows.rows, 6);
      std::vector<double> jacobian(rows.numbers()), hessian(rows.pairs());
      RowEvaluation evaluation;
      evaluation.at = &assembly;
      evaluation.weight = weight;
      evaluation.jacobian = jacobian;
      evaluation.hessian = hessian;
      REQUIRE(use.constraint->evaluate(evaluation).ok());
      const Spread all{jacobian, hessian};

      std::vector<RowSupport> support;
      for (int r = 0; r < use.rows.rows; ++r) support.push_back({0, 0, rows.places(r)});
      evaluation.support = support;
      REQUIRE(use.constraint->evaluate(evaluation).ok());
      const Spread narrow = spread(rows, support, jacobian, hessian);
      REQUIRE(largest(all.jacobian) > 0.0);
      REQUIRE(largest(all.hessian) > 0.0);
      CHECK(narrow.jacobian == all.jacobian);
      CHECK(narrow.hessian == all.hessian);

      // Row by row the same.
      REQUIRE(use.rows.in_parts);
      std::size_t first = 0;
      for (int r = 0; r < use.rows.rows; ++r) {
        const auto count = at(packed_size(rows.places(r) * dimension));
        std::vector<double> one(count);
        RowEvaluation part;
        part.at = &assembly;
        part.first = r;
        part.count = 1;
        part.weight = {weight.data() + r, 1};
        part.hessian = one;
        REQUIRE(use.constraint->evaluate(part).ok());
        CHECK(one == std::vector<double>(all.hessian.begin() + static_cast<std::ptrdiff_t>(first),
                                         all.hessian.begin() + static_cast<std::ptrdiff_t>(first + count)));
        first += count;
      }
    }
  }
}

TEST_CASE("a row that depends on places that it does not have stops the evaluation by name") {
  TestRowScene scene{SmallScene{}};
  REQUIRE(scene.evaluate().ok());
  for (const RowSupport wrong :
       {RowSupport{0, 1, 2}, RowSupport{2, 1, 1}, RowSupport{-1, 0, 1}, RowSupport{0, 0, -1}}) {
    scene.row.support = wrong;
    const Status status = scene.evaluate();
    CHECK(status.code == Code::failed);
    CHECK(status.text == "constraint 'lumen': row 0 depends on places that it does not have");
  }
}

TEST_CASE("a derivative that is not finite stops the evaluation by name, unless it is of a place that does not count") {
  TestRowScene scene{SmallScene{}};
  scene.row.derivative = nan_value;
  CHECK(scene.evaluate().text == "constraint 'lumen': a derivative of row 0 is not a finite number");
  scene.row.support = {0, 0, 0};
  CHECK(scene.evaluate().ok());
}

TEST_CASE("two assemblies of one scene at the same state give the same numbers, whichever has been asked before") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    SmallScene scene;
    scene.dimension = 3;
    scene.vessel_frames = true;
    scene.vessel_kinematics = scene.wire_kinematics = kinematics;
    const auto session = session_of(scene);
    Assembly second(*session->scene);
    const std::vector<double> multipliers = random_numbers(second.rows(), 7);
    const auto hessian = [&](Assembly& assembly, const std::vector<double>& q) {
      std::vector<double> out(at(assembly.hessian_pattern().entries()));
      REQUIRE(assembly.lagrangian_hessian(q, 1.0, multipliers, out).ok());
      return out;
    };
    const std::vector<double> q[] = {moved_start(*session, 0.1, 1), moved_start(*session, 0.2, 2)};
    const std::vector<double> expected = hessian(*session->assembly, q[0]);
    REQUIRE(largest_difference(expected, hessian(second, q[1])) > 1e-3);
    CHECK(hessian(*session->assembly, q[0]) == expected);
    CHECK(hessian(second, q[0]) == expected);
  }
}

TEST_CASE("places that nothing reads are up to date at an accepted state") {
  SmallScene scene;
  scene.contact = "";
  const auto session = session_of(scene);
  Assembly& assembly = *session->assembly;
  const std::vector<double> q = moved_start(*session, 0.2, 3);
  REQUIRE(assembly.accept(q).ok());
  const int wire = session->scene->find("wire")->view.index;
  const double* frames = assembly.table(wire, Site::frame);
  REQUIRE(frames != nullptr);
  const Curve& curve = *session->scene->curves[at(wire)];
  const double angle = q[at(curve.coordinate_begin + 2 * curve.view.nodes)];
  REQUIRE(angle != session->scene->start_coordinates()[at(curve.coordinate_begin + 2 * curve.view.nodes)]);
  CHECK(frames[0] == angle);
}

TEST_CASE("all_finite finds what is not, wherever it stands") {
  for (int count = 0; count < 20; ++count) {
    std::vector<double> numbers = random_numbers(count, 8);
    CHECK(all_finite(numbers.data(), numbers.size()));
    for (int k = 0; k < count; ++k) {
      for (const double wrong : {nan_value, std::numeric_limits<double>::infinity(), -HUGE_VAL}) {
        std::vector<double> flawed = numbers;
        flawed[at(k)] = wrong;
        CHECK_FALSE(all_finite(flawed.data(), flawed.size()));
      }
    }
  }
  const std::vector<double> large(9, std::numeric_limits<double>::max());
  CHECK(all_finite(large.data(), large.size()));
}

}  // namespace bowstring::testing
