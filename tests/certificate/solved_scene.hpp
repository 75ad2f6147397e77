#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/certificate/certificate.hpp"
#include "core/session/session.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

/// A session with its solution.
struct SolvedScene {
  std::unique_ptr<Session> session;
  Solution solution;
  Assembly& assembly() const { return *session->assembly; }
};

/// A tensioned wire that a wall holds in a bend: an S in the plane, part of a helix in space.
SmallScene contact_scene(int dimension, const char* vessel_kinematics = "edge-frames",
                         const char* wire_kinematics = "edge-frames");

/// Its text with the solver's own window and these keys of the solver.
std::string contact_text(const SmallScene& scene, const std::string& solver_keys = "tolerance = 1e-9");

SolvedScene solved(std::unique_ptr<Session> session);

/// Thresholds that every finite state meets.
CertificateTable no_thresholds();

Certificate certified(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& multipliers,
                      const CertificateTable& thresholds, Claim claim = Claim::optimal,
                      const std::string& reason = "the solver said so");

/// The row numbers of the scene's only constraint.
RowOrigin contact_rows(const Assembly& assembly);

}  // namespace bowstring::testing
