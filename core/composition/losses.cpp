#include "core/composition/losses.hpp"

#include <filesystem>
#include <iterator>
#include <utility>

#include "core/composition/keys.hpp"
#include "core/composition/parameters.hpp"
#include "core/composition/read_file.hpp"
#include "core/composition/vocabulary.hpp"
#include "core/measure/given_measure.hpp"

namespace bowstring {
namespace {

constexpr double unbounded = 1e308;

CurveSampling sampling_of(const ParameterSet& values) {
  CurveSampling out;
  if (values.has("points")) out.points = static_cast<int>(values.integer("points"));
  if (values.has("weights")) read_curve_weights(values.text("weights").c_str(), out.weights);
  if (!values.has("stations")) return out;
  for (const ParameterSet& item : values.at("stations").items) {
    if (!item.has("at") || !item.has("spread") || !item.has("weight")) continue;
    out.stations.push_back({item.scalar("at"), item.scalar("spread"), item.scalar("weight")});
  }
  return out;
}

/// Where the user's text leads from the file that it stands in.
MeasureName resolved_name(const Node& value) {
  if (!value.position.source) return measure_name(value.text);
  const std::filesystem::path& directory = value.position.source->directory;
  return measure_name((directory / std::filesystem::path(value.text)).lexically_normal().string());
}

void read_observed(const Node& value, const std::string& owner, LossTable& loss, Report& report) {
  const std::string subject = "'against' of " + owner;
  if (!value.is_text() || value.text.empty()) {
    report.error(value.position, subject + " is " + description(value), "text, a file of places or a curve of a result",
                 "write against = \"observed.csv\" or against = \"result.json#iliac\"");
    return;
  }
  const MeasureName name = resolved_name(value);
  loss.against = name.text();
  std::string text;
  if (const std::string why = read_file(name.file, text); !why.empty()) {
    const bool by_override = value.position.source != nullptr && value.position.line == 0;
    report.error(value.position, subject + ": '" + value.text + "' cannot be read (" + why + ")",
                 "a file of places, or a curve of a result document as \"result.json#iliac\"",
                 by_override ? "paths of --set are relative to the working directory"
                             : "paths are relative to the file that they stand in");
    return;
  }
  std::vector<InputError> errors;
  std::optional<GivenMeasure> given = read_given_measure(name, text, errors);
  for (InputError& error : errors) {
    report.error(value.position, subject + ": " + error.position + ": " + error.found, error.expected, error.mend);
  }
  if (!given) return;
  loss.observed = std::make_shared<const GivenMeasure>(std::move(*given));
}

/// Weights that draw a curve toward stations or wide places say nothing beside places that all count the same.
void check_weights(const Node& table, const std::string& owner, const LossTable& loss, Report& report) {
  const bool drawn = !loss.sampling.stations.empty() || loss.sampling.weights == CurveWeights::lumen_section;
  if (!drawn || loss.observed == nullptr || loss.observed->is_curve || loss.observed->has_weights) return;
  const char* key = loss.sampling.stations.empty() ? "weights" : "stations";
  report.error(
      table.find(key)->position, "'" + std::string(key) + "' of " + owner + " against places that have no weights",
      "both drawn alike",
      "write against = \"FILE.csv#curve\" where the rows of the file are a curve in order, or give it a column "
      "'weight'");
}

}  // namespace

Span<const ParameterDeclaration> loss_schema() {
  using Type = ParameterType;
  static const ParameterDeclaration station[] = {
      {"at", Type::scalar, "mm", nullptr, "arc length from the first end", 0.0},
      {"spread", Type::scalar, "mm", nullptr, "standard deviation of the bell along the curve", 0.0, unbounded, true},
      {"weight", Type::scalar, "", "1.0", "how much more its middle counts than places far away", 0.0},
  };
  static const ParameterDeclaration schema[] = {
      {"points", Type::integer, "", "", "places at which curves are resampled, otherwise their nodes", 1.0, 1e6},
      {"weights", Type::choice, "", "\"arc-length\"", "what the weight of a curve's place is in proportion to",
       -unbounded, unbounded, false, false, curve_weights_choices},
      {"stations", Type::list, "", "", "where curves count for more", -unbounded, unbounded, false, false, "", station,
       static_cast<int>(std::size(station))},
  };
  return {schema, std::size(schema)};
}

LossTable read_loss(const Node& table, const CurveNames& names, Reading& reading) {
  LossTable loss;
  loss.label = label_of(table, "loss");
  loss.on = table.text_at("on");
  loss.position = table.position.text();
  const std::string owner = "loss '" + loss.label + "'";
  if (!check_is_table(table, owner, "write it under [[loss]]", reading.report)) return loss;
  check_name(table, owner, reading.report);

  SchemaOwner schema_owner;
  schema_owner.name = owner;
  schema_owner.help = "remove it";
  schema_owner.structural = {"name", "on", "against", "transport", "ground-cost"};
  Status no_fault;
  const ParameterSet values = read_parameters(table, schema_owner, loss_schema(), no_fault, reading.report);
  loss.sampling = sampling_of(values);

  if (const Entry* on = table.find("on")) {
    check_reference(on->value, "'on' of " + owner, "curve", names.all(), names, reading.report);
  } else {
    reading.report.error(table.position, owner + " has no 'on'", "the curve that is compared", "add on = \"<curve>\"");
  }
  if (const Entry* against = table.find("against")) {
    loss.against_position = against->value.position.text();
    read_observed(against->value, owner, loss, reading.report);
  } else {
    reading.report.error(table.position, owner + " has no 'against'", "what the curve is compared with",
                         "add against = \"observed.csv\" or against = \"result.json#iliac\"");
  }
  check_weights(table, owner, loss, reading.report);
  loss.transport = read_component_of(table, "transport", Kind::transport, "exact", owner, reading);
  loss.ground_cost = read_component_of(table, "ground-cost", Kind::ground_cost, "euclidean", owner, reading);
  return loss;
}

}  // namespace bowstring
