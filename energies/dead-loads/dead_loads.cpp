#include <cstdio>
#include <string>
#include <vector>

#include "core/interfaces/energy.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration at_declaration = {
    .key = "at",
    .type = ParameterType::scalar,
    .unit = "mm",
    .default_text = "\"last\"",
    .description = "where: the first end, the last end, or an arc length of State 1",
    .lower = 0.0,
    .choices = "first|last",
};

constexpr ParameterDeclaration force_schema[] = {
    {.key = "force",
     .type = ParameterType::vector,
     .unit = "N",
     .default_text = nullptr,
     .description = "the force in global axes, one number per dimension of the scene; it keeps its direction",
     .differentiable = true},
    at_declaration,
};

constexpr ParameterDeclaration moment_schema[] = {
    {.key = "moment",
     .type = ParameterType::scalar,
     .unit = "N mm",
     .default_text = nullptr,
     .description = "the moment about the plane's normal, from x toward y",
     .differentiable = true},
    at_declaration,
};

/// W = −f·(x − x⁰): the work of a load that keeps its direction, at one place.
class DeadLaw final : public Law {
 public:
  std::vector<double> load;

  Status evaluate(const LawBatch& batch) const noexcept override {
    const int n = batch.dimension;
    for (int i = 0; i < batch.count; ++i) {
      double work = 0.0;
      for (int k = 0; k < n; ++k) {
        work += load[static_cast<std::size_t>(k)] * (batch.x[i * n + k] - batch.reference[i * n + k]);
        if (batch.stress != nullptr) batch.stress[i * n + k] = -load[static_cast<std::size_t>(k)];
      }
      if (batch.energy != nullptr) batch.energy[i] = -work;
      for (int k = 0; batch.modulus != nullptr && k < packed_size(n); ++k) batch.modulus[i * packed_size(n) + k] = 0.0;
    }
    return {};
  }
};

/// Place along a curve: on its `edge`, at `t` of it.
struct Station {
  int edge = 0;
  double t = 0.0;
  bool at_end = false;
  int end = 0;
};

Station station_of(const ParameterValue& at, const CurveView& curve) {
  Station out;
  out.at_end = !at.text.empty();
  if (out.at_end) {
    out.end = at.text == "last" ? 1 : 0;
    out.edge = out.end == 0 ? 0 : curve.nodes - 2;
    out.t = out.end;
    return out;
  }
  const double length = curve.arc[curve.nodes - 1];
  if (at.number > length) {
    char text[120];
    std::snprintf(text, sizeof text, "'at' is %.6g mm; expected at most the %.6g mm", at.number, length);
    throw StatusError(Code::invalid_input, text + (" that '" + std::string(curve.name)) + "' is long in State 1");
  }
  if (curve.extension == Extension::sliding) {
    throw StatusError(Code::unsupported, "'at' is an arc length of '" + std::string(curve.name) +
                                             "', whose material slides; use \"first\" or \"last\", or a wire of fixed "
                                             "length");
  }
  while (out.edge < curve.nodes - 2 && curve.arc[out.edge + 1] < at.number) ++out.edge;
  out.t = (at.number - curve.arc[out.edge]) / (curve.arc[out.edge + 1] - curve.arc[out.edge]);
  return out;
}

LawDescription dead_law(Site site) {
  LawDescription out;
  out.site = site;
  out.weighing = Weighing::per_place;
  out.linear = true;
  out.objective = false;
  return out;
}

/// A dead force on a node, or shared by the two nodes of an edge as its lever arms say.
class PointLoad final : public Energy {
 public:
  explicit PointLoad(const ParameterSet& parameters) : at_(parameters.at("at")) {
    law_.load = parameters.at("force").vector;
  }

  Status declare(const CurveView& curve, EnergyDeclaration& out) noexcept override {
    return guard([&] {
      if (static_cast<int>(law_.load.size()) != curve.dimension) {
        throw StatusError(Code::invalid_input, "'force' has " + std::to_string(law_.load.size()) +
                                                   " entries; expected one per dimension of the scene, " +
                                                   std::to_string(curve.dimension));
      }
      const Station station = station_of(at_, curve);
      LawDescription description = dead_law(Site::node);
      if (station.t == 0.0 || station.t == 1.0) {
        description.places = {station.edge + (station.t == 1.0 ? 1 : 0)};
        description.weight = {1.0};
      } else {
        description.places = {station.edge, station.edge + 1};
        description.weight = {1.0 - station.t, station.t};
      }
      out.laws = {&law_};
      out.descriptions = {description};
      warn_where_held(curve, station, out);
    });
  }

 private:
  void warn_where_held(const CurveView& curve, const Station& station, EnergyDeclaration& out) const {
    if (!station.at_end) return;
    const bool* held = curve.end[station.end].position_held;
    for (int k = 0; k < curve.dimension; ++k) {
      if (!held[k] || law_.load[static_cast<std::size_t>(k)] == 0.0) continue;
      out.warnings.push_back("point-load acts on the " + std::string(station.end == 0 ? "first" : "last") +
                             " end of '" + curve.name + "', whose position is held: the support takes it");
      return;
    }
  }

  ParameterValue at_;
  DeadLaw law_;
};

/// A dead moment in the plane, on the edge that holds the place. In space no potential gives a moment of fixed axis.
class DeadMoment final : public Energy {
 public:
  explicit DeadMoment(const ParameterSet& parameters) : at_(parameters.at("at")) {
    law_.load = {parameters.scalar("moment")};
  }

  Status declare(const CurveView& curve, EnergyDeclaration& out) noexcept override {
    return guard([&] {
      if (curve.dimension != 2) {
        throw StatusError(Code::unsupported,
                          "a dead moment has no energy in space, where rotations about a fixed axis do not commute; "
                          "turn an end by its frame, or set dimension = 2");
      }
      LawDescription description = dead_law(Site::frame);
      description.places = {station_of(at_, curve).edge};
      description.weight = {1.0};
      out.laws = {&law_};
      out.descriptions = {description};
    });
  }

 private:
  ParameterValue at_;
  DeadLaw law_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Energy, bowstring::PointLoad>(
                     bowstring::Kind::energy, "point-load", "A dead force at an end or an arc length of a curve: −F·u",
                     bowstring::force_schema),
                 bowstring::component<bowstring::Energy, bowstring::DeadMoment>(
                     bowstring::Kind::energy, "dead-moment",
                     "A dead moment at an end or an arc length of a curve in the plane: −M Δθ",
                     bowstring::moment_schema))
