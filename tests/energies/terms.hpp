#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

inline const EnergyUse& energy_of(const Session& session, const std::string& label) {
  for (const EnergyUse& use : session.scene->energies) {
    if (use.label == label) return use;
  }
  FAIL("the scene has no energy '" << label << "'");
  return session.scene->energies.front();
}

inline std::vector<double> term_energies(const Session& session, const std::vector<double>& q) {
  std::vector<double> out;
  const Status status = session.assembly->term_energies(q, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

}  // namespace bowstring::testing
