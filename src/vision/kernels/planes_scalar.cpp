#include "src/vision/kernels/planes_loops.hpp"

namespace gannet::vision {

const PlaneKernels kScalarPlaneKernels = {"scalar", smooth, halve, halve_packed, limits, pack};

}  // namespace gannet::vision
