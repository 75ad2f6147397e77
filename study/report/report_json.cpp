#include "study/report/report_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace bowstring::study {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_places = 400;  // of a page's sensitivities

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (double value : values) out.push_back(finite(value));
  return out;
}

/// One list over the runs.
template <class Get>
Json over_runs(const StudyData& data, Get get) {
  Json out = Json::array();
  for (const RunData& run : data.runs) out.push_back(get(run));
  return out;
}

Json study(const StudyData& data) {
  return {{"name", data.name},       {"title", data.title},     {"file", data.file},
          {"version", data.version}, {"repeats", data.repeats}, {"target_error", data.target_error}};
}

Json headlines(const Analysis& analysis) {
  Json out = Json::array();
  for (const Headline& h : analysis.headlines) {
    out.push_back({{"kind", headline_kind_name(h.kind)}, {"text", h.text}, {"detail", h.detail}, {"lines", h.lines}});
  }
  return out;
}

Json axes(const StudyData& data) {
  Json out = Json::array();
  for (const AxisData& axis : data.axes) {
    out.push_back({{"name", axis.name},
                   {"unit", axis.unit},
                   {"column", axis.column},
                   {"paths", axis.paths},
                   {"labels", axis.label},
                   {"numbers", axis.numeric() ? numbers(axis.number) : Json(nullptr)},
                   {"spacing", spacing_name(axis.spacing)}});
  }
  return out;
}

Json quantities(const StudyData& data) {
  Json out = Json::array();
  for (int q = 0; q < static_cast<int>(data.quantities.size()); ++q) {
    const QuantityData& quantity = data.quantities[at(q)];
    Json errors = Json::array(), references = Json::array();
    for (int run = 0; run < static_cast<int>(data.runs.size()); ++run) {
      errors.push_back(finite(relative_error(data, q, run)));
      references.push_back(finite(reference_of(data, q, run)));
    }
    if (!quantity.has_reference()) errors = nullptr;
    out.push_back({{"column", quantity.column},
                   {"unit", quantity.unit},
                   {"path", quantity.path},
                   {"reference_text", quantity.reference_text},
                   {"values", numbers(quantity.value)},
                   {"references", references},
                   {"errors", errors}});
  }
  return out;
}

Json energies(const StudyData& data) {
  Json out = Json::array();
  for (const EnergyData& energy : data.energies)
    out.push_back({{"term", energy.term}, {"values", numbers(energy.value)}});
  return out;
}

Json runs(const StudyData& data) {
  Json choice = Json::array();
  for (std::size_t a = 0; a < data.axes.size(); ++a) {
    choice.push_back(over_runs(data, [a](const RunData& run) { return run.choice[a]; }));
  }
  return {{"choice", choice},
          {"hash", over_runs(data, [](const RunData& run) { return run.hash; })},
          {"status", over_runs(data, [](const RunData& run) { return run.status; })},
          {"reason", over_runs(data, [](const RunData& run) { return run.reason; })},
          {"second_order", over_runs(data, [](const RunData& run) { return run.second_order; })},
          {"unknowns", over_runs(data, [](const RunData& run) { return run.unknowns; })},
          {"iterations", over_runs(data, [](const RunData& run) { return run.iterations; })},
          {"factorizations", over_runs(data, [](const RunData& run) { return run.factorizations; })},
          {"epochs", over_runs(data, [](const RunData& run) { return run.epochs; })},
          {"max_penetration_dense_mm",
           over_runs(data, [](const RunData& run) { return finite(run.max_penetration_dense); })},
          {"min_stretch", over_runs(data, [](const RunData& run) { return finite(run.min_stretch); })},
          {"setup_seconds", over_runs(data, [](const RunData& run) { return finite(run.setup_seconds); })},
          {"solve_seconds", over_runs(data, [](const RunData& run) { return finite(run.solve_seconds); })}};
}

Json fit(const std::optional<Fit>& fit) {
  if (!fit) return nullptr;
  return {{"verdict", settling_name(fit->verdict)},
          {"order", finite(fit->order)},
          {"order_low", finite(fit->order_low)},
          {"order_high", finite(fit->order_high)},
          {"limit", finite(fit->limit)},
          {"beside", finite(fit->beside)},
          {"text", fit->text}};
}

Json lines(const Analysis& analysis) {
  Json out = Json::array();
  for (const Line& line : analysis.lines.lines) {
    Json fits = Json::array();
    for (const std::optional<Fit>& own : line.fits) fits.push_back(fit(own));
    out.push_back({{"label", line.label}, {"choice", line.choice}, {"runs", line.runs}, {"fits", fits}});
  }
  return out;
}

Json effect_numbers(const Effect& effect) {
  return {{"axis", effect.axis},
          {"from", effect.from},
          {"to", effect.to},
          {"pairs", effect.pairs},
          {"mean", finite(effect.mean)},
          {"low", finite(effect.low)},
          {"high", finite(effect.high)},
          {"largest", finite(effect.largest)},
          {"largest_run", effect.largest_run},
          {"relative", finite(effect.relative)}};
}

Json effects(const Analysis& analysis) {
  Json out = Json::array();
  for (const Effect& effect : analysis.effects.quantities) {
    Json own = effect_numbers(effect);
    own["quantity"] = effect.quantity;
    out.push_back(own);
  }
  return out;
}

Json time_effects(const Analysis& analysis) {
  Json out = Json::array();
  for (const Effect& effect : analysis.effects.times) out.push_back(effect_numbers(effect));
  return out;
}

/// All of them, or evenly many of a large grid.
Json sensitivities(const Analysis& analysis) {
  Json out = Json::array();
  const std::size_t count = analysis.sensitivities.size();
  const std::size_t step = (count + most_places - 1) / most_places;
  for (std::size_t k = 0; k < count; k += step) {
    const Sensitivity& place = analysis.sensitivities[k];
    Json entries = Json::array();
    for (const SensitivityEntry& entry : place.entries) {
      entries.push_back(
          {{"axis", entry.axis}, {"derivative", finite(entry.derivative)}, {"elasticity", finite(entry.elasticity)}});
    }
    out.push_back({{"quantity", place.quantity}, {"at", place.at}, {"entries", entries}});
  }
  return out;
}

Json inseparable(const Analysis& analysis) {
  Json out = Json::array();
  for (const Inseparable& pair : analysis.inseparable) {
    out.push_back({{"axes", {pair.axes[0], pair.axes[1]}}, {"cosine", pair.cosine}, {"text", pair.text}});
  }
  return out;
}

Json distributions(const Analysis& analysis) {
  Json out = Json::array();
  for (const Distribution& d : analysis.distributions) {
    Json quantiles = Json::array();
    for (std::size_t k = 0; k < Distribution::at.size(); ++k) {
      quantiles.push_back({Distribution::at[k], finite(d.quantiles[k])});
    }
    out.push_back({{"quantity", d.quantity},
                   {"label", d.label},
                   {"count", d.count},
                   {"left_out", d.left_out},
                   {"mean", finite(d.mean)},
                   {"deviation", finite(d.deviation)},
                   {"quantiles", quantiles},
                   {"shares", d.shares.empty() ? Json(nullptr) : numbers(d.shares)},
                   {"share_axes", d.axes},
                   {"r_squared", finite(d.r_squared)},
                   {"note", d.note}});
  }
  return out;
}

Json points(const std::vector<double>& flat) {
  Json out = Json::array();
  for (std::size_t k = 0; k + 1 < flat.size(); k += 2) out.push_back({finite(flat[k]), finite(flat[k + 1])});
  return out;
}

Json shape(const Shape& shape) {
  Json curves = Json::array(), contacts = Json::array();
  for (const ShapeCurve& curve : shape.curves) {
    curves.push_back({{"name", curve.name},
                      {"kind", curve.wire ? "wire" : "vessel"},
                      {"points", points(curve.points)},
                      {"rest", curve.rest.empty() ? Json(nullptr) : points(curve.rest)}});
  }
  for (const ShapeContact& contact : shape.contacts) {
    contacts.push_back({{"x", finite(contact.x)},
                        {"y", finite(contact.y)},
                        {"fx", finite(contact.fx)},
                        {"fy", finite(contact.fy)},
                        {"force_N", finite(contact.force)}});
  }
  return {{"run", shape.run}, {"label", shape.label}, {"curves", curves}, {"contacts", contacts}};
}

Json index_or_null(int index) { return index < 0 ? Json(nullptr) : Json(index); }

}  // namespace

std::string report_json(const StudyData& data, const Analysis& analysis, const Shapes& shapes) {
  Json drawn = Json::array();
  for (const Shape& one : shapes.shapes) drawn.push_back(shape(one));
  const Json out = {{"format", "bowstring.report/1"},
                    {"study", study(data)},
                    {"headlines", headlines(analysis)},
                    {"axes", axes(data)},
                    {"along", index_or_null(data.along)},
                    {"line_axes", analysis.lines.axes},
                    {"line_over", index_or_null(analysis.lines.over)},
                    {"quantities", quantities(data)},
                    {"energies", energies(data)},
                    {"runs", runs(data)},
                    {"lines", lines(analysis)},
                    {"effects", effects(analysis)},
                    {"time_effects", time_effects(analysis)},
                    {"sensitivities", sensitivities(analysis)},
                    {"inseparable", inseparable(analysis)},
                    {"distributions", distributions(analysis)},
                    {"shapes", drawn},
                    {"shapes_text", shapes.text}};
  // A text that is not UTF-8 (a path of another encoding) must not cost the report.
  return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bowstring::study
