#include "core/model/scene.hpp"

#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::vector<double> gather(const Scene& scene, std::vector<double> FieldDeclaration::*numbers) {
  std::vector<double> q;
  q.reserve(static_cast<std::size_t>(scene.coordinates));
  for (const auto& curve : scene.curves) {
    for (const FieldDeclaration& field : curve->declaration.fields) {
      q.insert(q.end(), (field.*numbers).begin(), (field.*numbers).end());
    }
  }
  return q;
}

}  // namespace

const SiteDeclaration* Curve::site(Site which) const noexcept {
  for (const SiteDeclaration& declared : declaration.sites) {
    if (declared.site == which) return &declared;
  }
  return nullptr;
}

const Curve* Scene::find(const std::string& name) const noexcept {
  for (const auto& curve : curves) {
    if (curve->name == name) return curve.get();
  }
  return nullptr;
}

std::vector<double> Scene::start_coordinates() const { return gather(*this, &FieldDeclaration::start); }

std::vector<double> Scene::reference_coordinates() const { return gather(*this, &FieldDeclaration::reference); }

}  // namespace bowstring
