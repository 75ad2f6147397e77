#pragma once

#include <string>
#include <vector>

#include "core/composition/components.hpp"
#include "core/composition/composition.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// The names that `on` and `vessel` can refer to.
struct CurveNames {
  std::vector<std::string> vessels, wires;
  bool complete = true;  ///< false: a curve's name could not be read, so that a reference may be right after all

  std::vector<std::string> all() const;
};

CurveNames curve_names(const Node& root);

VesselTable read_vessel(const Node& table, Reading& reading);
WireTable read_wire(const Node& table, const CurveNames& names, Reading& reading);

/// Reports a reference to a curve that is not among `candidates`, where `kind` says what they are ("vessel").
/// `subject` is "'vessel' of wire 'lunderquist'".
void check_reference(const Node& reference, const std::string& subject, const std::string& kind,
                     const std::vector<std::string>& candidates, const CurveNames& names, Report& report);

/// Names stand in paths and in --set: they have no dot, no '=' and no control characters.
void check_name(const Node& table, const std::string& owner, Report& report);

}  // namespace bowstring
