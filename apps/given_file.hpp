#pragma once

#include <string>

#include "core/result/recorded_result.hpp"
#include "core/session/refusal.hpp"

namespace bowstring::apps {

/// Reads a file that was named on the command line, out of gzip where it is in it. What cannot be read is reported on
/// stderr, or put into the refusal, and the answer is false.
bool read_given_file(const std::string& file, std::string& text);
bool read_given_file(const std::string& file, std::string& text, Refusal& refusal);

/// Reads a result document out of such a text. What is wrong with it is reported on stderr, and the answer is false.
bool read_given_result(const std::string& file, std::string text, RecordedResult& out);

}  // namespace bowstring::apps
