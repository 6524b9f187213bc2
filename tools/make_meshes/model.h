#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "make_meshes/mesh.h"

namespace early_fusion::make_meshes {

/// A textured mesh under its file name.
struct Model {
  std::string name;
  Mesh mesh;            ///< [m], z up
  cv::Mat texture;      ///< square, 8-bit BGR
  double specular = 0;  ///< strength of the highlight, [0, 1]
};

/// Writes NAME.obj, NAME.mtl and NAME.png, the same bytes every time.
///
/// @param folder made where it is missing. @throws core::Error naming the file that cannot be written.
void writeModel(const std::string& folder, const Model& model);

}  // namespace early_fusion::make_meshes
