#include "core/result/carry.hpp"

#include <utility>

#include "core/model/carried_curve.hpp"

namespace bowstring {

namespace {

RecordedCurve recorded_curve(const Scene& scene, const Curve& curve, const CurveRecord& record) {
  RecordedCurve out;
  out.name = curve.name;
  out.kind = curve.view.kind;
  out.kinematics = curve.kinematics_name;
  out.dimension = scene.dimension;
  out.points = record.points;
  out.frames = record.frames;
  out.share = material_shares(curve);
  if (curve.along >= 0) {
    out.along = scene.curves[static_cast<std::size_t>(curve.along)]->name;
    out.along_begin = curve.along_begin;
    out.along_end = curve.along_end;
  }
  for (int e = 0; e < 2; ++e) out.held_frame[e] = curve.held_frame[e];
  find_flaw(out);
  return out;
}

CarriedState carry(const Scene& scene, const std::vector<RowOrigin>& rows, const Solution& solution,
                   const Readings& readings, std::string name) {
  RecordedState state = record_state(scene, rows, solution.q, solution.multipliers);
  for (const CurveRecord& record : readings.curves) {
    state.curves.push_back(recorded_curve(scene, *scene.curves[static_cast<std::size_t>(record.curve)], record));
  }
  CarriedState out;
  out.state = std::make_shared<const RecordedState>(std::move(state));
  out.name = std::move(name);
  return out;
}

}  // namespace

CarriedState carry(const SessionRecord& session, const Solution& solution, const Readings& readings, std::string name) {
  return carry(*session.scene, session.rows, solution, readings, std::move(name));
}

CarriedState carry(const Session& session, const Solution& solution, const Readings& readings, std::string name) {
  return carry(*session.scene, session.assembly->row_origins(), solution, readings, std::move(name));
}

}  // namespace bowstring
