#pragma once

#include <string>
#include <vector>

namespace bench {

/// Transport problems of one size with the same weights, one cost matrix each: what `benchmark-transport make` writes
/// and the others read. As a file: rows, columns and the number of matrices (64-bit integers), then all numbers as
/// doubles.
struct Problems {
  int rows = 0, columns = 0;
  std::vector<double> weight_a, weight_b;
  std::vector<std::vector<double>> cost;  ///< each rows × columns, row major
};

void write_problems(const Problems& problems, const std::string& file);
/// Ends the process with a message where the file cannot be read.
Problems read_problems(const std::string& file);

/// Seconds of one call.
double seconds_now();
void print_numbers(const char* key, const std::vector<double>& numbers, const char* end);

}  // namespace bench
