// The pictures of one run: kept frames with the recognised outline and axes drawn on both images.
// Normal thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/camera/image.hpp"
#include "src/tool/report_run.hpp"

namespace gannet::tool {

struct ReportPicture {
  double time_s = 0;
  hal::Image image;        // left and right beside each other
  double distance_mm = 0;  // from the goal, at the exposure
  double yaw_deg = 0;
  const ReportFrame* frame = nullptr;  // of the run
};

// At most so many of the kept frames in which the target was found, close together at the
// beginning. Error: a frame or model cannot be read.
Result<std::vector<ReportPicture>> run_pictures(const ReportRun& run, int most);

std::string caption_of(const ReportPicture& picture);

// The left eyes of two pictures with words on them, for a README.
hal::Image before_and_after(const ReportPicture& before, const ReportPicture& after);

Result<std::vector<std::uint8_t>> jpeg_of(const hal::Image& image, int quality);

}  // namespace gannet::tool
