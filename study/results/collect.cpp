#include "study/results/collect.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "core/result/provenance.hpp"
#include "study/analysis/statistics.hpp"
#include "study/results/references.hpp"
#include "study/workers/run_solver.hpp"
#include "study/workers/unit_work.hpp"

namespace bowstring::study {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double number(const RunRecord::Number& value) { return value.value_or(unknown); }

double number_at(const std::map<std::string, RunRecord::Number>& table, const std::string& key) {
  const auto found = table.find(key);
  return found == table.end() ? unknown : number(found->second);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? unknown : quantile(values, 0.5);
}

StudyData frame(const Plan& plan) {
  const StudyFile& study = plan.study;
  StudyData data;
  data.name = study.name;
  data.title = study.title.empty() ? study.name : study.title;
  data.file = study.file;
  data.version = bowstring_version;
  data.repeats = study.repeats;
  for (const Axis& axis : study.axes) data.axes.push_back(axis.data);
  data.along = study.along;
  data.target_error = study.target_error;
  for (const QuantityOfInterest& quantity : study.quantities) {
    QuantityData one;
    one.column = quantity.column;
    one.unit = quantity.unit;
    one.path = value_key(quantity);
    one.value.assign(plan.runs.size(), unknown);
    data.quantities.push_back(std::move(one));
  }
  return data;
}

/// A quantity that the record does not have is read from the document: the study may have asked for less before.
double value_of(const RunRecord& record, const QuantityOfInterest& quantity, const Folder& folder,
                std::vector<std::string>& problems) {
  const auto found = record.values.find(value_key(quantity));
  if (found != record.values.end()) return number(found->second);
  if (record.document_sha256.empty()) return unknown;
  std::string document, why;
  if (const std::string problem = folder.load_document(record, document); !problem.empty()) {
    problems.push_back(problem);
    return unknown;
  }
  return number(quantity_in(document, quantity, why));
}

RunData run_data(const PlannedRun& planned, const RunRecord& record) {
  RunData run;
  run.choice = planned.choice;
  run.hash = planned.hash;
  run.status = record.status;
  run.reason = record.reason;
  run.second_order = record.second_order;
  run.unknowns = record.unknowns;
  run.iterations = record.iterations;
  run.factorizations = record.factorizations;
  run.evaluations = record.evaluations;
  run.epochs = record.epochs;
  run.max_penetration_dense = number_at(record.certificate, "max_penetration_dense_mm");
  run.min_stretch = number_at(record.certificate, "min_stretch");
  run.setup_seconds = record.solve_seconds.empty() ? unknown : record.setup_seconds;
  run.solve_seconds = median(record.solve_seconds);
  return run;
}

void take_energy(const RunRecord& record, std::size_t run, std::size_t runs, std::vector<EnergyData>& energies) {
  for (const auto& [term, value] : record.energy) {
    if (term == "total") continue;
    const auto same = [&name = term](const EnergyData& one) { return one.term == name; };
    auto place = std::find_if(energies.begin(), energies.end(), same);
    if (place == energies.end()) place = energies.insert(place, {term, std::vector<double>(runs, unknown)});
    place->value[run] = number(value);
  }
}

}  // namespace

Collected collect(const Plan& plan, const Folder& folder) {
  Collected out;
  out.data = frame(plan);
  const std::size_t runs = plan.runs.size();
  out.records.resize(runs);
  for (std::size_t r = 0; r < runs; ++r) {
    const PlannedRun& planned = plan.runs[r];
    RunRecord& record = out.records[r];
    std::string why;
    if (planned.hash.empty()) {
      record.status = "refused";
      record.reason = planned.refusal;
    } else if (folder.load(planned.hash, record, why) != Stored::whole) {
      out.problems.push_back(why.empty() ? folder.record_file(planned.hash) + ": missing" : why);
    } else if (!is_complete(plan, folder, static_cast<int>(r), record, false)) {
      out.problems.push_back(folder.record_file(planned.hash) + ": lacks what the study asks for");
    } else {
      for (std::size_t k = 0; k < plan.study.quantities.size(); ++k) {
        out.data.quantities[k].value[r] = value_of(record, plan.study.quantities[k], folder, out.problems);
      }
    }
    out.data.runs.push_back(run_data(planned, record));
    take_energy(record, r, runs, out.data.energies);
  }
  add_references(plan, out.data);
  return out;
}

}  // namespace bowstring::study
