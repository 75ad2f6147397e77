#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/session/session.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::testing {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A wire in a vessel, small enough for dense differences. Texts are TOML.
struct SmallScene {
  int dimension = 2;
  std::string geometry;  ///< "" : a gentle S in the plane, part of a helix in space
  std::string radius = R"({ table = [["0 mm", "3 mm"], ["20 mm", "4 mm"], ["60 mm", "3.5 mm"]] })";
  int wire_nodes = 7;  ///< of a vessel with 8
  std::string vessel_kinematics = "edge-frames", wire_kinematics = "edge-frames";
  std::string vessel_ends = R"(["pinned", "pinned"])", wire_ends = R"(["pinned", "pinned"])";
  std::string contact_type = "node-wise-contact";
  std::string contact = R"(centerline = "spline")";  ///< keys of the constraint; "": no constraint
  bool vessel_frames = false, wire_frames = false;   ///< torsional stiffness, in space
  bool tension = true;

  std::string text() const;
};

/// The plugins of this build, opened once per process.
PluginHost& plugin_host();

/// Texts of everything that a refusal holds.
std::string refusal_text(const Refusal& refusal);

/// The text with its first `word` replaced.
std::string edited(std::string text, const std::string& word, const std::string& by);

/// Prepares a composition that has to be right, with a window that no row leaves.
std::unique_ptr<Session> session_of(const SmallScene& scene);
std::unique_ptr<Session> session_of_text(const std::string& text, const CarriedState* carried = nullptr);
/// What is said of a composition that has to be wrong.
std::string refusal_of(const std::string& text, const CarriedState* carried = nullptr);
/// The same for a file of the project's `scenes` folder.
std::unique_ptr<Session> session_of_file(const std::string& name, const std::vector<Override>& overrides = {});

/// The same with more nodes, and with rows that cover one segment on each side of their closest point: they leave it.
std::unique_ptr<Session> narrow_session(SmallScene scene);

std::vector<double> random_numbers(int count, unsigned seed);
double largest(const std::vector<double>& numbers);
double largest_difference(const std::vector<double>& a, const std::vector<double>& b);

/// A state: q of the start moved by tangent numbers in ±amplitude: mm on positions, tenths of a radian per mm on
/// rotations, a tenth of a mm per mm on lengths.
std::vector<double> moved_start(const Session& session, double amplitude, unsigned seed);

/// The start with the wire's inner nodes moved along by a share of its edges.
std::vector<double> slid(const Session& session, double share);

}  // namespace bowstring::testing
