#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// The tree of a TOML text. A syntax error, of which TOML's parser sees the first only, goes into the report.
std::optional<Node> read_toml(std::string_view text, const std::shared_ptr<const Source>& source, Report& report);

/// One TOML value; text where it is not TOML. Everything in it has the position `position`.
Node read_value_or_text(const std::string& text, const Position& position);

/// A value as TOML on one line, which reads as the same value.
std::string toml_value(const Node& node);

}  // namespace bowstring
