#pragma once

#include <Eigen/Core>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "make_meshes/mesh.h"

namespace early_fusion::make_meshes {

/// A colour, red, green, blue in [0, 255].
struct Colour {
  double r = 0, g = 0, b = 0;
};

/// `a` at t = 0, `b` at t = 1.
Colour mix(const Colour& a, const Colour& b, double t);

/// A rectangle of the texture, on a grid of 256 x 256 over the whole of it.
struct Cell {
  static constexpr int kMargin = 2;  ///< on every side

  int x = 0, y = 0, width = 256, height = 256;

  /// The cell without its margin. The margin keeps neighbouring cells out of coarse mip levels.
  UvRect uv() const;
};

/// A part of a texture to draw on, in fractions of the part: (0, 0) top left, (1, 1) bottom right.
class Panel {
 public:
  /// @param pixels shares its memory with the texture.
  explicit Panel(cv::Mat pixels) : pixels_(std::move(pixels)) {}

  void fill(const Colour& colour);
  void verticalGradient(const Colour& top, const Colour& bottom);

  /// Filled shapes with smooth edges.
  void rectangle(double left, double top, double right, double bottom, const Colour& colour);
  void ellipse(double x, double y, double radius_x, double radius_y, const Colour& colour);
  void polygon(const std::vector<Eigen::Vector2d>& points, const Colour& colour);

  /// @param width fraction of the panel's height.
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width, const Colour& colour);

  /// Writes one line of text, as large as fits, into the middle of a rectangle.
  void text(const std::string& words, double left, double top, double right, double bottom, const Colour& colour);

  /// Grey rows that look like small print from a distance.
  void smallPrint(double left, double top, double right, double bottom, int rows, const Colour& colour);

  /// Recolours every pixel: `recolour(x, y, colour so far)`, x and y in [0, 1].
  void paint(const std::function<Colour(double x, double y, const Colour& colour)>& recolour);

  /// Multiplies the brightness by 1 +- `strength` of fractal noise.
  void mottle(int cells, double strength, unsigned seed);

 private:
  cv::Point fixedPoint(double x, double y) const;

  cv::Mat pixels_;
};

/// A texture that is drawn at twice its size and then reduced.
class Canvas {
 public:
  /// @param size edge of the finished texture [px].
  Canvas(int size, const Colour& background);

  Panel panel(const Cell& cell);
  Panel whole() { return panel(Cell{}); }

  /// The texture in its own size, 8-bit BGR.
  cv::Mat finish() const;

 private:
  int size_;
  cv::Mat pixels_;
};

}  // namespace early_fusion::make_meshes
