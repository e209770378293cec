// Frames of a test as the text of can-utils.
#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "hal/can/can_text.hpp"

namespace gannet::hal {

using Texts = std::vector<std::string>;

inline std::vector<CanFrame> frames_from(const Texts& texts) {
  std::vector<CanFrame> frames;
  for (const std::string& text : texts) {
    const auto frame = can_frame_from_text(text);
    EXPECT_TRUE(frame) << frame.error().text;
    frames.push_back(*frame);
  }
  return frames;
}

inline Texts texts_of(std::span<const CanFrame> frames) {
  Texts texts;
  for (const CanFrame& frame : frames) texts.push_back(to_text(frame));
  return texts;
}

}  // namespace gannet::hal
