#pragma once

namespace bowstring {

/// Integral of f over [begin, end] by the Gauss–Legendre rule of ten points: exact for polynomials up to
/// degree 19. Nodes and weights: Abramowitz and Stegun, table 25.4.
template <class Function>
double gauss_legendre(const Function& f, double begin, double end) {
  constexpr double node[5] = {0.1488743389816312108848260, 0.4333953941292471907992659, 0.6794095682990244062343274,
                              0.8650633666889845107320967, 0.9739065285171717200779640};
  constexpr double weight[5] = {0.2955242247147528701738930, 0.2692667193099963550912269, 0.2190863625159820439955349,
                                0.1494513491505805931457763, 0.0666713443086881375935688};
  const double middle = 0.5 * (begin + end);
  const double half = 0.5 * (end - begin);
  double sum = 0.0;
  for (int i = 0; i < 5; ++i) sum += weight[i] * (f(middle - half * node[i]) + f(middle + half * node[i]));
  return half * sum;
}

}  // namespace bowstring
