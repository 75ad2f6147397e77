#include "apps/given_file.hpp"

#include <utility>

#include "apps/shell.hpp"
#include "core/composition/read_file.hpp"
#include "study/store/gzip.hpp"

namespace bowstring::apps {

bool read_given_file(const std::string& file, std::string& text, Refusal& refusal) {
  std::string why = read_file(file, text);
  if (why.empty() && study::is_gzip(text)) {
    const std::string bytes = std::move(text);
    why = study::gunzip(bytes, text);
  }
  if (why.empty()) return true;
  refusal.errors.push_back({file, "cannot be read (" + why + ")", "a file, plain or in gzip", "check the path"});
  return false;
}

bool read_given_file(const std::string& file, std::string& text) {
  Refusal refusal;
  if (read_given_file(file, text, refusal)) return true;
  report(refusal);
  return false;
}

bool read_given_result(const std::string& file, std::string text, RecordedResult& out) {
  std::vector<DocumentFlaw> flaws;
  out = read_result(std::move(text), "the document", flaws);
  Refusal refusal;
  for (const DocumentFlaw& flaw : flaws) refusal.errors.push_back({file, flaw.found, flaw.expected, flaw.mend});
  report(refusal);
  return flaws.empty();
}

}  // namespace bowstring::apps
