#include "early_fusion/model/annotation.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace early_fusion::model {

namespace {

/// White letters with a dark outline: readable on any background.
void drawText(cv::Mat& canvas, const std::string& text, cv::Point origin, double size) {
  const int thickness = std::max(1, static_cast<int>(std::lround(2 * size)));
  cv::putText(canvas, text, origin, cv::FONT_HERSHEY_SIMPLEX, size, {0, 0, 0}, 3 * thickness, cv::LINE_AA);
  cv::putText(canvas, text, origin, cv::FONT_HERSHEY_SIMPLEX, size, {255, 255, 255}, thickness, cv::LINE_AA);
}

}  // namespace

double coneRadiusPx(double cone_half_angle_rad, double horizontal_fov_rad, int image_size) {
  return 0.5 * image_size * std::tan(cone_half_angle_rad) / std::tan(0.5 * horizontal_fov_rad);
}

core::Image annotate(const core::Image& image, const Annotation& annotation, int scale) {
  core::Image result(image.width * scale, image.height * scale);
  const cv::Mat source(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data()));
  cv::Mat canvas(result.height, result.width, CV_8UC3, result.rgb.data());
  cv::resize(source, canvas, canvas.size(), 0, 0, cv::INTER_NEAREST);
  for (const Box& box : annotation.boxes) {
    const cv::Point corner(box.left * scale, box.top * scale), opposite(box.right * scale, box.bottom * scale);
    cv::rectangle(canvas, corner, opposite, {0, 0, 0}, 3);
    cv::rectangle(canvas, corner, opposite, {80, 255, 80}, 1);
  }
  if (annotation.cone_radius_px > 0) {
    const cv::Point centre(result.width / 2, result.height / 2);
    const int radius = static_cast<int>(std::lround(annotation.cone_radius_px * scale));
    cv::circle(canvas, centre, radius, {0, 0, 0}, 3, cv::LINE_AA);
    cv::circle(canvas, centre, radius, {255, 220, 0}, 1, cv::LINE_AA);
  }

  const double size = result.height / 720.0;
  const int line = static_cast<int>(std::lround(32 * size));
  int y = line;
  for (const std::string& item : annotation.request) {
    drawText(canvas, item, {line / 3, y}, size);
    y += line;
  }
  if (!annotation.note.empty()) drawText(canvas, annotation.note, {line / 3, result.height - line / 2}, size);
  if (!annotation.action.empty()) {
    const int note_lines = annotation.note.empty() ? 0 : 1;
    drawText(canvas, annotation.action, {line / 3, result.height - line / 2 - note_lines * line}, 1.2 * size);
  }
  return result;
}

}  // namespace early_fusion::model
