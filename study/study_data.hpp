#pragma once

#include <string>
#include <vector>

namespace bowstring::study {

/// Where an axis takes its values from.
enum class Spacing : int { listed, linear, logarithmic, sampled };
const char* spacing_name(Spacing spacing) noexcept;  ///< "listed", "linear", "log", "sampled"

/// An axis of a study as its results see it: a number, or alternatives with names. A sample of several numbers is one
/// axis for each of them.
struct AxisData {
  std::string name;                ///< "T", "contact"
  std::string unit;                ///< of the numbers, as the study file writes it: "N mm^2"; "" without
  std::string column;              ///< in results.csv: "EI_N_mm2", "contact"
  std::vector<std::string> paths;  ///< what it sets: "energy.axial-tension.tension"
  std::vector<std::string> label;  ///< per alternative, in the order of the study file: "10 N", "node-wise-contact"
  std::vector<double> number;      ///< per alternative, in `unit`; empty where an alternative is no number
  Spacing spacing = Spacing::listed;
  /// Per alternative the problem that it states: those of one problem are ways to solve it, others are cases. Empty:
  /// all state one.
  std::vector<int> problem;

  bool numeric() const noexcept { return !number.empty(); }
  /// The alternative with the largest number; -1 without numbers.
  int largest() const noexcept;
  /// Whether two alternatives are ways to solve one problem.
  bool same_problem(int one, int other) const noexcept;
  /// Whether some two are not.
  bool has_cases() const noexcept;
};

/// A quantity of interest.
struct QuantityData {
  std::string column;             ///< in results.csv, with its unit: "peak_displacement_mm"
  std::string unit;               ///< "mm"; "" without
  std::string path;               ///< in the result document: "quantities.peak_displacement_mm"
  std::vector<double> value;      ///< per run; NaN where the run has none
  std::vector<double> reference;  ///< per run; NaN where there is none
  std::string reference_text;     ///< "the run with N = 640, contact = segment-wise-contact"; "" without reference

  bool has_reference() const noexcept { return !reference_text.empty(); }
};

/// One term of the energy over all runs.
struct EnergyData {
  std::string term;           ///< its name or else type: "wire-bending"
  std::vector<double> value;  ///< N mm, per run; NaN where the run has no such term
};

/// One run as its results see it.
struct RunData {
  std::vector<int> choice;  ///< per axis the alternative; -1 where the axis has no part in this run
  std::string hash;         ///< of its files in runs/
  std::string status;       ///< a verdict's name, or "refused": the composition cannot be solved
  std::string reason;
  std::string second_order;  ///< "minimum" | "saddle" | "degenerate", or ""
  int unknowns = 0, iterations = 0, factorizations = 0, evaluations = 0, epochs = 0;
  double max_penetration_dense = 0.0;  ///< mm; NaN: not known
  double min_stretch = 0.0;            ///< NaN: not known
  double setup_seconds = 0.0;
  double solve_seconds = 0.0;  ///< the median of the repeats; NaN where nothing was solved

  bool converged() const noexcept { return status == "converged"; }
};

/// The results of a study, run by run in the order of its axes' product, the last axis fastest.
struct StudyData {
  std::string name, title, file;  ///< of the study; its file as the user gave it
  std::string version;            ///< of Bowstring
  int repeats = 1;
  std::vector<AxisData> axes;
  int along = -1;  ///< the axis along which results are to converge: a mesh; -1: none
  /// The relative error (of the reference) at which formulations are compared.
  double target_error = 0.01;
  std::vector<QuantityData> quantities;  ///< the first one is what the report opens with
  std::vector<EnergyData> energies;
  std::vector<RunData> runs;
};

}  // namespace bowstring::study
