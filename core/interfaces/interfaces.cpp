#include <stdexcept>

#include "core/interfaces/place.hpp"
#include "core/interfaces/component.hpp"
#include "core/interfaces/parameter.hpp"

namespace bowstring {

const char* kind_name(Kind kind) noexcept {
  switch (kind) {
    case Kind::geometry:
      return "geometry";
    case Kind::kinematics:
      return "kinematics";
    case Kind::energy:
      return "energy";
    case Kind::constraint:
      return "constraint";
    case Kind::enforcement:
      return "enforcement";
    case Kind::solver:
      return "solver";
    case Kind::integrator:
      return "integrator";
    case Kind::ground_cost:
      return "ground-cost";
    case Kind::transport:
      return "transport";
    case Kind::projection:
      return "projection";
    case Kind::loss:
      return "loss";
    case Kind::residual:
      return "residual";
    case Kind::readout:
      return "readout";
    case Kind::writer:
      return "writer";
  }
  return "unknown kind";
}

const ParameterValue* ParameterSet::find(const std::string& key) const noexcept {
  for (const ParameterValue& value : values) {
    if (value.key == key) return &value;
  }
  return nullptr;
}

const ParameterValue& ParameterSet::at(const std::string& key) const {
  if (const ParameterValue* value = find(key)) return *value;
  throw std::out_of_range("parameter '" + key +
                          "' has no value: the component's schema does not declare it, or "
                          "declares it optional and the composition leaves it out");
}

const char* site_name(Site site) noexcept {
  switch (site) {
    case Site::node:
      return "node";
    case Site::station:
      return "station";
    case Site::edge:
      return "edge";
    case Site::frame:
      return "frame";
    case Site::length:
      return "length";
    case Site::field:
      return "field";
    case Site::closure:
      break;
  }
  return "closure row";
}

}  // namespace bowstring
