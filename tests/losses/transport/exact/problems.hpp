#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/interfaces/transport.hpp"
#include "core/model/component.hpp"
#include "core/transport/transport_comparison.hpp"

namespace exact_test {

using namespace bowstring;

/// min over plans with these sums of ⟨cost, plan⟩.
struct MatrixProblem {
  std::vector<double> a, b, cost;  ///< cost: a.size() × b.size(), row major
};

/// The exact methods of this build: "exact", and "exact-lemon" where LEMON was found.
const std::vector<std::string>& exact_methods();

TransportComparison open_comparison(const std::string& method, const std::string& cost = "euclidean");
Owned<Transport> open_method(const std::string& method);

/// What `method`, cold, makes of the problem, which has to succeed.
TransportAnswer solve_cold(const std::string& method, const MatrixProblem& problem);
Status solve_into(TransportComparison& comparison, const MatrixProblem& problem, TransportAnswer& out);

/// That marginals, duals and gap hold, relative to mass and costs, and that the plan and duals in `answer` themselves
/// say so.
void check_proof(const MatrixProblem& problem, const TransportAnswer& answer, double tolerance = 1e-12);

/// A number of (0, 1), the same with every library.
double uniform(std::mt19937& random);
/// 0 … count − 1.
int below(std::mt19937& random, int count);

std::vector<double> random_cloud(std::mt19937& random, int count);
/// A coil in space with random turns and tilt, points in order along it, evenly spaced in its parameter.
std::vector<double> random_curve(std::mt19937& random, int count);
std::vector<double> squared_distances(const std::vector<double>& a, const std::vector<double>& b);
/// `count` numbers that sum to one.
std::vector<double> random_weights(std::mt19937& random, int count);

}  // namespace exact_test
