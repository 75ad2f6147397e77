#pragma once

#include "core/interfaces/component.hpp"

namespace bowstring {

/// The declared defaults of a component that is used outside of a composition. A parameter that has none is left out.
ParameterSet default_parameters(const ComponentDescriptor& component);

}  // namespace bowstring
