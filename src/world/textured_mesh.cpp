#include "early_fusion/world/textured_mesh.h"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "mesh_import.h"
#include "mesh_simplification.h"
#include "mesh_texture.h"
#include "vertex_colors.h"

namespace early_fusion::world {

namespace {

constexpr int kMaxNodeDepth = 256;

/// The state of a conversion from assimp's scene to parts, one part for each material.
struct Conversion {
  const std::string& path;
  const aiScene& scene;
  Eigen::Affine3d metres_from_file;
  std::vector<MeshPart> part_of_material;
};

bool isGltf(const std::string& path) {
  const std::string extension = core::lowerCaseExtension(path);
  return extension == ".glb" || extension == ".gltf";
}

/// glTF's axes are fixed: y up, z to the front.
Eigen::Affine3d axesOf(const std::string& path) {
  return Eigen::Affine3d(Eigen::AngleAxisd(isGltf(path) ? EIGEN_PI / 2 : 0., Eigen::Vector3d::UnitX()));
}

Eigen::Affine3d toEigen(const aiMatrix4x4& m) {
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return transform;
}

Vertex convertVertex(const aiMesh& mesh, unsigned index, const Eigen::Affine3d& transform,
                     const Eigen::Matrix3d& normal_transform) {
  const aiVector3D& position = mesh.mVertices[index];
  Vertex vertex;
  vertex.position = (transform * Eigen::Vector3d(position.x, position.y, position.z)).cast<float>();
  const aiVector3D normal = mesh.HasNormals() ? mesh.mNormals[index] : aiVector3D(0, 0, 1);
  vertex.normal = (normal_transform * Eigen::Vector3d(normal.x, normal.y, normal.z)).cast<float>();
  const float length = vertex.normal.norm();
  if (std::isfinite(length) && length > 1e-12f) {
    vertex.normal /= length;
  } else {
    vertex.normal = Eigen::Vector3f::UnitZ();  // the triangle has no area, so it is never visible
  }
  vertex.uv.setZero();
  if (mesh.HasTextureCoords(0)) vertex.uv << mesh.mTextureCoords[0][index].x, mesh.mTextureCoords[0][index].y;
  return vertex;
}

/// In a glTF file, vertex colours multiply the plain colour; in others, they replace it.
std::uint32_t vertexColor(const aiColor4D& color, const aiColor4D& plain, bool gltf) {
  if (!gltf) return packColor(color, false);
  return packColor(aiColor4D(color.r * plain.r, color.g * plain.g, color.b * plain.b, 1.f), true);
}

void appendMesh(Conversion& conversion, const aiMesh& mesh, const Eigen::Affine3d& node_transform) {
  const Eigen::Affine3d transform = conversion.metres_from_file * node_transform;
  const double determinant = transform.linear().determinant();
  if (!std::isfinite(determinant) || determinant == 0) {
    throw core::Error(conversion.path + ": mesh '" + core::excerpt(mesh.mName.C_Str()) +
                      "' is scaled to nothing or not finite");
  }
  // The inverse transpose keeps normals perpendicular under any scale, and pointing outwards under a reflection.
  const Eigen::Matrix3d normal_transform = transform.linear().inverse().transpose();
  MeshPart& part = conversion.part_of_material[mesh.mMaterialIndex];
  const auto first = static_cast<std::uint32_t>(part.vertices.size());
  const bool gltf = isGltf(conversion.path);
  const aiColor4D plain = plainColor(*conversion.scene.mMaterials[mesh.mMaterialIndex]);
  const std::uint32_t plain_color = packColor(plain, gltf);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    part.vertices.push_back(convertVertex(mesh, i, transform, normal_transform));
    if (!part.vertices.back().position.allFinite() || !part.vertices.back().uv.allFinite()) {
      throw core::Error(conversion.path + ": vertex " + std::to_string(i) + " of mesh '" +
                        core::excerpt(mesh.mName.C_Str()) + "' is not finite");
    }
    part.colors.push_back(mesh.HasVertexColors(0) ? vertexColor(mesh.mColors[0][i], plain, gltf) : plain_color);
  }
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;  // a point or a line
    const bool mirrored = determinant < 0;
    part.indices.insert(part.indices.end(), {first + face.mIndices[0], first + face.mIndices[mirrored ? 2 : 1],
                                             first + face.mIndices[mirrored ? 1 : 2]});
  }
}

void appendNode(Conversion& conversion, const aiNode& node, const Eigen::Affine3d& parent_transform, int depth) {
  if (depth > kMaxNodeDepth) throw core::Error(conversion.path + ": its nodes are nested more than 256 deep");
  const Eigen::Affine3d transform = parent_transform * toEigen(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    appendMesh(conversion, *conversion.scene.mMeshes[node.mMeshes[i]], transform);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) appendNode(conversion, *node.mChildren[i], transform, depth + 1);
}

/// Adds the backs of all triangles.
void addSecondSide(MeshPart& part) {
  const auto count = static_cast<std::uint32_t>(part.vertices.size());
  const std::vector<std::uint32_t> front = part.indices;
  for (std::uint32_t i = 0; i < count; ++i) {
    part.vertices.push_back(part.vertices[i]);
    part.vertices.back().normal *= -1;
  }
  const std::vector<std::uint32_t> colors = part.colors;
  part.colors.insert(part.colors.end(), colors.begin(), colors.end());
  for (std::size_t i = 0; i < front.size(); i += 3) {
    part.indices.insert(part.indices.end(), {count + front[i], count + front[i + 2], count + front[i + 1]});
  }
}

template <class Visit>  // (a, b, c): a triangle's corners
void forEachTriangle(const TexturedMesh& mesh, Visit visit) {
  for (const MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      visit(part.vertices[part.indices[i]], part.vertices[part.indices[i + 1]], part.vertices[part.indices[i + 2]]);
    }
  }
}

/// Whether two triangles meet at every edge, in opposite directions.
bool isClosed(const TexturedMesh& mesh) {
  std::map<std::array<float, 3>, int> corners;
  std::map<std::pair<int, int>, int> balance;  // of an edge: its triangles in one direction less those in the other
  const auto number = [&](const Vertex& vertex) {
    const Eigen::Vector3f& p = vertex.position;
    return corners.emplace(std::array<float, 3>{p.x(), p.y(), p.z()}, static_cast<int>(corners.size())).first->second;
  };
  const auto add = [&](int from, int to) {
    if (from != to) balance[std::minmax(from, to)] += from < to ? 1 : -1;
  };
  forEachTriangle(mesh, [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    const int i = number(a), j = number(b), k = number(c);
    add(i, j);
    add(j, k);
    add(k, i);
  });
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

constexpr double kClosed = 1e-3;  // share of the surface that may be missing, and of the volume that is none

/// Turns a closed mesh whose faces point inwards inside out: seen from outside it would be invisible.
void turnOutwards(TexturedMesh& mesh, const std::string& path) {
  const Eigen::Vector3d middle = mesh.bounds().center().cast<double>();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // of the area vectors; 0 if the mesh is closed
  double area = 0, volume = 0, agreement = 0;     // of the normals with the faces
  forEachTriangle(mesh, [&](const Vertex& a, const Vertex& b, const Vertex& c) {
    const Eigen::Vector3d p = a.position.cast<double>() - middle, q = b.position.cast<double>() - middle,
                          r = c.position.cast<double>() - middle;
    const Eigen::Vector3d twice = (q - p).cross(r - p);
    sum += twice / 2;
    area += twice.norm() / 2;
    volume += p.dot(q.cross(r)) / 6;
    agreement += twice.dot((a.normal + b.normal + c.normal).cast<double>());
  });
  if (volume >= -kClosed * std::pow(area, 1.5) || sum.norm() > kClosed * area) return;
  for (MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) std::swap(part.indices[i + 1], part.indices[i + 2]);
    for (Vertex& vertex : part.vertices) vertex.normal *= agreement > 0 ? -1.f : 1.f;
  }
  mesh.adapted = true;
  std::cerr << "early_fusion: " << path << ": its faces point inwards; they are turned\n";
}

bool hasArea(const TexturedMesh& mesh) {
  for (const MeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) {
        return part.vertices[part.indices[i + k]].position.cast<double>().eval();
      };
      if ((corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() > 0) return true;
    }
  }
  return false;
}

/// @return whether the part looks as rviz draws it: with its image or its plain colour.
bool setMaterial(MeshPart& part, const aiScene& scene, const aiMaterial& material, const std::string& path) {
  const std::optional<Texture> image = readTexture(scene, material, path);
  part.texture = image ? *image : uniformTexture(packColor(plainColor(material), isGltf(path)));
  part.specular = readSpecular(material);
  const auto& colors = part.colors;
  const bool varies =
      std::any_of(colors.begin(), colors.end(), [&](std::uint32_t color) { return color != colors[0]; });
  if (hasImage(material)) {
    part.colors.clear();
    return image.has_value();
  }
  if (varies) return false;
  const bool plain = part.texture.texels[0] == colors[0];
  part.texture = uniformTexture(colors[0]);
  part.colors.clear();
  return plain;
}

bool isTwoSided(const aiMaterial& material) {
  int two_sided = 0;
  return material.Get(AI_MATKEY_TWOSIDED, two_sided) == AI_SUCCESS && two_sided != 0;
}

TexturedMesh convert(const std::string& path, const aiScene& scene, const Eigen::Affine3d& metres_from_file,
                     MeshPurpose purpose) {
  Conversion conversion{path, scene, metres_from_file * axesOf(path), std::vector<MeshPart>(scene.mNumMaterials)};
  appendNode(conversion, *scene.mRootNode, Eigen::Affine3d::Identity(), 0);
  TexturedMesh mesh;
  std::vector<bool> two_sided;  // by part
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    MeshPart& part = conversion.part_of_material[i];
    if (part.indices.empty()) continue;
    mesh.adapted |= !setMaterial(part, scene, *scene.mMaterials[i], path);
    mesh.parts.push_back(std::move(part));
    two_sided.push_back(isTwoSided(*scene.mMaterials[i]));
  }
  if (purpose == MeshPurpose::kObject) turnOutwards(mesh, path);
  const bool any = std::find(two_sided.begin(), two_sided.end(), true) != two_sided.end();
  if (any && !isClosed(mesh)) {  // the backs of a closed mesh are never seen
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
      if (two_sided[i]) addSecondSide(mesh.parts[i]);
    }
  }
  return mesh;
}

}  // namespace

std::size_t TexturedMesh::triangleCount() const {
  std::size_t count = 0;
  for (const MeshPart& part : parts) count += part.indices.size() / 3;
  return count;
}

Eigen::AlignedBox3f TexturedMesh::bounds() const {
  Eigen::AlignedBox3f box;
  for (const MeshPart& part : parts) {
    for (const Vertex& vertex : part.vertices) box.extend(vertex.position);
  }
  return box;
}

TexturedMesh loadTexturedMesh(const std::string& path, const Eigen::Affine3d& metres_from_file, int max_triangles,
                              MeshPurpose purpose) {
  Assimp::Importer importer;
  TexturedMesh mesh = core::namingOutOfMemory(
      path, [&] { return convert(path, importMesh(importer, path), metres_from_file, purpose); });
  const std::size_t triangles = mesh.triangleCount();
  if (triangles == 0) throw core::Error(path + ": has no triangles; export a surface mesh");
  if (!hasArea(mesh)) throw core::Error(path + ": all its triangles have no area; export a surface mesh");
  simplify(mesh, max_triangles, path);
  for (MeshPart& part : mesh.parts) {
    if (!part.colors.empty()) bakeVertexColors(part);
  }
  return mesh;
}

}  // namespace early_fusion::world
