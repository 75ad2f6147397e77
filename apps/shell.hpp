#pragma once

#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "core/session/session.hpp"
#include "plugins/host/plugin_host.hpp"

namespace bowstring::apps {

/// The host for a composition: --plugin-path, the composition's own, the environment, the running binary's.
PluginHost make_host(const CommonOptions& common, const std::string& composition_file);
/// The same for several compositions.
PluginHost make_host(const CommonOptions& common, const std::vector<std::string>& composition_files);

/// "path=value" pairs; what lacks the equals sign is reported on stderr.
bool parse_overrides(const std::vector<std::string>& set, std::vector<Override>& out);

/// Prints a refusal on stderr and returns its exit code.
int report(const Refusal& refusal);

/// "error: " and the text on stderr.
void complain(const std::string& text);

/// "12.34" with so many significant digits.
std::string number(double value, int digits = 5);

/// "1 row", "2 rows".
std::string counted(int count, const std::string& singular);

}  // namespace bowstring::apps
