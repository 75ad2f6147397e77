#include "apps/shell.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace bowstring::apps {

namespace {

PluginHostOptions host_options(const CommonOptions& common, std::vector<std::string> composition_path) {
  PluginHostOptions options = plugin_search(std::move(composition_path));
  options.command_line_path = common.plugin_path;
  return options;
}

}  // namespace

PluginHostOptions host_options(const CommonOptions& common, const CompositionRequest& request) {
  return host_options(common, composition_plugin_path(request));
}

PluginHost make_host(const CommonOptions& common, const std::string& composition_file) {
  return make_host(common, std::vector<std::string>{composition_file});
}

PluginHost make_host(const CommonOptions& common, const std::vector<std::string>& composition_files) {
  std::vector<std::string> path;
  for (const std::string& file : composition_files) {
    if (file.empty()) continue;
    for (std::string& folder : composition_plugin_path({file, {}})) path.push_back(std::move(folder));
  }
  return PluginHost(host_options(common, std::move(path)));
}

bool parse_overrides(const std::vector<std::string>& set, std::vector<Override>& out) {
  bool good = true;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      complain("--set " + text + ": found no path=value; expected for instance --set solver.tolerance=1e-9");
      good = false;
      continue;
    }
    out.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return good;
}

int report(const Refusal& refusal) {
  for (const InputError& error : refusal.errors) std::fprintf(stderr, "%s\n", error.text().c_str());
  if (!refusal.plugin_failure.ok()) complain(refusal.plugin_failure.text);
  return static_cast<int>(refusal.kind());
}

void complain(const std::string& text) { std::fprintf(stderr, "error: %s\n", text.c_str()); }

std::string number(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

int width(const std::string& text) {
  constexpr unsigned continued = 0x80U, mask = 0xC0U;  // UTF-8: bytes that begin no character
  return static_cast<int>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned>(c) & mask) != continued; }));
}

std::string padded(const std::string& text, int columns) {
  return text + std::string(static_cast<std::size_t>(std::max(0, columns - width(text))), ' ');
}

std::string padded_left(const std::string& text, int columns) {
  return std::string(static_cast<std::size_t>(std::max(0, columns - width(text))), ' ') + text;
}

int flushed(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  complain("stdout cannot be written");
  return exit_fell_short;
}

}  // namespace bowstring::apps
