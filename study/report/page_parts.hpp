#pragma once

#include <string_view>

namespace bowstring::study {

// The page, joined by join_page.py when Bowstring is built: what stands before the report's JSON, and what follows it.
extern const std::string_view page_head;
extern const std::string_view page_tail;

}  // namespace bowstring::study
