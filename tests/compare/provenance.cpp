#include "core/result/provenance.hpp"

#include <doctest/doctest.h>

#include "tests/simulation/scenes.hpp"

namespace bowstring {

using namespace testing;

namespace {

using Lines = std::vector<std::string>;

const std::string ab(64, 'a'), cd(64, 'c');

Provenance recorded() {
  return {"0.1.0", 4, "/old/libbowstring.so", ab, {{Kind::energy, "anchoring", {"/old/a.so", ab, "gcc-12"}}}};
}

}  // namespace

TEST_CASE("a provenance comes back from its document") {
  const Provenance before = recorded();
  const Provenance again = read_provenance(provenance_json(before));
  CHECK(again.version == "0.1.0");
  CHECK(again.interface_version == 4);
  CHECK(again.kernel_file == "/old/libbowstring.so");
  CHECK(again.kernel_sha256 == ab);
  REQUIRE(again.plugins.size() == 1);
  CHECK(again.plugins[0].kind == Kind::energy);
  CHECK(again.plugins[0].name == "anchoring");
  CHECK(again.plugins[0].origin.file == "/old/a.so");
  CHECK(again.plugins[0].origin.sha256 == ab);
  CHECK(again.plugins[0].origin.abi_tag == "gcc-12");
  CHECK(provenance_differences(before, again) == Lines{});
  CHECK(read_provenance("{}").plugins.empty());
}

TEST_CASE("each difference in words; where a file lies is none") {
  Provenance here = recorded();
  here.kernel_file = "/here/libbowstring.so";
  here.plugins[0].origin.file = "/here/a.so";
  CHECK(provenance_differences(recorded(), here) == Lines{});

  here.plugins[0].origin.sha256 = cd;
  CHECK(provenance_differences(recorded(), here) ==
        Lines{"plugin energy/anchoring: sha256 aaaaaaaaaaaa… then, cccccccccccc… here (/here/a.so)"});
  here.plugins[0].origin.abi_tag = "gcc-13";
  CHECK(provenance_differences(recorded(), here, {"in A", "in B"}) ==
        Lines{"plugin energy/anchoring: sha256 aaaaaaaaaaaa… in A, cccccccccccc… in B; ABI tag 'gcc-12' in A, "
              "'gcc-13' in B (/here/a.so)"});
  here.plugins[0].origin = {"/here/a.so", "", "gcc-12"};
  CHECK(provenance_differences(recorded(), here) ==
        Lines{"plugin energy/anchoring: its library '/here/a.so' cannot be read here, sha256 aaaaaaaaaaaa… then "
              "(/old/a.so)"});
  here.plugins[0].origin = {};
  here.version = "0.2.0";
  here.interface_version = 5;
  here.kernel_sha256 = cd;
  CHECK(provenance_differences(recorded(), here) ==
        Lines{"version 0.1.0 then, 0.2.0 here", "interface of plugins: version 4 then, 5 here",
              "kernel: sha256 aaaaaaaaaaaa… then, cccccccccccc… here (/here/libbowstring.so)",
              "plugin energy/anchoring: offered by no library here, sha256 aaaaaaaaaaaa… then (/old/a.so)"});
  here = recorded();
  here.plugins.clear();
  CHECK(provenance_differences(recorded(), here) == Lines{});
}

TEST_CASE("the programs as they are here") {
  Provenance before = recorded();
  before.plugins.push_back({Kind::energy, "nobody-offers-this", {"/old/b.so", cd, "gcc-12"}});
  const Provenance here = provenance_here(before, plugins());
  CHECK(here.version == bowstring_version);
  CHECK(here.kernel_sha256.size() == 64);
  REQUIRE(here.plugins.size() == 2);
  CHECK(here.plugins[0].origin.sha256.size() == 64);
  CHECK(here.plugins[1].origin.file == "");
}

}  // namespace bowstring
