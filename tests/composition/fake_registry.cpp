#include "tests/composition/fake_registry.hpp"

#include <algorithm>

namespace bowstring::test {
namespace {

ParameterDeclaration declare(const char* key, ParameterType type, const char* unit, const char* default_text) {
  return {key, type, unit, default_text, ""};
}

ParameterDeclaration positive(ParameterDeclaration declaration) {
  declaration.lower = 0.0;
  declaration.lower_exclusive = true;
  return declaration;
}

ParameterDeclaration not_negative(ParameterDeclaration declaration) {
  declaration.lower = 0.0;
  return declaration;
}

ParameterDeclaration at_least(ParameterDeclaration declaration, double lower) {
  declaration.lower = lower;
  return declaration;
}

ParameterDeclaration one_of(const char* key, const char* default_text, const char* choices) {
  ParameterDeclaration declaration = declare(key, ParameterType::choice, "", default_text);
  declaration.choices = choices;
  return declaration;
}

const ParameterDeclaration nodes = at_least(declare("nodes", ParameterType::integer, "", "80"), 3);

std::vector<ParameterDeclaration> sinusoid_schema() {
  return {positive(declare("chord", ParameterType::scalar, "mm", nullptr)),
          declare("amplitude", ParameterType::scalar, "mm", nullptr),
          declare("periods", ParameterType::scalar, "", "1.0"),
          nodes,
          one_of("sampling", "\"uniform-arc\"", "uniform-x|uniform-arc"),
          declare("origin", ParameterType::vector, "mm", "")};
}

std::vector<ParameterDeclaration> arcs_schema() {
  static const ParameterDeclaration segment[] = {
      positive(declare("length", ParameterType::scalar, "mm", nullptr)),
      declare("bend", ParameterType::scalar, "rad", "0.0"),
  };
  ParameterDeclaration segments = declare("segments", ParameterType::list, "", nullptr);
  segments.items = segment;
  segments.item_count = 2;
  return {segments, nodes};
}

std::vector<ParameterDeclaration> csv_schema() {
  return {declare("file", ParameterType::path, "", nullptr), one_of("coordinates", "\"LPS\"", "LPS|RAS")};
}

std::vector<ParameterDeclaration> vessel_strain_schema() {
  return {not_negative(declare("bending-stiffness", ParameterType::profile, "N mm^2", nullptr)),
          not_negative(declare("torsional-stiffness", ParameterType::profile, "N mm^2", "0.0")),
          not_negative(declare("stretch-stiffness", ParameterType::profile, "N", "0.0"))};
}

std::vector<ParameterDeclaration> contact_schema() {
  return {one_of("centerline", "\"spline\"", "spline|polyline"),
          positive(declare("window", ParameterType::scalar, "|mm", ""))};
}

std::vector<ParameterDeclaration> solver_schema() {
  return {positive(declare("tolerance", ParameterType::scalar, "", "1e-8")),
          at_least(declare("max-iterations", ParameterType::integer, "", "500"), 1),
          positive(declare("time-limit", ParameterType::scalar, "s", ""))};
}

}  // namespace

FakeRegistry::FakeRegistry() {
  add(Kind::geometry, "sinusoid", sinusoid_schema());
  add(Kind::geometry, "arcs", arcs_schema());
  add(Kind::geometry, "csv", csv_schema());
  add(Kind::kinematics, "nodes", {});
  add(Kind::kinematics, "edge-frames", {declare("regularised", ParameterType::flag, "", "false")});
  add(Kind::energy, "wire-bending",
      {not_negative(declare("bending-stiffness", ParameterType::profile, "N mm^2", nullptr))});
  add(Kind::energy, "vessel-strain", vessel_strain_schema());
  add(Kind::energy, "anchoring", {not_negative(declare("stiffness", ParameterType::profile, "N/mm^2|N/mm", nullptr))});
  add(Kind::energy, "axial-tension", {declare("tension", ParameterType::scalar, "N", nullptr)});
  add(Kind::energy, "point-load", {declare("force", ParameterType::vector, "N", nullptr)});
  add(Kind::constraint, "node-wise-contact", contact_schema());
  add(Kind::constraint, "segment-wise-contact", contact_schema());
  add(Kind::enforcement, "kkt", {});
  add(Kind::solver, "ipopt", solver_schema());
  add(Kind::solver, "interior-point", solver_schema());
}

void FakeRegistry::add(Kind kind, const std::string& name, const std::vector<ParameterDeclaration>& schema) {
  Offer& offer = offers_[{kind, name}];
  offer.name = name;
  offer.schema = schema;
  offer.descriptor = {
      kind, offer.name.c_str(), "", offer.schema.data(), static_cast<int>(offer.schema.size()), nullptr, nullptr};
}

void FakeRegistry::break_plugin(Kind kind, const std::string& name, const std::string& text) {
  offers_[{kind, name}].failure = text;
}

std::vector<std::string> FakeRegistry::names(Kind kind) const {
  std::vector<std::string> result;
  for (const auto& [key, offer] : offers_) {
    if (key.first == kind) result.push_back(key.second);
  }
  return result;
}

const ComponentDescriptor* FakeRegistry::find(Kind kind, const std::string& name, Status& status) {
  const auto place = offers_.find({kind, name});
  if (place == offers_.end()) {
    status = Status::failure(Code::invalid_input, "nobody offers " + name);
    return nullptr;
  }
  if (!place->second.failure.empty()) {
    status = Status::failure(Code::failed, place->second.failure);
    return nullptr;
  }
  const std::string label = std::string(kind_name(kind)) + "/" + name;
  if (std::find(opened.begin(), opened.end(), label) == opened.end()) opened.push_back(label);
  return &place->second.descriptor;
}

ComponentOrigin FakeRegistry::origin(Kind, const std::string&) const { return {}; }

}  // namespace bowstring::test
