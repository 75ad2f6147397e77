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
/// Where that host looks, of a composition that is in no file.
PluginHostOptions host_options(const CommonOptions& common, const CompositionRequest& request);

/// "path=value" pairs; what lacks the equals sign is reported on stderr.
bool parse_overrides(const std::vector<std::string>& set, std::vector<Override>& out);

/// Prints a refusal on stderr and returns its exit code.
int report(const Refusal& refusal);

/// "error: " and the text on stderr.
void complain(const std::string& text);

/// "12.34" with so many significant digits.
std::string number(double value, int digits = 5);

/// Characters on a terminal.
int width(const std::string& text);

/// The text with spaces behind it, or before it, up to a width.
std::string padded(const std::string& text, int columns);
std::string padded_left(const std::string& text, int columns);

/// Flushes what was printed; says so, and returns the exit code of it, where it could not be. Else `code`.
int flushed(int code);

}  // namespace bowstring::apps
