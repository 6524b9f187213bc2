#pragma once

#include <Eigen/Core>

#include "make_meshes/mesh.h"

namespace early_fusion::make_meshes {

/// Where on the texture the faces of a box lie. Side faces stand upright as seen from outside; the top is seen from
/// above, with the front at the lower edge, and the bottom from below, with the front at the upper edge.
struct BoxFaces {
  UvRect front;  ///< faces +x
  UvRect back;   ///< faces -x
  UvRect left;   ///< faces -y: to the left when one looks at the front
  UvRect right;  ///< faces +y
  UvRect top;
  UvRect bottom;
};

/// A box centred on the origin with round edges.
///
/// @param size [m]. @param radius of the edges [m], less than half of any size.
/// @param flat_pieces, round_pieces cuts of each face's flat part, and of the half edge on either side of it.
Mesh roundedBox(const Eigen::Vector3d& size, double radius, const BoxFaces& faces, int flat_pieces = 6,
                int round_pieces = 1);

/// A box centred on the origin with sharp edges, every face on the same part of the texture: 12 triangles.
Mesh plainBox(const Eigen::Vector3d& size, const UvRect& uv);

}  // namespace early_fusion::make_meshes
