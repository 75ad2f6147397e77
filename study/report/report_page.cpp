#include "study/report/report_page.hpp"

#include <algorithm>
#include <string_view>

#include "study/report/page_parts.hpp"

namespace bowstring::study {
namespace {

// In JSON `<` stands in strings alone, where this escape means the same.
constexpr std::string_view escaped_less_than = "\\u003c";

}  // namespace

std::string report_page(const std::string& report_json) {
  const auto escapes = static_cast<std::size_t>(std::count(report_json.begin(), report_json.end(), '<'));
  std::string page;
  page.reserve(page_head.size() + report_json.size() + escapes * escaped_less_than.size() + page_tail.size());
  page += page_head;
  for (const char c : report_json) {
    if (c == '<')
      page += escaped_less_than;
    else
      page += c;
  }
  page += page_tail;
  return page;
}

}  // namespace bowstring::study
