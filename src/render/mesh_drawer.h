#pragma once

#include <array>
#include <vector>

#include "clipping.h"
#include "projection.h"
#include "render_assets.h"
#include "sample_buffer.h"

namespace early_fusion::render {

/// A vertex on the screen, with attributes that are interpolated over its triangles. attribute / w is linear on the
/// screen.
struct alignas(32) ShadingVertex {
  float x, y;       ///< [subsamples]
  float inverse_w;  ///< [1 / m]
  float u, v;       ///< times inverse_w
  float normal[3];  ///< times inverse_w, world frame
};
static_assert(sizeof(ShadingVertex) == 8 * sizeof(float));

/// A triangle that has at least one sample in its bounding box.
struct alignas(32) VisibleTriangle {
  float inverse_area;   ///< of twice the area [1 / subsamples^2]
  float texture_scale;  ///< times w^3 and the texture's size^2: texels per pixel, in area, at depth w
  std::int32_t material;
  std::int32_t corner[3];  ///< into MeshDrawer::vertices()
};
static_assert(sizeof(VisibleTriangle) == 8 * sizeof(float));

/// Transforms, clips, culls and sets up meshes, fills the samples of a screen, and keeps the data for shading. It
/// allocates memory in the first images only.
class MeshDrawer {
 public:
  /// Removes all triangles. The numbers of triangles, which are the ids of samples, start at 1.
  void clear();

  /// @param projection the projection of the world. Without perspective, both sides of triangles are drawn, and
  /// triangles are not kept for shading.
  void draw(const RenderMesh& mesh, const RenderPose& world_from_mesh, const Projection& projection,
            SampleBuffer& buffer);

  const ShadingVertex* vertices() const { return vertices_.data(); }
  const std::vector<VisibleTriangle>& triangles() const { return triangles_; }

 private:
  /// Triangles of the current mesh: the mesh's own, or the result of clipping them.
  struct Triangles {
    std::array<const IntLanes*, 3> corner;  ///< indices into the vertices of the current mesh
    const FloatLanes* uv_area;
    const std::int32_t* material;
    int count;
  };

  void reserveVertices(int count);
  void transform(const RenderMesh& mesh, const RenderPose& world_from_mesh, const Projection& projection);
  Triangles clip(const RenderMesh& mesh, const RenderPose& world_from_mesh, const Projection& projection);
  ClipVertex clipVertex(const RenderMesh& mesh, const RenderPose& world_from_mesh, int index) const;
  int addVertex(const ClipVertex& vertex, const Projection& projection);
  void addTriangle(std::array<std::int32_t, 3> corner, float uv_area, std::int32_t material);
  TriangleCorners gatherCorners(const Triangles& triangles, int batch) const;
  void keep(const Triangles& triangles, int batch, std::uint32_t accepted, const TriangleCorners& corners);
  void fill(const Triangles& triangles, const Projection& projection, SampleBuffer& buffer);

  // Of the current mesh, one element for each vertex.
  std::vector<IntLanes> screen_x_, screen_y_;         // [subsamples] from the top left corner
  std::vector<FloatLanes> depth_;                     // as in the depth buffer
  std::vector<FloatLanes> clip_x_, clip_y_, clip_w_;  // before the division by w
  int mesh_vertices_ = 0;
  // Of the current mesh, if it was clipped.
  std::array<std::vector<IntLanes>, 3> clipped_corner_;
  std::vector<FloatLanes> clipped_uv_area_;
  std::vector<std::int32_t> clipped_material_;
  TriangleBatch batch_;  // the triangles being set up
  // Of the whole image.
  std::vector<ShadingVertex> vertices_;
  int first_vertex_ = 0;  // of the current mesh
  std::vector<VisibleTriangle> triangles_;
};

}  // namespace early_fusion::render
