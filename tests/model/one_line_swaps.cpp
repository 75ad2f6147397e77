#include <doctest/doctest.h>

#include <sstream>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

struct Axis {
  std::string path;
  std::vector<std::string> values;  ///< TOML
};

std::vector<Axis> axes(const std::string& per_length, const std::string& per_node) {
  const std::vector<std::string> kinematics = {"\"nodes\"", "\"edge-frames\""};
  return {{"constraint.lumen.type",
           {"\"same-index-contact\"", "\"node-wise-contact\"", "\"segment-wise-contact\"", "\"concentric\""}},
          {"constraint.lumen.centerline", {"\"spline\"", "\"polyline\""}},
          {"energy.anchoring.stiffness", {"\"" + per_length + "\"", "\"" + per_node + "\""}},
          {"vessel.iliac.kinematics", kinematics},
          {"wire.lunderquist.kinematics", kinematics}};
}

/// A variant of a shipped scene with one line per axis.
std::string variant(const std::string& base, const std::vector<Axis>& all, const std::vector<std::size_t>& choice) {
  std::string text = "schema = 1\nbase = \"" + base + "\"\n[set]\n";
  for (std::size_t a = 0; a < all.size(); ++a) text += '"' + all[a].path + "\" = " + all[a].values[choice[a]] + '\n';
  return text;
}

int different_lines(const std::string& a, const std::string& b) {
  std::istringstream first(a), second(b);
  std::string left, right;
  int count = 0;
  while (std::getline(first, left)) {
    REQUIRE(std::getline(second, right));
    count += left != right;
  }
  return count;
}

}  // namespace

TEST_CASE("contact, wall, springs and kinematics are swapped by one line each, and every combination is composed") {
  const std::string scenes = std::string(std::getenv("BOWSTRING_SOURCE_ROOT")) + "/scenes/";
  for (const auto& [scene, per_length, per_node] :
       {std::tuple{"planar-iliac-smooth.toml", "0.012801 N/mm^2", "0.03 N/mm"},
        std::tuple{"helical-iliac-full.toml", "0.023314 N/mm^2", "0.07 N/mm"}}) {
    const std::vector<Axis> all = axes(per_length, per_node);
    std::vector<std::size_t> choice(all.size(), 0);
    const std::string start = variant(scenes + scene, all, choice);
    int composed = 0;
    for (std::size_t a = 0; a < all.size(); ++a) {
      for (std::size_t v = 1; v < all[a].values.size(); ++v) {
        choice[a] = v;
        CHECK(different_lines(start, variant(scenes + scene, all, choice)) == 1);
        choice[a] = 0;
      }
    }
    for (bool more = true; more;) {
      const auto session = session_of_text(variant(scenes + scene, all, choice));
      CHECK('"' + session->scene->constraints[0].plugin + '"' == all[0].values[choice[0]]);
      CHECK('"' + session->scene->find("iliac")->kinematics_name + '"' == all[3].values[choice[3]]);
      ++composed;
      more = false;
      for (std::size_t a = 0; a < all.size() && !more; ++a) {
        choice[a] = (choice[a] + 1) % all[a].values.size();
        more = choice[a] != 0;
      }
    }
    CHECK(composed == 64);
  }
}

}  // namespace bowstring::testing
