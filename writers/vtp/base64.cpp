#include "writers/vtp/base64.hpp"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

namespace bowstring {

std::string base64(const std::string& bytes) {
  using Iterator = boost::archive::iterators::base64_from_binary<
      boost::archive::iterators::transform_width<std::string::const_iterator, 6, 8>>;
  // The iterator reads whole groups of three bytes, past the end where there are fewer.
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  const std::string whole = bytes + std::string(padding, '\0');
  std::string out(Iterator(whole.begin()), Iterator(whole.end()));
  return out.replace(out.size() - padding, padding, padding, '=');
}

}  // namespace bowstring
