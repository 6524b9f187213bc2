#include <algorithm>
#include <cmath>

#include "make_meshes/curve.h"
#include "make_meshes/drawing.h"
#include "make_meshes/finish_object.h"
#include "make_meshes/loft.h"
#include "make_meshes/objects.h"

namespace early_fusion::make_meshes {
namespace {

// Labels. Each has the proportions of the surface that it covers.
constexpr Cell kSoupLabel{0, 0, 256, 115};
constexpr Cell kMeatLabel{0, 0, 256, 69};
constexpr Cell kMustardLabel{0, 0, 256, 160};
constexpr Cell kLid{0, 160, 96, 96};
constexpr Cell kBase{96, 160, 96, 96};
constexpr Cell kRim{192, 160, 64, 96};

const Colour kTin{176, 178, 182};

// Rings begin in the middle of the broad +x side. If they began in the middle of the narrow -y side, the label's seam
// would be there, and the broad sides would show the label at a quarter and at three quarters of its width.
std::vector<Ring> seamOnNarrowSide(std::vector<Ring> rings) {
  for (Ring& ring : rings) std::rotate(ring.begin(), ring.end() - ring.size() / 4, ring.end());
  return rings;
}

// A stamped tin lid.
void drawLid(Panel panel) {
  panel.fill(kTin);
  for (int ring = 0; ring < 4; ++ring) {
    const double radius = 0.46 - 0.09 * ring;
    panel.ellipse(0.5, 0.5, radius, radius, ring % 2 == 0 ? Colour{138, 140, 146} : Colour{204, 206, 210});
  }
}

}  // namespace

Model tomatoSoupCan() {
  const Colour red{206, 22, 26}, white{248, 246, 240}, gold{214, 170, 60};
  Canvas canvas(kObjectTextureSize, kTin);
  Panel label = canvas.panel(kSoupLabel);
  label.fill(white);
  label.rectangle(0, 0, 1, 0.52, red);
  for (const double left : {0.0, 0.5}) {
    label.text("TOMATO", left + 0.05, 0.12, left + 0.45, 0.40, white);
    label.ellipse(left + 0.25, 0.54, 0.05, 0.11, gold);
    label.text("SOUP", left + 0.1, 0.68, left + 0.4, 0.9, red);
  }
  drawLid(canvas.panel(kLid));
  drawLid(canvas.panel(kBase));
  const double r = 0.034, h = 0.102;
  const int segments = 28;
  Mesh mesh = revolve({{0, 0.002}, {r - 0.004, 0.002}, {r - 0.002, 0}}, segments, kBase.uv(), Wrap::kFlat);
  append(mesh, revolve({{r - 0.002, 0}, {r, 0.001}, {r, 0.004}, {r - 0.001, 0.005}}, segments, kRim.uv()));
  append(mesh,
         revolve({{r - 0.001, 0.005}, {r - 0.001, 0.03}, {r - 0.001, 0.055}, {r - 0.001, 0.08}, {r - 0.001, h - 0.005}},
                 segments, kSoupLabel.uv()));
  append(mesh, revolve({{r - 0.001, h - 0.005}, {r, h - 0.004}, {r, h - 0.001}, {r - 0.002, h}}, segments, kRim.uv()));
  append(mesh, revolve({{r - 0.002, h}, {r - 0.004, h - 0.003}, {0, h - 0.003}}, segments, kLid.uv(), Wrap::kFlat));
  return finishObject("tomato_soup_can", mesh, canvas, 0.25);
}

Model pottedMeatCan() {
  const Colour blue{20, 52, 150}, yellow{250, 214, 40}, ham{236, 150, 140}, white{240, 240, 240};
  Canvas canvas(kObjectTextureSize, kTin);
  Panel label = canvas.panel(kMeatLabel);
  label.fill(blue);
  for (const double middle : {0.25, 0.75}) {
    label.text("HAM", middle - 0.16, 0.05, middle + 0.16, 0.42, yellow);
    label.ellipse(middle, 0.66, 0.10, 0.19, white);
    label.ellipse(middle, 0.66, 0.085, 0.15, ham);
  }
  label.rectangle(0, 0.88, 1, 1, yellow);
  Panel lid = canvas.panel(kLid);
  lid.fill(kTin);
  lid.rectangle(0.12, 0.12, 0.88, 0.88, {150, 152, 158});
  lid.ellipse(0.5, 0.72, 0.12, 0.16, {214, 216, 220});
  lid.ellipse(0.5, 0.74, 0.06, 0.09, {120, 122, 128});
  canvas.panel(kBase).mottle(8, 0.06, 3);
  const auto ring = [](double inset, double z) {
    return roundedRectangleRing(0.060 - 2 * inset, 0.102 - 2 * inset, 0.02 - inset, z, 5, 4);
  };
  const int count = static_cast<int>(ring(0, 0).size());
  const double h = 0.084;
  Mesh mesh = loft({pointRing({0, 0, 0}, count), ring(0.002, 0)}, kBase.uv(), Wrap::kFlat);
  append(mesh, loft({ring(0.002, 0), ring(0, 0.002), ring(0, 0.004)}, kRim.uv()));
  append(mesh,
         loft(seamOnNarrowSide({ring(0, 0.004), ring(0, 0.03), ring(0, 0.055), ring(0, h - 0.005)}), kMeatLabel.uv()));
  append(mesh, loft({ring(0, h - 0.005), ring(0, h - 0.001), ring(0.001, h)}, kRim.uv()));
  append(mesh,
         loft({ring(0.001, h), ring(0.004, h - 0.003), pointRing({0, 0, h - 0.003}, count)}, kLid.uv(), Wrap::kFlat));
  return finishObject("potted_meat_can", mesh, canvas, 0.2);
}

namespace {

void drawMustardLabel(Panel panel) {
  const Colour yellow{236, 168, 0}, red{186, 24, 20}, cream{252, 240, 190};
  panel.verticalGradient({240, 176, 4}, {222, 150, 0});
  for (const double middle : {0.25, 0.75}) {
    panel.ellipse(middle, 0.62, 0.16, 0.22, red);
    panel.ellipse(middle, 0.62, 0.145, 0.19, cream);
    panel.text("MUSTARD", middle - 0.13, 0.55, middle + 0.13, 0.7, red);
  }
  panel.rectangle(0, 0.93, 1, 1, yellow);
}

// The squeezable body: an oval that rounds off at the foot and draws in to a round neck.
std::vector<Ring> mustardBody(int count) {
  const std::vector<Eigen::Vector3d> outline = smoothCurve<3>({{0.026, 0.040, 0.0},
                                                               {0.0325, 0.0475, 0.008},
                                                               {0.033, 0.0485, 0.05},
                                                               {0.032, 0.046, 0.095},
                                                               {0.029, 0.040, 0.118},
                                                               {0.022, 0.027, 0.135},
                                                               {0.017, 0.018, 0.142}},
                                                              2);
  std::vector<Ring> rings;
  for (const Eigen::Vector3d& oval : outline) rings.push_back(ellipseRing(oval.x(), oval.y(), oval.z(), count));
  return rings;
}

}  // namespace

Model mustardBottle() {
  const Colour cap{250, 214, 70}, tip{170, 30, 20};
  Canvas canvas(kObjectTextureSize, {236, 168, 0});
  drawMustardLabel(canvas.panel(kMustardLabel));
  canvas.panel(kRim).fill(cap);
  canvas.panel(kLid).fill(tip);
  canvas.panel(kBase).fill({200, 140, 0});
  const int count = 28;
  const std::vector<Ring> body = mustardBody(count);
  Mesh mesh = loft({pointRing({0, 0, 0}, count), body.front()}, kBase.uv(), Wrap::kFlat);
  append(mesh, loft(seamOnNarrowSide(body), kMustardLabel.uv()));
  const Ring neck = body.back();
  append(mesh, loft({neck, ellipseRing(0.0175, 0.0175, 0.142, count), ellipseRing(0.0175, 0.0175, 0.157, count),
                     ellipseRing(0.015, 0.015, 0.160, count), ellipseRing(0.008, 0.008, 0.163, count),
                     ellipseRing(0.0065, 0.0065, 0.175, count)},
                    kRim.uv()));
  append(mesh, loft({ellipseRing(0.0065, 0.0065, 0.175, count), ellipseRing(0.004, 0.004, 0.190, count),
                     pointRing({0, 0, 0.191}, count)},
                    kLid.uv()));
  return finishObject("mustard_bottle", mesh, canvas, 0.2);
}

}  // namespace early_fusion::make_meshes
