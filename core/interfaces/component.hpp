#pragma once

#include <cstdint>

#include "core/interfaces/parameter.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// Grows whenever a header of core/interfaces changes in a way that a built plugin would notice.
inline constexpr std::uint32_t interface_version = 5;
inline constexpr std::uint32_t plugin_magic = 0x424f5753;  // "BOWS"

/// The extension points. The names in compositions and on the command line are those of `kind_name`.
enum class Kind : int {
  geometry,
  kinematics,
  energy,
  constraint,
  enforcement,
  solver,
  integrator,
  ground_cost,
  transport,
  projection,
  loss,
  residual,
  readout,
  writer
};
inline constexpr int kind_count = 14;

/// "geometry", "ground-cost", …
const char* kind_name(Kind kind) noexcept;

/// Creates the component: on success `*out` is a pointer to the interface class of the component's kind (Energy*,
/// Solver*, …), owned by the caller, who gives it back to `destroy`. May answer `invalid_input`.
using Factory = Status (*)(const ParameterSet& parameters, void** out);
using Destructor = void (*)(void* component);

struct ComponentDescriptor {
  Kind kind;
  const char* name;         ///< lower-case, hyphenated
  const char* description;  ///< one sentence
  const ParameterDeclaration* parameters;
  int parameter_count;
  Factory create;
  Destructor destroy;
};

/// The one thing that a plugin library exports, under the C name `bowstring_plugin`.
struct PluginDescriptor {
  std::uint32_t magic;
  std::uint32_t size;  ///< sizeof(PluginDescriptor)
  std::uint32_t interface_version;
  const char* abi_tag;
  const ComponentDescriptor* components;
  int component_count;
};

inline constexpr const char* plugin_symbol = "bowstring_plugin";

}  // namespace bowstring
