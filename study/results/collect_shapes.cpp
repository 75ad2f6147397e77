#include "study/results/collect_shapes.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <Eigen/Eigenvalues>
#include <nlohmann/json.hpp>

namespace bowstring::study {
namespace {

using Json = nlohmann::json;
using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t most_points = 200;  // of a drawn curve

struct SolidCurve {
  std::string name;
  bool wire = false;
  Points points, rest;
};

struct SolidContact {
  Eigen::Vector3d place, force;
};

struct Solid {
  int run = 0;
  std::vector<SolidCurve> curves;
  std::vector<SolidContact> contacts;
};

Eigen::Vector3d vector_of(const Json& numbers) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < std::min<std::size_t>(3, numbers.size()); ++k) {
    out[static_cast<Eigen::Index>(k)] = numbers[k].is_number() ? numbers[k].get<double>() : 0.0;
  }
  return out;
}

Points points_of(const Json& rows) {
  Points out;
  for (const Json& row : rows) out.push_back(vector_of(row));
  return out;
}

/// The place on a wire where a row acts.
Eigen::Vector3d place_of(const Json& contact, const SolidCurve& wire) {
  const double t = contact["t"].get<double>();
  const auto edge = std::min(contact["wire_edge"].get<std::size_t>(), wire.points.size() - 1);
  const std::size_t next = std::min(edge + 1, wire.points.size() - 1);
  return (1.0 - t) * wire.points[edge] + t * wire.points[next];
}

Solid solid_of(int run, const Json& document) {
  Solid out;
  out.run = run;
  for (const Json& curve : document["curves"]) {
    SolidCurve one;
    one.name = curve["name"].get<std::string>();
    one.wire = curve["kind"] == "wire";
    one.points = points_of(curve["points"]);
    if (!one.wire) one.rest = points_of(curve["reference_points"]);
    out.curves.push_back(std::move(one));
  }
  for (const Json& contact : document["contacts"]) {
    const auto wire = std::find_if(out.curves.begin(), out.curves.end(),
                                   [&](const SolidCurve& curve) { return contact["wire"] == curve.name; });
    if (wire == out.curves.end() || wire->points.empty() || !contact["force_N"].is_number()) continue;
    const double force = contact["force_N"].get<double>();
    if (force > 0.0) out.contacts.push_back({place_of(contact, *wire), force * vector_of(contact["direction"])});
  }
  return out;
}

/// Two directions, as columns, in which all points extend most; x and y where they lie in that plane.
Eigen::Matrix<double, 3, 2> plane_of(const std::vector<Solid>& solids) {
  Eigen::Matrix<double, 3, 2> plane = Eigen::Matrix<double, 3, 2>::Identity();
  Points all;
  for (const Solid& solid : solids) {
    for (const SolidCurve& curve : solid.curves) all.insert(all.end(), curve.points.begin(), curve.points.end());
  }
  const bool flat = std::all_of(all.begin(), all.end(), [](const Eigen::Vector3d& p) { return p[2] == 0.0; });
  if (flat) return plane;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : all) mean += p / static_cast<double>(all.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : all) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  plane.col(0) = axes.eigenvectors().col(2);
  plane.col(1) = axes.eigenvectors().col(1);
  for (Eigen::Index k = 0; k < 2; ++k) {  // the sign of an eigenvector is the library's: the largest entry is positive
    Eigen::Index largest = 0;
    plane.col(k).cwiseAbs().maxCoeff(&largest);
    if (plane(largest, k) < 0.0) plane.col(k) *= -1.0;
  }
  return plane;
}

std::vector<double> drawn(const Points& points, const Eigen::Matrix<double, 3, 2>& plane) {
  std::vector<double> out;
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + most_points - 1) / most_points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % stride != 0 && i + 1 != points.size()) continue;
    const Eigen::Vector2d place = plane.transpose() * points[i];
    out.push_back(place[0]);
    out.push_back(place[1]);
  }
  return out;
}

Shape shape_of(const Solid& solid, const Eigen::Matrix<double, 3, 2>& plane, std::string label) {
  Shape out;
  out.run = solid.run;
  out.label = std::move(label);
  for (const SolidCurve& curve : solid.curves) {
    out.curves.push_back({curve.name, curve.wire, drawn(curve.points, plane), drawn(curve.rest, plane)});
  }
  for (const SolidContact& contact : solid.contacts) {
    const Eigen::Vector2d place = plane.transpose() * contact.place, force = plane.transpose() * contact.force;
    out.contacts.push_back({place[0], place[1], force[0], force[1], contact.force.norm()});
  }
  return out;
}

bool is_kept(const Collected& collected, std::size_t run) { return !collected.records[run].document_sha256.empty(); }

std::vector<int> chosen(const Collected& collected, int most) {
  const StudyData& data = collected.data;
  std::map<std::vector<int>, int> finest;  // of each formulation the run with the finest mesh
  std::vector<int> kept;
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    if (!is_kept(collected, r)) continue;
    kept.push_back(static_cast<int>(r));
    std::vector<int> key = data.runs[r].choice;
    if (data.along < 0) continue;
    const auto along = static_cast<std::size_t>(data.along);
    const auto mesh = [&](int run) {
      return data.axes[along].number[static_cast<std::size_t>(data.runs[static_cast<std::size_t>(run)].choice[along])];
    };
    key[along] = -1;
    const auto [place, fresh] = finest.emplace(std::move(key), static_cast<int>(r));
    if (!fresh && mesh(static_cast<int>(r)) > mesh(place->second)) place->second = static_cast<int>(r);
  }
  std::vector<int> first;
  for (const auto& [key, run] : finest) first.push_back(run);
  std::sort(first.begin(), first.end());
  std::vector<int> out;
  const auto spread = [&](const std::vector<int>& from) {
    const int room = most - static_cast<int>(out.size());
    const int count = static_cast<int>(from.size());
    for (int i = 0; i < std::min(room, count); ++i) {
      const int run = from[static_cast<std::size_t>(count <= room ? i : i * count / room)];
      if (std::find(out.begin(), out.end(), run) == out.end()) out.push_back(run);
    }
  };
  spread(first);
  if (first.empty()) spread(kept);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

Shapes collect_shapes(const Plan& plan, const Collected& collected, const Folder& folder, int most) {
  Shapes out;
  std::vector<Solid> solids;
  for (const int run : chosen(collected, most)) {
    std::string text;
    if (!folder.load_document(collected.records[static_cast<std::size_t>(run)], text).empty()) continue;
    const Json document = Json::parse(text, nullptr, false);
    if (document.is_object() && document.contains("curves")) solids.push_back(solid_of(run, document));
  }
  if (solids.empty()) {
    out.text = "No result document is kept (--keep full keeps them), so there are no shapes.";
    return out;
  }
  const Eigen::Matrix<double, 3, 2> plane = plane_of(solids);
  const bool flat = plane == Eigen::Matrix<double, 3, 2>::Identity();
  out.text = flat ? "In the plane of the scene." : "Seen along the direction in which the curves extend least.";
  for (const Solid& solid : solids) {
    out.shapes.push_back(
        shape_of(solid, plane, run_label(plan.study, plan.runs[static_cast<std::size_t>(solid.run)].choice)));
  }
  return out;
}

}  // namespace bowstring::study
