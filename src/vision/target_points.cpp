#include "src/vision/fitness.hpp"

namespace gannet::vision {

double TargetPoints::cost(int at) const {
  return static_cast<double>(level[static_cast<std::size_t>(at)].points()) / level[0].points();
}

}  // namespace gannet::vision
