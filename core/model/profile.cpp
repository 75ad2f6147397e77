#include <algorithm>
#include <cmath>

#include "core/composition/nearest.hpp"
#include "core/curve/arc_length.hpp"
#include "core/model/scene.hpp"

namespace bowstring {

namespace {

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text.empty() ? "none" : text;
}

std::string hint(const std::string& word, const std::vector<std::string>& names) {
  const auto nearest = nearest_names(word, names);
  return nearest.empty() ? "" : "; " + did_you_mean({nearest.front()});
}

/// Arc coordinate along the profile's own axis.
double profile_arc(const Profile& profile, double arc, double length) {
  return profile.measured_from == Profile::Origin::tip ? length - arc : arc;
}

Status sample_segments(const Profile& profile, const Curve& curve, const std::vector<double>& arc,
                       std::vector<double>& out) {
  if (curve.label.empty()) {
    return Status::failure(Code::invalid_input, "a profile by segments, but the geometry of '" + curve.name +
                                                    "' labels no segments; expected a value, a table or a column");
  }
  for (const std::string& label : curve.label) {
    if (std::find(profile.segment.begin(), profile.segment.end(), label) == profile.segment.end()) {
      return Status::failure(Code::invalid_input, "a profile by segments without a value for segment '" + label +
                                                      "' of '" + curve.name + "'; expected one for each of its labels");
    }
  }
  for (const std::string& segment : profile.segment) {
    if (std::find(curve.label.begin(), curve.label.end(), segment) != curve.label.end()) continue;
    std::vector<std::string> labels = curve.label;
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    return Status::failure(Code::invalid_input,
                           "a value for segment '" + segment + "', which the geometry of '" + curve.name +
                               "' does not label; expected one of: " + list_of(labels) + hint(segment, labels));
  }
  for (const double s : arc) {
    const std::string& label = curve.label[nearest_index(curve.arc, s)];
    const auto where = std::find(profile.segment.begin(), profile.segment.end(), label) - profile.segment.begin();
    out.push_back(profile.value[static_cast<std::size_t>(where)]);
  }
  return {};
}

Status sample_column(const Profile& profile, const Curve& curve, const std::vector<double>& arc,
                     std::vector<double>& out) {
  std::vector<std::string> names;
  for (const PointData& data : curve.data) {
    names.push_back(data.name);
    if (data.name != profile.column) continue;
    for (const double s : arc) out.push_back(interpolate_linearly(curve.arc, data.value, s));
    return {};
  }
  const std::string text = "a profile from column '" + profile.column + "', which the geometry of '" + curve.name +
                           "' does not have; expected one of: " + list_of(names);
  return Status::failure(Code::invalid_input, text + hint(profile.column, names));
}

}  // namespace

Status sample_profile(const Profile& profile, const Curve& curve, const std::vector<double>& arc,
                      std::vector<double>& out) {
  out.clear();
  switch (profile.form) {
    case Profile::Form::constant:
      out.assign(arc.size(), profile.constant);
      return {};
    case Profile::Form::segments:
      return sample_segments(profile, curve, arc, out);
    case Profile::Form::column:
      return sample_column(profile, curve, arc, out);
    case Profile::Form::table:
      break;
  }
  const double length = curve.arc.empty() ? 0.0 : curve.arc.back();
  for (const double s : arc) {
    out.push_back(interpolate_linearly(profile.arc, profile.value, profile_arc(profile, s, length)));
  }
  return {};
}

}  // namespace bowstring
