#include "src/vision/kernels/refine_loops.hpp"

namespace gannet::vision {

const RefineKernels kAvx2RefineKernels = {"avx2", add_part<6>, add_part<3>};

}  // namespace gannet::vision
