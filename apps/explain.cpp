#include <cstdio>
#include <set>

#include "apps/shell.hpp"
#include "core/composition/nearest.hpp"
#include "core/model/manifold.hpp"
#include "core/procedure/procedure.hpp"

namespace bowstring::apps {

namespace {

const char* manifold_text(Manifold manifold) {
  switch (manifold) {
    case Manifold::real:
      return "number";
    case Manifold::vector:
      return "vector";
    case Manifold::circle:
      return "angle (S1)";
    case Manifold::direction:
      return "direction (S2)";
    case Manifold::rotation:
      break;
  }
  return "rotation (SO3)";
}

const char* extension_text(const CurveView& curve) {
  if (curve.rigid) return "rigid: no unknowns";
  switch (curve.extension) {
    case Extension::sliding:
      return "length slides through the sheath: one unknown L";
    case Extension::fixed:
      return "every edge keeps its length";
    case Extension::stretching:
      break;
  }
  return "every edge has its own length";
}

void explain_curve(const Curve& curve) {
  std::printf("%s '%s': %d nodes, %.6g mm, ends %s and %s; %s\n",
              curve.view.kind == CurveKind::wire ? "wire" : "vessel", curve.name.c_str(), curve.view.nodes,
              curve.arc.back(), curve.end_text[0].c_str(), curve.end_text[1].c_str(), extension_text(curve.view));
  std::printf("  kinematics %s%s\n", curve.kinematics_name.c_str(),
              curve.needs.material_frames ? (", with material frames because " + curve.needs.reason).c_str() : "");
  for (const FieldDeclaration& field : curve.declaration.fields) {
    const int tangents = field.count * tangent_count(field.manifold, field.dimension);
    int free = 0;
    for (int u = 0; u < tangents; ++u) {
      free += field.fixed.empty() || field.fixed[static_cast<std::size_t>(u)] == 0;
    }
    std::printf("    field %-14s %5d × %-14s %6d unknown, %d fixed: %s\n", field.name.c_str(), field.count,
                manifold_text(field.manifold), free, tangents - free, field.reason.c_str());
  }
}

void explain_losses(const Composition& composition) {
  if (composition.losses.empty()) return;
  std::printf("losses, evaluated on the solution\n");
  for (const LossTable& loss : composition.losses) {
    const std::string places =
        loss.sampling.points > 0 ? counted(loss.sampling.points, "place") + ", resampled" : "its nodes";
    std::printf("  %-24s %s with %s between '%s' (%s, weights %s%s) and '%s'\n", loss.label.c_str(),
                loss.transport.name.c_str(), loss.ground_cost.name.c_str(), loss.on.c_str(), places.c_str(),
                curve_weights_name(loss.sampling.weights),
                loss.sampling.stations.empty()
                    ? ""
                    : (", " + counted(static_cast<int>(loss.sampling.stations.size()), "station")).c_str(),
                loss.against.c_str());
  }
}

void explain_plugins(const Session& session, const Registry& registry) {
  std::set<std::string> lines;
  for (const ComponentChoice* choice : components_of(session.composition)) {
    lines.insert(std::string(kind_name(choice->kind)) + "/" + choice->name + "  " +
                 registry.origin(choice->kind, choice->name).file);
  }
  std::printf("plugins opened, and no others\n");
  for (const std::string& line : lines) std::printf("  %s\n", line.c_str());
}

void explain_procedure(const Composition& composition) {
  const ContinuationTable& walk = composition.continuation;
  if (walk.given) {
    std::printf("walks '%s' from %s to %s%s\n", walk.path.c_str(), walk.range.text(0.0).c_str(),
                walk.range.text(1.0).c_str(),
                walk.fallback ? ", where the solve from the start does not converge" : "");
  }
  if (composition.multistart.given) {
    std::printf("solved from %s, perturbed with seed %ld\n",
                counted(static_cast<int>(composition.multistart.starts), "start").c_str(), composition.multistart.seed);
  }
  for (std::size_t k = 0; k < composition.steps.size(); ++k) {
    std::printf("%s '%s'%s\n", k == 0 ? "this is the first of a chain of states:" : "then",
                composition.steps[k].name.c_str(),
                composition.steps[k].rest_is_previous ? ", whose rest state is the state before" : "");
  }
}

}  // namespace

int explain(const CommonOptions& common, const std::string& file, const std::vector<std::string>& set) {
  CompositionRequest request;
  request.file = file;
  if (!parse_overrides(set, request.overrides)) return exit_wrong_input;
  PluginHost host = make_host(common, file);
  Refusal refusal;
  const std::unique_ptr<Procedure> procedure = Procedure::prepare(request, host, refusal);
  if (procedure == nullptr) return report(refusal);

  const Session* session = &procedure->session();
  const Composition& composition = session->composition;
  if (!composition.title.empty()) std::printf("%s\n", composition.title.c_str());
  std::printf("scene of dimension %d\n", composition.dimension);
  for (const auto& curve : session->scene->curves) explain_curve(*curve);
  std::printf("energies\n");
  for (const EnergyUse& use : session->scene->energies) {
    std::printf("  %-24s %s on '%s', %s\n", use.label.c_str(), use.plugin.c_str(),
                session->scene->curves[static_cast<std::size_t>(use.curve)]->name.c_str(),
                counted(static_cast<int>(use.laws.size()), "law").c_str());
  }
  const ProblemSummary& summary = session->assembly->summary();
  std::printf("rows: %d equalities, %d inequalities\n", summary.equalities, summary.inequalities);
  for (const RowGroup& group : summary.row_groups) std::printf("  %s\n", group.text.c_str());
  std::printf("unknowns: %d, eliminated because they are held: %d\n", summary.unknowns, summary.fixed);
  std::printf("Hessian: %d entries in its lower triangle; Jacobian: %d\n",
              session->assembly->hessian_pattern().entries(), session->assembly->jacobian_pattern().entries());
  std::printf("solved by %s with rows by %s\n", composition.solver.name.c_str(), composition.enforcement.name.c_str());
  explain_losses(composition);
  explain_procedure(composition);
  explain_plugins(*session, host);
  for (const std::string& idle : composition.without_effect) std::printf("without effect: %s\n", idle.c_str());
  for (const std::string& idle : session->scene->without_effect) std::printf("without effect: %s\n", idle.c_str());
  for (const std::string& warning : composition.warnings) std::printf("warning: %s\n", warning.c_str());
  for (const std::string& warning : session->scene->warnings) std::printf("warning: %s\n", warning.c_str());
  return exit_converged;
}

}  // namespace bowstring::apps
