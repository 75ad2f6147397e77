#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/result/provenance.hpp"

namespace bowstring::study {

/// Tells runs apart by all that their numbers come from, and by nothing else: the resolved composition, the content of
/// the files of data that it names, the kernel, the plugins that it names, and the run whose result it starts from.
/// Where any of these stand on the machine makes no difference.
class Identity {
 public:
  /// 64 hexadecimal digits. `states`: the composition as it is read for each of its [[step]]s, the first one telling
  /// what changes in the others; `provenance`: of all of them. `predecessor`: the identity of the run that it starts
  /// from, or "".
  std::string of(const std::vector<Composition>& states, const Provenance& provenance, const std::string& predecessor);

 private:
  const std::string& content(const std::string& file);

  std::map<std::string, std::string> content_;  ///< sha256 of files, each read once
};

}  // namespace bowstring::study
