#include "core/composition/defaults.hpp"

#include "core/composition/parameters.hpp"

namespace bowstring {

ParameterSet default_parameters(const ComponentDescriptor& component) {
  const Node nothing;
  Report report;
  Status fault;
  const SchemaOwner owner{std::string(kind_name(component.kind)) + " '" + component.name + "'", "", {}, {}};
  return read_parameters(nothing, owner, {component.parameters, static_cast<std::size_t>(component.parameter_count)},
                         fault, report);
}

}  // namespace bowstring
