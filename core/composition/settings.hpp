#pragma once

#include "core/composition/components.hpp"
#include "core/composition/composition.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

/// [scene] dimension, which has no default; 0 where the report has got an error.
int read_dimension(const Node& root, Report& report);

std::string read_title(const Node& root, Report& report);

/// [enforcement] and [solver]: a plugin, or the default where the table or its `type` is left out.
ComponentChoice read_enforcement(const Node& root, Reading& reading);
ComponentChoice read_solver(const Node& root, Reading& reading);

CertificateTable read_certificate(const Node& root, Report& report);
/// What [certificate] takes.
Span<const ParameterDeclaration> certificate_schema();

}  // namespace bowstring
