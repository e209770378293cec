// KeptFrames: every so-manieth pair that the simulated cameras took, as left/*.jpg, right/*.jpg and
// times.csv (frame,time_s of the scenario): a folder that `gannet track` and replay cameras read.
// The cameras' drawing thread alone.
#pragma once

#include <cstdint>
#include <string>

#include "hal/camera/image_view.hpp"
#include "platform/base/result.hpp"

namespace gannet::world {

class KeptFrames {
 public:
  // every: 1 keeps all, 0 none. The folder is made, files in it are replaced.
  // Error: it cannot be made.
  static Result<KeptFrames> create(const std::string& folder, int every);

  // number: of the exposure, from 1. Failures are counted: a full disk must not end the run.
  void take(std::uint64_t number, double time_s, const hal::ImageView& left,
            const hal::ImageView& right);
  std::uint64_t failures() const { return failures_; }

 private:
  KeptFrames(std::string folder, int every) : folder_(std::move(folder)), every_(every) {}
  std::string folder_;
  int every_ = 0;
  std::string times_ = "frame,time_s\n";
  std::uint64_t failures_ = 0;
};

}  // namespace gannet::world
