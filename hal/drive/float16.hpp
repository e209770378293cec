// IEEE 754 half precision, which DroneCAN uses for volts, amperes and kelvins. To half: nearest,
// ties to even, beyond 65504 infinite. NaN and infinity survive both ways. RT safe.
#pragma once

#include <cstdint>

namespace gannet::hal {

std::uint16_t float16_from(float value);
float float_from(std::uint16_t half);

}  // namespace gannet::hal
