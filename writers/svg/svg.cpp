#include <optional>

#include "core/interfaces/writer.hpp"
#include "core/result/write_file.hpp"
#include "plugins/sdk/plugin.hpp"
#include "writers/reading/result.hpp"
#include "writers/reading/transport.hpp"
#include "writers/svg/figure.hpp"

namespace bowstring {
namespace {

/// Of a result State 1, State 2, wires, lumen walls and contacts at one scale, a scene in space in two orthogonal
/// views; of a comparison both measures and the plan between them.
class SvgWriter final : public Writer {
 public:
  explicit SvgWriter(const ParameterSet&) {}

  Status write(const char* document, const char* file) noexcept override {
    return guard([&] {
      const std::optional<TransportPicture> compared = read_transport(document);
      return write_file(file, compared ? svg_figure(*compared) : svg_figure(read_result(document)));
    });
  }
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Writer, bowstring::SvgWriter>(
    bowstring::Kind::writer, "svg", "A figure of both states with the forces on the wall, or of a transport plan"))
