#include "core/session/refusal.hpp"

namespace bowstring {

std::string Refusal::text() const {
  std::string out;
  for (const InputError& error : errors) out += (out.empty() ? "" : "\n") + error.text();
  if (!plugin_failure.ok()) out += (out.empty() ? "" : "\n") + plugin_failure.text;
  return out;
}

}  // namespace bowstring
