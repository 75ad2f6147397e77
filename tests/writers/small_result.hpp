#pragma once

#include <string>

namespace bowstring::testing {

/// A document as `bowstring solve --json` prints it, by hand: a straight vessel of three nodes that moves up by 2 mm in
/// its middle, and a wire with contacts of 1 N and 4 N. In space both leave the plane. The second contact's place on
/// the wire, wire_edge + t, is not that of its s_mm.
std::string small_result(int dimension);

/// The only occurrence of `word` replaced.
std::string edited_result(std::string text, const std::string& word, const std::string& by);

/// What a writer plugin of this build makes of a document: the file's content, or the text of its refusal.
struct Written {
  bool good = false;
  std::string text;
};
Written written(const std::string& writer, const std::string& document);

}  // namespace bowstring::testing
