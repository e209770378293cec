#!/bin/bash
# arm64.sh TRIPLET: cross-compiles the rooms whose code differs by processor and runs their tests
# under qemu: the NEON kernels against scalar, bit by bit, and the loops that prepare planes and sum
# for the refinement as this compiler makes them. (The whole package comes with make deb.)
set -eu
triplet=$1
out=build/arm64
mkdir -p "$out"
flags="-std=c++20 -O2 -ffp-contract=off -fno-math-errno -I. -isystem /usr/include/eigen3 -Wall -Wextra -Werror"
echo "  ARM64 kernels"
# shellcheck disable=SC2086
"$triplet-g++" $flags -static -I/usr/src/googletest/googletest -I/usr/src/googletest/googletest/include \
  -o "$out/kernels_test" src/vision/kernels/kernels_scalar.cpp src/vision/kernels/kernels_neon.cpp \
  src/vision/kernels/planes.cpp src/vision/kernels/planes_scalar.cpp \
  src/vision/kernels/refine_sums.cpp src/vision/kernels/refine_scalar.cpp \
  src/vision/kernel_choice.cpp tests/unit/src/vision/kernels_test.cpp \
  tests/unit/src/vision/planes_test.cpp tests/unit/src/vision/refine_sums_test.cpp \
  /usr/src/googletest/googletest/src/gtest-all.cc /usr/src/googletest/googletest/src/gtest_main.cc -pthread
qemu-aarch64-static "$out/kernels_test"
