#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/certificate/solved_scene.hpp"

namespace bowstring::testing {

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Gradient of the Lagrangian from the problem's own gradient and Jacobian.
std::vector<double> lagrangian_gradient(Assembly& assembly, const std::vector<double>& q,
                                        const std::vector<double>& multipliers) {
  const SparsityPattern pattern = assembly.jacobian_pattern();
  std::vector<double> gradient(at(assembly.unknowns())), jacobian(at(pattern.entries()));
  ProblemEvaluation evaluation;
  evaluation.gradient = gradient;
  evaluation.jacobian = jacobian;
  const Status status = assembly.evaluate(q, evaluation);
  REQUIRE_MESSAGE(status.ok(), status.text);
  for (int r = 0; r < assembly.rows(); ++r) {
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      gradient[at(pattern.inner[at(k)])] += multipliers[at(r)] * jacobian[at(k)];
    }
  }
  return gradient;
}

/// Its largest entry in N, without that of one unknown.
double largest_force(const Assembly& assembly, const std::vector<double>& gradient, int without = -1) {
  double out = 0.0;
  for (int u = 0; u < assembly.unknowns(); ++u) {
    if (u != without) out = std::max(out, std::fabs(gradient[at(u)]) / assembly.stationarity_scale()[at(u)]);
  }
  return out;
}

std::vector<double> row_values(Assembly& assembly, const std::vector<double>& q) {
  std::vector<double> out(at(assembly.rows()));
  ProblemEvaluation evaluation;
  evaluation.rows = out;
  const Status status = assembly.evaluate(q, evaluation);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

struct Extremes {
  double smallest = 1e300, largest = -1e300;
};

Extremes edge_stretch(const Curve& curve, const std::vector<double>& q) {
  const int d = curve.view.dimension;
  Extremes out;
  for (int i = 0; i + 1 < curve.view.nodes; ++i) {
    double squared = 0.0;
    for (int k = 0; k < d; ++k) {
      const double* p = q.data() + curve.coordinate_begin + i * d + k;
      squared += (p[d] - p[0]) * (p[d] - p[0]);
    }
    const double stretch = std::sqrt(squared) / curve.view.edge_length[i];
    out.smallest = std::min(out.smallest, stretch);
    out.largest = std::max(out.largest, stretch);
  }
  return out;
}

double* node(const Curve& curve, std::vector<double>& q, int i) {
  return q.data() + curve.coordinate_begin + i * curve.view.dimension;
}

const char* const claim_text = "the solver's own words";

SolvedScene& solved_contact() {
  static SolvedScene scene = solved(session_of_text(contact_text(contact_scene(2))));
  REQUIRE(scene.solution.certificate.verdict == Verdict::converged);
  return scene;
}

struct ClaimedVerdict {
  Claim claim;
  Verdict verdict;
};
const ClaimedVerdict claimed_verdicts[] = {{Claim::optimal, Verdict::stalled},
                                           {Claim::stalled, Verdict::stalled},
                                           {Claim::infeasible, Verdict::infeasible},
                                           {Claim::diverged, Verdict::diverged},
                                           {Claim::failed, Verdict::failed}};

/// Gives the answer that it was made with, whatever the problem.
class FixedAnswer final : public Solver {
 public:
  FixedAnswer(Status status, SolverResult result) : status_(std::move(status)), result_(std::move(result)) {}
  SolverTraits traits() const noexcept override { return {}; }
  Status can(const ProblemSummary&) const noexcept override { return {}; }
  Status solve(Problem&, Span<const double>, const SolverContext&, SolverResult& out) noexcept override {
    out = result_;
    return status_;
  }

 private:
  Status status_;
  SolverResult result_;
};

Solution solved_by_answer(Session& session, Status status, Claim claim, std::vector<double> q) {
  SolverResult result;
  result.claim = claim;
  result.reason = claim_text;
  result.q = std::move(q);
  session.solver = Owned<Solver>(new FixedAnswer(std::move(status), std::move(result)),
                                 [](void* solver) { delete static_cast<Solver*>(solver); });
  return solve(session, {});
}

}  // namespace

TEST_CASE("the numbers of a certificate are the problem's own") {
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      CAPTURE(dimension);
      CAPTURE(std::string(kinematics));
      SmallScene small;
      small.dimension = dimension;
      small.vessel_kinematics = small.wire_kinematics = kinematics;
      const auto session = session_of(small);
      Assembly& assembly = *session->assembly;
      const std::vector<double> q = moved_start(*session, 0.8, 41);
      REQUIRE(assembly.accept(q).ok());
      const std::vector<double> multipliers = random_numbers(assembly.rows(), 42);
      const Certificate found = certified(assembly, q, multipliers, CertificateTable());

      const double stationarity = largest_force(assembly, lagrangian_gradient(assembly, q, multipliers));
      double penetration = 0.0, complementarity = 0.0, smallest = 1e300;
      const std::vector<double> rows = row_values(assembly, q);
      for (int r = 0; r < assembly.rows(); ++r) {
        if (assembly.row_lower()[at(r)] == assembly.row_upper()[at(r)]) {
          penetration = std::max(penetration, std::fabs(rows[at(r)] - assembly.row_upper()[at(r)]));
        } else {
          penetration = std::max(penetration, rows[at(r)]);
          complementarity = std::max(complementarity, std::fabs(multipliers[at(r)] * rows[at(r)]));
          smallest = std::min(smallest, multipliers[at(r)]);
        }
      }
      const Extremes stretch = edge_stretch(*session->scene->find("vessel"), q);
      REQUIRE(stationarity > 1e-2);
      REQUIRE(penetration > 1e-3);
      REQUIRE(complementarity > 1e-3);
      REQUIRE(smallest < -1e-3);
      REQUIRE(stretch.largest - stretch.smallest > 1e-3);
      CHECK(found.stationarity == doctest::Approx(stationarity).epsilon(1e-12));
      CHECK(found.penetration == doctest::Approx(penetration).epsilon(1e-12));
      CHECK(found.complementarity == doctest::Approx(complementarity).epsilon(1e-12));
      CHECK(found.minimum_multiplier == smallest);
      CHECK(found.minimum_stretch == doctest::Approx(stretch.smallest).epsilon(1e-12));
      CHECK(found.maximum_stretch == doctest::Approx(stretch.largest).epsilon(1e-12));
      CHECK(found.rounding_floor > 0.0);
      CHECK(found.rounding_floor < 1e-6);
    }
  }
}

TEST_CASE("each threshold is decisive: at its number it holds, just beyond it alone is missed and named") {
  SolvedScene& scene = solved_contact();
  std::vector<double> multipliers = scene.solution.multipliers;
  const RowOrigin rows = contact_rows(scene.assembly());
  for (int r = 0; r < rows.count; ++r) multipliers[at(rows.first + r)] += r % 2 == 0 ? 1e-3 : -1e-3;
  std::vector<double> q = scene.solution.q;
  node(*scene.session->scene->find("wire"), q, 5)[1] += 1e-4;
  const Certificate own = certified(scene.assembly(), q, multipliers, no_thresholds());
  REQUIRE(own.verdict == Verdict::converged);
  REQUIRE(own.stationarity > 1e-5);
  REQUIRE(own.penetration > 1e-5);
  REQUIRE(own.complementarity > 1e-5);
  REQUIRE(own.minimum_multiplier < -1e-5);

  CertificateTable exactly;
  exactly.stationarity = own.stationarity;
  exactly.penetration = own.penetration;
  exactly.complementarity = own.complementarity;
  exactly.multiplier = own.minimum_multiplier;
  CHECK(certified(scene.assembly(), q, multipliers, exactly).verdict == Verdict::converged);

  struct Threshold {
    std::string name;
    double CertificateTable::*number;
  };
  const Threshold thresholds[] = {{"stationarity", &CertificateTable::stationarity},
                                  {"row penetration", &CertificateTable::penetration},
                                  {"complementarity", &CertificateTable::complementarity},
                                  {"smallest multiplier", &CertificateTable::multiplier}};
  for (const Threshold& missed : thresholds) {
    CAPTURE(missed.name);
    CertificateTable table = exactly;
    table.*missed.number *= 1.0 - 1e-9;
    for (const ClaimedVerdict& row : claimed_verdicts) {
      const Certificate found = certified(scene.assembly(), q, multipliers, table, row.claim, claim_text);
      CHECK_FALSE(found.first_order);
      // Rows that hold are not infeasible, whatever a solver says.
      const bool rows_hold = missed.name != "row penetration";
      CHECK(found.verdict == (row.verdict == Verdict::infeasible && rows_hold ? Verdict::stalled : row.verdict));
      CHECK(found.reason.rfind(std::string(claim_text) + "; " + missed.name + " ", 0) == 0);
      for (const Threshold& other : thresholds) {
        CHECK(contains(found.reason, other.name + " ") == (other.name == missed.name));
      }
    }
  }
}

TEST_CASE("weakly active rows are those that touch and carry nothing") {
  SolvedScene& scene = solved_contact();
  const RowOrigin rows = contact_rows(scene.assembly());
  std::vector<double> multipliers = scene.solution.multipliers;
  const std::vector<double> gap = row_values(scene.assembly(), scene.solution.q);
  int touching = -1;
  for (int r = rows.first; r < rows.first + rows.count; ++r) {
    if (multipliers[at(r)] > 1e-3) touching = r;
  }
  REQUIRE(touching >= 0);
  REQUIRE(std::fabs(gap[at(touching)]) < 1e-6);
  const auto is_weakly_active = [&] {
    const std::vector<int> weak =
        certified(scene.assembly(), scene.solution.q, multipliers, CertificateTable()).weakly_active;
    return std::find(weak.begin(), weak.end(), touching) != weak.end();
  };
  CHECK_FALSE(is_weakly_active());
  multipliers[at(touching)] = 0.0;
  CHECK(is_weakly_active());
}

TEST_CASE("folds are told from what is allowed: a stretch ratio of 0.19 from 0.21, a turn of 92 degrees from 88") {
  SmallScene small;
  small.geometry = R"({ type = "line", length = "40 mm", nodes = 8 })";
  small.vessel_kinematics = small.wire_kinematics = "nodes";
  const auto session = session_of(small);
  const Curve& vessel = *session->scene->find("vessel");
  const std::vector<double> none(at(session->assembly->rows()), 0.0);
  const auto judged = [&](const std::vector<double>& q) {
    REQUIRE(session->assembly->accept(q).ok());
    return certified(*session->assembly, q, none, no_thresholds());
  };
  const auto place = [&](int edge) {
    char text[80];
    std::snprintf(text, sizeof text, "edge %d of vessel 'vessel' at s = %.4g mm ", edge, vessel.arc[at(edge)]);
    return std::string(text);
  };
  for (const double stretch : {0.21, 0.19}) {
    CAPTURE(stretch);
    std::vector<double> q = session->scene->start_coordinates();
    node(vessel, q, 4)[0] = node(vessel, q, 3)[0] + stretch * vessel.view.edge_length[3];
    const Certificate found = judged(q);
    CHECK(found.minimum_stretch == doctest::Approx(stretch).epsilon(1e-12));
    CHECK(found.verdict == (stretch > 0.2 ? Verdict::converged : Verdict::invalid));
    if (stretch < 0.2) CHECK(found.reason.rfind(place(3) + "has folded: stretch ratio 0.19; ", 0) == 0);
  }
  for (const double degrees : {88.0, 92.0}) {
    CAPTURE(degrees);
    std::vector<double> q = session->scene->start_coordinates();
    const double angle = degrees / 180.0 * std::acos(-1.0);
    for (int i = 5; i < vessel.view.nodes; ++i) {
      const double along = vessel.arc[at(i)] - vessel.arc[4];
      node(vessel, q, i)[0] = node(vessel, q, 4)[0] + along * std::cos(angle);
      node(vessel, q, i)[1] = node(vessel, q, 4)[1] + along * std::sin(angle);
    }
    const Certificate found = judged(q);
    CHECK(found.folds.size() == (degrees > 90.0 ? 1 : 0));
    if (degrees > 90.0) CHECK(found.folds.front().rfind(place(4) + "turns by more than 90 degrees", 0) == 0);
  }
}

TEST_CASE("a wire that turns back on itself is told from one that bends by 88 degrees: 92 are no shape of a curve") {
  SmallScene small;
  small.geometry = R"({ type = "line", length = "40 mm", nodes = 8 })";
  small.vessel_kinematics = small.wire_kinematics = "nodes";
  small.radius = "\"60 mm\"";
  const auto session = session_of(small);
  const Curve& wire = *session->scene->find("wire");
  const std::vector<double> none(at(session->assembly->rows()), 0.0);
  for (const double degrees : {88.0, 92.0}) {
    CAPTURE(degrees);
    std::vector<double> q = session->scene->start_coordinates();
    const double angle = degrees / 180.0 * std::acos(-1.0), edge = 40.0 / (wire.view.nodes - 1);
    for (int i = 4; i < wire.view.nodes; ++i) {
      const double along = (i - 3) * edge;
      node(wire, q, i)[0] = node(wire, q, 3)[0] + along * std::cos(angle);
      node(wire, q, i)[1] = node(wire, q, 3)[1] + along * std::sin(angle);
    }
    REQUIRE(session->assembly->accept(q).ok());
    const Certificate found = certified(*session->assembly, q, none, no_thresholds());
    CHECK(found.verdict == (degrees > 90.0 ? Verdict::invalid : Verdict::converged));
    CHECK(found.folds.empty());
    CHECK(found.wire_folds.size() == (degrees > 90.0 ? 1 : 0));
    char place[120];
    std::snprintf(place, sizeof place, "edge 3 of wire 'wire' at s = %.4g mm turns by more than 90 degrees",
                  3.0 * edge);
    if (degrees > 90.0) CHECK(found.reason.rfind(place, 0) == 0);
    if (degrees > 90.0) CHECK(contains(found.reason, "use a finer wire mesh, or push the wire less"));
  }
}

TEST_CASE("the row that fails the most is named with its place: of a contact, of a closure") {
  for (const char* kinematics : {"nodes", "edge-frames"}) {
    CAPTURE(std::string(kinematics));
    SmallScene small;
    small.geometry = R"({ type = "line", length = "40 mm", nodes = 8 })";
    small.radius = "\"3 mm\"";
    small.vessel_kinematics = small.wire_kinematics = kinematics;
    const auto session = session_of(small);
    const Curve& wire = *session->scene->find("wire");
    const std::vector<double> none(at(session->assembly->rows()), 0.0);
    std::vector<double> q = session->scene->start_coordinates();
    CertificateTable rows = no_thresholds();
    rows.penetration = 1e-8;
    for (int i = 1; i + 1 < wire.view.nodes; ++i) node(wire, q, i)[1] += i == 3 ? 9.0 : 0.5;
    REQUIRE(session->assembly->accept(q).ok());
    const Certificate out = certified(*session->assembly, q, none, rows);
    CHECK(out.worst_row >= 0);
    INFO(out.reason);
    REQUIRE(out.penetration > 4.0);
    // Arc lengths of the curves as they lie: the wire's to its node 3, State 1's of the vessel below it.
    double arc = 0.0;
    for (int i = 0; i < 3; ++i) {
      arc += std::hypot(node(wire, q, i + 1)[0] - node(wire, q, i)[0], node(wire, q, i + 1)[1] - node(wire, q, i)[1]);
    }
    char contact[160];
    std::snprintf(contact, sizeof contact, " of 'lumen' (wire 'wire' at s = %.4g mm, vessel 'vessel' at s = %.4g mm)",
                  arc, node(wire, q, 3)[0]);
    const bool at_contact = contains(out.reason, contact);
    const bool at_closure = contains(out.reason, " of 'wire.closure'");
    CHECK(at_contact != at_closure);
    CHECK(at_contact == (out.worst_row >= contact_rows(*session->assembly).first));

    // One edge of the wire torn open along the axis.
    q = session->scene->start_coordinates();
    for (int i = 4; i < wire.view.nodes - 1; ++i) node(wire, q, i)[0] += 1.5;
    REQUIRE(session->assembly->accept(q).ok());
    const Certificate torn = certified(*session->assembly, q, none, rows);
    INFO(torn.reason);
    REQUIRE(torn.penetration > 1.0);
    CHECK(contains(torn.reason, " of 'wire.closure'"));
    if (std::string(kinematics) == "edge-frames") {
      const bool named = contains(torn.reason, "(edge 3 of 'wire' at s = 20 mm)") ||
                         contains(torn.reason, "(edge 5 of 'wire' at s = 34.83 mm)");
      CHECK(named);
    }
  }
}

TEST_CASE("where thresholds are missed as well, a fold is told all the same") {
  SmallScene small;
  small.vessel_kinematics = small.wire_kinematics = "nodes";
  const auto session = session_of(small);
  const Curve& vessel = *session->scene->find("vessel");
  std::vector<double> q = session->scene->start_coordinates();
  for (int k = 0; k < 2; ++k) {
    node(vessel, q, 4)[k] = node(vessel, q, 3)[k] + 0.1 * (node(vessel, q, 4)[k] - node(vessel, q, 3)[k]);
  }
  REQUIRE(session->assembly->accept(q).ok());
  const std::vector<double> none(at(session->assembly->rows()), 0.0);
  const Certificate found = certified(*session->assembly, q, none, CertificateTable(), Claim::optimal, claim_text);
  CHECK(found.verdict == Verdict::stalled);
  CHECK(contains(found.reason, "stationarity"));
  CHECK(contains(found.reason, "has folded"));
}

TEST_CASE("a length on its bound is no equilibrium, and what the bound holds is no stationarity") {
  const auto session = session_of(SmallScene());
  Assembly& assembly = *session->assembly;
  std::vector<double> q = session->scene->start_coordinates();
  int length = -1;
  for (const FieldEntry& entry : assembly.entries()) {
    if (length >= 0 || entry.manifold != Manifold::real || entry.block < 0) continue;
    length = assembly.blocks().begin[at(entry.block)];
    REQUIRE(std::isfinite(assembly.lower()[at(length)]));
    q[at(entry.coordinate)] = assembly.lower()[at(length)];
  }
  REQUIRE(length >= 0);
  const std::vector<double> none(at(assembly.rows()), 0.0);
  const std::vector<double> pulled = lagrangian_gradient(assembly, q, none);
  REQUIRE(pulled[at(length)] < -1.0);  // the stretch law pulls a short edge outward, against no bound
  const Certificate free = certified(assembly, q, none, no_thresholds());
  CHECK(free.stationarity == doctest::Approx(largest_force(assembly, pulled)).epsilon(1e-12));
  CHECK(free.stationarity >= -pulled[at(length)]);
  CHECK(free.verdict == Verdict::invalid);
  CHECK(contains(free.reason, "a length of 'vessel' lies on its bound"));

  const SparsityPattern pattern = assembly.jacobian_pattern();
  std::vector<double> jacobian(at(pattern.entries()));
  ProblemEvaluation evaluation;
  evaluation.jacobian = jacobian;
  REQUIRE(assembly.evaluate(q, evaluation).ok());
  std::vector<double> pressing = none;
  for (int r = 0; r < assembly.rows(); ++r) {
    for (int k = pattern.begin[at(r)]; k < pattern.begin[at(r) + 1]; ++k) {
      if (pattern.inner[at(k)] == length) pressing[at(r)] = 1e3 * jacobian[at(k)];
    }
  }
  const std::vector<double> pressed = lagrangian_gradient(assembly, q, pressing);
  REQUIRE(pressed[at(length)] > 10.0);
  const double rest = largest_force(assembly, pressed, length);
  CHECK(certified(assembly, q, pressing, no_thresholds()).stationarity == doctest::Approx(rest).epsilon(1e-12));
}

TEST_CASE("tunnelled from one limb of a hairpin into the other: the place is where the wire leaves the lumen") {
  SmallScene small;
  const std::string limb_text = R"({ length = "40 mm" })", bend = R"({ length = "60 mm", bend = "180 deg" })";
  small.geometry = R"({ type = "arcs", nodes = 29, segments = [)" + limb_text + ", " + bend + ", " + limb_text + "] }";
  small.radius = "\"4 mm\"";
  small.vessel_kinematics = small.wire_kinematics = "nodes";
  small.wire_nodes = 29;
  const auto session = session_of(small);
  Assembly& assembly = *session->assembly;
  const Curve& vessel = *session->scene->find("vessel");
  const Curve& wire = *session->scene->find("wire");
  const std::vector<double> none(at(assembly.rows()), 0.0);
  std::vector<double> q = session->scene->start_coordinates();
  const Certificate sound = certified(assembly, q, none, no_thresholds());
  CHECK(sound.verdict == Verdict::converged);
  REQUIRE(sound.dense_penetration().has_value());
  CHECK(*sound.dense_penetration() < 0.0);

  // The bend's nodes go back into the limb on their side: one chord spans both limbs.
  const int last = wire.view.nodes - 1;
  const int limb = 8;
  const int middle = last / 2;
  for (int i = limb + 1; i < last - limb; ++i) {
    const bool first = i <= middle;
    const double share = static_cast<double>(first ? i - limb : last - limb - i) / (middle - limb + 1);
    const int from = first ? limb : last - limb;
    const int to = first ? limb - 2 : last - limb + 2;
    for (int k = 0; k < 2; ++k) {
      node(wire, q, i)[k] = (1.0 - share) * node(vessel, q, from)[k] + share * node(vessel, q, to)[k];
    }
  }
  REQUIRE(assembly.accept(q).ok());
  const std::vector<double> rows = row_values(assembly, q);
  const RowOrigin contact = contact_rows(assembly);
  for (int r = contact.first; r < contact.first + contact.count; ++r) REQUIRE(rows[at(r)] < 0.0);

  double begin = 0.0;
  for (int i = 0; i < middle; ++i) {
    begin += std::hypot(node(wire, q, i + 1)[0] - node(wire, q, i)[0], node(wire, q, i + 1)[1] - node(wire, q, i)[1]);
  }
  const double* jump = node(wire, q, middle);
  const double chord = std::hypot(jump[2] - jump[0], jump[3] - jump[1]);
  REQUIRE(chord > 20.0);
  const Certificate found = certified(assembly, q, none, no_thresholds());
  CHECK(found.first_order);
  CHECK(found.verdict == Verdict::invalid);
  REQUIRE(found.crossings.size() == 1);
  CHECK(found.reason.rfind("wire 'wire' passes through the wall of 'vessel' between its rows, from wire s = ", 0) == 0);
  CHECK(contains(found.reason, "use a finer wire mesh"));
  const double wire_place = std::stod(found.reason.substr(found.reason.find("wire s = ") + 9));
  const double vessel_place = std::stod(found.reason.substr(found.reason.find("vessel s = ") + 11));
  CHECK(wire_place > begin);
  CHECK(wire_place < begin + 0.5 * chord);
  CHECK(vessel_place > 0.5 * vessel.arc[at(limb)]);
  CHECK(vessel_place < vessel.arc[at(middle)]);
}

TEST_CASE("stalled: the iteration limit and the user's stop, with what is missed") {
  const SolvedScene limited = solved(session_of_text(contact_text(contact_scene(2), "max-iterations = 2")));
  CHECK(limited.solution.certificate.verdict == Verdict::stalled);
  CHECK(contains(limited.solution.certificate.reason, "the iteration limit was reached; "));
  CHECK(contains(limited.solution.certificate.reason, "(threshold "));

  const auto session = session_of_text(contact_text(contact_scene(2)));
  const Solution stopped = solve(*session, [](const IterationRecord& record) { return record.iteration < 3; });
  CHECK(stopped.certificate.verdict == Verdict::stalled);
  CHECK(contains(stopped.certificate.reason, "stopped by the user; "));
}

TEST_CASE("infeasible: a wire that has to lie in two rigid vessels at once") {
  // A line and a sinusoid that are up to 9 mm apart, where the wire has 2.6 mm in each.
  SmallScene small = contact_scene(2);
  small.radius = "\"3 mm\"\nrigid = true";
  std::string text = small.text();
  text.insert(text.find("[[wire]]"),
              "[[vessel]]\nname = \"straight\"\ngeometry = { type = \"line\", length = \"60 mm\", nodes = 20 }\n"
              "radius = \"3 mm\"\nrigid = true\n");
  text.insert(text.find("[solver]"),
              "[[constraint]]\nname = \"second\"\ntype = \"node-wise-contact\"\n"
              "on = [\"wire\", \"straight\"]\nwindow = 20\n");
  const auto certificate_with = [&](const std::string& guard) {
    return solved(session_of_text(text + "step-guard = " + guard + "\n")).solution.certificate;
  };
  for (const char* guard : {"0.0", "0.5"}) {
    const Certificate found = certificate_with(guard);
    INFO(found.reason);
    CHECK(found.penetration > 1.0);
    CHECK(found.verdict == Verdict::infeasible);
    CHECK(contains(found.reason, "Ipopt converged to a point of local infeasibility; "));
    CHECK(contains(found.reason, "row penetration "));
  }
}

TEST_CASE("a solver's word is no proof, and its failure is a verdict with its name") {
  const auto session = session_of_text(contact_text(contact_scene(2)));
  const std::vector<double> start = session->scene->start_coordinates();
  SUBCASE("optimal, but it never moved") {
    const Solution solution = solved_by_answer(*session, {}, Claim::optimal, start);
    CHECK(solution.estimated_multipliers);
    CHECK(solution.certificate.verdict == Verdict::stalled);
    CHECK(contains(solution.certificate.reason, claim_text));
    CHECK(contains(solution.certificate.reason, "stationarity"));
  }
  SUBCASE("failed, but at a solution, and without multipliers") {
    const Solution& known = solved_contact().solution;
    const Solution solution = solved_by_answer(*session, {}, Claim::failed, known.q);
    CHECK(solution.estimated_multipliers);
    CHECK(solution.certificate.verdict == Verdict::converged);
    REQUIRE(largest(known.multipliers) > 0.1);
    CHECK(largest_difference(solution.multipliers, known.multipliers) <= 1e-5);
  }
  SUBCASE("a status that is no success") {
    const Solution solution = solved_by_answer(*session, Status::failure(Code::failed, "it broke"), Claim::optimal, {});
    CHECK(solution.certificate.verdict == Verdict::failed);
    CHECK(contains(solution.certificate.reason, "solver 'ipopt': it broke"));
    CHECK(solution.q == start);
  }
  SUBCASE("numbers that are none") {
    const std::vector<double> none(start.size(), std::numeric_limits<double>::quiet_NaN());
    const Solution solution = solved_by_answer(*session, {}, Claim::optimal, none);
    CHECK(solution.certificate.verdict == Verdict::failed);
    CHECK_FALSE(solution.certificate.reason.empty());
  }
}

}  // namespace bowstring::testing
