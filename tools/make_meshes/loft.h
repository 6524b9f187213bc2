#pragma once

#include <Eigen/Core>
#include <vector>

#include "make_meshes/mesh.h"

namespace early_fusion::make_meshes {

/// A closed section of a surface [m], counter-clockwise about the direction from one section to the next.
using Ring = std::vector<Eigen::Vector3d>;

/// How the texture lies on a lofted surface.
enum class Wrap {
  kAround,  ///< u by length around the widest ring, v by length along, from the rect's bottom (first ring) to its top
  kFlat     ///< u along x and v against y, as seen from above, the rect spanning the widest extent: for lids
};

/// The surface through rings of equally many points. A ring may be a single point, repeated. With single points at both
/// ends the surface is closed.
Mesh loft(const std::vector<Ring>& rings, const UvRect& uv, Wrap wrap = Wrap::kAround);

/// A point as a ring, to end a loft with.
Ring pointRing(const Eigen::Vector3d& point, int count);

/// An ellipse in a plane of constant z, starting on the x axis. @param radius_x, radius_y [m]
Ring ellipseRing(double radius_x, double radius_y, double z, int count);

/// A rectangle with round corners in a plane of constant z, starting in the middle of its +x side.
///
/// @param size_x, size_y, radius [m]. @param per_corner points on each corner. @param per_side pieces of each side;
/// even.
Ring roundedRectangleRing(double size_x, double size_y, double radius, double z, int per_corner, int per_side);

/// The surface that `profile`, points (radius, z) [m], sweeps about the z axis. Facing outwards when the profile leads
/// from the axis at the bottom up to the axis at the top, also by way of the inside of a vessel.
Mesh revolve(const std::vector<Eigen::Vector2d>& profile, int segments, const UvRect& uv, Wrap wrap = Wrap::kAround);

/// A solid along a plane curve, closed at its ends.
///
/// @param spine the curve [m]. @param plane_normal unit normal of its plane.
/// @param radii one a spine point: half the width along `plane_normal` and half the width in the plane [m].
Mesh sweep(const std::vector<Eigen::Vector3d>& spine, const Eigen::Vector3d& plane_normal,
           const std::vector<Eigen::Vector2d>& radii, int segments, const UvRect& uv);

}  // namespace early_fusion::make_meshes
