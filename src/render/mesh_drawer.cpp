#include "mesh_drawer.h"

#include <algorithm>
#include <cmath>

namespace early_fusion::render {

namespace {

constexpr float kSubsamplesPerPixel = 4.f * kSubsamples * kSubsamples;

template <class Lanes>
void reserveLanes(std::vector<Lanes>& lanes, std::size_t count) {
  if (lanes.size() < count) lanes.resize(count + count / 2);
}

template <class Element, class Lanes>
Element* elements(std::vector<Lanes>& lanes) {
  return reinterpret_cast<Element*>(lanes.data());
}

FloatLanes evaluate(const LinearForm& form, FloatLanes x, FloatLanes y, FloatLanes z) {
  return form.factor[0] * x + form.factor[1] * y + form.factor[2] * z + form.constant;
}

FloatLanes rotated(const float (&row)[3], FloatLanes x, FloatLanes y, FloatLanes z) {
  return row[0] * x + row[1] * y + row[2] * z;
}

}  // namespace

void MeshDrawer::clear() {
  triangles_.assign(1, VisibleTriangle{});
  reserveLanes(vertices_, 1);
  first_vertex_ = 0;
  mesh_vertices_ = 0;
}

void MeshDrawer::draw(const RenderMesh& mesh, const RenderPose& world_from_mesh, const Projection& world_projection,
                      SampleBuffer& buffer) {
  const Projection projection = world_projection.after(world_from_mesh);
  const Visibility seen = visibility(projection, mesh);
  if (mesh.triangle_count == 0 || seen == Visibility::kOutside) return;
  transform(mesh, world_from_mesh, projection);
  if (seen == Visibility::kNeedsClip) {
    fill(clip(mesh, world_from_mesh, projection), projection, buffer);
  } else {
    fill({{mesh.corner[0].data(), mesh.corner[1].data(), mesh.corner[2].data()},
          mesh.uv_area.data(),
          mesh.material.data(),
          mesh.triangle_count},
         projection, buffer);
  }
  if (projection.perspective) first_vertex_ += mesh_vertices_;
}

void MeshDrawer::reserveVertices(int count) {
  const std::size_t lanes = (count + kLanes - 1) / kLanes;
  reserveLanes(screen_x_, lanes);
  reserveLanes(screen_y_, lanes);
  reserveLanes(depth_, lanes);
  reserveLanes(clip_x_, lanes);
  reserveLanes(clip_y_, lanes);
  reserveLanes(clip_w_, lanes);
  reserveLanes(vertices_, first_vertex_ + lanes * kLanes);
}

void MeshDrawer::transform(const RenderMesh& mesh, const RenderPose& world_from_mesh, const Projection& projection) {
  const int lanes = static_cast<int>(mesh.position[0].size());
  mesh_vertices_ = lanes * kLanes;
  reserveVertices(mesh_vertices_);
  const float middle_x = projection.half_width + 0.5f, middle_y = projection.half_height + 0.5f;
  for (int i = 0; i < lanes; ++i) {
    const FloatLanes px = mesh.position[0][i], py = mesh.position[1][i], pz = mesh.position[2][i];
    clip_x_[i] = evaluate(projection.x, px, py, pz);
    clip_y_[i] = evaluate(projection.y, px, py, pz);
    clip_w_[i] = evaluate(projection.w, px, py, pz);
    const FloatLanes inverse_w = 1.f / highest(clip_w_[i], allLanes(kNearPlane));
    screen_x_[i] = floorToInt(clip_x_[i] * inverse_w + middle_x);
    screen_y_[i] = floorToInt(clip_y_[i] * inverse_w + middle_y);
    if (!projection.perspective) {
      depth_[i] = evaluate(projection.depth, px, py, pz);
      continue;
    }
    depth_[i] = inverse_w;
    const FloatLanes nx = mesh.normal[0][i], ny = mesh.normal[1][i], nz = mesh.normal[2][i];
    const auto& rows = world_from_mesh.rotation;
    storeRecords<8>({toFloat(screen_x_[i]), toFloat(screen_y_[i]), inverse_w, mesh.uv[0][i] * inverse_w,
                     mesh.uv[1][i] * inverse_w, rotated(rows[0], nx, ny, nz) * inverse_w,
                     rotated(rows[1], nx, ny, nz) * inverse_w, rotated(rows[2], nx, ny, nz) * inverse_w},
                    &vertices_[first_vertex_ + i * kLanes].x);
  }
}

ClipVertex MeshDrawer::clipVertex(const RenderMesh& mesh, const RenderPose& world_from_mesh, int index) const {
  const int i = index / kLanes, lane = index % kLanes;
  ClipVertex vertex;
  vertex.value = {clip_x_[i][lane], clip_y_[i][lane],    clip_w_[i][lane],
                  depth_[i][lane],  mesh.uv[0][i][lane], mesh.uv[1][i][lane]};
  for (int row = 0; row < 3; ++row) {
    const float* r = world_from_mesh.rotation[row];
    vertex.value[ClipVertex::kNormalX + row] =
        r[0] * mesh.normal[0][i][lane] + r[1] * mesh.normal[1][i][lane] + r[2] * mesh.normal[2][i][lane];
  }
  return vertex;
}

int MeshDrawer::addVertex(const ClipVertex& vertex, const Projection& projection) {
  const int index = mesh_vertices_++;
  reserveVertices(mesh_vertices_);
  const auto& v = vertex.value;
  const float inverse_w = 1.f / v[ClipVertex::kW];
  const float x = std::floor(v[ClipVertex::kX] * inverse_w + (projection.half_width + 0.5f));
  const float y = std::floor(v[ClipVertex::kY] * inverse_w + (projection.half_height + 0.5f));
  elements<std::int32_t>(screen_x_)[index] = static_cast<std::int32_t>(x);
  elements<std::int32_t>(screen_y_)[index] = static_cast<std::int32_t>(y);
  elements<float>(depth_)[index] = projection.perspective ? inverse_w : v[ClipVertex::kDepth];
  vertices_[first_vertex_ + index] = {
      x,
      y,
      inverse_w,
      v[ClipVertex::kU] * inverse_w,
      v[ClipVertex::kV] * inverse_w,
      {v[ClipVertex::kNormalX] * inverse_w, v[ClipVertex::kNormalY] * inverse_w, v[ClipVertex::kNormalZ] * inverse_w}};
  return index;
}

void MeshDrawer::addTriangle(std::array<std::int32_t, 3> corner, float uv_area, std::int32_t material) {
  const std::size_t index = clipped_material_.size();
  for (int k = 0; k < 3; ++k) {
    reserveLanes(clipped_corner_[k], index / kLanes + 1);
    elements<std::int32_t>(clipped_corner_[k])[index] = corner[k];
  }
  reserveLanes(clipped_uv_area_, index / kLanes + 1);
  elements<float>(clipped_uv_area_)[index] = uv_area;
  clipped_material_.push_back(material);
}

MeshDrawer::Triangles MeshDrawer::clip(const RenderMesh& mesh, const RenderPose& world_from_mesh,
                                       const Projection& projection) {
  clipped_material_.clear();
  for (int i = 0; i < mesh.triangle_count; ++i) {
    std::array<std::int32_t, 3> corner;
    bool safe = true;
    for (int k = 0; k < 3; ++k) {
      corner[k] = mesh.corner[k][i / kLanes][i % kLanes];
      const int lanes = corner[k] / kLanes, lane = corner[k] % kLanes;
      safe = safe && isSafe(clip_x_[lanes][lane], clip_y_[lanes][lane], clip_w_[lanes][lane]);
    }
    if (safe) {
      addTriangle(corner, mesh.uv_area[i / kLanes][i % kLanes], mesh.material[i]);
      continue;
    }
    ClipPolygon polygon;
    for (int k = 0; k < 3; ++k) polygon[k] = clipVertex(mesh, world_from_mesh, corner[k]);
    const int count = clipPolygon(polygon, 3);
    std::array<int, std::tuple_size<ClipPolygon>::value> index;
    for (int k = 0; k < count; ++k) index[k] = addVertex(polygon[k], projection);
    for (int k = 2; k < count; ++k) {
      const auto edge = [&polygon](int end, int axis) {
        return polygon[end].value[ClipVertex::kU + axis] - polygon[0].value[ClipVertex::kU + axis];
      };
      const float uv_area = std::fabs(edge(k - 1, 0) * edge(k, 1) - edge(k, 0) * edge(k - 1, 1));
      addTriangle({index[0], index[k - 1], index[k]}, uv_area, mesh.material[i]);
    }
  }
  const int count = static_cast<int>(clipped_material_.size());
  while (clipped_material_.size() % kLanes != 0) addTriangle({0, 0, 0}, 0.f, 0);
  return {{clipped_corner_[0].data(), clipped_corner_[1].data(), clipped_corner_[2].data()},
          clipped_uv_area_.data(),
          clipped_material_.data(),
          count};
}

TriangleCorners MeshDrawer::gatherCorners(const Triangles& triangles, int batch) const {
  TriangleCorners corners;
  for (int k = 0; k < 3; ++k) {
    const IntLanes index = triangles.corner[k][batch];
    corners.x[k] = gather<IntLanes>(screen_x_.data(), index);
    corners.y[k] = gather<IntLanes>(screen_y_.data(), index);
    corners.depth[k] = gather<FloatLanes>(depth_.data(), index);
  }
  return corners;
}

void MeshDrawer::keep(const Triangles& triangles, int batch, std::uint32_t accepted, const TriangleCorners& corners) {
  // With perspective, depth is 1 / w. The ratio of a triangle's area in its texture to its area on the screen, at a
  // point with depth w, is this times w^3 (the determinant of a projective map).
  const FloatLanes texture_scale = triangles.uv_area[batch] * corners.depth[0] * corners.depth[1] * corners.depth[2] *
                                   batch_.inverse_area * kSubsamplesPerPixel;
  for (; accepted != 0; accepted &= accepted - 1) {
    const int lane = __builtin_ctz(accepted);
    VisibleTriangle triangle{
        batch_.inverse_area[lane], texture_scale[lane], triangles.material[batch * kLanes + lane], {}};
    for (int k = 0; k < 3; ++k) triangle.corner[k] = first_vertex_ + triangles.corner[k][batch][lane];
    triangles_.push_back(triangle);
  }
}

void MeshDrawer::fill(const Triangles& triangles, const Projection& projection, SampleBuffer& buffer) {
  const bool two_sided = !projection.perspective;
  for (int batch = 0; batch * kLanes < triangles.count; ++batch) {
    const TriangleCorners corners = gatherCorners(triangles, batch);
    std::uint32_t accepted = setUp(batch_, corners, two_sided, buffer.width(), buffer.height());
    auto id = static_cast<std::int32_t>(triangles_.size());
    if (projection.perspective) keep(triangles, batch, accepted, corners);
    for (; accepted != 0; accepted &= accepted - 1) buffer.fill(batch_, __builtin_ctz(accepted), id++);
  }
}

}  // namespace early_fusion::render
