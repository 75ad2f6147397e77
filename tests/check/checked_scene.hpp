#pragma once

#include <string>
#include <vector>

#include "core/check/check.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

/// A composition with the plugins of the fixture `dishonest` within reach.
std::unique_ptr<Session> dishonest_session(const std::string& text);

/// A single wire, "rod", with a bending stiffness; further tables follow.
struct Rod {
  int dimension = 2, nodes = 9;
  std::string geometry = R"(type = "line", length = "80 mm")";
  std::string kinematics = "nodes";
  std::string ends = R"(["free", "free"])";
  bool frames = false;  ///< a torsional stiffness, in space
  std::string more;

  std::string text() const;
};

/// The line of a subject and a thing that was judged; there has to be one.
const CheckLine& line_of(const std::vector<CheckLine>& lines, const std::string& subject, const std::string& what);

/// Lines that are not `ok`, for messages.
std::string remarks(const CheckReport& report);

bool contains(const std::string& text, const std::string& part);

}  // namespace bowstring::testing
