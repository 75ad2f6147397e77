#include "core/result/document.hpp"

#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "core/model/carried_curve.hpp"
#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

using Json = nlohmann::ordered_json;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Json optional(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// A finite number, or null: JSON has no other.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json word(const char* text) { return text == nullptr ? Json(nullptr) : Json(text); }

Json vector(const double* numbers, int count) {
  Json out = Json::array();
  for (int k = 0; k < count; ++k) out.push_back(finite(numbers[k]));
  return out;
}

Json numbers(const std::vector<double>& values) { return vector(values.data(), static_cast<int>(values.size())); }

Json rows(const std::vector<double>& values, int per_row) {
  if (per_row == 1) return numbers(values);
  Json out = Json::array();
  for (std::size_t i = 0; i + at(per_row) <= values.size(); i += at(per_row)) {
    out.push_back(vector(values.data() + i, per_row));
  }
  return out;
}

Json plugins_of(const Session& session, const Registry& registry) {
  std::set<std::pair<int, std::string>> named;
  for (const ComponentChoice* choice : components_of(session.composition)) {
    named.emplace(static_cast<int>(choice->kind), choice->name);
  }
  Json plugins = Json::array();
  for (const auto& [kind, name] : named) {
    const ComponentOrigin origin = registry.origin(static_cast<Kind>(kind), name);
    plugins.push_back({{"kind", kind_name(static_cast<Kind>(kind))},
                       {"name", name},
                       {"file", origin.file},
                       {"sha256", origin.sha256},
                       {"abi_tag", origin.abi_tag}});
  }
  return plugins;
}

Json start_of(const StartOrigin& start) {
  const auto known = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  return {{"file", known(start.file)}, {"sha256", known(start.sha256)}};
}

Json problem(const SessionRecord& session) {
  const ProblemSummary& summary = session.problem;
  Json fields = Json::array();
  for (const auto& curve : session.scene->curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      int free = 0;
      const int tangents = tangent_count(field.manifold, field.dimension);
      for (int u = 0; u < field.count * tangents; ++u) free += field.fixed.empty() || field.fixed[at(u)] == 0;
      fields.push_back({{"name", curve->name + "." + field.name},
                        {"manifold", manifold_name(field.manifold)},
                        {"count", field.count},
                        {"unknowns", free},
                        {"reason", field.reason}});
    }
  }
  return {{"unknowns", summary.unknowns},
          {"fixed", summary.fixed},
          {"inequalities", summary.inequalities},
          {"equalities", summary.equalities},
          {"fields", fields}};
}

Json solver(const SessionRecord& session, const Solution& solution) {
  const SolverResult& result = solution.solver;
  Json history = Json::array();
  for (const IterationRecord& record : result.history) {
    history.push_back({{"iteration", record.iteration},
                       {"energy", finite(record.energy)},
                       {"stationarity", finite(record.stationarity)},
                       {"penetration", finite(record.penetration)},
                       {"step", finite(record.step)}});
  }
  const Seconds& seconds = session.seconds;
  return {
      {"name", session.solver},
      {"claim", result.reason},
      {"iterations", result.iterations},
      {"factorizations", result.factorizations > 0 ? Json(result.factorizations) : Json(nullptr)},
      {"evaluations", result.evaluations},
      {"epochs", session.epochs},
      {"history", history},
      {"seconds",
       {{"load", seconds.load},
        {"setup", seconds.setup},
        {"solve", seconds.solve},
        {"total", seconds.total},
        {"evaluation", result.evaluation_seconds},
        {"factorization", result.factorization_seconds > 0.0 ? Json(result.factorization_seconds) : Json(nullptr)}}}};
}

std::vector<std::string> joined(std::vector<std::string> texts, const std::vector<std::string>& more) {
  texts.insert(texts.end(), more.begin(), more.end());
  return texts;
}

Json certificate(const Certificate& c) {
  const bool judged = c.second_order.curvature != Curvature::unjudged;
  return {{"stationarity", finite(c.stationarity)},
          {"rounding_floor_N", finite(c.rounding_floor)},
          {"max_penetration_mm", finite(c.penetration)},
          {"max_penetration_dense_mm", optional(c.dense_penetration())},
          {"min_stretch", finite(c.minimum_stretch)},
          {"max_stretch", finite(c.maximum_stretch)},
          {"complementarity", finite(c.complementarity)},
          {"min_multiplier", finite(c.minimum_multiplier)},
          {"second_order", word(curvature_name(c.second_order.curvature))},
          {"second_order_reason", c.second_order.reason},
          {"negative_directions", judged ? Json(c.second_order.negative_directions) : Json(nullptr)},
          {"leftmost_curvature_N_per_mm2", optional(c.second_order.leftmost_curvature)},
          {"leftmost_mode", c.second_order.leftmost_mode.empty() ? Json(nullptr) : Json(c.second_order.leftmost_mode)},
          {"neutral_modes", c.second_order.neutral_modes},
          {"deciding_rows", c.second_order.deciding_rows},
          {"weakly_active", c.weakly_active},
          {"folds", joined(c.folds, c.wire_folds)},
          {"crossings", c.crossings},
          {"verdict", verdict_name(c.verdict)}};
}

Json quantities(const Quantities& q) {
  return {{"peak_displacement_mm", optional(q.peak_displacement)},
          {"mean_displacement_mm", optional(q.mean_displacement)},
          {"mean_displacement_nodes_mm", optional(q.mean_displacement_nodes)},
          {"wire_length_mm", optional(q.wire_length)},
          {"vessel_length_change_mm", optional(q.vessel_length_change)},
          {"arc_to_chord", optional(q.arc_to_chord)},
          {"contact_count", q.contact_count},
          {"contact_force_N", q.contact_force},
          {"line_load_peak_N_per_mm", optional(q.line_load_peak)},
          {"line_load_integral_N", optional(q.line_load_integral)}};
}

Json state1_tangents(const Curve& curve) {
  Json out = Json::array();
  for (const std::vector<double>& tangent : curve.state1_tangent) {
    out.push_back(vector(tangent.data(), curve.view.dimension));
  }
  return out;
}

/// Of the rest state; of an end that holds no rotation State 1's.
Json reference_tangents(const Curve& curve) {
  Json out = state1_tangents(curve);
  for (std::size_t e = 0; e < 2; ++e) {
    if (curve.state1.empty() || curve.held_frame[e].empty()) continue;
    out[e] = vector(curve.view.end[e].tangent, curve.view.dimension);
  }
  return out;
}

Json held_frames(const Curve& curve) {
  Json out = Json::array();
  for (const std::vector<double>& frame : curve.held_frame)
    out.push_back(frame.empty() ? Json(nullptr) : numbers(frame));
  return out;
}

Json curve(const Scene& scene, const Curve& curve, const CurveRecord& record) {
  const int d = curve.view.dimension;
  const bool other_rest = !curve.state1.empty();
  const bool along = curve.along >= 0;
  return {{"name", curve.name},
          {"kind", curve.view.kind == CurveKind::wire ? "wire" : "vessel"},
          {"s_mm", numbers(record.arc)},
          {"points", rows(record.points, d)},
          {"reference_points", rows(curve.reference, d)},
          {"reference_tangents", reference_tangents(curve)},
          {"state_1_points", other_rest ? rows(curve.state1, d) : Json(nullptr)},
          {"state_1_tangents", other_rest ? state1_tangents(curve) : Json(nullptr)},
          {"material_share", numbers(material_shares(curve))},
          {"along", along ? Json(scene.curves[at(curve.along)]->name) : Json(nullptr)},
          {"span_mm", along ? Json::array({curve.along_begin, curve.along_end}) : Json(nullptr)},
          {"held_frames", held_frames(curve)},
          {"frames", rows(record.frames, 4)},
          {"radius_mm", curve.radius.empty() ? Json(nullptr) : numbers(curve.radius)},
          {"curvature_per_mm", numbers(record.curvature)},
          {"twist_per_mm", record.twist.empty() ? Json(nullptr) : numbers(record.twist)},
          {"moment_N_mm", rows(record.moment, d == 3 ? 3 : 1)},
          {"internal_force_N", record.internal_force.empty() ? Json(nullptr) : rows(record.internal_force, d)}};
}

Json contacts(const Scene& scene, const Readings& readings) {
  Json out = Json::array();
  for (const ContactRecord& contact : readings.contacts) {
    const double edge = std::floor(contact.wire_coordinate);
    out.push_back({{"wire", scene.curves[at(contact.wire)]->name},
                   {"vessel", contact.vessel < 0 ? Json() : Json(scene.curves[at(contact.vessel)]->name)},
                   {"row", contact.row},
                   {"wire_edge", static_cast<int>(edge)},
                   {"t", contact.wire_coordinate - edge},
                   {"s_mm", contact.wire_arc},
                   {"vessel_s_mm", contact.vessel_arc},
                   {"gap_mm", finite(contact.gap)},
                   {"force_N", finite(contact.force)},
                   {"direction", vector(contact.direction, scene.dimension)}});
  }
  return out;
}

Json supports(const Scene& scene, const Readings& readings) {
  Json out = Json::array();
  for (const SupportRecord& support : readings.supports) {
    Json entry = {{"on", scene.curves[at(support.curve)]->name},
                  {"end", support.end == 0 ? "first" : "last"},
                  {"force_N", vector(support.force, scene.dimension)}};
    entry["moment_N_mm"] = scene.dimension == 2 ? finite(support.moment[2]) : vector(support.moment, 3);
    out.push_back(std::move(entry));
  }
  return out;
}

Json state(const SessionRecord& session, const Solution& solution) {
  const RecordedState recorded = record_state(*session.scene, session.rows, solution.q, solution.multipliers);
  Json fields = Json::object(), multipliers = Json::object();
  for (const NamedNumbers& field : recorded.fields) fields[field.name] = numbers(field.values);
  for (const NamedNumbers& group : recorded.multipliers) multipliers[group.name] = numbers(group.values);
  return {{"fields", fields}, {"multipliers", multipliers}};
}

Json energies(const Scene& scene, const Readings& readings) {
  Json energy = Json::object();
  double total = 0.0;
  for (std::size_t e = 0; e < readings.term_energy.size(); ++e) {
    energy[scene.energies[e].label] = finite(readings.term_energy[e]);
    total += readings.term_energy[e];
  }
  const bool known = readings.term_energy.size() == scene.energies.size();
  energy["total"] = known ? finite(total) : Json(nullptr);
  return energy;
}

std::string written(const Json& document, int indent) {
  return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string provenance_json(const Session& session, const Registry& registry) {
  return written({{"version", bowstring_version},
                  {"interface_version", interface_version},
                  {"plugins", plugins_of(session, registry)}},
                 -1);
}

SessionRecord record_of(const Session& session, std::string provenance) {
  return {session.scene,
          session.composition.resolved_json,
          std::move(provenance),
          session.composition.solver.name,
          session.assembly->summary(),
          session.assembly->row_origins(),
          session.assembly->epochs(),
          session.seconds};
}

std::string result_document(const SessionRecord& session, const Solution& solution, const Readings& readings) {
  const Scene& scene = *session.scene;
  Json curves = Json::array();
  for (const CurveRecord& record : readings.curves)
    curves.push_back(curve(scene, *scene.curves[at(record.curve)], record));

  Json document;
  document["format"] = result_format;
  document["status"] = verdict_name(solution.certificate.verdict);
  document["reason"] = solution.certificate.reason;
  document["warnings"] = solution.warnings;
  document["composition"] = Json::parse(session.composition);
  document["provenance"] = Json::parse(session.provenance);
  if (solution.start) document["provenance"]["start"] = start_of(*solution.start);
  document["problem"] = problem(session);
  document["solver"] = solver(session, solution);
  document["certificate"] = certificate(solution.certificate);
  document["energy"] = energies(scene, readings);
  document["quantities"] = quantities(readings.quantities);
  document["curves"] = std::move(curves);
  document["contacts"] = contacts(scene, readings);
  document["supports"] = supports(scene, readings);
  document["state"] = state(session, solution);
  document["equilibria"] = Json::array();
  return written(document, 1) + "\n";
}

std::string result_scalars(const SessionRecord& session, const Solution& solution, const Readings& readings) {
  Json document;
  document["status"] = verdict_name(solution.certificate.verdict);
  document["reason"] = solution.certificate.reason;
  document["certificate"] = certificate(solution.certificate);
  document["energy"] = energies(*session.scene, readings);
  document["quantities"] = quantities(readings.quantities);
  return written(document, -1);
}

std::string result_document(const Session& session, const Solution& solution, const Readings& readings,
                            const Registry& registry) {
  return result_document(record_of(session, provenance_json(session, registry)), solution, readings);
}

}  // namespace bowstring
