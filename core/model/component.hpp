#pragma once

#include <exception>
#include <memory>
#include <string>

#include "core/composition/composition.hpp"
#include "core/interfaces/component.hpp"

namespace bowstring {

/// A component made by a plugin's factory; its destructor is the plugin's.
template <class Interface>
using Owned = std::unique_ptr<Interface, Destructor>;

/// Runs the factory of a choice. On failure the pointer is null and `status` says why, naming the plugin; an
/// exception that a factory lets through becomes `failed`.
template <class Interface>
Owned<Interface> create(const ComponentChoice& choice, Status& status) {
  void* made = nullptr;
  try {
    status = choice.descriptor->create(choice.parameters, &made);
  } catch (const std::exception& error) {
    status = Status::failure(Code::failed, std::string("its factory threw: ") + error.what());
  } catch (...) {
    status = Status::failure(Code::failed, "its factory threw something that is no std::exception");
  }
  if (status.ok() && made == nullptr) status = Status::failure(Code::failed, "its factory returned nothing");
  if (!status.ok()) {
    status.text = std::string(kind_name(choice.kind)) + " '" + choice.name + "': " + status.text;
    made = nullptr;
  }
  return Owned<Interface>(static_cast<Interface*>(made), choice.descriptor->destroy);
}

}  // namespace bowstring
