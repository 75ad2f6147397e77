#include <doctest/doctest.h>

#include <cmath>

#include "study/results/results_table.hpp"

namespace bowstring::study {
namespace {

Collected two_runs() {
  Collected out;
  AxisData mesh, rule;
  mesh.column = "N";
  mesh.label = {"10", "20"};
  mesh.number = {10, 20};
  rule.column = "rule";
  rule.label = {"a, \"b\""};
  out.data.axes = {mesh, rule};
  QuantityData tip;
  tip.column = "tip_mm";
  tip.unit = "mm";
  tip.value = {0.1, std::nan("")};
  tip.reference = {0.25, std::nan("")};
  tip.reference_text = "a stored value";
  out.data.quantities = {tip};
  out.data.energies = {{"wire-bending", {1.5, std::nan("")}}};
  RunData first, second;
  first.choice = {0, 0};
  first.solve_seconds = 0.5;
  second.choice = {1, -1};
  second.solve_seconds = std::nan("");
  out.data.runs = {first, second};
  RunRecord solved, refused;
  solved.status = "converged";
  solved.second_order = "minimum";
  solved.reason = "all hold";
  solved.iterations = 7;
  solved.certificate = {{"stationarity", 1e-9}};
  solved.energy = {{"wire-bending", 1.5}, {"total", 1.5}};
  solved.solve_seconds = {0.5};
  refused.status = "refused";
  refused.reason = "more than, say, 300 unknowns";
  out.records = {solved, refused};
  return out;
}

}  // namespace

TEST_CASE("one row per run, quoted where it has to be, unknown numbers empty") {
  CHECK(results_csv(two_runs()) ==
        "run,N,rule,status,second_order,tip_mm,tip_reference_mm,tip_error_mm,unknowns,iterations,factorizations,"
        "evaluations,epochs,stationarity_N,max_penetration_mm,max_penetration_dense_mm,min_stretch,"
        "energy_wire_bending_N_mm,energy_total_N_mm,load_seconds,setup_seconds,solve_seconds,total_seconds,reason\n"
        "0,10,\"a, \"\"b\"\"\",converged,minimum,0.1,0.25,0.15,0,7,0,0,0,1e-09,,,,1.5,1.5,0,0,0.5,0,all hold\n"
        "1,20,,refused,,,,,,,,,,,,,,,,,,,,\"more than, say, 300 unknowns\"\n");
}

}  // namespace bowstring::study
