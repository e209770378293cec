#include "src/vision/kernels/planes_loops.hpp"

namespace gannet::vision {

const PlaneKernels kAvx2PlaneKernels = {"avx2", smooth, halve, halve_packed, limits, pack};

}  // namespace gannet::vision
