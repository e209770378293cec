// Captures: where the target truly was at each of the last exposures, asked by the time that the
// daemon says a frame was taken. A device's stamps may be rounded to microseconds. World's thread
// alone.
#pragma once

#include <map>

#include "platform/base/time.hpp"
#include "src/core/transform.hpp"

namespace gannet::world {

class Captures {
 public:
  void add(TimePoint time, const Transform<LeftCamera, Target>& truth) {
    truths_[time] = truth;
    if (truths_.size() > kKept) truths_.erase(truths_.begin());
  }
  // Identity: nothing was exposed then.
  Transform<LeftCamera, Target> at(TimePoint time) const {
    const auto found = truths_.lower_bound(time - kRounding);
    const bool is_near = found != truths_.end() && found->first <= time + kRounding;
    return is_near ? found->second : Transform<LeftCamera, Target>();
  }

 private:
  static constexpr std::size_t kKept = 200;
  static constexpr Duration kRounding = std::chrono::microseconds(2);
  std::map<TimePoint, Transform<LeftCamera, Target>> truths_;
};

}  // namespace gannet::world
