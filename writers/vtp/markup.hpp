#pragma once

#include <string>

#include "writers/vtp/model.hpp"

namespace bowstring {

/// The text of a VTK XML PolyData file, version 1.0: one piece, arrays inline in base64 behind a 64-bit byte count, in
/// this machine's byte order, which the file names. Arrays of data that no point has are left out. `result` gives what
/// stands in the field data: title, status and the axes.
std::string vtp_text(const Result& result, const Model& model);

}  // namespace bowstring
