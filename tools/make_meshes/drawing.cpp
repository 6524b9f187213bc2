#include "make_meshes/drawing.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "make_meshes/noise.h"

namespace early_fusion::make_meshes {
namespace {

constexpr int kOversampling = 2;
constexpr int kGrid = 256;        // units of Cell
constexpr int kFractionBits = 4;  // of OpenCV's fixed-point coordinates

cv::Scalar bgr(const Colour& colour) { return {colour.b, colour.g, colour.r}; }

unsigned char toByte(double value) { return static_cast<unsigned char>(std::clamp(value + 0.5, 0.0, 255.0)); }

}  // namespace

Colour mix(const Colour& a, const Colour& b, double t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

UvRect Cell::uv() const {
  return {Eigen::Vector2d(x + kMargin, y + kMargin) / kGrid,
          Eigen::Vector2d(x + width - kMargin, y + height - kMargin) / kGrid};
}

cv::Point Panel::fixedPoint(double x, double y) const {
  const int one = 1 << kFractionBits;
  // OpenCV's integer coordinates are pixel centres.
  return {static_cast<int>(std::lround((x * pixels_.cols - 0.5) * one)),
          static_cast<int>(std::lround((y * pixels_.rows - 0.5) * one))};
}

void Panel::fill(const Colour& colour) { pixels_.setTo(bgr(colour)); }

void Panel::verticalGradient(const Colour& top, const Colour& bottom) {
  paint([&](double, double y, const Colour&) { return mix(top, bottom, y); });
}

void Panel::rectangle(double left, double top, double right, double bottom, const Colour& colour) {
  polygon({{left, top}, {right, top}, {right, bottom}, {left, bottom}}, colour);
}

void Panel::ellipse(double x, double y, double radius_x, double radius_y, const Colour& colour) {
  const int one = 1 << kFractionBits;
  const cv::Size axes(static_cast<int>(std::lround(radius_x * pixels_.cols * one)),
                      static_cast<int>(std::lround(radius_y * pixels_.rows * one)));
  cv::ellipse(pixels_, fixedPoint(x, y), axes, 0, 0, 360, bgr(colour), cv::FILLED, cv::LINE_AA, kFractionBits);
}

void Panel::polygon(const std::vector<Eigen::Vector2d>& points, const Colour& colour) {
  std::vector<cv::Point> corners;
  for (const Eigen::Vector2d& point : points) corners.push_back(fixedPoint(point.x(), point.y()));
  cv::fillPoly(pixels_, std::vector<std::vector<cv::Point>>{corners}, bgr(colour), cv::LINE_AA, kFractionBits);
}

void Panel::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width, const Colour& colour) {
  const int thickness = std::max(1, static_cast<int>(std::lround(width * pixels_.rows)));
  cv::line(pixels_, fixedPoint(from.x(), from.y()), fixedPoint(to.x(), to.y()), bgr(colour), thickness, cv::LINE_AA,
           kFractionBits);
}

void Panel::text(const std::string& words, double left, double top, double right, double bottom, const Colour& colour) {
  const int font = cv::FONT_HERSHEY_DUPLEX;
  const double width = (right - left) * pixels_.cols, height = (bottom - top) * pixels_.rows;
  // Strokes a fifth of the letters' height are still there after the texture has been reduced.
  int baseline = 0;
  const cv::Size unit = cv::getTextSize(words, font, 1.0, 1, &baseline);
  const double scale = std::min(width / unit.width, height / unit.height);
  const int thickness = std::max(1, static_cast<int>(std::lround(0.18 * scale * unit.height)));
  const cv::Point origin(static_cast<int>(std::lround(left * pixels_.cols + (width - scale * unit.width) / 2)),
                         static_cast<int>(std::lround(top * pixels_.rows + (height + scale * unit.height) / 2)));
  cv::putText(pixels_, words, origin, font, scale, bgr(colour), thickness, cv::LINE_AA);
}

void Panel::smallPrint(double left, double top, double right, double bottom, int rows, const Colour& colour) {
  for (int row = 0; row < rows; ++row) {
    const double height = (bottom - top) / rows;
    const double length = (right - left) * (0.65 + 0.35 * hashNoise(row, rows, 17));
    rectangle(left, top + row * height, left + length, top + (row + 0.5) * height, colour);
  }
}

void Panel::paint(const std::function<Colour(double x, double y, const Colour& colour)>& recolour) {
  for (int row = 0; row < pixels_.rows; ++row) {
    for (int column = 0; column < pixels_.cols; ++column) {
      auto& pixel = pixels_.at<cv::Vec3b>(row, column);
      const Colour now{double(pixel[2]), double(pixel[1]), double(pixel[0])};
      const Colour then = recolour((column + 0.5) / pixels_.cols, (row + 0.5) / pixels_.rows, now);
      pixel = {toByte(then.b), toByte(then.g), toByte(then.r)};
    }
  }
}

void Panel::mottle(int cells, double strength, unsigned seed) {
  paint([&](double x, double y, const Colour& colour) {
    return mix({0, 0, 0}, colour, 1 + strength * (2 * fractalNoise(x, y, cells, cells, seed) - 1));
  });
}

Canvas::Canvas(int size, const Colour& background)
    : size_(size), pixels_(size * kOversampling, size * kOversampling, CV_8UC3, bgr(background)) {}

Panel Canvas::panel(const Cell& cell) {
  const int unit = size_ * kOversampling / kGrid;
  return Panel(pixels_(cv::Rect(cell.x * unit, cell.y * unit, cell.width * unit, cell.height * unit)));
}

cv::Mat Canvas::finish() const {
  cv::Mat finished;
  cv::resize(pixels_, finished, cv::Size(size_, size_), 0, 0, cv::INTER_AREA);
  return finished;
}

}  // namespace early_fusion::make_meshes
