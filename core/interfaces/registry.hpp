#pragma once

#include <string>
#include <vector>

#include "core/interfaces/component.hpp"

namespace bowstring {

/// Where a component comes from, for the provenance of a result.
struct ComponentOrigin {
  std::string file;    ///< the library
  std::string sha256;  ///< of that file
  std::string abi_tag;
};

/// What the kernel knows of plugins: names first, components on demand. The plugin host implements it; the kernel
/// opens no library itself. Every member may be called from several threads at once.
class Registry {
 public:
  virtual ~Registry() = default;
  /// Every name that some library offers for the kind, sorted, without opening any.
  virtual std::vector<std::string> names(Kind kind) const = 0;
  /// Opens the library when it is not open yet. Null with `status` set: `invalid_input` where nobody offers the name,
  /// `failed` where the library could not be loaded or used.
  virtual const ComponentDescriptor* find(Kind kind, const std::string& name, Status& status) = 0;
  virtual ComponentOrigin origin(Kind kind, const std::string& name) const = 0;
};

}  // namespace bowstring
