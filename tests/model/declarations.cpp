#include "core/model/declarations.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

struct NoLaw final : Law {
  Status evaluate(const LawBatch&) const noexcept override { return {}; }
};

CurveGeometry geometry() {
  CurveGeometry out;
  out.points = {0.0, 0.0, 1.0, 0.0, 2.0, 0.0};
  out.data = {{"radius_mm", {1.0, 1.0, 1.0}}};
  out.label = {"a", "a", "b"};
  out.first_tangent = {1.0, 0.0};
  return out;
}

KinematicsDeclaration kinematics() {
  FieldDeclaration field;
  field.name = "orientation";
  field.manifold = Manifold::direction;
  field.count = 2;
  field.reference.assign(8, 0.5);
  field.start = field.reference;
  field.fixed = {1, 1, 0, 0};
  SiteDeclaration site;
  site.count = 2;
  site.values = site.width = 2;
  site.stencil = {0, 1, -1, 3};
  return {{field}, {site}, ""};
}

RowDeclaration rows() {
  RowDeclaration out;
  out.rows = 2;
  out.place_begin = {0, 1, 2};
  out.places = {{0, Site::node, 1}, {0, Site::node, 2}};
  out.lower = {0.0, 0.0};
  out.upper = {0.0, 1.0};
  return out;
}

}  // namespace

TEST_CASE("geometries with data of another length are refused in words") {
  CHECK(flaw_of(geometry(), 2) == "");
  CurveGeometry wrong = geometry();
  wrong.points.pop_back();
  CHECK(flaw_of(wrong, 2) == "gives 5 coordinates, which are no points of dimension 2");
  wrong = geometry();
  wrong.data[0].value.push_back(1.0);
  CHECK(flaw_of(wrong, 2) == "gives 4 values of 'radius_mm' for 3 nodes");
  wrong = geometry();
  wrong.label.pop_back();
  CHECK(flaw_of(wrong, 2) == "gives 2 labels for 3 nodes");
  wrong = geometry();
  wrong.last_tangent = {1.0, 0.0, 0.0};
  CHECK(flaw_of(wrong, 2) == "gives an end tangent of 3 numbers in dimension 2");
}

TEST_CASE("energies whose laws do not fit their descriptions or parameters are refused in words") {
  NoLaw law;
  ParameterSet parameters;
  ParameterValue stiffness;
  stiffness.key = "stiffness";
  stiffness.type = ParameterType::profile;
  ParameterValue name;
  name.key = "name";
  name.type = ParameterType::text;
  parameters.values = {stiffness, name};
  EnergyDeclaration good;
  good.laws = {&law};
  good.descriptions.resize(1);
  good.descriptions[0].parameters = {"stiffness"};
  CHECK(flaw_of(good, parameters) == "");
  EnergyDeclaration wrong = good;
  wrong.laws.push_back(&law);
  CHECK(flaw_of(wrong, parameters) == "declares 2 laws with 1 descriptions");
  wrong = good;
  wrong.laws[0] = nullptr;
  CHECK(flaw_of(wrong, parameters) == "declares a law that is null");
  wrong = good;
  wrong.descriptions[0].parameters = {"stifness"};
  CHECK(flaw_of(wrong, parameters) == "has a law that reads 'stifness', which is not declared or has no value");
  wrong.descriptions[0].parameters = {"name"};
  CHECK(flaw_of(wrong, parameters) == "has a law that reads 'name', which is neither a profile nor a scalar");
  wrong = good;
  wrong.descriptions[0].places = {1, 2};
  wrong.descriptions[0].weight = {1.0};
  CHECK(flaw_of(wrong, parameters) == "has a law with 1 weights for 2 places");
}

TEST_CASE("kinematics whose fields or sites do not fit are refused in words") {
  CHECK(flaw_of(kinematics(), 4) == "");
  KinematicsDeclaration wrong = kinematics();
  wrong.fields[0].start.pop_back();
  CHECK(flaw_of(wrong, 4) == "declares field 'orientation' with coordinates that do not fit its count");
  wrong = kinematics();
  wrong.fields[0].fixed = {1, 0, 0, 0};
  CHECK(flaw_of(wrong, 4) ==
        "holds entry 0 of field 'orientation' in part; a rotation or direction is held as a whole");
  wrong = kinematics();
  wrong.fields[0].lower = {0.0};
  CHECK(flaw_of(wrong, 4) == "declares field 'orientation' with bounds that do not fit its count");
  CHECK(flaw_of(kinematics(), 3) == "declares a site whose stencil does not fit its unknowns");
  wrong = kinematics();
  wrong.sites[0].site = Site::edge;
  CHECK(flaw_of(wrong, 4) == "declares no node positions");
}

TEST_CASE("rows whose sizes or bounds do not fit are refused in words") {
  CHECK(flaw_of(rows()) == "");
  RowDeclaration wrong = rows();
  wrong.upper.pop_back();
  CHECK(flaw_of(wrong) == "declares 2 rows with bounds or places of another number");
  wrong = rows();
  wrong.place_begin = {0, 2, 1};
  CHECK(flaw_of(wrong) == "declares rows whose places do not follow each other");
  wrong = rows();
  wrong.lower[1] = 2.0;
  CHECK(flaw_of(wrong) == "declares row 1 with a lower bound that is not below its upper one");
}

TEST_CASE("a solver's answer of another size, or that is not finite, is refused in words") {
  const auto session = session_of(SmallScene{});
  const Assembly& assembly = *session->assembly;
  SolverResult result;
  CHECK(flaw_of(result, assembly) == "");
  result.q = session->scene->start_coordinates();
  CHECK(flaw_of(result, assembly) == "");
  result.multipliers.assign(3, 0.0);
  CHECK(flaw_of(result, assembly) == "answers 3 multipliers for " + std::to_string(assembly.rows()) + " rows");
  result.multipliers.clear();
  result.q[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(flaw_of(result, assembly) == "answers a state that is not finite");
  result.q.pop_back();
  CHECK(flaw_of(result, assembly) == "answers a state of " + std::to_string(result.q.size()) + " numbers for " +
                                         std::to_string(assembly.coordinates()));
}

}  // namespace bowstring::testing
