#pragma once

#include <string>
#include <vector>

#include "core/assembly/site_table.hpp"

namespace bowstring {

/// One law at its places: forms what the law reads, asks it once, and applies the chain rule from x to the place's
/// y = (ζ, ds, s), which `Law` states.
class LawAssembly {
 public:
  /// `reference`: the site's y in State 1.
  LawAssembly(const LawUse& use, const SiteTable& site, const std::vector<double>& reference);

  /// Adds the sum of the energies to `energy` and the stress to `site.stress`. A number that is not finite is
  /// `failed`, and names the place.
  Status evaluate(SiteTable& site, double* energy);
  /// Adds the modulus to `site.modulus`, at the state of the last `evaluate`.
  Status add_modulus(SiteTable& site);

 private:
  void read(const SiteTable& site);
  void add_stress(SiteTable& site) const;
  void add_length_stress(SiteTable& site) const;
  void add_length_modulus(SiteTable& site) const;
  LawBatch batch(const SiteTable& site) const;
  Status check(const std::vector<double>& numbers, const char* what) const;

  const LawUse* use_;
  std::vector<int> place_;
  std::vector<double> weight_;
  int count_, dimension_;
  bool divides_, weighs_, varies_;
  bool as_it_stands_;  // the law reads y of all places, undivided: no copy
  // E = measure · W(y · by_ds), with measure = weight·ds or weight, and by_ds = 1/ds or 1.
  std::vector<double> measure_, by_ds_;
  std::vector<double> x_, reference_, energy_, stress_, modulus_;
  std::vector<const double*> parameter_;
};

}  // namespace bowstring
