#pragma once

#include <cstddef>

#include "core/interfaces/component.hpp"
#include "plugins/sdk/abi_tag.hpp"
#include "plugins/sdk/guard.hpp"

/// What a plugin library needs to offer its components. One line at the end of its source, at global scope:
///
///   BOWSTRING_PLUGIN(bowstring::component<bowstring::Energy, WireBending>(
///       bowstring::Kind::energy, "wire-bending", "Bending of a straight wire", schema))
///
/// with any number of components, separated by commas. `schema` is a constexpr array of ParameterDeclaration, left
/// out where there are no parameters. `WireBending` derives from Energy and is constructed from
/// `const ParameterSet&`; what its constructor throws becomes a status.

namespace bowstring {

class Constraint;
class Energy;
class Enforcement;
class Geometry;
class GroundCost;
class Integrator;
class Kinematics;
class Loss;
class Projection;
class Readout;
class Residual;
class Solver;
class Transport;
class Writer;

namespace plugin_detail {

template <class Interface>
struct KindOf;
template <>
struct KindOf<Geometry> {
  static constexpr Kind value = Kind::geometry;
};
template <>
struct KindOf<Kinematics> {
  static constexpr Kind value = Kind::kinematics;
};
template <>
struct KindOf<Energy> {
  static constexpr Kind value = Kind::energy;
};
template <>
struct KindOf<Constraint> {
  static constexpr Kind value = Kind::constraint;
};
template <>
struct KindOf<Enforcement> {
  static constexpr Kind value = Kind::enforcement;
};
template <>
struct KindOf<Solver> {
  static constexpr Kind value = Kind::solver;
};
template <>
struct KindOf<Integrator> {
  static constexpr Kind value = Kind::integrator;
};
template <>
struct KindOf<GroundCost> {
  static constexpr Kind value = Kind::ground_cost;
};
template <>
struct KindOf<Transport> {
  static constexpr Kind value = Kind::transport;
};
template <>
struct KindOf<Projection> {
  static constexpr Kind value = Kind::projection;
};
template <>
struct KindOf<Loss> {
  static constexpr Kind value = Kind::loss;
};
template <>
struct KindOf<Residual> {
  static constexpr Kind value = Kind::residual;
};
template <>
struct KindOf<Readout> {
  static constexpr Kind value = Kind::readout;
};
template <>
struct KindOf<Writer> {
  static constexpr Kind value = Kind::writer;
};

template <class Interface, class Implementation>
Status create(const ParameterSet& parameters, void** out) {
  return guard([&] { *out = static_cast<Interface*>(new Implementation(parameters)); });
}

template <class Interface>
void destroy(void* component) {
  delete static_cast<Interface*>(component);
}

template <class Interface, class Implementation>
constexpr ComponentDescriptor describe(Kind kind, const char* name, const char* description,
                                       const ParameterDeclaration* parameters, int parameter_count) {
  if (kind != KindOf<Interface>::value) throw "the component's kind is not that of its interface class";
  return {
      kind, name, description, parameters, parameter_count, &create<Interface, Implementation>, &destroy<Interface>};
}

}  // namespace plugin_detail

/// One entry of BOWSTRING_PLUGIN. A kind that does not belong to `Interface` does not compile.
template <class Interface, class Implementation, std::size_t count>
constexpr ComponentDescriptor component(Kind kind, const char* name, const char* description,
                                        const ParameterDeclaration (&parameters)[count]) {
  return plugin_detail::describe<Interface, Implementation>(kind, name, description, parameters,
                                                            static_cast<int>(count));
}

/// The same for a component without parameters.
template <class Interface, class Implementation>
constexpr ComponentDescriptor component(Kind kind, const char* name, const char* description) {
  return plugin_detail::describe<Interface, Implementation>(kind, name, description, nullptr, 0);
}

}  // namespace bowstring

/// Defines the one symbol that a plugin exports, and its ABI tag in a section of its own. The descriptor points to
/// that very section, so that no linker drops it.
#define BOWSTRING_PLUGIN(...)                                                                                          \
  namespace {                                                                                                          \
  [[gnu::section(".bowstring.abi"), gnu::used]] const bowstring::AbiTag bowstring_abi_tag = bowstring::make_abi_tag(); \
  constexpr bowstring::ComponentDescriptor bowstring_components[] = {__VA_ARGS__};                                     \
  }                                                                                                                    \
  extern "C" {                                                                                                         \
  [[gnu::visibility("default")]] extern const bowstring::PluginDescriptor bowstring_plugin;                            \
  const bowstring::PluginDescriptor bowstring_plugin = {                                                               \
      bowstring::plugin_magic,      static_cast<std::uint32_t>(sizeof(bowstring::PluginDescriptor)),                   \
      bowstring::interface_version, bowstring_abi_tag.text,                                                            \
      bowstring_components,         static_cast<int>(sizeof(bowstring_components) / sizeof(bowstring_components[0]))}; \
  }
