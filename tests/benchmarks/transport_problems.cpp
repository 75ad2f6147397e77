#include "transport_problems.hpp"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace bench {
namespace {

void write_numbers(std::ofstream& out, const std::vector<double>& numbers) {
  out.write(reinterpret_cast<const char*>(numbers.data()),
            static_cast<std::streamsize>(numbers.size() * sizeof(double)));
}

void read_numbers(std::ifstream& in, std::vector<double>& numbers, std::int64_t count) {
  numbers.resize(static_cast<std::size_t>(count));
  in.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(numbers.size() * sizeof(double)));
}

}  // namespace

void write_problems(const Problems& problems, const std::string& file) {
  std::ofstream out(file, std::ios::binary);
  const std::int64_t sizes[] = {problems.rows, problems.columns, static_cast<std::int64_t>(problems.cost.size())};
  out.write(reinterpret_cast<const char*>(sizes), sizeof sizes);
  write_numbers(out, problems.weight_a);
  write_numbers(out, problems.weight_b);
  for (const std::vector<double>& cost : problems.cost) write_numbers(out, cost);
}

Problems read_problems(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::int64_t sizes[3];
  Problems out;
  if (in.read(reinterpret_cast<char*>(sizes), sizeof sizes)) {
    out.rows = static_cast<int>(sizes[0]);
    out.columns = static_cast<int>(sizes[1]);
    read_numbers(in, out.weight_a, sizes[0]);
    read_numbers(in, out.weight_b, sizes[1]);
    out.cost.resize(static_cast<std::size_t>(sizes[2]));
    for (std::vector<double>& cost : out.cost) read_numbers(in, cost, sizes[0] * sizes[1]);
  }
  if (in) return out;
  std::fprintf(stderr, "%s: no problems that `benchmark-transport make` has written\n", file.c_str());
  std::exit(1);
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void print_numbers(const char* key, const std::vector<double>& numbers, const char* end) {
  std::printf("\"%s\": [", key);
  for (std::size_t k = 0; k < numbers.size(); ++k) std::printf("%s%.17g", k == 0 ? "" : ", ", numbers[k]);
  std::printf("]%s", end);
}

}  // namespace bench
