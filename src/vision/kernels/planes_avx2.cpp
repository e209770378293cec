#include "src/vision/kernels/planes_loops.hpp"

namespace gannet::vision {

const PlaneKernels kAvx2PlaneKernels = {"avx2", smooth, halve, limits, pack};

}  // namespace gannet::vision
