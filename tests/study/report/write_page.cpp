#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "study/report/report_page.hpp"

/// write-report-page REPORT.json PAGE.html
int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "write-report-page: expected a report's JSON file and the page to write\n";
    return 2;
  }
  std::ifstream in(argv[1], std::ios::binary);
  const std::string json{std::istreambuf_iterator<char>(in), {}};
  std::ofstream out(argv[2], std::ios::binary);
  out << bowstring::study::report_page(json);
  out.close();
  return in && out ? 0 : 1;
}
