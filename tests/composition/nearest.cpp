#include "core/composition/nearest.hpp"

#include <doctest/doctest.h>

using bowstring::did_you_mean;
using bowstring::nearest_names;
using Names = std::vector<std::string>;

TEST_CASE("a name with few letters wrong finds the right one") {
  const Names keys{"name", "on", "stiffness", "type"};
  CHECK(nearest_names("stifness", keys) == Names{"stiffness"});
  CHECK(nearest_names("stiffnes", keys) == Names{"stiffness"});
  CHECK(nearest_names("sttifnness", keys) == Names{"stiffness"});
  CHECK(nearest_names("tpye", keys) == Names{"type"});
  CHECK(nearest_names("Stiffness", keys) == Names{"stiffness"});
}

TEST_CASE("underscores stand for hyphens") {
  CHECK(nearest_names("bending_stiffness", {"bending-stiffness", "stretch-stiffness"}) == Names{"bending-stiffness"});
}

TEST_CASE("a part of a hyphenated name finds the whole") {
  const Names energies{"anchoring", "axial-tension", "vessel-strain", "wire-bending"};
  CHECK(nearest_names("tension", energies) == Names{"axial-tension"});
  CHECK(nearest_names("wire", energies) == Names{"wire-bending"});
  CHECK(nearest_names("strain-energy", {"strain", "kkt"}) == Names{"strain"});
}

TEST_CASE("what is far is not proposed") {
  CHECK(nearest_names("hoop-wall", {"anchoring", "axial-tension"}).empty());
  CHECK(nearest_names("q", {"v", "w"}).empty());
  CHECK(nearest_names("", {"v", "wire"}).empty());
  CHECK(nearest_names("kkt", {}).empty());
  CHECK(nearest_names("abc", {"xyz"}).empty());
}

TEST_CASE("at most three names, the nearest first, each once, ties in their own order") {
  CHECK(nearest_names("node-1", {"node-2", "node-3", "node-4", "node-5"}) == Names{"node-2", "node-3", "node-4"});
  CHECK(nearest_names("vessel-ab", {"vessel-xb", "vessel-a"}) == Names{"vessel-xb", "vessel-a"});
  CHECK(nearest_names("nodes", {"node-s", "nodez", "nodes"}) == Names{"nodes", "node-s", "nodez"});
  CHECK(nearest_names("ilia", {"iliac", "iliac"}) == Names{"iliac"});
}

TEST_CASE("a far name is left out beside a near one") {
  CHECK(nearest_names("tolerance", {"tolerances", "toleraXYZ"}) == Names{"tolerances"});
}

TEST_CASE("the question that a message asks") {
  CHECK(did_you_mean({}) == "");
  CHECK(did_you_mean({"a"}) == "did you mean 'a'?");
  CHECK(did_you_mean({"a", "b"}) == "did you mean 'a' or 'b'?");
  CHECK(did_you_mean({"a", "b", "c"}) == "did you mean 'a', 'b' or 'c'?");
}
