#include "core/result/document.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/model/carried_curve.hpp"
#include "core/model/manifold.hpp"
#include "core/transport/transport_json.hpp"

namespace bowstring {

namespace {

using Json = nlohmann::ordered_json;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A finite number, or null: JSON has no other.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json optional(const std::optional<double>& value) { return value ? finite(*value) : Json(nullptr); }

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

Json enforcement(const SessionRecord& session, const EnforcementReport& report) {
  return {{"name", session.enforcement},
          {"outer_iterations", report.outer_iterations},
          {"weight_N_per_mm", optional(report.weight)},
          {"bias",
           {{"penetration_mm", optional(report.penetration)},
            {"energy_N_mm", optional(report.energy)},
            {"measured_energy_N_mm", optional(report.measured_energy)},
            {"measured_motion_mm", optional(report.measured_motion)}}}};
}

std::vector<std::string> joined(std::vector<std::string> texts, const std::vector<std::string>& more) {
  texts.insert(texts.end(), more.begin(), more.end());
  return texts;
}

Json negative_directions(const Certificate& c) {
  return c.second_order.curvature != Curvature::unjudged ? Json(c.second_order.negative_directions) : Json(nullptr);
}

Json certificate(const Certificate& c) {
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
          {"negative_directions", negative_directions(c)},
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

Json state(const SessionRecord& session, const std::vector<double>& q, const std::vector<double>& carried) {
  const RecordedState recorded = record_state(*session.scene, session.rows, q, carried);
  Json fields = Json::object(), multipliers = Json::object();
  for (const NamedNumbers& field : recorded.fields) fields[field.name] = numbers(field.values);
  for (const NamedNumbers& group : recorded.multipliers) multipliers[group.name] = numbers(group.values);
  return {{"fields", fields}, {"multipliers", multipliers}};
}

Json energies(const std::vector<std::string>& labels, const Readings& readings) {
  Json energy = Json::object();
  double total = 0.0;
  for (std::size_t e = 0; e < readings.term_energy.size(); ++e) {
    energy[labels[e]] = finite(readings.term_energy[e]);
    total += readings.term_energy[e];
  }
  const bool known = readings.term_energy.size() == labels.size();
  energy["total"] = known ? finite(total) : Json(nullptr);
  return energy;
}

Json energies(const Scene& scene, const Readings& readings) {
  std::vector<std::string> labels;
  for (const EnergyUse& use : scene.energies) labels.push_back(use.label);
  return energies(labels, readings);
}

/// A value that was walked, as the composition writes it without its unit.
Json parameter(const Path& path, const std::vector<double>& value) {
  return path.list ? numbers(value) : finite(value.front());
}

Json path_points(const Path& path) {
  Json out = Json::array();
  for (const PathPoint& point : path.points) {
    const Certificate& found = point.state.certificate;
    out.push_back({{"parameter", parameter(path, point.parameter)},
                   {"share", point.share},
                   {"arclength", point.arclength},
                   {"verdict", verdict_name(found.verdict)},
                   {"reason", found.reason},
                   {"second_order", word(curvature_name(found.second_order.curvature))},
                   {"negative_directions", negative_directions(found)},
                   {"energy", energies(point.state.energy_label, point.state.readings)},
                   {"quantities", quantities(point.state.readings.quantities)},
                   {"iterations", point.iterations},
                   {"by_solver", point.by_solver}});
  }
  return out;
}

Json continuation(const Path& path) {
  if (path.value.empty()) return nullptr;
  Json critical = Json::array();
  for (const CriticalPoint& point : path.critical) {
    critical.push_back({{"kind", critical_name(point.kind)},
                        {"parameter", parameter(path, point.parameter)},
                        {"share", point.share},
                        {"uncertainty", point.uncertainty},
                        {"energy_N_mm", finite(point.energy)},
                        {"negative_directions_before", point.index_before},
                        {"negative_directions_after", point.index_after}});
  }
  return {{"path", path.value},
          {"unit", path.unit},
          {"reached", path.reached},
          {"reason", path.reason.empty() ? Json(nullptr) : Json(path.reason)},
          {"asked_composition", path.asked_composition.empty() ? Json(nullptr) : Json::parse(path.asked_composition)},
          {"critical_points", std::move(critical)}};
}

Json curves(const Scene& scene, const Readings& readings) {
  Json out = Json::array();
  for (const CurveRecord& record : readings.curves)
    out.push_back(curve(scene, *scene.curves[at(record.curve)], record));
  return out;
}

Json equilibria(const StateResult& result) {
  const Scene& scene = *result.session.scene;
  Json out = Json::array();
  for (const Equilibrium& one : result.equilibria) {
    const Certificate& found = one.state.certificate;
    out.push_back({{"origin", one.origin},
                   {"basin_count", one.basin},
                   {"index", negative_directions(found)},
                   {"status", verdict_name(found.verdict)},
                   {"reason", found.reason},
                   {"certificate", certificate(found)},
                   {"energy", energies(one.state.energy_label, one.state.readings)},
                   {"quantities", quantities(one.state.readings.quantities)},
                   {"curves", curves(scene, one.state.readings)},
                   {"contacts", contacts(scene, one.state.readings)},
                   {"supports", supports(scene, one.state.readings)},
                   {"state", state(result.session, one.q, one.multipliers)}});
  }
  return out;
}

Json loss(const LossRecord& record) {
  const Measure& measure = record.predicted.measure;
  Json out = {{"name", record.name}, {"on", record.on}, {"against", record.against}};
  if (!record.status.ok()) {
    out["value"] = nullptr;
    out["reason"] = record.status.text;
    return out;
  }
  double mass = 0.0;
  for (const double weight : measure.weight) mass += weight;
  out.update(transport_answer_json(record.result, mass));
  out["gradient"] = {{"positions", rows_or_null(record.result.gradient_a.position, 3)},
                     {"frames", rows_or_null(record.result.gradient_a.frame, 6)},
                     {"weights", numbers_or_null(record.result.answer.weight_gradient_a)}};
  out["places"] = {{"s_mm", numbers_or_null(record.predicted.arc)},
                   {"positions", rows_or_null(measure.position, 3)},
                   {"orientations", rows_or_null(measure.orientation, 4)},
                   {"weights", numbers_or_null(measure.weight)}};
  out["seconds"] = {{"cost", record.result.cost_seconds}, {"solve", record.result.solve_seconds}};
  return out;
}

Json losses(const std::vector<LossRecord>& records) {
  Json out = Json::array();
  for (const LossRecord& record : records) out.push_back(loss(record));
  return out;
}

/// All that the document says of one state, and not of where its plugins came from.
void add_state(Json& out, const StateResult& result) {
  const Scene& scene = *result.session.scene;
  out["status"] = verdict_name(result.solution.certificate.verdict);
  out["reason"] = result.solution.certificate.reason;
  out["warnings"] = result.solution.warnings;
  out["composition"] = Json::parse(result.session.composition);
  out["provenance"] = Json::parse(result.session.provenance);
  if (result.solution.start) out["provenance"]["start"] = start_of(*result.solution.start);
  out["problem"] = problem(result.session);
  out["solver"] = solver(result.session, result.solution);
  out["enforcement"] = enforcement(result.session, result.solution.solver.enforcement);
  out["certificate"] = certificate(result.solution.certificate);
  out["energy"] = energies(scene, result.readings);
  out["quantities"] = quantities(result.readings.quantities);
  out["losses"] = losses(result.losses);
  out["curves"] = curves(scene, result.readings);
  out["contacts"] = contacts(scene, result.readings);
  out["supports"] = supports(scene, result.readings);
  out["state"] = state(result.session, result.solution.q, result.solution.multipliers);
  out["equilibria"] = equilibria(result);
  out["continuation"] = continuation(result.path);
  out["path"] = path_points(result.path);
}

std::string written(const Json& document, int indent) {
  return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

SessionRecord record_of(const Session& session, std::string provenance) {
  return {session.scene,
          session.composition.resolved_json,
          std::move(provenance),
          session.composition.title,
          session.composition.solver.name,
          session.composition.enforcement.name,
          session.assembly->summary(),
          session.assembly->row_origins(),
          session.assembly->epochs(),
          session.seconds};
}

std::string result_document(const std::vector<StateResult>& states, const std::string& study) {
  Json document;
  document["format"] = result_format;
  document["study"] = Json::parse(study);
  add_state(document, states.back());
  document["states"] = Json::array();
  for (const StateResult& result : states) {
    if (result.name.empty()) continue;
    Json entry;
    entry["name"] = result.name;
    add_state(entry, result);
    document["states"].push_back(std::move(entry));
  }
  return written(document, 1) + "\n";
}

std::string result_scalars(const StateResult& result) {
  Json document;
  document["status"] = verdict_name(result.solution.certificate.verdict);
  document["reason"] = result.solution.certificate.reason;
  document["certificate"] = certificate(result.solution.certificate);
  document["energy"] = energies(*result.session.scene, result.readings);
  document["quantities"] = quantities(result.readings.quantities);
  return written(document, -1);
}

}  // namespace bowstring
