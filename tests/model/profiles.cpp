#include <doctest/doctest.h>

#include "core/model/scene.hpp"

namespace bowstring {

namespace {

/// A straight curve of five nodes, 100 mm long, with a column and labels.
Curve curve() {
  Curve out;
  out.name = "iliac";
  out.arc = {0.0, 25.0, 50.0, 75.0, 100.0};
  out.data = {{"radius_mm", {4.0, 5.0, 6.0, 7.0, 8.0}}, {"calcium", {0.0, 0.0, 1.0, 0.0, 0.0}}};
  out.label = {"cia", "cia", "cia", "eia", "eia"};
  return out;
}

const std::vector<double> stations = {-5.0, 0.0, 12.5, 60.0, 100.0, 130.0};

std::vector<double> sampled(const Profile& profile) {
  std::vector<double> out;
  const Status status = sample_profile(profile, curve(), stations, out);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

std::string refusal(const Profile& profile, const Curve& of) {
  std::vector<double> out;
  const Status status = sample_profile(profile, of, stations, out);
  CHECK(status.code == Code::invalid_input);
  return status.text;
}

Profile table() {
  Profile out;
  out.form = Profile::Form::table;
  out.arc = {10.0, 60.0};
  out.value = {5.0, 10.0};
  return out;
}

}  // namespace

TEST_CASE("a constant profile is one number") {
  Profile profile;
  profile.constant = 3.5;
  CHECK(sampled(profile) == std::vector<double>(6, 3.5));
}

TEST_CASE("a table is linear between its entries and constant beyond, from either end") {
  Profile profile = table();
  CHECK(sampled(profile) == std::vector<double>{5.0, 5.0, 5.25, 10.0, 10.0, 10.0});
  profile.measured_from = Profile::Origin::tip;
  CHECK(sampled(profile) == std::vector<double>{10.0, 10.0, 10.0, 8.0, 5.0, 5.0});
}

TEST_CASE("a column is linear between nodes") {
  Profile profile;
  profile.form = Profile::Form::column;
  profile.column = "radius_mm";
  CHECK(sampled(profile) == std::vector<double>{4.0, 4.0, 4.5, 6.4, 8.0, 8.0});
  profile.column = "radius";
  CHECK(refusal(profile, curve()) ==
        "a profile from column 'radius', which the geometry of 'iliac' does not have; expected one of: 'radius_mm', "
        "'calcium'; did you mean 'radius_mm'?");
}

TEST_CASE("values by segment are those of the nearest node's label") {
  Profile profile;
  profile.form = Profile::Form::segments;
  profile.segment = {"eia", "cia"};
  profile.value = {4.0, 5.0};
  CHECK(sampled(profile) == std::vector<double>{5.0, 5.0, 5.0, 5.0, 4.0, 4.0});
  profile.segment = {"eia", "aorta"};
  CHECK(refusal(profile, curve()) ==
        "a profile by segments without a value for segment 'cia' of 'iliac'; expected one "
        "for each of its labels");
  profile.segment = {"eia", "cia", "cfa"};
  profile.value = {4.0, 5.0, 6.0};
  CHECK(refusal(profile, curve()) ==
        "a value for segment 'cfa', which the geometry of 'iliac' does not label; expected "
        "one of: 'cia', 'eia'; did you mean 'cia'?");
  Curve unlabelled = curve();
  unlabelled.label.clear();
  CHECK(refusal(profile, unlabelled) ==
        "a profile by segments, but the geometry of 'iliac' labels no segments; expected "
        "a value, a table or a column");
}

}  // namespace bowstring
