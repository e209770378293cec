#include "src/vision/kernels/planes_loops.hpp"

namespace gannet::vision {

const PlaneKernels kScalarPlaneKernels = {"scalar", smooth, halve, limits, pack};

}  // namespace gannet::vision
