#include "early_fusion/world/textured_mesh.h"

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <iostream>

#include "early_fusion/core/error.h"
#include "early_fusion/core/excerpt.h"
#include "early_fusion/core/file.h"
#include "mesh_import.h"
#include "mesh_simplification.h"
#include "mesh_texture.h"

namespace early_fusion::world {

namespace {

constexpr int kMaxNodeDepth = 256;

/// The state of a conversion from assimp's scene to parts, one part for each material.
struct Conversion {
  const std::string& path;
  const aiScene& scene;
  Eigen::Vector3d scale;
  std::vector<MeshPart> part_of_material;
};

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

void appendMesh(Conversion& conversion, const aiMesh& mesh, const Eigen::Affine3d& node_transform) {
  const Eigen::Affine3d transform = Eigen::Scaling(conversion.scale) * node_transform;
  const double determinant = transform.linear().determinant();
  if (!std::isfinite(determinant) || determinant == 0) {
    throw core::Error(conversion.path + ": mesh '" + core::excerpt(mesh.mName.C_Str()) +
                      "' is scaled to nothing or not finite");
  }
  // The inverse transpose keeps normals perpendicular under any scale, and pointing outwards under a reflection.
  const Eigen::Matrix3d normal_transform = transform.linear().inverse().transpose();
  MeshPart& part = conversion.part_of_material[mesh.mMaterialIndex];
  const auto first = static_cast<std::uint32_t>(part.vertices.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    part.vertices.push_back(convertVertex(mesh, i, transform, normal_transform));
    if (!part.vertices.back().position.allFinite() || !part.vertices.back().uv.allFinite()) {
      throw core::Error(conversion.path + ": vertex " + std::to_string(i) + " of mesh '" +
                        core::excerpt(mesh.mName.C_Str()) + "' is not finite");
    }
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

TexturedMesh convert(const std::string& path, const aiScene& scene, const Eigen::Vector3d& scale) {
  Conversion conversion{path, scene, scale, std::vector<MeshPart>(scene.mNumMaterials)};
  appendNode(conversion, *scene.mRootNode, Eigen::Affine3d::Identity(), 0);
  TexturedMesh mesh;
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    MeshPart& part = conversion.part_of_material[i];
    if (part.indices.empty()) continue;
    part.texture = readTexture(scene, *scene.mMaterials[i], path);
    part.specular = readSpecular(*scene.mMaterials[i]);
    mesh.parts.push_back(std::move(part));
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

TexturedMesh loadTexturedMesh(const std::string& path, const Eigen::Vector3d& scale, int max_triangles) {
  Assimp::Importer importer;
  TexturedMesh mesh = core::namingOutOfMemory(path, [&] { return convert(path, importMesh(importer, path), scale); });
  const std::size_t triangles = mesh.triangleCount();
  if (triangles == 0) throw core::Error(path + ": has no triangles; export a surface mesh");
  if (!hasArea(mesh)) throw core::Error(path + ": all its triangles have no area; export a surface mesh");
  simplify(mesh, max_triangles);
  if (mesh.triangleCount() < triangles) {
    std::cerr << "early_fusion: " << path << ": " << triangles << " triangles simplified to " << mesh.triangleCount()
              << "\n";
  }
  return mesh;
}

}  // namespace early_fusion::world
