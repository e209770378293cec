#include "src/vision/kernels/refine_loops.hpp"

namespace gannet::vision {

const RefineKernels kScalarRefineKernels = {"scalar", add_part<6>, add_part<3>};

}  // namespace gannet::vision
