// Any text as a table of points, in the plane and in space: it is read, or every reason why not is a sentence.

#include "core/curve/point_table.hpp"

#include <cmath>

#include "tests/fuzz/scratch.hpp"

namespace {

using namespace bowstring;

void check(const PointTable& table, int dimension) {
  const std::size_t rows = table.points.size() / static_cast<std::size_t>(dimension);
  fuzz::require(rows * static_cast<std::size_t>(dimension) == table.points.size() && rows >= 3, "fewer than 3 points");
  for (const double number : table.points) fuzz::require(std::isfinite(number), "a point that is not finite");
  for (const PointData& column : table.data) {
    fuzz::require(!column.name.empty() && column.value.size() == rows, "a column of another length");
    for (const double number : column.value) fuzz::require(std::isfinite(number), "a number that is not finite");
  }
  fuzz::require(table.label.empty() || table.label.size() == rows, "labels of another number");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string& file = fuzz::scratch_file(data, size);
  const bool utf8 = fuzz::is_utf8(std::string(reinterpret_cast<const char*>(data), size));
  for (const int dimension : {2, 3}) {
    PointTable table;
    const Status status = read_point_table(file, dimension, table);
    if (status.ok()) {
      check(table, dimension);
    } else {
      fuzz::require(status.code == Code::invalid_input && !status.text.empty(), "a refusal without a reason");
      fuzz::require(!utf8 || fuzz::is_utf8(status.text), "an error that cuts a letter");
    }
  }
  return 0;
}
