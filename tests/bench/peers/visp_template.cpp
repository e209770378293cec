#include "tests/bench/peers/visp_template.hpp"

#if __has_include(<visp3/tt/vpTemplateTrackerZNCCInverseCompositional.h>)
#include <visp3/core/vpException.h>
#include <visp3/tt/vpTemplateTrackerWarpHomography.h>
#include <visp3/tt/vpTemplateTrackerZNCCInverseCompositional.h>

#include <cmath>
#include <vector>

namespace gannet::bench {
namespace {

using Grey = vpImage<unsigned char>;

// Zero-mean normalised correlation: the one of ViSP's costs that stands a change of light. A Gauss
// pyramid of two, every second pixel, as in ViSP's own example.
class Zncc : public VispTemplate {
 public:
  Zncc(const Grey& picture, const std::vector<vpImagePoint>& triangles) : frame_(picture) {
    tracker_.setSampling(2, 2);
    tracker_.setLambda(0.001);
    tracker_.setIterationMax(100);
    tracker_.setPyramidal(2, 1);
    tracker_.initFromPoints(picture, triangles);
  }

  void start_at(const Eigen::Matrix3d& h) override {
    vpMatrix from_picture(3, 3);
    for (unsigned r = 0; r < 3; ++r) {
      for (unsigned c = 0; c < 3; ++c) from_picture[r][c] = h(r, c);
    }
    warp_.getParam(from_picture, parameters_);
  }

  std::optional<Eigen::Matrix3d> track(const std::uint8_t* grey, int step) override {
    for (unsigned i = 0; i < frame_.getSize(); ++i) {
      frame_.bitmap[i] = grey[static_cast<std::size_t>(step) * i];
    }
    try {
      tracker_.setp(parameters_);
      tracker_.track(frame_);
    } catch (const vpException&) {
      return std::nullopt;  // the next frame starts from the last that was not lost
    }
    const vpColVector p = tracker_.getp();
    for (unsigned i = 0; i < p.size(); ++i) {
      if (!std::isfinite(p[i])) return std::nullopt;
    }
    parameters_ = p;
    const vpHomography found = warp_.getHomography(p);
    Eigen::Matrix3d h;
    for (unsigned r = 0; r < 3; ++r) {
      for (unsigned c = 0; c < 3; ++c) h(r, c) = found[r][c];
    }
    return h;
  }

 private:
  Grey frame_;
  vpTemplateTrackerWarpHomography warp_;
  vpTemplateTrackerZNCCInverseCompositional tracker_{&warp_};
  vpColVector parameters_{8};
};

}  // namespace

std::unique_ptr<VispTemplate> VispTemplate::create(const std::uint8_t* grey, int width, int height,
                                                   double cx, double cy, double half_px) {
  Grey picture(static_cast<unsigned>(height), static_cast<unsigned>(width));
  for (unsigned i = 0; i < picture.getSize(); ++i) picture.bitmap[i] = grey[i];
  const vpImagePoint a(cy - half_px, cx - half_px), b(cy - half_px, cx + half_px),
      c(cy + half_px, cx + half_px), d(cy + half_px, cx - half_px);
  return std::make_unique<Zncc>(picture, std::vector<vpImagePoint>{a, b, c, a, c, d});
}

}  // namespace gannet::bench

#else

namespace gannet::bench {
std::unique_ptr<VispTemplate> VispTemplate::create(const std::uint8_t*, int, int, double, double,
                                                   double) {
  return nullptr;
}
}  // namespace gannet::bench

#endif
