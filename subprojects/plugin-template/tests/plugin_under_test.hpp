#pragma once

#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <utility>

#include "core/interfaces/component.hpp"

extern "C" {
extern const bowstring::PluginDescriptor bowstring_plugin;
}

namespace bowstring::testing {

inline ParameterValue& add(ParameterSet& set, const std::string& key) {
  set.values.emplace_back();
  set.values.back().key = key;
  return set.values.back();
}

/// The first component of this program's plugin, by way of its descriptor.
template <class Interface>
std::unique_ptr<Interface> make(const ParameterSet& parameters) {
  REQUIRE(bowstring_plugin.component_count == 1);
  void* component = nullptr;
  const Status status = bowstring_plugin.components[0].create(parameters, &component);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return std::unique_ptr<Interface>(static_cast<Interface*>(component));
}

}  // namespace bowstring::testing
