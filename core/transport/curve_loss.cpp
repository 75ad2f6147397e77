#include "core/transport/curve_loss.hpp"

#include <utility>

#include "core/composition/tree.hpp"
#include "core/measure/given_measure.hpp"

namespace bowstring {
namespace {

std::string owner_of(const LossTable& loss) { return "loss '" + loss.label + "'"; }

TransportChoice choice_of(const LossTable& loss) { return {loss.transport, loss.ground_cost}; }

/// The first place alone, with weight 1.
Measure first_place(const Measure& measure) {
  Measure out;
  out.position.assign(measure.position.begin(), measure.position.begin() + 3);
  if (measure.has_frames()) out.orientation.assign(measure.orientation.begin(), measure.orientation.begin() + 4);
  out.weight = {1.0};
  return out;
}

class Checker {
 public:
  Checker(const LossTable& loss, Scene& scene, Refusal& refusal) : loss_(loss), scene_(scene), refusal_(refusal) {}

  void run() {
    const Curve* curve = scene_.find(loss_.on);
    if (curve == nullptr || loss_.observed == nullptr) return;
    warn_of_stations(*curve);
    std::vector<InputError> errors;
    const std::optional<CurveMeasure> observed = measure_of(*loss_.observed, loss_.sampling, false, errors);
    for (const InputError& error : errors) {
      refuse(loss_.against_position, "'against' of " + owner_of(loss_) + ": " + error.text());
    }
    const std::vector<double> start(curve->view.start, curve->view.start + curve->view.nodes * scene_.dimension);
    CurveMeasure predicted;
    const Status status =
        measure_of_curve(nodal_curve(start, scene_.dimension, curve->radius), loss_.sampling, predicted);
    if (!status.ok()) refuse(loss_.position, owner_of(loss_) + ": " + status.text + " (the curve '" + loss_.on + "')");
    if (status.ok() && observed) try_out(predicted.measure, observed->measure);
  }

 private:
  void refuse(const std::string& position, const std::string& text) {
    refusal_.errors.push_back({position, text, "", ""});
  }

  void refuse(const Status& status) {
    if (status.code == Code::invalid_input || status.code == Code::unsupported) {
      refuse(loss_.position, owner_of(loss_) + ": " + status.text);
    } else if (refusal_.plugin_failure.ok()) {
      refusal_.plugin_failure = status;
    }
  }

  void warn_of_stations(const Curve& curve) {
    for (const MeasureStation& station : loss_.sampling.stations) {
      if (station.at <= curve.arc.back()) continue;
      scene_.warnings.push_back("the station at " + decimal(station.at) + " mm of " + owner_of(loss_) +
                                " lies beyond the end of '" + loss_.on + "', which is " + decimal(curve.arc.back()) +
                                " mm long");
    }
  }

  /// What a method cannot take at all it says of one place each.
  void try_out(const Measure& predicted, const Measure& observed) {
    Status status;
    std::optional<TransportComparison> comparison = TransportComparison::open(choice_of(loss_), status);
    if (!comparison) return refuse(status);
    status = comparison->check(predicted, observed);
    if (!status.ok()) return refuse(status);
    TransportResult ignored;
    status = comparison->compare(first_place(predicted), first_place(observed), ignored, false);
    if (status.code == Code::invalid_input || status.code == Code::unsupported) refuse(status);
  }

  const LossTable& loss_;
  Scene& scene_;
  Refusal& refusal_;
};

Status evaluate(const LossTable& loss, const Scene& scene, const Readings& readings, LossRecord& out) {
  const CurveRecord* found = nullptr;
  const Curve* curve = nullptr;
  for (const CurveRecord& record : readings.curves) {
    const Curve& one = *scene.curves[static_cast<std::size_t>(record.curve)];
    if (one.name == loss.on) found = &record, curve = &one;
  }
  if (found == nullptr) return Status::failure(Code::failed, "the curve '" + loss.on + "' is not known");
  Status status =
      measure_of_curve(nodal_curve(found->points, scene.dimension, curve->radius), loss.sampling, out.predicted);
  if (!status.ok()) return status;
  std::vector<InputError> errors;
  const std::optional<CurveMeasure> observed = measure_of(*loss.observed, loss.sampling, false, errors);
  if (!observed) return Status::failure(Code::invalid_input, errors.front().text());
  std::optional<TransportComparison> comparison = TransportComparison::open(choice_of(loss), status);
  if (!comparison) return status;
  return comparison->compare(out.predicted.measure, observed->measure, out.result);
}

}  // namespace

void check_losses(const Composition& composition, Scene& scene, Refusal& refusal) {
  for (const LossTable& loss : composition.losses) Checker(loss, scene, refusal).run();
}

std::vector<LossRecord> evaluate_losses(const Composition& composition, const Scene& scene, const Readings& readings) {
  std::vector<LossRecord> out;
  for (const LossTable& loss : composition.losses) {
    LossRecord record;
    record.name = loss.label;
    record.on = loss.on;
    record.against = loss.against;
    record.status = evaluate(loss, scene, readings, record);
    out.push_back(std::move(record));
  }
  return out;
}

std::vector<std::string> loss_warnings(const std::vector<LossRecord>& losses) {
  std::vector<std::string> out;
  for (const LossRecord& loss : losses) {
    if (!loss.status.ok()) out.push_back("loss '" + loss.name + "' has no value: " + loss.status.text);
  }
  return out;
}

}  // namespace bowstring
