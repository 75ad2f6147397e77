#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/certificate/verdict.hpp"
#include "core/interfaces/status.hpp"
#include "core/session/refusal.hpp"

namespace bowstring {

/// A value, or why there is none.
template <class T>
struct Found {
  T value{};          ///< without a value: NaN, or empty
  std::string error;  ///< "" where there is one; else what was found, what was expected, and the nearest names

  bool ok() const noexcept { return error.empty(); }
  explicit operator bool() const noexcept { return ok(); }
};

/// Numbers in rows and columns, one row after the other; unknown ones are NaN.
struct NumberTable {
  int rows = 0, columns = 0;
  std::vector<double> values;  ///< rows × columns

  /// Without check of the range.
  double operator()(int row, int column = 0) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

class SimulationData;

/// What came of a solve: a result document (`bowstring.result/1`, docs/results.md), or a refusal. Cheap to copy; never
/// changes, so that any number of threads may read it.
///
/// A path leads through the document by keys, "quantities.peak_displacement_mm"; of a list it takes the entry of that
/// `name`, or else `type`, or of that number from 0, "curves.iliac.points", "contacts.0.force_N"; a key that all
/// entries of a list have takes it of every one, "contacts.force_N". Units are in the names of the keys.
class SimulationResult {
 public:
  /// Refused: nothing was solved yet.
  SimulationResult();
  explicit SimulationResult(std::shared_ptr<const SimulationData> data) noexcept;
  /// There is no moving, so that none is left empty.
  SimulationResult(const SimulationResult&) = default;
  SimulationResult& operator=(const SimulationResult&) = default;

  /// Whether there is a document. False: see `refusal`, everything else is empty or an error.
  bool ok() const noexcept;
  const Refusal& refusal() const noexcept;

  /// The kernel's verdict; `failed` where refused.
  Verdict status() const noexcept;
  bool converged() const noexcept { return status() == Verdict::converged; }
  /// Why that status, for people.
  const std::string& reason() const noexcept;
  const std::vector<std::string>& warnings() const noexcept;

  /// One number. An error where the document has none there, or null: not known, or not defined in this scene.
  Found<double> number(const std::string& path) const;
  /// A list of numbers (one column), of points (one row each), or one entry or list of every table of a list.
  Found<NumberTable> numbers(const std::string& path) const;
  Found<std::string> text(const std::string& path) const;
  /// The keys of a table, or of a list's entries their names, types or numbers, in the document's order.
  Found<std::vector<std::string>> names(const std::string& path) const;

  /// The whole document, as `bowstring solve --json` prints it; "" where refused. It is made when it is first asked
  /// for: by this, by `write`, or by a path that leads elsewhere than into `quantities`, `certificate` and `energy`.
  const std::string& json() const;
  /// Writes the document to a file, whole or not at all. `invalid_input` where the file cannot be written, or is what
  /// the composition reads; then nothing has changed.
  Status write(const std::string& file) const;

  /// The kernel's own, for what starts from it.
  const SimulationData& data() const noexcept;

 private:
  std::shared_ptr<const SimulationData> data_;
};

}  // namespace bowstring
