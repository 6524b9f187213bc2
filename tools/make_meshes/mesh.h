#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace early_fusion::make_meshes {

/// One corner of a triangle.
struct Corner {
  Eigen::Vector3d position;                          ///< [m]
  Eigen::Vector2d uv;                                ///< texture coordinates, v downwards in the image
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length once smoothNormals() has run
};

/// Counter-clockwise seen from outside.
using Triangle = std::array<Corner, 3>;

/// A triangle soup; corners at one position count as one point.
using Mesh = std::vector<Triangle>;

/// A rectangle of the texture [fractions of its edge]; beyond [0, 1] the texture repeats.
struct UvRect {
  Eigen::Vector2d top_left{0, 0};
  Eigen::Vector2d bottom_right{1, 1};

  /// @param u 0 left to 1 right. @param v 0 top to 1 bottom.
  Eigen::Vector2d at(double u, double v) const;
};

void append(Mesh& mesh, const Mesh& more);

/// Adds a triangle, or nothing where two corners coincide.
void addTriangle(Mesh& mesh, const Corner& a, const Corner& b, const Corner& c);

/// Adds a four-sided face, cut into columns x rows quads.
///
/// @param corners bottom left, bottom right, top right, top left, seen from outside [m]; two may coincide.
void addPatch(Mesh& mesh, const std::array<Eigen::Vector3d, 4>& corners, int columns, int rows, const UvRect& uv);

void transform(Mesh& mesh, const Eigen::Isometry3d& pose);

/// Moves the mesh such that it stands on z = 0 with the centre of its bounding box above the origin.
void standOnOrigin(Mesh& mesh);

/// Gives every corner the mean normal of the faces around its point, weighted by their angles there, leaving out faces
/// turned by more than `crease_deg` from the corner's own: edges sharper than that stay sharp.
void smoothNormals(Mesh& mesh, double crease_deg);

Eigen::AlignedBox3d bounds(const Mesh& mesh);

/// Volume that the surface encloses [m^3]; negative when the triangles face inwards.
double signedVolume(const Mesh& mesh);

}  // namespace early_fusion::make_meshes
