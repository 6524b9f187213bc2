#include "make_meshes/model.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "early_fusion/core/error.h"
#include "early_fusion/core/file.h"

namespace early_fusion::make_meshes {
namespace {

std::string decimal(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  // Adding zero turns -0 into 0.
  const double rounded = std::round(value * unit) / unit + 0.0;
  char text[32];
  std::snprintf(text, sizeof(text), "%.*f", decimals, rounded);
  return text;
}

// The lines of one kind ("v", "vt", "vn"), each once, numbered from 1 as OBJ wants it.
class LineTable {
 public:
  int number(const std::string& line) {
    const auto [entry, added] = numbers_.emplace(line, static_cast<int>(numbers_.size()) + 1);
    if (added) text_ += line + "\n";
    return entry->second;
  }
  const std::string& text() const { return text_; }

 private:
  std::map<std::string, int> numbers_;
  std::string text_;
};

std::string objText(const Model& model) {
  LineTable positions, uvs, normals;
  std::string faces;
  for (const Triangle& triangle : model.mesh) {
    faces += "f";
    for (const Corner& corner : triangle) {
      const Eigen::Vector3d& p = corner.position;
      const Eigen::Vector3d& n = corner.normal;
      const int v = positions.number("v " + decimal(p.x(), 5) + " " + decimal(p.y(), 5) + " " + decimal(p.z(), 5));
      // In OBJ files v points up.
      const int vt = uvs.number("vt " + decimal(corner.uv.x(), 4) + " " + decimal(1 - corner.uv.y(), 4));
      const int vn = normals.number("vn " + decimal(n.x(), 3) + " " + decimal(n.y(), 3) + " " + decimal(n.z(), 3));
      faces += " " + std::to_string(v) + "/" + std::to_string(vt) + "/" + std::to_string(vn);
    }
    faces += "\n";
  }
  return "# Written by make_meshes: change the tool, not this file. Metres, z up.\nmtllib " + model.name + ".mtl\no " +
         model.name + "\n" + positions.text() + uvs.text() + normals.text() + "usemtl " + model.name + "\n" + faces;
}

std::string mtlText(const Model& model) {
  const std::string specular = decimal(model.specular, 2);
  return "newmtl " + model.name + "\nKa 1 1 1\nKd 1 1 1\nKs " + specular + " " + specular + " " + specular +
         "\nNs 32\nillum 2\nmap_Kd " + model.name + ".png\n";
}

std::string pngBytes(const Model& model) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", model.texture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9})) {
    throw core::Error("Cannot make a PNG of the texture of '" + model.name + "': this OpenCV has no PNG support.");
  }
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace

void writeModel(const std::string& folder, const Model& model) {
  const std::string stem = folder + "/" + model.name;
  core::writeFileAtomically(stem + ".obj", objText(model));
  core::writeFileAtomically(stem + ".mtl", mtlText(model));
  core::writeFileAtomically(stem + ".png", pngBytes(model));
}

}  // namespace early_fusion::make_meshes
