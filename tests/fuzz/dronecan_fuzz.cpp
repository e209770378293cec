// libFuzzer entry: a DroneCAN drive under any frames. The input is frames of 13 bytes (4 id, 1
// length, 8 data; the id's upper bits choose what it looks like). Whatever comes, the drive goes on
// commanding all its motors within their range.
#include <cstdlib>
#include <cstring>

#include "hal/drive/dronecan_esc_drive.hpp"

using namespace gannet;
using namespace gannet::hal;

namespace {

CanFrame frame_from(const std::uint8_t* bytes) {
  CanFrame frame = {.extended = true};
  std::memcpy(&frame.id, bytes, 4);
  // Mostly ids that somebody listens to: random ones would all be ignored.
  const std::uint32_t kind = frame.id >> 29, node = frame.id & 0x7F;
  if (kind == 1) frame.id = 0x10040A00 | node;                   // esc.Status
  if (kind == 2) frame.id = 0x10015500 | node;                   // NodeStatus
  if (kind == 3) frame.id = 0x18010A80 | node;                   // GetNodeInfo answer
  if (kind == 4) frame.id = 0x18018A80 | node;                   // GetNodeInfo request
  if (kind == 5) frame.id = 0x10000100 | (frame.id & 0xFFFC00);  // Allocation
  frame.id &= kMaxExtendedId;
  frame.length = bytes[4] % 10;  // also one that is too long
  std::memcpy(frame.data.data(), bytes + 5, 8);
  return frame;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  DriveConfig config;
  for (int i = 0; i < 6; ++i) config.motors.push_back({.index = i, .node_id = 21 + i});
  auto drive = DroneCanEscDrive::create(config);
  if (!drive) std::abort();
  const DriveSetpoint full[6] = {{1}, {1}, {1}, {1}, {1}, {1}};
  CanFrame out[64];
  TimePoint now = {};
  for (; size >= 13; data += 13, size -= 13) {
    now += std::chrono::milliseconds(data[4]);
    (*drive)->receive(frame_from(data), now);
    const int n = (*drive)->send(full, true, now, out);
    if (n < 2 || n > (*drive)->max_frames() || out[0].id != 0x0804060A) std::abort();
    (*drive)->health(now);
  }
  return 0;
}
