#pragma once

#include <string>
#include <vector>

#include "core/interfaces/component.hpp"
#include "core/interfaces/status.hpp"
#include "plugins/host/sidecar.hpp"

namespace bowstring {

/// The ABI tag of this process.
std::string host_abi_tag();

/// `failed`, with both tags and what to do, where `tag` (found in `where`) is not the host's.
Status check_abi(const std::string& library, const std::string& tag, const std::string& where);

/// Whether the library's file is a plugin of this ABI. Does not open it.
Status check_library_file(const std::string& library);

/// Opens the library, with all its symbols bound now and none of them visible to others, and checks the descriptor
/// that it exports. It stays open for the rest of the process. Call `check_library_file` first: opening runs code.
Status open_library(const std::string& library, const PluginDescriptor** out);

/// What an open plugin offers.
std::vector<OfferedComponent> offered_components(const PluginDescriptor& plugin);

}  // namespace bowstring
