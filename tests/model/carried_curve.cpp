#include <doctest/doctest.h>

#include <cmath>

#include "core/curve/arc_length.hpp"
#include "core/lie/s2.hpp"
#include "core/model/carried_curve.hpp"
#include "core/result/carry.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

/// n places of a circle's arc in space, unevenly spread, with frames that also twist about it.
RecordedCurve circle(int nodes, double twist = 0.0) {
  RecordedCurve out;
  out.name = "arc";
  out.dimension = 3;
  std::vector<lie::Rotation> edges;
  const auto frame = [&](double s) {
    return lie::exp(Vector3{{0.0, 0.0, M_PI / 2.0 + 2.0 * s}}) * lie::about_first_axis(twist * s);
  };
  for (int i = 0; i < nodes; ++i) {
    const double t = static_cast<double>(i) / (nodes - 1);
    const double s = t + 0.1 * t * (1.0 - t);
    out.share.push_back(s);
    for (const double x : {10.0 * std::cos(2.0 * s), 10.0 * std::sin(2.0 * s), 3.0}) out.points.push_back(x);
  }
  for (int i = 0; i + 1 < nodes; ++i) edges.push_back(frame(0.5 * (out.share[at(i)] + out.share[at(i + 1)])));
  for (int i = 0; i < nodes; ++i) {
    lie::Rotation mean = edges[at(std::min(i, nodes - 2))];
    if (i > 0 && i < nodes - 1) {
      const lie::Rotation before = edges[at(i - 1)];
      mean = before * lie::exp(0.5 * lie::log(before.inverse() * edges[at(i)]));
    }
    double numbers[4];
    mean.store(numbers);
    out.frames.insert(out.frames.end(), numbers, numbers + 4);
  }
  find_flaw(out);
  REQUIRE(out.flaw == "");
  return out;
}

/// The largest distance from the circle of points at these shares.
double off(const RecordedCurve& recorded, const std::vector<double>& share) {
  const std::vector<double> points = interpolated_points(recorded, share);
  double largest = 0.0;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double x = points[3 * i] - 10.0 * std::cos(2.0 * share[i]);
    const double y = points[3 * i + 1] - 10.0 * std::sin(2.0 * share[i]);
    largest = std::max({largest, std::hypot(x, y), std::fabs(points[3 * i + 2] - 3.0)});
  }
  return largest;
}

CarriedState solved_state(const std::string& text, const CarriedState* from = nullptr) {
  const auto session = session_of_text(text, from);
  const Solution solution = solve(*session, nullptr);
  REQUIRE_MESSAGE(solution.certificate.verdict == Verdict::converged, solution.certificate.reason);
  Readings readings;
  REQUIRE(read_solution(*session, solution, readings).ok());
  CarriedState out = carry(*session, solution, readings, "the state before");
  out.position = "here";
  return out;
}

std::string with_wire(const std::string& text, const std::string& lines) {
  return edited(text, "radius = \"0.4 mm\"\n", "radius = \"0.4 mm\"\n" + lines);
}

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += text + "\n";
  return out;
}

Vector3 node(const std::vector<double>& points, int d, int i) {
  Vector3 out;
  for (int k = 0; k < d; ++k) out[k] = points[at(i * d + k)];
  return out;
}

double distance_to(const Vector3& p, const std::vector<double>& points, int d) {
  double least = 1e300;
  for (int i = 0; at((i + 2) * d) <= points.size(); ++i) {
    const Vector3 a = node(points, d, i), e = node(points, d, i + 1) - a;
    const double t = std::fmin(1.0, std::fmax(0.0, dot(p - a, e) / norm_squared(e)));
    least = std::fmin(least, norm(a + t * e - p));
  }
  return least;
}

}  // namespace

TEST_CASE("a recorded curve is interpolated by a C² spline of its material, recorded nodes bit for bit") {
  std::vector<double> share;
  for (int i = 0; i < 97; ++i) share.push_back(i / 96.0);
  const double coarse = off(circle(20), share), fine = off(circle(40), share);
  REQUIRE(coarse > 1e-6);
  CHECK(coarse < 1e-2);
  CHECK(coarse / fine > 10.0);  // fourth order

  const RecordedCurve recorded = circle(20);
  std::vector<double> mixed = recorded.share;
  mixed.insert(mixed.begin() + 7, 0.5 * (mixed[6] + mixed[7]));
  const std::vector<double> points = interpolated_points(recorded, mixed);
  CHECK(std::equal(recorded.points.begin(), recorded.points.begin() + 21, points.begin()));
  CHECK(std::equal(recorded.points.begin() + 21, recorded.points.end(), points.begin() + 24));

  std::vector<double> near = recorded.share;
  for (std::size_t i = 1; i + 1 < near.size(); ++i) near[i] += 0.1 / 19.0;
  CHECK(interpolated_points(recorded, near) == recorded.points);

  RecordedCurve three = circle(3);
  const std::vector<double> middle = interpolated_points(three, {0.0, 0.25 * three.share[1], three.share[1], 1.0});
  for (int k = 0; k < 3; ++k) {
    CHECK(middle[at(3 + k)] == doctest::Approx(0.75 * three.points[at(k)] + 0.25 * three.points[at(3 + k)]));
  }
}

TEST_CASE("what is wrong with a recorded curve is found") {
  const auto flaw = [](auto change) {
    RecordedCurve out = circle(5);
    change(out);
    find_flaw(out);
    return out.flaw;
  };
  CHECK(flaw([](RecordedCurve&) {}) == "");
  CHECK(flaw([](RecordedCurve& c) { c.share.clear(); }) == "no 'material_share', which older versions did not write");
  CHECK(flaw([](RecordedCurve& c) { c.points[3] = std::nan(""); }) == "'points' that are not known");
  CHECK(flaw([](RecordedCurve& c) { c.share[2] = c.share[1]; }) == "a 'material_share' that does not grow from 0 to 1");
  CHECK(flaw([](RecordedCurve& c) { c.frames.clear(); }) == "'frames' that are not known");
  CHECK(flaw([](RecordedCurve& c) { c.frames[4] += 0.1; }) == "'frames' that are no unit quaternions");
  CHECK(flaw([](RecordedCurve& c) {
          c.held_frame[1] = {1.0, 1.0, 0.0, 0.0};
        }) == "'held_frames' that are no unit quaternions");
}

TEST_CASE("material shares: State 1's arc length, or a sliding wire's own shares") {
  SmallScene scene;
  scene.wire_nodes = 5;
  const auto graded = session_of_text(with_wire(scene.text(), "spacing = [0.1, 0.2, 0.3, 0.4]\n"));
  const std::vector<double> share = material_shares(*graded->scene->find("wire"));
  const double expected[] = {0.0, 0.1, 0.3, 0.6, 1.0};
  for (int i = 0; i < 5; ++i) CHECK(share[at(i)] == doctest::Approx(expected[i]).epsilon(1e-14));
  CHECK(share.back() == 1.0);
  const Curve& vessel = *graded->scene->find("vessel");
  const std::vector<double> of_vessel = material_shares(vessel);
  for (std::size_t i = 0; i < of_vessel.size(); ++i) CHECK(of_vessel[i] == vessel.arc[i] / vessel.arc.back());
}

TEST_CASE("a finer scene takes the shape of a coarser one: places, directions and twist") {
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    SmallScene scene;
    scene.dimension = dimension;
    scene.wire_frames = scene.vessel_frames = dimension == 3;
    scene.wire_nodes = 21;
    const std::string coarse = edited(scene.text(), "nodes = 8 }", "nodes = 25 }");
    const CarriedState state = solved_state(coarse);
    scene.wire_nodes = 34;
    const std::string fine = edited(scene.text(), "nodes = 8 }", "nodes = 40 }");
    const auto session = session_of_text(fine, &state);
    std::vector<DocumentFlaw> flaws;
    const CarriedCurves carried = carried_curves(*session->scene, state, flaws);
    REQUIRE(flaws.empty());
    CHECK(carried.warnings.empty());
    CHECK(joined(session->start.warnings)
              .find("the state before is interpolated: 'vessel' from 25 nodes to 40; 'wire' "
                    "from 21 nodes to 34\n") == 0);
    for (const auto& curve : session->scene->curves) {
      const CarriedCurve& shape = carried.curves[at(curve->view.index)];
      const RecordedCurve& recorded = *state.state->find(curve->name);
      CHECK_FALSE(shape.same_mesh);
      CHECK(curve->previous == shape.points);
      REQUIRE(curve->view.previous == curve->previous.data());
      double twist = 0.0;
      for (int i = 0; i < curve->view.nodes; ++i) {
        CHECK(distance_to(node(shape.points, dimension, i), recorded.points, dimension) < 0.05);
        if (i == 0) continue;
        const Vector3 e = node(shape.points, dimension, i) - node(shape.points, dimension, i - 1);
        const lie::Rotation frame = lie::Rotation::load(shape.orientation.data() + 4 * (i - 1));
        CHECK(norm(frame.first_axis() - e / norm(e)) < 1e-12);
        if (i > 1) twist += lie::log(lie::Rotation::load(shape.orientation.data() + 4 * (i - 2)).inverse() * frame)[0];
      }
      double before = 0.0;
      for (int i = 1; i < recorded.nodes(); ++i) {
        before += lie::log(lie::Rotation::load(recorded.frames.data() + 4 * (i - 1)).inverse() *
                           lie::Rotation::load(recorded.frames.data() + 4 * i))[0];
      }
      if (dimension == 3 && curve->name == "vessel") REQUIRE(std::fabs(before) > 0.02);
      CHECK(std::fabs(twist - before) < 5e-3);
      // Where the solve starts is that shape, but for what ends hold.
      const double* q = session->start.q.data() + curve->coordinate_begin;
      for (int k = dimension; k < (curve->view.nodes - 1) * dimension; ++k) CHECK(q[k] == shape.points[at(k)]);
    }
    const Solution warm = solve(*session, nullptr);
    CHECK(warm.certificate.verdict == Verdict::converged);
    const auto cold_session = session_of_text(fine);
    const Solution cold = solve(*cold_session, nullptr);
    REQUIRE(cold.certificate.verdict == Verdict::converged);
    CHECK(warm.solver.iterations < cold.solver.iterations);
    CHECK(largest_difference(warm.q, cold.q) < 1e-4);
  }
}

TEST_CASE("a wire that is pushed in further keeps its place, and its tip runs on along the vessel") {
  for (const int dimension : {2, 3}) {
    CAPTURE(dimension);
    SmallScene scene;
    scene.dimension = dimension;
    scene.wire_ends = R"(["clamped", "free"])";
    scene.wire_nodes = 21;
    scene.tension = false;
    const std::string text = edited(scene.text(), "nodes = 8 }", "nodes = 30 }");
    const CarriedState state = solved_state(with_wire(text, "span = [\"0 mm\", \"20 mm\"]\n"));
    const RecordedCurve& before = *state.state->find("wire");
    CHECK(before.along == "vessel");
    CHECK(before.along_end == 20.0);
    for (const double end : {20.5, 30.0, 12.0}) {
      CAPTURE(end);
      const std::string further = with_wire(text, "span = [0, " + std::to_string(end) + "]\n");
      const auto session = session_of_text(further, &state);
      const std::string warnings = joined(session->start.warnings);
      CHECK(warnings.find("'wire' from the span 0 … 20 mm to 0 … ") != std::string::npos);
      const Curve& wire = *session->scene->find("wire");
      const Curve& vessel = *session->scene->find("vessel");
      double recorded = 0.0, beyond = 0.0, longest = 0.0, shortest = 1e300;
      for (int i = 0; i < wire.view.nodes; ++i) {
        const Vector3 p = node(wire.previous, dimension, i);
        const double arc = end * i / (wire.view.nodes - 1);
        if (arc <= 20.0) recorded = std::fmax(recorded, distance_to(p, before.points, dimension));
        beyond = std::fmax(beyond, distance_to(p, vessel.previous, dimension));
        if (i == 0) continue;
        const double edge = norm(p - node(wire.previous, dimension, i - 1));
        longest = std::fmax(longest, edge), shortest = std::fmin(shortest, edge);
      }
      CHECK(recorded < 0.02);
      CHECK(beyond < 3.6);  // within the lumen
      REQUIRE(shortest > 0.0);
      CHECK(longest / shortest < 1.1);
      CHECK(longest == doctest::Approx(end / 20.0).epsilon(0.05));
      const Solution solution = solve(*session, nullptr);
      CHECK(solution.certificate.verdict == Verdict::converged);
      CHECK(joined(solution.warnings).find("the scene's own start") == std::string::npos);
    }
  }
}

TEST_CASE("a wire that is exchanged starts along the vessel as it was recorded") {
  SmallScene scene;
  scene.wire_nodes = 15;
  const std::string text = edited(scene.text(), "nodes = 8 }", "nodes = 20 }");
  const CarriedState state = solved_state(text);
  std::string exchanged = text;
  for (const auto& [from, to] : {std::pair{"name = \"wire\"", "name = \"stiff\""},
                                 {"on = \"wire\"", "on = \"stiff\""},
                                 {"[\"wire\", \"vessel\"]", "[\"stiff\", \"vessel\"]"}}) {
    for (std::size_t i = exchanged.find(from); i != std::string::npos; i = exchanged.find(from)) {
      exchanged.replace(i, std::string(from).size(), to);
    }
  }
  const auto session = session_of_text(exchanged, &state);
  const std::string warnings = joined(session->start.warnings);
  CHECK(warnings.find("the state before has no wire 'stiff', which starts along 'vessel' as it was recorded\n") !=
        std::string::npos);
  CHECK(warnings.find("the state before has a wire 'wire', which this scene does not have: it is left out\n") !=
        std::string::npos);
  CHECK(warnings.find("multipliers of rows that the state before does not have, or on another mesh, start at 0: ") !=
        std::string::npos);
  const Curve& wire = *session->scene->find("stiff");
  CHECK(wire.view.previous == nullptr);
  const double* q = session->start.q.data() + wire.coordinate_begin;
  const std::vector<double> points(q, q + 2 * wire.view.nodes);
  const std::vector<double>& vessel = state.state->find("vessel")->points;
  double moved = 0.0;
  for (int i = 1; i + 1 < wire.view.nodes; ++i) {
    CHECK(distance_to(node(points, 2, i), vessel, 2) < 0.1);
    moved = std::fmax(moved, distance_to(node(points, 2, i), wire.start, 2));
  }
  REQUIRE(moved > 0.1);  // the vessel is not where State 1 has it
  CHECK(solve(*session, nullptr).certificate.verdict == Verdict::converged);
}

TEST_CASE("a state of another scene is refused with all that differs") {
  SmallScene scene;
  const CarriedState state = solved_state(scene.text());
  scene.dimension = 3;
  std::string other = scene.text();
  for (std::size_t i = other.find("\"vessel\""); i != std::string::npos; i = other.find("\"vessel\"")) {
    other.replace(i, 8, "\"aorta\"");
  }
  const std::string mend = "; start from a result of the same scene";
  CHECK(refusal_of(other, &state) ==
        "here: the state before is in the plane; expected a state in space, as this scene is" + mend +
            "\nhere: the state before has no vessel 'aorta'; expected the vessels of this scene: aorta" + mend +
            "\nhere: the state before has a vessel 'vessel', which this scene does not have; expected the vessels of "
            "this scene: aorta" +
            mend);
  RecordedState swapped = *state.state;
  for (RecordedCurve& curve : swapped.curves) {
    curve.kind = curve.kind == CurveKind::wire ? CurveKind::vessel : CurveKind::wire;
  }
  CarriedState kinds = state;
  kinds.state = std::make_shared<const RecordedState>(swapped);
  CHECK(refusal_of(SmallScene{}.text(), &kinds) ==
        "here: the state before has 'vessel' as a wire; expected a vessel, as in this scene" + mend +
            "\nhere: the state before has 'wire' as a vessel; expected a wire, as in this scene" + mend);
}

TEST_CASE("a curve without a shape does where its numbers fit, and is refused where they do not") {
  SmallScene scene;
  const CarriedState state = solved_state(scene.text());
  RecordedState older = *state.state;
  for (RecordedCurve& curve : older.curves) {
    curve.share.clear();
    find_flaw(curve);
  }
  CarriedState flat = state;
  flat.state = std::make_shared<const RecordedState>(older);
  const auto session = session_of_text(scene.text(), &flat);
  CHECK(session->start.q == session_of_text(scene.text(), &state)->start.q);
  scene.wire_nodes = 9;
  CHECK(refusal_of(scene.text(), &flat) ==
        "here: the numbers of 'wire' in the state before do not fit, and it has the curve with no 'material_share', "
        "which older versions did not write, so that nothing can be interpolated; expected a shape, or the fields "
        "position in R^n, orientation in S1, length in R; start from a result that this version wrote");
}

}  // namespace bowstring::testing
