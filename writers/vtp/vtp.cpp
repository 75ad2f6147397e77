#include "core/interfaces/writer.hpp"
#include "core/result/write_file.hpp"
#include "plugins/sdk/plugin.hpp"
#include "writers/reading/result.hpp"
#include "writers/vtp/markup.hpp"
#include "writers/vtp/model.hpp"

namespace bowstring {
namespace {

/// State 2 for ParaView and 3D Slicer: centerlines, lumen and wire surfaces, contact forces.
class VtpWriter final : public Writer {
 public:
  explicit VtpWriter(const ParameterSet&) {}

  Status write(const char* document, const char* file) noexcept override {
    return guard([&] {
      const Result result = read_result(document);
      return write_file(file, vtp_text(result, build_model(result)));
    });
  }
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Writer, bowstring::VtpWriter>(
    bowstring::Kind::writer, "vtp", "VTK PolyData for ParaView and 3D Slicer: curves, surfaces and contact forces"))
