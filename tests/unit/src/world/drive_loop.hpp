// A drive group and its nodes on one wire, in cycles of 5 ms, for the tests of nodes.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "hal/can/can_text.hpp"
#include "hal/drive/drive_kinds.hpp"
#include "src/world/motor_nodes.hpp"

namespace gannet::world {

class DriveLoop : public testing::Test {
 protected:
  void make(const hal::DriveConfig& config, std::unique_ptr<MotorNodes> nodes) {
    auto drive = hal::make_drive_group(config);
    ASSERT_TRUE(drive) << drive.error().text;
    drive_ = std::move(*drive);
    nodes_ = std::move(nodes);
  }
  void run(int cycles, const std::vector<double>& values, bool enable, bool daemon_lives = true) {
    std::vector<hal::DriveSetpoint> setpoints;
    for (const double value : values) setpoints.push_back({value});
    std::vector<hal::CanFrame> sent(static_cast<std::size_t>(drive_->max_frames()));
    for (int i = 0; i < cycles; ++i, ms_ += 5) {
      int n = 0;
      if (daemon_lives) n = drive_->send(setpoints, enable, now(), sent);
      heard_.clear();
      const auto carried = carry(std::span(sent).first(static_cast<std::size_t>(n)));
      throttles_ = nodes_->step(now(), carried, heard_);
      for (const hal::CanFrame& frame : carry(heard_)) {
        log_ += hal::to_text(frame) + '\n';
        if (daemon_lives) drive_->receive(frame, now());
      }
    }
  }
  // What arrives on a wire that loses frames and says some twice, as a sender does that has missed
  // the confirmation.
  std::vector<hal::CanFrame> carry(std::span<const hal::CanFrame> frames) {
    std::vector<hal::CanFrame> carried;
    for (const hal::CanFrame& frame : frames) {
      if (loss_ > 0 && random_.uniform() < loss_) continue;
      carried.push_back(frame);
      if (repeat_ > 0 && random_.uniform() < repeat_) carried.push_back(frame);
    }
    return carried;
  }
  // Not enabled, until the drives' own guards have been seen.
  void make_ready() {
    run(800, {}, false);
    ASSERT_TRUE(health().all_alive && health().all_ready && health().guards_itself)
        << health().trouble;
  }
  double throttle(std::size_t motor) const { return throttles_[motor]; }
  TimePoint now() const { return TimePoint(std::chrono::milliseconds(ms_)); }
  hal::DriveGroupHealth health() const { return drive_->health(now()); }

  std::unique_ptr<hal::DriveGroup> drive_;
  std::unique_ptr<MotorNodes> nodes_;
  std::vector<hal::CanFrame> heard_;
  std::span<const double> throttles_;
  std::string log_;
  double loss_ = 0, repeat_ = 0;  // shares of the frames, both ways
  Random random_{3};
  std::int64_t ms_ = 1000;
};

}  // namespace gannet::world
