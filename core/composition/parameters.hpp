#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "core/interfaces/parameter.hpp"
#include "core/interfaces/span.hpp"
#include "core/interfaces/status.hpp"

namespace bowstring {

/// The table whose keys are read against a schema.
struct SchemaOwner {
  std::string name;                     ///< "energy 'anchoring'", for messages
  std::string help;                     ///< what to do about a key that is like no other
  std::vector<std::string> structural;  ///< keys of the composition itself, which come before the schema's
  std::vector<std::string> later;       ///< keys of the format that this version does not take yet
};

/// Reads the parameters that a schema declares, fills in the defaults, and reports what is unknown, missing or wrong.
/// A declared default that its own schema refuses makes `schema_fault` `failed`: that is the plugin's mistake.
ParameterSet read_parameters(const Node& table, const SchemaOwner& owner, Span<const ParameterDeclaration> schema,
                             Status& schema_fault, Report& report);

/// One value against its declaration; empty where the report has got an error.
std::optional<ParameterValue> read_parameter(const Node& node, const ParameterDeclaration& declaration,
                                             const SchemaOwner& owner, Status& schema_fault, Report& report);

}  // namespace bowstring
