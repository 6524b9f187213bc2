#include "make_meshes/objects.h"

#include "make_meshes/finish_object.h"

namespace early_fusion::make_meshes {

Model finishObject(const std::string& name, Mesh mesh, const Canvas& canvas, double specular, double crease_deg) {
  standOnOrigin(mesh);
  smoothNormals(mesh, crease_deg);
  return {name, std::move(mesh), canvas.finish(), specular};
}

std::vector<Model> makeObjects() {
  return {crackerBox(), sugarBox(),  tomatoSoupCan(), mustardBottle(), gelatinBox(), pottedMeatCan(),
          banana(),     peach(),     sponge(),        rubiksCube(),    mug(),        bowl(),
          plate(),      wineGlass(), apple(),         milkCarton()};
}

}  // namespace early_fusion::make_meshes
