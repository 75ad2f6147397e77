#include "study/report/report_page.hpp"

#include <doctest/doctest.h>

#include <string>

#include "study/report/page_parts.hpp"

using bowstring::study::page_head;
using bowstring::study::page_tail;
using bowstring::study::report_page;

TEST_CASE("the report's JSON stands in its element") {
  const std::string page = report_page(R"({"a": [1, null]})");
  CHECK(page.find(R"(<script type="application/json" id="report">{"a": [1, null]}</script>)") != std::string::npos);
  CHECK(page.starts_with("<!doctype html>"));
  CHECK(page.ends_with("</html>\n"));
}

TEST_CASE("no name in the report can end its element") {
  const std::string json = R"({"a": "</script><b><!-- x"})";
  const std::string page = report_page(json);
  CHECK(page.find(R"("\u003c/script>\u003cb>\u003c!-- x")") != std::string::npos);
  CHECK(page.size() == page_head.size() + page_tail.size() + json.size() + 3 * 5);
}

TEST_CASE("the page holds Chart.js with its licence, and every part that it asks for") {
  const std::string page = report_page("{}");
  CHECK(page.find("Chart.js v3") != std::string::npos);
  CHECK(page.find("Released under the MIT License") != std::string::npos);
  CHECK(page.find("window.bowstringReport = ") != std::string::npos);
  CHECK(page.find("--ground:") != std::string::npos);
  for (const char* part : {"{{style}}", "{{chart}}", "{{script}}", "{{report}}"}) {
    CAPTURE(part);
    CHECK(page.find(part) == std::string::npos);
  }
}
