#include "tests/check/checked_scene.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "tests/curve/temporary_file.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring::testing {

namespace {

PluginHost& dishonest_host() {
  static const TemporaryFolder folder;
  static PluginHost host([] {
    folder.take_fixture("dishonest");
    PluginHostOptions options;
    options.command_line_path = {folder.path()};
    options.executable_path = std::string(std::getenv("BOWSTRING_BUILD_ROOT")) + "/bowstring";
    return options;
  }());
  return host;
}

}  // namespace

std::unique_ptr<Session> dishonest_session(const std::string& text) {
  const TemporaryFile file(text);
  CompositionRequest request;
  request.file = file.path();
  Refusal refusal;
  auto session = prepare(request, dishonest_host(), refusal);
  REQUIRE_MESSAGE(session != nullptr, refusal_text(refusal));
  return session;
}

std::string Rod::text() const {
  const std::string stiffness = "\nbending-stiffness = \"1000 N mm^2\"\n";
  const std::string torsion = "torsional-stiffness = \"800 N mm^2\"\n";
  return "schema = 1\n[scene]\ndimension = " + std::to_string(dimension) + "\n[[wire]]\nname = \"rod\"\ngeometry = { " +
         geometry + ", nodes = " + std::to_string(nodes) + " }\nradius = \"0.1 mm\"\nkinematics = \"" + kinematics +
         "\"\nends = " + ends + "\n[[energy]]\nname = \"bending\"\ntype = \"" +
         (frames ? "vessel-strain" : "wire-bending") + "\"\non = \"rod\"" + stiffness + (frames ? torsion : "") + more +
         "\n[solver]\ntype = \"ipopt\"\n";
}

const CheckLine& line_of(const std::vector<CheckLine>& lines, const std::string& subject, const std::string& what) {
  for (const CheckLine& line : lines) {
    if (line.subject == subject && line.what == what) return line;
  }
  FAIL("no line on " << subject << ", " << what);
  return lines.front();
}

std::string remarks(const CheckReport& report) {
  std::string out;
  for (const auto* lines : {&report.derivatives, &report.invariances, &report.scaling, &report.modes}) {
    for (const CheckLine& line : *lines) {
      if (line.verdict == CheckVerdict::ok) continue;
      out += std::string(check_verdict_name(line.verdict)) + " " + line.subject + ", " + line.what + ": " + line.text +
             " " + line.where + "\n";
    }
  }
  return out;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace bowstring::testing
